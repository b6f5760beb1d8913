//! Loss of Welkin's device in a Vulkan host: everything can be destroyed, the host's own device is not harmed, and a
//! new Welkin device draws the same picture.

use ash::vk;
use welkin::capi::{device::*, frame::*, view::*, vulkan::*};
use welkin_support::c_scene::{init, loss::lose_and_ask, ok, own::wet_scene};

use crate::capi::{device, image};
use crate::host::{Host, Setup};
use crate::{Picture, frame};

#[test]
fn a_vulkan_host_whose_device_was_lost_goes_on_with_another() {
    use vk::ImageLayout as L;
    let host = Host::new(Setup::modern());
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let mut pictures = Vec::new();
    for _ in 0..3 {
        let device = device(&host);
        let scene = wet_scene(device);
        picture.clear(&host, 0.001, [L::GENERAL, L::GENERAL], &[]);
        let color = image(&picture.colour, L::GENERAL, L::TRANSFER_SRC_OPTIMAL);
        let depth = image(&picture.depth, L::GENERAL, L::GENERAL);
        let target = wk_vulkan_target { color: &color, depth: &depth, ..init("wk_vulkan_target") };
        let frame = wk_frame { target: (&raw const target).cast(), ..frame(1) };
        // SAFETY: live handles, truly described.
        ok(unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) });
        pictures.push(host.read(&picture.colour.image, &[]));
        lose_and_ask(device, &scene, &wk_frame { frame_id: 2, ..frame }, true);
        scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
    }
    assert!(pictures.iter().all(|p| *p == pictures[0]));
    assert!(pictures[0].iter().any(|p| *p != [0, 0, 128, 255]), "something is drawn");
    host.assert_valid();
    picture.destroy(&host);
    host.finish();
}
