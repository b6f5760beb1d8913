//! The coarse grid of the weather against pictures in which every pixel is drawn.

use std::sync::Arc;

use glam::DVec3;

use crate::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, FrameFlags, Report, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    scene::Camera,
    sky::SkySettings,
    weather::{CloudKind, CloudLayer, Fog, FogKind, Weather},
};

const SIZE: (u32, u32) = (320, 180);
const EYE_M: f64 = 12.0;

/// Picture of a weather, once interpolated from the grid and once with every pixel drawn, and the passes of both.
struct Pictures {
    looked_up: Vec<[f32; 4]>,
    drawn: Vec<[f32; 4]>,
    passes: [u32; 2],
}

/// Depths of level ground with a post one pixel wide, a board, and thin posts far away.
fn depths() -> Vec<f32> {
    let (width, half) = (SIZE.0, 0.5 * f64::from(SIZE.1));
    let of = |i: u32| {
        let (x, y) = (i % width, i / width);
        let down = (f64::from(y) + 0.5 - half) / half * 0.5_f64.tan();
        let post = match x {
            60 if (40..150).contains(&y) => 15.0,
            100..=130 if (70..140).contains(&y) => 60.0,
            _ if x % 17 == 3 && (84..95).contains(&y) => 900.0,
            _ => f64::INFINITY,
        };
        let ground = if down > 0.0 { EYE_M / down } else { f64::INFINITY };
        (0.1 / post.min(ground)) as f32
    };
    (0..SIZE.0 * SIZE.1).map(of).collect()
}

/// A weather in front of these depths.
struct Scene {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    frame_id: u64,
}

impl Scene {
    fn new(device: &Arc<Device>, weather: &Weather, (azimuth_deg, elevation_deg): (f64, f64)) -> Self {
        let shared = Arc::new(Shared::new(device).expect("shared"));
        let sky = SkySettings { orders: 4, suns: 48, altitudes: 12, ..SkySettings::default() };
        let desc = ContextDesc { sky, ..ContextDesc::default() };
        let mut context = Context::new(device.clone(), shared, desc).expect("one");
        context.set_sun(Some(GivenDirection { azimuth_deg, elevation_deg })).expect("a sun");
        context.set_moon(Some(GivenDirection { azimuth_deg: 30.0, elevation_deg: -50.0 })).expect("a moon");
        context.set_weather(weather, 0.0, 0.0).expect("a weather");
        let view = View::new(&context).expect("a view");
        let texture = |format| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC
                | wgpu::TextureUsages::COPY_DST;
            crate::gpu::flat_texture(&device.device, "test", SIZE, format, usage)
        };
        let (color, depth) = (texture(wgpu::TextureFormat::Rgba32Float), texture(wgpu::TextureFormat::R32Float));
        let made = Self { device: device.clone(), context, view, color, depth, frame_id: 0 };
        made.write(&made.depth, bytemuck::cast_slice(&depths()), 4);
        made
    }

    fn write(&self, texture: &wgpu::Texture, bytes: &[u8], texel: u32) {
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(texel * SIZE.0), rows_per_image: None };
        self.device.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
    }

    /// Draws over a grey picture.
    fn draw(&mut self, stages: Stages, flags: FrameFlags) -> Report {
        let grey: Vec<f32> = (0..SIZE.0 * SIZE.1).flat_map(|i| [2000.0 + 500.0 * (i % 7) as f32; 4]).collect();
        self.write(&self.color, bytemuck::cast_slice(&grey), 16);
        let eye = DVec3::new(0.0, 0.0, EYE_M);
        let camera = Camera::look_to(eye, DVec3::Y, DVec3::Z, 1.0, 16.0 / 9.0, 0.1);
        self.frame_id += 1;
        let frame = Frame { flags, ..Frame::new(self.frame_id, camera, &self.color, Some(&self.depth)) };
        self.view.record(&self.context, &frame, stages).expect("a frame");
        *self.view.report()
    }

    /// Draws until nothing changes any more. Clouds need sixteen frames.
    fn settle(&mut self, stages: Stages) {
        let mut quiet = 0;
        while quiet < 20 {
            quiet = if self.draw(stages, FrameFlags::default()).tables_rebuilt > 0 { 0 } else { quiet + 1 };
        }
    }

    fn picture(&self) -> Vec<[f32; 4]> {
        readback::rgba(&self.device, &self.color).expect("read")
    }
}

fn pictures(device: &Arc<Device>, weather: &Weather, sun: (f64, f64), stages: Stages) -> Pictures {
    let mut scene = Scene::new(device, weather, sun);
    scene.settle(stages);
    let first = scene.draw(stages, FrameFlags::default()).passes;
    let looked_up = scene.picture();
    scene.view.forget_grid();
    let second = scene.draw(stages, FrameFlags::default()).passes;
    Pictures { looked_up, drawn: scene.picture(), passes: [first, second] }
}

/// A device that Welkin treats as a software driver or, if `is_gpu`, as a GPU.
fn device(is_gpu: bool) -> Arc<Device> {
    let mut device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
    if is_gpu {
        Arc::get_mut(&mut device).expect("nobody else has it").take_for_gpu();
    }
    device
}

