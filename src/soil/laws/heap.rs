//! Heaps: rated heaps of buckets, cones, and the swell of dug soil.

/// Returns the volume, m^3, of soil heaped on a level opening with the sides `sides_m`: a hipped roof that rises by
/// `rise` per unit of length from all four sides. `rise` is 1 for excavator buckets in SAE J296 and ISO 7451; it is 0.5
/// in CECE, and for loaders in SAE J742 and ISO 7546.
pub fn heap_volume_m3(sides_m: [f64; 2], rise: f64) -> f64 {
    let (short, long) = (sides_m[0].min(sides_m[1]), sides_m[0].max(sides_m[1]));
    rise * (short * short * short / 6.0 + short * short * (long - short) / 4.0)
}

/// Returns the radius of the base, m, of a cone of this volume and this slope, radians.
pub fn cone_radius_m(volume_m3: f64, slope: f64) -> f64 {
    libm::cbrt(3.0 * volume_m3 / (std::f64::consts::PI * libm::tan(slope)))
}

/// Returns the bank volume of a unit of loose volume, for soil that swells by the share `swell`.
pub fn load_factor(swell: f64) -> f64 {
    1.0 / (1.0 + swell)
}

/// Returns the share of loose volume that is new voids.
pub fn voids_share(swell: f64) -> f64 {
    swell / (1.0 + swell)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rated_heaps_are_those_of_the_standards() {
        assert!((heap_volume_m3([1.2, 1.5], 1.0) - 0.396).abs() < 1e-12);
        assert!((heap_volume_m3([1.5, 1.2], 0.5) - 0.198).abs() < 1e-12);
        // A square carries a pyramid.
        assert!((heap_volume_m3([2.0, 2.0], 1.0) - 4.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn cones_and_swell_are_those_of_the_tables() {
        for (slope, radius) in [(30.0f64, 1.183), (34.0, 1.123), (45.0, 0.985)] {
            assert!((cone_radius_m(1.0, slope.to_radians()) - radius).abs() < 6e-4, "{slope}");
        }
        assert_eq!([load_factor(0.25), voids_share(0.25)], [0.8, 0.2]);
        assert!((load_factor(0.67) - 0.599).abs() < 5e-4 && (voids_share(0.67) - 0.401).abs() < 5e-4);
    }
}
