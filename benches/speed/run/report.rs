//! Report of a day: quantiles of every segment in ms, in copies and over the same weather at rest, the causes of slow
//! frames, and all frames as CSV.

use std::{fmt::Write as _, path::Path};

use welkin::gpu::Caps;

use super::{
    day::{Pace, SEGMENTS, TICKS_PER_S},
    played::{PlayedDay, PlayedFrame, Times},
};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Times a frame at rest above which a frame counts as slow.
const SLOW: f64 = 1.5;
/// Frames that are named for each segment, the slowest first.
const NAMED: usize = 3;

/// Clock of a frame's times, ms.
type Clock = fn(&Times) -> f64;

/// Clocks of the report, with their names.
const CLOCKS: [(&str, Clock); 2] = [("wall", |t| t.wall_ms), ("processor", |t| t.processor_ms)];

/// All that was measured.
pub struct Day {
    pub pace: Pace,
    pub played: PlayedDay,
    /// Medians of each segment's weather at rest.
    pub rest: Vec<Times>,
}

/// Median, 95th and 99th percentile, and the largest.
fn quantiles(mut all: Vec<f64>) -> [f64; 4] {
    all.sort_by(f64::total_cmp);
    [0.5, 0.95, 0.99, 1.0]
        .map(|share| all.get(((all.len().max(1) - 1) as f64 * share) as usize).copied().unwrap_or(0.0))
}

impl Day {
    fn segment_of(&self, frame: &PlayedFrame) -> usize {
        (frame.tick / self.pace.segment) as usize
    }

    /// Returns the time of a frame at rest to which those of a segment are compared: the longer of the medians in its
    /// weather and in the one before.
    fn base(&self, segment: usize, clock: Clock) -> f64 {
        clock(&self.rest[segment]).max(clock(&self.rest[segment.saturating_sub(1)]))
    }

    fn frames_of(&self, segment: usize) -> impl Iterator<Item = (usize, &PlayedFrame)> {
        self.played.frames.iter().enumerate().filter(move |(_, frame)| self.segment_of(frame) == segment)
    }

    fn is_slow(&self, frame: &PlayedFrame) -> bool {
        frame.times.wall_ms > SLOW * self.base(self.segment_of(frame), CLOCKS[0].1)
    }

    /// Prints the report.
    pub fn print(&self) {
        println!(
            "  each weather at rest in the median of {} frames; the day began after {:.0} s of preparing and {} frames in which its first weather settled",
            self.pace.rest_frames, self.played.prepared_s, self.played.settled
        );
        println!(
            "  median, 95th and 99th percentile and slowest frame of every segment, with the wait for the driver:"
        );
        println!(
            "  {:11} {:6} {:9} {:>7} {:>27} {:>27} {:>23} {:>8}",
            "segment", "frames", "time", "at rest", "ms", "copies", "over the dearer rest", "settled"
        );
        for segment in 0..SEGMENTS.len() {
            self.print_segment(segment);
        }
        let slow = self.played.frames.iter().filter(|frame| self.is_slow(frame)).count();
        let (mut worst, mut p99) = (0.0f64, 0.0f64);
        for segment in 0..SEGMENTS.len() {
            let base = self.base(segment, CLOCKS[0].1);
            let [.., high, most] = quantiles(self.frames_of(segment).map(|(_, frame)| frame.times.wall_ms).collect());
            (worst, p99) = (worst.max(most / base), p99.max(high / base));
        }
        println!(
            "  {slow} slow frames; worst segment: 99th percentile {p99:.2}, slowest frame {worst:.2} times the frame at rest"
        );
    }

    fn print_segment(&self, segment: usize) {
        for (name, clock) in CLOCKS {
            let of = |unit: &dyn Fn(&PlayedFrame) -> f64| {
                quantiles(self.frames_of(segment).map(|(_, frame)| clock(&frame.times) / unit(frame)).collect())
            };
            let (base, rest) = (self.base(segment, clock), clock(&self.rest[segment]));
            let settled = self.frames_of(segment).filter(|(_, frame)| self.pace.is_settled(frame.tick));
            let [settled, ..] = quantiles(settled.map(|(_, frame)| clock(&frame.times)).collect());
            let row =
                |width: usize, digits: usize, of: [f64; 4]| of.map(|value| format!("{value:width$.digits$}")).join(" ");
            let first = if name == CLOCKS[0].0 { SEGMENTS[segment].name } else { "" };
            println!(
                "  {first:11} {:6} {name:9} {rest:7.1} {} {} {} {:8.2}",
                self.frames_of(segment).count(),
                row(6, 1, of(&|_| 1.0)),
                row(6, 1, of(&|frame| clock(&frame.copy))),
                row(5, 2, of(&|_| base)),
                settled / rest
            );
        }
        let mut slow: Vec<_> = self.frames_of(segment).filter(|(_, frame)| self.is_slow(frame)).collect();
        let mut causes: Vec<(String, usize)> = Vec::new();
        for (_, frame) in &slow {
            let cause = frame.work.causes();
            match causes.iter_mut().find(|(known, _)| *known == cause) {
                Some((_, count)) => *count += 1,
                None => causes.push((cause, 1)),
            }
        }
        causes.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        if slow.is_empty() {
            return;
        }
        let causes: Vec<String> = causes.iter().map(|(cause, count)| format!("{count} {cause}")).collect();
        println!("    {} frames above {SLOW} times the frame at rest: {}", slow.len(), causes.join(", "));
        slow.sort_by(|a, b| b.1.times.wall_ms.total_cmp(&a.1.times.wall_ms));
        let named = if std::env::var_os("RUN_SLOW").is_some() { slow.len() } else { NAMED };
        for (i, frame) in slow.into_iter().take(named) {
            let since = f64::from(frame.tick % self.pace.segment) / f64::from(TICKS_PER_S);
            println!(
                "      {:.1} ms wall, {:.1} to submit, {:.1} processor: frame {i}, {since:.2} s after the report; {}",
                frame.times.wall_ms,
                frame.submitted_ms,
                frame.times.processor_ms,
                frame.work.details()
            );
        }
    }

    /// Writes all frames to a file. The first line names the run, the adapter and the driver.
    pub fn write(&self, path: &Path, caps: &Caps) -> Fallible<()> {
        let clean = |text: &str| text.replace(',', ";");
        let mut out = format!("# run; {}; {}; {}\n", self.pace.name, clean(&caps.adapter_name), clean(&caps.driver));
        out.push_str("frame,segment,time_s,settled,wall_ms,submitted_ms,processor_ms,copy_ms,rest_ms,base_ms,cause\n");
        for (i, frame) in self.played.frames.iter().enumerate() {
            let (segment, wall) = (self.segment_of(frame), CLOCKS[0].1);
            writeln!(
                out,
                "{i},{},{:.3},{},{:.2},{:.2},{:.2},{:.4},{:.2},{:.2},{}",
                SEGMENTS[segment].name,
                f64::from(frame.tick) / f64::from(TICKS_PER_S),
                u8::from(self.pace.is_settled(frame.tick)),
                frame.times.wall_ms,
                frame.submitted_ms,
                frame.times.processor_ms,
                frame.copy.wall_ms,
                wall(&self.rest[segment]),
                self.base(segment, wall),
                if self.is_slow(frame) { frame.work.causes() } else { String::new() }
            )?;
        }
        Ok(std::fs::write(path, out)?)
    }
}
