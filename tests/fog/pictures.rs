//! Small pictures of fog for people to look at: WELKIN_FOG_PICTURES=<folder> writes them; without it, a few are drawn
//! and checked for the faults that an eye notices first (lines, steps, black or overexposed fog).

use glam::{DVec3, Vec3};
use welkin::fog::{
    CompatibilityLaw, DistanceKind, FogLayer, FogLight, FogModel, Law, Patches, Viewpoint,
    koschmieder_extinction_per_m, laws::Curve,
};
use welkin::scene::{Camera, DepthMapping, ViewRays};

use super::{gpu, path::EARTH_M};

const WIDTH: u32 = 480;
const HEIGHT: u32 = 270;

/// A picture: linear RGB and distance of each pixel.
struct Picture(Vec<[f32; 4]>);

struct FogScene {
    name: &'static str,
    law: Law,
    eye_m: f64,
    pitch: f64,
    light: FogLight,
    exposure: f64,
}

fn day(elevation_deg: f64, azimuth_deg: f64, sun: [f64; 3], sky: [f64; 3]) -> FogLight {
    let (s, c) = elevation_deg.to_radians().sin_cos();
    let (sa, ca) = azimuth_deg.to_radians().sin_cos();
    FogLight {
        to_sun: DVec3::new(c * sa, c * ca, s),
        sun_irradiance: sun,
        sky_irradiance: sky,
        ground_albedo: [0.13, 0.17, 0.08],
    }
}

fn noon() -> FogLight {
    day(50.0, 130.0, [0.85, 0.82, 0.76], [0.08, 0.12, 0.19])
}

fn low_sun() -> FogLight {
    day(6.0, 8.0, [0.42, 0.28, 0.14], [0.05, 0.06, 0.08])
}

fn fog(visibility_m: f64, top_m: f64, soft_m: f64) -> FogLayer {
    FogLayer::ground_fog(koschmieder_extinction_per_m(visibility_m), top_m, soft_m)
}

fn scenes() -> Vec<FogScene> {
    let shot = |name, law, eye_m, pitch, light, exposure| FogScene { name, law, eye_m, pitch, light, exposure };
    let layer = Law::Layer;
    let patches = FogLayer {
        patches: Some(Patches { amount: 1.0, size_m: 60.0, seed: 3, drift_m: [0.0; 2] }),
        ..fog(80.0, 4.0, 2.0)
    };
    let law = CompatibilityLaw {
        curve: Curve::ExponentialSquared { density_per_m: 1.0 / 600.0 },
        distance: DistanceKind::Range,
        colour: None,
        sky_band: 0.3,
    };
    vec![
        shot("clear", Law::Clear, 1.7, 0.0, noon(), 4.0),
        shot("fog_150", layer(fog(150.0, 60.0, 20.0)), 1.7, 0.05, noon(), 4.0),
        shot("fog_1000", layer(fog(1000.0, 120.0, 40.0)), 1.7, 0.05, noon(), 4.0),
        shot("mist_5000", layer(fog(5000.0, 300.0, 100.0)), 1.7, 0.05, noon(), 4.0),
        shot("shallow_from_1.7", layer(fog(60.0, 2.0, 0.8)), 1.7, 0.0, low_sun(), 8.0),
        shot("shallow_from_3", layer(fog(60.0, 2.0, 0.8)), 3.0, -0.02, low_sun(), 8.0),
        shot("shallow_from_50", layer(fog(60.0, 2.0, 0.8)), 50.0, -0.2, noon(), 4.0),
        shot("top_below", layer(fog(150.0, 20.0, 6.0)), 15.0, 0.0, noon(), 4.0),
        shot("top_within", layer(fog(150.0, 20.0, 6.0)), 20.0, 0.0, noon(), 4.0),
        shot("top_above", layer(fog(150.0, 20.0, 6.0)), 26.0, -0.05, noon(), 4.0),
        shot("sea_of_fog", layer(fog(150.0, 60.0, 20.0)), 300.0, -0.1, low_sun(), 8.0),
        shot("low_sun_300", layer(fog(300.0, 40.0, 15.0)), 1.7, 0.1, low_sun(), 8.0),
        shot("low_sun_2000", layer(fog(2000.0, 80.0, 30.0)), 1.7, 0.1, low_sun(), 8.0),
        shot(
            "night",
            layer(fog(300.0, 60.0, 20.0)),
            1.7,
            0.05,
            day(30.0, 40.0, [2e-6, 1.9e-6, 1.7e-6], [3e-7, 3e-7, 4e-7]),
            1e6,
        ),
        shot("patches", layer(patches), 6.0, -0.1, noon(), 4.0),
        shot("exp2_law", Law::Compatibility(law), 1.7, 0.05, noon(), 4.0),
    ]
}

