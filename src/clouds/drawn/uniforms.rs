//! Uniforms of a frame's clouds. They have the layouts of `shaders/clouds/`: `block.wgsl`, `picture.wgsl` and
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
    /// Altitude of the base, m; 1/thickness, 1/m; 1/distance from cloud to cloud, 1/m; extinction inside, 1/m.
    pub size: [f32; 4],
    /// Threshold of the map, dome, amplitude of the fraying, 1/softness.
    pub shape: [f32; 4],
    /// Position of the camera on the map's first and second sheet, in their periods.
    pub sheets: [f32; 4],
    /// Position of the camera in the solid noise, east and north, in periods; 0, because the noise begins at the
    /// layer's base; share of the cellular pattern.
    pub solid: [f32; 4],
    /// Illuminance by the sun or moon on a surface that faces it, lux times exposure.
    pub sun: [f32; 4],
    /// Radiance of sky and higher clouds above the layer, cd/m^2 times exposure.
    pub above: [f32; 4],
    /// Radiance of ground and lower clouds below the layer, cd/m^2 times exposure; scaled optical depth of a cloud from
    /// side to side.
    pub below: [f32; 4],
    /// Index of the medium; ratio of scaled extinction to extinction; share of the layer that is drawn as a volume;
    /// 1/side of the solid noise, 1/m.
    pub medium: [f32; 4],
    /// Matrix to the pattern before its stretch along the wind: xx, xy and yy; growth of the domes of cumulus with the
    /// excess.
    pub stretch: [f32; 4],
    /// Distance that the top lies downwind of the base (east, north), m; least excess that has an anvil above it;
    /// length of the first two, m.
    pub lean: [f32; 4],
    /// Host's map: position of the camera (east, north), in cells from the middle of the first cell; 1/side of a cell,
    /// 1/m; row of the map's first texels.
    pub mapped: [f32; 4],
    /// Number of the map's cells east and north, 0 without a map; growth of the domes times the dome squared; largest
    /// change of the threshold per metre.
    pub cells: [f32; 4],
    /// Threshold, dome and extinction, 1/m, where the layer is filled over rain areas; number of areas, 0 for other
    /// layers.
    pub filled: [f32; 4],
}

/// A cell of cloud over a rain area.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct AreaUniform {
    /// Middle, m east and north of the camera; unit vector to the right.
    pub place: [f32; 4],
    /// Half extents to the right and ahead, width of the edge, smaller half extent, m.
    pub extent: [f32; 4],
}

/// Scattering of one medium.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct MediumUniform {
    /// Phase function: asymmetry of the Henyey-Greenstein lobe and of Draine's, Draine's alpha, weight of Draine's.
    pub lobes: [f32; 4],
    /// Share of scattering that counts as straight on; value at which the phase function is cut off, 1/sr; 1 -
    /// asymmetry of the rest; single-scattering albedo of the rest.
    pub smooth: [f32; 4],
}

/// All clouds of a frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct CloudsUniform {
    /// Unit vector towards the sun or moon that lights the clouds, (east, north, up) at the camera.
    pub to_sun: [f32; 3],
    /// Number of layers.
    pub layer_count: u32,
    /// Altitude of the camera, m.
    pub altitude: f32,
    /// Radius of the planet's ground, m.
    pub radius: f32,
    /// Offset of a ray's samples within their steps, 0 to 1.
    pub jitter: f32,
    /// Padding.
    pub unused: f32,
    /// Scattering of droplets (0) and ice (1).
    pub media: [MediumUniform; 2],
    /// Layers, of which the first `layer_count` are in use.
    pub layers: [LayerUniform; MAX_CLOUD_LAYERS],
    /// Cells of cloud over rain areas.
    pub areas: [AreaUniform; MAX_AREAS],
}

/// Reprojection of a picture's clouds, and the pixels that this frame marches.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct PictureUniform {
    /// Size of the picture, pixels.
    pub size: [u32; 2],
    /// Side of a square of pixels, of which each frame marches one.
    pub side: u32,
    /// Index of the pixel in the square that this frame marches.
    pub place: u32,
    /// Matrix from a place relative to the last frame's camera (east, north, up), m, to that frame's clip space. From a
    /// place relative to this frame's camera, `moved` is subtracted first.
    pub before: [[f32; 4]; 4],
    /// Movement of a cloud relative to the camera since the last frame (east, north, up), m.
    pub moved: [f32; 3],
    /// Ratio of this frame's exposure to the last one's, 0 without history.
    pub exposed: f32,
}

/// Projection of the clouds' shadow map.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct ShadowUniform {
    /// Unit vector towards the light (east, north, up), never level.
    pub to_light: [f32; 3],
    /// Height of the map's plane above the sea, m.
    pub plane: f32,
    /// Position of the camera in the map, in periods.
    pub camera: [f32; 2],
    /// Side of the map, m; the map repeats with this period.
    pub period: f32,
    /// Height of the camera above the plane, m.
    pub eye: f32,
    /// Mean share of the direct light over all places.
    pub mean: f32,
    /// Weight of the map against `mean`, 0 to 1.
    pub map_weight: f32,
    /// Height above the plane, m, at and above which the mean share holds.
    pub top: f32,
    /// Extinction of the air at the camera's height, 1/m.
    pub haze: f32,
    /// Scale height of the extinction `haze`, m.
    pub haze_height: f32,
    /// Padding.
    pub pad: [f32; 3],
}

impl MediumUniform {
    /// Creates the uniform of a medium.
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

/// Returns a vector with a fourth number.
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
            [to_light, plane, camera, period, eye, mean, map_weight, top, haze, haze_height]
        );
    }
}
