//! Where the sun stands: the almanac, refraction, and the flattening of the disc near the horizon.

use glam::{DMat3, DVec3};
use solar_positioning::time::JulianDate;

use super::{
    celestial::mean_sidereal_time,
    ephemeris::{AU_M, Geocentric},
};
use crate::{
    error::{Error, Result, check_range},
    scene::Place,
};

/// Julian date of 1970-01-01T00:00:00Z.
const JD_UNIX_EPOCH: f64 = 2_440_587.5;

/// Years of which the almanac knows where the sun stands.
const FIRST_YEAR: f64 = -2000.0;
const LAST_YEAR: f64 = 6000.0;

/// Days of a month of the proleptic Gregorian calendar.
fn days_of(year: i32, month: u32) -> u32 {
    let leap = year.rem_euclid(4) == 0 && (year.rem_euclid(100) != 0 || year.rem_euclid(400) == 0);
    match month {
        2 => 28 + u32::from(leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Days from 1970-01-01 to a date of the proleptic Gregorian calendar: years are counted from March, so that the day that comes
/// every four years is a year's last (Richards 2013, Explanatory Supplement, section 15.11).
fn days_since_1970(year: i32, month: u32, day: u32) -> i64 {
    let (month, day) = (i64::from(month), i64::from(day));
    let year = i64::from(year) - i64::from(month <= 2);
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    365 * year + year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400) + of_year - 719_468
}

/// Coordinated universal time, in seconds since 1970-01-01T00:00:00Z without leap seconds. UT1 is taken as UTC, which
/// is 0.9 s at most: 0.004 degrees. Range: the years -2000 to 6000.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Utc(pub f64);

impl Utc {
    /// From a calendar date (proleptic Gregorian) and a time of day: a year in \[-2000, 6000\], and a second in \[0, 61) of minute 59
    /// of hour 23, else in \[0, 60). A leap second, 23:59:60, is the first of the next day, as Unix time has it.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn from_calendar(year: i32, month: u32, day: u32, hour: u32, minute: u32, second: f64) -> Result<Self> {
        let whole = |name: &str, value: u32, lo: u32, hi: u32| {
            check_range(name, f64::from(value), f64::from(lo), f64::from(hi), "")
        };
        check_range("year", f64::from(year), FIRST_YEAR, LAST_YEAR, "")?;
        whole("month", month, 1, 12)?;
        whole("day", day, 1, days_of(year, month))?;
        whole("hour", hour, 0, 23)?;
        whole("minute", minute, 0, 59)?;
        let below = if (hour, minute) == (23, 59) { 61.0 } else { 60.0 };
        if !(0.0..below).contains(&second) {
            let accepted = "in [0, 60) s, in the last minute of a day in [0, 61) for a leap second";
            return Err(Error::range("second", accepted, second));
        }
        let of_day = f64::from(hour) * 3600.0 + f64::from(minute) * 60.0 + second;
        Ok(Self(days_since_1970(year, month, day) as f64 * 86_400.0 + of_day))
    }

    /// Julian date, days (UT).
    pub fn julian_date(self) -> f64 {
        self.0 / 86_400.0 + JD_UNIX_EPOCH
    }

    /// Centuries of terrestrial time since J2000.0.
    pub(super) fn julian_centuries_tt(self) -> f64 {
        (self.julian_date() + self.delta_t_s() / 86_400.0 - 2_451_545.0) / 36_525.0
    }

    /// TT - UT1, s (the polynomials of Espenak and Meeus 2014, by the crate `solar-positioning`).
    pub fn delta_t_s(self) -> f64 {
        let year = 2000.0 + (self.julian_date() - 2_451_544.5) / 365.2425;
        solar_positioning::delta_t::estimate(year).unwrap_or(69.0)
    }

    pub(super) fn julian(self) -> Result<JulianDate> {
        JulianDate::new(self.julian_date(), self.delta_t_s()).map_err(|_| self.out_of_range())
    }

    pub(super) fn out_of_range(self) -> Error {
        Error::range("utc", "a time of the years -2000 to 6000 (seconds since 1970)", self.0)
    }
}

/// The sun over a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPosition {
    /// Towards the sun, (east, north, up), without refraction: what scattering sees.
    pub direction: DVec3,
    /// Degrees clockwise from true north.
    pub azimuth_deg: f64,
    /// Degrees above the horizon, without refraction.
    pub elevation_deg: f64,
    /// Distance from the Earth's centre, au.
    pub distance_au: f64,
}

