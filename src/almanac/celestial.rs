//! Orientation of the starry sky over a place: sidereal time, precession, nutation.
//!
//! Sines and cosines come from `libm`, which gives the same bits on every machine. The sun's series
//! (`ephemeris.rs`) uses the platform's, so its directions agree between machines to 1e-14 only.

use glam::{DMat3, DVec3};

use super::time::{UTC_RANGE_S, Utc};
use crate::{
    error::{Result, check_range},
    numerics::smooth,
    scene::{Place, turn_x, turn_y, turn_z},
};

/// One arc second, degrees.
const ARC_SECOND_DEG: f64 = 1.0 / 3600.0;

/// Returns the nutation in longitude and true obliquity of the ecliptic, rad, at `t` centuries of TT since J2000
/// (Meeus, Astronomical Algorithms, chapter 22). Of each series only the two leading terms are used, so the result is
/// within 0.5".
pub(crate) fn nutation_obliquity(t: f64) -> (f64, f64) {
    let node = (125.044_52 - 1_934.136_261 * t).to_radians();
    let sun = (280.466_5 + 36_000.769_8 * t).to_radians();
    let arc_seconds = -17.20 * libm::sin(node) - 1.32 * libm::sin(2.0 * sun);
    let obliquity = mean_obliquity_deg(t) + (9.20 * libm::cos(node) + 0.57 * libm::cos(2.0 * sun)) * ARC_SECOND_DEG;
    ((arc_seconds * ARC_SECOND_DEG).to_radians(), obliquity.to_radians())
}

/// Returns the mean obliquity, degrees, at `t` centuries of TT since J2000 (Lieske et al. 1977 to first order). The
/// terms left out are 0.001" in 2100, 0.01" in 2200 and 2" in 3000; they grow with the cube of the time.
fn mean_obliquity_deg(t: f64) -> f64 {
    23.439_291_1 - 0.013_004_2 * t
}

/// Returns the mean sidereal time at Greenwich, rad in [0, 2 pi) (Aoki et al. 1982; Meeus eq. 12.4).
pub fn mean_sidereal_time(utc: Utc) -> f64 {
    let days = utc.julian_date() - 2_451_545.0;
    let t = days / 36_525.0;
    // Whole days are whole turns and are dropped. With them the angle would be about 366 times as large and lose eight
    // bits.
    let turns = 360.0 * days.rem_euclid(1.0) + 0.985_647_366_29 * days;
    (280.460_618_37 + turns + t * t * (0.000_387_933 - t / 38_710_000.0)).rem_euclid(360.0).to_radians()
}

/// Returns the apparent sidereal time at Greenwich, rad: the mean one plus the equation of the equinoxes. May lie
/// slightly outside [0, 2 pi).
pub fn apparent_sidereal_time(utc: Utc) -> f64 {
    let (nutation, obliquity) = nutation_obliquity(utc.julian_centuries_tt());
    mean_sidereal_time(utc) + nutation * libm::cos(obliquity)
}

/// Returns the rotation from the equator and equinox of J2000.0 to those of date, at `t` centuries of TT since J2000:
/// precession (Lieske 1977, IAU 1976; Meeus eq. 21.3). Accurate to an arc second within two centuries of 2000.
fn precession(t: f64) -> DMat3 {
    let angle = |a: f64, b: f64, c: f64| (t * (a + t * (b + t * c)) * ARC_SECOND_DEG).to_radians();
    let zeta = angle(2306.2181, 0.301_88, 0.017_998);
    let z = angle(2306.2181, 1.094_68, 0.018_203);
    let theta = angle(2004.3109, -0.426_65, -0.041_833);
    turn_z(z) * turn_y(-theta) * turn_z(zeta)
}

/// Returns the rotation from the mean equator and equinox of date to the true ones, at `t` centuries of TT since J2000:
/// nutation.
fn nutation(t: f64) -> DMat3 {
    let (longitude, obliquity) = nutation_obliquity(t);
    let mean = mean_obliquity_deg(t).to_radians();
    turn_x(obliquity) * turn_z(longitude) * turn_x(-mean)
}

/// Returns the rotation from true equatorial axes of date to (east, north, up) at a place, by the Earth's rotation.
pub(crate) fn equator_of_date_to_world(utc: Utc, place: &Place) -> DMat3 {
    place.ecef_to_enu() * turn_z(-apparent_sidereal_time(utc))
}

/// Returns the rotation from catalogue directions (equator and equinox J2000.0; x to the equinox, z to the north pole)
/// to (east, north, up) at `place`: precession, nutation and the Earth's rotation. Apply it to a star's unit vector
/// ([`equatorial_direction`]).
///
/// Accurate to 1" within two centuries of 2000. Aberration (20") and refraction are not applied. UT1 is taken as UTC;
/// they differ by at most 0.9 s, which turns the sky by 14".
///
/// # Errors
/// [`crate::Status::InvalidArgument`] for a place or time out of range.
pub fn celestial_to_world(utc: Utc, place: &Place) -> Result<DMat3> {
    place.validate()?;
    check_range("utc", utc.0, UTC_RANGE_S[0], UTC_RANGE_S[1], "s since 1970")?;
    let t = utc.julian_centuries_tt();
    Ok(equator_of_date_to_world(utc, place) * nutation(t) * precession(t))
}

