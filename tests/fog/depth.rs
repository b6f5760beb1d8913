//! Depth conventions: a point that is written to a depth buffer must be read back at its place, at the picture's edge
//! as in the centre.

use glam::{DMat4, DVec2, DVec3};
use welkin::gpu::shader;
use welkin::scene::depth::{DepthFormat, RANGE_SKY_M};
use welkin::scene::{Camera, DepthKind, DepthMapping, DepthUniform, ViewRays};

use super::{cameras, gpu};

const PIXELS: [(f64, f64); 5] = [(0.0, 0.0), (0.999, -0.999), (-0.999, 0.999), (1.0, 1.0), (-0.4, -0.7)];
const RANGES: [f64; 8] = [0.5, 3.0, 20.0, 150.0, 1e3, 5e3, 2e4, 9e4];

fn rays(case: &cameras::Case) -> ViewRays {
    ViewRays::new(&case.camera, &case.mapping).unwrap_or_else(|e| panic!("{}: {e}", case.name))
}

#[test]
fn a_projected_point_comes_back_in_f64() {
    for case in cameras::all() {
        let rays = rays(&case);
        for (x, y) in PIXELS {
            let ndc = DVec2::new(x, y);
            let ray = rays.view_ray(ndc);
            for range in RANGES {
                let (depth, seen) = cameras::project(&case, ray.origin + ray.direction * range);
                let name = format!("{} at {ndc} range {range}", case.name);
                assert!((seen.truncate() - ndc).length() < 1e-9, "{name}: projects to {seen}");
                // Near the far end the rounding of depths in f64 (1e-16) limits the precision of the range.
                let tolerance =
                    1e-9 * range + 4.0 * rays.resolution_m(range, ndc, DepthFormat::Float32) * 2f64.powi(-28);
                let back = rays.view_range(depth, ndc);
                assert!((back - range).abs() < tolerance, "{name}: {back}");
                assert!((rays.depth_at(range, ndc) - depth).abs() < 1e-12, "{name}: {}", rays.depth_at(range, ndc));
                let eye = case.camera.rotation() * (ray.direction * range);
                let plane = rays.view_plane(depth, ndc);
                assert!((plane + eye.z).abs() < tolerance, "{name}: plane {plane} of {}", -eye.z);
            }
        }
    }
}

#[test]
fn the_gpu_agrees_with_f64_for_the_same_f32_depth() {
    for case in cameras::all() {
        let rays = rays(&case);
        let mut inputs = Vec::new();
        for (x, y) in PIXELS {
            for range in RANGES {
                inputs.push([x as f32, y as f32, rays.depth_at(range, DVec2::new(x, y)) as f32, 0.0]);
            }
        }
        let body = "fn answer(i: vec4f) -> vec4f { return vec4f(view_range(u, i.z, i.xy), view_plane(u, i.z, i.xy), 0.0, 0.0); }";
        let uniform = rays.uniform();
        let got = gpu::evaluate("common/depth.wgsl", body, "DepthUniform", bytemuck::bytes_of(&uniform), &inputs);
        for (i, g) in inputs.iter().zip(got) {
            let ndc = DVec2::new(f64::from(i[0]), f64::from(i[1]));
            let want = rays.view_range(f64::from(i[2]), ndc);
            let plane = rays.view_plane(f64::from(i[2]), ndc);
            // For parallel rays a depth near 1 has the error of an ulp of 1 times the depth's 120 km. Other rays keep
            // their digits.
            let floor = if case.mapping.kind == DepthKind::Orthographic { 0.02 } else { 0.0 };
            let name = format!("{} at {ndc} depth {}", case.name, i[2]);
            assert!((f64::from(g[0]) - want).abs() < 4e-6 * want + floor, "{name}: drawn {} of {want}", g[0]);
            assert!((f64::from(g[1]) - plane).abs() < 4e-6 * plane + floor, "{name}: plane {} of {plane}", g[1]);
        }
    }
}

#[test]
fn nothing_drawn_is_sky_and_bad_depths_are_harmless() {
    for case in cameras::all() {
        let rays = rays(&case);
        let far = case.mapping.far_depth();
        let beyond = if case.mapping.reversed { -0.5 } else { 1.5 };
        let before = if case.mapping.reversed { 1.5 } else { -0.5 };
        let cases = [far, beyond, f64::NAN, before, f64::INFINITY, f64::NEG_INFINITY];
        let inputs: Vec<_> = cases.iter().map(|d| [0.3, 0.9, *d as f32, 0.0]).collect();
        let body = "fn answer(i: vec4f) -> vec4f { return vec4f(view_range(u, i.z, i.xy)); }";
        let uniform = rays.uniform();
        let got = gpu::evaluate("common/depth.wgsl", body, "DepthUniform", bytemuck::bytes_of(&uniform), &inputs);
        let near = rays.view_range(1.0 - far, DVec2::new(0.3, 0.9));
        for (depth, drawn) in cases.iter().zip(got) {
            let twin = rays.view_range(*depth, DVec2::new(0.3, 0.9));
            for value in [twin, f64::from(drawn[0])] {
                let name = format!("{} depth {depth}: {value}", case.name);
                if depth.is_nan() || (depth - far) * (far - 0.5) >= 0.0 {
                    assert!((value / RANGE_SKY_M - 1.0).abs() < 1e-6, "{name}");
                } else {
                    assert!((value - near).abs() < 1e-5 * near + 0.02, "{name}, near {near}");
                }
            }
        }
    }
}

