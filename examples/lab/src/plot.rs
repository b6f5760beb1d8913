//! Scatter plots on logarithmic axes: the chart of cost against error, and lines of growth.

use super::canvas::{Anchor, Canvas, FAINT, GRID, INK, Rgb};

/// A logarithmic axis.
#[derive(Clone, Copy, Debug)]
pub struct LogAxis {
    /// Value and pixel of both ends.
    ends: [(f64, f64); 2],
}

impl LogAxis {
    /// An axis from pixel `a` to pixel `b` that covers `values` with a margin; values that are not above 0 are left
    /// out.
    pub fn over(values: impl Iterator<Item = f64>, a: f64, b: f64) -> Self {
        let (mut lo, mut hi) = (f64::INFINITY, 0.0f64);
        for v in values.filter(|v| *v > 0.0 && v.is_finite()) {
            (lo, hi) = (lo.min(v), hi.max(v));
        }
        if lo > hi {
            (lo, hi) = (0.1, 10.0);
        }
        Self { ends: [(lo / 1.6, a), (hi * 1.6, b)] }
    }

    /// Pixel of a value; values beyond an end are put on it.
    pub fn at(&self, value: f64) -> f64 {
        let [(lo, a), (hi, b)] = self.ends;
        let t = ((value.max(lo) / lo).ln() / (hi / lo).ln()).clamp(0.0, 1.0);
        a + (b - a) * t
    }

    /// Powers of ten and the ticks between them, and whether each has a number.
    pub fn ticks(&self) -> Vec<(f64, bool)> {
        let [(lo, _), (hi, _)] = self.ends;
        let decades = hi.log10().floor() as i32 - lo.log10().floor() as i32;
        let labelled: &[i32] = if decades > 4 {
            &[1]
        } else if decades > 2 {
            &[1, 3]
        } else {
            &[1, 2, 5]
        };
        let mut out = Vec::new();
        for e in lo.log10().floor() as i32..=hi.log10().ceil() as i32 {
            for m in 1..10 {
                let v = f64::from(m) * 10f64.powi(e);
                if v >= lo && v <= hi {
                    out.push((v, labelled.contains(&m)));
                }
            }
        }
        out
    }
}

