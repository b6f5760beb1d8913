//! Budgets and plans: figures out of range, plans that go from view to view, and files that are no plans.

use std::ffi::c_void;
use std::ptr::{null, null_mut};

use welkin::capi::{frame::*, plan::*, rain::*, report::*, status::*, timeline::*, view::*, weather::*};

use super::world::{World, init, message, next_frame};

fn budget(has: wk_budget_has_flags) -> wk_budget {
    wk_budget { has, tolerance: 0.01, milliseconds: 2.0, ..init("wk_budget") }
}

/// A wish for one part at one rung.
fn at_rung(part: wk_part, rung: u32) -> wk_part_wish {
    wk_part_wish { has: WK_PART_WISH_HAS_RUNG, part, rung, ..init("wk_part_wish") }
}

fn set(world: &World, has: wk_budget_has_flags, wishes: &[wk_part_wish]) -> (wk_status, String) {
    let b = wk_budget { wishes: wishes.as_ptr(), wish_count: wishes.len() as u32, ..budget(has) };
    // SAFETY: live pointers.
    (unsafe { wk_view_set_budget(world.view, &b) }, message())
}

fn part(world: &World, number: wk_part) -> wk_part_plan {
    let mut part = init::<wk_part_plan>("wk_part_plan");
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_view_get_part_plan(world.view, number, &mut part) }, WK_OK, "{}", message());
    part
}

/// Draws a frame and returns the rungs of air, fog, sky and rain in it.
fn drawn(world: &World) -> [u32; 4] {
    let target = wk_own_target { color: world.texture, ..init("wk_own_target") };
    let mut projection = [0.0; 16];
    (projection[0], projection[5], projection[11], projection[14]) = (1.0, 1.0, -1.0, 0.1);
    let target = (&raw const target).cast();
    let flags = WK_FRAME_DEPTH_REVERSED;
    let frame = wk_frame { frame_id: next_frame(), projection, flags, target, ..init("wk_frame") };
    let mut plan = init::<wk_plan>("wk_plan");
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_view_record(world.view, &frame, WK_STAGE_ALL & !WK_STAGE_TONE), WK_OK, "{}", message());
        assert_eq!(wk_view_get_plan(world.view, &mut plan), WK_OK);
    }
    assert_eq!(plan.part_count, 7);
    [WK_PART_AIR, WK_PART_FOG, WK_PART_SKY, WK_PART_RAIN].map(|number| part(world, number).rung)
}

fn report(world: &World) -> wk_report {
    let mut report = init("wk_report");
    // SAFETY: live pointers.
    assert_eq!(unsafe { wk_view_get_report(world.view, &mut report) }, WK_OK);
    report
}

fn saved(world: &World) -> Vec<u8> {
    let mut size = 0;
    // SAFETY: live pointers with the sizes given.
    unsafe {
        assert_eq!(wk_view_save_plan(world.view, null_mut(), 0, &mut size), WK_OK, "{}", message());
        let mut plan = vec![0xAA_u8; size + 1];
        let mut got = 0;
        let few = wk_view_save_plan(world.view, plan.as_mut_ptr().cast(), size - 1, &mut got);
        assert!(few == WK_ERROR_INVALID_ARGUMENT && got == size && plan[0] == 0xAA);
        assert!(message().contains(&format!("capacity must be at least {size}")), "{}", message());
        assert_eq!(wk_view_save_plan(world.view, plan.as_mut_ptr().cast(), plan.len(), &mut got), WK_OK);
        assert!(got == size && plan.pop() == Some(0xAA));
        plan
    }
}

fn load(world: &World, plan: &[u8]) -> (wk_status, String) {
    // SAFETY: live pointers with the size given.
    (unsafe { wk_view_load_plan(world.view, plan.as_ptr().cast(), plan.len()) }, message())
}

