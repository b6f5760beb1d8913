//! The front room: what a Rust host asks of contexts and views by the names of effects. The rooms below it, but for the
//! list of effects, name none.

mod air;
mod clouds;
mod ground;
mod lightning;
mod rain;
mod sky;
mod snowpack;
mod stars;
mod terrain;
mod view;
mod wind;
