//! State of a view's rehearsal, and the images that it draws into.

use crate::{stage::Frame, weather::Conditions};

/// Largest side of the rehearsed pictures, pixels. Smaller pictures have no coarse grid, so its pipelines would not be
/// compiled.
const SIDE: u32 = 64;
/// State of a view's rehearsal.
#[derive(Default)]
pub(super) struct RehearsedView {
    /// Whether the view draws into its own images now.
    pub is_on: bool,
    /// Number of frames drawn so far.
    pub frames: u64,
    /// Weathers that are rehearsed, and the number of moments drawn.
    pub weathers: Vec<Conditions>,
    pub done: usize,
    /// Images in place of the host's: colour, depth, mask, surface classes, normals.
    images: [Option<wgpu::Texture>; 5],
}

impl RehearsedView {
    /// Creates the images in place of those of `frame`, with their formats, numbers of samples and usages. Images that
    /// already have these are kept.
    pub fn hold(&mut self, device: &wgpu::Device, frame: &Frame<'_>) {
        let given = [frame.color, frame.depth, frame.mask, frame.surface_classes, frame.normals];
        for (own, given) in self.images.iter_mut().zip(given) {
            let fits = |own: &wgpu::Texture, given: &wgpu::Texture| {
                (own.format(), own.sample_count(), own.usage()) == (given.format(), given.sample_count(), given.usage())
            };
            let holds = match (&own, given) {
                (Some(own), Some(given)) => fits(own, given),
                (None, None) => true,
                _ => false,
            };
            if !holds {
                *own = given.map(|given| {
                    device.create_texture(&wgpu::TextureDescriptor {
                        label: Some("rehearsal"),
                        size: wgpu::Extent3d {
                            width: given.width().min(SIDE),
                            height: given.height().min(SIDE),
                            depth_or_array_layers: 1,
                        },
                        mip_level_count: 1,
                        sample_count: given.sample_count(),
                        dimension: wgpu::TextureDimension::D2,
                        format: given.format(),
                        usage: given.usage(),
                        view_formats: &[],
                    })
                });
            }
        }
    }

    /// Returns the images and the frame number that replace the host's.
    pub fn images(&self) -> ([Option<wgpu::Texture>; 5], u64) {
        (self.images.clone(), u64::MAX / 2 + self.frames)
    }
}
