//! Field of soil: sparse patches of dug ground, the sums of their masses, and the slides between their cells.

use std::collections::BTreeMap;

use super::{
    material::{SoilMaterials, SoilParcel, share},
    patch::{BankWater, CELLS, NEAR, NO_PATCH, SIDE, SoilPatch, UndugGround, WIDE, wide},
};
use crate::slides::{SlopeInputs, edge_flows};

/// Cell of a field: the slot of its patch and its index there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SoilCell {
    pub slot: u32,
    pub cell: usize,
}

/// Patches of dug ground.
#[derive(Clone, Debug)]
pub(super) struct SoilField {
    pub materials: SoilMaterials,
    /// Patches by slot.
    pub patches: Vec<SoilPatch>,
    /// Slots by key, rows from the south.
    pub slots: BTreeMap<[i32; 2], u32>,
    /// Slots of the patches whose soil may move in the next sweep, in the order of their keys.
    pub awake: Vec<u32>,
    /// Slots of the patches that have changed since the last sweep.
    changed: Vec<u32>,
    /// Slots of the patches with barriers.
    barred: Vec<u32>,
    /// Number of the present sweep.
    sweeps: u64,
    /// Water of ground that was not dug. New patches begin with this water.
    pub water: BankWater,
    /// Depth below the undug surface to which the bank is frozen, in units; 0 if tools break the frost.
    pub frozen: i64,
    /// Whether any bank has lost its hold.
    pub has_broken: bool,
    /// Incremented whenever a step, soil that the host brings, or new undug ground changes something.
    pub revision: u64,
    scratch: SweepScratch,
}

/// Heights and grades of a patch with its margin, and lists that are filled anew in each sweep.
#[derive(Clone, Debug, Default)]
struct SweepScratch {
    heights: Vec<f64>,
    grades: Vec<f64>,
    next: Vec<u32>,
    listed: Vec<u32>,
}

impl SoilField {
    pub fn new(materials: SoilMaterials) -> Self {
        let water = BankWater { saturation: materials.saturation, soaked: 0.0 };
        let margin = SweepScratch {
            heights: vec![f64::NAN; WIDE * WIDE],
            grades: vec![f64::INFINITY; WIDE * WIDE],
            ..SweepScratch::default()
        };
        Self {
            materials,
            patches: Vec::new(),
            slots: BTreeMap::new(),
            awake: Vec::new(),
            changed: Vec::new(),
            barred: Vec::new(),
            sweeps: 1,
            water,
            frozen: 0,
            has_broken: false,
            revision: 0,
            scratch: margin,
        }
    }

    /// Slot of the patch with a key; `None` without such a patch.
    pub fn slot(&self, key: [i32; 2]) -> Option<u32> {
        self.slots.get(&[key[1], key[0]]).copied()
    }

    /// Cell at a place of the lattice; `None` without ground or without a patch there.
    pub fn find(&self, place: [i32; 2]) -> Option<SoilCell> {
        let side = SIDE as i32;
        let slot = self.slot(place.map(|v| v.div_euclid(side)))?;
        let [x, y] = place.map(|v| v.rem_euclid(side) as usize);
        let cell = y * SIDE + x;
        self.patches[slot as usize].has_ground(cell).then_some(SoilCell { slot, cell })
    }

    /// Cell at a place of the lattice, with a new patch where there is none yet; `None` without ground.
    pub fn find_or_add(&mut self, place: [i32; 2], ground: &dyn UndugGround) -> Option<SoilCell> {
        let key = place.map(|v| v.div_euclid(SIDE as i32));
        if self.slot(key).is_none() {
            ground.height_m(place)?;
            self.add(key, ground)?;
        }
        self.find(place)
    }

    fn add(&mut self, key: [i32; 2], ground: &dyn UndugGround) -> Option<u32> {
        Some(self.insert(SoilPatch { water: self.water, ..SoilPatch::new(key, ground)? }))
    }

    /// Adds a patch whose key no other patch has. Returns its slot.
    pub fn insert(&mut self, mut patch: SoilPatch) -> u32 {
        let slot = self.patches.len() as u32;
        let key = patch.key;
        for (i, offset) in NEAR.into_iter().enumerate() {
            let Some(other) = self.slot([key[0] + offset[0], key[1] + offset[1]]) else { continue };
            patch.near[i] = other;
            let back = NEAR.iter().position(|near| near.map(|v| -v) == offset);
            self.patches[other as usize].near[back.unwrap_or(0)] = slot;
        }
        self.slots.insert([key[1], key[0]], slot);
        self.patches.push(patch);
        slot
    }

