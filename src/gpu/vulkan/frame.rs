//! Submission to a host's queue: images are taken over and handed back in the host's layouts, and semaphores are waited
//! for and signalled.

use std::sync::PoisonError;

use ash::vk;
use wgpu::hal::vulkan::Api as Vulkan;

use super::dispatch;
use super::host::VulkanHost;
use super::image::{self, HostImage, ImageRole};
use crate::error::{Error, Result, Status};

/// Semaphore of the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostSemaphore {
    /// Semaphore.
    pub semaphore: vk::Semaphore,
    /// `None` for a binary semaphore; for a timeline semaphore the value to wait for or to signal.
    pub value: Option<u64>,
}

/// Images and semaphores that the host lends for one submission.
#[derive(Clone, Copy, Debug, Default)]
pub struct HandOver<'a> {
    /// Images that the commands use, each at most once, with the texture that [`VulkanHost::import`] returned for it.
    pub images: &'a [(HostImage, ImageRole, &'a wgpu::Texture)],
    /// Semaphores to wait for before any of the commands; the signal of a binary one must already be submitted.
    pub wait: &'a [HostSemaphore],
    /// Semaphores to signal when all commands are done and the images are in their final layouts.
    pub signal: &'a [HostSemaphore],
}

impl VulkanHost {
    /// Submits the commands of `encoder` to the host's queue: waits for the semaphores, takes the images over from the
    /// host's layouts, runs the commands, brings the images into the layouts that the host wants, and signals.
    ///
    /// On return the work is submitted, not done.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`], which names a null semaphore, or a timeline semaphore where the host did not enable
    /// timeline semaphores; nothing is then submitted. [`Status::OutOfMemory`], if there is no memory for the barriers.
    /// [`Status::Internal`] or [`Status::DeviceLost`] for a GPU fault in the commands; if wgpu refused the commands
    /// because of the fault, the semaphores are neither waited for nor signalled.
    ///
    /// # Safety
    /// The images' descriptions must be true, and the semaphores live and of the kind that `value` says. The queue must
    /// be used as the [module's contract](super) demands.
    pub unsafe fn submit(&self, mut encoder: wgpu::CommandEncoder, hand_over: &HandOver<'_>) -> Result<()> {
        self.check_semaphores("wait_semaphores", hand_over.wait)?;
        self.check_semaphores("signal_semaphores", hand_over.signal)?;
        let home = hand_over.images.iter().map(|&(image, role, texture)| wgpu::TextureTransition {
            texture,
            selector: Some(wgpu::wgt::TextureSelector { mips: 0..1, layers: image.layer..image.layer + 1 }),
            state: image::home_state(role),
        });
        encoder.transition_resources(std::iter::empty(), home);
        let commands = encoder.finish();
        let mut brackets = self.brackets.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the caller vouches for the images; the queue is waited for before brackets are freed.
        let bracket = unsafe {
            if brackets.is_full() {
                self.device.wait()?;
                brackets.free(&self.raw, |_| true);
            }
            let family = self.record.queue_family_index;
            brackets.of(&self.raw, family, hand_over.images.iter().map(|&(image, role, _)| (image, role)))?
        };
        let turn = self.device.turn();
        // SAFETY: the caller vouches for the semaphores; they are staged for the submission right below.
        unsafe { self.stage(hand_over)? };
        let submitted = dispatch::with_bracket(self.record.queue, bracket, || self.device.queue.submit([commands]));
        // SAFETY: as for `stage`; only semaphores that are still staged are removed.
        unsafe { self.unstage(hand_over)? };
        drop(turn);
        if submitted { Ok(()) } else { Err(refused()) }
    }

    fn check_semaphores(&self, name: &str, semaphores: &[HostSemaphore]) -> Result<()> {
        for (i, s) in semaphores.iter().enumerate() {
            if s.semaphore == vk::Semaphore::null() {
                let name = format!("{name}[{i}].semaphore");
                return Err(Error::range(&name, "a live VkSemaphore", "VK_NULL_HANDLE"));
            }
            if s.value.is_some() && !self.record.enabled.timeline_semaphore {
                let rest = "needs timelineSemaphore enabled on the host's device and listed in enabled_features";
                return Err(Error::invalid(format!("{name}[{i}].value"), rest));
            }
        }
        Ok(())
    }

    /// Stages the semaphores for the next submission.
    ///
    /// # Safety
    /// The semaphores must be live and of the kind that their value says.
    unsafe fn stage(&self, hand_over: &HandOver<'_>) -> Result<()> {
        // SAFETY: the queue is not destroyed through the guard.
        let Some(queue) = (unsafe { self.device.queue.as_hal::<Vulkan>() }) else {
            return Err(lost());
        };
        for s in hand_over.wait {
            queue.add_wait_semaphore(s.semaphore, s.value, vk::PipelineStageFlags::ALL_COMMANDS);
        }
        for s in hand_over.signal {
            queue.add_signal_semaphore(s.semaphore, s.value);
        }
        Ok(())
    }

    /// Removes the semaphores that are still staged, which are left only if wgpu refused the commands. Reports a GPU
    /// fault.
    ///
    /// # Safety
    /// The requirements of [`Self::stage`].
    unsafe fn unstage(&self, hand_over: &HandOver<'_>) -> Result<()> {
        // SAFETY: the queue is not destroyed through the guard.
        if let Some(queue) = unsafe { self.device.queue.as_hal::<Vulkan>() } {
            for s in hand_over.wait {
                queue.remove_wait_semaphore(s.semaphore);
            }
            for s in hand_over.signal {
                queue.remove_signal_semaphore(s.semaphore);
            }
        }
        self.device.check()?;
        if self.device.is_lost() { Err(lost()) } else { Ok(()) }
    }
}

fn lost() -> Error {
    Error::new(Status::DeviceLost, "the device is lost: destroy it and create a new one")
}

fn refused() -> Error {
    Error::new(Status::Internal, "the commands were refused and not submitted; see the log")
}
