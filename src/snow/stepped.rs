//! Inputs for stepping the flakes of the lattice through a wind that varies in space ([`crate::particles::stepping`]
//! has the model). The step leaves out their helix, which is added around the stepped place when they are drawn.

use glam::DVec3;

use super::{
    lattice::{Flakes, SALT, side_m},
    uniforms::FlakesUniform,
};
use crate::{
    falling::lattice::short_seed,
    gpu::{Device, blocks::Blocks},
    particles::{
        MovingAir, StreakCamera,
        stepping::{StepPass, Stepped},
    },
    surroundings::{WindMap, WindView},
};

/// Creates the pass that steps flakes.
pub(super) fn pass(device: &Device, blocks: &Blocks) -> StepPass {
    StepPass::new(device, blocks, ("snow/step.wgsl", "step_flakes"), 128, size_of::<FlakesUniform>())
}

/// Creates the inputs of a step of the flakes.
pub(super) fn stepped<'a>(
    (seed, flakes): (u64, &Flakes),
    (camera, air): (&StreakCamera<'_>, &MovingAir),
    carried: &'a dyn Fn(f64) -> DVec3,
    wind: (WindView, Option<WindMap>),
) -> Stepped<'a> {
    Stepped {
        seed: short_seed(seed) ^ SALT,
        counts: flakes.counts(),
        sides_m: std::array::from_fn(side_m),
        least_room: 0,
        position_m: camera.position_m,
        time_s: air.time_s,
        air_m_s: air.velocity_m_s,
        carried,
        anew: false,
        wind,
    }
}

#[cfg(test)]
mod tests;
