//! Broken clouds set through the C functions, for the tests of every kind of host, and checks of their shadow map.

use welkin::capi::{cloud_shadow::*, clouds::*, frame::*, report::*, timeline::*, view::*, weather::*};

use super::{Scene, init, ok};

/// Points along a side of the tested square, and their spacing in metres.
pub const SIDE: u32 = 24;
pub const APART_M: f64 = 400.0;

/// Sets scattered clouds in sunlight.
pub fn scatter(scene: &Scene) {
    let sun = wk_given_direction { azimuth_deg: 120.0, elevation_deg: 40.0, ..init("wk_given_direction") };
    let mut weather = init("wk_weather");
    let mut layers = [init::<wk_cloud_layer>("wk_cloud_layer"); 4];
    let report = c"LOWI 121150Z 00000KT 9999 SCT100 18/12 Q1015".as_ptr();
    // SAFETY: live pointers with the sizes given.
    unsafe {
        let size = size_of::<wk_cloud_layer>() as u32;
        ok(wk_weather_from_metar(report, layers.as_mut_ptr(), 4, size, &mut weather, std::ptr::null_mut()));
        ok(wk_context_set_sun(scene.context, &sun));
        ok(wk_context_set_weather(scene.context, &weather, 0.0, 0.0));
    }
}

/// The view's shadow map.
pub fn shadows(scene: &Scene) -> wk_cloud_shadows {
    let mut map = init("wk_cloud_shadows");
    // SAFETY: live pointers.
    ok(unsafe { wk_view_get_cloud_shadows(scene.view, &mut map) });
    map
}

/// The complete map after a first frame, which draws nothing.
pub fn whole(scene: &Scene, size: (u32, u32)) -> wk_cloud_shadows {
    let first = shadows(scene);
    assert_eq!(first.map_weight, 0.0, "no frame yet");
    let frame = wk_frame { flags: WK_FRAME_DEPTH_REVERSED | WK_FRAME_NO_HISTORY, ..super::frame_of(1, size) };
    // SAFETY: live handles.
    ok(unsafe { wk_view_record(scene.view, &frame, WK_STAGE_PREPARE) });
    let map = shadows(scene);
    assert!(map.texture == first.texture && map.map_weight == 1.0 && map.top_m > 1000.0);
    map
}

/// Point `i` of the square; rows go north.
pub fn place(i: u32) -> [f64; 3] {
    let at = |p: u32| (f64::from(p) - 0.5 * f64::from(SIDE - 1)) * APART_M;
    [at(i % SIDE), at(i / SIDE), 0.0]
}

/// Asserts that these are the sun shares at the points, in order.
#[track_caller]
pub fn assert_shares(scene: &Scene, shares: &[f64]) {
    assert_eq!(shares.len(), (SIDE * SIDE) as usize);
    let (mut off, mut lit) = (Vec::new(), 0);
    for (i, share) in shares.iter().enumerate() {
        let mut queried = 0.0;
        // SAFETY: live pointers.
        ok(unsafe { wk_context_get_sun_share(scene.context, &place(i as u32), 0.0, &mut queried) });
        off.push((share - queried).abs());
        lit += usize::from(queried > 0.9);
    }
    off.sort_by(f64::total_cmp);
    let (half, most) = (off[off.len() / 2], off[off.len() * 95 / 100]);
    println!("shares: off by {half:.4} in the median, {most:.3} at 95 %; {lit} of {} places lit", off.len());
    assert!((60..off.len() - 60).contains(&lit), "light and shadow: {lit}");
    assert!(half < 0.02 && most < 0.2, "{half} {most}");
}
