//! Drops around a camera in or near the rim of rain areas: how many of each class fall at each place.
//!
//! The weather and each area have their own number of drops in every class. At each place these numbers are averaged
//! with the areas' shares there as weights. Only the drops whose index is below the average are drawn. A drop's index
//! does not depend on its place, so the rain is thinned evenly, and every view keeps the same drops. A camera with no
//! rim nearby sees one rain, without this average.

use std::ops::Range;

use super::{
    classes::Classes,
    shaft::{AreaField, ColumnUniform, EyeInWorld, RainColumn},
    shells::CLASSES,
    splash::Splashes,
};
use crate::{falling::MAX_AREAS, weather::Falling};

/// Number of rains in a mixture: the weather's and each area's.
const STATES: usize = MAX_AREAS + 1;
/// Number of vectors of four that hold one number per rain.
const ROWS: usize = STATES.div_ceil(4);

/// Uniform blocks `Columns` of `shaders/rain/area.wgsl` and `Local` of `shaders/rain/local.wgsl`, which describe the
/// fields, as one upload.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct LocalUniform {
    pub count: u32,
    pub pad: [u32; 3],
    pub list: [ColumnUniform; MAX_AREAS],
    pub counts: [[f32; 4]; CLASSES * ROWS],
    pub weights: [[f32; 4]; ROWS],
    pub splashes: [[f32; 4]; ROWS],
    pub cones: [[f32; 4]; ROWS],
}

/// Size of the columns of [`LocalUniform`], which are bound as a block of their own.
pub(super) const COLUMNS_BYTES: usize = std::mem::offset_of!(LocalUniform, counts);
/// Range of bytes of `Local` in the buffer, after the columns.
pub(super) const LOCAL: Range<usize> = {
    let at = COLUMNS_BYTES.next_multiple_of(256);
    at..at + size_of::<LocalUniform>() - COLUMNS_BYTES
};

/// Rain of one column that reaches the camera.
pub(crate) struct LocalColumn<'a> {
    /// Column in the layout of the shaders.
    pub uniform: ColumnUniform,
    /// Share of its rain that has left its cloud at the camera's altitude.
    pub begun: f64,
    /// Number of drops of each class in a shell of the column's rain.
    pub classes: &'a Classes,
}

/// Rain that falls within reach of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Local {
    /// One rain, the same everywhere within reach.
    Pure(Falling),
    /// Mixture of the given rain, outside the columns, with that of some columns: bit `i` is set for column `i`.
    Mixed(Falling, u32),
}

impl Local {
    /// Finds the rain within `reach_m` of a camera, from the rain of the weather and of the columns of `field`.
    pub fn new(weather: &Falling, field: &AreaField, eye: EyeInWorld<'_>, reach_m: f64) -> Self {
        let mut local = Self::Pure(*weather);
        for (i, column) in field.columns.iter().enumerate() {
            let shaft = column.shaft();
            let [least, most] = shaft.share_within(eye.position, eye.to_enu, eye.altitude_m, reach_m);
            let begun = shaft.begun(eye.altitude_m);
            local = match local {
                _ if least >= 1.0 && begun >= 1.0 => Self::Pure(shaft.falling),
                _ if most <= 0.0 => local,
                Self::Pure(falling) => Self::Mixed(falling, 1 << i),
                Self::Mixed(falling, bits) => Self::Mixed(falling, bits | 1 << i),
            };
        }
        local
    }

    /// Returns whether the rain contains drops.
    pub fn has_drops(&self, field: &AreaField) -> bool {
        let wet = |f: &Falling| f.rain_mm_h + f.drizzle_mm_h > 0.0;
        match self {
            Self::Pure(f) => wet(f),
            Self::Mixed(f, bits) => {
                let mixed = |(i, c): (usize, &RainColumn)| bits & (1 << i) != 0 && wet(&c.shaft().falling);
                wet(f) || field.columns.iter().enumerate().any(mixed)
            }
        }
    }
}

impl Classes {
    /// Returns classes that have, in each class, the larger number of drops and the larger flux of `self` and `other`.
    /// Weight and extinction are those of `self`.
    pub(crate) fn enveloped(&self, other: &Self) -> Self {
        let (mut upto, mut envelope) = (0.0, *self);
        for k in 0..CLASSES {
            upto += self.count(k).max(other.count(k));
            envelope.table[k][2] = upto as f32;
            if other.flux[k].2 > self.flux[k].2 {
                envelope.flux[k] = other.flux[k];
            }
        }
        envelope.per_shell = upto as u32;
        envelope
    }

    /// Returns these classes for the share `share` of all drops: flux, extinction and the number of all drops (drawn
    /// drops times weight) are multiplied by `share`. Each drawn drop then represents one drop.
    pub(crate) fn part(&self, share: f64) -> Self {
        let mut part = *self;
        part.flux.iter_mut().for_each(|c| c.2 *= share);
        part.extinction_per_m *= share;
        part.per_shell = (f64::from(part.per_shell) * part.weight * share) as u32;
        part.weight = 1.0;
        part
    }

