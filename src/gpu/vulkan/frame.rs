//! One submission on a host's queue: images taken over and handed back in the host's layouts, and semaphores.

use std::sync::PoisonError;

use ash::vk;
use wgpu::hal::vulkan::Api as Vulkan;

use super::VulkanHost;
use super::image::{self, HostImage, ImageRole};
use crate::error::{Error, Result, Status};

/// A semaphore of the host's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostSemaphore {
    /// The semaphore.
    pub semaphore: vk::Semaphore,
    /// `None` for a binary semaphore; the value to wait for or to signal for a timeline one.
    pub value: Option<u64>,
}

/// What the host lends for one submission.
#[derive(Clone, Copy, Debug, Default)]
pub struct HandOver<'a> {
    /// Images that the commands use, each with the texture that [`VulkanHost::import`] gave for it.
    pub images: &'a [(HostImage, ImageRole, &'a wgpu::Texture)],
    /// Waited for before any of the commands; a binary one must already have its signal submitted.
    pub wait: &'a [HostSemaphore],
    /// Signalled when all of the commands are done and the images are in their final layouts.
    pub signal: &'a [HostSemaphore],
}

impl VulkanHost {
    /// Submits the commands of `encoder` on the host's queue: waits, takes the images over from the host's
    /// layouts, runs the commands, brings the images into the layouts that the host wants, signals.
    ///
    /// When this returns the work is submitted, not done. An image may be handed over only once a submission.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] names a semaphore that is null or of a kind that the host did not enable;
    /// nothing is submitted then. A GPU fault in the commands comes as [`Status::Internal`] or
    /// [`Status::DeviceLost`], and the semaphores are then neither waited for nor signalled.
    ///
    /// # Safety
    /// The images are described truly and the semaphores live, of the kind that `value` says; the queue is used
    /// by the contract in the [module's words](super).
    pub unsafe fn submit(&self, mut encoder: wgpu::CommandEncoder, over: &HandOver<'_>) -> Result<()> {
        self.check_semaphores("wait", over.wait)?;
        self.check_semaphores("signal", over.signal)?;
        let home = over.images.iter().map(|(image, role, texture)| wgpu::TextureTransition {
            texture: *texture,
            selector: Some(wgpu::wgt::TextureSelector { mips: 0..1, layers: image.layer..image.layer + 1 }),
            state: image::home_state(*role),
        });
        encoder.transition_resources(std::iter::empty(), home);
        let take = over.images.iter().map(|(i, role, _)| barrier(i, i.layout, image::home_layout(*role)));
        let give = over.images.iter().map(|(i, role, _)| barrier(i, image::home_layout(*role), i.final_layout));
        // SAFETY: the caller vouches for the images; old layouts are the host's, then wgpu's own.
        let (take, give) =
            unsafe { (self.barriers(&take.collect::<Vec<_>>())?, self.barriers(&give.collect::<Vec<_>>())?) };
        let _one_at_a_time = self.submission.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the caller vouches for the semaphores; they are staged for the submission right below.
        unsafe { self.stage(over)? };
        self.device.queue.submit([take, encoder.finish(), give]);
        // SAFETY: the queue is only asked what is left over.
        unsafe { self.unstage(over) }
    }

    fn check_semaphores(&self, name: &str, semaphores: &[HostSemaphore]) -> Result<()> {
        for (i, s) in semaphores.iter().enumerate() {
            if s.semaphore == vk::Semaphore::null() {
                let name = format!("{name}[{i}].semaphore");
                return Err(Error::range(&name, "a live VkSemaphore", "VK_NULL_HANDLE"));
            }
            if s.value.is_some() && !self.record.enabled.timeline_semaphore {
                let message = format!(
                    "{name}[{i}]: a timeline value needs timelineSemaphore enabled on the host's device and listed \
                     in enabled_features"
                );
                return Err(Error::new(Status::InvalidArgument, message));
            }
        }
        Ok(())
    }

    /// Records one pipeline barrier with `barriers` into a command buffer of its own: wgpu must not track
    /// commands beside raw ones.
    ///
    /// # Safety
    /// The barriers describe live images of the host's device truly.
    unsafe fn barriers(&self, barriers: &[vk::ImageMemoryBarrier<'_>]) -> Result<wgpu::CommandBuffer> {
        let mut encoder = self.device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        // SAFETY: the encoder is used for this alone, its command buffer is recording and outside of a pass.
        let recorded = unsafe {
            encoder.as_hal_mut::<Vulkan, _, _>(|e| {
                let Some(e) = e else { return false };
                // All stages on both sides: what the host did before and does after is not known here.
                let all = vk::PipelineStageFlags::ALL_COMMANDS;
                let none = vk::DependencyFlags::empty();
                self.raw.cmd_pipeline_barrier(e.raw_handle(), all, all, none, &[], &[], barriers);
                true
            })
        };
        if recorded {
            return Ok(encoder.finish());
        }
        Err(self
            .device
            .take_fault()
            .unwrap_or_else(|| Error::new(Status::DeviceLost, "the device is lost: destroy it and create a new one")))
    }

    /// Stages the semaphores for the next submission.
    ///
    /// # Safety
    /// The semaphores are live and of the kind that their value says.
    unsafe fn stage(&self, over: &HandOver<'_>) -> Result<()> {
        // SAFETY: the queue is not destroyed through the guard.
        let Some(queue) = (unsafe { self.device.queue.as_hal::<Vulkan>() }) else {
            return Err(Error::new(Status::DeviceLost, "the device is lost: destroy it and create a new one"));
        };
        for s in over.wait {
            queue.add_wait_semaphore(s.semaphore, s.value, vk::PipelineStageFlags::ALL_COMMANDS);
        }
        for s in over.signal {
            queue.add_signal_semaphore(s.semaphore, s.value);
        }
        Ok(())
    }

    /// Takes back semaphores that no submission consumed, which means that wgpu refused the commands.
    ///
    /// # Safety
    /// As for [`Self::stage`].
    unsafe fn unstage(&self, over: &HandOver<'_>) -> Result<()> {
        // SAFETY: the queue is not destroyed through the guard.
        let queue = unsafe { self.device.queue.as_hal::<Vulkan>() };
        let mut refused = queue.is_none();
        if let Some(queue) = queue {
            for s in over.wait {
                refused |= queue.remove_wait_semaphore(s.semaphore);
            }
            for s in over.signal {
                refused |= queue.remove_signal_semaphore(s.semaphore);
            }
        }
        let fault = self.device.take_fault();
        if refused || fault.is_some() {
            return Err(fault.unwrap_or_else(|| {
                Error::new(Status::Internal, "the commands were refused and not submitted; see the log")
            }));
        }
        Ok(())
    }
}

/// A full dependency on one layer of an image, with its change of layout.
fn barrier(image: &HostImage, from: vk::ImageLayout, to: vk::ImageLayout) -> vk::ImageMemoryBarrier<'static> {
    vk::ImageMemoryBarrier::default()
        .image(image.image)
        .old_layout(from)
        .new_layout(to)
        .src_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE)
        .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .subresource_range(vk::ImageSubresourceRange {
            aspect_mask: image.aspects(),
            base_mip_level: 0,
            level_count: 1,
            base_array_layer: image.layer,
            layer_count: 1,
        })
}
