//! Clouds as a volume, drawn.

mod asked;
mod carried;
mod drawn;
mod elsewhere;
mod handed;
#[path = "../frame/lookup.rs"]
mod lookup;
mod plan;
mod seams;
mod shadows;
#[path = "../support/textures.rs"]
mod textures;
