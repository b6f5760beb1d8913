//! Kinds and layers of a site, converted to the units of its cells: how much mass a depth of soil holds, and at which
//! slope the soil rests.

use super::{
    kind::{MAX_SOIL_KINDS, MOIST, SoilHorizon, SoilKind},
    laws::WallTable,
};

/// Units of depth per metre. Depths are whole numbers of these units.
pub(super) const DEPTH_UNITS: f64 = 1_048_576.0;
/// Units of mass per kilogram: whole micrograms.
pub(super) const MASS_UNITS: f64 = 1e9;
/// Largest number of cells between the crest of a wall and its toe.
const MOST_WALL_CELLS: usize = 256;
/// Factor by which banks may be steeper than the slopes at which they rest for ever, so that rounding breaks none.
const STEEPER: f64 = 1.02;

/// Returns a length in whole units of depth.
pub(super) fn depth_units(length_m: f64) -> i64 {
    (length_m * DEPTH_UNITS).round() as i64
}

/// Returns the share `part / whole` of a number, rounded down; all of it if the part is the whole.
pub(super) fn share(number: i64, part: i64, whole: i64) -> i64 {
    if part >= whole { number } else { ((number as f64 * (part as f64 / whole as f64)) as i64).min(number) }
}

/// Soil that moves from one place to another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SoilParcel {
    /// Loose depth over one cell, in units of depth.
    pub depth: i64,
    /// Mass of each kind, in units of mass.
    pub masses: [i64; MAX_SOIL_KINDS],
}

impl SoilParcel {
    pub fn mass(&self) -> i128 {
        self.masses.iter().map(|mass| i128::from(*mass)).sum()
    }

    pub fn add(&mut self, other: &Self) {
        self.depth += other.depth;
        self.masses.iter_mut().zip(other.masses).for_each(|(mass, more)| *mass += more);
    }

    /// Takes a depth out of the parcel, at most all of it, with the same share of each mass.
    pub fn take(&mut self, depth: i64) -> Self {
        let (whole, depth) = (self.depth, depth.clamp(0, self.depth));
        let mut taken = Self { depth, ..Self::default() };
        self.depth -= depth;
        for (taken, mass) in taken.masses.iter_mut().zip(&mut self.masses) {
            *taken = share(*mass, depth, whole);
            *mass -= *taken;
        }
        taken
    }
}

/// Kind of soil, converted to the units of a site's cells.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SoilMaterial {
    pub kind: SoilKind,
    /// Mass of a unit of depth of bank over one cell.
    pub bank_mass: f64,
    /// Loose depth of a unit of mass over one cell.
    pub loose_depth: f64,
    /// Drop over one cell at which loose soil rests, in units of depth.
    pub grade: f64,
    /// Drop over one cell up to which the bank rests however high it is, in units of depth.
    pub bank_grade: f64,
    /// Heights of the highest walls, in units of depth, by the distance in cells from the crest to the toe.
    pub walls: Vec<f64>,
}

/// All kinds and layers of a site.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SoilMaterials {
    pub cell_m: f64,
    pub kinds: Vec<SoilMaterial>,
    pub horizons: Vec<SoilHorizon>,
    /// Saturation of the bank without rain and sun.
    pub saturation: f64,
    /// Upper sides of the layers, in units of depth below the undug surface.
    tops: Vec<i64>,
}

impl SoilMaterial {
    fn new(kind: SoilKind, cell_m: f64) -> Self {
        let per_unit = cell_m * cell_m * MASS_UNITS / DEPTH_UNITS;
        let steepness = |degrees: f64| libm::tan(degrees.to_radians()) * cell_m * DEPTH_UNITS;
        let walls = WallTable::new(&kind.wall_law(), cell_m, MOST_WALL_CELLS).heights_m;
        Self {
            kind,
            bank_mass: kind.density_kg_m3 * per_unit,
            loose_depth: 1.0 / (kind.loose_density_kg_m3() * per_unit),
            grade: steepness(kind.repose_deg),
            bank_grade: STEEPER * steepness(kind.friction_deg.max(kind.repose_deg)),
            walls: walls.into_iter().map(|height_m| height_m * DEPTH_UNITS).collect(),
        }
    }
}

impl SoilMaterials {
    pub fn new(cell_m: f64, kinds: &[SoilKind], horizons: Vec<SoilHorizon>) -> Self {
        let tops = horizons.iter().map(|horizon| depth_units(horizon.top_m)).collect();
        let kinds = kinds.iter().map(|kind| SoilMaterial::new(*kind, cell_m)).collect();
        Self { cell_m, kinds, horizons, saturation: MOIST, tops }
    }

    pub fn area_m2(&self) -> f64 {
        self.cell_m * self.cell_m
    }

    /// Index of the layer at a depth.
    fn layer(&self, depth: i64) -> usize {
        self.tops.iter().rposition(|top| *top <= depth).unwrap_or(0)
    }

    /// Index of the kind that lies at a depth below the undug surface.
    pub fn bank_kind(&self, depth: i64) -> usize {
        self.horizons[self.layer(depth)].kind.index()
    }

    /// Mass of a layer above a depth; only differences between two depths are moved, so that their sum is exact.
    fn mass_above(&self, layer: usize, depth: i64) -> i64 {
        let bottom = self.tops.get(layer + 1).copied().unwrap_or(i64::MAX);
        let thickness = depth.clamp(self.tops[layer], bottom) - self.tops[layer];
        (self.kinds[self.horizons[layer].kind.index()].bank_mass * thickness as f64) as i64
    }

    /// Returns the bank between two depths below the undug surface as loose soil.
    pub fn dug(&self, upper: i64, lower: i64) -> SoilParcel {
        let mut parcel = SoilParcel::default();
        let mut depth = 0.0;
        for layer in self.layer(upper)..=self.layer(lower) {
            let kind = self.horizons[layer].kind.index();
            let mass = self.mass_above(layer, lower) - self.mass_above(layer, upper);
            parcel.masses[kind] += mass;
            depth += mass as f64 * self.kinds[kind].loose_depth;
        }
        parcel.depth = depth.round() as i64;
        parcel
    }

    /// Returns loose soil of one kind.
    pub fn loose(&self, kind: usize, mass: i64) -> SoilParcel {
        let mut parcel = SoilParcel::default();
        parcel.masses[kind] = mass;
        parcel.depth = (mass as f64 * self.kinds[kind].loose_depth).round() as i64;
        parcel
    }

    /// Drop over one cell at which a mixture rests, in units of depth: the mean of its kinds by mass.
    pub fn mixed_grade(&self, masses: impl Iterator<Item = (usize, i64)>) -> f64 {
        let (mut weighted, mut whole, mut any) = (0.0, 0.0, f64::INFINITY);
        for (kind, mass) in masses {
            let grade = self.kinds[kind].grade;
            weighted += mass as f64 * grade;
            whole += mass as f64;
            any = grade;
        }
        if whole > 0.0 { weighted / whole } else { any }
    }
}
