//! Image of a host, a `VkImage`: its description, and the formats and layouts that correspond to it.

use ash::vk;
use wgpu::{TextureFormat, TextureUses};

use super::names;
use crate::error::{Error, Result};

/// wgpu features that every host's device gets if it supports them: timestamps, and the formats and sample counts that
/// the host's images may have. None of these features needs a Vulkan feature to be enabled.
pub(super) const FORMAT_FEATURES: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES)
    .union(wgpu::Features::DEPTH32FLOAT_STENCIL8)
    .union(wgpu::Features::RG11B10UFLOAT_RENDERABLE);

/// Use that Welkin makes of a host's image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageRole {
    /// Drawn into, and copied for reading: needs `VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT` and `TRANSFER_SRC_BIT`. A
    /// multisampled image also needs `sampleRateShading` enabled.
    Colour,
    /// Depth that is read: needs `VK_IMAGE_USAGE_SAMPLED_BIT`.
    Depth,
    /// Colour data that is read (mask, normals, motion): needs `VK_IMAGE_USAGE_SAMPLED_BIT`.
    Sampled,
}

/// 2-D image of the host, handed over for one submission. The host remains its owner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostImage {
    /// Image. It belongs to the queue's family (or is shared concurrently); its mip level 0 is used.
    pub image: vk::Image,
    /// Format that the image was created with.
    pub format: vk::Format,
    /// Width of the image, pixels.
    pub width: u32,
    /// Height of the image, pixels.
    pub height: u32,
    /// Samples per pixel: 1, 2, 4 or 8.
    pub samples: u32,
    /// Usage that the image was created with.
    pub usage: vk::ImageUsageFlags,
    /// Number of array layers, \[1, 2048\]; 1 for a plain image.
    pub array_layers: u32,
    /// Index of the layer that is handed over, from 0.
    pub layer: u32,
    /// Layout in which the host left the image. `UNDEFINED` (colour only) means that its contents may be discarded.
    pub layout: vk::ImageLayout,
    /// Layout in which the host wants the image back.
    pub final_layout: vk::ImageLayout,
}

impl HostImage {
    /// Whether two descriptions agree in everything but the layer and the layouts, and so mean the same Vulkan image.
    pub(super) fn same_image(&self, other: &Self) -> bool {
        let rest =
            Self { layer: 0, layout: vk::ImageLayout::UNDEFINED, final_layout: vk::ImageLayout::UNDEFINED, ..*self };
        let other = Self { layer: 0, layout: rest.layout, final_layout: rest.final_layout, ..*other };
        rest == other
    }

    /// Checks that depth was created with a usage that allows writing; `name` is the parameter in the message.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`], which names the usage.
    pub fn check_written(&self, name: &str) -> Result<()> {
        let needed = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        if self.usage.contains(needed) {
            return Ok(());
        }
        let bits = names::usage_names(needed, " and ");
        let rest = format!("lacks {bits}, with which the image must be created where depth_access writes it");
        Err(Error::invalid(format!("{name}.usage"), rest))
    }

    /// Returns the aspects that a layout change must name.
    pub(super) fn aspects(&self) -> vk::ImageAspectFlags {
        match wgpu_format(self.format) {
            Some(f) if f.has_stencil_aspect() => vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL,
            Some(f) if f.has_depth_aspect() => vk::ImageAspectFlags::DEPTH,
            _ => vk::ImageAspectFlags::COLOR,
        }
    }
}

/// Returns the wgpu format that corresponds to `format`; `None` if Welkin does not support it.
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

/// Returns the wgpu state of an imported image at the start and at the end of each submission.
pub(super) fn home_state(role: ImageRole) -> TextureUses {
    match role {
        ImageRole::Colour => TextureUses::COLOR_TARGET,
        ImageRole::Depth | ImageRole::Sampled => TextureUses::RESOURCE,
    }
}

/// Returns the Vulkan layout that wgpu's Vulkan backend uses for [`home_state`].
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
