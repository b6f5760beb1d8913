//! Layouts that a host's image can have, and the reason why it cannot have a layout: its format, or a usage, feature or
//! extension that is missing.

use ash::vk;

use super::facts::EnabledFeatures;
use super::image::HostImage;
use super::names::{feature_text, usage_names};

const SWAPCHAIN: &str = "needs VK_KHR_swapchain enabled on the device and listed in enabled_device_extensions of the \
                         wk_vulkan_host_desc";

/// Returns the reason for which `image` cannot be in `layout`, as the end of a sentence about the layout; `None` if it
/// can. The rules are those of image barriers (Vulkan specification, VkImageMemoryBarrier, valid usage). `presents`
/// says whether `VK_KHR_swapchain` is enabled.
pub(super) fn obstacle(
    layout: vk::ImageLayout,
    image: &HostImage,
    enabled: &EnabledFeatures,
    presents: bool,
) -> Option<String> {
    use vk::{ImageLayout as L, ImageUsageFlags as U};
    let aspects = image.aspects();
    let depth = aspects.contains(vk::ImageAspectFlags::DEPTH);
    let stencil = aspects.contains(vk::ImageAspectFlags::STENCIL);
    let read = U::SAMPLED | U::INPUT_ATTACHMENT;
    let colour = |needs| if depth { Some("is for colour images".to_owned()) } else { needs };
    let only_depth = |needs| if depth { needs } else { Some("is for depth images".to_owned()) };
    let used = |any: U| {
        let missing = !image.usage.intersects(any);
        missing.then(|| format!("needs an image with usage {}", usage_names(any, " or ")))
    };
    let with = |feature: bool, name: &str| (!feature).then(|| format!("needs {}", feature_text(name)));
    match layout {
        L::GENERAL => None,
        L::TRANSFER_SRC_OPTIMAL => used(U::TRANSFER_SRC),
        L::TRANSFER_DST_OPTIMAL => used(U::TRANSFER_DST),
        L::SHADER_READ_ONLY_OPTIMAL => used(read),
        L::COLOR_ATTACHMENT_OPTIMAL => colour(used(U::COLOR_ATTACHMENT)),
        L::PRESENT_SRC_KHR => colour((!presents).then(|| SWAPCHAIN.to_owned())),
        L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL => only_depth(used(U::DEPTH_STENCIL_ATTACHMENT)),
        L::DEPTH_STENCIL_READ_ONLY_OPTIMAL => only_depth(used(U::DEPTH_STENCIL_ATTACHMENT | read)),
        L::DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL | L::DEPTH_ATTACHMENT_STENCIL_READ_ONLY_OPTIMAL => {
            if stencil {
                used(U::DEPTH_STENCIL_ATTACHMENT)
            } else {
                Some("is for formats with stencil".to_owned())
            }
        }
        L::DEPTH_ATTACHMENT_OPTIMAL | L::DEPTH_READ_ONLY_OPTIMAL if stencil => {
            Some("is for formats without stencil".to_owned())
        }
        L::DEPTH_ATTACHMENT_OPTIMAL | L::DEPTH_READ_ONLY_OPTIMAL => only_depth(
            with(enabled.separate_depth_stencil_layouts, "separateDepthStencilLayouts")
                .or_else(|| used(U::DEPTH_STENCIL_ATTACHMENT)),
        ),
        L::READ_ONLY_OPTIMAL => {
            with(enabled.synchronization2, "synchronization2").or_else(|| used(read | U::DEPTH_STENCIL_ATTACHMENT))
        }
        L::ATTACHMENT_OPTIMAL => with(enabled.synchronization2, "synchronization2")
            .or_else(|| used(U::COLOR_ATTACHMENT | U::DEPTH_STENCIL_ATTACHMENT)),
        L::UNDEFINED | L::PREINITIALIZED => Some("would drop what the image holds".to_owned()),
        _ => Some("is none that Welkin knows".to_owned()),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Returns a small image of a host, in layout `GENERAL`.
    pub fn image(format: vk::Format, usage: vk::ImageUsageFlags) -> HostImage {
        HostImage {
            image: ash::vk::Handle::from_raw(1),
            format,
            width: 4,
            height: 4,
            samples: 1,
            usage,
            array_layers: 1,
            layer: 0,
            layout: vk::ImageLayout::GENERAL,
            final_layout: vk::ImageLayout::GENERAL,
        }
    }

    #[test]
    fn layouts_fit_by_format_usage_and_features() {
        use vk::{ImageLayout as L, ImageUsageFlags as U};
        let none = EnabledFeatures::default();
        let fits = |layout, image: &HostImage, e: &EnabledFeatures, presents| obstacle(layout, image, e, presents);
        let says = |o: Option<String>, words: &str| assert!(o.as_ref().is_some_and(|o| o.contains(words)), "{o:?}");
        let colour = image(vk::Format::R8G8B8A8_UNORM, U::COLOR_ATTACHMENT | U::TRANSFER_SRC);
        assert_eq!(fits(L::COLOR_ATTACHMENT_OPTIMAL, &colour, &none, false), None);
        assert_eq!(fits(L::TRANSFER_SRC_OPTIMAL, &colour, &none, false), None);
        says(fits(L::TRANSFER_DST_OPTIMAL, &colour, &none, false), "usage VK_IMAGE_USAGE_TRANSFER_DST_BIT");
        says(fits(L::PRESENT_SRC_KHR, &colour, &none, false), "VK_KHR_swapchain");
        assert_eq!(fits(L::PRESENT_SRC_KHR, &colour, &none, true), None);
        says(fits(L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL, &colour, &none, false), "depth images");
        says(fits(L::UNDEFINED, &colour, &none, false), "drop");
        says(fits(L::READ_ONLY_OPTIMAL, &colour, &none, false), "synchronization2");
        let depth = image(vk::Format::D32_SFLOAT, U::DEPTH_STENCIL_ATTACHMENT | U::SAMPLED);
        assert_eq!(fits(L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL, &depth, &none, false), None);
        says(fits(L::PRESENT_SRC_KHR, &depth, &none, true), "colour images");
        says(fits(L::DEPTH_ATTACHMENT_OPTIMAL, &depth, &none, false), "separateDepthStencilLayouts");
        let separate = EnabledFeatures { separate_depth_stencil_layouts: true, ..none };
        assert_eq!(fits(L::DEPTH_ATTACHMENT_OPTIMAL, &depth, &separate, false), None);
        let both = image(vk::Format::D24_UNORM_S8_UINT, U::DEPTH_STENCIL_ATTACHMENT | U::SAMPLED);
        says(fits(L::DEPTH_ATTACHMENT_OPTIMAL, &both, &separate, false), "without stencil");
    }
}