    /// Place of a cell on the lattice.
    pub fn place(&self, cell: SoilCell) -> [i32; 2] {
        let key = self.patches[cell.slot as usize].key;
        [key[0] * SIDE as i32 + (cell.cell % SIDE) as i32, key[1] * SIDE as i32 + (cell.cell / SIDE) as i32]
    }

    /// Cell beside another, in whichever patch it lies; `None` without ground or without a patch there.
    pub fn beside(&self, cell: SoilCell, offset: [i32; 2]) -> Option<SoilCell> {
        let side = SIDE as i32;
        let [x, y] = [(cell.cell % SIDE) as i32 + offset[0], (cell.cell / SIDE) as i32 + offset[1]];
        let out = [x.div_euclid(side), y.div_euclid(side)];
        let slot = match NEAR.iter().position(|near| *near == out) {
            Some(i) => self.patches[cell.slot as usize].near[i],
            None => cell.slot,
        };
        let cell = (y.rem_euclid(side) * side + x.rem_euclid(side)) as usize;
        (slot != NO_PATCH && self.patches[slot as usize].has_ground(cell)).then_some(SoilCell { slot, cell })
    }

    /// Adapts the patches to changes of the undug ground. Returns whether there are any changes.
    pub fn set_ground(&mut self, ground: &dyn UndugGround) -> bool {
        let mut changes = false;
        for slot in 0..self.patches.len() as u32 {
            if self.patches[slot as usize].set_ground(ground, &self.materials) {
                self.touch(slot);
                changes = true;
            }
        }
        changes
    }

    pub fn patch(&self, slot: u32) -> &SoilPatch {
        &self.patches[slot as usize]
    }

    /// Notes that a patch has changed.
    pub fn touch(&mut self, slot: u32) {
        let patch = &mut self.patches[slot as usize];
        patch.is_unchecked = true;
        patch.revision = self.revision + 1;
        self.note(slot);
    }

    /// Lists a patch for the next sweep.
    fn note(&mut self, slot: u32) {
        let stamp = &mut self.patches[slot as usize].stamps[0];
        if *stamp != self.sweeps {
            *stamp = self.sweeps;
            self.changed.push(slot);
        }
    }

    /// Removes all barriers. With `wakes`, the soil that they held may slide.
    pub fn clear_barriers(&mut self, wakes: bool) {
        let barred = std::mem::take(&mut self.barred);
        for slot in &barred {
            self.patches[*slot as usize].barriers.clear();
            if wakes {
                self.note(*slot);
            }
        }
        self.barred = barred;
        self.barred.clear();
    }

    /// Closes the eastern (`side` 0) or northern (1) edge of a cell to soil from a cell whose surface lies between two
    /// heights, in units.
    pub fn close(&mut self, cell: SoilCell, side: u16, heights: [f64; 2]) {
        let patch = &mut self.patches[cell.slot as usize];
        if patch.barriers.is_empty() {
            self.barred.push(cell.slot);
        }
        patch.barriers.push((2 * cell.cell as u16 + side, heights));
    }

    /// Whether a blade holds the soil that would slide from a cell across an edge of a patch
    /// ([`SoilPatch::barriers`]).
    fn is_held(&self, slot: u32, edge: u16, donor: SoilCell) -> bool {
        let top = self.patches[donor.slot as usize].surface[donor.cell];
        let holds = |(closed, [low, high]): &(u16, [f64; 2])| *closed == edge && *low < top && top <= *high;
        self.patches[slot as usize].barriers.iter().any(holds)
    }

    /// Changes a cell and notes it.
    pub fn change<T>(&mut self, cell: SoilCell, act: impl FnOnce(&mut SoilPatch, usize, &SoilMaterials) -> T) -> T {
        self.touch(cell.slot);
        act(&mut self.patches[cell.slot as usize], cell.cell, &self.materials)
    }

    /// Takes soil of this depth, in units, off the surface of a cell: loose soil first, then bank.
    pub fn dig(&mut self, cell: SoilCell, depth: i64) -> SoilParcel {
        self.change(cell, |patch, cell, materials| {
            let loose = depth.min(patch.loose[cell]);
            let mut parcel = patch.take_loose(cell, loose, materials);
            if depth > loose {
                parcel.add(&patch.dig_bank(cell, depth - loose, materials));
            }
            parcel
        })
    }

    /// Puts loose soil onto a cell.
    pub fn put(&mut self, cell: SoilCell, parcel: &SoilParcel) {
        if *parcel != SoilParcel::default() {
            self.change(cell, |patch, cell, materials| patch.put(cell, parcel, materials));
        }
    }

