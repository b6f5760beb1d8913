//! Patch of ground that has been dug: a square of cells and, for each cell, what was taken from it and the loose soil
//! on it.

use super::{
    laws::cohesion_share,
    material::{SoilMaterials, SoilParcel, depth_units, share},
};

/// Number of cells along a side of a patch.
pub(super) const SIDE: usize = 16;
/// Number of cells of a patch.
pub(super) const CELLS: usize = SIDE * SIDE;
/// Number of cells along a side of a patch with its margin.
pub(super) const WIDE: usize = SIDE + 2;
/// Value of a slot that means no patch.
pub(super) const NO_PATCH: u32 = u32::MAX;

/// Compaction of a cell's bank (its undisturbed soil) by wheels and tracks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Pressed {
    /// Thickness of the compacted soil before it was compacted, in units of depth.
    pub packed: i64,
    /// Depth by which compaction has lowered the surface, in units of depth.
    pub sunk: i64,
    /// Depth to which wheels have pressed the surface since it was last covered or dug, in units of depth.
    pub reached: i64,
}

/// Water of the bank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BankWater {
    /// Share of the pores that water fills.
    pub saturation: f64,
    /// Wet share of the surface, which changes the saturation.
    pub soaked: f64,
}

/// Heights of the undug ground.
pub trait UndugGround {
    /// Returns the height of a cell of the lattice, m, \[-1e5, 1e5\]; `None` where there is no ground. `cell` is the
    /// index of the cell east and north.
    fn height_m(&self, cell: [i32; 2]) -> Option<f64>;
}

/// Square of cells, by rows from the south-west. Units without a name are those of depth
/// ([`DEPTH_UNITS`](super::material::DEPTH_UNITS)).
#[derive(Clone, Debug)]
pub(super) struct SoilPatch {
    /// Position on the lattice of patches, east and north.
    pub key: [i32; 2],
    /// Undug heights with a margin of one cell, in units; NaN without ground.
    pub ground: Vec<f64>,
    /// Depth of undisturbed soil that was taken from each cell, in units.
    pub cut: Vec<i64>,
    /// Compaction of each cell; empty where nothing was pressed.
    pub pressed: Vec<Pressed>,
    /// Depth of loose soil on each cell, in units.
    pub loose: Vec<i64>,
    /// Mass of loose soil of each kind on each cell, in order of kinds.
    pub masses: Vec<(u8, Vec<i64>)>,
    /// Whether the bank of each cell has lost its hold and slides.
    pub broken: Vec<bool>,
    /// Heights of the surface, in units. They follow from the fields above.
    pub surface: Vec<f64>,
    /// Drop over one cell at which the surface of each cell rests; infinite where nothing can move.
    pub grade: Vec<f64>,
    /// Flows across the eastern and the northern edges.
    pub flows: [Vec<f64>; 2],
    /// Edges that a blade closes, with the blade's lower and upper height there, in units. The number of an edge is
    /// twice the index of its cell, plus 1 for the cell's northern edge.
    pub barriers: Vec<(u16, [f64; 2])>,
    /// Slots of the neighbours W, E, S, N, SW, SE, NW, NE.
    pub near: [u32; 8],
    /// Revision of the site at the last change.
    pub revision: u64,
    /// Water of the bank.
    pub water: BankWater,
    /// Whether walls of this patch or beside it may have lost their hold since they were last checked.
    pub is_unchecked: bool,
    /// Number of the sweep in which the patch last changed, and number of the sweep for which it was last listed.
    pub stamps: [u64; 2],
}

/// Offsets of the neighbours in the order of [`SoilPatch::near`].
pub(super) const NEAR: [[i32; 2]; 8] = [[-1, 0], [1, 0], [0, -1], [0, 1], [-1, -1], [1, -1], [-1, 1], [1, 1]];

