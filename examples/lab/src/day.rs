//! `lab run FILE`: the frames of a scripted day, as `cargo bench --bench speed -- run` writes them to a file: a chart
//! of their times over the day, and a part of the page.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use welkin::{Error, Result, Status};

use crate::canvas::{Anchor, Canvas, GRID, INK, Rgb};
use crate::chart::today;
use crate::command::Options;
use crate::page;
use crate::plot::{LogAxis, short};
use crate::store::{Table, io};

/// Columns of the file that are read here.
const COLUMNS: [&str; 7] = ["frame", "segment", "settled", "wall_ms", "rest_ms", "base_ms", "cause"];

/// Causes of slow frames and their colours. A frame with several causes has the colour of the first of these.
const CAUSES: [(&str, Rgb); 5] = [
    ("pipeline", (176, 38, 64)),
    ("sky table", (214, 96, 22)),
    ("observer's table", (123, 72, 168)),
    ("cloud table", (46, 139, 70)),
    ("other", INK),
];
const FRAMES: Rgb = (96, 150, 200);
const AT_REST: Rgb = (31, 72, 120);

/// Frames of one segment.
struct SegmentFrames<'a> {
    name: &'a str,
    /// Number and wall time, ms, of each frame.
    frames: Vec<(f64, f64)>,
    /// Wall times, ms, of the frames after the change of weather.
    settled: Vec<f64>,
    /// Number, wall time and causes of the slow ones.
    slow: Vec<(f64, f64, &'a str)>,
    /// Wall time at rest in its weather, and the longer of that and of the weather before, ms.
    rest: f64,
    base: f64,
}

/// Value below which this share of the numbers lies.
fn quantile(numbers: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut all: Vec<f64> = numbers.collect();
    all.sort_by(f64::total_cmp);
    all.get(((all.len().max(1) - 1) as f64 * share) as usize).copied().unwrap_or(f64::NAN)
}

/// Reads the segments of a table, in order.
///
/// # Errors
/// A missing column, or a row that is no frame.
fn segments(table: &Table) -> Result<Vec<SegmentFrames<'_>>> {
    let fault = |what: String| Error::new(Status::Parse, format!("no frames of a run: {what}"));
    let column = |name: &str| {
        let found = table.columns.iter().position(|column| column == name);
        found.ok_or_else(|| fault(format!("there is no column {name}")))
    };
    let mut at = [0; COLUMNS.len()];
    for (place, name) in at.iter_mut().zip(COLUMNS) {
        *place = column(name)?;
    }
    let [_, segment, .., cause] = at;
    let mut all: Vec<SegmentFrames<'_>> = Vec::new();
    for row in &table.rows {
        let number = |place: usize| {
            let read = row[place].parse().ok().filter(|v: &f64| v.is_finite() && *v >= 0.0);
            read.ok_or_else(|| fault(format!("{} of frame {} is `{}`", table.columns[place], row[at[0]], row[place])))
        };
        let [frame, settled, wall, rest, base] = [at[0], at[2], at[3], at[4], at[5]].map(number);
        let (frame, wall, rest, base) = (frame?, wall?, rest?, base?);
        if all.last().is_none_or(|last| last.name != row[segment]) {
            let (frames, settled, slow) = (Vec::new(), Vec::new(), Vec::new());
            all.push(SegmentFrames { name: &row[segment], frames, settled, slow, rest, base });
        }
        let Some(last) = all.last_mut() else { continue };
        last.frames.push((frame, wall));
        last.settled.extend((settled? > 0.0).then_some(wall));
        if !row[cause].is_empty() {
            last.slow.push((frame, wall, &row[cause]));
        }
    }
    if all.is_empty() { Err(fault("there is no row".to_owned())) } else { Ok(all) }
}

/// Charts the frames in a file and writes the page again.
///
/// # Errors
/// Files; a file that holds no frames of a run.
pub fn run(file: &Path, options: &Options) -> Result<()> {
    let missing = || io(file, &"no such file; `RUN_CSV=FILE cargo bench --bench speed -- run` writes one");
    let table = Table::read(file)?.ok_or_else(missing)?;
    let chart = draw(&segments(&table)?);
    let text = fs::read_to_string(file).map_err(|e| io(file, &e))?;
    if !text.starts_with("# ") {
        return Err(Error::new(
            Status::Parse,
            "no frames of a run: the first line does not say how they were measured",
        ));
    }
    let dated = text.replacen('\n', &format!("; {}\n", today()), 1);
    fs::create_dir_all(&options.out).map_err(|e| io(&options.out, &e))?;
    welkin_command_line::write_whole(&options.out.join("run.csv"), dated.as_bytes())?;
    chart.save(&options.out.join("run"))?;
    page::write(&options.out)
}

/// Index of a slow frame's cause in [`CAUSES`].
fn cause_of(causes: &str) -> usize {
    let known = CAUSES.iter().position(|(name, _)| causes.split(" + ").any(|cause| cause == *name));
    known.unwrap_or(CAUSES.len() - 1)
}