/// A number in its shortest readable form.
pub fn short(v: f64) -> String {
    let a = v.abs();
    if a == 0.0 {
        "0".into()
    } else if !(1e-3..1e5).contains(&a) {
        format!("{v:.0e}")
    } else if a >= 100.0 {
        format!("{v:.0}")
    } else {
        let digits = (1 - a.log10().floor() as i32).max(0) as usize;
        let text = format!("{v:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    }
}

/// Margins of the plot in the figure.
const LEFT: f64 = 78.0;
const TOP: f64 = 56.0;
const BOTTOM: f64 = 62.0;

/// One point of the chart.
pub struct Point {
    pub name: String,
    /// Cost, and its quartiles.
    pub cost: f64,
    pub spread: (f64, f64),
    pub error: f64,
    pub family: String,
    /// On the front: no other point is both cheaper and more accurate.
    pub front: bool,
    pub default: bool,
}

/// Titles of a plot.
pub struct Titles<'a> {
    pub title: &'a str,
    pub x: &'a str,
    pub y: &'a str,
    pub note: &'a str,
}

const FAMILIES: [Rgb; 6] = [(31, 105, 178), (214, 96, 22), (46, 139, 70), (123, 72, 168), (176, 38, 64), (90, 90, 90)];

fn pale(c: Rgb) -> Rgb {
    let p = |v: u8| (f64::from(v) * 0.38 + 255.0 * 0.62) as u8;
    (p(c.0), p(c.1), p(c.2))
}

fn axes(canvas: &mut Canvas, area: [f64; 4], x: &LogAxis, y: &LogAxis, titles: &Titles<'_>) {
    let [left, top, right, bottom] = area;
    for (v, labelled) in x.ticks() {
        let p = x.at(v);
        canvas.line(&[(p, top), (p, bottom)], GRID, 1);
        if labelled {
            canvas.text(&short(v), (p, bottom + 15.0), 14.0, INK, Anchor::Center);
        }
    }
    for (v, labelled) in y.ticks() {
        let p = y.at(v);
        canvas.line(&[(left, p), (right, p)], GRID, 1);
        if labelled {
            canvas.text(&short(v), (left - 8.0, p), 14.0, INK, Anchor::Right);
        }
    }
    canvas.frame(area, INK);
    canvas.text(titles.title, (left, 20.0), 20.0, INK, Anchor::Left);
    canvas.text(titles.note, (left, 42.0), 13.0, (110, 115, 122), Anchor::Left);
    canvas.text(titles.x, (0.5 * (left + right), bottom + 38.0), 15.0, INK, Anchor::Center);
    canvas.upright(titles.y, (18.0, 0.5 * (top + bottom)), 15.0, INK);
}

/// Places labels next to their points so that they do not overlap. A label that finds no place nearby gets a line to
/// its point.
fn place_labels(canvas: &mut Canvas, area: [f64; 4], labels: &[(String, (f64, f64), Rgb)], bars: Vec<[f64; 4]>) {
    let size = 13.0;
    let mut taken = bars;
    taken.extend(labels.iter().map(|l| [l.1.0 - 6.0, l.1.1 - 6.0, l.1.0 + 6.0, l.1.1 + 6.0]));
    let apart = |a: &[f64; 4], b: &[f64; 4]| a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
    for (text, (x, y), color) in labels {
        let w = Canvas::width_of(text, size);
        let mut places = Vec::new();
        for ring in 0..9 {
            let r = 10.0 + 14.0 * f64::from(ring);
            for turn in 0..16 {
                let (s, c) = (f64::from(turn) * std::f64::consts::TAU / 16.0).sin_cos();
                let (cx, cy) = (x + c * (r + 0.5 * w), y - s * r);
                places.push(([cx - 0.5 * w, cy - 8.0, cx + 0.5 * w, cy + 8.0], ring));
            }
        }
        let inside = |p: &[f64; 4]| p[0] > area[0] + 2.0 && p[2] < area[2] - 2.0 && p[1] > area[1] && p[3] < area[3];
        let free = places.iter().find(|(p, _)| inside(p) && taken.iter().all(|t| apart(p, t)));
        let Some((p, ring)) = free else { continue };
        if *ring > 0 {
            let end = (x.clamp(p[0], p[2]), y.clamp(p[1], p[3]));
            canvas.line(&[(*x, *y), end], FAINT, 1);
        }
        canvas.text(text, (0.5 * (p[0] + p[2]), 0.5 * (p[1] + p[3])), size, *color, Anchor::Center);
        taken.push(*p);
    }
}

/// The chart: every candidate as a point, the front as a line, candidates off the front faint, the default in a ring.
pub fn scatter(points: &[Point], titles: &Titles<'_>) -> Canvas {
    let (width, height) = (1200, 760);
    let mut canvas = Canvas::new(width, height);
    let area = [LEFT, TOP, f64::from(width) - 24.0, f64::from(height) - BOTTOM];
    let shown: Vec<&Point> = points.iter().filter(|p| p.cost > 0.0 && p.error > 0.0 && p.error.is_finite()).collect();
    let x = LogAxis::over(shown.iter().map(|p| p.cost), area[0], area[2]);
    let y = LogAxis::over(shown.iter().map(|p| p.error), area[3], area[1]);
    axes(&mut canvas, area, &x, &y, titles);
    let mut families: Vec<&str> = Vec::new();
    shown.iter().for_each(|p| {
        if !families.contains(&p.family.as_str()) {
            families.push(&p.family);
        }
    });
    let color = |p: &Point| FAMILIES[families.iter().position(|f| *f == p.family).unwrap_or(0) % FAMILIES.len()];
    let mut front: Vec<&&Point> = shown.iter().filter(|p| p.front).collect();
    front.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut steps = Vec::new();
    for p in &front {
        if let Some((_, last)) = steps.last().copied() {
            steps.push((x.at(p.cost), last));
        }
        steps.push((x.at(p.cost), y.at(p.error)));
    }
    canvas.line(&steps, (120, 126, 134), 2);
    let (mut labels, mut bars) = (Vec::new(), Vec::new());
    // Points on the front are drawn last, on top, but labelled first.
    for wanted in [false, true] {
        for p in shown.iter().filter(|p| p.front == wanted) {
            let c = if p.front { color(p) } else { pale(color(p)) };
            let at = (x.at(p.cost), y.at(p.error));
            let (low, high) = (x.at(p.spread.0), x.at(p.spread.1));
            canvas.line(&[(low, at.1), (high, at.1)], c, 2);
            bars.push([low, at.1 - 2.0, high, at.1 + 2.0]);
            canvas.circle(at, 5.0, c, true);
            if p.default {
                canvas.circle(at, 10.0, INK, false);
            }
            labels.push((p.name.clone(), at, if p.front { INK } else { (140, 145, 152) }));
        }
    }
    labels.reverse();
    place_labels(&mut canvas, area, &labels, bars);
    for (i, f) in families.iter().enumerate() {
        let at = area[3] - 18.0 - 20.0 * (families.len() - 1 - i) as f64;
        canvas.circle((area[0] + 16.0, at), 5.0, FAMILIES[i % FAMILIES.len()], true);
        canvas.text(f, (area[0] + 28.0, at), 14.0, INK, Anchor::Left);
    }
    canvas
}

/// Cost (value, lower end, upper end) and error of one effect: in another system, in an earlier version, and now.
pub struct Move {
    pub name: String,
    pub at: [Option<[f64; 4]>; 3],
}

/// The chart of changes: an earlier version is hollow, the current one filled, another system a square.
pub fn moves(all: &[Move], titles: &Titles<'_>) -> Canvas {
    let (width, height) = (1200, 760);
    let mut canvas = Canvas::new(width, height);
    let area = [LEFT, TOP, f64::from(width) - 24.0, f64::from(height) - BOTTOM];
    let shown = || all.iter().flat_map(|m| m.at.iter().flatten());
    let x = LogAxis::over(shown().flat_map(|p| [p[1], p[2]]), area[0], area[2]);
    let y = LogAxis::over(shown().map(|p| p[3]), area[3], area[1]);
    axes(&mut canvas, area, &x, &y, titles);
    let (mut labels, mut bars) = (Vec::new(), Vec::new());
    for (i, of) in all.iter().enumerate() {
        let color = FAMILIES[i % FAMILIES.len()];
        let place = |p: &[f64; 4]| (x.at(p[0]), y.at(p[3]));
        if let [_, Some(before), Some(now)] = &of.at {
            canvas.line(&[place(before), place(now)], pale(color), 2);
        }
        for (p, kind) in of.at.iter().zip(0..).filter_map(|(p, kind)| Some((p.as_ref()?, kind))) {
            let (cx, cy) = place(p);
            let (low, high) = (x.at(p[1]), x.at(p[2]));
            canvas.line(&[(low, cy), (high, cy)], color, 2);
            bars.push([low, cy - 2.0, high, cy + 2.0]);
            match kind {
                0 => canvas.fill([cx - 5.0, cy - 5.0, cx + 5.0, cy + 5.0], color),
                _ => canvas.circle((cx, cy), 6.0, color, kind == 2),
            }
            let when = ["elsewhere", "before", "now"][kind];
            labels.push((format!("{}, {when}", of.name), (cx, cy), INK));
        }
    }
    place_labels(&mut canvas, area, &labels, bars);
    canvas
}

/// One growth curve.
pub struct Line {
    pub name: String,
    pub points: Vec<[f64; 2]>,
}

/// Curves on logarithmic axes, each with its name at its end.
pub fn lines(curves: &[Line], titles: &Titles<'_>) -> Canvas {
    let (width, height) = (1200, 700);
    let mut canvas = Canvas::new(width, height);
    let area = [LEFT, TOP, f64::from(width) - 330.0, f64::from(height) - BOTTOM];
    let all = || curves.iter().flat_map(|c| c.points.iter());
    let x = LogAxis::over(all().map(|p| p[0]), area[0], area[2]);
    let y = LogAxis::over(all().map(|p| p[1]), area[3], area[1]);
    axes(&mut canvas, area, &x, &y, titles);
    // Names stand next to the curves' ends, and are shifted down where they overlap.
    let mut ends: Vec<(f64, usize)> =
        curves.iter().enumerate().filter_map(|(i, c)| c.points.last().map(|p| (y.at(p[1]), i))).collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut above = f64::NEG_INFINITY;
    for (at, i) in ends {
        let color = FAMILIES[i % FAMILIES.len()];
        let points: Vec<(f64, f64)> = curves[i].points.iter().map(|p| (x.at(p[0]), y.at(p[1]))).collect();
        canvas.line(&points, color, 2);
        points.iter().for_each(|p| canvas.circle(*p, 4.0, color, true));
        let place = at.max(above + 18.0);
        above = place;
        if let Some(end) = points.last() {
            canvas.line(&[*end, (area[2] + 8.0, place)], pale(color), 1);
        }
        canvas.text(&curves[i].name, (area[2] + 12.0, place), 13.0, color, Anchor::Left);
    }
    canvas
}
