//! Rain: cost against the number of drops; the added cost of boxes and maps that shelter from it, and of lamps; and
//! that dry weather costs nothing.

use std::{sync::Arc, time::Instant};

use glam::{DMat3, DVec3};
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    rain::{AreaMotion, AreaShape, OccluderMap, Planes, RainArea, RainModel, RainSettings, Shelter, Taken},
    scene::{Camera, HostLight},
    weather::{Precipitation, PrecipitationKind, Weather},
    wind::{WindGrid, WindGridKind},
};
use welkin_support::{depth_texture::depth_texture, textures};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: wgpu::Extent3d = wgpu::Extent3d { width: 640, height: 360, depth_or_array_layers: 1 };

struct Bench {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    frame_id: u64,
    /// Vertical field of view, rad.
    fov: f64,
}

impl Bench {
    fn new(options: &DeviceOptions) -> Fallible<Self> {
        let device = Device::headless(options)?;
        let shared = Arc::new(Shared::new(&device)?);
        let mut context = Context::new(device.clone(), shared, ContextDesc::default())?;
        context.set_sun(Some(GivenDirection { azimuth_deg: 60.0, elevation_deg: 35.0 }))?;
        let view = View::new(&context)?;
        let texture = |format| textures::texture(&device, (SIZE.width, SIZE.height), format, 1);
        let (color, depth) = (texture(wgpu::TextureFormat::Rgba16Float), texture(wgpu::TextureFormat::R32Float));
        Ok(Self { device, context, view, color, depth, frame_id: 0, fov: 0.9 })
    }

    fn weather(&mut self, rate_mm_h: f64, time_s: f64) -> Fallible<()> {
        self.falls(PrecipitationKind::Rain, rate_mm_h, time_s)
    }

    fn falls(&mut self, kind: PrecipitationKind, rate_mm_h: f64, time_s: f64) -> Fallible<()> {
        let precipitation = Precipitation::of(kind, rate_mm_h);
        let weather = Weather { visibility_m: 3000.0, precipitation, ..Weather::default() };
        self.context.set_weather(&weather, time_s, 0.0)?;
        Ok(self.context.update(time_s)?)
    }

    /// Time of the stage PARTICLES until the GPU has finished it, ms.
    fn frame(&mut self) -> Fallible<f64> {
        self.frame_id += 1;
        self.context.update(self.context.time_s() + 1.0 / 60.0)?;
        let camera = Camera::look_to(DVec3::new(0.0, 0.0, 2.0), DVec3::Y, DVec3::Z, self.fov, 16.0 / 9.0, 0.1);
        let frame = Frame::new(self.frame_id, camera, &self.color, Some(&self.depth));
        self.view.record(&self.context, &frame, Stages::PREPARE)?;
        self.device.wait()?;
        let start = Instant::now();
        self.view.record(&self.context, &frame, Stages::PARTICLES)?;
        self.device.wait()?;
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }

    fn drops(&mut self, most_drops: u32) -> Fallible<()> {
        self.model(RainModel::Drops, most_drops)
    }

    fn model(&mut self, model: RainModel, most_drops: u32) -> Fallible<()> {
        let asked = RainSettings { model, most_drops: Some(most_drops), ..RainSettings::default() };
        Ok(self.view.set_rain(asked)?)
    }

    /// Median times of `n` frames of each kind, drawn in turn.
    fn compare(
        &mut self,
        n: usize,
        mut first: impl FnMut(&mut Self) -> Fallible<()>,
        mut second: impl FnMut(&mut Self) -> Fallible<()>,
    ) -> Fallible<(f64, f64)> {
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for _ in 0..=n {
            first(self)?;
            a.push(self.frame()?);
            second(self)?;
            b.push(self.frame()?);
        }
        Ok((median(&mut a[1..]), median(&mut b[1..])))
    }

