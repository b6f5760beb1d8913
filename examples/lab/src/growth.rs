//! `lab growth`: how time and memory grow with the amounts that a host can set.

use std::sync::Arc;
use std::time::Instant;

use welkin::candidates::Method as LibraryMethod;
use welkin::context::{Context, ContextDesc, GivenDirection};
use welkin::frame::{Frame, Shared, Stages, View};
use welkin::gpu::{Device, flat_texture};
use welkin::rain::{RainModel, RainSettings};
use welkin::scene::Camera;
use welkin::sky::{SkySettings, SkyTables, SkyVolume};
use welkin::weather::{CloudLayer, Weather, derive};
use welkin::{Result, Status};

use crate::candidates::{Effect, Method, candidate};
use crate::chart::{Lab, say_what_moved, today};
use crate::command::Options;
use crate::front::growth;
use crate::plot::{Line, Titles, lines, short};
use crate::store::{Journal, Table};
use crate::timing::{interleaved, target, timed};
use crate::{fog, page, rain, scenes, sky, wind_flakes};

/// Exponents above this are reported: linear growth plus the fit's own error.
pub const LINEAR: f64 = 1.1;
const COLUMNS: [&str; 10] =
    ["key", "what", "against", "amount", "cost", "cost_low", "cost_high", "ms", "bytes", "date"];

/// Measures all series and draws them.
///
/// # Errors
/// Files and the GPU.
pub fn run(options: &Options) -> Result<()> {
    let lab = Lab::open(options)?;
    let mut series = Series {
        journal: Journal::open(&options.out, "growth", &lab.note("growth", options), &COLUMNS, options.fresh)?,
        lab: &lab,
    };
    sky_pixels(&mut series)?;
    fog_pixels(&mut series)?;
    sky_tables(&mut series)?;
    views(&mut series)?;
    clouds(&mut series)?;
    drops(&mut series)?;
    wind_flakes::measure(&mut series)?;
    let (table, old) = series.journal.finish()?;
    say_what_moved(&table, old.as_ref());
    draw(&table, options)?;
    for (name, against, time, bytes) in exponents(&table) {
        for (kind, fit) in [("time", time), ("bytes", bytes)] {
            if let Some((p, miss)) = fit {
                let worse = if p > LINEAR { "  <- worse than linear" } else { "" };
                println!("  {name} against {against}: {kind} ~ amount^{} (within x{}){worse}", short(p), short(miss));
            }
        }
    }
    page::write(&options.out)
}

/// The series that are being measured.
pub struct Series<'a> {
    journal: Journal,
    pub lab: &'a Lab,
}

impl Series<'_> {
    /// Measures one point, unless an earlier run has it. `make` prepares the work to be timed and returns the bytes
    /// that it holds.
    pub fn point<F: FnMut(usize) -> Result<f64>>(
        &mut self,
        (what, against, amount): (&str, &str, f64),
        make: impl FnOnce() -> Result<(F, f64)>,
    ) -> Result<()> {
        let key = format!("{what}/{against}/{amount}");
        if self.journal.has(&key) {
            return Ok(());
        }
        eprintln!("  {key} ..");
        let (work, bytes) = make()?;
        let cost = interleaved(&self.lab.baseline, self.lab.rounds, work)?;
        let n = |v: f64| format!("{v:.6e}");
        let numbers = [amount, cost.median, cost.low, cost.high, cost.ms, bytes].map(n);
        let mut row = vec![key, what.to_owned(), against.to_owned()];
        row.extend(numbers);
        row.push(today());
        self.journal.push(row)
    }
}

const SIZES: [(u32, u32); 5] = [(80, 45), (160, 90), (320, 180), (640, 360), (1280, 720)];

fn sky_pixels(series: &mut Series<'_>) -> Result<()> {
    let device = series.lab.device.clone();
    let mut made: Option<sky::Library> = None;
    for size in SIZES {
        let pixels = f64::from(size.0 * size.1);
        series.point(("sky", "pixels", pixels), || {
            use sky::SkyDraw as _;
            let library = match made.take() {
                Some(l) => l,
                None => sky::Library::new(&device, &SkySettings::default())?,
            };
            let library = made.insert(library);
            let bytes = candidate(Effect::Sky, "directional")?.work.view_bytes as f64;
            Ok((move |_: usize| library.frame(size, 0, false), bytes))
        })?;
    }
    Ok(())
}

