//! Noise: its properties, the GPU's noise against the CPU's, its files, and the cover of the presets of Tarantilis
//! (2004).

mod cover;
mod files;
mod gpu;
mod loaders;
mod reference;