fn nobody_sees_what_is_looked_up(is_gpu: bool) {
    let device = device(is_gpu);
    let of = |name: &str| Weather::preset(name).expect("a preset");
    let mist = Fog { kind: FogKind::Shallow, top_m: Some(2.0), coverage: None, visibility_inside_m: None };
    let cumulus = CloudLayer::of(CloudKind::Cumulus, 0.5, 1000.0);
    let all = Stages::ALL.without(Stages::TONE).without(Stages::PARTICLES);
    let two = Stages::PREPARE.with(Stages::BACKGROUND).with(Stages::MEDIUM);
    for (name, weather, sun, stages) in [
        ("clear", of("clear"), (200.0, 60.0), two),
        ("a low sun in the picture", of("clear"), (8.0, 3.0), two),
        ("fog", of("fog"), (200.0, 40.0), two),
        ("haze", Weather { visibility_m: 3000.0, ..Weather::default() }, (10.0, 20.0), two),
        ("shallow fog", Weather { fog: mist, ..Weather::default() }, (200.0, 40.0), two),
        ("rain", of("rain"), (200.0, 40.0), all),
        ("broken clouds", Weather { clouds: vec![cumulus], ..Weather::default() }, (200.0, 40.0), all),
        ("broken clouds, the sky alone", Weather { clouds: vec![cumulus], ..Weather::default() }, (8.0, 9.0), two),
    ] {
        let found = pictures(&device, &weather, sun, stages);
        let [with, without] = found.passes;
        assert_eq!(with, without + 2, "{name}");
        let mean = found.drawn.iter().map(|p| f64::from(p[1])).sum::<f64>() / found.drawn.len() as f64;
        let of = |(a, b): (&[f32; 4], &[f32; 4])| {
            (0..3).map(|c| f64::from((a[c] - b[c]).abs()) / (f64::from(b[c]) + 0.01 * mean)).fold(0.0, f64::max)
        };
        let mut errors: Vec<f64> = found.looked_up.iter().zip(&found.drawn).map(of).collect();
        let changed = errors.iter().filter(|e| **e > 0.0).count() as f64 / errors.len() as f64;
        errors.sort_by(f64::total_cmp);
        let [p95, worst] = [0.95, 1.0].map(|share| errors[((errors.len() - 1) as f64 * share) as usize]);
        println!("{name}: looked up {changed:.2} of it; off {p95:.5} at p95, {worst:.5} at worst");
        assert!(changed > 0.15, "{name}: {changed}");
        assert!(p95 < 1e-3 && worst < 5e-3, "{name}: {p95} {worst}");
    }
}

#[test]
fn interpolated_pixels_of_a_software_driver_look_like_drawn_ones() {
    nobody_sees_what_is_looked_up(false);
}

#[test]
fn interpolated_pixels_of_a_gpu_look_like_drawn_ones() {
    nobody_sees_what_is_looked_up(true);
}

/// On a GPU each frame compiles one pipeline, and every pixel is drawn until all are compiled; pure pictures must not
/// depend on that.
#[test]
fn pure_pictures_of_a_gpu_wait_for_no_pipeline() {
    let stages = Stages::PREPARE.with(Stages::BACKGROUND).with(Stages::MEDIUM);
    let haze = Weather { visibility_m: 3000.0, ..Weather::default() };
    let mut scene = Scene::new(&device(true), &haze, (200.0, 40.0));
    scene.draw(stages, FrameFlags::NO_HISTORY);
    let first = scene.picture();
    scene.settle(stages);
    scene.draw(stages, FrameFlags::NO_HISTORY);
    assert!(scene.picture() == first, "pure pictures are the same");

    let mut other = Scene::new(&device(true), &haze, (200.0, 40.0));
    other.draw(stages, FrameFlags::default());
    let steps: Vec<u32> =
        (0..4).map(|_| other.draw(Stages::BACKGROUND.with(Stages::MEDIUM), FrameFlags::default()).passes).collect();
    assert_eq!(steps, [1, 1, 3, 3], "all pixels; grid, the uneven and the even ones are compiled one by one");
}

/// A software driver computes cloud shadows only for pixels on which the host drew, a GPU for all pixels.
#[test]
fn shadows_drawn_apart_are_those_drawn_with_the_clouds() {
    let cumulus = CloudLayer::of(CloudKind::Cumulus, 0.5, 1000.0);
    let weather = Weather { clouds: vec![cumulus], ..Weather::default() };
    let stages = Stages::PREPARE.with(Stages::BACKGROUND).with(Stages::MEDIUM).with(Stages::SURFACE);
    let [apart, whole, bare] =
        [(false, stages), (true, stages), (false, stages.without(Stages::SURFACE))].map(|(is_gpu, stages)| {
            let mut scene = Scene::new(&device(is_gpu), &weather, (200.0, 40.0));
            scene.draw(stages, FrameFlags::NO_HISTORY);
            scene.picture()
        });
    let off = |a: &[[f32; 4]], b: &[[f32; 4]]| {
        let off = |(a, b): (&[f32; 4], &[f32; 4])| f64::from((a[1] - b[1]).abs() / b[1]);
        a.iter().zip(b).map(off).fold(0.0, f64::max)
    };
    let (ways, shadows) = (off(&apart, &whole), off(&apart, &bare));
    println!("drawn apart: off by {ways:.5}; shadows change up to {shadows:.2}");
    assert!(shadows > 0.2, "there are shadows: {shadows}");
    assert!(ways < 2e-3, "{ways}");
}
