//! Queries against each other, against known light, and against the drawn picture.

use glam::DVec3;
use welkin::{
    context::{ContextDesc, GivenDirection},
    weather::{Fog, FogKind, Weather},
};

use crate::host::Host;

fn host() -> Host {
    Host::new(wgpu::TextureFormat::Rgba16Float)
}

#[test]
fn visibility_between_two_points_is_the_reported_one() {
    let mut host = host();
    for (i, v) in [150.0, 1500.0, 8000.0, 30_000.0].into_iter().enumerate() {
        let fog = if v < 1000.0 { FogKind::Fog } else { FogKind::None };
        let weather = Weather { visibility_m: v, fog: Fog::of(fog), ..Weather::default() };
        host.context.set_weather(&weather, i as f64, 0.0).unwrap();
        host.context.update(i as f64).unwrap();
        let between = host.context.between(DVec3::new(0.0, 0.0, 1.0), DVec3::new(0.0, v, 1.0)).unwrap();
        // The planet curves below the level line: at 30 km its end is 70 m up, in thinner haze.
        assert!((between.visibility_m / v - 1.0).abs() < 0.05, "{v}: {between:?}");
        assert!((between.transmittance[1] / 0.05 - 1.0).abs() < 0.15, "{v}: {between:?}");
    }
}

#[test]
fn ambient_light_agrees_with_the_light_on_level_ground() {
    let mut host = host();
    for elevation_deg in [60.0, 20.0] {
        host.context.set_sun(Some(GivenDirection { azimuth_deg: 90.0, elevation_deg })).unwrap();
        let light = host.context.light_at(DVec3::ZERO).unwrap();
        let sh = host.context.ambient_at(DVec3::ZERO).unwrap();
        let pi = std::f32::consts::PI;
        let level = |up: f32| {
            pi * sh[0][1] * 0.282_095
                + up * 2.0 * pi / 3.0 * sh[2][1] * 0.488_603
                + pi / 4.0 * sh[6][1] * 0.315_392 * 2.0
        };
        let want = light.arriving.sky_lux[1] as f32;
        assert!((level(1.0) / want - 1.0).abs() < 0.25, "{elevation_deg}: {} against {want} lux", level(1.0));
        assert!(sh[3][1] > 0.0, "the sky is brighter towards the sun in the east");
    }
}

#[test]
fn a_saved_context_goes_on_alike_and_channels_agree() {
    let mut a = host();
    let fog = Weather { visibility_m: 300.0, fog: Fog::of(FogKind::Fog), ..Weather::default() };
    a.context.set_weather(&fog, 5.0, 60.0).unwrap();
    a.context.update(20.0).unwrap();
    let state = a.context.save().unwrap();
    let mut b = host();
    assert_ne!(a.context.state_hash().unwrap(), b.context.state_hash().unwrap());
    b.context.load(&state).unwrap();
    for host in [&mut a, &mut b] {
        host.context.update(40.0).unwrap();
    }
    assert_eq!(a.context.state_hash().unwrap(), b.context.state_hash().unwrap());
    assert_eq!(a.context.conditions_at(50.0).unwrap(), b.context.conditions_at(50.0).unwrap());
    let before = b.context.state_hash().unwrap();
    for damaged in [&state[..20], b"nonsense".as_slice(), &[0xff, 0xfe]] {
        assert!(b.context.load(damaged).is_err());
    }
    assert_eq!(b.context.state_hash().unwrap(), before, "a refused load changes nothing");
    assert!(b.context.update(30.0).is_err(), "time does not run back");
    assert!(b.context.set_weather(&fog, 10.0, 0.0).is_err(), "the past cannot be changed");
    assert!(ContextDesc::default().world.validate().is_ok());
}
