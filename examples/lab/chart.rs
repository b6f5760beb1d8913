//! `lab chart`: what each candidate costs and how far it is from the truth.

use std::sync::Arc;

use welkin::Result;
use welkin::candidates::{Candidate, Effect, Method, candidates};
use welkin::gpu::{Device, DeviceOptions};
use welkin::plan::{Difference, Price, difference, difference::percentile};
use welkin::rain::{RainModel, RainSettings, candidates::RainMethod};

use crate::command::Options;
use crate::front::pareto;
use crate::picture::{Figures, Picture};
use crate::plot::{Point, Titles, scatter, short};
use crate::store::{Journal, Table};
use crate::timing::{Baseline, Ratio, interleaved};
use crate::{fog, page, quadrature, rain, scenes, sky, snow, stars};

/// What can be charted.
pub const CHARTS: [&str; 6] = ["sky", "fog", "rain", "snow", "stars", "quadrature"];
/// Size of the frames that are timed.
pub const FRAME: (u32, u32) = (320, 180);

/// Frames over which the building of an air is spread in the cost of one: an air that lasts a minute at 60 Hz.
pub const FRAMES_AN_AIR: f64 = 3600.0;

/// Columns that every chart has, first.
pub const COLUMNS: [&str; 10] =
    ["name", "family", "default", "cost", "cost_low", "cost_high", "ms", "p95", "median", "worst"];

/// A device, what it is, and its baseline.
pub struct Lab {
    pub device: Arc<Device>,
    pub baseline: Baseline,
    pub rounds: usize,
}

impl Lab {
    /// Opens the device: a software driver where there is one, since its times are sound.
    pub fn open(options: &Options) -> Result<Self> {
        let software = DeviceOptions { force_software: true, ..Default::default() };
        let device = Device::headless(&software).or_else(|_| Device::headless(&DeviceOptions::default()))?;
        let baseline = Baseline::new(&device)?;
        Ok(Self { device, baseline, rounds: if options.quick { 3 } else { 15 } })
    }

    /// What a chart's file says of itself; a run continues only one that says the same.
    pub fn note(&self, what: &str, options: &Options) -> String {
        let caps = self.device.caps();
        let how = if options.quick { "quick" } else { "full" };
        let clean = |s: &str| s.replace(',', ";");
        let (name, driver) = (clean(&caps.adapter_name), clean(&caps.driver));
        format!("{what}; {how}; {name}; {driver}; {}; shaders {}", clean(&cpu()), shaders(what))
    }
}

/// A hash of the shaders that a chart's numbers come from (FNV-1a over the sources of their folders, in order of path), so that
/// a chart that is older than they are can be told.
pub fn shaders(what: &str) -> String {
    let folders: &[&str] = match what {
        "sky" | "quadrature" => &["common", "sky"],
        "fog" | "stability" => &["common", "fog", "frame", "sky"],
        "rain" => &["common", "fog", "frame", "rain", "sky"],
        "snow" => &["common", "fog", "frame", "sky", "snow"],
        "stars" => &["common", "frame", "sky", "stars"],
        _ => &["common", "fog", "frame", "ground", "rain", "sky"],
    };
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for folder in folders {
        let mut paths: Vec<_> =
            std::fs::read_dir(root.join(folder)).into_iter().flatten().flatten().map(|f| f.path()).collect();
        paths.sort();
        for byte in paths.iter().filter_map(|p| std::fs::read(p).ok()).flatten() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    format!("{:08x}", hash >> 32)
}

/// The processor's model.
fn cpu() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find(|l| l.starts_with("model name")).and_then(|l| l.split(':').nth(1));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{} x{cores}", model.unwrap_or("unknown processor").trim())
}

/// Today as year-month-day (Hinnant's civil_from_days, 2013).
pub fn today() -> String {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |d| d.as_secs());
    let z = (now / 86_400) as i64 + 719_468;
    let (era, doe) = (z.div_euclid(146_097), z.rem_euclid(146_097));
    let yoe = (doe - doe / 1460 + doe / 36_524 - doe / 146_096) / 365;
    let doy = doe - (365 * yoe + yoe / 4 - yoe / 100);
    let mp = (5 * doy + 2) / 153;
    let month = if mp < 10 { mp + 3 } else { mp - 9 };
    let year = yoe + era * 400 + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{:02}", doy - (153 * mp + 2) / 5 + 1)
}

