//! Uniform block of the frame, as `shaders/common/frame.wgsl` reads it.

use std::{mem::offset_of, ops::Deref};

use super::frame::{ColorSpace, Frame};
use crate::{
    gpu::{
        Device,
        blocks::{BlockView, Blocks, UniformBlock},
    },
    light::Exposure,
    moment::SceneMoment,
    scene::{DepthUniform, MAX_FLASH_LAMPS, ViewRays},
};

/// One source of a lightning flash's light (`FlashSource` of `shaders/common/frame.wgsl`, which has the units).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct FlashUniform {
    pub position: [f32; 3],
    pub clouds: f32,
    pub air: f32,
    pub radius: f32,
    pub height: f32,
    pub pad: f32,
}

/// Constants of the composition, apart from those in the effects' own blocks and from the tables of bows.
/// `shaders/common/frame.wgsl` has the units.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct FrameValues {
    pub depth: DepthUniform,
    pub color: [[f32; 4]; 3],
    pub night_floor: [f32; 3],
    pub exposure: f32,
    pub deck: [f32; 3],
    pub deck_cover: f32,
    pub cd_m2_per_unit: f32,
    pub color_space: u32,
    pub tone: u32,
    pub seed: u32,
    pub y_sign: f32,
    pub dither_step: f32,
    pub pixel_angle: f32,
    pub encode: u32,
    pub medium_share: f32,
    pub direct_share: f32,
    /// Extinction of the rain that the drawn drops replace, 1/m, and the distance up to which they replace it, m.
    pub drops: [f32; 2],
    /// Drawn shares of air, fog, clear sky, and falling drops and flakes.
    pub drawn: [f32; 4],
    pub compositions: u32,
    /// Drawn share of the layer behind the sky times that of the clear sky.
    pub behind_drawn: f32,
    /// Luminance of the value 1 in the layer behind the sky, cd/m^2, and the share of the night floor that the layer
    /// replaces.
    pub behind: [f32; 2],
    /// Colour of the light of flashes, normalised to luminance 1, and the number of its sources.
    pub flash_color: [f32; 3],
    pub flash_count: u32,
    /// Clouds that the flashes light: height of their face above the camera, m; their cover; extinction of the haze in
    /// front of them, 1/m; scattering coefficient of the air, 1/m.
    pub flash_plane: f32,
    pub flash_cover: f32,
    pub flash_haze: f32,
    pub flash_scattering: f32,
    pub flashes: [FlashUniform; MAX_FLASH_LAMPS],
    /// For each channel: share of direct light in all light on level ground, divided by the mean share that clouds let
    /// through. The fourth value is that mean share.
    pub cloud_shadow: [f32; 4],
    /// Size of the picture, pixels.
    pub picture: [f32; 2],
    /// Share of the clouds that is drawn as a volume instead of a deck, and the height of their base above the camera,
    /// m.
    pub clouds_drawn: f32,
    pub clouds_over: f32,
    /// Mean light of the clouds that may be drawn as a volume, cd/m^2, and their cover; 0 without such clouds.
    pub mean_cloud: [f32; 4],
    /// Extinction of the falling snow that the drawn flakes replace, 1/m, and the distance up to which they replace it,
    /// m.
    pub flakes: [f32; 2],
    /// Factor for light in the coarse grid, a power of two with which white is about 1.
    pub even_scale: f32,
    pub pad: f32,
}

/// Uniform block of the frame: what each draw sets, and the tables of bows. No draw creates the block as a whole,
/// because the tables are most of its size, and few pictures show a bow.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct FrameUniform {
    pub values: FrameValues,
    /// Differences that bows make to the phase function of drops, 1/sr per channel, tabulated over the angle from the
    /// antisolar point: for drops in the low air, and for drops in the columns of rain areas.
    pub bows: [BowTable; 2],
}

/// Light of lightning flashes in a frame's block.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FlashBlock {
    /// Colour of the light, normalised to luminance 1.
    pub color: [f32; 3],
    pub count: u32,
    /// Height of the lit face of the clouds above the camera, m.
    pub plane: f32,
    /// Cover of these clouds, 0 to 1.
    pub cover: f32,
    /// Extinction of the haze in front of the clouds, 1/m.
    pub haze: f32,
    /// Scattering coefficient of the air, 1/m.
    pub scattering: f32,
    pub sources: [FlashUniform; MAX_FLASH_LAMPS],
}

