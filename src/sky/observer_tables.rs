//! Textures of an observer's tables: an array texture that shaders read, and separate textures of its layers that
//! passes mix.

use super::passes::table_texture;
use super::settings::SkySettings;
use crate::gpu::bind::as_layers;
use crate::gpu::{Device, Layer};

/// Number of layers for each lamp. The first is light scattered by gas or more than once. The second is light scattered
/// once by haze, without its phase function.
pub(super) const LAYERS: u32 = 2;
/// Largest number of lamps that light the air.
pub(super) const LAMPS: usize = 2;

/// Table of an observer's air with the sky beside or below it: an array texture with [`LAYERS`] layers for each lamp.
pub(super) struct Layered {
    texture: wgpu::Texture,
    /// View of all layers, for look-ups.
    pub whole: wgpu::TextureView,
    /// View of each layer, for passes to draw into.
    pub layers: Vec<wgpu::TextureView>,
}

impl Layered {
    pub fn new(device: &Device, settings: &SkySettings) -> Self {
        let texture = table_texture(device, "sky of an observer", settings.observer_size(), LAYERS * LAMPS as u32);
        let layer = |index| Layer { texture: &texture, index }.attached_view();
        let layers = (0..LAYERS * LAMPS as u32).map(layer).collect();
        let whole = as_layers(&texture);
        Self { texture, whole, layers }
    }

    /// Copies the layers of a lamp to the same layers of `copies`.
    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder, lamp: usize, copies: &Apart) {
        let size = wgpu::Extent3d { depth_or_array_layers: 1, ..self.texture.size() };
        for z in LAYERS * lamp as u32..LAYERS * (lamp as u32 + 1) {
            let origin = wgpu::Origin3d { z, ..wgpu::Origin3d::ZERO };
            let source = wgpu::TexelCopyTextureInfo { origin, ..self.texture.as_image_copy() };
            encoder.copy_texture_to_texture(source, copies.layers[z as usize].texture().as_image_copy(), size);
        }
    }
}

/// Layers as in [`Layered`], but each in its own texture, for passes to read. On OpenGL, shaders read nothing through a
/// view of a single layer of an array.
pub(super) struct Apart {
    pub layers: Vec<wgpu::TextureView>,
}

impl Apart {
    pub fn new(device: &Device, settings: &SkySettings) -> Self {
        let layer = |_| table_texture(device, "fading sky of an observer", settings.observer_size(), 1);
        Self { layers: (0..LAYERS * LAMPS as u32).map(layer).map(|t| t.create_view(&Default::default())).collect() }
    }
}
