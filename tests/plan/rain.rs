//! Rain in the plan: drops, cones, a veil or nothing, as a picture needs it.

use welkin::{
    frame::FrameFlags,
    plan::{Budget, Reason, difference},
    rain::{RainModel, RainSettings},
    weather::Weather,
};
use welkin_support::accept;

use crate::{
    SETTLED,
    scenes::{Bench, PlanScene, SIZE},
};

/// Index of the rain among the parts; the constants below are its rungs.
const RAIN: usize = 3;
const CONES: usize = 1;
const VEIL: usize = 2;
/// Rungs with the rain at `rung` and all other parts drawn in full.
const fn rain_at(rung: usize) -> [usize; 4] {
    [0, 0, 0, rung]
}
/// Presets in which rain falls.
const RAINY: [&str; 6] = ["drizzle", "rain", "heavy_rain", "showers", "thunderstorm", "freezing_rain"];

fn rainy(seed: u64) -> PlanScene {
    let weather = RAINY[seed as usize % RAINY.len()];
    let tolerance = [0.002, 0.005, 0.01, 0.02][(seed / 6) as usize % 4];
    let shot = PlanScene::seeded(seed);
    // No rain falls high above the ground.
    let height_m = shot.height_m.min(30.0);
    let name = format!("{weather} seed {seed}");
    let far_m = shot.far_m.min(2000.0);
    PlanScene { name, weather, tolerance, height_m, far_m, particles: true, ..shot }
}

/// Mean and deviation from pixel to pixel of blocks of 24 x 18 pixels, divided by the block's mean plus a hundredth of
/// white.
fn textures(pictures: &[Vec<f64>]) -> Vec<[f64; 2]> {
    let (across, down) = (SIZE.0 as usize / 24, SIZE.1 as usize / 18);
    let block = |picture: &[f64], b: usize| {
        let of = |i: usize| picture[(b / across * 18 + i / 24) * SIZE.0 as usize + b % across * 24 + i % 24];
        let values: Vec<f64> = (0..24 * 18).map(of).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        [mean, values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64]
    };
    let over = |b: usize| {
        let all: Vec<[f64; 2]> = pictures.iter().map(|p| block(p, b)).collect();
        let mean = |k: usize| all.iter().map(|v| v[k]).sum::<f64>() / all.len() as f64;
        [mean(0), mean(1).sqrt()]
    };
    (0..across * down).map(over).collect()
}

/// 95th percentile over blocks of the difference of two textures.
fn apart(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let mut all: Vec<f64> =
        a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) / (b[0] + 0.01)).collect();
    all.sort_by(f64::total_cmp);
    all[all.len() * 95 / 100]
}

#[test]
fn rain_is_drawn_as_the_picture_needs_it() {
    let mut bench = Bench::new();
    let scenes = if accept() { 36 } else { 24 };
    let (mut veiled, mut on_cones, mut dropped, mut beyond) = (0, 0, 0, Vec::new());
    for seed in 0..scenes {
        let shot = rainy(seed);
        bench.set(&shot);
        let everything = bench.everything(&shot);
        let (_, plan) = bench.planned(&shot, SETTLED);
        let veil = bench.pinned(&shot, &rain_at(VEIL));
        let d = difference(&veil, &everything, 1.0).unwrap();
        let (rain, worth) = (plan.parts[RAIN], plan.parts[RAIN].last());
        println!(
            "{}: tolerance {}, a veil errs by {:.4} ({:.3}), estimated {:.4} ({:.3}); {} {:?}",
            shot.name, shot.tolerance, d.p95, d.worst, worth.p95, worth.worst, rain.rung, rain.reason
        );
        assert!(rain.reason != Reason::Absent);
        if rain.rung == VEIL {
            veiled += 1;
            if d.p95 > shot.tolerance || d.worst > 12.0 * shot.tolerance {
                beyond.push(format!("{}: {d:?} {worth:?}", shot.name));
            }
        } else if worth.bound < 0.5 * shot.tolerance {
            panic!("{}: streaks that nobody sees are drawn, {plan:?}", shot.name);
        }
        // The closed form covers neither splashes nor single streaks.
        if d.p95 > 0.001 {
            assert!((0.75..1.4).contains(&(worth.p95 / d.p95)), "{}: {d:?} {worth:?}", shot.name);
        }
        on_cones += u32::from(rain.rung == CONES);
        dropped += u32::from(rain.rung == 0);
    }
    println!("{veiled} as a veil, {on_cones} on cones, {dropped} drop by drop");
    assert!(veiled > 2 && on_cones > 1 && dropped > 0, "{veiled} {on_cones} {dropped}");
    assert!(20 * beyond.len() <= veiled.max(20), "{beyond:?}");
}

