//! Waves of a ship: the angles and lengths of Kelvin's wake by speed, length of the hull and depth.

use std::f64::consts::PI;

use super::dispersion::GRAVITY_M_S2;

/// Exponent with which wake waves decay over distance inside the wedge.
pub const INSIDE_DECAY: f64 = -0.5;
/// Exponent with which wake waves decay over distance along the cusps.
pub const CUSP_DECAY: f64 = -1.0 / 3.0;

/// Returns the half angle, rad, of the wake in deep water: asin(1/3) (Kelvin 1887).
pub fn deep_half_angle() -> f64 {
    libm::asin(1.0 / 3.0)
}

/// Returns the length, m, of the transverse waves on the ship's track: 2 pi U^2 / g.
pub fn transverse_length_m(speed_m_s: f64) -> f64 {
    2.0 * PI * speed_m_s * speed_m_s / GRAVITY_M_S2
}

/// Returns the length, m, of the waves at the cusps: 2/3 of [`transverse_length_m`].
pub fn cusp_length_m(speed_m_s: f64) -> f64 {
    transverse_length_m(speed_m_s) * 2.0 / 3.0
}

/// Returns the angle, rad, between the ship's course and the direction in which waves at the cusps travel: acos(sqrt(2
/// / 3)).
pub fn cusp_wave_angle() -> f64 {
    libm::acos(libm::sqrt(2.0 / 3.0))
}

/// Returns the angle, rad, at which a wake is highest, by the hull's Froude number U / sqrt(g L): Kelvin's up to 0.489,
/// then falling (Rabaud and Moisy 2013). The wedge itself keeps Kelvin's angle.
pub fn highest_angle(hull_froude: f64) -> f64 {
    let square = 2.0 * PI * hull_froude * hull_froude;
    if square <= 1.5 {
        return deep_half_angle();
    }
    libm::atan((square - 1.0).sqrt() / (2.0 * square - 1.0))
}

/// Returns the half angle, rad, of the wake at a depth, by the depth's Froude number U / sqrt(g h) (Havelock 1908): the
/// largest angle at which energy leaves the ship's track. It is that of deep water for small numbers, 90 degrees at 1,
/// and asin(1 / F) above.
pub fn half_angle_at_depth(depth_froude: f64) -> f64 {
    let froude = depth_froude;
    if froude >= 1.0 {
        return libm::asin(1.0 / froude);
    }
    // A wave at the angle t off the course stays with the ship if its speed is U cos t; its energy follows at the group
    // speed, n times that. Energy that left the ship a while ago lies at tan a = n cos t sin t / (1 - n cos^2 t).
    let angle = |x: f64| {
        let cos2 = libm::tanh(x) / x / (froude * froude);
        let n = 0.5 * (1.0 + 2.0 * x / libm::sinh(2.0 * x));
        let sin2 = (1.0 - cos2).max(0.0);
        libm::atan2(n * libm::sqrt(cos2 * sin2), 1.0 - n * cos2)
    };
    // The longest possible wave runs with the ship: x_0 = k h with tanh(x_0) / x_0 = F^2.
    let (mut low, mut high) = (1e-6, 1e3);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if libm::tanh(middle) / middle > froude * froude { low = middle } else { high = middle }
    }
    // The angle rises from 0 at x_0 to one maximum and falls: golden sections in the logarithm of x.
    let (mut from, mut until) = (libm::log(high), libm::log(1e3f64.max(100.0 * high)));
    let ratio = 0.618_033_988_749_895;
    for _ in 0..120 {
        let (a, b) = (until - ratio * (until - from), from + ratio * (until - from));
        if angle(libm::exp(a)) > angle(libm::exp(b)) { until = b } else { from = a }
    }
    angle(libm::exp(0.5 * (from + until)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deep_wakes_are_kelvin_s() {
        assert!((deep_half_angle().to_degrees() - 19.471).abs() < 1e-3);
        assert!((transverse_length_m(5.0) - 16.01).abs() < 6e-3 && (transverse_length_m(10.0) - 64.05).abs() < 6e-3);
        assert!((cusp_wave_angle().to_degrees() - 35.264).abs() < 1e-3);
        assert!((cusp_length_m(5.0) / transverse_length_m(5.0) - 2.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn fast_hulls_raise_narrow_wakes() {
        for (froude, deg) in [(0.3, 19.471), (0.6, 17.68), (1.0, 11.24), (2.0, 5.69)] {
            let found = highest_angle(froude).to_degrees();
            assert!((found - deg).abs() < 6e-3, "{froude}: {found}");
        }
        // Continuous where the hull's length begins to matter.
        let (before, after) = (highest_angle(0.4886), highest_angle(0.4887));
        assert!((before - after).abs() < 1e-3, "{before} {after}");
    }

    #[test]
    fn shallow_water_widens_the_wedge() {
        for (froude, deg) in
            [(0.1, 19.471), (0.7, 20.53), (0.8, 24.32), (0.9, 34.62), (0.99, 67.9), (1.2, 56.44), (2.0, 30.0)]
        {
            let found = half_angle_at_depth(froude).to_degrees();
            assert!((found - deg).abs() < 0.06, "{froude}: {found}");
        }
    }
}
