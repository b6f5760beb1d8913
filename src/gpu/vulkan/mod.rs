//! Hosts that own a Vulkan device: Welkin draws on the host's own `VkDevice` and `VkQueue`, into its images.
//!
//! # The queue contract
//! Welkin itself submits to the host's queue: when a record call returns, its work *is submitted*. Vulkan allows only
//! one thread at a time to use a queue. So the host must either keep off the queue while any Welkin call with this
//! device runs (record, create, destroy), or pass [`VulkanHostDesc::lock_queue`] and `unlock_queue`. Welkin calls these
//! two around every `vkQueueSubmit` and `vkQueueWaitIdle`, and around nothing else. The callbacks must not call any
//! Welkin function.
//!
//! # Images and order
//! The host hands over an image, or one layer of an array, for one submission ([`VulkanHost::submit`]). The image comes
//! in the layout that the host left it in, and goes back in the layout that the host asks for. On the *same queue* no
//! semaphore and no barrier of the host's own is needed: Welkin's work waits for what the host submitted before, and
//! what the host submits afterwards waits for Welkin's work. The host orders work on other queues by semaphores
//! ([`HandOver`]).
//!
//! # What the host must have enabled
//! The host needs nothing beyond Vulkan 1.1 and a queue for graphics and compute, except `VK_KHR_swapchain` for images
//! in `PRESENT_SRC_KHR`, and `sampleRateShading` for multisampled colour. Timeline semaphores, robust access, 16-bit
//! storage and similar features are used only where the host says that it enabled them ([`EnabledFeatures`]): wgpu sees
//! only what is enabled. On Vulkan 1.0 the device needs `VK_KHR_maintenance1` and
//! `VK_KHR_storage_buffer_storage_class`.

mod adopt;
mod bracket;
mod checks;
mod desc;
mod dispatch;
mod facts;
mod frame;
mod host;
mod image;
mod importing;
mod imports;
mod layouts;
mod names;

pub use adopt::adopt;
pub use desc::VulkanHostDesc;
pub use dispatch::QueueLock;
pub use facts::EnabledFeatures;
pub use frame::{HandOver, HostSemaphore};
pub use host::VulkanHost;
pub use image::{HostImage, ImageRole};
