//! Pictures of a frame's numbers in place of the frame itself, for developers.

use super::stages::Stages;

/// A false-colour picture in place of a frame's: one number of each pixel on a scale from black over blue, green,
/// yellow and red to white.
///
/// The call of the frame that has the number's stage draws it; other calls of the frame draw nothing. The colours are a
/// display's: linear in float and sRGB formats and where the host's colour is display-linear, else encoded by the sRGB
/// curve. Of several samples a pixel the first stands for all. Masked pixels stay the host's. Where nothing of what it
/// shows is in the frame all is black.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Diagnostic {
    /// The picture itself.
    #[default]
    None = 0,
    /// Metres along the ray to what the host drew, by decades: black 1 m or less, white 100 km and more, and the sky.
    /// Stage MEDIUM.
    Distance = 1,
    /// Optical depth of air, fog and what falls between the eye and what is seen, of luminance: black 0, 1 a step,
    /// white 5 and more. Rain areas' columns are left out. Stage MEDIUM.
    OpticalDepth = 2,
    /// Share of a surface under a film, standing water or clear ice: black 0, 0.2 a step, white 1. Stage SURFACE.
    Wetness = 3,
    /// Error by what the plan leaves out of air, fog and clear sky: relative change of luminance over a hundredth of
    /// white, by decades: black 1e-4 or less, white 10 and more. Drops and stars are not counted. Stage MEDIUM.
    PlanError = 4,
    /// How often what falls was drawn over a pixel: black never, 4 times a step, white 20 times and more. Stage
    /// PARTICLES.
    Overdraw = 5,
    /// The wind that carries what falls, 2 m over what the host drew: black a calm, 4 m/s a step, white 20 m/s and
    /// more. Each square of the ground has an arrow along the wind, or a dot where it is slower than 0.3 m/s. The sky
    /// is black. Stage MEDIUM.
    Wind = 6,
}

impl Diagnostic {
    /// The stage whose call draws it.
    pub(crate) fn stage(self) -> Stages {
        match self {
            Self::None => Stages(0),
            Self::Distance | Self::OpticalDepth | Self::PlanError | Self::Wind => Stages::MEDIUM,
            Self::Wetness => Stages::SURFACE,
            Self::Overdraw => Stages::PARTICLES,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_shader_and_no_other_shader_has_it() {
        let text = crate::gpu::shader::assemble("frame/diagnostic.wgsl").unwrap();
        for (name, diagnostic) in [
            ("DISTANCE", Diagnostic::Distance),
            ("OPTICAL_DEPTH", Diagnostic::OpticalDepth),
            ("WETNESS", Diagnostic::Wetness),
            ("PLAN_ERROR", Diagnostic::PlanError),
            ("OVERDRAW", Diagnostic::Overdraw),
        ] {
            assert!(text.contains(&format!("const {name}: u32 = {}u;", diagnostic as u32)), "{name}");
        }
        for name in crate::gpu::shader::names().filter(|name| *name != "frame/diagnostic.wgsl") {
            assert!(!crate::gpu::shader::assemble(name).unwrap().contains("DIAGNOSTIC"), "{name}");
        }
    }
}
