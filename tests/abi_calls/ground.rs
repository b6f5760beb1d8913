//! Water on the host's terrain through the C interface.

use std::ptr::{null, null_mut};

use super::world::{World, init, message, update};
use welkin::capi::{
    context::*, ground::*, ground_grid::*, ground_texture::*, rain::*, status::*, timeline::*, weather::*,
    weather_kinds::*, wind::*,
};

const CELL: u32 = size_of::<wk_ground_cell>() as u32;

fn rain(context: *mut wk_context) {
    let weather =
        wk_weather { precipitation_kind: WK_PRECIPITATION_RAIN, precipitation_rate_mm_h: 20.0, ..init("wk_weather") };
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_set_weather(context, &weather, 0.0, 0.0) }, WK_OK, "{}", message());
}

#[test]
fn a_terrain_gets_wet_and_its_hollow_fills() {
    let world = World::new();
    let simulation = wk_simulation_desc { ground_model: WK_GROUND_SIMULATED, ..init("wk_simulation_desc") };
    let desc = wk_context_desc { next: (&raw const simulation).cast(), ..init("wk_context_desc") };
    let mut context = null_mut();
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_create(world.device, &desc, &mut context) }, WK_OK, "{}", message());
    rain(context);
    let refused = |status: wk_status, wanted: &str| {
        assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{wanted}: {}", message());
        assert!(message().contains(wanted), "{wanted}: {}", message());
    };
    // A pit of 0.2 m in the middle of 5 x 5 cells of 2 m.
    let mut heights = [0.0f32; 25];
    heights[12] = -0.2;
    let grid = wk_ground_grid {
        origin_m: [-4.0, -4.0, 0.0],
        cell_m: 2.0,
        nodes: [5, 5],
        heights_m: heights.as_ptr(),
        height_count: 25,
        ..init("wk_ground_grid")
    };
    // SAFETY, for all: live pointers with the sizes given.
    let set = |grid: &wk_ground_grid| unsafe { wk_context_set_ground_grid(context, grid) };
    let mut cells = [wk_ground_cell { film_mm: 9.0, soaked: 9.0, standing_mm: 9.0, ice: 9.0 }; 25];
    let mut revision = 0u64;
    let get = |cells: &mut [wk_ground_cell], size: u32, revision: *mut u64| unsafe {
        wk_context_get_ground_cells(context, cells.as_mut_ptr(), cells.len() as u32, size, revision)
    };
    assert_eq!(get(&mut cells, CELL, &mut revision), WK_ERROR_WRONG_ORDER, "{}", message());
    assert_eq!(set(&grid), WK_OK, "{}", message());
    update(context, 1800.0);
    refused(get(&mut cells[..24], CELL, &mut revision), "capacity must be at least 25");
    refused(get(&mut cells, 12, &mut revision), "cell_size must be");
    refused(get(&mut cells, CELL, null_mut()), "out_revision must not be NULL");
    assert_eq!(cells[12].film_mm, 9.0, "an error writes nothing");
    assert_eq!(get(&mut cells, CELL, &mut revision), WK_OK, "{}", message());
    assert!(cells[12].standing_mm > 20.0 && cells[12].film_mm == 0.0 && cells[12].ice == 0.0);
    assert!(
        cells.iter().enumerate().all(|(i, c)| i == 12 || (c.film_mm > 0.5 && c.standing_mm == 0.0 && c.soaked > 0.9))
    );
    let mut ground = init::<wk_ground>("wk_ground");
    assert_eq!(unsafe { wk_context_get_ground(context, &[0.0; 3], &mut ground) }, WK_OK);
    assert!((ground.water_mm / f64::from(cells[12].standing_mm) - 1.0).abs() < 1e-6 && ground.in_puddle == 1);
    // The material is that of the cell, or the default where the cell has none.
    let mut classes = [WK_SURFACE_CLASS_ROCK as u8; 25];
    classes[12] = 0;
    let made = wk_ground_grid { surface_classes: classes.as_ptr(), surface_class_count: 25, ..grid };
    assert_eq!(set(&made), WK_OK, "{}", message());
    assert_eq!(unsafe { wk_context_set_default_surface_class(context, WK_SURFACE_CLASS_SOIL) }, WK_OK);
    for (at, class) in [([0.0; 3], WK_SURFACE_CLASS_SOIL), ([4.0, 4.0, 0.0], WK_SURFACE_CLASS_ROCK)] {
        assert_eq!(unsafe { wk_context_get_ground(context, &at, &mut ground) }, WK_OK);
        assert_eq!(ground.surface_class, class, "{at:?}");
    }
    refused(unsafe { wk_context_set_default_surface_class(context, 7) }, "surface_class must be one of");
    refused(
        set(&wk_ground_grid { surface_class_count: 24, ..made }),
        "ground_grid.surface_class_count must be 0, or 25",
    );
    classes[3] = 7;
    let torn = wk_ground_grid { surface_classes: classes.as_ptr(), ..made };
    refused(set(&torn), "ground_grid.surface_classes[3] must be a WK_SURFACE_CLASS_ value, 0 to 6, got 7");
    let mut again = 0u64;
    assert_eq!(get(&mut [], CELL, &mut again), WK_OK, "{}", message());
    assert_eq!(again, revision);
    update(context, 1810.0);
    assert_eq!(get(&mut [], CELL, &mut again), WK_OK);
    assert!(again != revision, "rain goes on");
    for (bad, wanted) in [
        (wk_ground_grid { cell_m: -1.0, ..grid }, "ground_grid.cell_m must be in [0.01, 10000]"),
        (wk_ground_grid { nodes: [1, 25], ..grid }, "ground_grid.nodes[0] must be in [2, 512]"),
        (wk_ground_grid { nodes: [513, 5], ..grid }, "ground_grid.nodes[0] must be in [2, 512]"),
        (wk_ground_grid { height_count: 24, ..grid }, "ground_grid.height_count must be 25"),
        (wk_ground_grid { heights_m: null(), ..grid }, "ground_grid.heights_m must not be NULL"),
        (wk_ground_grid { reserved0: 1, ..grid }, "ground_grid.reserved0 must be 0"),
    ] {
        refused(set(&bad), wanted);
    }
    let mut torn = heights;
    torn[3] = f32::NAN;
    refused(set(&wk_ground_grid { heights_m: torn.as_ptr(), ..grid }), "ground_grid.heights_m[3] must be finite");
    assert_eq!(get(&mut [], CELL, &mut revision), WK_OK);
    assert_eq!(revision, again, "what ran goes on");
    assert_eq!(unsafe { wk_context_set_ground_grid(context, null()) }, WK_OK);
    assert_eq!(get(&mut cells, CELL, &mut revision), WK_ERROR_WRONG_ORDER);
    // SAFETY: a live handle.
    assert_eq!(unsafe { wk_context_destroy(context) }, WK_OK);
}

