//! A host's `VkImage` as a texture: what formats, sample counts, usages and layouts are served, and the cache.

use ash::vk;
use wgpu::hal::vulkan::Api as Vulkan;
use wgpu::{TextureFormat, TextureUses};

use super::VulkanHost;
use super::layouts;
use crate::error::{Error, Result, Status};

/// Features that let wgpu use the formats and sample counts that the host's images may have; none of them needs
/// anything switched on in Vulkan.
pub(super) const FORMAT_FEATURES: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES)
    .union(wgpu::Features::DEPTH32FLOAT_STENCIL8)
    .union(wgpu::Features::RG11B10UFLOAT_RENDERABLE);

/// Imports kept at once; a host with more images than this pays for a new import now and then.
const MAX_IMPORTS: usize = 64;

/// Use that Welkin makes of a host's image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageRole {
    /// Drawn into, and copied to be read: needs `VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT` and `TRANSFER_SRC_BIT`, and with
    /// several samples `sampleRateShading` enabled.
    Colour,
    /// Depth that is read: needs `VK_IMAGE_USAGE_SAMPLED_BIT`.
    Depth,
    /// Colour data that is read (mask, normals, motion): needs `VK_IMAGE_USAGE_SAMPLED_BIT`.
    Sampled,
}

/// A host's 2-D image, handed over for one submission. It stays the host's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostImage {
    /// The image; it belongs to the queue's family (or is shared concurrently) and has one mip level in use.
    pub image: vk::Image,
    /// Format that the image was created with.
    pub format: vk::Format,
    /// Width of the image, pixels.
    pub width: u32,
    /// Height of the image, pixels.
    pub height: u32,
    /// Samples a pixel: 1, 2, 4 or 8.
    pub samples: u32,
    /// Usage that the image was created with.
    pub usage: vk::ImageUsageFlags,
    /// Array layers of the image; 1 for a plain one.
    pub array_layers: u32,
    /// Layer that is handed over, from 0.
    pub layer: u32,
    /// Layout that the host left it in. `UNDEFINED` (colour only) says that its content may be dropped.
    pub layout: vk::ImageLayout,
    /// Layout that the host wants it back in.
    pub final_layout: vk::ImageLayout,
}

impl HostImage {
    /// Whether two descriptions mean the same Vulkan image, whatever layer and layouts they speak of.
    fn same_image(&self, other: &Self) -> bool {
        let rest =
            Self { layer: 0, layout: vk::ImageLayout::UNDEFINED, final_layout: vk::ImageLayout::UNDEFINED, ..*self };
        let other = Self { layer: 0, layout: rest.layout, final_layout: rest.final_layout, ..*other };
        rest == other
    }

    /// Refuses depth that was not created to be written, in a message about the parameter `name`.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the usage.
    pub fn check_written(&self, name: &str) -> Result<()> {
        let needed = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        if self.usage.contains(needed) {
            return Ok(());
        }
        let bits = layouts::usage_names(needed, " and ");
        let rest = format!("lacks {bits}, with which the image must be created where depth_access writes it");
        Err(Error::invalid(format!("{name}.usage"), rest))
    }

    /// The aspects that a layout change must name.
    pub(super) fn aspects(&self) -> vk::ImageAspectFlags {
        match wgpu_format(self.format) {
            Some(f) if f.has_stencil_aspect() => vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL,
            Some(f) if f.has_depth_aspect() => vk::ImageAspectFlags::DEPTH,
            _ => vk::ImageAspectFlags::COLOR,
        }
    }
}