/// Cones are chosen where their texture is like that of drops.
#[test]
fn cones_in_place_of_drops_keep_the_tolerance_as_textures() {
    let mut bench = Bench::new();
    for seed in [1, 2, 9] {
        let shot =
            PlanScene { tolerance: 0.01, height_m: 2.0, sun_deg: 30.0, far_m: 80.0, fov_deg: 50.0, ..rainy(seed) };
        bench.set(&shot);
        // Both at the same moments, because curtains of rain pass.
        let mut pictures = [vec![], vec![]];
        for _ in 0..8 {
            bench.pass(1.3);
            for (rung, pictures) in [0, CONES].into_iter().zip(&mut pictures) {
                pictures.push(bench.pinned(&shot, &rain_at(rung)));
            }
        }
        let [drops, cones] = pictures.map(|p| textures(&p));
        let error = apart(&cones, &drops);
        bench.view.set_budget(Budget::default()).unwrap();
        let (_, plan) = bench.planned(&shot, SETTLED);
        println!("{}: textures {error:.4} apart, estimated {:.4}", shot.name, plan.parts[RAIN].worth[CONES].p95);
        assert!(error <= shot.tolerance, "{}: {error}", shot.name);
    }
}

/// A contrast gain makes streaks matter more, and the plan accounts for it.
#[test]
fn the_plan_counts_the_contrast_gain_of_streaks() {
    let mut bench = Bench::new();
    for seed in [1, 2, 7] {
        let shot =
            PlanScene { tolerance: 0.5, height_m: 2.0, sun_deg: 30.0, far_m: 300.0, fov_deg: 50.0, ..rainy(seed) };
        bench.set(&shot);
        let mut found = [RainSettings::default(), RainSettings::TRAINER].map(|settings| {
            bench.view.set_rain(settings).unwrap();
            bench.plain.set_rain(settings).unwrap();
            let everything = bench.everything(&shot);
            let (_, plan) = bench.planned(&shot, SETTLED);
            let error = difference(&bench.pinned(&shot, &rain_at(VEIL)), &everything, 1.0).unwrap().p95;
            bench.view.set_budget(Budget::default()).unwrap();
            (error, plan.parts[RAIN].last().p95)
        });
        println!("{}: (found, expected) {found:?}", shot.name);
        for (error, expected) in &mut found {
            assert!((0.75..1.4).contains(&(*expected / *error)), "{}: {expected} expected, {error}", shot.name);
        }
        assert!(found[1].1 > 2.5 * found[0].1, "{}: {found:?}", shot.name);
    }
}

#[test]
fn a_model_of_the_hosts_own_choice_is_not_the_plans() {
    let mut bench = Bench::new();
    let shot = PlanScene { weather: "rain", tolerance: 0.3, particles: true, ..PlanScene::yard() };
    bench.set(&shot);
    let settings = RainSettings { model: RainModel::Drops, ..RainSettings::default() };
    bench.view.set_rain(settings).unwrap();
    let (_, plan) = bench.planned(&shot, SETTLED);
    assert_eq!(plan.parts[RAIN].reason, Reason::Absent);
    assert!(bench.view.report().rain.drops > 0);
    bench.view.set_rain(RainSettings::default()).unwrap();
    let (_, plan) = bench.planned(&shot, 3 * SETTLED);
    assert_eq!(plan.parts[RAIN].reason, Reason::WithinTolerance, "{plan:?}");
    assert!(bench.view.report().rain.drops == 0 && plan.parts[RAIN].share == 0.0);
    // No rain at all: the fog omits the rain's extinction too.
    assert_eq!(plan.parts[1].reason, Reason::WithinTolerance);
    // A picture that may not depend on earlier frames is drawn with every part.
    bench.draw(&shot, true, FrameFlags::NO_HISTORY);
    assert!(bench.view.report().rain.drops > 0);
}

#[test]
fn dry_air_has_no_rain_to_leave_out() {
    let mut bench = Bench::new();
    let shot = PlanScene { weather: "overcast", ..rainy(1) };
    assert!(Weather::preset("overcast").unwrap().precipitation == Default::default());
    bench.set(&shot);
    let (_, plan) = bench.planned(&shot, SETTLED);
    assert_eq!((plan.parts[RAIN].reason, plan.parts[RAIN].work > 0.0), (Reason::Absent, true));
}
