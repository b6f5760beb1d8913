//! Depth that is written: every kind of image that a host hands over receives the depth drawn into it, and Welkin reads
//! that depth at once.

use glow::HasContext;
use welkin::{
    Status,
    capi::{frame::*, opengl::*, status::*, view::*},
    gpu::{
        HostBinding,
        gl::{GlImage, GlMode, GlTargetDesc, Multisample},
    },
};
use welkin_support::{
    c_scene::{Scene, message, ok},
    egl::{Api, Window},
    opaque_card::draw_card,
};

use crate::{
    capi::{device, picture, target},
    frame,
    host::{Depth, Host, Picture, close},
    images::*,
    kinds::{assert_refused, resolved},
};

/// Depths of the host's image, rows from the bottom; of several samples the first.
fn depths(host: &Host, fbo: Option<glow::Framebuffer>, samples: i32) -> Vec<f32> {
    let gl = &host.gl;
    let mut bytes = vec![0u8; (WIDTH * HEIGHT * 4) as usize];
    let (w, h) = (WIDTH as i32, HEIGHT as i32);
    // SAFETY: the host's context is current and there is room for every texel.
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, fbo);
        if samples > 1 {
            let depth = image_of(texture(gl, glow::DEPTH_COMPONENT24));
            let to = framebuffer(gl, image_of(texture(gl, glow::RGBA8)), Some(depth));
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, fbo);
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(to));
            gl.blit_framebuffer(0, 0, w, h, 0, 0, w, h, glow::DEPTH_BUFFER_BIT, glow::NEAREST);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(to));
        }
        let room = glow::PixelPackData::Slice(Some(&mut bytes));
        gl.read_pixels(0, 0, w, h, glow::DEPTH_COMPONENT, glow::FLOAT, room);
        assert_eq!(gl.get_error(), 0);
    }
    bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

/// Checks the depths and colours of `clear`, with the card in front of their upper left.
fn assert_card(depths: &[f32], reds: &[[u8; 4]]) {
    for (i, (depth, red)) in depths.iter().zip(reds).enumerate() {
        let (left, upper) = (i as u32 % WIDTH < WIDTH / 2, i as u32 / WIDTH >= HEIGHT / 2);
        let (expected, shown) = match (left, upper) {
            (true, true) => (0.5, 255),
            (_, true) => (0.75, 51),
            _ => (0.25, 51),
        };
        assert!(
            (depth - expected).abs() < 1e-4 && red[0] == shown,
            "texel {i}: {depth} {red:?}, not {expected} {shown}"
        );
    }
}

/// Draws the card into a target, draws the depth that Welkin reads into the target's colour, and returns the host's
/// depths.
fn draw_and_look(host: &Host, desc: &GlTargetDesc, copied: bool) -> Vec<f32> {
    let adopted = host.adopt();
    {
        let _current = adopted.host.enter().unwrap();
        let target = adopted.host.target(&adopted.device.device, desc).unwrap();
        let read = target.depth_read.as_ref().unwrap();
        let attached = adopted.host.attached_depth(read).unwrap();
        assert_eq!((Some(&attached.texture), attached.is_copied), (target.depth.as_ref(), copied));
        adopted.device.queue.submit([draw_card(&adopted.device.device, &target.color, &attached.texture).finish()]);
        adopted.host.refresh_depth(read).unwrap();
    }
    let fbo = |image| (image != GlImage::Framebuffer { name: 0 }).then(|| framebuffer(&host.gl, image, desc.depth));
    let samples = if let GlImage::Framebuffer { .. } = desc.color { 1 } else { samples_of(host, desc) };
    let written = depths(host, fbo(desc.color), samples);
    // SAFETY: the host's context is current.
    unsafe { host.gl.bind_framebuffer(glow::FRAMEBUFFER, fbo(desc.color)) };
    let reds = if samples > 1 { resolved(&host.gl, fbo(desc.color).unwrap()) } else { read(&host.gl) };
    assert_card(&written, &reds);
    close(adopted);
    written
}

