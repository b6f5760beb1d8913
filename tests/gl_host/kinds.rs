//! Every kind of image a host can hand over: formats, samples, copies, and errors for unsupported images.

use glow::HasContext;
use welkin::{
    Status,
    gpu::gl::{GlImage, GlMode, GlTargetDesc, Multisample},
};
use welkin_support::egl::{Api, Window};

use crate::{
    host::{Depth, Host, Picture, close},
    images::*,
    pictures::draw,
};

#[test]
fn color_formats() {
    let host = Host::new(Api::Core(4, 5), Window::None, GlMode::Shared);
    let gl = &host.gl;
    let adopted = host.adopt();
    for (internal, float, steps) in [
        (glow::RGBA8, false, 1),
        (glow::RGB8, false, 1),
        (glow::RGB10_A2, false, 1),
        (glow::RGBA16F, true, 1),
        (glow::RGBA32F, true, 1),
        (glow::R11F_G11F_B10F, true, 3),
        (glow::RGBA, false, 1), // not a sized format: the driver chooses
    ] {
        let color = image_of(texture(gl, internal));
        {
            let _current = adopted.host.enter().unwrap();
            let target =
                adopted.host.target(&adopted.device.device, &desc(color, None)).unwrap_or_else(|e| panic!("{e}"));
            Picture::new(&adopted.device.device, &target, Depth::None).draw(&adopted, &target);
        }
        let fbo = framebuffer(gl, color, None);
        // SAFETY: the host's context is current.
        unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
        let texels = if float { read_floats(gl) } else { read(gl) };
        assert_picture(&texels, Blue::Plain, steps);
    }
    close(adopted);
}

#[test]
fn an_srgb_texture_gets_encoded_colours() {
    for mode in [GlMode::Shared, GlMode::HostContext] {
        for api in [Api::Core(3, 3), Api::Es(3, 0)] {
            let host = Host::new(api, Window::None, mode);
            let gl = &host.gl;
            let color = image_of(texture(gl, glow::SRGB8_ALPHA8));
            draw(&host, &desc(color, None), Depth::None);
            let fbo = framebuffer(gl, color, None);
            // SAFETY: the host's context is current.
            unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
            // 0.25 linear is 137 of 255 encoded (IEC 61966-2-1).
            let blue = read(gl)[0][2];
            assert!((136..=138).contains(&blue), "{api:?} {mode:?}: {blue}");
        }
    }
}

#[test]
fn depth_formats() {
    for api in [Api::Core(3, 3), Api::Es(3, 0)] {
        let host = Host::new(api, Window::None, GlMode::Shared);
        let gl = &host.gl;
        let adopted = host.adopt();
        for internal in [
            glow::DEPTH_COMPONENT16,
            glow::DEPTH_COMPONENT24,
            glow::DEPTH_COMPONENT32F,
            glow::DEPTH24_STENCIL8,
            glow::DEPTH32F_STENCIL8,
        ] {
            for as_texture in [true, false] {
                let color = image_of(texture(gl, glow::RGBA8));
                let depth = if as_texture {
                    image_of(texture(gl, internal))
                } else {
                    image_of_buffer(renderbuffer(gl, internal, 1))
                };
                let fbo = framebuffer(gl, color, Some(depth));
                // SAFETY: the host's context is current.
                unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
                clear(gl);
                {
                    let _current = adopted.host.enter().unwrap();
                    let target = adopted.host.target(&adopted.device.device, &desc(color, Some(depth)));
                    let target = target.unwrap_or_else(|e| panic!("{internal:#x}: {e}"));
                    Picture::new(&adopted.device.device, &target, Depth::One).draw(&adopted, &target);
                }
                assert_picture(&read(gl), Blue::Depth, 1);
            }
        }
        close(adopted);
    }
}

