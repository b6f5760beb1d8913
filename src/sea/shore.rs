//! Waves at a shore: shoaling, turning and breaking; the tide.

use std::f64::consts::PI;

use super::dispersion::{GRAVITY_M_S2, group_speed_m_s, wave_number};

/// Ratio of the height of breaking waves to the depth (McCowan 1894).
pub const BREAKING_INDEX: f64 = 0.78;
/// Period of the principal lunar tide M2, s (12.4206 h).
pub const LUNAR_TIDE_S: f64 = 44_714.16;

/// Form in which waves break on a slope.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Breaker {
    /// Foam slides down the front: gentle slopes.
    Spilling,
    /// The crest curls over.
    Plunging,
    /// The front runs up steep slopes without breaking.
    Surging,
}

/// Returns the ratio of the height of waves at a depth to that in deep water, without turning: sqrt(cg0 / cg), because
/// the flux of energy stays the same (Rayleigh 1911).
pub fn shoaling(period_s: f64, depth_m: f64) -> f64 {
    let w = 2.0 * PI / period_s;
    let deep_m_s = 0.5 * GRAVITY_M_S2 / w;
    (deep_m_s / group_speed_m_s(wave_number(w, depth_m), depth_m)).sqrt()
}

/// Returns the ratio of the height of waves at the shallow depth h2, `to_depth_m`, to that at the shallow depth h1,
/// `from_depth_m`, by Green's law (1838): (h1 / h2)^(1/4).
pub fn green_ratio(from_depth_m: f64, to_depth_m: f64) -> f64 {
    libm::sqrt(libm::sqrt(from_depth_m / to_depth_m))
}

/// Returns the angle, rad, between wave crests and straight depth contours at a depth, for the angle in deep water:
/// Snell's law with phase speeds.
pub fn refracted_angle(period_s: f64, depth_m: f64, deep_angle: f64) -> f64 {
    let w = 2.0 * PI / period_s;
    let slower = w * w / (GRAVITY_M_S2 * wave_number(w, depth_m));
    libm::asin((slower * libm::sin(deep_angle)).clamp(-1.0, 1.0))
}

/// Place where waves break.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Breaking {
    /// Depth, m.
    pub depth_m: f64,
    /// Height of the wave there, m.
    pub height_m: f64,
}

/// Returns where waves of a deep-water height, a period and an angle in deep water break on a gentle slope: where
/// shoaling and turning have raised them to [`BREAKING_INDEX`] times the depth.
pub fn breaking(height_m: f64, period_s: f64, deep_angle: f64) -> Breaking {
    let raised_m = |depth_m: f64| {
        let angle = refracted_angle(period_s, depth_m, deep_angle);
        let turned = libm::cos(deep_angle) / libm::cos(angle);
        height_m * shoaling(period_s, depth_m) * turned.sqrt()
    };
    let (mut low, mut high) = (1e-6 * height_m, 10.0 * height_m);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if raised_m(middle) > BREAKING_INDEX * middle { low = middle } else { high = middle }
    }
    let depth_m = 0.5 * (low + high);
    Breaking { depth_m, height_m: BREAKING_INDEX * depth_m }
}

/// Returns how waves break on a slope, given as its tangent, by the number of Iribarren: the slope over the square root
/// of H / L0, with the height H at breaking and the length L0 in deep water. Waves spill below 0.4 and surge from 2.0
/// on (Battjes 1974).
pub fn breaker(slope: f64, breaking_height_m: f64, period_s: f64) -> Breaker {
    let deep_length_m = GRAVITY_M_S2 * period_s * period_s / (2.0 * PI);
    let iribarren = slope / (breaking_height_m / deep_length_m).sqrt();
    if iribarren < 0.4 {
        Breaker::Spilling
    } else if iribarren < 2.0 {
        Breaker::Plunging
    } else {
        Breaker::Surging
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_shoal_as_linear_theory_says() {
        for (depth, wanted) in [(20.0, 0.9181), (10.0, 0.9327), (5.0, 1.0227), (2.0, 1.2256), (1.0, 1.4345)] {
            let found = shoaling(8.0, depth);
            assert!((found - wanted).abs() < 1e-4, "{depth}: {found}");
        }
        let least = (1..2000).map(|i| 0.05 * f64::from(i)).map(|d| (shoaling(8.0, d), d));
        let (least, depth) = least.min_by(|a, b| a.0.total_cmp(&b.0)).expect("some");
        let length = GRAVITY_M_S2 * 64.0 / (2.0 * PI);
        assert!((least - 0.9130).abs() < 1e-4 && (depth / length - 0.159).abs() < 2e-3, "{least} {depth}");
        assert!((green_ratio(5.0, 1.0) - 1.495).abs() < 1e-3);
        assert!((shoaling(8.0, 1.0) / shoaling(8.0, 5.0) - 1.403).abs() < 1e-3);
    }

    #[test]
    fn waves_turn_to_the_shore_and_break() {
        for (depth, deg) in [(10.0, 20.78), (5.0, 15.40), (2.0, 10.00)] {
            let found = refracted_angle(8.0, depth, 30f64.to_radians()).to_degrees();
            assert!((found - deg).abs() < 6e-3, "{depth}: {found}");
        }
        let straight = breaking(2.0, 10.0, 0.0);
        assert!((straight.depth_m - 3.139).abs() < 1e-3 && (straight.height_m - 2.449).abs() < 1e-3, "{straight:?}");
        let turned = breaking(2.0, 10.0, 30f64.to_radians());
        assert!((turned.depth_m - 2.977).abs() < 1e-3, "{turned:?}");
        let kinds = [0.02, 0.1, 0.5].map(|slope| breaker(slope, 2.0, 8.0));
        assert_eq!(kinds, [Breaker::Spilling, Breaker::Plunging, Breaker::Surging]);
    }
}