    /// Median times of some frames of each kind in turn. The first frame after a change is left out, as it may include
    /// the change's cost.
    fn in_turns(
        &mut self,
        mut first: impl FnMut(&mut Self) -> Fallible<()>,
        mut second: impl FnMut(&mut Self) -> Fallible<()>,
    ) -> Fallible<(f64, f64)> {
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for _ in 0..5 {
            first(self)?;
            self.frame()?;
            a.extend((0..3).map(|_| self.frame()).collect::<Fallible<Vec<_>>>()?);
            second(self)?;
            self.frame()?;
            b.extend((0..3).map(|_| self.frame()).collect::<Fallible<Vec<_>>>()?);
        }
        Ok((median(&mut a), median(&mut b)))
    }
}

fn median(v: &mut [f64]) -> f64 {
    v.sort_by(f64::total_cmp);
    v[v.len() / 2]
}

/// Prints the added cost of rain areas in front of the camera, and of the rim of an area in which the camera stands.
fn areas(bench: &mut Bench) -> Fallible<()> {
    let area = |i: u32| RainArea {
        center_m: [(f64::from(i % 4) - 1.5) * 2500.0, 6000.0 + f64::from(i / 4) * 2500.0, 0.0],
        shape: AreaShape::Ellipse([1000.0, 800.0]),
        rim_m: 300.0,
        motion: AreaMotion::Own([0.0, 0.0]),
        ..RainArea::default()
    };
    let list: Vec<RainArea> = (0..16).map(area).collect();
    let inside = [RainArea { center_m: [0.0; 3], ..list[0] }];
    let rim = [RainArea { center_m: [0.0, 650.0, 0.0], ..list[0] }];
    for (name, areas) in [
        ("1 rain area 5 km away adds", &list[..1]),
        ("4 add", &list[..4]),
        ("16 add", &list[..]),
        ("one all round the camera adds", &inside[..]),
        ("the rim of one all round it adds", &rim[..]),
    ] {
        let (a, b) =
            bench.compare(8, |s| Ok(s.context.set_rain_areas(&[])?), |s| Ok(s.context.set_rain_areas(areas)?))?;
        println!("  {name} {:.0} % of {} drops", 100.0 * (b / a - 1.0), 100_000);
    }
    Ok(bench.context.set_rain_areas(&[])?)
}

/// Creates the occluder map of a bridge over level ground, along the drops' direction of fall.
fn map(bench: &Bench, side: u32) -> Fallible<(wgpu::Texture, Taken)> {
    let fall = bench.context.rain_at(DVec3::ZERO, bench.context.time_s())?.fall_velocity_m_s.normalize();
    let (eye, half, deep) = (DVec3::new(0.0, 8.0, 0.0) - fall * 60.0, 24.0, 120.0);
    let taken = Taken::parallel(eye, fall, [half; 2], deep);
    let from_clip = taken.clip_from_world.inverse();
    let ndc = |i: u32| (f64::from(i) + 0.5) / f64::from(side) * 2.0 - 1.0;
    let depth = |x: u32, y: u32| {
        let p = (from_clip * glam::DVec4::new(ndc(x), -ndc(y), 1.0, 1.0)).truncate();
        let at = |z: f64| (z - p.z) / fall.z;
        let deck = p + fall * at(5.0);
        let bridge = deck.x.abs() < 12.0 && (deck.y - 8.0).abs() < 3.0;
        (1.0 - at(if bridge { 5.0 } else { 0.0 }) / deep) as f32
    };
    let texels: Vec<f32> = (0..side * side).map(|i| depth(i % side, i / side)).collect();
    Ok((depth_texture(&bench.device, (side, side), &texels), taken))
}

