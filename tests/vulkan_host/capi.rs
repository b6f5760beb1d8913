//! A Vulkan host through the C functions: it gets the same picture as a device of Welkin's own, and error messages name
//! its mistakes.

use std::ffi::c_void;
use std::ptr::null_mut;

use ash::vk::{self, Handle};
use welkin::capi::{device::*, environment::*, frame::*, status::*, veil::*, view::*, vulkan::*};
use welkin_support::c_scene::{Scene, assert_same, init, message, ok, own_picture};

use crate::host::{Host, Owned, Setup};
use crate::{Picture, SIZE, frame};

fn desc(host: &Host) -> wk_vulkan_host_desc {
    let at = |raw: u64| raw as usize as *mut c_void;
    type GetProc = unsafe extern "system" fn(*mut c_void, *const std::ffi::c_char) -> *mut c_void;
    // SAFETY: both take (instance, name) and return a function pointer.
    let get = unsafe {
        std::mem::transmute::<vk::PFN_vkGetInstanceProcAddr, GetProc>(host.desc().get_instance_proc_addr.unwrap())
    };
    wk_vulkan_host_desc {
        get_instance_proc_addr: Some(get),
        instance: at(host.instance.handle().as_raw()),
        physical_device: at(host.physical_device.as_raw()),
        device: at(host.device.handle().as_raw()),
        instance_api_version: host.setup.api_version,
        ..init("wk_vulkan_host_desc")
    }
}

pub fn device(host: &Host) -> *mut wk_device {
    // The part of the host's VkDeviceCreateInfo that Welkin reads.
    let mut timeline = vk::PhysicalDeviceTimelineSemaphoreFeatures::default().timeline_semaphore(host.setup.timeline);
    let features = vk::PhysicalDeviceFeatures2::default().features(host.setup.core).push_next(&mut timeline);
    let names = [ash::khr::get_physical_device_properties2::NAME.as_ptr()];
    let desc = wk_vulkan_host_desc {
        enabled_features: (&raw const features).cast(),
        enabled_instance_extensions: names.as_ptr(),
        instance_extension_count: 1,
        ..desc(host)
    };
    let mut device = null_mut();
    // SAFETY: the description is true and the host outlives the device.
    ok(unsafe { wk_device_create_vulkan(&desc, &mut device) });
    device
}

pub fn image(owned: &Owned, layout: vk::ImageLayout, final_layout: vk::ImageLayout) -> wk_vulkan_image {
    let i = &owned.image;
    wk_vulkan_image {
        image: i.image.as_raw(),
        format: i.format.as_raw() as u32,
        width: i.width,
        height: i.height,
        samples: i.samples,
        usage: i.usage.as_raw(),
        layout: layout.as_raw() as u32,
        final_layout: final_layout.as_raw() as u32,
        ..init("wk_vulkan_image")
    }
}

#[test]
fn c_hosts_get_the_same_picture_and_their_layouts_and_semaphores() {
    use vk::ImageLayout as L;
    let host = Host::new(Setup::modern());
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let device = device(&host);
    let scene = Scene::new(device);
    let (ready, done) = (host.semaphore(false), host.semaphore(true));
    let (depth, last) = (0.001, 1);
    for frame_id in 0..=last {
        picture.clear(&host, depth, [L::GENERAL, L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL], &[ready]);
        let color = image(&picture.colour, L::GENERAL, L::TRANSFER_SRC_OPTIMAL);
        let depths = image(&picture.depth, L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL, L::GENERAL);
        let wait = wk_vulkan_semaphore { semaphore: ready.as_raw(), ..init("wk_vulkan_semaphore") };
        let signal = wk_vulkan_semaphore {
            semaphore: done.as_raw(),
            value: frame_id + 1,
            kind: WK_VULKAN_SEMAPHORE_TIMELINE,
            ..init("wk_vulkan_semaphore")
        };
        let target = wk_vulkan_target {
            color: &color,
            depth: &depths,
            wait_semaphores: &wait,
            wait_count: 1,
            signal_semaphores: &signal,
            signal_count: 1,
            ..init("wk_vulkan_target")
        };
        let frame = wk_frame { frame_id, target: (&raw const target).cast(), ..frame(7) };
        // SAFETY: live handles, truly described.
        ok(unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) });
        let info = vk::SemaphoreWaitInfo::default().semaphores(std::slice::from_ref(&done));
        let values = [frame_id + 1];
        // SAFETY: plain Vulkan by its rules.
        unsafe { host.device.wait_semaphores(&info.values(&values), 10_000_000_000).expect("signalled") };
    }
    assert_same(&host.read(&picture.colour.image, &[]), &own_picture(SIZE, depth, last), 1);
    scene.destroy();
    // SAFETY: live handles.
    unsafe {
        ok(wk_device_forget_vulkan_image(device, picture.colour.image.image.as_raw()));
        ok(wk_device_destroy(device));
    }
    host.assert_valid();
    host.destroy_semaphore(ready);
    host.destroy_semaphore(done);
    picture.destroy(&host);
    host.finish();
}

