//! Budget and plan of a view: the parts that its pictures may leave out, and the parts that they do leave out.

use glam::DVec3;

use super::view::View;
use crate::{
    effects::{Effects, PARTS, together},
    error::{Error, Result, Status},
    moment::Scene,
    plan::{self, Budget, Plan, Presence, Reason, Situation, parts::Part},
    stage::{DrawContext, Frame, Stages},
};

/// Returns the parts that a picture of these stages has, with the work of the steps of each part and the extra work of
/// two parts drawn together.
pub(super) fn present(effects: &mut Effects, context: &DrawContext<'_>, stages: Stages) -> Presence {
    let place = |part: &Part| PARTS.iter().position(|p| p.name == part.name);
    let (pair, work) = together(&context.now.scene);
    let mut present = Presence { pixels: context.pixels(), ..Presence::default() };
    if let [Some(a), Some(b)] = pair.map(place) {
        present.together = ([a, b], work);
    }
    for effect in effects.each() {
        effect.parts(context, stages, &mut |part, is_there, steps| {
            if let Some(place) = place(part) {
                let now = &mut present.parts[place];
                now.is_there = is_there;
                now.steps[..steps.len()].copy_from_slice(steps);
            }
        });
    }
    present
}

/// Returns the camera, sun and weather by which the planner compares pictures.
pub(super) fn situation(frame: &Frame<'_>, scene: &Scene) -> Situation {
    let forward = frame.camera.rotation().transpose() * DVec3::NEG_Z;
    Situation { position: frame.camera.position, forward, sun: scene.sun.direction, conditions: scene.conditions }
}

impl View {
    /// Sets the limits for the view's pictures: their error and their time. After a few frames the view leaves out the
    /// parts that its pictures do not need. Default: everything is drawn.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`], which names the field and its range; the budget is then unchanged.
    /// [`Status::DeviceLost`], or a GPU fault.
    pub fn set_budget(&mut self, budget: Budget) -> Result<()> {
        let device = self.device.clone();
        let _entered = device.enter()?;
        self.planner.set_budget(&device, budget)?;
        device.check()
    }

    /// Reports the time that the weather took in the last frame, ms, measured in the way in which the host measures its
    /// budget (by its GPU timer, or by a call that waits). Under a budget of time the plan follows these reports.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] outside of (0, 1e5] ms; the view is then unchanged.
    pub fn report_time(&mut self, milliseconds: f64) -> Result<()> {
        self.planner.report_time(milliseconds)?;
        self.history.report.reported_ms = Some(milliseconds);
        Ok(())
    }

    /// Returns the plan as text, for [`View::load_plan`] on other channels or another day: the rung of each part, and
    /// the sky's settings.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] while the view has a budget but has not yet gauged its picture. Gauging takes some frames
    /// after each jump of camera, sun or weather.
    pub fn save_plan(&self) -> Result<String> {
        let plan = self.plan();
        if plan.parts.iter().any(|p| p.reason == Reason::NotGauged) {
            return Err(Error::new(Status::WrongOrder, "the plan is not made yet: this picture has not been gauged"));
        }
        Ok(plan::write(PARTS, &plan.rungs(), &self.effects.saved_with()))
    }

    /// Pins a plan that [`View::save_plan`] wrote ([`plan::PartWish::rung`]). The rest of the budget stays, and limits
    /// that the plan breaks are reported.
    ///
    /// # Errors
    /// [`Status::Parse`] for text that is not such a plan or has another version. Its message names line and column, or
    /// the field. [`Status::InvalidArgument`], which names the sky setting that differs in the view's context. After
    /// either of these two errors the budget is unchanged. [`Status::DeviceLost`], or a GPU fault.
    pub fn load_plan(&mut self, plan: &[u8]) -> Result<()> {
        let rungs = plan::read(plan, PARTS, &self.effects.saved_with())?;
        let mut budget = self.planner.budget().clone();
        budget.wishes.resize(PARTS.len(), plan::PartWish::default());
        budget.wishes.iter_mut().zip(rungs).for_each(|(wish, rung)| wish.rung = Some(rung));
        self.set_budget(budget)
    }

    /// Returns the plan of the last frame: which parts of the weather it drew, and why.
    pub fn plan(&self) -> &Plan {
        self.planner.plan()
    }
}
