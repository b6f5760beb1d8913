//! Detours that a world keeps: the last map that was asked for, and all that it follows from.

use std::sync::{Arc, Mutex};

use glam::DVec2;

use crate::wind::DetourMap;

/// All that detours follow from.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct DetourInputs {
    pub volume: u64,
    pub terrain: u64,
    /// At two heights over the ground.
    pub weathers_m_s: [DVec2; 2],
    pub life_m: f64,
}

/// The last detours that were asked for.
#[derive(Default)]
pub(super) struct KeptDetours(pub Mutex<Option<(DetourInputs, Option<Arc<DetourMap>>)>>);