fn draw(shot: &FogScene) -> Picture {
    let forward = DVec3::new(0.0, shot.pitch.cos(), shot.pitch.sin());
    let aspect = f64::from(WIDTH) / f64::from(HEIGHT);
    let camera = Camera::look_to(DVec3::ZERO, forward, DVec3::Z, 0.8, aspect, 0.1);
    let rays = ViewRays::new(&camera, &DepthMapping { reversed: true, ..Default::default() }).unwrap();
    let view = Viewpoint { planet_radius_m: EARTH_M, ..Viewpoint::flat(shot.eye_m) };
    let m = FogModel::new(&shot.law, &shot.light, &view).unwrap();
    let sky = Vec3::from(shot.light.sky_irradiance.map(|v| v as f32)) / std::f32::consts::PI;
    let sun = Vec3::from(shot.light.sun_irradiance.map(|v| v as f32));
    let height = shot.light.to_sun.z as f32;
    let mut bytes = bytemuck::bytes_of(&m.uniform()).to_vec();
    bytes.extend_from_slice(bytemuck::bytes_of(&rays.uniform()));
    let lit = sun * height + sky * std::f32::consts::PI;
    for (v, w) in [
        (Vec3::new(0.0, 0.0, shot.eye_m as f32), 0.0),
        (sun, 0.0),
        (sky * 0.7, 0.0),
        (sky * 1.5, 0.0),
        (lit, EARTH_M as f32),
    ] {
        bytes.extend_from_slice(bytemuck::bytes_of(&[v.x, v.y, v.z, w]));
    }
    let inputs: Vec<_> = (0..WIDTH * HEIGHT)
        .map(|i| {
            let (x, y) = ((i % WIDTH) as f32 + 0.5, (i / WIDTH) as f32 + 0.5);
            [2.0 * x / WIDTH as f32 - 1.0, 1.0 - 2.0 * y / HEIGHT as f32, 0.0, 0.0]
        })
        .collect();
    Picture(gpu::evaluate("fog/lookup.wgsl", include_str!("scene.wgsl"), "SceneUniform", &bytes, &inputs))
}

fn save(picture: &Picture, exposure: f64, path: &std::path::Path) {
    let encode = |v: f32| {
        let shown = 1.0 - (-f64::from(v) * exposure).exp();
        (255.0 * shown.powf(1.0 / 2.2)).round() as u8
    };
    let bytes: Vec<u8> = picture.0.iter().flat_map(|p| [encode(p[0]), encode(p[1]), encode(p[2])]).collect();
    image::save_buffer(path, &bytes, WIDTH, HEIGHT, image::ColorType::Rgb8).unwrap();
}

#[test]
fn pictures_are_finite_and_not_negative() {
    let folder = std::env::var("WELKIN_FOG_PICTURES").ok();
    for shot in scenes() {
        let picture = draw(&shot);
        if let Some(folder) = &folder {
            std::fs::create_dir_all(folder).unwrap();
            save(&picture, shot.exposure, &std::path::Path::new(folder).join(format!("{}.png", shot.name)));
        }
        for (i, p) in picture.0.iter().enumerate() {
            let ok = p[..3].iter().all(|v| v.is_finite() && *v >= 0.0);
            assert!(ok, "{} pixel {i}: {p:?}", shot.name);
        }
    }
}
