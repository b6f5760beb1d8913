//! Threshold, dome and extinction with which a layer has a given cover at a place. The folder's `mod.rs` defines them.

use super::{
    shape::Shape,
    thresholds::{CLEAR, threshold},
};
use crate::weather::CloudSlab;

/// Cover below which the threshold rises linearly, to [`CLEAR`] at cover 0.
const LEAST: f64 = 1e-3;
/// Least cover from which dome and extinction are computed; below it they stay the same.
const SHAPED_FROM: f64 = 0.02;
/// Threshold, dome and extinction at one place of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoverThreshold {
    /// Number of the map above which cloud grows.
    pub threshold: f64,
    /// Excess at which a cloud reaches the layer's top ([`Shape::dome`]).
    pub dome: f64,
    /// Extinction inside clouds, 1/m.
    pub extinction_per_m: f64,
}

impl CoverThreshold {
    /// Returns the values of a layer's shape.
    pub(super) fn of(shape: &Shape) -> Self {
        Self { threshold: shape.threshold, dome: shape.dome, extinction_per_m: shape.extinction_per_m }
    }

    /// Creates the values with which a layer like `slab` has this cover, 0 to 1.
    pub(crate) fn with_cover(slab: &CloudSlab, cover: f64) -> Self {
        let at = |cover: f64| threshold(&CloudSlab { cover, ..*slab });
        let own = at(cover.max(LEAST));
        let shaped = Shape::still(slab, at(cover.max(SHAPED_FROM)));
        let threshold = CLEAR + (own - CLEAR) * (cover / LEAST).min(1.0);
        Self { threshold, ..Self::of(&shaped) }
    }

    /// Interpolates between two sets of values; `t` is the weight of `other`, 0 to 1.
    pub(crate) fn mix(self, other: &Self, t: f64) -> Self {
        let between = |a: f64, b: f64| a + (b - a) * t;
        Self {
            threshold: between(self.threshold, other.threshold),
            dome: between(self.dome, other.dome),
            extinction_per_m: between(self.extinction_per_m, other.extinction_per_m),
        }
    }

    /// Writes the values into a shape. The product of `held` and the square of the dome stays the same.
    pub(super) fn put(&self, shape: &mut Shape) {
        let piled = shape.held * shape.dome * shape.dome;
        (shape.threshold, shape.dome, shape.extinction_per_m) = (self.threshold, self.dome, self.extinction_per_m);
        shape.held = piled / (self.dome * self.dome);
    }
}
