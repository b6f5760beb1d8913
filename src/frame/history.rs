//! History of a view: its last calls.

use std::time::Duration;

use super::unit::LuminanceUnitCheck;
use crate::{
    stage::{Report, Stages},
    world::KeptScene,
};

/// Calls of the last frame, and what was found of it.
pub(super) struct FrameHistory {
    /// The frame that the plan was made for.
    pub planned_for: Option<u64>,
    /// Texels of the veil's textures over the units of the last picture.
    pub light_scale: f32,
    pub unit: LuminanceUnitCheck,
    /// Stages of the frame so far.
    pub recorded: Stages,
    pub report: Report,
    /// The scene of the last call, for the next calls of the frame.
    pub scene: Option<Box<KeptScene>>,
    /// Time that the last measured call took, its wait for earlier work included.
    pub last_call: Option<Duration>,
}

impl Default for FrameHistory {
    fn default() -> Self {
        Self {
            planned_for: None,
            light_scale: 0.0,
            unit: LuminanceUnitCheck::default(),
            recorded: Stages(0),
            report: Report { frame_id: u64::MAX, ..Report::default() },
            scene: None,
            last_call: None,
        }
    }
}
