//! The host's images and what it reads from them, through its own OpenGL.

use glow::{HasContext, PixelPackData, PixelUnpackData};
use welkin::gpu::gl::{GlImage, GlTargetDesc, Multisample};

pub const WIDTH: u32 = 64;
pub const HEIGHT: u32 = 48;

/// The client format and type that go with an internal format.
pub fn client(internal: u32) -> (u32, u32) {
    match internal {
        glow::RGBA16F => (glow::RGBA, glow::HALF_FLOAT),
        glow::RGBA32F => (glow::RGBA, glow::FLOAT),
        glow::R11F_G11F_B10F => (glow::RGB, glow::FLOAT),
        glow::RGB10_A2 => (glow::RGBA, glow::UNSIGNED_INT_2_10_10_10_REV),
        glow::RGB8 | glow::SRGB8 => (glow::RGB, glow::UNSIGNED_BYTE),
        glow::DEPTH_COMPONENT16 => (glow::DEPTH_COMPONENT, glow::UNSIGNED_SHORT),
        glow::DEPTH_COMPONENT24 => (glow::DEPTH_COMPONENT, glow::UNSIGNED_INT),
        glow::DEPTH_COMPONENT32F => (glow::DEPTH_COMPONENT, glow::FLOAT),
        glow::DEPTH24_STENCIL8 => (glow::DEPTH_STENCIL, glow::UNSIGNED_INT_24_8),
        glow::DEPTH32F_STENCIL8 => (glow::DEPTH_STENCIL, glow::FLOAT_32_UNSIGNED_INT_24_8_REV),
        glow::R8 => (glow::RED, glow::UNSIGNED_BYTE),
        glow::RGB5_A1 => (glow::RGBA, glow::UNSIGNED_SHORT_5_5_5_1),
        _ => (glow::RGBA, glow::UNSIGNED_BYTE),
    }
}

pub fn texture(gl: &glow::Context, internal: u32) -> glow::Texture {
    let (format, ty) = client(internal);
    // SAFETY: the host's context is current; no data is passed.
    unsafe {
        let name = gl.create_texture().unwrap();
        gl.bind_texture(glow::TEXTURE_2D, Some(name));
        let none = PixelUnpackData::Slice(None);
        let (w, h) = (WIDTH as i32, HEIGHT as i32);
        gl.tex_image_2d(glow::TEXTURE_2D, 0, internal as i32, w, h, 0, format, ty, none);
        gl.bind_texture(glow::TEXTURE_2D, None);
        assert_eq!(gl.get_error(), 0, "{internal:#x}");
        name
    }
}

pub fn multisampled_texture(gl: &glow::Context, internal: u32, samples: i32) -> glow::Texture {
    // SAFETY: the host's context is current.
    unsafe {
        let name = gl.create_texture().unwrap();
        gl.bind_texture(glow::TEXTURE_2D_MULTISAMPLE, Some(name));
        let (w, h) = (WIDTH as i32, HEIGHT as i32);
        gl.tex_storage_2d_multisample(glow::TEXTURE_2D_MULTISAMPLE, samples, internal, w, h, true);
        gl.bind_texture(glow::TEXTURE_2D_MULTISAMPLE, None);
        assert_eq!(gl.get_error(), 0);
        name
    }
}

pub fn renderbuffer(gl: &glow::Context, internal: u32, samples: i32) -> glow::Renderbuffer {
    // SAFETY: the host's context is current.
    unsafe {
        let name = gl.create_renderbuffer().unwrap();
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(name));
        let (w, h) = (WIDTH as i32, HEIGHT as i32);
        if samples > 1 {
            gl.renderbuffer_storage_multisample(glow::RENDERBUFFER, samples, internal, w, h);
        } else {
            gl.renderbuffer_storage(glow::RENDERBUFFER, internal, w, h);
        }
        gl.bind_renderbuffer(glow::RENDERBUFFER, None);
        assert_eq!(gl.get_error(), 0);
        name
    }
}

pub fn image_of(texture: glow::Texture) -> GlImage {
    GlImage::Texture { name: texture.0.get(), target: glow::TEXTURE_2D }
}

pub fn image_of_samples(texture: glow::Texture) -> GlImage {
    GlImage::Texture { name: texture.0.get(), target: glow::TEXTURE_2D_MULTISAMPLE }
}

pub fn image_of_buffer(buffer: glow::Renderbuffer) -> GlImage {
    GlImage::Renderbuffer { name: buffer.0.get() }
}

pub fn desc(color: GlImage, depth: Option<GlImage>) -> GlTargetDesc {
    GlTargetDesc {
        color,
        depth,
        mask: None,
        surface_classes: None,
        normals: None,
        width: WIDTH,
        height: HEIGHT,
        generation: 0,
        multisample: Multisample::Each,
        write_depth: false,
    }
}

