//! Slopes of the sea by wind: their variances, their distribution, and the glitter that follows.

use std::f64::consts::PI;

use super::water::fresnel_reflectance;

/// Variances of the slopes along two axes, without a dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeVariances {
    /// Variance across the wind.
    pub crosswind: f64,
    /// Variance along the wind.
    pub upwind: f64,
}

impl SlopeVariances {
    /// Returns the sum of both: the mean square slope.
    pub fn total(&self) -> f64 {
        self.crosswind + self.upwind
    }
}

/// Returns the slope variances of Cox and Munk (1954) for a wind, m/s, at 12.5 m: 0.003 + 0.00192 W across and 0.00316
/// W along.
pub fn cox_munk(wind_m_s: f64) -> SlopeVariances {
    SlopeVariances { crosswind: 0.003 + 0.001_92 * wind_m_s, upwind: 0.003_16 * wind_m_s }
}

/// Returns the mean square slope of Cox and Munk (1954) for a wind, m/s: their own fit of the sum, 0.003 + 0.00512 W.
pub fn mean_square_slope(wind_m_s: f64) -> f64 {
    0.003 + 0.005_12 * wind_m_s
}

/// Returns the slope variances of Breon and Henriot (2006) for a wind, m/s, at 10 m.
pub fn breon_henriot(wind_m_s: f64) -> SlopeVariances {
    SlopeVariances { crosswind: 0.003 + 0.001_85 * wind_m_s, upwind: 0.001 + 0.003_16 * wind_m_s }
}

/// Returns the skewness coefficients c21 and c03 of Breon and Henriot (2006).
pub fn skewness(wind_m_s: f64) -> [f64; 2] {
    [-9e-4 * wind_m_s * wind_m_s, -0.45 / (1.0 + libm::exp(7.0 - wind_m_s))]
}

/// Returns the density of slopes by the series of Gram and Charlier (Cox and Munk 1954, equation 18) with the
/// variances, skewness and kurtosis (c40 0.30, c22 0.12, c04 0.40) of Breon and Henriot (2006). The series is negative
/// in far tails and is cut off at 0 there.
pub fn slope_density(crosswind: f64, upwind: f64, wind_m_s: f64) -> f64 {
    let v = breon_henriot(wind_m_s);
    let (c, u) = (crosswind / v.crosswind.sqrt(), upwind / v.upwind.sqrt());
    let [c21, c03] = skewness(wind_m_s);
    let (c2, u2) = (c * c, u * u);
    let series = 1.0 - 0.5 * c21 * (c2 - 1.0) * u - c03 / 6.0 * (u2 - 3.0) * u
        + 0.30 / 24.0 * (c2 * c2 - 6.0 * c2 + 3.0)
        + 0.12 / 4.0 * (c2 - 1.0) * (u2 - 1.0)
        + 0.40 / 24.0 * (u2 * u2 - 6.0 * u2 + 3.0);
    let normal = libm::exp(-0.5 * (c2 + u2)) / (2.0 * PI * (v.crosswind * v.upwind).sqrt());
    (normal * series).max(0.0)
}

/// Returns the reflectance factor of sun glint in the mirror plane, for slopes of the same variance in all directions:
/// pi p R / (4 cos sun cos view cos^4 tilt), with the density p of the slopes, Fresnel's reflectance R and the tilt of
/// the facets that mirror (Cox and Munk 1954). Angles are from the vertical, on opposite sides; a negative view is on
/// the sun's side.
pub fn glint_reflectance(sun: f64, view: f64, mean_square: f64, index: f64) -> f64 {
    let tilt = 0.5 * (view - sun);
    let tan = libm::tan(tilt);
    let density = libm::exp(-tan * tan / mean_square) / (PI * mean_square);
    let cos_tilt = libm::cos(tilt);
    let incidence = libm::cos(0.5 * (sun + view));
    PI * density * fresnel_reflectance(incidence, index)
        / (4.0 * libm::cos(sun) * libm::cos(view) * cos_tilt * cos_tilt * cos_tilt * cos_tilt)
}

/// Returns the half-widths of the glitter, rad, in elevation and in azimuth, where its density has fallen to e^-1/2: 2
/// atan(s) and 2 asin(s tan h) with s = sqrt(`mean_square` / 2) and the sun's height h = `sun_height`, rad. The width
/// in azimuth is that of rays that rise to the eye at the angle h.
pub fn glitter_half_widths(mean_square: f64, sun_height: f64) -> [f64; 2] {
    let s = (0.5 * mean_square).sqrt();
    [2.0 * libm::atan(s), 2.0 * libm::asin((s * libm::tan(sun_height)).min(1.0))]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variances_are_those_published() {
        assert!((cox_munk(10.0).total() - (0.003 + 0.0508)).abs() < 1e-12);
        assert!((mean_square_slope(10.0) - 0.0542).abs() < 1e-12 && (mean_square_slope(20.0) - 0.1054).abs() < 1e-12);
        assert!((breon_henriot(7.0).total() - (0.004 + 0.00501 * 7.0)).abs() < 1e-12);
    }

    #[test]
    fn densities_keep_norm_and_variances() {
        let (mut whole, mut cc, mut uu) = (0.0, 0.0, 0.0);
        let wind = 8.0;
        let v = breon_henriot(wind);
        let n = 400;
        for i in 0..n {
            for j in 0..n {
                let at = |i: i32| 8.0 * (2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0);
                let (c, u) = (at(i) * v.crosswind.sqrt(), at(j) * v.upwind.sqrt());
                let p = slope_density(c, u, wind) * (v.crosswind * v.upwind).sqrt() * (16.0 / f64::from(n)).powi(2);
                whole += p;
                cc += p * c * c;
                uu += p * u * u;
            }
        }
        assert!((whole - 1.0).abs() < 2e-3, "{whole}");
        assert!((cc / v.crosswind - 1.0).abs() < 0.01 && (uu / v.upwind - 1.0).abs() < 0.01, "{cc} {uu}");
    }

    #[test]
    fn glint_is_that_of_the_reference_program() {
        for (sun, view, wind, wanted) in [
            (30.0f64, 30.0f64, 5.0, 0.251_105),
            (30.0, 30.0, 10.0, 0.132_502),
            (60.0, 60.0, 5.0, 2.093_673),
            (30.0, 0.0, 5.0, 0.019_341),
        ] {
            let found = glint_reflectance(sun.to_radians(), view.to_radians(), mean_square_slope(wind), 1.334);
            assert!((found / wanted - 1.0).abs() < 3e-5, "{sun} {view} {wind}: {found}");
        }
    }

    #[test]
    fn glitter_widens_with_wind_and_sun() {
        for (wind, deg) in [(2.0, 9.3), (5.0, 13.6), (10.0, 18.7)] {
            let [up, _] = glitter_half_widths(mean_square_slope(wind), 0.5);
            assert!((up.to_degrees() - deg).abs() < 0.06, "{wind}: {}", up.to_degrees());
        }
        for (height, deg) in [(10.0f64, 2.4), (30.0, 7.9), (60.0, 23.9)] {
            let [_, aside] = glitter_half_widths(mean_square_slope(5.0), height.to_radians());
            assert!((aside.to_degrees() - deg).abs() < 0.06, "{height}: {}", aside.to_degrees());
        }
    }
}
