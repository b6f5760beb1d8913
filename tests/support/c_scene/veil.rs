//! A glass object in fog and in rain. Compares what a host's own shader draws of it with the frame's veil to what
//! Welkin draws in front of an opaque object at the same place.

use welkin::capi::{device::*, frame::*, status::*, timeline::*, veil::*, view::*, weather::*, weather_kinds::*};

use super::{Scene, frame_of, init, ok, own::Size};

/// Colour of the object, in units of 1000 cd/m^2 or as a display value.
pub const COLOR: [f32; 3] = [0.1, 0.3, 0.6];
/// Opacity of the object.
pub const ALPHA: f32 = 0.5;
pub const STAGES: wk_stage_flags = WK_STAGE_PREPARE | WK_STAGE_BACKGROUND | WK_STAGE_MEDIUM;
/// Whether it rains, and the frame's colour space. sRGB-encoded values are left out, as they cannot blend glass
/// correctly.
pub const CASES: [(bool, wk_color_space); 3] =
    [(false, WK_COLOR_SCENE_LINEAR), (true, WK_COLOR_SCENE_LINEAR), (false, WK_COLOR_DISPLAY_LINEAR)];
/// Distances of the object from the camera, m.
pub const FAR_M: [f64; 4] = [12.0, 60.0, 250.0, 1500.0];

/// Creates a view in fog or in rain, with the sun to the side, and requests its veil.
pub fn scene(device: *mut wk_device, rain: bool) -> Scene {
    let scene = Scene::new(device);
    let sun = wk_given_direction { azimuth_deg: 110.0, elevation_deg: 35.0, ..init("wk_given_direction") };
    let weather = if rain {
        wk_weather {
            precipitation_kind: WK_PRECIPITATION_RAIN,
            precipitation_rate_mm_h: 30.0,
            visibility_m: 3000.0,
            ..init("wk_weather")
        }
    } else {
        wk_weather { visibility_m: 300.0, ..init("wk_weather") }
    };
    // SAFETY: live handles.
    unsafe {
        ok(wk_context_set_sun(scene.context, &sun));
        ok(wk_context_set_weather(scene.context, &weather, 0.0, 0.0));
        ok(wk_context_update(scene.context, 40.0));
    }
    let _ = textures(&scene);
    scene
}

pub fn textures(scene: &Scene) -> wk_frame_textures {
    let mut veil = init::<wk_frame_textures>("wk_frame_textures");
    // SAFETY: live handles.
    ok(unsafe { wk_view_get_frame_textures(scene.view, &mut veil) });
    veil
}

pub fn snippet(language: wk_shading_language) -> &'static str {
    let mut text = std::ptr::null();
    // SAFETY: a live pointer; the text lives as long as the process.
    unsafe {
        assert_eq!(wk_get_veil_snippet(language, &mut text), WK_OK);
        std::ffi::CStr::from_ptr(text).to_str().unwrap()
    }
}

/// A frame in this colour space, without its target.
pub fn frame(id: u64, size: Size, color_space: wk_color_space) -> wk_frame {
    let frame = frame_of(id, size);
    wk_frame { color_space, cd_m2_per_unit: 1000.0, flags: frame.flags | WK_FRAME_NO_HISTORY, ..frame }
}

/// Depth of an object `far_m` in front of the camera.
pub fn depth(far_m: f64) -> f32 {
    (0.1 / far_m) as f32
}

/// Factors from a pixel's position to its ray, per metre in front of the camera: (1 / p0, 1 / p5).
pub fn slopes(size: Size) -> [f32; 2] {
    let p = frame_of(0, size).projection;
    [(1.0 / p[0]) as f32, (1.0 / p[5]) as f32]
}

/// Asserts that the host's glass in front of `behind` is half `behind` and half the `opaque` object.
pub fn assert_mixed(got: &[[f32; 4]], behind: &[[f32; 4]], opaque: &[[f32; 4]], what: &str) {
    let (mut worst, mut sum) = (0.0_f32, 0.0);
    for ((g, b), o) in got.iter().zip(behind).zip(opaque) {
        for c in 0..3 {
            let wanted = (1.0 - ALPHA) * b[c] + ALPHA * o[c];
            let off = (g[c] - wanted).abs() / wanted;
            assert!(off.is_finite(), "{what}: {g:?} {wanted}");
            worst = worst.max(off);
            sum += off;
        }
    }
    let mean = sum / (3 * got.len()) as f32;
    assert!(mean < MEAN && worst < WORST, "{what}: mean {mean}, worst {worst}");
}

const MEAN: f32 = 0.01;
const WORST: f32 = 0.06;
