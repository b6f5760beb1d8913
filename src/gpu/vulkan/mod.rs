//! Hosts that own a Vulkan device: Welkin draws on the host's own `VkDevice` and `VkQueue`, into its images.
//!
//! # The queue contract
//! Welkin submits on the host's queue itself: when a record call returns, its work *is submitted*. Vulkan wants
//! a queue used by one thread at a time, so either the host stays away from the queue while any Welkin call
//! with this device runs (record, create, destroy), or it passes [`VulkanHostDesc::lock_queue`] and
//! `unlock_queue`, which Welkin calls round every `vkQueueSubmit` and `vkQueueWaitIdle` and nothing else.
//! Inside the callbacks no Welkin function may be called.
//!
//! # Images and order
//! An image, or one layer of an array, is handed over for one submission ([`VulkanHost::submit`]) in the layout that
//! the host left it in and comes back in the layout that it asks for. Work that the host submitted to the *same queue*
//! before is waited for without a semaphore, and so is Welkin's by what the host submits to that queue afterwards: no
//! barrier of the host's own is needed. Semaphores order work with other queues.
//!
//! # What the host must have enabled
//! Nothing beyond Vulkan 1.1 and a queue that draws and computes, except `VK_KHR_swapchain` for images in
//! `PRESENT_SRC_KHR` and `sampleRateShading` for colour of several samples. Timeline semaphores, robust access, 16-bit
//! storage and the like are used where the host says that it enabled them ([`EnabledFeatures`]), and otherwise not:
//! wgpu is shown only what is enabled. On Vulkan 1.0 the device needs `VK_KHR_maintenance1` and
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
