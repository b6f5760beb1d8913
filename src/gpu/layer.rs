//! One layer of a host's image: what a frame draws into and reads.

use crate::error::{Error, Result};

/// One layer of a texture; a plain texture has layer 0 alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layer<'a> {
    /// The texture.
    pub texture: &'a wgpu::Texture,
    /// Index of the layer in it.
    pub index: u32,
}

/// A layer kept beyond the frame, to compare the next one with.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KeptLayer(wgpu::Texture, u32);

impl Layer<'_> {
    /// A view of the layer alone, and of depth alone where the format has stencil too.
    pub fn view(self) -> wgpu::TextureView {
        let depth = self.texture.format().has_depth_aspect();
        self.texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            aspect: if depth { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All },
            base_array_layer: self.index,
            array_layer_count: Some(1),
            ..Default::default()
        })
    }

    /// A view of the layer alone to draw into, with all that its format holds. It cannot be read from: OpenGL finds
    /// nothing in a single layer of several.
    pub fn attached_view(self) -> wgpu::TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor {
            usage: Some(wgpu::TextureUsages::RENDER_ATTACHMENT),
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: self.index,
            array_layer_count: Some(1),
            ..Default::default()
        })
    }

    /// Whether it has several samples a pixel.
    pub fn is_multisampled(self) -> bool {
        self.texture.sample_count() > 1
    }

    /// Copies it to `destination`, a plain texture of its size.
    pub fn copy(self, encoder: &mut wgpu::CommandEncoder, destination: &wgpu::Texture) {
        let mut from = self.texture.as_image_copy();
        from.origin.z = self.index;
        encoder.copy_texture_to_texture(from, destination.as_image_copy(), destination.size());
    }

    /// To compare a later frame's with.
    pub fn kept(self) -> KeptLayer {
        KeptLayer(self.texture.clone(), self.index)
    }
}

impl PartialEq<KeptLayer> for Layer<'_> {
    fn eq(&self, kept: &KeptLayer) -> bool {
        *self.texture == kept.0 && self.index == kept.1
    }
}

/// The view of the layer that was drawn into last. A window's image is let go as soon as it is recorded
/// (`View::let_go_of_window`): some systems change a window's size only when nobody holds its images.
#[derive(Default)]
pub(crate) struct KeptView(Option<(KeptLayer, wgpu::TextureView)>);

impl KeptView {
    /// The view of `layer`, which `make` makes where another was drawn into last.
    pub fn of<'a>(
        &mut self,
        layer: Layer<'a>,
        make: impl FnOnce(Layer<'a>) -> wgpu::TextureView,
    ) -> &wgpu::TextureView {
        if self.0.as_ref().is_some_and(|(kept, _)| layer != *kept) {
            self.0 = None;
        }
        &self.0.get_or_insert_with(|| (layer.kept(), make(layer))).1
    }
}

/// Whether an image of this frame, or none, is the one kept.
pub(crate) fn is_kept(layer: Option<Layer<'_>>, kept: Option<&KeptLayer>) -> bool {
    match (layer, kept) {
        (Some(layer), Some(kept)) => layer == *kept,
        (None, None) => true,
        _ => false,
    }
}

/// Refuses a format whose depth shaders cannot read.
///
/// # Errors
/// [`crate::Status::Unsupported`] naming those that they can.
pub(crate) fn check_depth_format(format: wgpu::TextureFormat) -> Result<()> {
    use wgpu::TextureFormat as F;
    if !matches!(
        format,
        F::Depth16Unorm
            | F::Depth24Plus
            | F::Depth24PlusStencil8
            | F::Depth32Float
            | F::Depth32FloatStencil8
            | F::R32Float
    ) {
        return Err(Error::unsupported(format!(
            "{format:?}; supported: Depth16Unorm, Depth24Plus(Stencil8), Depth32Float(Stencil8), R32Float"
        ))
        .within("depth.format"));
    }
    Ok(())
}
