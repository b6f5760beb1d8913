//! A host that leaves OpenGL in an unusual state.

use std::ffi::c_void;

use glow::HasContext;

use crate::{host::Host, snapshot::Objects};
use welkin_support::egl::{Api, function};

const VERTEX: &str = "in vec4 place; out vec4 caught; void main() { caught = place; gl_Position = place; }";
const FRAGMENT: &str = "uniform vec4 tint; out vec4 color; void main() { color = tint; }";

unsafe fn program(gl: &glow::Context, es: bool) -> glow::Program {
    let head = if es { "#version 300 es\nprecision highp float;\n" } else { "#version 330\n" };
    // SAFETY: the caller's context is current.
    unsafe {
        let program = gl.create_program().unwrap();
        for (kind, text) in [(glow::VERTEX_SHADER, VERTEX), (glow::FRAGMENT_SHADER, FRAGMENT)] {
            let shader = gl.create_shader(kind).unwrap();
            gl.shader_source(shader, &format!("{head}{text}"));
            gl.compile_shader(shader);
            assert!(gl.get_shader_compile_status(shader), "{}", gl.get_shader_info_log(shader));
            gl.attach_shader(program, shader);
        }
        gl.transform_feedback_varyings(program, &["caught"], glow::INTERLEAVED_ATTRIBS);
        gl.link_program(program);
        assert!(gl.get_program_link_status(program));
        program
    }
}

unsafe fn buffer(gl: &glow::Context, target: u32) -> glow::Buffer {
    // SAFETY: the caller's context is current.
    unsafe {
        let name = gl.create_buffer().unwrap();
        gl.bind_buffer(target, Some(name));
        gl.buffer_data_u8_slice(target, &[0x5A; 4096], glow::DYNAMIC_DRAW);
        name
    }
}

/// Sets everything to values other than those of a fresh context. Returns the objects whose own state must not change
/// either. A transform feedback is left running.
pub fn set(host: &Host, api: Api) -> Objects {
    let gl = &host.gl;
    let es = matches!(api, Api::Es(..));
    let mut objects = Objects::default();
    // SAFETY: the host's context is current; only its own names are used.
    unsafe {
        let version = (gl.version().major, gl.version().minor);
        raster(gl, es, version);
        if let Api::Compatibility(..) = api {
            compatibility(); // before an unpack buffer is bound, from which the stipple would come
        }
        bindings(gl, es, version, &mut objects);
        pixel_store(gl, es, version);
        feedback(gl, &objects);
        assert_eq!(gl.get_error(), 0, "the host's own calls are right");
    }
    objects
}

