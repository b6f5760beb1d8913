//! The world that all views of a simulator share: its place on the planet, the timeline of weathers, the clock, sun and
//! moon, the wind, and the host's shelters, occluder maps and lamps. The world names no effect. Effects with a state of
//! their own are advanced along with the world ([`HeldEffect`]).
//!
//! Everything here is a function of the description, the host's settings, the timeline, the states that effects
//! publish, time and position. Two worlds with the same input give the same answers on every machine, except that the
//! sun's direction may differ by 1e-14 (`src/almanac/celestial.rs`). No device and no frame is needed.

mod air;
mod binary;
mod color;
mod couplings;
mod detours;
mod dug;
mod held;
mod kept;
mod lights;
mod moment;
mod regions;
mod saved;
mod saved_settings;
mod scene;
mod settings;
mod state;
mod wind;

pub(crate) use binary::{binary_text, text_binary};
pub(crate) use color::color_of;
pub(crate) use couplings::Couplings;
pub(crate) use dug::{DUG_SIDE, DUG_WATER_S, DugGround};
pub(crate) use held::{HeldEffect, HeldEffects, UpdateBudget};
pub(crate) use kept::KeptScene;
pub(crate) use saved::{LoadedWorld, SavedWorld, parse_error};
pub(crate) use saved_settings::{values, words};
pub(crate) use scene::{light_above_clouds, night_share, zenith_depth};
pub use settings::GivenDirection;
pub(crate) use settings::{NightSettings, Settings};
pub(crate) use state::{World, WorldDesc, next_revision};
