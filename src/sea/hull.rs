//! Hulls that raise wakes, as the host describes them.

use serde::{Deserialize, Serialize};

use crate::error::{Result, check_range};

/// Maximum number of hulls.
pub const MAX_SEA_HULLS: usize = 64;

/// A hull that moves through the water and raises a wake. It keeps its speed and its rate of turn until it is set
/// anew.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeaHull {
    /// Number by which the hull is known when it is set again. No two hulls have the same. Default 0.
    pub id: u32,
    /// Length of the waterline, m. Range [1, 500], default 30.
    pub length_m: f64,
    /// Beam of the waterline, m. Range [0.2, 100], default 8.
    pub beam_m: f64,
    /// Draught, m. Range [0.05, 30], default 2.5.
    pub draught_m: f64,
    /// Position of the middle of the waterline in the host's world at the time `at_s`, m, within 1e12 of the origin.
    /// Default (0, 0, 0). Its height does not matter.
    pub position_m: [f64; 3],
    /// Heading at `at_s`, degrees clockwise from true north. Range [-360, 360], default 0. The hull moves in the
    /// direction of its heading.
    pub heading_deg: f64,
    /// Speed through the water, m/s. Range [0, 60], default 0.
    pub speed_m_s: f64,
    /// Rate of turn, degrees clockwise a second. Range [-90, 90], default 0.
    pub turn_deg_s: f64,
    /// Simulation time of position and heading, s. Range [-1e10, 1e10], default 0.
    pub at_s: f64,
}

impl Default for SeaHull {
    fn default() -> Self {
        Self {
            id: 0,
            length_m: 30.0,
            beam_m: 8.0,
            draught_m: 2.5,
            position_m: [0.0; 3],
            heading_deg: 0.0,
            speed_m_s: 0.0,
            turn_deg_s: 0.0,
            at_s: 0.0,
        }
    }
}

impl SeaHull {
    /// Checks all fields but the position.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        check_range("length_m", self.length_m, 1.0, 500.0, "m")?;
        check_range("beam_m", self.beam_m, 0.2, 100.0, "m")?;
        check_range("draught_m", self.draught_m, 0.05, 30.0, "m")?;
        check_range("heading_deg", self.heading_deg, -360.0, 360.0, "degrees")?;
        check_range("speed_m_s", self.speed_m_s, 0.0, 60.0, "m/s")?;
        check_range("turn_deg_s", self.turn_deg_s, -90.0, 90.0, "degrees/s")?;
        check_range("at_s", self.at_s, -1e10, 1e10, "s")
    }
}
