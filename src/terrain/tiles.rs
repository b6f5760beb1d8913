//! Tiles of a terrain, found by key, by position and by number.

use std::{
    collections::BTreeMap,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering::Relaxed},
    },
};

use glam::{DMat3, DVec2, DVec3};

use super::{
    CellRect, DugCell, DugColor, MAX_TERRAIN_CELLS, RecentChanges, SurfaceClass, TerrainCells, TerrainDesc, Tile,
    TileKey,
};
use crate::{
    chance::mixed,
    error::{Error, Result},
    scene::WorldFrame,
};

/// Number of a cell in the terrain: the slot of its tile in the upper bits, the index in the tile in the lower ones.
pub(crate) type CellId = u32;

/// Offsets of the eight neighbours of a cell, east and north.
pub(crate) const AROUND: [[i32; 2]; 8] = [[-1, -1], [0, -1], [1, -1], [-1, 0], [1, 0], [-1, 1], [0, 1], [1, 1]];

/// The terrain at one position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainPoint {
    /// Height of the ground above the terrain's origin, m, on the triangle of three neighbouring cells.
    pub height_m: f64,
    /// Unit normal of the ground's triangle in the host's axes, upwards.
    pub normal: DVec3,
    /// Material of the nearest cell.
    pub surface_class: SurfaceClass,
    /// Tile of the nearest cell.
    pub tile: TileKey,
    /// Revision of the terrain at the last change of the nearest cell's tile
    /// ([`Context::terrain_revision`](crate::context::Context::terrain_revision)).
    pub revision: u64,
}

/// Height and slope of the ground's triangle at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Facet {
    /// Height above the terrain's origin, m.
    pub height_m: f64,
    /// Rise over run to the east and the north.
    pub slope: DVec2,
}

/// The host's terrain. Copies share its tiles.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Terrain {
    /// Number that only copies of this terrain share.
    pub id: u64,
    pub desc: TerrainDesc,
    /// Rotation from the host's axes to east, north, up at the origin.
    pub to_enu: DMat3,
    /// Altitude of the origin, m.
    pub altitude_m: f64,
    /// Binary logarithm of the number of cells along a side of a tile.
    bits: u32,
    /// Tiles by slot; slots that `slots` does not name are empty.
    tiles: Vec<Arc<Tile>>,
    slots: BTreeMap<TileKey, u32>,
    /// Rectangle that contains all tiles.
    pub bounds: Option<CellRect>,
    /// Revision, which grows with every change.
    pub revision: u64,
    /// Revision after the host's last change.
    pub host_revision: u64,
    /// Revision of the soil up to which the heights include the soil's changes.
    pub soil_revision: u64,
    /// Soil below the undug surface. Walls of dug ground show this soil.
    pub surface_soil: DugColor,
    /// Hash, equal for terrains with equal tiles.
    pub hash: u64,
    /// Last changes of the terrain's cells.
    pub recent: RecentChanges,
}

fn hash_of(tile: &Tile) -> u64 {
    let key = u64::from(tile.key.east as u32) << 32 | u64::from(tile.key.north as u32);
    mixed(tile.hash ^ mixed(key))
}

