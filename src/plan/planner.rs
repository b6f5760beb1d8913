//! A view's planner: from gauged pictures to parts that are drawn, faded or left out.

use glam::{DVec2, DVec3};

use super::{
    Price,
    gauge::{EVERY, GRID, Gauge},
    governor::{Amount, Choice, GaveWay, Governor, IMPORTANCE, SETS},
    parts::{Estimate, Estimator, GAUGED, PARTS, Part, Reason, Sample, is_possible},
};
use crate::{
    error::{Error, Result, check_range},
    gpu::Device,
    rain::Streaks,
    sky::SkySettings,
    weather::Conditions,
};

/// What a view may spend on a picture, and how wrong it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Largest error of what is left out, (0, 1]: 95th percentile over pixels of |Y' - Y| / (Y + 0.01 white) after
    /// exposure, and ten times as much at the worst pixel. Default `None`: everything is drawn. 0.01 is not seen.
    pub tolerance: Option<f64>,
    /// Longest time of the weather in a frame, ms, (0, 1000]: parts are left out as the times reported by
    /// [`View::report_time`](crate::frame::View::report_time) demand. It wins over the tolerance. Default `None`.
    pub milliseconds: Option<f64>,
    /// How much parts matter to those who look, [0, 1], in the order of [`Part::ALL`]: what is left out first under a
    /// budget of time. Default [`IMPORTANCE`].
    pub importance: [f64; PARTS],
    /// Draw just these parts, in the order of [`Part::ALL`], whatever the tolerance and the time, so that all channels of a
    /// simulator draw alike; what of these they do not keep is still said ([`Plan::gave_way`]). Default `None`: plan.
    pub pinned: Option<[bool; PARTS]>,
}

impl Budget {
    /// Refuses what is out of range, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        let above_zero = |name: &str, value: Option<f64>, most: f64| match value {
            Some(v) if !(v.is_finite() && v > 0.0 && v <= most) => {
                Err(Error::range(name, &format!("in (0, {most}]"), v))
            }
            _ => Ok(()),
        };
        above_zero("budget.tolerance", self.tolerance, 1.0)?;
        above_zero("budget.milliseconds", self.milliseconds, 1000.0)?;
        for (part, value) in Part::ALL.iter().zip(self.importance) {
            check_range(&format!("budget.importance of {}", part.name()), value, 0.0, 1.0, "")?;
        }
        Ok(())
    }

    /// Whether it asks what pictures show.
    fn gauges(&self) -> bool {
        self.tolerance.is_some() || self.milliseconds.is_some()
    }

    /// The parts that are pinned out, as a set.
    fn pinned_out(&self) -> Option<usize> {
        self.pinned.map(|drawn| (0..PARTS).filter(|i| !drawn[*i]).fold(0, |set, i| set | 1 << i))
    }
}

impl Default for Budget {
    fn default() -> Self {
        Self { tolerance: None, milliseconds: None, importance: IMPORTANCE, pinned: None }
    }
}

/// A part of the weather in a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartPlan {
    /// Which.
    pub part: Part,
    /// How much of it is drawn: 1 all, 0 nothing, between while it fades.
    pub share: f32,
    /// Why.
    pub reason: Reason,
    /// Error of the picture without this part alone, as last gauged.
    pub worth: Estimate,
    /// What it adds to the work of this picture with everything, or would, in units of a pixel with none of the parts.
    pub work: f64,
}

/// What a view draws, and why.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// One entry for each of [`Part::ALL`].
    pub parts: [PartPlan; PARTS],
    /// Estimated error of all that is left out together.
    pub error: Estimate,
    /// Work of the picture as planned, in units of a pixel with none of the parts.
    pub work: f64,
    /// Work of the picture with everything.
    pub work_of_everything: f64,
    /// What the picture should take, ms, by the times reported so far; `None` before the first.
    pub milliseconds: Option<f64>,
    /// What could not be kept of the budget.
    pub gave_way: GaveWay,
}

