//! Time of each effect on a GPU at 1920x1080 and 3840x2160, from the GPU's own timestamps. Prints the Markdown page
//! `docs/lab/gpu.md`: `cargo bench --bench speed -- gpu`. Set other sizes by `SIZES="320x180"`.
//!
//! Frames are submitted while the GPU is still busy with other work, so that it never waits for the CPU between two
//! timestamps.

use std::{sync::Arc, time::Instant};

use glam::{DMat4, DVec3};
use welkin::{
    clouds::CloudSettings,
    context::{Context, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    rain::{RainModel, RainSettings},
    scene::Camera,
    snow::{SnowModel, SnowSettings},
    weather::{CloudLayer, Precipitation, PrecipitationKind, Surface, SurfaceState, Weather},
    wind::{WindGrid, WindGridKind},
};
use welkin_support::{level_ground::level_ground, textures};

use crate::{
    clouds,
    copies::{Copying, SETTLED, median, size_of, world},
    glass,
    record::empty_pass,
};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Frames of a scene per round, and rounds.
const FRAMES: u64 = 8;
const ROUNDS: usize = 4;
const CLEARED: wgpu::LoadOp<wgpu::Color> = wgpu::LoadOp::Clear(wgpu::Color::BLACK);
/// Number of passes that clear a square picture to keep the GPU busy while frames are submitted, and the picture's
/// side.
const FILLING: (u32, u32) = (40, 4096);

/// Reads the GPU's clock between submissions.
struct Clock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    read: wgpu::Buffer,
    target: wgpu::TextureView,
    ns_per_tick: f64,
}

impl Clock {
    fn new(device: &Device) -> Self {
        let bytes = 8 * (FRAMES + 1);
        let buffer = |usage| {
            device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: bytes,
                usage,
                mapped_at_creation: false,
            })
        };
        let queries = device.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("timestamps"),
            ty: wgpu::QueryType::Timestamp,
            count: FRAMES as u32 + 1,
        });
        let target = textures::texture(device, (1, 1), wgpu::TextureFormat::Rgba16Float, 1);
        Self {
            queries,
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            read: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            target: target.create_view(&Default::default()),
            ns_per_tick: f64::from(device.queue.get_timestamp_period()),
        }
    }

    /// Writes a timestamp for the moment at which all work submitted so far is done.
    fn mark(&self, device: &Device, index: u32) {
        let mut encoder = device.device.create_command_encoder(&Default::default());
        empty_pass(&mut encoder, &self.target, CLEARED, Some((&self.queries, index)));
        device.submit(encoder);
    }

    /// Times between the timestamps, ms.
    fn between(&self, device: &Device) -> Fallible<Vec<f64>> {
        let mut encoder = device.device.create_command_encoder(&Default::default());
        encoder.resolve_query_set(&self.queries, 0..FRAMES as u32 + 1, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.read, 0, self.read.size());
        device.submit_and_wait(encoder)?;
        self.read.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        device.wait()?;
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&self.read.slice(..).get_mapped_range()?);
        self.read.unmap();
        Ok(ticks.windows(2).map(|t| t[1].saturating_sub(t[0]) as f64 * self.ns_per_tick * 1e-6).collect())
    }
}

/// Change from frame to frame.
#[derive(Clone, Copy, PartialEq)]
enum Change {
    /// The camera turns by 30 degrees per second at 60 frames per second.
    Turns,
    /// The camera climbs by 5 cm per frame and turns.
    Climbs,
    /// The sun moves by 0.05 degrees per frame.
    Sun,
}

/// A scene, and the name of the scene to which its cost is compared.
struct Scene {
    name: &'static str,
    beyond: &'static str,
    context: Context,
    view: View,
    change: Change,
    stages: Stages,
    flags: FrameFlags,
    /// Pitch of the camera, rad, and its height, m.
    pitch_rad: f64,
    height_m: f64,
    frame_id: u64,
}

