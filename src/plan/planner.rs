//! Planner of a view: decides from gauged pictures which parts are drawn, faded or left out.

use glam::{DVec2, DVec3};

use super::{
    budget::Budget,
    choice::{Choices, PlanDemands},
    estimate::Estimate,
    gauge::{EVERY, GRID, Gauge, GaugeSample},
    governor::{GaveWay, Governor, WorkAmount},
    parts::{MOST_PARTS, MOST_RUNGS, MOST_STEPS, Part, Reason, Set, StepWork, Worth},
};
use crate::{
    error::{Error, Result},
    gpu::Device,
    weather::Conditions,
};

/// A part of the weather in a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartPlan {
    /// Part that this entry plans.
    pub part: &'static Part,
    /// Rung at which the part is drawn once its fade has ended. For a part that was absent when the picture was gauged
    /// it is 0, the rung with all of the part, unless the host pinned the part.
    pub rung: usize,
    /// Share of the part that is drawn: 1 on its first rung, 0 on its last. It lies between them during a fade and on
    /// middle rungs.
    pub share: f32,
    /// Reason for the rung.
    pub reason: Reason,
    /// Error of the picture for each rung of this part, with every other part drawn in full, as last gauged. It is 0
    /// for the first rung.
    pub worth: [Estimate; MOST_RUNGS],
    /// Work that the whole part adds, or would add, to this picture with everything else, in units of the work of a
    /// pixel in which no part is drawn.
    pub work: f64,
    /// Number of steps that the part has gone down. During a fade it is not a whole number.
    depth: f32,
}

impl PartPlan {
    /// Returns the error of the picture with this part at its last rung and every other part drawn in full, as last
    /// gauged.
    pub fn last(&self) -> Estimate {
        self.worth[self.part.rungs.len() - 1]
    }
}

/// Plan of a view: what the view draws, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// One entry for each of [`frame::PARTS`](crate::frame::PARTS).
    pub parts: Vec<PartPlan>,
    /// Estimated error of everything that is left out together.
    pub error: Estimate,
    /// Work of the picture as planned, in units of the work of a pixel in which no part is drawn. It is 0 until the
    /// picture has been gauged.
    pub work: f64,
    /// Work of the picture with everything, in the units of `work`. It is 0 until the picture has been gauged.
    pub work_of_everything: f64,
    /// Predicted time of the picture, ms, by the times reported so far; `None` before the first report, and until the
    /// picture has been gauged.
    pub milliseconds: Option<f64>,
    /// Limit of the budget that could not be kept.
    pub gave_way: GaveWay,
}

impl Plan {
    /// Creates a plan that draws everything.
    fn of(parts: &'static [Part]) -> Self {
        let part = |part| PartPlan {
            part,
            rung: 0,
            share: 1.0,
            reason: Reason::EverythingAsked,
            worth: [Estimate::default(); MOST_RUNGS],
            work: 0.0,
            depth: 0.0,
        };
        Self {
            parts: parts.iter().map(part).collect(),
            error: Estimate::default(),
            work: 0.0,
            work_of_everything: 0.0,
            milliseconds: None,
            gave_way: GaveWay::Nothing,
        }
    }

    /// Resets what the plan says about the picture as a whole. The entries of the parts are kept.
    fn forget(&mut self) {
        (self.error, self.work, self.work_of_everything) = (Estimate::default(), 0.0, 0.0);
        (self.milliseconds, self.gave_way) = (None, GaveWay::Nothing);
    }

    /// Returns the rung of every part once its fade has ended ([`PartPlan::rung`]).
    pub fn rungs(&self) -> Vec<usize> {
        self.parts.iter().map(|p| p.rung).collect()
    }
}

/// Prediction for a frame, to be compared with measured values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prediction {
    /// Predicted time of the weather in this frame, ms; `None` before the first gauge, and before the first reported
    /// time.
    pub milliseconds: Option<f64>,
    /// Error of what this frame leaves out. A step that still fades counts as not taken. `None` before the first gauge.
    pub error: Option<Estimate>,
    /// For the newest gauged picture: the predicted bound of the error, and the error that the gauge measured. `None`
    /// if no error was predicted for that picture.
    pub checked: Option<[f64; 2]>,
}

