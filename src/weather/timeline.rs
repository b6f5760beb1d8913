//! The weather over time: changes that begin at absolute times and blend without a jump in value or in rate.

use serde::{Deserialize, Serialize};

use super::Conditions;
use crate::{
    error::{Error, Result, Status, check_range, toml_fault},
    numerics::smooth,
};

/// Longest transition, s: a year.
const MAX_TRANSITION_S: f64 = 3.2e7;
/// Largest distance of simulation time from 0, s.
pub(crate) const MAX_TIME_S: f64 = 1e10;
/// Time before every simulation time, s: the infinite past.
const EVER_S: f64 = -1e12;
/// Version number at the beginning of a saved timeline; increases when the format changes.
const VERSION: u32 = 1;
/// Maximum number of changes that are under way or still to come.
const MAX_CHANGES: usize = 1024;

/// Change of the weather to `to`, which begins at `start_s` and takes `transition_s`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Change {
    pub(crate) start_s: f64,
    transition_s: f64,
    pub(crate) to: Conditions,
}

impl Change {
    /// Returns the share of the change that has taken place at `t`: 3x^2 - 2x^3 with the elapsed share x of the
    /// transition. Its rate is 0 at both ends.
    pub(crate) fn share(&self, t: f64) -> f64 {
        if t >= self.end_s() {
            return 1.0;
        }
        smooth(((t - self.start_s) / self.transition_s).clamp(0.0, 1.0))
    }

    /// Returns the time at which the change ends, s.
    pub(crate) fn end_s(&self) -> f64 {
        self.start_s + self.transition_s
    }
}

/// Conditions as a function of simulation time. Two timelines with the same input give the same bits on every machine
/// (only + - * / and `libm` are used).
///
/// A change that begins while another is under way is blended over it: the older one continues while the share of the
/// newer one grows, so neither the weather nor its rate of change jumps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timeline {
    version: u32,
    /// Time of the last advance; nothing may be changed before it.
    now_s: f64,
    /// Time from which the history is known: the end of the last change that was forgotten.
    #[serde(default = "always", skip_serializing_if = "is_always")]
    known_from_s: f64,
    base: Conditions,
    #[serde(default)]
    changes: Vec<Change>,
}

fn always() -> f64 {
    EVER_S
}

fn is_always(time_s: &f64) -> bool {
    *time_s == always()
}

impl Timeline {
    /// Creates a timeline on which `base` holds for ever.
    pub fn new(base: Conditions) -> Self {
        Self { version: VERSION, now_s: EVER_S, known_from_s: always(), base, changes: Vec::new() }
    }

    /// Adds a change to `weather`, beginning at simulation time `start_s` (\[-1e10, 1e10\] s) and lasting
    /// `transition_s` (\[0, 3.2e7\] s; 0 is a cut).
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for a time out of range, which the message names, and for more than 1024 changes
    /// under way or to come. [`Status::WrongOrder`] if the change begins before the last update or before a change that
    /// was given earlier. After an error the timeline is as it was.
    pub fn change(&mut self, weather: Conditions, start_s: f64, transition_s: f64) -> Result<()> {
        check_range("start_time_s", start_s, -MAX_TIME_S, MAX_TIME_S, "s")?;
        check_range("transition_s", transition_s, 0.0, MAX_TRANSITION_S, "s")?;
        let earliest = self.changes.last().map_or(self.now_s, |c| c.start_s.max(self.now_s));
        if start_s < earliest {
            let rest = format!("must not lie before the last update or change at {earliest} s, got {start_s}");
            return Err(Error::about(Status::WrongOrder, "start_time_s", rest));
        }
        // If two cuts begin at the same time, the later call wins; the earlier one never shows.
        if self.changes.len() >= MAX_CHANGES {
            return Err(Error::range(
                "weather",
                &format!("one of at most {MAX_CHANGES} changes under way or to come"),
                "one more",
            ));
        }
        self.changes.push(Change { start_s, transition_s, to: weather });
        Ok(())
    }

    /// Returns the earliest simulation time for which the conditions are known, s: the end of the last change that
    /// [`advance`](Self::advance) has forgotten, or -1e12 if there is none.
    pub fn known_from_s(&self) -> f64 {
        self.known_from_s
    }

    /// Returns the conditions at simulation time `t`. Before [`known_from_s`](Self::known_from_s) every forgotten
    /// change is taken as complete.
    pub fn at(&self, t: f64) -> Conditions {
        let started = self.changes.iter().take_while(|c| c.start_s <= t);
        started.fold(self.base, |below, change| match change.share(t) {
            share if share >= 1.0 => change.to,
            share => below.lerp(&change.to, share),
        })
    }

    /// Whether the conditions at two times may differ.
    pub fn changes_between(&self, a: f64, b: f64) -> bool {
        let (a, b) = (a.min(b), a.max(b));
        self.changes.iter().any(|c| c.start_s <= b && c.end_s() >= a)
    }