/// Truth: standard z 60 m at 10 km with the near plane at 0.1 m, reversed 0.9 mm.
#[test]
fn resolution_is_what_the_convention_gives_and_no_worse() {
    let far = |name: &str| {
        let case = cameras::all().into_iter().find(|c| c.name.starts_with(name)).unwrap();
        let r = rays(&case);
        let (a, b) = (r.depth_at(1e4, DVec2::ZERO) as f32, r);
        let next = f32::from_bits(a.to_bits() + 1);
        let range = |d: f32| b.view_range(f64::from(d), DVec2::ZERO);
        let measured = (range(next) - range(a)).abs();
        let said = b.resolution_m(1e4, DVec2::ZERO, DepthFormat::Float32);
        assert!((measured / said - 1.0).abs() < 0.02, "{name}: {measured} m, said {said} m");
        measured
    };
    let standard = far("perspective far inf reversed false ZeroToOne straight");
    let reversed = far("perspective far inf reversed true ZeroToOne straight");
    assert!((standard - 60.0).abs() < 1.0, "{standard}");
    assert!((reversed - 0.9e-3).abs() < 0.1e-3, "{reversed}");
}

#[test]
fn coplanar_surfaces_stay_apart_on_the_gpu_as_far_as_the_buffer_separates_them() {
    for case in cameras::all() {
        let rays = rays(&case);
        let body = "fn answer(i: vec4f) -> vec4f { return vec4f(view_range(u, i.z, i.xy)); }";
        let mut inputs = Vec::new();
        for (x, y) in PIXELS {
            for range in [20.0, 1e3, 1e4] {
                let ndc = DVec2::new(x, y);
                let gap = (4.0 * rays.resolution_m(range, ndc, DepthFormat::Float32)).max(4e-6 * range);
                inputs.push([x as f32, y as f32, rays.depth_at(range, ndc) as f32, 0.0]);
                inputs.push([x as f32, y as f32, rays.depth_at(range + gap, ndc) as f32, 0.0]);
            }
        }
        let uniform = rays.uniform();
        let got = gpu::evaluate("common/depth.wgsl", body, "DepthUniform", bytemuck::bytes_of(&uniform), &inputs);
        for (i, pair) in got.chunks_exact(2).enumerate() {
            assert!(pair[1][0] > pair[0][0], "{} pair {i}: {} then {}", case.name, pair[0][0], pair[1][0]);
        }
    }
}

#[test]
fn contradictions_and_bad_constants_are_named() {
    let good = &cameras::all()[0];
    let says = |camera: &Camera, mapping: DepthMapping| ViewRays::new(camera, &mapping).unwrap_err().to_string();
    let wrong = DepthMapping { reversed: true, ..good.mapping };
    assert!(says(&good.camera, wrong).contains("reversed"));
    let wrong = DepthMapping { kind: DepthKind::Orthographic, ..good.mapping };
    assert!(says(&good.camera, wrong).contains("orthographic"));
    let wrong = DepthMapping { kind: DepthKind::Logarithmic { c: f64::NAN, far_m: 1e4 }, ..good.mapping };
    assert!(says(&good.camera, wrong).contains("logarithmic_c"));
    let broken = Camera { projection: DMat4::NAN, ..good.camera };
    assert!(says(&broken, good.mapping).contains("camera.projection"));
}

#[test]
fn the_worlds_origin_does_not_matter() {
    for case in cameras::all() {
        let moved = Camera { position: DVec3::new(1e7, -1e7, 1e7), ..case.camera };
        let here = ViewRays::new(&case.camera, &case.mapping).unwrap().uniform();
        let there = ViewRays::new(&moved, &case.mapping).unwrap().uniform();
        assert_eq!(bytemuck::bytes_of(&here), bytemuck::bytes_of(&there), "{}", case.name);
    }
}

#[test]
fn offsets_are_those_of_the_shader() {
    let text = shader::assemble("common/depth.wgsl").unwrap();
    let (size, members) = shader::struct_layout(&text, "DepthUniform").unwrap();
    assert_eq!(size as usize, size_of::<DepthUniform>());
    macro_rules! offsets { ($($f:ident),*) => { vec![$((stringify!($f).to_owned(), std::mem::offset_of!(DepthUniform, $f) as u32)),*] } }
    let ours = offsets!(
        origin,
        turn_offset,
        origin_dx,
        turn_scale,
        origin_dy,
        kind,
        direction,
        plane_scale,
        direction_dx,
        log_far,
        direction_dy,
        inverse_c,
        pole,
        scale
    );
    assert_eq!(members, ours);
}