/// Presence of a part in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PartNow {
    /// Whether the weather has the part and the recorded stages draw it.
    pub is_there: bool,
    /// Work of each of its steps.
    pub steps: [StepWork; MOST_RUNGS],
}

/// Presence of each part in a frame, and its cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Presence {
    /// Number of pixels of the picture.
    pub pixels: u64,
    /// Presence of each part, in the order of the list.
    pub parts: [PartNow; MOST_PARTS],
    /// Indices of two parts that cost extra work if both are drawn, and that work.
    pub together: ([usize; 2], StepWork),
}

impl Presence {
    /// Returns the work of the picture if the host drew something in every pixel.
    fn most_work(&self) -> f64 {
        let pixels = self.pixels as f64;
        let work = |step: &StepWork| step.object * pixels + step.fixed;
        let parts = self.parts.iter().filter(|p| p.is_there).flat_map(|p| &p.steps).map(work).sum::<f64>();
        let ([a, b], step) = &self.together;
        let together = if self.parts[*a].is_there && self.parts[*b].is_there { work(step) } else { 0.0 };
        pixels + parts + together
    }
}

/// Source of changes that the gauge cannot see, in closed form.
pub(crate) trait Unseen {
    /// Returns the relative change due to each step of a part, taken together with the steps above it, at pixel number
    /// `pixel` of the gauge, at `ndc`. Entries beyond the part's last step are ignored. `picture` is the exposed
    /// luminance there (1 = white), and the optical depth of the drops and flakes drawn one by one.
    fn change(&self, part: &Part, pixel: usize, ndc: DVec2, picture: [f64; 2]) -> [f32; MOST_RUNGS - 1];
}

/// Situation in which a picture was gauged. A picture in a very different situation needs another gauge.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Situation {
    /// Position of the camera in the host's world, m.
    pub position: DVec3,
    /// Unit vector along the camera's axis.
    pub forward: DVec3,
    /// Unit vector towards the sun.
    pub sun: DVec3,
    /// Conditions of the weather at the camera.
    pub conditions: Conditions,
}

/// Largest relative change of a quantity of the weather up to which a gauge stays valid. It applies to each quantity
/// that a picture shows. A part that the weather did not have at the gauge is drawn in any case.
const NEAR: f64 = 0.05;

impl Situation {
    /// Whether a gauge made in this situation is still valid in `other`.
    fn is_near(&self, other: &Self) -> bool {
        let reach = (0.02 * self.conditions.visibility_m()).max(20.0);
        self.position.distance(other.position) <= reach
            && self.forward.dot(other.forward) >= 0.97
            && self.sun.dot(other.sun) >= 0.9998
            && self.conditions.is_near(&other.conditions, NEAR)
    }

    /// Whether the next frame is a cut to a very different picture. All parts are then drawn in full at once, without a
    /// fade.
    fn is_cut(&self, next: &Self) -> bool {
        let (a, b) = (self.conditions.visibility_m(), next.conditions.visibility_m());
        self.position.distance(next.position) > (0.05 * a.min(b)).max(100.0)
            || self.forward.dot(next.forward) < 0.9
            || self.sun.dot(next.sun) < 0.998
            || a.max(b) > 1.2 * a.min(b)
    }
}

/// Gauge under way.
struct Gauging<U> {
    /// Situation of the gauged picture.
    there: Situation,
    /// Steps that were taken in the gauged picture.
    absent: Set,
    /// Predicted bound of the error of the gauged picture.
    bound: Option<f64>,
    /// Closed form of the changes that the gauge cannot see, if a part has any.
    unseen: Option<U>,
}