    /// Whether `is_such` may hold for the conditions at some time from `a` to `b`. Blends into or out of such
    /// conditions count.
    pub fn is_ever_between(&self, a: f64, b: f64, is_such: impl Fn(&Conditions) -> bool) -> bool {
        let (a, b) = (a.min(b), a.max(b));
        let mut within = self.changes.iter().filter(|c| c.start_s <= b && c.end_s() >= a);
        within.any(|c| is_such(&c.to)) || is_such(&self.at(a))
    }

    /// Advances the present to `now_s` and forgets changes that ended before it. A time before the present has no
    /// effect.
    pub fn advance(&mut self, now_s: f64) {
        self.advance_keeping(now_s, now_s);
    }

    /// Advances as [`Timeline::advance`], but keeps the changes that end after `keep_s`, for readers that lag behind.
    pub fn advance_keeping(&mut self, now_s: f64, keep_s: f64) {
        self.now_s = self.now_s.max(now_s);
        if let Some(ended) = self.last_ended(now_s.min(keep_s)) {
            let change = &self.changes[ended];
            self.base = change.to;
            self.known_from_s = change.end_s();
            self.changes.drain(..=ended);
        }
    }

    /// Returns the index of the last change that has ended at `now_s`: it hides all earlier ones.
    fn last_ended(&self, now_s: f64) -> Option<usize> {
        self.changes.iter().rposition(|c| c.end_s() <= now_s && c.start_s <= now_s)
    }

    /// Returns the [`known_from_s`](Self::known_from_s) after an advance to `now_s`; `None` if the advance would forget
    /// no change.
    pub(crate) fn ends_before(&self, now_s: f64) -> Option<f64> {
        self.last_ended(now_s).map(|i| self.changes[i].end_s())
    }

    /// Whether nothing has been forgotten.
    pub(crate) fn known_since_ever(&self) -> bool {
        is_always(&self.known_from_s)
    }

    /// Returns the weather before all changes, and the changes in the order of their starts.
    pub(crate) fn parts(&self) -> (&Conditions, &[Change]) {
        (&self.base, &self.changes)
    }

    /// Returns the timeline as text (a seal, then TOML) for [`Timeline::load`]; numbers come back bit for bit.
    ///
    /// # Errors
    /// [`Status::Internal`] if a number cannot be written.
    pub fn save(&self) -> Result<String> {
        let body = toml::to_string(self);
        let body = body.map_err(|e| Error::new(Status::Internal, format!("the timeline cannot be written: {e}")))?;
        Ok(sealed(&body))
    }

    /// Loads a timeline from the text of [`Timeline::save`].
    ///
    /// # Errors
    /// [`Status::Parse`] for text of another version, cut short or changed.
    pub fn load(text: &str) -> Result<Self> {
        let parse = |e: &dyn std::fmt::Display| Error::new(Status::Parse, format!("saved timeline: {e}"));
        #[derive(Deserialize)]
        struct Head {
            version: u32,
        }
        let body = text.split_once('\n').map_or("", |(_, body)| body);
        let head: Head = toml::from_str(body).map_err(|e| parse(&toml_fault(body, &e)))?;
        if head.version != VERSION {
            return Err(parse(&format!("version must be {VERSION}, got {}", head.version)));
        }
        // A text that is cut between two changes, or inside its last number, is still valid TOML.
        if sealed(body) != text {
            return Err(parse(&"the text is cut short or changed: its seal does not fit"));
        }
        let timeline: Self = toml::from_str(body).map_err(|e| parse(&toml_fault(body, &e)))?;
        if let Some(line) = text.lines().position(|l| l.ends_with("nan") || l.ends_with("inf")) {
            return Err(parse(&format!("line {}: numbers must be finite", line + 1)));
        }
        let ordered = timeline.changes.windows(2).all(|w| w[0].start_s <= w[1].start_s);
        let finite = timeline
            .changes
            .iter()
            .all(|c| c.start_s.is_finite() && (0.0..=MAX_TRANSITION_S).contains(&c.transition_s));
        if !ordered || !finite || !timeline.known_from_s.is_finite() || timeline.changes.len() > MAX_CHANGES {
            return Err(parse(&"changes must be finite, in order of their starts, and no more than 1024"));
        }
        Ok(timeline)
    }
}

/// Returns `body` below a line with its FNV-1a hash, which reveals a cut text.
fn sealed(body: &str) -> String {
    let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    format!("# timeline {:016x}\n{body}", body.bytes().fold(0xcbf2_9ce4_8422_2325, fold))
}

#[cfg(test)]
mod tests {
    use super::super::{Weather, derive};
    use super::*;

    fn clear_and_fog() -> (Conditions, Conditions) {
        let clear = Weather { visibility_m: 10_000.0, ..Weather::default() };
        let fog = Weather { visibility_m: 150.0, ..Weather::default() };
        (derive(&clear).unwrap(), derive(&fog).unwrap())
    }

