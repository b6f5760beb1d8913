//! The terrain's water in an OpenGL host's own shaders: at the nodes the cells of the CPU's copy, the right way up, and
//! between the nodes the values of the queries.

use glow::HasContext;
use welkin::capi::{
    device::*, frame::*, ground::*, ground_grid::*, ground_texture::*, status::*, terrain::*, veil::*, view::*,
};
use welkin::gpu::gl::GlMode;
use welkin_support::{
    c_scene::{Scene, ground::*, init, ok},
    egl::{Api, Window},
};

use crate::capi::{device, target};
use crate::{
    frame,
    host::Host,
    images::{framebuffer, image_of, texture as image},
    painter::{CORNERS, program},
};

/// Samples a texel this often along either side.
const FINE: u32 = 4;

/// Output of the host's fragment shader: the filtered texture, or the result of the published functions.
const SAMPLED: &str = "colour = texture(ground, uv);";
const LOOK: &str = "WelkinGround w = welkin_ground(ground, uv); colour = vec4(w.soaked, w.film, w.pool, w.ice);";
const MATERIAL: &str = "WelkinGround w = welkin_ground(ground, uv);
    colour = vec4(welkin_wet_albedo(vec3(0.1, 0.5, 0.0), w).xy, welkin_film(w));";

fn looking(gl: &glow::Context, api: Api, writes: &str) -> glow::Program {
    let mut text = std::ptr::null();
    // SAFETY: live pointers.
    let snippet = unsafe {
        ok(wk_get_ground_snippet(WK_SHADING_GLSL, &mut text));
        std::ffi::CStr::from_ptr(text).to_str().unwrap()
    };
    let fragment = format!(
        "uniform sampler2D ground;\nuniform vec2 size;\nout vec4 colour;\n{snippet}\nvoid main() {{\n    \
         vec2 uv = gl_FragCoord.xy / size;\n    {writes}\n}}"
    );
    program(gl, matches!(api, Api::Es(..)), CORNERS, &fragment)
}

/// Draws the output `writes` over the texture, `fine` pixels a texel along either side; rows from the south.
fn drawn(host: &Host, api: Api, from: &wk_ground_texture, fine: u32, writes: &str) -> Vec<[f32; 4]> {
    let gl = &host.gl;
    let (width, height) = ((fine * from.width) as i32, (fine * from.height) as i32);
    let mut pixels = vec![[0.0_f32; 4]; (width * height) as usize];
    // SAFETY: the host's context is current, names and sizes are live.
    unsafe {
        let program = looking(gl, api, writes);
        let out = gl.create_texture().unwrap();
        gl.bind_texture(glow::TEXTURE_2D, Some(out));
        gl.tex_storage_2d(glow::TEXTURE_2D, 1, glow::RGBA32F, width, height);
        let fbo = gl.create_framebuffer().unwrap();
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo));
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, glow::TEXTURE_2D, Some(out), 0);
        assert_eq!(gl.check_framebuffer_status(glow::FRAMEBUFFER), glow::FRAMEBUFFER_COMPLETE);
        let name = glow::NativeTexture(u32::try_from(from.texture).unwrap().try_into().unwrap());
        gl.bind_texture(glow::TEXTURE_2D, Some(name));
        let sampler = gl.create_sampler().unwrap();
        for (parameter, value) in [
            (glow::TEXTURE_MIN_FILTER, glow::LINEAR),
            (glow::TEXTURE_MAG_FILTER, glow::LINEAR),
            (glow::TEXTURE_WRAP_S, glow::CLAMP_TO_EDGE),
            (glow::TEXTURE_WRAP_T, glow::CLAMP_TO_EDGE),
        ] {
            gl.sampler_parameter_i32(sampler, parameter, value as i32);
        }
        gl.bind_sampler(0, Some(sampler));
        let vertices = gl.create_vertex_array().unwrap();
        gl.bind_vertex_array(Some(vertices));
        gl.use_program(Some(program));
        gl.uniform_2_f32(gl.get_uniform_location(program, "size").as_ref(), width as f32, height as f32);
        gl.viewport(0, 0, width, height);
        gl.draw_arrays(glow::TRIANGLES, 0, 3);
        let room = glow::PixelPackData::Slice(Some(bytemuck::cast_slice_mut(&mut pixels)));
        gl.read_pixels(0, 0, width, height, glow::RGBA, glow::FLOAT, room);
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
    pixels
}

