//! Recent changes of a terrain. A reader that keeps a copy of the terrain's cells updates only the cells that changed.

use std::collections::VecDeque;

use super::CellRect;

/// Number of changes that are remembered. A reader that has missed an older change reads all cells anew.
const REMEMBERED: usize = 256;

/// Changed rectangles of cells, each with the terrain's revision after the change.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct RecentChanges(VecDeque<(u64, CellRect)>);

impl RecentChanges {
    /// Adds a change, and drops the oldest if there are more than [`REMEMBERED`].
    pub fn add(&mut self, revision: u64, rect: CellRect) {
        if self.0.len() == REMEMBERED {
            self.0.pop_front();
        }
        self.0.push_back((revision, rect));
    }

    /// Returns the rectangles that changed after revision `revision`; `None` if some of these changes are no longer
    /// remembered. `now` is the terrain's present revision.
    pub fn since(&self, revision: u64, now: u64) -> Option<impl Iterator<Item = CellRect> + '_> {
        let known = revision == now || self.0.front().is_some_and(|(first, _)| *first <= revision + 1);
        known.then(|| self.0.iter().filter(move |(at, _)| *at > revision).map(|(_, rect)| *rect))
    }
}