impl Plan {
    /// Which parts are drawn once they have faded, in the order of [`Part::ALL`]; a part that there is none of would be.
    pub fn drawn(&self) -> [bool; PARTS] {
        self.parts.map(|p| match p.reason {
            Reason::WithinTolerance | Reason::OutOfTime => false,
            Reason::Pinned => p.share > 0.0,
            _ => true,
        })
    }
}

/// What was predicted of a frame, to be held against what it was.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prediction {
    /// What the weather should take in this frame, ms; `None` before the first gauge, and before the first reported time.
    pub milliseconds: Option<f64>,
    /// Error of what this frame leaves out, parts that still fade not counted; `None` before the first gauge.
    pub error: Option<Estimate>,
    /// The newest gauge's picture: the bound that had been predicted for what it left out, and the error that was found.
    pub checked: Option<[f64; 2]>,
}

impl Default for Plan {
    fn default() -> Self {
        let part = |part| PartPlan {
            part,
            share: 1.0,
            reason: Reason::EverythingAsked,
            worth: Estimate::default(),
            work: 0.0,
        };
        Self {
            parts: Part::ALL.map(part),
            error: Estimate::default(),
            work: 0.0,
            work_of_everything: 0.0,
            milliseconds: None,
            gave_way: GaveWay::Nothing,
        }
    }
}

/// What a frame has of each part, and what each costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Present {
    /// Whether weather and stages draw it at all.
    pub parts: [bool; PARTS],
    pub pixels: u64,
    pub lamps: u32,
    /// Drops that are drawn one by one.
    pub drops: u32,
}

/// Work of a pixel, measured on a software driver (`cargo bench -- parts`) in units of a pixel with none of the parts:
/// air between and clear sky for one lamp and for each further one, fog as a layer, and the air before the fog.
const AIR: (f64, f64) = (0.4, 0.2);
const SKY: (f64, f64) = (0.07, 0.05);
const FOG: f64 = 0.26;
const AIR_BEFORE_FOG: f64 = 0.3;
/// The layer of rain, its cones and splashes, a pixel; and a drop of the lattice that is drawn one by one.
const RAIN: f64 = 0.4;
const DROP: f64 = 0.4;
/// Where the host drew nothing, the pixel's way to the air costs this share of it all the same.
const AIR_UNDRAWN: f64 = 0.6;

/// What a gauge was made of: a picture far from it needs another.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Situation {
    pub position: DVec3,
    pub forward: DVec3,
    pub sun: DVec3,
    pub conditions: Conditions,
}

impl Situation {
    /// Whether what was gauged there still says something here.
    fn is_near(&self, other: &Self) -> bool {
        let reach = (0.02 * self.conditions.visibility_m()).max(20.0);
        self.position.distance(other.position) <= reach
            && self.forward.dot(other.forward) >= 0.97
            && self.sun.dot(other.sun) >= 0.9998
            && self.conditions == other.conditions
    }

    /// Whether the next frame shows another picture altogether: nothing fades then.
    fn is_cut(&self, next: &Self) -> bool {
        let (a, b) = (self.conditions.visibility_m(), next.conditions.visibility_m());
        self.position.distance(next.position) > (0.05 * a.min(b)).max(100.0)
            || self.forward.dot(next.forward) < 0.9
            || self.sun.dot(next.sun) < 0.998
            || a.max(b) > 1.2 * a.min(b)
    }
}

/// A gauge under way: of which picture, which parts that leaves out, and the bound predicted for its error.
struct Gauging {
    there: Situation,
    absent: usize,
    bound: Option<f64>,
    /// What streaks of rain are worth in it, where they fall.
    streaks: Option<Streaks>,
}

/// Least and largest share of a build of the sky's tables with the default settings that one frame pays. Finer strips are
/// not cut; and the largest keeps a frame of 640 x 360 within half as much again on the software driver.
const SHARE: (f64, f64) = (1.0 / 256.0, 1.0 / 80.0);

