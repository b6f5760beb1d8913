//! Settings of the lightning: rate, storm cells, tall objects, and the limit on flicker.

use glam::DVec3;

pub use super::trigger::FlashTrigger;
use super::{schedule::MOST_PER_MINUTE, trigger::check_place};
use crate::error::{Error, Result, check_range};

/// Largest number of a host's storm cells.
pub const MAX_CELLS: usize = 16;
/// Largest number of a host's tall objects.
pub const MAX_MASTS: usize = 64;
/// Largest number of triggered flashes that are kept at a time.
pub const MAX_TRIGGERED: usize = 64;
/// A storm cell from the host.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StormCell {
    /// Middle of the cell in the host's world, m; the height does not matter.
    pub position: DVec3,
    /// Distance from the middle within which two thirds of the flashes start, m, \[0, 1e5\].
    pub radius_m: f64,
    /// Flashes a minute, \[0, 60\].
    pub flashes_per_minute: f64,
}

/// Settings of a context's flashes, and of how its views show them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightningSettings {
    /// Flashes a minute of each of the weather's storm cells, \[0, 60\], in place of the weather's rate (3 in a
    /// thunderstorm, otherwise none). The host's cells have rates of their own. Default `None`: the weather's rate.
    pub flashes_per_minute: Option<f64>,
    /// The host's storm cells, at most [`MAX_CELLS`]. They replace the weather's cells, one in each square of 20 km x
    /// 20 km. Default none.
    pub cells: Vec<StormCell>,
    /// Tips of tall objects in the host's world, m, at most [`MAX_MASTS`]. They attract ground flashes. Default none.
    pub masts: Vec<DVec3>,
    /// Whether views draw at most three changes of luminance a second, for viewers whom flicker may harm. Schedule and
    /// queries do not change. Default off.
    pub limits_flicker: bool,
}

impl LightningSettings {
    /// Checks the ranges; an error names the field.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        if let Some(rate) = self.flashes_per_minute {
            check_range("lightning.flashes_per_minute", rate, 0.0, MOST_PER_MINUTE, "1/min")?;
        }
        if self.cells.len() > MAX_CELLS {
            return Err(Error::range("lightning.cells", &format!("at most {MAX_CELLS}"), self.cells.len()));
        }
        if self.masts.len() > MAX_MASTS {
            return Err(Error::range("lightning.masts", &format!("at most {MAX_MASTS}"), self.masts.len()));
        }
        for (i, cell) in self.cells.iter().enumerate() {
            let name = |field: &str| format!("lightning.cells[{i}].{field}");
            check_place(&name("position"), cell.position)?;
            check_range(&name("radius_m"), cell.radius_m, 0.0, 1e5, "m")?;
            check_range(&name("flashes_per_minute"), cell.flashes_per_minute, 0.0, MOST_PER_MINUTE, "1/min")?;
        }
        self.masts.iter().enumerate().try_for_each(|(i, tip)| check_place(&format!("lightning.masts[{i}]"), *tip))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lightning::flash::FlashKind;

    #[test]
    fn what_is_out_of_range_is_refused_by_name() {
        let cell = StormCell { position: DVec3::ZERO, radius_m: 1.0, flashes_per_minute: 1.0 };
        let set =
            |cells, masts, rate| LightningSettings { flashes_per_minute: rate, cells, masts, limits_flicker: false };
        for (bad, name) in [
            (set(vec![], vec![], Some(61.0)), "lightning.flashes_per_minute"),
            (set(vec![cell; 17], vec![], None), "lightning.cells"),
            (set(vec![cell, StormCell { radius_m: -1.0, ..cell }], vec![], None), "lightning.cells[1].radius_m"),
            (set(vec![], vec![DVec3::NAN], None), "lightning.masts[0]"),
            (set(vec![], vec![DVec3::ZERO; 65], None), "lightning.masts"),
        ] {
            let e = bad.validate().unwrap_err().to_string();
            assert!(e.contains(name), "{e}");
        }
        let flash = FlashTrigger {
            time_s: 0.0,
            position: DVec3::ZERO,
            kind: FlashKind::ToGround,
            peak_ka: Some(30.0),
            strokes: Some(3),
        };
        flash.validate().unwrap();
        for (bad, name) in [
            (FlashTrigger { time_s: f64::NAN, ..flash }, "flash.time_s"),
            (FlashTrigger { position: DVec3::splat(1e13), ..flash }, "flash.position"),
            (FlashTrigger { peak_ka: Some(0.0), ..flash }, "flash.peak_ka"),
            (FlashTrigger { strokes: Some(27), ..flash }, "flash.strokes"),
        ] {
            let e = bad.validate().unwrap_err().to_string();
            assert!(e.contains(name), "{e}");
        }
    }
}