fn samples_of(host: &Host, desc: &GlTargetDesc) -> i32 {
    let fbo = framebuffer(&host.gl, desc.color, desc.depth);
    // SAFETY: the host's context is current.
    unsafe {
        host.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo));
        host.gl.get_parameter_i32(glow::SAMPLES).max(1)
    }
}

fn cleared(host: &Host, color: GlImage, depth: GlImage) -> GlTargetDesc {
    let fbo = framebuffer(&host.gl, color, Some(depth));
    // SAFETY: the host's context is current.
    unsafe { host.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
    clear(&host.gl);
    GlTargetDesc { write_depth: true, ..desc(color, Some(depth)) }
}

#[test]
fn textures_and_renderbuffers_get_what_was_written() {
    for (api, mode) in [
        (Api::Core(4, 5), GlMode::Shared),
        (Api::Core(3, 3), GlMode::HostContext),
        (Api::Compatibility(4, 5), GlMode::HostContext),
    ] {
        for internal in [glow::DEPTH_COMPONENT24, glow::DEPTH_COMPONENT32F, glow::DEPTH24_STENCIL8] {
            let host = Host::new(api, Window::None, mode);
            let gl = &host.gl;
            let color = || image_of(texture(gl, glow::RGBA8));
            draw_and_look(&host, &cleared(&host, color(), image_of(texture(gl, internal))), false);
            let buffer = image_of_buffer(renderbuffer(gl, internal, 1));
            draw_and_look(&host, &cleared(&host, color(), buffer), true);
        }
    }
}

#[test]
fn every_sample_gets_what_was_written() {
    for textures in [true, false] {
        let host = Host::new(Api::Core(4, 5), Window::None, GlMode::Shared);
        let gl = &host.gl;
        let (color, depth) = if textures {
            let color = image_of_samples(multisampled_texture(gl, glow::RGBA8, 4));
            (color, image_of_samples(multisampled_texture(gl, glow::DEPTH_COMPONENT24, 4)))
        } else {
            let color = image_of_buffer(renderbuffer(gl, glow::RGBA8, 4));
            (color, image_of_buffer(renderbuffer(gl, glow::DEPTH_COMPONENT24, 4)))
        };
        draw_and_look(&host, &cleared(&host, color, depth), !textures);
    }
}

#[test]
fn welkin_reads_what_it_wrote_in_the_same_call() {
    for buffer in [false, true] {
        let host = Host::new(Api::Core(4, 5), Window::None, GlMode::Shared);
        let gl = &host.gl;
        let depth = if buffer {
            image_of_buffer(renderbuffer(gl, glow::DEPTH_COMPONENT24, 1))
        } else {
            image_of(texture(gl, glow::DEPTH_COMPONENT24))
        };
        let desc = cleared(&host, image_of(texture(gl, glow::RGBA8)), depth);
        let adopted = host.adopt();
        {
            let _current = adopted.host.enter().unwrap();
            let target = adopted.host.target(&adopted.device.device, &desc).unwrap();
            let (read, device) = (target.depth_read.as_ref().unwrap(), &adopted.device.device);
            let attached = adopted.host.attached_depth(read).unwrap().texture;
            adopted.device.queue.submit([draw_card(device, &target.color, &attached).finish()]);
            adopted.host.refresh_depth(read).unwrap();
            Picture::new(device, &target, Depth::One).draw(&adopted, &target);
        }
        let fbo = framebuffer(gl, desc.color, None);
        // SAFETY: the host's context is current.
        unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
        let blue = read(gl);
        let at = |x: u32, y: u32| blue[(y * WIDTH + x) as usize][2];
        assert_eq!([at(2, 2), at(2, 40), at(60, 40)], [64, 128, 191], "renderbuffer {buffer}");
        close(adopted);
    }
}

#[test]
fn a_window_gets_what_was_written() {
    let window = Window::Pbuffer(WIDTH as i32, HEIGHT as i32, 0);
    let host = Host::new(Api::Core(3, 3), window, GlMode::HostContext);
    clear(&host.gl);
    let image = GlImage::Framebuffer { name: 0 };
    draw_and_look(&host, &GlTargetDesc { write_depth: true, ..desc(image, Some(image)) }, false);
}

#[test]
fn depth_whose_samples_would_be_lost_is_refused_by_name() {
    let host = Host::new(Api::Core(4, 5), Window::None, GlMode::Shared);
    let gl = &host.gl;
    let color = image_of_samples(multisampled_texture(gl, glow::RGBA8, 4));
    let depth = image_of_samples(multisampled_texture(gl, glow::DEPTH_COMPONENT24, 4));
    let written = GlTargetDesc { write_depth: true, ..desc(color, Some(depth)) };
    let resolved = GlTargetDesc { multisample: Multisample::Resolve, ..written };
    assert_refused(&host, &resolved, Status::Unsupported, &["target.multisample", "must be each"]);
    let one = GlTargetDesc { color: image_of(texture(gl, glow::RGBA8)), ..written };
    assert_refused(&host, &one, Status::InvalidArgument, &["target.depth", "as many samples as color, 1", "got 4"]);
}

#[test]
fn a_c_host_may_let_depth_be_written_and_sees_the_same_picture() {
    let host = Host::new(Api::Core(4, 5), Window::None, GlMode::Shared);
    let gl = &host.gl;
    let device = device(&host);
    let scene = Scene::new(device);
    let color = image_of(texture(gl, glow::RGBA8));
    for depth in
        [image_of(texture(gl, glow::DEPTH_COMPONENT24)), image_of_buffer(renderbuffer(gl, glow::DEPTH_COMPONENT24, 1))]
    {
        let fbo = framebuffer(gl, color, Some(depth));
        let target = target(color, depth);
        // The first frame's sky is a draft.
        let _ = picture(&host, &scene, fbo, &target, 1);
        let read_only = picture(&host, &scene, fbo, &target, 2);
        let before = depths(&host, Some(fbo), 1);
        // SAFETY: the host's context is current, the handles live.
        unsafe {
            // The next frame may have the same number again.
            ok(wk_view_record(scene.view, &frame(3), WK_STAGE_PREPARE));
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo));
            gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
            let both =
                wk_frame { target: (&raw const target).cast(), depth_access: WK_DEPTH_ACCESS_READ_WRITE, ..frame(2) };
            ok(wk_view_record(scene.view, &both, WK_STAGE_ALL));
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo));
        }
        let rows: Vec<_> = read(gl).chunks_exact(WIDTH as usize).rev().flatten().copied().collect();
        let far = rows.iter().zip(&read_only).map(|(a, b)| (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap()).max();
        assert!(far <= Some(1), "{far:?} steps");
        assert_eq!(depths(&host, Some(fbo), 1), before);
    }
    let many = target(
        image_of_samples(multisampled_texture(gl, glow::RGBA8, 4)),
        image_of_samples(multisampled_texture(gl, glow::DEPTH_COMPONENT24, 4)),
    );
    let many = wk_opengl_target { multisample: WK_OPENGL_MULTISAMPLE_RESOLVE, ..many };
    let wrong = wk_frame { target: (&raw const many).cast(), depth_access: WK_DEPTH_ACCESS_READ_WRITE, ..frame(9) };
    // SAFETY: as above.
    let status = unsafe { wk_view_record(scene.view, &wrong, WK_STAGE_ALL) };
    assert_eq!(status, WK_ERROR_UNSUPPORTED);
    assert!(message().contains("frame.target.multisample must be each where depth is written"), "{}", message());
    scene.destroy();
    // SAFETY: a live handle.
    ok(unsafe { welkin::capi::device::wk_device_destroy(device) });
}
