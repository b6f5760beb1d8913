//! Depth of a Vulkan host that is written: the host gets it back in the requested layout with the drawn values in it,
//! and a depth image that was not created for writing is refused by name.

use ash::vk;
use welkin::{
    capi::{device::wk_device_destroy, frame::*, status::*, view::*, vulkan::*},
    gpu::vulkan::{HandOver, HostImage, ImageRole},
};
use welkin_support::{
    c_scene::{Scene, init, message, ok},
    opaque_card::draw_card,
};

use crate::{
    Picture, SIZE, adopted,
    capi::{device, image},
    frame,
    host::{Host, Setup},
};

/// Depths of an image that is ready to be copied from.
fn depths(host: &Host, depth: &HostImage) -> Vec<f32> {
    host.read_texels(depth, &[])
}

#[test]
fn depth_comes_back_written_in_the_layout_asked_for() {
    use vk::ImageLayout as L;
    let host = Host::new(Setup::modern());
    let welkin = adopted(&host);
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    // Each layout is tried twice, the second time on the cached imports.
    for (i, layout) in [L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL, L::GENERAL, L::SHADER_READ_ONLY_OPTIMAL]
        .iter()
        .cycle()
        .take(6)
        .enumerate()
    {
        // The card at 0.5 hides a picture at 0.75, and not one at 0.25.
        let cleared = [0.75, 0.25][i % 2];
        picture.clear(&host, cleared, [L::GENERAL, *layout], &[]);
        let colour = HostImage { layout: L::GENERAL, final_layout: L::TRANSFER_SRC_OPTIMAL, ..picture.colour.image };
        let depth = HostImage { layout: *layout, final_layout: L::TRANSFER_SRC_OPTIMAL, ..picture.depth.image };
        depth.check_written("depth").unwrap();
        // SAFETY: the images are described truly.
        let [target, tested] = unsafe {
            [
                welkin.import("colour", &colour, ImageRole::Colour).unwrap(),
                welkin.import("depth", &depth, ImageRole::Depth).unwrap(),
            ]
        };
        let encoder = draw_card(&welkin.device.device, &target, &tested);
        let images = [(colour, ImageRole::Colour, &target), (depth, ImageRole::Depth, &tested)];
        // SAFETY: as above; this test keeps to the queue contract.
        unsafe { welkin.submit(encoder, &HandOver { images: &images, ..HandOver::default() }) }.unwrap();
        let (colors, written) = (host.read(&colour, &[]), depths(&host, &depth));
        for (at, (color, depth)) in colors.iter().zip(&written).enumerate() {
            // The picture has an odd width: its middle column is left out.
            let column = at as u32 % SIZE.0;
            let shows = column < SIZE.0 / 2 && cleared > 0.5;
            if column != SIZE.0 / 2 {
                assert_eq!((*depth, color[0]), if shows { (0.5, 255) } else { (cleared, 0) }, "{layout:?}, texel {at}");
            }
        }
        host.assert_valid();
    }
    welkin.forget_image(picture.colour.image.image).unwrap();
    welkin.forget_image(picture.depth.image.image).unwrap();
    picture.destroy(&host);
    welkin.close().unwrap();
    host.finish();
}

#[test]
fn a_c_host_may_let_depth_be_written_and_what_it_lacks_is_named() {
    use vk::{ImageLayout as L, ImageUsageFlags as U};
    let host = Host::new(Setup::modern());
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let device = device(&host);
    let scene = Scene::new(device);
    let record = |depth: &wk_vulkan_image, depth_access: wk_depth_access, id: u64| {
        picture.clear(&host, 0.001, [L::GENERAL, L::GENERAL], &[]);
        let color = image(&picture.colour, L::GENERAL, L::TRANSFER_SRC_OPTIMAL);
        let target = wk_vulkan_target { color: &color, depth, ..init("wk_vulkan_target") };
        let frame = wk_frame { target: (&raw const target).cast(), depth_access, ..frame(id) };
        // SAFETY: live handles, truly described.
        unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) }
    };
    let good = image(&picture.depth, L::GENERAL, L::TRANSFER_SRC_OPTIMAL);
    // The first frame's sky is a draft.
    ok(record(&good, WK_DEPTH_ACCESS_READ, 0));
    let pictures = [WK_DEPTH_ACCESS_READ, WK_DEPTH_ACCESS_READ_WRITE].map(|access| {
        ok(record(&good, access, 7));
        // The next frame may have the same number again.
        // SAFETY: live handles.
        ok(unsafe { wk_view_record(scene.view, &frame(8), WK_STAGE_PREPARE) });
        (host.read(&picture.colour.image, &[]), depths(&host, &picture.depth.image))
    });
    let far = pictures[0].0.iter().flatten().zip(pictures[1].0.iter().flatten()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(far <= Some(1), "{far:?} steps");
    assert!(pictures.iter().all(|p| p.1.iter().all(|d| *d == 0.001)));
    let unwritten = host.image(vk::Format::D32_SFLOAT, SIZE, 1, U::SAMPLED | U::TRANSFER_DST | U::TRANSFER_SRC);
    host.run(&[], &[], true, |c| host.transition(c, &unwritten.image, L::UNDEFINED, L::GENERAL));
    let lacking = image(&unwritten, L::GENERAL, L::GENERAL);
    assert_eq!(record(&lacking, WK_DEPTH_ACCESS_READ_WRITE, 9), WK_ERROR_INVALID_ARGUMENT);
    let wanted = "frame.target.depth.usage lacks VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, with which the image must be created";
    assert!(message().contains(wanted), "{}", message());
    scene.destroy();
    // SAFETY: live handles.
    unsafe {
        for owned in [&picture.colour, &picture.depth, &unwritten] {
            ok(wk_device_forget_vulkan_image(device, vk::Handle::as_raw(owned.image.image)));
        }
        ok(wk_device_destroy(device));
    }
    host.assert_valid();
    host.destroy_image(unwritten);
    picture.destroy(&host);
    host.finish();
}
