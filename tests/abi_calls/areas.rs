//! Rain areas through the C interface.

use std::ptr::null;

use super::world::{World, init, message};
use welkin::capi::{area::*, status::*, wind::*};

const STRIDE: u32 = size_of::<wk_rain_area>() as u32;

fn rate(world: &World, x: f64) -> f64 {
    let mut rain = init::<wk_rainfall>("wk_rainfall");
    // SAFETY: live pointers.
    let status = unsafe { wk_context_get_rainfall_at(world.context, &[x, 0.0, 0.0], 0.0, &mut rain) };
    assert_eq!(status, WK_OK, "{}", message());
    rain.rate_mm_h
}

#[test]
fn an_area_rains_where_it_is_and_a_bad_one_is_refused_by_name() {
    let world = World::new();
    let set = |areas: &[wk_rain_area], count: u32| {
        // SAFETY: live pointers; too large a count is refused before the list is read.
        unsafe { wk_context_set_rain_areas(world.context, areas.as_ptr(), count, STRIDE) }
    };
    let shower = wk_rain_area { rain: WK_AREA_RAIN_SHOWERS, rate_mm_h: 24.0, ..init("wk_rain_area") };
    let mut square = wk_rain_area { center_m: [9000.0, 0.0, 0.0], corner_count: 4, rate_mm_h: 3.0, ..shower };
    square.corners_m[..8].copy_from_slice(&[-1e3, -1e3, 1e3, -1e3, 1e3, 1e3, -1e3, 1e3]);
    square.motion = WK_AREA_MOTION_OWN;
    assert_eq!(set(&[shower, square], 2), WK_OK, "{}", message());
    let rates = || [0.0, 1750.0, 5000.0, 9000.0].map(|x| (rate(&world, x) * 1e3).round() * 1e-3);
    assert_eq!(rates(), [24.0, 12.0, 0.0, 3.0]);
    for (bad, wanted) in [
        (wk_rain_area { rate_mm_h: f64::NAN, ..square }, "areas[1].rate_mm_h must be finite and in [0, 500], got NaN"),
        (wk_rain_area { rim_m: 3000.0, ..shower }, "areas[1].rim_m must be in [1, 2000]"),
        (wk_rain_area { corner_count: 2, ..square }, "areas[1].corner_count must be in [3, 8]"),
        (wk_rain_area { at_s: 1e11, ..shower }, "areas[1].at_s must be in"),
        (wk_rain_area { rain: 9, ..shower }, "areas[1].rain must be"),
        (wk_rain_area { motion: 9, ..shower }, "areas[1].motion must be"),
        (wk_rain_area { snow: 9, ..shower }, "areas[1].snow must be"),
    ] {
        assert_eq!(set(&[shower, bad], 2), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains(wanted), "{wanted}: {}", message());
    }
    assert_eq!(set(&[shower, wk_rain_area { snow: WK_AREA_SNOW_FLAKES, ..shower }], 2), WK_ERROR_UNSUPPORTED);
    assert!(message().contains("areas[1].snow must be WK_AREA_SNOW_NONE"), "{}", message());
    assert_eq!(set(&[shower; 17], 17), WK_ERROR_INVALID_ARGUMENT);
    assert!(message().contains("at most 16"), "{}", message());
    assert_eq!(rates(), [24.0, 12.0, 0.0, 3.0], "what ran goes on");
    // SAFETY: an empty list is never followed.
    assert_eq!(unsafe { wk_context_set_rain_areas(world.context, null(), 0, 0) }, WK_OK);
    assert_eq!(rates(), [0.0; 4]);
}
