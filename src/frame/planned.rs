//! A view's budget and plan: what it may leave out of its pictures, and what it did.

use glam::DVec3;

use super::{Frame, View};
use crate::{
    context::Scene,
    error::{Error, Result, Status},
    fog,
    plan::{self, Budget, PartNow, Plan, Present, Price, Reason, Situation, parts::Part},
    rain, sky,
};

/// The parts of the weather that a picture may do with less of, in the order of every list of them.
pub const PARTS: &[Part] = &[sky::candidates::AIR, fog::candidates::FOG, sky::candidates::SKY, rain::candidates::RAIN];
/// Their places in the list.
pub(super) const AIR: usize = 0;
pub(super) const FOG: usize = 1;
pub(super) const SKY: usize = 2;
pub(super) const RAIN: usize = 3;

/// Which parts a picture has, its pixels, lamps and drops that are drawn one by one: what each part costs in it.
pub(super) fn present(parts: [bool; 4], pixels: u64, lamps: u32, drops: u32) -> Present {
    let mut present =
        Present { pixels, together: ([AIR, FOG], sky::candidates::air_before_fog_work(lamps)), ..Present::default() };
    let [cones, veil] = rain::candidates::rain_work(pixels, drops);
    let works = [
        [sky::candidates::air_work(lamps), Default::default()],
        [fog::candidates::FOG_WORK, Default::default()],
        [sky::candidates::sky_work(lamps), Default::default()],
        [cones, veil],
    ];
    for ((to, is_there), work) in present.parts.iter_mut().zip(parts).zip(works) {
        *to = PartNow { is_there, ..PartNow::default() };
        to.steps[..2].copy_from_slice(&work);
    }
    present
}

/// Work of building the sky's default tables, in pixels of a sky with these settings.
pub(super) fn rebuild_work(settings: &sky::SkySettings) -> f64 {
    let (work, price) = (sky::candidates::work, Price::default());
    work(&sky::SkySettings::default()).rebuild.at(&price) / work(settings).pixel.at(&price)
}

/// What a plan is saved with.
fn saved_with(sky: &sky::SkySettings) -> plan::Settings<'_> {
    plan::Settings {
        model: sky.model.name(),
        check_model: |name| sky::SkyModel::from_name(name).map(|_| ()),
        numbers: sky.numbers().to_vec(),
    }
}

/// What the planner compares pictures by.
pub(super) fn situation(frame: &Frame<'_>, scene: &Scene) -> Situation {
    let forward = frame.camera.rotation().transpose() * DVec3::NEG_Z;
    Situation { position: frame.camera.position, forward, sun: scene.sun.direction, conditions: scene.conditions }
}

impl View {
    /// Sets how wrong the view's pictures may be: what they do not need is left out from some frames later on. Unchanged
    /// after an error. Default: everything is drawn.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming the field and its range.
    pub fn set_budget(&mut self, budget: Budget) -> Result<()> {
        let device = self.device.clone();
        let _entered = device.enter()?;
        self.planner.set_budget(&device, budget)?;
        device.check()
    }

    /// Says what the weather took in the last frame, ms of whatever the host's budget counts (its GPU timer, or the
    /// waited call): under a budget of time the plan follows it.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] outside of (0, 1e5] ms; nothing changes then.
    pub fn report_time(&mut self, milliseconds: f64) -> Result<()> {
        self.planner.report_time(milliseconds)?;
        self.report.reported_ms = Some(milliseconds);
        Ok(())
    }

    /// The plan as text, for [`View::load_plan`] on other channels or another day: the parts that are drawn, and the sky's
    /// settings.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] while the view has a budget but has not gauged its picture yet: some frames follow each jump
    /// of camera, sun or weather.
    pub fn save_plan(&self) -> Result<String> {
        let plan = self.plan();
        if plan.parts.iter().any(|p| p.reason == Reason::NotGauged) {
            return Err(Error::new(Status::WrongOrder, "the plan is not made yet: this picture has not been gauged"));
        }
        Ok(plan::write(PARTS, &plan.rungs(), &saved_with(self.sky.settings())))
    }

    /// Pins a plan that [`View::save_plan`] wrote ([`plan::Wish::rung`]); the rest of the budget stays, and says what the
    /// plan does not keep. Unchanged after an error.
    ///
    /// # Errors
    /// [`Status::Parse`] for what is no such plan or of another version, naming line and column or the field;
    /// [`Status::InvalidArgument`] naming the setting of the sky in which the view's context differs.
    pub fn load_plan(&mut self, plan: &[u8]) -> Result<()> {
        let rungs = plan::read(plan, PARTS, &saved_with(self.sky.settings()))?;
        let mut budget = self.planner.budget().clone();
        budget.wishes.resize(PARTS.len(), plan::Wish::default());
        budget.wishes.iter_mut().zip(rungs).for_each(|(wish, rung)| wish.rung = Some(rung));
        self.set_budget(budget)
    }

    /// What the last frame drew of the weather, and why.
    pub fn plan(&self) -> &Plan {
        self.planner.plan()
    }
}
