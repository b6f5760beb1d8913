//! Extinction of a layer at a place, in f64. `shaders/clouds/field.wgsl` has the same formulas in f32; the folder's
//! `mod.rs` explains the model.

use glam::{DMat2, DVec2, DVec3};

use super::{
    map::{MAP_CELLS, Map, SECOND_OFFSET, SECOND_PERIOD, SECOND_TURN_RAD},
    placed::LocalCover,
    shape::{Shape, dome, smooth},
    solid::Solid,
};

/// Mean of the solid noise.
const SOLID_MEAN: f64 = 0.47;
/// Reciprocal of the range that contains nearly all of the solid noise.
const SOLID_GAIN: f64 = 2.2;

/// Amount, in units of `rough`, up to which the solid noise raises the excess, except in rare peaks.
pub(crate) const MOST_FRAYED: f64 = 0.8;

/// Clouds of a layer.
pub struct Field<'a> {
    /// Shape of the clouds.
    pub shape: Shape,
    /// Map of where clouds grow.
    pub map: &'a Map,
    /// Solid noise that frays the edges of clouds.
    pub solid: &'a Solid,
    /// Local cover that overrides the layer's own.
    pub(crate) placed: LocalCover,
}

impl Field<'_> {
    /// Returns the map's number at a place, m east and north of the world's origin. Cloud grows where it is above the
    /// threshold.
    pub fn strength(&self, place_m: DVec2) -> f64 {
        let s = &self.shape;
        let cell = s.stretch * (place_m - s.drift_m) / s.scale_m;
        let first = self.map.at(cell / MAP_CELLS);
        let turned = DMat2::from_angle(SECOND_TURN_RAD) * (cell - s.evolution);
        let second = self.map.at(turned / (MAP_CELLS * SECOND_PERIOD) + SECOND_OFFSET);
        let c = s.cellular;
        let scale = 1.0 / (2.0 * (c * c + (1.0 - c) * (1.0 - c))).sqrt();
        ((first[0] + second[1]) * (1.0 - c) + (first[2] + second[3]) * c) * scale
    }

    /// Returns the field with the local cover of a position. Also returns the distance within which this cover holds,
    /// m, and the largest change of the threshold per metre beyond it.
    pub(crate) fn here(&self, position_m: DVec3) -> (Self, [f64; 2]) {
        let mut shape = self.shape;
        let steady = self.placed.shape_at(self.upright(position_m), &mut shape);
        (Self { shape, placed: LocalCover::default(), ..*self }, steady)
    }

    /// Returns the horizontal position of a place, m, without the lean by which its cloud lies downwind of the layer's
    /// base.
    pub(crate) fn upright(&self, position_m: DVec3) -> DVec2 {
        let s = &self.shape;
        let height = (position_m.z - s.base_m) / s.thickness_m;
        position_m.truncate() - s.lean_m * (height * height)
    }

    /// Returns the excess of the map's number over the threshold at a position, before dome and fraying.
    pub(crate) fn over(&self, position_m: DVec3) -> f64 {
        let s = &self.shape;
        self.strength(self.upright(position_m)) - s.threshold
    }

    /// Returns the amount that the solid noise adds to the excess at a place.
    pub(crate) fn frays(&self, position_m: DVec3) -> f64 {
        let s = &self.shape;
        let level = s.stretch * (self.upright(position_m) - s.drift_m);
        let at = level.extend(position_m.z - s.base_m) / s.solid_m;
        s.rough * smooth(s, (position_m.z - s.base_m) / s.thickness_m) * SOLID_GAIN * (self.solid.at(at) - SOLID_MEAN)
    }

    /// Returns the extinction, 1/m, for an excess from which the dome is subtracted and to which fraying is added.
    pub(crate) fn dense(&self, excess: f64) -> f64 {
        self.shape.extinction_per_m * (excess / self.shape.soft).clamp(0.0, 1.0)
    }

    /// Returns the extinction, 1/m, at a place `position_m` (east and north of the world's origin, above the sea).
    pub fn extinction_per_m(&self, position_m: DVec3) -> f64 {
        let height = (position_m.z - self.shape.base_m) / self.shape.thickness_m;
        if !(0.0..=1.0).contains(&height) {
            return 0.0;
        }
        let (here, _) = self.here(position_m);
        let over = here.over(position_m);
        let excess = over - dome(&here.shape, over, height);
        if excess < -MOST_FRAYED * here.shape.rough {
            return 0.0;
        }
        here.dense(excess + here.frays(position_m))
    }
}
