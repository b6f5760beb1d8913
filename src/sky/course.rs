//! Course of an observer whose altitude changes steadily, or whose sun or moon moves steadily. It would cost too much
//! to draw the observer's tables of the sky (`observer_tables.rs`) anew in every frame. The course therefore picks
//! places on the observer's way. A place is an altitude together with the elevations of sun and moon. The tables of the
//! next place are drawn in slices: some rows in each frame. The tables for the observer itself are a mix of the tables
//! of two places, one behind and one ahead of it: the pair.

use std::ops::Range;

use super::observer_tables::LAMPS;

/// Count of the values that an observer's tables depend on: its altitude, and the sine of elevation of each lamp.
const NUMBERS: usize = 1 + LAMPS;

/// Place on an observer's way: the values that the observer's tables depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ObserverPlace {
    /// Altitude, m.
    pub altitude_m: f64,
    /// Sine of elevation of each lamp that lights the air (sun, moon); `None` for a lamp that does not shine.
    pub mu_s: [Option<f64>; LAMPS],
}

impl ObserverPlace {
    fn numbers(&self) -> [f64; NUMBERS] {
        let [a, b] = self.mu_s.map(|mu_s| mu_s.unwrap_or(0.0));
        [self.altitude_m, a, b]
    }

    /// Returns the place with the altitude and sines given; a lamp that is `None` stays `None`.
    fn with(&self, [altitude_m, a, b]: [f64; NUMBERS]) -> Self {
        let mu_s = |lamp: usize, value: f64| self.mu_s[lamp].map(|_| value.clamp(-1.0, 1.0));
        Self { altitude_m, mu_s: [mu_s(0, a), mu_s(1, b)] }
    }

    /// Whether tables of this place may be used for an observer at `place`.
    pub fn is_near(&self, place: &Self, bounds: &Bounds) -> bool {
        difference(self, place).iter().zip(bounds.near).all(|(moved, near)| moved.abs() <= near)
    }

    fn has_lamps_of(&self, other: &Self) -> bool {
        self.mu_s.map(|mu_s| mu_s.is_some()) == other.mu_s.map(|mu_s| mu_s.is_some())
    }
}

/// Bounds for following an observer. The first number of each is for the altitude, m, the others are for the sine of
/// elevation of each lamp.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Largest difference between two places at which the tables of one may be used for an observer at the other.
    pub near: [f64; NUMBERS],
    /// Largest difference between two places whose tables may be mixed linearly for the places in between.
    pub far: [f64; NUMBERS],
}

/// Frames of motion before anything is drawn ahead.
const FRAMES_BEFORE: u32 = 8;
/// Least and largest value of the limit on the number of frames from one place to the next. The limit is the number of
/// frames in which the motion covers [`SHORT_WAY`] times a near bound. It is therefore above the least value only for a
/// very slow motion. The far bounds may allow fewer frames than the limit.
const MOST_FRAMES: (f64, f64) = (40.0, 400.0);
/// Way from one place to the next, in multiples of the near bounds, that a very slow motion is to cover.
const SHORT_WAY: f64 = 20.0;
/// Weight of the newest frame's motion in the speed, an exponential mean over some 10 frames. With the mean, a camera
/// that sways keeps its course.
const SPEED_SHARE: f64 = 0.1;

/// Tables of the next place, which are drawn row by row from the first row on.
#[derive(Clone, Copy, Debug)]
struct Coming {
    place: ObserverPlace,
    /// Rows drawn so far.
    rows: u32,
    /// Rows to draw in each frame.
    rows_a_frame: u32,
}

/// Work of one frame on the tables ahead.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct CourseStep {
    /// Rows to draw of the tables of a place ahead.
    pub slice: Option<(ObserverPlace, Range<u32>)>,
    /// Whether to shift the pair after drawing `slice`: its second tables become its first, and the tables of the next
    /// place become its second.
    pub turns: bool,
    /// Whether to copy the observer's present tables into the pair's first tables, after the shift.
    pub copies: bool,
    /// Weight of the pair's second tables in the mix for the observer, 0 to 1; `None` if no pair may be used.
    pub share: Option<f32>,
}

/// Course of an observer.
#[derive(Clone, Debug, Default)]
pub(super) struct ObserverCourse {
    /// Observer's place in the last frame.
    last: Option<ObserverPlace>,
    /// Mean change of the altitude, m, and of each lamp's sine of elevation, in one frame.
    speed: [f64; NUMBERS],
    /// Frames of motion since the course began.
    frames: u32,
    /// Places with whole tables, the first behind and the second ahead of the observer.
    pair: Option<[ObserverPlace; 2]>,
    /// Next place, whose tables are not yet whole.
    coming: Option<Coming>,
}

impl ObserverCourse {
    /// Follows the observer to `place` in the next frame, and returns that frame's work. A frame without motion draws
    /// no slice, and a lamp that appears or goes begins a new course. `drawn` is the place of the present tables,
    /// `rows` the height of a table.
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

