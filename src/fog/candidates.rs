//! Ways to draw a layer of fog that the lab charts against each other, and their cost.

use super::{
    laws::{CompatibilityLaw, Curve, DistanceKind},
    layer::{FogLayer, Law},
    visibility::CONTRAST_THRESHOLD,
};
use crate::plan::parts::{Part, Worth};
use crate::plan::{Listed, StepWork, Units, Work};

/// Fog, mist, dust and precipitation, as one part of the plan. Its importance, 0.9, is that of the air
/// (`sky::candidates::AIR`).
pub const FOG: Part = Part { name: "fog", rungs: &["all", "none"], importance: 0.9, worth: Worth::Composed(1) };

/// Work of the layer, in units of the work of a pixel in which no part is drawn. Measured on a software driver (`cargo
/// bench -- parts`).
pub(crate) const FOG_WORK: StepWork = StepWork { object: 0.26, sky: 0.26, fixed: 0.0 };

/// Curve of older simulators, used instead of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FogCurve {
    /// [`Curve::Linear`], starting at the eye.
    Linear,
    /// [`Curve::Exponential`] with the layer's extinction.
    Exponential,
    /// [`Curve::ExponentialSquared`].
    ExponentialSquared,
}

/// Method to draw fog.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum FogMethod {
    /// The closed form at every pixel, with the smallest pipeline that can draw the law.
    #[default]
    Exact,
    /// The closed form at every pixel, with the pipeline for all laws.
    ExactForAll,
    /// The closed form without the layer's patches.
    Even,
    /// The closed form in cells over (picture, distance), looked up at every pixel, as in hosts' transparent shaders.
    Froxels {
        /// Number of cells across the picture, up, and in distance.
        cells: [u32; 3],
    },
    /// A curve over the distance. It has the visibility of air that has the layer's extinction everywhere.
    Curve(FogCurve),
}

impl FogMethod {
    /// Returns the law with which this method draws `layer`.
    pub fn law(self, layer: &FogLayer) -> Law {
        let sigma = layer.extinction_per_m;
        // Visibility, m: distance at which the share `CONTRAST_THRESHOLD` of the contrast is left.
        let visibility = -CONTRAST_THRESHOLD.ln() / sigma.max(1e-12);
        let curve = match self {
            Self::Even => return Law::Layer(FogLayer { patches: None, ..*layer }),
            Self::Exact | Self::ExactForAll | Self::Froxels { .. } => return Law::Layer(*layer),
            Self::Curve(FogCurve::Linear) => {
                Curve::Linear { start_m: 0.0, end_m: (visibility / (1.0 - CONTRAST_THRESHOLD)).min(1e9) }
            }
            Self::Curve(FogCurve::Exponential) => Curve::Exponential { density_per_m: sigma },
            Self::Curve(FogCurve::ExponentialSquared) => {
                Curve::ExponentialSquared { density_per_m: (-CONTRAST_THRESHOLD.ln()).sqrt() / visibility }
            }
        };
        // The older simulators measured from the camera's plane and kept the upper part of the sky clear.
        Law::Compatibility(CompatibilityLaw { curve, distance: DistanceKind::Plane, colour: None, sky_band: 0.35 })
    }

    /// Returns the cost of the method.
    fn work(self) -> Work {
        let sample = |samples: f64| Work { pixel: Units { samples, texels: 0.0, bytes: 8.0 }, ..Work::default() };
        match self {
            // 12 exponentials and 12 square roots: about the work of 6 steps of ray marching.
            Self::Exact | Self::Even => sample(6.0),
            Self::ExactForAll => sample(10.0),
            Self::Curve(_) => sample(1.0),
            Self::Froxels { cells } => {
                let count = cells.iter().map(|n| f64::from(*n)).product::<f64>();
                Work {
                    // The cells move with the camera, so they are drawn anew in every frame.
                    view: Units { samples: 6.0 * count, texels: 0.0, bytes: 16.0 * count },
                    pixel: Units { samples: 0.5, texels: 4.0, bytes: 8.0 },
                    view_bytes: (16.0 * count) as u64,
                    ..Work::default()
                }
            }
        }
    }
}

/// Returns all candidates.
pub fn candidates() -> Vec<Listed<FogMethod>> {
    let froxels = |x, y, z| FogMethod::Froxels { cells: [x, y, z] };
    let named = [
        ("exact", FogMethod::Exact),
        ("exact-for-all", FogMethod::ExactForAll),
        ("even", FogMethod::Even),
        ("froxels-16", froxels(16, 9, 16)),
        ("froxels-32", froxels(32, 18, 32)),
        ("froxels-64", froxels(64, 36, 64)),
        ("linear", FogMethod::Curve(FogCurve::Linear)),
        ("exponential", FogMethod::Curve(FogCurve::Exponential)),
        ("exponential-squared", FogMethod::Curve(FogCurve::ExponentialSquared)),
    ];
    named.map(|(name, method)| Listed { name, method, work: method.work() }).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_curve_leaves_the_same_contrast_at_the_visibility() {
        let layer = FogLayer::ground_fog(0.02, 50.0, 10.0);
        let v = -CONTRAST_THRESHOLD.ln() / 0.02;
        for curve in [FogCurve::Linear, FogCurve::Exponential, FogCurve::ExponentialSquared] {
            let Law::Compatibility(law) = FogMethod::Curve(curve).law(&layer) else { panic!("{curve:?}") };
            assert!((law.visibility(v) - CONTRAST_THRESHOLD).abs() < 1e-9, "{curve:?}: {}", law.visibility(v));
            law.validate().unwrap();
        }
        assert_eq!(FogMethod::Exact.law(&layer), Law::Layer(layer));
    }
}
