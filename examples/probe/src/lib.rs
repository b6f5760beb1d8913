//! Questions to the drawn models, from tables in CSV to tables in CSV: the commands of `probe`.

pub mod clouds;
pub mod command;
pub mod csv;
pub mod flow;
pub mod fog;
pub mod lightning;
pub mod rain;
pub mod scene;
pub mod sky;
pub mod snow;
