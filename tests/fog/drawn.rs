//! The drawn functions against their f64 twins, and the accuracy that is promised of them.

use glam::{DVec2, DVec3};
use welkin::fog::patterns::Curtains;
use welkin::fog::reference::{FogModel, fog_along, fog_beside_drops};
use welkin::fog::{
    CompatibilityLaw, DistanceKind, FallingLayer, FogLayer, FogUniform, Law, LowAirUniform, Patches, Phase, Viewpoint,
    koschmieder_extinction_per_m, laws::Curve,
};
use welkin::gpu::shader;
use welkin::scene::ViewRays;
use welkin::scene::depth::RANGE_SKY_M;

use super::path::{EARTH_M, exponential, model, noon, slab, view};
use super::{cameras, gpu};

/// Fog along rays given as (azimuth, mu, range, plane). Returns radiance and transmittance of the green channel, the
/// share of the air's light, and transmittance of the red one.
const BODY: &str = "fn answer(i: vec4f) -> vec4f {
    let s = sqrt(max(1.0 - i.y * i.y, 0.0));
    let fog = fog_along(u, vec3f(0.0), vec3f(s * sin(i.x), s * cos(i.x), i.y), i.z, i.w);
    return vec4f(fog.radiance.y, fog.transmittance.y, fog.shade, fog.transmittance.x);
}";

fn drawn(m: &FogModel, inputs: &[[f32; 4]]) -> Vec<[f32; 4]> {
    gpu::evaluate("fog/lookup.wgsl", BODY, "FogUniform", bytemuck::bytes_of(&m.uniform()), inputs)
}

/// Draws as [`drawn`] does, by the pipeline that has only the steps that the model needs.
fn drawn_narrow(m: &FogModel, inputs: &[[f32; 4]]) -> Vec<[f32; 4]> {
    let uniform = m.uniform();
    gpu::evaluate_with(
        "fog/lookup.wgsl",
        BODY,
        "FogUniform",
        bytemuck::bytes_of(&uniform),
        inputs,
        &m.variant().constants(),
    )
}

fn twin(m: &FogModel, i: [f32; 4]) -> [f64; 4] {
    let [a, mu, range, plane] = i.map(f64::from);
    let s = (1.0 - mu * mu).max(0.0).sqrt();
    let range = if i[2] >= RANGE_SKY_M as f32 { RANGE_SKY_M } else { range };
    let f = fog_along(m, DVec3::ZERO, DVec3::new(s * a.sin(), s * a.cos(), mu), range, plane);
    [f.radiance.y, f.transmittance.y, f.shade, f.transmittance.x]
}

fn rays() -> Vec<[f32; 4]> {
    let mut out = Vec::new();
    for azimuth in [0.54f32, 2.0, 4.0] {
        for mu in [-1.0f32, -0.4, -0.03, -0.004, -0.0005, 0.0, 0.001, 0.02, 0.3, 0.81, 1.0] {
            for range in [0.3f32, 20.0, 150.0, 1e3, 8e3, 4e4, RANGE_SKY_M as f32] {
                out.push([azimuth, mu, range, range * 0.8]);
            }
        }
    }
    out
}

fn compare(name: &str, m: &FogModel, tolerance: f64) {
    let inputs = rays();
    let both = drawn(m, &inputs).into_iter().chain(drawn_narrow(m, &inputs));
    for (i, g) in inputs.iter().chain(&inputs).zip(both) {
        let want = twin(m, *i);
        assert!(g.iter().all(|v| v.is_finite() && *v >= 0.0), "{name} {i:?}: drawn {g:?}");
        // More than 5 km below the eye a pipeline without a lower edge continues the fog, so the share of the air's
        // light differs there.
        let checked = if i[1] * i[2] < -5000.0 { &[0, 1, 3][..] } else { &[0, 1, 2, 3] };
        for &j in checked {
            let error = (f64::from(g[j]) - want[j]).abs();
            assert!(error < tolerance * want[j].max(1.0), "{name} {i:?} [{j}]: drawn {} of {}", g[j], want[j]);
        }
    }
}

