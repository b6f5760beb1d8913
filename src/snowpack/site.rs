//! Site of a snow field: the heights of the world's grid or tiles, the boxes that stand on them, and the wind over
//! them.
//!
//! Lying snow reads the host's terrain only through this file.

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};

use super::{column::Column, field::SnowField, patch::Patch};
use crate::{
    falling::flakes::aggregate_speed_m_s,
    surroundings::{
        Shelter, TerrainHeights,
        shelter::{met_at, sheltered},
    },
    terrain::{Terrain, TileKey},
    weather::{Conditions, WindProfile},
    wind::WindVolume,
    world::World,
};

/// Height above the ground of the point for which shelter from falling snow is tested, m.
const SURFACE_M: f64 = 0.02;
/// Largest height of a box's underside above the ground at which the box still stands on it, m. Wind and snow pass
/// under a higher box.
const GAP_M: f64 = 0.3;
/// Height above the ground above which a queried position counts as being on an object, m.
const ABOVE_M: f64 = 3.0;
/// Least height over the snow at which a wind that varies in space is sampled, m.
const ASKED_M: f64 = 2.0;
/// Number of steps in which a flake's path is traced back from the ground to the top of a box if the air is calm.
const WAY_PARTS: f64 = 12.0;
/// Largest number of steps in which a flake's path is traced back.
const MOST_PARTS: u32 = 24;
/// Diameter of the flakes whose paths decide which cells boxes shelter, mm.
const FLAKE_MM: f64 = 4.0;

/// Source of the ground.
enum Ground {
    Grid(Arc<TerrainHeights>),
    /// Tiles of the terrain with this identity, up to a revision.
    Tiles {
        id: u64,
        revision: u64,
    },
}

/// Ground of a snow field.
pub(super) struct Site {
    ground: Ground,
    /// Position in the host's world, m, of the lattice's first cell at height 0.
    origin: DVec3,
    /// Rotation from the host's axes to east, north, up.
    to_enu: DMat3,
    /// Side of a cell, m.
    cell_m: f64,
    /// Standing boxes for which shelter was found last.
    boxes: Vec<Shelter>,
    /// Direction of the flakes, relative to their fall, for which shelter was found last ([`slant`]).
    slant: DVec3,
    /// Key of the wind that varies in space for which shelter was found last; `None` for a uniform wind.
    air: Option<ShadedIn>,
    /// Whether the ground has changed since shelter was found last.
    stale: bool,
}

/// Inputs of the flakes' paths in a wind that varies in space. Shelter is found again when any of them changes:
/// otherwise it would differ from that of a loaded state, which is found from the current inputs.
#[derive(Clone, Copy, PartialEq)]
struct ShadedIn {
    /// Revision of the wind volume.
    revision: u64,
    /// Wind of the weather.
    weathers: WindProfile,
    /// Fall speed of the flakes, m/s.
    fall: f64,
}

/// Four cells around a place, each with its patch, and their weights; `None` for a cell without ground.
pub(super) type CornerShares = [Option<((usize, usize), f64)>; 4];

impl Site {
    /// Creates a site without boxes and wind. `to_enu` is the rotation from the host's axes to east, north, up at the
    /// `origin`.
    fn new(ground: Ground, (origin, to_enu): (DVec3, DMat3), cell_m: f64) -> Self {
        Self { ground, origin, to_enu, cell_m, boxes: Vec::new(), slant: DVec3::ZERO, air: None, stale: true }
    }

    /// Creates the site of a grid. Snow stays if the nodes are at the same places as those of the grid of `old`, or if
    /// there is no `old` and the loaded snow has as many nodes. On another grid the snow is as deep as on level ground.
    pub fn of_grid(
        terrain: &Arc<TerrainHeights>,
        old: Option<&Self>,
        field: &mut Option<SnowField>,
        country: Column,
    ) -> Self {
        let t = terrain;
        let keeps = match old.map(|old| &old.ground) {
            Some(Ground::Grid(o)) => o.has_nodes_of(t),
            Some(Ground::Tiles { .. }) => false,
            None => true,
        };
        let size = t.nodes.map(|n| n as usize);
        let fits = |f: &SnowField| f.lattice.is_none() && f.patches.len() == 1 && f.len() == t.heights_m.len();
        match field.as_mut().filter(|f| keeps && fits(f)) {
            Some(field) => {
                (field.size, field.cell_m) = (size, t.cell_m);
                field.patches[0].set_ground(t.heights_m.clone(), Vec::new());
            }
            None => {
                let mut new = SnowField::new(size, t.cell_m);
                new.add(Patch::new([0, 0], t.heights_m.clone(), Vec::new(), country));
                *field = Some(new);
            }
        }
        Self::new(Ground::Grid(t.clone()), (t.origin, t.to_enu), t.cell_m)
    }

