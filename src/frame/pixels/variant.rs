//! Variant of the composition: the properties that distinguish one compiled pipeline from another.

use super::pixel_kind::Pixels;
use crate::stage::{Constants, Pipeline, Sampling, Stages, flag, veiled};

/// Properties that distinguish one compiled variant from another. `C` is the type of the constants: `()` while they lie
/// in a composition, because they are large and a frame copies them only for a variant that it has not drawn before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::frame) struct Variant<C = Pipeline> {
    pub stages: Stages,
    pub format: wgpu::TextureFormat,
    pub samples: u32,
    pub sampling: Sampling,
    /// Whether the host gives depth, mask, surface classes, normals.
    pub images: [bool; 4],
    /// Constants set by the effects and the frame.
    pub constants: C,
    /// Kind of pixels that this variant draws.
    pub pixels: Pixels,
}

impl Variant<()> {
    /// Returns the variant with its constants.
    pub fn with(&self, constants: &Pipeline) -> Variant {
        let Self { stages, format, samples, sampling, images, constants: (), pixels } = *self;
        Variant { stages, format, samples, sampling, images, constants: *constants, pixels }
    }
}

impl Variant {
    /// Returns the colour target state for draws into the host's colour.
    pub fn target(&self, write_mask: wgpu::ColorWrites) -> wgpu::ColorTargetState {
        wgpu::ColorTargetState { format: self.format, blend: None, write_mask }
    }

    /// Returns the shader, without the steps that the variant does not draw, and its entry point.
    pub fn program(&self) -> (String, &'static str) {
        let [(composed, entry), _] = self.sampling.shaders();
        let diagnoses = self.constants.composed.value("DIAGNOSTIC") > 0.0;
        let (name, entry) = match self.pixels {
            Pixels::Grid => ("frame/even_grid.wgsl", "even_grid"),
            _ if diagnoses => (self.sampling.diagnostic(), "diagnose"),
            _ => (composed, entry),
        };
        let dry = if self.stages.has(Stages::SURFACE) { "" } else { ":dry" };
        let shader = if self.pixels.are_even() {
            // Interpolated pixels already contain the fog.
            format!("{name}{dry}:even")
        } else if self.constants.traits.veils_all {
            veiled(name, self.constants.between.all()) + dry
        } else {
            format!("{name}:clear{dry}")
        };
        (shader, entry)
    }

    /// Whether the variant equals `other` with `constants`. No constants are copied.
    pub fn is_with(&self, other: &Variant<()>, constants: &Pipeline) -> bool {
        let Self { stages, format, samples, sampling, images, constants: own, pixels } = self;
        (*stages, *format, *samples, *sampling, *images, *pixels)
            == (other.stages, other.format, other.samples, other.sampling, other.images, other.pixels)
            && own == constants
    }

    /// Returns the values of the shader's `override` constants.
    pub fn constants(&self) -> Constants {
        let mut all = Constants::NONE;
        for (name, stage) in [
            ("BACKGROUND", Stages::BACKGROUND),
            ("SURFACE", Stages::SURFACE),
            ("MEDIUM", Stages::MEDIUM),
            ("TONE", Stages::TONE),
            ("PARTICLES", Stages::PARTICLES),
        ] {
            all.push((name, flag(self.stages.has(stage))));
        }
        for (name, given) in ["HAS_DEPTH", "HAS_MASK", "HAS_CLASSES", "HAS_NORMALS"].into_iter().zip(self.images) {
            all.push((name, flag(given)));
        }
        all.push(("FAR_ABOVE", flag(self.pixels != Pixels::Below)));
        all.push(("FAR_BELOW", flag(self.pixels != Pixels::Above)));
        all.extend(self.constants.between.all());
        all.extend(self.constants.composed.all());
        all
    }
}
