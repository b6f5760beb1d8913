//! Memory that runs out on a Vulkan host: a frame that does not fit is refused with that status, the host's images are
//! unchanged, and frames that fit are drawn as before.

use ash::vk;
use welkin::capi::{device::*, frame::*, status::*, view::*, vulkan::*};
use welkin_support::c_scene::{
    frame_of, init,
    limited::{MIB, in_a_process, is_limited, leave},
    message, ok,
    own::wet_scene,
};

use crate::capi::{device, image};
use crate::host::{Host, Setup};
use crate::{Picture, frame};

#[test]
fn a_frame_that_does_not_fit_is_refused_in_a_vulkan_host() {
    use vk::{ImageLayout as L, ImageUsageFlags as U};
    if !in_a_process("memory::a_frame_that_does_not_fit_is_refused_in_a_vulkan_host") {
        return;
    }
    let host = Host::new(Setup::modern());
    let picture = Picture::new(&host, vk::Format::D32_SFLOAT);
    let device = device(&host);
    if is_limited(device) {
        let scene = wet_scene(device);
        let draw = |frame_id: u64| {
            picture.clear(&host, 0.001, [L::GENERAL, L::GENERAL], &[]);
            let color = image(&picture.colour, L::GENERAL, L::TRANSFER_SRC_OPTIMAL);
            let depth = image(&picture.depth, L::GENERAL, L::GENERAL);
            let target = wk_vulkan_target { color: &color, depth: &depth, ..init("wk_vulkan_target") };
            let flags = frame(frame_id).flags | WK_FRAME_NO_HISTORY;
            let frame = wk_frame { target: (&raw const target).cast(), flags, ..frame(7 + frame_id) };
            // SAFETY: live handles, truly described.
            ok(unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) });
            host.read(&picture.colour.image, &[])
        };
        let before = draw(0);
        let usage = U::COLOR_ATTACHMENT | U::SAMPLED | U::TRANSFER_SRC | U::TRANSFER_DST;
        let large = host.image(vk::Format::R8G8B8A8_UNORM, (8192, 8192), 1, usage);
        host.run(&[], &[], true, |c| host.clear_colour(c, &large.image, [0.0, 0.0, 0.5, 1.0], L::GENERAL));
        let color = image(&large, L::GENERAL, L::GENERAL);
        let target = wk_vulkan_target { color: &color, ..init("wk_vulkan_target") };
        let frame = wk_frame { target: (&raw const target).cast(), ..frame_of(20, (8192, 8192)) };
        leave(Some(200 * MIB));
        // The host may record the frame again, at once or when there is memory.
        for _ in 0..2 {
            // SAFETY: live handles, truly described.
            let status = unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) };
            assert_eq!(status, WK_ERROR_OUT_OF_MEMORY, "{}", message());
        }
        leave(None);
        // SAFETY: live handles.
        unsafe {
            ok(wk_device_get_status(device));
            ok(wk_device_forget_vulkan_image(device, vk::Handle::as_raw(large.image.image)));
        }
        host.destroy_image(large);
        assert_eq!(draw(0), before);
        scene.destroy();
    }
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
    host.assert_valid();
    picture.destroy(&host);
    host.finish();
}