    /// Copies the heights and grades of a patch and of the cells around it.
    fn gather(&mut self, slot: u32) {
        let patch = &self.patches[slot as usize];
        let SweepScratch { heights, grades, .. } = &mut self.scratch;
        for row in 0..SIDE {
            let (from, first) = (row * SIDE, wide(row * SIDE));
            heights[first..first + SIDE].copy_from_slice(&patch.surface[from..from + SIDE]);
            grades[first..first + SIDE].copy_from_slice(&patch.grade[from..from + SIDE]);
        }
        let last = SIDE - 1;
        for i in 0..SIDE {
            // The four sides: neighbour, its cell, and the place in the margin.
            let sides = [
                (0, i * SIDE + last, (i + 1) * WIDE),
                (1, i * SIDE, (i + 1) * WIDE + WIDE - 1),
                (2, last * SIDE + i, i + 1),
                (3, i, (WIDE - 1) * WIDE + i + 1),
            ];
            for (near, cell, place) in sides {
                margin(&self.patches, patch, near, cell, place, [heights, grades]);
            }
        }
        let corners =
            [(4, CELLS - 1, 0), (5, last * SIDE, WIDE - 1), (6, last, (WIDE - 1) * WIDE), (7, 0, WIDE * WIDE - 1)];
        for (near, cell, place) in corners {
            margin(&self.patches, patch, near, cell, place, [heights, grades]);
        }
    }

    /// Moves loose soil of up to `depth` units from a cell to another. Bank that has lost its hold is loosened first.
    fn slide(&mut self, donor: SoilCell, receiver: SoilCell, depth: i64) {
        let patch = &mut self.patches[donor.slot as usize];
        let missing = depth - patch.loose[donor.cell];
        if missing > 0 && patch.broken[donor.cell] {
            let kind = self.materials.bank_kind(patch.cut[donor.cell]);
            let bank = (missing as f64 / (1.0 + self.materials.kinds[kind].kind.swell)) as i64;
            let parcel = patch.dig_bank(donor.cell, bank, &self.materials);
            patch.put(donor.cell, &parcel, &self.materials);
        }
        let (whole, depth) = (patch.loose[donor.cell], depth.min(patch.loose[donor.cell]));
        if depth <= 0 {
            return;
        }
        for i in 0..self.patches[donor.slot as usize].masses.len() {
            let (kind, masses) = &mut self.patches[donor.slot as usize].masses[i];
            let (kind, moved) = (*kind, share(masses[donor.cell], depth, whole));
            if moved > 0 {
                masses[donor.cell] -= moved;
                self.patches[receiver.slot as usize].kind_masses(kind)[receiver.cell] += moved;
            }
        }
        self.patches[donor.slot as usize].loose[donor.cell] -= depth;
        let below = &mut self.patches[receiver.slot as usize];
        below.loose[receiver.cell] += depth;
        if let Some(press) = below.pressed.get_mut(receiver.cell) {
            press.reached = (press.reached - depth).max(0);
        }
        for cell in [donor, receiver] {
            self.touch(cell.slot);
            self.patches[cell.slot as usize].refresh(cell.cell, &self.materials);
        }
    }

    /// Moves the soil that flows across the edges of a patch.
    fn apply(&mut self, slot: u32, ground: &dyn UndugGround) {
        for cell in 0..CELLS {
            let here = SoilCell { slot, cell };
            for (side, offset) in [[1, 0], [0, 1]].into_iter().enumerate() {
                let flow = self.patches[slot as usize].flows[side][cell];
                if flow == 0.0 {
                    continue;
                }
                let beyond = self.beside(here, offset).or_else(|| {
                    let place = self.place(here);
                    self.find_or_add([place[0] + offset[0], place[1] + offset[1]], ground)
                });
                let Some(beyond) = beyond else { continue };
                let (from, to) = if flow > 0.0 { (here, beyond) } else { (beyond, here) };
                if self.is_held(slot, (2 * cell + side) as u16, from) {
                    continue;
                }
                self.slide(from, to, flow.abs() as i64);
            }
        }
    }

