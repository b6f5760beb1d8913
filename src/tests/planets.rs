//! The sun of a planet, in the light that queries answer with, and the figure of its world.

use std::sync::Arc;

use glam::DVec3;

use crate::{
    context::{Context, ContextDesc},
    gpu::{Device, DeviceOptions, Shared},
    light::luminance,
    planet::{Absorption, Planet, Rayleigh},
    scene::Figure,
    weather::Weather,
    world::GivenDirection,
};

/// Creates the context of a planet without haze, with the sun 50 degrees high.
fn context(planet: Planet) -> Context {
    let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
    let device = Device::headless(&options).unwrap();
    let shared = Arc::new(Shared::new(&device).unwrap());
    let mut context = Context::new(device, shared, ContextDesc { planet, ..ContextDesc::default() }).unwrap();
    context.set_weather(&Weather { visibility_m: 1e6, ..Weather::default() }, 0.0, 0.0).unwrap();
    context.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg: 50.0 })).unwrap();
    context
}

/// The Earth under a sun whose irradiance is the Earth's times a ratio at each wavelength.
fn under_sun(ratios: [f64; 3]) -> Planet {
    let earth = Planet::earth();
    Planet { solar_irradiance: std::array::from_fn(|i| earth.solar_irradiance[i] * ratios[i]), ..earth }
}

const PLACE: DVec3 = DVec3::new(0.0, 0.0, 2.0);

#[test]
fn a_planets_own_sun_lights_it() {
    let [earth, dim] = [[1.0; 3], [0.4; 3]].map(|ratios| context(under_sun(ratios)));
    let [lit, dimmed] = [&earth, &dim].map(|context| context.light_at(PLACE, 0.0).unwrap());
    let pairs = [
        ("the sun above the air", lit.sun.illuminance_lux, dimmed.sun.illuminance_lux),
        ("the moon above the air", lit.moon.illuminance_lux, dimmed.moon.illuminance_lux),
        ("the sun on the ground", lit.arriving.sun_lux, dimmed.arriving.sun_lux),
        ("the sky's light", lit.arriving.sky_lux, dimmed.arriving.sky_lux),
    ];
    let up = [DVec3::new(0.6, 0.0, 0.8)];
    let [seen, seen_dimmed] = [&earth, &dim].map(|context| context.sky_radiance(PLACE, &up, 0.0).unwrap()[0]);
    for (name, whole, part) in pairs.into_iter().chain([("the sky's radiance", seen, seen_dimmed)]) {
        for (whole, part) in whole.into_iter().zip(part) {
            // The night's light, below 0.01 lux, does not depend on the sun.
            assert!((part - 0.4 * whole).abs() < 1e-6 * whole + 0.01, "{name}: {part} of {whole}");
        }
    }
    // Without air, all light of a red sun arrives, and no other light.
    let none = [0.0; 3];
    let red = Planet {
        rayleigh: Rayleigh { scattering_per_m: none, ..Planet::earth().rayleigh },
        absorption: Absorption { extinction_per_m: none, ..Planet::earth().absorption },
        ..under_sun([1.0, 0.5, 0.25])
    };
    let light = context(red).light_at(PLACE, 0.0).unwrap();
    let [above, arriving] = [light.sun.illuminance_lux, light.arriving.sun_lux];
    assert!(above[0] > 1.3 * above[1] && above[1] > 1.3 * above[2], "{above:?}");
    assert!(luminance(&above) < 0.7 * luminance(&lit.sun.illuminance_lux), "{above:?}");
    for (above, arriving) in above.into_iter().zip(arriving) {
        assert!((arriving / above - 1.0).abs() < 0.01, "{arriving} of {above}");
    }
    assert!(luminance(&light.arriving.sky_lux) < 1e-3 * luminance(&arriving), "{:?}", light.arriving.sky_lux);
}

#[test]
fn a_world_lies_on_the_figure_of_its_planet_whoever_sets_it() {
    let small = Planet { bottom_radius_m: 3_389_500.0, top_radius_m: 3_489_500.0, ..Planet::earth() };
    let made = context(small).world().figure;
    assert_eq!(made, Figure::of_radius(small.bottom_radius_m));
    let mut changed = context(Planet::earth());
    assert_eq!(changed.world().figure, Figure::WGS84);
    let of_the_earth = changed.save().unwrap();
    changed.set_planet(&small).unwrap();
    assert_eq!(changed.world().figure, made);
    let of_the_small = changed.save().unwrap();
    changed.load(&of_the_earth).unwrap();
    assert_eq!(changed.world().figure, Figure::WGS84);
    changed.load(&of_the_small).unwrap();
    assert_eq!(changed.world().figure, made);
}
