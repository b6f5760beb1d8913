//! The frame's uniform block, as `shaders/frame/uniform.wgsl` reads it.

use crate::scene::DepthUniform;

/// Everything a pixel of the composition needs beside the sky's and the fog's own blocks.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct FrameUniform {
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
    pub drops: [f32; 2],
    /// How much of air, fog and clear sky is drawn.
    pub drawn: [f32; 4],
}

#[cfg(test)]
mod tests {
    use std::mem::offset_of;

    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shader() {
        let text = shader::assemble("frame/uniform.wgsl").unwrap();
        let (size, members) = shader::struct_layout(&text, "FrameUniform").unwrap();
        assert_eq!(size as usize, size_of::<FrameUniform>());
        macro_rules! same {
            ($($field:ident),*) => {
                $(assert!(
                    members.contains(&(stringify!($field).into(), offset_of!(FrameUniform, $field) as u32)),
                    "{}: {members:?}", stringify!($field)
                );)*
            };
        }
        same!(
            depth,
            color,
            night_floor,
            exposure,
            deck,
            deck_cover,
            cd_m2_per_unit,
            color_space,
            tone,
            seed,
            y_sign,
            dither_step
        );
        same!(pixel_angle, encode, medium_share, direct_share, drops, drawn);
    }
}
