//! Position of the sun over a place, and the flattening of its disc by refraction near the horizon.

use glam::DVec3;

use super::ephemeris::{AU_M, Geocentric};
pub use super::{
    Utc,
    celestial::{direction, refraction_deg},
};
use crate::{
    almanac::celestial::mean_sidereal_time,
    error::Result,
    scene::{Place, turn_z},
};

/// Position of the sun over a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPosition {
    /// Unit vector towards the sun, (east, north, up), without refraction: the direction that scattering uses.
    pub direction: DVec3,
    /// Azimuth, degrees clockwise from true north.
    pub azimuth_deg: f64,
    /// Elevation above the horizon, degrees, without refraction.
    pub elevation_deg: f64,
    /// Distance of the sun from the Earth's centre, au.
    pub distance_au: f64,
}

/// Returns the position of the sun over `place` at `utc`, seen from the place itself (topocentric), within 0.0005
/// degrees: NREL's solar position algorithm (Reda & Andreas 2004).
///
/// # Errors
/// [`crate::Status::InvalidArgument`] for a place or time out of range.
pub fn sun_position(utc: Utc, place: &Place) -> Result<SunPosition> {
    place.validate()?;
    Ok(Topocentric::new(&Geocentric::at(utc)?, utc, place).sun())
}

/// Sun and moon relative to a place (topocentric): vectors (east, north, up) from the place, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Topocentric {
    pub(super) sun_m: DVec3,
    pub(super) moon_m: DVec3,
    distance_au: f64,
}

impl Topocentric {
    pub fn new(from_centre: &Geocentric, utc: Utc, place: &Place) -> Self {
        let to_enu = place.ecef_to_enu();
        let turn = turn_z(-(mean_sidereal_time(utc) + from_centre.equinoxes));
        let seen = |body: DVec3| to_enu * (turn * body - place.to_ecef());
        let distance_au = from_centre.sun_m.length() / AU_M;
        Self { sun_m: seen(from_centre.sun_m), moon_m: seen(from_centre.moon_m), distance_au }
    }

    pub fn sun(&self) -> SunPosition {
        let direction = self.sun_m.normalize();
        SunPosition {
            direction,
            azimuth_deg: libm::atan2(direction.x, direction.y).to_degrees().rem_euclid(360.0),
            elevation_deg: libm::atan2(direction.z, libm::hypot(direction.x, direction.y)).to_degrees(),
            distance_au: self.distance_au,
        }
    }
}

/// Returns the ratio of the vertical to the horizontal diameter of a small disc at a true elevation, [0.5, 1].
/// Refraction flattens the disc to 1 + d(refraction)/d(elevation).
pub fn disc_flattening(elevation_deg: f64, pressure_hpa: f64, temperature_c: f64) -> f64 {
    let h = 0.13;
    let rise = refraction_deg(elevation_deg + h, pressure_hpa, temperature_c)
        - refraction_deg(elevation_deg - h, pressure_hpa, temperature_c);
    (1.0 + rise / (2.0 * h)).clamp(0.5, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::almanac::celestial::{equator_of_date_to_world, equatorial_direction, nutation_obliquity};

    #[test]
    fn nrels_own_example() {
        // Reda & Andreas 2004, table A5.1: zenith angle 50.11162 with refraction, azimuth 194.34024, degrees.
        let utc = Utc::from_calendar(2003, 10, 17, 19, 30, 30.0).unwrap();
        let place = Place { latitude_deg: 39.742_476, longitude_deg: -105.1786, altitude_m: 1830.14 };
        let sun = sun_position(utc, &place).unwrap();
        assert!((sun.azimuth_deg - 194.340_24).abs() < 1e-3, "{sun:?}");
        let apparent = sun.elevation_deg + refraction_deg(sun.elevation_deg, 820.0, 11.0);
        assert!((90.0 - apparent - 50.111_62).abs() < 1e-3, "{apparent}");
    }

    #[test]
    fn the_suns_place_agrees_with_other_almanacs() {
        // Values of XEphem's libastro (pressure 0): (utc, latitude, longitude, azimuth, elevation).
        let cases = include!("testdata/sun.in");
        for (unix, latitude_deg, longitude_deg, azimuth, elevation) in cases {
            let place = Place { latitude_deg, longitude_deg, altitude_m: 0.0 };
            let sun = sun_position(Utc(unix), &place).unwrap();
            let apart = sun.direction.angle_between(direction(azimuth, elevation)).to_degrees();
            assert!(apart < 0.01, "{unix}: {sun:?} is {apart} degrees from {azimuth} {elevation}");
        }
    }

    #[test]
    fn the_suns_catalogue_place_stands_where_the_almanac_has_it() {
        // 2020-06-20 21:43:40 UT is the solstice. The sun's true longitude of date is then 90 degrees, so in the
        // equator of date its right ascension is 90 degrees and its declination is the obliquity.
        let utc = Utc::from_calendar(2020, 6, 20, 21, 43, 40.0).unwrap();
        let place = Place { latitude_deg: 20.0, longitude_deg: -150.0, altitude_m: 0.0 };
        let (_, obliquity) = nutation_obliquity(utc.julian_centuries_tt());
        let seen = equator_of_date_to_world(utc, &place) * equatorial_direction(90.0, obliquity.to_degrees());
        let sun = sun_position(utc, &place).unwrap();
        // The diurnal parallax is at most 0.0024 degrees. The instant is good to a minute, which is 0.0007 degrees.
        assert!(seen.angle_between(sun.direction).to_degrees() < 0.004, "{seen} {:?}", sun.direction);
    }

    #[test]
    fn refraction_lifts_the_horizon_by_about_half_a_degree_and_flattens_the_disc() {
        // Explanatory Supplement: refraction lifts a body seen on the horizon by 34', from a true elevation of -0.57
        // degrees.
        assert!((refraction_deg(-0.57, 1010.0, 10.0) * 60.0 - 34.0).abs() < 1.0);
        assert!(refraction_deg(90.0, 1010.0, 10.0).abs() < 1e-3);
        let f = disc_flattening(-0.3, 1013.0, 15.0);
        assert!((0.78..0.92).contains(&f), "the setting sun is about 5/6 as high as wide: {f}");
        let mut last = -90.0;
        for i in 0..2000 {
            let h = -10.0 + 0.01 * f64::from(i);
            let seen = h + refraction_deg(h, 1013.25, 15.0);
            assert!(seen > last, "order of elevations is kept at {h}");
            last = seen;
        }
    }

    #[test]
    fn times_and_places_out_of_range_are_named() {
        let place = Place { latitude_deg: 0.0, longitude_deg: 0.0, altitude_m: 0.0 };
        for bad in [f64::NAN, f64::INFINITY, 1e13] {
            assert!(sun_position(Utc(bad), &place).unwrap_err().to_string().contains("utc"));
        }
        let nowhere = Place { latitude_deg: 91.0, ..place };
        assert!(sun_position(Utc(0.0), &nowhere).unwrap_err().to_string().contains("latitude_deg"));
        assert!(Utc::from_calendar(2024, 13, 1, 0, 0, 0.0).is_err());
    }
}
