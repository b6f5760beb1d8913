//! What could draw each effect, what that costs, and how wrong the picture becomes.
//!
//! A [`Candidate`] is one way to draw an effect: a model at a setting, with its [`Work`], a deterministic model of its cost
//! in samples, texels and bytes. The lab (`examples/lab`) draws every candidate, measures cost and [`Difference`] from
//! the f64 reference, and charts them; of what is [`Candidate::offered`], only those on the front ([`front::pareto`])
//! are worth a choice.
//!
//! A view with a [`Budget`] gauges its own picture (a coarse grid of its pixels, read back without waiting), chooses
//! at which rung each [`Part`] of the weather is drawn ([`parts`]), and fades them out and in so that nothing pops.
//! [`Plan`] says what was chosen and why, and the error to expect; [`Prediction`] holds that against what was. A plan can be
//! saved and pinned elsewhere ([`View::save_plan`](crate::frame::View::save_plan)).
//!
//! ```
//! use welkin::plan::{Effect, Method, candidate, candidates};
//!
//! let half = candidate(Effect::Sky, "directional-half").unwrap();
//! let Method::Sky(settings) = half.method else { panic!() };
//! let default = candidates(Effect::Sky).into_iter().find(|c| c.is_default()).unwrap();
//! assert!(half.work.view.samples < default.work.view.samples);
//! settings.check().unwrap(); // ready for `SkyTables::new`
//! ```

mod candidate;
mod choice;
pub mod difference;
pub mod estimate;
pub mod front;
mod gauge;
mod governor;
pub mod parts;
mod planner;
mod saved;
mod search;

pub use candidate::{Candidate, Effect, Method, Price, Units, Work, candidate, candidates};
pub use difference::{Difference, difference};
pub use estimate::Estimate;
pub use governor::GaveWay;
pub use parts::{Part, Reason, StepWork};
pub use planner::{Budget, PartPlan, Plan, Prediction, Wish};
pub(crate) use planner::{PartNow, Planner, Present, Situation, Unseen};
pub(crate) use saved::{Settings, read, write};