/// The host's multisampled image, averaged by the host into one it can read.
pub fn resolved(gl: &glow::Context, from: glow::Framebuffer) -> Vec<[u8; 4]> {
    let to = framebuffer(gl, image_of(texture(gl, glow::RGBA8)), None);
    let (w, h) = (WIDTH as i32, HEIGHT as i32);
    // SAFETY: the host's context is current.
    unsafe {
        gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(from));
        gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(to));
        gl.blit_framebuffer(0, 0, w, h, 0, 0, w, h, glow::COLOR_BUFFER_BIT, glow::NEAREST);
        gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(to));
        assert_eq!(gl.get_error(), 0);
    }
    read(gl)
}

#[test]
fn multisampled_images_per_sample() {
    for (api, mode) in [
        (Api::Core(4, 5), GlMode::Shared),
        (Api::Core(3, 3), GlMode::HostContext),
        (Api::Compatibility(4, 5), GlMode::HostContext),
        (Api::Core(4, 5), GlMode::HostContext),
    ] {
        for textures in [true, false] {
            let host = Host::new(api, Window::None, mode);
            let gl = &host.gl;
            let (color, depth) = if textures {
                let color = multisampled_texture(gl, glow::RGBA8, 4);
                let depth = multisampled_texture(gl, glow::DEPTH_COMPONENT24, 4);
                (image_of_samples(color), image_of_samples(depth))
            } else {
                let color = renderbuffer(gl, glow::RGBA8, 4);
                (image_of_buffer(color), image_of_buffer(renderbuffer(gl, glow::DEPTH_COMPONENT24, 4)))
            };
            let fbo = framebuffer(gl, color, Some(depth));
            // SAFETY: the host's context is current.
            unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
            clear(gl);
            draw(&host, &desc(color, Some(depth)), Depth::Many);
            assert_picture(&resolved(gl, fbo), Blue::Depth, 1);
        }
    }
}

#[test]
fn effects_read_images_that_wgpu_cannot_copy() {
    for mode in [GlMode::Shared, GlMode::HostContext] {
        let host = Host::new(Api::Core(4, 5), Window::None, mode);
        let gl = &host.gl;
        for (color, reads) in [
            (image_of_buffer(renderbuffer(gl, glow::RGBA8, 1)), Depth::OldColor),
            (image_of_buffer(renderbuffer(gl, glow::RGBA8, 4)), Depth::OldColors),
            (image_of_samples(multisampled_texture(gl, glow::RGBA8, 4)), Depth::OldColors),
        ] {
            let fbo = framebuffer(gl, color, None);
            // SAFETY: the host's context is current.
            unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
            clear(gl);
            draw(&host, &desc(color, None), reads);
            assert_picture(&resolved(gl, fbo), Blue::Old, 1);
        }
    }
}

#[test]
fn a_mask() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::Shared);
    let gl = &host.gl;
    for internal in [glow::R8, glow::RGBA8] {
        let (color, mask) = (image_of(texture(gl, glow::RGBA8)), image_of(texture(gl, internal)));
        let [fbo, mask_fbo] = [color, mask].map(|image| framebuffer(gl, image, None));
        // SAFETY: the host's context is current.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(mask_fbo));
            gl.clear_color(1.0, 1.0, 1.0, 1.0);
            gl.clear(glow::COLOR_BUFFER_BIT);
        }
        draw(&host, &GlTargetDesc { mask: Some(mask), ..desc(color, None) }, Depth::Mask);
        // SAFETY: as above.
        unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
        assert_picture(&read(gl), Blue::One, 1);
    }
    let (color, mask) = (image_of(texture(gl, glow::RGBA8)), image_of_buffer(renderbuffer(gl, glow::R8, 1)));
    let desc = GlTargetDesc { mask: Some(mask), ..desc(color, None) };
    assert_refused(&host, &desc, Status::Unsupported, &["target.mask", "GL_TEXTURE_2D"]);
}

