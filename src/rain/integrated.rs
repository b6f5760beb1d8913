//! Drops that are stepped: for a wind that varies in space, such as that round a building.
//!
//! Drops are those of the lattice ([`super::lattice`]), as many in the same shells, but each has a place and a velocity of its
//! own, in a buffer of the view. In an even wind a drop starts where the lattice has it and stays there until it leaves
//! the cell round the camera.
//!
//! A step goes by drag that is linear while it lasts, solved exactly ([`step`]), so that no length of it is unstable. The rate
//! is that of drag by the square at the step's first moment, so short steps converge to it; where a step is long
//! against it, the rate at rest, which ends at the right fall.
//!
//! A drop that leaves its cell, or that the camera leaves behind, comes in again on the opposite side at a place by
//! chance (hash of its number and how often it has been there) at the speed that it has there at rest. As many leave as come in:
//! neither dropped frames nor a camera at 300 m/s make gaps or bursts. After a jump of time, or of the camera where the host
//! says so, all start anew.

use glam::DVec3;

use super::{
    Classes,
    lattice::{SHELLS, fraction, side_m},
    uniforms::{MovingAir, StreakCamera},
};
pub use crate::falling::drag::step;
use crate::surroundings::WindMap;

/// Longest time that is stepped over, s; what is longer starts anew.
pub(crate) const MOST_S: f64 = 10.0;
/// Longest time of one of the steps that a frame is divided into, s, as long as there are no more than [`MOST_STEPS`].
const STEP_S: f64 = 1.0 / 60.0;
/// Most steps of a frame.
const MOST_STEPS: f64 = 8.0;

/// `StepUniform` of `shaders/rain/step.wgsl`, which explains the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct StepUniform {
    pub air: [f32; 3],
    pub dt: f32,
    pub wind: WindMap,
    pub moved: [f32; 3],
    pub steps: u32,
    pub known: u32,
    pub capacity: u32,
    pad: [u32; 2],
    pub eye: [[u32; 4]; SHELLS],
    pub before: [[u32; 4]; SHELLS],
}

/// What the last step left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Left {
    pub time_s: f64,
    pub position_m: DVec3,
    pub per_shell: u32,
}

impl StepUniform {
    /// From what was `left` to now; none where there is nothing to step.
    pub fn new(
        classes: &Classes,
        shot: &StreakCamera<'_>,
        air: &MovingAir,
        left: Option<Left>,
        carried: &dyn Fn(f64) -> DVec3,
        wind: Option<WindMap>,
        capacity: u32,
    ) -> Option<Self> {
        let v = |d: DVec3| d.as_vec3().to_array();
        let left = left.filter(|l| (0.0..=MOST_S).contains(&(air.time_s - l.time_s)));
        let dt = left.map_or(0.0, |l| air.time_s - l.time_s);
        let moved = left.map_or(DVec3::ZERO, |l| shot.position_m - l.position_m);
        let known = left.map_or(0, |l| l.per_shell);
        if left.is_some() && dt == 0.0 && moved == DVec3::ZERO && known >= classes.per_shell {
            return None;
        }
        let steps = (dt / STEP_S).ceil().clamp(1.0, MOST_STEPS);
        let blows = match left {
            Some(l) if dt > 0.0 => carried(l.time_s) / dt,
            _ => air.velocity_m_s,
        };
        let places = |p: DVec3| {
            std::array::from_fn(|s| {
                let [x, y, z] = p.to_array().map(|x| fraction(x, side_m(s)));
                [x, y, z, 0]
            })
        };
        Some(Self {
            air: v(blows),
            dt: (dt / steps) as f32,
            steps: if dt > 0.0 { steps as u32 } else { 0 },
            known,
            capacity,
            moved: v(moved),
            eye: places(shot.position_m),
            before: places(shot.position_m - moved),
            wind: wind.unwrap_or_default(),
            pad: [0; 2],
        })
    }
}