#[test]
fn every_profile_is_drawn_as_the_reference_has_it() {
    for h in [1.7, 19.0, 50.0, 400.0, 3000.0, 12_000.0] {
        for radius in [EARTH_M, f64::INFINITY] {
            let layers = [
                slab(150.0, -1e4, 60.0, 20.0),
                slab(30.0, 0.0, 2.0, 1.0),
                slab(1000.0, 0.0, 200.0, 0.0),
                slab(5000.0, 100.0, 400.0, 120.0),
                exponential(2000.0, 50.0),
                exponential(20_000.0, 1200.0),
                FogLayer { albedo: [0.97, 0.93, 0.85], angstrom: 1.3, ..slab(400.0, 0.0, 300.0, 50.0) },
                FogLayer {
                    albedo: [1.0, 0.5, 0.0],
                    phase: Phase::HenyeyGreenstein { g: 0.3 },
                    ..slab(80.0, 0.0, 90.0, 9.0)
                },
            ];
            for layer in layers {
                compare(&format!("h {h} radius {radius} {layer:?}"), &model(layer, &view(h, radius)), 6e-4);
            }
        }
    }
}

#[test]
fn patches_are_drawn_as_the_reference_has_them() {
    let patches = Patches { amount: 1.0, size_m: 80.0, seed: 7, drift_m: [1.2e7, -3e6] };
    let layer = FogLayer { patches: Some(patches), ..slab(100.0, 0.0, 30.0, 5.0) };
    for h in [2.0, 60.0] {
        let m = model(layer, &Viewpoint { map_m: [5.5e6, -2e6], ..view(h, EARTH_M) });
        compare(&format!("patches h {h}"), &m, 2e-3);
    }
}

/// Precipitation that fades out between 550 m and 650 m, around a cloud base at 600 m.
fn rain(liquid_per_m: f64) -> FallingLayer {
    FallingLayer { liquid_per_m, solid_per_m: 1e-4, top_m: 650.0, soft_m: 100.0 }
}

fn with_falling(layer: Option<&FogLayer>, falling: &FallingLayer, view: &Viewpoint) -> FogModel {
    FogModel::of_weather(layer, falling, &noon(), view).unwrap()
}

#[test]
fn precipitation_is_drawn_as_the_reference_has_it_beside_fog_and_drops() {
    let body = BODY.replace("fog_along(u", "fog_beside_drops(u").replace("i.z, i.w)", "i.z, i.z, i.w)");
    let layers = [
        None,
        Some(slab(400.0, -1e4, 60.0, 20.0)),
        Some(slab(3000.0, 200.0, 900.0, 100.0)),
        Some(exponential(2000.0, 50.0)),
        Some(FogLayer { albedo: [0.97, 0.93, 0.85], angstrom: 1.3, ..slab(400.0, 0.0, 300.0, 50.0) }),
    ];
    for (h, layer) in [2.0, 300.0, 640.0, 5000.0].into_iter().flat_map(|h| layers.map(|l| (h, l))) {
        let m = with_falling(layer.as_ref(), &rain(8e-4), &view(h, EARTH_M));
        compare(&format!("h {h} {layer:?}"), &m, 6e-4);
        let mut changed = 0;
        for (k, hidden) in [0.004f32, 0.02, 5.0].into_iter().enumerate() {
            let inputs: Vec<_> =
                rays().into_iter().skip(k).step_by(3).map(|[a, mu, range, _]| [a, mu, range, hidden]).collect();
            let uniform = m.uniform();
            let block = bytemuck::bytes_of(&uniform);
            let all = gpu::evaluate("fog/lookup.wgsl", &body, "FogUniform", block, &inputs);
            let narrow =
                gpu::evaluate_with("fog/lookup.wgsl", &body, "FogUniform", block, &inputs, &m.variant().constants());
            for (i, g) in inputs.iter().chain(&inputs).zip(all.into_iter().chain(narrow)) {
                let s = f64::from(1.0 - i[1] * i[1]).max(0.0).sqrt();
                let [a, mu, range, hidden] = i.map(f64::from);
                let range = if i[2] >= RANGE_SKY_M as f32 { RANGE_SKY_M } else { range };
                let d = DVec3::new(s * a.sin(), s * a.cos(), mu);
                let want = fog_beside_drops(&m, DVec3::ZERO, d, range, range, hidden);
                let plain = fog_along(&m, DVec3::ZERO, d, range, range);
                changed += usize::from((want.transmittance.y - plain.transmittance.y).abs() > 1e-3);
                for (got, want) in [(g[0], want.radiance.y), (g[1], want.transmittance.y), (g[3], want.transmittance.x)]
                {
                    let error = (f64::from(got) - want).abs();
                    assert!(error < 6e-4 * want.max(1.0), "h {h} {layer:?} {i:?}: drawn {got} of {want}");
                }
                // Drops hide nothing of the fog.
                let none = FallingLayer { liquid_per_m: 0.0, solid_per_m: 0.0, ..rain(0.0) };
                let fog =
                    fog_along(&with_falling(layer.as_ref(), &none, &view(h, EARTH_M)), DVec3::ZERO, d, range, range);
                assert!(want.transmittance.y <= fog.transmittance.y + 1e-9, "h {h} {layer:?} {i:?}");
            }
        }
        assert!(h > 1000.0 || changed > 30, "h {h}: {changed} changed");
    }
}

