//! Brackets: command buffers with barriers before and after a submission. They are recorded once, because they depend
//! only on the images and layouts, which repeat from frame to frame. They go into the same `vkQueueSubmit` as wgpu's
//! commands.

use ash::vk;

use super::image::{self, HostImage, ImageRole};
use crate::error::{Error, Result, Status};

/// Largest number of different hand-overs kept. A host that alternates among a few images stays far below.
const MAX_BRACKETS: usize = 64;

/// One image of a hand-over, with everything that its barriers depend on.
type Lent = (HostImage, ImageRole);

/// Recorded command buffers of one hand-over: to run before the commands, and after them.
struct Bracket {
    lent: Vec<Lent>,
    buffers: [vk::CommandBuffer; 2],
}

/// Recorded brackets of one host, the most recent last.
#[derive(Default)]
pub(super) struct Brackets {
    pool: Option<vk::CommandPool>,
    recorded: Vec<Bracket>,
}

impl Brackets {
    /// Returns the two command buffers of a hand-over: the one to run before the commands changes the host's layouts to
    /// wgpu's, the one to run after them changes wgpu's layouts to the host's.
    ///
    /// # Errors
    /// [`Status::OutOfMemory`], [`Status::DeviceLost`] or [`Status::Internal`] if the driver refuses a command buffer.
    ///
    /// # Safety
    /// `device` must be the host's live device, `family` the queue's, and the images' descriptions must be true.
    pub(super) unsafe fn of(
        &mut self,
        device: &ash::Device,
        family: u32,
        lent: impl Iterator<Item = Lent> + Clone,
    ) -> Result<[vk::CommandBuffer; 2]> {
        if let Some(at) = self.recorded.iter().position(|b| b.lent.iter().copied().eq(lent.clone())) {
            self.recorded[at..].rotate_left(1);
        } else {
            let lent: Vec<Lent> = lent.collect();
            // SAFETY: the caller vouches for device, family and images.
            let buffers = unsafe { self.record(device, family, &lent) }.map_err(driver_error)?;
            self.recorded.push(Bracket { lent, buffers });
        }
        Ok(self.recorded.last().map_or([vk::CommandBuffer::null(); 2], |b| b.buffers))
    }

    /// Allocates and records the two command buffers of a hand-over.
    ///
    /// # Safety
    /// The requirements of [`Self::of`].
    unsafe fn record(
        &mut self,
        device: &ash::Device,
        family: u32,
        lent: &[Lent],
    ) -> std::result::Result<[vk::CommandBuffer; 2], vk::Result> {
        // SAFETY: the caller vouches for device and family; the buffers are new and come from this pool.
        unsafe {
            let pool = match self.pool {
                Some(pool) => pool,
                None => {
                    let info = vk::CommandPoolCreateInfo::default()
                        .queue_family_index(family)
                        .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
                    *self.pool.insert(device.create_command_pool(&info, None)?)
                }
            };
            let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(2);
            let buffers = device.allocate_command_buffers(&info)?;
            let buffers = [buffers[0], buffers[1]];
            for (buffer, taking) in buffers.into_iter().zip([true, false]) {
                let barriers: Vec<_> = lent.iter().map(|(image, role)| barrier(image, *role, taking)).collect();
                let many = vk::CommandBufferUsageFlags::SIMULTANEOUS_USE;
                device.begin_command_buffer(buffer, &vk::CommandBufferBeginInfo::default().flags(many))?;
                // All stages on both sides, because the host's work before and after is not known here.
                let all = vk::PipelineStageFlags::ALL_COMMANDS;
                device.cmd_pipeline_barrier(buffer, all, all, vk::DependencyFlags::empty(), &[], &[], &barriers);
                device.end_command_buffer(buffer)?;
            }
            Ok(buffers)
        }
    }

    /// Whether brackets must be freed before another one is recorded; freeing needs an idle queue.
    pub(super) fn is_full(&self) -> bool {
        self.recorded.len() >= MAX_BRACKETS
    }

    /// Frees the brackets for which `f` holds.
    ///
    /// # Safety
    /// The queue must be idle, and `device` must be the host's live device.
    pub(super) unsafe fn free(&mut self, device: &ash::Device, f: impl Fn(&[Lent]) -> bool) {
        let Some(pool) = self.pool else { return };
        self.recorded.retain(|b| {
            let keep = !f(&b.lent);
            if !keep {
                // SAFETY: the caller vouches that nothing is pending.
                unsafe { device.free_command_buffers(pool, &b.buffers) };
            }
            keep
        });
    }

    /// Frees all brackets and the command pool.
    ///
    /// # Safety
    /// The requirements of [`Self::free`].
    pub(super) unsafe fn destroy(&mut self, device: &ash::Device) {
        self.recorded.clear();
        if let Some(pool) = self.pool.take() {
            // SAFETY: the caller vouches that nothing is pending.
            unsafe { device.destroy_command_pool(pool, None) };
        }
    }
}

fn driver_error(e: vk::Result) -> Error {
    let status = match e {
        vk::Result::ERROR_OUT_OF_HOST_MEMORY | vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => Status::OutOfMemory,
        vk::Result::ERROR_DEVICE_LOST => Status::DeviceLost,
        _ => Status::Internal,
    };
    Error::new(status, format!("the host's Vulkan device refused a command buffer: {e}"))
}

/// Returns a full dependency on one layer of an image, with its change of layout. `taking` is true for the change from
/// the host's layout to wgpu's.
fn barrier(image: &HostImage, role: ImageRole, taking: bool) -> vk::ImageMemoryBarrier<'static> {
    let home = image::home_layout(role);
    let (from, to) = if taking { (image.layout, home) } else { (home, image.final_layout) };
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
