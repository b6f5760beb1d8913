//! Directions, distances and magnitudes of the planets as seen from the Earth.

use glam::DVec3;

use super::orbits::{EARTH, Orbit, PLANETS};
use crate::almanac::Utc;

/// Light time of an astronomical unit, days (IAU 2012).
const LIGHT_DAYS_PER_AU: f64 = 0.005_775_518_3;
/// Days a millennium.
const MILLENNIUM_DAYS: f64 = 365_250.0;

/// Planets that are drawn with the stars.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// Mercury.
    Mercury,
    /// Venus.
    Venus,
    /// Mars.
    Mars,
    /// Jupiter.
    Jupiter,
    /// Saturn, with its rings.
    Saturn,
    /// Uranus.
    Uranus,
}

/// All planets that are drawn, from the sun outwards.
pub const BODIES: [Body; 6] = [Body::Mercury, Body::Venus, Body::Mars, Body::Jupiter, Body::Saturn, Body::Uranus];

/// A planet as seen from the Earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanetPlace {
    /// Identity of the planet.
    pub body: Body,
    /// Unit vector from the Earth's centre in the equator and equinox of J2000.0, corrected for light time but without
    /// aberration.
    pub direction: DVec3,
    /// Distance from the Earth, au.
    pub distance_au: f64,
    /// Visual magnitude above the air.
    pub magnitude: f64,
}

/// Millennia of terrestrial time since J2000.0.
fn millennia(utc: Utc) -> f64 {
    utc.julian_centuries_tt() / 10.0
}

/// Direction of the sun from the Earth in the equator and equinox of J2000.0, within 10". The barycentre of Earth and
/// moon is used in place of the Earth's centre.
pub fn sun_direction(utc: Utc) -> DVec3 {
    -EARTH.heliocentric(millennia(utc)).normalize()
}

/// The Earth's orbital velocity divided by the speed of light, in the equator and equinox of J2000.0; it causes annual
/// aberration. Its length is about 1e-4. The error is below 1e-7, because the sun's own motion and the moon's pull on
/// the Earth are left out.
pub fn earth_velocity(utc: Utc) -> DVec3 {
    let (t, half_day) = (millennia(utc), 0.5 / MILLENNIUM_DAYS);
    (EARTH.heliocentric(t + half_day) - EARTH.heliocentric(t - half_day)) * LIGHT_DAYS_PER_AU
}

/// Planets at a time, from the sun outwards. Directions are within 0.03 degrees from 1950 to 2100, and magnitudes
/// within 0.03 of the formulas (tested against another almanac).
pub fn planets(utc: Utc) -> [PlanetPlace; 6] {
    let t = millennia(utc);
    let earth = EARTH.heliocentric(t);
    std::array::from_fn(|i| planet(BODIES[i], &PLANETS[i], t, earth))
}

fn planet(body: Body, orbit: &Orbit, t: f64, earth: DVec3) -> PlanetPlace {
    let now = orbit.heliocentric(t);
    // Position at the time when the light left. One iteration is enough, because no planet moves by more than 0.001 of
    // its distance meanwhile.
    let away = LIGHT_DAYS_PER_AU * (now - earth).length() / MILLENNIUM_DAYS;
    let from_sun = orbit.heliocentric(t - away);
    let from_earth = from_sun - earth;
    let magnitude = magnitude(body, from_sun, from_earth);
    PlanetPlace { body, direction: from_earth.normalize(), distance_au: from_earth.length(), magnitude }
}

