//! A device that is lost: of Welkin's own on Vulkan and OpenGL, and in an OpenGL host's contexts in both modes.
//! Everything can be destroyed, and a new device draws the same picture.

use glow::HasContext;
use welkin::capi::{device::*, frame::*, status::*, texture::*, view::*};
use welkin::gpu::gl::GlMode;
use welkin_support::{
    c_scene::{
        Scene, init,
        loss::lose_and_ask,
        message, ok,
        own::{Own, wet_scene},
    },
    egl::{Api, Window},
};

use crate::{
    SIZE,
    capi::{device, picture, target},
    frame,
    host::Host,
    images::{framebuffer, image_of, texture},
};

#[test]
fn an_own_device_that_was_lost_is_followed_by_one_that_draws_the_same() {
    for backends in [WK_BACKEND_VULKAN, WK_BACKEND_GL] {
        let pictures = [0, 1].map(|_| {
            let mut own = Own::new(backends);
            let scene = wet_scene(own.device);
            let drawn = own.wet_picture(scene.view, 1, SIZE, WK_STAGE_ALL, |_, _| ());
            let pixels = (SIZE.0 * SIZE.1) as usize;
            let color = own.image(WK_FORMAT_RGBA8_UNORM, SIZE, &vec![[7_u8; 4]; pixels]);
            let target = wk_own_target { color, ..init("wk_own_target") };
            let frame = wk_frame { target: (&raw const target).cast(), ..frame(2) };
            lose_and_ask(own.device, &scene, &frame, false);
            let mut texels = vec![[9_u8; 4]; pixels];
            // SAFETY: live handles with the sizes given.
            unsafe {
                let (data, row) = (texels.as_mut_ptr().cast(), 4 * SIZE.0);
                assert_eq!(wk_texture_read(color, data, 4 * pixels, row), WK_ERROR_DEVICE_LOST, "{}", message());
                assert_eq!(wk_texture_write(color, data, 4 * pixels, row), WK_ERROR_DEVICE_LOST, "{}", message());
            }
            assert!(texels.iter().all(|t| *t == [9; 4]), "after a failure no output was written");
            scene.destroy();
            own.destroy();
            drawn
        });
        assert_eq!(pictures[0], pictures[1]);
    }
}

#[test]
fn an_opengl_host_whose_device_was_lost_goes_on_with_another() {
    for (api, mode) in [
        (Api::Core(3, 3), GlMode::Shared),
        (Api::Es(3, 1), GlMode::Shared),
        (Api::Core(4, 5), GlMode::HostContext),
        (Api::Compatibility(4, 5), GlMode::HostContext),
    ] {
        let host = Host::new(api, Window::None, mode);
        let color = image_of(texture(&host.gl, glow::RGBA8));
        let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
        let fbo = framebuffer(&host.gl, color, Some(depth));
        let target = target(color, depth);
        let mut pictures = Vec::new();
        for _ in 0..3 {
            let device = device(&host);
            let scene = Scene::new(device);
            let _ = picture(&host, &scene, fbo, &target, 0);
            pictures.push(picture(&host, &scene, fbo, &target, 1));
            let frame = wk_frame { target: (&raw const target).cast(), ..frame(2) };
            lose_and_ask(device, &scene, &frame, true);
            assert!(host.contexts.host.is_current());
            scene.destroy();
            // SAFETY: a live handle.
            ok(unsafe { wk_device_destroy(device) });
            assert!(host.contexts.host.is_current());
            // SAFETY: the host's context is current.
            assert_eq!(unsafe { host.gl.get_error() }, glow::NO_ERROR);
        }
        assert!(pictures.iter().all(|p| *p == pictures[0]), "{api:?} {mode:?}");
    }
}
