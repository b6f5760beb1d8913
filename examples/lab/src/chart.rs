//! `lab chart`: the cost of each candidate and its error relative to the truth.

use std::sync::Arc;

use welkin::Result;
use welkin::gpu::{Device, DeviceOptions};
use welkin::plan::Difference;

use crate::command::Options;
use crate::front::pareto;
use crate::plot::{Point, Titles, scatter, short};
use crate::store::Table;
use crate::timing::{Baseline, Ratio};
use crate::{effect_charts, page, painted_chart, quadrature};

/// Names of all charts.
pub const CHARTS: [&str; 8] = ["sky", "fog", "rain", "snow", "stars", "clouds", "painted-clouds", "quadrature"];
/// Size of the timed frames.
pub const FRAME: (u32, u32) = (320, 180);

/// Frames over which the cost of building an air is spread: an air that lasts one minute at 60 Hz.
pub const FRAMES_AN_AIR: f64 = 3600.0;

/// The first columns of every chart.
pub const COLUMNS: [&str; 10] =
    ["name", "family", "default", "cost", "cost_low", "cost_high", "ms", "p95", "median", "worst"];

/// A device, its description, and its baseline.
pub struct Lab {
    pub device: Arc<Device>,
    pub baseline: Baseline,
    pub rounds: usize,
}

impl Lab {
    /// Opens the device: a software driver if there is one, because its times are reliable.
    pub fn open(options: &Options) -> Result<Self> {
        let software = DeviceOptions { force_software: true, ..Default::default() };
        let device = Device::headless(&software).or_else(|_| Device::headless(&DeviceOptions::default()))?;
        let baseline = Baseline::new(&device)?;
        Ok(Self { device, baseline, rounds: if options.quick { 3 } else { 15 } })
    }

    /// The note in a chart's file. A run continues a file only if the notes are equal.
    pub fn note(&self, what: &str, options: &Options) -> String {
        let caps = self.device.caps();
        let how = if options.quick { "quick" } else { "full" };
        let clean = |s: &str| s.replace(',', ";");
        let (name, driver) = (clean(&caps.adapter_name), clean(&caps.driver));
        format!("{what}; {how}; {name}; {driver}; {}; shaders {}", clean(&cpu()), shaders(what))
    }
}

/// A hash of the shaders that produce a chart's numbers (FNV-1a over the sources in their folders, in order of path).
/// It reveals a chart that is older than its shaders.
pub fn shaders(what: &str) -> String {
    let folders: &[&str] = match what {
        "sky" | "quadrature" => &["common", "sky"],
        "fog" | "stability" => &["common", "fog", "frame", "sky"],
        "rain" => &["common", "fog", "frame", "rain", "sky"],
        "snow" => &["common", "fog", "frame", "sky", "snow"],
        "stars" => &["common", "frame", "sky", "stars"],
        "clouds" | "painted-clouds" => &["between", "clouds", "common", "frame", "sky"],
        _ => &["common", "fog", "frame", "ground", "rain", "sky"],
    };
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders");
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for folder in folders {
        let mut paths: Vec<_> =
            std::fs::read_dir(root.join(folder)).into_iter().flatten().flatten().map(|f| f.path()).collect();
        paths.sort();
        for text in paths.iter().filter_map(|path| std::fs::read_to_string(path).ok()) {
            for byte in text.lines().flat_map(|line| code(line).bytes()) {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
    format!("{:08x}", hash >> 32)
}

/// A line of a shader without its comment, because a changed comment does not make a chart outdated.
fn code(line: &str) -> &str {
    if line.starts_with("//!include") { line } else { line.split("//").next().unwrap_or_default().trim_end() }
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

/// Runs the chart `what` and writes the page again.
///
/// # Errors
/// Files and the GPU.
pub fn run(what: &str, options: &Options) -> Result<()> {
    let lab = Lab::open(options)?;
    println!("{}", lab.note(what, options));
    match what {
        "sky" => effect_charts::sky(&lab, options)?,
        "fog" => effect_charts::fog(&lab, options)?,
        "rain" => effect_charts::rain(&lab, options)?,
        "snow" => effect_charts::snow(&lab, options)?,
        "stars" => effect_charts::stars(&lab, options)?,
        "clouds" => effect_charts::clouds(&lab, options)?,
        "painted-clouds" => painted_chart::run(&lab, options)?,
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

/// The points of a table, with the cost from the column `cost` and its quartiles.
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

/// Lines about the candidates whose cost changed by more than its spread, or whose error changed.
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
