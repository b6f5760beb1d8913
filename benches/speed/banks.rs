//! Cost of fog banks: frames over level ground with weather regions of fog, in copies beyond the frame without them.

use std::sync::Arc;

use welkin::{
    frame::Shared,
    gpu::Device,
    regions::{RegionPlan, RegionShape, WeatherRegion},
    weather::{Fog, FogKind, Weather, WeatherParts},
};

use crate::copies::{Scene, measured, median, world};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// A bank 60 m high with its centre at a place.
fn bank(center_m: [f64; 2], half_m: [f64; 2]) -> WeatherRegion {
    let fog = Fog { top_m: Some(60.0), ..Fog::of(FogKind::Fog) };
    WeatherRegion {
        plan: RegionPlan {
            shape: RegionShape::Rectangle { half_m, corner_radius_m: 0.5 * half_m[0].min(half_m[1]) },
            center_m: [center_m[0], center_m[1], 0.0],
            perimeter_m: 300.0,
            ..RegionPlan::default()
        },
        has: WeatherParts::FOG,
        weather: Weather { visibility_m: 300.0, fog, ..Weather::default() },
        ..WeatherRegion::default()
    }
}

fn scenes(device: &Arc<Device>) -> Fallible<Vec<Scene>> {
    let shared = Arc::new(Shared::new(device)?);
    let eight = |apart_m: f64| -> Vec<WeatherRegion> {
        (0..8)
            .map(|i| bank([apart_m * (f64::from(i) - 3.5), 3000.0 + 900.0 * f64::from(i % 3)], [500.0, 400.0]))
            .collect()
    };
    let across = bank([0.0, 4000.0], [6000.0, 1500.0]);
    let mut made = Vec::new();
    for (name, regions) in [
        ("no region", vec![]),
        ("a bank behind the camera", vec![bank([0.0, -20_000.0], [3000.0, 1500.0])]),
        ("a bank across the picture", vec![across.clone()]),
        ("the camera inside a bank", vec![bank([0.0, 0.0], [3000.0, 1500.0])]),
        ("eight banks", eight(2000.0)),
        ("eight banks that overlap", eight(900.0)),
    ] {
        let mut own = world(device, &shared, &Weather::default(), -60.0)?;
        Arc::get_mut(&mut own).ok_or("a new context")?.set_weather_regions(&regions)?;
        made.push(Scene::new(name, &own, 0.0)?);
    }
    Ok(made)
}

/// Prints the copies of each scene, and what its regions add.
pub fn run() -> Fallible<()> {
    let mut clear = None;
    for mut scene in measured(0.0, scenes)? {
        let copies = median(&mut scene.copies);
        let none = *clear.get_or_insert(copies);
        println!("  {}: {copies:.1}, {:+.1}", scene.name, copies - none);
    }
    Ok(())
}
