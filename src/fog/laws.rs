//! Fog laws of older simulators, for pictures that must look as they did there, and the distance beyond which a host
//! may cull.
//!
//! Beware of a naming trap: texts about these laws call the **visibility** V "fog" (1 = clear, 0 = all fog), while
//! shaders mix by the share of fog, 1 - V. Here [`CompatibilityLaw::visibility`] is V, the transmittance.

use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, Result, check_range},
    moment::MAX_EXTINCTION_PER_M,
};

/// Kind of distance that a compatibility law uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum DistanceKind {
    /// Distance from the camera's centre. Turning on the spot changes nothing.
    #[default]
    Range,
    /// Distance from the camera's plane, as in the oldest systems. Objects at the picture's edge gain fog when the
    /// camera turns toward them.
    Plane,
}

/// Curve of the visibility V over the distance d.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Curve {
    /// V = (end - d)/(end - start), clamped: no fog before the start, all fog after the end.
    Linear {
        /// Distance at which fog begins, m, \[0, 1e9\].
        start_m: f64,
        /// Distance from which only fog is visible, m, above `start_m` and at most 1e9.
        end_m: f64,
    },
    /// V = exp(-density d).
    Exponential {
        /// Density, 1/m, \[0, 10\].
        density_per_m: f64,
    },
    /// V = exp(-(density d)^2).
    ExponentialSquared {
        /// Density, 1/m, \[0, 10\].
        density_per_m: f64,
    },
}

/// Fog law: a curve, its kind of distance and its colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CompatibilityLaw {
    /// Curve of the visibility.
    pub curve: Curve,
    /// Kind of distance, range or plane.
    pub distance: DistanceKind,
    /// Radiance of full fog, per channel, each \[0, 1e12\]. `None` takes the radiance of a deep layer of fog under the
    /// current light (see [`super::FogModel::new`]).
    pub colour: Option<[f64; 3]>,
    /// Height above the horizon over which fog on sky pixels decreases from full to none, rad, \[0, pi\]. 0 leaves the
    /// sky clear, so culled objects would vanish visibly in front of it; pi covers the whole sky.
    pub sky_band: f64,
}

impl CompatibilityLaw {
    /// Checks that every field is within its range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
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

    /// Returns the distance, m, beyond which less than `threshold` of an object's colour is left; infinite if there is
    /// no such distance. The distance is of the law's kind: for plane distance, it is measured from the camera's plane.
    pub fn cull_distance_m(&self, threshold: f64) -> f64 {
        let depth = -threshold.ln();
        match self.curve {
            Curve::Linear { start_m, end_m } => end_m - threshold * (end_m - start_m),
            Curve::Exponential { density_per_m } => depth / density_per_m,
            Curve::ExponentialSquared { density_per_m } => depth.sqrt() / density_per_m,
        }
    }
}

/// Largest contrast that is invisible in an 8-bit picture: 1/255.
pub const CULL_THRESHOLD: f64 = 1.0 / 255.0;

/// Returns the distance, m, beyond which a host may cull in air of this uniform extinction (for a visibility see
/// [`super::koschmieder_extinction_per_m`]): less than 1/255 of an object's contrast is left there. Infinite in clear
/// air. The picture without the culled objects is the same only if the background is fogged as well, as Welkin's sky
/// is.
pub fn cull_distance_m(extinction_per_m: f64) -> f64 {
    -CULL_THRESHOLD.ln() / extinction_per_m
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(curve: Curve) -> CompatibilityLaw {
        CompatibilityLaw { curve, distance: DistanceKind::Range, colour: None, sky_band: 0.0 }
    }

    /// The printed example has start 5, end 40 and density 0.05.
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
