//! Images that a host may hand over: any layer of an array, a resolved picture with a multisampled depth, and new
//! images with the handles of destroyed ones. All draw rain, wet ground, fog and air.

use ash::vk::{self, Handle};
use welkin::capi::{device::*, frame::*, status::*, view::*, vulkan::*};
use welkin::gpu::vulkan::HostImage;
use welkin_support::c_scene::{Scene, ground, init, message, ok};

use crate::capi::{device, image};
use crate::host::{Host, Owned, Setup};
use crate::{SIZE, assert_all, frame};

const COLOUR: vk::Format = vk::Format::R8G8B8A8_UNORM;
/// Depth of ground 40 m away, 2 m below the eye: reversed depth with the near plane at 0.1 m.
const DEPTH: f32 = 0.0025;
/// Colour that the host draws.
const BLUE: [f32; 4] = [0.0, 0.0, 0.5, 1.0];

fn usages() -> [vk::ImageUsageFlags; 2] {
    use vk::ImageUsageFlags as U;
    let transfer = U::TRANSFER_SRC | U::TRANSFER_DST;
    [U::COLOR_ATTACHMENT | transfer, U::DEPTH_STENCIL_ATTACHMENT | U::SAMPLED | transfer]
}

/// Colour and depth images of the given samples and layers, cleared by the host.
fn pair(host: &Host, [of_colour, of_depth]: [u32; 2], layers: u32) -> [Owned; 2] {
    let [colour, depth] = usages();
    let colour = host.layered_image(COLOUR, SIZE, (of_colour, layers), colour);
    let depth = host.layered_image(vk::Format::D32_SFLOAT, SIZE, (of_depth, layers), depth);
    host.run(&[], &[], true, |c| {
        for layer in 0..layers {
            let general = vk::ImageLayout::GENERAL;
            host.clear_colour(c, &HostImage { layer, ..colour.image }, BLUE, general);
            host.clear_depth(c, &HostImage { layer, ..depth.image }, DEPTH, general);
        }
    });
    [colour, depth]
}

/// Creates a view of rain, an area of heavier rain, a roof, and water on a terrain.
fn rainy(device: *mut wk_device) -> Scene {
    let scene = ground::scene(device);
    ground::set_grid(&scene, [9, 6]);
    ground::rain(&scene, 12.0, 0.0, 900.0);
    scene
}

/// Records all stages on a layer of the pair; the images stay in the layout GENERAL.
fn record(scene: &Scene, frame_id: u64, [colour, depth]: &[Owned; 2], layer: u32) -> wk_status {
    let general = vk::ImageLayout::GENERAL;
    let layered = |owned: &Owned| wk_vulkan_image {
        array_layers: owned.image.array_layers,
        layer,
        ..image(owned, general, general)
    };
    let (color, depth) = (layered(colour), layered(depth));
    let target = wk_vulkan_target { color: &color, depth: &depth, ..init("wk_vulkan_target") };
    let frame = wk_frame { target: (&raw const target).cast(), ..frame(frame_id) };
    // SAFETY: live handles, truly described.
    unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) }
}

/// One layer of the colour, which is in the layout GENERAL, resolved if it has several samples.
fn pixels(host: &Host, colour: &Owned, layer: u32) -> Vec<[u8; 4]> {
    use vk::ImageLayout as L;
    let from = HostImage { layer, ..colour.image };
    let one = host.image(COLOUR, SIZE, 1, usages()[0]);
    host.run(&[], &[], true, |c| {
        host.transition(c, &from, L::GENERAL, L::TRANSFER_SRC_OPTIMAL);
        if from.samples > 1 {
            host.transition(c, &one.image, L::UNDEFINED, L::TRANSFER_DST_OPTIMAL);
            host.resolve(c, &from, &one.image);
            host.transition(c, &one.image, L::TRANSFER_DST_OPTIMAL, L::TRANSFER_SRC_OPTIMAL);
        }
    });
    let read = host.read(if from.samples > 1 { &one.image } else { &from }, &[]);
    host.run(&[], &[], true, |c| host.transition(c, &from, L::TRANSFER_SRC_OPTIMAL, L::GENERAL));
    host.destroy_image(one);
    read
}