fn fog_pixels(series: &mut Series<'_>) -> Result<()> {
    let device = series.lab.device.clone();
    let bench = fog::Bench::new(&device)?;
    let scene = scenes::fog()[1];
    for size in SIZES {
        let pixels = f64::from(size.0 * size.1);
        series.point(("fog", "pixels", pixels), || {
            let drawn = bench.make(&candidate(Effect::Fog, "exact")?, &scene, &fog::host(&scene, size)?)?;
            Ok((move |_: usize| drawn.frame(), 0.0))
        })?;
    }
    Ok(())
}

fn sky_tables(series: &mut Series<'_>) -> Result<()> {
    let device = series.lab.device.clone();
    for name in ["directional-eighth", "directional-quarter", "directional-half", "directional"] {
        let c = candidate(Effect::Sky, name)?;
        let Method::Library(LibraryMethod::Sky(s)) = c.method else { continue };
        let texels = c.work.shared_bytes as f64 / 8.0;
        series.point(("sky build", "texels", texels), || {
            let mut tables = SkyTables::new(&device, &s)?;
            let device = device.clone();
            let planet = scenes::SkyAir::Clear.planet();
            let work = move |i: usize| {
                let air = planet.with_air_scaled(1.0 + 0.001 * (i + 1) as f64);
                Ok(sky::build(&device, &mut tables, &air)? * 1e3)
            };
            Ok((work, c.work.shared_bytes as f64))
        })?;
        series.point(("sky of an observer", "texels", c.work.view_bytes as f64 / 8.0), || {
            let small = SkySettings { orders: 3, suns: 16, altitudes: 8, ..s };
            let mut tables = SkyTables::new(&device, &small)?;
            let planet = scenes::SkyAir::Clear.planet();
            sky::build(&device, &mut tables, &planet)?;
            let mut volume = SkyVolume::new(&tables)?;
            let device = device.clone();
            let work = move |i: usize| {
                let mut encoder = device.device.create_command_encoder(&Default::default());
                volume.prepare(&mut encoder, &tables, &sky::moving(&planet, i, true))?;
                timed(&device, encoder)
            };
            Ok((work, c.work.view_bytes as f64))
        })?;
    }
    Ok(())
}

/// Growth with the number of views of one context, each recorded with all stages.
fn views(series: &mut Series<'_>) -> Result<()> {
    let device = series.lab.device.clone();
    for count in [1u32, 2, 4, 8, 16] {
        series.point(("frame", "views", f64::from(count)), || {
            let mut hosts = HostViews::new(&device, count)?;
            let bytes = hosts.views.iter().map(|v| v.report().bytes as f64).sum::<f64>();
            Ok((move |_: usize| hosts.frame(), bytes))
        })?;
    }
    Ok(())
}

struct HostViews {
    device: Arc<Device>,
    context: Context,
    views: Vec<View>,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    next: u64,
}

impl HostViews {
    fn new(device: &Arc<Device>, count: u32) -> Result<Self> {
        let shared = Arc::new(Shared::new(device)?);
        let mut context = Context::new(device.clone(), shared, ContextDesc::default())?;
        context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: 30.0 }))?;
        let size = (160, 90);
        let color = target(device, size, wgpu::TextureFormat::Rgba16Float);
        let depth = flat_texture(
            &device.device,
            "lab depth",
            size,
            wgpu::TextureFormat::Depth32Float,
            wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        );
        let views = (0..count).map(|_| View::new(&context)).collect::<Result<Vec<_>>>()?;
        let mut this = Self { device: device.clone(), context, views, color, depth, next: 0 };
        // The shared tables are built in parts, over many frames.
        let mut quiet = 0;
        while quiet < 12 {
            this.frame()?;
            quiet = if this.views.iter().any(|v| v.report().tables_rebuilt > 0) { 0 } else { quiet + 1 };
        }
        Ok(this)
    }

    /// Draws the next frame of all views and returns its time, ms.
    fn frame(&mut self) -> Result<f64> {
        self.next += 1;
        let start = Instant::now();
        for (i, view) in self.views.iter_mut().enumerate() {
            let angle = i as f64 * 0.4;
            let forward = glam::DVec3::new(angle.sin(), angle.cos(), 0.1);
            let camera =
                Camera::look_to(glam::DVec3::new(0.0, 0.0, 50.0), forward, glam::DVec3::Z, 1.0, 16.0 / 9.0, 0.1);
            view.record(&self.context, &Frame::new(self.next, camera, &self.color, Some(&self.depth)), Stages::ALL)?;
        }
        self.device.wait()?;
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }
}

