//! Images of surface classes and normals of an OpenGL host: the picture that an own device draws with them.

use welkin::capi::device::*;
use welkin::gpu::gl::GlMode;

use crate::c_scene::{
    assert_same,
    marks::{classes, half_normals, own_pictures, packed_normals},
    ok,
    own::wet_scene,
};
use crate::{
    SIZE,
    canvas::{filled, wet_picture},
    capi::{device, image},
    egl::{Api, Window},
    host::Host,
    images::image_of,
};

#[test]
fn classes_and_normals_of_an_opengl_host_are_those_of_an_own_device() {
    let wanted = own_pictures(SIZE);
    for (api, mode) in [
        (Api::Core(3, 3), GlMode::Shared),
        (Api::Es(3, 1), GlMode::Shared),
        (Api::Core(4, 5), GlMode::HostContext),
        (Api::Compatibility(4, 5), GlMode::HostContext),
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
            (None, None, 0),
            (Some(marks), None, 1),
            (Some(coloured), None, 1),
            (None, Some(halves), 2),
            (None, Some(packed), 2),
            (Some(marks), Some(halves), 3),
        ];
        for (i, (marks, normals, which)) in said.into_iter().enumerate() {
            let got = wet_picture(&host, &scene, 1 + i as u64, SIZE, |target| {
                if let Some(marks) = marks {
                    target.surface_classes = image(image_of(marks));
                }
                if let Some(normals) = normals {
                    target.normals = image(image_of(normals));
                }
            });
            println!("{api:?} {mode:?}: {i}");
            assert_same(&got, &wanted[which], 4);
        }
        scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
    }
}