#[test]
fn budgets_and_times_out_of_range_are_named_with_their_range() {
    let world = World::new();
    // SAFETY, for all: live pointers.
    let refused = |b: wk_budget, names: &str| {
        assert_eq!(unsafe { wk_view_set_budget(world.view, &b) }, WK_ERROR_INVALID_ARGUMENT, "{names}");
        assert!(message().starts_with(&format!("wk_view_set_budget: {names}")), "{}", message());
    };
    for tolerance in [0.0, -0.01, 1.01, f64::MAX] {
        refused(wk_budget { tolerance, ..budget(WK_BUDGET_HAS_TOLERANCE) }, "budget.tolerance must be in (0, 1], got");
    }
    for milliseconds in [0.0, -2.0, 1000.1, f64::MAX] {
        let b = wk_budget { milliseconds, ..budget(WK_BUDGET_HAS_MILLISECONDS) };
        refused(b, "budget.milliseconds must be in (0, 1000], got");
    }
    let wish =
        |part, importance| wk_part_wish { has: WK_PART_WISH_HAS_IMPORTANCE, part, importance, ..init("wk_part_wish") };
    let wished = |wishes: &[wk_part_wish], names: &str| {
        let (status, text) = set(&world, 0, wishes);
        assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{names}");
        assert!(text.starts_with(&format!("wk_view_set_budget: {names}")), "{text}");
    };
    for importance in [-0.1, 1.1] {
        wished(&[wish(WK_PART_FOG, importance)], "budget.wishes[0].importance must be in [0, 1], got");
        // The error names the place in the list, which is not the part's number.
        let behind = [wish(WK_PART_RAIN, 0.5), wish(WK_PART_FOG, importance), wish(WK_PART_AIR, 0.5)];
        wished(&behind, "budget.wishes[1].importance must be in [0, 1], got");
        wished(&[behind[0], behind[2], behind[1]], "budget.wishes[2].importance must be in [0, 1], got");
    }
    let parts = "must be one of WK_PART_AIR, WK_PART_FOG, WK_PART_SKY, WK_PART_RAIN, WK_PART_STARS, WK_PART_CLOUDS, WK_PART_SNOW, got 7";
    wished(&[wish(WK_PART_FOG, 0.5), wish(7, 0.5)], &format!("budget.wishes[1].part {parts}"));
    wished(&[wish(WK_PART_FOG, 0.5); 2], "budget.wishes[1].part must be a part that is not in the list yet, got 1");
    wished(&[at_rung(WK_PART_RAIN, 3)], "budget.wishes[0].rung must be in [0, 2] for rain: drops, cones, none, got 3");
    wished(&[at_rung(WK_PART_AIR, 0); 8], "budget.wish_count must be at most 7, got 8");
    wished(&[wk_part_wish { has: 4, ..wish(WK_PART_AIR, 0.5) }], "budget.wishes[0].has");
    for milliseconds in [0.0, -1.0, 2e5, f64::NAN, f64::INFINITY] {
        assert_eq!(unsafe { wk_view_report_time(world.view, milliseconds) }, WK_ERROR_INVALID_ARGUMENT);
        assert!(message().starts_with("wk_view_report_time: milliseconds must be in (0, 1e5] ms"), "{}", message());
        assert_eq!(report(&world).has & WK_REPORT_HAS_REPORTED_MS, 0);
    }
    for part in [7, u32::MAX] {
        let mut plan = init::<wk_part_plan>("wk_part_plan");
        assert_eq!(unsafe { wk_view_get_part_plan(world.view, part, &mut plan) }, WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("part must be one of WK_PART_AIR"), "{}", message());
    }
    // A field whose flag is clear is not checked.
    let nothing = [wk_part_wish { importance: 7.0, rung: 9, ..init("wk_part_wish") }];
    let b = wk_budget { tolerance: -1.0, milliseconds: -1.0, wishes: nothing.as_ptr(), wish_count: 1, ..budget(0) };
    assert_eq!(unsafe { wk_view_set_budget(world.view, &b) }, WK_OK);
}

