//! Undo and redo.

use crate::settings::Settings;

/// Largest number of steps that are kept.
const MOST: usize = 200;

/// States before and after the present one.
#[derive(Default)]
pub struct History {
    before: Vec<Settings>,
    after: Vec<Settings>,
    /// Whether the next change belongs to the last step, as while a slider is dragged.
    open: bool,
}

impl History {
    /// Notes a change away from `from`. Changes until [`Self::close`] are one step.
    pub fn note(&mut self, from: &Settings) {
        if !self.open {
            self.before.push(from.clone());
            if self.before.len() > MOST {
                self.before.remove(0);
            }
        }
        self.after.clear();
        self.open = true;
    }

    /// Ends a step.
    pub fn close(&mut self) {
        self.open = false;
    }

    /// Takes a step back. Returns whether there was one.
    pub fn undo(&mut self, now: &mut Settings) -> bool {
        self.open = false;
        let Some(before) = self.before.pop() else { return false };
        self.after.push(std::mem::replace(now, before));
        true
    }

    /// Takes a step back again. Returns whether there was one.
    pub fn redo(&mut self, now: &mut Settings) -> bool {
        self.open = false;
        let Some(after) = self.after.pop() else { return false };
        self.before.push(std::mem::replace(now, after));
        true
    }
}
