//! Pictures in every kind of image, in both modes, on every kind of context.

use glow::HasContext;
use welkin::gpu::gl::{GlImage, GlMode, GlTargetDesc};
use welkin_support::egl::{Api, Window};

use crate::{
    host::{Depth, Host, Picture, close},
    images::*,
};

const MODES: [GlMode; 2] = [GlMode::Shared, GlMode::HostContext];

/// Clears as a host does, draws the picture over it, and checks the result that the host reads.
pub fn draw(host: &Host, desc: &GlTargetDesc, depth: Depth) {
    let adopted = host.adopt();
    {
        let _current = adopted.host.enter().unwrap();
        let target = adopted.host.target(&adopted.device.device, desc).unwrap_or_else(|e| panic!("{e}"));
        Picture::new(&adopted.device.device, &target, depth).draw(&adopted, &target);
    }
    close(adopted);
}

fn draws_into_textures(api: Api, mode: GlMode, color: u32, depth: u32) {
    let host = Host::new(api, Window::None, mode);
    let gl = &host.gl;
    let (color, depth) = (image_of(texture(gl, color)), image_of(texture(gl, depth)));
    let fbo = framebuffer(gl, color, Some(depth));
    // SAFETY: the host's context is current.
    unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
    clear(gl);
    draw(&host, &desc(color, Some(depth)), Depth::One);
    assert_picture(&read(gl), Blue::Depth, 1);
}

#[test]
fn textures_of_a_core_context() {
    for mode in MODES {
        draws_into_textures(Api::Core(3, 3), mode, glow::RGBA8, glow::DEPTH_COMPONENT24);
        draws_into_textures(Api::Core(4, 5), mode, glow::RGBA8, glow::DEPTH24_STENCIL8);
    }
}

#[test]
fn textures_of_a_compatibility_context() {
    for mode in MODES {
        draws_into_textures(Api::Compatibility(3, 3), mode, glow::RGBA8, glow::DEPTH_COMPONENT24);
    }
}

#[test]
fn textures_of_an_es_context() {
    for mode in MODES {
        draws_into_textures(Api::Es(3, 0), mode, glow::RGBA8, glow::DEPTH_COMPONENT16);
        draws_into_textures(Api::Es(3, 1), mode, glow::RGBA8, glow::DEPTH_COMPONENT24);
    }
}

#[test]
fn renderbuffers() {
    for (api, mode) in
        [Api::Core(4, 5), Api::Compatibility(3, 3), Api::Es(3, 0)].into_iter().zip(MODES.into_iter().cycle())
    {
        let host = Host::new(api, Window::None, mode);
        let gl = &host.gl;
        let color = image_of_buffer(renderbuffer(gl, glow::RGBA8, 1));
        let depth = image_of_buffer(renderbuffer(gl, glow::DEPTH_COMPONENT24, 1));
        let fbo = framebuffer(gl, color, Some(depth));
        // SAFETY: the host's context is current.
        unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
        clear(gl);
        draw(&host, &desc(color, Some(depth)), Depth::One);
        assert_picture(&read(gl), Blue::Depth, 1);
    }
}

#[test]
fn the_window() {
    for api in [Api::Core(3, 3), Api::Compatibility(4, 5), Api::Es(3, 0)] {
        let window = Window::Pbuffer(WIDTH as i32, HEIGHT as i32, 0);
        let host = Host::new(api, window, GlMode::HostContext);
        clear(&host.gl);
        let image = GlImage::Framebuffer { name: 0 };
        draw(&host, &desc(image, Some(image)), Depth::One);
        assert_picture(&read(&host.gl), Blue::Depth, 1);
    }
}
