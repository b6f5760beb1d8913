//! Fog banks, the low layers of weather regions, in the picture: their optical depth against the integral along the
//! way, and the light of sky pixels against the query.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    chance::RandomStream,
    clouds::CloudModel,
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    light::luminance,
    regions::{MAX_REGION_CORNERS, RegionPlan, RegionShape, WeatherRegion},
    scene::Camera,
    weather::{Fog, FogKind, Weather, WeatherParts},
};
use welkin_support::{accept, coarse_sky::coarse_sky, textures::texture};

use crate::froxels;

const SIZE: (u32, u32) = (64, 36);

/// A context under a sun 30 degrees high, a view, and targets.
struct Bench {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    frame_id: u64,
}

/// Layer of a bank: fog with this visibility up to this height.
fn fog(visibility_m: f64, top_m: f64) -> Weather {
    let fog = Fog { top_m: Some(top_m), ..Fog::of(FogKind::Fog) };
    Weather { visibility_m, fog, ..Weather::default() }
}

/// A bank 5 km to the north.
fn bank(shape: RegionShape, perimeter_m: f64) -> WeatherRegion {
    let plan =
        RegionPlan { shape, perimeter_m, center_m: [300.0, 5000.0, 0.0], heading_deg: 25.0, ..RegionPlan::default() };
    WeatherRegion { plan, has: WeatherParts::FOG, weather: fog(400.0, 150.0), ..WeatherRegion::default() }
}

fn rectangle() -> RegionShape {
    RegionShape::Rectangle { half_m: [3000.0, 1200.0], corner_radius_m: 700.0 }
}

fn polygon(corners: &[[f64; 2]]) -> RegionShape {
    let mut corners_m = [[0.0; 2]; MAX_REGION_CORNERS];
    corners_m[..corners.len()].copy_from_slice(corners);
    RegionShape::Polygon { corners_m, count: corners.len() }
}

impl Bench {
    fn new(desc: ContextDesc) -> Self {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut context = Context::new(device.clone(), shared, desc).unwrap();
        context.set_cloud_model(CloudModel::Deck);
        context.set_sun(Some(GivenDirection { azimuth_deg: 120.0, elevation_deg: 30.0 })).unwrap();
        let view = View::new(&context).unwrap();
        let color = texture(&device, SIZE, wgpu::TextureFormat::Rgba32Float, 1);
        let depth = texture(&device, SIZE, wgpu::TextureFormat::R32Float, 1);
        Self { device, context, view, color, depth, frame_id: 0 }
    }

    fn put(&self, texture: &wgpu::Texture, bytes: &[u8]) {
        let row = bytes.len() as u32 / SIZE.1;
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        self.device.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
    }

    /// Draws what lies in front of surfaces of the luminance `host` at these depths.
    fn draw(&mut self, camera: &Camera, depths: Option<&[f32]>, host: f32) -> Vec<[f32; 4]> {
        self.put(&self.color, bytemuck::cast_slice(&vec![[host; 4]; (SIZE.0 * SIZE.1) as usize]));
        if let Some(depths) = depths {
            self.put(&self.depth, bytemuck::cast_slice(depths));
        }
        self.frame_id += 1;
        let mut frame = Frame::new(self.frame_id, *camera, &self.color, depths.map(|_| &self.depth));
        frame.flags = FrameFlags::NO_HISTORY;
        self.view.record(&self.context, &frame, Stages::BACKGROUND.with(Stages::MEDIUM)).unwrap();
        readback::rgba(&self.device, &self.color).unwrap()
    }

    /// Returns the drawn optical depth, at 550 nm, before surfaces at these depths.
    fn depths(&mut self, camera: &Camera, depths: &[f32]) -> Vec<f64> {
        let [white, black] = [1e6, 0.0].map(|host| self.draw(camera, Some(depths), host));
        white.iter().zip(black).map(|(w, b)| -((f64::from(w[1]) - f64::from(b[1])) / 1e6).ln()).collect()
    }
}

