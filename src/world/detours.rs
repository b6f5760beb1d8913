//! Detours that a world keeps: the last map that was asked for, and its inputs.

use std::sync::{Arc, Mutex};

use glam::DVec2;

use crate::wind::DetourMap;

/// Inputs from which detours follow.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct DetourInputs {
    pub volume: u64,
    pub terrain: u64,
    /// Weather's wind at two heights above ground, m/s.
    pub weathers_m_s: [DVec2; 2],
    pub life_m: f64,
}

/// The last detours that were asked for, with their inputs.
#[derive(Default)]
pub(super) struct KeptDetours(pub Mutex<Option<(DetourInputs, Option<Arc<DetourMap>>)>>);
