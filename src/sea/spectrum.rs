//! Frequency spectra of waves: JONSWAP, its moments, and the depth function of TMA.

use std::f64::consts::PI;

use super::dispersion::GRAVITY_M_S2;
use crate::numerics::GAUSS_8_HALF;

/// Peak enhancement of a growing wind sea (Hasselmann et al. 1973, the mean of JONSWAP).
pub const GROWING_GAMMA: f64 = 3.3;
/// Level of the tail of a fully developed sea (Pierson and Moskowitz 1964).
pub const DEVELOPED_ALPHA: f64 = 0.0081;

/// Returns the shape of JONSWAP's spectrum at `x` = w / wp, without a dimension: x^-5 exp(-1.25 x^-4) gamma^r with r =
/// exp(-(x - 1)^2 / (2 s^2)), s = 0.07 below the peak and 0.09 above (Hasselmann et al. 1973). The spectrum is alpha
/// g^2 wp^-5 times this shape, m^2 s/rad; gamma 1 is that of Pierson and Moskowitz.
pub fn jonswap_shape(x: f64, gamma: f64) -> f64 {
    if x < 0.2 {
        return 0.0; // exp(-781) and less.
    }
    let fifth = 1.0 / (x * x * x * x);
    let width = if x <= 1.0 { 0.07 } else { 0.09 };
    let away = (x - 1.0) / width;
    let peak = libm::exp(-0.5 * away * away);
    fifth / x * libm::exp(peak * libm::log(gamma) - 1.25 * fifth)
}

/// Returns the integral of x^`order` times [`jonswap_shape`] over all x, by Gauss-Legendre panels in log x. `order` is
/// at most 3: higher moments grow with the highest frequency.
pub fn jonswap_moment(order: f64, gamma: f64) -> f64 {
    let (low, high, panels) = (libm::log(0.25), libm::log(60.0), 200u32);
    let step = (high - low) / f64::from(panels);
    let at = |log: f64| libm::exp((order + 1.0) * log) * jonswap_shape(libm::exp(log), gamma);
    let panel = |i: u32| {
        let middle = low + (f64::from(i) + 0.5) * step;
        GAUSS_8_HALF.iter().map(|(n, w)| w * (at(middle + 0.5 * step * n) + at(middle - 0.5 * step * n))).sum::<f64>()
    };
    let inside: f64 = (0..panels).map(panel).sum();
    // Beyond the last panel the shape is x^-5.
    let beyond = libm::exp((order - 4.0) * high) / (4.0 - order);
    0.5 * step * inside + beyond
}

/// Returns the level alpha of JONSWAP's spectrum with a variance `m0_m2`, m^2, and a peak: the spectrum is solved for
/// the height, since its own laws of alpha and peak do not give the heights that its authors measured.
pub fn alpha_of(m0_m2: f64, peak_rad_s: f64, gamma: f64) -> f64 {
    let peak2 = peak_rad_s * peak_rad_s;
    m0_m2 * peak2 * peak2 / (GRAVITY_M_S2 * GRAVITY_M_S2 * jonswap_moment(0.0, gamma))
}

/// Returns the share of a deep-water spectrum that a depth leaves at an angular frequency: tanh^2(k h) / (1 + 2 k h /
/// sinh(2 k h)) (Kitaigorodskii, Krasitskii and Zaslavskii 1975; TMA: Bouws et al. 1985), for the wave number of the
/// linear gravity wave.
pub fn depth_share(w_rad_s: f64, depth_m: f64) -> f64 {
    let squared = w_rad_s * w_rad_s * depth_m / GRAVITY_M_S2;
    if squared > 40.0 {
        return 1.0;
    }
    let x = depth_phase(squared);
    let t = libm::tanh(x);
    t * t / (1.0 + 2.0 * x / libm::sinh(2.0 * x))
}

/// Solves x tanh x = `squared` for x = k h.
fn depth_phase(squared: f64) -> f64 {
    let mut x = squared / libm::sqrt(libm::tanh(squared)).max(1e-150);
    for _ in 0..30 {
        let t = libm::tanh(x);
        let step = (x * t - squared) / (t + x * (1.0 - t * t));
        x = (x - step).max(0.5 * x);
        if step.abs() <= 1e-15 * x {
            break;
        }
    }
    x
}

/// Returns the share of a JONSWAP sea's variance that a depth leaves (TMA), by panels in log w.
pub fn depth_share_of_sea(peak_rad_s: f64, gamma: f64, depth_m: f64) -> f64 {
    let (low, high, panels) = (libm::log(0.25), libm::log(60.0), 400u32);
    let step = (high - low) / f64::from(panels);
    let (mut kept, mut whole) = (0.0, 0.0);
    for i in 0..panels {
        let x = libm::exp(low + (f64::from(i) + 0.5) * step);
        let energy = x * jonswap_shape(x, gamma);
        whole += energy;
        kept += energy * depth_share(x * peak_rad_s, depth_m);
    }
    kept / whole
}