/// Draws the range of times in each column of pixels, the time at rest, and a dot for each slow frame.
fn draw(segments: &[SegmentFrames<'_>]) -> Canvas {
    let (width, height) = (1200, 620);
    let mut canvas = Canvas::new(width, height);
    let area = [78.0, 76.0, f64::from(width) - 24.0, f64::from(height) - 62.0];
    let frames = || segments.iter().flat_map(|segment| &segment.frames);
    let y = LogAxis::over(frames().map(|(_, ms)| *ms), area[3], area[1]);
    let last = frames().map(|(frame, _)| *frame).fold(1.0, f64::max);
    let x = |frame: f64| area[0] + (area[2] - area[0]) * frame / last;
    for (ms, labelled) in y.ticks() {
        canvas.line(&[(area[0], y.at(ms)), (area[2], y.at(ms))], GRID, 1);
        if labelled {
            canvas.text(&short(ms), (area[0] - 8.0, y.at(ms)), 14.0, INK, Anchor::Right);
        }
    }
    let mut columns = vec![(f64::INFINITY, 0.0f64); (area[2] - area[0]) as usize + 1];
    for (frame, ms) in frames() {
        let (low, high) = &mut columns[(x(*frame) - area[0]) as usize];
        (*low, *high) = (low.min(*ms), high.max(*ms));
    }
    for (i, (low, high)) in columns.iter().enumerate().filter(|(_, (low, _))| low.is_finite()) {
        let column = area[0] + i as f64;
        canvas.line(&[(column, y.at(*low)), (column, y.at(*high) - 1.0)], FRAMES, 1);
    }
    for segment in segments {
        let ends =
            [segment.frames.first(), segment.frames.last()].map(|end| end.map_or(area[0], |(frame, _)| x(*frame)));
        canvas.line(&[(ends[0], area[1]), (ends[0], area[3])], GRID, 2);
        canvas.line(&[(ends[0], y.at(segment.rest)), (ends[1], y.at(segment.rest))], AT_REST, 2);
        canvas.text(segment.name, (ends[0] + 4.0, area[1] + 12.0), 11.0, INK, Anchor::Left);
    }
    for (frame, ms, causes) in segments.iter().flat_map(|segment| &segment.slow) {
        canvas.circle((x(*frame), y.at(*ms)), 2.5, CAUSES[cause_of(causes)].1, true);
    }
    canvas.frame(area, INK);
    canvas.text("A scripted day, frame by frame", (area[0], 20.0), 20.0, INK, Anchor::Left);
    let note =
        "light: least and longest in each column; dark: the same weather at rest; dots: slow frames by their cause";
    canvas.text(note, (area[0], 40.0), 13.0, (110, 115, 122), Anchor::Left);
    let mut along = area[0];
    for (name, color) in CAUSES {
        canvas.circle((along + 5.0, 60.0), 4.0, color, true);
        canvas.text(name, (along + 14.0, 60.0), 13.0, INK, Anchor::Left);
        along += 34.0 + Canvas::width_of(name, 13.0);
    }
    canvas.text("frame", (0.5 * (area[0] + area[2]), area[3] + 38.0), 15.0, INK, Anchor::Center);
    canvas.text(&short(last), (area[2], area[3] + 15.0), 14.0, INK, Anchor::Right);
    canvas.upright("wall time of a frame, ms", (18.0, 0.5 * (area[1] + area[3])), 15.0, INK);
    canvas
}

/// Writes the part of the page for the table beside it.
///
/// # Errors
/// A table that holds no frames of a run.
pub fn section(out: &mut String, table: &Table) -> Result<()> {
    out.push_str(
        "## A scripted day\n\n![times of all frames](run.svg)\n\n\
         A trainer's day as `cargo bench --bench speed -- run` plays it: a report every 30 s with a change of weather, a camera that \
         drives, turns and climbs, a sun at its pace and at 60 times its pace. Wall times of a frame with the wait for the driver. \
         *At rest* is the same weather with camera and sun at rest; 99th percentile and slowest frame are over the longer of that and \
         the weather before, *settled* is the median from 2 s after the change over the weather at rest. Slow frames took more than \
         1.5 times the frame at rest.\n\n\
         | weather | at rest, ms | median, ms | 99th percentile | slowest | settled | slow frames |\n|---|---|---|---|---|---|---|\n",
    );
    for segment in segments(table)? {
        let wall = |share| quantile(segment.frames.iter().map(|(_, ms)| *ms), share);
        let mut counts = [0; CAUSES.len()];
        segment.slow.iter().for_each(|(.., causes)| counts[cause_of(causes)] += 1);
        let counted = CAUSES.iter().zip(counts).filter(|(_, count)| *count > 0);
        let causes: Vec<String> = counted.map(|((name, _), count)| format!("{count} {name}")).collect();
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} | {} |",
            segment.name,
            short(segment.rest),
            short(wall(0.5)),
            short(wall(0.99) / segment.base),
            short(wall(1.0) / segment.base),
            short(quantile(segment.settled.iter().copied(), 0.5) / segment.rest),
            causes.join(", ")
        );
    }
    let _ = writeln!(out, "\nMeasured: {}.\n", table.note);
    Ok(())
}