impl Scene {
    fn camera(&self) -> Camera {
        let frame_id = self.frame_id;
        let height_m = self.height_m + if self.change == Change::Climbs { 0.05 * frame_id as f64 } else { 0.0 };
        let (eye, ahead) = (DVec3::Z * height_m, DVec3::new(0.0, self.pitch_rad.cos(), self.pitch_rad.sin()));
        let mut camera = Camera::look_to(eye, ahead, DVec3::Z, 0.9, 16.0 / 9.0, 0.1);
        camera.view *= DMat4::from_rotation_z(0.0087 * frame_id as f64);
        camera
    }

    /// Records one frame, a sixtieth of a second after the last; returns the calling thread's time in `record`, ms.
    fn record(&mut self, (color, depth): (&wgpu::Texture, &wgpu::Texture)) -> Fallible<f64> {
        self.frame_id += 1;
        let frame_id = self.frame_id;
        if self.change == Change::Sun {
            let elevation_deg = 45.0 + 0.05 * (frame_id % 600) as f64;
            self.context.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg }))?;
        }
        self.context.update(frame_id as f64 / 60.0)?;
        let frame = Frame::new(frame_id, self.camera(), color, Some(depth));
        let began = Instant::now();
        self.view.record(&self.context, &Frame { flags: self.flags, ..frame }, self.stages)?;
        Ok(began.elapsed().as_secs_f64() * 1e3)
    }
}

/// A benchmark with pictures of one size.
struct Bench {
    device: Arc<Device>,
    clock: Clock,
    filled: wgpu::TextureView,
    color: wgpu::Texture,
    depth: wgpu::Texture,
}

impl Bench {
    fn new(device: &Arc<Device>, (width, height): (u32, u32)) -> Self {
        let texture = |size, format| textures::texture(device, size, format, 1);
        let depth = texture((width, height), wgpu::TextureFormat::R32Float);
        level_ground(device, &depth, 0.0);
        let side = if device.caps().software { 16 } else { FILLING.1 };
        Self {
            device: device.clone(),
            clock: Clock::new(device),
            filled: texture((side, side), wgpu::TextureFormat::Rgba16Float).create_view(&Default::default()),
            color: texture((width, height), wgpu::TextureFormat::Rgba16Float),
            depth,
        }
    }

    /// Keeps the GPU busy while the measured work is submitted.
    fn fill(&self) {
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        for _ in 0..FILLING.0 {
            empty_pass(&mut encoder, &self.filled, CLEARED, None);
        }
        self.device.submit(encoder);
    }

    /// GPU time of each frame that `record` submits, ms.
    fn timed(&self, mut record: impl FnMut() -> Fallible<()>) -> Fallible<Vec<f64>> {
        let mut gpu = Vec::new();
        for _ in 0..ROUNDS {
            self.fill();
            self.clock.mark(&self.device, 0);
            for i in 1..=FRAMES {
                record()?;
                self.clock.mark(&self.device, i as u32);
            }
            gpu.extend(self.clock.between(&self.device)?);
        }
        Ok(gpu)
    }

    /// GPU time of a full-screen pass that loads a texel and writes it, median, ms.
    fn copy_ms(&self) -> Fallible<f64> {
        let copying = Copying::new(&self.device, (self.color.width(), self.color.height()))?;
        let mut gpu = self.timed(|| {
            let mut encoder = self.device.device.create_command_encoder(&Default::default());
            copying.copy(&mut encoder);
            self.device.submit(encoder);
            Ok(())
        })?;
        Ok(median(&mut gpu))
    }

    /// GPU time and calling thread's time per frame of a scene, medians, ms.
    fn measure(&self, scene: &mut Scene) -> Fallible<(f64, f64)> {
        let pictures = (&self.color, &self.depth);
        let (mut frames, mut since) = (0, 0);
        while since < SETTLED && frames < 2000 {
            frames += 1;
            scene.record(pictures)?;
            self.device.wait()?;
            let is_quiet = scene.view.report().tables_rebuilt == 0 || scene.change != Change::Turns;
            since = if is_quiet { since + 1 } else { 0 };
        }
        let mut cpu = Vec::new();
        let mut gpu = self.timed(|| {
            cpu.push(scene.record(pictures)?);
            Ok(())
        })?;
        Ok((median(&mut gpu), median(&mut cpu)))
    }
}

