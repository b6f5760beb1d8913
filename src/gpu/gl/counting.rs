//! Checks for the host's conditional rendering and active queries, in the context in which Welkin draws.
//!
//! If the host renders conditionally and its query counted nothing, none of Welkin's draws is made, so tables that are
//! drawn once would stay empty. An active query of the host would count Welkin's samples. Neither can be suspended and
//! resumed. OpenGL reports whether a query is active (`GL_CURRENT_QUERY`). It does not report whether rendering is
//! conditional. But it is an error to begin conditional rendering twice (OpenGL 4.6 core specification, section 10.9),
//! so a trial shows whether it is.

use super::{
    api::Api,
    check::{GlInfo, GlProfile},
    names::*,
};
use crate::error::{Error, Result, Status};

/// Targets of queries that would count Welkin's draws, and their names.
const COUNTING: [(u32, &str); 4] = [
    (SAMPLES_PASSED, "GL_SAMPLES_PASSED"),
    (ANY_SAMPLES_PASSED, "GL_ANY_SAMPLES_PASSED"),
    (ANY_SAMPLES_PASSED_CONSERVATIVE, "GL_ANY_SAMPLES_PASSED_CONSERVATIVE"),
    (PRIMITIVES_GENERATED, "GL_PRIMITIVES_GENERATED"),
];

/// Checks made before Welkin draws in the host's own context.
pub(super) struct Counting {
    /// Query targets that this context has.
    targets: Vec<(u32, &'static str)>,
    /// Ended query for the trial; 0 if no trial is made. There is none on OpenGL ES, which has no conditional
    /// rendering, none if a query was active when the device was created, and none if trials are not reliable with this
    /// driver.
    trial: u32,
}

impl Counting {
    /// Creates the objects that the checks need. Leaves no error flag.
    pub(super) fn new(api: &Api, info: &GlInfo) -> Self {
        api.take_error();
        let is_known = |(target, _): &(u32, &str)| {
            active(api, *target);
            api.take_error() == NO_ERROR
        };
        let targets = COUNTING.iter().copied().filter(is_known).collect();
        let mut own = Self { targets, trial: 0 };
        if info.profile != GlProfile::Es && own.counts(api).is_none() {
            own.trial = api.one(Api::GenQueries);
            api.BeginQuery(ANY_SAMPLES_PASSED, own.trial);
            api.EndQuery(ANY_SAMPLES_PASSED);
            api.take_error();
        }
        own
    }

    /// Returns the name of an active query's target.
    fn counts(&self, api: &Api) -> Option<&'static str> {
        self.targets.iter().find(|(target, _)| active(api, *target)).map(|(_, name)| *name)
    }

    /// Whether rendering is conditional now.
    fn is_conditional(&self, api: &Api) -> bool {
        if self.trial == 0 {
            return false;
        }
        api.take_error();
        api.BeginConditionalRender(self.trial, QUERY_NO_WAIT);
        let is_conditional = api.take_error() == INVALID_OPERATION;
        if !is_conditional {
            api.EndConditionalRender();
        }
        is_conditional
    }

    /// Opens a device. If `trial` is 0 (a query was active, or the context is OpenGL ES), an active query is refused
    /// before `open` is called. Otherwise calls `open` even if the trial says that rendering is conditional: if it
    /// really is, nothing is drawn and opening fails. If opening succeeds all the same, trials are not reliable with
    /// this driver, and no more are made.
    ///
    /// # Errors
    /// The errors of [`Counting::allows`] and of `open`.
    pub(super) fn opens<T>(&mut self, api: &Api, open: impl FnOnce() -> Result<T>) -> Result<T> {
        let allowed = self.allows(api);
        if self.trial == 0 {
            allowed?;
            return open();
        }
        match (allowed, open()) {
            (Err(refusal), Err(_)) => Err(refusal),
            (Err(_), Ok(opened)) => {
                self.delete(api);
                Ok(opened)
            }
            (Ok(()), outcome) => outcome,
        }
    }

    /// Checks that Welkin may draw now. Must be called with the host's error flag saved and its debug output off.
    ///
    /// # Errors
    /// [`Status::WrongOrder`], which names what the host must end first.
    pub(super) fn allows(&self, api: &Api) -> Result<()> {
        let refuse = |text: String| Err(Error::new(Status::WrongOrder, text));
        if let Some(name) = self.counts(api) {
            return refuse(format!(
                "a query of target {name} is active and would count what Welkin draws: call glEndQuery before this call"
            ));
        }
        if self.is_conditional(api) {
            return refuse(
                "conditional rendering is active, in which nothing may be drawn: call glEndConditionalRender before this call"
                    .into(),
            );
        }
        Ok(())
    }

    pub(super) fn delete(&mut self, api: &Api) {
        api.delete(Api::DeleteQueries, std::mem::take(&mut self.trial));
    }
}

/// Whether a query of this target is active.
fn active(api: &Api, target: u32) -> bool {
    let mut current = 0;
    // SAFETY: one integer is written.
    unsafe { api.GetQueryiv(target, CURRENT_QUERY, &mut current) };
    current != 0
}