/// Growth with the number of cloud layers: the CPU time of deriving conditions from the weather.
fn clouds(series: &mut Series<'_>) -> Result<()> {
    for count in [1usize, 2, 4, 8, 16] {
        series.point(("conditions", "cloud layers", count as f64), || {
            let layer = |i: usize| CloudLayer::new(0.4, 500.0 + 600.0 * i as f64);
            let weather = Weather { clouds: (0..count).map(layer).collect(), ..Weather::default() };
            derive(&weather)?;
            let work = move |_: usize| {
                let start = Instant::now();
                for _ in 0..2000 {
                    std::hint::black_box(derive(std::hint::black_box(&weather))?);
                }
                Ok(start.elapsed().as_secs_f64() * 1e3)
            };
            Ok((work, 0.0))
        })?;
    }
    Ok(())
}

/// Growth with the number of rain drops drawn, in a cloudburst, which has more drops than that.
fn drops(series: &mut Series<'_>) -> Result<()> {
    let scene = scenes::RainScene { rate_mm_h: 400.0, ..scenes::rain()[3] };
    for count in [50_000u32, 100_000, 200_000, 400_000, 800_000] {
        let device = series.lab.device.clone();
        series.point(("rain", "drops", f64::from(count)), || {
            let mut host = rain::Host::new(&device, &scene, (320, 180))?;
            host.set(RainSettings { model: RainModel::Drops, most_drops: Some(count), ..RainSettings::default() })?;
            Ok((move |_: usize| host.timed(), 0.0))
        })?;
    }
    Ok(())
}

/// Name of a series, the amount it grows with, and the exponents of time and of bytes, each with the largest factor
/// between a point and the fit.
pub type Exponents = (String, String, Option<(f64, f64)>, Option<(f64, f64)>);

/// The exponents of all series in a table.
pub fn exponents(table: &Table) -> Vec<Exponents> {
    let mut names: Vec<(String, String)> = Vec::new();
    for r in &table.rows {
        if !names.iter().any(|n| n.0 == r[1] && n.1 == r[2]) {
            names.push((r[1].clone(), r[2].clone()));
        }
    }
    let fit = |name: &(String, String), column: &str| growth(&series_of(table, name, column));
    names.into_iter().map(|n| (n.0.clone(), n.1.clone(), fit(&n, "cost"), fit(&n, "bytes"))).collect()
}

fn series_of(table: &Table, name: &(String, String), column: &str) -> Vec<[f64; 2]> {
    let rows = table.rows.iter().filter(|r| r[1] == name.0 && r[2] == name.1);
    rows.filter_map(|r| Some([table.number(r, "amount")?, table.number(r, column)?])).collect()
}

fn draw(table: &Table, options: &Options) -> Result<()> {
    for (column, stem, title, y) in [
        ("cost", "growth-time", "How time grows", "time over that of the least amount"),
        ("bytes", "growth-bytes", "How memory grows", "bytes over those of the least amount"),
    ] {
        let mut curves = Vec::new();
        for (name, against, time, bytes) in exponents(table) {
            let Some((p, _)) = (if column == "cost" { time } else { bytes }) else { continue };
            let points = series_of(table, &(name.clone(), against.clone()), column);
            let Some([x0, y0]) = points.first().copied() else { continue };
            let points = points.iter().map(|[x, y]| [x / x0, y / y0]).collect();
            curves.push(Line { name: format!("{name} by {against}: ^{}", short(p)), points });
        }
        if curves.is_empty() {
            return Err(welkin::Error::new(Status::Internal, "no series to draw".to_owned()));
        }
        let titles = Titles {
            title,
            x: "amount over the least",
            y,
            note: "names: the series, what it grows with, and the fitted exponent",
        };
        lines(&curves, &titles).save(&options.out.join(stem))?;
    }
    Ok(())
}
