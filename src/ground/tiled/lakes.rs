//! Standing water on tiles. Hollows are found as water rises in them, and may cross the borders between tiles.
//!
//! The water of a pit rises over its neighbours from the lowest up, until the next cell to be covered has a lower
//! neighbour outside the water. This cell is a saddle. Such a rise is the priority-flood (Barnes, Lehman and Mulla
//! 2014), restricted to one hollow and to the height of its water. Further water spills over the saddle into the pit
//! beyond. Two full lakes that spill into each other become one, which rises on from the saddle. When the water sinks
//! below the saddle, the lake parts into the two again. This builds the depression hierarchy of Barnes, Callaghan and
//! Wickert (2020 and 2021) from below, so the ground is examined only where water stands. After a change of the ground,
//! the lakes that it touches are removed and their water is poured again.
//!
//! Water is counted in millimetres times cells. Cells of equal height are ordered by place, so the same ground and
//! water give the same hollows, whatever their history.

mod parting;
pub(super) mod saved;

use std::{cmp::Ordering, collections::BinaryHeap};

use super::drains::is_lower;
use crate::terrain::{CellId, Terrain};

/// Index that means no hollow or lake.
const NONE: u32 = u32::MAX;

/// Cell at the rim of a lake. The lowest cell compares greatest, so that the heap returns it first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rim {
    /// Height of the cell, mm.
    height_mm: f64,
    /// Place of the cell on the lattice, cells east and north.
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

/// Saddle at which a hollow ends.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Close {
    /// Water in the hollow when it spills, mm times cells.
    capacity: f64,
    /// Cell beyond the saddle onto which the hollow spills; `None` if the water leaves the terrain there.
    to: Option<CellId>,
}

/// Hollow with the cells found so far.
#[derive(Clone, Debug)]
struct Hollow {
    /// Indices of the two hollows from which this one was joined; `None` for the hollow of one pit.
    parts: Option<[u32; 2]>,
    /// Cells of the hollow that belong to none of its parts, in the order in which water covers them.
    cells: Vec<CellId>,
    /// Heights of the cells in `cells`, mm.
    levels_mm: Vec<f64>,
    /// For each cell in `cells`, the water in the hollow when the level is at the cell's height, mm times cells.
    held_at: Vec<f64>,
    /// Number of cells of the hollow's parts.
    below: f64,
    /// Water that the hollow's parts hold when they are full, mm times cells.
    base: f64,
    /// Height at which the hollow begins, mm: that of its pit, or of the saddle where its parts meet.
    birth_mm: f64,
    /// Saddle at which the hollow ends; `None` until the saddle is found.
    close: Option<Close>,
}

/// Water that stands in a hollow and is not part of a larger lake.
#[derive(Clone, Debug)]
struct Lake {
    /// Index of the hollow.
    hollow: u32,
    /// Volume, mm times cells.
    held: f64,
    /// Height of the water's surface, mm.
    level_mm: f64,
    /// Cells beside the known cells of the hollow, lowest first; `None` if they must be found again.
    rim: Option<BinaryHeap<Rim>>,
}

/// Standing water on a terrain.
#[derive(Clone, Debug, Default)]
pub(super) struct Lakes {
    /// Hollows, by index; `None` for a free place.
    hollows: Vec<Option<Hollow>>,
    /// Indices of the free places in `hollows`.
    free_hollows: Vec<u32>,
    /// Lakes, by index; `None` for a free place.
    lakes: Vec<Option<Lake>>,
    /// Indices of the free places in `lakes`.
    free_lakes: Vec<u32>,
    /// Lake of each cell, by the tile's slot and then by cell: the index of the lake plus 1, or 0 for none. Empty for a
    /// tile in which no lake has stood.
    owners: Vec<Vec<u32>>,
    /// Number of lakes.
    pub count: usize,
}

/// Function that returns the pit in which the run-off of a cell ends, or `None` if it leaves the terrain.
pub(super) type PitBelow<'a> = &'a dyn Fn(CellId) -> Option<CellId>;

/// Returns the height of a cell, mm.
fn height_mm(terrain: &Terrain, cell: CellId) -> f64 {
    f64::from(terrain.height(cell)) * 1e3
}

/// Puts a value into a free place of a list. Returns its index.
fn put<T>(list: &mut Vec<Option<T>>, free: &mut Vec<u32>, value: T) -> u32 {
    let place = free.pop().unwrap_or_else(|| {
        list.push(None);
        list.len() as u32 - 1
    });
    list[place as usize] = Some(value);
    place
}

