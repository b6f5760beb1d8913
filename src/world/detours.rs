//! Cache of the last map of detours and its inputs. A detour is the distance by which air that flows around obstacles
//! lags behind the wind's displacement (`src/wind/detour.rs`).

use std::sync::{Arc, Mutex};

use glam::DVec2;

use crate::wind::DetourMap;

/// Inputs from which a map of detours follows; equal inputs give equal maps.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct DetourInputs {
    /// Revision of the wind that varies in space.
    pub volume: u64,
    /// Hash or revision of the host's terrain; 0 without one.
    pub terrain: u64,
    /// Weather's wind (east, north) at 2 m and 20 m above ground, m/s.
    pub weathers_m_s: [DVec2; 2],
    /// Distance that a patch of the weather's low layer drifts during its life, m: taken as the size of a patch.
    pub life_m: f64,
}

/// The last map of detours, `None` if no air lags, with its inputs.
#[derive(Default)]
pub(super) struct KeptDetours(pub Mutex<Option<(DetourInputs, Option<Arc<DetourMap>>)>>);
