//! Course of an observer that moves steadily: between which two places it is, and which place comes next.

use std::ops::Range;

use super::observer_tables::LAMPS;

/// Numbers that an observer's tables depend on: its altitude, and the sine of elevation of each lamp.
pub(super) const NUMBERS: usize = 1 + LAMPS;

/// Altitude of an observer, m, and the sine of elevation of each lamp that lights the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ObserverPlace {
    pub altitude_m: f64,
    pub mu_s: [Option<f64>; LAMPS],
}

impl ObserverPlace {
    fn numbers(&self) -> [f64; NUMBERS] {
        let [a, b] = self.mu_s.map(|mu_s| mu_s.unwrap_or(0.0));
        [self.altitude_m, a, b]
    }

    /// The place with other numbers; lamps that are not there stay away.
    fn with(&self, [altitude_m, a, b]: [f64; NUMBERS]) -> Self {
        let mu_s = |lamp: usize, value: f64| self.mu_s[lamp].map(|_| value.clamp(-1.0, 1.0));
        Self { altitude_m, mu_s: [mu_s(0, a), mu_s(1, b)] }
    }

    /// Whether tables at this place serve an observer at `place`.
    pub fn is_near(&self, place: &Self, bounds: &Bounds) -> bool {
        difference(self, place).iter().zip(bounds.near).all(|(moved, near)| moved.abs() <= near)
    }

    fn has_lamps_of(&self, other: &Self) -> bool {
        self.mu_s.map(|mu_s| mu_s.is_some()) == other.mu_s.map(|mu_s| mu_s.is_some())
    }
}

/// Bounds for following an observer, for its altitude, m, and the sine of elevation of each lamp.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Differences from the observer's place up to which tables serve it.
    pub near: [f64; NUMBERS],
    /// Distances over which the light of the air is straight enough to be mixed from both ends.
    pub far: [f64; NUMBERS],
}

/// Frames of motion before anything is drawn ahead.
const FRAMES_BEFORE: u32 = 8;
/// Frames from one pair of places to the next: as many as the light allows, up to the first; or more, up to the second,
/// for a motion so slow that the way is shorter than `SHORT_WAY` of the near bounds.
const MOST_FRAMES: (f64, f64) = (40.0, 400.0);
const SHORT_WAY: f64 = 20.0;
/// Share of a frame's motion in the speed that is followed: a mean over some frames, so that a camera that sways keeps
/// its course.
const SPEED_SHARE: f64 = 0.1;

/// Tables at one place that are being drawn from the first row on.
#[derive(Clone, Copy, Debug)]
struct Coming {
    place: ObserverPlace,
    rows: u32,
    rows_a_frame: u32,
}

/// Work of one frame on the tables ahead.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct CourseStep {
    /// Rows to draw of the tables of a place ahead.
    pub slice: Option<(ObserverPlace, Range<u32>)>,
    /// Whether, after that, the tables of the place ahead take the place of the pair's second, and those the place of
    /// its first.
    pub turns: bool,
    /// Whether, after that, the present tables are copied to the pair's first.
    pub copies: bool,
    /// Share of the pair's second tables at the observer's place; `None` without a pair that serves it.
    pub share: Option<f32>,
}

/// Course of an observer.
#[derive(Clone, Debug, Default)]
pub(super) struct Course {
    last: Option<ObserverPlace>,
    speed: [f64; NUMBERS],
    frames: u32,
    pair: Option<[ObserverPlace; 2]>,
    coming: Option<Coming>,
}

impl Course {
    /// Follows the observer to `place` in the next frame. `drawn` is the place of the present tables, `rows` the height
    /// of a table.
    pub fn follow(
        &mut self,
        place: ObserverPlace,
        drawn: Option<ObserverPlace>,
        bounds: &Bounds,
        rows: u32,
    ) -> CourseStep {
        let mut step = CourseStep::default();
        let Some(last) = self.last.replace(place).filter(|last| last.has_lamps_of(&place)) else {
            *self = Self { last: Some(place), ..Self::default() };
            return step;
        };
        if place == last {
            step.share = self.pair.and_then(|pair| share(&pair, &place, bounds));
            return step;
        }
        let moved = difference(&place, &last);
        let known = if self.frames == 0 { moved } else { self.speed };
        self.speed = std::array::from_fn(|i| known[i] + SPEED_SHARE * (moved[i] - known[i]));
        self.frames += 1;
        match self.pair {
            Some(pair) => self.between(&pair, &place, bounds, rows, &mut step),
            None => self.toward(&place, drawn, bounds, rows, &mut step),
        }
        step
    }