/// Charts `what` and writes the page anew.
///
/// # Errors
/// Files and the GPU.
pub fn run(what: &str, options: &Options) -> Result<()> {
    let lab = Lab::open(options)?;
    println!("{}", lab.note(what, options));
    match what {
        "sky" => sky_chart(&lab, options)?,
        "fog" => fog_chart(&lab, options)?,
        "rain" => rain_chart(&lab, options)?,
        "snow" => snow_chart(&lab, options)?,
        "stars" => star_chart(&lab, options)?,
        _ => quadrature::chart(&lab, options)?,
    }
    page::write(&options.out)
}

/// The first columns of a row.
pub fn first_fields(name: &str, family: &str, default: bool, cost: &Ratio, error: &Difference) -> Vec<String> {
    let n = |v: f64| format!("{v:.6e}");
    vec![
        name.into(),
        family.into(),
        default.to_string(),
        n(cost.median),
        n(cost.low),
        n(cost.high),
        n(cost.ms),
        n(error.p95),
        n(error.median),
        n(error.worst),
    ]
}

/// All scenes as one: every picture exposed so that white is 1, and the mean perceptual difference.
fn over_scenes(pairs: &[(Picture, &Picture)]) -> Result<(Figures, Vec<f64>)> {
    let (mut a, mut b) = (Vec::new(), Vec::new());
    let (mut perceptual, mut each) = (0.0, Vec::new());
    for (drawn, truth) in pairs {
        let white = truth.white();
        let y = |p: &Picture| -> Vec<f64> { p.texels.iter().map(|t| welkin::light::luminance(t) / white).collect() };
        a.extend(y(drawn));
        b.extend(y(truth));
        let figures = drawn.figures(truth)?;
        perceptual += figures.perceptual / pairs.len() as f64;
        each.push(figures.luminance.p95);
    }
    Ok((Figures { luminance: difference(&a, &b, 1.0)?, perceptual }, each))
}

/// What a candidate is called up to its first number or size.
fn family(c: &Candidate) -> &'static str {
    let end = c.name.find('-').unwrap_or(c.name.len());
    match (c.effect, &c.name[..end]) {
        (Effect::Fog, "exact" | "even") => "closed form",
        (Effect::Fog, "froxels") => "froxels",
        (Effect::Fog, _) => "older laws",
        (Effect::Sky | Effect::Rain | Effect::Snow, known) => known,
        (Effect::Stars, _) => "night",
    }
}

fn sky_chart(lab: &Lab, options: &Options) -> Result<()> {
    let names: Vec<String> = scenes::SKY.iter().map(|s| format!("p95_{}", s.name)).collect();
    let more = [
        "moving_ms",
        "still",
        "still_low",
        "still_high",
        "still_ms",
        "rebuild_s",
        "shared_bytes",
        "view_bytes",
        "perceptual",
    ];
    let units = ["units", "units_still", "units_rebuild", "date"];
    let columns: Vec<&str> =
        COLUMNS.iter().chain(&more).copied().chain(names.iter().map(String::as_str)).chain(units).collect();
    let mut journal = Journal::open(&options.out, "sky", &lab.note("sky", options), &columns, options.fresh)?;
    let mut truths: Option<Vec<Vec<sky::TrueScene>>> = None;
    let all = candidates(Effect::Sky);
    for (i, c) in all.iter().enumerate() {
        if journal.has(c.name) {
            continue;
        }
        if truths.is_none() {
            let of = |air| sky::truth(&scenes_of(air), air, sky::SIZE, options.quick);
            truths = Some(scenes::SkyAir::ALL.into_iter().map(of).collect::<Result<_>>()?);
        }
        eprintln!("  {}/{} {} ..", i + 1, all.len(), c.name);
        let row = sky_row(lab, c, truths.as_deref().unwrap_or_default())?;
        journal.push(row)?;
    }
    let (table, old) = journal.finish()?;
    say_what_moved(&table, old.as_ref());
    let titles = Titles {
        title: "Sky: what a frame costs against how far it is from the truth",
        x: "cost of a frame over the baseline's: 320x180, sun moved, and 1/3600 of building the air",
        y: "95th percentile of the relative error in luminance",
        note: &format!(
            "{} scenes from an excavator's seat to orbit; line: nothing is both cheaper and better; ring: the default",
            scenes::SKY.len()
        ),
    };
    plot(&table, "cost", &titles, &options.out.join("sky"))?;
    let titles = Titles {
        x: "cost of a further frame with the same sun, 320x180, over the baseline's",
        title: "Sky: what a frame costs while sun and altitude stay",
        ..titles
    };
    plot(&table, "still", &titles, &options.out.join("sky-still"))?;
    calibrate(&table);
    Ok(())
}

