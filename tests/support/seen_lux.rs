//! Illuminance of level ground by the sky, as a sum over the visible radiance.

use glam::DVec3;
use welkin::{context::Context, light::luminance};

/// Illuminance at a place at time 0, lux, from `rings` rings around the zenith with `turns` directions each.
pub fn seen_lux(context: &Context, place: DVec3, (rings, turns): (u32, u32)) -> f64 {
    let directions: Vec<DVec3> = (0..rings * turns)
        .map(|i| {
            // Every equal share of the light on level ground gets the same number of directions.
            let up2 = (f64::from(i / turns) + 0.5) / f64::from(rings);
            let (sine, cosine) = (f64::from(i % turns) * std::f64::consts::TAU / f64::from(turns)).sin_cos();
            let level = (1.0 - up2).sqrt();
            DVec3::new(level * sine, level * cosine, up2.sqrt())
        })
        .collect();
    let seen = context.sky_radiance(place, &directions, 0.0).unwrap();
    std::f64::consts::PI * seen.iter().map(luminance).sum::<f64>() / seen.len() as f64
}
