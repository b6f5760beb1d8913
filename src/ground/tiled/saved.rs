//! Saved form of the water on a tiled terrain. Heights are not saved: the host sets them, and the state only has their
//! hashes.

use serde::{Deserialize, Serialize};

use super::{
    lakes::saved::LakeBranch,
    water::{TiledWater, pit_below},
};
use crate::{
    error::{Error, Result},
    ground::water::PORES_MM,
    terrain::{Terrain, TerrainDesc, TileKey},
    world::{binary_text, parse_error, text_binary, values, words},
};

/// Word in the list of a lake's pits that joins the two trees before it.
const JOINED: u64 = u64::MAX;

/// Saved water of a tile.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SavedWaterTile {
    /// Index of the tile, (east, north).
    tile: [i32; 2],
    /// Hash of the heights and classes.
    cells: String,
    /// Runs of equal film and pores, in base 64. In a state that is only hashed, this is the hash of film and pores.
    /// Left out if the tile has no state of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    water: Option<String>,
}

/// Saved water on tiles.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SavedTiles {
    /// Origin of the lattice of tiles in the host's world, m.
    origin_m: [f64; 3],
    /// Side of a cell, m.
    cell_m: f64,
    /// Side of a tile, cells.
    tile_cells: u32,
    tiles: Vec<SavedWaterTile>,
    /// Lakes as words: for each, the number of its words, then its pits and joints ([`LakeBranch`]).
    lakes: String,
    /// Volume of each lake, mm times cells, as the bits of an f64.
    held: String,
}

/// Encodes runs of equal values: the length in 4 bytes, then the two numbers.
fn runs(top: &[[f32; 2]]) -> Vec<u8> {
    let same = |a: &[f32; 2], b: &[f32; 2]| a.map(f32::to_bits) == b.map(f32::to_bits);
    let run = |run: &[[f32; 2]]| {
        let bits = run[0].map(|v| v.to_bits().to_le_bytes());
        [(run.len() as u32).to_le_bytes(), bits[0], bits[1]].concat()
    };
    top.chunk_by(same).flat_map(run).collect()
}

/// Decodes the values that [`runs`] wrote; `None` if they are not valid film and pores of either `count` or 0 cells.
fn of_runs(bytes: &[u8], count: usize) -> Option<Vec<[f32; 2]>> {
    let (runs, rest) = bytes.as_chunks::<12>();
    let mut top = Vec::new();
    for run in runs {
        let number = |i: usize| u32::from_le_bytes([run[i], run[i + 1], run[i + 2], run[i + 3]]);
        let [film, soaked] = [4, 8].map(|i| f32::from_bits(number(i)));
        let is_sound = (0.0..1e4).contains(&film) && (0.0..=PORES_MM).contains(&f64::from(soaked));
        let times = number(0) as usize;
        if !is_sound || times == 0 || times > count - top.len() {
            return None;
        }
        top.resize(top.len() + times, [film, soaked]);
    }
    (rest.is_empty() && (top.is_empty() || top.len() == count)).then_some(top)
}

/// Offset that makes places non-negative: they lie within 2^30 cells of the origin.
const MIDDLE: i32 = 1 << 30;

/// Returns a place as a word: columns east in the upper 32 bits, rows north in the lower.
fn word(place: [i32; 2]) -> u64 {
    let [x, y] = place.map(|v| u64::from(v.wrapping_add(MIDDLE) as u32));
    x << 32 | y
}

impl SavedTiles {
    /// Creates the saved form. If `for_hash`, film and pores of each tile are given only by their hash.
    pub fn of(water: &TiledWater, terrain: &Terrain, for_hash: bool) -> Self {
        let tiles = water.keys.iter().filter_map(|(key, slot)| {
            let tile = water.tiles[*slot as usize].as_ref()?;
            let text = |_: &()| if for_hash { format!("{:x}", tile.hash()) } else { binary_text(&runs(tile.tops())) };
            Some(SavedWaterTile {
                tile: [key.east, key.north],
                cells: format!("{:016x}", terrain.tile(*slot).hash),
                water: tile.begun.then_some(()).as_ref().map(text),
            })
        });
        // Sorts the lakes by their words, so that the order does not depend on the history.
        let mut lakes: Vec<(Vec<u64>, u64)> = water
            .lakes
            .saved()
            .map(|(branches, held)| {
                let number = |b: &LakeBranch| match b {
                    LakeBranch::Pit(pit) => word(terrain.place(*pit)),
                    LakeBranch::Joined => JOINED,
                };
                (branches.iter().map(number).collect(), held.to_bits())
            })
            .collect();
        lakes.sort_unstable();
        let desc = &terrain.desc;
        Self {
            origin_m: desc.origin.to_array(),
            cell_m: desc.cell_m,
            tile_cells: desc.tile_cells,
            tiles: tiles.collect(),
            lakes: words(
                lakes.iter().flat_map(|(pits, _)| std::iter::once(pits.len() as u64).chain(pits.iter().copied())),
            ),
            held: words(lakes.iter().map(|(_, held)| *held)),
        }
    }

