//! The front room: queries and settings of single effects on contexts and views, for Rust hosts. No room below it names
//! a single effect, except the list of effects.

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
