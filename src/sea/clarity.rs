//! Clarity of the sea: how fast light fades, by Jerlov's type of water or by the light that a metre leaves.

use serde::{Deserialize, Serialize};

use super::water::WaterType;
use crate::error::{Result, check_range};

/// Range of [`WaterClarity::Percent`]: type 7C to type I.
const PERCENT: [f64; 2] = [41.1, 98.1];

/// Clarity of the water.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum WaterClarity {
    /// An optical type of Jerlov's.
    Type(WaterType),
    /// Share of downward blue light (450 nm) that a metre of water leaves, percent. Range [41.1, 98.1], which are types
    /// 7C and I; attenuations between two types are interpolated in their logarithms.
    Percent(f64),
}

impl Default for WaterClarity {
    /// The clear open sea: type IB.
    fn default() -> Self {
        Self::Type(WaterType::IB)
    }
}

impl WaterClarity {
    /// Checks the percentage. A type is always valid.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming `clarity.percent`.
    pub fn validate(&self) -> Result<()> {
        let Self::Percent(percent) = self else { return Ok(()) };
        check_range("clarity.percent", *percent, PERCENT[0], PERCENT[1], "%")
    }

    /// Returns the diffuse attenuation of downward light, 1/m, at 450, 550 and 650 nm.
    pub fn diffuse_attenuation_per_m(self) -> [f64; 3] {
        let percent = match self {
            Self::Type(of) => return of.diffuse_attenuation_per_m(),
            Self::Percent(percent) => percent.clamp(PERCENT[0], PERCENT[1]),
        };
        let blue = -libm::log(0.01 * percent);
        let known = WaterType::ALL.map(WaterType::diffuse_attenuation_per_m);
        let above = known.iter().position(|k| k[0] >= blue).unwrap_or(known.len() - 1).max(1);
        let (low, high) = (known[above - 1], known[above]);
        let share = (libm::log(blue / low[0]) / libm::log(high[0] / low[0])).clamp(0.0, 1.0);
        std::array::from_fn(|i| low[i] * libm::pow(high[i] / low[i], share))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percents_meet_the_types_and_lie_between_them() {
        for of in WaterType::ALL {
            let wanted = of.diffuse_attenuation_per_m();
            let percent = 100.0 * (-wanted[0]).exp();
            let found = WaterClarity::Percent(percent).diffuse_attenuation_per_m();
            // The ends of the range are rounded.
            assert!(found.iter().zip(wanted).all(|(f, w)| (f / w - 1.0).abs() < 2e-2), "{of:?}: {found:?}");
        }
        let [ii, iii] = [WaterType::II, WaterType::III].map(WaterType::diffuse_attenuation_per_m);
        let between = WaterClarity::Percent(100.0 * (-0.1f64).exp()).diffuse_attenuation_per_m();
        assert!((between[0] - 0.1).abs() < 1e-12, "{between:?}");
        assert!((0..3).all(|i| (ii[i]..=iii[i]).contains(&between[i])), "{between:?}");
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        for percent in [f64::NAN, 41.0, 98.2, 0.0, 100.0] {
            let e = WaterClarity::Percent(percent).validate().expect_err("out of range");
            assert_eq!(e.field(), Some("clarity.percent"), "{e}");
        }
        WaterClarity::Percent(80.0).validate().expect("in range");
    }
}
