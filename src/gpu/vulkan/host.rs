//! Host of a Vulkan device: Welkin's device over it, and what the host handed over.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::bracket::Brackets;
use super::dispatch::HostRecord;
use super::facts::EnabledFeatures;
use super::imports::Imports;
use crate::error::{Error, Result, Status};
use crate::gpu::device::Device;

/// Welkin's device over a host's Vulkan device, with what the host handed over. Dropping it destroys nothing of
/// the host's.
pub struct VulkanHost {
    /// The device for contexts and views; it shows only what the host enabled.
    pub device: Arc<Device>,
    pub(super) record: Arc<HostRecord>,
    pub(super) raw: ash::Device,
    pub(super) released: Arc<AtomicBool>,
    pub(super) images: Mutex<Imports>,
    /// Held through a submission: semaphores and barriers belong to the next one, so staging them and submitting
    /// is one step.
    pub(super) brackets: Mutex<Brackets>,
}

impl std::fmt::Debug for VulkanHost {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("VulkanHost").field("queue", &self.record.queue).finish_non_exhaustive()
    }
}

impl VulkanHost {
    /// Returns the features that the host enabled on its device.
    pub fn enabled_features(&self) -> &EnabledFeatures {
        &self.record.enabled
    }

    /// Waits for the GPU (and so for every semaphore that was to be waited for), gives everything back and says whether
    /// the host may now destroy its device.
    ///
    /// # Errors
    /// [`Status::InUse`] if contexts, views or textures made from this device are still alive: they keep it open,
    /// and it closes when the last of them goes. [`Status::DeviceLost`] if the device was lost meanwhile.
    pub fn close(self) -> Result<()> {
        let waited = self.device.wait();
        let released = Arc::clone(&self.released);
        drop(self);
        if !released.load(Ordering::Acquire) {
            let message = "the Vulkan device is still used by contexts, views or textures made from it: destroy them";
            return Err(Error::new(Status::InUse, message));
        }
        waited
    }
}

impl Drop for VulkanHost {
    fn drop(&mut self) {
        // A device that is lost has nothing pending either.
        let _ = self.device.wait();
        let brackets = self.brackets.get_mut().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the queue's work was waited for, and the host's device lives longer than this.
        unsafe { brackets.destroy(&self.raw) };
    }
}
