//! Single waves that a host adds to the sea: each with a height, a length or a period, a direction and a phase.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::{
    bins::toward_of,
    dispersion::{angular_frequency, wave_number},
    lattice::SeaWave,
};
use crate::error::{Error, Result, check_range};

/// Maximum number of single waves.
pub const MAX_SINGLE_WAVES: usize = 16;
/// Largest ratio of a regular wave's height to its length in deep water. At a depth the limit is this times tanh(k h)
/// (Miche 1944).
pub const MOST_SINGLE_STEEPNESS: f64 = 0.142;

/// Length or period of a wave; the other follows from the depth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum WaveScale {
    /// Wave length, m. Range [0.1, 2000].
    Length(f64),
    /// Period, s. Range [0.25, 40].
    Period(f64),
}

/// A regular wave whose crests are infinitely long, added to all others.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SingleWave {
    /// Height from trough to crest, m. Range [0, 40]. The steepness of a wave is its height over the product of its
    /// length and tanh(k h). The steepnesses of all single waves together are at most 0.142 (Miche 1944).
    pub height_m: f64,
    /// Length or period.
    pub scale: WaveScale,
    /// Direction that it comes from, degrees clockwise from true north. Range [0, 360].
    pub from_deg: f64,
    /// Time of a crest at the world's origin, in degrees of the period after simulation time 0. Range [-360, 360].
    pub phase_deg: f64,
}

impl SingleWave {
    /// Checks all fields except the steepness.
    fn validate(&self) -> Result<()> {
        check_range("height_m", self.height_m, 0.0, 40.0, "m")?;
        match self.scale {
            WaveScale::Length(length_m) => check_range("length_m", length_m, 0.1, 2000.0, "m")?,
            WaveScale::Period(period_s) => check_range("period_s", period_s, 0.25, 40.0, "s")?,
        }
        check_range("from_deg", self.from_deg, 0.0, 360.0, "degrees")?;
        check_range("phase_deg", self.phase_deg, -360.0, 360.0, "degrees")
    }

    /// Returns the wave at a depth.
    pub(super) fn wave(&self, depth_m: f64) -> SeaWave {
        let k = match self.scale {
            WaveScale::Length(length_m) => TAU / length_m,
            WaveScale::Period(period_s) => wave_number(TAU / period_s, depth_m),
        };
        let w = match self.scale {
            WaveScale::Length(_) => angular_frequency(k, depth_m),
            WaveScale::Period(period_s) => TAU / period_s,
        };
        SeaWave {
            amplitude_m: 0.5 * self.height_m,
            toward: toward_of(self.from_deg),
            turns_per_m: k / TAU,
            frequency_hz: w / TAU,
            phase: self.phase_deg / 360.0,
            stretch: 1.0 / libm::tanh(k * depth_m),
        }
    }
}

/// Checks a list of waves over a depth.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming the wave and its field, or `waves` if there are too many.
pub(super) fn validate(waves: &[SingleWave], depth_m: f64) -> Result<()> {
    if waves.len() > MAX_SINGLE_WAVES {
        return Err(Error::range("waves", &format!("at most {MAX_SINGLE_WAVES} waves"), waves.len()));
    }
    let mut left = MOST_SINGLE_STEEPNESS;
    for (i, single) in waves.iter().enumerate() {
        single.validate().map_err(|e| e.within(&format!("waves[{i}]")))?;
        let wave = single.wave(depth_m);
        let most_m = left / (wave.turns_per_m * wave.stretch);
        if single.height_m > most_m {
            let accepted = format!("at most {most_m:.4} m at this length and depth, beside the waves before it");
            return Err(Error::range(&format!("waves[{i}].height_m"), &accepted, single.height_m));
        }
        left = (left - single.height_m * wave.turns_per_m * wave.stretch).max(0.0);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SWELL: SingleWave =
        SingleWave { height_m: 2.0, scale: WaveScale::Length(100.0), from_deg: 270.0, phase_deg: 0.0 };

    #[test]
    fn lengths_and_periods_are_one_wave() {
        let long = SWELL.wave(10.0);
        let timed = SingleWave { scale: WaveScale::Period(1.0 / long.frequency_hz), ..SWELL }.wave(10.0);
        assert!((timed.turns_per_m / long.turns_per_m - 1.0).abs() < 1e-12);
        // w^2 = g k tanh k h: 10.7243 s.
        assert!((1.0 / long.frequency_hz - 10.7243).abs() < 1e-3, "{}", 1.0 / long.frequency_hz);
        assert!((long.toward.x - 1.0).abs() < 1e-15 && long.toward.y.abs() < 1e-15);
    }

    #[test]
    fn faults_are_named_with_their_range() {
        let faults = [
            ("waves[1].height_m", SingleWave { height_m: -1.0, ..SWELL }),
            ("waves[1].height_m", SingleWave { height_m: 14.3, ..SWELL }),
            ("waves[1].height_m", SingleWave { height_m: f64::NAN, ..SWELL }),
            ("waves[1].length_m", SingleWave { scale: WaveScale::Length(0.0), ..SWELL }),
            ("waves[1].period_s", SingleWave { scale: WaveScale::Period(0.0), ..SWELL }),
            ("waves[1].from_deg", SingleWave { from_deg: 361.0, ..SWELL }),
            ("waves[1].phase_deg", SingleWave { phase_deg: f64::INFINITY, ..SWELL }),
        ];
        for (field, wave) in faults {
            let e = validate(&[SWELL, wave], 4000.0).expect_err(field);
            assert_eq!(e.field(), Some(field), "{e}");
        }
        validate(&[SingleWave { height_m: 14.19, ..SWELL }], 4000.0).expect("just not breaking");
        // Seven waves of 2 m on 100 m are the steepest sum.
        validate(&[SWELL; 7], 4000.0).expect("0.14");
        assert_eq!(validate(&[SWELL; 8], 4000.0).expect_err("0.16").field(), Some("waves[7].height_m"));
        assert_eq!(validate(&[SWELL; 17], 4000.0).expect_err("17").field(), Some("waves"));
        // Shallow water breaks lower waves.
        validate(&[SingleWave { height_m: 1.7, ..SWELL }], 2.0).expect("0.142 L tanh(k h) is 1.775 m");
        assert!(validate(&[SingleWave { height_m: 1.8, ..SWELL }], 2.0).is_err());
    }
}
