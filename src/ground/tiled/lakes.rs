//! Standing water on tiles: hollows that are found as water rises in them, wherever tiles end.
//!
//! The water of a pit rises over its neighbours from the lowest up (the priority-flood of Barnes, Lehman and Mulla
//! 2014, of one hollow alone and no further than its water reaches) until the next cell has a lower neighbour on its
//! other side: a saddle. What comes then spills over it into the pit beyond. Where two full waters spill into each
//! other they become one, which rises from the saddle on; where it sinks below, they part (the hierarchy of hollows of
//! Barnes, Callaghan and Wickert 2020 and 2021, found from below). So ground is looked at where water stands, and
//! nowhere else: a change of the ground forgets the waters that it touches, and pours them anew.
//!
//! Water is counted in millimetres times cells. Cells of one height follow each other by their place, so that what is
//! found is the same for the same ground and water, however these came to be.

mod parting;
pub(super) mod saved;

use std::{cmp::Ordering, collections::BinaryHeap};

use super::drains::is_lower;
use crate::terrain::{CellId, Terrain};

/// No hollow.
const NONE: u32 = u32::MAX;

/// A cell at the rim of a water; the lowest is the greatest, for the heap.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rim {
    height_mm: f64,
    place: [i32; 2],
    cell: CellId,
}

impl Eq for Rim {}

impl Ord for Rim {
    fn cmp(&self, other: &Self) -> Ordering {
        let place = |r: &Self| (r.place[1], r.place[0]);
        other.height_mm.total_cmp(&self.height_mm).then_with(|| place(other).cmp(&place(self)))
    }
}

impl PartialOrd for Rim {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// How a hollow ends: what it holds then, and the cell beyond its saddle that it spills onto, if that is ground.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Close {
    capacity: f64,
    to: Option<CellId>,
}

/// A hollow as far as it is known.
#[derive(Clone, Debug)]
struct Hollow {
    /// The two that it became one of.
    parts: Option<[u32; 2]>,
    /// Cells of its own in the order in which water covers them, their heights, mm, and what it holds when it stands
    /// that high.
    cells: Vec<CellId>,
    levels_mm: Vec<f64>,
    held_at: Vec<f64>,
    /// Cells of its parts, what these hold, and the height at which it begins, mm.
    below: f64,
    base: f64,
    birth_mm: f64,
    close: Option<Close>,
}

/// A water: a hollow that is no part of another, and what it holds.
#[derive(Clone, Debug)]
struct Lake {
    hollow: u32,
    held: f64,
    level_mm: f64,
    /// Cells about those that are known; none where they have to be found again.
    rim: Option<BinaryHeap<Rim>>,
}

/// All standing water on a terrain.
#[derive(Clone, Debug, Default)]
pub(super) struct Lakes {
    hollows: Vec<Option<Hollow>>,
    free_hollows: Vec<u32>,
    lakes: Vec<Option<Lake>>,
    free_lakes: Vec<u32>,
    /// Numbers of lakes, by the number of the tile and then by cell: one more than the number of the cell's lake, or 0;
    /// empty for a tile without any.
    owners: Vec<Vec<u32>>,
    /// How many there are.
    pub count: usize,
}

/// Where water goes on from a cell: the pit that its run-off ends in; none off the terrain.
pub(super) type PitBelow<'a> = &'a dyn Fn(CellId) -> Option<CellId>;

fn height_mm(terrain: &Terrain, cell: CellId) -> f64 {
    f64::from(terrain.height(cell)) * 1e3
}

fn put<T>(list: &mut Vec<Option<T>>, free: &mut Vec<u32>, value: T) -> u32 {
    let place = free.pop().unwrap_or_else(|| {
        list.push(None);
        list.len() as u32 - 1
    });
    list[place as usize] = Some(value);
    place
}

impl Hollow {
    fn new(parts: Option<[u32; 2]>, part_cells: f64, base: f64, birth_mm: f64) -> Self {
        let (cells, levels_mm, held_at) = (Vec::new(), Vec::new(), Vec::new());
        Self { parts, cells, levels_mm, held_at, below: part_cells, base, birth_mm, close: None }
    }

    /// Level of the water, mm, and how many cells lie under it, when it holds `held`.
    fn level(&self, held: f64) -> (f64, f64) {
        if self.cells.is_empty() {
            return (self.birth_mm, self.below);
        }
        let own = self.held_at.partition_point(|h| *h <= held).max(1);
        let under = self.below + own as f64;
        (self.levels_mm[own - 1] + (held - self.held_at[own - 1]) / under, under)
    }

