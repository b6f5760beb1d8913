//! Saved form of the host's grid and its water as text. Each number is the hexadecimal word of its bits; a run of n
//! equal numbers is written as "bits*n".

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{
    class::SurfaceClass,
    grid::{GroundGrid, MAX_GRID_NODES},
    host::HostGround,
    terrain::TerrainWater,
};
use crate::{
    scene::WorldFrame,
    world::{values, words},
};

/// Saved grid, with its water if the water is a simulated state.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedGround {
    /// Position of the first node in the host's world, m.
    origin_m: [f64; 3],
    /// Distance between neighbouring nodes, m.
    cell_m: f64,
    /// Numbers of nodes east and north.
    nodes: [u32; 2],
    /// Heights of the nodes, m, as bits of f32.
    heights_m: String,
    /// Numbers of the cells' classes; left out if no cell has one.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    classes: String,
    /// Film and soaked water of each cell, mm, and water in each hollow, mm times cells (-1 for a hollow whose parts
    /// hold separate lakes), as bits of f64.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    water: Option<[String; 3]>,
}

impl SavedGround {
    /// Creates the saved form of a grid and its water.
    pub fn of(held: &HostGround) -> Self {
        let grid = &held.terrain.grid;
        let column = |i: usize| words(held.water.top.iter().map(move |t| t[i].to_bits()));
        let held_by = || words(held.water.held().iter().map(|v| v.to_bits()));
        Self {
            origin_m: grid.origin.to_array(),
            cell_m: grid.cell_m,
            nodes: grid.nodes,
            heights_m: words(grid.heights_m.iter().map(|h| u64::from(h.to_bits()))),
            classes: words(grid.classes.iter().map(|c| *c as u64)),
            water: held.begun.then(|| [column(0), column(1), held_by()]),
        }
    }

    /// Returns the saved ground, or `None` if it is not valid.
    pub fn host_ground(&self, world: &WorldFrame) -> Option<HostGround> {
        if self.nodes.iter().any(|n| *n > MAX_GRID_NODES) {
            return None;
        }
        let count = self.nodes[0] as usize * self.nodes[1] as usize;
        let heights_m = values(&self.heights_m, count)?.into_iter().map(|b| Some(f32::from_bits(b.try_into().ok()?)));
        let classes = values(&self.classes, if self.classes.is_empty() { 0 } else { count })?.into_iter();
        let classes = classes.map(|n| SurfaceClass::from_number("classes", n.try_into().ok()?).ok());
        let classes = classes.collect::<Option<Vec<_>>>()?;
        let (origin, cell_m) = (DVec3::from(self.origin_m), self.cell_m);
        let heights_m = heights_m.collect::<Option<_>>()?;
        let grid = GroundGrid { origin, cell_m, nodes: self.nodes, heights_m, classes };
        grid.validate().ok()?;
        world.place_at("origin", origin).ok()?;
        let mut held = HostGround::new(grid, world);
        if let Some([film, soaked, hollows]) = &self.water {
            let floats = |text: &str, count| Some(values(text, count)?.into_iter().map(f64::from_bits));
            let top = floats(film, count)?.zip(floats(soaked, count)?).map(|(f, s)| [f, s]).collect();
            let held_by = floats(hollows, held.water.held().len())?.collect();
            held.water = TerrainWater::from_parts(&held.terrain, top, held_by)?;
            held.begun = true;
        }
        Some(held)
    }
}
