//! Sand, dust and snow that the wind lifts: their mean density is the reported one, and gusts move with the wind.

use glam::DVec3;
use welkin::{
    context::GivenDirection,
    frame::Stages,
    weather::{Lofted, LoftedKind, Weather, Wind, derive},
};
use welkin_support::rain_scene::{Host, upright};

use crate::{
    drops::WHITE,
    pictures::{paint, save},
};

fn blowing(kind: LoftedKind, visibility_m: f64, wind_m_s: f64) -> Weather {
    let wind = Wind { turbulence_intensity: Some(0.2), ..Wind::of(wind_m_s, 270.0) };
    Weather { lofted: Lofted::of(kind), wind, visibility_m, relative_humidity: 0.2, ..Weather::default() }
}

/// Optical depth of the ground layer from `eye` to a wall 60 m east of it, by the share of the wall's light that
/// arrives at night.
fn depth(host: &mut Host, eye: DVec3) -> f64 {
    host.boxes = vec![upright([eye.x + 60.0, eye.y, eye.z], [1.0, 500.0, 500.0])];
    host.look(eye, DVec3::X);
    host.draw(|_, _| [WHITE; 3]);
    host.record(Stages::PREPARE.with(Stages::MEDIUM)).unwrap();
    let middle = (host.size.0 * (host.size.1 / 2) + host.size.0 / 2) as usize;
    -(f64::from(host.pixels()[middle][1]) / WHITE).ln()
}

#[test]
fn lifted_sand_is_as_dense_as_reported_on_the_mean_and_its_gusts_go_with_the_wind() {
    let mut host = Host::new((32, 18));
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: -40.0 })).unwrap();
    for (i, (wind, uneven)) in [(18.0, true), (3.0, false)].into_iter().enumerate() {
        let start = 1e4 * (i + 1) as f64;
        let weather = blowing(LoftedKind::BlowingSand, 800.0, wind);
        host.context.set_weather(&weather, start, 0.0).unwrap();
        let wanted = derive(&weather).unwrap().extinction_per_m * 59.0;
        let mut seen = Vec::new();
        for k in 0..60 {
            host.context.update(start + 17.0 * f64::from(k)).unwrap();
            seen.push(depth(&mut host, DVec3::new(0.0, 0.0, 1.7)));
        }
        let mean = seen.iter().sum::<f64>() / seen.len() as f64;
        let deviation = (seen.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / seen.len() as f64).sqrt();
        println!("wind {wind}: depth {mean:.4} +- {deviation:.4} of {wanted:.4}");
        assert!((mean / wanted - 1.0).abs() < if uneven { 0.2 } else { 0.01 }, "{wind}: {mean} of {wanted}");
        assert_eq!(deviation > 0.2 * mean, uneven, "{wind}: {deviation} about {mean}");
        // An observer who moves with the air sees the same gust all the time.
        let t = start + 2000.0;
        host.context.update(t).unwrap();
        let (air, here) = (host.context.wind_displacement(t).unwrap(), depth(&mut host, DVec3::new(0.0, 0.0, 1.7)));
        for later in [0.5, 4.0, 30.0] {
            host.context.update(t + later).unwrap();
            let moved = host.context.wind_displacement(t + later).unwrap() - air;
            let with_it = depth(&mut host, moved + DVec3::Z * 1.7);
            assert!((with_it / here - 1.0).abs() < 0.02, "{wind} m/s, {later} s: {with_it} of {here}");
        }
    }
}

#[test]
fn pictures_of_blowing_sand_dust_and_snow() {
    let mut host = Host::new((480, 270));
    host.boxes = (0..12)
        .map(|i| {
            let y = 15.0 + 25.0 * f64::from(i);
            upright([if i % 2 == 0 { -9.0 } else { 9.0 }, y, 3.0], [2.0, 2.0, 3.0])
        })
        .collect();
    for (i, (kind, visibility, wind, height, name)) in [
        (LoftedKind::BlowingSand, 800.0, 16.0, 1.7, "blowing_sand"),
        (LoftedKind::BlowingSand, 250.0, 24.0, 1.7, "sand_storm"),
        (LoftedKind::BlowingDust, 1500.0, 14.0, 1.7, "blowing_dust"),
        (LoftedKind::DriftingDust, 9000.0, 10.0, 2.5, "drifting_sand"),
        (LoftedKind::BlowingSnow, 400.0, 14.0, 1.7, "blowing_snow"),
    ]
    .into_iter()
    .enumerate()
    {
        let t = 100.0 * (i + 1) as f64;
        host.context.set_weather(&blowing(kind, visibility, wind), t, 0.0).unwrap();
        host.context.update(t + 3.0).unwrap();
        host.look(DVec3::new(0.5, 0.0, height), DVec3::new(0.05, 1.0, -0.06));
        paint(&host);
        host.record(Stages::ALL).unwrap();
        let pixels = save(&host, &format!("lifted_{name}.png"));
        assert!(pixels.iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
    }
}
