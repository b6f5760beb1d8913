//! Frames of a Vulkan host. Each call imports the host's images, waits for the host's semaphores, draws, hands the
//! images back and signals.

use std::ffi::{CStr, c_char, c_void};

use ash::vk::{self, Handle};

use super::target::{in_map, target};
use crate::{
    capi::{
        boundary::{
            DeviceCell, Host,
            input::{self, List, Named},
            layout,
            objects::{ContextObject, ViewObject, wk_device},
        },
        device,
        frame::{self, Images, WK_DEPTH_ACCESS_READ_WRITE, in_frame, wk_frame},
        occluder_map::wk_occluder_map,
        vulkan_structs::*,
    },
    error::{Error, Result, Status},
    frame::{ImageLayers, Stages, View},
    gpu::vulkan::{EnabledFeatures, HandOver, HostImage, HostSemaphore, ImageRole, VulkanHost, VulkanHostDesc, adopt},
    rain::OccluderMap,
};

/// Most names in a list of extensions; there are about 400 device extensions.
const MAX_NAMES: usize = 4096;
/// Most semaphores in a list.
const MAX_SEMAPHORES: usize = 16;

type VulkanGetProc = unsafe extern "system" fn(*mut c_void, *const c_char) -> *mut c_void;

/// Creates a device on a Vulkan host.
///
/// # Safety
/// The header's requirements on `wk_vulkan_host_desc`.
pub(in crate::capi) unsafe fn open(c: &wk_vulkan_host_desc) -> Result<*mut wk_device> {
    let raw = |p: *mut c_void| p as usize as u64;
    let instance_count = Named("desc.instance_extension_count", c.instance_extension_count as usize);
    let device_count = Named("desc.device_extension_count", c.device_extension_count as usize);
    // SAFETY: the caller's promise about the lists.
    let (instance_names, device_names) = unsafe {
        (
            names("desc.enabled_instance_extensions", c.enabled_instance_extensions, instance_count)?,
            names("desc.enabled_device_extensions", c.enabled_device_extensions, device_count)?,
        )
    };
    // SAFETY: both types take (instance or NULL, name) and return a function pointer or NULL.
    let get_proc = |f: VulkanGetProc| unsafe { std::mem::transmute::<VulkanGetProc, vk::PFN_vkGetInstanceProcAddr>(f) };
    let desc = VulkanHostDesc {
        get_instance_proc_addr: c.get_instance_proc_addr.map(get_proc),
        instance: vk::Instance::from_raw(raw(c.instance)),
        instance_api_version: c.instance_api_version,
        enabled_instance_extensions: &instance_names,
        physical_device: vk::PhysicalDevice::from_raw(raw(c.physical_device)),
        device: vk::Device::from_raw(raw(c.device)),
        enabled_device_extensions: &device_names,
        // SAFETY: the caller's promise about the chain.
        enabled_features: unsafe { EnabledFeatures::from_chain(c.enabled_features) },
        queue_family_index: c.queue_family_index,
        queue_index: c.queue_index,
        lock_queue: c.lock_queue,
        unlock_queue: c.unlock_queue,
        user: c.user,
        wanted_features: wgpu::Features::empty(),
    };
    // SAFETY: the caller's promise about the handles and the queue.
    let host = unsafe { adopt(&desc) }.map_err(|e| e.map_field(|field| format!("desc.{field}")))?;
    device::issue(host.device.clone(), Host::Vulkan(Box::new(host)))
}

/// Reads a list of extension names.
///
/// # Safety
/// `p` is NULL or points to `count` strings that live as long as `'a`.
unsafe fn names<'a>(param: &str, p: *const *const c_char, count: Named) -> Result<Vec<&'a CStr>> {
    // SAFETY: the caller's promise.
    let list = unsafe { input::slice(param, p, count, MAX_NAMES)? };
    let name = |(i, p): (usize, &*const c_char)| {
        layout::check_pointer(&format_args!("{param}[{i}]"), *p)?;
        // SAFETY: not NULL, and the caller's promise.
        Ok(unsafe { CStr::from_ptr(*p) })
    };
    list.iter().enumerate().map(name).collect()
}