/// Picture of a frame on plain images of one sample, drawn by its own view.
fn plain(host: &Host, device: *mut wk_device, frame_id: u64) -> Vec<[u8; 4]> {
    let images = pair(host, [1, 1], 1);
    let scene = rainy(device);
    ok(record(&scene, frame_id, &images, 0));
    let seen = pixels(host, &images[0], 0);
    assert!(seen.iter().any(|p| *p != seen[0]) && seen.iter().all(|p| p[..3] != [0, 0, 128]), "weather everywhere");
    scene.destroy();
    forget(device, &images);
    images.into_iter().for_each(|i| host.destroy_image(i));
    seen
}

fn forget(device: *mut wk_device, images: &[Owned]) {
    for i in images {
        // SAFETY: a live device.
        ok(unsafe { wk_device_forget_vulkan_image(device, i.image.image.as_raw()) });
    }
}

fn finish(host: Host, device: *mut wk_device, images: Vec<Owned>) {
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
    host.assert_valid();
    images.into_iter().for_each(|i| host.destroy_image(i));
    host.finish();
}

#[test]
fn any_layer_is_drawn_and_the_others_stay() {
    let host = Host::new(Setup::sampling());
    let device = device(&host);
    let wanted = [0, 1].map(|id| plain(&host, device, id));
    for samples in [1, 4] {
        let eyes = pair(&host, [samples; 2], 3);
        // One view for each eye, on layers 2 and 0; no view uses layer 1.
        let scenes = [rainy(device), rainy(device)];
        for (id, wanted) in wanted.iter().enumerate() {
            for (scene, layer) in scenes.iter().zip([2, 0]) {
                host.run(&[], &[], true, |c| {
                    host.clear_colour(c, &HostImage { layer, ..eyes[0].image }, BLUE, vk::ImageLayout::GENERAL);
                });
                ok(record(scene, id as u64, &eyes, layer));
                // Several samples of the same colour and depth give the picture of one sample, except for rounding.
                for (got, wanted) in pixels(&host, &eyes[0], layer).iter().zip(wanted) {
                    let most = u8::from(samples > 1);
                    assert!(
                        got.iter().zip(wanted).all(|(a, b)| a.abs_diff(*b) <= most),
                        "{samples}: {got:?} {wanted:?}"
                    );
                }
                let others = [0, 1, 2].into_iter().filter(|l| id == 0 && *l != layer && !(layer == 0 && *l == 2));
                others.for_each(|l| assert_all(&pixels(&host, &eyes[0], l), [0, 0, 128, 255]));
            }
        }
        // A view that drew one layer can draw another too.
        let before = pixels(&host, &eyes[0], 2);
        ok(record(&scenes[0], 9, &eyes, 1));
        assert_eq!(pixels(&host, &eyes[0], 2), before);
        assert!(pixels(&host, &eyes[0], 1).iter().all(|p| p[..3] != [0, 0, 128]));
        scenes.into_iter().for_each(Scene::destroy);
        forget(device, &eyes);
        eyes.into_iter().for_each(|i| host.destroy_image(i));
    }
    finish(host, device, Vec::new());
}

#[test]
fn a_resolved_picture_may_have_multisampled_depth() {
    // These images need no feature.
    let host = Host::new(Setup::modern());
    let device = device(&host);
    let resolved = pair(&host, [1, 4], 1);
    let scene = rainy(device);
    ok(record(&scene, 0, &resolved, 0));
    assert_eq!(pixels(&host, &resolved[0], 0), plain(&host, device, 0));
    scene.destroy();
    finish(host, device, resolved.into());
}