#[test]
fn a_plan_goes_from_one_view_to_another() {
    let (one, other) = (World::new(), World::new());
    assert_eq!((drawn(&one), drawn(&other)), ([0; 4], [0; 4]));
    // A part that is not in the list is not pinned; without a budget all of it is drawn.
    assert_eq!(set(&one, 0, &[at_rung(WK_PART_FOG, 1), at_rung(WK_PART_AIR, 1)]).0, WK_OK);
    assert_eq!(drawn(&one), [1, 1, 0, 0]);
    assert_eq!(part(&one, WK_PART_SKY).reason, WK_PLAN_REASON_EVERYTHING_ASKED);
    assert_eq!(set(&one, 0, &[at_rung(WK_PART_AIR, 1), at_rung(WK_PART_FOG, 1), at_rung(WK_PART_RAIN, 1)]).0, WK_OK);
    assert_eq!(drawn(&one), [1, 1, 0, 1]);
    let rain = part(&one, WK_PART_RAIN);
    // SAFETY: texts that live as long as the process.
    let texts = [rain.name, rain.rung_name, rain.reason_text].map(|p| unsafe { std::ffi::CStr::from_ptr(p) }.to_str());
    assert_eq!(texts, [Ok("rain"), Ok("cones"), Ok("the host pinned it")]);
    assert_eq!((rain.rung_count, rain.importance, rain.share), (3, 0.7, 0.5));
    let plan = saved(&one);
    assert_eq!(load(&other, &plan).0, WK_OK, "{}", message());
    assert_eq!(drawn(&other), [1, 1, 0, 1]);
    assert_eq!(saved(&other), plan);
    let air = part(&other, WK_PART_AIR);
    assert_eq!((air.reason, air.share), (WK_PLAN_REASON_PINNED, 0.0));
    // SAFETY: a live pointer.
    assert_eq!(unsafe { wk_view_set_budget(other.view, null()) }, WK_OK);
    assert_eq!(drawn(&other), [0; 4], "wk_view_set_budget ends a pinned plan");
}

#[test]
fn a_bad_plan_is_refused_and_the_last_plan_stays() {
    let world = World::new();
    assert_eq!(set(&world, 0, &[at_rung(WK_PART_AIR, 1), at_rung(WK_PART_SKY, 1)]).0, WK_OK);
    assert_eq!(drawn(&world), [1, 0, 1, 0]);
    let plan = saved(&world);
    let text = String::from_utf8(plan.clone()).unwrap().replace("\"none\"", "\"all\"");
    let later = text.replace("version = 3", "version = 7");
    let finer = text.replace("suns = 64", "suns = 96");
    for (bytes, status, says) in [
        (&[][..], WK_ERROR_PARSE, "plan.version must be 3, got nothing"),
        (&text.as_bytes()[..text.len() / 2], WK_ERROR_PARSE, "plan"),
        (later.as_bytes(), WK_ERROR_PARSE, "plan.version must be 3, got 7"),
        (finer.as_bytes(), WK_ERROR_INVALID_ARGUMENT, "plan.sky.suns must be 64 as in this view's context, got 96"),
        (&[0xff, 0, 0xff], WK_ERROR_PARSE, "plan: invalid utf-8"),
        (&[0; 4096], WK_ERROR_PARSE, "plan: TOML parse error at line 1"),
        (&[b' '; 1 << 17], WK_ERROR_PARSE, "plan must have at most 65536 bytes, got 131072"),
    ] {
        let (got, message) = load(&world, bytes);
        assert_eq!(got, status, "{message}");
        assert!(message.starts_with("wk_view_load_plan: ") && message.contains(says), "{says}: {message}");
        assert_eq!(drawn(&world), [1, 0, 1, 0], "{says}");
    }
    // SAFETY: NULL, or sizes that are the buffer's.
    unsafe {
        assert_eq!(wk_view_load_plan(world.view, null(), 9), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("plan must not be NULL"), "{}", message());
        assert_eq!(wk_view_save_plan(world.view, null_mut(), 9, &mut 0), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("buffer must not be NULL"), "{}", message());
        let mut buffer = [0_u8; 8];
        let at: *mut c_void = buffer.as_mut_ptr().cast();
        assert_eq!(wk_view_save_plan(world.view, at, 8, null_mut()), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("out_size must not be NULL"), "{}", message());
    }
    assert_eq!(drawn(&world), [1, 0, 1, 0]);
}