/// Waits until the GPU no longer uses a VkImage, and forgets it.
pub(in crate::capi) fn forget_image(cell: &DeviceCell, image: u64) -> Result<()> {
    match &*cell.host() {
        Host::Vulkan(host) => host.forget_image(vk::Image::from_raw(image)),
        _ => Err(Error::about(Status::Unsupported, "device", "must be a Vulkan host's")),
    }
}

/// Returns the VkImage of a texture.
pub(super) fn native_texture(texture: &wgpu::Texture) -> Result<u64> {
    // SAFETY: the handle is only read.
    let hal = unsafe { texture.as_hal::<wgpu::hal::vulkan::Api>() };
    let lost = || Error::new(Status::DeviceLost, "the device is lost: destroy it and create a new one");
    // SAFETY: as above.
    Ok(unsafe { hal.ok_or_else(lost)?.raw_handle() }.as_raw())
}

/// Image of the host, with the texture through which wgpu uses it.
struct Imported {
    image: HostImage,
    role: ImageRole,
    texture: wgpu::Texture,
}

/// Records a frame into the images of a Vulkan host, and submits it.
///
/// # Safety
/// `c.target` is NULL or a live target struct whose images and semaphores are live and correctly described.
pub(in crate::capi) unsafe fn record(
    host: &VulkanHost,
    object: &ViewObject,
    c: &wk_frame,
    stages: Stages,
) -> Result<()> {
    // SAFETY: the caller's promise, for this and what follows.
    let (imports, target) = unsafe {
        let target = target::<wk_vulkan_target>(c.target)?;
        let imports = [
            import(host, "frame.target.color", target.color, ImageRole::Colour),
            import(host, "frame.target.depth", target.depth, ImageRole::Depth),
            import(host, "frame.target.mask", target.mask, ImageRole::Sampled),
            import(host, "frame.target.surface_classes", target.surface_classes, ImageRole::Sampled),
            import(host, "frame.target.normals", target.normals, ImageRole::Sampled),
        ];
        (imports, target)
    };
    let [color, depth, mask, classes, normals] = all_of(imports)?;
    let read = [("depth", &depth), ("mask", &mask), ("surface_classes", &classes), ("normals", &normals)];
    check_distinct(read, &color)?;
    if let (Some(depth), WK_DEPTH_ACCESS_READ_WRITE) = (&depth, c.depth_access) {
        depth.image.check_written("frame.target.depth")?;
    }
    // SAFETY: as above.
    let (waits, signals) = unsafe {
        (
            semaphores(&waits_of(&target), target.wait_semaphores)?,
            semaphores(&signals_of(&target), target.signal_semaphores)?,
        )
    };
    let layer = |i: &Option<Imported>| i.as_ref().map_or(0, |i| i.image.layer);
    let images = Images {
        layers: ImageLayers {
            color: layer(&color),
            depth: layer(&depth),
            mask: layer(&mask),
            surface_classes: layer(&classes),
            normals: layer(&normals),
        },
        color: color.as_ref().map(|i| &i.texture),
        depth: depth.as_ref().map(|i| &i.texture),
        mask: mask.as_ref().map(|i| &i.texture),
        surface_classes: classes.as_ref().map(|i| &i.texture),
        normals: normals.as_ref().map(|i| &i.texture),
    };
    let frame = frame::from_c(c, images, false)?;
    let gpu = object.cell.gpu();
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("welkin") });
    let mut view = object.lock();
    if view.rehearses() {
        // A rehearsal draws into no image of the host and waits for no semaphore.
        return view.record(&object.context.read(), &frame, stages).map_err(in_frame);
    }
    let recorded = view.recorded_of(frame.frame_id);
    view.record_into(&object.context.read(), &frame, stages, &mut encoder).map_err(in_frame)?;
    let read = sampled(object, &mut view, stages)?;
    let transitions = read.iter().flatten().map(|texture| wgpu::TextureTransition {
        texture,
        selector: None,
        state: wgpu::TextureUses::RESOURCE,
    });
    encoder.transition_resources(std::iter::empty(), transitions);
    let lent: Vec<_> = [&color, &depth, &mask, &classes, &normals]
        .into_iter()
        .flatten()
        .map(|i| (i.image, i.role, &i.texture))
        .collect();
    let over = HandOver { images: &lent, wait: waits.as_slice(), signal: signals.as_slice() };
    // SAFETY: as above; the queue is used by the header's contract.
    unsafe { host.submit(encoder, &over) }
        .inspect_err(|_| view.take_back(recorded))
        .map_err(|e| e.map_field(|field| format!("frame.target.{field}")))
}

