//! Uniforms of a frame's clouds. Their fields are described in `shaders/clouds/`: `block.wgsl`, `picture.wgsl` and
//! `shadow_map.wgsl`.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{DMat2, DVec2};

use crate::{
    clouds::{
        field::{
            cells::AreaCell,
            cover_threshold::CoverThreshold,
            layer_map::LayerMap,
            layers::CloudLayers,
            map::{MAP_CELLS, SECOND_OFFSET, SECOND_PERIOD, SECOND_TURN_RAD},
            shape::{Shape, WIDTH_CELLS},
        },
        light::{
            layer_light::{LayerLight, light_on},
            transport::{Scattering, Transport},
        },
    },
    falling::MAX_AREAS,
    moment::SceneMoment,
    weather::MAX_CLOUD_LAYERS,
};

/// One layer of cloud.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct LayerUniform {
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

/// A cell of cloud over a rain area.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct AreaUniform {
    pub place: [f32; 4],
    pub extent: [f32; 4],
}

/// Scattering of one medium.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct MediumUniform {
    pub lobes: [f32; 4],
    pub smooth: [f32; 4],
}

/// All clouds of a frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct CloudsUniform {
    pub to_sun: [f32; 3],
    pub layer_count: u32,
    pub altitude: f32,
    pub radius: f32,
    pub jitter: f32,
    pub unused: f32,
    pub media: [MediumUniform; 2],
    pub layers: [LayerUniform; MAX_CLOUD_LAYERS],
    pub areas: [AreaUniform; MAX_AREAS],
}

/// Reprojection of a picture's clouds, and the pixels that this frame marches.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct PictureUniform {
    pub size: [u32; 2],
    pub side: u32,
    pub place: u32,
    pub before: [[f32; 4]; 4],
    pub moved: [f32; 3],
    pub exposed: f32,
}

/// Projection of the clouds' shadow map.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct ShadowUniform {
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
    pub fn new(scattering: &Scattering) -> Self {
        let l = &scattering.lobes;
        Self {
            lobes: [l.g_hg, l.g_draine, l.alpha, l.w_draine].map(|v| v as f32),
            smooth: [scattering.forward, scattering.cap, scattering.turning(), scattering.scaled_albedo()]
                .map(|v| v as f32),
        }
    }
}

impl LayerUniform {
    /// Creates the uniform of a layer for a camera at `place_m` (east and north of the world's origin). `share` of the
    /// layer is drawn as a volume, the rest as a deck.
    pub fn new(s: &Shape, share: f64, place_m: DVec2, light: &LayerLight, medium: (usize, &Scattering)) -> Self {
        // Positions in periods are reduced in f64, because f32 has too few digits for metres from a far origin.
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

impl CloudLayers {
    /// Creates the uniforms of a moment, with the scattering of these media.
    pub fn uniform(&self, now: &SceneMoment<'_>, exposure: f64, media: &[Arc<Transport>; 2]) -> CloudsUniform {
        let scene = &now.scene;
        let light = scene.brighter();
        let mut layers = [bytemuck::Zeroable::zeroed(); MAX_CLOUD_LAYERS];
        for (to, layer) in layers.iter_mut().zip(self.layers()) {
            let of = (layer.medium(), &media[layer.medium()].scattering);
            let light = light_on(scene, (&layer.shape, self.is_placed()), exposure);
            *to = LayerUniform::new(&layer.shape, layer.share, self.place_m, &light, of);
        }
        self.place_uniforms(&mut layers);
        CloudsUniform {
            to_sun: light.direction.as_vec3().to_array(),
            layer_count: self.layers().len() as u32,
            altitude: scene.place.altitude_m as f32,
            radius: now.planet_radius_m.min(1e9) as f32,
            jitter: 0.5,
            unused: 0.0,
            media: [0, 1].map(|i| MediumUniform::new(&media[i].scattering)),
            layers,
            areas: self.area_uniforms(),
        }
    }

    /// Adds the cover that varies with the place, by the host's cover map and over rain areas, to the layers' uniforms.
    fn place_uniforms(&self, layers: &mut [LayerUniform; MAX_CLOUD_LAYERS]) {
        if !self.is_placed() {
            return;
        }
        let mut row = 0;
        for (i, (to, layer)) in layers.iter_mut().zip(self.layers()).enumerate() {
            let piled = layer.shape.held * layer.shape.dome * layer.shape.dome;
            to.cells[2] = piled as f32;
            if let Some(LayerMap { map, slope_per_m, .. }) = self.maps[i].as_deref() {
                let camera = (self.place_m - DVec2::from_array(map.first_m)) / map.cell_m;
                to.mapped = [camera.x, camera.y, 1.0 / map.cell_m, f64::from(row)].map(|v| v as f32);
                to.cells = [map.cells[0] as f32, map.cells[1] as f32, piled as f32, *slope_per_m as f32];
                row += map.cells[1];
            }
            if let Some(areas) = self.areas.as_ref().filter(|areas| areas.layer == i) {
                let CoverThreshold { threshold, dome, extinction_per_m } = areas.filled;
                to.filled = [threshold, dome, extinction_per_m, areas.count as f64].map(|v| v as f32);
                to.cells[3] += areas.slope_per_m() as f32;
            }
        }
    }

    /// Returns the uniforms of the cells over rain areas.
    fn area_uniforms(&self) -> [AreaUniform; MAX_AREAS] {
        let one = |cell: &AreaCell| {
            let center = cell.center_m - self.place_m;
            AreaUniform {
                place: [center.x, center.y, cell.right.x, cell.right.y].map(|v| v as f32),
                extent: [cell.semi_m.x, cell.semi_m.y, cell.rim_m, cell.semi_m.min_element()].map(|v| v as f32),
            }
        };
        let cells = self.areas.map_or([AreaCell::default(); MAX_AREAS], |areas| areas.cells);
        cells.map(|cell| one(&cell))
    }
}

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
