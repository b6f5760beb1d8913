//! Panorama: the clouds in all directions from the camera, for mirrors on the ground and for the cube map, which show
//! more than the picture. A frame refreshes some rows of the panorama. `shaders/between/sky_sample.wgsl` reads it from
//! the first layer of the picture's texture, in the rows after those of the picture.

use super::shadow_projection::{HistoryUse, ShadowInputs};
use crate::{
    clouds::drawn::{
        picture::{PANORAMA_SIDE, SEEN},
        rows::{self, MapRows, RowSpan, Turn},
    },
    error::Result,
    gpu::{
        Device, flat_texture,
        pass::{self, FullscreenDesc},
    },
    stage::flag,
};

/// Number of rows that a frame refreshes. While inputs change, the refresh is put off until this many rows are old.
const ROWS: u32 = 12;
/// Changes that make all rows of the panorama old. A share of a change makes that share of the rows old, and the
/// largest share holds. First: distance, m, by which the camera moves or by which the wind carries the clouds; it turns
/// a cloud 500 m up by one texel. Second: no change, but a factor: the share of the shadow map's rows that has become
/// old, times this factor, is a share of the panorama's rows. Third: change of the exposure's natural logarithm.
const AGES: (f64, f64, f64) = (12.0, 4.0, 0.01);
/// Jumps between two frames beyond which the panorama is redrawn at once, besides those that put the shadow map out of
/// date: distance by which the camera moves, m; change of the exposure's natural logarithm.
const LEAPS: (f64, f64) = (100.0, 0.05);

/// Inputs of the panorama, to detect changes.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct PanoramaInputs {
    /// Inputs that the panorama has in common with the shadow map.
    pub inputs: ShadowInputs,
    /// Altitude of the camera, m.
    pub altitude_m: f64,
    /// Exposure, display units per cd/m^2.
    pub exposure: f64,
}

/// Panorama with the pass that draws it.
pub(crate) struct CloudPanorama {
    /// Octahedral map of radiance and transmittance, of [`PANORAMA_SIDE`] texels on a side.
    pub texture: wgpu::Texture,
    /// View of the texture, into which the pass draws.
    view: wgpu::TextureView,
    /// Pipeline that draws the panorama.
    pipeline: wgpu::RenderPipeline,
    /// Inputs of the last frame that needed the panorama.
    around: Option<PanoramaInputs>,
    /// Progress of the refresh.
    rows: MapRows,
}

impl CloudPanorama {
    /// Creates the panorama; `layouts` are those of the march.
    pub fn new(device: &Device, layouts: &[&wgpu::BindGroupLayout], is_placed: bool) -> Result<Self> {
        let texture = flat_texture(
            &device.device,
            "clouds all round",
            (PANORAMA_SIDE, PANORAMA_SIDE),
            SEEN,
            wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::RENDER_ATTACHMENT,
        );
        let desc = FullscreenDesc {
            shader: "clouds/round.wgsl",
            entry: "round",
            layouts,
            targets: &[SEEN.into()],
            constants: &[("CLOUD_PLACED", flag(is_placed)), ("CLOUD_COARSE", 1.0)],
            samples: 1,
        };
        Ok(Self {
            view: texture.create_view(&Default::default()),
            pipeline: pass::fullscreen(device, &desc)?,
            texture,
            around: None,
            rows: MapRows::default(),
        })
    }

    /// Bytes of GPU memory.
    pub const BYTES: u64 = 8 * PANORAMA_SIDE as u64 * PANORAMA_SIDE as u64;

    /// Refreshes some rows once enough of them are old, but none while another map has its turn (`waits`). If the whole
    /// panorama is out of date, or the frame may use no history, all rows are drawn even then. Returns the number of
    /// passes.
    pub fn draw(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        groups: &[&wgpu::BindGroup],
        here: PanoramaInputs,
        (past, waits): (HistoryUse, bool),
    ) -> u32 {
        let before = self.around.replace(here);
        let turn = Turn {
            rests: before == Some(here),
            holds: past == HistoryUse::Kept && before.is_some_and(|b| !here.leaps_from(&b)),
            aged: before.map_or(1.0, |b| here.aged_since(&b)),
            waits,
            is_coarse: false,
        };
        let due = self.rows.due((PANORAMA_SIDE, ROWS), &turn);
        let Some((first, count)) = due else { return 0 };
        rows::draw(encoder, &self.view, RowSpan { width: PANORAMA_SIDE, first, count }, &self.pipeline, groups);
        1
    }

    /// Copies the panorama below a picture of this height.
    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder, target: &wgpu::Texture, height: u32) {
        let origin = wgpu::Origin3d { x: 0, y: height, z: 0 };
        let target = wgpu::TexelCopyTextureInfo { origin, ..target.as_image_copy() };
        encoder.copy_texture_to_texture(self.texture.as_image_copy(), target, self.texture.size());
    }
}

impl PanoramaInputs {
    /// Whether a panorama drawn from `earlier` is wholly out of date.
    fn leaps_from(&self, earlier: &Self) -> bool {
        let (way_m, exposed) = LEAPS;
        self.inputs.leaps_from(&earlier.inputs)
            || self.inputs.camera_m.distance(earlier.inputs.camera_m) > way_m
            || (self.altitude_m - earlier.altitude_m).abs() > way_m
            || (self.exposure / earlier.exposure).ln().abs() > exposed
    }

    /// Returns the share of the panorama's rows that the change since `earlier` makes old.
    fn aged_since(&self, earlier: &Self) -> f64 {
        let (way_m, times, exposed) = AGES;
        let (here, there) = (&self.inputs, &earlier.inputs);
        let shares = [
            times * here.aged_since(there),
            here.camera_m.distance(there.camera_m) / way_m,
            (self.altitude_m - earlier.altitude_m).abs() / way_m,
            (here.drift_m - there.drift_m).length() / way_m,
            (self.exposure / earlier.exposure).ln().abs() / exposed,
        ];
        shares.into_iter().fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shader_has_the_same_side_length() {
        let text = crate::gpu::shader::assemble("between/sky_sample.wgsl").unwrap();
        assert!(text.contains(&format!("const ROUND_SIDE: f32 = {PANORAMA_SIDE}.0;")));
    }
}
