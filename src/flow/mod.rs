//! The air as a solved field.

mod advect;
mod field;
mod lattice;
mod multigrid;
mod obstacles;
mod openings;
mod pressure;
pub mod probe;
mod sides;
#[cfg(test)]
mod tests;

pub use advect::Scheme;
pub use field::{FlowField, FlowSettings, MAX_SPEED_M_S};
pub use obstacles::{FlowBox, FlowObstacles, Heights};
pub use pressure::{PressureMethod, Solved};
pub use sides::Side;