impl SoilPatch {
    /// Creates an undug patch; `None` where there is no ground at all.
    pub fn new(key: [i32; 2], ground: &dyn UndugGround) -> Option<Self> {
        let patch = Self::bare(key, ground);
        patch.surface.iter().any(|height| !height.is_nan()).then_some(patch)
    }

    /// Creates an undug patch, with or without ground.
    pub fn bare(key: [i32; 2], ground: &dyn UndugGround) -> Self {
        let ground = undug_units(key, ground);
        Self {
            key,
            cut: vec![0; CELLS],
            pressed: Vec::new(),
            loose: vec![0; CELLS],
            masses: Vec::new(),
            broken: vec![false; CELLS],
            surface: (0..CELLS).map(|cell| ground[wide(cell)]).collect(),
            grade: vec![f64::INFINITY; CELLS],
            flows: [vec![0.0; CELLS], vec![0.0; CELLS]],
            barriers: Vec::new(),
            near: [NO_PATCH; 8],
            revision: 0,
            water: BankWater { saturation: 0.0, soaked: 0.0 },
            is_unchecked: false,
            stamps: [0; 2],
            ground,
        }
    }

    pub fn has_ground(&self, cell: usize) -> bool {
        !self.ground[wide(cell)].is_nan()
    }

    pub fn press(&self, cell: usize) -> Pressed {
        self.pressed.get(cell).copied().unwrap_or_default()
    }

    pub fn set_press(&mut self, cell: usize, press: Pressed) {
        if self.pressed.is_empty() && press != Pressed::default() {
            self.pressed = vec![Pressed::default(); CELLS];
        }
        if let Some(old) = self.pressed.get_mut(cell) {
            *old = press;
        }
    }

    /// Reads the undug heights again. Returns whether any of them has changed.
    pub fn set_ground(&mut self, ground: &dyn UndugGround, materials: &SoilMaterials) -> bool {
        let heights = undug_units(self.key, ground);
        if heights.iter().map(|v| v.to_bits()).eq(self.ground.iter().map(|v| v.to_bits())) {
            return false;
        }
        self.ground = heights;
        (0..CELLS).for_each(|cell| self.refresh(cell, materials));
        true
    }

    /// Share of its full cohesion that the bank still has, in steps of 1/64.
    pub fn hold(&self) -> f64 {
        (64.0 * cohesion_share(self.water.saturation)).floor() / 64.0
    }

    /// Change of the surface against the undug ground, in units.
    pub fn change(&self, cell: usize) -> i64 {
        self.loose[cell] - self.cut[cell] - self.press(cell).sunk
    }

    /// Height of the top of the bank, in units; NaN without ground.
    pub fn bank_top(&self, cell: usize) -> f64 {
        self.surface[cell] - self.loose[cell] as f64
    }

    /// Whether the bank of a cell was dug or pressed.
    pub fn is_disturbed(&self, cell: usize) -> bool {
        self.cut[cell] > 0 || self.press(cell).sunk > 0
    }

    /// Depth of bank, as it was before it was compacted, that a dig of `depth` units takes, and the compaction that is
    /// left.
    fn bank_taken(&self, cell: usize, depth: i64) -> (i64, Pressed) {
        let press = self.press(cell);
        let thickness = press.packed - press.sunk;
        if depth >= thickness {
            return (press.packed + depth - thickness, Pressed::default());
        }
        let taken = share(press.packed, depth, thickness);
        let packed = press.packed - taken;
        (taken, Pressed { packed, sunk: packed - (thickness - depth), reached: 0 })
    }

    /// Takes bank of this depth, in units, and returns it as loose soil.
    pub fn dig_bank(&mut self, cell: usize, depth: i64, materials: &SoilMaterials) -> SoilParcel {
        let (taken, press) = self.bank_taken(cell, depth);
        let upper = self.cut[cell];
        self.cut[cell] = upper + taken;
        self.set_press(cell, press);
        let parcel = materials.dug(upper, self.cut[cell]);
        self.refresh(cell, materials);
        parcel
    }