fn attach(gl: &glow::Context, attachment: u32, image: GlImage) {
    // SAFETY: the host's context is current and the names are its own.
    unsafe {
        match image {
            GlImage::Texture { name, target } => {
                let name = glow::NativeTexture(name.try_into().unwrap());
                gl.framebuffer_texture_2d(glow::FRAMEBUFFER, attachment, target, Some(name), 0);
            }
            GlImage::Renderbuffer { name } => {
                let name = glow::NativeRenderbuffer(name.try_into().unwrap());
                gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, attachment, glow::RENDERBUFFER, Some(name));
            }
            GlImage::Framebuffer { .. } => unreachable!(),
        }
    }
}

/// A framebuffer of the host with these images.
pub fn framebuffer(gl: &glow::Context, color: GlImage, depth: Option<GlImage>) -> glow::Framebuffer {
    // SAFETY: the host's context is current.
    unsafe {
        let name = gl.create_framebuffer().unwrap();
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(name));
        attach(gl, glow::COLOR_ATTACHMENT0, color);
        if let Some(depth) = depth {
            attach(gl, glow::DEPTH_ATTACHMENT, depth);
        }
        assert_eq!(gl.check_framebuffer_status(glow::FRAMEBUFFER), glow::FRAMEBUFFER_COMPLETE);
        gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        name
    }
}

/// Clears the bound framebuffer to dark grey, with a depth of 0.25 in the lower half and 0.75 in the upper, as the host
/// sees it.
pub fn clear(gl: &glow::Context) {
    // SAFETY: the host's context is current.
    unsafe {
        gl.disable(glow::SCISSOR_TEST);
        gl.clear_color(0.2, 0.2, 0.2, 1.0);
        gl.clear_depth_f32(0.25);
        gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
        gl.enable(glow::SCISSOR_TEST);
        gl.scissor(0, HEIGHT as i32 / 2, WIDTH as i32, HEIGHT as i32);
        gl.clear_depth_f32(0.75);
        gl.clear(glow::DEPTH_BUFFER_BIT);
        gl.disable(glow::SCISSOR_TEST);
        assert_eq!(gl.get_error(), 0);
    }
}

/// The bound read framebuffer's colours, row 0 at the bottom.
pub fn read(gl: &glow::Context) -> Vec<[u8; 4]> {
    let mut bytes = vec![0u8; (WIDTH * HEIGHT * 4) as usize];
    // SAFETY: the host's context is current and there is room for every texel.
    unsafe {
        gl.read_pixels(
            0,
            0,
            WIDTH as i32,
            HEIGHT as i32,
            glow::RGBA,
            glow::UNSIGNED_BYTE,
            PixelPackData::Slice(Some(&mut bytes)),
        );
        assert_eq!(gl.get_error(), 0);
    }
    bytes.chunks_exact(4).map(|t| [t[0], t[1], t[2], t[3]]).collect()
}

/// Reads as [`read`] does, from a float format.
pub fn read_floats(gl: &glow::Context) -> Vec<[u8; 4]> {
    let mut bytes = vec![0u8; (WIDTH * HEIGHT * 16) as usize];
    // SAFETY: the host's context is current and there is room for every texel.
    unsafe {
        gl.read_pixels(
            0,
            0,
            WIDTH as i32,
            HEIGHT as i32,
            glow::RGBA,
            glow::FLOAT,
            PixelPackData::Slice(Some(&mut bytes)),
        );
        assert_eq!(gl.get_error(), 0);
    }
    let float = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    let texel = |t: &[u8]| [0, 4, 8, 12].map(|i| (float(&t[i..i + 4]) * 255.0).round() as u8);
    bytes.chunks_exact(16).map(texel).collect()
}

/// Expected blue of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blue {
    /// 0.25 everywhere.
    Plain,
    /// The depth that [`clear`] left.
    Depth,
    /// The red that [`clear`] left.
    Old,
    /// A mask of 1.
    One,
}

/// The picture of `host::Picture` the right way up, to within `steps` of 255.
pub fn assert_picture(texels: &[[u8; 4]], blue: Blue, steps: i32) {
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            let texel = texels[(y * WIDTH + x) as usize].map(i32::from);
            let part = |i: u32, n: u32| ((f64::from(i) + 0.5) / f64::from(n) * 255.0).round() as i32;
            let blue = match blue {
                Blue::Depth if y >= HEIGHT / 2 => 191,
                Blue::Old => 51,
                Blue::One => 255,
                _ => 64,
            };
            let expected = [part(x, WIDTH), part(y, HEIGHT), blue, 255];
            let off = texel.iter().zip(expected).map(|(a, b)| (a - b).abs()).max().unwrap();
            assert!(off <= steps, "texel ({x}, {y}) should be {expected:?} and is {texel:?}");
        }
    }
}