    /// Returns these classes with `share` times the number, flux and extinction of `other` added. The table of counts
    /// is unchanged.
    pub(crate) fn with(&self, share: f64, other: &Self) -> Self {
        let (mut sum, other) = (*self, other.part(share));
        for (to, from) in sum.flux.iter_mut().zip(other.flux) {
            to.2 += from.2;
        }
        sum.extinction_per_m += other.extinction_per_m;
        sum.per_shell += other.per_shell;
        sum
    }

    /// Returns the number of drops of a class in a shell.
    pub(crate) fn count(&self, class: usize) -> f64 {
        let before = if class > 0 { self.table[class - 1][2] } else { 0.0 };
        f64::from(self.table[class][2] - before)
    }
}

impl LocalUniform {
    /// Creates the mixture of the `weather`'s drops with those of some columns, and classes with enough drops for every
    /// rain of the mixture.
    pub fn new<'a>(weather: &Classes, columns: impl Iterator<Item = LocalColumn<'a>>) -> (Self, Classes) {
        let mut block: Self = bytemuck::Zeroable::zeroed();
        let mut envelope = *weather;
        let mut put = |state: usize, classes: &Classes, begun: f64| {
            let (row, at) = (state / 4, state % 4);
            for k in 0..CLASSES {
                block.counts[k * ROWS + row][at] = (classes.count(k) * begun) as f32;
            }
            block.weights[row][at] = classes.weight as f32;
            // Stores the rate. The last loop of this function divides it by the rate of the envelope.
            block.splashes[row][at] = (Splashes::new(classes).drawn_per_m2_s * begun) as f32;
            block.cones[row][at] = (classes.extinction_per_m * begun) as f32;
        };
        put(0, weather, 1.0);
        let mut list = [ColumnUniform::NONE; MAX_AREAS];
        let mut count = 0;
        for LocalColumn { uniform, begun, classes } in columns.take(MAX_AREAS) {
            list[count] = uniform;
            count += 1;
            put(count, classes, begun);
            envelope = envelope.enveloped(classes);
        }
        let most = Splashes::new(&envelope).drawn_per_m2_s.max(1e-9) as f32;
        for rate in block.splashes.iter_mut().flatten() {
            *rate = (*rate / most).min(1.0);
        }
        (block.count, block.list) = (count as u32, list);
        (block, envelope)
    }

    /// Makes the cones' extinctions relative to `extinction_per_m`, the extinction of the drops that the cones' block
    /// is made for.
    pub fn set_cones(&mut self, extinction_per_m: f64) {
        let all = extinction_per_m.max(1e-12) as f32;
        self.cones.iter_mut().flatten().for_each(|v| *v /= all);
    }
}

#[cfg(test)]
mod tests {
    use std::mem::offset_of;

    use glam::{DMat3, DVec3};

    use super::*;
    use crate::{
        falling::{
            FallingLayer,
            area::{AreaShape, RainArea, Shaft},
        },
        gpu::shader,
    };

    #[test]
    fn offsets_are_those_of_the_shaders() {
        let text = shader::assemble("rain/local.wgsl").unwrap();
        let (columns, _) = shader::struct_layout(&text, "Columns").unwrap();
        assert_eq!(columns as usize, offset_of!(LocalUniform, counts));
        let (size, members) = shader::struct_layout(&text, "Local").unwrap();
        assert_eq!(size as usize, size_of::<LocalUniform>() - columns as usize);
        for (name, at) in [
            ("counts", offset_of!(LocalUniform, counts)),
            ("weights", offset_of!(LocalUniform, weights)),
            ("splashes", offset_of!(LocalUniform, splashes)),
            ("cones", offset_of!(LocalUniform, cones)),
        ] {
            assert!(members.contains(&(name.into(), at as u32 - columns)), "{name}: {members:?}");
        }
        shader::assert_layout!(
            "rain/local.wgsl",
            "Column",
            ColumnUniform,
            [
                center, lean, right, semi, rim, ground, top, extinction, fallen, turn, fine, near, corners, later,
                radius, soft, edges
            ]
        );
    }

    #[test]
    fn only_a_camera_near_a_rim_sees_a_mixture() {
        let area = RainArea { shape: AreaShape::Ellipse([1000.0, 600.0]), rim_m: 200.0, ..RainArea::default() };
        let dry = crate::weather::derive(&Default::default()).unwrap().precipitation;
        let at = |x: f64| {
            let shaft = Shaft::new(&area, 0, (DVec3::ZERO, 0.0), (6.0, Default::default()), 0.0);
            let eye = EyeInWorld { position: DVec3::X * x, to_enu: &DMat3::IDENTITY, altitude_m: 0.0 };
            let own = FallingLayer::NONE;
            let field = AreaField::new(std::iter::once(shaft), eye, &own, 0.0);
            let local = Local::new(&dry, &field, eye, 4.0);
            (local, local.has_drops(&field))
        };
        assert_eq!(at(0.0), (Local::Pure(area.falling()), true));
        assert_eq!(at(900.0), (Local::Mixed(dry, 1), true));
        assert_eq!(at(1100.0), (Local::Pure(dry), false));
    }
}