fn camera(position: DVec3, toward: DVec3) -> Camera {
    Camera::look_to(position, toward, DVec3::Z, 0.9, 16.0 / 9.0, 0.1)
}

/// Direction of a pixel's middle; the axes of a flat world are the host's.
fn direction(camera: &Camera, i: usize) -> DVec3 {
    let [x, y] = [i as u32 % SIZE.0, i as u32 / SIZE.0].map(|p| f64::from(p) + 0.5);
    let ndc = DVec3::new(2.0 * x / f64::from(SIZE.0) - 1.0, 1.0 - 2.0 * y / f64::from(SIZE.1), 0.5);
    let eye = camera.projection.inverse().project_point3(ndc);
    (camera.rotation().transpose() * eye).normalize()
}

/// Cameras outside, in the perimeter, inside, and above.
fn cameras() -> [(&'static str, Camera); 5] {
    let north = DVec3::new(0.1, 1.0, 0.0);
    [
        ("outside", camera(DVec3::new(0.0, 0.0, 20.0), north)),
        ("in the perimeter", camera(DVec3::new(0.0, 3200.0, 20.0), north)),
        ("inside", camera(DVec3::new(300.0, 5000.0, 20.0), DVec3::new(1.0, 0.2, 0.0))),
        ("above", camera(DVec3::new(0.0, 1000.0, 900.0), DVec3::new(0.0, 1.0, -0.3))),
        ("12 km up", camera(DVec3::new(-9000.0, 3000.0, 12_000.0), DVec3::new(1.0, 0.2, -1.0))),
    ]
}

/// A camera, points before it at random distances, and the optical depth to them without regions.
struct ClearView {
    place: &'static str,
    camera: Camera,
    points: Vec<(f64, DVec3)>,
    depths: Vec<f32>,
    drawn: Vec<f64>,
    asked: Vec<f64>,
}

impl ClearView {
    /// Numbers of the points whose integral along the way is compared; it takes about as long as a picture.
    fn compared(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.points.len()).step_by(if accept() { 1 } else { 31 })
    }

    /// Returns the optical depth of the query to a point.
    fn asked(&self, bench: &Bench, i: usize) -> f64 {
        let ((range, d), eye) = (self.points[i], self.camera.position);
        -bench.context.between(eye, eye + d * range, 0.0).unwrap().transmittance[1].ln()
    }
}

/// Looks from every camera without regions. A change of regions changes the air and so the sky, which takes seconds:
/// all cameras look before the next one.
fn clear_views(bench: &mut Bench) -> Vec<ClearView> {
    let mut chance = RandomStream::new(9, 4);
    bench.context.set_weather_regions(&[]).unwrap();
    let view = |(place, camera): (&'static str, Camera)| {
        let points: Vec<(f64, DVec3)> = (0..(SIZE.0 * SIZE.1) as usize)
            .map(|i| {
                let d = direction(&camera, i);
                let ground = if d.z < 0.0 { camera.position.z / -d.z } else { f64::INFINITY };
                let range = (100.0 * 200f64.powf(chance.even())).min(ground);
                (range, d)
            })
            .collect();
        let forward = camera.rotation().transpose() * DVec3::NEG_Z;
        let depths: Vec<f32> = points.iter().map(|(range, d)| (0.1 / (range * d.dot(forward))) as f32).collect();
        let drawn = bench.depths(&camera, &depths);
        let mut view = ClearView { place, camera, points, depths, drawn, asked: Vec::new() };
        view.asked = view.compared().map(|i| view.asked(bench, i)).collect();
        view
    };
    cameras().map(view).into()
}

