//! Clouds: the model, and the sun's share at a place.

use welkin::capi::{clouds::*, status::*};

use super::world::{World, message};

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
