//! The front room: queries and settings of single effects on contexts and views, for Rust hosts. Below this room, only
//! the list of effects (`src/effects.rs`) names single effects.

mod air;
mod clouds;
mod ground;
mod lightning;
mod rain;
mod regions;
mod sea;
mod sky;
mod snowpack;
mod soil;
mod stars;
mod terrain;
mod view;
mod wind;