/// Fields of [`FrameValues`] that one effect writes into a frame's block.
#[derive(Clone, Copy, Debug)]
pub(crate) enum FrameBlock {
    /// Drawn shares of the air in front of things and of the clear sky.
    Sky { air: f32, sky: f32 },
    /// Drawn share of the fog.
    Fog { share: f32 },
    /// [`FrameValues::behind`].
    Stars { behind: [f32; 2] },
    /// `drawn`: share drawn as a volume. `mean`: mean light with cover, and height above the camera, if the plan
    /// gauges. `shadow`: [`FrameValues::cloud_shadow`], if the clouds cast shadows.
    Clouds { drawn: f32, mean: Option<([f32; 4], f32)>, shadow: Option<[f32; 4]> },
    /// `hidden`: [`FrameValues::drops`]. `share`: drawn share of the drops.
    Rain { hidden: [f32; 2], share: f32 },
    /// `hidden`: [`FrameValues::flakes`]. `share`: drawn share of the flakes.
    Snow { hidden: [f32; 2], share: f32 },
}

/// Difference that bows make to the phase function of drops, 1/sr per channel, tabulated over the angle from the
/// antisolar point.
pub(crate) type BowTable = [[f32; 4]; BOW_ENTRIES];

impl FrameValues {
    /// Sets the fields of one effect.
    pub fn merge(&mut self, fields: &FrameBlock) {
        match *fields {
            FrameBlock::Sky { air, sky } => (self.drawn[0], self.drawn[2]) = (air, sky),
            FrameBlock::Fog { share } => self.drawn[1] = share,
            FrameBlock::Stars { behind } => self.behind = behind,
            FrameBlock::Clouds { drawn, mean, shadow } => {
                self.clouds_drawn = drawn;
                (self.mean_cloud, self.clouds_over) = mean.unwrap_or_default();
                self.cloud_shadow = shadow.unwrap_or_default();
            }
            FrameBlock::Rain { hidden, share } => (self.drops, self.drawn[3]) = (hidden, share),
            FrameBlock::Snow { hidden, share } => {
                // Drops and flakes have one value in common: the mean of their drawn shares, weighted by optical depth.
                let (others, own) = (self.drops[0] * self.drops[1], hidden[0] * hidden[1]);
                if own > 0.0 {
                    self.drawn[3] = (self.drawn[3] * others + share * own) / (others + own);
                }
                self.flakes = hidden;
            }
        }
    }

    /// Sets the light of lightning flashes.
    pub fn set_flashes(&mut self, flashes: &FlashBlock) {
        self.flash_color = flashes.color;
        self.flash_count = flashes.count;
        self.flash_plane = flashes.plane;
        self.flash_cover = flashes.cover;
        self.flash_haze = flashes.haze;
        self.flash_scattering = flashes.scattering;
        self.flashes = flashes.sources;
    }

    /// Sets the fields that depend on those of several effects.
    pub fn finish(&mut self) {
        self.behind_drawn = self.behind[1] * self.drawn[2];
    }
}

/// Uniform block of the frame on the GPU; it holds a [`FrameUniform`].
pub(crate) struct FrameUniformBlock {
    block: UniformBlock,
    /// Whether the block's tables of bows may differ from 0.
    has_bows: bool,
}

impl FrameUniformBlock {
    pub fn new(device: &Device, blocks: &Blocks) -> Self {
        Self { block: blocks.block(device, size_of::<FrameUniform>()), has_bows: false }
    }

    /// Writes the block for a draw. Without `bows`, its tables of bows are 0.
    pub fn write(&mut self, values: &FrameValues, bows: Option<&[BowTable; 2]>) {
        self.block.write(bytemuck::bytes_of(values));
        if bows.is_some() || self.has_bows {
            let none = [[[0.0; 4]; BOW_ENTRIES]; 2];
            self.block.write_at(offset_of!(FrameUniform, bows), bytemuck::bytes_of(bows.unwrap_or(&none)));
            self.has_bows = bows.is_some();
        }
    }
}

impl Deref for FrameUniformBlock {
    type Target = BlockView;

    fn deref(&self) -> &BlockView {
        &self.block
    }
}

/// Number of angles in a table of bows.
pub(crate) const BOW_ENTRIES: usize = 160;

/// Whether a format stores light as floats, not as a display's integer steps.
pub(crate) fn is_float(format: wgpu::TextureFormat) -> bool {
    use wgpu::TextureFormat as F;
    matches!(format, F::Rgba16Float | F::Rgba32Float | F::Rg11b10Ufloat)
}

