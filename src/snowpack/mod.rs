//! Snow that lies: how deep, how dense and how wet, on level, open ground and cell by cell on the host's terrain.
//!
//! **A column** (`column.rs`) has ice, held water, depth and an albedo, in whole units of 2^-24 kg/m^2 and m, so that
//! nothing is lost: what falls lands with the density of its temperature and wind (Pahaut 1976), settles by the change
//! of its grains and under its load (Anderson 1976), melts by temperature, sun and rain (Pellicciotti et al. 2005; US
//! Army Corps of Engineers 1956), holds a tenth of its mass as water, refreezes (Bergstroem 1976), and gives the rest
//! to the ground. `laws.rs` has these forms, each with its equation.
//!
//! **A field** (`field.rs`) has a column for each node of the terrain: one patch of a grid, or a patch for each tile,
//! of which those without snow are passed over. Wind above the threshold (Li and Pomeroy 1997) carries its snow along
//! (`drift.rs`; Pomeroy and Gray 1990), and what lies steeper than 38 degrees slides (`slides.rs`). Standing boxes keep
//! off what falls, stop the wind, and cast lees. `site.rs` alone knows where heights, boxes and wind come from.
//!
//! Steps of [`STEP_S`] begin at whole multiples of it, so that the state does not depend on how often it is led.
//! Fast-forward takes steps of [`COARSE_STEP_S`] with the same laws, and the state remembers how much of it was laid
//! so. One column is one layer: no hard crust under new snow, no frozen ground.
//!
//! Nothing here is drawn: what draws snow, runs from under it or is lit by it reads `LyingSnow` of the world. So there
//! are no `view.rs`, `passes.rs` and `candidates.rs`, and no `reference.rs`: `laws.rs` is the physics in f64.

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
pub use query::{SnowAt, SnowBooks, SnowFriction};
pub use state::{COARSE_STEP_S, STEP_S};
pub use strips::{MAX_STRIP_POINTS, SnowStrip};
