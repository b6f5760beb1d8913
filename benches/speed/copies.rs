//! Cost of a frame on a software driver, in copies ([`Copying`]). Pictures have 640x360 pixels; set another size by
//! `SIZE="1280x720"`.
//!
//! The measured time is the processor time of all threads of the process, so that other load on the machine affects
//! neither side.

use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3};
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    ground::SurfaceClass,
    scene::Camera,
    weather::{Fog, FogKind, Surface, SurfaceState, Weather},
    wind::{WindGrid, WindGridKind},
};
use welkin_support::{level_ground::level_ground, processor::processor_ns, textures::texture};

pub use crate::copying::Copying;
pub use welkin_support::processor::median;

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Default size of pictures.
pub const SIZE: (u32, u32) = (640, 360);
/// Elevation of the sun.
const HIGH_SUN_DEG: f64 = 60.0;
/// Rounds over all scenes; the median of each scene counts.
const ROUNDS: usize = 9;
/// Number of frames in a row without work on tables after which the tables are complete.
pub const SETTLED: u32 = 12;

/// The value below which this share of the numbers lies.
pub fn quantile(of: &mut [f64], share: f64) -> f64 {
    of.sort_by(f64::total_cmp);
    of[((of.len() - 1) as f64 * share) as usize]
}

/// Parses a size such as `1280x720`.
pub fn size_of(text: &str) -> Fallible<(u32, u32)> {
    let (width, height) = text.split_once('x').ok_or_else(|| format!("{text} is not WIDTHxHEIGHT"))?;
    Ok((width.parse()?, height.parse()?))
}

/// One weather over a picture, and the stages in which its frames are drawn.
pub struct Scene {
    pub name: &'static str,
    pub context: Arc<Context>,
    pub view: View,
    pub camera: Camera,
    /// Rotation of the camera from frame to frame about the vertical, rad.
    pub turn_rad: f64,
    /// Climb of the camera from frame to frame, m.
    pub climb_m: f64,
    /// Movement of the sun from frame to frame, degrees. It may differ from 0 only if the scene has a context of its
    /// own.
    pub sun_deg: f64,
    pub flags: FrameFlags,
    pub calls: Vec<Stages>,
    pub has_depth: bool,
    pub frame_id: u64,
    pub copies: Vec<f64>,
}

impl Scene {
    /// Draws all stages before tone mapping, with depth. The camera is at rest 2 m above the ground and looks north and
    /// `pitch_rad` up.
    pub fn new(name: &'static str, context: &Arc<Context>, pitch_rad: f64) -> Fallible<Self> {
        let (eye, ahead) = (DVec3::new(0.0, 0.0, 2.0), DVec3::new(0.0, pitch_rad.cos(), pitch_rad.sin()));
        Ok(Self {
            name,
            context: context.clone(),
            view: View::new(context)?,
            camera: Camera::look_to(eye, ahead, DVec3::Z, 0.9, 16.0 / 9.0, 0.1),
            turn_rad: 0.0,
            climb_m: 0.0,
            sun_deg: 0.0,
            flags: FrameFlags::default(),
            calls: vec![Stages::ALL.without(Stages::TONE)],
            has_depth: true,
            frame_id: 0,
            copies: Vec::new(),
        })
    }

    /// Draws frames until the sky's tables, which are built in parts, are complete.
    fn settle(&mut self, device: &Device, color: &wgpu::Texture, depth: &wgpu::Texture) -> Fallible<()> {
        let (mut since, mut frames) = (0, 0);
        while since < SETTLED && frames < 1000 {
            self.ns(device, color, depth)?;
            since = if self.view.report().tables_rebuilt > 0 { 0 } else { since + 1 };
            frames += 1;
        }
        Ok(())
    }

    /// Measures one frame between two copies. A frame before that is not counted: with many shaders, a software driver
    /// drops the code of those that have not run for long, and compiles it again.
    fn measure(
        &mut self,
        device: &Device,
        copying: &Copying,
        color: &wgpu::Texture,
        depth: &wgpu::Texture,
    ) -> Fallible<()> {
        self.ns(device, color, depth)?;
        let before = copying.ns(device)?;
        let frame = self.ns(device, color, depth)?;
        let copy = 0.5 * (before + copying.ns(device)?);
        self.copies.push(frame / copy);
        Ok(())
    }

    /// Nanoseconds of a frame.
    fn ns(&mut self, device: &Device, color: &wgpu::Texture, depth: &wgpu::Texture) -> Fallible<f64> {
        let depth = self.has_depth.then_some(depth);
        self.frame_id += 1;
        if self.turn_rad != 0.0 {
            self.camera.view *= DMat4::from_rotation_z(self.turn_rad);
        }
        self.camera.position.z += self.climb_m;
        if self.sun_deg != 0.0 {
            let elevation_deg = HIGH_SUN_DEG + self.sun_deg * self.frame_id as f64;
            let context = Arc::get_mut(&mut self.context).ok_or("the sun moves in a context of its own")?;
            context.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg }))?;
        }
        let before = processor_ns();
        for stages in &self.calls {
            let frame = Frame { flags: self.flags, ..Frame::new(self.frame_id, self.camera, color, depth) };
            self.view.record(&self.context, &frame, *stages)?;
        }
        device.wait()?;
        Ok((processor_ns() - before) as f64)
    }
}

