//! Clouds as a volume, drawn.

mod asked;
mod bases;
mod carried;
mod drawn;
mod elsewhere;
mod handed;
#[path = "../frame/lookup.rs"]
mod lookup;
mod placed;
mod plan;
mod seams;
mod shadows;
mod shafts;
#[path = "../support/textures.rs"]
mod textures;
