//! From the weather and a camera to what the drops' shader reads.

use glam::DVec3;

pub(crate) use crate::particles::StreakCamera;

use super::{
    lattice::{CLASSES, FADE, Moment, SHELLS, SIDE_M, SPEED_UNIT, short_seed, side_m},
    light::DropLight,
    sizes::DropSizes,
};
use crate::{scene::DepthUniform, weather::Falling};

/// Diameters that are drawn as drops, mm: what is smaller shows as a veil only.
const DRAWN_MM: (f64, f64) = (0.5, 6.0);

/// [`RainUniform::shell`] and the rest as `RainUniform` of `shaders/rain/drops.wgsl` has them.
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

/// How many drops of each class one shell holds, as the shader wants them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Classes {
    /// Diameter (m), speed units, drops of the classes up to and with this one.
    pub table: [[f32; 4]; CLASSES],
    /// Drops of a shell.
    pub per_shell: u32,
    /// Drops that each of them stands for.
    pub weight: f64,
    /// Extinction of the drops that they stand for, 1/m.
    pub extinction_per_m: f64,
    /// Diameter (mm), fall speed (m/s) and flux on level ground (1/(m^2 s)) of each class.
    pub flux: [(f64, f64, f64); CLASSES],
}

impl Classes {
    /// Creates the classes of what falls at an altitude that makes drops faster by `density_factor`
    /// ([`super::drops::factor_in`]), at most `most` drops in all shells together.
    pub fn new(falling: &Falling, density_factor: f64, most: u32) -> Self {
        let (low, high) = DRAWN_MM;
        let step = (high / low).powf(1.0 / CLASSES as f64);
        let edges = |k: usize| low * step.powi(k as i32);
        let volume = SIDE_M.powi(3);
        let sizes = DropSizes::new(falling, density_factor);
        let number: [f64; CLASSES] = std::array::from_fn(|k| volume * sizes.number_between(edges(k), edges(k + 1)));
        let all: f64 = number.iter().sum();
        let share = (f64::from(most) / SHELLS as f64 / all.max(1.0)).min(1.0);
        let mut upto = 0.0f64;
        let mut extinction = 0.0;
        let mut flux = [(0.0, 0.0, 0.0); CLASSES];
        let table: [[f32; 4]; CLASSES] = std::array::from_fn(|k| {
            upto += number[k] * share;
            let d = (edges(k) * edges(k + 1)).sqrt();
            let speed = sizes.speed_m_s(d);
            flux[k] = (d, speed, number[k] / volume * speed);
            extinction += number[k] / volume * std::f64::consts::FRAC_PI_2 * d * d * 1e-6;
            [(d * 1e-3) as f32, (speed / SPEED_UNIT).round() as f32, upto.floor() as f32, 0.0]
        });
        Self { table, per_shell: upto as u32, weight: 1.0 / share, extinction_per_m: extinction, flux }
    }
}

/// The air that the drops fall in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MovingAir {
    pub displacement_m: DVec3,
    pub velocity_m_s: DVec3,
    pub time_s: f64,
    /// Extinction beside the rain's, 1/m.
    pub extinction_per_m: f64,
}

impl RainUniform {
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
    use crate::{
        gpu::shader,
        weather::{Precipitation, PrecipitationKind, Weather, derive},
    };

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

    #[test]
    fn classes_hold_the_water_that_falls_and_thinning_keeps_what_they_cover() {
        let weather = Weather { precipitation: Precipitation::of(PrecipitationKind::Rain, 20.0), ..Weather::default() };
        let falling = derive(&weather).unwrap().precipitation;
        let (all, few) = (Classes::new(&falling, 1.0, u32::MAX), Classes::new(&falling, 1.0, 20_000));
        assert!(few.per_shell <= 5000 && all.per_shell > 20_000);
        let cover = |c: &Classes| {
            let mut before = 0.0;
            c.table.iter().fold(0.0, |sum, row| {
                let n = f64::from(row[2]) - before;
                before = f64::from(row[2]);
                sum + n * f64::from(row[0]).powi(2)
            }) * c.weight
        };
        assert!((cover(&few) / cover(&all) - 1.0).abs() < 0.02, "{} {}", cover(&few), cover(&all));
        let falls: f64 = {
            let mut before = 0.0;
            all.table.iter().fold(0.0, |sum, row| {
                let n = f64::from(row[2]) - before;
                before = f64::from(row[2]);
                let d = f64::from(row[0]);
                sum + n * d * d * d * std::f64::consts::PI / 6.0 * f64::from(row[1]) * SPEED_UNIT
            }) / SIDE_M.powi(3)
                * 3.6e6
        };
        // Drops below half a millimetre carry the rest.
        assert!((18.0..20.2).contains(&falls), "{falls} mm/h");
    }
}
