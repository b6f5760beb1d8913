//! Clouds drawn as a volume.

mod asked;
mod bases;
mod carried;
mod drawn;
mod elsewhere;
mod far;
mod handed;
mod lamps;
mod mean_light;
mod placed;
mod plan;
mod seams;
mod shadows;
mod shafts;
