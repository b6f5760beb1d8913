//! Positions of sun and moon relative to the Earth's centre, and fast interpolation of them in time.
//!
//! The published series cost some microseconds a call, but the bodies move slowly. An [`Ephemeris`] evaluates the
//! series at knots half an hour apart and interpolates between the four nearest by a cubic (Lagrange). The fast
//! rotation of the Earth is not interpolated: each call computes it.

use std::sync::{Mutex, PoisonError};

use glam::DVec3;
use solar_positioning::SolarPositions;

use super::lunar_series;
use crate::{
    almanac::{Utc, celestial, time::UTC_RANGE_S},
    error::Result,
};

/// Astronomical unit, m (IAU 2012).
pub(super) const AU_M: f64 = 1.495_978_707e11;
/// Sun and moon relative to the Earth's centre, in the true equator and equinox of date (x to the equinox, z to the
/// pole).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geocentric {
    /// Apparent position of the sun, m.
    pub sun_m: DVec3,
    /// Position of the moon, m.
    pub moon_m: DVec3,
    /// Equation of the equinoxes: apparent minus mean sidereal time, rad.
    pub equinoxes: f64,
}

impl Geocentric {
    /// Evaluates the series: NREL's solar position algorithm (Reda & Andreas 2004), and [`lunar_series`].
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a time out of range.
    pub fn at(utc: Utc) -> Result<Self> {
        let series = SolarPositions::new().for_time_from_julian(utc.julian()?).map_err(|_| utc.out_of_range())?;
        let toward = celestial::equatorial_direction(series.right_ascension(), series.declination());
        let t = utc.julian_centuries_tt();
        let (nutation, obliquity) = celestial::nutation_obliquity(t);
        Ok(Self {
            sun_m: toward * series.earth_radius_vector().unwrap_or(1.0) * AU_M,
            moon_m: lunar_series::geocentric_equatorial(t, nutation, obliquity),
            equinoxes: nutation * libm::cos(obliquity),
        })
    }

    fn weighed(knots: &[Self; 4], weights: [f64; 4]) -> Self {
        let sum = |of: fn(&Self) -> DVec3| (0..4).fold(DVec3::ZERO, |sum, i| sum + of(&knots[i]) * weights[i]);
        Self {
            sun_m: sum(|k| k.sun_m),
            moon_m: sum(|k| k.moon_m),
            equinoxes: (0..4).map(|i| knots[i].equinoxes * weights[i]).sum(),
        }
    }
}

/// Spacing h of the knots, s. Between the middle two of four knots a cubic differs from the interpolated function f by
/// at most 9/384 h^4 f''''. The moon's fastest large term has a period of 9.6 days and its mean motion one of 27.3
/// days, so the difference is below 1e-8 degrees (tested).
const STEP_S: f64 = 1800.0;

/// Interpolated [`Geocentric`] as a function of time; keeps the knots of the last call.
///
/// The result depends only on the time, not on earlier calls: knots lie at multiples of half an hour since 1970. Any
/// thread.
#[derive(Debug, Default)]
pub struct Ephemeris {
    /// Number of the first of four knots, counted from 1970 in steps of [`STEP_S`], and the four knots.
    knots: Mutex<Option<(f64, [Geocentric; 4])>>,
}

impl Ephemeris {
    /// Returns sun and moon at `utc`. No allocation; the series are evaluated at most four times.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a time out of range.
    pub fn at(&self, utc: Utc) -> Result<Geocentric> {
        if !(UTC_RANGE_S[0]..=UTC_RANGE_S[1]).contains(&utc.0) {
            return Err(utc.out_of_range());
        }
        // Near an end of the range the time lies outside the middle interval, because all knots stay in the range.
        let (lowest, highest) = ((UTC_RANGE_S[0] / STEP_S).ceil(), (UTC_RANGE_S[1] / STEP_S).floor() - 3.0);
        let first = ((utc.0 / STEP_S).floor() - 1.0).clamp(lowest, highest);
        let x = utc.0 / STEP_S - first;
        let weights = [
            -(x - 1.0) * (x - 2.0) * (x - 3.0) / 6.0,
            x * (x - 2.0) * (x - 3.0) / 2.0,
            -x * (x - 1.0) * (x - 3.0) / 2.0,
            x * (x - 1.0) * (x - 2.0) / 6.0,
        ];
        let mut kept = self.knots.lock().unwrap_or_else(PoisonError::into_inner);
        let knots = match &*kept {
            Some((known, knots)) if *known == first => knots,
            before => {
                let knots = knots_from(before.as_ref(), first)?;
                &kept.insert((first, knots)).1
            }
        };
        Ok(Geocentric::weighed(knots, weights))
    }
}

/// Returns the four knots from number `first` on, reusing those in `kept` that are among them.
fn knots_from(kept: Option<&(f64, [Geocentric; 4])>, first: f64) -> Result<[Geocentric; 4]> {
    let knot = |i: usize| {
        let number = first + i as f64;
        let known = kept.and_then(|(from, knots)| {
            let at = number - from;
            (0.0..4.0).contains(&at).then(|| knots[at as usize])
        });
        known.map_or_else(|| Geocentric::at(Utc(number * STEP_S)), Ok)
    };
    Ok([knot(0)?, knot(1)?, knot(2)?, knot(3)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times over three centuries, one in the time of the pyramids, and one equally far ahead.
    fn times() -> impl Iterator<Item = Utc> {
        (0..400).map(|i| Utc(-3.0e9 + 2.345_678_9e7 * f64::from(i))).chain([Utc(-1.2e11), Utc(1.2e11)])
    }

    #[test]
    fn the_cubic_is_within_a_hundred_millionth_of_a_degree_of_the_series() {
        let quick = Ephemeris::default();
        for utc in times() {
            for minute in [0.0, 7.0, 15.0, 29.9] {
                let utc = Utc(utc.0 + 60.0 * minute);
                let (got, want) = (quick.at(utc).unwrap(), Geocentric::at(utc).unwrap());
                // The angle from the chord: `angle_between` has no digits left at so small an angle.
                let apart = |a: DVec3, b: DVec3| (a.normalize() - b.normalize()).length().to_degrees();
                assert!(apart(got.sun_m, want.sun_m) < 1e-8, "{utc:?}: {got:?} {want:?}");
                assert!(apart(got.moon_m, want.moon_m) < 1e-8, "{utc:?}: {got:?} {want:?}");
                assert!((got.equinoxes - want.equinoxes).abs() < 1e-12, "{utc:?}");
                assert!((got.moon_m.length() / want.moon_m.length() - 1.0).abs() < 1e-9, "{utc:?}");
            }
        }
    }

    #[test]
    fn positions_do_not_depend_on_earlier_queries() {
        let (used, start) = (Ephemeris::default(), 1.7e9);
        for i in 0..50 {
            let utc = Utc(start + 977.0 * f64::from(i * i % 41));
            assert_eq!(used.at(utc).unwrap(), Ephemeris::default().at(utc).unwrap());
        }
    }

    #[test]
    fn the_range_ends_where_the_series_does() {
        let quick = Ephemeris::default();
        for end in UTC_RANGE_S {
            assert!(quick.at(Utc(end)).is_ok());
        }
        for bad in [f64::NAN, f64::INFINITY, 1.273e11, -1.253e11] {
            assert!(quick.at(Utc(bad)).unwrap_err().to_string().contains("utc"));
        }
    }
}
