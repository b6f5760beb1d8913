//! Drawing of clouds: rays through them in f64 and on the GPU, and a picture's uniforms, tables, pipelines and
//! textures.

pub(crate) mod march;
pub(crate) mod noise;
pub(crate) mod picture;
pub(crate) mod pipelines;
pub mod probe;
pub(crate) mod rows;
pub(crate) mod tables;
pub mod traced;
pub(crate) mod uniforms;
