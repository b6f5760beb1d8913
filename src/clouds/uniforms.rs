//! The clouds of a frame as shaders read them (`shaders/clouds/block.wgsl`, `picture.wgsl`).

use bytemuck::{Pod, Zeroable};
use glam::{DMat2, DVec2};

use super::{
    field::{MAP_CELLS, SECOND_OFFSET, SECOND_PERIOD, SECOND_TURN_RAD, Shape},
    transport::Scattering,
};
use crate::falling::MAX_AREAS;

/// Most layers.
pub(super) const LAYERS: usize = crate::weather::MAX_CLOUD_LAYERS;

/// One layer.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct LayerUniform {
    pub size: [f32; 4],
    pub shape: [f32; 4],
    pub sheets: [f32; 4],
    pub solid: [f32; 4],
    pub sun: [f32; 4],
    pub above: [f32; 4],
    pub below: [f32; 4],
    pub medium: [f32; 4],
    pub stretch: [f32; 4],
    pub lean: [f32; 4],
    pub mapped: [f32; 4],
    pub cells: [f32; 4],
    pub filled: [f32; 4],
}

/// A cell over a rain area.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct AreaUniform {
    pub place: [f32; 4],
    pub extent: [f32; 4],
}

/// One medium.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct MediumUniform {
    pub lobes: [f32; 4],
    pub smooth: [f32; 4],
}

/// All of them.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct CloudsUniform {
    pub to_sun: [f32; 3],
    pub layer_count: u32,
    pub altitude: f32,
    pub radius: f32,
    pub jitter: f32,
    pub unused: f32,
    pub media: [MediumUniform; 2],
    pub layers: [LayerUniform; LAYERS],
    pub areas: [AreaUniform; MAX_AREAS],
}

/// How a picture's clouds are spread over frames.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct PictureUniform {
    pub size: [u32; 2],
    pub side: u32,
    pub place: u32,
    pub before: [[f32; 4]; 4],
    pub moved: [f32; 3],
    pub exposed: f32,
}

/// The map of the clouds' shadows.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct ShadowUniform {
    pub to_light: [f32; 3],
    pub plane: f32,
    pub camera: [f32; 2],
    pub period: f32,
    pub eye: f32,
    pub mean: f32,
    pub told: f32,
    pub top: f32,
    pub haze: f32,
    pub haze_height: f32,
    pub pad: [f32; 3],
}

impl MediumUniform {
    pub fn new(of: &Scattering) -> Self {
        let l = &of.lobes;
        Self {
            lobes: [l.g_hg, l.g_draine, l.alpha, l.w_draine].map(|v| v as f32),
            smooth: [of.forward, of.cap, of.turning(), of.scaled_albedo()].map(|v| v as f32),
        }
    }
}

/// Light on a layer from what is above and below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LayerLight {
    /// Illuminance by the sun or moon on what faces it, lux times exposure a channel.
    pub sun: [f64; 3],
    /// Radiance of all above, and of all below, cd/m^2 times exposure a channel.
    pub above: [f64; 3],
    /// See `above`.
    pub below: [f64; 3],
}

impl LayerUniform {
    /// Creates the block of a layer over which the camera stands at `place_m` (east and north of the world's origin).
    /// `share` of it is drawn as a volume, the rest as a deck.
    pub fn new(s: &Shape, share: f64, place_m: DVec2, light: &LayerLight, medium: (usize, &Scattering)) -> Self {
        // Positions in periods, reduced in f64: metres of a far origin have no digits left in f32.
        let level = s.stretch * (place_m - s.drift_m);
        let cell = level / s.scale_m;
        let first = cell / MAP_CELLS;
        let second =
            DMat2::from_angle(SECOND_TURN_RAD) * (cell - s.evolution) / (MAP_CELLS * SECOND_PERIOD) + SECOND_OFFSET;
        let solid = level / s.solid_m;
        let [first, second, solid] = [first, second, solid].map(|v| [v.x, v.y].map(|v| v.rem_euclid(1.0) as f32));
        let scaled = medium.1.scale();
        let width = WIDTH_CELLS * s.scale_m * s.extinction_per_m * scaled;
        Self {
            size: [s.base_m, 1.0 / s.thickness_m, 1.0 / s.scale_m, s.extinction_per_m].map(|v| v as f32),
            shape: [s.threshold, s.dome, s.rough, 1.0 / s.soft].map(|v| v as f32),
            sheets: [first[0], first[1], second[0], second[1]],
            solid: [solid[0], solid[1], 0.0, s.cellular as f32],
            sun: padded(light.sun, 0.0),
            above: padded(light.above, 0.0),
            below: padded(light.below, width),
            medium: [medium.0 as f32, scaled as f32, share as f32, 1.0 / s.solid_m as f32],
            stretch: [s.stretch.x_axis.x, s.stretch.x_axis.y, s.stretch.y_axis.y, s.held].map(|v| v as f32),
            lean: [s.lean_m.x, s.lean_m.y, s.anvil, s.lean_m.length()].map(|v| v as f32),
            ..Self::zeroed()
        }
    }
}

fn padded(v: [f64; 3], last: f64) -> [f32; 4] {
    [v[0], v[1], v[2], last].map(|v| v as f32)
}

/// Width of a cloud from side to side, in cells.
pub(super) const WIDTH_CELLS: f64 = 0.6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shaders() {
        shader::assert_layout!(
            "clouds/block.wgsl",
            "CloudsUniform",
            CloudsUniform,
            [to_sun, layer_count, altitude, radius, jitter, media, layers, areas]
        );
        shader::assert_layout!(
            "clouds/picture.wgsl",
            "CloudsPicture",
            PictureUniform,
            [size, side, place, before, moved, exposed]
        );
        shader::assert_layout!(
            "clouds/shadow_map.wgsl",
            "CloudShadows",
            ShadowUniform,
            [to_light, plane, camera, period, eye, mean, told, top, haze, haze_height]
        );
    }
}