#[test]
fn what_a_c_host_has_wrong_is_named_as_in_the_header() {
    use vk::ImageLayout as L;
    let host = Host::new(Setup::modern());
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let device = device(&host);
    let scene = Scene::new(device);
    let good = image(&picture.colour, L::UNDEFINED, L::GENERAL);
    let record = |target: &wk_vulkan_target| {
        let frame = wk_frame { target: std::ptr::from_ref(target).cast(), ..frame(7) };
        // SAFETY: live handles; Welkin finds the mistake before it uses the value.
        (unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) }, message())
    };
    let none = init::<wk_vulkan_semaphore>("wk_vulkan_semaphore");
    type Change = fn(&mut wk_vulkan_image);
    let images: [(&str, Change); 6] = [
        ("frame.target.color.image must be a live VkImage", |i| i.image = 0),
        ("frame.target.color.width must be in [1,", |i| i.width = 0),
        ("frame.target.color.samples must be 1, 2, 4 or 8", |i| i.samples = 3),
        ("frame.target.color.format must be a colour format", |i| i.format = vk::Format::D32_SFLOAT.as_raw() as u32),
        (
            "frame.target.color.final_layout must not be VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, which is for depth images",
            |i| {
                i.final_layout = L::DEPTH_ATTACHMENT_OPTIMAL.as_raw() as u32;
            },
        ),
        ("frame.target.color.layer must be below array_layers (2)", |i| (i.array_layers, i.layer) = (2, 2)),
    ];
    for (wanted, change) in images {
        let mut color = good;
        change(&mut color);
        let (status, text) = record(&wk_vulkan_target { color: &color, ..init("wk_vulkan_target") });
        assert!(status < 0 && text.contains(wanted), "{wanted}: {text}");
    }
    let many = vec![none; 17];
    let semaphores = [
        ("frame.target.wait_count must be at most 16, got 17", 17, size_of::<wk_vulkan_semaphore>()),
        ("frame.target.wait_stride must be", 1, 4),
        ("frame.target.wait_semaphores[0].semaphore must be a live VkSemaphore", 1, size_of::<wk_vulkan_semaphore>()),
    ];
    for (wanted, count, stride) in semaphores {
        let target = wk_vulkan_target {
            color: &good,
            wait_semaphores: many.as_ptr(),
            wait_count: count,
            wait_stride: stride as u32,
            ..init("wk_vulkan_target")
        };
        let (status, text) = record(&target);
        assert!(status == WK_ERROR_INVALID_ARGUMENT && text.contains(wanted), "{wanted}: {text}");
    }
    let mut second = null_mut();
    // SAFETY: live handles.
    unsafe {
        assert_eq!(wk_device_create_vulkan(&desc(&host), &mut second), WK_ERROR_ALREADY_WRAPPED);
        let wrong = wk_vulkan_host_desc { device: null_mut(), ..desc(&host) };
        assert_eq!(wk_device_create_vulkan(&wrong, &mut second), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("desc.device must be"), "{}", message());
        assert!(second.is_null());
        scene.destroy();
        ok(wk_device_destroy(device));
    }
    picture.destroy(&host);
    host.finish();
}