/// Wind that varies in space, so that falling particles are integrated step by step.
fn wind() -> WindGrid {
    let nodes = [32, 32, 16];
    let velocity = |i: u32| [4.0 + 0.05 * (i % 32) as f32, 0.0, 0.0];
    WindGrid {
        kind: WindGridKind::Whole,
        origin: DVec3::new(-64.0, -64.0, -2.0),
        cell_m: DVec3::splat(4.0),
        nodes,
        velocities_m_s: (0..nodes.iter().product()).map(velocity).collect(),
    }
}

struct Maker {
    device: Arc<Device>,
    shared: Arc<Shared>,
}

impl Maker {
    fn scene(&self, name: &'static str, beyond: &'static str, weather: &Weather) -> Fallible<Scene> {
        let context =
            Arc::into_inner(world(&self.device, &self.shared, weather, -60.0)?).ok_or("the world is shared")?;
        let view = View::new(&context)?;
        let (pitch_rad, height_m) = (0.0, 2.0);
        let (change, stages, flags) = (Change::Turns, Stages::ALL, FrameFlags::default());
        Ok(Scene { name, beyond, context, view, change, stages, flags, pitch_rad, height_m, frame_id: 0 })
    }

    fn clear(&self, name: &'static str, beyond: &'static str) -> Fallible<Scene> {
        self.scene(name, beyond, &Weather::default())
    }