/// Creates a world under a high sun, with the moon at an elevation, degrees.
pub fn world(device: &Arc<Device>, shared: &Arc<Shared>, weather: &Weather, moon_deg: f64) -> Fallible<Arc<Context>> {
    let mut context = Context::new(device.clone(), shared.clone(), ContextDesc::default())?;
    context.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg: HIGH_SUN_DEG }))?;
    context.set_moon(Some(GivenDirection { azimuth_deg: 20.0, elevation_deg: moon_deg }))?;
    context.set_default_surface_class(SurfaceClass::Paved);
    context.set_weather(weather, 0.0, 0.0)?;
    context.update(0.0)?;
    Ok(Arc::new(context))
}

/// Creates a wind that is slow within 60 m of a place 150 m ahead.
fn slow_place() -> WindGrid {
    let speed = |i: u32| {
        let from = DVec2::new(f64::from(i % 33), f64::from(i / 33 % 33)) - 16.0;
        [if from.length() < 6.0 { 0.5 } else { 5.0 }, 0.0, 0.0]
    };
    WindGrid {
        origin: DVec3::new(-160.0, -10.0, 0.0),
        cell_m: DVec3::new(10.0, 10.0, 30.0),
        nodes: [33, 33, 3],
        kind: WindGridKind::Whole,
        velocities_m_s: (0..33 * 33 * 3).map(speed).collect(),
    }
}

/// Scenes: each weather in one call, clear noon with a call per stage, and a picture that shows only sky.
fn scenes(device: &Arc<Device>) -> Fallible<Vec<Scene>> {
    let shared = Arc::new(Shared::new(device)?);
    let haze = Weather { visibility_m: 3000.0, ..Weather::default() };
    let wet = Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() };
    let wet = Weather { surface: wet, ..Weather::default() };
    let weathers = [Weather::preset("clear")?, Weather::preset("fog")?, haze, Weather::preset("rain")?, wet];
    let mut worlds = Vec::new();
    for weather in &weathers {
        worlds.push(world(device, &shared, weather, -60.0)?);
    }
    worlds.push(world(device, &shared, &weathers[0], 30.0)?);
    let all = Stages::ALL.without(Stages::TONE);
    let (sky, air) = (Stages::BACKGROUND, Stages::MEDIUM);
    let mut made = Vec::new();
    for (name, world, calls, has_depth) in [
        ("clear noon", 0, &[all][..], true),
        ("clear noon, nothing but sky", 0, &[all], false),
        ("clear noon, the moon up", 5, &[all], true),
        ("clear noon, the moon up, nothing but sky", 5, &[all], false),
        ("clear noon, TONE too", 0, &[Stages::ALL], true),
        ("clear noon, BACKGROUND and MEDIUM in one call", 0, &[sky.with(air)], true),
        ("clear noon, in two calls", 0, &[sky, air], true),
        ("fog", 1, &[all], true),
        ("haze of 3 km", 2, &[all], true),
        ("rain", 3, &[all], true),
        ("rain without drops", 3, &[all.without(Stages::PARTICLES)], true),
        ("wet road", 4, &[all], true),
    ] {
        made.push(Scene { calls: calls.to_vec(), has_depth, ..Scene::new(name, &worlds[world], 0.0)? });
    }
    let clear = |name| Scene::new(name, &worlds[0], 0.0);
    made.push(Scene { turn_rad: 0.01, ..clear("clear noon, the camera turning")? });
    made.push(Scene { climb_m: 0.05, ..clear("clear noon, the camera climbing by 5 cm a frame")? });
    for (name, a_second_deg) in
        [("clear noon, the sun moving", 15.0 / 3600.0), ("clear noon, the sun moving by 1 degree a second", 1.0)]
    {
        let own = world(device, &shared, &weathers[0], -60.0)?;
        made.push(Scene { sun_deg: a_second_deg / 60.0, ..Scene::new(name, &own, 0.0)? });
    }
    let patches = Weather { visibility_m: 400.0, fog: Fog::of(FogKind::Patches), ..Weather::default() };
    made.push(Scene::new("patches of fog", &world(device, &shared, &patches, -60.0)?, 0.0)?);
    let mut led = world(device, &shared, &patches, -60.0)?;
    Arc::get_mut(&mut led).ok_or("a new context")?.set_wind_grid(Some(slow_place()))?;
    made.push(Scene::new("patches of fog led round a slow place", &led, 0.0)?);
    Ok(made)
}

/// Measures scenes and copies in turn and prints the device used. Cameras look `pitch_rad` up over level ground.
pub fn measured(pitch_rad: f64, scenes: impl Fn(&Arc<Device>) -> Fallible<Vec<Scene>>) -> Fallible<Vec<Scene>> {
    let device = Device::headless(&DeviceOptions::default())?;
    let size = std::env::var("SIZE").map_or(Ok(SIZE), |asked| size_of(&asked))?;
    let color = texture(&device, size, wgpu::TextureFormat::Rgba16Float, 1);
    let depth = texture(&device, size, wgpu::TextureFormat::R32Float, 1);
    level_ground(&device, &depth, pitch_rad);
    let copying = Copying::new(&device, size)?;
    let mut scenes = scenes(&device)?;
    for scene in &mut scenes {
        scene.settle(&device, &color, &depth)?;
    }
    for _ in 0..ROUNDS {
        for scene in &mut scenes {
            scene.measure(&device, &copying, &color, &depth)?;
        }
    }
    println!("frames of {} x {} in copies, {}:", size.0, size.1, device.caps().adapter_name);
    Ok(scenes)
}

/// Prints the copies of each scene.
pub fn run() -> Fallible<()> {
    for mut scene in measured(0.0, scenes)? {
        println!("  {}: {:.1}", scene.name, median(&mut scene.copies));
    }
    Ok(())
}
