//! Host's contexts in shared mode: one for each window, all sharing objects with Welkin's one.
//!
//! A call comes from the window whose context is current, and that context must be current again afterwards. Only the
//! host's callback can make it so. A host whose callback knows only one window would draw into that window after a call
//! from another.

use super::{
    api::Api,
    mark::Mark,
    names::VERSION,
    switch::{Switch, WhichContext},
};
use crate::error::Result;

/// Contexts from which calls have come so far.
pub(super) struct Windows {
    marks: Vec<Mark>,
    last: Option<usize>,
}

impl Windows {
    /// Starts the list with the current context, in which the device is created.
    pub(super) fn new(host: &Api) -> Self {
        Self { marks: vec![Mark::leave(host)], last: Some(0) }
    }

    /// Records the context from which a call comes. If the last call came from another context, asks the host once to
    /// make its own context current, and checks that this is the context from which the call comes. It is also valid
    /// that no context is current.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] if the callback fails or makes another context current.
    pub(super) fn enter(&mut self, host: &Api, switch: Switch) -> Result<()> {
        if host.GetString(VERSION).is_null() {
            self.last = None;
            return Ok(());
        }
        let here = match self.marks.iter().position(|mark| mark.is_here(host)) {
            Some(here) => here,
            None => {
                self.marks.push(Mark::leave(host));
                self.marks.len() - 1
            }
        };
        if self.last.replace(here) == Some(here) {
            return Ok(());
        }
        switch.to(WhichContext::Host)?;
        let back = self.check_back(host);
        if back.is_err() {
            self.last = None;
        }
        back
    }

    /// Checks that the context from which the call came is current again.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] if another context is.
    pub(super) fn check_back(&self, host: &Api) -> Result<()> {
        match self.last {
            Some(last) if !self.marks[last].is_here(host) => Err(WhichContext::Host.refuse(
                "make the context current that was current when the call came, and made another window's current: keep \
                 for each thread which one it draws in",
            )),
            _ => Ok(()),
        }
    }

    /// Removes the marks, as far as the current context can reach them.
    pub(super) fn remove(&mut self, host: &Api) {
        for mark in self.marks.drain(..) {
            if mark.is_here(host) {
                mark.remove(host);
            } else {
                mark.remove_shared(host);
            }
        }
    }
}