#[test]
fn curtains_are_drawn_as_the_reference_has_them() {
    for h in [2.0, 300.0, 900.0] {
        let wave = |i: usize| {
            let k = 2.0 * std::f64::consts::PI / (130.0 + 110.0 * i as f64);
            (DVec3::new(k * (i as f64).cos(), k * (i as f64).sin(), 0.15 * k), i as f64)
        };
        let even = with_falling(None, &rain(1e-3), &view(h, EARTH_M));
        let curtains = Curtains { amount: 0.245, waves: std::array::from_fn(wave) };
        let mut m = even.clone();
        m.falling.curtains = curtains;
        compare(&format!("curtains h {h}"), &m, 2e-3);
        let changed = rays().iter().filter(|i| (twin(&m, **i)[1] - twin(&even, **i)[1]).abs() > 0.03).count();
        assert!(h > 500.0 || changed > 3, "{h} m: {changed} rays differ");
    }
}

#[test]
fn the_compatibility_laws_are_drawn_on_range_and_plane() {
    for curve in [
        Curve::Linear { start_m: 100.0, end_m: 3000.0 },
        Curve::Exponential { density_per_m: 2e-3 },
        Curve::ExponentialSquared { density_per_m: 1e-3 },
    ] {
        for distance in [DistanceKind::Range, DistanceKind::Plane] {
            for sky_band in [0.0, 0.2, std::f64::consts::PI] {
                for colour in [None, Some([0.5, 0.6, 0.7])] {
                    let law = CompatibilityLaw { curve, distance, colour, sky_band };
                    let m = FogModel::new(&Law::Compatibility(law), &noon(), &view(2.0, EARTH_M)).unwrap();
                    compare(&format!("{law:?}"), &m, 1e-5);
                    let d = if distance == DistanceKind::Range { 150.0 } else { 120.0 };
                    let v = twin(&m, [0.0, 0.0, 150.0, 120.0])[1];
                    assert!((v - law.visibility(d)).abs() < 1e-12);
                }
            }
        }
    }
}

/// Truth: a flat homogeneous layer keeps 0.05 +- 0.001 at the visibility as drawn, at any depth mapping, and at the
/// picture's edge as in its centre.
#[test]
fn five_percent_at_every_depth_mapping_and_pixel() {
    let body = "struct Both { fog: FogUniform, depth: DepthUniform }
        fn answer(i: vec4f) -> vec4f {
            let ray = view_ray(u.depth, i.xy);
            let fog = fog_along(u.fog, ray.origin, ray.direction, view_range(u.depth, i.z, i.xy), view_plane(u.depth, i.z, i.xy));
            return vec4f(fog.transmittance, fog.radiance.y);
        }";
    let pixels = [(0.0, 0.0), (0.999, -0.999), (-0.999, 0.999), (1.0, 1.0), (-0.4, -0.7)];
    for case in cameras::all() {
        let rays = ViewRays::new(&case.camera, &case.mapping).unwrap();
        for v in [50.0, 150.0, 1e3, 5e3, 2e4, 5e4] {
            let m = model(slab(v, -1e5, 1e5, 0.0), &view(2.0, f64::INFINITY));
            // A depth in f32 is as precise as the host's convention allows; nothing else may add to its error.
            let inputs: Vec<_> = pixels
                .iter()
                .map(|(x, y)| [*x as f32, *y as f32, rays.depth_at(v, DVec2::new(*x, *y)) as f32, 0.0])
                .collect();
            let mut bytes = bytemuck::bytes_of(&m.uniform()).to_vec();
            bytes.extend_from_slice(bytemuck::bytes_of(&rays.uniform()));
            for (i, g) in inputs.iter().zip(gpu::evaluate("fog/lookup.wgsl", body, "Both", &bytes, &inputs)) {
                let ndc = DVec2::new(f64::from(i[0]), f64::from(i[1]));
                let held = rays.view_range(f64::from(i[2]), ndc);
                let want = (-koschmieder_extinction_per_m(v) * held).exp();
                let name = format!("{} V {v} at {ndc}", case.name);
                assert!((f64::from(g[1]) - want).abs() < 1e-4, "{name}: drawn {} of {want}", g[1]);
                let lost = (held - v).abs() / v;
                if lost < 5e-3 {
                    assert!((f64::from(g[1]) - 0.05).abs() < 1e-3, "{name}: {}", g[1]);
                } else {
                    assert!(!case.mapping.reversed && case.name.contains("perspective"), "{name}: depth lost {lost}");
                }
            }
        }
    }
}