#[test]
fn saving_before_the_plan_is_made_is_refused_and_the_report_has_no_predictions_yet() {
    let world = World::new();
    drawn(&world);
    assert_eq!(report(&world).has, 0, "no budget");
    // SAFETY: live pointers.
    unsafe {
        let both = budget(WK_BUDGET_HAS_TOLERANCE | WK_BUDGET_HAS_MILLISECONDS);
        assert_eq!(wk_view_set_budget(world.view, &both), WK_OK);
        drawn(&world);
        let mut size = 7;
        assert_eq!(wk_view_save_plan(world.view, null_mut(), 0, &mut size), WK_ERROR_WRONG_ORDER);
        assert!(message().contains("the plan is not made yet") && size == 7, "{}", message());
        let says = report(&world);
        assert_eq!((says.has, says.predicted_ms, says.predicted_error), (0, 0.0, 0.0));
        assert_eq!(wk_view_report_time(world.view, 3.5), WK_OK);
        let says = report(&world);
        assert_eq!((says.has, says.reported_ms), (WK_REPORT_HAS_REPORTED_MS, 3.5));
    }
}

#[test]
fn a_contrast_gain_of_zero_means_one_and_the_report_has_the_gain_that_was_applied() {
    let world = World::new();
    let set = |contrast_gain: f64| {
        let rain = wk_rain { contrast_gain, ..init("wk_rain") };
        // SAFETY: live pointers.
        (unsafe { wk_view_set_rain(world.view, &rain) }, message())
    };
    let mut weather = init::<wk_weather>("wk_weather");
    // SAFETY: live pointers.
    unsafe {
        let report = c"METAR LFPG 121200Z 00000KT 4000 +RA 12/11 Q1005";
        assert_eq!(wk_weather_from_metar(report.as_ptr(), null_mut(), 0, 0, &mut weather, null_mut()), WK_OK);
        assert_eq!(wk_context_set_weather(world.context, &weather, 0.0, 0.0), WK_OK, "{}", message());
    }
    for (gain, applied) in [(0.0, 1.0), (1.0, 1.0), (WK_RAIN_GAIN_TRAINER, 4.0), (16.0, 16.0)] {
        assert_eq!(set(gain).0, WK_OK);
        drawn(&world);
        assert_eq!(report(&world).contrast_gain, applied);
    }
    assert!(set(f64::NAN).1.contains("rain.contrast_gain must be finite and in [1, 16], got NaN"));
    for gain in [0.5, -1.0, 16.1] {
        let (status, text) = set(gain);
        assert_eq!(status, WK_ERROR_INVALID_ARGUMENT);
        assert!(text.contains("rain.contrast_gain must be in [1, 16]"), "{text}");
    }
    drawn(&world);
    assert_eq!(report(&world).contrast_gain, 16.0, "a refused one changes nothing");
    let named = [WK_RAIN_SHUTTER_EYE_S, WK_RAIN_SHUTTER_CAMERA_60_S, WK_RAIN_SHUTTER_CAMERA_500_S];
    type Settings = welkin::rain::RainSettings;
    assert_eq!(named, [Settings::SHUTTER_EYE_S, Settings::SHUTTER_CAMERA_60_S, Settings::SHUTTER_CAMERA_500_S]);
    assert_eq!(WK_RAIN_GAIN_TRAINER, Settings::TRAINER.contrast_gain);
}