#[test]
fn multisampled_images_resolved() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::Shared);
    let gl = &host.gl;
    for textures in [true, false] {
        let (color, depth) = if textures {
            let color = multisampled_texture(gl, glow::RGBA8, 4);
            (image_of_samples(color), image_of_samples(multisampled_texture(gl, glow::DEPTH24_STENCIL8, 4)))
        } else {
            let color = renderbuffer(gl, glow::RGBA8, 4);
            (image_of_buffer(color), image_of_buffer(renderbuffer(gl, glow::DEPTH24_STENCIL8, 4)))
        };
        let fbo = framebuffer(gl, color, Some(depth));
        // SAFETY: the host's context is current.
        unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
        clear(gl);
        let desc = GlTargetDesc { multisample: Multisample::Resolve, ..desc(color, Some(depth)) };
        draw(&host, &desc, Depth::One);
        assert_picture(&resolved(gl, fbo), Blue::Depth, 1);
    }
}

#[test]
fn a_resolved_picture_with_multisampled_depth() {
    for mode in [GlMode::Shared, GlMode::HostContext] {
        for as_texture in [true, false] {
            let host = Host::new(Api::Core(3, 3), Window::None, mode);
            let gl = &host.gl;
            let (color, beside) = (image_of(texture(gl, glow::RGBA8)), renderbuffer(gl, glow::RGBA8, 4));
            let depth = if as_texture {
                image_of_samples(multisampled_texture(gl, glow::DEPTH_COMPONENT24, 4))
            } else {
                image_of_buffer(renderbuffer(gl, glow::DEPTH_COMPONENT24, 4))
            };
            let [drawn, fbo] = [framebuffer(gl, image_of_buffer(beside), Some(depth)), framebuffer(gl, color, None)];
            for framebuffer in [drawn, fbo] {
                // SAFETY: the host's context is current.
                unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer)) };
                clear(gl);
            }
            draw(&host, &desc(color, Some(depth)), Depth::One);
            // SAFETY: as above.
            unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
            assert_picture(&read(gl), Blue::Depth, 1);
        }
    }
}

#[test]
fn a_multisampled_window() {
    for multisample in [Multisample::Each, Multisample::Resolve] {
        let window = Window::Pbuffer(WIDTH as i32, HEIGHT as i32, 4);
        let host = Host::new(Api::Core(3, 3), window, GlMode::HostContext);
        clear(&host.gl);
        let image = GlImage::Framebuffer { name: 0 };
        let depth = if multisample == Multisample::Each { Depth::Many } else { Depth::One };
        draw(&host, &GlTargetDesc { multisample, ..desc(image, Some(image)) }, depth);
        // SAFETY: the host's context is current; the window is read through one of one sample.
        let texels = unsafe {
            let to = framebuffer(&host.gl, image_of(texture(&host.gl, glow::RGBA8)), None);
            host.gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(to));
            let (w, h) = (WIDTH as i32, HEIGHT as i32);
            host.gl.blit_framebuffer(0, 0, w, h, 0, 0, w, h, glow::COLOR_BUFFER_BIT, glow::NEAREST);
            host.gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(to));
            read(&host.gl)
        };
        assert_picture(&texels, Blue::Depth, 1);
    }
}

#[test]
fn a_framebuffer_with_several_buffers() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::HostContext);
    let gl = &host.gl;
    let (first, second) = (texture(gl, glow::RGBA8), texture(gl, glow::RGBA8));
    let depth = image_of(texture(gl, glow::DEPTH_COMPONENT24));
    let fbo = framebuffer(gl, image_of(first), Some(depth));
    // SAFETY: the host's context is current.
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo));
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT1, glow::TEXTURE_2D, Some(second), 0);
        gl.draw_buffers(&[glow::COLOR_ATTACHMENT1, glow::COLOR_ATTACHMENT0]);
        gl.read_buffer(glow::COLOR_ATTACHMENT0);
    }
    clear(gl);
    let image = GlImage::Framebuffer { name: fbo.0.get() };
    draw(&host, &desc(image, Some(image)), Depth::One);
    assert_eq!(read(gl)[0], [51, 51, 51, 255], "the buffer that shaders reach second keeps what it had");
    // SAFETY: as above.
    unsafe {
        assert_eq!(gl.get_parameter_i32(glow::DRAW_BUFFER0) as u32, glow::COLOR_ATTACHMENT1);
        assert_eq!(gl.get_parameter_i32(glow::DRAW_BUFFER0 + 1) as u32, glow::COLOR_ATTACHMENT0);
        gl.read_buffer(glow::COLOR_ATTACHMENT1);
    }
    assert_picture(&read(gl), Blue::Depth, 1);
}

