//! Inputs that would abort the process or break the driver are refused, and the message names them.

use ash::vk::{self, Handle};
use welkin::gpu::vulkan::{HandOver, HostImage, HostSemaphore, ImageRole, VulkanHostDesc, adopt};
use welkin::{Error, Status};

use crate::host::{Host, Setup};
use crate::{Picture, adopted};

fn refused(host: &Host, change: impl FnOnce(&mut VulkanHostDesc<'_>)) -> Error {
    let mut desc = host.desc();
    change(&mut desc);
    // SAFETY: the checks must find the false values of the description before they use them.
    unsafe { adopt(&desc).expect_err("this description must be refused") }
}

fn assert_says(e: &Error, status: Status, words: &[&str]) {
    assert_eq!(e.status, status, "{e}");
    for w in words {
        assert!(e.to_string().contains(w), "\"{e}\" does not say {w}");
    }
}

unsafe extern "C" fn nothing(_: *mut std::ffi::c_void) {}

unsafe extern "system" fn knows_nothing(_: vk::Instance, _: *const std::ffi::c_char) -> vk::PFN_vkVoidFunction {
    None
}

#[test]
fn wrong_handles_are_refused_by_name() {
    let host = Host::new(Setup::modern());
    let bad = Status::InvalidArgument;
    assert_says(&refused(&host, |d| d.get_instance_proc_addr = None), bad, &["get_instance_proc_addr", "NULL"]);
    let e = refused(&host, |d| d.get_instance_proc_addr = Some(knows_nothing));
    assert_says(&e, bad, &["get_instance_proc_addr", "vkDestroyInstance"]);
    assert_says(&refused(&host, |d| d.instance = vk::Instance::null()), bad, &["instance", "VK_NULL_HANDLE"]);
    let e = refused(&host, |d| d.physical_device = vk::PhysicalDevice::null());
    assert_says(&e, bad, &["physical_device", "VK_NULL_HANDLE"]);
    let e = refused(&host, |d| d.physical_device = vk::PhysicalDevice::from_raw(0x1234_5678));
    assert_says(&e, bad, &["physical_device", "vkEnumeratePhysicalDevices"]);
    assert_says(&refused(&host, |d| d.device = vk::Device::null()), bad, &["device", "VK_NULL_HANDLE"]);
    let e = refused(&host, |d| d.queue_family_index = 99);
    assert_says(&e, bad, &["queue_family_index", "99"]);
    let e = refused(&host, |d| d.queue_index = 99);
    assert_says(&e, bad, &["queue_index", "99"]);
    let e = refused(&host, |d| d.lock_queue = Some(nothing));
    assert_says(&e, bad, &["lock_queue", "unlock_queue"]);
    let e = refused(&host, |d| d.instance_api_version = vk::make_api_version(1, 1, 3, 0));
    assert_says(&e, bad, &["instance_api_version"]);
    let e = refused(&host, |d| d.instance_api_version = vk::make_api_version(0, 2, 0, 0));
    assert_says(&e, bad, &["instance_api_version"]);
    host.assert_valid();
    host.finish();
}

#[test]
fn a_queue_has_one_device() {
    let host = Host::new(Setup::modern());
    let welkin = adopted(&host);
    assert_says(&refused(&host, |_| {}), Status::AlreadyWrapped, &["queue"]);
    welkin.close().unwrap();
    adopted(&host).close().unwrap();
    host.finish();
}

#[test]
fn versions_that_would_abort_are_refused() {
    let old = Host::new(Setup::bare(vk::API_VERSION_1_0));
    let bad = Status::InvalidArgument;
    let both =
        ["VK_KHR_maintenance1 and VK_KHR_storage_buffer_storage_class", "apiVersion", "enabled_device_extensions"];
    let e = refused(&old, |_| {});
    assert_says(&e, bad, &both);
    assert_says(&e, bad, &["instance_api_version is 1.0"]);
    // A field that is left at 0 is named first.
    let e = refused(&old, |d| d.instance_api_version = 0);
    assert_says(&e, bad, &both);
    assert!(e.to_string().starts_with("instance_api_version 0 means Vulkan 1.0: say there what the instance's"), "{e}");
    // The message names missing features too, and not the extensions that are already enabled.
    let e = refused(&old, |d| {
        d.enabled_features.timeline_semaphore = true;
        d.enabled_device_extensions = &[ash::khr::maintenance1::NAME];
    });
    assert_says(&e, bad, &["enable VK_KHR_storage_buffer_storage_class on", "VK_KHR_timeline_semaphore"]);
    old.assert_valid();
    old.finish();

    // A host that lists a feature it does not have: the backend would call a function that does not exist, and abort.
    let middle = Host::new(Setup::bare(vk::API_VERSION_1_1));
    let e = refused(&middle, |d| d.enabled_features.timeline_semaphore = true);
    assert_says(&e, Status::InvalidArgument, &["timelineSemaphore", "1.1", "VK_KHR_timeline_semaphore"]);
    let e = refused(&middle, |d| {
        d.enabled_features.timeline_semaphore = true;
        d.enabled_device_extensions = &[ash::khr::timeline_semaphore::NAME];
    });
    assert_says(&e, Status::InvalidArgument, &["vkGetSemaphoreCounterValueKHR, vkWaitSemaphoresKHR"]);
    let e = refused(&middle, |d| {
        d.enabled_features.timeline_semaphore = true;
        d.instance_api_version = vk::API_VERSION_1_3;
    });
    assert_says(&e, Status::InvalidArgument, &["vkGetSemaphoreCounterValue", "1.3"]);
    middle.assert_valid();
    middle.finish();
}

#[test]
fn wgpu_sees_only_what_the_host_enabled() {
    let first_instance = wgpu::Features::INDIRECT_FIRST_INSTANCE;
    let bare = Host::new(Setup::bare(vk::API_VERSION_1_3));
    let welkin = adopted(&bare);
    let features = welkin.device.adapter.features();
    assert!(!features.contains(first_instance), "not enabled by the host: {features:?}");
    assert!(!features.intersects(wgpu::Features::SHADER_F16 | wgpu::Features::SHADER_F64), "{features:?}");
    assert!(!features.intersects(wgpu::Features::TEXTURE_COMPRESSION_BC | wgpu::Features::DUAL_SOURCE_BLENDING));
    welkin.close().unwrap();
    bare.finish();

    let core = vk::PhysicalDeviceFeatures::default().draw_indirect_first_instance(true);
    let host = Host::new(Setup { core, ..Setup::modern() });
    let mut desc = host.desc();
    desc.wanted_features = first_instance | wgpu::Features::SHADER_F64;
    // SAFETY: the description is true and the host outlives the device.
    let welkin = unsafe { adopt(&desc).unwrap() };
    assert!(welkin.device.device.features().contains(first_instance));
    assert!(!welkin.device.device.features().contains(wgpu::Features::SHADER_F64));
    welkin.close().unwrap();
    host.finish();
}

#[test]
fn images_that_do_not_fit_are_refused_by_name() {
    use vk::ImageLayout as L;
    let host = Host::new(Setup::modern());
    let welkin = adopted(&host);
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let good = HostImage { layout: L::GENERAL, final_layout: L::GENERAL, ..picture.colour.image };
    let says = |image: HostImage, role: ImageRole, status: Status, words: &[&str]| {
        // SAFETY: the checks must find the false values of the description before they use them.
        let e = unsafe { welkin.import("colour", &image, role) }.expect_err("this image must be refused");
        assert_says(&e, status, words);
    };
    let (colour, bad) = (ImageRole::Colour, Status::InvalidArgument);
    says(HostImage { image: vk::Image::null(), ..good }, colour, bad, &["colour.image"]);
    says(HostImage { width: 0, ..good }, colour, bad, &["colour.width", "[1, "]);
    says(HostImage { height: 1 << 20, ..good }, colour, bad, &["colour.height"]);
    says(HostImage { samples: 3, ..good }, colour, bad, &["colour.samples", "1, 2, 4 or 8"]);
    says(HostImage { layer: 1, ..good }, colour, bad, &["colour.layer", "array_layers"]);
    says(HostImage { array_layers: 0, ..good }, colour, bad, &["colour.array_layers"]);
    let odd = HostImage { format: vk::Format::R5G6B5_UNORM_PACK16, ..good };
    says(odd, colour, Status::Unsupported, &["colour.format", "R5G6B5"]);
    says(good, ImageRole::Depth, bad, &["colour.format", "depth"]);
    let unused = HostImage { usage: vk::ImageUsageFlags::SAMPLED, ..good };
    says(unused, colour, bad, &["colour.usage", "COLOR_ATTACHMENT"]);
    let shown = HostImage { final_layout: L::PRESENT_SRC_KHR, ..good };
    says(shown, colour, bad, &["colour.final_layout", "VK_IMAGE_LAYOUT_PRESENT_SRC_KHR", "VK_KHR_swapchain"]);
    says(shown, colour, bad, &["enabled_device_extensions of the wk_vulkan_host_desc"]);
    // One message names all that a host with a window forgot.
    let forgetful = HostImage { usage: vk::ImageUsageFlags::COLOR_ATTACHMENT, samples: 4, ..shown };
    let all = ["VK_IMAGE_USAGE_TRANSFER_SRC_BIT", "sampleRateShading", "enabled_features", "VK_KHR_swapchain"];
    says(forgetful, colour, bad, &all);
    says(HostImage { final_layout: L::UNDEFINED, ..good }, colour, bad, &["colour.final_layout", "UNDEFINED"]);
    says(HostImage { layout: L::UNDEFINED, ..good }, ImageRole::Sampled, bad, &["colour.layout"]);
    welkin.close().unwrap();
    picture.destroy(&host);
    host.finish();
}

#[test]
fn semaphores_that_do_not_fit_are_refused_by_name() {
    let host = Host::new(Setup::bare(vk::API_VERSION_1_3));
    let welkin = adopted(&host);
    let binary = host.semaphore(false);
    let submit = |wait: &[HostSemaphore], signal: &[HostSemaphore]| {
        let encoder = welkin.device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        // SAFETY: the checks must find the false values before they use them.
        unsafe { welkin.submit(encoder, &HandOver { wait, signal, ..Default::default() }) }.unwrap_err()
    };
    let null = HostSemaphore { semaphore: vk::Semaphore::null(), value: None };
    let timeline = HostSemaphore { semaphore: binary, value: Some(3) };
    assert_says(&submit(&[null], &[]), Status::InvalidArgument, &["wait_semaphores[0].semaphore", "VK_NULL_HANDLE"]);
    assert_says(&submit(&[], &[timeline]), Status::InvalidArgument, &["signal_semaphores[0]", "timelineSemaphore"]);
    welkin.close().unwrap();
    host.destroy_semaphore(binary);
    host.finish();
}
