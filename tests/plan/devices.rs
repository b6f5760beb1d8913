//! One planner on two devices: the plan follows the times of the device itself, not a table of another device.

use welkin::{
    frame::{FrameFlags, PARTS},
    plan::{Budget, GaveWay, PartPlan, Plan, Reason},
};

use crate::scenes::{Bench, PlanScene, SIZE};

/// Recorded costs of a device: the time of a pixel with none of the parts, and each part's time over that.
struct Profile {
    name: &'static str,
    pixel_ns: f64,
    /// For each pixel in which the host drew.
    air: f64,
    /// For each pixel.
    fog: f64,
    /// In addition to `fog`, for each pixel in which the host drew and air is drawn too.
    fog_in_air: f64,
    /// For each pixel in which the host drew nothing.
    sky: f64,
    /// For each pixel, as soon as streaks of rain are drawn at all.
    streaks: f64,
    /// For each drop.
    drop: f64,
}

/// Mesa's software driver: shares by `cargo bench --bench speed -- parts`, fog with the air before it by `-- copies`
/// (5.3 copies beside a clear noon of 11.6), nanoseconds of a drop by `-- rain`.
const SOFTWARE: Profile = Profile {
    name: "llvmpipe",
    pixel_ns: 67.0,
    air: 0.74,
    fog: 0.31,
    fog_in_air: 0.68,
    sky: 0.09,
    streaks: 0.22,
    drop: 1.04,
};

/// An H100 at 1920x1080, from docs/lab/gpu.md. A clear noon takes 1.358 ms; the shares of air and sky in it are the
/// software driver's. Fog adds 0.246 ms. To dry haze 150,000 drops add 0.738 ms, and 400,000 drops 0.973 ms.
const GPU: Profile = Profile {
    name: "H100",
    pixel_ns: 0.463,
    air: 0.74,
    fog: 0.13,
    fog_in_air: 0.26,
    sky: 0.09,
    streaks: 0.62,
    drop: 2.03,
};

fn place(name: &str) -> usize {
    PARTS.iter().position(|p| p.name == name).unwrap()
}

impl Profile {
    /// Returns the time of a picture, ms, in whose share `share` the host drew, with this many `drops`, and parts at
    /// these rungs.
    fn ms(&self, share: f64, drops: f64, there: &[bool], rungs: &[usize]) -> f64 {
        let drawn = |name| there[place(name)] && rungs[place(name)] + 1 < PARTS[place(name)].rungs.len();
        let cost = |is_drawn, work: f64| if is_drawn { work } else { 0.0 };
        let pixels = f64::from(SIZE.0 * SIZE.1);
        let a_pixel = 1.0
            + cost(drawn("air"), self.air * share)
            + cost(drawn("fog"), self.fog)
            + cost(drawn("air") && drawn("fog"), self.fog_in_air * share)
            + cost(drawn("sky"), self.sky * (1.0 - share))
            + cost(drawn("rain"), self.streaks);
        let drops = cost(drawn("rain") && rungs[place("rain")] == 0, self.drop * drops);
        1e-6 * self.pixel_ns * (pixels * a_pixel + drops)
    }
}

/// Returns the rung that determines the cost while a part fades.
fn paid(part: &PartPlan) -> usize {
    ((1.0 - part.share) * (part.part.rungs.len() - 1) as f32) as usize
}

/// Returns the loss with parts at these rungs, as plan::choice defines it.
fn loss(plan: &Plan, rungs: &[usize]) -> f64 {
    plan.parts.iter().zip(rungs).map(|(part, rung)| part.part.importance * part.worth[*rung].p95).sum()
}

/// Every set of rungs of the parts that are there.
fn all_rungs(there: &[bool]) -> Vec<Vec<usize>> {
    PARTS.iter().zip(there).fold(vec![Vec::new()], |sets, (part, there)| {
        let rungs = if *there { part.rungs.len() } else { 1 };
        sets.iter().flat_map(|set| (0..rungs).map(|r| set.iter().copied().chain([r]).collect())).collect()
    })
}

