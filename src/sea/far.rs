//! The sea far away and under ice: distance and dip of the horizon, waves that ice lets through.

/// Mean radius of the Earth, m.
pub const EARTH_RADIUS_M: f64 = 6_371_000.0;

/// Returns the distance of the geometric horizon along the line of sight, m, for an eye at a height above the sea,
/// without refraction.
pub fn horizon_distance_m(eye_height_m: f64, radius_m: f64) -> f64 {
    (eye_height_m * (2.0 * radius_m + eye_height_m)).max(0.0).sqrt()
}

/// Returns the angle of the geometric horizon below the horizontal, rad.
pub fn horizon_dip(eye_height_m: f64, radius_m: f64) -> f64 {
    // As the tangent, since the arc cosine loses the digits of small angles.
    libm::atan(horizon_distance_m(eye_height_m, radius_m) / radius_m)
}

/// Returns the rate, 1/m, at which ice floes take energy from waves of a frequency, Hz: 2.12e-3 f^2 + 4.59e-2 f^4
/// (Meylan, Bennetts and Kohout 2014).
pub fn ice_attenuation_per_m(frequency_hz: f64) -> f64 {
    let square = frequency_hz * frequency_hz;
    2.12e-3 * square + 4.59e-2 * square * square
}

/// Returns the share of their height that waves of a period keep behind ice of the width `width_m`, m.
pub fn height_through_ice(period_s: f64, width_m: f64) -> f64 {
    libm::exp(-0.5 * ice_attenuation_per_m(1.0 / period_s) * width_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn horizons_are_those_of_the_earth() {
        for (eye, distance, dip) in
            [(2.0, 5048.0, 0.0454), (10.0, 11_288.0, 0.1015), (20.0, 15_964.0, 0.1436), (50.0, 25_241.0, 0.2270)]
        {
            assert!((horizon_distance_m(eye, EARTH_RADIUS_M) - distance).abs() < 0.6, "{eye}");
            assert!((horizon_dip(eye, EARTH_RADIUS_M).to_degrees() - dip).abs() < 6e-5, "{eye}");
        }
    }

    #[test]
    fn ice_lets_long_waves_through() {
        for (period, share) in [(6.0, 0.624), (8.0, 0.801), (10.0, 0.879), (12.0, 0.919)] {
            let found = height_through_ice(period, 10_000.0);
            assert!((found - share).abs() < 6e-4, "{period}: {found}");
        }
    }
}
