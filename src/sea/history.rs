//! The waves that the weather's timeline has raised until a given time: the growth law, integrated from change to
//! change.
//!
//! Between changes the law is in closed form. During a change the weather is taken at 64 times, which follow from the
//! change alone. The state at a time therefore depends neither on earlier calls nor on changes that begin later.
//!
//! The weather before all changes is taken to have lasted for ever. If the first change of all takes no time, the
//! weather after it is also taken to have lasted for ever, because a host begins with that weather.

use super::growth::{GrowthState, WaveForcing};
use crate::weather::Timeline;

/// Number of steps in which the law is integrated over a change.
const STEPS: f64 = 64.0;

/// A state and its simulation time, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DatedGrowth {
    pub time_s: f64,
    pub state: GrowthState,
}

/// Advances a state to a later time. No change begins or ends in between.
fn led(timeline: &Timeline, fetch_m: Option<f64>, start: &DatedGrowth, until_s: f64) -> GrowthState {
    // A change that has ended hides all earlier ones, which the timeline may forget at any time.
    let (_, changes) = timeline.parts();
    let shown = changes.iter().rposition(|c| c.end_s() <= start.time_s).map_or(0, |ended| ended + 1);
    let under_way = changes[shown..].iter().filter(|c| c.start_s <= start.time_s);
    let step_s = under_way.map(|c| (c.end_s() - c.start_s) / STEPS).fold(f64::INFINITY, f64::min);
    let forcing = |time_s: f64| WaveForcing::new(&timeline.at(time_s), fetch_m);
    if step_s.is_infinite() {
        let lasting = forcing(start.time_s);
        // A sea in the state of a weather that has lasted for ever stays the same to the last bit.
        let is_resting = start.state == GrowthState::lasting(&lasting);
        return if is_resting { start.state } else { start.state.after(&lasting, until_s - start.time_s) };
    }
    let mut state = start.state;
    for i in 0u32.. {
        let begin_s = start.time_s + f64::from(i) * step_s;
        if begin_s >= until_s {
            break;
        }
        let end_s = (start.time_s + f64::from(i + 1) * step_s).min(until_s);
        state = state.after(&forcing(begin_s), end_s - begin_s);
    }
    state
}

/// States at the time from which the timeline is known, and at the beginnings and ends of the changes after it, in
/// order. Ends of changes that a later change hides are left out.
#[derive(Clone, Debug, Default)]
pub(super) struct GrowthHistory {
    pub dated: Vec<DatedGrowth>,
}

impl GrowthHistory {
    /// Works out the states of a timeline. `kept` are states that were written down before the timeline forgot the
    /// changes that led to them.
    pub fn fill(&mut self, timeline: &Timeline, fetch_m: Option<f64>, kept: &[DatedGrowth]) {
        let (_, changes) = timeline.parts();
        let known_s = timeline.known_from_s();
        let lasting = |time_s: f64| DatedGrowth {
            time_s,
            state: GrowthState::lasting(&WaveForcing::new(&timeline.at(time_s), fetch_m)),
        };
        let found = kept.iter().find(|dated| dated.time_s == known_s);
        let first = found.copied().unwrap_or_else(|| lasting(known_s));
        self.dated.clear();
        self.dated.push(first);
        let is_hidden = |i: usize| changes[i + 1..].iter().any(|later| later.end_s() <= changes[i].end_s());
        let starts = changes.iter().map(|c| c.start_s);
        let ends = (0..changes.len()).filter(|i| !is_hidden(*i)).map(|i| changes[i].end_s());
        let times = starts.chain(ends).filter(|t| *t > known_s);
        self.dated.extend(times.map(|time_s| DatedGrowth { time_s, ..first }));
        self.dated.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        self.dated.dedup_by(|a, b| a.time_s == b.time_s);
        let begins = changes.first().filter(|c| timeline.known_since_ever() && c.start_s == c.end_s());
        let begin_s = begins.map(|c| c.start_s);
        for i in 1..self.dated.len() {
            let time_s = self.dated[i].time_s;
            let is_begin = begin_s == Some(time_s);
            self.dated[i] = if is_begin {
                lasting(time_s)
            } else {
                DatedGrowth { time_s, state: led(timeline, fetch_m, &self.dated[i - 1], time_s) }
            };
        }
    }

