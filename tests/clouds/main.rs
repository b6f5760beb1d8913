//! Clouds as a volume, drawn.

mod asked;
mod bases;
mod carried;
#[path = "../support/depth_texture.rs"]
mod depth_texture;
mod drawn;
mod elsewhere;
mod far;
mod handed;
mod lamps;
#[path = "../frame/lookup.rs"]
mod lookup;
mod placed;
mod plan;
mod seams;
#[path = "../support/seen_lux.rs"]
mod seen_lux;
mod shadows;
mod shafts;
#[path = "../support/textures.rs"]
mod textures;
mod told;
