//! Where a field of snow lies: the heights of the world's terrain, the standing boxes on it, and the wind over it.
//!
//! All that the snow knows of the host's terrain goes through here.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{
    column::Column,
    field::{Land, WindOver},
};
use crate::{
    falling::flakes::aggregate_speed_m_s,
    surroundings::{Shelter, TerrainHeights, shelter::sheltered},
    weather::Conditions,
    world::World,
};

/// So far above the ground is what counts as its surface, m.
const SURFACE_M: f64 = 0.02;
/// A box whose underside is higher above the ground than this lets the wind through, m.
const GAP_M: f64 = 0.3;
/// What lies higher above the snow than this, m, is on something that stands on it.
const ABOVE_M: f64 = 3.0;
/// Height at which a wind that varies in space is asked, m.
const ASKED_M: f64 = 2.0;
/// The flakes whose fall decides what boxes keep off, mm.
const FLAKE_MM: f64 = 4.0;

/// The ground of a field of snow.
pub(super) struct Site {
    pub terrain: Arc<TerrainHeights>,
    pub land: Land,
    boxes: Vec<Shelter>,
    slant: DVec3,
    winds: Vec<DVec2>,
}

impl Site {
    pub fn new(terrain: Arc<TerrainHeights>) -> Self {
        let land = Land {
            nodes: terrain.nodes.map(|n| n as usize),
            cell_m: terrain.cell_m,
            heights_m: terrain.heights_m.iter().map(|h| f64::from(*h)).collect(),
            obstacles_m: Vec::new(),
            sheltered: Vec::new(),
        };
        Self { terrain, land, boxes: Vec::new(), slant: DVec3::ZERO, winds: Vec::new() }
    }

    /// Whether another terrain has its nodes at the same places, however high.
    pub fn has_places_of(&self, other: &TerrainHeights) -> bool {
        let t = &self.terrain;
        (t.origin, t.cell_m, t.nodes) == (other.origin, other.cell_m, other.nodes)
    }

    /// East and north of the first node, m, and the height over it.
    pub fn local(&self, position: DVec3) -> DVec3 {
        self.terrain.to_enu * (position - self.terrain.origin)
    }

    pub fn position(&self, local: DVec3) -> DVec3 {
        self.terrain.origin + self.terrain.to_enu.transpose() * local
    }

    /// Where the ground of a cell lies.
    pub fn cell_position(&self, cell: usize) -> DVec3 {
        let columns = self.land.nodes[0];
        let plan = DVec2::new((cell % columns) as f64, (cell / columns) as f64) * self.land.cell_m;
        self.position(plan.extend(self.land.heights_m[cell]))
    }