    #[test]
    fn a_change_is_monotone_without_jumps_and_even_to_the_eye() {
        let (clear, fog) = clear_and_fog();
        let mut timeline = Timeline::new(clear);
        timeline.change(fog, 100.0, 600.0).unwrap();
        assert_eq!((timeline.at(100.0), timeline.at(700.0)), (clear, fog));
        let seen = |i: u32| timeline.at(100.0 + f64::from(i)).visibility_m().ln();
        let whole = seen(600) - seen(0);
        let mut steepest = 0.0f64;
        for i in 0..600 {
            let step = (seen(i + 1) - seen(i)) / whole;
            assert!(step >= 0.0, "{i}: visibility turned back");
            steepest = steepest.max(step * 600.0);
        }
        assert!(steepest < 1.6, "the fastest second is 1.5 times the mean one, as smoothstep says: {steepest}");
    }

    #[test]
    fn fog_is_found_in_every_interval_in_which_it_blends_and_thunder_in_none() {
        let (clear, fog) = clear_and_fog();
        let mut timeline = Timeline::new(clear);
        timeline.change(fog, 100.0, 50.0).unwrap();
        timeline.change(clear, 300.0, 50.0).unwrap();
        let fogs = |c: &Conditions| c.extinction_per_m > 1.01 * clear.extinction_per_m;
        let ever = |a, b| timeline.is_ever_between(a, b, fogs);
        assert!(
            [(90.0, 100.0), (120.0, 130.0), (200.0, 210.0), (310.0, 320.0), (0.0, 500.0)]
                .iter()
                .all(|&(a, b)| ever(a, b))
        );
        assert!(!ever(0.0, 99.0) && !ever(350.0, 360.0));
        assert!(!timeline.is_ever_between(0.0, 500.0, |c| c.precipitation.thunder > 0.0), "changes bring no thunder");
    }

    #[test]
    fn an_interrupting_change_jumps_neither_in_value_nor_in_rate() {
        let (clear, fog) = clear_and_fog();
        let mut timeline = Timeline::new(clear);
        timeline.change(fog, 0.0, 100.0).unwrap();
        timeline.change(clear, 50.0, 100.0).unwrap();
        let f = |t: f64| timeline.at(t).extinction_per_m;
        let h = 1e-3;
        let (before, after) = ((f(50.0) - f(50.0 - h)) / h, (f(50.0 + h) - f(50.0)) / h);
        assert!(before > 1e-6 && (after / before - 1.0).abs() < 1e-2, "{before} {after}");
        assert_eq!(timeline.at(151.0), clear);
    }

    #[test]
    fn past_times_cannot_be_changed_and_ended_changes_are_forgotten() {
        let (clear, fog) = clear_and_fog();
        let mut timeline = Timeline::new(clear);
        timeline.change(fog, 10.0, 5.0).unwrap();
        let ahead = timeline.at(20.0);
        timeline.advance(20.0);
        assert_eq!(timeline.at(20.0), ahead);
        assert!(timeline.changes.is_empty() && !timeline.changes_between(20.0, 30.0));
        for (start, transition, name) in
            [(19.0, 0.0, "start_time_s"), (f64::NAN, 0.0, "start_time_s"), (30.0, -1.0, "transition_s")]
        {
            let e = timeline.change(clear, start, transition).unwrap_err();
            assert!(e.to_string().contains(name), "{e}");
            assert_eq!(e.status == Status::WrongOrder, start == 19.0);
        }
        timeline.change(clear, 30.0, 0.0).unwrap();
        assert_eq!((timeline.at(29.999), timeline.at(30.0)), (fog, clear));
    }

    #[test]
    fn a_saved_timeline_goes_on_bit_for_bit_and_damage_is_refused() {
        let (clear, fog) = clear_and_fog();
        let mut timeline = Timeline::new(clear);
        timeline.change(fog, 0.1, 60.0).unwrap();
        timeline.advance(7.3);
        let text = timeline.save().unwrap();
        let again = Timeline::load(&text).unwrap();
        assert_eq!(again, timeline);
        assert_eq!(again.at(33.3), timeline.at(33.3));
        let other = text.replacen("version = 1", "version = 2", 1);
        assert!(Timeline::load(&other).unwrap_err().to_string().contains("version must be 1"));
        for cut in 0..text.len() {
            let e = Timeline::load(&text[..cut]).expect_err("cut short");
            assert_eq!(e.status, Status::Parse, "cut at {cut}");
        }
        let changed = text.replacen("transition_s = 60.0", "transition_s = 61.0", 1);
        assert!(Timeline::load(&changed).unwrap_err().to_string().contains("seal"));
        let body = text.split_once('\n').unwrap().1;
        let broken = sealed(&body.replacen("transition_s = 60.0", "transition_s = nan", 1));
        assert!(Timeline::load(&broken).unwrap_err().to_string().contains("finite"));
    }
}
