//! Inputs for stepping the drops of the lattice through a wind that varies in space (`particles::stepping` has the
//! model). `cull_pass` draws the stepped drops.

use glam::DVec3;

use super::{classes::Classes, shells::side_m, uniforms::RainUniform};
pub use crate::falling::drag::step;
use crate::{
    falling::lattice::short_seed,
    gpu::{Device, blocks::Blocks},
    particles::{
        MovingAir, StreakCamera,
        stepping::{StepPass, Stepped},
    },
    surroundings::{WindMap, WindView},
};

/// Seed offset that makes the places where drops enter independent of those of the lattice.
const COMES_IN: u32 = 0x9e37_79b9;

/// Creates the pass that steps drops.
pub(super) fn pass(device: &Device, blocks: &Blocks) -> StepPass {
    StepPass::new(device, blocks, ("rain/step.wgsl", "step_drops"), 64, size_of::<RainUniform>())
}

/// Drops of the lattice that are stepped in a frame.
pub(super) struct SteppedDrops<'a> {
    pub seed: u64,
    /// Number of drops of each class in a shell.
    pub classes: &'a Classes,
    /// Number of drawn shells of the lattice.
    pub shells: usize,
    /// Number of drops for which memory is allocated at least, in all drawn shells together. It may exceed the number
    /// of drops that are drawn now, because that number may soon grow, for example at the rim of a rain area.
    pub most: u32,
}

/// Returns the inputs for stepping the drops.
pub(super) fn stepped<'a>(
    drops: &SteppedDrops<'_>,
    (camera, air): (&StreakCamera<'_>, &MovingAir),
    carried: &'a dyn Fn(f64) -> DVec3,
    wind: (WindView, Option<WindMap>),
) -> Stepped<'a> {
    Stepped {
        seed: short_seed(drops.seed) ^ COMES_IN,
        counts: std::array::from_fn(|s| if s < drops.shells { drops.classes.per_shell } else { 0 }),
        sides_m: std::array::from_fn(side_m),
        least_room: drops.most.div_ceil(drops.shells.max(1) as u32),
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
