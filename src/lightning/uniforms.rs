//! Uniforms and instances of the lightning shaders.

use glam::{DMat3, DMat4};

use super::light::COLOR;

/// `ChannelUniform` of `shaders/lightning/channel.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct ChannelUniform {
    /// Matrix from camera-relative (east, north, up), m, to clip space.
    pub clip: [[f32; 4]; 4],
    /// Colour of the light in linear Rec. 709, with luminance 1.
    pub color: [f32; 3],
    /// Solid angle of a pixel divided by the cube of the clip w of a unit direction, sr; 0 for parallel rays.
    pub pixel_sr: f32,
    /// Size of the target, pixels.
    pub size: [f32; 2],
    /// Area of a pixel for parallel rays, m^2; 0 otherwise.
    pub pixel_m2: f32,
    /// Radius of a channel, m.
    pub radius: f32,
}

/// Radius of the luminous channel, m: photographs show diameters of 2 to 10 cm (Rakov and Uman 2003, section 4.6).
const RADIUS_M: f64 = 0.03;

impl ChannelUniform {
    /// Creates the uniforms for a picture of `size` pixels.
    ///
    /// Let M be the 3 x 3 matrix of the rows x, y and w of `clip`. It takes a unit direction d to M d = w (X, Y, 1),
    /// where w is the clip w of d, and X and Y are its place in the picture, -1 to 1. The cone over dX dY has the solid
    /// angle |det M^-1| w^3 dX dY, and a pixel covers dX dY = 4 / number of pixels. `pixel_sr` = |det M^-1| dX dY, the
    /// solid angle without w^3. For parallel rays w is constant, and a pixel has an area, `pixel_m2`, instead.
    pub fn new(clip: &DMat4, size: [u32; 2]) -> Self {
        let rows = [0, 1, 3].map(|i| clip.row(i).truncate());
        let pixels = f64::from(size[0]) * f64::from(size[1]);
        let parallel = rows[2].length_squared() < 1e-18;
        let determinant = DMat3::from_cols(rows[0], rows[1], rows[2]).determinant().abs();
        let area = rows[0].cross(rows[1]).length();
        Self {
            clip: clip.as_mat4().to_cols_array_2d(),
            color: COLOR.map(|c| c as f32),
            pixel_sr: if parallel { 0.0 } else { (4.0 / (pixels * determinant.max(1e-30))) as f32 },
            size: size.map(|s| s as f32),
            pixel_m2: if parallel { (4.0 / (pixels * area.max(1e-30))) as f32 } else { 0.0 },
            radius: RADIUS_M as f32,
        }
    }
}

/// A part of a channel as an instance of the vertex stage, 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct PartInstance {
    /// One end, relative to the camera, m.
    pub from: [f32; 3],
    /// Luminous intensity, cd, times exposure.
    pub intensity: f32,
    /// Other end, relative to the camera, m.
    pub to: [f32; 3],
    /// Padding.
    pub pad: f32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shader() {
        shader::assert_layout!(
            "lightning/channel.wgsl",
            "ChannelUniform",
            ChannelUniform,
            [clip, color, pixel_sr, size, pixel_m2, radius]
        );
    }
}
