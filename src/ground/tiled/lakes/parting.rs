//! Loss of standing water: lakes sink, part at saddles, and are removed where the ground changes, with their water set
//! loose.

use super::{Hollow, Lake, Lakes, NONE, put};
use crate::terrain::{CellId, Terrain};

impl Lakes {
    /// Lowers every lake by `depth_mm`. Returns the water lost, mm times cells; `bared` receives the cells that fall
    /// dry.
    pub fn sink(&mut self, terrain: &Terrain, depth_mm: f64, bared: &mut Vec<CellId>) -> f64 {
        let all: Vec<u32> = (0..self.lakes.len() as u32).filter(|l| self.lakes[*l as usize].is_some()).collect();
        let (mut gone, mut losing) = (0.0, Vec::new());
        for lake in all {
            let lost = self.of(lake).map_or(0.0, |(l, h)| depth_mm * h.level(l.held).1);
            losing.push((lake, lost));
            while let Some((lake, lost)) = losing.pop() {
                gone += self.lose(terrain, lake, lost, &mut losing, bared);
            }
        }
        gone
    }

    /// Takes water from a lake, or from its parts once it has sunk below their saddle. Returns the amount taken from
    /// the lake itself; `losing` receives each part and the amount that it must lose.
    fn lose(
        &mut self,
        terrain: &Terrain,
        lake: u32,
        lost: f64,
        losing: &mut Vec<(u32, f64)>,
        bared: &mut Vec<CellId>,
    ) -> f64 {
        let Some((l, h)) = self.of(lake) else { return 0.0 };
        let (held, before_mm) = (l.held, l.level_mm);
        let left = held - lost;
        if left >= h.base && left > 0.0 {
            let level_mm = h.level(left).0;
            let dry = h.levels_mm.iter().zip(&h.cells).rev().take_while(|(mm, _)| **mm >= level_mm);
            bared.extend(dry.filter(|(mm, _)| **mm < before_mm).map(|(_, cell)| *cell));
            if let Some(l) = self.lakes[lake as usize].as_mut() {
                (l.held, l.level_mm) = (left, level_mm);
            }
            return lost;
        }
        let known = h.levels_mm.iter().zip(&h.cells);
        bared.extend(known.filter(|(mm, _)| **mm < before_mm).map(|(_, cell)| *cell));
        let (parts, base) = (h.parts, h.base);
        let Some(parts) = parts else {
            self.forget(terrain, lake);
            return held;
        };
        let apart = self.part(terrain, lake, parts);
        let capacity = |s: &Self, lake: u32| s.of(lake).map_or(0.0, |(l, _)| l.held);
        let cells = |s: &Self, lake: u32| s.of(lake).map_or(0.0, |(l, h)| h.level(l.held).1);
        let holding: Vec<(u32, f64)> =
            apart.into_iter().filter(|p| capacity(self, *p) > 0.0).map(|p| (p, cells(self, p))).collect();
        let all: f64 = holding.iter().map(|p| p.1).sum();
        losing.extend(holding.iter().map(|(part, cells)| (*part, (base - left) * cells / all)));
        for part in apart {
            if capacity(self, part) <= 0.0 {
                self.forget(terrain, part);
            }
        }
        held - base
    }

    /// Splits a lake into its two parts, each full to the saddle.
    fn part(&mut self, terrain: &Terrain, lake: u32, parts: [u32; 2]) -> [u32; 2] {
        let Some(whole) = self.lakes[lake as usize].take() else { return [lake; 2] };
        if let Some(h) = self.hollows[whole.hollow as usize].take() {
            h.cells.iter().for_each(|cell| self.own(terrain, *cell, NONE));
        }
        self.free_hollows.push(whole.hollow);
        let under = |s: &Self, part: u32| s.hollows[part as usize].as_ref().map_or(0.0, Hollow::cells_under);
        let (keeps, goes) =
            if under(self, parts[0]) >= under(self, parts[1]) { (parts[0], parts[1]) } else { (parts[1], parts[0]) };
        let full = |s: &Self, hollow: u32| {
            let h = s.hollows[hollow as usize].as_ref();
            let held = h.and_then(|h| h.close).map_or(0.0, |c| c.capacity);
            Lake { hollow, held, level_mm: h.map_or(0.0, |h| h.level(held).0), rim: None }
        };
        self.lakes[lake as usize] = Some(full(self, keeps));
        let other = full(self, goes);
        let other = put(&mut self.lakes, &mut self.free_lakes, other);
        self.count += 1;
        self.label(terrain, goes, other);
        [lake, other]
    }

    /// Removes a lake. `loose` receives the cells on which it stood, each with the depth of its water there, mm.
    pub fn let_loose(&mut self, terrain: &Terrain, lake: u32, loose: &mut Vec<(CellId, f64)>) {
        let Some((l, _)) = self.of(lake) else { return };
        let (level_mm, held, first) = (l.level_mm, l.held, loose.len());
        for part in self.tree(l.hollow) {
            let Some(h) = self.hollows[part as usize].as_ref() else { continue };
            let wet = h.cells.iter().zip(&h.levels_mm).filter(|(_, mm)| **mm < level_mm);
            loose.extend(wet.map(|(cell, mm)| (*cell, level_mm - mm)));
        }
        let found: f64 = loose[first..].iter().map(|w| w.1).sum();
        match loose[first..].first_mut() {
            Some(w) => w.1 += held - found,
            // The water is so thin that no cell lies below its rounded level: all of it goes to the pit.
            None => loose.extend(self.tree(l.hollow).first().and_then(|h| self.pit_of(*h)).map(|pit| (pit, held))),
        }
        self.forget(terrain, lake);
    }

    /// Returns all water.
    #[cfg(test)]
    pub fn total(&self) -> f64 {
        self.lakes.iter().flatten().map(|l| l.held).sum()
    }
}
