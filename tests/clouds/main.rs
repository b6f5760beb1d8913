//! Clouds as a volume, drawn.

mod drawn;
#[path = "../support/textures.rs"]
mod textures;