/// Returns the place of pixel `i` of a picture with `fine` pixels a texel, in nodes; `None` in the outer half of the
/// border's texels.
fn place(from: &wk_ground_texture, fine: u32, i: usize) -> Option<[f64; 2]> {
    let width = (fine * from.width) as usize;
    let at = [i % width, i / width].map(|p| (p as f64 + 0.5) / f64::from(fine) - 0.5);
    let last = [from.width, from.height].map(|n| f64::from(n - 1));
    (0..2).all(|k| (0.0..=last[k]).contains(&at[k])).then_some(at)
}

fn water_at(scene: &Scene, at: [f64; 2]) -> wk_ground {
    let position = [ORIGIN[0] + at[0] * CELL_M, ORIGIN[1] + at[1] * CELL_M, ORIGIN[2]];
    let mut ground = init("wk_ground");
    // SAFETY: live pointers.
    ok(unsafe { wk_context_get_ground(scene.context, &position, &mut ground) });
    ground
}

/// Checks everything about the texture at this moment.
#[track_caller]
fn assert_shown(host: &Host, api: Api, scene: &Scene, from: &wk_ground_texture) {
    let (cells, revision) = cells(scene, (from.width * from.height) as usize);
    assert_eq!(from.revision, revision);
    let texels = drawn(host, api, from, 1, SAMPLED);
    assert_cells(&texels, &cells);
    // The texture's coordinates correspond to the nodes in the host's world.
    let place_of = |at: [f64; 2]| [ORIGIN[0] + at[0] * CELL_M, ORIGIN[1] + at[1] * CELL_M, ORIGIN[2], 1.0];
    for (at, wanted) in [([0.0, 0.0], [0.5, 0.5]), ([3.0, 4.5], [3.5, 5.0])] {
        let uv = from.uv_from_world.map(|row| row.iter().zip(place_of(at)).map(|(a, b)| a * b).sum::<f64>());
        let texel = [uv[0] * f64::from(from.width), uv[1] * f64::from(from.height)];
        assert!((texel[0] - wanted[0]).abs() + (texel[1] - wanted[1]).abs() < 1e-9, "{texel:?} {wanted:?}");
    }
    // Between nodes the sampler agrees with the queries, within the precision of filtering.
    let steepest = texels.iter().map(|t| t[0] + t[2].abs()).fold(0.0, f32::max) / 128.0 + 1e-4;
    for (i, pixel) in drawn(host, api, from, FINE, SAMPLED).iter().enumerate() {
        let Some(at) = place(from, FINE, i) else { continue };
        let wanted = water_at(scene, at);
        let water = pixel[0] + pixel[2].max(0.0);
        assert!((water - wanted.water_mm as f32).abs() < steepest, "{at:?}: {pixel:?}, {}", wanted.water_mm);
    }
}