/// Returns the peak, rad/s, of a fully developed sea of a variance: m0 = alpha g^2 / (5 wp^4) (Pierson and Moskowitz
/// 1964).
pub fn developed_peak_rad_s(m0_m2: f64) -> f64 {
    let level = DEVELOPED_ALPHA * GRAVITY_M_S2 * GRAVITY_M_S2 / 5.0;
    libm::sqrt(libm::sqrt(level / m0_m2.max(1e-12)))
}

/// Returns the most likely height of the highest of N = `waves` waves, over the significant height: sqrt(ln N / 2) for
/// Rayleigh's distribution (Longuet-Higgins 1952). N below 2 is taken as 2.
pub fn highest_over_significant(waves: f64) -> f64 {
    libm::sqrt(0.5 * libm::log(waves.max(2.0)))
}

/// Returns the significant height, m, of a variance.
pub fn significant_height_m(m0_m2: f64) -> f64 {
    4.0 * m0_m2.max(0.0).sqrt()
}

/// Returns the length, m, in deep water of waves of a period.
pub fn deep_length_m(period_s: f64) -> f64 {
    GRAVITY_M_S2 * period_s * period_s / (2.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_the_published_shape() {
        let m0 = |gamma| jonswap_moment(0.0, gamma);
        assert!((m0(1.0) - 0.2).abs() < 1e-7, "{}", m0(1.0));
        for (gamma, ratio, t02, t01, te) in [
            (1.0, 1.0, 0.71037, 0.77177, 0.85722),
            (2.0, 1.24562, 0.74644, 0.80630, 0.88354),
            (3.3, 1.52495, 0.77740, 0.83433, 0.90330),
            (5.0, 1.85843, 0.80529, 0.85834, 0.91919),
            (7.0, 2.22517, 0.82850, 0.87747, 0.93123),
        ] {
            let m = |order| jonswap_moment(order, gamma);
            let found = [m(0.0) / 0.2, (m(0.0) / m(2.0)).sqrt(), m(0.0) / m(1.0), m(-1.0) / m(0.0)];
            for (found, wanted) in found.iter().zip([ratio, t02, t01, te]) {
                assert!((found / wanted - 1.0).abs() < 2e-5, "{gamma}: {found} {wanted}");
            }
        }
    }

    #[test]
    fn levels_give_the_height_that_was_asked() {
        // JONSWAP's own laws at 10 m/s over 100 km: alpha and peak give 2.139 m.
        let z: f64 = 9810.0;
        let alpha = 0.076 * z.powf(-0.22);
        let peak = 22.0 * (GRAVITY_M_S2 * GRAVITY_M_S2 / (10.0 * 1e5)).cbrt();
        let m0 = alpha * GRAVITY_M_S2.powi(2) * peak.powi(-4) * jonswap_moment(0.0, 3.3);
        assert!((significant_height_m(m0) - 2.139).abs() < 1e-3);
        assert!((alpha_of(m0, peak, 3.3) / alpha - 1.0).abs() < 1e-12);
        assert!((2.0 * PI / peak - 6.232).abs() < 1e-3);
        // Pierson and Moskowitz: 0.2092 U^2 / g and a peak of 0.877 g / U.
        let developed = (0.2092 * 100.0 / GRAVITY_M_S2 / 4.0f64).powi(2);
        assert!((developed_peak_rad_s(developed) / (0.877 * GRAVITY_M_S2 / 10.0) - 1.0).abs() < 2e-3);
    }

    #[test]
    fn depths_leave_the_share_of_tma() {
        for (x, share) in [(0.5, 0.12481), (1.0, 0.48277), (1.5, 0.87853), (2.0, 0.99336)] {
            let found = depth_share(x * (GRAVITY_M_S2 / 7.0f64).sqrt(), 7.0);
            assert!((found - share).abs() < 6e-6, "{x}: {found}");
        }
        let peak = 2.0 * PI / 6.2322;
        for (depth, hs) in [(3.0, 1.030), (5.0, 1.285), (10.0, 1.670), (20.0, 2.003), (50.0, 2.136)] {
            let found = 2.1391 * depth_share_of_sea(peak, 3.3, depth).sqrt();
            assert!((found / hs - 1.0).abs() < 1.5e-3, "{depth}: {found}");
        }
    }

    #[test]
    fn the_highest_of_a_thousand_is_rayleigh_s() {
        assert!((highest_over_significant(1000.0) - 1.86).abs() < 5e-3);
    }
}