    /// Lists the patches in which something may move: those that have changed, and their neighbours. With `keeps`,
    /// those of the last list too.
    fn wake(&mut self, keeps: bool, ground: &dyn UndugGround) {
        let mut next = std::mem::take(&mut self.scratch.next);
        next.clear();
        let changed = std::mem::take(&mut self.changed);
        for slot in &changed {
            let key = self.patches[*slot as usize].key;
            let is_free = |cell: usize| self.patches[*slot as usize].grade[cell].is_finite();
            // A patch has the flows across the eastern and northern edges of its cells. Flows across its western and
            // southern border need a neighbour.
            let [west, south] = [(0..SIDE).any(|i| is_free(i * SIDE)), (0..SIDE).any(is_free)];
            for (leaves, near, offset) in [(west, 0, [-1, 0]), (south, 2, [0, -1])] {
                if leaves && self.patches[*slot as usize].near[near] == NO_PATCH {
                    let _ = self.add([key[0] + offset[0], key[1] + offset[1]], ground);
                }
            }
        }
        let sweep = self.sweeps;
        let kept: &[u32] = if keeps { &self.awake } else { &[] };
        let near_of = |slot: &u32| (*slot, self.patches[*slot as usize].near);
        self.scratch.listed.clear();
        self.scratch.listed.extend(kept);
        for (slot, near) in changed.iter().map(near_of) {
            self.scratch.listed.push(slot);
            self.scratch.listed.extend(near.into_iter().filter(|other| *other != NO_PATCH));
        }
        for slot in &self.scratch.listed {
            let patch = &mut self.patches[*slot as usize];
            if patch.stamps[1] != sweep {
                patch.stamps[1] = sweep;
                next.push(*slot);
            }
        }
        next.sort_unstable_by_key(|slot| [self.patches[*slot as usize].key[1], self.patches[*slot as usize].key[0]]);
        self.changed = changed;
        self.changed.clear();
        self.scratch.next = std::mem::replace(&mut self.awake, next);
        self.sweeps += 1;
    }

    /// Lets steep soil slide, by at most `sweeps` sweeps. Returns whether all of it is at rest.
    pub fn settle(&mut self, sweeps: usize, ground: &dyn UndugGround) -> bool {
        self.wake(true, ground);
        for _ in 0..sweeps {
            if self.awake.is_empty() {
                break;
            }
            self.sweep(ground);
        }
        self.awake.is_empty()
    }

    /// Whether no soil moves and nothing has changed since the last sweep.
    pub fn is_at_rest(&self) -> bool {
        self.awake.is_empty() && self.changed.is_empty()
    }

    /// Whether a patch has changed since the last sweep.
    pub fn has_changed(&self, slot: u32) -> bool {
        self.patches[slot as usize].stamps[0] == self.sweeps
    }

    /// Completes a loaded patch: computes its heights, and marks whether it is awake, has changed, and has unchecked
    /// walls.
    pub fn restore(&mut self, slot: u32, [is_awake, has_changed, is_unchecked]: [bool; 3]) {
        let patch = &mut self.patches[slot as usize];
        for cell in 0..CELLS {
            patch.refresh(cell, &self.materials);
        }
        if has_changed {
            patch.stamps[0] = self.sweeps;
            self.changed.push(slot);
        }
        patch.is_unchecked = is_unchecked;
        self.has_broken |= patch.broken.contains(&true);
        if is_awake {
            self.awake.push(slot);
        }
    }

    /// Runs one sweep over the patches that are awake.
    fn sweep(&mut self, ground: &dyn UndugGround) {
        let awake = std::mem::take(&mut self.awake);
        for slot in &awake {
            self.gather(*slot);
            let inputs =
                SlopeInputs { size: [SIDE, SIDE], heights: &self.scratch.heights, grades: &self.scratch.grades };
            let [east, north] = &mut self.patches[*slot as usize].flows;
            edge_flows(&inputs, east, north);
        }
        for slot in &awake {
            self.apply(*slot, ground);
        }
        self.awake = awake;
        self.wake(false, ground);
    }

    /// Mass of all loose soil.
    pub fn lying(&self) -> i128 {
        self.patches.iter().map(SoilPatch::lying).sum()
    }

    /// Mass of all bank that was taken.
    pub fn dug(&self) -> i128 {
        self.patches.iter().map(|patch| patch.dug(&self.materials)).sum()
    }

    /// Forgets which banks had lost their hold, once nothing moves.
    pub fn rest(&mut self) {
        if !std::mem::take(&mut self.has_broken) {
            return;
        }
        for patch in self.patches.iter_mut().filter(|patch| patch.broken.contains(&true)) {
            for cell in 0..CELLS {
                if std::mem::take(&mut patch.broken[cell]) {
                    patch.refresh(cell, &self.materials);
                }
            }
        }
    }
}

/// Copies one cell of the margin of a patch.
fn margin(
    patches: &[SoilPatch],
    patch: &SoilPatch,
    side: usize,
    cell: usize,
    place: usize,
    [heights, grades]: [&mut Vec<f64>; 2],
) {
    (heights[place], grades[place]) = match patches.get(patch.near[side] as usize) {
        Some(other) => (other.surface[cell], other.grade[cell]),
        None => (patch.ground[place], f64::INFINITY),
    };
}
