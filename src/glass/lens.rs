//! Uniforms of the lens pass: mapping from pixels to the glass, and from directions back to the picture.

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec2, DVec3};

use super::{
    geometry::{PictureRays, Plane},
    laws,
    step::VOLUME_UNIT_M3,
    windscreen::{MAX_ARMS, Windscreen},
};
use crate::{error::Result, gpu::Layer, scene::Camera};

/// Optical depth of snow per metre of its water: 3 / (2 r rho), with grains of the radius r = 0.1 mm (Wiscombe & Warren
/// 1980, new snow) and rho = 0.917, the density of ice relative to water.
const SNOW_DEPTH_PER_M: f64 = 1.5 / (1e-4 * 0.917);

/// Target and source images of the frame.
#[derive(Clone, Copy)]
pub(crate) struct LensFrame<'a> {
    /// Camera of the picture.
    pub camera: &'a Camera,
    /// Finished picture to read; it has the size of the target.
    pub picture: &'a wgpu::Texture,
    /// Mask of the host; where it is 1, the glass is not drawn.
    pub mask: Option<Layer<'a>>,
    /// Image to which the lens draws.
    pub target: &'a wgpu::TextureView,
    /// Whether the picture's values are sRGB-encoded.
    pub encoded: bool,
    /// Whether row 0 of the target is the picture's bottom.
    pub bottom_left: bool,
}

/// Uniform block `Lens` of `shaders/glass/lens.wgsl`, which describes the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct LensUniform {
    pub ray: [f32; 3],
    pub per_m: f32,
    pub ray_dx: [f32; 3],
    pub y_sign: f32,
    pub ray_dy: [f32; 3],
    pub radius: f32,
    pub eye: [f32; 3],
    pub pixel: f32,
    pub clip_x: [f32; 3],
    pub fogging: f32,
    pub clip_y: [f32; 3],
    pub demist: f32,
    pub clip_z: [f32; 3],
    pub height: f32,
    pub edges: [[f32; 4]; 4],
    pub arms: [[f32; 4]; MAX_ARMS],
    pub flow: [f32; 2],
    pub size: [i32; 2],
    pub key: u32,
    pub wet: u32,
    pub snow_depth: f32,
    pub pad: u32,
}

/// Lattice of water and snow that the lens draws.
#[derive(Clone, Copy)]
pub(super) struct LensLattice {
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Numbers of columns and rows.
    pub size: [u32; 2],
    /// Whether there is water on it.
    pub wet: bool,
    /// Whether snow may lie on it.
    pub snowy: bool,
    /// Direction in which large beads run, (u, v), of any length; 0 if they rest.
    pub flow: DVec2,
    pub key: u32,
}

impl LensUniform {
    /// Creates the block of a pane as a picture's camera sees it.
    pub fn of(screen: &Windscreen, plane: &Plane, frame: &LensFrame<'_>, shown: &LensLattice) -> Result<Self> {
        let rays = PictureRays::of(&frame.camera.projection)?;
        let to_glass = DMat3::from_cols(plane.u, plane.v, plane.out).transpose();
        let clip = rays.to_clip() * to_glass.transpose();
        let eye = to_glass * -plane.origin;
        let f3 = |v: DVec3| v.as_vec3().to_array();
        // Computes the size of a pixel on the glass in the middle of the picture, with the slant of the glass limited.
        let ray = rays.direction.normalize();
        let distance = eye.z.abs() / (to_glass * ray).z.abs().max(0.2);
        let angle = 2.0 * rays.dy.length() / rays.direction.length() / f64::from(frame.picture.height());
        let edges = std::array::from_fn(|i| {
            let (a, b) = (plane.corners[i], plane.corners[(i + 1) % 4]);
            let inwards = (b - a).normalize().perp();
            [inwards.x as f32, inwards.y as f32, -inwards.dot(a) as f32, 0.0]
        });
        let arms = screen.arms.map(|arm| {
            let metres = arm.map_or([0.0; 4], |a| [a.pivot_m[0], a.pivot_m[1], a.inner_radius_m, a.length_m]);
            metres.map(|m| (m / shown.cell_m) as f32)
        });
        Ok(Self {
            ray: f3(to_glass * rays.direction),
            per_m: (1.0 / shown.cell_m) as f32,
            ray_dx: f3(to_glass * rays.dx),
            y_sign: if frame.bottom_left { -1.0 } else { 1.0 },
            ray_dy: f3(to_glass * rays.dy),
            radius: (laws::radius_m(VOLUME_UNIT_M3) / shown.cell_m) as f32,
            eye: f3(eye),
            pixel: (angle * distance / shown.cell_m) as f32,
            clip_x: f3(clip.x_axis),
            fogging: screen.fogging as f32,
            clip_y: f3(clip.y_axis),
            demist: screen.demist as f32,
            clip_z: f3(clip.z_axis),
            height: plane.size_m.y as f32,
            edges,
            arms,
            flow: shown.flow.normalize_or_zero().as_vec2().to_array(),
            size: shown.size.map(|n| n as i32),
            key: shown.key,
            wet: u32::from(shown.wet),
            snow_depth: if shown.snowy {
                (VOLUME_UNIT_M3 / (shown.cell_m * shown.cell_m) * SNOW_DEPTH_PER_M) as f32
            } else {
                0.0
            },
            pad: 0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shader() {
        shader::assert_layout!(
            "glass/lens.wgsl",
            "Lens",
            LensUniform,
            [
                ray, per_m, ray_dx, y_sign, ray_dy, radius, eye, pixel, clip_x, fogging, clip_y, demist, clip_z,
                height, edges, arms, flow, size, key, wet, snow_depth
            ]
        );
    }
}
