//! Flash that the host triggers.

use glam::DVec3;

use super::flash::{FlashKind, MOST_STROKES};
use crate::error::{Error, Result, check_range};

/// Largest distance of a place from the origin of the host's world, m.
const FARTHEST_M: f64 = 1e12;

/// A flash that the host triggers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlashTrigger {
    /// Time of its first stroke, s of simulation time; not before the present.
    pub time_s: f64,
    /// Position that the flash strikes, in the host's world, m. A flash in the cloud passes over this position.
    pub position: DVec3,
    /// Kind of the flash.
    pub kind: FlashKind,
    /// Largest peak current, kA, \[1, 500\]; `None` for a random one.
    pub peak_ka: Option<f64>,
    /// Number of strokes, 1 to 26; `None` for a random one.
    pub strokes: Option<u32>,
}

impl FlashTrigger {
    /// Checks the ranges; an error names the field.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        check_range("flash.time_s", self.time_s, -1e10, 1e10, "s")?;
        check_place("flash.position", self.position)?;
        if let Some(peak_ka) = self.peak_ka {
            check_range("flash.peak_ka", peak_ka, 1.0, 500.0, "kA")?;
        }
        if let Some(strokes) = self.strokes {
            check_range("flash.strokes", f64::from(strokes), 1.0, MOST_STROKES as f64, "")?;
        }
        Ok(())
    }
}

/// Refuses a place that is not finite or too far from the origin of the host's world. The error names the place as
/// `name`.
pub(super) fn check_place(name: &str, position: DVec3) -> Result<()> {
    if position.is_finite() && position.length() <= FARTHEST_M {
        return Ok(());
    }
    Err(Error::range(name, "finite and within 1e12 m of the world's origin", position))
}
