//! Soil: ground that is dug, carried, heaped and pressed, with its mass kept to the microgram.
//!
//! **Columns** (`patch.rs`). The undug ground is the host's. Where it was never touched, nothing is stored. A patch of
//! 16 x 16 cells stores, for each cell, how deep the undisturbed soil (the bank) was cut, and the depth of the loose
//! soil on the cell and its mass of each kind. Depths are whole numbers of 2^-20 m, masses whole micrograms. Moves
//! split a mass and add the two parts to what is there, so dug + brought = lying + held + taken holds exactly
//! ([`SoilBooks`]). Volume is not kept: bank swells as it is dug, and wheels compact it.
//!
//! **Tools** (`tool.rs`, `work.rs`). A bucket or blade is described by its cutting edge, the opposite edge of its
//! opening, the direction out of the opening, and a volume. Between two poses the edge sweeps a ribbon (`ribbon.rs`),
//! and each cell loses soil over the share of its area that the ribbon covers, down to the height of the edge. The soil
//! fills the bucket up to its rated heap (SAE J296), or is pushed ahead. What a tilted bucket cannot hold pours from
//! the lowest edge of its opening. Wheels and tracks sink by Bekker's law. `laws/` has all laws in f64, each with its
//! source.
//!
//! **Slides** (`field.rs`, `src/slides.rs`). Loose soil lies up to its angle of repose. Bank stands as a wall up to the
//! height of Culmann's law (`walls.rs`). A higher wall breaks, and what lies above the slope of repose slides.
//!
//! **Time** (`site.rs`). Steps of [`SOIL_STEP_S`] end at whole multiples of [`SOIL_STEP_S`]. [`SoilSite::advance`] runs
//! a step once every live tool has a pose at or after the step's end; in a context a tool without a later pose stands
//! still. The same timed poses therefore give the same bits at any frame rate. A step does at most eight sweeps; a site
//! in which nothing moves is skipped.
//!
//! **Context** (`held.rs`, `weather.rs`). A context holds a site on the tiles of its terrain, and adds the change of
//! the soil to the tiles' heights. Once a minute the bank takes up water from a wet surface or drains, which changes
//! its cohesion, and cold air freezes it from the surface down; tools do not cut bank that is frozen deeper than 5 cm.
//! A host may also keep a [`SoilSite`] of its own, which has no weather.
//!
//! Limits: a cell has one column, so a cell that is cut in part gives its upper layers first, and nothing overhangs.
//! Soil is drawn with its terrain, as heights and colours of the tiles (`shown.rs`), so there are no `view.rs`,
//! `passes.rs` and `candidates.rs`; `laws/` is the physics in f64 in place of `reference.rs`.

mod field;
mod heap;
mod held;
mod kind;
pub mod laws;
mod material;
mod patch;
mod resistance;
mod ribbon;
mod saved;
mod shown;
mod site;
#[cfg(test)]
mod tests;
mod tool;
mod walls;
mod weather;
mod work;

pub use heap::{HEAP_AZIMUTHS_DEG, heap_radii_m};
pub use held::SoilChange;
pub(crate) use held::{HeldSoil, LoadedSoil};
pub use kind::{MAX_HORIZONS, MAX_SOIL_KINDS, SoilHorizon, SoilKind, SoilKindId, SoilSettings};
pub use patch::UndugGround;
pub use resistance::SoilBlade;
pub use site::{SOIL_STEP_S, SoilBooks, SoilPoint, SoilSite, SoilSiteDesc, SoilToolReport};
pub use tool::{MAX_SOIL_TOOLS, SoilToolId, SoilToolPose, SoilToolShape};
