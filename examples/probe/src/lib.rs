//! The commands of `probe`: questions to the drawn models, read from CSV tables and answered as CSV tables.

pub mod cloud_shape;
pub mod clouds;
pub mod command;
pub mod csv;
pub mod flow;
pub mod fog;
pub mod lightning;
pub mod rain;
pub mod scene;
pub mod sea;
pub mod sky;
pub mod snow;
pub mod soil;
