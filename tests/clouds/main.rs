//! Clouds as a volume, drawn.

mod asked;
mod carried;
mod drawn;
mod elsewhere;
#[path = "../frame/lookup.rs"]
mod lookup;
mod plan;
mod shadows;
#[path = "../support/textures.rs"]
mod textures;
