//! Textures of a picture's clouds: the pixels that a frame marches, and the whole picture that is resolved from these
//! pixels and from the last whole picture.

use crate::gpu::{Device, Layer, bind, flat_texture};

/// Format of radiance and transmittance.
pub(crate) const SEEN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Format of the range of distances of the visible cloud in the marched pixels: log2 of the nearest and of the farthest
/// distance, m, each times 1 - transmittance.
pub(crate) const PAIR: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;
/// Format of the depth that marks the pixels on which the host drew.
pub(crate) const KINDS: wgpu::TextureFormat = wgpu::TextureFormat::Depth16Unorm;
/// Layers of the whole picture: radiance and transmittance of the clouds; range of distances of the visible cloud; and
/// the stars and glow behind the sky's own light. The panorama has its place in the rows below the picture.
pub(crate) const LAYERS: u32 = 3;
/// Index of the layer of stars and glow, which stand behind the sky's own light.
pub(crate) const BEHIND: u32 = 2;

/// Side of the panorama, texels. A texel of this octahedral map spans 1.2 to 2.4 degrees (2 / 96 to 4 / 96 rad), which
/// is fine enough for broken clouds in a mirror of still water.
pub(crate) const PANORAMA_SIDE: u32 = 96;

/// Whether shadows get their own draw: on a software driver that can mask each target separately. Such a driver
/// evaluates both sides of a branch, so in a single draw it would compute shadows for the sky too.
fn shades_apart(device: &Device) -> bool {
    let can = wgpu::DownlevelFlags::INDEPENDENT_BLEND;
    device.caps().software && device.adapter.get_downlevel_capabilities().flags.contains(can)
}

/// Creates a texture of `layers` layers, to be drawn into and read.
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

/// Returns the size of the whole picture with the panorama below it, texels.
fn with_round((width, height): (u32, u32)) -> (u32, u32) {
    (width.max(PANORAMA_SIDE), height + PANORAMA_SIDE)
}

/// Textures of a whole picture, as one frame leaves them.
pub(crate) struct Whole {
    /// Texture with all layers.
    pub texture: wgpu::Texture,
    /// All layers, as the composition reads them.
    pub layers: wgpu::TextureView,
    /// Layers to draw into: radiance and transmittance, and range of distances.
    pub written: [wgpu::TextureView; 2],
}

impl Whole {
    /// Creates the textures of a picture of `size` pixels.
    fn new(device: &Device, size: (u32, u32)) -> Self {
        let texture = texture(device, with_round(size), SEEN, LAYERS);
        let layers = bind::as_layers(&texture);
        let written = [0, 1].map(|index| Layer { texture: &texture, index }.attached_view());
        Self { texture, layers, written }
    }
}

/// Textures of a picture.
pub(crate) struct Picture {
    /// Size in pixels, and side of the squares in each of which a frame marches one pixel.
    pub of: ((u32, u32), u32),
    /// Radiance and transmittance of the marched pixels, and their range of distances.
    pub marched: [wgpu::TextureView; 2],
    /// Values for each square of pixels (`shaders/clouds/follow.wgsl`), one texture each: smallest radiance and
    /// transmittance of the squares around it; largest ones; offset to its position in the last picture, with the
    /// weight of the marched picture against the last one.
    pub followed: [wgpu::TextureView; 3],
    /// Whole pictures of this frame and of the last, which swap roles.
    pub whole: [Whole; 2],
    /// Depth that marks the pixels on which the host drew, if shadows have their own draw.
    pub kinds: Option<wgpu::TextureView>,
    /// Index in `whole` of the last frame.
    pub newest: usize,
    /// Bind groups of the passes after the march: of the reprojection, and of the resolving into each of `whole`.
    pub groups: Option<[wgpu::BindGroup; 3]>,
    /// Marched pixels of a picture's first frame, in place of `marched`, and the bind group that resolves from them.
    /// The squares of this frame have [`BEGUN_SIDE`] pixels on a side.
    pub begun: Option<([wgpu::TextureView; 2], wgpu::BindGroup)>,
}

/// Largest side of the squares in a first frame, pixels.
pub(crate) const BEGUN_SIDE: u32 = 2;

/// Creates the textures of the marched pixels.
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

    /// Returns the index in `whole` that the next draw writes. If an earlier call of the frame has written the newest
    /// picture (`is_begun`), the draw writes the newest again; otherwise it writes the older one.
    pub fn to_make(&self, is_begun: bool) -> usize {
        if is_begun { self.newest } else { 1 - self.newest }
    }

    /// Returns the bytes of GPU memory in use.
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