    /// Scenes of the sky, haze and fog.
    fn air(&self) -> Fallible<Vec<Scene>> {
        let haze = Weather { visibility_m: 3000.0, ..Weather::default() };
        let mut night = self.clear("a night of stars", "")?;
        night.context.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg: -40.0 }))?;
        let mut mirrored = self.clear("the cube map of the surroundings", CLEAR)?;
        mirrored.view.environment()?;
        Ok(vec![
            self.clear(CLEAR, "")?,
            Scene { change: Change::Sun, ..self.clear("the sun moves", CLEAR)? },
            Scene { change: Change::Climbs, ..self.clear("the camera climbs", CLEAR)? },
            Scene { height_m: 4e5, pitch_rad: -0.4, ..self.clear("the planet from 400 km", "")? },
            night,
            self.scene("haze of 3 km", CLEAR, &haze)?,
            self.scene("fog", CLEAR, &Weather::preset("fog")?)?,
            mirrored,
        ])
    }

    fn clouds(&self) -> Fallible<Vec<Scene>> {
        let under = |name, layers: &[CloudLayer]| -> Fallible<Scene> {
            let weather = Weather { clouds: layers.to_vec(), ..Weather::default() };
            Ok(Scene { pitch_rad: 0.26, ..self.scene(name, CLEAR_UP, &weather)? })
        };
        let broken = clouds::cumulus();
        let mut shafts = under("broken cumulus with shafts of light", &broken)?;
        shafts.view.set_clouds(CloudSettings { shafts: true, ..Default::default() })?;
        Ok(vec![
            Scene { beyond: "", ..under(CLEAR_UP, &[])? },
            under("a closed deck of stratus", &clouds::stratus())?,
            under("broken cumulus", &broken)?,
            shafts,
            under("cumulus, altocumulus and cirrus", &clouds::three_layers())?,
            Scene { flags: FrameFlags::NO_HISTORY, ..under("broken cumulus, every pixel marched", &broken)? },
            Scene { height_m: 4e5, pitch_rad: -0.6, ..under("broken cumulus from 400 km", &broken)? },
        ])
    }

    fn rain(&self) -> Fallible<Vec<Scene>> {
        let falls = |name, beyond, kind, rate| -> Fallible<Scene> {
            let precipitation = Precipitation::of(kind, rate);
            let surface = Surface { state: Some(SurfaceState::Dry), ..Surface::default() };
            self.scene(name, beyond, &Weather { visibility_m: 3000.0, precipitation, surface, ..Weather::default() })
        };
        let asked = |name, model, drops, (kind, rate)| -> Fallible<Scene> {
            let mut scene = falls(name, DRY, kind, rate)?;
            let settings = RainSettings { model, most_drops: Some(drops), ..RainSettings::default() };
            scene.view.set_rain(settings)?;
            Ok(scene)
        };
        let cloudburst = (PrecipitationKind::Rain, 100.0);
        let mut stepped = asked("400,000 drops stepped through a wind", RainModel::Integrated, 400_000, cloudburst)?;
        stepped.context.set_wind_grid(Some(wind()))?;
        let wet = Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() };
        let mut behind_glass = self.scene("a wet windscreen", CLEAR, &Weather::default())?;
        let shower = Precipitation::of(PrecipitationKind::Rain, 10.0);
        behind_glass.context.set_weather(&Weather { precipitation: shower, ..Weather::default() }, 0.0, 0.0)?;
        behind_glass.stages = Stages::ALL.without(Stages::PARTICLES.with(Stages::SURFACE));
        behind_glass.view.set_windscreen(Some(&glass::windscreen()))?;
        // Far more small drops than in nature, so that the air has as many as are to be drawn.
        let many = (PrecipitationKind::Drizzle, 500.0);
        Ok(vec![
            falls(DRY, "", PrecipitationKind::None, 0.0)?,
            falls("rain of 5 mm/h", DRY, PrecipitationKind::Rain, 5.0)?,
            falls("rain of 20 mm/h", DRY, PrecipitationKind::Rain, 20.0)?,
            falls("rain of 60 mm/h", DRY, PrecipitationKind::Rain, 60.0)?,
            asked("150,000 drops", RainModel::Drops, 150_000, cloudburst)?,
            asked("400,000 drops", RainModel::Drops, 400_000, cloudburst)?,
            asked("4 million drops", RainModel::Drops, 4_000_000, many)?,
            stepped,
            self.scene("a wet road", CLEAR, &Weather { surface: wet, ..Weather::default() })?,
            behind_glass,
        ])
    }

    fn snow(&self) -> Fallible<Vec<Scene>> {
        let falls = |name, beyond, rate, depth_m| -> Fallible<Scene> {
            let kind = if rate > 0.0 { PrecipitationKind::Snow } else { PrecipitationKind::None };
            let surface = Surface { snow_depth_m: depth_m, ..Surface::default() };
            let weather = Weather {
                visibility_m: 3000.0,
                temperature_c: -5.0,
                precipitation: Precipitation::of(kind, rate),
                surface,
                ..Weather::default()
            };
            self.scene(name, beyond, &weather)
        };
        let flakes = |name, n, is_stepped| -> Fallible<Scene> {
            let mut scene = falls(name, COLD, 5.0, 0.0)?;
            let settings = SnowSettings { model: SnowModel::Flakes, most_flakes: Some(n), ..SnowSettings::default() };
            scene.view.set_snow(settings)?;
            if is_stepped {
                scene.context.set_wind_grid(Some(wind()))?;
            }
            Ok(scene)
        };
        Ok(vec![
            falls(COLD, "", 0.0, 0.0)?,
            falls("snow of 1 mm/h", COLD, 1.0, 0.0)?,
            falls("snow of 5 mm/h", COLD, 5.0, 0.0)?,
            falls("lying snow, 20 cm", COLD, 0.0, 0.2)?,
            flakes("250,000 flakes", 250_000, false)?,
            flakes("1 million flakes", 1_000_000, false)?,
            flakes("4 million flakes", 4_000_000, false)?,
            flakes("250,000 flakes stepped through a wind", 250_000, true)?,
            flakes("1 million flakes stepped through a wind", 1_000_000, true)?,
            flakes("4 million flakes stepped through a wind", 4_000_000, true)?,
        ])
    }
}

const CLEAR: &str = "clear noon";
const CLEAR_UP: &str = "clear noon, looking up";
const DRY: &str = "haze of 3 km, dry";
const COLD: &str = "haze of 3 km, cold";

/// Sizes of the measured pictures.
fn sizes() -> Fallible<Vec<(u32, u32)>> {
    let asked = std::env::var("SIZES").unwrap_or_else(|_| "1920x1080 3840x2160".into());
    asked.split_whitespace().map(size_of).collect()
}

/// Notes for the reader of the table.
const READING: &str = "
Scenes look over level ground, so that half of each picture is air before a plain. Rain wets the ground, so its rows have wet surfaces too. *Record*
is what a frame takes of the CPU at its least size; *memory* is the view's own, at the last size.