    /// The four cells about a place and their shares; `None` off the terrain and on what stands above it.
    pub fn about(&self, position: DVec3) -> Option<[(usize, f64); 4]> {
        let p = self.local(position);
        let c = p.truncate() / self.land.cell_m;
        let last = self.land.nodes.map(|n| (n - 1) as f64);
        if !((0.0..=last[0]).contains(&c.x) && (0.0..=last[1]).contains(&c.y)) {
            return None;
        }
        let low = [(c.x as usize).min(self.land.nodes[0] - 2), (c.y as usize).min(self.land.nodes[1] - 2)];
        let part = c - DVec2::new(low[0] as f64, low[1] as f64);
        let about = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| {
            let share = |on: usize, part: f64| if on == 1 { part } else { 1.0 - part };
            ((low[1] + y) * self.land.nodes[0] + low[0] + x, share(x, part.x) * share(y, part.y))
        });
        let ground: f64 = about.iter().map(|(cell, share)| self.land.heights_m[*cell] * share).sum();
        (p.z <= ground + ABOVE_M).then_some(about)
    }

    /// Finds what the standing boxes keep off and stop under a weather. Says whether something new stands on cells.
    pub fn shade(&mut self, c: &Conditions, shelters: &[Shelter]) -> bool {
        let fall = aggregate_speed_m_s(FLAKE_MM, c.air.temperature_c);
        let wind = DVec2::new(c.wind.east_m_s, c.wind.north_m_s);
        // Eddies bring flakes into the lee, so that no shadow is longer than its box is high.
        let across = wind * (fall / wind.length().max(fall));
        let slant = ((across / fall * 16.0).round() / 16.0).extend(-1.0);
        let standing = || shelters.iter().filter(|s| s.stands());
        let same = self.boxes.iter().eq(standing());
        if same && (slant == self.slant || self.boxes.is_empty()) {
            return false;
        }
        self.slant = slant;
        self.boxes.clear();
        self.boxes.extend(standing());
        let len = if self.boxes.is_empty() { 0 } else { self.land.len() };
        self.land.sheltered.clear();
        self.land.sheltered.resize(len, false);
        if !same {
            self.land.obstacles_m.clear();
            self.land.obstacles_m.resize(len, 0.0);
        }
        for shelter in std::mem::take(&mut self.boxes) {
            self.shade_box(&shelter, !same);
            self.boxes.push(shelter);
        }
        !same
    }

    fn shade_box(&mut self, shelter: &Shelter, stands_anew: bool) {
        let middle = self.local(shelter.center_m);
        let radius = shelter.half_size_m.length() + self.land.cell_m;
        let lowest = self.land.heights_m.iter().fold(f64::MAX, |low, h| h.min(low));
        let run = self.slant.truncate() * (middle.z + radius - lowest).max(0.0);
        let low = (middle.truncate() + run.min(DVec2::ZERO) - radius) / self.land.cell_m;
        let high = (middle.truncate() + run.max(DVec2::ZERO) + radius) / self.land.cell_m;
        let columns = self.land.nodes[0];
        let span = |low: f64, high: f64, nodes: usize| {
            low.ceil().max(0.0) as usize..(high.floor() + 1.0).clamp(0.0, nodes as f64) as usize
        };
        let velocity = self.terrain.to_enu.transpose() * self.slant;
        let up = self.terrain.to_enu.row(2);
        for row in span(low.y, high.y, self.land.nodes[1]) {
            for cell in span(low.x, high.x, columns).map(|column| row * columns + column) {
                let ground = self.cell_position(cell);
                if sheltered(shelter, ground + up * SURFACE_M, velocity) {
                    self.land.sheltered[cell] = true;
                }
                if stands_anew {
                    let height = self.stands_on(shelter, ground, up);
                    self.land.obstacles_m[cell] = self.land.obstacles_m[cell].max(height);
                }
            }
        }
    }

    /// How high a box that reaches the ground stands over it at a cell, m; 0 where it does not.
    fn stands_on(&self, shelter: &Shelter, ground: DVec3, up: DVec3) -> f64 {
        let half_height = (shelter.axes.transpose() * up).abs().dot(shelter.half_size_m);
        let over = up.dot(shelter.center_m - ground);
        let (top, bottom) = (over + half_height, over - half_height);
        if bottom > GAP_M || top <= 0.0 {
            return 0.0;
        }
        // At the box's own height, since it may lean; cells that it only touches count.
        let at = shelter.axes.transpose() * (ground + up * over - shelter.center_m);
        let upright = (shelter.axes.transpose() * up).abs();
        let touches = (0..3).all(|i| {
            let reach =
                shelter.half_size_m[i] + 0.5 * self.land.cell_m * (1.0 - upright[i] * upright[i]).max(0.0).sqrt();
            at[i].abs() <= reach + 1e-9
        });
        if touches { top } else { 0.0 }
    }

    /// The wind at 10 m at a time in the weather `c`: where it varies in space, that of each cell, by the logarithmic law from 2 m.
    pub fn wind(&mut self, world: &World, time_s: f64, c: &Conditions, columns: &[Column]) -> WindOver<'_> {
        let mean = DVec2::new(c.wind.east_m_s, c.wind.north_m_s);
        let Some(volume) = world.wind_volume(time_s) else { return WindOver { mean, local: None } };
        let asked_m = ASKED_M.max(volume.cell_m.z);
        let speed = c.wind.speed_m_s();
        let lower = if speed > 0.0 { c.wind.speed_at_height_m_s(asked_m) / speed } else { 1.0 };
        let mut winds = std::mem::take(&mut self.winds);
        winds.clear();
        winds.extend((0..self.land.len()).map(|cell| {
            let over = DVec3::Z * (columns[cell].depth_m() + asked_m);
            let at = self.cell_position(cell) + self.terrain.to_enu.transpose() * over;
            let about = volume.wind(at, (mean * lower).extend(0.0));
            about.map_or(mean, |w| w.truncate() / lower.max(0.1))
        }));
        self.winds = winds;
        WindOver { mean, local: Some(&self.winds) }
    }
}
