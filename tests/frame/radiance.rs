//! The sky's radiance as a query against the sky that a view draws.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    almanac::Utc,
    clouds::CloudModel,
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    light::luminance,
    scene::Camera,
    stars::StarSettings,
    weather::{CloudKind, CloudLayer, Weather},
};
use welkin_support::{accept, seen_lux::seen_lux};

use crate::environment::Level;

const SIZE: (u32, u32) = (64, 36);
/// Winter night without moon, 2026-01-18 22:00 UTC.
const NIGHT: Utc = Utc(1_768_773_600.0);

/// A context, a view of it, and a target without depth.
struct Sky {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    frame_id: u64,
}

impl Sky {
    fn new() -> Self {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut context = Context::new(device.clone(), shared, ContextDesc::default()).unwrap();
        let points = StarSettings { stars: Some(Vec::new().into()), planets: false, ..StarSettings::default() };
        context.set_stars(points).unwrap();
        context.set_clock(NIGHT, 0.0).unwrap();
        // Edges of clouds have a test of their own (tests/clouds/asked.rs).
        context.set_cloud_model(CloudModel::Deck);
        let view = View::new(&context).unwrap();
        let color = welkin_support::textures::texture(&device, SIZE, wgpu::TextureFormat::Rgba32Float, 1);
        Self { device, context, view, color, frame_id: 0 }
    }

    /// Directions of pixels with the radiances that a picture and the query give them, discs left out.
    fn pairs(&mut self, camera: &Camera) -> Vec<(DVec3, [f64; 3], [f64; 3])> {
        self.frame_id += 1;
        let mut frame = Frame::new(self.frame_id, *camera, &self.color, None);
        frame.flags = FrameFlags::NO_HISTORY;
        self.view.record(&self.context, &frame, Stages::BACKGROUND.with(Stages::MEDIUM)).unwrap();
        let picture = readback::rgba(&self.device, &self.color).unwrap();
        let light = self.context.light_at(camera.position, 0.0).unwrap();
        let is_sky =
            |d: &DVec3| d.angle_between(light.sun.apparent) > 0.05 && d.angle_between(light.moon.apparent) > 0.05;
        let pixels: Vec<(usize, DVec3)> =
            (0..picture.len()).step_by(41).map(|i| (i, direction(camera, i))).filter(|(_, d)| is_sky(d)).collect();
        let directions: Vec<DVec3> = pixels.iter().map(|p| p.1).collect();
        let asked = self.context.sky_radiance(camera.position, &directions, 0.0).unwrap();
        let drawn = |i: usize| [0, 1, 2].map(|k| f64::from(picture[i][k]));
        pixels.iter().zip(asked).map(|((i, d), asked)| (*d, drawn(*i), asked)).collect()
    }
}

/// Directions of texels of the cube map that the last picture updated, with the radiances that it and the query give
/// them.
fn cube_pairs(sky: &mut Sky, at: DVec3) -> Vec<(DVec3, [f64; 3], [f64; 3])> {
    let map = sky.view.environment().unwrap();
    let level = Level::read(&sky.device, &map, 0);
    let texels: Vec<(DVec3, [f64; 3])> = level.all().step_by(211).map(|(d, _, texel)| (d, texel)).collect();
    let directions: Vec<DVec3> = texels.iter().map(|t| t.0).collect();
    let asked = sky.context.sky_radiance(at, &directions, 0.0).unwrap();
    texels.into_iter().zip(asked).map(|((d, texel), asked)| (d, texel, asked)).collect()
}

/// (east, north, up) of a pixel's middle; the world is flat, so its axes are the host's.
fn direction(camera: &Camera, i: usize) -> DVec3 {
    let [x, y] = [i as u32 % SIZE.0, i as u32 / SIZE.0].map(|p| f64::from(p) + 0.5);
    let ndc = DVec3::new(2.0 * x / f64::from(SIZE.0) - 1.0, 1.0 - 2.0 * y / f64::from(SIZE.1), 0.5);
    let eye = camera.projection.inverse().project_point3(ndc);
    (camera.rotation().transpose() * eye).normalize()
}

fn camera(height_m: f64, elevation_deg: f64) -> Camera {
    let toward = DVec3::new(0.5, 0.8, 0.0).normalize() + DVec3::Z * elevation_deg.to_radians().tan();
    Camera::look_to(DVec3::new(0.0, 0.0, height_m), toward, DVec3::Z, 1.4, 16.0 / 9.0, 0.1)
}

