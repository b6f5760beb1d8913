//! Uniform block of foam: `SeaFoam` of `shaders/sea/uniform.wgsl`, whose comments describe each field.

use glam::DVec2;

use super::{
    foam::{AGES, FoamLaw},
    surface::to_tile,
};
use crate::numerics::smoothstep;

/// Copies of constants of `shaders/sea/foam.wgsl`: lengths of the patterns, m, and the turn of the coarse one.
const LACE_FINE_M: f64 = 6.4;
const LACE_COARSE_M: f64 = 17.3;
const LACE_TURN: DVec2 = DVec2::new(0.8, 0.6);
const STREAK_LONG_M: f64 = 120.0;
const STREAK_WIDE_M: f64 = 12.0;
/// Angle between two directions of streaks. Streaks fade from one fixed direction to the next. If they turned about the
/// world's origin instead, they would sweep over places far from the origin.
const STREAK_STEP_DEG: f64 = 22.5;
/// Winds, m/s, between which the gathering of the foam that waves left, in streaks along the wind, grows from 0 to
/// [`MOST_GATHERED`]. At 14 m/s, where Beaufort's 7 with its streaks begins, nine tenths of that value are reached.
const STREAK_WINDS_M_S: [f64; 2] = [6.0, 16.0];
/// Value of [`FoamUniform::gathered`] from the second of these winds on.
const MOST_GATHERED: f64 = 0.9;

/// Block of foam in a frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct FoamUniform {
    pub kept: [f32; AGES],
    pub lace: [f32; 4],
    pub streaks: [[f32; 4]; 2],
    pub second: f32,
    pub gathered: f32,
    pub pad: [f32; 2],
}

/// Returns a place in periods of a texture as coordinates within one period.
fn repeated(place: DVec2) -> [f32; 2] {
    [place.x - place.x.floor(), place.y - place.y.floor()].map(|v| v as f32)
}

/// Returns the streaks of a direction, given by its number: texture coordinates of an anchor on the map, and cosine and
/// sine of the direction.
fn streak(number: f64, anchor_m: DVec2) -> [f32; 4] {
    let (sin, cos) = libm::sincos((number * STREAK_STEP_DEG).to_radians());
    let turn = DVec2::new(cos, sin);
    let [x, y] = repeated(to_tile(turn, anchor_m) / DVec2::new(STREAK_LONG_M, STREAK_WIDE_M));
    [x, y, turn.x as f32, turn.y as f32]
}

impl FoamUniform {
    /// Returns the block around an anchor on the map, for a wind, m/s, and the direction that it comes from, degrees.
    pub fn new(law: &FoamLaw, anchor_m: DVec2, wind_m_s: f64, from_deg: f64) -> Self {
        let [fine, coarse] = [anchor_m / LACE_FINE_M, to_tile(LACE_TURN, anchor_m) / LACE_COARSE_M].map(repeated);
        // Streaks are the same in opposite directions; the angle runs from east to north.
        let steps = (270.0 - from_deg).rem_euclid(180.0) / STREAK_STEP_DEG;
        let [from, until] = STREAK_WINDS_M_S;
        Self {
            kept: law.kept.map(|share| share as f32),
            lace: [fine[0], fine[1], coarse[0], coarse[1]],
            streaks: [steps.floor(), steps.floor() + 1.0].map(|number| streak(number, anchor_m)),
            second: smoothstep(0.25, 0.75, steps.fract()) as f32,
            gathered: (MOST_GATHERED * smoothstep(from, until, wind_m_s)) as f32,
            pad: [0.0; 2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn shaders_have_the_lengths_of_the_patterns() {
        let text = shader::assemble("sea/foam.wgsl").unwrap();
        for (name, value) in [
            ("LACE_FINE: f32", format!("{LACE_FINE_M:?}")),
            ("LACE_COARSE: f32", format!("{LACE_COARSE_M:?}")),
            ("LACE_TURN: vec2f", format!("vec2f({:?}, {:?})", LACE_TURN.x, LACE_TURN.y)),
            ("STREAK_LONG: f32", format!("{STREAK_LONG_M:?}")),
            ("STREAK_WIDE: f32", format!("{STREAK_WIDE_M:?}")),
        ] {
            let line = format!("const {name} = {value};");
            assert!(text.contains(&line), "{line}");
        }
    }

    #[test]
    fn streaks_turn_with_the_wind_without_a_jump() {
        let law = FoamLaw { from: 0.3, variance: 0.02, short_deviation: 0.1, kept: [0.5; AGES] };
        let at = |deg: f64| FoamUniform::new(&law, DVec2::new(1e6, -3e5), 25.0, deg);
        // Wind from west blows along the first direction.
        let west = at(270.0);
        assert_eq!((west.streaks[0][2..].to_vec(), west.second), (vec![1.0, 0.0], 0.0));
        // Close to a direction that streaks can have, on both sides of it, that direction has all the weight.
        let [before, after] = [at(270.0 - 22.499), at(270.0 - 22.501)];
        assert_eq!((before.second, after.second), (1.0, 0.0));
        assert_eq!(before.streaks[1], after.streaks[0]);
    }
}