    /// Creates the site of a tiled terrain whose tiles are not known yet. Loaded snow of the same lattice stays; snow
    /// of the site `old` does not.
    pub fn of_tiles(terrain: &Terrain, old: Option<&Self>, field: &mut Option<SnowField>) -> Self {
        let lattice = [terrain.desc.origin.x, terrain.desc.origin.y, terrain.desc.origin.z, terrain.desc.cell_m];
        let fits = |f: &SnowField| f.lattice == Some(lattice) && f.size == [terrain.side(); 2];
        if old.is_some() || !field.as_ref().is_some_and(fits) {
            let mut new = SnowField::new([terrain.side(); 2], terrain.desc.cell_m);
            new.lattice = Some(lattice);
            *field = Some(new);
        }
        let ground = Ground::Tiles { id: terrain.id, revision: 0 };
        Self::new(ground, (terrain.desc.origin, terrain.to_enu), terrain.desc.cell_m)
    }

    /// Returns whether this is the site of this grid.
    pub fn is_of(&self, terrain: &Arc<TerrainHeights>) -> bool {
        matches!(&self.ground, Ground::Grid(own) if Arc::ptr_eq(own, terrain) || own.hash == terrain.hash)
    }

    /// Returns the revision of these tiles up to which the site knows them; `None` for other ground.
    pub fn seen(&self, terrain: &Terrain) -> Option<u64> {
        match self.ground {
            Ground::Tiles { id, revision } if id == terrain.id => Some(revision),
            _ => None,
        }
    }

    /// Synchronises all tiles with the terrain.
    pub fn follow_all(&mut self, terrain: &Terrain, field: &mut SnowField, country: Column, revision: u64) {
        for at in (0..field.patches.len()).rev() {
            let [east, north] = field.patches[at].key;
            if terrain.slot(TileKey::new(east, north)).is_none() {
                field.remove(at);
            }
        }
        for (_, tile) in terrain.all() {
            self.follow(terrain, tile.key, field, country, revision);
        }
        self.mark_known(terrain);
    }

    /// Synchronises one tile with the terrain: a removed tile loses its snow, a new one starts with the snow of the
    /// open country, a changed one keeps its snow wherever there is ground.
    pub fn follow(&mut self, terrain: &Terrain, key: TileKey, field: &mut SnowField, country: Column, revision: u64) {
        let at = field.find([key.east, key.north]);
        let tile = terrain.slot(key).map(|slot| terrain.tile(slot));
        let (tile, ground) = match (tile, at) {
            (Some(tile), _) => {
                if at.is_ok_and(|at| field.patches[at].tile_revision == tile.revision) {
                    return;
                }
                let hole = |cell| !tile.has_ground(cell);
                let any = tile.says_classes() && (0..tile.heights_m.len()).any(hole);
                let holes = if any { (0..tile.heights_m.len()).map(hole).collect() } else { Vec::new() };
                (tile, (tile.heights_m.clone(), holes))
            }
            (None, at) => {
                at.into_iter().for_each(|at| field.remove(at));
                self.stale = true;
                return;
            }
        };
        match at {
            Ok(at) => {
                let patch = &mut field.patches[at];
                patch.set_ground(ground.0, ground.1);
                patch.tile_revision = tile.revision;
                field.books.taken += patch.clear_blocked();
                patch.changed(revision);
            }
            Err(_) => {
                let mut patch = Patch::new([key.east, key.north], ground.0, ground.1, country);
                patch.tile_revision = tile.revision;
                patch.changed(revision);
                field.add(patch);
            }
        }
        self.stale = true;
    }

