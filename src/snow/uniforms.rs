//! Uniform block of the flakes' shader, computed from the flakes and a camera.

use glam::DVec3;

use super::lattice::{CLASSES, FADE, Flakes, Moment, SHELLS, side_m};
use crate::{
    falling::lattice::{fraction, short_seed},
    moment::LightAround,
    particles::{MovingAir, StreakCamera},
    scene::DepthUniform,
};

/// Uniform block `FlakesUniform` of `shaders/snow/flakes.wgsl`, which describes the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct FlakesUniform {
    pub depth: DepthUniform,
    pub clip: [[f32; 4]; 4],
    pub wind: [f32; 3],
    pub exposure: f32,
    pub above: [f32; 3],
    pub seed: u32,
    pub below: [f32; 3],
    pub pixel_angle: f32,
    pub sun: [f32; 3],
    pub extinction: f32,
    pub to_sun: [f32; 3],
    pub y_sign: f32,
    pub camera: [f32; 3],
    pub share: f32,
    pub first: [u32; 4],
    pub count: u32,
    pub turn: u32,
    pub pad: [u32; 2],
    pub cell: [[u32; 4]; SHELLS],
    pub eye: [[u32; 4]; SHELLS],
    pub shell: [[f32; 4]; SHELLS],
    pub classes: [[f32; 4]; CLASSES],
    pub upto: [[u32; SHELLS]; CLASSES],
    pub weight: [[f32; SHELLS]; CLASSES],
}

impl FlakesUniform {
    /// Creates the block of flakes for a camera in moving air, with a drawn share of 1. `light` includes the exposure.
    pub fn new(seed: u64, flakes: &Flakes, light: &LightAround, shot: &StreakCamera<'_>, air: &MovingAir) -> Self {
        let v = |d: DVec3| d.as_vec3().to_array();
        let last = flakes.upto[CLASSES - 1];
        let eyes: [[u32; 3]; SHELLS] =
            std::array::from_fn(|s| shot.position_m.to_array().map(|x| fraction(x, side_m(s))));
        let mut first = [flakes.drawn; 4];
        first[0] = 0;
        for shell in 1..flakes.shells {
            first[shell] = first[shell - 1] + last[shell - 1];
        }
        Self {
            depth: shot.rays.uniform(),
            clip: shot.clip.as_mat4().to_cols_array_2d(),
            wind: v(air.velocity_m_s),
            exposure: shot.exposure_s as f32,
            above: v(light.above),
            seed: short_seed(seed),
            below: v(light.below),
            pixel_angle: shot.rays.pixel_angle(shot.height) as f32,
            sun: v(light.sun),
            extinction: air.extinction_per_m as f32,
            to_sun: v(light.to_sun),
            y_sign: shot.y_sign,
            camera: v(shot.velocity_m_s),
            share: 1.0,
            first,
            count: flakes.drawn,
            turn: Moment::new(0, air.displacement_m, air.time_s).turn,
            pad: [0; 2],
            cell: std::array::from_fn(|s| {
                let m = Moment::new(s, air.displacement_m, air.time_s);
                let [x, y, z] = [0, 1, 2].map(|i| eyes[s][i].wrapping_sub(m.air[i]));
                [x, y, z, m.fall]
            }),
            eye: eyes.map(|[x, y, z]| [x, y, z, 0]),
            shell: std::array::from_fn(|s| {
                let side = side_m(s);
                let inner = if s > 0 { 0.25 * side } else { 0.0 };
                [side, FADE * inner, 0.5 * FADE * side, inner].map(|x| x as f32)
            }),
            classes: flakes.table,
            upto: flakes.upto,
            weight: flakes.weight,
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
            "snow/flakes_view.wgsl",
            "FlakesUniform",
            FlakesUniform,
            [
                depth,
                clip,
                wind,
                exposure,
                above,
                seed,
                below,
                pixel_angle,
                sun,
                extinction,
                to_sun,
                y_sign,
                camera,
                share,
                first,
                count,
                turn,
                cell,
                eye,
                shell,
                classes,
                upto,
                weight
            ]
        );
    }
}