/// The sky scenes of an air.
pub fn scenes_of(air: scenes::SkyAir) -> Vec<scenes::SkyScene> {
    scenes::SKY.into_iter().filter(|s| s.air == air).collect()
}

fn sky_row(lab: &Lab, c: &Candidate, truths: &[Vec<sky::TrueScene>]) -> Result<Vec<String>> {
    let mut drawn = sky::make(&lab.device, c)?;
    let mut pairs = Vec::new();
    let mut rebuilds = Vec::new();
    // The clear air last: frames are timed in it.
    for (air, truths) in scenes::SkyAir::ALL.into_iter().zip(truths).rev() {
        // An air that nobody has built, so that none is shared.
        let odd = air.planet().with_air_scaled(1.0 + 1e-5 * rebuilds.len() as f64 + 1e-6);
        let before = lab.baseline.run()?;
        let seconds = drawn.rebuild(&odd)?;
        rebuilds.push((seconds * 1e3, 0.5 * (before + lab.baseline.run()?)));
        drawn.rebuild(&air.planet())?;
        for (scene, truth) in scenes_of(air).iter().zip(truths) {
            let pixels = sky::pixels(scene, sky::SIZE);
            let veils = drawn.veils(scene, &pixels)?;
            pairs.push((scene.name, sky::compose(scene, &pixels, &veils, truth.ground, sky::SIZE), &truth.picture));
        }
    }
    let order = |name: &str| scenes::SKY.iter().position(|s| s.name == name);
    pairs.sort_by_key(|p| order(p.0));
    let pairs: Vec<(Picture, &Picture)> = pairs.into_iter().map(|(_, a, b)| (a, b)).collect();
    let (error, each) = over_scenes(&pairs)?;
    let frame = interleaved(&lab.baseline, lab.rounds, |i| drawn.frame(FRAME, i, true))?;
    let rebuild = Ratio::of(&rebuilds);
    let cost = frame.plus(&rebuild, 1.0 / FRAMES_AN_AIR);
    let still = interleaved(&lab.baseline, lab.rounds, |i| drawn.frame(FRAME, i, false))?;
    let mut row = first_fields(c.name, family(c), c.is_default(), &cost, &error.luminance);
    let pixels = u64::from(FRAME.0 * FRAME.1);
    let price = Price::default();
    let numbers = [frame.ms, still.median, still.low, still.high, still.ms, rebuild.ms * 1e-3];
    row.extend(numbers.map(|v| format!("{v:.6e}")));
    row.extend([c.work.shared_bytes.to_string(), c.work.view_bytes.to_string(), format!("{:.6e}", error.perceptual)]);
    row.extend(each.iter().map(|v| format!("{v:.6e}")));
    let units = [c.work.frame(pixels, true), c.work.frame(pixels, false), c.work.rebuild];
    row.extend(units.map(|u| format!("{:.4e}", u.at(&price))));
    row.push(today());
    Ok(row)
}