    /// Marks the whole terrain as known.
    pub fn mark_known(&mut self, terrain: &Terrain) {
        if let Ground::Tiles { revision, .. } = &mut self.ground {
            *revision = terrain.revision;
        }
    }

    /// Returns a position in metres east and north of the first cell of the lattice, and its height over the origin.
    pub fn local(&self, position: DVec3) -> DVec3 {
        self.to_enu * (position - self.origin)
    }

    /// Returns the position in the host's world, m, of a result of [`Self::local`].
    pub fn position(&self, local: DVec3) -> DVec3 {
        self.origin + self.to_enu.transpose() * local
    }

    /// Returns the position in the host's world, m, of a cell of the lattice, given by its index east and north, at a
    /// height above the origin, m.
    pub fn place(&self, place: [i32; 2], height_m: f64) -> DVec3 {
        self.position((DVec2::new(f64::from(place[0]), f64::from(place[1])) * self.cell_m).extend(height_m))
    }

    /// Returns the cells around a position and their weights; `None` off the terrain, and more than [`ABOVE_M`] above
    /// the ground, as on an object.
    pub fn about(&self, field: &SnowField, position: DVec3) -> Option<CornerShares> {
        let p = self.local(position);
        let c = p.truncate() / self.cell_m;
        if let Ground::Grid(t) = &self.ground {
            let last = t.nodes.map(|n| f64::from(n - 1));
            if !((0.0..=last[0]).contains(&c.x) && (0.0..=last[1]).contains(&c.y)) {
                return None;
            }
        }
        if !c.is_finite() || c.abs().max_element() >= f64::from(1 << 30) {
            return None;
        }
        let (low, part) = (c.floor(), c - c.floor());
        let mut about = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|bit: [i32; 2]| {
            let share = |i: usize| if bit[i] == 1 { part[i] } else { 1.0 - part[i] };
            let cell = field.cell_at([low.x as i32 + bit[0], low.y as i32 + bit[1]])?;
            Some((cell, share(0) * share(1)))
        });
        about[usize::from(part.x >= 0.5) + 2 * usize::from(part.y >= 0.5)]?;
        if about.iter().any(Option::is_none) {
            let all: f64 = about.iter().flatten().map(|(_, share)| share).sum();
            about.iter_mut().flatten().for_each(|(_, share)| *share /= all);
        }
        (p.z <= ground_m(field, &about) + ABOVE_M).then_some(about)
    }

    /// Finds the cells that boxes shelter from falling snow, and the cells on which boxes stand. Only boxes that stand
    /// still are included. Flakes move with `air` where the wind varies in space. Returns whether the boxes or the
    /// ground have changed; `false` if there neither were nor are any boxes.
    pub fn shade(
        &mut self,
        field: &mut SnowField,
        c: &Conditions,
        shelters: &[Shelter],
        air: Option<&SiteWind<'_>>,
    ) -> bool {
        let fall = aggregate_speed_m_s(FLAKE_MM, c.air.temperature_c);
        let slant = slant(DVec2::new(c.wind.east_m_s, c.wind.north_m_s), fall);
        let shaded_in = air.map(|air| ShadedIn { revision: air.volume.revision(), weathers: c.wind, fall });
        let standing = || shelters.iter().filter(|s| s.stands());
        let same = self.boxes.iter().eq(standing()) && !self.stale;
        if same && ((slant == self.slant && shaded_in == self.air) || self.boxes.is_empty()) {
            return false;
        }
        let had_any = !self.boxes.is_empty();
        (self.slant, self.air, self.stale) = (slant, shaded_in, false);
        self.boxes.clear();
        self.boxes.extend(standing());
        if self.boxes.is_empty() && !had_any && field.patches.iter().all(|p| p.sheltered.is_empty()) {
            return false;
        }
        for patch in &mut field.patches {
            patch.sheltered.clear();
            if !same {
                patch.obstacles_m.clear();
            }
            for shelter in &self.boxes {
                self.shade_box((patch, field.size), shelter, !same, air.map(|air| (air, fall)));
            }
        }
        !same
    }

    /// Marks the cells of a patch that a box shelters from falling snow and, if `stands_anew`, those on which it
    /// stands. `air` is a wind that varies in space and the flakes' fall speed, m/s.
    fn shade_box(
        &self,
        (patch, size): (&mut Patch, [usize; 2]),
        shelter: &Shelter,
        stands_anew: bool,
        air: Option<(&SiteWind<'_>, f64)>,
    ) {
        let corner = [0, 1].map(|i| f64::from(patch.key[i]) * size[i] as f64);
        let middle = self.local(shelter.center_m);
        let radius = shelter.half_size_m.length() + self.cell_m;
        let over = (middle.z + radius - patch.lowest_m).max(0.0);
        let (back, on) = match air {
            // The wind may turn in any direction around the box.
            Some(_) => (DVec2::splat(-over), DVec2::splat(over)),
            None => (self.slant.truncate().min(DVec2::ZERO) * over, self.slant.truncate().max(DVec2::ZERO) * over),
        };
        let low = (middle.truncate() + back - radius) / self.cell_m;
        let high = (middle.truncate() + on + radius) / self.cell_m;
        let span = |i: usize| {
            let (low, high) = (low[i] - corner[i], high[i] - corner[i]);
            low.ceil().max(0.0) as usize..(high.floor() + 1.0).clamp(0.0, size[i] as f64) as usize
        };
        let up = self.to_enu.row(2);
        for row in span(1) {
            for column in span(0) {
                let cell = row * size[0] + column;
                let plan = DVec2::new(corner[0] + column as f64, corner[1] + row as f64) * self.cell_m;
                let ground = self.position(plan.extend(f64::from(patch.heights_m[cell])));
                let landed = ground + up * SURFACE_M;
                let is_kept_off = match air {
                    Some((air, fall)) => self.meets(shelter, landed, air, fall),
                    None => sheltered(shelter, landed, self.to_enu.transpose() * self.slant),
                };
                if is_kept_off {
                    patch.sheltered.resize(size[0] * size[1], false);
                    patch.sheltered[cell] = true;
                }
                let height = if stands_anew { self.stands_on(shelter, ground, up) } else { 0.0 };
                if height > 0.0 {
                    patch.obstacles_m.resize(size[0] * size[1], 0.0);
                    patch.obstacles_m[cell] = patch.obstacles_m[cell].max(height);
                }
            }
        }
    }

    /// Returns whether flakes on their way to `landed`, a position in the host's world, meet a box. The path is traced
    /// back until it is above the box, in at most [`MOST_PARTS`] steps. `fall` is the flakes' fall speed, m/s.
    fn meets(&self, shelter: &Shelter, landed: DVec3, air: &SiteWind<'_>, fall: f64) -> bool {
        let up = self.to_enu.row(2);
        let half_height = (shelter.axes.transpose() * up).abs().dot(shelter.half_size_m);
        let top = up.dot(shelter.center_m - landed) + half_height;
        let seconds = top / (WAY_PARTS * fall);
        let (mut at, mut height) = (landed, 0.0);
        for _ in 0..MOST_PARTS {
            if height >= top {
                return false;
            }
            let wind = air.at(at, height);
            let flake = slanted(wind.truncate(), fall).extend((wind.z - fall).min(-0.25 * fall));
            let before = at - self.to_enu.transpose() * flake * seconds;
            if met_at(shelter, at, before).is_some() {
                return true;
            }
            (at, height) = (before, height - flake.z * seconds);
        }
        false
    }

    /// Returns the height, m, by which a box that reaches the ground rises over it at a cell; 0 if the box is not
    /// there.
    fn stands_on(&self, shelter: &Shelter, ground: DVec3, upward: DVec3) -> f64 {
        let half_height = (shelter.axes.transpose() * upward).abs().dot(shelter.half_size_m);
        let over = upward.dot(shelter.center_m - ground);
        let (top, bottom) = (over + half_height, over - half_height);
        if bottom > GAP_M || top <= 0.0 {
            return 0.0;
        }
        // Tests at the height of the box's centre, since the box may lean. Cells that the box only touches are
        // included.
        let at = shelter.axes.transpose() * (ground + upward * over - shelter.center_m);
        let upright = (shelter.axes.transpose() * upward).abs();
        let touches = (0..3).all(|i| {
            let reach = shelter.half_size_m[i] + 0.5 * self.cell_m * (1.0 - upright[i] * upright[i]).max(0.0).sqrt();
            at[i].abs() <= reach + 1e-9
        });
        if touches { top } else { 0.0 }
    }

    /// Returns the wind that varies in space at a time in the weather `c`; `None` if the wind is uniform then.
    pub fn air<'w>(&self, world: &'w World, time_s: f64, c: &'w Conditions) -> Option<SiteWind<'w>> {
        let volume = world.wind_volume(time_s)?;
        let mean = DVec2::new(c.wind.east_m_s, c.wind.north_m_s);
        Some(SiteWind { volume, mean, c, origin: self.origin, from_enu: self.to_enu.transpose(), cell_m: self.cell_m })
    }
}

