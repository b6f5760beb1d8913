//! Weather regions through the C interface.

use std::ptr::null;

use super::world::{World, init, message};
use welkin::capi::{conditions::*, region::*, status::*, weather::*, weather_kinds::*};

const STRIDE: u32 = size_of::<wk_weather_region>() as u32;

fn conditions(world: &World, x: f64) -> wk_conditions {
    let mut found = init::<wk_conditions>("wk_conditions");
    // SAFETY: live pointers.
    let status = unsafe { wk_context_get_conditions(world.context, &[x, 0.0, 1.0], 0.0, &mut found) };
    assert_eq!(status, WK_OK, "{}", message());
    found
}

#[test]
fn a_region_has_its_weather_where_it_is_and_a_bad_one_is_refused_by_name() {
    let world = World::new();
    let set = |regions: &[wk_weather_region], count: u32| {
        // SAFETY: live pointers; what is too many is refused before it is read.
        unsafe { wk_context_set_weather_regions(world.context, regions.as_ptr(), count, STRIDE) }
    };
    let fog = wk_weather { visibility_m: 200.0, fog_kind: WK_FOG_FOG, ..init("wk_weather") };
    let cold = wk_weather { temperature_c: -8.0, ..init("wk_weather") };
    let bank = wk_weather_region {
        has: WK_WEATHER_PART_HAZE | WK_WEATHER_PART_FOG,
        weather: &fog,
        ..init("wk_weather_region")
    };
    let mut square = wk_weather_region {
        has: WK_WEATHER_PART_TEMPERATURE,
        weather: &cold,
        center_m: [9000.0, 0.0, 0.0],
        shape: WK_REGION_SHAPE_POLYGON,
        corner_count: 4,
        ..init("wk_weather_region")
    };
    square.corners_m[..8].copy_from_slice(&[-1e3, -1e3, 1e3, -1e3, 1e3, 1e3, -1e3, 1e3]);
    assert_eq!(set(&[bank, square], 2), WK_OK, "{}", message());
    let found = || [0.0, 9000.0, 20_000.0].map(|x| conditions(&world, x));
    let check = || {
        let [inside, cold, outside] = found();
        assert!((inside.visibility_m - 200.0).abs() < 1e-6 && inside.temperature_c == 15.0, "{}", inside.visibility_m);
        assert_eq!((cold.temperature_c, cold.visibility_m), (-8.0, outside.visibility_m));
        assert_eq!(outside.temperature_c, 15.0);
    };
    check();
    let broken = wk_weather { visibility_m: f64::NAN, ..fog };
    let crossing = {
        let mut region = square;
        region.corners_m[..8].copy_from_slice(&[-1e3, -1e3, 1e3, 1.1e3, 1e3, -1e3, -1e3, 1e3]);
        region
    };
    let rounded = wk_weather_region { shape: WK_REGION_SHAPE_RECTANGLE, corner_radius_m: 2001.0, ..bank };
    for (bad, wanted) in [
        (wk_weather_region { has: 0x800, ..bank }, "regions[1].has must"),
        (wk_weather_region { merges: 0x1000, ..bank }, "regions[1].merges must"),
        (wk_weather_region { shape: 3, ..bank }, "regions[1].shape must be"),
        (wk_weather_region { corner_count: 17, ..square }, "regions[1].corner_count must be in [3, 16]"),
        (crossing, "regions[1].corners_m must be those of a polygon"),
        (rounded, "regions[1].corner_radius_m must be in [0, 2000]"),
        (wk_weather_region { strength: 2.0, ..bank }, "regions[1].strength must be in [0, 1]"),
        (wk_weather_region { perimeter_m: f64::NAN, ..bank }, "regions[1].perimeter_m must be finite"),
        (wk_weather_region { at_s: 1e11, ..bank }, "regions[1].at_s must be in"),
        (wk_weather_region { weather: &broken, ..bank }, "regions[1].weather.visibility_m must be finite"),
    ] {
        assert_eq!(set(&[bank, bad], 2), WK_ERROR_INVALID_ARGUMENT, "{wanted}");
        assert!(message().contains(wanted), "{wanted}: {}", message());
    }
    assert_eq!(set(&[bank; 65], 65), WK_ERROR_INVALID_ARGUMENT);
    assert!(message().contains("at most 64"), "{}", message());
    check();
    // SAFETY: an empty list is never followed.
    assert_eq!(unsafe { wk_context_set_weather_regions(world.context, null(), 0, 0) }, WK_OK);
    assert!(conditions(&world, 0.0).visibility_m > 39_000.0);
}
