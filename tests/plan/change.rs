//! Plans while the weather changes: they are kept, and what they leave out stays within the tolerance.

use welkin::{
    frame::FrameFlags,
    plan::{Reason, difference},
};

use crate::scenes::{Bench, PlanScene};

/// In ten seconds at 30 frames a second clear air becomes hazy. The machine stands so near that at first no air is
/// needed before it. The other view has the same history and leaves nothing out.
#[test]
fn a_plan_is_kept_while_the_weather_changes() {
    let scene = PlanScene { weather: "clear", tolerance: 0.05, ..PlanScene::yard() };
    let mut bench = Bench::new();
    bench.set(&scene);
    bench.planned(&scene, 60);
    bench.draw(&scene, false, FrameFlags(0));
    bench.change_to("hazy", 10.0);
    let (mut planned, mut less, mut worst) = (0, 0, 0.0f64);
    for _ in 0..300 {
        bench.pass(1.0 / 30.0);
        let picture = bench.draw(&scene, true, FrameFlags(0));
        let plan = bench.view.plan();
        planned += usize::from(plan.parts.iter().all(|p| p.reason != Reason::NotGauged));
        less += usize::from(plan.parts.iter().any(|p| p.reason == Reason::WithinTolerance));
        let whole = bench.draw(&scene, false, FrameFlags(0));
        worst = worst.max(difference(&picture, &whole, 1.0).unwrap().p95);
    }
    println!("{planned} frames with a plan, {less} that leave a part out, error {worst:.4}");
    assert!(planned >= 250 && less >= 100, "{planned} and {less} of 300");
    assert!(worst <= scene.tolerance, "{worst}");
}