unsafe fn raster(gl: &glow::Context, es: bool, version: (u32, u32)) {
    // SAFETY: the caller's context is current.
    unsafe {
        for cap in [
            glow::CULL_FACE,
            glow::DEPTH_TEST,
            glow::STENCIL_TEST,
            glow::SCISSOR_TEST,
            glow::BLEND,
            glow::POLYGON_OFFSET_FILL,
            glow::SAMPLE_ALPHA_TO_COVERAGE,
            glow::SAMPLE_COVERAGE,
            glow::RASTERIZER_DISCARD,
        ] {
            gl.enable(cap);
        }
        gl.disable(glow::DITHER);
        gl.viewport(3, 5, 7, 11);
        gl.scissor(1, 2, 3, 4);
        gl.depth_range_f32(0.25, 0.5);
        gl.depth_func(glow::NEVER);
        gl.depth_mask(false);
        gl.clear_depth_f32(0.375);
        gl.clear_stencil(77);
        gl.clear_color(0.1, 0.2, 0.3, 0.4);
        gl.color_mask(true, false, true, false);
        gl.stencil_func_separate(glow::FRONT, glow::LESS, 3, 0x3C);
        gl.stencil_func_separate(glow::BACK, glow::GREATER, 5, 0xC3);
        gl.stencil_mask_separate(glow::FRONT, 0x0F);
        gl.stencil_mask_separate(glow::BACK, 0xF0);
        gl.stencil_op_separate(glow::FRONT, glow::INCR, glow::DECR, glow::INVERT);
        gl.stencil_op_separate(glow::BACK, glow::ZERO, glow::REPLACE, glow::INCR_WRAP);
        gl.cull_face(glow::FRONT_AND_BACK);
        gl.front_face(glow::CW);
        gl.polygon_offset(2.5, -3.5);
        gl.blend_color(0.6, 0.7, 0.8, 0.9);
        gl.blend_func_separate(glow::ONE, glow::CONSTANT_COLOR, glow::ZERO, glow::DST_ALPHA);
        gl.blend_equation_separate(glow::FUNC_SUBTRACT, glow::MAX);
        gl.sample_coverage(0.125, true);
        gl.line_width(1.0);
        gl.hint(glow::FRAGMENT_SHADER_DERIVATIVE_HINT, glow::NICEST);
        let indexed: bool = if es { version >= (3, 2) } else { version >= (4, 0) };
        if indexed {
            gl.disable_draw_buffer(glow::BLEND, 1);
            gl.color_mask_draw_buffer(2, false, true, false, true);
            gl.blend_func_separate_draw_buffer(3, glow::SRC_COLOR, glow::ONE, glow::ONE, glow::ONE);
            gl.blend_equation_separate_draw_buffer(3, glow::MIN, glow::FUNC_ADD);
            let least: unsafe extern "system" fn(f32) = function("glMinSampleShading");
            least(0.5);
            gl.enable(glow::SAMPLE_SHADING);
        }
        if version >= (3, 2) || es && version >= (3, 1) {
            gl.enable(glow::SAMPLE_MASK);
            let mask: unsafe extern "system" fn(u32, u32) = function("glSampleMaski");
            mask(0, 0x5);
        }
        if es {
            gl.enable(glow::PRIMITIVE_RESTART_FIXED_INDEX);
            return;
        }
        for cap in [
            glow::COLOR_LOGIC_OP,
            glow::LINE_SMOOTH,
            glow::POLYGON_SMOOTH,
            glow::POLYGON_OFFSET_LINE,
            glow::POLYGON_OFFSET_POINT,
            glow::DEPTH_CLAMP,
            glow::PRIMITIVE_RESTART,
            glow::SAMPLE_ALPHA_TO_ONE,
            glow::PROGRAM_POINT_SIZE,
            glow::CLIP_DISTANCE0,
            glow::CLIP_DISTANCE0 + 5,
            glow::FRAMEBUFFER_SRGB,
        ] {
            gl.enable(cap);
        }
        gl.disable(glow::MULTISAMPLE);
        let one: unsafe extern "system" fn(u32) = function("glLogicOp");
        one(glow::XOR);
        let one: unsafe extern "system" fn(u32) = function("glPrimitiveRestartIndex");
        one(12345);
        gl.polygon_mode(glow::FRONT_AND_BACK, glow::LINE);
        let one: unsafe extern "system" fn(u32) = function("glProvokingVertex");
        one(glow::FIRST_VERTEX_CONVENTION);
        let clamp: unsafe extern "system" fn(u32, u32) = function("glClampColor");
        clamp(0x891C, 1); // read colour
        if version >= (4, 1) {
            let view: unsafe extern "system" fn(u32, f32, f32, f32, f32) = function("glViewportIndexedf");
            view(4, 0.5, 1.25, 20.0, 30.0);
            let scissor: unsafe extern "system" fn(u32, i32, i32, i32, i32) = function("glScissorIndexed");
            scissor(5, 9, 8, 7, 6);
            let range: unsafe extern "system" fn(u32, f64, f64) = function("glDepthRangeIndexed");
            range(6, 0.125, 0.625);
            gl.disable_draw_buffer(glow::SCISSOR_TEST, 7);
        }
        if version >= (4, 5) {
            let clip: unsafe extern "system" fn(u32, u32) = function("glClipControl");
            clip(glow::UPPER_LEFT, glow::ZERO_TO_ONE);
        }
        if gl.supported_extensions().contains("GL_ARB_polygon_offset_clamp") {
            let offset: unsafe extern "system" fn(f32, f32, f32) = function("glPolygonOffsetClamp");
            offset(2.5, -3.5, 0.75);
        }
    }
}