/// Shares of a build of the sky's tables (default settings) that one frame does. The first is the least share: tables
/// are not built in finer strips. The second is the usual share, for frames with time to spare. Such a frame does more
/// only if [`SLICE`] allows more.
const SHARE: (f64, f64) = (1.0 / 256.0, 1.0 / 80.0);
/// Largest work on the sky's tables in a frame, as a share of the picture's own work. If the usual share of a build
/// ([`SHARE`]) is more work, the usual share is the limit instead. A frame that works on tables takes less than 1.5
/// times as long as one that does not.
const SLICE: f64 = 0.3;

/// Largest relative change of a pixel in one frame while a part fades.
const FADE_STEP: f64 = 0.005;
/// Fewest and most frames in which a part fades by one step.
const FADE_FRAMES: (f64, f64) = (8.0, 128.0);

/// Planner of a view's pictures. `U` gives the changes that the gauge cannot see.
pub(crate) struct Planner<U> {
    /// Limits and wishes of the host.
    budget: Budget,
    /// Demands on a picture that follow from `budget`.
    demands: PlanDemands,
    /// Work of building the sky's default tables, in units of the work of a pixel in which no part is drawn.
    pub rebuild: f64,
    /// Work that the last picture with everything has if the host draws something in every pixel, in the units of
    /// `rebuild`; 0 before the first picture.
    work: f64,
    /// Gauge, created once a budget needs one.
    gauge: Option<Gauge>,
    /// Findings of the last gauge.
    choices: Choices,
    /// Predictor of times.
    governor: Governor,
    /// Gauge whose samples have not arrived yet.
    gauging: Option<Gauging<U>>,
    /// Situation of the gauge on which the present choice is based.
    planned: Option<Situation>,
    /// Situation of the last frame.
    last: Option<Situation>,
    /// Steps that the present choice takes.
    left_out: Set,
    /// Number of frames since the last gauge.
    frames: u32,
    /// Plan that the host can read.
    plan: Plan,
    /// Prediction for the last frame.
    prediction: Prediction,
}

impl<U: Unseen> Planner<U> {
    /// Creates a planner for a list of parts. `rebuild` is the work of building the sky's default tables, in units of
    /// the work of a pixel in which no part is drawn.
    pub fn new(parts: &'static [Part], rebuild: f64) -> Self {
        let mut planner = Self {
            rebuild,
            work: 0.0,
            budget: Budget::default(),
            demands: PlanDemands::default(),
            gauge: None,
            choices: Choices::new(parts),
            governor: Governor::default(),
            gauging: None,
            planned: None,
            last: None,
            left_out: 0,
            frames: 0,
            plan: Plan::of(parts),
            prediction: Prediction::default(),
        };
        planner.demands = planner.demands_of(&planner.budget);
        planner
    }

    /// Replaces the budget. A different budget begins a new plan.
    pub fn set_budget(&mut self, device: &Device, budget: Budget) -> Result<()> {
        budget.validate(self.choices.ladder.parts)?;
        if budget.gauges() && self.gauge.is_none() {
            self.gauge = Some(Gauge::new(device));
            self.choices.estimator.reserve((GRID.0 * GRID.1) as usize);
        }
        if budget != self.budget {
            self.forget();
            self.demands = self.demands_of(&budget);
            self.budget = budget;
        }
        Ok(())
    }

    /// Returns the demands on a picture by a budget.
    fn demands_of(&self, budget: &Budget) -> PlanDemands {
        let Budget { tolerance, milliseconds, .. } = *budget;
        let mut demands = PlanDemands { tolerance, milliseconds, ..PlanDemands::default() };
        let ladder = &self.choices.ladder;
        for (i, part) in ladder.parts.iter().enumerate() {
            let wish = budget.wishes.get(i).copied().unwrap_or_default();
            demands.importance[i] = wish.importance.unwrap_or(part.importance);
            if let Some(rung) = wish.rung {
                demands.pinned.0 |= ladder.whole(i);
                demands.pinned.1 |= ladder.set(i, rung);
            }
        }
        demands
    }

    /// Returns the limits and wishes of the host.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Returns the plan of the last frame.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the prediction for the last frame.
    pub fn prediction(&self) -> Prediction {
        self.prediction
    }

