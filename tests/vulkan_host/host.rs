//! A Vulkan host in small: its own instance with the validation layer, device, images and readback.

use std::ffi::{CStr, c_void};
use std::sync::Mutex;

use crate::reuse;
use ash::vk;
use welkin::gpu::vulkan::{EnabledFeatures, HostImage, VulkanHostDesc};

/// Set where the validation layer cannot be installed: the tests then run without it, which they otherwise refuse.
pub const UNVALIDATED: &str = "WELKIN_WITHOUT_VALIDATION";

/// Settings of a host: Vulkan version, device extensions, core features, and whether timeline semaphores are enabled.
#[derive(Clone)]
pub struct Setup {
    pub api_version: u32,
    pub extensions: Vec<&'static CStr>,
    pub core: vk::PhysicalDeviceFeatures,
    pub timeline: bool,
    /// Whether the validation layer gives each object a handle that is never used again. Without it a new image has the
    /// handle of the last destroyed one, as with a driver.
    pub unique_handles: bool,
}

impl Setup {
    /// A modern host: Vulkan 1.3 with timeline semaphores.
    pub fn modern() -> Self {
        let core = vk::PhysicalDeviceFeatures::default();
        Self { api_version: vk::API_VERSION_1_3, extensions: Vec::new(), core, timeline: true, unique_handles: true }
    }

    /// A modern host that enables sample shading for its multisampled images.
    pub fn sampling() -> Self {
        let core = vk::PhysicalDeviceFeatures::default().sample_rate_shading(true);
        Self { core, ..Self::modern() }
    }

    /// A host that enables no feature, on the given version.
    pub fn bare(api_version: u32) -> Self {
        let core = vk::PhysicalDeviceFeatures::default();
        Self { api_version, extensions: Vec::new(), core, timeline: false, unique_handles: true }
    }
}

/// Messages of the validation layer.
#[derive(Default)]
pub struct Complaints(Mutex<Vec<String>>);

/// An image of the host's with its memory.
#[derive(Clone, Copy)]
pub struct Owned {
    pub image: HostImage,
    memory: vk::DeviceMemory,
}

/// A host with one queue.
pub struct Host {
    pub setup: Setup,
    pub entry: ash::Entry,
    pub instance: ash::Instance,
    pub physical_device: vk::PhysicalDevice,
    pub device: ash::Device,
    pub queue: vk::Queue,
    pool: vk::CommandPool,
    messenger: Option<(ash::ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    complaints: Box<Complaints>,
}

unsafe extern "system" fn collect(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer gives valid data; `user` is the host's box of complaints, which outlives the messenger.
    unsafe {
        let text = (*data).message_as_c_str().map_or(String::new(), |t| t.to_string_lossy().into_owned());
        (*user.cast::<Complaints>()).0.lock().unwrap().push(text);
    }
    vk::FALSE
}

impl Host {
    pub fn new(setup: Setup) -> Self {
        // SAFETY: plain Vulkan set-up by its rules; every pointer lives through the call that gets it.
        unsafe {
            let entry = ash::Entry::load().expect("libvulkan is installed");
            let layer = c"VK_LAYER_KHRONOS_validation";
            let layers = entry.enumerate_instance_layer_properties().unwrap();
            let validated = layers.iter().any(|l| l.layer_name_as_c_str() == Ok(layer));
            assert!(
                validated || std::env::var_os(UNVALIDATED).is_some(),
                "{} is not installed; set {UNVALIDATED}=1 to test without it",
                layer.to_string_lossy()
            );
            let complaints = Box::<Complaints>::default();
            let app = vk::ApplicationInfo::default().api_version(setup.api_version);
            let layer_names = if validated { vec![layer.as_ptr()] } else { Vec::new() };
            let mut instance_extensions = vec![ash::khr::get_physical_device_properties2::NAME.as_ptr()];
            if validated {
                instance_extensions.push(ash::ext::debug_utils::NAME.as_ptr());
            }
            let checks = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
            let plain = [vk::ValidationFeatureDisableEXT::UNIQUE_HANDLES];
            let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&checks);
            if !setup.unique_handles {
                features = features.disabled_validation_features(&plain);
            }
            let info = vk::InstanceCreateInfo::default()
                .application_info(&app)
                .enabled_layer_names(&layer_names)
                .enabled_extension_names(&instance_extensions);
            let info = if validated { info.push_next(&mut features) } else { info };
            let instance = entry.create_instance(&info, None).expect("a Vulkan instance");
            let messenger = validated.then(|| {
                let utils = ash::ext::debug_utils::Instance::new(&entry, &instance);
                let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
                    .message_severity(
                        vk::DebugUtilsMessageSeverityFlagsEXT::ERROR | vk::DebugUtilsMessageSeverityFlagsEXT::WARNING,
                    )
                    .message_type(
                        vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE,
                    )
                    .pfn_user_callback(Some(collect))
                    .user_data((&raw const *complaints).cast_mut().cast());
                let made = utils.create_debug_utils_messenger(&info, None).unwrap();
                (utils, made)
            });
            let physical_device = instance.enumerate_physical_devices().unwrap()[0];
            let device = make_device(&instance, physical_device, &setup);
            let queue = device.get_device_queue(0, 0);
            let pool_info = vk::CommandPoolCreateInfo::default();
            let pool = device.create_command_pool(&pool_info, None).unwrap();
            Self { setup, entry, instance, physical_device, device, queue, pool, messenger, complaints }
        }
    }

