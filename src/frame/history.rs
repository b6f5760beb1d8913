//! History of a view: data of its last calls.

use std::time::Duration;

use super::unit::LuminanceUnitCheck;
use crate::{
    stage::{Report, Stages},
    world::KeptScene,
};

/// Data from the calls of the view's last frame so far.
pub(super) struct FrameHistory {
    /// Frame for which the plan was made.
    pub planned_for: Option<u64>,
    /// Factor from the values of the veil's textures to units of the last picture's colour.
    pub light_scale: f32,
    pub unit: LuminanceUnitCheck,
    /// Stages of the frame that have been recorded so far.
    pub recorded: Stages,
    pub report: Report,
    /// Scene of the last call, for the next calls of the frame.
    pub scene: Option<Box<KeptScene>>,
    /// Time that the last measured call took, with its wait for earlier work.
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
