//! Plans as text: another view that loads one draws the same parts, and nothing else changes its plan.

use welkin::{
    frame::FrameFlags,
    plan::{Budget, GaveWay, Reason},
};

use crate::{
    SETTLED,
    scenes::{Bench, PlanScene},
};

/// A yard under clear air, in which air and fog are not needed.
fn near() -> PlanScene {
    PlanScene { weather: "clear", tolerance: 0.05, ..PlanScene::yard() }
}

#[test]
fn another_view_that_loads_a_plan_draws_the_same_parts_at_once() {
    let mut bench = Bench::new();
    let near = near();
    bench.set(&near);
    let (planned, plan) = bench.planned(&near, SETTLED);
    assert_eq!(plan.parts[0].reason, Reason::WithinTolerance, "{plan:?}");
    let text = bench.view.save_plan().unwrap();
    assert_ne!(bench.everything(&near), planned);
    bench.plain.load_plan(text.as_bytes()).unwrap();
    assert_eq!(bench.everything(&near), planned, "the other channel draws alike in its first frame");
    assert_eq!(bench.plain.plan().rungs(), plan.rungs());
    assert_eq!(bench.plain.save_plan().unwrap(), text);
    // The plan stays after a jump and in another weather.
    let fog = PlanScene { weather: "fog", ..near.clone() };
    bench.set(&fog);
    bench.draw(&fog, false, FrameFlags::CUT);
    assert_eq!(bench.plain.plan().rungs(), plan.rungs());
    assert!(bench.plain.plan().parts.iter().all(|p| p.reason == Reason::Pinned));
}

#[test]
fn a_plan_is_saved_once_it_is_made() {
    let mut bench = Bench::new();
    let near = near();
    bench.set(&near);
    bench.planned(&near, 1);
    let e = bench.view.save_plan().unwrap_err();
    assert!(e.status == welkin::Status::WrongOrder && e.to_string().contains("not made yet"), "{e:?}");
    bench.planned(&near, SETTLED);
    bench.view.save_plan().unwrap();
}

#[test]
fn a_plan_that_is_no_plan_changes_nothing() {
    let mut bench = Bench::new();
    let near = near();
    bench.set(&near);
    let (before, plan) = bench.planned(&near, SETTLED);
    let text = bench.view.save_plan().unwrap();
    // The benches' sky has 4 orders of scattering; with a plan for the default's 5 the picture would differ.
    for (from, to, says) in [
        ("version = 3", "version = 4", "plan.version must be 3, got 4"),
        ("air = \"none\"", "", "plan.drawn.air"),
        ("orders = 4", "orders = 5", "plan.sky.orders must be 4"),
    ] {
        assert!(text.contains(from));
        let e = bench.view.load_plan(text.replacen(from, to, 1).as_bytes()).unwrap_err();
        assert!(e.to_string().starts_with(says), "{}", e);
        assert_eq!(bench.draw(&near, true, FrameFlags(0)), before);
        assert_eq!(bench.view.plan().parts, plan.parts);
    }
}

#[test]
fn a_pinned_plan_reports_the_limit_that_it_does_not_keep() {
    let mut bench = Bench::new();
    let fog = PlanScene { weather: "fog", ..PlanScene::yard() };
    bench.set(&fog);
    let mut pinned = |rungs: [usize; 7], tolerance, milliseconds| {
        let budget = Budget { tolerance, milliseconds, ..Budget::pinned(&rungs) };
        bench.view.set_budget(budget).unwrap();
        for _ in 0..12 {
            bench.draw(&fog, true, FrameFlags(0));
            bench.view.report_time(5.0).unwrap();
        }
        let plan = bench.view.plan().clone();
        assert!(plan.parts.iter().all(|p| p.reason == Reason::Pinned));
        assert_eq!(plan.rungs(), rungs);
        plan
    };
    let plan = pinned([0, 1, 0, 0, 0, 0, 0], Some(0.01), None);
    assert!(plan.gave_way == GaveWay::Tolerance && plan.error.p95 > 0.1, "{plan:?}");
    let plan = pinned([0; 7], Some(0.01), None);
    assert!(plan.gave_way == GaveWay::Nothing && plan.error.p95 == 0.0, "{plan:?}");
    assert_eq!(pinned([0; 7], Some(0.01), Some(4.0)).gave_way, GaveWay::Time);
    assert_eq!(pinned([0; 7], Some(0.01), Some(6.0)).gave_way, GaveWay::Nothing);
}
