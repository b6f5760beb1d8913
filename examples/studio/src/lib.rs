//! The studio: one window in which the weather is set, seen and written out.
//!
//! Everything that a C host sets stands in one table, which is read from the header (`table`): the panel, the settings
//! file and the page of the manual are made from it, so a new field of the library shows up in all three. The same
//! commands work in the window and in a script without a display (`script`).

pub mod app;
pub mod bytes;
pub mod camera;
pub mod headless;
pub mod history;
pub mod manual;
pub mod objects;
pub mod pages;
pub mod paint;
pub mod panel;
pub mod script;
pub mod settings;
pub mod table;
pub mod window;
pub mod world;
