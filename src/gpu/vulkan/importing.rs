//! Import of a host's `VkImage` as a texture: checks of its format, sample count, usage and layouts.

use ash::vk;
use wgpu::hal::vulkan::Api as Vulkan;
use wgpu::{TextureFormat, TextureUses};

use super::host::VulkanHost;
use super::image::{HostImage, ImageRole, home_state, wgpu_format};
use super::imports::Import;
use super::{layouts, names};
use crate::error::{Error, Result, Status};

impl VulkanHost {
    /// Returns the texture of a host's image. The same image in the same role gives the same texture as long as this
    /// import is among the 64 that were used last. The texture of an older import is destroyed.
    ///
    /// `name` is the parameter's name in messages. The texture may be drawn to or read only between this call and the
    /// [`VulkanHost::submit`] of the same image. The host must call [`VulkanHost::forget_image`] before or after it
    /// destroys the image.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`], which names the field of `image` that does not fit; [`Status::Unsupported`], which
    /// names a format or sample count that this device or Welkin does not support; [`Status::DeviceLost`].
    ///
    /// # Safety
    /// The description `image` must be true, of a live image of the host's device.
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

    /// Waits until the GPU no longer uses `image`, and forgets it. The host must call this function for every image
    /// that it handed over and destroys. The call may come before or after the destruction, but must come before the
    /// host hands over another image, because Vulkan may give a new image the old handle. A call after the destruction
    /// destroys only Welkin's views of the image, for which the image need not exist. Not for use in a frame.
    ///
    /// # Errors
    /// [`Status::DeviceLost`], or the first GPU fault.
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
        // SAFETY: the queue's work was waited for (a lost device has none), and the brackets are locked.
        unsafe { brackets.free(&self.raw, |lent| lent.iter().any(|(i, _)| i.image == image)) };
        waited
    }

    /// Creates the texture of an image whose description was checked.
    ///
    /// # Safety
    /// The description `image` must be true, of a live image of the host's device.
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
        // SAFETY: the device is on Vulkan. With external memory and a drop callback, wgpu destroys neither image nor
        // memory. The given state is the one into which `submit` first brings the image.
        unsafe {
            let hal = self.device.device.as_hal::<Vulkan>().ok_or_else(lost)?;
            let memory = wgpu::hal::vulkan::TextureMemory::External;
            let texture = hal.texture_from_raw(image.image, &hal_desc, Some(Box::new(|| {})), memory);
            Ok(self.device.device.create_texture_from_hal::<Vulkan>(texture, &desc, home_state(role)))
        }
    }

    /// Checks a description and returns its wgpu format.
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

    /// Lists what the host must change before it hands over this image, whose format the device supports: features to
    /// enable, usages of the image, layouts.
    fn lacks(&self, name: &str, image: &HostImage, role: ImageRole) -> Vec<Error> {
        let field = |name_of_field: &str| format!("{name}.{name_of_field}");
        let mut lacks = Vec::new();
        if role == ImageRole::Colour && image.samples > 1 && self.record.enabled.core.sample_rate_shading == vk::FALSE {
            let feature = names::feature_text("VkPhysicalDeviceFeatures::sampleRateShading");
            lacks.push(Error::invalid(field("samples"), format!("above 1 needs {feature}, or resolve first")));
        }
        let needed = if role == ImageRole::Colour {
            vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC
        } else {
            vk::ImageUsageFlags::SAMPLED
        };
        if !image.usage.contains(needed) {
            let bits = names::usage_names(needed & !image.usage, " and ");
            let rest = format!("lacks {bits}, with which the image must be created");
            lacks.push(Error::invalid(field("usage"), rest));
        }
        let presents = self.record.extensions.contains(&ash::khr::swapchain::NAME);
        for (which, layout) in [("layout", image.layout), ("final_layout", image.final_layout)] {
            let dropped = which == "layout" && layout == vk::ImageLayout::UNDEFINED && role == ImageRole::Colour;
            let obstacle = layouts::obstacle(layout, image, &self.record.enabled, presents).filter(|_| !dropped);
            if let Some(o) = obstacle {
                let rest = format!("must not be {}, which {o}", names::layout_name(layout));
                lacks.push(Error::invalid(field(which), rest));
            }
        }
        lacks
    }

    /// Checks that this device supports the format for the role and sample count.
    fn check_format(&self, name: &str, image: &HostImage, format: TextureFormat, role: ImageRole) -> Result<()> {
        let raw = image.format;
        let unsupported = |what: String| Err(Error::unsupported(what).within(&format!("{name}.format")));
        if !self.device.device.features().contains(format.required_features()) {
            return unsupported(format!("this device does not serve {raw:?}"));
        }
        // SAFETY: the adapter is only queried.
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

/// Converts the host's usage to wgpu's.
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