    /// Takes loose soil of this depth, in units, at most all of it.
    pub fn take_loose(&mut self, cell: usize, depth: i64, materials: &SoilMaterials) -> SoilParcel {
        let whole = self.loose[cell];
        let mut parcel = SoilParcel { depth: depth.clamp(0, whole), ..SoilParcel::default() };
        for (kind, masses) in &mut self.masses {
            let taken = share(masses[cell], parcel.depth, whole);
            masses[cell] -= taken;
            parcel.masses[usize::from(*kind)] = taken;
        }
        self.loose[cell] -= parcel.depth;
        self.refresh(cell, materials);
        parcel
    }

    /// Puts loose soil onto a cell.
    pub fn put(&mut self, cell: usize, parcel: &SoilParcel, materials: &SoilMaterials) {
        self.loose[cell] += parcel.depth;
        for (kind, mass) in parcel.masses.iter().enumerate().filter(|(_, mass)| **mass != 0) {
            self.kind_masses(kind as u8)[cell] += mass;
        }
        if let Some(press) = self.pressed.get_mut(cell) {
            press.reached = (press.reached - parcel.depth).max(0);
        }
        self.refresh(cell, materials);
    }

    /// Masses of a kind, by cell; all are 0 for a kind that the patch did not have yet.
    pub fn kind_masses(&mut self, kind: u8) -> &mut Vec<i64> {
        let found = self.masses.binary_search_by_key(&kind, |(kind, _)| *kind);
        let index = found.unwrap_or_else(|index| {
            self.masses.insert(index, (kind, vec![0; CELLS]));
            index
        });
        &mut self.masses[index].1
    }

    /// Masses of loose soil on a cell by kind.
    pub fn loose_masses(&self, cell: usize) -> impl Iterator<Item = (usize, i64)> + '_ {
        self.masses.iter().map(move |(kind, masses)| (usize::from(*kind), masses[cell])).filter(|(_, mass)| *mass > 0)
    }

    /// Updates the height and the grade of a cell.
    pub fn refresh(&mut self, cell: usize, materials: &SoilMaterials) {
        let bank = self.cut[cell] + self.press(cell).sunk;
        self.surface[cell] = self.ground[wide(cell)] - bank as f64 + self.loose[cell] as f64;
        self.grade[cell] = if self.loose[cell] > 0 {
            materials.mixed_grade(self.loose_masses(cell))
        } else if self.broken[cell] {
            materials.kinds[materials.bank_kind(self.cut[cell])].grade
        } else {
            f64::INFINITY
        };
    }

    /// Mass of the loose soil.
    pub fn lying(&self) -> i128 {
        self.masses.iter().flat_map(|(_, masses)| masses).map(|mass| i128::from(*mass)).sum()
    }

    /// Mass of the bank that was taken.
    pub fn dug(&self, materials: &SoilMaterials) -> i128 {
        self.cut.iter().map(|cut| materials.dug(0, *cut).mass()).sum()
    }
}

/// Undug heights of a patch and its margin, in units; NaN without ground.
fn undug_units(key: [i32; 2], ground: &dyn UndugGround) -> Vec<f64> {
    let first = key.map(|k| k * SIDE as i32);
    let height = |i: usize| {
        let offset = [(i % WIDE) as i32 - 1, (i / WIDE) as i32 - 1];
        let height_m = ground.height_m([first[0] + offset[0], first[1] + offset[1]]);
        height_m.filter(|height| height.abs() <= 1e5).map_or(f64::NAN, |height| depth_units(height) as f64)
    };
    (0..WIDE * WIDE).map(height).collect()
}

/// Index of a cell of a patch in the arrays with a margin.
pub(super) fn wide(cell: usize) -> usize {
    (cell / SIDE + 1) * WIDE + cell % SIDE + 1
}
