//! The veil in an OpenGL host's own shader, compiled from the published text and run: glass in front of the sky has the
//! same veil as an opaque object at its place.

use glow::HasContext;
use welkin::capi::{device::*, frame::*, veil::*, view::*};
use welkin::gpu::gl::GlMode;
use welkin_support::{
    c_scene::{Scene, ok, veil::*},
    egl::{Api, Window},
};

use crate::SIZE;
use crate::{
    canvas::{Canvas, filled},
    capi::device,
    host::Host,
    images::{framebuffer, image_of},
    painter::{CORNERS, program},
};

const GLASS: &str = "
uniform sampler2D veil_light;
uniform sampler2D veil_through;
uniform vec2 size;
uniform vec2 slopes;
uniform vec4 glass;
uniform float far_m;
uniform float light_scale;
out vec4 colour;
void main() {
    vec2 uv = gl_FragCoord.xy / size;
    vec3 ray = vec3((2.0 * uv - 1.0) * slopes, 1.0);
    vec3 through;
    vec3 light = welkin_veil(veil_light, veil_through, uv, far_m * length(ray), through);
    colour = vec4(glass.rgb * through + light * light_scale, glass.a);
}";

/// Blends the glass over the canvas.
fn draw_glass(gl: &glow::Context, program: glow::Program, canvas: &Canvas, veil: &wk_frame_textures, far_m: f64) {
    let name = |n: u64| glow::NativeTexture(u32::try_from(n).unwrap().try_into().unwrap());
    let (width, height) = (canvas.size.0 as i32, canvas.size.1 as i32);
    // SAFETY: the host's context is current, names and sizes are live.
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(canvas.fbo));
        let sampler = gl.create_sampler().unwrap();
        for (parameter, value) in [
            (glow::TEXTURE_MIN_FILTER, glow::LINEAR),
            (glow::TEXTURE_MAG_FILTER, glow::LINEAR),
            (glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE),
            (glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE),
        ] {
            gl.sampler_parameter_i32(sampler, parameter, value as i32);
        }
        for (unit, texture) in [(0, veil.light), (1, veil.through)] {
            gl.active_texture(glow::TEXTURE0 + unit);
            gl.bind_texture(glow::TEXTURE_2D, Some(name(texture)));
            gl.bind_sampler(unit, Some(sampler));
        }
        let vertices = gl.create_vertex_array().unwrap();
        gl.bind_vertex_array(Some(vertices));
        gl.use_program(Some(program));
        let at = |name: &str| gl.get_uniform_location(program, name);
        gl.uniform_1_i32(at("veil_light").as_ref(), 0);
        gl.uniform_1_i32(at("veil_through").as_ref(), 1);
        gl.uniform_2_f32(at("size").as_ref(), width as f32, height as f32);
        let [x, y] = slopes(canvas.size);
        gl.uniform_2_f32(at("slopes").as_ref(), x, y);
        gl.uniform_4_f32(at("glass").as_ref(), COLOR[0], COLOR[1], COLOR[2], ALPHA);
        gl.uniform_1_f32(at("far_m").as_ref(), far_m as f32);
        gl.uniform_1_f32(at("light_scale").as_ref(), veil.light_scale as f32);
        gl.viewport(0, 0, width, height);
        gl.enable(glow::BLEND);
        gl.blend_func(glow::SRC_ALPHA, glow::ONE_MINUS_SRC_ALPHA);
        gl.draw_arrays(glow::TRIANGLES, 0, 3);
        gl.disable(glow::BLEND);
        gl.use_program(None);
        gl.bind_vertex_array(None);
        for unit in [1, 0] {
            gl.active_texture(glow::TEXTURE0 + unit);
            gl.bind_texture(glow::TEXTURE_2D, None);
            gl.bind_sampler(unit, None);
        }
        gl.delete_vertex_array(vertices);
        gl.delete_sampler(sampler);
        gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        assert_eq!(gl.get_error(), glow::NO_ERROR);
    }
}

fn canvas(gl: &glow::Context, texel: [f32; 3], depth: f32) -> Canvas {
    let pixels = (SIZE.0 * SIZE.1) as usize;
    let half = |v: f32| half::f16::from_f32(v).to_bits();
    let texel = [half(texel[0]), half(texel[1]), half(texel[2]), half(1.0)];
    let color = filled(gl, glow::RGBA16F, SIZE, &vec![texel; pixels]);
    let depth = filled(gl, glow::DEPTH_COMPONENT32F, SIZE, &vec![depth; pixels]);
    let fbo = framebuffer(gl, image_of(color), Some(image_of(depth)));
    Canvas { color, depth, fbo, size: SIZE }
}

/// The host's colours; rows as OpenGL has them.
fn read(gl: &glow::Context, canvas: &Canvas) -> Vec<[f32; 4]> {
    let mut pixels = vec![[0.0_f32; 4]; (SIZE.0 * SIZE.1) as usize];
    // SAFETY: the host's context is current, and there is room for every pixel.
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(canvas.fbo));
        let room = glow::PixelPackData::Slice(Some(bytemuck::cast_slice_mut(&mut pixels)));
        gl.read_pixels(0, 0, SIZE.0 as i32, SIZE.1 as i32, glow::RGBA, glow::FLOAT, room);
        gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        assert_eq!(gl.get_error(), glow::NO_ERROR);
    }
    pixels
}

fn record(scene: &Scene, canvas: &Canvas, id: u64, space: wk_color_space) {
    let mut target = canvas.target();
    target.generation = id;
    let frame = wk_frame { target: (&raw const target).cast(), ..frame(id, SIZE, space) };
    // SAFETY: live handles; the host's context is current.
    ok(unsafe { wk_view_record(scene.view, &frame, STAGES) });
}

#[test]
fn glass_by_the_published_shader_is_what_welkin_draws_before_an_opaque_thing() {
    for (api, mode) in [
        (Api::Core(3, 3), GlMode::Shared),
        (Api::Es(3, 1), GlMode::Shared),
        (Api::Compatibility(4, 5), GlMode::HostContext),
    ] {
        let host = Host::new(api, Window::None, mode);
        let gl = &host.gl;
        let device = device(&host);
        let fragment = format!("{}{GLASS}", snippet(WK_SHADING_GLSL));
        let program = program(gl, matches!(api, Api::Es(..)), CORNERS, &fragment);
        for (rain, space) in CASES {
            let scene = scene(device, rain);
            let mut id = 0;
            for far_m in FAR_M {
                let thing = canvas(gl, COLOR, depth(far_m));
                record(&scene, &thing, id + 1, space);
                let opaque = read(gl, &thing);
                let sky = canvas(gl, [0.0; 3], 0.0);
                record(&scene, &sky, id + 2, space);
                let behind = read(gl, &sky);
                draw_glass(gl, program, &sky, &textures(&scene), far_m);
                let what = format!("{api:?}, {mode:?}, rain {rain}, colour space {space}, {far_m} m");
                assert_mixed(&read(gl, &sky), &behind, &opaque, &what);
                thing.delete(gl);
                sky.delete(gl);
                id += 2;
            }
            scene.destroy();
        }
        // SAFETY: live handles; the host's context is current.
        unsafe {
            gl.delete_program(program);
            ok(wk_device_destroy(device));
        }
    }
}
