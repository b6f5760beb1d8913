//! Universal time: seconds since 1970, the calendar, and terrestrial time.

use solar_positioning::time::JulianDate;

use crate::error::{Error, Result, check_range};

/// Julian date of 1970-01-01T00:00:00Z.
const JD_UNIX_EPOCH: f64 = 2_440_587.5;

/// First and last year of a calendar date. The sun's series ends 16 hours before the last year does.
const FIRST_YEAR: f64 = -2000.0;
const LAST_YEAR: f64 = 6000.0;

/// Range of the sun's series, the years -2000 to 6000, in seconds since 1970. It ends 57,600 s (16 hours) before the
/// year 6000 does, because the series counts in terrestrial time, which is then some 57,270 s ahead of universal time.
pub(crate) const UTC_RANGE_S: [f64; 2] = [-125_281_123_200.0, 127_206_057_600.0];

/// Years between which the difference between terrestrial and universal time is fitted to observations and simulations.
const FITTED_YEARS: [f64; 2] = [-500.0, 3000.0];

/// Returns TT - UT1 over millennia, s (Morrison and Stephenson 2004, in the form of Espenak and Meeus 2006).
fn long_term_s(year: f64) -> f64 {
    let centuries = (year - 1820.0) / 100.0;
    -20.0 + 32.0 * centuries * centuries
}

/// Returns the number of days in a month of the proleptic Gregorian calendar.
fn days_of(year: i32, month: u32) -> u32 {
    let leap = year.rem_euclid(4) == 0 && (year.rem_euclid(100) != 0 || year.rem_euclid(400) == 0);
    match month {
        2 => 28 + u32::from(leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Returns the number of days from 1970-01-01 to a date of the proleptic Gregorian calendar. Years begin in March, so
/// that the leap day is the last of a year (Richards 2013, Explanatory Supplement, section 15.11).
fn days_since_1970(year: i32, month: u32, day: u32) -> i64 {
    let (month, day) = (i64::from(month), i64::from(day));
    let year = i64::from(year) - i64::from(month <= 2);
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    365 * year + year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400) + of_year - 719_468
}

/// Coordinated universal time, in seconds since 1970-01-01T00:00:00Z without leap seconds. UT1 is taken as UTC; they
/// differ by at most 0.9 s, which is 0.004 degrees. Range: the years -2000 to 6000, except the last 16 hours of 6000.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Utc(pub f64);

impl Utc {
    /// Creates a time from a calendar date (proleptic Gregorian) and a time of day: a year in \[-2000, 6000\], and a
    /// second in \[0, 60), or in \[0, 61) in minute 59 of hour 23. A leap second, 23:59:60, is the first second of the
    /// next day, as in Unix time. The last 16 hours of 6000 are accepted here, but refused by the series of sun and
    /// moon.
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

    /// Returns the Julian date, days (UT).
    pub fn julian_date(self) -> f64 {
        self.0 / 86_400.0 + JD_UNIX_EPOCH
    }

    /// Returns the centuries of terrestrial time since J2000.0.
    pub(crate) fn julian_centuries_tt(self) -> f64 {
        (self.julian_date() + self.delta_t_s() / 86_400.0 - 2_451_545.0) / 36_525.0
    }

    /// Returns TT - UT1, s: 69.1 s in 2026. For the years -500 to 3000 it comes from the crate `solar-positioning`: the
    /// polynomials of Espenak and Meeus (2006, with Espenak's of 2014) until 2015, then a quartic through the
    /// observations of IERS until the middle of 2026, and a quadratic through simulations (Agnew 2026) after that.
    /// These curves meet within 0.4 s. Before -500 and after 3000 the difference continues as the parabola of Morrison
    /// and Stephenson (2004), 32 s per century squared for tidal friction, shifted to meet the fit without a step.
    pub fn delta_t_s(self) -> f64 {
        let year = 2000.0 + (self.julian_date() - 2_451_544.5) / 365.2425;
        let fitted = year.clamp(FITTED_YEARS[0], FITTED_YEARS[1]);
        // The crate estimates every year of this range, so the default is never used.
        solar_positioning::delta_t::estimate(fitted).unwrap_or_default() + long_term_s(year) - long_term_s(fitted)
    }

    pub(crate) fn julian(self) -> Result<JulianDate> {
        JulianDate::new(self.julian_date(), self.delta_t_s()).map_err(|_| self.out_of_range())
    }

    pub(crate) fn out_of_range(self) -> Error {
        Error::range("utc", "a time of the years -2000 to 6000 (seconds since 1970)", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn in_year(year: f64) -> Utc {
        Utc((year - 1970.0) * 365.2425 * 86_400.0)
    }

    #[test]
    fn the_difference_of_times_has_no_step_in_all_the_range() {
        // Steps of one day. The parabola is steepest in the year 6000, 0.07 s a day; the polynomials meet within 0.4 s.
        let mut before = Utc(UTC_RANGE_S[0]).delta_t_s();
        for day in 1..=2_922_000 {
            let utc = Utc(UTC_RANGE_S[0] + 86_400.0 * f64::from(day));
            if utc.0 > UTC_RANGE_S[1] {
                break;
            }
            let now = utc.delta_t_s();
            assert!((now - before).abs() < 0.5, "{before} to {now} s in {}", 1970.0 + utc.0 / 86_400.0 / 365.2425);
            before = now;
        }
        for border in FITTED_YEARS {
            let step = in_year(border + 1e-6).delta_t_s() - in_year(border - 1e-6).delta_t_s();
            assert!(step.abs() < 1e-3, "{step} s at {border}");
        }
        for (year, expected, within) in
            // Espenak and Meeus (2006): their table for the years -500 and 1000, IERS in 2026, and years in which only
            // the parabola holds.
            [
                (-500.0, 17_190.0, 430.0),
                (1000.0, 1570.0, 55.0),
                (2026.5, 69.14, 0.1),
                (-2000.0, 46_656.0, 100.0),
            ]
        {
            let found = in_year(year).delta_t_s();
            assert!((found - expected).abs() <= within, "{found} s in {year}");
        }
    }

    #[test]
    fn the_almanac_answers_at_both_ends_of_its_range() {
        for end in UTC_RANGE_S {
            assert!(Utc(end).julian().is_ok(), "{end}");
        }
        assert!(in_year(6000.999).delta_t_s() < 57_600.0);
    }
}
