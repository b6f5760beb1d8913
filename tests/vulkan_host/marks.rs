//! A Vulkan host's images of surface classes and normals, and targets of other sizes: the picture is the one that a
//! device of Welkin's own draws.

use ash::vk::{self, Handle};
use welkin::capi::{device::*, frame::*, view::*, vulkan::*};
use welkin_support::c_scene::{
    Scene, init,
    marks::{STAGES, classes, half_normals, own_pictures, packed_normals},
    ok,
    own::{Own, Size, different, grey_ground, ground_depths, still_frame, wet_scene},
};

use crate::SIZE;
use crate::capi::{device, image};
use crate::host::{Host, Owned, Setup};

const GENERAL: vk::ImageLayout = vk::ImageLayout::GENERAL;

/// Creates an image that Welkin samples, with these texels.
fn filled<T: bytemuck::Pod>(host: &Host, format: vk::Format, size: Size, texels: &[T]) -> Owned {
    use vk::ImageUsageFlags as U;
    let owned = host.image(format, size, 1, U::SAMPLED | U::TRANSFER_DST);
    host.write_texels(&owned.image, texels, GENERAL);
    owned
}

/// Draws the wet scene on grey ground; `change` may add images to the target.
fn wet_picture(
    host: &Host,
    (device, scene): (*mut wk_device, &Scene),
    frame_id: u64,
    size: Size,
    change: impl FnOnce(&mut wk_vulkan_target),
) -> Vec<[u8; 4]> {
    use vk::ImageUsageFlags as U;
    let transfer = U::TRANSFER_SRC | U::TRANSFER_DST;
    let color = host.image(vk::Format::R8G8B8A8_UNORM, size, 1, U::COLOR_ATTACHMENT | transfer);
    let depth = host.image(vk::Format::D32_SFLOAT, size, 1, U::DEPTH_STENCIL_ATTACHMENT | U::SAMPLED | transfer);
    host.write_texels(&color.image, &grey_ground(size), GENERAL);
    host.write_texels(&depth.image, &ground_depths(size), GENERAL);
    let (c, d) = (image(&color, GENERAL, vk::ImageLayout::TRANSFER_SRC_OPTIMAL), image(&depth, GENERAL, GENERAL));
    let mut target = wk_vulkan_target { color: &c, depth: &d, ..init("wk_vulkan_target") };
    change(&mut target);
    let frame = wk_frame { target: (&raw const target).cast(), ..still_frame(frame_id, size) };
    // SAFETY: live handles, truly described.
    ok(unsafe { wk_view_record(scene.view, &frame, STAGES) });
    let pixels = host.read(&color.image, &[]);
    for owned in [color, depth] {
        // SAFETY: a live device.
        ok(unsafe { wk_device_forget_vulkan_image(device, owned.image.image.as_raw()) });
        host.destroy_image(owned);
    }
    pixels
}

#[test]
fn classes_and_normals_of_a_vulkan_host_are_those_of_an_own_device() {
    let wanted = own_pictures(SIZE);
    let host = Host::new(Setup::modern());
    let device = device(&host);
    let scene = wet_scene(device);
    let coloured: Vec<[u8; 4]> = classes(SIZE).iter().map(|c| [*c, 200, 100, 50]).collect();
    let images = [
        filled(&host, vk::Format::R8_UNORM, SIZE, &classes(SIZE)),
        filled(&host, vk::Format::R8G8B8A8_UNORM, SIZE, &coloured),
        filled(&host, vk::Format::R16G16B16A16_SFLOAT, SIZE, &half_normals(SIZE)),
        filled(&host, vk::Format::A2B10G10R10_UNORM_PACK32, SIZE, &packed_normals(SIZE)),
    ];
    let [marks, coloured, halves, packed] = images.each_ref().map(|i| image(i, GENERAL, GENERAL));
    for (i, (marks, normals)) in [(&marks, &halves), (&coloured, &packed)].into_iter().enumerate() {
        let got = wet_picture(&host, (device, &scene), 10 + i as u64, SIZE, |target| {
            (target.surface_classes, target.normals) = (marks, normals);
        });
        assert_eq!(different(&got, &wanted[3], 4), 0, "case {i}");
    }
    scene.destroy();
    for owned in images {
        // SAFETY: a live device.
        ok(unsafe { wk_device_forget_vulkan_image(device, owned.image.image.as_raw()) });
        host.destroy_image(owned);
    }
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
    host.assert_valid();
    host.finish();
}

#[test]
fn targets_of_any_size_one_after_the_other_show_what_an_own_device_draws() {
    let mut own = Own::new(WK_BACKEND_VULKAN);
    let own_scene = wet_scene(own.device);
    let host = Host::new(Setup::modern());
    let device = device(&host);
    let scene = wet_scene(device);
    for (id, size) in [SIZE, (200, 113), (33, 19), (1, 1), (1, 40), SIZE].into_iter().enumerate() {
        let id = id as u64;
        let wanted = own.wet_picture(own_scene.view, id, size, STAGES, |_, _| ());
        let got = wet_picture(&host, (device, &scene), id, size, |_| ());
        assert_eq!(different(&got, &wanted, 1), 0, "{size:?}");
        assert!(different(&got, &grey_ground(size), 0) > 0, "{size:?}: nothing is drawn");
    }
    own_scene.destroy();
    own.destroy();
    scene.destroy();
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
    host.assert_valid();
    host.finish();
}
