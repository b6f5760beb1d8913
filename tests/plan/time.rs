//! Predicted times and errors against the actual ones, by a fake clock.

use welkin::{
    frame::FrameFlags,
    plan::{Budget, Reason},
};

use crate::scenes::{Bench, PlanScene};

/// A machine on which the parts' relative costs differ from those of the machine on which the constants were measured:
/// the time of its frame by the number of the host's pixels, ms.
struct Machine {
    ms: f64,
    air: f64,
    fog: f64,
    sky: f64,
}

impl Machine {
    fn frame(&self, bench: &Bench, parts: &[bool]) -> f64 {
        let objects = bench.share_of_objects();
        let costs = [self.air * objects, self.fog, self.sky * (1.0 - objects)];
        let before_fog = if parts[0] && parts[1] { self.air } else { 0.0 };
        self.ms * (1.0 + before_fog + (0..3).filter(|i| parts[*i]).map(|i| costs[i]).sum::<f64>())
    }
}

#[test]
fn times_are_predicted_within_a_quarter_in_seeded_scenes() {
    let mut bench = Bench::new();
    let machine = Machine { ms: 6.0, air: 0.7, fog: 0.25, sky: 0.04 };
    // Errors in frames whose scene and parts have not changed for some frames, and in all frames.
    let (mut settled, mut all) = (Vec::new(), Vec::new());
    for seed in 0..24 {
        let shot = PlanScene::seeded(seed);
        bench.set(&shot);
        // Most scenes cannot be drawn in full in this time.
        let budget = Budget { tolerance: Some(shot.tolerance), milliseconds: Some(11.0), ..Budget::default() };
        bench.view.set_budget(budget).unwrap();
        let (mut before, mut since) = (vec![true; 4], 0);
        for _ in 0..30 {
            bench.draw(&shot, true, FrameFlags(0));
            let plan = bench.view.plan();
            let drawn: Vec<bool> = plan.parts.iter().map(|p| p.reason != Reason::Absent && p.share > 0.0).collect();
            since = if drawn == before { since + 1 } else { 0 };
            let took = machine.frame(&bench, &drawn);
            before = drawn;
            if let Some(said) = bench.view.report().prediction.milliseconds {
                let error = (said / took - 1.0).abs();
                all.push(error);
                if since >= 7 {
                    settled.push(error);
                }
            }
            bench.view.report_time(took).unwrap();
            assert_eq!(bench.view.report().reported_ms, Some(took));
        }
    }
    let beyond = |errors: &[f64]| errors.iter().filter(|e| **e > 0.25).count();
    let worst = all.iter().copied().fold(0.0, f64::max);
    println!("{} of {}, settled {} of {}, worst {worst}", beyond(&all), all.len(), beyond(&settled), settled.len());
    assert!(settled.len() > 200 && beyond(&settled) == 0);
    assert!(20 * beyond(&all) <= all.len(), "{} of {}", beyond(&all), all.len());
}

#[test]
fn a_report_says_what_was_predicted_and_what_was_found() {
    let mut bench = Bench::new();
    let near = PlanScene { weather: "mist", tolerance: 0.2, ..PlanScene::yard() };
    bench.set(&near);
    bench.draw(&near, true, FrameFlags(0));
    let unplanned = bench.view.report().prediction;
    assert!(unplanned.milliseconds.is_none() && unplanned.error.is_none() && unplanned.checked.is_none());
    let (_, plan) = bench.planned(&near, 90);
    assert!(plan.milliseconds.is_none(), "no time was reported yet");
    let report = *bench.view.report();
    assert_eq!((report.prediction.milliseconds, report.reported_ms), (None, None));
    assert_eq!(report.prediction.error, Some(plan.error), "all that is left out has faded");
    let [bound, found] = report.prediction.checked.unwrap();
    assert!(plan.error.p95 > 1e-3 && found <= bound && (found - plan.error.p95).abs() < 0.1 * found, "{report:?}");
    bench.view.report_time(4.0).unwrap();
    assert_eq!(bench.view.report().reported_ms, Some(4.0));
    bench.planned(&near, 1);
    let report = *bench.view.report();
    assert!((report.prediction.milliseconds.unwrap() - 4.0).abs() < 1e-9 && report.reported_ms.is_none(), "{report:?}");
    // Another scene, on which the earlier gauge gives no information.
    bench.pure(&near);
    let cut = bench.view.report().prediction;
    assert!(cut.milliseconds.is_none() && cut.error.is_none(), "{cut:?}");
}

#[test]
fn tables_that_follow_the_air_take_longer_where_there_is_no_time_for_them() {
    let mut bench = Bench::new();
    let clear = PlanScene { weather: "clear", ..PlanScene::yard() };
    let smoke = PlanScene { weather: "smoke", ..PlanScene::yard() };
    // Number of frames that work on tables after a change of air; a frame takes 10 ms.
    let mut frames_with = |budget: f64| {
        bench.set(&clear);
        bench.everything(&clear);
        let budget = Budget { milliseconds: Some(budget), ..Budget::default() };
        bench.view.set_budget(budget).unwrap();
        for _ in 0..20 {
            bench.draw(&clear, true, FrameFlags(0));
            bench.view.report_time(10.0).unwrap();
        }
        assert_eq!(bench.view.report().tables_rebuilt, 0);
        bench.set(&smoke);
        let mut frames = 0;
        for _ in 0..120 {
            bench.draw(&smoke, true, FrameFlags(0));
            frames += u32::from(bench.view.report().tables_rebuilt > 0);
        }
        frames
    };
    let (ample, tight) = (frames_with(1000.0), frames_with(10.5));
    println!("{ample} frames, {tight} where time is short");
    assert!((20..40).contains(&ample) && tight > ample + 15 && tight < 110, "{ample} {tight}");
}