    /// Returns the water that it holds when the water stands at a height above all known cells.
    fn held_to(&self, level_mm: f64) -> f64 {
        let (held, from) = match (self.held_at.last(), self.levels_mm.last()) {
            (Some(held), Some(from)) => (*held, *from),
            _ => (self.base, self.birth_mm),
        };
        held + (self.below + self.cells.len() as f64) * (level_mm - from)
    }

    fn cells_under(&self) -> f64 {
        self.below + self.cells.len() as f64
    }
}

impl Lakes {
    /// Makes room for a tile's number, without any water.
    pub fn reserve(&mut self, slot: u32) {
        if self.owners.len() <= slot as usize {
            self.owners.resize(slot as usize + 1, Vec::new());
        }
    }

    /// The lake that a cell is known to lie in.
    pub fn lake_of(&self, slot: usize, cell: usize) -> Option<u32> {
        self.owners.get(slot)?.get(cell)?.checked_sub(1)
    }

    /// Level of a lake, mm.
    pub fn level_mm(&self, lake: u32) -> f64 {
        self.lake(lake).map_or(f64::NEG_INFINITY, |l| l.level_mm)
    }

    /// Whether any cell of a tile is known to lie in a lake.
    pub fn has_any(&self, slot: usize) -> bool {
        self.owners.get(slot).is_some_and(|o| !o.is_empty())
    }

    /// Whether standing water covers a cell of this height, m.
    pub fn is_under(&self, slot: usize, cell: usize, height_m: f32) -> bool {
        self.lake_of(slot, cell).is_some_and(|lake| self.level_mm(lake) > f64::from(height_m) * 1e3)
    }

    /// Cells under standing water.
    pub fn covered(&self) -> f64 {
        let lakes = (0..self.lakes.len() as u32).filter_map(|l| self.of(l));
        lakes.map(|(l, h)| h.level(l.held).1).sum()
    }

    /// Forgets of a tile that was taken away in which lakes its cells lay.
    pub fn clear(&mut self, slot: u32) {
        if let Some(owners) = self.owners.get_mut(slot as usize) {
            *owners = Vec::new();
        }
    }

    fn lake(&self, lake: u32) -> Option<&Lake> {
        self.lakes.get(lake as usize)?.as_ref()
    }

    /// A hollow of a lake and what the lake holds.
    fn of(&self, lake: u32) -> Option<(&Lake, &Hollow)> {
        let l = self.lake(lake)?;
        Some((l, self.hollows.get(l.hollow as usize)?.as_ref()?))
    }

    fn own(&mut self, terrain: &Terrain, cell: CellId, lake: u32) {
        let (slot, at) = terrain.split(cell);
        let owners = &mut self.owners[slot];
        if owners.is_empty() {
            owners.resize(terrain.side() * terrain.side(), 0);
        }
        owners[at] = lake.wrapping_add(1);
    }

    /// The lake of a pit, or a new one without water.
    fn lake_at(&mut self, terrain: &Terrain, pit: CellId) -> u32 {
        let (slot, at) = terrain.split(pit);
        if let Some(lake) = self.lake_of(slot, at) {
            return lake;
        }
        let mm = height_mm(terrain, pit);
        let hollow = put(&mut self.hollows, &mut self.free_hollows, Hollow::new(None, 0.0, 0.0, mm));
        self.begin(terrain, hollow, pit)
    }

    fn begin(&mut self, terrain: &Terrain, hollow: u32, pit: CellId) -> u32 {
        let level_mm = height_mm(terrain, pit);
        let first = Rim { height_mm: level_mm, place: terrain.place(pit), cell: pit };
        let rim = Some(BinaryHeap::from([first]));
        self.count += 1;
        let lake = put(&mut self.lakes, &mut self.free_lakes, Lake { hollow, held: 0.0, level_mm, rim });
        self.extend(terrain, lake);
        lake
    }

