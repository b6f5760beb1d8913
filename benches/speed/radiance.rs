//! Cost of the sky's radiance as a query on one thread: for a new air, and then for each direction.

use std::{sync::Arc, time::Instant};

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::Shared,
    gpu::{Device, DeviceOptions},
    weather::Weather,
};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Directions for a call, spread over the upper half (`above`) or the lower one.
fn directions(above: bool) -> Vec<DVec3> {
    let toward = |i: u32| {
        let z = (f64::from(i) + 0.5) / 256.0;
        let (s, c) = (2.399_963_23 * f64::from(i)).sin_cos();
        let level = (1.0 - z * z).sqrt();
        DVec3::new(level * c, level * s, if above { z } else { -z })
    };
    (0..256).map(toward).collect()
}

fn ms_each(context: &Context, height_m: f64, above: bool) -> Fallible<f64> {
    let (at, list) = (DVec3::new(0.0, 0.0, height_m), directions(above));
    let time = || -> Fallible<f64> {
        let start = Instant::now();
        context.sky_radiance(at, &list, 0.0)?;
        Ok(start.elapsed().as_secs_f64() * 1e3 / list.len() as f64)
    };
    // The first call fills the tables of the light from the ground.
    time()?;
    Ok((0..3).map(|_| time()).collect::<Fallible<Vec<_>>>()?.into_iter().fold(f64::INFINITY, f64::min))
}

/// Prints the time for a new air in s, and the time per direction in ms.
pub fn run() -> Fallible<()> {
    let device = Device::headless(&DeviceOptions { backends: wgpu::Backends::NOOP, ..Default::default() })?;
    let shared = Arc::new(Shared::new(&device)?);
    let mut context = Context::new(device, shared, ContextDesc::default())?;
    for name in ["clear", "hazy", "overcast", "rain"] {
        context.set_weather(&Weather::preset(name)?, 0.0, 0.0)?;
        context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 30.0 }))?;
        context.set_moon(Some(GivenDirection { azimuth_deg: 20.0, elevation_deg: 30.0 }))?;
        let start = Instant::now();
        context.sky_radiance(DVec3::ZERO, &[DVec3::NEG_Z], 0.0)?;
        let first = start.elapsed().as_secs_f64();
        let mut each = Vec::new();
        for elevation_deg in [30.0, -12.0] {
            context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg }))?;
            for (height_m, above) in [(2.0, true), (2.0, false), (3000.0, false)] {
                each.push(ms_each(&context, height_m, above)?);
            }
        }
        println!(
            "radiance, {name}: a new air {first:.2} s; a direction by day {:.2} ms above the horizon, {:.2} ms below it, {:.2} ms \
             below it from 3 km; by moonlight {:.2}, {:.2}, {:.2} ms",
            each[0], each[1], each[2], each[3], each[4], each[5]
        );
    }
    Ok(())
}
