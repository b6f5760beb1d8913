//! The fog laws of older simulators, kept for pictures that must look as before, and the distance beyond which a host
//! may cull.
//!
//! A trap in their names: texts about these laws call the **visibility** V "fog" (1 = clear, 0 = all fog), while
//! shaders mix by the fog's share 1 - V. Here [`CompatibilityLaw::visibility`] is V, the transmittance.

use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, Result, check_range},
    moment::MAX_EXTINCTION_PER_M,
};

/// Kind of distance that a compatibility law takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum DistanceKind {
    /// From the camera's centre: turning on the spot changes nothing.
    #[default]
    Range,
    /// From the camera's plane, as the oldest systems have it: objects at the picture's edge gain fog when the camera
    /// turns toward them.
    Plane,
}

/// The curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Curve {
    /// V = (end - d)/(end - start), clamped: none before the start, all after the end.
    Linear {
        /// Where fog begins, m, \[0, 1e9\].
        start_m: f64,
        /// Where nothing is left, m, above `start_m`.
        end_m: f64,
    },
    /// V = exp(-density d).
    Exponential {
        /// 1/m, \[0, 10\].
        density_per_m: f64,
    },
    /// V = exp(-(density d)^2).
    ExponentialSquared {
        /// 1/m, \[0, 10\].
        density_per_m: f64,
    },
}

/// A curve with its distance and colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CompatibilityLaw {
    /// The curve.
    pub curve: Curve,
    /// Range or plane.
    pub distance: DistanceKind,
    /// Radiance that the picture fades into, per channel; `None` takes what a deep layer under this light would show
    /// (see [`super::FogModel::new`]).
    pub colour: Option<[f64; 3]>,
    /// Sky pixels fade fully at the horizon and not at all this high above it, rad, \[0, pi\]: 0 leaves the sky as it
    /// is (then culled objects would vanish before it), pi covers all of it.
    pub sky_band: f64,
}

impl CompatibilityLaw {
    /// Refuses what is not a law, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        match self.curve {
            Curve::Linear { start_m, end_m } => {
                check_range("fog.start_m", start_m, 0.0, 1e9, "m")?;
                check_range("fog.end_m", end_m, 0.0, 1e9, "m")?;
                if end_m <= start_m {
                    return Err(Error::range("fog.end_m", &format!("above start_m, {start_m} m"), end_m));
                }
            }
            Curve::Exponential { density_per_m } | Curve::ExponentialSquared { density_per_m } => {
                check_range("fog.density_per_m", density_per_m, 0.0, MAX_EXTINCTION_PER_M, "1/m")?;
            }
        }
        for c in self.colour.iter().flatten() {
            check_range("fog.colour", *c, 0.0, 1e12, "")?;
        }
        check_range("fog.sky_band", self.sky_band, 0.0, std::f64::consts::PI, "rad")
    }

    /// Returns the share of an object's colour that is left at `distance_m`: 1 clear, 0 all fog.
    pub fn visibility(&self, distance_m: f64) -> f64 {
        match self.curve {
            Curve::Linear { start_m, end_m } => ((end_m - distance_m) / (end_m - start_m)).clamp(0.0, 1.0),
            Curve::Exponential { density_per_m } => (-density_per_m * distance_m).exp(),
            Curve::ExponentialSquared { density_per_m } => (-(density_per_m * distance_m).powi(2)).exp(),
        }
    }

    /// Distance beyond which less than `threshold` of an object's colour is left, m; infinite if that never happens.
    /// Measured as the law measures: from the plane if it takes plane distance.
    pub fn cull_distance_m(&self, threshold: f64) -> f64 {
        let depth = -threshold.ln();
        match self.curve {
            Curve::Linear { start_m, end_m } => end_m - threshold * (end_m - start_m),
            Curve::Exponential { density_per_m } => depth / density_per_m,
            Curve::ExponentialSquared { density_per_m } => depth.sqrt() / density_per_m,
        }
    }
}

/// Largest contrast that an 8-bit picture cannot show: 1/255.
pub const CULL_THRESHOLD: f64 = 1.0 / 255.0;

/// Distance beyond which a host may cull in a homogeneous extinction (of a visibility:
/// [`super::koschmieder_extinction_per_m`]), m: there less than 1/255 of an object's contrast is left. Infinite in
/// clear air. The picture without the culled objects is the same only if what lies behind them is fogged as well, as
/// Welkin's sky is.
pub fn cull_distance_m(extinction_per_m: f64) -> f64 {
    -CULL_THRESHOLD.ln() / extinction_per_m
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(curve: Curve) -> CompatibilityLaw {
        CompatibilityLaw { curve, distance: DistanceKind::Range, colour: None, sky_band: 0.0 }
    }

    /// The printed example: start 5, end 40, density 0.05.
    #[test]
    fn the_source_systems_table_is_met() {
        let rows = [
            (Curve::Linear { start_m: 5.0, end_m: 40.0 }, [1.0, 0.857, 0.571, 0.286, 0.0]),
            (Curve::Exponential { density_per_m: 0.05 }, [0.779, 0.607, 0.368, 0.223, 0.135]),
            (Curve::ExponentialSquared { density_per_m: 0.05 }, [0.939, 0.779, 0.368, 0.105, 0.018]),
        ];
        for (curve, want) in rows {
            for (d, v) in [5.0, 10.0, 20.0, 30.0, 40.0].into_iter().zip(want) {
                assert!((law(curve).visibility(d) - v).abs() < 5e-4, "{curve:?} at {d}");
            }
        }
    }

    #[test]
    fn beyond_the_cull_distance_nothing_shows_and_just_before_it_something_does() {
        for curve in [
            Curve::Linear { start_m: 5.0, end_m: 40.0 },
            Curve::Exponential { density_per_m: 0.05 },
            Curve::ExponentialSquared { density_per_m: 0.05 },
        ] {
            let far = law(curve).cull_distance_m(CULL_THRESHOLD);
            assert!(law(curve).visibility(far * 1.001) < CULL_THRESHOLD, "{curve:?}");
            assert!(law(curve).visibility(far * 0.999) > CULL_THRESHOLD, "{curve:?}");
        }
        let exp = law(Curve::Exponential { density_per_m: 0.05 });
        assert!((exp.cull_distance_m(CULL_THRESHOLD) - 5.54 / 0.05).abs() < 0.1);
        let squared = law(Curve::ExponentialSquared { density_per_m: 0.05 });
        assert!((squared.cull_distance_m(CULL_THRESHOLD) - 2.35 / 0.05).abs() < 0.1);
        assert!((cull_distance_m(super::super::koschmieder_extinction_per_m(1000.0)) - 1849.7).abs() < 1.0);
        assert!(cull_distance_m(0.0).is_infinite());
    }

    #[test]
    fn faults_are_named() {
        let says = |c| law(c).validate().unwrap_err().to_string();
        assert!(says(Curve::Linear { start_m: 5.0, end_m: 5.0 }).contains("fog.end_m"));
        assert!(says(Curve::Exponential { density_per_m: f64::NAN }).contains("fog.density_per_m"));
        let bad = CompatibilityLaw {
            colour: Some([0.0, f64::INFINITY, 0.0]),
            ..law(Curve::Linear { start_m: 0.0, end_m: 1.0 })
        };
        assert!(bad.validate().unwrap_err().to_string().contains("fog.colour"));
    }
}