fn fog_chart(lab: &Lab, options: &Options) -> Result<()> {
    let list = scenes::fog();
    let names: Vec<String> = list.iter().map(|s| format!("p95_{}", s.name)).collect();
    let more = ["shared_bytes", "view_bytes", "perceptual"];
    let columns: Vec<&str> =
        COLUMNS.iter().chain(&more).copied().chain(names.iter().map(String::as_str)).chain(["units", "date"]).collect();
    let mut journal = Journal::open(&options.out, "fog", &lab.note("fog", options), &columns, options.fresh)?;
    let bench = fog::Bench::new(&lab.device)?;
    let all = candidates(Effect::Fog);
    for (i, c) in all.iter().enumerate() {
        if journal.has(c.name) {
            continue;
        }
        eprintln!("  {}/{} {} ..", i + 1, all.len(), c.name);
        let hosts = list.iter().map(|s| fog::host(s, fog::SIZE)).collect::<Result<Vec<_>>>()?;
        let truths = list.iter().zip(&hosts).map(|(s, h)| fog::truth(s, h)).collect::<Result<Vec<_>>>()?;
        let mut pairs = Vec::new();
        for ((scene, host), truth) in list.iter().zip(&hosts).zip(&truths) {
            pairs.push((bench.make(c, scene, host)?.picture()?, truth));
        }
        let (error, each) = over_scenes(&pairs)?;
        // Timed in plain fog, and where there are patches, in these: the dearest law.
        let frames = [1, 6].map(|s| (&list[s], fog::host(&list[s], (640, 360))));
        let mut made = Vec::new();
        for (scene, host) in frames {
            made.push(bench.make(c, scene, &host?)?);
        }
        let cost = interleaved(&lab.baseline, lab.rounds, |_| made.iter().map(fog::FogDraw::frame).sum())?;
        let mut row = first_fields(c.name, family(c), c.is_default(), &cost, &error.luminance);
        row.extend([
            c.work.shared_bytes.to_string(),
            c.work.view_bytes.to_string(),
            format!("{:.6e}", error.perceptual),
        ]);
        row.extend(each.iter().map(|v| format!("{v:.6e}")));
        row.push(format!("{:.4e}", c.work.frame(640 * 360, true).at(&Price::default())));
        row.push(today());
        journal.push(row)?;
    }
    let (table, old) = journal.finish()?;
    say_what_moved(&table, old.as_ref());
    let titles = Titles {
        title: "Fog: what a frame costs against how far it is from the truth",
        x: "cost of a frame in fog and one in patches of it, 640x360, over the baseline's",
        y: "95th percentile of the relative error in luminance",
        note: &format!(
            "{} scenes from dense fog to light haze; line: nothing is both cheaper and better; ring: the default",
            list.len()
        ),
    };
    plot(&table, "cost", &titles, &options.out.join("fog"))
}

fn rain_chart(lab: &Lab, options: &Options) -> Result<()> {
    let list = scenes::rain();
    let names: Vec<String> = list.iter().map(|s| format!("p95_{}", s.name)).collect();
    let columns: Vec<&str> =
        COLUMNS.iter().copied().chain(names.iter().map(String::as_str)).chain(["units", "date"]).collect();
    let mut journal = Journal::open(&options.out, "rain", &lab.note("rain", options), &columns, options.fresh)?;
    let all = candidates(Effect::Rain);
    if all.iter().all(|c| journal.has(c.name)) && journal.has("truth-again") {
        return rain_plots(journal, options, list.len());
    }

    let day: Vec<bool> = list.iter().map(|s| !s.lamps).collect();
    let mut hosts = list.iter().map(|s| rain::Host::new(&lab.device, s, rain::SIZE)).collect::<Result<Vec<_>>>()?;
    let mut truths = Vec::new();
    for (host, scene) in hosts.iter_mut().zip(&list) {
        eprintln!("  truth of {} ..", scene.name);
        truths.push(host.truth(1)?);
    }
    // Timed in steady rain and in a cloudburst.
    let mut timed =
        [1, 3].map(|i| rain::Host::new(&lab.device, &list[i], (640, 360))).into_iter().collect::<Result<Vec<_>>>()?;
    let mut cost = |settings: RainSettings| {
        timed.iter_mut().try_for_each(|h| h.set(settings))?;
        interleaved(&lab.baseline, lab.rounds, |_| timed.iter_mut().map(rain::Host::timed).sum())
    };
    for (i, c) in all.iter().enumerate() {
        if journal.has(c.name) {
            continue;
        }
        eprintln!("  {}/{} {} ..", i + 1, all.len(), c.name);
        let Method::Rain(method) = c.method else { continue };
        let mut blocks = Vec::new();
        for host in &mut hosts {
            blocks.push(host.drawn_by(&method)?);
        }
        let settings = match method {
            RainMethod::Offered(settings) => settings,
            // As many quads as it draws.
            RainMethod::Source(lod) => {
                RainSettings { model: RainModel::Drops, most_drops: Some(lod.drop_count()), ..RainSettings::default() }
            }
        };
        let units = format!("{:.4e}", c.work.frame(640 * 360, true).at(&Price::default()));
        journal.push(rain_row(c.name, c.is_default(), &cost(settings)?, (&blocks, &truths, &day), units)?)?;
    }
    if !journal.has("truth-again") {
        // How far all drops are from all drops elsewhere: less cannot be asked.
        let again = hosts.iter_mut().map(|h| Ok(h.truth(2)?.0)).collect::<Result<Vec<_>>>()?;
        journal.push(rain_row("truth-again", false, &Ratio::default(), (&again, &truths, &day), "0".into())?)?;
    }
    rain_plots(journal, options, list.len())
}

