//! Rehearsals of weathers: errors name the parameter, and the context is afterwards as before.

use std::ptr::{null, null_mut};

use welkin::capi::{context::*, frame::*, status::*, timeline::*, view::*, weather::*};

use super::world::{World, init, message, next_frame};

const STRIDE: u32 = size_of::<wk_weather>() as u32;

/// A scene-linear frame that draws into the world's texture.
fn frame(target: &wk_own_target) -> wk_frame {
    let mut projection = [0.0; 16];
    (projection[0], projection[5], projection[11], projection[14]) = (1.0, 1.0, -1.0, 0.1);
    let target = (&raw const *target).cast();
    wk_frame { frame_id: next_frame(), projection, flags: WK_FRAME_DEPTH_REVERSED, target, ..init("wk_frame") }
}

fn prepare(world: &World, calls: &[wk_stage_flags], weathers: &[wk_weather], most_s: f64) -> (wk_status, String) {
    let target = wk_own_target { color: world.texture, ..init("wk_own_target") };
    let (calls_at, count) = (if calls.is_empty() { null() } else { calls.as_ptr() }, calls.len() as u32);
    let (list, number) = (weathers.as_ptr(), weathers.len() as u32);
    // SAFETY: live pointers with the counts given.
    let status = unsafe { wk_view_prepare(world.view, &frame(&target), calls_at, count, list, number, STRIDE, most_s) };
    (status, message())
}

fn hash(context: *mut wk_context) -> u64 {
    let mut hash = 0;
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_context_state_hash(context, &mut hash) }, WK_OK, "{}", message());
    hash
}

fn weathers(count: usize) -> Vec<wk_weather> {
    (0..count).map(|i| wk_weather { visibility_m: 2000.0 + i as f64, ..init("wk_weather") }).collect()
}

#[test]
fn a_rehearsal_goes_on_until_it_is_done_and_keeps_the_context() {
    let world = World::new();
    let before = hash(world.context);
    let mut calls = 0;
    while prepare(&world, &[], &weathers(2), 0.0).0 == WK_PENDING {
        calls += 1;
        assert_eq!(hash(world.context), before);
    }
    assert_eq!(calls, 37, "nineteen moments each, one a call, and the last call is done");
    assert_eq!(prepare(&world, &[WK_STAGE_BACKGROUND, WK_STAGE_MEDIUM | WK_STAGE_TONE], &weathers(1), 60.0).0, WK_OK);
    assert_eq!(prepare(&world, &[], &[], 0.0).0, WK_OK, "no weather is no work");
    assert_eq!(hash(world.context), before);
    let target = wk_own_target { color: world.texture, ..init("wk_own_target") };
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_view_record(world.view, &frame(&target), WK_STAGE_ALL) }, WK_OK, "{}", message());
}

#[test]
fn what_is_wrong_is_named_and_nothing_changes() {
    let world = World::new();
    let before = hash(world.context);
    let mut bad = weathers(3);
    bad[2].visibility_m = -1.0;
    for (calls, weathers, most_s, wanted) in [
        (vec![], bad, 1.0, "weathers[2].visibility_m must be"),
        (vec![], weathers(65), 1.0, "weather_count must be at most 64"),
        (vec![], weathers(1), -1.0, "most_s must be"),
        (vec![], weathers(1), f64::NAN, "most_s must be"),
        (vec![WK_STAGE_BACKGROUND, 0], weathers(1), 1.0, "calls[1] must be"),
        (vec![1 << 20], weathers(1), 1.0, "calls[0] must be"),
        (vec![WK_STAGE_ALL; 8], weathers(1), 1.0, "call_count must be at most 7"),
        (vec![WK_STAGE_MEDIUM, WK_STAGE_MEDIUM], weathers(1), 1.0, "stages 0x8 of frame_id"),
    ] {
        let (status, message) = prepare(&world, &calls, &weathers, most_s);
        assert!(status < 0 && message.contains(wanted), "{status}: {message}, not {wanted}");
        assert_eq!(hash(world.context), before, "{wanted}");
    }
    let weather = weathers(1);
    let empty = frame(&init("wk_own_target"));
    let refused = |frame: *const wk_frame, weathers: *const wk_weather, count: u32, stride: u32, wanted: &str| {
        // SAFETY: live pointers, or NULL.
        let status = unsafe { wk_view_prepare(world.view, frame, null(), 0, weathers, count, stride, 1.0) };
        assert!(status < 0 && message().contains(wanted), "{status}: {}, not {wanted}", message());
        assert_eq!(hash(world.context), before, "{wanted}");
    };
    refused(null(), weather.as_ptr(), 1, STRIDE, "frame");
    refused(&empty, weather.as_ptr(), 1, STRIDE, "frame.target.color");
    refused(&empty, null_mut(), 1, STRIDE, "weathers must not be NULL");
    refused(&empty, weather.as_ptr(), 1, 4, "weather_stride must be");
}