#[test]
fn an_image_is_not_read_while_it_is_drawn_into() {
    let host = Host::new(Setup::modern());
    let device = device(&host);
    let scene = Scene::new(device);
    let colour = host.image(COLOUR, SIZE, 1, usages()[0] | vk::ImageUsageFlags::SAMPLED);
    let general = vk::ImageLayout::GENERAL;
    let (color, mask) = (image(&colour, general, general), image(&colour, general, general));
    let target = wk_vulkan_target { color: &color, mask: &mask, ..init("wk_vulkan_target") };
    let frame = wk_frame { target: (&raw const target).cast(), ..frame(2) };
    // SAFETY: live handles, truly described.
    let status = unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) };
    let wanted = "frame.target.mask.image must be another image or layer than frame.target.color";
    assert!(status == WK_ERROR_INVALID_ARGUMENT && message().contains(wanted), "{}", message());
    scene.destroy();
    finish(host, device, vec![colour]);
}

#[test]
fn depth_of_fewer_samples_than_colour_is_refused_with_what_to_do() {
    let host = Host::new(Setup::sampling());
    let device = device(&host);
    let scene = rainy(device);
    let images = pair(&host, [4, 1], 1);
    assert_eq!(record(&scene, 0, &images, 0), WK_ERROR_INVALID_ARGUMENT);
    let text = message();
    assert!(text.contains("frame.target.depth.samples must be those of color, 4, or color resolved"), "{text}");
    scene.destroy();
    finish(host, device, images.into());
}

/// Environment variable that is set in a process with only one test.
const ALONE: &str = "WELKIN_TEST_ALONE";

#[test]
fn images_are_forgotten_after_they_were_destroyed() {
    // The validation layer's unique handles are switched off for a whole process, so this test runs in its own process.
    if std::env::var_os(ALONE).is_some() {
        return forgotten_after_they_were_destroyed();
    }
    let name = "images::images_are_forgotten_after_they_were_destroyed";
    let mut alone = std::process::Command::new(std::env::current_exe().expect("a test program"));
    let output = alone.args(["--exact", name]).env(ALONE, "1").output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("1 passed"), "{said}{}", String::from_utf8_lossy(&output.stderr));
}

fn forgotten_after_they_were_destroyed() {
    let host = Host::new(Setup { unique_handles: false, ..Setup::modern() });
    let device = device(&host);
    let scene = rainy(device);
    let old = pair(&host, [1, 1], 1);
    ok(record(&scene, 0, &old, 0));
    let wanted = pixels(&host, &old[0], 0);
    assert!(wanted.iter().all(|p| p[..3] != [0, 0, 128]), "weather everywhere");
    // As when an engine rebuilds its swapchain in one call: old images are destroyed, new ones created, and only then
    // is Welkin informed.
    old.iter().rev().for_each(|i| host.destroy_image(*i));
    let new = pair(&host, [1, 1], 1);
    assert_eq!(new[0].image.image, old[0].image.image, "the driver gives a number twice");
    forget(device, &old);
    ok(record(&scene, 1, &new, 0));
    for (got, wanted) in pixels(&host, &new[0], 0).iter().zip(&wanted) {
        assert!(got.iter().zip(wanted).all(|(a, b)| a.abs_diff(*b) <= 2), "{got:?} {wanted:?}");
    }
    scene.destroy();
    finish(host, device, new.into());
}

#[test]
fn a_device_with_children_is_not_destroyed() {
    let host = Host::new(Setup::modern());
    let device = device(&host);
    let scene = rainy(device);
    // SAFETY: a live handle.
    assert_eq!(unsafe { wk_device_destroy(device) }, WK_ERROR_IN_USE);
    assert!(message().contains("device has 1 live child"), "{}", message());
    // The refusal has changed nothing: the next frame is drawn.
    let images = pair(&host, [1, 1], 1);
    ok(record(&scene, 0, &images, 0));
    scene.destroy();
    finish(host, device, images.into());
}
