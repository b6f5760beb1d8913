//! Cost per frame of rain, snow and their effect on the ground, on a software driver, in copies (see
//! [`crate::copies`]). It is compared with the same frame in dry weather, and without each of the stages that draw
//! them.

use std::sync::Arc;

use welkin::{
    frame::{Shared, Stages},
    gpu::Device,
    weather::{Precipitation, PrecipitationKind, Surface, SurfaceState, Weather},
};

use crate::copies::{Scene, measured, median, world};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Visibility apart from precipitation, m.
const VISIBILITY_M: f64 = 10_000.0;

/// A time at which no rain cone swaps its streaks, as in four of five frames, s; at time 0 one does.
const STEADY_S: f64 = 0.1;

fn falls(kind: PrecipitationKind, rate_mm_h: f64) -> Weather {
    Weather { visibility_m: VISIBILITY_M, precipitation: Precipitation::of(kind, rate_mm_h), ..Weather::default() }
}

fn lies(state: SurfaceState) -> Weather {
    let surface = Surface { state: Some(state), ..Surface::default() };
    Weather { visibility_m: VISIBILITY_M, surface, ..Weather::default() }
}

fn scenes(device: &Arc<Device>) -> Fallible<Vec<Scene>> {
    let shared = Arc::new(Shared::new(device)?);
    let all = Stages::ALL.without(Stages::TONE);
    let dry = Weather { visibility_m: VISIBILITY_M, ..Weather::default() };
    let mut made = vec![Scene::new("dry", &world(device, &shared, &dry, -60.0)?, 0.0)?];
    for (name, weather) in [
        ("rain of 5 mm/h", falls(PrecipitationKind::Rain, 5.0)),
        ("rain of 20 mm/h", falls(PrecipitationKind::Rain, 20.0)),
        ("rain of 60 mm/h", falls(PrecipitationKind::Rain, 60.0)),
        ("snowfall of 1 mm/h", falls(PrecipitationKind::Snow, 1.0)),
        ("snowfall of 5 mm/h", falls(PrecipitationKind::Snow, 5.0)),
        ("wet road", lies(SurfaceState::Wet)),
        ("standing water", lies(SurfaceState::StandingWater)),
        ("lying snow", lies(SurfaceState::Snow)),
    ] {
        let mut own = world(device, &shared, &weather, -60.0)?;
        Arc::get_mut(&mut own).ok_or("a new context")?.update(STEADY_S)?;
        made.push(Scene::new(name, &own, 0.0)?);
        if weather.precipitation.rate_mm_h > 0.0 {
            for (which, left) in [
                ("  without what falls", Stages::PARTICLES),
                ("  without what lies", Stages::SURFACE),
                ("  without both", Stages::PARTICLES.with(Stages::SURFACE)),
            ] {
                made.push(Scene { calls: vec![all.without(left)], ..Scene::new(which, &own, 0.0)? });
            }
        }
    }
    let exchanges = world(device, &shared, &falls(PrecipitationKind::Rain, 5.0), -60.0)?;
    let calls = vec![all.without(Stages::SURFACE)];
    let name = "rain of 5 mm/h while a cone exchanges its streaks, without what lies";
    made.push(Scene { calls, ..Scene::new(name, &exchanges, 0.0)? });
    Ok(made)
}

/// Prints the copies of each scene, and how many fewer the dry scene needs.
pub fn run() -> Fallible<()> {
    let mut scenes = measured(0.0, scenes)?;
    let dry = median(&mut scenes[0].copies);
    for scene in &mut scenes {
        let (copies, report) = (median(&mut scene.copies), scene.view.report());
        println!("  {}: {copies:.1}, {:.1} beyond dry; {} drops", scene.name, copies - dry, report.rain.drops);
    }
    Ok(())
}