/// A part changes a pixel by no more than this in a frame while it fades, and takes at least and at most so many frames.
const FADE_STEP: f64 = 0.005;
const FADE_FRAMES: (f64, f64) = (8.0, 128.0);

pub(crate) struct Planner {
    budget: Budget,
    /// Work of building the sky's default tables, in pixels with none of the parts.
    rebuild: f64,
    gauge: Option<Gauge>,
    estimator: Estimator,
    governor: Governor,
    gauging: Option<Gauging>,
    /// Of the gauge that the choices stand on.
    planned: Option<Situation>,
    last: Option<Situation>,
    /// Every set of parts that could be left out, as last gauged.
    choices: [Choice; SETS],
    /// Work of the picture with everything.
    all: Amount,
    left_out: usize,
    frames: u32,
    plan: Plan,
    prediction: Prediction,
}

impl Planner {
    pub fn new(sky: &SkySettings) -> Self {
        let (work, price) = (crate::sky::candidates::work, Price::default());
        Self {
            rebuild: work(&SkySettings::default()).rebuild.at(&price) / work(sky).pixel.at(&price),
            budget: Budget::default(),
            gauge: None,
            estimator: Estimator::new(0),
            governor: Governor::default(),
            gauging: None,
            planned: None,
            last: None,
            choices: [Choice::default(); SETS],
            all: Amount::default(),
            left_out: 0,
            frames: 0,
            plan: Plan::default(),
            prediction: Prediction::default(),
        }
    }

    pub fn set_budget(&mut self, device: &Device, budget: Budget) -> Result<()> {
        budget.validate()?;
        if budget.gauges() && self.gauge.is_none() {
            self.gauge = Some(Gauge::new(device));
        }
        if budget != self.budget {
            self.forget();
            self.budget = budget;
        }
        Ok(())
    }

    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Of the last frame.
    pub fn prediction(&self) -> Prediction {
        self.prediction
    }

    /// What the last frame took.
    pub fn report_time(&mut self, milliseconds: f64) -> Result<()> {
        if !(milliseconds.is_finite() && milliseconds > 0.0 && milliseconds <= 1e5) {
            return Err(Error::range("milliseconds", "in (0, 1e5] ms", milliseconds));
        }
        if self.planned.is_some() {
            self.governor.report(milliseconds, &self.all, self.absent());
        }
        Ok(())
    }

    /// The parts of which nothing is drawn: one that fades is paid whole.
    fn absent(&self) -> usize {
        let gone = |i: &usize| self.plan.parts[*i].share == 0.0 && self.left_out & (1 << i) != 0;
        (0..PARTS).filter(gone).fold(0, |set, i| set | 1 << i)
    }

    /// Draw everything until the next gauge answers.
    fn forget(&mut self) {
        (self.planned, self.gauging, self.left_out, self.frames) = (None, None, 0, EVERY);
    }

    /// Once a frame: takes a gauge's answer, chooses, fades, predicts. `pure`: the picture may not depend on earlier ones.
    pub fn begin(&mut self, device: &Device, here: &Situation, present: &Present, pure: bool) {
        let mut pure = pure;
        if self.budget.gauges() {
            self.frames = self.frames.saturating_add(1);
            pure |= self.last.replace(*here).is_some_and(|last| last.is_cut(here));
            if pure || self.planned.as_ref().is_some_and(|p| !p.is_near(here)) {
                self.forget();
            }
            self.take_gauge(device, here, present);
        } else {
            (self.plan, self.prediction) = (Plan::default(), Prediction::default());
        }
        if self.planned.is_some() {
            self.choose(present);
        } else if self.budget.gauges() {
            self.plan = Plan { parts: self.plan.parts, ..Plan::default() };
            self.plan.parts.iter_mut().for_each(|p| p.reason = Reason::NotGauged);
        }
        match self.budget.pinned_out() {
            Some(set) => self.pin_parts(set),
            None => self.fade(present, pure),
        }
        let absent = self.absent();
        self.prediction.milliseconds = self.planned.as_ref().and_then(|_| self.governor.ms(&self.all.without(absent)));
        self.prediction.error = self.planned.as_ref().map(|_| self.choices[absent].error);
    }

