//! The host's contexts in shared mode: one a window, all sharing objects with Welkin's one.
//!
//! A call comes from the window whose context is current, and must go back to it; only the host's callback can make
//! that so. A host whose callback knows one window only would find itself drawing into that one after a call from
//! another.

use super::{
    api::Api,
    mark::Mark,
    names::VERSION,
    switch::{Switch, WhichContext},
};
use crate::error::Result;

/// The contexts that calls came from so far.
pub(super) struct Windows {
    marks: Vec<Mark>,
    last: Option<usize>,
}

impl Windows {
    /// Begins with the context that is current, the one that the device is made in.
    pub(super) fn new(host: &Api) -> Self {
        Self { marks: vec![Mark::leave(host)], last: Some(0) }
    }

    /// Notes which context a call comes from; where it is another than last time, asks the host to make its context
    /// current once, to see whether that is the same one. None need be current.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] if it is not.
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

    /// Whether the context is current again that the call came from.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] if another one is.
    pub(super) fn check_back(&self, host: &Api) -> Result<()> {
        match self.last {
            Some(last) if !self.marks[last].is_here(host) => Err(WhichContext::Host.refuse(
                "make the context current that was current when the call came, and made another window's current: keep \
                 for each thread which one it draws in",
            )),
            _ => Ok(()),
        }
    }

    /// Takes the marks off again, as far as the current context reaches.
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
