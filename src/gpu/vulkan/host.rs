//! Host of a Vulkan device: Welkin's device on it, and the objects that the host handed over.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::bracket::Brackets;
use super::dispatch::HostRecord;
use super::facts::EnabledFeatures;
use super::imports::Imports;
use crate::error::{Error, Result, Status};
use crate::gpu::device::Device;

/// Welkin's device on a host's Vulkan device, and the objects that the host handed over. Dropping it destroys no object
/// of the host.
pub struct VulkanHost {
    /// Device for contexts and views; it shows only what the host enabled.
    pub device: Arc<Device>,
    pub(super) record: Arc<HostRecord>,
    pub(super) raw: ash::Device,
    /// Whether wgpu has released its last object on the host's device.
    pub(super) released: Arc<AtomicBool>,
    pub(super) images: Mutex<Imports>,
    /// Brackets, locked during a submission: semaphores and barriers belong to the next submission, so staging them and
    /// submitting must be one step.
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

    /// Waits for the GPU (and so for every semaphore that a submission waits for), releases everything, and reports
    /// whether the host may now destroy its device.
    ///
    /// # Errors
    /// [`Status::InUse`] if contexts, views or textures made from this device still exist: they keep the device open,
    /// and it closes with the last of them. [`Status::DeviceLost`] if the device was lost meanwhile, or the first GPU
    /// fault that was not yet reported.
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
        // On a lost device nothing is pending either.
        let _ = self.device.wait();
        let brackets = self.brackets.get_mut().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the queue's work was waited for, and the host's device lives longer than this.
        unsafe { brackets.destroy(&self.raw) };
    }
}
