//! A host with an unusual state gets the right picture, and its state back.

use glow::HasContext;
use welkin::gpu::gl::GlMode;
use welkin_support::egl::{Api, Window};

use crate::{
    exercise,
    host::{Depth, Host, Picture, close},
    images::*,
    snapshot::Snapshot,
    unusual,
};

fn nothing_leaks(api: Api, mode: GlMode, force_tier0: bool, least_values: usize) {
    let window = Window::Pbuffer(WIDTH as i32, HEIGHT as i32, 0);
    let host = Host::new(api, window, mode);
    let gl = &host.gl;
    let (color_name, depth_name) = (texture(gl, glow::RGBA8), texture(gl, glow::DEPTH_COMPONENT24));
    let (color, depth) = (image_of(color_name), image_of(depth_name));
    let fbo = framebuffer(gl, color, Some(depth));
    // SAFETY: the host's context is current, here and below.
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo));
        clear(gl);
        // A shadow map's parameters on the depth, a mip chain's on the colour.
        gl.bind_texture(glow::TEXTURE_2D, Some(depth_name));
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_COMPARE_MODE, glow::COMPARE_REF_TO_TEXTURE as i32);
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MIN_FILTER, glow::LINEAR as i32);
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_SWIZZLE_R, glow::ONE as i32);
        gl.bind_texture(glow::TEXTURE_2D, Some(color_name));
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAX_LEVEL, 6);
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_SWIZZLE_G, glow::BLUE as i32);
    }
    let mut objects = unusual::set(&host, api);
    objects.textures.extend([(glow::TEXTURE_2D, color_name), (glow::TEXTURE_2D, depth_name)]);
    objects.framebuffers.extend([None, Some(fbo)]);
    let before = Snapshot::take(gl, &objects);
    assert!(before.len() > least_values, "{api:?} tells {} values", before.len());

    let adopted = host.adopt_with(|d| d.force_tier0 = force_tier0);
    assert_same(&before, &Snapshot::take(gl, &objects), "adopt");
    for round in 0..2 {
        {
            let _current = adopted.host.enter().unwrap_or_else(|e| panic!("{e}"));
            let target = adopted
                .host
                .target(&adopted.device.device, &desc(color, Some(depth)))
                .unwrap_or_else(|e| panic!("{e}"));
            exercise::run(&adopted, &target);
            Picture::new(&adopted.device.device, &target, Depth::One).draw(&adopted, &target);
        }
        assert_same(&before, &Snapshot::take(gl, &objects), &format!("record {round}"));
    }
    close(adopted);
    assert_same(&before, &Snapshot::take(gl, &objects), "close");
    for target in [glow::PIXEL_PACK_BUFFER, glow::PIXEL_UNPACK_BUFFER, glow::COPY_WRITE_BUFFER, glow::ARRAY_BUFFER] {
        assert!(unusual::bytes(gl, target).iter().all(|b| *b == 0x5A), "the host's buffers keep what they hold");
    }
    unusual::calm(&host, api);
    // SAFETY: the host's context is current.
    unsafe { gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(fbo)) };
    assert_picture(&read(gl), Blue::Depth, 1);
}

fn assert_same(before: &Snapshot, after: &Snapshot, moment: &str) {
    let differences = before.differences(after);
    assert!(differences.is_empty(), "after {moment}:\n{}", differences.join("\n"));
}

#[test]
fn a_core_context_keeps_its_state() {
    nothing_leaks(Api::Core(4, 5), GlMode::HostContext, false, 1500);
}

#[test]
fn a_core_context_keeps_its_state_on_tier_0() {
    nothing_leaks(Api::Core(3, 3), GlMode::HostContext, true, 1500);
}

#[test]
fn a_compatibility_context_keeps_its_state() {
    nothing_leaks(Api::Compatibility(4, 5), GlMode::HostContext, false, 1500);
}

#[test]
fn an_es_context_keeps_its_state() {
    nothing_leaks(Api::Es(3, 0), GlMode::HostContext, false, 800);
    nothing_leaks(Api::Es(3, 1), GlMode::HostContext, true, 800);
}

#[test]
fn old_contexts_keep_their_state() {
    for mode in [GlMode::HostContext, GlMode::Shared] {
        nothing_leaks(Api::Core(3, 3), mode, false, 700);
        nothing_leaks(Api::Compatibility(3, 3), mode, false, 700);
        nothing_leaks(Api::Es(3, 0), mode, false, 500);
    }
}

/// Drivers give the latest version that they have, whatever a host requests. An environment variable makes this driver
/// an old one: tests that need no more run again in a process with that variable.
#[test]
fn an_old_driver_keeps_the_state() {
    let hidden = [
        "GL_ARB_viewport_array",
        "GL_ARB_draw_buffers_blend",
        "GL_ARB_clip_control",
        "GL_ARB_polygon_offset_clamp",
        "GL_ARB_compute_shader",
        "GL_ARB_shader_storage_buffer_object",
        "GL_ARB_shader_image_load_store",
        "GL_ARB_draw_indirect",
        "GL_ARB_query_buffer_object",
        "GL_ARB_vertex_attrib_binding",
        "GL_ARB_buffer_storage",
        "GL_ARB_sample_shading",
        "GL_ARB_ES3_compatibility",
        "GL_ARB_texture_cube_map_array",
        "GL_ARB_stencil_texturing",
        "GL_KHR_debug",
    ];
    let hidden = hidden.map(|name| format!("-{name}")).join(" ");
    let tests = ["state::old_contexts_keep_their_state", "pictures::textures_of_a_compatibility_context"];
    let outcome = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "--nocapture"])
        .args(tests)
        .env("MESA_GL_VERSION_OVERRIDE", "3.3")
        .env("MESA_GLSL_VERSION_OVERRIDE", "330")
        .env("MESA_GLES_VERSION_OVERRIDE", "3.0")
        .env("MESA_EXTENSION_OVERRIDE", hidden)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&outcome.stdout) + String::from_utf8_lossy(&outcome.stderr);
    assert!(outcome.status.success() && text.contains("2 passed"), "{text}");
}

#[test]
fn a_shared_context_keeps_the_hosts_state() {
    nothing_leaks(Api::Core(4, 5), GlMode::Shared, false, 1500);
    nothing_leaks(Api::Compatibility(3, 3), GlMode::Shared, true, 1500);
    nothing_leaks(Api::Es(3, 0), GlMode::Shared, false, 800);
}
