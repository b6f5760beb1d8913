//! Names of Vulkan's features, layouts and usages, spelled for messages.

use ash::vk;

/// Returns a feature's name with the places where the host must enable and list it.
pub(super) fn feature_text(name: &str) -> String {
    format!("{name} enabled on the device and listed in enabled_features of the wk_vulkan_host_desc")
}

/// Returns the layout's name in Vulkan's headers, or its number if the name is not known.
pub(super) fn layout_name(layout: vk::ImageLayout) -> String {
    let text = format!("{layout:?}");
    if text.starts_with(|c: char| c.is_ascii_digit()) { text } else { format!("VK_IMAGE_LAYOUT_{text}") }
}

/// Returns the bits' names in Vulkan's headers.
pub(super) fn usage_names(usage: vk::ImageUsageFlags, separator: &str) -> String {
    let text = format!("{usage:?}");
    let names = text.split(" | ").map(|n| format!("VK_IMAGE_USAGE_{n}_BIT"));
    names.collect::<Vec<_>>().join(separator)
}