    /// Takes the gauge's answer, if it has come.
    fn take_gauge(&mut self, device: &Device, here: &Situation, present: &Present) {
        let Some(samples) = self.gauge.as_mut().and_then(|g| g.advance(device)) else { return };
        let Some(gauging) = self.gauging.take().filter(|g| g.there.is_near(here)) else { return };
        // Without streaks to say what they are worth, the veil in their place says nothing either.
        if let Some(streaks) = &gauging.streaks {
            see_streaks(samples, streaks);
        }
        let importance = self.budget.importance;
        let to = (&mut self.choices, &mut self.plan);
        self.all = weigh(&mut self.estimator, samples, present, importance, to);
        let found = self.choices[gauging.absent].error.p95;
        self.prediction.checked = gauging.bound.map(|bound| [bound, found]);
        self.planned = Some(gauging.there);
    }

    /// Parts appear and go at once where they are pinned.
    fn pin_parts(&mut self, out: usize) {
        self.left_out = out;
        for (i, part) in self.plan.parts.iter_mut().enumerate() {
            (part.share, part.reason) = (f32::from(u8::from(out & (1 << i) == 0)), Reason::Pinned);
        }
    }

    fn fade(&mut self, present: &Present, pure: bool) {
        for (i, part) in self.plan.parts.iter_mut().enumerate() {
            let p99 = part.worth.worst.min(2.0 * part.worth.p95);
            // A pixel that loses half of its light sees each step twice as large at the end.
            let frames = p99 / (FADE_STEP * (1.0 - p99).max(0.2));
            let step = 1.0 / frames.clamp(FADE_FRAMES.0, FADE_FRAMES.1) as f32;
            let left_out = self.left_out & (1 << i) != 0 && present.parts[i];
            part.share = if pure { 1.0 } else { (part.share + if left_out { -step } else { step }).clamp(0.0, 1.0) };
        }
    }

    /// Chooses anew among what was gauged last: a reported time may ask for another set in any frame.
    fn choose(&mut self, present: &Present) {
        let Budget { tolerance, milliseconds, .. } = self.budget;
        let (set, gave_way) = match self.budget.pinned_out() {
            Some(set) => (set, self.governor.judge(&self.choices[set], tolerance, milliseconds)),
            None => self.governor.choose(&self.choices, tolerance, milliseconds, self.left_out),
        };
        self.left_out = set;
        let chosen = self.choices[set];
        let within = tolerance.is_some_and(|t| chosen.error.keeps(t));
        for (i, part) in self.plan.parts.iter_mut().enumerate() {
            part.reason = match (present.parts[i], set & (1 << i) != 0) {
                (false, _) => Reason::Absent,
                (true, true) if within => Reason::WithinTolerance,
                (true, true) => Reason::OutOfTime,
                (true, false) if tolerance.is_none() => Reason::EverythingAsked,
                (true, false) => Reason::Needed,
            };
        }
        self.plan.error = chosen.error;
        self.plan.work = chosen.amount.total();
        self.plan.work_of_everything = self.all.total();
        self.plan.milliseconds = self.governor.ms(&chosen.amount);
        self.plan.gave_way = gave_way;
    }

    /// The share of a build of the sky's default tables that a frame has time for.
    pub fn share_of_tables(&self) -> f32 {
        let frame = self.governor.ms(&self.all.without(self.absent()));
        let spare = self.budget.milliseconds.zip(frame).map(|(budget, ms)| budget - ms);
        let whole = self.governor.ms(&Amount { pixels: self.rebuild, ..Amount::default() });
        let share = spare.zip(whole).map_or(SHARE.1, |(spare, whole)| (spare / whole).clamp(SHARE.0, SHARE.1));
        share as f32
    }

    /// How much of each part the frame draws, and how often the gauge composes.
    pub fn drawn(&self) -> [f32; 4] {
        let p = &self.plan.parts;
        [p[0].share, p[1].share, p[2].share, 1.0]
    }

