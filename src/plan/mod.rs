//! Plan of a picture: what the parts of the weather are worth in it, and which of them it does with less of.
//!
//! Ways to draw an effect have their [`Work`], a deterministic model of cost, and their [`Difference`] from the truth
//! (`src/candidates.rs`). A view with a [`Budget`] gauges its own picture (a coarse grid of its pixels, read back
//! without waiting), chooses at which rung each [`Part`] of the weather is drawn ([`parts`]), and fades between them so
//! that nothing pops. [`Plan`] says what was chosen and why, and the error to expect; [`Prediction`] holds that against
//! what was. A plan can be saved and pinned elsewhere ([`View::save_plan`](crate::frame::View::save_plan)).

mod budget;
mod choice;
pub mod difference;
pub mod estimate;
mod gauge;
mod governor;
pub mod parts;
mod planner;
mod saved;
mod search;
mod work;

pub use budget::{Budget, Wish};
pub use difference::{Difference, difference};
pub use estimate::Estimate;
pub use governor::GaveWay;
pub use parts::{Part, Reason, StepWork};
pub use planner::{PartPlan, Plan, Prediction};
pub(crate) use planner::{Planner, Presence, Situation, Unseen};
pub(crate) use saved::{PlanSettings, read, write};
pub use work::{Listed, Price, Units, Work};
