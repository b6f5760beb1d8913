//! A view's planner: from gauged pictures to parts that are drawn, faded or left out.

use glam::DVec3;

use super::{
    gauge::{EVERY, Gauge},
    parts::{Chooser, Estimate, Part, Reason, Sample},
};
use crate::{
    error::{Error, Result},
    gpu::Device,
    weather::Conditions,
};

/// What a view may spend on a picture, and how wrong it may be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Budget {
    /// Largest error of what is left out, (0, 1]: 95th percentile over pixels of |Y' - Y| / (Y + 0.01 white) after
    /// exposure, and ten times as much at the worst pixel. Default `None`: everything is drawn. 0.01 is not seen.
    pub tolerance: Option<f64>,
    /// Draw just these parts, in the order of [`Part::ALL`], whatever the tolerance, so that all channels of a simulator
    /// draw alike. Default `None`: plan.
    pub pinned: Option<[bool; 3]>,
}

impl Budget {
    /// Refuses what is out of range, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        match self.tolerance {
            Some(t) if !(t.is_finite() && t > 0.0 && t <= 1.0) => Err(Error::range("budget.tolerance", "in (0, 1]", t)),
            _ => Ok(()),
        }
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
    /// Its work in this picture, were it drawn, in units of a pixel with none of the parts.
    pub work: f64,
}

/// What a view draws, and why.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// One entry for each of [`Part::ALL`].
    pub parts: [PartPlan; 3],
    /// Estimated error of all that is left out together.
    pub error: Estimate,
    /// Work of the picture as planned, in units of a pixel with none of the parts.
    pub work: f64,
    /// Work of the picture with everything.
    pub work_of_everything: f64,
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
        Self { parts: Part::ALL.map(part), error: Estimate::default(), work: 0.0, work_of_everything: 0.0 }
    }
}

/// What a frame has of each part, and what each costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Present {
    /// Whether weather and stages draw it at all.
    pub parts: [bool; 3],
    pub pixels: u64,
    pub lamps: u32,
}

/// Work of a pixel, measured on a software driver (`cargo bench -- parts`) in units of a pixel with none of the parts:
/// air between and clear sky for one lamp and for each further one, fog as a layer.
const AIR: (f64, f64) = (0.4, 0.2);
const SKY: (f64, f64) = (0.07, 0.05);
const FOG: f64 = 0.17;

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
}

/// A part fades in or out in so many frames.
const FADE_FRAMES: f32 = 8.0;

pub(crate) struct Planner {
    budget: Budget,
    gauge: Option<Gauge>,
    chooser: Chooser,
    /// Of the gauge under way, and of the one that the plan stands on.
    gauging: Option<Situation>,
    planned: Option<Situation>,
    left_out: usize,
    frames: u32,
    plan: Plan,
}

impl Planner {
    pub fn new() -> Self {
        Self {
            budget: Budget::default(),
            gauge: None,
            chooser: Chooser::new(0),
            gauging: None,
            planned: None,
            left_out: 0,
            frames: 0,
            plan: Plan::default(),
        }
    }

    pub fn set_budget(&mut self, device: &Device, budget: Budget) -> Result<()> {
        budget.validate()?;
        if budget.tolerance.is_some() && self.gauge.is_none() {
            self.gauge = Some(Gauge::new(device));
        }
        if budget != self.budget {
            self.forget();
            self.budget = budget;
        }
        Ok(())
    }

    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Draw everything until the next gauge answers.
    fn forget(&mut self) {
        (self.planned, self.gauging, self.left_out, self.frames) = (None, None, 0, EVERY);
    }

