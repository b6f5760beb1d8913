//! The moon by day: its disc stands in the bright sky with the light that it has by night.

use glam::DVec3;
use welkin::{context::GivenDirection, light::luminance, scene::Camera};

use crate::night::{Night, light};

const SIZE: (u32, u32) = (160, 90);

/// Light of the moon's disc in a picture of it, lux, and what arrives there by the query. Directions: azimuth and
/// elevation, degrees.
fn drawn_and_asked(sun: (f64, f64), moon: (f64, f64)) -> (f64, f64) {
    let given = |(azimuth_deg, elevation_deg)| Some(GivenDirection { azimuth_deg, elevation_deg });
    let mut night = Night::new(SIZE);
    night.context.set_sun(given(sun)).unwrap();
    night.context.set_moon(given(moon)).unwrap();
    let eye = DVec3::new(0.0, 0.0, 10.0);
    let scene = night.context.scene_at(eye, 0.0).unwrap();
    // Pixels of a third of a milliradian: the disc is 28 of them wide.
    let camera = Camera::look_to(eye, scene.moon.apparent, DVec3::Z, 0.03, 16.0 / 9.0, 0.1);
    let with = night.picture(&camera);
    night.context.set_moon(given((moon.0, -60.0))).unwrap();
    let without = night.picture(&camera);
    // Near the moon's disc the sky is drawn at every pixel; elsewhere it may be interpolated from the coarse grid,
    // within a thousandth.
    let differs = |a: [f32; 4], b: [f32; 4]| (0..3).any(|c| (a[c] - b[c]).abs() > 3e-3 * b[c]);
    let changed = (0..with.len()).filter(|i| differs(with[*i], without[*i])).count();
    assert!(changed < 800, "the disc has some 600 pixels, and {changed} are not those of a sky without it");
    (light(&with, &without, &camera, SIZE), luminance(&scene.ground.moon_lux))
}

#[test]
fn by_day_and_at_sunset_the_moons_disc_is_as_bright_as_by_night() {
    for (sun, moon) in [
        ((140.0, 30.0), (270.0, 40.0)),
        ((140.0, 30.0), (320.0, 10.0)),
        ((270.0, 0.0), (90.0, 15.0)),
        ((270.0, -3.0), (90.0, 20.0)),
    ] {
        let (drawn, asked) = drawn_and_asked(sun, moon);
        println!("sun {sun:?}, moon {moon:?}: {drawn:.5} of {asked:.5} lux");
        assert!((drawn / asked - 1.0).abs() < 0.04, "sun {sun:?}, moon {moon:?}: {drawn} lux of {asked}");
    }
}