/// The sun over `place` at `utc`: NREL's solar position algorithm (Reda & Andreas 2004), topocentric, +-0.0005 degrees.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] for a place or time out of range.
pub fn sun_position(utc: Utc, place: &Place) -> Result<SunPosition> {
    place.validate()?;
    Ok(Turned::new(&Geocentric::at(utc)?, utc, place).sun())
}

/// Sun and moon as they stand over a place: turned with the Earth and seen from there, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turned {
    pub(super) sun_m: DVec3,
    pub(super) moon_m: DVec3,
    distance_au: f64,
}

impl Turned {
    pub fn new(from_centre: &Geocentric, utc: Utc, place: &Place) -> Self {
        let to_enu = place.ecef_to_enu();
        let turn = DMat3::from_rotation_z(-(mean_sidereal_time(utc) + from_centre.equinoxes));
        let seen = |body: DVec3| to_enu * (turn * body - place.to_ecef());
        let distance_au = from_centre.sun_m.length() / AU_M;
        Self { sun_m: seen(from_centre.sun_m), moon_m: seen(from_centre.moon_m), distance_au }
    }

    pub fn sun(&self) -> SunPosition {
        let direction = self.sun_m.normalize();
        SunPosition {
            direction,
            azimuth_deg: direction.x.atan2(direction.y).to_degrees().rem_euclid(360.0),
            elevation_deg: direction.z.atan2(direction.x.hypot(direction.y)).to_degrees(),
            distance_au: self.distance_au,
        }
    }
}

/// Unit vector (east, north, up) of an azimuth (clockwise from north) and an elevation, degrees.
pub fn direction(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    let (sa, ca) = azimuth_deg.to_radians().sin_cos();
    let (se, ce) = elevation_deg.to_radians().sin_cos();
    DVec3::new(sa * ce, ca * ce, se)
}

/// Lift of a body by refraction, degrees, at a true elevation: Saemundsson (1986), scaled by the air's density at the
/// eye. Below -1 degree, where the formula ends and nothing is seen from the ground, it fades to 0 at -4 degrees.
pub fn refraction_deg(elevation_deg: f64, pressure_hpa: f64, temperature_c: f64) -> f64 {
    let h = elevation_deg.max(-1.0);
    let arc_minutes = 1.02 / (h + 10.3 / (h + 5.11)).to_radians().tan();
    let fade = ((elevation_deg + 4.0) / 3.0).clamp(0.0, 1.0);
    let smooth = fade * fade * (3.0 - 2.0 * fade);
    (arc_minutes / 60.0 * pressure_hpa / 1010.0 * 283.0 / (273.0 + temperature_c) * smooth).max(0.0)
}

/// Vertical over horizontal diameter of a small disc at a true elevation: 1 + d(refraction)/d(elevation).
pub fn disc_flattening(elevation_deg: f64, pressure_hpa: f64, temperature_c: f64) -> f64 {
    let h = 0.13;
    let rise = refraction_deg(elevation_deg + h, pressure_hpa, temperature_c)
        - refraction_deg(elevation_deg - h, pressure_hpa, temperature_c);
    (1.0 + rise / (2.0 * h)).clamp(0.5, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nrels_own_example() {
        // Reda & Andreas 2004, table A5.1: zenith 50.11162 is refracted; azimuth 194.34024.
        let utc = Utc::from_calendar(2003, 10, 17, 19, 30, 30.0).unwrap();
        let place = Place { latitude_deg: 39.742_476, longitude_deg: -105.1786, altitude_m: 1830.14 };
        let sun = sun_position(utc, &place).unwrap();
        assert!((sun.azimuth_deg - 194.340_24).abs() < 1e-3, "{sun:?}");
        let apparent = sun.elevation_deg + refraction_deg(sun.elevation_deg, 820.0, 11.0);
        assert!((90.0 - apparent - 50.111_62).abs() < 1e-3, "{apparent}");
    }

    #[test]
    fn the_suns_place_agrees_with_other_almanacs() {
        // Computed with XEphem's libastro (pressure 0): (utc, latitude, longitude, azimuth, elevation).
        let cases = include!("testdata/sun.in");
        for (unix, latitude_deg, longitude_deg, azimuth, elevation) in cases {
            let place = Place { latitude_deg, longitude_deg, altitude_m: 0.0 };
            let sun = sun_position(Utc(unix), &place).unwrap();
            let apart = sun.direction.angle_between(direction(azimuth, elevation)).to_degrees();
            assert!(apart < 0.01, "{unix}: {sun:?} is {apart} degrees from {azimuth} {elevation}");
        }
    }

    #[test]
    fn refraction_lifts_the_horizon_by_about_half_a_degree_and_flattens_the_disc() {
        // Explanatory Supplement: 34' for a body seen on the horizon, whose true elevation is then -0.57 degrees.
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