/// Result of a device's frames once the plan has settled.
struct Settled {
    plan: Plan,
    ms: f64,
    drops: f64,
}

/// Draws frames of a new view, with the times of a device.
fn settled(bench: &mut Bench, shot: &PlanScene, profile: &Profile, budget_ms: f64, frames: u32) -> Settled {
    bench.start_anew();
    bench.view.set_budget(Budget { milliseconds: Some(budget_ms), ..Budget::default() }).unwrap();
    let (share, mut drops) = (bench.share_of_objects(), 0.0f64);
    let mut ms = 0.0;
    for _ in 0..frames {
        bench.draw(shot, true, FrameFlags(0));
        drops = drops.max(f64::from(bench.view.report().rain.drops));
        let plan = bench.view.plan();
        let rungs: Vec<usize> = plan.parts.iter().map(paid).collect();
        ms = profile.ms(share, drops, &there(plan), &rungs);
        bench.view.report_time(ms).unwrap();
    }
    Settled { plan: bench.view.plan().clone(), ms, drops }
}

fn there(plan: &Plan) -> Vec<bool> {
    plan.parts.iter().map(|p| p.reason != Reason::Absent).collect()
}

/// Asserts that the plan keeps its time if any set of rungs does, and that no set that fits with room to spare loses
/// less.
fn is_best(name: &str, profile: &Profile, share: f64, budget_ms: f64, of: &Settled) {
    let Settled { plan, drops, .. } = of;
    let there = there(plan);
    let missed = loss(plan, &plan.rungs());
    let fits = |rungs: &[usize], room: f64| profile.ms(share, *drops, &there, rungs) <= room * budget_ms;
    let better = |r: &[usize]| fits(r, 0.84) && loss(plan, r) < 0.999 * missed;
    let sets = all_rungs(&there);
    assert!(!sets.iter().any(|r| better(r)), "{name}: {:?} of {plan:?}", plan.rungs());
    let any_fits = sets.iter().any(|r| fits(r, 1.0));
    assert_eq!(plan.gave_way != GaveWay::Time, any_fits, "{name}: {plan:?}");
    assert!(!any_fits || of.ms <= budget_ms, "{name}: {:.3} of {budget_ms:.3} ms", of.ms);
}

#[test]
fn the_plan_for_each_device_loses_least_within_its_time() {
    let mut bench = Bench::new();
    let mut differ = Vec::new();
    // Important parts take 128 frames to fade.
    for (weather, far_m, frames) in [("rain", 300.0, 64), ("heavy_rain", 2000.0, 64), ("mist", 600.0, 160)] {
        let shot = PlanScene { weather, far_m, particles: true, pitch_deg: -3.0, ..PlanScene::yard() };
        bench.set(&shot);
        let share = bench.share_of_objects();
        let whole = [&SOFTWARE, &GPU].map(|device| settled(&mut bench, &shot, device, 1000.0, 16).ms);
        // Share of the time that all parts take.
        for time in [0.64, 0.5, 0.35] {
            let rungs = [(&SOFTWARE, whole[0]), (&GPU, whole[1])].map(|(device, whole)| {
                let got = settled(&mut bench, &shot, device, time * whole, frames);
                let name = format!("{weather}, {time} of {whole:.3} ms on {}", device.name);
                println!("{name}: {:?}, {:.2} of the budget", got.plan.rungs(), got.ms / (time * whole));
                is_best(&name, device, share, time * whole, &got);
                got.plan.rungs()
            });
            if rungs[0] != rungs[1] {
                differ.push(format!("{weather} {time}"));
            }
        }
        // A budget that leaves the fast device time to spare.
        let [slow, fast] = [&SOFTWARE, &GPU].map(|device| settled(&mut bench, &shot, device, 1.25 * whole[1], frames));
        assert!(fast.plan.gave_way == GaveWay::Nothing && fast.plan.rungs().iter().all(|r| *r == 0), "{:?}", fast.plan);
        assert_eq!(slow.plan.gave_way, GaveWay::Time);
    }
    println!("they differ in {differ:?}");
    assert!(differ.len() >= 3, "{differ:?}");
}
