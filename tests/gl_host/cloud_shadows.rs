//! The clouds' shadows in an OpenGL host's own shader, compiled from the published text and run.

use glow::HasContext;
use welkin::capi::{cloud_shadow::*, device::*, veil::*};
use welkin::gpu::gl::GlMode;
use welkin_support::{
    c_scene::{Scene, cloud_shadows::*, ok},
    egl::{Api, Window},
};

use crate::{
    SIZE,
    capi::device,
    host::Host,
    painter::{CORNERS, program},
};

const SHADED: &str = "
uniform sampler2D shadow_map;
uniform vec4 rows[3];
uniform vec2 camera_uv;
uniform vec3 even;
uniform vec2 square; // places along a side, metres between them
out vec4 colour;
void main() {
    vec4 place = vec4((gl_FragCoord.xy - 0.5 * square.x) * square.y, 0.0, 1.0);
    vec2 uv = vec2(dot(rows[0], place), dot(rows[1], place));
    colour = vec4(welkin_cloud_shadow(shadow_map, uv, camera_uv, dot(rows[2], place), even));
}";

/// The published sampling function.
fn snippet() -> &'static str {
    let mut text = std::ptr::null();
    // SAFETY: live pointers; the text lives as long as the process.
    unsafe {
        ok(wk_get_cloud_shadow_snippet(WK_SHADING_GLSL, &mut text));
        std::ffi::CStr::from_ptr(text).to_str().unwrap()
    }
}

/// Shares of direct light at the places of a square, as the host's shader computes them; rows run to the north.
fn drawn(host: &Host, api: Api, map: &wk_cloud_shadows) -> Vec<f64> {
    let gl = &host.gl;
    let side = SIDE as i32;
    let mut pixels = vec![[0.0_f32; 4]; (SIDE * SIDE) as usize];
    let fragment = format!("{}{SHADED}", snippet());
    // SAFETY: the host's context is current, names and sizes are live.
    unsafe {
        let program = program(gl, matches!(api, Api::Es(..)), CORNERS, &fragment);
        let out = gl.create_texture().unwrap();
        gl.bind_texture(glow::TEXTURE_2D, Some(out));
        gl.tex_storage_2d(glow::TEXTURE_2D, 1, glow::RGBA32F, side, side);
        let fbo = gl.create_framebuffer().unwrap();
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo));
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, glow::TEXTURE_2D, Some(out), 0);
        let name = glow::NativeTexture(u32::try_from(map.texture).unwrap().try_into().unwrap());
        gl.bind_texture(glow::TEXTURE_2D, Some(name));
        let sampler = gl.create_sampler().unwrap();
        for (parameter, value) in [
            (glow::TEXTURE_MIN_FILTER, glow::LINEAR),
            (glow::TEXTURE_MAG_FILTER, glow::LINEAR),
            (glow::TEXTURE_WRAP_S, glow::REPEAT),
            (glow::TEXTURE_WRAP_T, glow::REPEAT),
        ] {
            gl.sampler_parameter_i32(sampler, parameter, value as i32);
        }
        gl.bind_sampler(0, Some(sampler));
        let vertices = gl.create_vertex_array().unwrap();
        gl.bind_vertex_array(Some(vertices));
        gl.use_program(Some(program));
        let at = |name: &str| gl.get_uniform_location(program, name);
        let [u, v] = map.uv_from_world;
        let rows: Vec<f32> = [u, v, map.height_from_world].iter().flatten().map(|x| *x as f32).collect();
        gl.uniform_4_f32_slice(at("rows").as_ref(), &rows);
        gl.uniform_2_f32(at("camera_uv").as_ref(), map.camera_uv[0] as f32, map.camera_uv[1] as f32);
        gl.uniform_3_f32(at("even").as_ref(), map.mean_share as f32, map.map_weight as f32, map.top_m as f32);
        gl.uniform_2_f32(at("square").as_ref(), SIDE as f32, APART_M as f32);
        gl.viewport(0, 0, side, side);
        gl.draw_arrays(glow::TRIANGLES, 0, 3);
        let room = glow::PixelPackData::Slice(Some(bytemuck::cast_slice_mut(&mut pixels)));
        gl.read_pixels(0, 0, side, side, glow::RGBA, glow::FLOAT, room);
        assert_eq!(gl.get_error(), glow::NO_ERROR);
        gl.bind_sampler(0, None);
        gl.bind_vertex_array(None);
        gl.use_program(None);
        gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        gl.bind_texture(glow::TEXTURE_2D, None);
        gl.delete_texture(out);
        gl.delete_framebuffer(fbo);
        gl.delete_program(program);
        gl.delete_sampler(sampler);
        gl.delete_vertex_array(vertices);
    }
    pixels.iter().map(|p| f64::from(p[0])).collect()
}

#[test]
fn a_hosts_shader_finds_the_shadow_of_each_place() {
    for (api, mode) in [(Api::Core(3, 3), GlMode::Shared), (Api::Compatibility(4, 5), GlMode::HostContext)] {
        let host = Host::new(api, Window::None, mode);
        let device = device(&host);
        let scene = Scene::new(device);
        scatter(&scene);
        let map = whole(&scene, SIZE);
        assert_shares(&scene, &drawn(&host, api, &map));
        scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(device) });
    }
}