/// Clear, the same air below a broken deck, fog near the ground, haze, and rain.
fn weathers() -> [(&'static str, Weather); 5] {
    let broken = Weather { clouds: vec![CloudLayer::of(CloudKind::Stratocumulus, 0.75, 1000.0)], ..Weather::default() };
    let preset = |name| (name, Weather::preset(name).unwrap());
    [preset("clear"), ("broken", broken), preset("shallow_fog"), preset("hazy"), preset("rain")]
}

/// Relative errors of luminance, sorted, each with its place.
#[derive(Default)]
struct Errors(Vec<(f64, String)>);

impl Errors {
    fn add(&mut self, from: &str, pairs: Vec<(DVec3, [f64; 3], [f64; 3])>) {
        for (d, drawn, asked) in pairs {
            let place = format!("{from} to {d:.3}: {drawn:.5?} drawn, {asked:.5?} asked for");
            self.0.push(((luminance(&drawn) / luminance(&asked) - 1.0).abs(), place));
        }
    }

    /// Compares median, 95th percentile and worst with docs/reflections.md. Returns the disagreements.
    fn hold(mut self, name: &str, documented: [f64; 3]) -> Vec<String> {
        self.0.sort_by(|a, b| a.0.total_cmp(&b.0));
        let found = [0.5, 0.95, 1.0].map(|share| self.0[((self.0.len() - 1) as f64 * share) as usize].clone());
        println!(
            "{name}: median {:.4}, 95th percentile {:.4}, worst {:.4} at {}",
            found[0].0, found[1].0, found[2].0, found[2].1
        );
        let mut faults = Vec::new();
        for ((found, place), documented) in found.iter().zip(documented) {
            if *found >= documented {
                faults.push(format!("{name}: {found} is above the documented {documented}: {place}"));
            }
            if accept() && *found < 0.6 * documented {
                faults.push(format!("{name}: {found} is far below the documented {documented}"));
            }
        }
        faults
    }
}

/// With `WELKIN_ACCEPT` in every weather. Each weather has an air of its own, which takes seconds to solve.
#[test]
fn radiance_asked_for_is_the_radiance_drawn() {
    let mut sky = Sky::new();
    let [mut day, mut dusk, mut night, mut cube] = [const { Errors(Vec::new()) }; 4];
    sky.view.environment().unwrap();
    for (name, weather) in weathers().into_iter().step_by(if accept() { 1 } else { 4 }) {
        sky.context.set_weather(&weather, 0.0, 0.0).unwrap();
        for (sun_deg, moon_deg) in [(50.0, -40.0), (6.0, -40.0), (-5.0, 30.0), (-12.0, 30.0), (-40.0, -30.0)] {
            sky.context.set_sun(Some(GivenDirection { azimuth_deg: 70.0, elevation_deg: sun_deg })).unwrap();
            sky.context.set_moon(Some(GivenDirection { azimuth_deg: -20.0, elevation_deg: moon_deg })).unwrap();
            for (height_m, elevation_deg) in [(2.0, 20.0), (2500.0, -5.0), (12_000.0, 0.0)] {
                let from = format!("{name}, sun {sun_deg}, from {height_m} m");
                let errors = if sun_deg > -6.0 {
                    &mut day
                } else if sun_deg > -20.0 {
                    &mut dusk
                } else {
                    &mut night
                };
                errors.add(&from, sky.pairs(&camera(height_m, elevation_deg)));
                // By night the cube map's glow is uniform.
                if height_m < 10.0 && sun_deg > -4.0 {
                    cube.add(&from, cube_pairs(&mut sky, DVec3::new(0.0, 0.0, height_m)));
                }
            }
        }
    }
    let faults = [
        cube.hold("cube map", [0.0015, 0.018, 0.08]),
        day.hold("sun to -5 degrees", [0.0035, 0.025, 0.085]),
        dusk.hold("sun at -12 degrees", [0.025, 0.09, 0.18]),
        night.hold("night", [0.006, 0.14, 0.18]),
    ];
    assert!(faults.iter().all(Vec::is_empty), "{faults:#?}");
}

/// Returns the largest relative error of the queried light of the sky against the sum over its queried radiance, at
/// these visibilities and over ground with this much snow.
fn queried_over_sum(visibilities_m: &[f64], snow_depth_m: f64) -> f64 {
    let mut sky = Sky::new();
    let mut worst = 0.0f64;
    for &visibility_m in visibilities_m {
        let mut weather = Weather { visibility_m, ..Weather::default() };
        weather.surface.snow_depth_m = snow_depth_m;
        sky.context.set_weather(&weather, 0.0, 0.0).unwrap();
        for elevation_deg in [6.0, 11.0, 30.0, 65.0] {
            sky.context.set_sun(Some(GivenDirection { azimuth_deg: 200.0, elevation_deg })).unwrap();
            let queried = luminance(&sky.context.light_at(DVec3::Z * 2.0, 0.0).unwrap().arriving.sky_lux);
            let off = queried / seen_lux(&sky.context, DVec3::Z * 2.0, (16, 32)) - 1.0;
            println!(
                "visibility {:.0} km, {snow_depth_m} m of snow, sun at {elevation_deg:.0} degrees: {queried:.0} lux, off by {off:+.3}",
                visibility_m / 1e3
            );
            worst = worst.max(off.abs());
        }
    }
    worst
}

#[test]
fn the_queried_light_of_a_clear_sky_is_the_sum_over_its_radiance() {
    let worst = queried_over_sum(&[3e3, 7e3, 20e3, 150e3], 0.0);
    assert!(worst < 0.06, "{worst}");
}

#[test]
fn snow_on_the_ground_brightens_the_skys_radiance_and_the_queried_light_alike() {
    let worst = queried_over_sum(&[7e3, 150e3], 0.5);
    assert!(worst < 0.06, "{worst}");
}