fn rain_row(
    name: &str,
    default: bool,
    cost: &Ratio,
    (drawn, truths, day): (&[rain::Blocks], &[(rain::Blocks, f64)], &[bool]),
    units: String,
) -> Result<Vec<String>> {
    let (mut all, mut each) = (Vec::new(), Vec::new());
    for ((blocks, (truth, white)), day) in drawn.iter().zip(truths).zip(day) {
        let mut errors = blocks.errors(truth, *white);
        errors.sort_by(f64::total_cmp);
        each.push(format!("{:.6e}", percentile(&errors, 0.95)));
        // Light at night is of another order; it has a column of its own.
        all.extend(errors.into_iter().filter(|_| *day));
    }
    all.sort_by(f64::total_cmp);
    let at = |share| percentile(&all, share);
    let error = Difference { median: at(0.5), p95: at(0.95), worst: at(1.0) };
    let end = name.find('-').unwrap_or(name.len());
    let mut row = first_fields(name, &name[..end], default, cost, &error);
    row.extend(each);
    row.extend([units, today()]);
    Ok(row)
}

fn rain_plots(journal: Journal, options: &Options, scenes: usize) -> Result<()> {
    let (mut table, old) = journal.finish()?;
    say_what_moved(&table, old.as_ref());
    let titles = Titles {
        title: "Rain: what a frame costs against how far it is from all drops drawn",
        x: "cost of fog and rain in steady rain and in a cloudburst, 640x360, over the baseline's",
        y: "95th percentile of the relative error of blocks: mean, and contrast of two sizes",
        note: &format!(
            "{} scenes by day, light rain to cloudburst; line: nothing is both cheaper and better",
            scenes - 1
        ),
    };
    table.rows.retain(|r| r[0] != "truth-again");
    plot(&table, "cost", &titles, &options.out.join("rain"))
}

fn snow_chart(lab: &Lab, options: &Options) -> Result<()> {
    let list = scenes::snow();
    let names: Vec<String> = list.iter().map(|s| format!("p95_{}", s.name)).collect();
    let columns: Vec<&str> =
        COLUMNS.iter().copied().chain(names.iter().map(String::as_str)).chain(["units", "date"]).collect();
    let mut journal = Journal::open(&options.out, "snow", &lab.note("snow", options), &columns, options.fresh)?;
    let all = candidates(Effect::Snow);
    if !(all.iter().all(|c| journal.has(c.name)) && journal.has("truth-again")) {
        let day = vec![true; list.len()];
        let mut hosts = list.iter().map(|s| rain::Host::new(&lab.device, s, rain::SIZE)).collect::<Result<Vec<_>>>()?;
        let mut truths = Vec::new();
        for (host, scene) in hosts.iter_mut().zip(&list) {
            eprintln!("  truth of {} ..", scene.name);
            truths.push(snow::truth(host, 1)?);
        }
        let mut timed = rain::Host::new(&lab.device, &list[0], (640, 360))?;
        for (i, c) in all.iter().enumerate() {
            let Method::Snow(settings) = c.method else { continue };
            if journal.has(c.name) {
                continue;
            }
            eprintln!("  {}/{} {} ..", i + 1, all.len(), c.name);
            let blocks = hosts.iter_mut().map(|h| snow::drawn_by(h, settings)).collect::<Result<Vec<_>>>()?;
            timed.set_snow(settings)?;
            let cost = interleaved(&lab.baseline, lab.rounds, |_| timed.timed())?;
            let units = format!("{:.4e}", c.work.frame(640 * 360, true).at(&Price::default()));
            journal.push(rain_row(c.name, c.is_default(), &cost, (&blocks, &truths, &day), units)?)?;
        }
        if !journal.has("truth-again") {
            // How far all flakes are from all flakes elsewhere: less cannot be asked.
            let again = hosts.iter_mut().map(|h| Ok(snow::truth(h, 2)?.0)).collect::<Result<Vec<_>>>()?;
            journal.push(rain_row("truth-again", false, &Ratio::default(), (&again, &truths, &day), "0".into())?)?;
        }
    }
    let (mut table, old) = journal.finish()?;
    say_what_moved(&table, old.as_ref());
    let titles = Titles {
        title: "Snow: what a frame costs against how far it is from all flakes drawn",
        x: "cost of fog and snow with large flakes in hardly any wind, 640x360, over the baseline's",
        y: "95th percentile of the relative error of blocks: mean, and contrast of two sizes",
        note: "4 scenes by day, large flakes to storm; line: nothing is both cheaper and better; ring: the default",
    };
    table.rows.retain(|r| r[0] != "truth-again");
    plot(&table, "cost", &titles, &options.out.join("snow"))
}