/// Sets state that only the compatibility profile has.
unsafe fn compatibility() {
    // SAFETY: the caller's context is current; each is the named function's type.
    unsafe {
        let enable: unsafe extern "system" fn(u32) = function("glEnable");
        for cap in [0x0BC0, 0x0B42, 0x0B24, 0x0B60] {
            enable(cap); // alpha test, polygon and line stipple, fog
        }
        let alpha: unsafe extern "system" fn(u32, f32) = function("glAlphaFunc");
        alpha(glow::NEVER, 0.5);
        let stipple: unsafe extern "system" fn(*const u8) = function("glPolygonStipple");
        stipple([0u8; 128].as_ptr());
        let mode: unsafe extern "system" fn(u32, u32) = function("glPolygonMode");
        mode(glow::FRONT, glow::POINT);
        mode(glow::BACK, glow::LINE);
        let clamp: unsafe extern "system" fn(u32, u32) = function("glClampColor");
        clamp(0x891A, 1);
        clamp(0x891B, 1);
        let transfer: unsafe extern "system" fn(u32, f32) = function("glPixelTransferf");
        transfer(0x0D14, 0.5); // red scale
        transfer(0x0D19, 0.25); // green bias
        transfer(0x0D1E, 0.5); // depth scale
        let shade: unsafe extern "system" fn(u32) = function("glShadeModel");
        shade(0x1D00);
    }
}

unsafe fn pixel_store(gl: &glow::Context, es: bool, version: (u32, u32)) {
    let set = |list: &[(u32, i32)]| {
        for &(name, value) in list {
            // SAFETY: the caller's context is current.
            unsafe { gl.pixel_store_i32(name, value) };
        }
    };
    // unpack, then pack: alignment, row length, skips, image height
    set(&[(0x0CF5, 8), (0x0CF2, 100), (0x0CF3, 3), (0x0CF4, 5), (0x806D, 1), (0x806E, 60)]);
    set(&[(0x0D05, 2), (0x0D02, 90), (0x0D03, 2), (0x0D04, 7)]);
    if !es {
        set(&[(0x0CF0, 1), (0x0CF1, 1), (0x0D00, 1), (0x0D01, 1), (0x806B, 1), (0x806C, 50)]);
    }
    if !es && version >= (4, 2) {
        set(&[(0x9127, 4), (0x9128, 4), (0x912A, 16), (0x912B, 4), (0x912E, 16)]);
    }
}

unsafe fn bindings(gl: &glow::Context, es: bool, version: (u32, u32), objects: &mut Objects) {
    let later = if es { version >= (3, 1) } else { version >= (4, 3) };
    // SAFETY: the caller's context is current.
    unsafe {
        // A vertex array of the host's own, with elements and attributes.
        let array = gl.create_vertex_array().unwrap();
        gl.bind_vertex_array(Some(array));
        buffer(gl, glow::ELEMENT_ARRAY_BUFFER);
        buffer(gl, glow::ARRAY_BUFFER);
        for i in [0, 3] {
            gl.enable_vertex_attrib_array(i);
            gl.vertex_attrib_pointer_f32(i, 3, glow::FLOAT, false, 28, 4 * i as i32);
        }
        gl.vertex_attrib_divisor(3, 2);
        objects.arrays = vec![Some(array)];
        let uniform = buffer(gl, glow::UNIFORM_BUFFER);
        gl.bind_buffer_base(glow::UNIFORM_BUFFER, 0, Some(uniform));
        gl.bind_buffer_range(glow::UNIFORM_BUFFER, 1, Some(uniform), 256, 512);
        gl.bind_buffer_range(glow::UNIFORM_BUFFER, 7, Some(uniform), 512, 16);
        if later {
            for target in [glow::DRAW_INDIRECT_BUFFER, glow::DISPATCH_INDIRECT_BUFFER] {
                buffer(gl, target);
            }
            let storage = buffer(gl, glow::SHADER_STORAGE_BUFFER);
            gl.bind_buffer_range(glow::SHADER_STORAGE_BUFFER, 0, Some(storage), 256, 1024);
            gl.bind_buffer_base(glow::SHADER_STORAGE_BUFFER, 3, Some(storage));
        }
        if !es && version >= (4, 4) {
            buffer(gl, 0x9192); // query buffer
        }
        textures(gl, later, objects);
        objects.programs.push({
            let program = program(gl, es);
            gl.use_program(Some(program));
            let tint = gl.get_uniform_location(program, "tint").unwrap();
            gl.uniform_4_f32(Some(&tint), 0.1, 0.2, 0.3, 0.4);
            (program, tint.0 as i32)
        });
        // Different framebuffers for drawing and reading, with lists of buffers of their own.
        let color = crate::images::texture(gl, glow::RGBA8);
        let draw = crate::images::framebuffer(gl, crate::images::image_of(color), None);
        let read = crate::images::framebuffer(gl, crate::images::image_of(color), None);
        gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(draw));
        gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(read));
        gl.read_buffer(glow::NONE);
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(crate::images::renderbuffer(gl, glow::RGBA8, 1)));
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(crate::images::renderbuffer(gl, glow::RGBA8, 1)));
        objects.framebuffers = vec![Some(draw), Some(read)];
        // Last, because uploads read from the unpack buffer while one is bound.
        for target in
            [glow::COPY_READ_BUFFER, glow::COPY_WRITE_BUFFER, glow::PIXEL_PACK_BUFFER, glow::PIXEL_UNPACK_BUFFER]
        {
            buffer(gl, target);
        }
    }
}

