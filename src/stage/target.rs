//! Checks of the images that a host hands over (colour, depth, mask, classes, normals), and how shaders read them.

use super::{
    frame::{ColorSpace, Frame},
    stages::Stages,
    uniform::is_float,
};
use crate::{
    error::{Error, Result},
    gpu::check_depth_format,
};

/// Checks that a colour texture has a supported format and can be drawn into.
///
/// # Errors
/// [`crate::Status::Unsupported`] naming the format, [`crate::Status::InvalidArgument`] naming the usage.
pub(crate) fn check_color(texture: &wgpu::Texture) -> Result<()> {
    use wgpu::TextureFormat as F;
    let format = texture.format();
    if !matches!(
        format,
        F::Rgba8Unorm
            | F::Rgba8UnormSrgb
            | F::Bgra8Unorm
            | F::Bgra8UnormSrgb
            | F::Rgba16Float
            | F::Rgba32Float
            | F::Rgb10a2Unorm
            | F::Rg11b10Ufloat
    ) {
        return Err(Error::unsupported(format!(
            "{format:?}; supported: Rgba8Unorm, Bgra8Unorm (both with or without Srgb), Rgb10a2Unorm, Rg11b10Ufloat, \
             Rgba16Float, Rgba32Float"
        ))
        .within("color.format"));
    }
    check_usage("color", texture, wgpu::TextureUsages::RENDER_ATTACHMENT)
}

/// Whether wgpu can copy `color`. If not, the OpenGL host's binding ([`crate::gpu::HostBinding`]) copies it between
/// submissions.
pub(crate) fn can_copy(color: &wgpu::Texture) -> bool {
    color.usage().contains(wgpu::TextureUsages::COPY_SRC)
}

/// Checks that a depth texture can be read and matches the colour target.
///
/// # Errors
/// [`crate::Status::Unsupported`] naming the format, [`crate::Status::InvalidArgument`] naming size, samples or usage.
pub(crate) fn check_depth(texture: &wgpu::Texture, color: &wgpu::Texture) -> Result<()> {
    check_depth_format(texture.format())?;
    if (texture.width(), texture.height()) != (color.width(), color.height()) {
        return Err(Error::range(
            "depth",
            &format!("as large as color, {} x {}", color.width(), color.height()),
            format!("{} x {}", texture.width(), texture.height()),
        ));
    }
    if texture.sample_count() != color.sample_count() && color.sample_count() > 1 {
        return Err(Error::range(
            "depth.samples",
            &format!("those of color, {}, or color resolved to one sample", color.sample_count()),
            texture.sample_count(),
        ));
    }
    check_usage("depth", texture, wgpu::TextureUsages::TEXTURE_BINDING)
}

/// Checks that a depth texture can be attached beside the colour target and written. [`check_depth`] checks its size.
///
/// # Errors
/// [`crate::Status::Unsupported`] naming the format, [`crate::Status::InvalidArgument`] naming samples or usage.
pub(crate) fn check_written(depth: &wgpu::Texture, color: &wgpu::Texture) -> Result<()> {
    let format = depth.format();
    if !format.has_depth_aspect() {
        let rest = "which cannot be written as depth_access asks; Depth16Unorm, Depth24Plus(Stencil8) and \
                    Depth32Float(Stencil8) can, or let depth_access be read only";
        return Err(Error::unsupported(format!("{format:?}, {rest}")).within("depth.format"));
    }
    if depth.sample_count() != color.sample_count() {
        let accepted = format!("those of color, {}, where depth_access writes it", color.sample_count());
        return Err(Error::range("depth.samples", &accepted, depth.sample_count()));
    }
    check_usage("depth", depth, wgpu::TextureUsages::RENDER_ATTACHMENT)
}

/// Checks the optional mask (red channel: 0 draws weather, 1 leaves the host's pixel).
///
/// # Errors
/// The errors of [`check_depth`].
pub(crate) fn check_mask(texture: &wgpu::Texture, color: &wgpu::Texture) -> Result<()> {
    use wgpu::TextureFormat as F;
    let format = texture.format();
    if !matches!(format, F::R8Unorm | F::Rgba8Unorm | F::Rgba8UnormSrgb | F::Bgra8Unorm) {
        return Err(Error::unsupported(format!(
            "{format:?}; supported: R8Unorm, Rgba8Unorm (with or without Srgb), Bgra8Unorm"
        ))
        .within("mask.format"));
    }
    check_of_one_sample("mask", texture, color)
}

/// Checks the optional surface classes of the pixels.
///
/// # Errors
/// The errors of [`check_depth`].
pub(crate) fn check_classes(texture: &wgpu::Texture, color: &wgpu::Texture) -> Result<()> {
    use wgpu::TextureFormat as F;
    if !matches!(texture.format(), F::R8Unorm | F::Rgba8Unorm | F::Bgra8Unorm) {
        return Err(Error::unsupported(format!("{:?}; supported: R8Unorm, Rgba8Unorm, Bgra8Unorm", texture.format()))
            .within("surface_classes.format"));
    }
    check_of_one_sample("surface_classes", texture, color)
}

/// Checks the optional normals of the pixels.
///
/// # Errors
/// The errors of [`check_depth`].
pub(crate) fn check_normals(texture: &wgpu::Texture, color: &wgpu::Texture) -> Result<()> {
    use wgpu::TextureFormat as F;
    let format = texture.format();
    if !matches!(format, F::Rgba8Unorm | F::Bgra8Unorm | F::Rgb10a2Unorm | F::Rgba16Float | F::Rgba32Float) {
        return Err(Error::unsupported(format!(
            "{format:?}; supported: Rgba8Unorm, Bgra8Unorm, Rgb10a2Unorm, Rgba16Float, Rgba32Float"
        ))
        .within("normals.format"));
    }
    check_of_one_sample("normals", texture, color)
}