/// Compares the optical depth that regions add with that of the query. Returns the number of rays, the share of those
/// within 1 % or 0.001, and the largest error beyond that.
fn compare(bench: &mut Bench, views: &[ClearView], regions: &[WeatherRegion], name: &str) -> [f64; 3] {
    let (mut rays, mut held, mut worst, mut far) = (0, 0, 0.0f64, String::new());
    bench.context.set_weather_regions(regions).unwrap();
    for view in views {
        let foggy = bench.depths(&view.camera, &view.depths);
        for (i, before) in view.compared().zip(&view.asked) {
            let (through, clear, place) = (view.asked(bench, i), view.drawn[i], view.place);
            if through.max(*before) > 6.0 {
                assert!(foggy[i].max(clear) > 5.9, "{name}, {place}: {} against {through}", foggy[i]);
                continue;
            }
            let (drawn, truth) = (foggy[i] - clear, through - before);
            rays += 1;
            let error = (drawn - truth).abs();
            held += usize::from(error <= (0.01 * truth).max(1e-3));
            if error > worst {
                worst = error;
                far = format!("{place}: {drawn:.4} against {truth:.4} at {:?}", view.points[i]);
            }
        }
    }
    let found = [rays as f64, held as f64 / rays as f64, worst];
    println!("{name}: {found:.4?}, {far}");
    found
}

fn bench() -> Bench {
    Bench::new(ContextDesc { sky: coarse_sky(), ..ContextDesc::default() })
}

#[test]
fn the_depth_of_a_bank_is_that_along_the_way() {
    let mut bench = bench();
    let views = clear_views(&mut bench);
    let sides = polygon(&[[-2500.0, -800.0], [2000.0, -1100.0], [2600.0, 400.0], [-500.0, 1500.0]]);
    for (name, shape, perimeter_m) in [
        ("rectangle", rectangle(), 800.0),
        ("rectangle without perimeter", rectangle(), 0.0),
        ("ellipse", RegionShape::Ellipse { half_m: [3000.0, 900.0] }, 500.0),
        ("circle", RegionShape::Ellipse { half_m: [1500.0, 1500.0] }, 300.0),
        ("polygon", sides, 400.0),
    ] {
        let [_, held, worst] = compare(&mut bench, &views, &[bank(shape, perimeter_m)], name);
        assert!(held > 0.999 && worst < 0.02, "{name}: {held} {worst}");
    }
}

/// In a mist that a bank, and a hole in it, replace; where regions cover and merge each other; and for a polygon that
/// is not convex, which is sampled.
#[test]
fn the_depth_of_banks_together_is_that_along_the_way() {
    let mut bench = bench();
    let views = clear_views(&mut bench);
    let at = |mut region: WeatherRegion, center_m: [f64; 2]| {
        region.plan.center_m = [center_m[0], center_m[1], 0.0];
        region
    };
    let merging = |region: WeatherRegion| WeatherRegion { merges: WeatherParts::FOG, ..region };
    let thin = WeatherRegion { weather: fog(900.0, 80.0), ..bank(rectangle(), 400.0) };
    let hole =
        WeatherRegion { weather: Weather::default(), ..bank(RegionShape::Ellipse { half_m: [900.0; 2] }, 300.0) };
    let arrow = polygon(&[[-2500.0, -1500.0], [0.0, -300.0], [2500.0, -1500.0], [0.0, 2000.0]]);
    let covering = [bank(rectangle(), 800.0), at(thin.clone(), [2200.0, 5900.0]), at(hole.clone(), [0.0, 4700.0])];
    let merged = [merging(bank(rectangle(), 800.0)), merging(at(thin.clone(), [2200.0, 5900.0]))];
    let [_, held, worst] = compare(&mut bench, &views, &covering, "covering");
    assert!(held > 0.999 && worst < 0.02, "{held} {worst}");
    let [_, held, worst] = compare(&mut bench, &views, &merged, "merging");
    assert!(held > 0.999 && worst < 0.02, "{held} {worst}");
    let [_, held, worst] = compare(&mut bench, &views, &[bank(arrow, 600.0)], "arrow");
    assert!(held > 0.99 && worst < 0.1, "{held} {worst}");
    bench.context.set_weather(&fog(1500.0, 250.0), 0.0, 0.0).unwrap();
    let views = clear_views(&mut bench);
    let [_, held, worst] = compare(&mut bench, &views, &[bank(rectangle(), 800.0)], "in mist");
    assert!(held > 0.999 && worst < 0.02, "{held} {worst}");
    let [_, held, worst] = compare(&mut bench, &views, &[hole], "hole");
    assert!(held > 0.999 && worst < 0.02, "{held} {worst}");
}