/// Returns the textures of the view that `stages` write and that the host's shaders read. The map of the clouds'
/// shadows is among them at any stage.
fn sampled(object: &ViewObject, view: &mut View, stages: Stages) -> Result<[Option<wgpu::Texture>; 4]> {
    let mut read = [const { None }; 4];
    if object.has_veil() && stages.has(Stages::MEDIUM) {
        let veil = view.frame_textures()?;
        (read[0], read[1]) = (Some(veil.light), Some(veil.through));
    }
    if object.has_environment() && stages.has(Stages::BACKGROUND.with(Stages::MEDIUM)) {
        read[2] = Some(view.environment()?.texture);
    }
    if object.has_cloud_shadows() {
        read[3] = Some(view.cloud_shadows()?.texture);
    }
    Ok(read)
}

/// Sets the occluder maps of a context from images of a Vulkan host, and submits the copies.
///
/// # Safety
/// The images of `maps` are live and correctly described.
pub(in crate::capi) unsafe fn set_occluder_maps<'a>(
    host: &VulkanHost,
    object: &ContextObject,
    maps: impl Iterator<Item = &'a wk_occluder_map> + Clone,
) -> Result<()> {
    let mut images = Vec::new();
    for (i, map) in maps.clone().enumerate() {
        let param = format!("maps[{i}].vulkan");
        // SAFETY: the caller's promise.
        let found = unsafe { import(host, &param, map.vulkan, ImageRole::Depth)? };
        let none = || Error::invalid(&*param, "must not be NULL on a Vulkan host's device");
        let found = found.ok_or_else(none)?;
        if found.image.array_layers > 1 {
            let field = format!("{param}.array_layers");
            return Err(Error::about(Status::Unsupported, field, "above 1: hand over an image of one layer"));
        }
        images.push(found);
    }
    let list: Vec<_> =
        maps.zip(&images).map(|(c, i)| OccluderMap { depth: &i.texture, taken: c.taken(false) }).collect();
    let gpu = object.cell.gpu();
    let label = wgpu::CommandEncoderDescriptor { label: Some("occluder maps") };
    let mut encoder = gpu.device.create_command_encoder(&label);
    object.write().record_occluder_maps(&list, &mut encoder).map_err(in_map("vulkan"))?;
    // Several maps may use one image, which must be lent only once.
    let mut lent: Vec<(HostImage, ImageRole, &wgpu::Texture)> = Vec::new();
    for i in &images {
        if lent.iter().all(|l| l.0.image != i.image.image) {
            lent.push((i.image, i.role, &i.texture));
        }
    }
    // SAFETY: as above; the queue is used by the header's contract.
    unsafe { host.submit(encoder, &HandOver { images: &lent, wait: &[], signal: &[] }) }
}