/// Checks that a texture that is read together with `color` has the size of `color`, one sample, and the usage for
/// being read.
fn check_of_one_sample(name: &str, texture: &wgpu::Texture, color: &wgpu::Texture) -> Result<()> {
    if (texture.width(), texture.height(), texture.sample_count()) != (color.width(), color.height(), 1) {
        return Err(Error::range(
            name,
            &format!("as large as color, {} x {}, one sample", color.width(), color.height()),
            format!("{} x {}, {} samples", texture.width(), texture.height(), texture.sample_count()),
        ));
    }
    check_usage(name, texture, wgpu::TextureUsages::TEXTURE_BINDING)
}

/// Creates a texture with the size, format and samples of the host's colour, to read while the host's is written.
pub(crate) fn color_copy(device: &wgpu::Device, color: &wgpu::Texture) -> wgpu::Texture {
    let mut usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    if color.sample_count() > 1 {
        usage |= wgpu::TextureUsages::RENDER_ATTACHMENT;
    }
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("color copy"),
        size: wgpu::Extent3d { depth_or_array_layers: 1, ..color.size() },
        mip_level_count: 1,
        sample_count: color.sample_count(),
        dimension: wgpu::TextureDimension::D2,
        format: color.format(),
        usage,
        view_formats: &[],
    })
}

/// Whether `copy` can serve as the [`color_copy`] of `color`.
pub(crate) fn is_copy_of(copy: &wgpu::Texture, color: &wgpu::Texture) -> bool {
    copy.usage().contains(wgpu::TextureUsages::COPY_DST)
        && (copy.width(), copy.height()) == (color.width(), color.height())
        && copy.format() == color.format()
        && copy.sample_count() == color.sample_count()
}

fn check_usage(name: &str, texture: &wgpu::Texture, needed: wgpu::TextureUsages) -> Result<()> {
    if texture.usage().contains(needed) {
        return Ok(());
    }
    Err(Error::range(&format!("{name}.usage"), &format!("one with {needed:?}"), format!("{:?}", texture.usage())))
}

/// Number of samples per pixel in colour and in depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Sampling {
    /// One sample in both.
    Single,
    /// Several samples; each is drawn with its own depth.
    Multi,
    /// One sample in colour, as after a resolve, and several in depth, of which the first is used.
    Resolved,
}

impl Sampling {
    /// All variants; the index of each is its value as a number.
    pub const ALL: [Self; 3] = [Self::Single, Self::Multi, Self::Resolved];

    /// Returns the sampling of a frame's images.
    pub fn of(color: &wgpu::Texture, depth: Option<&wgpu::Texture>) -> Self {
        match (color.sample_count() > 1, depth.is_some_and(|d| d.sample_count() > 1)) {
            (true, _) => Self::Multi,
            (false, true) => Self::Resolved,
            (false, false) => Self::Single,
        }
    }

    /// Whether colour is multisampled, and whether depth is.
    pub fn multisampled(self) -> [bool; 2] {
        [self == Self::Multi, self != Self::Single]
    }

    /// Shader and entry point of the composition, then those of the gauge.
    pub fn shaders(self) -> [(&'static str, &'static str); 2] {
        match self {
            Self::Single => [("frame/composite_view.wgsl", "composite"), ("plan/gauge_view.wgsl", "gauge")],
            Self::Multi => {
                [("frame/composite_samples.wgsl:multi", "composite_samples"), ("plan/gauge_view.wgsl:multi", "gauge")]
            }
            Self::Resolved => {
                [("frame/composite_view.wgsl:resolved", "composite"), ("plan/gauge_view.wgsl:resolved", "gauge")]
            }
        }
    }

    /// Shader of the diagnostic pictures; its entry point is `diagnose`.
    pub fn diagnostic(self) -> &'static str {
        match self {
            Self::Single => "frame/diagnostic.wgsl",
            Self::Multi => "frame/diagnostic.wgsl:multi",
            Self::Resolved => "frame/diagnostic.wgsl:resolved",
        }
    }

    /// Shader of the wind picture; its entry point is `wind`.
    pub fn wind_picture(self) -> &'static str {
        match self {
            Self::Single => "frame/wind_picture.wgsl",
            Self::Multi => "frame/wind_picture.wgsl:multi",
            Self::Resolved => "frame/wind_picture.wgsl:resolved",
        }
    }

    /// Shader that sorts pixels by kind, for pictures with one colour sample.
    pub fn kinds(self) -> &'static str {
        if self == Self::Single { "frame/kinds.wgsl" } else { "frame/kinds.wgsl:resolved" }
    }
}

/// Whether stages drawn one by one give the same picture as all of them in one draw. They do not with TONE on a
/// scene-linear colour whose format is no float: between the draws, the scene-linear picture would be rounded to the
/// steps of that format.
pub(crate) fn can_be_apart(frame: &Frame<'_>, stages: Stages) -> bool {
    let tone = stages.has(Stages::TONE) && frame.color_space == ColorSpace::SceneLinear;
    !tone || frame.color.is_some_and(|c| is_float(c.format()))
}

/// Rounding of a depth format: absolute, and relative to the value. The rasteriser's own rounding is taken as two steps
/// of an `f32`.
pub(crate) fn rounding(depth: &wgpu::Texture) -> [f64; 2] {
    use wgpu::TextureFormat as F;
    let float = 2f64.powi(-22);
    match depth.format() {
        F::Depth16Unorm => [1.0 / 65_535.0, float],
        F::Depth24Plus | F::Depth24PlusStencil8 => [1.0 / 16_777_215.0, float],
        _ => [0.0, float],
    }
}
