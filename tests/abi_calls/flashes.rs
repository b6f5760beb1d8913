//! Lightning through the C calls.

use std::ptr::{null, null_mut};

use welkin::capi::{lightning::*, status::*, timeline::*};

use super::world::{World, init, message};

const HERE: [f64; 3] = [0.0, 0.0, 2.0];
const SIZE: u32 = size_of::<wk_flash>() as u32;

fn flashes(world: &World, from_s: f64, until_s: f64) -> Vec<wk_flash> {
    let mut count = 0;
    unsafe {
        let ask = |p: *mut wk_flash, n: u32, count: &mut u32| {
            wk_context_get_flashes(world.context, &HERE, from_s, until_s, 2e4, p, n, SIZE, count)
        };
        assert_eq!(ask(null_mut(), 0, &mut count), WK_OK, "{}", message());
        let mut all = vec![std::mem::zeroed::<wk_flash>(); count as usize];
        if count > 1 {
            assert_eq!(ask(all.as_mut_ptr(), count - 1, &mut count), WK_ERROR_INVALID_ARGUMENT);
            assert!(message().contains("capacity") && all[0].id == 0, "{}", message());
        }
        if count > 0 {
            assert_eq!(ask(all.as_mut_ptr(), count, &mut count), WK_OK, "{}", message());
        }
        all
    }
}

#[test]
fn a_host_sets_triggers_and_asks() {
    let world = World::new();
    assert!(flashes(&world, 0.0, 600.0).is_empty());
    let cells = [3000.0, 0.0, 0.0, 500.0, 12.0];
    let masts = [3000.0, 0.0, 90.0];
    let set = wk_lightning {
        cell_count: 1,
        mast_count: 1,
        cells: cells.as_ptr(),
        masts: masts.as_ptr(),
        ..init("wk_lightning")
    };
    assert_eq!(unsafe { wk_context_set_lightning(world.context, &set) }, WK_OK, "{}", message());
    let all = flashes(&world, 0.0, 600.0);
    assert!((80..160).contains(&all.len()), "{}", all.len());
    assert!(all.windows(2).all(|p| p[0].time_s <= p[1].time_s));
    assert_eq!(unsafe { wk_context_set_lightning(world.context, null()) }, WK_OK);
    let flash =
        wk_flash_trigger { time_s: 3.0, position_m: [0.0, 2000.0, 0.0], strokes: 2, ..init("wk_flash_trigger") };
    assert_eq!(unsafe { wk_context_trigger_flash(world.context, &flash) }, WK_OK, "{}", message());
    let own = flashes(&world, 0.0, 600.0);
    assert_eq!((own.len(), own[0].time_s, own[0].strokes, own[0].kind), (1, 3.0, 2, WK_FLASH_KIND_TO_GROUND));
    assert!(own[0].distance_m <= 2001.0 && own[0].thunder_delay_s > 4.0 && own[0].direction[1] > 0.9);
    let mut light: wk_flash_light = init("wk_flash_light");
    assert_eq!(unsafe { wk_context_get_flash_light(world.context, &HERE, 3.01, 0.02, &mut light) }, WK_OK);
    assert!(light.facing_lux[1] > 1.0 && light.level_lux > 0.0, "{:?}", light.facing_lux);
}

#[test]
fn lightning_is_refused_by_name() {
    let world = World::new();
    let plain: wk_lightning = init("wk_lightning");
    let lists = [[0.0, 0.0, 0.0, -1.0, 1.0], [0.0, 0.0, 0.0, 1.0, 61.0], [f64::NAN, 0.0, 0.0, 1.0, 1.0]];
    let of = |list: &[f64; 5]| wk_lightning { cells: list.as_ptr(), cell_count: 1, ..plain };
    for (bad, words) in [
        (of(&lists[0]), "lightning.cells[3] must be in [0, 100000]"),
        (of(&lists[1]), "lightning.cells[4] must be in [0, 60]"),
        (of(&lists[2]), "lightning.cells[0]"),
        (wk_lightning { cell_count: 1, ..plain }, "lightning.cells must not be NULL"),
        (wk_lightning { cell_count: 17, ..of(&lists[0]) }, "lightning.cell_count must be at most 16"),
        (wk_lightning { mast_count: 65, ..plain }, "lightning.mast_count must be at most 64"),
        (wk_lightning { flags: 2, ..plain }, "lightning.flags"),
        (wk_lightning { flicker: 2, ..plain }, "lightning.flicker"),
        (
            wk_lightning { flags: WK_LIGHTNING_RATE, flashes_per_minute: 61.0, ..plain },
            "lightning.flashes_per_minute must be in [0, 60]",
        ),
    ] {
        assert_eq!(unsafe { wk_context_set_lightning(world.context, &bad) }, WK_ERROR_INVALID_ARGUMENT, "{words}");
        assert!(message().contains(words), "{} for {words}", message());
    }
    let plain: wk_flash_trigger = init("wk_flash_trigger");
    for (bad, words) in [
        (wk_flash_trigger { peak_ka: 0.5, ..plain }, "flash.peak_ka must be in [1, 500]"),
        (wk_flash_trigger { strokes: 27, ..plain }, "flash.strokes"),
        (wk_flash_trigger { kind: 2, ..plain }, "flash.kind"),
        (wk_flash_trigger { position_m: [2e12, 0.0, 0.0], ..plain }, "flash.position_m"),
    ] {
        assert_eq!(unsafe { wk_context_trigger_flash(world.context, &bad) }, WK_ERROR_INVALID_ARGUMENT, "{words}");
        assert!(message().contains(words), "{} for {words}", message());
    }
    unsafe {
        assert_eq!(wk_context_update(world.context, 5.0), WK_OK);
        assert_eq!(wk_context_trigger_flash(world.context, &plain), WK_ERROR_WRONG_ORDER);
        assert!(message().contains("flash.time_s"), "{}", message());
        let mut count = 0;
        let most = |d: f64, until: f64, count: &mut u32| {
            wk_context_get_flashes(world.context, &HERE, 0.0, until, d, null_mut(), 0, SIZE, count)
        };
        assert_eq!(most(6e4, 1.0, &mut count), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("most_distance_m"), "{}", message());
        assert_eq!(most(1e4, 3601.0, &mut count), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("until_s"), "{}", message());
        let mut light: wk_flash_light = init("wk_flash_light");
        assert_eq!(wk_context_get_flash_light(world.context, &HERE, 0.0, 1.5, &mut light), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("exposure_s"), "{}", message());
    }
}