/// Refuses an image that the frame would both read and draw into.
fn check_distinct(read: [(&str, &Option<Imported>); 4], color: &Option<Imported>) -> Result<()> {
    let place = |i: &Imported| (i.image.image, i.image.layer);
    let is_color = |i: &Imported| color.as_ref().is_some_and(|c| place(c) == place(i));
    match read.into_iter().find(|(_, image)| image.as_ref().is_some_and(is_color)) {
        Some((name, _)) => {
            let rest = "must be another image or layer than frame.target.color";
            Err(Error::invalid(format!("frame.target.{name}.image"), rest))
        }
        None => Ok(()),
    }
}

/// Returns the images, or one error that names everything wrong with any of them.
fn all_of<T>(images: [Result<T>; 5]) -> Result<[T; 5]> {
    match images {
        [Ok(color), Ok(depth), Ok(mask), Ok(classes), Ok(normals)] => Ok([color, depth, mask, classes, normals]),
        some => {
            Error::all(some.into_iter().filter_map(Result::err))?;
            Err(Error::new(Status::Internal, "no image is wrong"))
        }
    }
}

/// Imports an image of the host; `None` for NULL.
///
/// # Safety
/// `p` is NULL or a live, correctly described image.
unsafe fn import(
    host: &VulkanHost,
    param: &str,
    p: *const wk_vulkan_image,
    role: ImageRole,
) -> Result<Option<Imported>> {
    if p.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&param, p)? };
    // SAFETY: as above.
    unsafe { layout::check_chain(&param, c.next, &[])? };
    let image = HostImage {
        image: vk::Image::from_raw(c.image),
        format: vk::Format::from_raw(c.format as i32),
        width: c.width,
        height: c.height,
        samples: c.samples,
        usage: vk::ImageUsageFlags::from_raw(c.usage),
        array_layers: c.array_layers,
        layer: c.layer,
        layout: vk::ImageLayout::from_raw(c.layout as i32),
        final_layout: vk::ImageLayout::from_raw(c.final_layout as i32),
    };
    // SAFETY: as above.
    let texture = unsafe { host.import(param, &image, role)? };
    Ok(Some(Imported { image, role, texture }))
}

/// Returns the list of the semaphores to wait for.
fn waits_of(target: &wk_vulkan_target) -> List<'static> {
    List {
        name: "frame.target.wait_semaphores",
        count: Named("frame.target.wait_count", target.wait_count as usize),
        stride: Named("frame.target.wait_stride", target.wait_stride as usize),
        limit: MAX_SEMAPHORES,
    }
}

/// Returns the list of the semaphores to signal.
fn signals_of(target: &wk_vulkan_target) -> List<'static> {
    List {
        name: "frame.target.signal_semaphores",
        count: Named("frame.target.signal_count", target.signal_count as usize),
        stride: Named("frame.target.signal_stride", target.signal_stride as usize),
        limit: MAX_SEMAPHORES,
    }
}

/// List of semaphores on the stack, so that a frame allocates nothing for them.
struct Semaphores {
    list: [HostSemaphore; MAX_SEMAPHORES],
    count: usize,
}

impl Semaphores {
    fn as_slice(&self) -> &[HostSemaphore] {
        &self.list[..self.count]
    }
}

/// Reads a list of semaphores.
///
/// # Safety
/// `p` is NULL or points to the list's structs.
unsafe fn semaphores(list: &List<'_>, p: *const wk_vulkan_semaphore) -> Result<Semaphores> {
    let none = HostSemaphore { semaphore: vk::Semaphore::null(), value: None };
    let mut found = Semaphores { list: [none; MAX_SEMAPHORES], count: 0 };
    let mut take = |i: usize, c: wk_vulkan_semaphore| {
        let timeline = c.kind == WK_VULKAN_SEMAPHORE_TIMELINE;
        let value = timeline.then_some(c.value);
        found.list[i] = HostSemaphore { semaphore: vk::Semaphore::from_raw(c.semaphore), value };
        found.count = i + 1;
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { input::each(list, p, &mut take)? };
    Ok(found)
}