    /// Takes the time of the last frame, ms, in (0, 1e5]. The time is not used until the picture has been gauged.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a time outside this range.
    pub fn report_time(&mut self, milliseconds: f64) -> Result<()> {
        if !(milliseconds.is_finite() && milliseconds > 0.0 && milliseconds <= 1e5) {
            return Err(Error::range("milliseconds", "in (0, 1e5] ms", milliseconds));
        }
        if self.planned.is_some() {
            self.governor.report(milliseconds, &self.choices.all, self.absent());
        }
        Ok(())
    }

    /// Returns the steps that are taken in full: a step that still fades costs its whole work.
    fn absent(&self) -> Set {
        let ladder = &self.choices.ladder;
        let gone = |part: usize| ladder.set(part, self.plan.parts[part].depth as usize) & self.left_out;
        (0..ladder.parts.len()).fold(0, |set, part| set | gone(part))
    }

    /// Draws everything until the next gauge has been read back.
    fn forget(&mut self) {
        (self.planned, self.gauging, self.left_out, self.frames) = (None, None, 0, EVERY);
    }

    /// Begins a frame: reads the gauge, chooses, fades and predicts. `pure` means that the picture must not depend on
    /// earlier ones.
    pub fn begin(&mut self, device: &Device, here: &Situation, present: &Presence, pure: bool) {
        let mut pure = pure;
        self.work = present.most_work();
        if self.budget.gauges() {
            self.frames = self.frames.saturating_add(1);
            pure |= self.last.replace(*here).is_some_and(|last| last.is_cut(here));
            if pure || self.planned.as_ref().is_some_and(|p| !p.is_near(here)) {
                self.forget();
            }
            self.take_gauge(device, here, present);
        } else {
            self.prediction = Prediction::default();
            pure = true;
        }
        if self.planned.is_some() {
            self.choose(present);
        } else {
            self.plan.forget();
            let reason = if self.budget.gauges() { Reason::NotGauged } else { Reason::EverythingAsked };
            self.plan.parts.iter_mut().for_each(|p| (p.reason, p.rung) = (reason, 0));
        }
        self.pin();
        self.fade(present, pure);
        let absent = self.absent();
        let choices = &mut self.choices;
        let error = self.planned.as_ref().map(|_| choices.estimator.estimate(&choices.ladder, absent));
        let milliseconds = self.planned.as_ref().and_then(|_| self.governor.ms(&choices.all.without(absent)));
        (self.prediction.error, self.prediction.milliseconds) = (error, milliseconds);
    }

    /// Takes the gauge's samples, if they have arrived and the situation is still near that of the gauge.
    fn take_gauge(&mut self, device: &Device, here: &Situation, present: &Presence) {
        let Some(samples) = self.gauge.as_mut().and_then(|g| g.advance(device)) else { return };
        let Some(gauging) = self.gauging.take().filter(|g| g.there.is_near(here)) else { return };
        let choices = &mut self.choices;
        choices.see(samples, gauging.unseen.as_ref());
        let (all, there) = choices.weigh(samples, present, &mut self.plan);
        choices.take(all, there, &self.governor, &self.demands, self.left_out);
        for (i, part) in self.plan.parts.iter_mut().enumerate() {
            for (rung, step) in choices.ladder.steps(i).enumerate() {
                part.worth[rung + 1] = choices.worth[step];
            }
        }
        let found = choices.estimator.estimate(&choices.ladder, gauging.absent).p95;
        self.prediction.checked = gauging.bound.map(|bound| [bound, found]);
        self.planned = Some(gauging.there);
    }

    /// Moves pinned parts to their rungs at once, without a fade.
    fn pin(&mut self) {
        let (whole, set) = self.demands.pinned;
        self.left_out = self.left_out & !whole | set;
        let ladder = &self.choices.ladder;
        for (i, part) in self.plan.parts.iter_mut().enumerate().filter(|(i, _)| whole & ladder.whole(*i) != 0) {
            part.rung = ladder.rung(set, i);
            (part.depth, part.reason) = (part.rung as f32, Reason::Pinned);
            part.show();
        }
    }

