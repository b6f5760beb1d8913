//! Noise in textures that repeat without a seam, out of which clouds are cut.
//!
//! A noise texture is a sum of octaves. Each octave has twice as many cells across the texture as the one before, and a
//! smaller amplitude A. There are three kinds ([`NoiseKind`]):
//!
//! - gradient noise N (Perlin 2002, *Improving Noise*): 0 at the corners of the cells, with continuous second
//!   derivatives. The texel holds the sum of A (1 + N) / 2 over the octaves. With this mapping the presets of
//!   Tarantilis (2004, *Simulating Clouds with Procedural Texturing Techniques Using the GPU*, section IV.A.1) have the
//!   covers that their names say;
//! - cellular noise 1 - F1 (Worley 1996, *A Cellular Texture Basis Function*), where F1 is the distance to the nearest
//!   feature point and each cell has one such point. It forms round lumps. The texel holds the sum of A (1 - F1) over
//!   the octaves;
//! - both combined: gradient noise mapped from \[0, 1\] to \[cellular noise, 1\] (Schneider 2015, *The Real-time
//!   Volumetric Cloudscapes of Horizon: Zero Dawn*). It is connected like gradient noise and round like cellular noise.
//!
//! Sums are clamped to \[0, 1\] and stored as bytes. An octave needs at least two texels to a cell. Finer octaves add
//! only their mean, so that a small texture is as bright as a large one. The host gives the seed; the clock is never
//! used.
//!
//! [`NoiseImage`] computes the bytes on the CPU, the same on every machine. [`NoiseTexture`] draws the same noise on
//! the GPU by fragment passes, without compute, slice by slice over any number of frames. The two agree within 1 of
//! 255, mip levels included. [`NoiseImage::load`] reads DDS and KTX2 files. [`CloudFunction`] turns noise into opacity.
//!
//! Cost: `cargo bench --bench speed -- noise`.

mod file;
mod image;
mod opacity;
mod presets;
mod reference;
mod settings;
mod texture;

pub use image::NoiseImage;
pub use opacity::CloudFunction;
pub use presets::CloudPreset;
pub use reference::{cellular_2d, cellular_3d, gradient_2d, gradient_3d, noise_at};
pub use settings::{NoiseKind, NoiseSettings};
pub use texture::NoiseTexture;
