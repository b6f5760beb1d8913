//! A picture's clouds from frame to frame: the pixels that a frame marches, and the whole picture that is made of them
//! and of the last.

use crate::gpu::{Device, Layer, bind, flat_texture};

/// Format of what is seen of clouds.
pub(crate) const SEEN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Format of two numbers of a place in the picture.
pub(crate) const PAIR: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;
/// Format of the depth that tells apart the pixels on which the host drew.
pub(crate) const KINDS: wgpu::TextureFormat = wgpu::TextureFormat::Depth16Unorm;
/// Layers of the whole picture: what is seen of clouds and how far they reach, and what else stands behind the sky's
/// own light. Below the picture there is room for the clouds of all directions.
pub(crate) const LAYERS: u32 = 3;
/// The last of them.
pub(crate) const BEHIND: u32 = 2;

/// Texels along a side of the map of clouds in all directions: 1.5 degrees each, as a mirror of still water shows
/// broken clouds.
pub(crate) const PANORAMA_SIDE: u32 = 96;

/// Whether shadows may have a draw of their own: a software driver would work them out for the sky too, since it takes
/// both ways of a branch.
fn shades_apart(device: &Device) -> bool {
    let can = wgpu::DownlevelFlags::INDEPENDENT_BLEND;
    device.caps().software && device.adapter.get_downlevel_capabilities().flags.contains(can)
}

fn texture(device: &Device, (width, height): (u32, u32), format: wgpu::TextureFormat, layers: u32) -> wgpu::Texture {
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("clouds"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Texels of the whole picture with the clouds of all directions below it.
fn with_round((width, height): (u32, u32)) -> (u32, u32) {
    (width.max(PANORAMA_SIDE), height + PANORAMA_SIDE)
}

/// The whole picture as one frame left it.
pub(crate) struct Whole {
    pub texture: wgpu::Texture,
    /// All layers, as the composition reads them.
    pub layers: wgpu::TextureView,
    /// Layers to draw into: what is seen, and the reach.
    pub written: [wgpu::TextureView; 2],
}

impl Whole {
    fn new(device: &Device, size: (u32, u32)) -> Self {
        let texture = texture(device, with_round(size), SEEN, LAYERS);
        let layers = bind::as_layers(&texture);
        let written = [0, 1].map(|index| Layer { texture: &texture, index }.attached_view());
        Self { texture, layers, written }
    }
}

/// A picture's textures.
pub(crate) struct Picture {
    /// Pixels, and the side of the squares of which one is marched a frame.
    pub of: ((u32, u32), u32),
    /// Clouds that this frame's pixels see, and how far these reach.
    pub marched: [wgpu::TextureView; 2],
    /// Least and most that is seen about each square, and where the square was in the last frame with how smooth it is.
    pub followed: [wgpu::TextureView; 3],
    pub whole: [Whole; 2],
    /// Depth that tells apart the pixels on which the host drew, where shadows have a draw of their own.
    pub kinds: Option<wgpu::TextureView>,
    /// Index in `whole` of the last frame that was drawn.
    pub newest: usize,
    /// Bind groups of the passes after the march.
    pub groups: Option<[wgpu::BindGroup; 3]>,
    /// As `marched`, of a first frame, which has none before it: of squares of [`BEGUN_SIDE`] on a side. With what the
    /// pass after it is bound to.
    pub begun: Option<([wgpu::TextureView; 2], wgpu::BindGroup)>,
}

/// Side of the squares of which a frame marches one pixel that begins a picture, at most.
pub(crate) const BEGUN_SIDE: u32 = 2;

/// Where marched pixels of a picture are kept.
pub(crate) fn marched(device: &Device, size: (u32, u32), side: u32) -> [wgpu::TextureView; 2] {
    let low = (size.0.div_ceil(side), size.1.div_ceil(side));
    [SEEN, PAIR].map(|format| texture(device, low, format, 1).create_view(&Default::default()))
}

impl Picture {
    pub fn new(device: &Device, size: (u32, u32), side: u32) -> Self {
        let low = (size.0.div_ceil(side), size.1.div_ceil(side));
        let one = |format| texture(device, low, format, 1).create_view(&Default::default());
        let kinds = shades_apart(device).then(|| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
            flat_texture(&device.device, "clouds", with_round(size), KINDS, usage).create_view(&Default::default())
        });
        Self {
            of: (size, side),
            marched: marched(device, size, side),
            followed: [one(SEEN), one(SEEN), one(SEEN)],
            whole: [Whole::new(device, size), Whole::new(device, size)],
            kinds,
            newest: 0,
            groups: None,
            begun: None,
        }
    }

    /// Returns the index in `whole` that the next draw makes: the newest once more where that is of the same frame.
    pub fn to_make(&self, is_begun: bool) -> usize {
        if is_begun { self.newest } else { 1 - self.newest }
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        let ((width, height), side) = self.of;
        let low = u64::from(width.div_ceil(side)) * u64::from(height.div_ceil(side));
        let whole = with_round((width, height));
        let begun = self.begun.as_ref().map_or(0, |_| u64::from(BEGUN_SIDE));
        let first = u64::from(width) * u64::from(height) * 12 / begun.max(1).pow(2) * begun.min(1);
        let kinds = self.kinds.as_ref().map_or(0, |_| 2);
        (2 * 8 * u64::from(LAYERS) + kinds) * u64::from(whole.0) * u64::from(whole.1) + (4 * 8 + 4) * low + first
    }
}