    /// Returns the state at a time; for a time before the first known one, the state at the first known time.
    pub fn at(&self, timeline: &Timeline, fetch_m: Option<f64>, time_s: f64) -> GrowthState {
        let after = self.dated.partition_point(|dated| dated.time_s <= time_s);
        match after.checked_sub(1) {
            None => self.dated[0].state,
            Some(before) => led(timeline, fetch_m, &self.dated[before], time_s),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{Sea, Weather, Wind, derive};

    fn blowing(speed: f64, from_deg: f64) -> crate::weather::Conditions {
        derive(&Weather { wind: Wind::of(speed, from_deg), ..Weather::default() }).expect("a weather")
    }

    fn at(timeline: &Timeline, kept: &[DatedGrowth], time_s: f64) -> GrowthState {
        let mut history = GrowthHistory::default();
        history.fill(timeline, None, kept);
        history.at(timeline, None, time_s)
    }

    #[test]
    fn a_lasting_wind_keeps_its_full_sea_at_all_times() {
        let timeline = Timeline::new(blowing(12.0, 240.0));
        let ever = GrowthState::lasting(&WaveForcing::new(&blowing(12.0, 240.0), None));
        for time in [-1e9, 0.0, 1e8] {
            assert_eq!(at(&timeline, &[], time), ever);
        }
    }

    #[test]
    fn the_sea_grows_continuously_and_whatever_changes_come_later() {
        let mut timeline = Timeline::new(blowing(0.0, 0.0));
        timeline.change(blowing(4.0, 270.0), 0.0, 0.0).unwrap();
        let begun = GrowthState::lasting(&WaveForcing::new(&blowing(4.0, 270.0), None));
        assert_eq!((at(&timeline, &[], -1.0).m0_m2, at(&timeline, &[], 0.0)), (0.0, begun));
        timeline.change(blowing(16.0, 300.0), 1000.0, 0.0).unwrap();
        timeline.change(blowing(9.0, 200.0), 20_000.0, 3600.0).unwrap();
        let before: Vec<_> = (0..60).map(|i| at(&timeline, &[], 400.0 * f64::from(i))).collect();
        assert!(before[50].m0_m2 > 4.0 * before[0].m0_m2, "it grows");
        let fine: Vec<_> = (0..3000).map(|i| at(&timeline, &[], 10.0 * f64::from(i))).collect();
        for pair in fine.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            assert!((b.m0_m2 - a.m0_m2).abs() < 0.01 * a.m0_m2 && (b.toward - a.toward).length() < 0.01, "{a:?} {b:?}");
            assert!((b.peak_rad_s / a.peak_rad_s - 1.0).abs() < 0.02, "{a:?} {b:?}");
        }
        // A later change leaves all times before it as they were, to the last bit.
        timeline.change(blowing(2.0, 10.0), 23_700.0, 600.0).unwrap();
        for (i, state) in before.iter().enumerate().take_while(|(i, _)| 400.0 * (*i as f64) < 23_700.0) {
            assert_eq!(at(&timeline, &[], 400.0 * i as f64), *state, "{i}");
        }
    }

    #[test]
    fn changes_that_the_timeline_forgets_still_shape_the_sea() {
        let mut timeline = Timeline::new(blowing(0.0, 0.0));
        timeline.change(blowing(4.0, 270.0), 0.0, 0.0).unwrap();
        timeline.change(blowing(16.0, 300.0), 1000.0, 600.0).unwrap();
        // A change of many hours that the next one hides.
        timeline.change(blowing(3.0, 100.0), 9000.0, 80_000.0).unwrap();
        timeline.change(blowing(9.0, 200.0), 20_000.0, 3600.0).unwrap();
        let times: Vec<f64> = (0..40).map(|i| 1600.0 + 777.0 * f64::from(i)).collect();
        let early = at(&timeline, &[], 500.0);
        let whole: Vec<_> = times.iter().map(|t| at(&timeline, &[], *t)).collect();
        let mut history = GrowthHistory::default();
        history.fill(&timeline, None, &[]);
        let kept = history.dated;
        timeline.advance(500.0);
        assert_eq!((timeline.known_from_s(), at(&timeline, &kept, 500.0)), (0.0, early));
        assert_eq!(at(&timeline, &kept, times[3]), whole[3]);
        timeline.advance(2000.0);
        assert_eq!(timeline.known_from_s(), 1600.0);
        for (time, state) in times.iter().zip(&whole) {
            assert_eq!(at(&timeline, &kept, *time), *state, "{time}");
        }
        timeline.advance(30_000.0);
        for (time, state) in times.iter().zip(&whole).filter(|(t, _)| **t >= 23_600.0) {
            assert_eq!(at(&timeline, &kept, *time), *state, "{time}");
        }
        // Without the kept states, the weather is taken to have lasted for ever, which gives a smaller sea.
        assert_ne!(at(&timeline, &[], 30_000.0), *whole.last().unwrap());
    }

    #[test]
    fn given_heights_replace_the_wind_s() {
        let sea = Sea { significant_wave_height_m: Some(3.0), ..Sea::default() };
        let given = derive(&Weather { wind: Wind::of(2.0, 0.0), sea, ..Weather::default() }).unwrap();
        let state = at(&Timeline::new(given), &[], 0.0);
        assert!((4.0 * state.m0_m2.sqrt() - 3.0).abs() < 1e-12 && state.given == 1.0, "{state:?}");
    }
}