    /// Takes the next cell into a lake's hollow, or finds its saddle.
    fn extend(&mut self, terrain: &Terrain, lake: u32) {
        if self.lake(lake).is_some_and(|l| l.rim.is_none()) {
            self.find_rim(terrain, lake);
        }
        let mut rim = self.lakes[lake as usize].as_mut().and_then(|l| l.rim.take()).unwrap_or_default();
        let inside = |s: &Self, cell: CellId| {
            let (slot, at) = terrain.split(cell);
            s.lake_of(slot, at) == Some(lake)
        };
        while rim.peek().is_some_and(|r| inside(self, r.cell)) {
            rim.pop();
        }
        let Some(next) = rim.peek().copied() else { return };
        let around = terrain.around(next.cell);
        let beyond = around.iter().flatten().filter(|n| is_lower(terrain, **n, next.cell) && !inside(self, **n));
        let to = beyond.copied().reduce(|a, b| if is_lower(terrain, b, a) { b } else { a });
        let is_edge = around.contains(&None);
        if is_edge || to.is_some() {
            let to = if is_edge { None } else { to };
            self.change(lake, |h| h.close = Some(Close { capacity: h.held_to(next.height_mm), to }));
        } else {
            rim.pop();
            self.own(terrain, next.cell, lake);
            self.change(lake, |h| {
                let held = h.held_to(next.height_mm);
                h.cells.push(next.cell);
                h.levels_mm.push(next.height_mm);
                h.held_at.push(held);
            });
            for cell in around.into_iter().flatten().filter(|n| !inside(self, *n)) {
                rim.push(Rim { height_mm: height_mm(terrain, cell), place: terrain.place(cell), cell });
            }
        }
        if let Some(l) = self.lakes[lake as usize].as_mut() {
            l.rim = Some(rim);
        }
    }

    fn change(&mut self, lake: u32, edit: impl FnOnce(&mut Hollow)) {
        let hollow = self.lake(lake).map_or(NONE, |l| l.hollow);
        if let Some(h) = self.hollows.get_mut(hollow as usize).and_then(Option::as_mut) {
            edit(h);
        }
    }

    /// All hollows of a tree.
    fn tree(&self, hollow: u32) -> Vec<u32> {
        let (mut found, mut next) = (vec![hollow], 0);
        while next < found.len() {
            let parts = self.hollows[found[next] as usize].as_ref().and_then(|h| h.parts);
            found.extend(parts.into_iter().flatten());
            next += 1;
        }
        found
    }

    /// The cells about a lake whose rim was given away.
    fn find_rim(&mut self, terrain: &Terrain, lake: u32) {
        let Some(hollow) = self.lake(lake).map(|l| l.hollow) else { return };
        let mut rim = BinaryHeap::new();
        for part in self.tree(hollow) {
            for cell in self.hollows[part as usize].iter().flat_map(|h| &h.cells) {
                for near in terrain.around(*cell).into_iter().flatten() {
                    let (slot, at) = terrain.split(near);
                    if self.lake_of(slot, at) != Some(lake) {
                        rim.push(Rim { height_mm: height_mm(terrain, near), place: terrain.place(near), cell: near });
                    }
                }
            }
        }
        if let Some(l) = self.lakes[lake as usize].as_mut() {
            l.rim = Some(rim);
        }
    }

    /// Puts water into a lake until it spills. Answers what is left.
    fn fill(&mut self, terrain: &Terrain, lake: u32, water: f64) -> f64 {
        let short = |s: &Self| {
            s.of(lake).is_some_and(|(l, h)| {
                h.close.is_none() && h.held_at.last().is_none_or(|known| *known <= l.held + water)
            })
        };
        while short(self) {
            let before = self.of(lake).map(|(_, h)| h.cells.len());
            self.extend(terrain, lake);
            let Some((_, h)) = self.of(lake) else { return water };
            if h.close.is_none() && Some(h.cells.len()) == before {
                break;
            }
        }
        let Some((l, h)) = self.of(lake) else { return water };
        let room = h.close.map_or(f64::INFINITY, |c| c.capacity - l.held);
        let (held, left) = match h.close {
            Some(close) if water >= room => (close.capacity, water - room.max(0.0)),
            _ => (l.held + water, 0.0),
        };
        let level = h.level(held).0;
        if let Some(l) = self.lakes[lake as usize].as_mut() {
            (l.held, l.level_mm) = (held, level);
        }
        left
    }

    /// Onto which cell a full lake spills.
    fn spills_to(&self, lake: u32) -> Option<CellId> {
        let (l, h) = self.of(lake)?;
        h.close.filter(|c| l.held >= c.capacity)?.to
    }

