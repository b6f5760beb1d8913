//! The plan against pictures: what it leaves out is within the tolerance, what it keeps is needed.

mod scenes;

use scenes::{Bench, Shot};
use welkin::plan::{Budget, Reason, difference, parts::WORST};

/// Frames until a gauge has answered and what it chose has faded.
const SETTLED: u64 = 22;

/// Whether a picture keeps a tolerance, as the documentation of `plan::parts` has it.
fn keeps(picture: &[f64], everything: &[f64], tolerance: f64) -> bool {
    let d = difference(picture, everything, 1.0).unwrap();
    d.p95 <= tolerance && d.worst <= WORST * tolerance
}

#[test]
fn planned_pictures_are_sufficient_and_minimal() {
    let mut bench = Bench::new();
    let (mut left_out, mut exceeded, mut needless) = (0, 0, Vec::new());
    for seed in 0..24 {
        let shot = Shot::seeded(seed);
        bench.set(&shot);
        let everything = bench.everything(&shot);
        let (planned, plan) = bench.planned(&shot, SETTLED);
        let d = difference(&planned, &everything, 1.0).unwrap();
        println!(
            "{seed} {}: tolerance {} error {:.4} worst {:.3}, estimated {:.4} bound {:.4} worst {:.3}, work {:.2} {:?}",
            shot.name,
            shot.tolerance,
            d.p95,
            d.worst,
            plan.error.p95,
            plan.error.bound,
            plan.error.worst,
            plan.work / plan.work_of_everything,
            plan.parts.map(|p| (p.share, p.reason, p.worth.p95))
        );
        assert!(d.p95 <= shot.tolerance, "{}: {d:?} {plan:?}", shot.name);
        exceeded += u32::from(d.p95 > plan.error.bound + 2e-3);
        let drawn = plan.parts.map(|p| p.share > 0.0);
        for (i, part) in plan.parts.iter().enumerate() {
            match part.reason {
                Reason::WithinTolerance => left_out += 1,
                Reason::Needed if part.work > 0.02 * plan.work => {
                    let mut fewer = drawn;
                    fewer[i] = false;
                    // A tenth of hysteresis and the bound's own width lie between the choice and the tolerance.
                    if keeps(&bench.pinned(&shot, fewer), &everything, 0.8 * shot.tolerance) {
                        needless.push(format!("{} {:?}", shot.name, part.part));
                    }
                }
                _ => {}
            }
        }
    }
    assert!(left_out >= 5, "{left_out} parts left out in all: these scenes ask nothing of the planner");
    assert!(exceeded <= 1, "the bound was exceeded in {exceeded} of 24");
    assert!(needless.is_empty(), "{needless:?}");
}

#[test]
fn parts_fade_without_a_step_and_come_back_when_the_weather_does() {
    let mut bench = Bench::new();
    let near = Shot { weather: "clear", tolerance: 0.03, ..Shot::yard() };
    bench.set(&near);
    let mut last = bench.everything(&near);
    let mut worst = 0.0f64;
    for frame in 0..SETTLED {
        let (now, _) = bench.planned(&near, if frame == 0 { 0 } else { 1 });
        worst = worst.max(difference(&now, &last, 1.0).unwrap().p95);
        last = now;
    }
    let (_, plan) = bench.planned(&near, 1);
    assert_eq!(plan.parts[0].reason, Reason::WithinTolerance, "{plan:?}");
    let worth = plan.parts[0].worth.p95;
    assert!(worth > 0.01 && worst <= worth / 4.0, "{worst}: a part worth {worth} fades over several frames");
    let fog = Shot { weather: "fog", ..near.clone() };
    bench.set(&fog);
    let (planned, plan) = bench.planned(&fog, 12);
    assert!(plan.parts[1].reason == Reason::Needed && plan.parts[1].share == 1.0, "{plan:?}");
    assert!(difference(&planned, &bench.everything(&fog), 1.0).unwrap().p95 < 0.03);
}

#[test]
fn pure_frames_and_hosts_without_a_tolerance_get_everything() {
    let mut bench = Bench::new();
    let near = Shot { weather: "clear", tolerance: 0.05, ..Shot::yard() };
    bench.set(&near);
    bench.planned(&near, SETTLED);
    let pure = bench.pure(&near);
    assert_eq!(pure, bench.everything(&near));
    let view = &mut bench.view;
    view.set_budget(Budget::default()).unwrap();
    let (asked, plan) = bench.unplanned(&near);
    assert_eq!(asked, pure);
    assert!(plan.parts.iter().all(|p| p.reason == Reason::EverythingAsked && p.share == 1.0));
}

#[test]
fn a_budget_out_of_range_is_refused_and_the_last_one_stays() {
    let mut bench = Bench::new();
    let near = Shot { weather: "clear", tolerance: 0.05, ..Shot::yard() };
    bench.set(&near);
    bench.planned(&near, SETTLED);
    for tolerance in [0.0, -1.0, 1.5, f64::NAN, f64::INFINITY] {
        let e = bench.view.set_budget(Budget { tolerance: Some(tolerance), pinned: None }).unwrap_err();
        assert!(e.message.contains("budget.tolerance") && e.message.contains("(0, 1]"), "{}", e.message);
    }
    let (_, plan) = bench.planned(&near, 1);
    assert!(plan.parts.iter().any(|p| p.reason == Reason::WithinTolerance), "{plan:?}");
}