#[test]
fn depth_goes_back_to_the_window_when_asked() {
    for write_depth in [false, true] {
        let window = Window::Pbuffer(WIDTH as i32, HEIGHT as i32, 0);
        let host = Host::new(Api::Core(3, 3), window, GlMode::HostContext);
        clear(&host.gl);
        let image = GlImage::Framebuffer { name: 0 };
        let desc = GlTargetDesc { write_depth, ..desc(image, Some(image)) };
        let adopted = host.adopt();
        {
            let _current = adopted.host.enter().unwrap();
            let target = adopted.host.target(&adopted.device.device, &desc).unwrap();
            let mut encoder = adopted.device.device.create_command_encoder(&Default::default());
            drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &target.depth.as_ref().unwrap().create_view(&Default::default()),
                    depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.5), store: wgpu::StoreOp::Store }),
                    stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
                }),
                ..Default::default()
            }));
            adopted.device.queue.submit([encoder.finish()]);
        }
        close(adopted);
        let mut depth = [0u8; 4];
        // SAFETY: the host's context is current and there is room for one texel.
        unsafe {
            let room = glow::PixelPackData::Slice(Some(&mut depth));
            host.gl.read_pixels(0, 0, 1, 1, glow::DEPTH_COMPONENT, glow::FLOAT, room);
        }
        let depth = f32::from_le_bytes(depth);
        let expected = if write_depth { 0.5 } else { 0.25 };
        assert!((depth - expected).abs() < 1e-4, "{depth}");
    }
}

/// Returns the error of the target for `desc`.
fn refusal(host: &Host, desc: &GlTargetDesc) -> welkin::Error {
    let adopted = host.adopt();
    let error = {
        let _current = adopted.host.enter().unwrap();
        adopted.host.target(&adopted.device.device, desc).unwrap_err()
    };
    assert!(adopted.host.enter().is_ok(), "a refused target is no fault of the device");
    close(adopted);
    // SAFETY: the host's context is current.
    assert_eq!(unsafe { host.gl.get_error() }, 0, "{error}");
    error
}

pub fn assert_refused(host: &Host, desc: &GlTargetDesc, status: Status, parts: &[&str]) {
    let error = refusal(host, desc);
    assert_eq!(error.status, status, "{error}");
    for part in parts {
        assert!(error.to_string().contains(part), "{part:?} is not in {:?}", error);
    }
}

