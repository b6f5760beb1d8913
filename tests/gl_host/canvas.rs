//! Colour and depth of an OpenGL host of any size, with level grey ground in them.

use glow::HasContext;
use welkin::capi::{frame::*, opengl::*, view::*};
use welkin_support::c_scene::{
    Scene, init, ok,
    own::{Size, grey_ground, ground_depths, still_frame},
};

use crate::{
    capi::image,
    host::Host,
    images::{client, framebuffer, image_of},
};

/// A texture with these texels; rows from the top.
pub fn filled<T: bytemuck::Pod>(gl: &glow::Context, internal: u32, size: Size, texels: &[T]) -> glow::Texture {
    let (format, ty) = client(internal);
    let rows: Vec<T> = texels.chunks_exact(size.0 as usize).rev().flatten().copied().collect();
    assert_eq!(rows.len() as u32, size.0 * size.1);
    // SAFETY: the host's context is current; there are as many texels.
    unsafe {
        let name = gl.create_texture().unwrap();
        gl.bind_texture(glow::TEXTURE_2D, Some(name));
        gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
        let data = glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(&rows)));
        gl.tex_image_2d(glow::TEXTURE_2D, 0, internal as i32, size.0 as i32, size.1 as i32, 0, format, ty, data);
        // Without these filters a texture without mipmaps is incomplete.
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MIN_FILTER, glow::NEAREST as i32);
        gl.bind_texture(glow::TEXTURE_2D, None);
        gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 4);
        assert_eq!(gl.get_error(), glow::NO_ERROR, "{internal:#x}");
        name
    }
}

pub struct Canvas {
    pub color: glow::Texture,
    pub depth: glow::Texture,
    pub fbo: glow::Framebuffer,
    pub size: Size,
}

impl Canvas {
    pub fn new(gl: &glow::Context, size: Size) -> Self {
        let color = filled(gl, glow::RGBA8, size, &grey_ground(size));
        let depth = filled(gl, glow::DEPTH_COMPONENT32F, size, &ground_depths(size));
        let fbo = framebuffer(gl, image_of(color), Some(image_of(depth)));
        Self { color, depth, fbo, size }
    }

    pub fn target(&self) -> wk_opengl_target {
        wk_opengl_target {
            color: image(image_of(self.color)),
            depth: image(image_of(self.depth)),
            width: self.size.0,
            height: self.size.1,
            ..init("wk_opengl_target")
        }
    }

    /// Returns the picture as the host sees it; rows from the top.
    pub fn pixels(&self, gl: &glow::Context) -> Vec<[u8; 4]> {
        let mut pixels = vec![[0_u8; 4]; (self.size.0 * self.size.1) as usize];
        // SAFETY: the host's context is current, and there is room for every pixel.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.fbo));
            let room = glow::PixelPackData::Slice(Some(pixels.as_flattened_mut()));
            gl.read_pixels(0, 0, self.size.0 as i32, self.size.1 as i32, glow::RGBA, glow::UNSIGNED_BYTE, room);
            gl.bind_framebuffer(glow::FRAMEBUFFER, None);
            assert_eq!(gl.get_error(), glow::NO_ERROR);
        }
        pixels.chunks_exact(self.size.0 as usize).rev().flatten().copied().collect()
    }

    pub fn delete(self, gl: &glow::Context) {
        // SAFETY: the host's context is current.
        unsafe {
            gl.delete_framebuffer(self.fbo);
            gl.delete_texture(self.color);
            gl.delete_texture(self.depth);
        }
    }
}

/// The wet scene on a new canvas; `change` may add images to the target.
pub fn wet_picture(
    host: &Host,
    scene: &Scene,
    frame_id: u64,
    size: Size,
    stages: wk_stage_flags,
    change: impl FnOnce(&mut wk_opengl_target),
) -> Vec<[u8; 4]> {
    let canvas = Canvas::new(&host.gl, size);
    let mut target = canvas.target();
    // OpenGL reuses the names of deleted objects.
    target.generation = frame_id;
    change(&mut target);
    let frame = wk_frame { target: (&raw const target).cast(), ..still_frame(frame_id, size) };
    // SAFETY: live handles; the host's context is current.
    ok(unsafe { wk_view_record(scene.view, &frame, stages) });
    let pixels = canvas.pixels(&host.gl);
    canvas.delete(&host.gl);
    pixels
}
