//! Image of a host, a `VkImage`: its description, and the formats and layouts that stand for it.

use ash::vk;
use wgpu::{TextureFormat, TextureUses};

use super::names;
use crate::error::{Error, Result};

/// Features that let wgpu use the formats and sample counts that the host's images may have; none of them needs
/// anything switched on in Vulkan.
pub(super) const FORMAT_FEATURES: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES)
    .union(wgpu::Features::DEPTH32FLOAT_STENCIL8)
    .union(wgpu::Features::RG11B10UFLOAT_RENDERABLE);

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
    pub(super) fn same_image(&self, other: &Self) -> bool {
        let rest =
            Self { layer: 0, layout: vk::ImageLayout::UNDEFINED, final_layout: vk::ImageLayout::UNDEFINED, ..*self };
        let other = Self { layer: 0, layout: rest.layout, final_layout: rest.final_layout, ..*other };
        rest == other
    }

    /// Refuses depth that was not created to be written, in a message about the parameter `name`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the usage.
    pub fn check_written(&self, name: &str) -> Result<()> {
        let needed = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        if self.usage.contains(needed) {
            return Ok(());
        }
        let bits = names::usage_names(needed, " and ");
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
pub(super) fn wgpu_format(format: vk::Format) -> Option<TextureFormat> {
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