    /// Moves each part that is not pinned by one frame towards its rung; with `pure` each part is drawn in full at
    /// once.
    fn fade(&mut self, present: &Presence, pure: bool) {
        let ladder = &self.choices.ladder;
        let planned = |i: &usize| self.demands.pinned.0 & ladder.whole(*i) == 0;
        for (i, part) in self.plan.parts.iter_mut().enumerate().filter(|(i, _)| planned(i)) {
            let wanted = if present.parts[i].is_there { ladder.rung(self.left_out, i) as f32 } else { 0.0 };
            if pure {
                part.depth = 0.0;
            } else if part.depth != wanted {
                // Rung to which the step under way leads down.
                let lower = if wanted > part.depth { part.depth.floor() + 1.0 } else { part.depth.ceil() } as usize;
                let worth = part.worth[lower.min(MOST_RUNGS - 1)];
                let p99 = worth.worst.min(2.0 * worth.p95);
                // If a pixel loses half of its light, the same change of its light is relatively twice as large at the
                // end of the fade.
                let frames = p99 / (FADE_STEP * (1.0 - p99).max(0.2));
                let step = 1.0 / frames.clamp(FADE_FRAMES.0, FADE_FRAMES.1) as f32;
                part.depth += (wanted - part.depth).clamp(-step, step);
            }
            part.show();
        }
    }

    /// Chooses again from the last gauge's findings, because a newly reported time may require another set in any
    /// frame.
    fn choose(&mut self, present: &Presence) {
        let (set, gave_way) = self.choices.choose(&self.governor, &self.demands, self.left_out);
        self.left_out = set;
        let choices = &mut self.choices;
        let amount = choices.all.without(set);
        self.plan.error = choices.estimator.estimate(&choices.ladder, set);
        let tolerance = self.demands.tolerance;
        let within = tolerance.is_some_and(|t| self.plan.error.keeps(t));
        for (i, part) in self.plan.parts.iter_mut().enumerate() {
            part.rung = choices.ladder.rung(set, i);
            part.reason = match (present.parts[i].is_there, part.rung > 0) {
                (false, _) => Reason::Absent,
                (true, true) if within => Reason::WithinTolerance,
                (true, true) => Reason::OutOfTime,
                (true, false) if tolerance.is_none() => Reason::EverythingAsked,
                (true, false) => Reason::Needed,
            };
        }
        self.plan.work = amount.total();
        self.plan.work_of_everything = choices.all.total();
        self.plan.milliseconds = self.governor.ms(&amount);
        self.plan.gave_way = gave_way;
    }

    /// Returns the share of a build of the sky's default tables for which a frame has time.
    pub fn share_of_tables(&self) -> f32 {
        let frame = self.governor.ms(&self.choices.all.without(self.absent()));
        let spare = self.budget.milliseconds.zip(frame).map(|(budget, ms)| budget - ms);
        let whole = self.governor.ms(&WorkAmount { pixels: self.rebuild, ..WorkAmount::default() });
        let most = (SLICE * self.work / self.rebuild).clamp(SHARE.1, 1.0);
        let share = spare.zip(whole).map_or(most, |(spare, whole)| (spare / whole).clamp(SHARE.0, most));
        share as f32
    }

    /// Returns the drawn share of what a part has at `rung` but not at the next lower rung.
    pub fn drawn_share(&self, part: usize, rung: usize) -> f32 {
        1.0 - (self.plan.parts[part].depth - rung as f32).clamp(0.0, 1.0)
    }

    /// Returns the number of compositions of the gauge. `unseen` adds one, for the stand-in of the parts whose change
    /// has a closed form.
    pub fn compositions(&self, unseen: bool) -> u32 {
        let channel = |part: &Part| if let Worth::Composed(channel) = part.worth { channel + 1 } else { 0 };
        let composed = self.choices.ladder.parts.iter().map(channel).max().unwrap_or(0);
        1 + composed as u32 + u32::from(unseen)
    }