/// Compares the appearance at the nodes and between them by the published functions and by the queries.
fn assert_looks(host: &Host, api: Api, scene: &Scene, from: &wk_ground_texture) {
    let smooth = |low: f64, high: f64, x: f64| {
        let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let node = |x: u32, y: u32| {
        let water = water_at(scene, [f64::from(x), f64::from(y)]);
        [smooth(0.0, 0.3, water.wetness), smooth(0.3, 1.0, water.wetness)]
    };
    let material = drawn(host, api, from, FINE, MATERIAL);
    let mut seen = [0; 3];
    for (i, pixel) in drawn(host, api, from, FINE, LOOK).iter().enumerate() {
        let Some(at) = place(from, FINE, i) else { continue };
        let low = [at[0] as u32, at[1] as u32];
        let part = [at[0].fract(), at[1].fract()];
        let corner = |x: u32, y: u32| node((low[0] + x).min(from.width - 1), (low[1] + y).min(from.height - 1));
        let corners = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
        let mix = |a: f64, b: f64, t: f64| a + t * (b - a);
        let look = [0, 1].map(|k| {
            let row = |j: usize| mix(corners[j][k], corners[j + 1][k], part[0]);
            mix(row(0), row(2), part[1]) as f32
        });
        assert!((pixel[0] - look[0]).abs() < 2e-3 && (pixel[1] - look[1]).abs() < 2e-3, "{at:?}: {pixel:?} {look:?}");
        let ground = water_at(scene, at);
        assert!(ground.in_puddle == 1 || pixel[2] == 0.0, "{at:?}: {pixel:?}");
        assert!(ground.water_mm - ground.film_mm < 2.01 || pixel[2] == 1.0, "{at:?}: {pixel:?}");
        // Soaked ground is darkened by Angstrom's law: an albedo of 0.1 becomes 0.051, and 0.5 becomes 0.32.
        let wet = |albedo: f32| albedo * (1.0 - 0.0664) * (1.0 - 0.4746) / (1.0 - 0.4746 * albedo);
        for (k, albedo) in [0.1, 0.5].into_iter().enumerate() {
            let wanted = albedo + look[0] * (wet(albedo) - albedo);
            assert!((material[i][k] - wanted).abs() < 2e-3, "{at:?}: {:?} {wanted}", material[i]);
        }
        let share = look[1] + pixel[2] * (1.0 - look[1]);
        let alpha = 2f32.sqrt() * (0.3 - 0.15 * look[1]) * (1.0 - pixel[2]);
        assert!(
            (material[i][2] - share).abs() < 2e-3 && (material[i][3] - alpha).abs() < 2e-3,
            "{at:?}: {:?}",
            material[i]
        );
        for (count, found) in seen.iter_mut().zip([pixel[0] < 0.1, pixel[1] > 0.5, pixel[2] > 0.5]) {
            *count += u32::from(found);
        }
    }
    assert!(seen.iter().all(|n| *n > 10), "dry places, films and puddles: {seen:?}");
}

#[test]
fn a_hosts_shader_finds_the_cells_water_in_the_texture() {
    for (api, mode) in [
        (Api::Core(3, 3), GlMode::Shared),
        (Api::Es(3, 1), GlMode::Shared),
        (Api::Compatibility(4, 5), GlMode::HostContext),
    ] {
        let host = Host::new(api, Window::None, mode);
        let device = device(&host);
        let scene = scene(device);
        assert_none(&scene);
        set_grid(&scene, [9, 6]);
        let dry = texture(&scene);
        assert_shown(&host, api, &scene, &dry);
        rain(&scene, 12.0, 0.0, 1800.0);
        let wet = texture(&scene);
        assert_shown(&host, api, &scene, &wet);
        assert_looks(&host, api, &scene, &wet);
        assert!(wet.revision != dry.revision);
        rain(&scene, 0.0, 1800.0, 5400.0);
        let drier = texture(&scene);
        assert_shown(&host, api, &scene, &drier);
        let names = |t: &wk_ground_texture| (t.texture, t.generation);
        assert_eq!([names(&wet), names(&drier)], [names(&dry); 2], "it stays the same");
        assert_eq!(texture(&scene).revision, drier.revision, "standing time changes nothing");
        set_grid(&scene, [4, 11]);
        let other = texture(&scene);
        assert!(other.generation != wet.generation && (other.width, other.height) == (4, 11));
        assert_shown(&host, api, &scene, &other);
        // SAFETY: live handles.
        unsafe {
            ok(wk_context_set_ground_grid(scene.context, std::ptr::null()));
            assert_none(&scene);
            scene.destroy();
            ok(wk_device_destroy(device));
        }
    }
}

#[test]
fn the_host_samples_the_water_that_the_frame_draws() {
    let api = Api::Core(3, 3);
    let host = Host::new(api, Window::None, GlMode::Shared);
    let color = image_of(image(&host.gl, glow::RGBA8));
    let depth = image_of(image(&host.gl, glow::DEPTH_COMPONENT32F));
    framebuffer(&host.gl, color, Some(depth));
    let device = device(&host);
    let scene = scene(device);
    set_grid(&scene, [9, 6]);
    rain(&scene, 12.0, 0.0, 600.0);
    let before = texture(&scene);
    rain(&scene, 12.0, 600.0, 1200.0);
    let target = target(color, depth);
    let frame = wk_frame { target: (&raw const target).cast(), ..frame(1) };
    // SAFETY: live handles.
    ok(unsafe { wk_view_record(scene.view, &frame, WK_STAGE_ALL) });
    // The texture is not requested again: the frame has uploaded the water once for both.
    let (cells, revision) = cells(&scene, 54);
    assert_cells(&drawn(&host, api, &before, 1, SAMPLED), &cells);
    let after = texture(&scene);
    assert_eq!((after.texture, after.generation, after.revision), (before.texture, before.generation, revision));
    scene.destroy();
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
}

#[test]
fn the_water_of_tiles_about_a_place_is_a_texture_of_the_hosts_too() {
    let api = Api::Core(3, 3);
    let host = Host::new(api, Window::None, GlMode::Shared);
    let device = device(&host);
    let scene = scene(device);
    let desc = wk_terrain { tile_cells: 32, ..init("wk_terrain") };
    let slope = |i: usize| 0.05 * ((i % 7) as f32 - 3.0).abs();
    let heights: Vec<f32> = (0..32 * 32).map(|i| slope(i % 32) + slope(i / 32)).collect();
    let tile = wk_terrain_cells { heights_m: heights.as_ptr(), height_count: 32 * 32, ..init("wk_terrain_cells") };
    let center = [40.0, 8.0, 0.0];
    let mut from: wk_ground_texture = init("wk_ground_texture");
    let mut cells = vec![wk_ground_cell { film_mm: 0.0, soaked: 0.0, standing_mm: 0.0, ice: 0.0 }; 32 * 32];
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_context_get_terrain_texture(scene.context, &center, &mut from), WK_ERROR_WRONG_ORDER);
        ok(wk_context_set_terrain(scene.context, &desc));
        ok(wk_context_set_terrain_tile(scene.context, &tile));
        rain(&scene, 12.0, 0.0, 1800.0);
        ok(wk_context_get_terrain_texture(scene.context, &center, &mut from));
        let size = size_of::<wk_ground_cell>() as u32;
        ok(wk_context_get_terrain_water(scene.context, 0, 0, cells.as_mut_ptr(), 32 * 32, size, &mut 0));
    }
    assert_eq!((from.width, from.height, from.snow_texture), (512, 512, 0));
    let texels = drawn(&host, api, &from, 1, SAMPLED);
    for (i, cell) in cells.iter().enumerate() {
        let at = [(i % 32) as f64, (i / 32) as f64, 0.0, 1.0];
        let [x, y] = from.uv_from_world.map(|row| row.iter().zip(at).map(|(a, b)| a * b).sum::<f64>() * 512.0);
        let texel = texels[y as usize * 512 + x as usize];
        let near = |got: f32, wanted: f32| (got - wanted).abs() <= 1e-3 * wanted.abs() + 1e-4;
        let stands = if cell.standing_mm > 0.0 { near(texel[2], cell.standing_mm) } else { texel[2] <= 0.0 };
        assert!(near(texel[0], cell.film_mm) && near(texel[1], cell.soaked) && stands, "{at:?}: {texel:?}");
    }
    assert!(cells.iter().any(|c| c.standing_mm > 1.0) && cells.iter().any(|c| c.film_mm > 0.0));
    scene.destroy();
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
}