    /// Pours water into a pit. Answers what leaves the terrain.
    pub fn pour(&mut self, terrain: &Terrain, pit_below: PitBelow<'_>, pit: CellId, water: f64) -> f64 {
        let mut lake = self.lake_at(terrain, pit);
        let mut left = self.fill(terrain, lake, water);
        if left <= 0.0 {
            return 0.0;
        }
        let mut made = vec![lake];
        while let Some(pit) = self.spills_to(lake).and_then(pit_below) {
            let next = self.lake_at(terrain, pit);
            if next == lake {
                break;
            }
            let back = self.spills_to(next).and_then(pit_below).map(|pit| terrain.split(pit));
            lake = if back.is_some_and(|(slot, at)| self.lake_of(slot, at) == Some(lake)) {
                self.join(terrain, lake, next)
            } else {
                next
            };
            made.push(lake);
            left = self.fill(terrain, lake, left);
            if left <= 0.0 {
                break;
            }
        }
        // What only passed on what came has no water.
        for lake in made {
            if self.lake(lake).is_some_and(|l| l.held <= 0.0) {
                self.forget(terrain, lake);
            }
        }
        left.max(0.0)
    }

    /// Makes one of two full waters that spill into each other.
    fn join(&mut self, terrain: &Terrain, a: u32, b: u32) -> u32 {
        for lake in [a, b] {
            if self.lake(lake).is_some_and(|l| l.rim.is_none()) {
                self.find_rim(terrain, lake);
            }
        }
        let cells = |s: &Self, lake: u32| s.of(lake).map_or(0.0, |(_, h)| h.cells_under());
        let (all, base) = (cells(self, a) + cells(self, b), [a, b].map(|l| self.lake(l).map_or(0.0, |l| l.held)));
        // The larger one keeps its number.
        let (keeps, gives) = if cells(self, a) >= cells(self, b) { (a, b) } else { (b, a) };
        let (Some(kept), Some(given)) = (self.lakes[keeps as usize].take(), self.lakes[gives as usize].take()) else {
            return a;
        };
        self.free_lakes.push(gives);
        self.count -= 1;
        let (mut rim, mut other) = (kept.rim.unwrap_or_default(), given.rim.unwrap_or_default());
        rim.append(&mut other);
        self.label(terrain, given.hollow, keeps);
        while rim.peek().is_some_and(|r| {
            let (slot, at) = terrain.split(r.cell);
            self.lake_of(slot, at) == Some(keeps)
        }) {
            rim.pop();
        }
        let birth_mm = rim.peek().map_or(kept.level_mm, |r| r.height_mm);
        // The order of the two is that of their pits, whoever was found first.
        let mut parts = [kept.hollow, given.hollow];
        parts.sort_by_key(|part| self.pit_of(*part).map(|pit| (terrain.place(pit)[1], terrain.place(pit)[0])));
        let whole = Hollow::new(Some(parts), all, base[0] + base[1], birth_mm);
        let hollow = put(&mut self.hollows, &mut self.free_hollows, whole);
        let held = base[0] + base[1];
        self.lakes[keeps as usize] = Some(Lake { hollow, held, level_mm: birth_mm, rim: Some(rim) });
        keeps
    }

    /// The first pit of a tree.
    fn pit_of(&self, mut hollow: u32) -> Option<CellId> {
        loop {
            let h = self.hollows[hollow as usize].as_ref()?;
            match h.parts {
                Some([first, _]) => hollow = first,
                None => return h.cells.first().copied(),
            }
        }
    }

    /// Says of all cells of a tree in which lake they lie.
    fn label(&mut self, terrain: &Terrain, hollow: u32, lake: u32) {
        for part in self.tree(hollow) {
            let cells = self.hollows[part as usize].as_mut().map(|h| std::mem::take(&mut h.cells)).unwrap_or_default();
            cells.iter().for_each(|cell| self.own(terrain, *cell, lake));
            if let Some(h) = self.hollows[part as usize].as_mut() {
                h.cells = cells;
            }
        }
    }

    fn forget(&mut self, terrain: &Terrain, lake: u32) {
        let Some(gone) = self.lakes[lake as usize].take() else { return };
        self.label(terrain, gone.hollow, NONE);
        for part in self.tree(gone.hollow) {
            self.hollows[part as usize] = None;
            self.free_hollows.push(part);
        }
        self.free_lakes.push(lake);
        self.count -= 1;
    }
}
