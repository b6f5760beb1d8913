//! Ice on the sea: the share of its amplitude that a wave keeps in a field of floes.
//!
//! Two laws act together. Energy fades along the way through the ice at the rate of Meylan, Bennetts and Kohout (2014).
//! The rate was measured where floes covered nearly all of the sea; here it is multiplied by the share that floes
//! cover. A thin rigid floe follows the mean of the waves under it: over a disc of radius r the mean of a wave of the
//! wave number k is 2 J1(k r) / (k r) of its height (the force of Froude and Krylov), so waves shorter than a floe do
//! not lift it.

use serde::{Deserialize, Serialize};

use super::far::ice_attenuation_per_m;
use crate::error::{Result, check_range};

/// Ice that floats on the sea, the same everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeaIce {
    /// Share of the surface under floes. Range [0, 1].
    pub cover: f64,
    /// Diameter of the floes, m. Range [0.1, 10 000].
    pub floe_m: f64,
    /// Distance that the waves have come through ice, m. Range [0, 1e7].
    pub width_m: f64,
}

impl Default for SeaIce {
    /// Half of the sea under floes of 20 m, the waves 1 km behind the ice's edge.
    fn default() -> Self {
        Self { cover: 0.5, floe_m: 20.0, width_m: 1000.0 }
    }
}

impl SeaIce {
    /// Checks all fields.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        check_range("ice.cover", self.cover, 0.0, 1.0, "")?;
        check_range("ice.floe_m", self.floe_m, 0.1, 1e4, "m")?;
        check_range("ice.width_m", self.width_m, 0.0, 1e7, "m")
    }

    /// Returns the share of its amplitude that a wave keeps.
    pub fn amplitude_share(&self, frequency_hz: f64, k_per_m: f64) -> f64 {
        let faded = libm::exp(-0.5 * self.cover * ice_attenuation_per_m(frequency_hz) * self.width_m);
        faded * (1.0 - self.cover + self.cover * floe_share(0.5 * self.floe_m * k_per_m))
    }
}

/// Returns the ratio of the mean of a wave over a disc to the wave's height, for x = k r. It is taken as 0 from its
/// first zero on.
fn floe_share(x: f64) -> f64 {
    const FIRST_ZERO: f64 = 3.831_705_970_207_512;
    if x < 1e-4 {
        return 1.0 - 0.125 * x * x;
    }
    if x >= FIRST_ZERO { 0.0 } else { 2.0 * libm::j1(x) / x }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_ice_fades_waves_as_measured() {
        // Small floes follow the surface, so that only the rate of fading acts: periods of 6, 8, 10 and 12 s, 10 km
        // into the ice.
        let ice = SeaIce { cover: 1.0, floe_m: 0.1, width_m: 1e4 };
        for (period, share) in [(6.0f64, 0.624), (8.0, 0.801), (10.0, 0.879), (12.0, 0.919)] {
            let w = std::f64::consts::TAU / period;
            let found = ice.amplitude_share(1.0 / period, w * w / 9.81);
            assert!((found - share).abs() < 6e-4, "{period}: {found}");
        }
        let open = SeaIce { cover: 0.0, ..ice };
        assert_eq!(open.amplitude_share(0.2, 0.16), 1.0);
    }

    #[test]
    fn floes_ride_long_waves_and_quell_short_ones() {
        let ice = SeaIce { cover: 0.8, floe_m: 20.0, width_m: 0.0 };
        let share = |length_m: f64| ice.amplitude_share(0.1, std::f64::consts::TAU / length_m);
        assert!(share(1000.0) > 0.998 && (share(10.0) - 0.2).abs() < 1e-12, "{} {}", share(1000.0), share(10.0));
        let falling = (1..100).map(|i| share(16.0 + 3.0 * f64::from(i))).collect::<Vec<_>>();
        assert!(falling.windows(2).all(|pair| pair[0] < pair[1]), "{falling:?}");
        // The mean over a disc, by a sum over it: k r = 2.
        let (mut sum, mut area) = (0.0, 0.0);
        for i in -500..500 {
            let x = (f64::from(i) + 0.5) / 500.0;
            let chord = (1.0 - x * x).sqrt();
            sum += chord * (2.0 * x).cos();
            area += chord;
        }
        assert!((floe_share(2.0) - sum / area).abs() < 1e-4, "{} {}", floe_share(2.0), sum / area);
    }

    #[test]
    fn faults_are_named_with_their_range() {
        for (field, ice) in [
            ("ice.cover", SeaIce { cover: 1.1, ..SeaIce::default() }),
            ("ice.floe_m", SeaIce { floe_m: 0.0, ..SeaIce::default() }),
            ("ice.width_m", SeaIce { width_m: f64::NAN, ..SeaIce::default() }),
        ] {
            assert_eq!(ice.validate().expect_err(field).field(), Some(field));
        }
        SeaIce::default().validate().expect("the default stands");
    }
}