    /// Returns the gauge if this frame should be gauged. `unseen` gives the changes that the gauge cannot see, if a
    /// part has any.
    pub fn due(&mut self, here: &Situation, unseen: impl FnOnce() -> Option<U>) -> Option<&mut Gauge> {
        let absent = self.absent();
        let gauge = self.gauge.as_mut()?;
        if !self.budget.gauges() || self.frames < EVERY || !gauge.is_idle() {
            return None;
        }
        let bound = self.prediction.error.map(|e| e.bound);
        self.gauging = Some(Gauging { there: *here, absent, bound, unseen: unseen() });
        self.frames = 0;
        Some(gauge)
    }
}

impl PartPlan {
    /// Sets the drawn share from the steps that the part has gone down.
    fn show(&mut self) {
        self.share = 1.0 - self.depth / (self.part.rungs.len() - 1) as f32;
    }
}

impl Choices {
    /// Takes the samples of the gauge, and adds the changes that the gauge cannot see.
    fn see(&mut self, samples: &[GaugeSample], unseen: Option<&impl Unseen>) {
        let half = |i: usize, n: u32| (i as f64 + 0.5) / f64::from(n) * 2.0 - 1.0;
        self.estimator.clear();
        for (i, sample) in samples.iter().enumerate().filter(|(_, s)| s.kind != 0.0) {
            let mut changes = [0.0; MOST_STEPS];
            for (part, spec) in self.ladder.parts.iter().enumerate() {
                let steps = self.ladder.steps(part);
                match (spec.worth, unseen) {
                    (Worth::Composed(channel) | Worth::Estimated(channel), _) => {
                        changes[steps].fill(sample.composed[channel])
                    }
                    (Worth::Unseen(channel), Some(unseen)) => {
                        let (x, y) = (i % GRID.0 as usize, i / GRID.0 as usize);
                        let ndc = DVec2::new(half(x, GRID.0), -half(y, GRID.1));
                        let found = unseen.change(spec, i, ndc, [sample.luminance, sample.hidden].map(f64::from));
                        let last = steps.end - 1;
                        changes[steps.clone()].copy_from_slice(&found[..steps.len()]);
                        changes[last] += sample.composed[channel];
                    }
                    // Without the closed form the change by the part's stand-in means nothing either.
                    (Worth::Unseen(_), None) => {}
                }
            }
            self.estimator.see(changes);
        }
    }

    /// Returns the work of the picture with everything, and the steps of the parts that are present. Writes the work of
    /// each part into the plan.
    fn weigh(&self, samples: &[GaugeSample], present: &Presence, plan: &mut Plan) -> (WorkAmount, Set) {
        let share = |kind: f32| samples.iter().filter(|s| s.kind == kind).count() as f64 / samples.len().max(1) as f64;
        let (objects, sky, pixels) = (share(1.0), share(-1.0), present.pixels as f64);
        let work = |step: &StepWork| (objects * step.object + sky * step.sky) * pixels + step.fixed;
        let mut all = WorkAmount { pixels, ..WorkAmount::default() };
        let mut there = 0;
        for (i, now) in present.parts[..self.ladder.parts.len()].iter().enumerate().filter(|(_, n)| n.is_there) {
            there |= self.ladder.whole(i);
            self.ladder.steps(i).zip(&now.steps).for_each(|(to, step)| all.steps[to] = work(step));
        }
        let ([a, b], step) = &present.together;
        if present.parts[*a].is_there && present.parts[*b].is_there {
            all.together = ([*a, *b].map(|part| self.ladder.steps(part).start), work(step));
        }
        for (i, (part, now)) in plan.parts.iter_mut().zip(&present.parts).enumerate() {
            let own = || now.steps[..self.ladder.steps(i).len()].iter().map(work).sum();
            part.work = if now.is_there { all.total() - all.without(self.ladder.whole(i)).total() } else { own() };
        }
        (all, there)
    }
}
