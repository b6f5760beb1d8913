//! Budget for the pictures of a view: error, time, and the host's wishes for single parts.

use super::parts::Part;
use crate::error::{Error, Result, check_range};

/// Wish of a host for one part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PartWish {
    /// Importance of the part to viewers, [0, 1]. A budget of time leaves out the less important parts first. Default
    /// `None`: the part's own [`Part::importance`].
    pub importance: Option<f64>,
    /// Rung at which the part is drawn whatever the tolerance and the time, so that all views of a simulator draw the
    /// part alike. [`Plan::gave_way`](super::Plan::gave_way) still names the limit that the picture then breaks.
    /// Default `None`: the plan chooses the rung.
    pub rung: Option<usize>,
}

/// Limits for a view's pictures: the time that one may take, and how wrong it may be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Budget {
    /// Largest error that leaving parts out may cause, (0, 1]. The error of a pixel is |Y' - Y| / (Y + 0.01 white)
    /// after exposure, where Y is the luminance with everything drawn and Y' that of the planned picture. The 95th
    /// percentile over pixels must be at most the tolerance, and the worst pixel at most ten times the tolerance. An
    /// error of 0.01 is not visible. Default `None`: everything is drawn, unless `milliseconds` says otherwise.
    pub tolerance: Option<f64>,
    /// Longest time that the weather may take in a frame, ms, (0, 1000]. It wins over the tolerance. The times that the
    /// host reports by [`View::report_time`](crate::frame::View::report_time) decide how many parts are left out.
    /// Default `None`: no limit.
    pub milliseconds: Option<f64>,
    /// Wishes for single parts, in the order of [`frame::PARTS`](crate::frame::PARTS). The list may be shorter: the
    /// parts after its end have no wish. Default: empty.
    pub wishes: Vec<PartWish>,
}

impl Budget {
    /// Creates a budget that pins each part to its rung in `rungs`, in the order of
    /// [`frame::PARTS`](crate::frame::PARTS).
    pub fn pinned(rungs: &[usize]) -> Self {
        let wishes = rungs.iter().map(|rung| PartWish { rung: Some(*rung), ..PartWish::default() }).collect();
        Self { wishes, ..Self::default() }
    }

    /// Checks that all fields are in range. The error names the field that is not.
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

    /// Whether planning by this budget needs the gauge.
    pub(crate) fn gauges(&self) -> bool {
        self.tolerance.is_some() || self.milliseconds.is_some()
    }
}