/// Compares sky pixels from every camera with the query, which integrates the shares by itself and has the same
/// solution of the light.
#[test]
fn the_light_of_banks_is_the_light_asked_for() {
    let mut bench = Bench::new(ContextDesc::default());
    let regions = [bank(rectangle(), 800.0), bank(RegionShape::Ellipse { half_m: [3000.0, 900.0] }, 300.0)];
    let mut errors = Vec::new();
    for region in regions {
        for (place, camera) in cameras() {
            let mut pictures = Vec::new();
            for regions in [&[][..], std::slice::from_ref(&region)] {
                bench.context.set_weather_regions(regions).unwrap();
                let picture = bench.draw(&camera, None, 0.0);
                let pixels: Vec<usize> = (0..picture.len()).step_by(31).collect();
                let directions: Vec<DVec3> = pixels.iter().map(|i| direction(&camera, *i)).collect();
                let asked = bench.context.sky_radiance(camera.position, &directions, 0.0).unwrap();
                let drawn = |i: usize| [0, 1, 2].map(|k| f64::from(picture[i][k]));
                let ratio = |i: usize, asked: &[f64; 3]| (luminance(&drawn(i)) / luminance(asked), luminance(asked));
                pictures.push(pixels.iter().zip(&asked).map(|(i, asked)| ratio(*i, asked)).collect::<Vec<_>>());
            }
            let changed = pictures[0].iter().zip(&pictures[1]).filter(|(a, b)| (a.1 / b.1 - 1.0).abs() > 0.01);
            let found: Vec<f64> = changed.map(|(_, b)| (b.0 - 1.0).abs()).collect();
            println!("{place}: {} pixels, worst {:.4}", found.len(), found.iter().fold(0.0f64, |m, e| m.max(*e)));
            errors.extend(found);
        }
    }
    errors.sort_by(f64::total_cmp);
    let at = |share: f64| errors[((errors.len() - 1) as f64 * share) as usize];
    println!("{} pixels: median {:.4}, 95th percentile {:.4}, worst {:.4}", errors.len(), at(0.5), at(0.95), at(1.0));
    assert!(errors.len() > 100 && at(0.5) < 0.01 && at(0.95) < 0.03 && at(1.0) < 0.1);
}

/// The textures for the host's transparent shaders have the bank about the camera, up to its border.
#[test]
fn transparent_things_are_veiled_by_banks() {
    let mut bench = bench();
    let [_, _, (_, camera), ..] = cameras();
    bench.context.set_weather_regions(&[bank(rectangle(), 800.0)]).unwrap();
    bench.view.frame_textures().unwrap();
    bench.draw(&camera, None, 0.0);
    let through = readback::rgba(&bench.device, &bench.view.frame_textures().unwrap().through).unwrap();
    let forward = camera.rotation().transpose() * DVec3::NEG_Z;
    for distance in [50.0, 150.0, 400.0, 900.0] {
        let drawn = froxels::sample(&through, [0.5; 2], distance)[1];
        let end = camera.position + forward * distance;
        let truth = bench.context.between(camera.position, end, 0.0).unwrap().transmittance[1];
        assert!((drawn - truth).abs() < 0.02 && truth < 0.8, "{distance} m: {drawn} against {truth}");
    }
}
