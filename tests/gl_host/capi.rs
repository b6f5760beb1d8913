//! An OpenGL host through the C functions: the same picture as on a device of Welkin's own, in every mode, and objects
//! that are destroyed where no context is current.

use std::ptr::null_mut;

use glow::HasContext;
use welkin::capi::{context::*, device::*, environment::*, frame::*, opengl::*, status::*, veil::*, view::*};
use welkin::gpu::gl::{GlImage, GlMode};
use welkin_support::{
    c_scene::{Scene, assert_same, init, message, ok, own_picture},
    egl::{Api, Window, make_none_current},
};

use crate::{
    SIZE, frame,
    host::{Host, get_proc, make_current},
    images::{framebuffer, image_of, image_of_samples, multisampled_texture, texture},
    kinds::resolved,
};

pub fn device(host: &Host) -> *mut wk_device {
    let shared = host.mode == GlMode::Shared;
    let desc = wk_opengl_host_desc {
        get_proc: Some(get_proc),
        make_current: shared.then_some(make_current as _),
        user: (&raw const *host.contexts).cast_mut().cast(),
        mode: if shared { WK_OPENGL_SHARED } else { WK_OPENGL_HOST_CONTEXT },
        ..init("wk_opengl_host_desc")
    };
    let mut device = null_mut();
    // SAFETY: the callbacks are those of the host, whose contexts outlive the device.
    ok(unsafe { wk_device_create_opengl(&desc, &mut device) });
    device
}

pub fn image(image: GlImage) -> wk_opengl_image {
    let none = wk_opengl_image { kind: WK_OPENGL_NONE, name: 0, target: glow::TEXTURE_2D, reserved0: 0 };
    match image {
        GlImage::Texture { name, target } => wk_opengl_image { kind: WK_OPENGL_TEXTURE, name, target, ..none },
        GlImage::Renderbuffer { name } => wk_opengl_image { kind: WK_OPENGL_RENDERBUFFER, name, ..none },
        GlImage::Framebuffer { name } => wk_opengl_image { kind: WK_OPENGL_FRAMEBUFFER, name, ..none },
    }
}

pub fn target(color: GlImage, depth: GlImage) -> wk_opengl_target {
    wk_opengl_target {
        color: image(color),
        depth: image(depth),
        width: SIZE.0,
        height: SIZE.1,
        ..init("wk_opengl_target")
    }
}

/// Clears blue 0.5 and a depth, draws, and reads; rows from the top.
pub fn picture(host: &Host, scene: &Scene, fbo: glow::Framebuffer, target: &wk_opengl_target, id: u64) -> Vec<[u8; 4]> {
    let gl = &host.gl;
    let frame = wk_frame { target: std::ptr::from_ref(target).cast(), ..frame(id) };
    let mut pixels = vec![[0_u8; 4]; (SIZE.0 * SIZE.1) as usize];
    // SAFETY: the host's context is current, the handles live.
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo));
        gl.clear_color(0.0, 0.0, 128.0 / 255.0, 1.0);
        gl.clear_depth_f32(0.001);
        gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
        ok(wk_view_record(scene.view, &frame, WK_STAGE_ALL));
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo));
        let room = glow::PixelPackData::Slice(Some(pixels.as_flattened_mut()));
        gl.read_pixels(0, 0, SIZE.0 as i32, SIZE.1 as i32, glow::RGBA, glow::UNSIGNED_BYTE, room);
        assert_eq!(gl.get_error(), glow::NO_ERROR);
    }
    let rows: Vec<_> = pixels.chunks_exact(SIZE.0 as usize).rev().flatten().copied().collect();
    rows
}

#[test]
fn c_hosts_get_the_same_picture_in_both_modes() {
    let wanted = own_picture(SIZE, 0.001, 1);
    for (api, mode) in [
        (Api::Core(3, 3), GlMode::Shared),
        (Api::Es(3, 1), GlMode::Shared),
        (Api::Compatibility(4, 5), GlMode::HostContext),
    ] {
        let host = Host::new(api, Window::None, mode);
        let color = image_of(texture(&host.gl, glow::RGBA8));
        let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
        let fbo = framebuffer(&host.gl, color, Some(depth));
        let device = device(&host);
        let scene = Scene::new(device);
        let _ = picture(&host, &scene, fbo, &target(color, depth), 0);
        let got = picture(&host, &scene, fbo, &target(color, depth), 1);
        // Another driver, whose last bits differ.
        assert_same(&got, &wanted, 3);
        scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
    }
}