impl Hollow {
    /// Creates a hollow of which no cells of its own are known yet. Its `parts` have `part_cells` known cells, and hold
    /// `base`, mm times cells, at the level `birth_mm`. Without parts `birth_mm` is the height of the pit.
    fn new(parts: Option<[u32; 2]>, part_cells: f64, base: f64, birth_mm: f64) -> Self {
        let (cells, levels_mm, held_at) = (Vec::new(), Vec::new(), Vec::new());
        Self { parts, cells, levels_mm, held_at, below: part_cells, base, birth_mm, close: None }
    }

    /// Returns the water level, mm, and the number of cells under water, when the hollow holds `held`, mm times cells.
    fn level(&self, held: f64) -> (f64, f64) {
        if self.cells.is_empty() {
            return (self.birth_mm, self.below);
        }
        let own = self.held_at.partition_point(|h| *h <= held).max(1);
        let under = self.below + own as f64;
        (self.levels_mm[own - 1] + (held - self.held_at[own - 1]) / under, under)
    }

    /// Returns the water in the hollow, mm times cells, at a level that is not below any of its known cells.
    fn held_to(&self, level_mm: f64) -> f64 {
        let (held, from) = match (self.held_at.last(), self.levels_mm.last()) {
            (Some(held), Some(from)) => (*held, *from),
            _ => (self.base, self.birth_mm),
        };
        held + (self.below + self.cells.len() as f64) * (level_mm - from)
    }

    /// Returns the number of known cells of the hollow and of its parts.
    fn cells_under(&self) -> f64 {
        self.below + self.cells.len() as f64
    }
}

impl Lakes {
    /// Makes room for the cells of a tile.
    pub fn reserve(&mut self, slot: u32) {
        if self.owners.len() <= slot as usize {
            self.owners.resize(slot as usize + 1, Vec::new());
        }
    }

    /// Returns the lake to whose known cells a cell belongs. The cell may lie above the lake's level.
    pub fn lake_of(&self, slot: usize, cell: usize) -> Option<u32> {
        self.owners.get(slot)?.get(cell)?.checked_sub(1)
    }

    /// Returns the level of a lake, mm; negative infinity if there is none.
    pub fn level_mm(&self, lake: u32) -> f64 {
        self.lake(lake).map_or(f64::NEG_INFINITY, |l| l.level_mm)
    }

    /// Returns whether any cell of a tile may lie in a lake.
    pub fn has_any(&self, slot: usize) -> bool {
        self.owners.get(slot).is_some_and(|o| !o.is_empty())
    }

    /// Returns whether standing water covers a cell of this height, m.
    pub fn is_under(&self, slot: usize, cell: usize, height_m: f32) -> bool {
        self.lake_of(slot, cell).is_some_and(|lake| self.level_mm(lake) > f64::from(height_m) * 1e3)
    }

    /// Returns the number of cells under standing water.
    pub fn covered(&self) -> f64 {
        let lakes = (0..self.lakes.len() as u32).filter_map(|l| self.of(l));
        lakes.map(|(l, h)| h.level(l.held).1).sum()
    }

    /// Forgets in which lakes the cells of a removed tile lay.
    pub fn clear(&mut self, slot: u32) {
        if let Some(owners) = self.owners.get_mut(slot as usize) {
            *owners = Vec::new();
        }
    }

    /// Returns the lake with an index; `None` if it no longer exists.
    fn lake(&self, lake: u32) -> Option<&Lake> {
        self.lakes.get(lake as usize)?.as_ref()
    }

    /// Returns a lake and its hollow.
    fn of(&self, lake: u32) -> Option<(&Lake, &Hollow)> {
        let l = self.lake(lake)?;
        Some((l, self.hollows.get(l.hollow as usize)?.as_ref()?))
    }

    /// Marks a cell as lying in a lake; with [`NONE`], in none.
    fn own(&mut self, terrain: &Terrain, cell: CellId, lake: u32) {
        let (slot, at) = terrain.split(cell);
        let owners = &mut self.owners[slot];
        if owners.is_empty() {
            owners.resize(terrain.side() * terrain.side(), 0);
        }
        owners[at] = lake.wrapping_add(1);
    }

    /// Returns the lake of a pit; creates one without water if there is none.
    fn lake_at(&mut self, terrain: &Terrain, pit: CellId) -> u32 {
        let (slot, at) = terrain.split(pit);
        if let Some(lake) = self.lake_of(slot, at) {
            return lake;
        }
        let mm = height_mm(terrain, pit);
        let hollow = put(&mut self.hollows, &mut self.free_hollows, Hollow::new(None, 0.0, 0.0, mm));
        self.begin(terrain, hollow, pit)
    }