#[test]
fn unsupported_images_are_refused_by_name() {
    for mode in [GlMode::Shared, GlMode::HostContext] {
        let host = Host::new(Api::Core(4, 5), Window::None, mode);
        let gl = &host.gl;
        let good = image_of(texture(gl, glow::RGBA8));
        let refused = |desc, status, parts: &[&str]| assert_refused(&host, &desc, status, parts);
        let five_one = image_of(texture(gl, glow::RGB5_A1));
        refused(desc(five_one, None), Status::Unsupported, &["target.color", "GL_RGB5_A1", "GL_RGBA8"]);
        let red = image_of(texture(gl, glow::R8));
        refused(desc(red, None), Status::Unsupported, &["target.color", "GL_R8 (0x8229)"]);
        refused(desc(good, Some(good)), Status::Unsupported, &["target.depth", "GL_RGBA8", "GL_DEPTH_COMPONENT24"]);
        let depth = image_of(texture(gl, glow::DEPTH_COMPONENT24));
        refused(desc(depth, None), Status::Unsupported, &["target.color", "GL_DEPTH_COMPONENT24"]);
        let nothing = GlImage::Texture { name: 4711, target: glow::TEXTURE_2D };
        refused(desc(nothing, None), Status::InvalidArgument, &["target.color", "4711"]);
        let nothing = GlImage::Renderbuffer { name: 4711 };
        refused(desc(good, Some(nothing)), Status::InvalidArgument, &["target.depth", "renderbuffer", "4711"]);
        let GlImage::Texture { name, .. } = good else { unreachable!() };
        let cube = GlImage::Texture { name, target: glow::TEXTURE_CUBE_MAP };
        refused(desc(cube, None), Status::Unsupported, &["target.color.target", "GL_TEXTURE_CUBE_MAP"]);
        let wrong = GlImage::Texture { name, target: glow::TEXTURE_2D_MULTISAMPLE };
        refused(desc(wrong, None), Status::InvalidArgument, &["target.color.target"]);
        let small = GlTargetDesc { width: 63, ..desc(good, None) };
        refused(small, Status::InvalidArgument, &["target.width", "64 x 48", "63 x 48"]);
        let samples = image_of_buffer(renderbuffer(gl, glow::RGBA8, 4));
        refused(desc(samples, Some(depth)), Status::InvalidArgument, &["target.depth", "samples", "4", "got 1"]);
        // SAFETY: the host's context is current; a texture without storage.
        let empty = unsafe {
            let name = gl.create_texture().unwrap();
            gl.bind_texture(glow::TEXTURE_2D, Some(name));
            gl.bind_texture(glow::TEXTURE_2D, None);
            image_of(name)
        };
        refused(desc(empty, None), Status::InvalidArgument, &["target.color", "storage"]);
    }
}

#[test]
fn framebuffers_are_refused_where_they_mean_nothing() {
    let window = Window::Pbuffer(WIDTH as i32, HEIGHT as i32, 0);
    let image = GlImage::Framebuffer { name: 0 };
    let host = Host::new(Api::Core(3, 3), window, GlMode::Shared);
    assert_refused(&host, &desc(image, None), Status::Unsupported, &["target.color", "shared context", "framebuffers"]);
    // Without a window there is no framebuffer 0.
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::HostContext);
    assert_refused(&host, &desc(image, None), Status::InvalidArgument, &["target.color", "GL_FRAMEBUFFER_UNDEFINED"]);
    let color = image_of(texture(&host.gl, glow::RGBA8));
    assert_refused(&host, &desc(color, Some(image)), Status::InvalidArgument, &["target.depth", "same framebuffer"]);
}

#[test]
fn samples_are_refused_where_shaders_cannot_read_them() {
    for mode in [GlMode::Shared, GlMode::HostContext] {
        let host = Host::new(Api::Es(3, 1), Window::None, mode);
        for multisample in [Multisample::Each, Multisample::Resolve] {
            let color = image_of_samples(multisampled_texture(&host.gl, glow::RGBA8, 4));
            let desc = GlTargetDesc { multisample, ..desc(color, None) };
            assert_refused(&host, &desc, Status::Unsupported, &["target.color", "1 sample on OpenGL ES, got 4"]);
        }
    }
    let host = Host::new(Api::Core(4, 5), Window::None, GlMode::Shared);
    let color = image_of_samples(multisampled_texture(&host.gl, glow::RGBA8, 4));
    let adopted = host.adopt_with(|d| d.force_tier0 = true);
    {
        let _current = adopted.host.enter().unwrap();
        let error = adopted.host.target(&adopted.device.device, &desc(color, None)).unwrap_err();
        assert!(error.to_string().contains("target.multisample") && error.to_string().contains("tier 0"), "{error}");
    }
    close(adopted);
}