/// Returns the unit vector of a right ascension and a declination, degrees.
pub fn equatorial_direction(right_ascension_deg: f64, declination_deg: f64) -> DVec3 {
    let (sa, ca) = libm::sincos(right_ascension_deg.to_radians());
    let (sd, cd) = libm::sincos(declination_deg.to_radians());
    DVec3::new(ca * cd, sa * cd, sd)
}

/// Returns the unit vector (east, north, up) of an azimuth (clockwise from north) and an elevation, degrees.
pub fn direction(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    let (sa, ca) = libm::sincos(azimuth_deg.to_radians());
    let (se, ce) = libm::sincos(elevation_deg.to_radians());
    DVec3::new(sa * ce, ca * ce, se)
}

/// Returns by how many degrees refraction lifts a body at a true elevation, degrees: Saemundsson (1986), scaled by the
/// air's density at the eye. The formula ends at -1 degree, below which nothing is seen from the ground; from there the
/// lift fades to 0 at -4 degrees.
pub fn refraction_deg(elevation_deg: f64, pressure_hpa: f64, temperature_c: f64) -> f64 {
    let h = elevation_deg.max(-1.0);
    let arc_minutes = 1.02 / libm::tan((h + 10.3 / (h + 5.11)).to_radians());
    let fade = ((elevation_deg + 4.0) / 3.0).clamp(0.0, 1.0);
    (arc_minutes / 60.0 * pressure_hpa / 1010.0 * 283.0 / (273.0 + temperature_c) * smooth(fade)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn degrees(v: DVec3) -> (f64, f64) {
        (v.y.atan2(v.x).to_degrees().rem_euclid(360.0), v.z.asin().to_degrees())
    }

    #[test]
    fn sidereal_time_of_meeus_examples_12a_and_12b() {
        let midnight = Utc::from_calendar(1987, 4, 10, 0, 0, 0.0).unwrap();
        let seconds = |rad: f64| rad.to_degrees() * 240.0;
        assert!((seconds(mean_sidereal_time(midnight)) - (13.0 * 3600.0 + 10.0 * 60.0 + 46.3668)).abs() < 1e-3);
        assert!((seconds(apparent_sidereal_time(midnight)) - (13.0 * 3600.0 + 10.0 * 60.0 + 46.1351)).abs() < 0.03);
        let evening = Utc::from_calendar(1987, 4, 10, 19, 21, 0.0).unwrap();
        assert!((mean_sidereal_time(evening).to_degrees() - 128.737_873_4).abs() < 1e-5);
    }

    #[test]
    fn precession_of_meeus_example_21b() {
        // Theta Persei with its proper motion applied, from J2000 to 2028-11-13.19 TD.
        let t = 0.288_670_500;
        let (ra, dec) = degrees(precession(t) * equatorial_direction(41.054_063, 49.227_750));
        assert!((ra - 41.547_214).abs() < 2e-6 && (dec - 49.348_483).abs() < 2e-6, "{ra} {dec}");
    }

    #[test]
    fn nutation_of_meeus_example_22a() {
        // 1987-04-10 0h TD: -3.788" in longitude, true obliquity 23 26' 36.850"; the two leading terms are good to
        // 0.5".
        let (longitude, obliquity) = nutation_obliquity(-0.127_296_372_348);
        assert!((longitude.to_degrees() * 3600.0 + 3.788).abs() < 0.5);
        assert!((obliquity.to_degrees() - (23.0 + 26.0 / 60.0 + 36.850 / 3600.0)).abs() * 3600.0 < 0.1);
    }

    #[test]
    fn venus_over_washington_in_meeus_example_13b() {
        // Apparent place of date 23h 09m 16.641s, -6 43' 11.61": azimuth 68.0337 from the south, elevation 15.1249. The
        // example's latitude is geographic, and its site is at sea level.
        let place = Place { latitude_deg: 38.921_389, longitude_deg: -77.065_556, altitude_m: 0.0 };
        let utc = Utc::from_calendar(1987, 4, 10, 19, 21, 0.0).unwrap();
        let venus = equatorial_direction(347.319_337_5, -6.719_891_7);
        let seen = equator_of_date_to_world(utc, &place) * venus;
        assert!(seen.angle_between(direction(248.0337, 15.1249)).to_degrees() < 2e-4, "{seen}");
    }

    #[test]
    fn the_pole_stands_at_the_latitude_and_the_matrix_turns_only() {
        for latitude_deg in [-60.0, 0.0, 47.0, 89.0] {
            let place = Place { latitude_deg, longitude_deg: 11.0, altitude_m: 300.0 };
            let m = celestial_to_world(Utc(9.467e8), &place).unwrap();
            assert!((m.determinant() - 1.0).abs() < 1e-12);
            let pole = m * DVec3::Z;
            assert!((pole.z.asin().to_degrees() - latitude_deg).abs() < 0.01 && pole.x.abs() < 2e-4, "{pole}");
        }
    }

    #[test]
    fn times_and_places_out_of_range_are_refused() {
        let place = Place { latitude_deg: 0.0, longitude_deg: 0.0, altitude_m: 0.0 };
        for bad in [f64::NAN, f64::INFINITY, -2e11, 2e11] {
            assert!(celestial_to_world(Utc(bad), &place).unwrap_err().to_string().contains("utc"));
        }
        assert!(celestial_to_world(Utc(0.0), &Place { latitude_deg: f64::NAN, ..place }).is_err());
    }
}