fn star_chart(lab: &Lab, options: &Options) -> Result<()> {
    let names: Vec<String> = scenes::STARS.iter().map(|s| format!("p95_{}", s.name)).collect();
    let columns: Vec<&str> = COLUMNS
        .iter()
        .copied()
        .chain(["flux"])
        .chain(names.iter().map(String::as_str))
        .chain(["units", "date"])
        .collect();
    let mut journal = Journal::open(&options.out, "stars", &lab.note("stars", options), &columns, options.fresh)?;
    let all = candidates(Effect::Stars);
    for (i, c) in all.iter().enumerate() {
        let Method::Stars(method) = c.method else { continue };
        if journal.has(c.name) {
            continue;
        }
        eprintln!("  {}/{} {} ..", i + 1, all.len(), c.name);
        let (mut pictures, mut flux) = (Vec::new(), 0.0f64);
        for scene in &scenes::STARS {
            let mut host = stars::Host::new(&lab.device, scene, stars::SIZE)?;
            let ((truth, even), drawn) = (host.truth()?, host.picture(method)?);
            flux = flux.max(stars::flux_error(&drawn, &truth, &even));
            pictures.push([drawn, truth].map(|p| stars::blocks(&p)));
        }
        let pairs: Vec<(Picture, &Picture)> = pictures.iter().map(|[drawn, truth]| (drawn.clone(), truth)).collect();
        let (mut luminances, mut each) = ([Vec::new(), Vec::new()], Vec::new());
        for (drawn, truth) in &pairs {
            let white = truth.white();
            let y = |p: &Picture| -> Vec<f64> {
                p.texels.iter().map(welkin::light::luminance).map(|y| y / white).collect()
            };
            let [a, b] = [y(drawn), y(truth)];
            each.push(difference(&a, &b, 1.0)?.p95);
            luminances[0].extend(a);
            luminances[1].extend(b);
        }
        let error = difference(&luminances[0], &luminances[1], 1.0)?;
        let mut timed = stars::Host::new(&lab.device, &scenes::STARS[0], (640, 360))?;
        let cost = interleaved(&lab.baseline, lab.rounds, |i| timed.timed(method, i == 0))?;
        let mut row = first_fields(c.name, family(c), c.is_default(), &cost, &error);
        row.push(format!("{flux:.6e}"));
        row.extend(each.iter().map(|v| format!("{v:.6e}")));
        row.push(format!("{:.4e}", c.work.frame(640 * 360, true).at(&Price::default())));
        row.push(today());
        journal.push(row)?;
    }
    let (table, old) = journal.finish()?;
    say_what_moved(&table, old.as_ref());
    let titles = Titles {
        title: "Stars: what a frame costs against how far its light is from the truth",
        x: "cost of a picture of nothing but a clear night sky, 640x360, over the baseline's",
        y: "95th percentile of the relative error of blocks' mean luminance",
        note: "moonless, moonlit, dusk; line: nothing is both cheaper and better; ring: the default",
    };
    plot(&table, "cost", &titles, &options.out.join("stars"))
}