    /// How often the gauge composes: with streaks of rain once more.
    pub fn compositions(rain: bool) -> u32 {
        1 + GAUGED as u32 + u32::from(rain)
    }

    /// How much of all rain is drawn as streaks, and how much of that near the camera drop by drop.
    pub fn rain(&self) -> [f32; 2] {
        [Part::Rain, Part::Drops].map(|p| self.plan.parts[p as usize].share)
    }

    /// The gauge, if this frame should be gauged.
    /// `streaks` says what rain is worth, if it falls.
    pub fn due(&mut self, here: &Situation, streaks: impl FnOnce() -> Option<Streaks>) -> Option<&mut Gauge> {
        let absent = self.absent();
        let gauge = self.gauge.as_mut()?;
        if !self.budget.gauges() || self.frames < EVERY || !gauge.is_idle() {
            return None;
        }
        let bound = self.prediction.error.map(|e| e.bound);
        self.gauging = Some(Gauging { there: *here, absent, bound, streaks: streaks() });
        self.frames = 0;
        Some(gauge)
    }
}

/// Adds what streaks are worth to samples row by row.
fn see_streaks(samples: &mut [Sample], streaks: &Streaks) {
    let half = |i: usize, n: u32| (i as f64 + 0.5) / f64::from(n) * 2.0 - 1.0;
    for (i, sample) in samples.iter_mut().enumerate().filter(|(_, s)| s.kind != 0.0) {
        let (x, y) = (i % GRID.0 as usize, i / GRID.0 as usize);
        let ndc = DVec2::new(half(x, GRID.0), -half(y, GRID.1));
        let [rain, drops] = streaks.change(i, ndc, [sample.luminance, sample.hidden].map(f64::from));
        sample.change[Part::Rain as usize] += rain;
        sample.change[Part::Drops as usize] = drops;
    }
}

/// Work and error of every set of parts, from a gauge's samples. The work of everything.
fn weigh(
    estimator: &mut Estimator,
    samples: &[Sample],
    present: &Present,
    importance: [f64; PARTS],
    (choices, plan): (&mut [Choice; SETS], &mut Plan),
) -> Amount {
    let share = |kind: f32| samples.iter().filter(|s| s.kind == kind).count() as f64 / samples.len().max(1) as f64;
    let (objects, sky, pixels) = (share(1.0), share(-1.0), present.pixels as f64);
    let lamps = f64::from(present.lamps.saturating_sub(1));
    let air = AIR.0 + AIR.1 * lamps;
    let air_and_sky = ((objects + AIR_UNDRAWN * sky) * air, sky * (SKY.0 + SKY.1 * lamps));
    let a_pixel = [air_and_sky.0, (objects + sky) * FOG, air_and_sky.1, RAIN, 0.0];
    let mut work = a_pixel.map(|w| w * pixels);
    work[Part::Drops as usize] = DROP * f64::from(present.drops);
    let both = present.parts[0] && present.parts[1];
    let before_fog = if both { (objects + sky) * AIR_BEFORE_FOG / AIR.0 * air * pixels } else { 0.0 };
    let all =
        Amount { pixels, parts: std::array::from_fn(|i| if present.parts[i] { work[i] } else { 0.0 }), before_fog };
    for (set, choice) in choices.iter_mut().enumerate() {
        choice.possible = is_possible(set, &present.parts);
        if choice.possible || set.count_ones() == 1 {
            choice.error = estimator.estimate(samples, set);
        }
    }
    for (i, part) in plan.parts.iter_mut().enumerate() {
        part.worth = choices[1 << i].error;
        part.work = if present.parts[i] { all.total() - all.without(1 << i).total() } else { work[i] };
    }
    for (set, choice) in choices.iter_mut().enumerate() {
        let parts = || (0..PARTS).filter(|i| set & (1 << i) != 0);
        choice.loss = parts().map(|i| importance[i] * plan.parts[i].worth.p95).sum();
        choice.amount = all.without(set);
    }
    all
}
