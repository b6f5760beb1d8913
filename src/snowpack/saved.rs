//! Saved form of lying snow as text. Amounts are whole numbers. The lists of the cells' amounts are hexadecimal; a run
//! of n equal numbers v is written as "v*n", with n in decimal.

use serde::{Deserialize, Serialize};

use super::{
    column::Column,
    field::{Books, SnowField},
    patch::Patch,
    state::SnowState,
};
use crate::{
    surroundings::Meltwater,
    world::{values, words},
};

/// Largest number of cells of a terrain.
const MOST_CELLS: usize = 1 << 26;

/// Saved state: the fields of [`SnowState`]. A column is its ice, water, depth and albedo, in units.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedSnow {
    /// Time up to which the snow is simulated, s.
    time_s: f64,
    sunlight_w_m2: f64,
    /// Column of level, open ground.
    country: [i64; 4],
    melted: [f64; 2],
    /// Left out if no time was simulated in fast-forward.
    #[serde(default, skip_serializing_if = "is_zero")]
    coarse_s: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    field: Option<SavedCells>,
}

/// Saved cells of a grid or of each tile.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedCells {
    /// Number of cells of a grid or of a tile.
    cells: usize,
    /// Columns of a grid: lists of ice, water, depth and albedo.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    columns: Option<[String; 4]>,
    /// Mass balance, in the order of [`Books::to_array`].
    books: [i64; 7],
    /// Share of the ground that snow covers, and run-off, mm/h, in the last step.
    melted: [f64; 2],
    /// Lattice of tiles: x, y and z of its origin in the host's world, and its cell size, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    lattice: Option<[f64; 4]>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    tiles: Vec<SavedTile>,
}

/// Saved snow of a tile, by the tile's index east and north.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedTile {
    /// Index of the tile, (east, north).
    tile: [i32; 2],
    /// Columns, as for a grid; left out without snow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    columns: Option<[String; 4]>,
    /// Hash that replaces the columns when the state is only hashed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    hash: Option<String>,
}

/// Returns whether a value is left out of the saved state because it is 0.
fn is_zero(v: &f64) -> bool {
    *v == 0.0
}

/// Returns ice, water, depth and albedo of a column, in units.
fn numbers(c: &Column) -> [i64; 4] {
    [c.ice, c.water, c.depth, c.albedo]
}

/// Returns the column of these numbers; `None` if they are out of range.
fn column([ice, water, depth, albedo]: [i64; 4]) -> Option<Column> {
    Some(Column { ice, water, depth, albedo }).filter(Column::is_sound)
}

/// Returns the numbers of all columns as lists.
fn lists(patch: &Patch, cells: usize) -> [String; 4] {
    [0, 1, 2, 3].map(|i| words((0..cells).map(move |cell| numbers(&patch.column(cell))[i] as u64)))
}

/// Returns the columns that [`lists`] wrote; `None` if they cannot be `cells` columns.
fn of_lists(columns: &[String; 4], cells: usize) -> Option<Vec<Column>> {
    let [ice, water, depth, albedo] = [0, 1, 2, 3].map(|i| values(&columns[i], cells));
    let (ice, water, depth, albedo) = (ice?, water?, depth?, albedo?);
    let at = |i: usize| column([ice[i] as i64, water[i] as i64, depth[i] as i64, albedo[i] as i64]);
    (0..cells).map(at).collect()
}

impl SavedTile {
    /// Writes a tile: its columns, or only their hash with `for_hash`.
    fn of(patch: &Patch, cells: usize, for_hash: bool) -> Self {
        let lies = !patch.is_bare();
        Self {
            tile: patch.key,
            columns: (lies && !for_hash).then(|| lists(patch, cells)),
            hash: (lies && for_hash).then(|| format!("{:x}", patch.hash())),
        }
    }
}

impl SavedCells {
    /// Writes a field: the columns of a grid or of tiles, and the mass balance; with `for_hash`, tiles have only their
    /// hash.
    fn of(field: &SnowField, for_hash: bool) -> Self {
        let cells = field.size[0] * field.size[1];
        let is_grid = field.lattice.is_none();
        let tiles = field.patches.iter().filter(|_| !is_grid);
        Self {
            cells,
            columns: field.patches.first().filter(|_| is_grid).map(|patch| lists(patch, cells)),
            books: field.books.to_array(),
            melted: [field.cover, field.runoff_mm_h],
            lattice: field.lattice,
            tiles: tiles.map(|patch| SavedTile::of(patch, cells, for_hash)).collect(),
        }
    }

    /// Returns the saved field, whose ground is not known yet; `None` if it is not valid.
    fn field(&self) -> Option<SnowField> {
        if self.cells.saturating_mul(self.tiles.len().max(1)) > MOST_CELLS
            || self.columns.is_some() == self.lattice.is_some()
        {
            return None;
        }
        let side = self.cells.isqrt();
        let mut field = SnowField::new(if self.lattice.is_some() { [side; 2] } else { [self.cells, 1] }, 1.0);
        if let Some([x, y, z, cell_m]) = self.lattice.filter(|_| side * side == self.cells) {
            field.lattice = Some([x, y, z, cell_m]);
            field.cell_m = cell_m;
        }
        if let Some(columns) = &self.columns {
            field.add(Patch::loaded([0, 0], of_lists(columns, self.cells)?));
        }
        for tile in &self.tiles {
            let columns = tile.columns.as_ref().map(|columns| of_lists(columns, self.cells));
            field.find(tile.tile).err()?;
            field.add(Patch::loaded(tile.tile, columns.unwrap_or_else(|| Some(Vec::new()))?));
        }
        field.books = Books::from_array(self.books);
        [field.cover, field.runoff_mm_h] = self.melted;
        (field.books.balance() == field.lying() && self.lattice == field.lattice).then_some(field)
    }
}

impl SavedSnow {
    /// Creates the saved form. If `for_hash`, the snow of each tile is given only by its hash.
    pub fn of(state: &SnowState, for_hash: bool) -> Self {
        Self {
            time_s: state.time_s,
            sunlight_w_m2: state.sunlight_w_m2,
            country: numbers(&state.country),
            melted: [state.melted.covered, state.melted.runoff_mm_h],
            coarse_s: state.coarse_s,
            field: state.field.as_ref().map(|field| SavedCells::of(field, for_hash)),
        }
    }

    /// Returns the saved state, or `None` if it is not valid.
    pub fn state(&self) -> Option<SnowState> {
        let field = match &self.field {
            Some(field) => Some(field.field()?),
            None => None,
        };
        let sound = self.time_s.is_finite()
            && self.coarse_s >= 0.0
            && [self.sunlight_w_m2, self.melted[0], self.melted[1]].iter().all(|v| (0.0..1e5).contains(v));
        let [covered, runoff_mm_h] = self.melted;
        sound.then_some(SnowState {
            time_s: self.time_s,
            sunlight_w_m2: self.sunlight_w_m2,
            country: column(self.country)?,
            melted: Meltwater { covered, runoff_mm_h },
            coarse_s: self.coarse_s,
            field,
        })
    }
}