#[test]
fn a_device_without_shaders_of_the_hosts_has_no_texture_for_them() {
    let world = World::new();
    let heights = [0.0f32; 4];
    let grid = wk_ground_grid { heights_m: heights.as_ptr(), height_count: 4, ..init("wk_ground_grid") };
    let mut texture = wk_ground_texture { generation: 77, ..init("wk_ground_texture") };
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_context_set_ground_grid(world.context, &grid), WK_OK, "{}", message());
        assert_eq!(wk_context_get_ground_texture(world.context, &mut texture), WK_ERROR_UNSUPPORTED);
        assert!(message().contains("ground textures are for hosts that draw"), "{}", message());
        assert_eq!((texture.texture, texture.generation), (0, 77), "an error writes nothing");
        assert_eq!(wk_context_get_ground_texture(world.context, null_mut()), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("out_texture must not be NULL"), "{}", message());
        let center = [0.0; 3];
        assert_eq!(wk_context_get_terrain_texture(world.context, &center, &mut texture), WK_ERROR_UNSUPPORTED);
        assert!(message().contains("terrain textures are for hosts that draw"), "{}", message());
        assert_eq!(
            wk_context_get_terrain_texture(world.context, null(), &mut texture),
            WK_ERROR_INVALID_ARGUMENT,
            "a place is missing"
        );
        assert!(message().contains("center_m must not be NULL"), "{}", message());
        assert_eq!((texture.texture, texture.generation), (0, 77), "an error writes nothing");
    }
}