    /// Once a frame: takes a gauge's answer, chooses, fades. `pure`: the picture may not depend on earlier ones.
    pub fn begin(&mut self, device: &Device, here: &Situation, present: &Present, pure: bool) {
        if let Some(pinned) = self.budget.pinned {
            for (part, drawn) in self.plan.parts.iter_mut().zip(pinned) {
                (part.share, part.reason) = (f32::from(u8::from(drawn)), Reason::Pinned);
            }
            return;
        }
        let Some(tolerance) = self.budget.tolerance else {
            self.plan = Plan::default();
            return;
        };
        self.frames = self.frames.saturating_add(1);
        if pure || self.planned.as_ref().is_some_and(|p| !p.is_near(here)) {
            self.forget();
        }
        if let Some(gauge) = &mut self.gauge
            && let Some(samples) = gauge.advance(device)
            && let Some(there) = self.gauging.take()
            && !pure
            && there.is_near(here)
        {
            let chosen = estimate(&mut self.chooser, samples, present, tolerance, self.left_out);
            (self.left_out, self.plan) = (chosen.0, Plan { parts: shares(&self.plan, chosen.1.parts), ..chosen.1 });
            self.planned = Some(there);
        }
        for (i, part) in self.plan.parts.iter_mut().enumerate() {
            let left_out = self.left_out & (1 << i) != 0 && present.parts[i];
            if self.planned.is_none() {
                part.reason = Reason::NotGauged;
            }
            let step = if left_out { -1.0 / FADE_FRAMES } else { 1.0 / FADE_FRAMES };
            part.share = if pure { 1.0 } else { (part.share + step).clamp(0.0, 1.0) };
        }
    }

    /// How much of each part the frame draws, and how often the gauge composes.
    pub fn drawn(&self) -> [f32; 4] {
        let p = &self.plan.parts;
        [p[0].share, p[1].share, p[2].share, 1.0 + p.len() as f32]
    }

    /// The gauge, if this frame should be gauged.
    pub fn due(&mut self, here: &Situation) -> Option<&mut Gauge> {
        let gauge = self.gauge.as_mut()?;
        if self.budget.pinned.is_some() || self.budget.tolerance.is_none() || self.frames < EVERY || !gauge.is_idle() {
            return None;
        }
        (self.frames, self.gauging) = (0, Some(*here));
        Some(gauge)
    }
}

/// New choices keep the shares that the fade has reached.
fn shares(old: &Plan, mut new: [PartPlan; 3]) -> [PartPlan; 3] {
    new.iter_mut().zip(&old.parts).for_each(|(n, o)| n.share = o.share);
    new
}

/// Leaving out takes a tenth more certainty than staying out, so that a picture at the border does not flicker.
const HYSTERESIS: f64 = 0.9;

fn estimate(
    chooser: &mut Chooser,
    samples: &[Sample],
    present: &Present,
    tolerance: f64,
    before: usize,
) -> (usize, Plan) {
    let share = |kind: f32| samples.iter().filter(|s| s[3] == kind).count() as f64 / samples.len().max(1) as f64;
    let (objects, sky, pixels) = (share(1.0), share(-1.0), present.pixels as f64);
    let lamps = f64::from(present.lamps.saturating_sub(1));
    let work =
        [objects * (AIR.0 + AIR.1 * lamps), (objects + sky) * FOG, sky * (SKY.0 + SKY.1 * lamps)].map(|w| w * pixels);
    let chosen = chooser.choose(samples, present.parts, work, HYSTERESIS * tolerance);
    let kept = chooser.choose(samples, present.parts, work, tolerance);
    let left_out = if kept == before { before } else { chosen };
    let mut part = |i: usize| PartPlan {
        part: Part::ALL[i],
        share: 1.0,
        reason: match (present.parts[i], left_out & (1 << i) != 0) {
            (false, _) => Reason::Absent,
            (true, true) => Reason::WithinTolerance,
            (true, false) => Reason::Needed,
        },
        worth: chooser.estimate(samples, 1 << i),
        work: work[i],
    };
    let parts = [part(0), part(1), part(2)];
    let there = |i: &usize| present.parts[*i];
    let all: f64 = pixels + (0..3).filter(there).map(|i| work[i]).sum::<f64>();
    let saved: f64 = (0..3).filter(|i| left_out & (1 << i) != 0).map(|i| work[i]).sum();
    let error = chooser.estimate(samples, left_out);
    (left_out, Plan { parts, error, work: all - saved, work_of_everything: all })
}
