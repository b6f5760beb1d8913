//! Diagnostic pictures for developers: numbers of a frame in false colour, in place of the frame itself.

use super::stages::Stages;

/// False-colour picture in place of a frame's: one number of each pixel on a scale of six colours (black, blue, green,
/// yellow, red, white). A step leads from one colour to the next.
///
/// Each picture names a stage. The call with this stage draws the picture. Other calls of the frame draw nothing,
/// except for the sea and the terrain where the depth may be written. The colours are display colours: linear in float
/// and sRGB formats and where the host's colour is display-linear, otherwise encoded by the sRGB curve. In multisampled
/// images the first sample of a pixel gives the colour of the whole pixel. Masked pixels keep the host's colour. If
/// nothing in the frame has the picture's number, the picture is black.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Diagnostic {
    /// The normal picture.
    #[default]
    None = 0,
    /// Distance along the ray to what the host drew, on a logarithmic scale: black is 1 m or less; white is 100 km or
    /// more, and the sky. Stage MEDIUM.
    Distance = 1,
    /// Optical depth, for luminance, of air, fog, precipitation and clouds in front of what the host drew; in the sky,
    /// of air, fog and precipitation up to the edge of the atmosphere. Black is 0, a step is 1, white is 5 or more. The
    /// columns of rain areas are left out. Stage MEDIUM.
    OpticalDepth = 2,
    /// Share of a surface under a water film, standing water or clear ice: black is 0, a step is 0.2, white is 1. Stage
    /// SURFACE.
    Wetness = 3,
    /// Error due to what the plan leaves out of air, fog and clear sky, on a logarithmic scale: black is 1e-4 or less,
    /// white is 10 or more. The error is |Y' - Y| / (Y + 0.01), where Y is the exposed luminance with all air, fog and
    /// sky (1 is white) and Y' that with the plan's shares. Drops and stars are not counted. Stage MEDIUM.
    PlanError = 4,
    /// Number of times that precipitation was drawn over a pixel: black is never, a step is 4 times, white is 20 times
    /// or more. Stage PARTICLES.
    Overdraw = 5,
    /// Wind that carries precipitation, 2 m above what the host drew: black is calm, a step is 4 m/s, white is 20 m/s
    /// or more. Each square of the ground has an arrow along the wind, or a dot where the wind is slower than 0.3 m/s.
    /// The sky is black. Stage MEDIUM.
    Wind = 6,
}

impl Diagnostic {
    /// Stage whose call draws this picture.
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
