//! Drawing: rays through the clouds in f64 and on the GPU, and the blocks, tables, pipelines and textures of a picture.

pub(crate) mod march;
pub(crate) mod noise;
pub(crate) mod picture;
pub(crate) mod pipelines;
pub mod probe;
pub(crate) mod rows;
pub(crate) mod tables;
pub mod traced;
pub(crate) mod uniforms;
