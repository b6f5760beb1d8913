//! Plan of a picture: how much each part of the weather matters in it, and which parts are drawn in less detail.
//!
//! Each way to draw an effect has its [`Work`], a deterministic model of its cost, and its [`Difference`] from the
//! truth (`src/candidates.rs`). A view whose [`Budget`] limits error or time gauges its own picture: it composes a
//! coarse grid of its pixels and reads the grid back without waiting. From the gauge the view chooses the rung at which
//! each [`Part`] of the weather is drawn ([`parts`]), and fades between rungs so that nothing pops. [`Plan`] says what
//! was chosen and why, and which error to expect. [`Prediction`] compares the predicted error with the measured one. A
//! plan can be saved and pinned in other views ([`View::save_plan`](crate::frame::View::save_plan)).

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

pub use budget::{Budget, PartWish};
pub use difference::{Difference, difference};
pub use estimate::Estimate;
pub use governor::GaveWay;
pub use parts::{Part, Reason, StepWork};
pub use planner::{PartPlan, Plan, Prediction};
pub(crate) use planner::{Planner, Presence, Situation, Unseen};
pub(crate) use saved::{PlanSettings, read, write};
pub use work::{Listed, Price, Units, Work};