    /// Goes on between two places, or past the second towards the one that comes.
    fn between(
        &mut self,
        pair: &[ObserverPlace; 2],
        place: &ObserverPlace,
        bounds: &Bounds,
        rows: u32,
        step: &mut CourseStep,
    ) {
        step.share = share(pair, place, bounds);
        if step.share.is_none()
            && let Some(mut coming) = self.coming.take()
        {
            // The rest of the next tables at once: the observer came there sooner than its speed said.
            step.slice = coming.next(rows, rows);
            let next = [pair[1], coming.place];
            step.turns = true;
            step.share = share(&next, place, bounds);
            self.pair = Some(next);
        } else if step.share.is_some() {
            let speed = self.speed;
            let coming = match &mut self.coming {
                Some(coming) => Some(coming),
                none => {
                    *none =
                        frames_ahead(place, &speed, bounds).map(|frames| Coming::new(&pair[1], &speed, frames, rows));
                    none.as_mut()
                }
            };
            step.slice = coming.and_then(|coming| coming.next(coming.rows_a_frame, rows));
        }
        if step.share.is_none() {
            *self = Self { last: self.last, ..Self::default() };
            step.turns = false;
            step.slice = None;
        }
    }

    /// Draws the first tables ahead, while the present ones are still drawn whole.
    fn toward(
        &mut self,
        place: &ObserverPlace,
        drawn: Option<ObserverPlace>,
        bounds: &Bounds,
        rows: u32,
        step: &mut CourseStep,
    ) {
        if self.frames < FRAMES_BEFORE {
            return;
        }
        let Some(frames) = frames_ahead(place, &self.speed, bounds) else {
            *self = Self { last: self.last, ..Self::default() };
            return;
        };
        let speed = self.speed;
        let coming = self.coming.get_or_insert_with(|| Coming::new(place, &speed.map(|v| 2.0 * v), frames, rows));
        step.slice = coming.next(coming.rows_a_frame, rows);
        let (Some(drawn), true) = (drawn, coming.rows >= rows) else { return };
        let pair = [drawn, coming.place];
        step.share = share(&pair, place, bounds);
        if step.share.is_none() {
            *self = Self { last: self.last, ..Self::default() };
            step.slice = None;
            return;
        }
        (step.turns, step.copies) = (true, true);
        (self.pair, self.coming) = (Some(pair), None);
    }
}

impl Coming {
    /// Tables of the place that is reached from `from` in so many frames.
    fn new(from: &ObserverPlace, speed: &[f64; NUMBERS], frames: f64, rows: u32) -> Self {
        let numbers = from.numbers();
        let place = from.with(std::array::from_fn(|i| numbers[i] + frames * speed[i]));
        // A frame less than there are, for an observer that comes a little sooner.
        Self { place, rows: 0, rows_a_frame: (f64::from(rows) / (frames - 1.0).max(1.0)).ceil() as u32 }
    }

    /// The next rows to draw.
    fn next(&mut self, count: u32, rows: u32) -> Option<(ObserverPlace, Range<u32>)> {
        let range = self.rows..(self.rows + count).min(rows);
        self.rows = range.end;
        (!range.is_empty()).then_some((self.place, range))
    }
}

fn difference(a: &ObserverPlace, b: &ObserverPlace) -> [f64; NUMBERS] {
    let (a, b) = (a.numbers(), b.numbers());
    std::array::from_fn(|i| a[i] - b[i])
}

/// Frames until an observer at this speed has gone as far as tables may be mixed over; `None` if it is there at once.
fn frames_ahead(place: &ObserverPlace, speed: &[f64; NUMBERS], bounds: &Bounds) -> Option<f64> {
    let numbers = || (0..NUMBERS).filter(|i| *i == 0 || place.mu_s[i - 1].is_some());
    let frames =
        |ways: &[f64; NUMBERS]| numbers().map(|i| ways[i] / speed[i].abs().max(1e-300)).fold(f64::INFINITY, f64::min);
    let slow = (SHORT_WAY * frames(&bounds.near)).min(MOST_FRAMES.1);
    let frames = frames(&bounds.far).min(slow.max(MOST_FRAMES.0)).floor();
    (frames >= 2.0).then_some(frames)
}

