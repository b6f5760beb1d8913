//! Clouds as a volume, drawn.

mod drawn;
mod shadows;
#[path = "../support/textures.rs"]
mod textures;