impl Terrain {
    /// Creates a terrain without tiles.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn new(desc: TerrainDesc, world: &WorldFrame) -> Result<Self> {
        desc.validate()?;
        let frame = world.place_at("terrain.origin_m", desc.origin)?;
        static NEXT: AtomicU64 = AtomicU64::new(1);
        Ok(Self {
            id: NEXT.fetch_add(1, Relaxed),
            desc,
            to_enu: frame.world_to_enu,
            altitude_m: frame.place.altitude_m,
            bits: desc.tile_cells.trailing_zeros(),
            tiles: Vec::new(),
            slots: BTreeMap::new(),
            bounds: None,
            revision: 1,
            host_revision: 1,
            soil_revision: 0,
            surface_soil: DugColor::default(),
            hash: 0,
            recent: RecentChanges::default(),
        })
    }

    /// Number of cells along a side of a tile.
    pub fn side(&self) -> usize {
        self.desc.tile_cells as usize
    }

    /// All tiles in the order of their keys, with their slots.
    pub fn all(&self) -> impl ExactSizeIterator<Item = (u32, &Tile)> {
        self.slots.values().map(|slot| (*slot, self.tile(*slot)))
    }

    /// Tile in a slot.
    pub fn tile(&self, slot: u32) -> &Tile {
        &self.tiles[slot as usize]
    }

    /// Slot of a tile.
    pub fn slot(&self, key: TileKey) -> Option<u32> {
        self.slots.get(&key).copied()
    }

    /// Key of the tile that holds a lattice position, whether or not the terrain has this tile.
    pub fn key_of(&self, [x, y]: [i32; 2]) -> TileKey {
        TileKey::new(x >> self.bits, y >> self.bits)
    }

    /// Slot of the tile that holds a lattice position.
    pub fn slot_at(&self, [x, y]: [i32; 2]) -> Option<u32> {
        self.slot(TileKey::new(x >> self.bits, y >> self.bits))
    }

    /// Rectangle of a tile's cells on the lattice.
    pub fn rect(&self, key: TileKey) -> CellRect {
        let low = [key.east, key.north].map(|k| k << self.bits);
        CellRect { low, high: low.map(|v| v + (1 << self.bits)) }
    }

    /// Keys of the tiles that a rectangle touches, whether or not the terrain has these tiles.
    pub fn keys_within(&self, rect: CellRect) -> impl Iterator<Item = TileKey> + use<> {
        let bits = self.bits;
        let along = move |i: usize| (rect.low[i] >> bits)..=((rect.high[i] - 1) >> bits);
        along(1).flat_map(move |north| along(0).map(move |east| TileKey { east, north }))
    }

    /// Index within its tile of the cell at a lattice position.
    pub fn in_tile(&self, [x, y]: [i32; 2]) -> usize {
        let mask = (1 << self.bits) - 1;
        ((y & mask) as usize) << self.bits | (x & mask) as usize
    }

    /// Lattice position of a cell of a tile.
    pub fn place_in(&self, key: TileKey, cell: usize) -> [i32; 2] {
        let low = self.rect(key).low;
        let mask = (1usize << self.bits) - 1;
        [low[0] + (cell & mask) as i32, low[1] + (cell >> self.bits) as i32]
    }

    /// Position of the south-western cell of a tile, at height 0, in the host's world.
    pub fn origin_of(&self, key: TileKey) -> DVec3 {
        let low = self.rect(key).low;
        let plan = DVec3::new(f64::from(low[0]), f64::from(low[1]), 0.0) * self.desc.cell_m;
        self.desc.origin + self.to_enu.transpose() * plan
    }

    /// Adds a tile, or replaces the cells of the tile that has this key. Returns the tile's rectangle; `None` if no
    /// cell has changed.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; then nothing changes.
    pub fn set_tile(&mut self, cells: &TerrainCells<'_>) -> Result<Option<CellRect>> {
        let side = self.desc.tile_cells;
        self.check(cells)?;
        if cells.size_in(side) != [side; 2] {
            let wanted = format!("the whole tile, {side} x {side}, or 0 x 0 for it");
            let got = format!("{} x {}", cells.size[0], cells.size[1]);
            return Err(Error::range("terrain_cells.cells", &wanted, got));
        }
        if cells.heights_m.values.is_empty() {
            return Err(Error::range("terrain_cells.heights_m.len", &format!("{}, one a cell", side * side), 0));
        }
        if self.slot(cells.key).is_some() {
            return Ok(self.take(cells));
        }
        if self.slots.len() >= self.desc.most_tiles() {
            let most = self.desc.most_tiles();
            let wanted = format!("one of at most {most} tiles of {side} x {side}, {MAX_TERRAIN_CELLS} cells");
            return Err(Error::range("terrain_cells.tile", &wanted, "one more"));
        }
        let mut tile = Tile::level(cells.key, side);
        tile.take(cells, side);
        self.revision += 1;
        (tile.revision, self.host_revision) = (self.revision, self.revision);
        self.hash = self.hash.wrapping_add(hash_of(&tile));
        let free = self.tiles.iter().position(|t| t.heights_m.is_empty()).unwrap_or(self.tiles.len());
        if free == self.tiles.len() {
            self.tiles.push(Arc::new(tile));
        } else {
            self.tiles[free] = Arc::new(tile);
        }
        self.slots.insert(cells.key, free as u32);
        let rect = self.rect(cells.key);
        self.bounds = Some(self.bounds.map_or(rect, |b| b.with(rect)));
        self.recent.add(self.revision, rect);
        Ok(Some(rect))
    }

    /// Replaces a rectangle of a tile's cells. Returns that rectangle on the lattice; `None` if no cell has changed.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; then nothing changes.
    pub fn update(&mut self, cells: &TerrainCells<'_>) -> Result<Option<CellRect>> {
        self.check(cells)?;
        let slot = self.known(cells.key)?;
        self.check_no_data(cells, self.tile(slot))?;
        Ok(self.take(cells))
    }

    fn check(&self, cells: &TerrainCells<'_>) -> Result<()> {
        let tile = self.slot(cells.key).map(|slot| self.tile(slot));
        cells.check(self.desc.tile_cells, |cell| tile.is_some_and(|tile| !tile.has_ground(cell)))
    }

    /// Refuses a no-data value that is the height of a cell with ground in the same tile outside the rectangle.
    fn check_no_data(&self, cells: &TerrainCells<'_>, tile: &Tile) -> Result<()> {
        if cells.no_data_m.is_none() {
            return Ok(());
        }
        let (side, size) = (self.desc.tile_cells, cells.size_in(self.desc.tile_cells));
        let is_beside = |cell: usize| {
            let at = [cell as u32 % side, cell as u32 / side];
            (0..2).any(|i| at[i] < cells.first[i] || at[i] - cells.first[i] >= size[i])
        };
        let uses = |cell: &usize| cells.is_no_data(tile.heights_m[*cell]) && tile.has_ground(*cell) && is_beside(*cell);
        match (0..tile.heights_m.len()).find(uses) {
            None => Ok(()),
            Some(cell) => {
                let place = format!("({}, {})", cell as u32 % side, cell as u32 / side);
                let accepted = format!("no height in use, such as that of cell {place} of this tile");
                Err(Error::range("terrain_cells.no_data_m", &accepted, tile.heights_m[cell]))
            }
        }
    }

    /// Slot of a tile, or an error if the tile does not exist.
    fn known(&self, key: TileKey) -> Result<u32> {
        self.slot(key).ok_or_else(|| {
            let got = format!("({}, {})", key.east, key.north);
            Error::range("terrain_cells.tile", "the key of a tile that was set", got)
        })
    }

    fn take(&mut self, cells: &TerrainCells<'_>) -> Option<CellRect> {
        let slot = self.slot(cells.key)? as usize;
        let tile = Arc::make_mut(&mut self.tiles[slot]);
        let before = hash_of(tile);
        if !tile.take(cells, self.desc.tile_cells) {
            return None;
        }
        self.revision += 1;
        (tile.revision, self.host_revision) = (self.revision, self.revision);
        self.hash = self.hash.wrapping_sub(before).wrapping_add(hash_of(tile));
        let corner = self.rect(cells.key).low;
        let low = [0, 1].map(|i| corner[i] + cells.first[i] as i32);
        let size = cells.size_in(self.desc.tile_cells);
        let rect = CellRect { low, high: [0, 1].map(|i| low[i] + size[i] as i32) };
        self.recent.add(self.revision, rect);
        Some(rect)
    }

    /// Removes a tile. Returns the cells that it had.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if there is no such tile.
    pub fn remove(&mut self, key: TileKey) -> Result<CellRect> {
        let slot = self.known(key).map_err(|e| e.renamed("terrain_cells.tile", "tile"))?;
        let tile = std::mem::replace(&mut self.tiles[slot as usize], Arc::new(Tile::none()));
        self.hash = self.hash.wrapping_sub(hash_of(&tile));
        self.slots.remove(&key);
        self.bounds = self.slots.keys().map(|key| self.rect(*key)).reduce(CellRect::with);
        self.revision += 1;
        self.host_revision = self.revision;
        let rect = self.rect(key);
        self.recent.add(self.revision, rect);
        Ok(rect)
    }

    /// Sets the heights and the colours that the soil gives to cells of a tile. If any cell changes, the terrain and
    /// the tile get the revision `revision`. Returns the smallest rectangle around the cells that have changed; `None`
    /// if there are none.
    pub fn set_dug(&mut self, slot: u32, cells: &[DugCell], revision: u64) -> Option<CellRect> {
        let tile = Arc::make_mut(&mut self.tiles[slot as usize]);
        let (key, before) = (tile.key, hash_of(tile));
        let mut changed: Option<CellRect> = None;
        for cell in cells.iter().filter_map(|dug| tile.set_dug(dug).then_some(dug.cell)) {
            let low = [key.east << self.bits, key.north << self.bits];
            let mask = (1usize << self.bits) - 1;
            let low = [low[0] + (cell & mask) as i32, low[1] + (cell >> self.bits) as i32];
            let one = CellRect { low, high: low.map(|v| v + 1) };
            changed = Some(changed.map_or(one, |rect| rect.with(one)));
        }
        if let Some(rect) = changed {
            self.recent.add(revision, rect);
            (self.revision, tile.revision) = (revision, revision);
            self.hash = self.hash.wrapping_sub(before).wrapping_add(hash_of(tile));
        }
        changed
    }

    /// Notes that the heights of a tile include the change by the soil up to revision `soil_revision` of the soil.
    pub fn note_dug(&mut self, slot: u32, soil_revision: u64) {
        Arc::make_mut(&mut self.tiles[slot as usize]).soil_revision = soil_revision;
    }

    /// Undoes all changes by the soil. Returns the rectangles of the tiles that the soil had changed.
    pub fn undo_dug(&mut self) -> Vec<CellRect> {
        let mut changed = Vec::new();
        for tile in self.tiles.iter_mut().filter(|tile| tile.is_dug()) {
            let tile = Arc::make_mut(tile);
            let before = hash_of(tile);
            tile.undo_dug();
            self.revision += 1;
            tile.revision = self.revision;
            self.hash = self.hash.wrapping_sub(before).wrapping_add(hash_of(tile));
            changed.push(tile.key);
        }
        self.soil_revision = 0;
        let changed: Vec<_> = changed.into_iter().map(|key| self.rect(key)).collect();
        changed.iter().for_each(|rect| self.recent.add(self.revision, *rect));
        changed
    }

    /// Height of the cell at a lattice position before anything was dug, m; `None` without ground.
    pub fn undug_m(&self, place: [i32; 2]) -> Option<f64> {
        let (tile, cell) = (self.tile(self.slot_at(place)?), self.in_tile(place));
        tile.has_ground(cell).then(|| f64::from(tile.undug_m(cell)))
    }

    /// Cell at a lattice position, if it has ground.
    pub fn cell_at(&self, place: [i32; 2]) -> Option<CellId> {
        let slot = self.slot_at(place)?;
        let cell = self.in_tile(place);
        self.tile(slot).has_ground(cell).then(|| self.joined(slot, cell))
    }

    /// Slot of a cell's tile, and the cell's index in it.
    pub fn split(&self, id: CellId) -> (usize, usize) {
        ((id >> (2 * self.bits)) as usize, (id & ((1 << (2 * self.bits)) - 1)) as usize)
    }

    /// Cell in the tile of a slot, at an index in the tile.
    pub fn joined(&self, slot: u32, cell: usize) -> CellId {
        slot << (2 * self.bits) | cell as u32
    }

    /// Lattice position of a cell.
    pub fn place(&self, id: CellId) -> [i32; 2] {
        let (slot, cell) = self.split(id);
        self.place_in(self.tile(slot as u32).key, cell)
    }

    /// Height of a cell above the origin, m.
    pub fn height(&self, id: CellId) -> f32 {
        let (slot, cell) = self.split(id);
        self.tile(slot as u32).heights_m[cell]
    }

    /// Whether a cell lies at the border of its tile, whether or not the terrain has the tile beyond.
    pub fn is_at_border(&self, id: CellId) -> bool {
        let mask = (1usize << self.bits) - 1;
        let cell = self.split(id).1;
        [cell & mask, cell >> self.bits].iter().any(|v| *v == 0 || *v == mask)
    }

    /// Returns the eight neighbours of a cell in the order of [`AROUND`], across tile borders; `None` for those without
    /// ground.
    pub fn around(&self, id: CellId) -> [Option<CellId>; 8] {
        let (slot, cell) = self.split(id);
        let mask = (1usize << self.bits) - 1;
        let (x, y) = (cell & mask, cell >> self.bits);
        if x > 0 && y > 0 && x < mask && y < mask {
            let tile = self.tile(slot as u32);
            return AROUND.map(|[dx, dy]| {
                let step = dx + (dy << self.bits);
                tile.has_ground(cell.wrapping_add_signed(step as isize)).then(|| id.wrapping_add_signed(step))
            });
        }
        let at = self.place(id);
        AROUND.map(|[dx, dy]| self.cell_at([at[0] + dx, at[1] + dy]))
    }

    /// Converts a position in the host's world to cells east and north of the origin, and height above the origin, m.
    pub fn cells_at(&self, position: DVec3) -> (DVec2, f64) {
        let p = self.to_enu * (position - self.desc.origin);
        (p.truncate() / self.desc.cell_m, p.z)
    }

    /// Cells for bilinear interpolation at a position in cells east and north of the origin, with their weights. Cells
    /// without ground are left out, and the weights of the others add up to 1. `None` if the nearest cell has no
    /// ground.
    pub fn about(&self, cells: DVec2) -> Option<impl Iterator<Item = (CellId, f64)> + Clone + use<>> {
        if !cells.is_finite() || cells.abs().max_element() >= f64::from(1 << 30) {
            return None;
        }
        let low = cells.floor();
        let part = cells - low;
        let corner = [low.x as i32, low.y as i32];
        let found = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|bit: [i32; 2]| {
            let share = |i: usize| if bit[i] == 1 { part[i] } else { 1.0 - part[i] };
            (self.cell_at([corner[0] + bit[0], corner[1] + bit[1]]), share(0) * share(1))
        });
        let nearest = usize::from(part.x >= 0.5) + 2 * usize::from(part.y >= 0.5);
        found[nearest].0?;
        let all: f64 = found.iter().filter(|f| f.0.is_some()).map(|f| f.1).sum();
        Some(found.into_iter().filter_map(move |(cell, share)| Some((cell?, share / all))))
    }

    /// The facet of the ground at a position in cells east and north of the origin. Each square of four neighbouring
    /// cells is split along the diagonal from its south-western to its north-eastern cell. `None` where a corner of the
    /// triangle has no ground; a corner with weight 0 may lack ground.
    pub fn facet_at(&self, cells: DVec2) -> Option<Facet> {
        if !cells.is_finite() || cells.abs().max_element() >= f64::from(1 << 30) {
            return None;
        }
        let low = cells.floor();
        let (part, [x, y]) = (cells - low, [low.x as i32, low.y as i32]);
        // The third corner lies east or north of the first one.
        let is_south = part.x >= part.y;
        let (large, small) = if is_south { (part.x, part.y) } else { (part.y, part.x) };
        let places = [[x, y], if is_south { [x + 1, y] } else { [x, y + 1] }, [x + 1, y + 1]];
        let weights = [1.0 - large, large - small, small];
        let corners = places.map(|place| self.cell_at(place));
        let is_whole = corners.iter().zip(weights).all(|(corner, weight)| corner.is_some() || weight == 0.0);
        let first = f64::from(self.height(corners[0].filter(|_| is_whole)?));
        let [_, third, last] = corners.map(|corner| corner.map_or(first, |cell| f64::from(self.height(cell))));
        let (along, across) = ((third - first) / self.desc.cell_m, (last - third) / self.desc.cell_m);
        Some(Facet {
            height_m: first * weights[0] + third * weights[1] + last * weights[2],
            slope: if is_south { DVec2::new(along, across) } else { DVec2::new(across, along) },
        })
    }

    /// Height of the ground above the origin, m, at a position in cells east and north of the origin; `None` where
    /// there is no ground.
    pub fn height_at(&self, cells: DVec2) -> Option<f64> {
        Some(self.facet_at(cells)?.height_m)
    }

    /// Returns the height of the ground above the origin, m, at a position in metres east and north of the origin, for
    /// flow over the ground. Outside the rectangle of all tiles it is the height at the rectangle's border. `None`
    /// where there is no ground.
    pub fn height_near(&self, place_m: DVec2) -> Option<f64> {
        let all = self.bounds?;
        let end = |v: [i32; 2], off: i32| DVec2::new(f64::from(v[0] - off), f64::from(v[1] - off));
        self.height_at((place_m / self.desc.cell_m).clamp(end(all.low, 0), end(all.high, 1)))
    }

    /// The terrain at a position in the host's world; `None` where there is no ground.
    pub fn point_at(&self, position: DVec3) -> Option<TerrainPoint> {
        let (cells, _) = self.cells_at(position);
        let facet = self.facet_at(cells)?;
        let nearest = self.about(cells)?.max_by(|a, b| a.1.total_cmp(&b.1))?.0;
        let (slot, cell) = self.split(nearest);
        let tile = self.tile(slot as u32);
        let normal = DVec3::new(-facet.slope.x, -facet.slope.y, 1.0).normalize();
        Some(TerrainPoint {
            height_m: facet.height_m,
            normal: self.to_enu.transpose() * normal,
            surface_class: tile.class(cell),
            tile: tile.key,
            revision: tile.revision,
        })
    }

    /// Hash of the tiles in and next to a rectangle, which is given in metres east and north of the origin.
    pub fn hash_within(&self, low_m: DVec2, high_m: DVec2) -> u64 {
        let tile_m = self.desc.cell_m * f64::from(self.desc.tile_cells);
        // Includes the tiles next to the rectangle, because heights are interpolated between cells.
        let (low, high) = ((low_m / tile_m).floor() - 1.0, (high_m / tile_m).floor() + 1.0);
        let inside = |k: &TileKey| {
            let at = DVec2::new(f64::from(k.east), f64::from(k.north));
            at.cmpge(low).all() && at.cmple(high).all()
        };
        let tiles = self.all().filter(|(_, tile)| inside(&tile.key));
        tiles.fold(0, |sum: u64, (_, tile)| sum.wrapping_add(hash_of(tile)))
    }
}
