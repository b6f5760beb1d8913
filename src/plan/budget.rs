//! Budget of a view for a picture, and how much the picture's parts matter.

use super::parts::Part;
use crate::error::{Error, Result, check_range};

/// Wish of a host for one part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wish {
    /// How much it matters to those who look, [0, 1]: what is left out first under a budget of time. Default `None`: as
    /// its room says ([`Part::importance`]).
    pub importance: Option<f64>,
    /// Draw it at this rung, whatever the tolerance and the time, so that all channels of a simulator draw alike; what
    /// of these that does not keep is still said ([`Plan::gave_way`](super::Plan::gave_way)). Default `None`: plan.
    pub rung: Option<usize>,
}

/// Limits of a view's picture: the time that it may take, and how wrong it may be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Budget {
    /// Largest error of what is left out, (0, 1]: 95th percentile over pixels of |Y' - Y| / (Y + 0.01 white) after
    /// exposure, and ten times as much at the worst pixel. Default `None`: everything is drawn. 0.01 is not seen.
    pub tolerance: Option<f64>,
    /// Longest time of the weather in a frame, ms, (0, 1000]: parts are left out as the times reported by
    /// [`View::report_time`](crate::frame::View::report_time) demand. It wins over the tolerance. Default `None`.
    pub milliseconds: Option<f64>,
    /// Wishes for single parts, in the order of [`frame::PARTS`](crate::frame::PARTS); parts that it does not reach
    /// have none. Default: empty.
    pub wishes: Vec<Wish>,
}

impl Budget {
    /// Draws just these rungs, in the order of the list of parts.
    pub fn pinned(rungs: &[usize]) -> Self {
        let wishes = rungs.iter().map(|rung| Wish { rung: Some(*rung), ..Wish::default() }).collect();
        Self { wishes, ..Self::default() }
    }

    /// Refuses what is out of range, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self, parts: &[Part]) -> Result<()> {
        let above_zero = |name: &str, value: Option<f64>, most: f64| match value {
            Some(v) if !(v.is_finite() && v > 0.0 && v <= most) => {
                Err(Error::range(name, &format!("in (0, {most}]"), v))
            }
            _ => Ok(()),
        };
        above_zero("budget.tolerance", self.tolerance, 1.0)?;
        above_zero("budget.milliseconds", self.milliseconds, 1000.0)?;
        if self.wishes.len() > parts.len() {
            return Err(Error::range(
                "budget.wishes.len",
                &format!("at most {}, one a part", parts.len()),
                self.wishes.len(),
            ));
        }
        for (i, (part, wish)) in parts.iter().zip(&self.wishes).enumerate() {
            if let Some(importance) = wish.importance {
                check_range(&format!("budget.wishes[{i}].importance"), importance, 0.0, 1.0, "")?;
            }
            if let Some(rung) = wish.rung.filter(|r| *r >= part.rungs.len()) {
                let (most, names) = (part.rungs.len() - 1, part.rungs.join(", "));
                let accepted = format!("in [0, {most}] for {}: {names}", part.name);
                return Err(Error::range(&format!("budget.wishes[{i}].rung"), &accepted, rung));
            }
        }
        Ok(())
    }

    /// Whether it asks what pictures show.
    pub(crate) fn gauges(&self) -> bool {
        self.tolerance.is_some() || self.milliseconds.is_some()
    }
}
