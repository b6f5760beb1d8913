//! Noise: its properties, the GPU's against the CPU's, its files, and the cover of the source's presets.

mod cover;
mod files;
mod gpu;
mod loaders;
mod reference;
