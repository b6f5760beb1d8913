//! Patches of fog that lag where the wind is slow: the mean over a ray by parts against a fine sum over its points.

use glam::{DMat3, DVec2, DVec3};
use std::sync::Arc;

use crate::{
    fog::{FogLayer, FogLight, FogModel, Law, Patches, Viewpoint, patterns::patch_mean},
    wind::{DetourMap, WindGrid, WindGridKind, WindVolume},
};

/// Wind to the east at 5 m/s, except for slow air behind a house 80 m ahead that is `width_m` wide.
fn lee(width_m: f64) -> WindVolume {
    let (nodes, cell_m) = ([81, 81, 5], DVec3::new(4.0, 4.0, 6.0));
    let origin = DVec3::new(-160.0, -80.0, 0.0);
    let speed = |i: u32| {
        let at = origin + DVec3::new(f64::from(i % 81), f64::from(i / 81 % 81), 0.0) * cell_m;
        let is_behind = (0.0..50.0).contains(&at.x) && (at.y - 80.0).abs() < 0.5 * width_m;
        [if is_behind { 0.5 } else { 5.0 }, 0.0, 0.0]
    };
    let velocities_m_s = (0..81 * 81 * 5).map(speed).collect();
    let grid = WindGrid { origin, cell_m, nodes, kind: WindGridKind::Whole, velocities_m_s };
    WindVolume::of_grid(&grid, DMat3::IDENTITY)
}

/// Fog patches of this size round the camera without a detour, and with the detour of the wind of [`lee`].
fn models(size_m: f64, width_m: f64) -> [FogModel; 2] {
    let patches = Patches { amount: 1.0, size_m, seed: 5, drift_m: [0.0; 2] };
    let layer = FogLayer { patches: Some(patches), ..FogLayer::ground_fog(0.01, 20.0, 1.0) };
    let light =
        FogLight { to_sun: DVec3::Z, sun_irradiance: [1.0; 3], sky_irradiance: [0.2; 3], ground_albedo: [0.1; 3] };
    let free = FogModel::new(&Law::Layer(layer), &light, &Viewpoint::flat(2.0)).expect("a fog");
    let map = DetourMap::new(&lee(width_m), &|_| 0.0, &|_| DVec2::ZERO, size_m).map(Arc::new).expect("wind");
    let mut led = free.clone();
    led.set_detour(Some(map.about(DVec3::new(0.0, 0.0, 2.0))));
    [free, led]
}

/// Mean of the pattern over many points of a ray, each shifted by its own lag.
fn by_points(m: &FogModel, direction: DVec3, length: f64) -> f64 {
    const POINTS: usize = 2000;
    let detour = m.detour.as_ref().expect("led");
    let [enters, leaves] = detour.over(DVec3::ZERO, direction);
    let value = |i: usize| {
        let range = (i as f64 + 0.5) / POINTS as f64 * length;
        let place = direction * range;
        let lag = if (enters..leaves).contains(&range) { detour.lag_m(place) } else { DVec2::ZERO }.extend(0.0);
        let row = |k: DVec3| 8.0 / (8.0 + k.length() * 0.5 * length);
        m.patch_waves.iter().map(|(k, phase)| (phase + k.dot(place + lag)).cos() * row(*k)).sum::<f64>()
    };
    (1.0 + m.patch_amount * 0.5 * (0..POINTS).map(value).sum::<f64>() / POINTS as f64).max(0.0)
}

#[test]
fn parts_of_a_ray_are_nearly_as_good_as_points() {
    for (size_m, width_m, most) in [(12.0, 20.0, 0.02), (120.0, 20.0, 0.02), (200.0, 40.0, 0.02)] {
        let [free, led] = models(size_m, width_m);
        let (mut errors, mut changes) = (Vec::new(), Vec::new());
        for i in 0..400 {
            let azimuth = f64::from(i % 80) * 0.02 - 0.8;
            let direction = DVec3::new(azimuth.sin(), azimuth.cos(), 0.0);
            let length = 60.0 + 60.0 * f64::from(i / 80);
            let got = patch_mean(&led, DVec3::ZERO, direction, 0.0, length);
            errors.push((got - by_points(&led, direction, length)).abs());
            changes.push((got - patch_mean(&free, DVec3::ZERO, direction, 0.0, length)).abs());
        }
        let p95 = |of: &mut Vec<f64>| {
            of.sort_by(f64::total_cmp);
            of[of.len() * 95 / 100]
        };
        let worst = errors.iter().copied().fold(0.0, f64::max);
        let (error, change) = (p95(&mut errors), p95(&mut changes));
        println!(
            "patches of {size_m} m, house of {width_m} m: off {error:.4} at p95, {worst:.4} at worst; changed by {change:.3}"
        );
        assert!(error < most && change > 2.0 * error, "{size_m}: {error} {change}");
    }
}
