//! Layer of a host's image that a frame draws into or reads.

use crate::error::{Error, Result};

/// One layer of a texture; a plain texture has only layer 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layer<'a> {
    /// Texture.
    pub texture: &'a wgpu::Texture,
    /// Index of the layer in it.
    pub index: u32,
}

/// Layer kept beyond the frame, to compare with that of a later frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KeptLayer(wgpu::Texture, u32);

impl Layer<'_> {
    /// Creates a view of this layer only. If the format has depth, the view leaves out stencil.
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

    /// Creates a view of this layer only, to draw into, with all aspects of its format. The view cannot be read: on
    /// OpenGL a single layer of several reads as empty.
    pub fn attached_view(self) -> wgpu::TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor {
            usage: Some(wgpu::TextureUsages::RENDER_ATTACHMENT),
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: self.index,
            array_layer_count: Some(1),
            ..Default::default()
        })
    }

    /// Whether the texture is multisampled.
    pub fn is_multisampled(self) -> bool {
        self.texture.sample_count() > 1
    }

    /// Copies the layer to `destination`, a plain texture of the same size.
    pub fn copy(self, encoder: &mut wgpu::CommandEncoder, destination: &wgpu::Texture) {
        let mut from = self.texture.as_image_copy();
        from.origin.z = self.index;
        encoder.copy_texture_to_texture(from, destination.as_image_copy(), destination.size());
    }

    /// Keeps the layer, to compare with that of a later frame.
    pub fn kept(self) -> KeptLayer {
        KeptLayer(self.texture.clone(), self.index)
    }
}

impl PartialEq<KeptLayer> for Layer<'_> {
    fn eq(&self, kept: &KeptLayer) -> bool {
        *self.texture == kept.0 && self.index == kept.1
    }
}

/// View of the layer that was last drawn into. A view of a window's image is dropped as soon as the frame is recorded
/// (`View::let_go_of_window`), because some systems resize a window only when nothing holds its images.
#[derive(Default)]
pub(crate) struct KeptView(Option<(KeptLayer, wgpu::TextureView)>);

impl KeptView {
    /// Returns the view of `layer`; `make` creates it if another layer was drawn into last.
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

/// Whether `layer`, of this frame, is the layer kept; two absent ones are equal.
pub(crate) fn is_kept(layer: Option<Layer<'_>>, kept: Option<&KeptLayer>) -> bool {
    match (layer, kept) {
        (Some(layer), Some(kept)) => layer == *kept,
        (None, None) => true,
        _ => false,
    }
}

/// Checks that shaders can read the depth of `format`.
///
/// # Errors
/// [`crate::Status::Unsupported`], which names the formats that shaders can read.
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