/// The wgpu format whose Vulkan counterpart is `format`; `None` where Welkin does not serve it.
fn wgpu_format(format: vk::Format) -> Option<TextureFormat> {
    Some(match format {
        vk::Format::R8_UNORM => TextureFormat::R8Unorm,
        vk::Format::R8_UINT => TextureFormat::R8Uint,
        vk::Format::R16_UINT => TextureFormat::R16Uint,
        vk::Format::R32_UINT => TextureFormat::R32Uint,
        vk::Format::R16_SFLOAT => TextureFormat::R16Float,
        vk::Format::R32_SFLOAT => TextureFormat::R32Float,
        vk::Format::R8G8_UNORM => TextureFormat::Rg8Unorm,
        vk::Format::R16G16_SFLOAT => TextureFormat::Rg16Float,
        vk::Format::R32G32_SFLOAT => TextureFormat::Rg32Float,
        vk::Format::R8G8B8A8_UNORM => TextureFormat::Rgba8Unorm,
        vk::Format::R8G8B8A8_SRGB => TextureFormat::Rgba8UnormSrgb,
        vk::Format::B8G8R8A8_UNORM => TextureFormat::Bgra8Unorm,
        vk::Format::B8G8R8A8_SRGB => TextureFormat::Bgra8UnormSrgb,
        vk::Format::A2B10G10R10_UNORM_PACK32 => TextureFormat::Rgb10a2Unorm,
        vk::Format::B10G11R11_UFLOAT_PACK32 => TextureFormat::Rg11b10Ufloat,
        vk::Format::R16G16B16A16_SFLOAT => TextureFormat::Rgba16Float,
        vk::Format::R32G32B32A32_SFLOAT => TextureFormat::Rgba32Float,
        vk::Format::D16_UNORM => TextureFormat::Depth16Unorm,
        vk::Format::X8_D24_UNORM_PACK32 => TextureFormat::Depth24Plus,
        vk::Format::D24_UNORM_S8_UINT => TextureFormat::Depth24PlusStencil8,
        vk::Format::D32_SFLOAT => TextureFormat::Depth32Float,
        vk::Format::D32_SFLOAT_S8_UINT => TextureFormat::Depth32FloatStencil8,
        _ => return None,
    })
}

/// The state in which wgpu finds and leaves an imported image between submissions.
pub(super) fn home_state(role: ImageRole) -> TextureUses {
    match role {
        ImageRole::Colour => TextureUses::COLOR_TARGET,
        ImageRole::Depth | ImageRole::Sampled => TextureUses::RESOURCE,
    }
}

/// The Vulkan layout behind [`home_state`], as wgpu's Vulkan backend maps it.
pub(super) fn home_layout(role: ImageRole) -> vk::ImageLayout {
    match role {
        ImageRole::Colour => vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        ImageRole::Depth => vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        ImageRole::Sampled => vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    }
}

struct Import {
    image: HostImage,
    role: ImageRole,
    texture: wgpu::Texture,
}

/// The imports in use, the most recent last.
#[derive(Default)]
pub(super) struct Imports(Vec<Import>);

impl Imports {
    /// The texture of an image imported in `role`, which becomes the most recent.
    fn find(&mut self, image: &HostImage, role: ImageRole) -> Option<wgpu::Texture> {
        let at = self.0.iter().position(|i| i.role == role && i.image.same_image(image))?;
        self.0[at..].rotate_left(1);
        self.0.last().map(|i| i.texture.clone())
    }

    /// Keeps an import, and returns the oldest if there are too many.
    fn keep(&mut self, import: Import) -> Option<Import> {
        let oldest = (self.0.len() >= MAX_IMPORTS).then(|| self.0.remove(0));
        self.0.push(import);
        oldest
    }
}