/// Wind that varies in space, over a site.
pub(super) struct SiteWind<'w> {
    volume: &'w WindVolume,
    /// Wind of the weather at 10 m, east and north, m/s.
    mean: DVec2,
    /// Weather, from whose profile the wind at other heights follows.
    c: &'w Conditions,
    /// Position of the lattice's first cell at height 0 in the host's world, m.
    origin: DVec3,
    /// Rotation from east, north, up to the host's axes.
    from_enu: DMat3,
    /// Side of a cell of the site, m.
    cell_m: f64,
}

impl SiteWind<'_> {
    /// Returns the ratio of the weather's wind at this height over the ground to that at 10 m.
    fn lower(&self, height_m: f64) -> f64 {
        let speed = self.c.wind.speed_m_s();
        if speed > 0.0 { self.c.wind.speed_at_height_m_s(height_m) / speed } else { 1.0 }
    }

    /// Returns the wind at a place of the host's world and this height over the ground: east, north, up, m/s.
    fn at(&self, position: DVec3, height_m: f64) -> DVec3 {
        let weathers = (self.mean * self.lower(height_m)).extend(0.0);
        self.volume.wind(position, weathers).unwrap_or(weathers)
    }

    /// Returns the wind at 10 m over a cell of the lattice, given by its index east and north and the height of its
    /// snow's surface, m: east and north, m/s. It is the wind 2 m above the snow (or one cell of the wind volume above
    /// the snow, if that is more), extrapolated to 10 m by the logarithmic law. Outside the wind volume it is the
    /// weather's wind.
    pub fn over(&self, place: [i32; 2], surface_m: f64) -> DVec2 {
        let asked_m = ASKED_M.max(self.volume.cell_m.z);
        let lower = self.lower(asked_m);
        let plan = DVec2::new(f64::from(place[0]), f64::from(place[1])) * self.cell_m;
        let at = self.origin + self.from_enu * plan.extend(surface_m + asked_m);
        let about = self.volume.wind(at, (self.mean * lower).extend(0.0));
        about.map_or(self.mean, |w| w.truncate() / lower.max(0.1))
    }
}

/// Returns the horizontal velocity with which flakes of this fall speed move in a wind, m/s. It is at most the fall
/// speed: eddies bring flakes into the lee, so a shadow is never longer than its box is high.
fn slanted(wind: DVec2, fall: f64) -> DVec2 {
    wind * (fall / wind.length().max(fall))
}

/// Returns the direction of flakes in a wind, (east, north, -1): the horizontal distance per metre of fall, rounded to
/// sixteenths so that small changes of the wind do not change the direction.
fn slant(wind: DVec2, fall: f64) -> DVec3 {
    (slanted(wind, fall) / fall * 16.0).round().extend(-16.0) / 16.0
}

/// Returns the mean height of the ground of four cells with their weights, m.
pub(super) fn ground_m(field: &SnowField, corners: &CornerShares) -> f64 {
    corners
        .iter()
        .flatten()
        .map(|((patch, cell), share)| f64::from(field.patches[*patch].heights_m[*cell]) * share)
        .sum()
}