/// Share of the second of two places in `place`, if it lies between them: beside the way by less than the near bounds.
fn share(pair: &[ObserverPlace; 2], place: &ObserverPlace, bounds: &Bounds) -> Option<f32> {
    let (way, gone) = (difference(&pair[1], &pair[0]), difference(place, &pair[0]));
    let sum = |a: &[f64; NUMBERS]| (0..NUMBERS).map(|i| a[i] * way[i] / bounds.near[i].powi(2)).sum::<f64>();
    let share = sum(&gone) / sum(&way);
    let beside = (0..NUMBERS).all(|i| (gone[i] - share * way[i]).abs() <= bounds.near[i]);
    (beside && (0.0..=1.0).contains(&share)).then_some(share as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: Bounds = Bounds { near: [1.2, 2e-5, 2e-5], far: [60.0, 0.01, 0.01] };
    const ROWS: u32 = 40;

    fn sun(altitude_m: f64, mu_s: f64) -> ObserverPlace {
        ObserverPlace { altitude_m, mu_s: [Some(mu_s), None] }
    }

    /// Rows drawn ahead and tables drawn whole, over frames of a motion; tables are drawn whole where nothing serves.
    fn drawn(frames: u32, motion: impl Fn(f64) -> ObserverPlace) -> (u32, u32) {
        let (mut course, mut tables, mut rows, mut whole) = (Course::default(), None::<ObserverPlace>, 0, 0);
        for i in 0..frames {
            let place = motion(f64::from(i));
            let step = course.follow(place, tables, &BOUNDS, ROWS);
            rows += step.slice.map_or(0, |(_, rows)| rows.len() as u32);
            let serves = tables.is_some_and(|t| t.is_near(&place, &BOUNDS));
            if step.share.is_some() {
                tables = Some(place);
            } else if !serves {
                (tables, whole) = (Some(place), whole + 1);
            }
        }
        (rows, whole)
    }

    #[test]
    fn a_steady_motion_needs_a_slice_a_frame_and_no_whole_tables() {
        // A sun that moves by 0.05 degrees a frame, first alone, then with a camera that climbs and sways.
        for climb_m in [0.0, 0.05] {
            let motion = |i: f64| sun(10.0 + climb_m * i + 0.3 * climb_m * (1.7 * i).sin(), 0.7 - 8.7e-4 * i);
            let (rows, whole) = drawn(400, motion);
            assert!(whole <= 20, "{whole} of 400 frames draw whole tables");
            assert!((30 * ROWS..56 * ROWS).contains(&rows), "{rows} rows: one table in about eleven frames");
        }
        // The sun at its pace: 40 rows in 333 frames.
        let (rows, whole) = drawn(4000, |i| sun(10.0, 0.7 - 1.2e-6 * i));
        assert!(whole <= 3 && (8 * ROWS..16 * ROWS).contains(&rows), "{rows} rows, {whole} whole");
        // Frames of uneven length lie on the same way.
        let (_, whole) = drawn(400, |i| sun(10.0, 0.7 - 8.7e-4 * (i + 0.4 * (i * 0.9).sin())));
        assert!(whole <= 24, "{whole}");
    }

    #[test]
    fn a_motion_that_turns_back_or_leaps_is_drawn_whole_and_followed_again() {
        let back = |i: f64| sun(10.0, 0.7 - 8.7e-4 * (200.0 - (i - 200.0).abs()));
        let (_, whole) = drawn(400, back);
        assert!((20..60).contains(&whole), "{whole}");
        let (rows, whole) = drawn(100, |i| sun(10.0, 0.9 * (i * 12.9898).sin()));
        assert_eq!((rows, whole), (0, 100), "leaps leave nothing to draw ahead");
        let (rows, whole) = drawn(100, |_| sun(10.0, 0.3));
        assert_eq!((rows, whole), (0, 1), "at rest nothing is drawn");
    }

    #[test]
    fn a_lamp_that_appears_begins_a_new_course() {
        let mut course = Course::default();
        let motion = |i: u32| sun(10.0, 0.7 - 8.7e-4 * f64::from(i));
        let at_last = (0..60).map(|i| course.follow(motion(i), Some(motion(i)), &BOUNDS, ROWS)).last();
        assert!(at_last.is_some_and(|step| step.share.is_some()));
        let with_moon = ObserverPlace { mu_s: [Some(0.6), Some(0.1)], ..motion(60) };
        assert_eq!(course.follow(with_moon, Some(motion(59)), &BOUNDS, ROWS), CourseStep::default());
    }
}
