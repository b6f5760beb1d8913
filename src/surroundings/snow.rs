//! Lying snow in the form that other effects read, for drawing, meltwater and reflected light.

use std::collections::{BTreeMap, VecDeque};

/// Length of the time slots in which meltwater is recorded, s.
pub(crate) const MELT_SLOT_S: f64 = 60.0;
/// Number of slots that are kept, for a little more than a day.
const SLOTS: usize = 1500;

/// Snow at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SnowHere {
    /// Depth, m.
    pub depth_m: f64,
    /// Density, kg/m^3; 0 without snow.
    pub density_kg_m3: f64,
    /// Ratio of the liquid water in the snow to the most that it can hold, 0 to 1.
    pub wetness: f64,
    /// Albedo for visible light; 0 without snow.
    pub albedo: f64,
}

/// Influence of lying snow on the water on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Meltwater {
    /// Share of the ground that lies under snow, 0 to 1. The snow takes up the rain that falls there.
    pub covered: f64,
    /// Run-off from the snow, mm/h, averaged over all of the ground.
    pub runoff_mm_h: f64,
}

/// Snow on a tile of the host's terrain.
#[derive(Clone, Debug, Default)]
pub(crate) struct TileSnow {
    /// Snow of each cell in half floats: depth in m, density in kg/m^3, wetness, albedo.
    pub cells: Vec<[u16; 4]>,
    /// Revision of `cells`, changed whenever they may have changed.
    pub revision: u64,
}

/// Lying snow of a world.
#[derive(Clone, Debug, Default)]
pub(crate) struct LyingSnow {
    /// Snow on level, open ground.
    pub country: SnowHere,
    /// Share of level, open ground that snow covers, 0 to 1.
    pub cover: f64,
    /// Wind speed, 10 m above the ground, that must be exceeded for the snow to drift, m/s.
    pub threshold_m_s: f64,
    /// Snow of each node of the host's terrain, in the terrain's order: depth in m, density in kg/m^3, wetness, albedo.
    /// Empty without a terrain.
    pub cells: Vec<[f32; 4]>,
    /// Snow of each of the host's tiles on which snow lies, by the tile's index east and north.
    pub tiles: BTreeMap<[i32; 2], TileSnow>,
    /// Incremented whenever `cells` or `tiles` change.
    pub revision: u64,
    /// Whether any node or tile has snow.
    pub has_cells: bool,
    /// Meltwater of each time slot, by the slot's index: time / [`MELT_SLOT_S`], rounded down.
    melt: VecDeque<(i64, Meltwater)>,
}

impl LyingSnow {
    /// Records the water that leaves the snow from the time `from_s` to `from_s + seconds`, s, for each slot that this
    /// span touches. Slots up to the last one recorded stay as they are.
    pub fn melts(&mut self, from_s: f64, seconds: f64, water: Meltwater) {
        let first = (from_s / MELT_SLOT_S).floor() as i64;
        let last = ((from_s + seconds) / MELT_SLOT_S).ceil() as i64;
        self.melt.reserve(SLOTS - self.melt.len());
        for slot in first..last {
            if self.melt.back().is_some_and(|(known, _)| *known >= slot) {
                continue;
            }
            if self.melt.len() == SLOTS {
                self.melt.pop_front();
            }
            self.melt.push_back((slot, water));
        }
    }

    /// Returns the water of the last recorded slot that is complete at `time_s`, however far the snow has been
    /// simulated since. `None` if there is no such slot.
    pub fn meltwater(&self, time_s: f64) -> Option<Meltwater> {
        let wanted = (time_s / MELT_SLOT_S).floor() as i64 - 1;
        self.melt.iter().rev().find(|(slot, _)| *slot <= wanted).map(|(_, water)| *water)
    }

    /// Removes the recorded water and the snow on tiles.
    pub fn forget(&mut self) {
        self.melt.clear();
        self.tiles.clear();
    }

    /// Removes the snow of all nodes and tiles.
    pub fn show_none(&mut self) {
        self.cells.clear();
        self.tiles.clear();
        self.has_cells = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meltwater_is_that_of_the_last_complete_slot() {
        let mut snow = LyingSnow::default();
        let water = |runoff_mm_h| Meltwater { covered: 1.0, runoff_mm_h };
        snow.melts(10.0, 50.0, water(1.0));
        snow.melts(60.0, 540.0, water(2.0));
        assert_eq!(snow.meltwater(50.0), None);
        assert_eq!(snow.meltwater(60.0), Some(water(1.0)));
        assert_eq!((snow.meltwater(120.0), snow.meltwater(1e5)), (Some(water(2.0)), Some(water(2.0))));
        (0..3000).for_each(|i| snow.melts(600.0 + 60.0 * f64::from(i), 60.0, water(3.0)));
        assert_eq!(snow.meltwater(500.0), None, "a day is kept");
    }
}
