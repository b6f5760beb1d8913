//! Dispersion of waves: wave number, phase and group speed at a depth, with surface tension, and on a current.

use std::f64::consts::PI;

/// Acceleration of gravity in all of the sea's laws, m/s^2. The Earth's is 9.780 at the equator and 9.832 at the poles.
pub const GRAVITY_M_S2: f64 = 9.81;
/// Surface tension of sea water over its density, m^3/s^2 (0.0742 N/m over 1025 kg/m^3).
pub const TENSION_M3_S2: f64 = 7.24e-5;

/// Returns the angular frequency, rad/s, of waves of wave number `k_per_m` at a depth: w^2 = (g k + t k^3) tanh(k h)
/// (Lamb 1932, article 267).
pub fn angular_frequency(k_per_m: f64, depth_m: f64) -> f64 {
    let k = k_per_m;
    (k * (GRAVITY_M_S2 + TENSION_M3_S2 * k * k) * libm::tanh(k * depth_m)).sqrt()
}

/// Returns the wave number, 1/m, of waves of angular frequency `w_rad_s` at a depth: the inverse of
/// [`angular_frequency`], by Newton's method to the last bits.
pub fn wave_number(w_rad_s: f64, depth_m: f64) -> f64 {
    let squared = w_rad_s * w_rad_s;
    if squared <= 0.0 {
        return 0.0;
    }
    // Eckart (1952) is within 5 % for gravity waves. Surface tension alone would give the wave number (w^2 /
    // tension)^(1/3), which is close for capillary waves: the smaller of the two is the start.
    let deep = squared / GRAVITY_M_S2;
    let gravity = deep / libm::sqrt(libm::tanh(deep * depth_m));
    let mut k = gravity.min(libm::cbrt(squared / TENSION_M3_S2));
    for _ in 0..40 {
        let t = libm::tanh(k * depth_m);
        let stiffness = k * (GRAVITY_M_S2 + TENSION_M3_S2 * k * k);
        let rise = (GRAVITY_M_S2 + 3.0 * TENSION_M3_S2 * k * k) * t + stiffness * depth_m * (1.0 - t * t);
        let step = (stiffness * t - squared) / rise;
        // A step never more than halves the wave number, so that it stays positive.
        let next = (k - step).max(0.5 * k);
        if (next - k).abs() <= 1e-15 * k {
            return next;
        }
        k = next;
    }
    k
}

/// Returns the group speed dw/dk, m/s, of waves of wave number `k_per_m` at a depth.
pub fn group_speed_m_s(k_per_m: f64, depth_m: f64) -> f64 {
    let k = k_per_m;
    let t = libm::tanh(k * depth_m);
    let stiffness = k * (GRAVITY_M_S2 + TENSION_M3_S2 * k * k);
    let rise = (GRAVITY_M_S2 + 3.0 * TENSION_M3_S2 * k * k) * t + stiffness * depth_m * (1.0 - t * t);
    rise / (2.0 * angular_frequency(k, depth_m))
}

/// Returns the wave length, m, of waves of a period at a depth.
pub fn wave_length_m(period_s: f64, depth_m: f64) -> f64 {
    2.0 * PI / wave_number(2.0 * PI / period_s, depth_m)
}

/// Returns the wave length in deep water, m, of waves of a period (as seen from the ground) on a current along their
/// direction. `current_m_s` is negative for a current against the waves. Returns `None` if the current blocks the
/// waves, at -g T / (8 pi) and below. The phase speed over the ground c solves (c - U)^2 = c0 c, with c0 that of still
/// water (Longuet-Higgins and Stewart 1961).
pub fn wave_length_on_current_m(period_s: f64, current_m_s: f64) -> Option<f64> {
    let still_m_s = GRAVITY_M_S2 * period_s / (2.0 * PI);
    let inner = 1.0 + 4.0 * current_m_s / still_m_s;
    // The intrinsic speed c - U is c0 (1 + sqrt(inner)) / 2; the wave length follows from it by L = 2 pi (c - U)^2 / g.
    let intrinsic_m_s = 0.5 * still_m_s * (1.0 + inner.max(0.0).sqrt());
    (inner > 0.0).then(|| 2.0 * PI * intrinsic_m_s * intrinsic_m_s / GRAVITY_M_S2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frequency_and_length_are_those_of_airy() {
        let w = angular_frequency(2.0 * PI / 100.0, 10.0);
        assert!((w / 0.585_882 - 1.0).abs() < 1e-5, "{w}");
        for (depth, period, length) in
            [(10.0, 8.0, 70.898), (5.0, 6.0, 38.090), (20.0, 10.0, 121.237), (3.0, 4.0, 18.963)]
        {
            let found = wave_length_m(period, depth);
            assert!((found / length - 1.0).abs() < 3e-5, "{depth} {period}: {found}");
        }
        assert!((group_speed_m_s(2.0 * PI / 100.0, 10.0) - 8.2912).abs() < 1e-4);
        let swell = group_speed_m_s(wave_number(2.0 * PI / 14.0, 5000.0), 5000.0);
        assert!((swell - 10.93).abs() < 5e-3, "{swell}");
    }

    #[test]
    fn capillary_waves_have_a_slowest_speed() {
        let speed = |length: f64| angular_frequency(2.0 * PI / length, 100.0) * length / (2.0 * PI);
        for (length, m_s) in [(0.1, 0.400_85), (0.05, 0.295_23), (0.005, 0.314_28), (0.017_07, 0.230_86)] {
            assert!((speed(length) / m_s - 1.0).abs() < 1e-4, "{length}: {}", speed(length));
        }
        let slowest = (1..4000).map(|i| 0.005 + 1e-5 * f64::from(i)).min_by(|a, b| speed(*a).total_cmp(&speed(*b)));
        assert!((slowest.expect("some") - 0.017_07).abs() < 2e-5, "{slowest:?}");
    }

    #[test]
    fn wave_numbers_invert_frequencies_over_the_whole_range() {
        for depth in [0.1, 1.0, 10.0, 300.0, 11_000.0] {
            let mut w = 0.02;
            while w < 400.0 {
                let k = wave_number(w, depth);
                assert!((angular_frequency(k, depth) / w - 1.0).abs() < 1e-12, "{depth} {w}: {k}");
                w *= 1.07;
            }
        }
        assert_eq!(wave_number(0.0, 10.0), 0.0);
    }

    #[test]
    fn currents_stretch_shorten_and_block() {
        for (current, length) in [(-2.0, 26.84), (-1.0, 43.38), (0.0, 56.21), (1.0, 67.68), (2.0, 78.37)] {
            let found = wave_length_on_current_m(6.0, current).expect("passes");
            assert!((found - length).abs() < 6e-3, "{current}: {found}");
        }
        let blocked = -GRAVITY_M_S2 * 6.0 / (8.0 * PI);
        assert!(wave_length_on_current_m(6.0, blocked * 1.001).is_none());
        assert!(wave_length_on_current_m(6.0, blocked * 0.999).is_some());
    }
}
