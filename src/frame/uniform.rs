//! The frame's uniform block, as `shaders/frame/uniform.wgsl` reads it.

use crate::scene::DepthUniform;

/// One light above the frame: the sun or the moon.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // The members are those of the WGSL struct, where each is explained.
pub(crate) struct LightUniform {
    pub direction: [f32; 3],
    pub radius: f32,
    pub apparent: [f32; 3],
    pub lit: f32,
    pub irradiance: [f32; 3],
    pub flattening: f32,
    pub bright_limb: [f32; 3],
    pub direct_share: f32,
}

/// Everything a pixel of the composition needs beside the tables.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)]
pub(crate) struct FrameUniform {
    pub depth: DepthUniform,
    pub lights: [LightUniform; 2],
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
    pub inverse_size: [f32; 2],
    pub medium_share: f32,
    pub encode: u32,
    pub pad: [f32; 2],
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shader() {
        let text = shader::assemble("frame/uniform.wgsl").unwrap();
        macro_rules! same {
            ($ty:ident, $wgsl:literal, $($field:ident $name:literal),*) => {{
                let (size, members) = shader::struct_layout(&text, $wgsl).unwrap();
                assert_eq!(size as usize, size_of::<$ty>(), $wgsl);
                $(assert!(
                    members.contains(&($name.to_owned(), std::mem::offset_of!($ty, $field) as u32)),
                    "{} {}: {members:?}", $wgsl, $name
                );)*
            }};
        }
        same!(LightUniform, "FrameLight", direction "direction", radius "radius", apparent "apparent", lit "lit",
            irradiance "irradiance", flattening "flattening", bright_limb "bright_limb", direct_share "direct_share");
        same!(FrameUniform, "FrameUniform", depth "depth", lights "lights", night_floor "night_floor",
            exposure "exposure", deck "deck", deck_cover "deck_cover", cd_m2_per_unit "cd_m2_per_unit",
            color_space "color_space", tone "tone", seed "seed", y_sign "y_sign", dither_step "dither_step",
            inverse_size "inverse_size", medium_share "medium_share", encode "encode", pad "pad0");
    }
}