/// The points of a table: cost by the column `cost` with its quarters.
pub fn points(table: &Table, cost: &str) -> Vec<Point> {
    let number = |r: &[String], c: &str| table.number(r, c).unwrap_or(f64::NAN);
    let mut out: Vec<Point> = table
        .rows
        .iter()
        .map(|r| Point {
            name: r[0].clone(),
            cost: number(r, cost),
            spread: (number(r, &format!("{cost}_low")), number(r, &format!("{cost}_high"))),
            error: number(r, "p95"),
            family: r[1].clone(),
            front: false,
            default: r[2] == "true",
        })
        .collect();
    let bare: Vec<[f64; 2]> = out.iter().map(|p| [p.cost, p.error]).collect();
    pareto(&bare).into_iter().for_each(|i| out[i].front = true);
    out
}

/// Draws a table's chart.
pub fn plot(table: &Table, cost: &str, titles: &Titles<'_>, stem: &std::path::Path) -> Result<()> {
    scatter(&points(table, cost), titles).save(stem)
}

/// Lines about the candidates whose cost left its spread or whose error is another.
pub fn moved(new: &Table, old: &Table) -> Vec<String> {
    let mut out = Vec::new();
    for row in &new.rows {
        let Some(before) = old.row(&row[0]) else {
            out.push(format!("{}: new", row[0]));
            continue;
        };
        let n = |t: &Table, r: &[String], c: &str| t.number(r, c).unwrap_or(f64::NAN);
        let ratio = |t: &Table, r: &[String]| Ratio {
            median: n(t, r, "cost"),
            low: n(t, r, "cost_low"),
            high: n(t, r, "cost_high"),
            ms: n(t, r, "ms"),
        };
        let (a, b) = (ratio(old, before), ratio(new, row));
        if a.moved(&b) {
            out.push(format!("{}: cost {} -> {}, beyond its spread", row[0], short(a.median), short(b.median)));
        }
        let (a, b) = (n(old, before, "p95"), n(new, row, "p95"));
        if (a - b).abs() > 0.01 * a.max(b) {
            out.push(format!("{}: error {} -> {}", row[0], short(a), short(b)));
        }
    }
    out
}

/// Prints what [`moved`] finds.
pub fn say_what_moved(new: &Table, old: Option<&Table>) {
    let Some(old) = old else { return println!("  first run: nothing to compare with") };
    if old.note != new.note {
        println!("  the run before was another kind: {}", old.note);
    }
    let lines = moved(new, old);
    if lines.is_empty() {
        println!("  no point moved beyond its spread");
    }
    lines.iter().for_each(|l| println!("  moved: {l}"));
}

/// How well the work units foretell the times: the factor between both, candidate by candidate.
fn calibrate(table: &Table) {
    let find = |name: &str| candidates(Effect::Sky).into_iter().find(|c| c.name == name);
    let pixels = u64::from(FRAME.0 * FRAME.1);
    let mut data = Vec::new();
    for r in &table.rows {
        let Some(c) = find(&r[0]) else { continue };
        // Ratios to the baseline, which a busy machine moves less than times.
        let moving = c.work.frame(pixels, true).plus(c.work.rebuild, 1.0 / FRAMES_AN_AIR);
        for (column, work) in [("cost", moving), ("still", c.work.frame(pixels, false))] {
            if let Some(v) = table.number(r, column) {
                data.push((format!("{} {column}", r[0]), v, work));
            }
        }
    }
    let fit = |price: &Price| {
        let logs: Vec<f64> = data.iter().map(|d| (d.1 / d.2.at(price)).ln()).collect();
        let mean = logs.iter().sum::<f64>() / logs.len().max(1) as f64;
        (logs.iter().map(|l| (l - mean).powi(2)).sum::<f64>() / logs.len().max(1) as f64, mean)
    };
    let grid = |lo: f64, n: i32| (0..n).map(move |i| lo * 1.3f64.powi(i));
    let prices = grid(0.02, 24).flat_map(|texel| grid(0.002, 24).map(move |byte| Price { texel, byte }));
    let best = prices.min_by(|a, b| fit(a).0.total_cmp(&fit(b).0)).unwrap_or_default();
    let (variance, mean) = fit(&best);
    println!(
        "  work units: a look-up {} samples, a byte {}; {} baselines a million samples; costs follow within a factor {} (1 sigma)",
        short(best.texel),
        short(best.byte),
        short(mean.exp() * 1e6),
        short(variance.sqrt().exp())
    );
    for d in &data {
        let factor = d.1 / (d.2.at(&best) * mean.exp());
        if !(0.5..2.0).contains(&factor) {
            println!("    {}: {} of what its units say", d.0, short(factor));
        }
    }
}
