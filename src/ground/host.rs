//! Water on the host's grid: the precipitation on each cell, and how the water is stepped together with that of level,
//! open ground.

use glam::{DMat3, DVec2};

use super::{
    grid::GroundGrid,
    host_rain::AreasOverGrid,
    rain_on::{GridRain, RainStep},
    state::{GroundModel, GroundState, GroundStep},
    terrain::{GridTerrain, TerrainWater},
    water::{GroundWater, STEP_S, Step},
};
use crate::{
    error::Result,
    scene::WorldFrame,
    surroundings::Shelter,
    weather::{Conditions, Falling},
    world::World,
};

/// Water of one cell of the host's terrain, for the host's own materials.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct GroundCell {
    /// Water between and on the grains, mm; 0 under standing water.
    pub film_mm: f32,
    /// Water in the pores, as a share of their capacity.
    pub soaked: f32,
    /// Depth of standing water, mm.
    pub standing_mm: f32,
    /// Share of the cell under ice, in the present weather. On a grid, boxes that stand still keep freezing rain off a
    /// cell, and thus the ice of this rain.
    pub ice: f32,
}

/// Terrain of the host and the water on it.
pub(super) struct HostGround {
    pub terrain: GridTerrain,
    /// Rotation from the host's axes to east, north, up at the grid's origin.
    pub to_enu: DMat3,
    /// Precipitation on the grid's cells, less the part that boxes keep off.
    pub rain: GridRain,
    pub water: TerrainWater,
    /// Whether `water` is a simulated state; otherwise it is derived from `shown`.
    pub begun: bool,
    /// Inputs from which `water` was derived last; `None` if it must be derived anew.
    shown: Option<CellInputs>,
}

/// Inputs from which the water of cells without a state is derived.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CellInputs {
    /// Water of level, open ground.
    water: GroundWater,
    falling: Falling,
    /// Wind, east and north, m/s.
    wind: DVec2,
    /// Relative humidity, 0 to 1.
    humidity: f64,
    /// Beginning of the present 10-s slot, s, if there are rain areas, which move; otherwise 0.
    slot: f64,
    /// Revision of the rain areas and shelters.
    surroundings: u64,
}

impl HostGround {
    /// Creates a dry terrain from the host's grid.
    pub fn new(grid: GroundGrid, world: &WorldFrame) -> Self {
        let frame = world.frame_at(grid.origin);
        let terrain = GridTerrain::new(grid);
        let water = TerrainWater::new(&terrain, |_| GroundWater::default());
        let rain = GridRain::new(&terrain.grid.cells(), (frame.world_to_enu, frame.place.altitude_m));
        Self { to_enu: frame.world_to_enu, rain, terrain, water, begun: false, shown: None }
    }

    /// Returns the share of a cell under ice.
    pub fn ice(&self, cell: usize) -> f32 {
        self.rain.ice(cell)
    }

    /// Advances the water by a step. Returns whether it may have changed.
    fn step(&mut self, now: &RainStep<'_>, overs: &AreasOverGrid, shelters: &[Shelter]) -> bool {
        let rains = overs.rain(now.forcing);
        if !rains && self.water.is_dry() {
            return false;
        }
        let step = Step::new(now.forcing, now.seconds);
        if rains {
            self.rain.fall(&self.terrain.grid.cells(), now, overs, shelters);
            let rain = &self.rain;
            self.water.step(&self.terrain, &step, |run| rain.rains_on(run), |cell| rain.fallen_mm(cell));
        } else {
            self.water.step(&self.terrain, &step, |_| false, |_| 0.0);
        }
        true
    }

    /// Sets each cell to `water`, the water of level, open ground. Cells under boxes get less, and cells in rain areas
    /// more.
    fn show(&mut self, c: &Conditions, water: &GroundWater, overs: &AreasOverGrid, shelters: &[Shelter]) {
        let cells = self.rain.first_water(&self.terrain.grid.cells(), (c, water), overs, shelters);
        self.water = TerrainWater::new(&self.terrain, |cell| cells[cell]);
    }

    /// Advances the water by the step `step` of level, open ground. Returns whether it may have changed.
    pub fn advance(&mut self, world: &World, step: &GroundStep<'_>) -> Result<bool> {
        let GroundStep { from_s, seconds, water, .. } = *step;
        let local = step.in_regions(world, self.rain.whole.middle);
        let (conditions, forcing) = local.as_ref().map_or((step.conditions, step.forcing), |(c, forcing)| (c, forcing));
        let overs = self.rain.overs(world, from_s + 0.5 * seconds, conditions)?;
        let shelters = &world.set.shelters;
        if !self.begun {
            self.show(conditions, water, &overs, shelters);
            self.begun = true;
        }
        Ok(self.step(&RainStep { conditions, forcing, seconds }, &overs, shelters))
    }

    /// Discards the state; the next step begins a new one with the water that level, open ground then has.
    pub fn begin_anew(&mut self) {
        (self.begun, self.shown) = (false, None);
    }

    /// Updates the values that depend only on the present weather, areas and shelter: the ice, and the water of a grid
    /// without a state. Returns whether anything may have changed.
    pub fn refresh(&mut self, world: &World, model: GroundModel, state: Option<&GroundState>) -> Result<bool> {
        // Takes the weather at the beginning of the present step, so that the derived water changes only as often as a
        // stepped state: weather and areas may change at any time.
        let slot_s = ((world.time_s / STEP_S).floor() * STEP_S).max(world.timeline.known_from_s());
        let c = world.over().weather_at(self.rain.whole.middle, slot_s);
        if self.begun && c.surface.ice == 0.0 && !self.rain.is_iced() {
            return Ok(false);
        }
        let overs = self.rain.overs(world, slot_s, &c)?;
        let shelters = &world.set.shelters;
        let iced = self.rain.ice_over(&self.terrain.grid.cells(), &c, &overs, shelters);
        if self.begun {
            return Ok(iced);
        }
        let water = match (model, state) {
            (GroundModel::Simulated, Some(state)) => state.water(),
            _ => GroundWater::of_cover(&c.surface),
        };
        let shown = CellInputs {
            water,
            falling: c.precipitation,
            wind: DVec2::new(c.wind.east_m_s, c.wind.north_m_s),
            humidity: c.air.relative_humidity,
            slot: if world.set.regions.is_empty() { 0.0 } else { slot_s },
            surroundings: world.surroundings_revision,
        };
        if self.shown == Some(shown) {
            return Ok(iced);
        }
        self.show(&c, &water, &overs, shelters);
        self.shown = Some(shown);
        Ok(true)
    }
}