impl VulkanHost {
    /// The texture over a host's image. Asking again for the same image gives the same texture.
    ///
    /// `name` is the parameter's name in messages. The texture may be drawn to or read only between this call
    /// and [`VulkanHost::submit`] of the same image. When the host has destroyed the image, or
    /// before, it calls [`VulkanHost::forget_image`].
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] names the field of `image` that does not fit; [`Status::Unsupported`] names a
    /// format or sample count that this device or Welkin does not serve.
    ///
    /// # Safety
    /// `image` describes a live image of the host's device truly.
    pub unsafe fn import(&self, name: &str, image: &HostImage, role: ImageRole) -> Result<wgpu::Texture> {
        let format = self.check_image(name, image, role)?;
        let mut images = self.images.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(texture) = images.find(image, role) {
            return Ok(texture);
        }
        // SAFETY: the caller vouches for the image, and the description was checked.
        let texture = unsafe { self.wrap(image, role, format)? };
        let oldest = images.keep(Import { image: *image, role, texture: texture.clone() });
        drop(images);
        if let Some(oldest) = oldest {
            oldest.texture.destroy();
        }
        Ok(texture)
    }

    /// Waits until the GPU no longer uses `image` and forgets it. To be called before or after the host destroys an
    /// image that it handed over, but before it hands over another: Vulkan may give a new image the old one's handle.
    /// What is left to do is destroying views, for which the image need not live. Not a frame's call.
    ///
    /// # Errors
    /// [`Status::DeviceLost`].
    pub fn forget_image(&self, image: vk::Image) -> Result<()> {
        let mut images = self.images.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        images.0.retain(|i| {
            let keep = i.image.image != image;
            if !keep {
                i.texture.destroy();
            }
            keep
        });
        drop(images);
        let mut brackets = self.brackets.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let waited = self.device.wait();
        // SAFETY: the queue's work was waited for (a lost device has none), with the brackets held.
        unsafe { brackets.free(&self.raw, |lent| lent.iter().any(|(i, _)| i.image == image)) };
        waited
    }

    /// Makes the texture over an image whose description was checked.
    ///
    /// # Safety
    /// `image` describes a live image of the host's device truly.
    unsafe fn wrap(&self, image: &HostImage, role: ImageRole, format: TextureFormat) -> Result<wgpu::Texture> {
        let size =
            wgpu::Extent3d { width: image.width, height: image.height, depth_or_array_layers: image.array_layers };
        let (usage, uses) = usages(image.usage, format.is_depth_stencil_format());
        let hal_desc = wgpu::hal::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: image.samples,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: uses,
            memory_flags: wgpu::hal::MemoryFlags::empty(),
            view_formats: Vec::new(),
        };
        let desc = wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: image.samples,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        };
        let lost = || Error::new(Status::DeviceLost, "the device is lost: destroy it and create a new one");
        // SAFETY: the device is on Vulkan; memory is external and there is a drop callback, so that wgpu destroys
        // neither image nor memory; the state given is the one that `submit` brings the image into first.
        unsafe {
            let hal = self.device.device.as_hal::<Vulkan>().ok_or_else(lost)?;
            let memory = wgpu::hal::vulkan::TextureMemory::External;
            let texture = hal.texture_from_raw(image.image, &hal_desc, Some(Box::new(|| {})), memory);
            Ok(self.device.device.create_texture_from_hal::<Vulkan>(texture, &desc, home_state(role)))
        }
    }

    /// Checks a description and gives its wgpu format.
    fn check_image(&self, name: &str, image: &HostImage, role: ImageRole) -> Result<TextureFormat> {
        let bad = |field: &str, accepted: &str, got: &dyn std::fmt::Display| {
            Err(Error::range(&format!("{name}.{field}"), accepted, got))
        };
        if image.image == vk::Image::null() {
            return bad("image", "a live VkImage", &"VK_NULL_HANDLE");
        }
        let max = self.device.caps().max_texture_size;
        for (field, value) in [("width", image.width), ("height", image.height)] {
            if !(1..=max).contains(&value) {
                return bad(field, &format!("in [1, {max}] pixels"), &value);
            }
        }
        if image.array_layers == 0 || image.array_layers > 2048 {
            return bad("array_layers", "in [1, 2048]", &image.array_layers);
        }
        if image.layer >= image.array_layers {
            return bad("layer", &format!("below array_layers ({})", image.array_layers), &image.layer);
        }
        let Some(format) = wgpu_format(image.format) else {
            let what = format!("Welkin does not serve {:?}", image.format);
            return Err(Error::unsupported(what).within(&format!("{name}.format")));
        };
        if format.is_depth_stencil_format() != (role == ImageRole::Depth) {
            let accepted = if role == ImageRole::Depth { "a depth format" } else { "a colour format" };
            return bad("format", accepted, &format_args!("{:?}", image.format));
        }
        if ![1, 2, 4, 8].contains(&image.samples) {
            return bad("samples", "1, 2, 4 or 8", &image.samples);
        }
        self.check_format(name, image, format, role)?;
        Error::all(self.lacks(name, image, role)).map(|()| format)
    }

    /// All that the host has to enable, list or create otherwise before it hands over an image that this device can
    /// hold.
    fn lacks(&self, name: &str, image: &HostImage, role: ImageRole) -> Vec<Error> {
        let field = |name_of_field: &str| format!("{name}.{name_of_field}");
        let mut lacks = Vec::new();
        if role == ImageRole::Colour && image.samples > 1 && self.record.enabled.core.sample_rate_shading == vk::FALSE {
            let feature = layouts::feature_text("VkPhysicalDeviceFeatures::sampleRateShading");
            lacks.push(Error::invalid(field("samples"), format!("above 1 needs {feature}, or resolve first")));
        }
        let needed = if role == ImageRole::Colour {
            vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC
        } else {
            vk::ImageUsageFlags::SAMPLED
        };
        if !image.usage.contains(needed) {
            let bits = layouts::usage_names(needed & !image.usage, " and ");
            let rest = format!("lacks {bits}, with which the image must be created");
            lacks.push(Error::invalid(field("usage"), rest));
        }
        let presents = self.record.extensions.contains(&ash::khr::swapchain::NAME);
        for (which, layout) in [("layout", image.layout), ("final_layout", image.final_layout)] {
            let dropped = which == "layout" && layout == vk::ImageLayout::UNDEFINED && role == ImageRole::Colour;
            let obstacle = layouts::obstacle(layout, image, &self.record.enabled, presents).filter(|_| !dropped);
            if let Some(o) = obstacle {
                let rest = format!("must not be {}, which {o}", layouts::layout_name(layout));
                lacks.push(Error::invalid(field(which), rest));
            }
        }
        lacks
    }

    /// Whether this device serves the format for the role and sample count.
    fn check_format(&self, name: &str, image: &HostImage, format: TextureFormat, role: ImageRole) -> Result<()> {
        let raw = image.format;
        let unsupported = |what: String| Err(Error::unsupported(what).within(&format!("{name}.format")));
        if !self.device.device.features().contains(format.required_features()) {
            return unsupported(format!("this device does not serve {raw:?}"));
        }
        // SAFETY: the adapter is only asked.
        let mapped = unsafe { self.device.adapter.as_hal::<Vulkan>() }.map(|a| a.texture_format_as_raw(format));
        if mapped != Some(raw) {
            return unsupported(format!("this device holds {format:?} as {mapped:?}, not as {raw:?}"));
        }
        let features = self.device.adapter.get_texture_format_features(format);
        let usage = if role == ImageRole::Colour {
            wgpu::TextureUsages::RENDER_ATTACHMENT
        } else {
            wgpu::TextureUsages::TEXTURE_BINDING
        };
        if !features.allowed_usages.contains(usage) {
            return unsupported(format!("this device does not allow {usage:?} of {raw:?}"));
        }
        if !features.flags.sample_count_supported(image.samples) {
            let what = format!("this device does not serve {} samples of {raw:?}", image.samples);
            return Err(Error::unsupported(what).within(&format!("{name}.samples")));
        }
        Ok(())
    }
}