fn maps(bench: &mut Bench) -> Fallible<()> {
    let (depth, taken) = map(bench, 512)?;
    let map = [OccluderMap { depth: &depth, taken }];
    let (a, b) =
        bench.in_turns(|s| Ok(s.context.set_occluder_maps(&[])?), |s| Ok(s.context.set_occluder_maps(&map)?))?;
    println!("  a map of 512 x 512 of what keeps it off adds {:.0} %", 100.0 * (b / a - 1.0));
    let maps = [map[0]; 4];
    let (a, b) =
        bench.in_turns(|s| Ok(s.context.set_occluder_maps(&[])?), |s| Ok(s.context.set_occluder_maps(&maps)?))?;
    println!("  four of them add {:.0} %", 100.0 * (b / a - 1.0));
    bench.context.set_occluder_maps(&[])?;
    let start = Instant::now();
    bench.context.set_occluder_maps(&map)?;
    bench.device.wait()?;
    println!("  to take one over takes {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    Ok(bench.context.set_occluder_maps(&[])?)
}

/// Compares the cost of drops found by compute shaders with that of drops drawn one by one without them.
fn one_by_one(bench: &mut Bench, each: &[u32]) -> Fallible<()> {
    let mut other = Bench::new(&DeviceOptions { force_tier0: true, ..DeviceOptions::default() })?;
    other.weather(100.0, 1.0)?;
    for &drops in each {
        bench.drops(drops)?;
        other.drops(drops)?;
        let (mut listed, mut all) = (Vec::new(), Vec::new());
        for _ in 0..=8 {
            listed.push(bench.frame()?);
            all.push(other.frame()?);
        }
        let (a, b) = (median(&mut listed[1..]), median(&mut all[1..]));
        println!("  {drops} drops cost {:.2} of what they cost one by one, without compute shaders", a / b);
    }
    Ok(())
}

/// Prints the cost of simulated drops in the wind around a building: with a normal field of view, and with one so
/// narrow that hardly any drop is drawn.
fn integrated(bench: &mut Bench, each: &[u32]) -> Fallible<()> {
    let around = |x: f64, y: f64| {
        let (r2, a2) = ((x * x + y * y).max(1.0), 1.0);
        [6.0 * (1.0 - a2 * (x * x - y * y) / (r2 * r2)), -12.0 * a2 * x * y / (r2 * r2), 0.0]
    };
    let nodes = [32, 32, 16];
    let place = |i: u32| (f64::from(i % 32) * 0.5 - 8.0, f64::from(i / 32 % 32) * 0.5 - 8.0);
    let velocity = |i: u32| around(place(i).0, place(i).1).map(|v| v as f32);
    let grid = WindGrid {
        kind: WindGridKind::Whole,
        origin: DVec3::new(-8.0, -8.0, -2.0),
        cell_m: DVec3::splat(0.5),
        nodes,
        velocities_m_s: (0..nodes.iter().product()).map(velocity).collect(),
    };
    bench.context.set_wind_grid(Some(grid))?;
    for fov in [0.9, 1e-3] {
        bench.fov = fov;
        for &n in each {
            let (a, b) = bench.in_turns(|s| s.model(RainModel::Drops, n), |s| s.model(RainModel::Integrated, n))?;
            println!("  {n} drops, {fov} rad: without a state {a:.2} ms, integrated {b:.2} ms, {:.2} times", b / a);
        }
    }
    bench.fov = 0.9;
    Ok(bench.context.set_wind_grid(None)?)
}

pub fn run() -> Fallible<()> {
    let mut bench = Bench::new(&DeviceOptions::default())?;
    println!("rain: {} at {} x {}", bench.device.caps().adapter_name, SIZE.width, SIZE.height);
    bench.weather(100.0, 1.0)?;
    let base = 100_000;
    one_by_one(&mut bench, &[base, 4 * base])?;
    for drops in [50_000, 200_000, 400_000] {
        let (a, b) = bench.compare(8, |s| s.drops(base), |s| s.drops(drops))?;
        println!(
            "  {drops} drops cost {:.2} times {base} (their number is {:.2} times)",
            b / a,
            f64::from(drops) / 1e5
        );
    }
    for (first, name, second, other, drops) in [
        (RainModel::Cones, "cones", RainModel::Drops, "drops without a state", base),
        (RainModel::Automatic, "near ones and cones", RainModel::Drops, "drops without a state", base),
    ] {
        let (a, b) = bench.compare(6, |s| s.model(first, drops), |s| s.model(second, drops))?;
        println!("  {drops} drops: {name} {a:.2} ms, {other} {b:.2} ms, {:.2} times", b / a);
    }
    integrated(&mut bench, &[base, 4 * base])?;
    // Far more small drops than in nature, so that the air has as many as are to be drawn.
    bench.falls(PrecipitationKind::Drizzle, 500.0, bench.context.time_s() + 1.0)?;
    let (depth, taken) = map(&bench, 512)?;
    let hit = [OccluderMap { depth: &depth, taken }];
    for drops in [500_000, 1_000_000, 2_000_000, 4_000_000] {
        bench.drops(drops)?;
        let (ms, with) =
            bench.compare(4, |s| Ok(s.context.set_occluder_maps(&[])?), |s| Ok(s.context.set_occluder_maps(&hit)?))?;
        let (drawn, more) = (f64::from(bench.view.report().rain.drops), 100.0 * (with / ms - 1.0));
        println!(
            "  {:.3} million drops: {ms:.1} ms, {:.1} ms a million; with a map {more:+.0} %",
            drawn / 1e6,
            ms / drawn * 1e6
        );
    }
    bench.context.set_occluder_maps(&[])?;
    bench.weather(100.0, bench.context.time_s() + 1.0)?;
    bench.drops(base)?;
    let boxes: Vec<Shelter> = (0..16)
        .map(|i| Shelter {
            center_m: DVec3::new(f64::from(i) * 20.0 - 20.0, 10.0, 4.0),
            axes: DMat3::IDENTITY,
            half_size_m: DVec3::splat(3.0),
            velocity_m_s: DVec3::ZERO,
            planes: Planes::NONE,
        })
        .collect();
    let (a, b) = bench.in_turns(|s| Ok(s.context.set_shelters(&[])?), |s| Ok(s.context.set_shelters(&boxes)?))?;
    println!("  16 boxes that keep rain off, 3 of them near, add {:.0} %", 100.0 * (b / a - 1.0));
    bench.context.set_shelters(&[])?;
    bench.model(RainModel::Automatic, base)?;
    let (a, b) = bench.in_turns(|s| Ok(s.context.set_shelters(&[])?), |s| Ok(s.context.set_shelters(&boxes)?))?;
    println!("  near drops and cones: the same boxes add {:.0} %", 100.0 * (b / a - 1.0));
    bench.context.set_shelters(&[])?;
    println!("  and maps:");
    maps(&mut bench)?;
    println!("  drops alone:");
    bench.drops(base)?;
    maps(&mut bench)?;
    let lamp = HostLight {
        position_m: DVec3::new(0.0, 0.0, 3.0),
        direction: DVec3::Y,
        intensity_cd: [20_000.0; 3],
        inner_deg: 10.0,
        outer_deg: 30.0,
    };
    let lamps = [lamp; 4];
    let (a, b) = bench.compare(12, |s| Ok(s.context.set_lights(&[])?), |s| Ok(s.context.set_lights(&lamps)?))?;
    println!("  4 lamps add {:.0} %", 100.0 * (b / a - 1.0));
    bench.context.set_lights(&[])?;
    areas(&mut bench)?;
    let wet = median(&mut (0..8).map(|_| bench.frame()).collect::<Fallible<Vec<_>>>()?);
    bench.weather(0.0, bench.context.time_s() + 1.0)?;
    let dry = median(&mut (0..8).map(|_| bench.frame()).collect::<Fallible<Vec<_>>>()?);
    println!("  dry weather costs {:.4} of it", dry / wet);
    Ok(())
}