    /// Plans a frame of an observer with a pair. Between the pair's places the plan is a mix of their tables and a
    /// slice of the next tables. Past the second place the plan is the rest of the next tables and a shift of the pair.
    /// Forgets the course if the observer is outside the shifted pair too, or if there is no next place.
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
            // Completes the next tables at once, if the observer passed the second place before they were whole.
            step.slice = coming.next(rows, rows);
            let next = [pair[1], coming.place];
            step.turns = true;
            step.share = share(&next, place, bounds);
            self.pair = Some(next);
        } else if step.share.is_some() {
            if self.coming.is_none() {
                let frames = frames_ahead(place, &self.speed, bounds);
                self.coming = frames.map(|frames| Coming::new(&pair[1], &self.speed, frames, rows));
            }
            step.slice = self.coming.as_mut().and_then(|coming| coming.next(coming.rows_a_frame, rows));
        }
        if step.share.is_none() {
            self.forget();
            step.turns = false;
            step.slice = None;
        }
    }

    /// Plans slices of the tables of the first place ahead. Until these are complete there is no pair, and the caller
    /// draws the observer's own tables whole.
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
            self.forget();
            return;
        };
        let speed = self.speed;
        // Plans for twice the way, because the observer covers its first half while the tables are drawn.
        let coming = self.coming.get_or_insert_with(|| Coming::new(place, &speed.map(|v| 2.0 * v), frames, rows));
        step.slice = coming.next(coming.rows_a_frame, rows);
        let (Some(drawn), true) = (drawn, coming.rows >= rows) else { return };
        let pair = [drawn, coming.place];
        step.share = share(&pair, place, bounds);
        if step.share.is_none() {
            self.forget();
            step.slice = None;
            return;
        }
        (step.turns, step.copies) = (true, true);
        (self.pair, self.coming) = (Some(pair), None);
    }

    /// Forgets everything except the observer's place in the last frame.
    fn forget(&mut self) {
        *self = Self { last: self.last, ..Self::default() };
    }
}

impl Coming {
    /// Plans the tables of the place that an observer reaches from `start` in `frames` frames at `speed`.
    fn new(start: &ObserverPlace, speed: &[f64; NUMBERS], frames: f64, rows: u32) -> Self {
        let numbers = start.numbers();
        let place = start.with(std::array::from_fn(|i| numbers[i] + frames * speed[i]));
        // Plans for one frame fewer, because an observer may arrive a little early.
        Self { place, rows: 0, rows_a_frame: (f64::from(rows) / (frames - 1.0).max(1.0)).ceil() as u32 }
    }

    /// Returns the next `count` rows to draw of the table's `rows`; `None` if all are drawn.
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

/// Returns the number of frames from `place` to the next place: those in which the observer moves by a far bound, or
/// the limit of [`MOST_FRAMES`] if that is less. `speed` is the motion in one frame. Returns `None` below 2 frames, too
/// few for slices.
fn frames_ahead(place: &ObserverPlace, speed: &[f64; NUMBERS], bounds: &Bounds) -> Option<f64> {
    let numbers = || (0..NUMBERS).filter(|i| *i == 0 || place.mu_s[i - 1].is_some());
    let frames =
        |ways: &[f64; NUMBERS]| numbers().map(|i| ways[i] / speed[i].abs().max(1e-300)).fold(f64::INFINITY, f64::min);
    let slow = (SHORT_WAY * frames(&bounds.near)).min(MOST_FRAMES.1);
    let frames = frames(&bounds.far).min(slow.max(MOST_FRAMES.0)).floor();
    (frames >= 2.0).then_some(frames)
}

/// Returns the weight of the pair's second place in a linear mix for `place`, 0 to 1. Returns `None` if `place` lies
/// before the first or past the second place, or farther from the line between them than the near bounds.
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

    /// Counts, over `frames` frames of a motion, the rows drawn ahead and the tables drawn whole. A frame draws tables
    /// whole where neither a pair nor the present tables serve the observer.
    fn drawn(frames: u32, motion: impl Fn(f64) -> ObserverPlace) -> (u32, u32) {
        let (mut course, mut tables, mut rows, mut whole) = (ObserverCourse::default(), None::<ObserverPlace>, 0, 0);
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
        // A camera that climbs by 5 cm in each frame draws the 40 rows of a table within 400 frames.
        let (rows, whole) = drawn(2400, |i| sun(10.0 + 0.05 * i, 0.7));
        assert!(whole <= 4 && (5 * ROWS..8 * ROWS).contains(&rows), "{rows} rows, {whole} whole");
        // The real sun, at 60 frames/s: 20 times the near bound of 2e-5 takes 333 frames, which draw 40 rows.
        let (rows, whole) = drawn(4000, |i| sun(10.0, 0.7 - 1.2e-6 * i));
        assert!(whole <= 3 && (8 * ROWS..16 * ROWS).contains(&rows), "{rows} rows, {whole} whole");
        // A motion whose speed varies from frame to frame, but whose places lie on one line.
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
        let mut course = ObserverCourse::default();
        let motion = |i: u32| sun(10.0, 0.7 - 8.7e-4 * f64::from(i));
        let at_last = (0..60).map(|i| course.follow(motion(i), Some(motion(i)), &BOUNDS, ROWS)).last();
        assert!(at_last.is_some_and(|step| step.share.is_some()));
        let with_moon = ObserverPlace { mu_s: [Some(0.6), Some(0.1)], ..motion(60) };
        assert_eq!(course.follow(with_moon, Some(motion(59)), &BOUNDS, ROWS), CourseStep::default());
    }
}
