//! `lab stability`: maps of where methods fail, with Welkin's methods beside common ones that fail.

pub mod cloud_maps;
pub mod numbers;
pub mod particles;
pub mod sky_maps;

use std::fmt::Write as _;
use std::path::Path;

use welkin::{Error, Result};

use crate::canvas::{Anchor, Canvas, INK, Rgb};
use crate::chart::{Lab, today};
use crate::command::Options;
use crate::page;
use crate::plot::short;
use crate::store::{Journal, Table};

/// Result at one point of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell {
    /// An error, 0 or above.
    Error(f64),
    /// The value grew without bound.
    Diverged,
    /// NaN or infinity, or a negative value where that is impossible.
    NotFinite,
    /// The value jumped or oscillated where it must change smoothly.
    Jumps,
    /// The library refuses these numbers.
    Refused,
    /// The right one of two answers; there is no error to measure.
    Right,
    /// The wrong one of two answers.
    Wrong,
    /// There is nothing to measure here.
    Nothing,
}

impl Cell {
    /// An error, or `NotFinite`.
    pub fn of(error: f64) -> Self {
        if error.is_finite() { Self::Error(error.abs()) } else { Self::NotFinite }
    }

    fn kind(self) -> &'static str {
        match self {
            Self::Error(_) => "error",
            Self::Diverged => "diverged",
            Self::NotFinite => "not finite",
            Self::Jumps => "jumps",
            Self::Refused => "refused",
            Self::Right => "right",
            Self::Wrong => "wrong",
            Self::Nothing => "nothing there",
        }
    }

    fn color(self) -> Rgb {
        match self {
            Self::Error(e) => heat(e),
            Self::Diverged => (196, 28, 28),
            Self::NotFinite => (214, 30, 190),
            Self::Jumps => (240, 140, 20),
            Self::Refused => (178, 182, 188),
            Self::Right => (206, 226, 206),
            Self::Wrong => (120, 60, 20),
            Self::Nothing => (255, 255, 255),
        }
    }
}