/// The horizon, from ground at the end of its ray to sky: a picture whose ground and sky are as bright as the far fog
/// must show no line there, however much of them is seen.
#[test]
fn no_seam_at_the_horizon() {
    // At a visibility of 5 km a sixteenth of the light of the ground at the horizon arrives, so its darkness shows a
    // little.
    let cases =
        [(150.0, 60.0, [1.7, 30.0], 0.004), (1000.0, 100.0, [1.7, 70.0], 0.004), (5000.0, 300.0, [1.7, 500.0], 0.015)];
    for (v, top, heights, step) in cases {
        for h in heights {
            let m = model(slab(v, -1e4, top, 0.2 * top), &view(h, EARTH_M));
            let dip = -(2.0 * h / EARTH_M).sqrt();
            let n = 400;
            let sky = RANGE_SKY_M as f32;
            let inputs: Vec<_> =
                (0..=n).map(|i| [0.2, (dip + 0.004 * (i as f64 / n as f64 - 0.5)) as f32, sky, sky]).collect();
            let got = drawn(&m, &inputs);
            let far = got.iter().map(|g| g[0]).fold(0.0, f32::max);
            let picture: Vec<_> = got.iter().map(|g| g[0] + g[1] * far).collect();
            for (pair, i) in picture.windows(2).zip(&inputs) {
                assert!((pair[1] - pair[0]).abs() < step * far, "V {v} h {h} mu {}: {pair:?} of {far}", i[1]);
            }
        }
    }
}

/// Everything far away in deep fog has one radiance: ground and sky converge, but for what the forward lobe sees of the
/// dark ground, which changes by 2 % over these angles (adding and doubling).
#[test]
fn far_ground_and_sky_converge() {
    let m = model(slab(150.0, -1e4, 150.0, 30.0), &view(2.0, EARTH_M));
    let far = |mu: f32, range: f32| drawn(&m, &[[0.2, mu, range, range]])[0];
    let sky = far(0.001, RANGE_SKY_M as f32);
    for ground in [far(-0.001, 1900.0), far(-0.0005, RANGE_SKY_M as f32), far(0.0, 5000.0)] {
        assert!((ground[0] / sky[0] - 1.0).abs() < 0.02 && ground[1] < 1e-4, "{ground:?} {sky:?}");
    }
}