    /// Checks that the terrain is the one of the state: the same lattice, and the same tiles with the same heights and
    /// classes.
    fn check(&self, terrain: Option<&Terrain>) -> Result<()> {
        let unfit =
            |what: String| Err(Error::invalid("state", format!("holds the water of a terrain of tiles: {what}")));
        let Some(terrain) = terrain else { return unfit("set the terrain and its tiles before".into()) };
        let desc = TerrainDesc { origin: self.origin_m.into(), cell_m: self.cell_m, tile_cells: self.tile_cells };
        if terrain.desc != desc {
            return unfit(format!("its lattice is {desc:?}, here {:?}", terrain.desc));
        }
        let mut here = terrain.all().map(|(_, tile)| (tile.key, format!("{:016x}", tile.hash)));
        for saved in &self.tiles {
            let key = TileKey::new(saved.tile[0], saved.tile[1]);
            let at = || format!("tile ({}, {})", key.east, key.north);
            match here.next() {
                Some((own, cells)) if own == key && cells == saved.cells => {}
                Some((own, _)) if own == key => return unfit(format!("{} has other cells here", at())),
                _ => return unfit(format!("{} must be set as it was, and no other before it", at())),
            }
        }
        match here.next() {
            Some((key, _)) => unfit(format!("tile ({}, {}) is not in the state", key.east, key.north)),
            None => Ok(()),
        }
    }

    /// Returns the saved water, on the terrain that the host has set.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the state is of another terrain, [`crate::Status::Parse`] if the values
    /// cannot be water on this terrain.
    pub fn water(&self, terrain: Option<&Terrain>) -> Result<TiledWater> {
        self.check(terrain)?;
        let unfit = || parse_error("terrain_tiles must be the water that these tiles can hold");
        let terrain = terrain.ok_or_else(unfit)?;
        let mut water = TiledWater::of_all(terrain);
        for saved in &self.tiles {
            let slot = terrain.slot(TileKey::new(saved.tile[0], saved.tile[1]));
            let tile = slot.and_then(|slot| water.tiles[slot as usize].as_mut()).ok_or_else(unfit)?;
            if let Some(text) = &saved.water {
                let top = text_binary(text).and_then(|bytes| of_runs(&bytes, terrain.side() * terrain.side()));
                tile.restore(top.ok_or_else(unfit)?);
            }
        }
        self.restore_lakes(&mut water, terrain).ok_or_else(unfit)?;
        Ok(water)
    }

    /// Restores the lakes; `None` if these tiles cannot hold them.
    fn restore_lakes(&self, water: &mut TiledWater, terrain: &Terrain) -> Option<()> {
        let count = |text: &str| {
            let times = |w: &str| w.split_once('*').map_or(Some(1), |(_, n)| n.parse::<usize>().ok());
            let sum = text.split_whitespace().map(times).try_fold(0usize, |sum, n| sum.checked_add(n?));
            sum.filter(|n| *n <= 4 * crate::terrain::MAX_TERRAIN_CELLS)
        };
        let held = values(&self.held, count(&self.held)?)?;
        let mut numbers = values(&self.lakes, count(&self.lakes)?)?.into_iter();
        let TiledWater { tiles, lakes, .. } = water;
        let below = |cell| pit_below(tiles, terrain, cell);
        for held in held {
            let length = numbers.next()?;
            let branch = |n: u64| match n {
                JOINED => Some(LakeBranch::Joined),
                n => {
                    let place = [(n >> 32) as u32, n as u32].map(|v| (v as i32).wrapping_sub(MIDDLE));
                    terrain.cell_at(place).map(LakeBranch::Pit)
                }
            };
            let branches: Vec<LakeBranch> =
                numbers.by_ref().take(usize::try_from(length).ok()?).map(branch).collect::<Option<_>>()?;
            lakes.restore(terrain, &below, &branches, f64::from_bits(held)).then_some(())?;
        }
        numbers.next().is_none().then_some(())?;
        (water.covered, water.cells) =
            (lakes.covered(), (terrain.all().len() * terrain.side() * terrain.side()) as f64);
        Some(())
    }
}