/// Returns the scale of light in the coarse grid, 1/(cd/m^2): the exposure for the luminance to which eyes adapt, or
/// the display's exposure if that is larger, as in a picture exposed for dark areas. A scene-linear host's own exposure
/// has no influence. The scale is rounded down to a power of two, so that a change of scale causes no rounding.
fn even_scale(adaptation_cd_m2: f64, display_exposure: f64) -> f32 {
    let eyes = Exposure::Auto { compensation_ev: 0.0 }.factor(adaptation_cd_m2);
    eyes.max(display_exposure).log2().floor().clamp(-100.0, 100.0).exp2() as f32
}

/// Creates the block of a frame to which no effect has added anything. `tone` is whether the whole picture is
/// tone-mapped.
pub(crate) fn uniform(
    frame: &Frame<'_>,
    now: &SceneMoment<'_>,
    rays: &ViewRays,
    color: &wgpu::Texture,
    exposure: f64,
    tone: bool,
) -> FrameValues {
    let (format, scene) = (color.format(), &now.scene);
    let display = tone || frame.color_space != ColorSpace::SceneLinear;
    let plain_display = display && !is_float(format) && !format.is_srgb();
    let step = if format == wgpu::TextureFormat::Rgb10a2Unorm { 1.0 / 1023.0 } else { 1.0 / 255.0 };
    // Only plain formats dither: in an sRGB format the hardware encodes the value after the shader, so the format's
    // steps are not steps of the shader's value.
    let encode = plain_display && (tone || frame.color_space == ColorSpace::DisplaySrgb);
    FrameValues {
        depth: rays.uniform(),
        color: scene.color.map(|c| [c[0] as f32, c[1] as f32, c[2] as f32, 0.0]),
        night_floor: scene.night_floor_cd_m2.map(|v| v as f32),
        exposure: exposure as f32,
        deck: scene.deck_cd_m2.map(|v| v as f32),
        deck_cover: scene.deck_cover as f32,
        cd_m2_per_unit: frame.cd_m2_per_unit as f32,
        color_space: match frame.color_space {
            ColorSpace::SceneLinear => 0,
            ColorSpace::DisplayLinear => 1,
            ColorSpace::DisplaySrgb if format.is_srgb() => 1,
            ColorSpace::DisplaySrgb => 2,
        },
        tone: now.tone.shader_value(),
        seed: frame.frame_id as u32,
        y_sign: if frame.origin_bottom_left { -1.0 } else { 1.0 },
        dither_step: if plain_display { step } else { 0.0 },
        pixel_angle: rays.pixel_angle(color.height()) as f32,
        medium_share: scene.medium_share as f32,
        direct_share: scene.brighter().direct_share as f32,
        encode: u32::from(encode),
        drops: [0.0; 2],
        drawn: [0.0; 4],
        compositions: 0,
        behind_drawn: 0.0,
        behind: [0.0; 2],
        flash_color: [0.0; 3],
        flash_count: 0,
        flash_plane: 0.0,
        flash_cover: 0.0,
        flash_haze: 0.0,
        flash_scattering: 0.0,
        flashes: [FlashUniform::default(); MAX_FLASH_LAMPS],
        cloud_shadow: [0.0; 4],
        picture: [color.width() as f32, color.height() as f32],
        clouds_drawn: 0.0,
        clouds_over: 0.0,
        mean_cloud: [0.0; 4],
        flakes: [0.0; 2],
        even_scale: even_scale(scene.ground.adaptation_cd_m2, if display { exposure } else { 0.0 }),
        pad: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shader() {
        shader::assert_layout!(
            "common/frame.wgsl",
            "FrameUniform",
            FrameUniform,
            [
                values.depth,
                values.color,
                values.night_floor,
                values.exposure,
                values.deck,
                values.deck_cover,
                values.cd_m2_per_unit,
                values.color_space,
                values.tone,
                values.seed,
                values.behind_drawn,
                values.y_sign,
                values.dither_step,
                values.pixel_angle,
                values.encode,
                values.medium_share,
                values.direct_share,
                values.drops,
                values.drawn,
                values.compositions,
                values.behind,
                values.flash_color,
                values.flash_count,
                values.flash_plane,
                values.flash_cover,
                values.flash_haze,
                values.flash_scattering,
                values.flashes,
                values.cloud_shadow,
                values.picture,
                values.clouds_drawn,
                values.clouds_over,
                values.mean_cloud,
                values.flakes,
                values.even_scale,
                bows
            ]
        );
        shader::assert_layout!(
            "common/frame.wgsl",
            "FlashSource",
            FlashUniform,
            [position, clouds, air, radius, height]
        );
    }
}
