//! Uniform block of the drops' shader, computed from the weather and a camera.

use glam::DVec3;

use super::{
    classes::Classes,
    light::DropLight,
    shells::{CLASSES, FADE, Moment, SHELLS, side_m},
};
use crate::{
    falling::lattice::short_seed,
    particles::{MovingAir, StreakCamera},
    scene::DepthUniform,
};

/// Uniform block `RainUniform` of `shaders/rain/drops.wgsl`, which describes the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct RainUniform {
    pub depth: DepthUniform,
    pub clip: [[f32; 4]; 4],
    pub wind: [f32; 3],
    pub exposure: f32,
    pub above: [f32; 3],
    pub per_shell: u32,
    pub below: [f32; 3],
    pub seed: u32,
    pub sun: [f32; 3],
    pub pixel_angle: f32,
    pub to_sun: [f32; 3],
    pub extinction: f32,
    pub weight: f32,
    pub y_sign: f32,
    pub shells: u32,
    pub gain: f32,
    pub camera: [f32; 3],
    pub pad2: f32,
    pub cell: [[u32; 4]; SHELLS],
    pub shell: [[f32; 4]; SHELLS],
    pub classes: [[f32; 4]; CLASSES],
}

impl RainUniform {
    /// Computes the block of the drops for a camera.
    pub fn new(seed: u64, classes: &Classes, light: &DropLight, shot: &StreakCamera<'_>, air: &MovingAir) -> Self {
        let v = |d: DVec3| d.as_vec3().to_array();
        let moment = |s: usize| Moment::new(s, air.displacement_m, air.time_s);
        Self {
            depth: shot.rays.uniform(),
            clip: shot.clip.as_mat4().to_cols_array_2d(),
            wind: v(air.velocity_m_s),
            exposure: shot.exposure_s as f32,
            above: v(light.above),
            per_shell: classes.per_shell,
            below: v(light.below),
            seed: short_seed(seed),
            sun: v(light.sun),
            pixel_angle: shot.rays.pixel_angle(shot.height) as f32,
            to_sun: v(light.to_sun),
            extinction: air.extinction_per_m as f32,
            weight: classes.weight as f32,
            y_sign: shot.y_sign,
            shells: SHELLS as u32,
            gain: shot.gain as f32,
            camera: v(shot.velocity_m_s),
            pad2: 0.0,
            cell: std::array::from_fn(|s| {
                let m = moment(s);
                let [x, y, z] = m.camera(s, shot.position_m);
                [x, y, z, m.fall]
            }),
            shell: std::array::from_fn(|s| {
                let side = side_m(s);
                let last = if s > 0 { 0.5 * side_m(s - 1) } else { 0.0 };
                [side, last * FADE, 0.5 * side * FADE, last].map(|x| x as f32)
            }),
            classes: classes.table,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_are_those_of_the_shader() {
        shader::assert_layout!(
            "rain/drops_view.wgsl",
            "RainUniform",
            RainUniform,
            [
                depth,
                clip,
                wind,
                exposure,
                above,
                per_shell,
                below,
                seed,
                sun,
                pixel_angle,
                to_sun,
                extinction,
                weight,
                y_sign,
                shells,
                gain,
                camera,
                cell,
                shell,
                classes
            ]
        );
    }
}