#[test]
fn the_veil_is_an_image_that_the_hosts_shaders_may_read() {
    use vk::ImageLayout as L;
    let host = Host::new(Setup::modern());
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let device = device(&host);
    let scene = Scene::new(device);
    let mut veil = init::<wk_frame_textures>("wk_frame_textures");
    let mut map = init::<wk_environment>("wk_environment");
    picture.clear(&host, 0.001, [L::GENERAL, L::GENERAL], &[]);
    let color = image(&picture.colour, L::GENERAL, L::GENERAL);
    let depth = image(&picture.depth, L::GENERAL, L::GENERAL);
    let target = wk_vulkan_target { color: &color, depth: &depth, ..init("wk_vulkan_target") };
    // SAFETY: live handles.
    unsafe {
        ok(wk_view_get_frame_textures(scene.view, &mut veil));
        ok(wk_view_get_environment(scene.view, &mut map));
        for id in 0..3 {
            let frame = wk_frame { frame_id: id, target: (&raw const target).cast(), ..frame(7) };
            ok(wk_view_record(scene.view, &frame, WK_STAGE_ALL));
        }
        let before = (veil.light, veil.through);
        ok(wk_view_get_frame_textures(scene.view, &mut veil));
        assert_eq!((veil.light, veil.through), before, "they stay the same");
        assert!(veil.light != 0 && veil.light != veil.through && veil.light_scale > 0.0);
        let before = map.texture;
        ok(wk_view_get_environment(scene.view, &mut map));
        assert!(map.texture == before && before != 0 && map.cd_m2_per_unit > 0.0);
    }
    // The host copies a texel out of it, from the layout that the header promises; the validation layer watches.
    let light = vk::Image::from_raw(veil.light);
    let size = (veil.width, veil.height);
    let out = host.image(vk::Format::R16G16B16A16_SFLOAT, size, 1, vk::ImageUsageFlags::TRANSFER_DST);
    host.run(&[], &[], true, |c| {
        let promised = welkin::gpu::vulkan::HostImage { image: light, ..out.image };
        host.transition(c, &promised, L::SHADER_READ_ONLY_OPTIMAL, L::TRANSFER_SRC_OPTIMAL);
        host.transition(c, &promised, L::TRANSFER_SRC_OPTIMAL, L::SHADER_READ_ONLY_OPTIMAL);
        // The cube map, all faces and levels.
        for [from, to] in [
            [L::SHADER_READ_ONLY_OPTIMAL, L::TRANSFER_SRC_OPTIMAL],
            [L::TRANSFER_SRC_OPTIMAL, L::SHADER_READ_ONLY_OPTIMAL],
        ] {
            let whole = vk::ImageSubresourceRange {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                level_count: map.level_count,
                layer_count: 6,
                ..Default::default()
            };
            let access = vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE;
            let barrier = vk::ImageMemoryBarrier::default()
                .image(vk::Image::from_raw(map.texture))
                .old_layout(from)
                .new_layout(to)
                .src_access_mask(access)
                .dst_access_mask(access)
                .subresource_range(whole);
            let (all, none) = (vk::PipelineStageFlags::ALL_COMMANDS, vk::DependencyFlags::empty());
            // SAFETY: plain Vulkan by its rules.
            unsafe { host.device.cmd_pipeline_barrier(c, all, all, none, &[], &[], &[barrier]) };
        }
    });
    // SAFETY: live handles.
    unsafe {
        let frame = wk_frame { frame_id: 9, target: (&raw const target).cast(), ..frame(7) };
        ok(wk_view_record(scene.view, &frame, WK_STAGE_ALL));
        scene.destroy();
        ok(wk_device_destroy(device));
    }
    host.assert_valid();
    host.destroy_image(out);
    picture.destroy(&host);
    host.finish();
}