#[test]
fn what_a_c_host_has_wrong_is_named_as_in_the_header() {
    let host = Host::new(Api::Core(4, 5), Window::None, GlMode::Shared);
    let color = image_of(texture(&host.gl, glow::RGBA8));
    let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
    let device = device(&host);
    let scene = Scene::new(device);
    let record = |change: fn(&mut wk_opengl_target)| {
        let mut target = target(color, depth);
        change(&mut target);
        let frame = wk_frame { target: (&raw const target).cast(), ..frame(7) };
        // SAFETY: live handles; what is wrong is found before it is used.
        (unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) }, message())
    };
    type Change = fn(&mut wk_opengl_target);
    let cases: [(&str, Change); 7] = [
        ("frame.target.color must be", |t| t.color.name = 4711),
        ("frame.target.color must be", |t| t.color.kind = WK_OPENGL_FRAMEBUFFER),
        ("frame.target.color must be given", |t| t.color.kind = WK_OPENGL_NONE),
        ("frame.target.width must be of the size of the color image", |t| t.width = 1),
        ("frame.target.color.kind must be one of WK_OPENGL_NONE", |t| t.color.kind = 9),
        ("frame.target.multisample must be one of", |t| t.multisample = 7),
        ("frame.target.struct_type must be WK_STRUCT_TYPE_OPENGL_TARGET", |t| {
            t.struct_type = WK_STRUCT_TYPE_OWN_TARGET
        }),
    ];
    for (wanted, change) in cases {
        let (status, text) = record(change);
        assert!(status < 0 && text.contains(wanted), "{wanted}: {text}");
    }
    assert_eq!(record(|_| {}).0, WK_OK, "{}", message());
    let mut second = null_mut();
    let again = wk_opengl_host_desc {
        get_proc: Some(get_proc),
        make_current: Some(make_current),
        user: (&raw const *host.contexts).cast_mut().cast(),
        ..init("wk_opengl_host_desc")
    };
    let deaf = wk_opengl_host_desc { get_proc: None, ..again };
    // SAFETY: the host's callbacks.
    unsafe {
        assert_eq!(wk_device_create_opengl(&again, &mut second), WK_ERROR_ALREADY_WRAPPED, "{}", message());
        assert_eq!(wk_device_create_opengl(&deaf, &mut second), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("desc.get_proc must not be NULL"), "{}", message());
        scene.destroy();
        ok(wk_device_destroy(device));
    }
}

/// A status and the message that goes with it.
fn recorded(scene: &Scene, target: &wk_opengl_target, id: u64) -> (i32, String) {
    let frame = wk_frame { target: std::ptr::from_ref(target).cast(), ..frame(id) };
    // SAFETY: live handles and names.
    let status = unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) };
    (status, if status < 0 { message() } else { String::new() })
}

#[test]
fn a_window_of_another_size_than_stated_is_refused() {
    for samples in [0, 4] {
        let host =
            Host::new(Api::Core(3, 3), Window::Pbuffer(SIZE.0 as i32, SIZE.1 as i32, samples), GlMode::HostContext);
        let device = device(&host);
        let scene = Scene::new(device);
        let window = GlImage::Framebuffer { name: 0 };
        let right = target(window, window);
        let with = |width, height| wk_opengl_target { width, height, ..right };
        for id in 0..3 {
            for (width, height, relation) in [
                (SIZE.0 - 1, SIZE.1, "larger"),
                (SIZE.0, SIZE.1 - 1, "larger"),
                (SIZE.0 + 1, SIZE.1, "smaller"),
                (SIZE.0, SIZE.1 + 9, "smaller"),
            ] {
                let (status, text) = recorded(&scene, &with(width, height), id);
                assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{width} x {height}: {text}");
                assert!(text.contains("frame.target.width must be with height the window's size now"), "{text}");
                assert!(text.contains(&format!("{width} x {height} for a {relation} one")), "{text}");
            }
        }
        for id in 3..6 {
            assert_eq!(recorded(&scene, &right, id), (WK_OK, String::new()));
        }
        scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
    }
}

#[test]
fn a_framebuffer_of_another_size_than_stated_is_refused() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::HostContext);
    let device = device(&host);
    let scene = Scene::new(device);
    let color = image_of(texture(&host.gl, glow::RGBA8));
    let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT24));
    let image = GlImage::Framebuffer { name: framebuffer(&host.gl, color, Some(depth)).0.get() };
    let wrong = wk_opengl_target { width: SIZE.0 + 1, ..target(image, image) };
    let (status, text) = recorded(&scene, &wrong, 1);
    assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{text}");
    assert!(text.contains("frame.target.width must be of the size of the color image, 64 x 48"), "{text}");
    assert_eq!(recorded(&scene, &target(image, image), 2), (WK_OK, String::new()));
    scene.destroy();
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
}