#[test]
fn boxes_keep_rain_off_the_surfaces_that_are_asked_for() {
    let world = World::new();
    rain(world.context);
    let on = |position_m: [f64; 3], normal: [f64; 3], velocity_m_s: [f64; 3], time_s: f64| {
        let surface = wk_rain_surface { position_m, normal, velocity_m_s, area_m2: 1.0 };
        let mut on = wk_rain_on { rate_mm_h: 0.0, drops_per_s: 0.0 };
        let sizes = [size_of::<wk_rain_surface>(), size_of::<wk_rain_on>()].map(|s| s as u32);
        // SAFETY: live pointers with the sizes given.
        let status =
            unsafe { wk_context_get_rain_on_at(world.context, &surface, 1, sizes[0], time_s, &mut on, sizes[1]) };
        assert_eq!(status, WK_OK, "{}", message());
        on.rate_mm_h
    };
    let (up, still) = ([0.0, 0.0, 1.0], [0.0; 3]);
    let open = on(still, up, still, 0.0);
    assert!((open - 20.0).abs() < 0.1, "{open}");
    let stride = size_of::<wk_shelter>() as u32;
    let set = |shelter: &wk_shelter| unsafe { wk_context_set_shelters(world.context, shelter, 1, stride) };
    // A cab that drives north at 20 m/s: its roof and its front are wet, its floor and its rear are not.
    let cab = wk_shelter {
        center_m: [0.0, 0.0, 2.0],
        half_size_m: [1.0, 2.0, 1.0],
        velocity_m_s: [0.0, 20.0, 0.0],
        ..init("wk_shelter")
    };
    assert_eq!(set(&cab), WK_OK, "{}", message());
    let drives = cab.velocity_m_s;
    assert_eq!(on([0.0, 0.0, 1.5], up, drives, 0.0), 0.0, "in it");
    assert!((on([0.0, 0.0, 3.0], up, drives, 0.0) / open - 1.0).abs() < 1e-9, "on its roof");
    let front = on([0.0, 2.0, 2.0], [0.0, 1.0, 0.0], drives, 0.0);
    assert!(front > 2.0 * open, "{front}");
    // A surface in the cab's way is dry while the cab passes over it, and wet again afterwards.
    let by_time = [0.0, 0.5, 1.05, 2.0].map(|t| on([0.0, 20.0, 0.5], up, still, t) / open);
    assert!(by_time[0] > 0.99 && by_time[2] < 0.1 && by_time[3] > 0.9, "{by_time:?}");
    // Below a roof at the edge of the shadow, steeply falling drops arrive and slanting ones do not.
    let windy = wk_weather {
        precipitation_kind: WK_PRECIPITATION_RAIN,
        precipitation_rate_mm_h: 20.0,
        wind_speed_m_s: 6.0,
        wind_from_deg: 270.0,
        ..init("wk_weather")
    };
    assert_eq!(unsafe { wk_context_set_weather(world.context, &windy, 0.0, 0.0) }, WK_OK, "{}", message());
    let roof = wk_shelter { center_m: [0.0, 0.0, 6.0], half_size_m: [5.0, 50.0, 0.1], ..init("wk_shelter") };
    assert_eq!(set(&roof), WK_OK, "{}", message());
    let across: Vec<f64> = (-8..=22).map(|x| on([f64::from(x), 0.0, 0.0], up, still, 0.0) / open).collect();
    let at = |x: i32| across[(x + 8) as usize];
    assert!(at(-8) > 0.99 && at(-4) > 0.3 && at(6) < 0.5 && at(22) > 0.95, "{across:?}");
    let shares = across.iter().filter(|s| (0.02..0.98).contains(*s)).count();
    assert!(shares > 6, "sizes come along slants of their own: {across:?}");
}
