//! Lying snow: depth, density and liquid water, on level, open ground and for each cell of the host's terrain.
//!
//! **A column** (`column.rs`) has ice, liquid water, depth and an albedo. Mass and depth are whole numbers of 2^-24
//! kg/m^2 and m, so nothing is lost to rounding. New snow lands with a density by temperature and wind (Pahaut 1976).
//! The snow settles as its grains change and under its own load (Anderson 1976). It melts by temperature, sun and rain
//! (Pellicciotti et al. 2005; US Army Corps of Engineers 1956), holds liquid water up to a tenth of its ice's mass,
//! refreezes (Bergstroem 1976), and gives the rest of the water to the ground. `laws.rs` has these laws, each with its
//! equation.
//!
//! **A field** (`field.rs`) has a column for each node of the terrain. It consists of one patch for a grid, or of a
//! patch for each tile; patches without snow are skipped. Wind above the threshold (Li and Pomeroy 1997) carries snow
//! along (`drift.rs`; Pomeroy and Gray 1990), and snow steeper than 38 degrees slides (`slides.rs`). Boxes that stand
//! still keep snowfall off, stop the wind, and cast lees. Only `site.rs` reads heights, boxes and wind from the host's
//! data.
//!
//! Steps of [`STEP_S`] begin at whole multiples of [`STEP_S`], so the state does not depend on how often the host
//! updates the context. Fast-forward takes steps of [`COARSE_STEP_S`] with the same laws, and the state records how
//! much time was covered this way. A column is a single layer: there is no hard crust under new snow, and no frozen
//! ground.
//!
//! This room draws nothing. Effects that draw snow, take its meltwater or are lit by it read the world's `LyingSnow`.
//! So there are no `view.rs`, `passes.rs` and `candidates.rs`, and no `reference.rs`: `laws.rs` is the physics in f64.

mod column;
mod drift;
mod drift_state;
mod field;
mod held;
mod inputs;
pub mod laws;
mod patch;
mod published;
mod query;
mod saved;
mod site;
mod slides;
mod state;
mod step;
mod strips;
#[cfg(test)]
mod tests;

pub use held::LyingSnowModel;
pub(crate) use held::{HeldSnow, LoadedSnow};
pub use query::{SnowAt, SnowBalance, SnowFriction};
pub use state::{COARSE_STEP_S, STEP_S};
pub use strips::{MAX_STRIP_POINTS, SnowStrip};