/// OpenGL reuses names: an image created anew under an old name is drawn into, whether the host reports that or not,
/// also where a framebuffer of Welkin's held on to the old one; a generation that falls is an error.
#[test]
fn an_image_made_anew_under_its_old_name_is_the_one_drawn_into() {
    // In the compatibility profile a host may choose names itself.
    let host = Host::new(Api::Compatibility(4, 5), Window::None, GlMode::Shared);
    let gl = &host.gl;
    let device = device(&host);
    let scene = Scene::new(device);
    let depth = image_of_samples(multisampled_texture(gl, glow::DEPTH_COMPONENT24, 4));
    let name = multisampled_texture(gl, glow::RGBA8, 4);
    for (id, generation) in [4, 5, 5].into_iter().enumerate() {
        if id > 0 {
            // SAFETY: the host's context is current, and the name is free.
            unsafe {
                gl.bind_texture(glow::TEXTURE_2D_MULTISAMPLE, Some(name));
                let (w, h) = (SIZE.0 as i32, SIZE.1 as i32);
                gl.tex_storage_2d_multisample(glow::TEXTURE_2D_MULTISAMPLE, 4, glow::RGBA8, w, h, true);
                assert_eq!(gl.get_error(), glow::NO_ERROR);
            }
        }
        let color = image_of_samples(name);
        let fbo = framebuffer(gl, color, Some(depth));
        let target = wk_opengl_target { generation, ..target(color, depth) };
        // SAFETY: the host's context is current.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo));
            gl.clear_color(0.0, 0.0, 0.0, 1.0);
            gl.clear_depth_f32(0.001);
            gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
        }
        assert_eq!(recorded(&scene, &target, id as u64), (WK_OK, String::new()));
        let drawn = resolved(gl, fbo);
        assert!(drawn.iter().filter(|p| p[2] > 20).count() > 500, "generation {generation}: {:?}", drawn[0]);
        let older = wk_opengl_target { generation: generation - 1, ..target };
        let (status, text) = recorded(&scene, &older, 100);
        assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{text}");
        assert!(text.contains(&format!("frame.target.generation must be at least {generation}")), "{text}");
        // SAFETY: as above; the name is free for the next one.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, None);
            gl.delete_framebuffer(fbo);
            gl.delete_texture(name);
        }
    }
    scene.destroy();
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
}

#[test]
fn one_image_in_two_roles_is_refused_by_name() {
    let host = Host::new(Api::Core(4, 5), Window::None, GlMode::Shared);
    let device = device(&host);
    let scene = Scene::new(device);
    let color = image_of(texture(&host.gl, glow::RGBA8));
    let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT24));
    let both = target(color, depth);
    for (name, wrong) in [
        ("mask", wk_opengl_target { mask: both.color, ..both }),
        ("depth", wk_opengl_target { depth: both.color, ..both }),
        ("depth", wk_opengl_target { color: both.depth, ..both }),
    ] {
        let (status, text) = recorded(&scene, &wrong, 1);
        assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{text}");
        assert!(text.contains(&format!("frame.target.{name} must be another image than frame.target.color")), "{text}");
    }
    assert_eq!(recorded(&scene, &both, 1), (WK_OK, String::new()));
    scene.destroy();
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
}

#[test]
fn the_veil_has_names_that_the_host_can_bind() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::Shared);
    let color = image_of(texture(&host.gl, glow::RGBA8));
    let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
    let fbo = framebuffer(&host.gl, color, Some(depth));
    let device = device(&host);
    let scene = Scene::new(device);
    let mut veil = init::<wk_frame_textures>("wk_frame_textures");
    // SAFETY: live handles.
    ok(unsafe { wk_view_get_frame_textures(scene.view, &mut veil) });
    let _ = picture(&host, &scene, fbo, &target(color, depth), 1);
    // SAFETY: live handles; the host's context is current.
    unsafe {
        ok(wk_view_get_frame_textures(scene.view, &mut veil));
        let name = |n: u64| glow::NativeTexture(u32::try_from(n).unwrap().try_into().unwrap());
        let mut texels = vec![[0.0_f32; 4]; (veil.width * veil.height) as usize];
        host.gl.bind_texture(glow::TEXTURE_2D, Some(name(veil.through)));
        let room = glow::PixelPackData::Slice(Some(bytes(&mut texels)));
        host.gl.get_tex_image(glow::TEXTURE_2D, 0, glow::RGBA, glow::FLOAT, room);
        assert_eq!(host.gl.get_error(), glow::NO_ERROR);
        // Near the eye the air is clear; everywhere the transmittance is between 0 and 1.
        assert!(texels[0][..3].iter().all(|t| *t > 0.99 && *t <= 1.0), "{:?}", texels[0]);
        assert!(texels.iter().flat_map(|t| &t[..3]).all(|t| (0.0..=1.0).contains(t)));
        assert!(texels.last().unwrap()[2] < texels[0][2], "the far air lets less through");
        scene.destroy();
        ok(wk_device_destroy(device));
    }
}

