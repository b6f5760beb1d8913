//! The moon over a place: its position, its phase, and the illuminance that it gives.

use glam::DVec3;

use super::ephemeris::Geocentric;
use super::sun::{Topocentric, Utc};
use crate::{
    error::Result,
    scene::{Place, angle_between},
};

/// Radius of the moon, m (IAU 2015 mean).
const MOON_RADIUS_M: f64 = 1.7374e6;

/// Position and light of the moon over a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoonPosition {
    /// Unit vector towards the moon, (east, north, up), topocentric, without refraction.
    pub direction: DVec3,
    /// Azimuth, degrees clockwise from true north.
    pub azimuth_deg: f64,
    /// Elevation above the horizon, degrees, topocentric, without refraction.
    pub elevation_deg: f64,
    /// Distance from the place, m.
    pub distance_m: f64,
    /// Angular radius, rad.
    pub angular_radius: f64,
    /// Angle sun - moon - observer, rad: 0 at full moon, pi at new moon.
    pub phase_angle: f64,
    /// Lit share of the disc, 0 to 1.
    pub illuminated: f64,
    /// Unit vector in the plane of the disc towards the middle of the lit limb, (east, north, up). If the sun, the moon
    /// and the place lie on one line, it has any direction in that plane.
    pub bright_limb: DVec3,
    /// Illuminance above the air on a surface facing the moon, lux.
    pub illuminance_lux: f64,
}

/// Returns the position and light of the moon over `place` at `utc`, within 0.01 degrees.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] for a place or time out of range.
pub fn moon_position(utc: Utc, place: &Place) -> Result<MoonPosition> {
    place.validate()?;
    Ok(lit(&Topocentric::new(&Geocentric::at(utc)?, utc, place)))
}

/// Returns the position, phase and illuminance of the moon over a place.
pub(crate) fn lit(turned: &Topocentric) -> MoonPosition {
    let seen = turned.moon_m;
    let direction = seen.normalize();
    let distance_m = seen.length();
    let to_sun = turned.sun_m - seen;
    let phase_angle = angle_between(to_sun, -seen);
    let in_disc = to_sun - direction * to_sun.dot(direction);
    let azimuth = libm::atan2(direction.x, direction.y).to_degrees().rem_euclid(360.0);
    MoonPosition {
        direction,
        azimuth_deg: azimuth,
        elevation_deg: libm::asin(direction.z).to_degrees(),
        distance_m,
        angular_radius: libm::asin(MOON_RADIUS_M / distance_m),
        phase_angle,
        illuminated: 0.5 * (1.0 + libm::cos(phase_angle)),
        bright_limb: in_disc.normalize_or(direction.any_orthonormal_vector()),
        illuminance_lux: moon_illuminance_lux(phase_angle, distance_m),
    }
}

/// Returns the moon's illuminance above the air on a surface facing it, lux, at a phase angle, rad, and a distance, m.
/// At the mean distance, 384,400 km, the magnitude is V = -12.73 + 0.026 |a| + 4e-9 a^4 with the phase angle a in
/// degrees (Krisciunas & Schaefer 1991, eq. 9, with Allen's magnitude of the full moon). One lux is magnitude -14.18.
pub fn moon_illuminance_lux(phase_angle: f64, distance_m: f64) -> f64 {
    let a = phase_angle.abs().to_degrees();
    let magnitude = -12.73 + 0.026 * a + 4e-9 * a.powi(4);
    libm::exp10(-0.4 * (magnitude + 14.18)) * (384.4e6 / distance_m).powi(2)
}

#[cfg(test)]
mod tests {
    use super::super::sun::sun_position;
    use super::*;

    #[test]
    fn the_moons_place_and_phase_agree_with_another_almanac() {
        // Values of XEphem's libastro, topocentric, pressure 0: (utc, latitude, longitude, azimuth, elevation, lit
        // percent).
        let cases = include!("testdata/moon.in");
        for (unix, latitude_deg, longitude_deg, azimuth, elevation, percent) in cases {
            let place = Place { latitude_deg, longitude_deg, altitude_m: 0.0 };
            let moon = moon_position(Utc(unix), &place).unwrap();
            let apart = moon.direction.angle_between(super::super::sun::direction(azimuth, elevation)).to_degrees();
            assert!(apart < 0.02, "{unix}: {moon:?} is {apart} degrees from {azimuth} {elevation}");
            // That almanac gives the phase as seen from the Earth's centre. The moon's parallax, up to 0.95 degrees,
            // changes the lit share by up to 0.8 %.
            assert!((moon.illuminated * 100.0 - percent).abs() < 0.9, "{moon:?} {percent}");
        }
    }

    #[test]
    fn the_lit_limb_faces_the_sun_and_the_full_moon_gives_a_quarter_lux() {
        let place = Place { latitude_deg: 50.0, longitude_deg: 10.0, altitude_m: 0.0 };
        for day in 0..60 {
            let utc = Utc(1.7e9 + 86_400.0 * f64::from(day));
            let (moon, sun) = (moon_position(utc, &place).unwrap(), sun_position(utc, &place).unwrap());
            assert!(moon.bright_limb.dot(sun.direction) > 0.0 && moon.bright_limb.dot(moon.direction).abs() < 1e-9);
        }
        assert!((moon_illuminance_lux(0.0, 384.4e6) - 0.263).abs() < 0.01);
        assert!(moon_illuminance_lux(3.1, 384.4e6) < 1e-3);
    }
}