    /// Description of the host for Welkin.
    pub fn desc(&self) -> VulkanHostDesc<'_> {
        let enabled_features = EnabledFeatures {
            core: self.setup.core,
            timeline_semaphore: self.setup.timeline,
            ..EnabledFeatures::default()
        };
        VulkanHostDesc {
            get_instance_proc_addr: Some(self.entry.static_fn().get_instance_proc_addr),
            instance: self.instance.handle(),
            instance_api_version: self.setup.api_version,
            enabled_instance_extensions: &[ash::khr::get_physical_device_properties2::NAME],
            physical_device: self.physical_device,
            device: self.device.handle(),
            enabled_device_extensions: &self.setup.extensions,
            enabled_features,
            queue_family_index: 0,
            queue_index: 0,
            lock_queue: None,
            unlock_queue: None,
            user: std::ptr::null_mut(),
            wanted_features: wgpu::Features::empty(),
        }
    }

    /// Fails if the validation layer has reported anything so far, with its messages.
    pub fn assert_valid(&self) {
        let complaints = self.complaints.0.lock().unwrap();
        assert!(complaints.is_empty(), "{} complaints:\n{}", complaints.len(), complaints.join("\n"));
    }

    /// Whether the validation layer is active.
    pub fn is_validated(&self) -> bool {
        self.messenger.is_some()
    }

    /// Returns the messages so far and clears them.
    pub fn take_complaints(&self) -> Vec<String> {
        std::mem::take(&mut *self.complaints.0.lock().unwrap())
    }

    pub fn image(&self, format: vk::Format, size: (u32, u32), samples: u32, usage: vk::ImageUsageFlags) -> Owned {
        self.layered_image(format, size, (samples, 1), usage)
    }

    /// Creates an image with `samples` samples and `layers` array layers.
    pub fn layered_image(
        &self,
        format: vk::Format,
        size: (u32, u32),
        (samples, layers): (u32, u32),
        usage: vk::ImageUsageFlags,
    ) -> Owned {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width: size.0, height: size.1, depth: 1 })
            .mip_levels(1)
            .array_layers(layers)
            .samples(vk::SampleCountFlags::from_raw(samples))
            .usage(usage);
        // SAFETY: plain Vulkan by its rules.
        unsafe {
            let image = self.device.create_image(&info, self.images().as_ref()).unwrap();
            let needs = self.device.get_image_memory_requirements(image);
            let memory = self.allocate(needs, vk::MemoryPropertyFlags::DEVICE_LOCAL);
            self.device.bind_image_memory(image, memory, 0).unwrap();
            let undefined = vk::ImageLayout::UNDEFINED;
            let image = HostImage {
                image,
                format,
                width: size.0,
                height: size.1,
                samples,
                usage,
                array_layers: layers,
                layer: 0,
                layout: undefined,
                final_layout: undefined,
            };
            Owned { image, memory }
        }
    }

    /// Allocation callbacks that determine the handles of images.
    fn images(&self) -> Option<vk::AllocationCallbacks<'static>> {
        (!self.setup.unique_handles).then(reuse::callbacks)
    }

    fn allocate(&self, needs: vk::MemoryRequirements, flags: vk::MemoryPropertyFlags) -> vk::DeviceMemory {
        // SAFETY: plain Vulkan by its rules.
        unsafe {
            let memory = self.instance.get_physical_device_memory_properties(self.physical_device);
            let fits = |i: u32| {
                let all = memory.memory_types[i as usize].property_flags.contains(flags);
                needs.memory_type_bits & (1 << i) != 0 && all
            };
            let kind = (0..memory.memory_type_count).find(|&i| fits(i)).expect("a memory type");
            let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(kind);
            self.device.allocate_memory(&info, None).unwrap()
        }
    }

    fn buffer(&self, size: u64) -> (vk::Buffer, vk::DeviceMemory) {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: plain Vulkan by its rules.
        unsafe {
            let buffer = self.device.create_buffer(&info, None).unwrap();
            let needs = self.device.get_buffer_memory_requirements(buffer);
            let flags = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
            let memory = self.allocate(needs, flags);
            self.device.bind_buffer_memory(buffer, memory, 0).unwrap();
            (buffer, memory)
        }
    }

    /// Records with `f`, submits with the semaphores given (binary), and waits for the end if `finish`.
    pub fn run(
        &self,
        wait: &[vk::Semaphore],
        signal: &[vk::Semaphore],
        finish: bool,
        f: impl FnOnce(vk::CommandBuffer),
    ) {
        // SAFETY: plain Vulkan by its rules.
        unsafe {
            let info = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
            let commands = self.device.allocate_command_buffers(&info).unwrap()[0];
            self.device.begin_command_buffer(commands, &vk::CommandBufferBeginInfo::default()).unwrap();
            f(commands);
            self.device.end_command_buffer(commands).unwrap();
            let stages = vec![vk::PipelineStageFlags::ALL_COMMANDS; wait.len()];
            let commands = [commands];
            let submit = vk::SubmitInfo::default()
                .wait_semaphores(wait)
                .wait_dst_stage_mask(&stages)
                .signal_semaphores(signal)
                .command_buffers(&commands);
            self.device.queue_submit(self.queue, &[submit], vk::Fence::null()).unwrap();
            if finish {
                self.device.queue_wait_idle(self.queue).unwrap();
            }
        }
    }

    /// Changes a layout, with a barrier against all work before and after it.
    pub fn transition(
        &self,
        commands: vk::CommandBuffer,
        image: &HostImage,
        from: vk::ImageLayout,
        to: vk::ImageLayout,
    ) {
        let access = vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE;
        let barrier = vk::ImageMemoryBarrier::default()
            .image(image.image)
            .old_layout(from)
            .new_layout(to)
            .src_access_mask(access)
            .dst_access_mask(access)
            .subresource_range(range(image));
        let all = vk::PipelineStageFlags::ALL_COMMANDS;
        // SAFETY: plain Vulkan by its rules.
        unsafe {
            let none = vk::DependencyFlags::empty();
            self.device.cmd_pipeline_barrier(commands, all, all, none, &[], &[], &[barrier]);
        }
    }

    /// Clears a colour image and leaves it in `layout`.
    pub fn clear_colour(&self, c: vk::CommandBuffer, image: &HostImage, rgba: [f32; 4], layout: vk::ImageLayout) {
        self.transition(c, image, vk::ImageLayout::UNDEFINED, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        self.fill(c, image, vk::ImageLayout::TRANSFER_DST_OPTIMAL, rgba);
        self.transition(c, image, vk::ImageLayout::TRANSFER_DST_OPTIMAL, layout);
    }

    /// Clears a colour image that is in `layout`, without any barrier.
    pub fn fill(&self, c: vk::CommandBuffer, image: &HostImage, layout: vk::ImageLayout, rgba: [f32; 4]) {
        let value = vk::ClearColorValue { float32: rgba };
        // SAFETY: plain Vulkan by its rules.
        unsafe { self.device.cmd_clear_color_image(c, image.image, layout, &value, &[range(image)]) };
    }

    /// Clears a depth image and leaves it in `layout`.
    pub fn clear_depth(&self, c: vk::CommandBuffer, image: &HostImage, depth: f32, layout: vk::ImageLayout) {
        self.transition(c, image, vk::ImageLayout::UNDEFINED, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        let value = vk::ClearDepthStencilValue { depth, stencil: 0 };
        let range = range(image);
        // SAFETY: plain Vulkan by its rules.
        unsafe {
            let target = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
            self.device.cmd_clear_depth_stencil_image(c, image.image, target, &value, &[range]);
        }
        self.transition(c, image, vk::ImageLayout::TRANSFER_DST_OPTIMAL, layout);
    }

    /// Resolves a multisampled image in `TRANSFER_SRC_OPTIMAL` into a plain one in `TRANSFER_DST_OPTIMAL`.
    pub fn resolve(&self, c: vk::CommandBuffer, from: &HostImage, to: &HostImage) {
        let layer = |image: &HostImage| vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            base_array_layer: image.layer,
            layer_count: 1,
            ..Default::default()
        };
        let region = vk::ImageResolve::default()
            .src_subresource(layer(from))
            .dst_subresource(layer(to))
            .extent(vk::Extent3D { width: from.width, height: from.height, depth: 1 });
        let (source, target) = (vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        // SAFETY: plain Vulkan by its rules.
        unsafe { self.device.cmd_resolve_image(c, from.image, source, to.image, target, &[region]) };
    }

    /// Reads an RGBA8 image that is in `TRANSFER_SRC_OPTIMAL`, after the semaphores given.
    pub fn read(&self, image: &HostImage, wait: &[vk::Semaphore]) -> Vec<[u8; 4]> {
        self.read_texels(image, wait)
    }

    /// Reads an image as [`Self::read`] does, with texels of type `T`.
    pub fn read_texels<T: bytemuck::Pod>(&self, image: &HostImage, wait: &[vk::Semaphore]) -> Vec<T> {
        let pixels = (image.width * image.height) as usize;
        let (buffer, memory) = self.buffer((pixels * size_of::<T>()) as u64);
        self.run(wait, &[], true, |c| {
            let region = vk::BufferImageCopy::default()
                .image_subresource(vk::ImageSubresourceLayers {
                    aspect_mask: aspects(image.format),
                    base_array_layer: image.layer,
                    layer_count: 1,
                    ..Default::default()
                })
                .image_extent(vk::Extent3D { width: image.width, height: image.height, depth: 1 });
            let source = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
            // SAFETY: plain Vulkan by its rules.
            unsafe { self.device.cmd_copy_image_to_buffer(c, image.image, source, buffer, &[region]) };
        });
        // SAFETY: the memory is host-visible and coherent, the copy is done, and the size fits.
        unsafe {
            let at = self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty()).unwrap();
            let out = std::slice::from_raw_parts(at.cast::<T>(), pixels).to_vec();
            self.device.destroy_buffer(buffer, None);
            self.device.free_memory(memory, None);
            out
        }
    }

    /// Fills an image with these texels, rows from the top, and leaves it in `layout`.
    pub fn write_texels<T: bytemuck::Pod>(&self, image: &HostImage, texels: &[T], layout: vk::ImageLayout) {
        assert_eq!(texels.len() as u32, image.width * image.height);
        let (buffer, memory) = self.buffer(size_of_val(texels) as u64);
        // SAFETY: the memory is host-visible and coherent, and the size fits.
        unsafe {
            let at = self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty()).unwrap();
            at.cast::<T>().copy_from_nonoverlapping(texels.as_ptr(), texels.len());
            self.device.unmap_memory(memory);
        }
        let target = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        self.run(&[], &[], true, |c| {
            self.transition(c, image, vk::ImageLayout::UNDEFINED, target);
            let region = vk::BufferImageCopy::default()
                .image_subresource(vk::ImageSubresourceLayers {
                    aspect_mask: aspects(image.format),
                    base_array_layer: image.layer,
                    layer_count: 1,
                    ..Default::default()
                })
                .image_extent(vk::Extent3D { width: image.width, height: image.height, depth: 1 });
            // SAFETY: plain Vulkan by its rules.
            unsafe { self.device.cmd_copy_buffer_to_image(c, buffer, image.image, target, &[region]) };
            self.transition(c, image, target, layout);
        });
        // SAFETY: the queue was waited for.
        unsafe {
            self.device.destroy_buffer(buffer, None);
            self.device.free_memory(memory, None);
        }
    }

    /// A semaphore: binary, or timeline from 0.
    pub fn semaphore(&self, timeline: bool) -> vk::Semaphore {
        let mut kind = vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
        let info = vk::SemaphoreCreateInfo::default();
        let info = if timeline { info.push_next(&mut kind) } else { info };
        // SAFETY: plain Vulkan by its rules.
        unsafe { self.device.create_semaphore(&info, None).unwrap() }
    }

    pub fn destroy_semaphore(&self, semaphore: vk::Semaphore) {
        // SAFETY: plain Vulkan by its rules; the tests wait for the queue first.
        unsafe { self.device.destroy_semaphore(semaphore, None) }
    }

    pub fn destroy_image(&self, owned: Owned) {
        // SAFETY: plain Vulkan by its rules; the tests wait for the queue first.
        unsafe {
            self.device.destroy_image(owned.image.image, self.images().as_ref());
            self.device.free_memory(owned.memory, None);
        }
    }

    /// Destroys the device and lets the validation layer report everything that was left behind on it.
    pub fn finish(self) {
        // SAFETY: plain Vulkan by its rules: no object of the host is in use any more.
        unsafe {
            self.device.destroy_command_pool(self.pool, None);
            self.device.destroy_device(None);
            self.assert_valid();
            if let Some((utils, messenger)) = &self.messenger {
                utils.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}

/// Subresource range of the layer that a description names.
fn range(image: &HostImage) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: aspects(image.format),
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: image.layer,
        layer_count: 1,
    }
}

fn aspects(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D16_UNORM | vk::Format::D32_SFLOAT | vk::Format::X8_D24_UNORM_PACK32 => vk::ImageAspectFlags::DEPTH,
        vk::Format::D24_UNORM_S8_UINT | vk::Format::D32_SFLOAT_S8_UINT => {
            vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL
        }
        _ => vk::ImageAspectFlags::COLOR,
    }
}

/// # Safety
/// The instance and the physical device are live and belong together.
unsafe fn make_device(instance: &ash::Instance, physical: vk::PhysicalDevice, setup: &Setup) -> ash::Device {
    let priorities = [1.0];
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(0).queue_priorities(&priorities)];
    let names: Vec<_> = setup.extensions.iter().map(|n| n.as_ptr()).collect();
    let mut timeline = vk::PhysicalDeviceTimelineSemaphoreFeatures::default().timeline_semaphore(true);
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&names)
        .enabled_features(&setup.core);
    let info = if setup.timeline { info.push_next(&mut timeline) } else { info };
    // SAFETY: the caller vouches for the handles; the chain lives through the call.
    unsafe { instance.create_device(physical, &info, None).expect("a Vulkan device") }
}
