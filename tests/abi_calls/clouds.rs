//! Clouds: the model, and the sun's share at a place.

use std::ptr::null;

use welkin::capi::{cloud_map::*, clouds::*, status::*, timeline::*};

use super::world::{World, init, message};

fn refused(status: wk_status, wanted: &str) {
    assert_eq!(status, WK_ERROR_INVALID_ARGUMENT);
    assert!(message().contains(wanted), "{}", message());
}

#[test]
fn a_host_chooses_how_clouds_are_drawn_and_asks_for_the_suns_share() {
    let world = World::new();
    let share = |at: &[f64; 3], time_s: f64| {
        let mut share = -1.0;
        let status = unsafe { wk_context_get_sun_share(world.context, at, time_s, &mut share) };
        (status, share)
    };
    let (status, mean) = share(&[0.0; 3], 0.0);
    assert_eq!(status, WK_OK, "{}", message());
    assert!((0.0..=1.0).contains(&mean));
    assert_eq!(unsafe { wk_context_set_cloud_model(world.context, WK_CLOUD_MODEL_VOLUME) }, WK_OK);
    let (status, above) = share(&[0.0, 0.0, 30e3], 0.0);
    assert_eq!((status, above), (WK_OK, 1.0), "above all clouds");
    refused(unsafe { wk_context_set_cloud_model(world.context, 2) }, "cloud_model must be one of");
    refused(share(&[f64::NAN, 0.0, 0.0], 0.0).0, "position_m");
    refused(share(&[0.0; 3], f64::NAN).0, "time_s");
    assert_eq!(share(&[0.0; 3], f64::NAN).1, -1.0, "nothing is written");
    let null = std::ptr::null_mut();
    refused(unsafe { wk_context_get_sun_share(world.context, &[0.0; 3], 0.0, null) }, "out_share");
}

#[test]
fn a_map_of_clouds_comes_through_and_goes_again() {
    let world = World::new();
    let hash = || {
        let mut hash = 0;
        assert_eq!(unsafe { wk_context_state_hash(world.context, &mut hash) }, WK_OK);
        hash
    };
    let before = hash();
    let cover = [0.0f32, 0.5, 1.0, 1.0];
    let map = wk_cloud_map { cells: [2, 2], cover: cover.as_ptr(), cover_count: 4, ..init("wk_cloud_map") };
    // SAFETY, for all: live pointers.
    let set = |map: &wk_cloud_map| unsafe { wk_context_set_cloud_map(world.context, map) };
    assert_eq!(set(&map), WK_OK, "{}", message());
    let mapped = hash();
    assert_ne!(mapped, before);
    let bad = [0.0f32, 2.0, f32::NAN, 0.0];
    refused(set(&wk_cloud_map { cover: bad.as_ptr(), ..map }), "cloud_map.cover[1] must be in [0, 1]");
    refused(set(&wk_cloud_map { cover_count: 3, ..map }), "cloud_map.cover_count must be 4");
    refused(set(&wk_cloud_map { cover: null(), ..map }), "cloud_map.cover must not be NULL");
    refused(set(&wk_cloud_map { cells: [0, 2], ..map }), "cloud_map.cells[0] must be in [1, 128]");
    refused(set(&wk_cloud_map { cells: [129, 2], ..map }), "cloud_map.cells[0] must be in [1, 128]");
    refused(set(&wk_cloud_map { cell_m: f64::NAN, ..map }), "cloud_map.cell_m must be finite and in [100, 50 000]");
    refused(set(&wk_cloud_map { first_m: [0.0, 1e9], ..map }), "cloud_map.first_m[1] must be in");
    assert_eq!(hash(), mapped, "an error changes nothing");
    assert_eq!(unsafe { wk_context_set_cloud_map(world.context, null()) }, WK_OK);
    assert_eq!(hash(), before);
}
