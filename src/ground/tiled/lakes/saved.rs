//! Saved form of lakes.

use super::{Lakes, PitBelow};
use crate::terrain::{CellId, Terrain};

/// Element of a hollow's saved tree, a list in postfix order: a pit is a tree of its own, and `Joined` makes one tree
/// of the two trees before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LakeBranch {
    Pit(CellId),
    Joined,
}

impl Lakes {
    /// Returns the saved form of each lake: its tree and its volume.
    pub fn saved(&self) -> impl Iterator<Item = (Vec<LakeBranch>, f64)> {
        self.lakes.iter().flatten().map(|l| {
            let mut branches = Vec::new();
            let mut next = vec![(l.hollow, false)];
            while let Some((hollow, is_done)) = next.pop() {
                let Some(h) = self.hollows[hollow as usize].as_ref() else { continue };
                match h.parts {
                    Some(_) if is_done => branches.push(LakeBranch::Joined),
                    Some([a, b]) => next.extend([(hollow, true), (b, false), (a, false)]),
                    None => branches.extend(h.cells.first().map(|pit| LakeBranch::Pit(*pit))),
                }
            }
            (branches, l.held)
        })
    }

    /// Restores a saved lake. Returns whether it is valid on this terrain.
    pub fn restore(&mut self, terrain: &Terrain, pit_below: PitBelow<'_>, branches: &[LakeBranch], held: f64) -> bool {
        let mut stack: Vec<u32> = Vec::new();
        for branch in branches {
            match branch {
                LakeBranch::Pit(pit) => {
                    let (slot, at) = terrain.split(*pit);
                    if pit_below(*pit) != Some(*pit) || self.lake_of(slot, at).is_some() {
                        return false;
                    }
                    stack.push(self.lake_at(terrain, *pit));
                }
                LakeBranch::Joined => {
                    let (Some(b), Some(a)) = (stack.pop(), stack.pop()) else { return false };
                    let brim = [a, b].map(|lake| self.fill(terrain, lake, f64::MAX));
                    let to = |s: &Self, lake: u32| {
                        let pit = s.spills_to(lake).and_then(pit_below)?;
                        let (slot, at) = terrain.split(pit);
                        s.lake_of(slot, at)
                    };
                    if brim.contains(&0.0) || to(self, a) != Some(b) || to(self, b) != Some(a) {
                        return false;
                    }
                    stack.push(self.join(terrain, a, b));
                }
            }
        }
        let [lake] = stack[..] else { return false };
        let base = self.of(lake).map_or(f64::NAN, |(l, _)| l.held);
        let more = held - base;
        if !(held > 0.0 && more >= 0.0) || self.fill(terrain, lake, more) > 0.0 {
            return false;
        }
        // Sets the saved volume itself, since sums round.
        let level = self.of(lake).map_or(0.0, |(_, h)| h.level(held).0);
        if let Some(l) = self.lakes[lake as usize].as_mut() {
            (l.held, l.level_mm) = (held, level);
        }
        true
    }
}