/// Visual magnitude (Mallama and Hilton 2018, Astronomy and Computing 25, 10) of a body at `from_sun` and `from_earth`,
/// au. The rotation of Mars, which changes its magnitude by 0.06, is left out.
fn magnitude(body: Body, from_sun: DVec3, from_earth: DVec3) -> f64 {
    let (r, d) = (from_sun.length(), from_earth.length());
    let a = from_sun.angle_between(from_earth).to_degrees();
    let polynomial = |c: &[f64]| c.iter().rev().fold(0.0, |sum, k| sum * a + k);
    let of_phase = match body {
        Body::Mercury => polynomial(&[-0.613, 6.3280e-2, -1.6336e-3, 3.3644e-5, -3.4265e-7, 1.6893e-9, -3.0334e-12]),
        Body::Venus if a < 163.7 => polynomial(&[-4.384, -1.044e-3, 3.687e-4, -2.814e-6, 8.938e-9]),
        Body::Venus => polynomial(&[236.058_28, -2.819_14, 8.390_34e-3]),
        Body::Mars if a <= 50.0 => polynomial(&[-1.601, 0.022_67, -0.000_130_2]),
        Body::Mars => polynomial(&[-0.367, -0.025_73, 0.000_344_5]),
        Body::Jupiter => polynomial(&[-9.395, -3.7e-4, 6.16e-4]),
        Body::Saturn => {
            let tilt = ring_tilt(from_sun, from_earth).sin();
            -8.914 - 1.825 * tilt + 0.026 * a - 0.378 * tilt * (-2.25 * a).exp()
        }
        Body::Uranus => -7.110 - 0.000_84 * uranus_latitude_deg(from_sun, from_earth),
    };
    of_phase + 5.0 * (r * d).log10()
}

/// Latitude, on a planet with this pole, of the point that faces an observer who looks in `direction`, rad.
fn latitude_facing(pole: DVec3, direction: DVec3) -> f64 {
    -direction.normalize().dot(pole).clamp(-1.0, 1.0).asin()
}

/// Effective tilt of Saturn's rings, rad: the geometric mean of their tilts to sun and Earth; 0 if sun and Earth see
/// different faces.
fn ring_tilt(from_sun: DVec3, from_earth: DVec3) -> f64 {
    // North pole at J2000.0: right ascension 40.589, declination 83.537 degrees (Archinal et al. 2018).
    let pole = crate::almanac::celestial::equatorial_direction(40.589, 83.537);
    (latitude_facing(pole, from_sun) * latitude_facing(pole, from_earth)).max(0.0).sqrt()
}

/// Mean latitude of the points of Uranus that face sun and Earth, degrees.
fn uranus_latitude_deg(from_sun: DVec3, from_earth: DVec3) -> f64 {
    // North pole at J2000.0: right ascension 257.311, declination -15.175 degrees (Archinal et al. 2018).
    let pole = crate::almanac::celestial::equatorial_direction(257.311, -15.175);
    0.5 * (latitude_facing(pole, from_sun).abs() + latitude_facing(pole, from_earth).abs()).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::{super::orbits::ecliptic_to_equator, *};
    use crate::almanac::celestial::equatorial_direction;

    #[test]
    fn planets_stand_and_shine_as_another_almanac_has_them() {
        let (mut worst, mut worst_magnitude) = ([0.0f64; 6], [0.0f64; 6]);
        let lines = include_str!("testdata/planets.csv").lines().filter(|l| !l.starts_with('#')).skip(1);
        let mut count = 0;
        for line in lines {
            let (name, rest) = line.split_once(',').unwrap();
            let n: Vec<f64> = rest.split(',').map(|v| v.parse().unwrap()).collect();
            let i = BODIES.iter().position(|b| format!("{b:?}").to_lowercase() == name).unwrap();
            let place = planets(Utc(n[0]))[i];
            let apart = place.direction.angle_between(equatorial_direction(n[1], n[2])).to_degrees();
            worst[i] = worst[i].max(apart);
            worst_magnitude[i] = worst_magnitude[i].max((place.magnitude - n[3]).abs());
            assert!(apart < 0.03, "{line}: {apart} degrees apart");
            assert!((place.magnitude - n[3]).abs() < 0.03, "{line}: {}", place.magnitude);
            count += 1;
        }
        println!("worst directions, degrees: {worst:.4?}; magnitudes: {worst_magnitude:.3?}");
        assert_eq!(count, 6 * 56);
    }

    #[test]
    fn the_earth_moves_at_thirty_kilometres_a_second_across_the_way_to_the_sun() {
        for month in 0..24 {
            let utc = Utc(1.6e9 + 2.6e6 * f64::from(month));
            let speed = earth_velocity(utc).length() * 299_792.458;
            assert!((29.2..30.4).contains(&speed), "{speed} km/s");
            let (v, sun) = (earth_velocity(utc).normalize(), sun_direction(utc));
            assert!(v.dot(sun).abs() < 0.02, "across");
            // The Earth moves towards the sun's direction of three months before, west of the present one.
            assert!(v.dot((ecliptic_to_equator() * DVec3::Z).cross(sun)) < -0.9);
        }
    }
}
