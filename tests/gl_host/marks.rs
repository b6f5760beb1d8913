//! An OpenGL host's images of surface classes and normals: the picture is the one that a device of Welkin's own draws
//! with them.

use welkin::capi::device::*;
use welkin::gpu::gl::GlMode;
use welkin_support::{
    c_scene::{
        marks::{STAGES, classes, half_normals, own_pictures, packed_normals},
        ok,
        own::{different, wet_scene},
    },
    egl::{Api, Window},
};

use crate::{
    SIZE,
    canvas::{filled, wet_picture},
    capi::{device, image},
    host::Host,
    images::image_of,
};

#[test]
fn classes_and_normals_of_an_opengl_host_are_those_of_an_own_device() {
    let wanted = own_pictures(SIZE);
    for (api, mode, all) in [
        (Api::Core(3, 3), GlMode::Shared, true),
        (Api::Es(3, 1), GlMode::Shared, false),
        (Api::Compatibility(4, 5), GlMode::HostContext, false),
    ] {
        let host = Host::new(api, Window::None, mode);
        let gl = &host.gl;
        let marks = filled(gl, glow::R8, SIZE, &classes(SIZE));
        let coloured: Vec<[u8; 4]> = classes(SIZE).iter().map(|c| [*c, 200, 100, 50]).collect();
        let coloured = filled(gl, glow::RGBA8, SIZE, &coloured);
        let halves = filled(gl, glow::RGBA16F, SIZE, &half_normals(SIZE));
        let packed = filled(gl, glow::RGB10_A2, SIZE, &packed_normals(SIZE));
        let device = device(&host);
        let scene = wet_scene(device);
        let said = [
            (Some(marks), Some(halves), 3),
            (Some(coloured), Some(packed), 3),
            (Some(coloured), None, 1),
            (None, Some(packed), 2),
            (None, None, 0),
        ];
        for (i, (marks, normals, which)) in said.into_iter().enumerate().take(if all { 5 } else { 2 }) {
            let got = wet_picture(&host, &scene, 10 + i as u64, SIZE, STAGES, |target| {
                if let Some(marks) = marks {
                    target.surface_classes = image(image_of(marks));
                }
                if let Some(normals) = normals {
                    target.normals = image(image_of(normals));
                }
            });
            let off = different(&got, &wanted[which], 4);
            assert_eq!(off, 0, "{api:?} {mode:?}, case {i}");
        }
        scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
    }
}
