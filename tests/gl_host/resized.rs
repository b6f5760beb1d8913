//! Targets that change their size between the frames of a view: each picture equals that of a view that never had
//! another size.

use std::ptr::{null, null_mut};

use welkin::capi::{device::*, frame::*, status::*, texture::*, view::*};
use welkin::gpu::gl::GlMode;
use welkin_support::{
    c_scene::{
        Scene, frame_of, init, message, ok,
        own::{Own, Size, different, grey_ground, ground_depths, still_frame, wet_scene},
    },
    egl::{Api, Window},
};

use crate::{SIZE, canvas::wet_picture, capi::device, host::Host};

/// Larger, smaller, one pixel, one column, and back.
const SIZES: [Size; 6] = [SIZE, (200, 113), (33, 19), (1, 1), (1, 40), SIZE];

/// Checks that `scene`'s view, which has drawn other sizes, and a new view of the same context draw the same picture.
fn assert_as_new(scene: &Scene, size: Size, mut picture: impl FnMut(*mut wk_view) -> Vec<[u8; 4]>) {
    let got = picture(scene.view);
    let mut view = null_mut();
    // SAFETY: live handles.
    ok(unsafe { wk_view_create(scene.context, null(), &mut view) });
    let wanted = picture(view);
    // SAFETY: a live handle.
    ok(unsafe { wk_view_destroy(view) });
    assert_eq!(different(&got, &wanted, 0), 0, "{size:?}: {:?} {:?}", &got[..1], &wanted[..1]);
    assert!(different(&got, &grey_ground(size), 0) > 0, "{size:?}: nothing is drawn");
}

fn draws_any_size(backends: wk_backend_flags) {
    let mut own = Own::new(backends);
    let scene = wet_scene(own.device);
    for (id, size) in SIZES.into_iter().enumerate() {
        assert_as_new(&scene, size, |view| own.wet_picture(view, id as u64, size, WK_STAGE_ALL, |_, _| ()));
    }
    // Every size is drawn with history too.
    for (id, size) in SIZES.into_iter().enumerate() {
        let color = own.image(WK_FORMAT_RGBA8_UNORM, size, &grey_ground(size));
        let depth = own.image(WK_FORMAT_R32_FLOAT, size, &ground_depths(size));
        let target = wk_own_target { color, depth, ..init("wk_own_target") };
        let frame = wk_frame { target: (&raw const target).cast(), ..frame_of(100 + id as u64, size) };
        // SAFETY: live handles.
        ok(unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) });
    }
    scene.destroy();
    own.destroy();
}

#[test]
fn an_own_vulkan_device_draws_targets_of_any_size_one_after_the_other() {
    draws_any_size(WK_BACKEND_VULKAN);
}

#[test]
fn an_own_opengl_device_draws_targets_of_any_size_one_after_the_other() {
    draws_any_size(WK_BACKEND_GL);
}

#[test]
fn an_opengl_host_draws_targets_of_any_size_one_after_the_other() {
    for (api, mode) in [(Api::Core(3, 3), GlMode::Shared), (Api::Compatibility(4, 5), GlMode::HostContext)] {
        let host = Host::new(api, Window::None, mode);
        let device = device(&host);
        let scene = wet_scene(device);
        for (id, size) in SIZES.into_iter().enumerate() {
            assert_as_new(&scene, size, |view| {
                wet_picture(&host, &Scene { context: scene.context, view }, id as u64, size, WK_STAGE_ALL, |_| ())
            });
        }
        scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
    }
}

#[test]
fn the_largest_target_is_drawn_and_a_larger_one_refused_by_name() {
    for backends in [WK_BACKEND_VULKAN, WK_BACKEND_GL] {
        let mut own = Own::new(backends);
        let mut caps = init::<wk_caps>("wk_caps");
        // SAFETY: live handles.
        ok(unsafe { wk_device_get_caps(own.device, &mut caps) });
        let most = caps.max_texture_size;
        let scene = wet_scene(own.device);
        // The middle of a wide or high picture whose pixels are as large is the small picture.
        for (id, wide) in [true, false].into_iter().enumerate() {
            let (small, large) = if wide { ((64, 4), (most, 4)) } else { ((4, 64), (4, most)) };
            let mut view = null_mut();
            // SAFETY: live handles.
            ok(unsafe { wk_view_create(scene.context, null(), &mut view) });
            let [a, b] = [(scene.view, small), (view, large)].map(|(view, size): (_, Size)| {
                let mut frame = still_frame(id as u64, (64, 64));
                frame.projection[0] *= 64.0 / f64::from(size.0);
                frame.projection[5] *= 64.0 / f64::from(size.1);
                let color = own.image(WK_FORMAT_RGBA8_UNORM, size, &vec![[0_u8; 4]; (size.0 * size.1) as usize]);
                let target = wk_own_target { color, ..init("wk_own_target") };
                let frame = wk_frame { target: (&raw const target).cast(), ..frame };
                // SAFETY: live handles.
                ok(unsafe { wk_view_record(view, &frame, WK_STAGE_ALL & !WK_STAGE_PARTICLES) });
                own.read::<[u8; 4]>(color, size)
            });
            // SAFETY: a live handle.
            ok(unsafe { wk_view_destroy(view) });
            let first = |x: u32| if x == most { (most - 64) / 2 } else { 0 };
            let at = |x: u32, y: u32| b[((y + first(large.1)) * large.0 + x + first(large.0)) as usize];
            let middle: Vec<_> = (0..small.1).flat_map(|y| (0..small.0).map(move |x| at(x, y))).collect();
            assert_eq!(different(&a, &middle, 2), 0, "{backends} {wide}: {:?} {:?}", a[0], middle[0]);
        }
        let mut none = null_mut();
        for (width, height, name) in [(most + 1, 1, "desc.width"), (1, most + 1, "desc.height"), (0, 1, "desc.width")] {
            let desc = wk_texture_desc { width, height, ..init("wk_texture_desc") };
            // SAFETY: live pointers.
            let status = unsafe { wk_texture_create(own.device, &desc, &mut none) };
            assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{}", message());
            assert!(message().contains(&format!("{name} must be in [1, {most}] pixels")), "{}", message());
            assert!(none.is_null());
        }
        scene.destroy();
        own.destroy();
    }
}