/// Colour of errors from 1e-7 (dark blue) to 1 (yellow), on a logarithmic scale.
fn heat(error: f64) -> Rgb {
    const STOPS: [Rgb; 8] = [
        (48, 18, 90),
        (62, 60, 140),
        (48, 104, 142),
        (36, 142, 140),
        (54, 184, 120),
        (146, 214, 70),
        (226, 228, 60),
        (255, 250, 190),
    ];
    let t = (error.max(1e-7).log10() + 7.0).clamp(0.0, 7.0);
    let i = (t.floor() as usize).min(6);
    let f = t - i as f64;
    let mix = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * f) as u8;
    let (a, b) = (STOPS[i], STOPS[i + 1]);
    (mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

/// The points along one side of a map.
pub struct Axis {
    pub label: &'static str,
    pub values: Vec<f64>,
}

impl Axis {
    /// `n` values from `lo` to `hi` with equal ratios.
    pub fn ratios(label: &'static str, lo: f64, hi: f64, n: usize) -> Self {
        let value = |i: usize| lo * (hi / lo).powf(i as f64 / (n - 1) as f64);
        Self { label, values: (0..n).map(value).collect() }
    }

    /// `n` values from `lo` to `hi` with equal steps.
    pub fn steps(label: &'static str, lo: f64, hi: f64, n: usize) -> Self {
        Self { label, values: (0..n).map(|i| lo + (hi - lo) * i as f64 / (n - 1) as f64).collect() }
    }

    /// Values as given.
    pub fn list(label: &'static str, values: &[f64]) -> Self {
        Self { label, values: values.to_vec() }
    }
}

/// One method at all points, row by row of y.
pub struct Panel {
    pub title: String,
    pub cells: Vec<Cell>,
    /// Whether the method is Welkin's; then the region of accepted numbers is outlined.
    pub ours: bool,
}

impl Panel {
    /// Evaluates a method at all points.
    pub fn of(title: &str, ours: bool, x: &Axis, y: &Axis, mut f: impl FnMut(f64, f64) -> Cell) -> Self {
        let mut cells = Vec::new();
        y.values.iter().for_each(|y| x.values.iter().for_each(|x| cells.push(f(*x, *y))));
        Self { title: title.to_owned(), cells, ours }
    }
}

/// A map: methods side by side over the same two quantities.
pub struct Map {
    pub title: &'static str,
    pub x: Axis,
    pub y: Axis,
    pub panels: Vec<Panel>,
    /// Larger errors are reported as a border if the library accepts the numbers.
    pub tolerance: f64,
}

type Make = fn(&Lab, &Options) -> Result<Map>;

/// All maps by name.
const MAPS: [(&str, Make); 19] = [
    ("quadrature", sky_maps::quadrature),
    ("horizon-distance", |_, _| Ok(numbers::horizon_distance())),
    ("horizon", sky_maps::horizon),
    ("twilight", sky_maps::twilight),
    ("media", sky_maps::media),
    ("half-floats", sky_maps::half_floats),
    ("phase", |_, _| Ok(numbers::phase())),
    ("depth", |_, _| numbers::depth()),
    ("origin", |_, _| numbers::origin()),
    ("fog-distance", numbers::fog_distance),
    ("drag", |_, _| Ok(particles::drag())),
    ("gust", |_, _| particles::gust()),
    ("over-relaxation", |_, _| Ok(particles::over_relaxation())),
    ("whirls", |_, _| Ok(particles::whirls())),
    ("time-steps", |_, _| particles::time_steps()),
    ("cloud-steps", cloud_maps::steps),
    ("cloud-layers", cloud_maps::layers),
    ("cloud-bases", cloud_maps::bases),
    ("cloud-cover", cloud_maps::cover),
];

const COLUMNS: [&str; 12] =
    ["key", "map", "panel", "ours", "cells", "refused", "not_finite", "diverged", "jumps", "median", "worst", "date"];

/// Draws the named maps, or all if none is named.
///
/// # Errors
/// An unknown name, before anything is written; files; the GPU.
pub fn run(names: &[&str], options: &Options) -> Result<()> {
    let known = || MAPS.map(|(n, _)| n).join(", ");
    if let Some(bad) = names.iter().find(|n| !MAPS.iter().any(|(m, _)| m == *n)) {
        return Err(Error::range("map", &format!("one of {}", known()), bad));
    }
    let lab = Lab::open(options)?;
    let mut journal =
        Journal::open(&options.out, "stability", &lab.note("stability", options), &COLUMNS, options.fresh)?;
    // A run of some maps keeps the results of the others.
    let old = Table::read(&options.out.join("stability.csv"))?;
    for (name, make) in MAPS {
        if journal.has(&format!("{name}/0")) {
            continue;
        }
        if !names.is_empty() && !names.contains(&name) {
            let rows = old.iter().flat_map(|t| t.rows.iter()).filter(|r| r[1] == name);
            rows.cloned().collect::<Vec<_>>().into_iter().try_for_each(|r| journal.push(r))?;
            continue;
        }
        eprintln!("  {name} ..");
        let map = make(&lab, options)?;
        draw(&map).save(&options.out.join(format!("stability-{name}")))?;
        write_cells(&map, &options.out.join(format!("stability-{name}.csv")))?;
        borders(name, &map).iter().for_each(|l| println!("  {l}"));
        for (i, panel) in map.panels.iter().enumerate() {
            journal.push(summary(name, i, panel))?;
        }
    }
    journal.finish()?;
    page::write(&options.out)
}

/// A panel's row in the table.
pub fn summary(name: &str, index: usize, panel: &Panel) -> Vec<String> {
    let count = |kind: &str| panel.cells.iter().filter(|c| c.kind() == kind).count().to_string();
    let mut errors: Vec<f64> =
        panel.cells.iter().filter_map(|c| if let Cell::Error(e) = c { Some(*e) } else { None }).collect();
    errors.sort_by(f64::total_cmp);
    let at = |share| format!("{:.3e}", welkin::plan::difference::percentile(&errors, share));
    vec![
        format!("{name}/{index}"),
        name.to_owned(),
        panel.title.replace(',', ";"),
        panel.ours.to_string(),
        panel.cells.len().to_string(),
        count("refused"),
        count("not finite"),
        count("diverged"),
        count("jumps"),
        at(0.5),
        at(1.0),
        today(),
    ]
}

/// Lines about points that the library accepts although its result is wrong.
pub fn borders(name: &str, map: &Map) -> Vec<String> {
    let mut out = Vec::new();
    for panel in map.panels.iter().filter(|p| p.ours) {
        let wrong = |c: &Cell| match c {
            Cell::Error(e) => *e > map.tolerance,
            Cell::Right | Cell::Nothing | Cell::Refused => false,
            _ => true,
        };
        let bad: Vec<usize> = (0..panel.cells.len()).filter(|i| wrong(&panel.cells[*i])).collect();
        if bad.is_empty() {
            continue;
        }
        let n = map.x.values.len();
        let range = |values: Vec<f64>| {
            let lo = values.iter().copied().fold(f64::INFINITY, f64::min);
            let hi = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            format!("{} to {}", short(lo), short(hi))
        };
        let x = range(bad.iter().map(|i| map.x.values[i % n]).collect());
        let y = range(bad.iter().map(|i| map.y.values[i / n]).collect());
        out.push(format!(
            "{name}: border: {}: {} of {} places accepted but beyond {}: {} in {x}, {} in {y}",
            panel.title,
            bad.len(),
            panel.cells.len(),
            short(map.tolerance),
            map.x.label,
            map.y.label
        ));
    }
    out
}

fn write_cells(map: &Map, path: &Path) -> Result<()> {
    let mut out = format!("# {}\npanel,x,y,kind,error\n", map.title);
    for panel in &map.panels {
        for (i, cell) in panel.cells.iter().enumerate() {
            let (x, y) = (map.x.values[i % map.x.values.len()], map.y.values[i / map.x.values.len()]);
            let error = if let Cell::Error(e) = cell { format!("{e:.3e}") } else { String::new() };
            let _ = writeln!(out, "{},{x:.6e},{y:.6e},{},{error}", panel.title.replace(',', ";"), cell.kind());
        }
    }
    welkin_command_line::write_whole(path, out.as_bytes())
}

const SIDE: f64 = 330.0;
const GAP: f64 = 84.0;
const TOP: f64 = 92.0;

fn draw(map: &Map) -> Canvas {
    let n = map.panels.len() as f64;
    let (width, height) = (n * (SIDE + GAP) + 30.0, TOP + SIDE + 130.0);
    let mut canvas = Canvas::new(width.max(900.0) as u32, height as u32);
    canvas.text(map.title, (20.0, 22.0), 19.0, INK, Anchor::Left);
    for (i, panel) in map.panels.iter().enumerate() {
        let left = GAP + i as f64 * (SIDE + GAP);
        panel_into(&mut canvas, map, panel, left);
    }
    let y = TOP + SIDE + 82.0;
    for i in 0..70 {
        let x = GAP + 4.0 * f64::from(i);
        canvas.fill([x, y, x + 4.0, y + 12.0], heat(10f64.powf(-7.0 + 0.1 * f64::from(i))));
    }
    for e in [-7, -5, -3, -1] {
        canvas.text(&format!("1e{e}"), (GAP + 40.0 * f64::from(e + 7), y + 24.0), 12.0, INK, Anchor::Center);
    }
    canvas.text("error", (GAP - 8.0, y + 6.0), 12.0, INK, Anchor::Right);
    let mut x = GAP + 320.0;
    let kinds = [Cell::Diverged, Cell::NotFinite, Cell::Jumps, Cell::Refused, Cell::Right, Cell::Wrong, Cell::Nothing];
    for cell in kinds.into_iter().filter(|k| map.panels.iter().any(|p| p.cells.contains(k))) {
        canvas.fill([x, y, x + 16.0, y + 12.0], cell.color());
        canvas.text(cell.kind(), (x + 22.0, y + 6.0), 12.0, INK, Anchor::Left);
        x += 50.0 + Canvas::width_of(cell.kind(), 12.0);
    }
    canvas.frame([x, y, x + 16.0, y + 12.0], (0, 0, 0));
    canvas.text("accepted", (x + 22.0, y + 6.0), 12.0, INK, Anchor::Left);
    canvas
}

fn panel_into(canvas: &mut Canvas, map: &Map, panel: &Panel, left: f64) {
    let (nx, ny) = (map.x.values.len(), map.y.values.len());
    let at = |i: usize, j: usize| (left + SIDE * i as f64 / nx as f64, TOP + SIDE * (1.0 - j as f64 / ny as f64));
    for (k, cell) in panel.cells.iter().enumerate() {
        let ((x0, y1), (x1, y0)) = (at(k % nx, k / nx), at(k % nx + 1, k / nx + 1));
        canvas.fill([x0, y0, x1, y1], cell.color());
    }
    canvas.text(&panel.title, (left, TOP - 16.0), 14.0, INK, Anchor::Left);
    let every = |n: usize| n.div_ceil(6);
    for i in (0..nx).step_by(every(nx)) {
        let x = 0.5 * (at(i, 0).0 + at(i + 1, 0).0);
        canvas.text(&short(map.x.values[i]), (x, TOP + SIDE + 14.0), 12.0, INK, Anchor::Center);
    }
    for j in (0..ny).step_by(every(ny)) {
        let y = 0.5 * (at(0, j).1 + at(0, j + 1).1);
        canvas.text(&short(map.y.values[j]), (left - 6.0, y), 12.0, INK, Anchor::Right);
    }
    canvas.text(map.x.label, (left + 0.5 * SIDE, TOP + SIDE + 38.0), 13.0, INK, Anchor::Center);
    canvas.upright(map.y.label, (left - 58.0, TOP + 0.5 * SIDE), 13.0, INK);
    if panel.ours {
        outline(canvas, panel, nx, ny, &at);
    }
}

/// Draws lines between accepted and refused points, and along the map's edge.
fn outline(canvas: &mut Canvas, panel: &Panel, nx: usize, ny: usize, at: &dyn Fn(usize, usize) -> (f64, f64)) {
    let accepted = |i: i64, j: i64| {
        let inside = i >= 0 && j >= 0 && i < nx as i64 && j < ny as i64;
        inside && panel.cells[j as usize * nx + i as usize] != Cell::Refused
    };
    for j in 0..=ny {
        for i in 0..=nx {
            let (a, b) = (i as i64, j as i64);
            if i < nx && accepted(a, b) != accepted(a, b - 1) {
                canvas.line(&[at(i, j), at(i + 1, j)], (0, 0, 0), 2);
            }
            if j < ny && accepted(a, b) != accepted(a - 1, b) {
                canvas.line(&[at(i, j), at(i, j + 1)], (0, 0, 0), 2);
            }
        }
    }
}

/// Description of each map for the page, by name.
const SAYS: [(&str, &str); 19] = [
    (
        "quadrature",
        "The rule with an offset of 0.3 leaves out the last step: it errs by some per cent everywhere and by tens of per cent near the horizon. The closed form does not.",
    ),
    (
        "horizon-distance",
        "r^2 - R^2 in f32 has no digits left near the ground: at eye level the horizon is 4 % off, lower it is lost. sqrt(h (2R + h)) never subtracts.",
    ),
    (
        "horizon",
        "Radiance within two degrees of the horizon, from below the ground's level to 10 000 km, sun at 60 degrees, against the reference; and whether f32 roots of r^2 (mu^2 - 1) + R^2 know on which side of the horizon a ray is.",
    ),
    (
        "twilight",
        "Sun from 80 to 110 degrees from the zenith by half degrees. Jumps: the zenith would brighten while the sun sinks.",
    ),
    (
        "media",
        "Air from none to ten thousand times the Earth's, and scale heights from 0 to 1000 km. The usual step (S - S T)/sigma gives 0/0 where the density underflows, and its series 1/(1 - f) diverges. Welkin stays finite and never negative. Errors grow with optical depth. Beyond a depth of about ten the reference, cut at 40 orders, is no truth either, so the map shows only finiteness there.",
    ),
    (
        "half-floats",
        "Error of storing radiance: plain fp16, the square root in fp16 as in Welkin's tables, and fp32, which no table needs.",
    ),
    ("phase", "The forward peak in f32. The usual denominator 1 + g^2 - 2 g cos subtracts equal numbers."),
    (
        "depth",
        "The step of a 32-bit depth buffer over distance. Standard depth cannot tell 10 km from 10.06 km with the near plane at 0.1 m.",
    ),
    (
        "origin",
        "Misplacement of a point over its distance when the world's origin is far away: world coordinates in f32 against Welkin's camera-relative ones.",
    ),
    (
        "fog-distance",
        "Contrast left at a distance: the older squared law that has the same visibility, and the drawn layer against 0.05^(d/V).",
    ),
    (
        "drag",
        "A gust of 20 m/s meets drops of 0.1 to 6 mm. Explicit Euler makes drops faster than the wind that blows them (jumps), then explodes: below 0.38 mm at 1/60 s, below 1 mm at 0.1 s, every drop at 1 s. Welkin solves both of its steps exactly, so they stay finite at any length. The first is the law of linear drag itself. The second steps the integrated drops; its error comes from a drag rate that is constant during each step and limited to between a quarter and 8 times the rate at rest.",
    ),
    (
        "gust",
        "A gust throws anything that is placed at velocity times time, and the later the gust, the farther: at 1e6 s by kilometres. The displacement moves it as far as the wind blows.",
    ),
    (
        "over-relaxation",
        "Residual of a pressure solve after 400 sweeps: it diverges at a factor of 2 and above. The wind's solver refuses those.",
    ),
    (
        "whirls",
        "Kinetic energy that Taylor and Green's whirls lose, which would turn for ever: by the scheme of older snow simulators, by MacCormack's, and by the one that the wind field steps with. The splitting of a step loses most of it, so that a finer grid alone helps little.",
    ),
    (
        "time-steps",
        "A change of weather in steps of dt, against one step. Relaxing towards the new weather depends on the step; Welkin's timeline is a function of time.",
    ),
    (
        "cloud-steps",
        "Banding of a march through broken cumulus, by how high one looks, in the mean of rays. Even steps: the share of light that gets through, against 4096 of them. Welkin's pictures: luminance, against the finest march that a view can be set to; steps are the most that a ray takes through a layer, 192 by default. The panels show two quantities: along a ray light changes more than what gets through.",
    ),
    (
        "cloud-layers",
        "Layers of 1 m to 20 km, half covered, seen level from below their base to above their top: pictures at the default against the finest march. All are finite.",
    ),
    (
        "cloud-bases",
        "A camera climbs through the base of a closed layer: each frame against the same one drawn by itself, without earlier ones. 0 is the first frame in the cloud.",
    ),
    (
        "cloud-cover",
        "Cover that is seen less cover that was asked for, by kind; no cloud and a closed layer are exact. The threshold of even noise, which takes what lies above it for the cover of the sky, misses the sides of clouds.",
    ),
];

/// Writes the maps' part of the page.
///
/// # Errors
/// Files.
pub fn section(out: &mut String, directory: &Path) -> Result<()> {
    let Some(table) = Table::read(&directory.join("stability.csv"))? else { return Ok(()) };
    out.push_str("## Where methods fail\n\nEach map shows the usual method beside Welkin's, over the numbers along which they break; the outline is what the library accepts.\n\n");
    for (name, says) in SAYS {
        let rows: Vec<_> = table.rows.iter().filter(|r| r[1] == name).collect();
        if rows.is_empty() {
            continue;
        }
        let _ = write!(out, "### {name}\n\n{says}\n\n![{name}](stability-{name}.svg)\n\n");
        out.push_str("| method | places | refused | not finite | diverged | jumps | median error | worst |\n|---|---|---|---|---|---|---|---|\n");
        for r in rows {
            let _ = writeln!(
                out,
                "| {} | {} | {} | {} | {} | {} | {} | {} |",
                r[2], r[4], r[5], r[6], r[7], r[8], r[9], r[10]
            );
        }
        out.push('\n');
    }
    Ok(())
}
