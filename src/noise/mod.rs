//! Noise in textures that repeat without a seam: what clouds are cut out of.
//!
//! A texture of noise is a sum of octaves, each with twice as many cells to the texture as the one before and a smaller
//! amplitude. Three kinds of it ([`NoiseKind`]):
//!
//! - gradient noise N (Perlin 2002, *Improving Noise*): 0 at the corners of the cells, with continuous second
//!   derivatives. The texel holds the sum of A (1 + N) / 2 over the octaves, the mapping with which the presets of
//!   Tarantilis (2004, *Simulating Clouds with Procedural Texturing Techniques Using the GPU*, section IV.A.1) have the
//!   cover of their names;
//! - cellular noise 1 - F1 (Worley 1996, *A Cellular Texture Basis Function*), F1 the distance to the nearest of points
//!   of which each cell has one: round lumps. The texel holds the sum of A (1 - F1);
//! - both: gradient noise mapped from \[0, 1\] to \[cellular noise, 1\] (Schneider 2015, *The Real-time Volumetric
//!   Cloudscapes of Horizon: Zero Dawn*): connected like the one and round like the other.
//!
//! Sums are clamped to \[0, 1\] and stored as bytes. An octave needs two texels to a cell; finer ones add their mean
//! alone, so that a smaller texture is as bright as a large one. The seed is a number of the host's, never the clock.
//!
//! [`NoiseImage`] has the bytes on the CPU, the same on every machine. [`NoiseTexture`] draws the same noise on the GPU
//! by fragment passes, without compute, slice by slice over as many frames as one likes. The two agree within 1 of 255,
//! mip levels too. [`NoiseImage::load`] reads DDS and KTX2 files. [`CloudFunction`] turns noise into opacity.
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