    /// Creates a lake without water in a new hollow whose pit is `pit`.
    fn begin(&mut self, terrain: &Terrain, hollow: u32, pit: CellId) -> u32 {
        let level_mm = height_mm(terrain, pit);
        let first = Rim { height_mm: level_mm, place: terrain.place(pit), cell: pit };
        let rim = Some(BinaryHeap::from([first]));
        self.count += 1;
        let lake = put(&mut self.lakes, &mut self.free_lakes, Lake { hollow, held: 0.0, level_mm, rim });
        self.extend(terrain, lake);
        lake
    }

    /// Adds the lowest cell of a lake's rim to the lake's hollow or, if that cell is the hollow's saddle, closes the
    /// hollow.
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

    /// Applies `edit` to a lake's hollow.
    fn change(&mut self, lake: u32, edit: impl FnOnce(&mut Hollow)) {
        let hollow = self.lake(lake).map_or(NONE, |l| l.hollow);
        if let Some(h) = self.hollows.get_mut(hollow as usize).and_then(Option::as_mut) {
            edit(h);
        }
    }

    /// Returns a hollow and all parts in its tree.
    fn tree(&self, hollow: u32) -> Vec<u32> {
        let (mut found, mut next) = (vec![hollow], 0);
        while next < found.len() {
            let parts = self.hollows[found[next] as usize].as_ref().and_then(|h| h.parts);
            found.extend(parts.into_iter().flatten());
            next += 1;
        }
        found
    }

    /// Finds the cells around a lake whose rim was dropped.
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

    /// Fills `water`, mm times cells, into a lake until the lake is full. Returns the rest.
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

    /// Returns the cell onto which a lake spills; `None` if it is not full or its water leaves the terrain.
    fn spills_to(&self, lake: u32) -> Option<CellId> {
        let (l, h) = self.of(lake)?;
        h.close.filter(|c| l.held >= c.capacity)?.to
    }

    /// Pours water into a pit. Returns the amount that leaves the terrain.
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
        // A lake that only passed its water on holds none.
        for lake in made {
            if self.lake(lake).is_some_and(|l| l.held <= 0.0) {
                self.forget(terrain, lake);
            }
        }
        left.max(0.0)
    }

    /// Joins two full lakes that spill into each other. Returns the index of the joined lake.
    fn join(&mut self, terrain: &Terrain, a: u32, b: u32) -> u32 {
        for lake in [a, b] {
            if self.lake(lake).is_some_and(|l| l.rim.is_none()) {
                self.find_rim(terrain, lake);
            }
        }
        let cells = |s: &Self, lake: u32| s.of(lake).map_or(0.0, |(_, h)| h.cells_under());
        let (all, base) = (cells(self, a) + cells(self, b), [a, b].map(|l| self.lake(l).map_or(0.0, |l| l.held)));
        // The larger lake keeps its index.
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
        // The parts are ordered by their pits, so the order does not depend on which was found first.
        let mut parts = [kept.hollow, given.hollow];
        parts.sort_by_key(|part| self.pit_of(*part).map(|pit| (terrain.place(pit)[1], terrain.place(pit)[0])));
        let whole = Hollow::new(Some(parts), all, base[0] + base[1], birth_mm);
        let hollow = put(&mut self.hollows, &mut self.free_hollows, whole);
        let held = base[0] + base[1];
        self.lakes[keeps as usize] = Some(Lake { hollow, held, level_mm: birth_mm, rim: Some(rim) });
        keeps
    }

    /// Returns the first of a tree's pits, counted row by row from the south-west.
    fn pit_of(&self, mut hollow: u32) -> Option<CellId> {
        loop {
            let h = self.hollows[hollow as usize].as_ref()?;
            match h.parts {
                Some([first, _]) => hollow = first,
                None => return h.cells.first().copied(),
            }
        }
    }

    /// Marks all cells of a tree as lying in a lake.
    fn label(&mut self, terrain: &Terrain, hollow: u32, lake: u32) {
        for part in self.tree(hollow) {
            let cells = self.hollows[part as usize].as_mut().map(|h| std::mem::take(&mut h.cells)).unwrap_or_default();
            cells.iter().for_each(|cell| self.own(terrain, *cell, lake));
            if let Some(h) = self.hollows[part as usize].as_mut() {
                h.cells = cells;
            }
        }
    }

    /// Removes a lake and all hollows in its tree.
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