#[test]
fn the_environment_is_a_cube_map_that_the_host_can_bind() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::Shared);
    let color = image_of(texture(&host.gl, glow::RGBA8));
    let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
    let fbo = framebuffer(&host.gl, color, Some(depth));
    let device = device(&host);
    let scene = Scene::new(device);
    let mut map = init::<wk_environment>("wk_environment");
    // SAFETY: live handles.
    ok(unsafe { wk_view_get_environment(scene.view, &mut map) });
    assert_eq!((map.size, map.level_count, map.cd_m2_per_unit), (64, 7, 0.0));
    let _ = picture(&host, &scene, fbo, &target(color, depth), 1);
    // SAFETY: live handles; the host's context is current.
    unsafe {
        ok(wk_view_get_environment(scene.view, &mut map));
        assert!(map.cd_m2_per_unit > 0.0 && map.light_scale > 0.0);
        let name = glow::NativeTexture(u32::try_from(map.texture).unwrap().try_into().unwrap());
        host.gl.bind_texture(glow::TEXTURE_CUBE_MAP, Some(name));
        for (level, size) in [(0, 64), (3, 8), (6, 1)] {
            let mean = |face: u32| {
                let mut texels = vec![[0.0_f32; 4]; size * size];
                let room = glow::PixelPackData::Slice(Some(bytes(&mut texels)));
                let face = glow::TEXTURE_CUBE_MAP_POSITIVE_X + face;
                host.gl.get_tex_image(face, level, glow::RGBA, glow::FLOAT, room);
                assert_eq!(host.gl.get_error(), glow::NO_ERROR);
                assert!(texels.iter().flatten().all(|v| v.is_finite() && *v >= 0.0), "{face} {level}");
                texels.iter().map(|t| t[2]).sum::<f32>() / (size * size) as f32
            };
            // The blue sky overhead (+Z is up), the ground below.
            let (up, down) = (mean(4), mean(5));
            assert!(up > 0.01 && down > 0.0 && up != down, "level {level}: {up} {down}");
        }
        scene.destroy();
        ok(wk_device_destroy(device));
    }
}

fn bytes(texels: &mut [[f32; 4]]) -> &mut [u8] {
    bytemuck::cast_slice_mut(texels)
}

#[test]
fn objects_destroyed_without_a_context_are_freed_at_the_next_call() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::HostContext);
    let color = image_of(texture(&host.gl, glow::RGBA8));
    let depth = image_of(texture(&host.gl, glow::DEPTH_COMPONENT32F));
    let fbo = framebuffer(&host.gl, color, Some(depth));
    let device = device(&host);
    let (first, second) = (Scene::new(device), Scene::new(device));
    let _ = picture(&host, &first, fbo, &target(color, depth), 0);
    let (view, context) = (first.view as usize, first.context as usize);
    // No context is current on the other thread.
    let elsewhere = std::thread::spawn(move || {
        // SAFETY: live handles.
        unsafe { (wk_view_destroy(view as *mut wk_view), wk_context_destroy(context as *mut wk_context)) }
    });
    assert_eq!(elsewhere.join().unwrap(), (WK_OK, WK_OK));
    let got = picture(&host, &second, fbo, &target(color, depth), 1);
    assert_same(&got, &own_picture(SIZE, 0.001, 1), 3);
    second.destroy();
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
}

#[test]
fn a_device_whose_context_is_gone_is_given_up_without_a_crash() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::HostContext);
    let device = device(&host);
    let scene = Scene::new(device);
    make_none_current();
    drop(host);
    let frame = wk_frame { target: std::ptr::null(), ..frame(3) };
    // SAFETY: live handles.
    unsafe {
        assert!(wk_view_record(scene.view, &frame, WK_STAGE_PREPARE) < 0);
        scene.destroy();
        ok(wk_device_destroy(device));
    }
}