NVIDIA's data-centre GPUs draw pixels with few of their processors: an H100 with 2 of its 66 pairs (NVIDIA H100 architecture, 2022), which is
a laptop's worth. Compute passes have all of it.
";

/// Results published by others, each measured on its authors' machine.
const PUBLISHED: &str = "
## Published beside it

Each was measured on its authors' machine; none was run here.

| what | ms |
|---|---|
| sky with all its tables, 1280x720, GTX 1080 (Hillaire 2020) | 0.31 |
| volumetric clouds: PlayStation 4 (Schneider 2015) | < 2 |
| 4 million flakes in a wind of 128 x 32 x 128, GTX 480: simulated; drawn too | 13.8; 33.8 |
| 4 million drops with collisions, GTX 280 | 64 |
| 150,000 particles of rain, 3840x2160, RTX 3090 | 0.175 |
";

/// Prints the page. On a software driver without `SIZES`, prints that a GPU is needed.
pub fn run() -> Fallible<()> {
    let device = Device::headless(&DeviceOptions::default())?;
    let has_clock = device.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
    if !has_clock || device.caps().software && std::env::var_os("SIZES").is_none() {
        println!("gpu: {} is no GPU with timestamps", device.caps().adapter_name);
        return Ok(());
    }
    let sizes = sizes()?;
    let benches: Vec<Bench> = sizes.iter().map(|&size| Bench::new(&device, size)).collect();
    let maker = Maker { device: device.clone(), shared: Arc::new(Shared::new(&device)?) };
    let named = |of: &str| sizes.iter().map(|(w, h)| format!(" {w}x{h}, {of} |")).collect::<String>();
    println!("# What effects cost on a GPU\n");
    println!(
        "Written by `cargo bench --bench speed -- gpu` on: {}, {}.\n",
        device.caps().adapter_name,
        device.caps().driver
    );
    println!(
        "Milliseconds of a whole frame by the GPU's timestamps, all that Welkin does for it from the sky to the tone curve, and how much that is \
         more than the frame that the third column names; then what `View::record` takes of the calling thread. Medians of {} frames, \
         {:?} adapter; the camera turns by half a degree a frame.\n",
        FRAMES * ROUNDS as u64,
        device.caps().backend
    );
    println!("| scene |{} beyond |{} record, ms | memory, MB |", named("ms"), named("more"));
    println!("|---|{}---|{}---|---|", "---|".repeat(sizes.len()), "---|".repeat(sizes.len()));
    let copies = benches.iter().map(Bench::copy_ms).collect::<Fallible<Vec<_>>>()?;
    let copies = copies.iter().map(|ms| format!(" {ms:.3} |")).collect::<String>();
    println!("| a copy: a pass that loads a texel and writes it |{copies} |{} | |", " |".repeat(sizes.len()));
    let mut told: Vec<(&str, Vec<f64>)> = Vec::new();
    for scenes in [Maker::air, Maker::clouds, Maker::rain, Maker::snow] {
        for mut scene in scenes(&maker)? {
            let measured = benches.iter().map(|bench| bench.measure(&mut scene)).collect::<Fallible<Vec<_>>>()?;
            let row = |ms: &mut dyn Iterator<Item = String>| ms.map(|ms| format!(" {ms} |")).collect::<String>();
            let base = told.iter().find(|(name, _)| *name == scene.beyond);
            let whole = row(&mut measured.iter().map(|(gpu, _)| format!("{gpu:.3}")));
            let more = row(&mut measured
                .iter()
                .enumerate()
                .map(|(i, (gpu, _))| base.map_or(String::new(), |(_, of)| format!("{:+.3}", gpu - of[i]))));
            println!(
                "| {} |{whole} {} |{more} {:.2} | {:.1} |",
                scene.name,
                scene.beyond,
                measured.iter().map(|m| m.1).fold(f64::INFINITY, f64::min),
                scene.view.report().bytes as f64 * 1e-6
            );
            told.push((scene.name, measured.into_iter().map(|m| m.0).collect()));
        }
    }
    println!("{READING}{PUBLISHED}");
    Ok(())
}