/// The host's usage in wgpu's words.
fn usages(usage: vk::ImageUsageFlags, depth: bool) -> (wgpu::TextureUsages, TextureUses) {
    use vk::ImageUsageFlags as U;
    let attached = if depth {
        TextureUses::DEPTH_STENCIL_READ | TextureUses::DEPTH_STENCIL_WRITE
    } else {
        TextureUses::COLOR_TARGET
    };
    let table = [
        (U::TRANSFER_SRC, wgpu::TextureUsages::COPY_SRC, TextureUses::COPY_SRC),
        (U::TRANSFER_DST, wgpu::TextureUsages::COPY_DST, TextureUses::COPY_DST),
        (U::SAMPLED, wgpu::TextureUsages::TEXTURE_BINDING, TextureUses::RESOURCE),
        (U::COLOR_ATTACHMENT | U::DEPTH_STENCIL_ATTACHMENT, wgpu::TextureUsages::RENDER_ATTACHMENT, attached),
    ];
    let mut both = (wgpu::TextureUsages::empty(), TextureUses::empty());
    for (theirs, public, inner) in table {
        if usage.intersects(theirs) {
            both.0 |= public;
            both.1 |= inner;
        }
    }
    both
}

#[cfg(test)]
mod tests {
    use super::{super::layouts::tests::image, *};

    #[test]
    fn one_image_is_one_import_whatever_its_layouts() {
        let a = image(vk::Format::R8G8B8A8_UNORM, vk::ImageUsageFlags::COLOR_ATTACHMENT);
        let b = HostImage { layout: vk::ImageLayout::UNDEFINED, ..a };
        assert!(a.same_image(&b));
        assert!(!a.same_image(&HostImage { width: 5, ..a }));
        assert!(!a.same_image(&HostImage { samples: 4, ..a }));
    }
}