#[test]
fn edges_of_the_ranges_stay_finite() {
    let mut cases = Vec::new();
    for v in [1.0, 1e6] {
        for top in [0.0, 2.0, 1e4] {
            for h in [-100.0, 1.7, 1e7] {
                for radius in [EARTH_M, f64::INFINITY] {
                    cases.push((slab(v, 0.0, top, 1.0), h, radius));
                }
            }
        }
        cases.push((exponential(v, 1.0), 1e7, EARTH_M));
        cases.push((exponential(v, 1.0), -1e3, EARTH_M));
        cases.push((exponential(v, 1e5), 0.0, f64::INFINITY));
    }
    cases.push((FogLayer { extinction_per_m: 0.0, ..slab(1.0, 0.0, 10.0, 1.0) }, 1.0, EARTH_M));
    cases.push((FogLayer { extinction_per_m: 0.0, albedo: [0.0; 3], ..slab(1.0, 0.0, 10.0, 1.0) }, 1.0, EARTH_M));
    let inputs = rays();
    for (layer, h, radius) in cases {
        for sun in [DVec3::Z, DVec3::X, -DVec3::Z] {
            let mut light = noon();
            light.to_sun = sun;
            let m = FogModel::new(&Law::Layer(layer), &light, &view(h, radius)).unwrap();
            for (i, g) in inputs.iter().zip(drawn(&m, &inputs)) {
                let ok = g.iter().all(|v| v.is_finite() && *v >= 0.0) && g[1] <= 1.0;
                assert!(ok, "{layer:?} h {h} radius {radius} sun {sun} {i:?}: {g:?}");
                if layer.extinction_per_m == 0.0 {
                    assert!(g[0] == 0.0 && g[1] == 1.0, "no fog changed the picture: {g:?}");
                }
            }
        }
    }
}

#[test]
fn bad_numbers_are_refused_by_name() {
    let good = slab(150.0, 0.0, 10.0, 1.0);
    let says =
        |layer: FogLayer| FogModel::new(&Law::Layer(layer), &noon(), &view(2.0, EARTH_M)).unwrap_err().to_string();
    assert!(says(FogLayer { extinction_per_m: f64::NAN, ..good }).contains("fog.extinction_per_m"));
    assert!(says(FogLayer { albedo: [0.5, 1.5, 0.5], ..good }).contains("fog.albedo"));
    assert!(says(slab(150.0, 10.0, 0.0, 1.0)).contains("fog.top_m"));
    assert!(says(slab(150.0, 0.0, 10.0, f64::INFINITY)).contains("softness"));
    assert!(says(FogLayer { phase: Phase::Droplets { diameter_um: 1.0 }, ..good }).contains("fog.diameter_um"));
    let mut light = noon();
    light.sun_irradiance[1] = f64::NAN;
    let e = FogModel::new(&Law::Layer(good), &light, &view(2.0, EARTH_M)).unwrap_err();
    assert!(e.to_string().contains("fog.sun_irradiance"));
    let wrong = [
        ("liquid_per_m", FallingLayer { liquid_per_m: -1e-3, ..rain(0.0) }),
        ("solid_per_m", FallingLayer { solid_per_m: f64::NAN, ..rain(0.0) }),
        ("top_m", FallingLayer { top_m: f64::INFINITY, ..rain(0.0) }),
        ("soft_m", FallingLayer { soft_m: 0.0, ..rain(0.0) }),
    ];
    for (field, falling) in wrong {
        let e = FogModel::of_weather(None, &falling, &noon(), &view(2.0, EARTH_M)).unwrap_err().to_string();
        assert!(e.contains(&format!("falling.{field}")), "{e}");
    }
    let e = FogModel::new(&Law::Layer(good), &noon(), &view(f64::NAN, EARTH_M)).unwrap_err();
    assert!(e.to_string().contains("altitude_m"));
}

#[test]
fn offsets_are_those_of_the_shader() {
    let text = shader::assemble("fog/lookup.wgsl").unwrap();
    let (size, members) = shader::struct_layout(&text, "FogUniform").unwrap();
    assert_eq!(size as usize, size_of::<FogUniform>());
    assert_eq!(shader::struct_layout(&text, "LowAir").unwrap().0 as usize, size_of::<LowAirUniform>());
    macro_rules! offsets { ($($f:ident),*) => { vec![$((stringify!($f).to_owned(), std::mem::offset_of!(FogUniform, $f) as u32)),*] } }
    let ours = offsets!(
        to_sun,
        altitude,
        knots,
        ratio,
        extinction,
        scaling,
        depth_total,
        pair,
        sky_band,
        plane_distance,
        lobes,
        radius,
        curvature,
        ground,
        inverse_mu0,
        k,
        absorbing,
        first,
        patch_amount,
        sky_radiance,
        kind,
        ground_radiance,
        spread,
        scattering,
        constant,
        slope,
        beam,
        rise,
        fall,
        patch_waves,
        curtain_waves,
        falling,
        lit,
        curtain_amount,
        waves
    );
    assert_eq!(members, ours);
}