/// Binds objects to many texture units, samplers and image units.
unsafe fn textures(gl: &glow::Context, later: bool, objects: &mut Objects) {
    // SAFETY: the caller's context is current.
    unsafe {
        let flat = crate::images::texture(gl, glow::RGBA8);
        objects.textures.push((glow::TEXTURE_2D, flat));
        let sampler = gl.create_sampler().unwrap();
        gl.sampler_parameter_i32(sampler, glow::TEXTURE_COMPARE_MODE, glow::COMPARE_REF_TO_TEXTURE as i32);
        gl.sampler_parameter_i32(sampler, glow::TEXTURE_MIN_FILTER, glow::LINEAR_MIPMAP_LINEAR as i32);
        objects.samplers.push(sampler);
        for unit in [0, 1, 4, 9, 15, 17] {
            gl.active_texture(glow::TEXTURE0 + unit);
            gl.bind_texture(glow::TEXTURE_2D, Some(flat));
            gl.bind_sampler(unit, Some(sampler));
            for target in [glow::TEXTURE_3D, glow::TEXTURE_2D_ARRAY, glow::TEXTURE_CUBE_MAP] {
                let name = gl.create_texture().unwrap();
                gl.bind_texture(target, Some(name));
            }
        }
        gl.active_texture(glow::TEXTURE0 + 17); // further than wgpu goes
        if later {
            let image = gl.create_texture().unwrap();
            gl.bind_texture(glow::TEXTURE_2D, Some(image));
            gl.tex_storage_2d(glow::TEXTURE_2D, 2, glow::RGBA8, 16, 16);
            gl.bind_image_texture(0, Some(image), 1, false, 0, glow::READ_ONLY, glow::RGBA8);
            gl.bind_image_texture(2, Some(image), 0, false, 0, glow::WRITE_ONLY, glow::RGBA8);
        }
    }
}

/// Starts a transform feedback and leaves it running.
unsafe fn feedback(gl: &glow::Context, objects: &Objects) {
    // SAFETY: the caller's context is current.
    unsafe {
        let object = gl.create_transform_feedback().unwrap();
        gl.bind_transform_feedback(glow::TRANSFORM_FEEDBACK, Some(object));
        let caught = buffer(gl, glow::TRANSFORM_FEEDBACK_BUFFER);
        gl.bind_buffer_base(glow::TRANSFORM_FEEDBACK_BUFFER, 0, Some(caught));
        gl.use_program(Some(objects.programs[0].0));
        gl.begin_transform_feedback(glow::TRIANGLES);
    }
}

/// Restores the state that would keep the host from reading a picture.
pub fn calm(host: &Host, api: Api) {
    let gl = &host.gl;
    // SAFETY: the host's context is current.
    unsafe {
        gl.end_transform_feedback();
        gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
        for (name, value) in [(0x0D05, 4), (0x0D02, 0), (0x0D03, 0), (0x0D04, 0), (0x806B, 0), (0x0D00, 0), (0x0D01, 0)]
        {
            gl.pixel_store_i32(name, value);
        }
        gl.get_error(); // OpenGL ES does not know the last three
        gl.disable(glow::SCISSOR_TEST);
        if let Api::Compatibility(..) = api {
            let transfer: unsafe extern "system" fn(u32, f32) = function("glPixelTransferf");
            transfer(0x0D14, 1.0);
            transfer(0x0D19, 0.0);
        }
    }
}

/// The bytes of the buffer bound to `target`.
pub fn bytes(gl: &glow::Context, target: u32) -> Vec<u8> {
    // SAFETY: the buffer has 4096 bytes and is unmapped again.
    unsafe {
        let map: unsafe extern "system" fn(u32, isize, isize, u32) -> *const c_void = function("glMapBufferRange");
        let bytes = std::slice::from_raw_parts(map(target, 0, 4096, glow::MAP_READ_BIT).cast::<u8>(), 4096).to_vec();
        gl.unmap_buffer(target);
        bytes
    }
}
