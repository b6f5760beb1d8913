//! Universal time: seconds since 1970, the calendar, and terrestrial time.

use solar_positioning::time::JulianDate;

use crate::error::{Error, Result, check_range};

/// Julian date of 1970-01-01T00:00:00Z.
const JD_UNIX_EPOCH: f64 = 2_440_587.5;

/// Years of which the almanac knows where the sun stands.
const FIRST_YEAR: f64 = -2000.0;
const LAST_YEAR: f64 = 6000.0;

/// Seconds since 1970 of the years -2000 to 6000, as the sun's series has them; the last hour is left to the difference
/// between terrestrial and universal time.
pub(crate) const UTC_RANGE_S: [f64; 2] = [-125_281_123_200.0, 127_206_111_600.0];

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
    pub(crate) fn julian_centuries_tt(self) -> f64 {
        (self.julian_date() + self.delta_t_s() / 86_400.0 - 2_451_545.0) / 36_525.0
    }

    /// TT - UT1, s (the polynomials of Espenak and Meeus 2014, by the crate `solar-positioning`).
    pub fn delta_t_s(self) -> f64 {
        let year = 2000.0 + (self.julian_date() - 2_451_544.5) / 365.2425;
        solar_positioning::delta_t::estimate(year).unwrap_or(69.0)
    }

    pub(crate) fn julian(self) -> Result<JulianDate> {
        JulianDate::new(self.julian_date(), self.delta_t_s()).map_err(|_| self.out_of_range())
    }

    pub(crate) fn out_of_range(self) -> Error {
        Error::range("utc", "a time of the years -2000 to 6000 (seconds since 1970)", self.0)
    }
}
