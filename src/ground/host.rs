//! Water on the host's terrain: what falls where on it, and how it is led through time beside that of level, open ground.

use glam::{DMat3, DVec2, DVec3};

use super::{
    GroundGrid, GroundModel, GroundWater,
    held::GroundState,
    host_rain::{AreasOverGrid, Part, liquid},
    terrain::{RUN, Terrain, TerrainWater},
    water::{Forcing, STEP_S, Step},
};
use crate::{
    error::Result,
    falling::{drops::factor_in, sizes::DropSizes},
    scene::WorldFrame,
    surroundings::{Shelter, shelter::sheltered},
    weather::{Conditions, Falling, cover_under_rain},
    world::World,
};

/// So far above the ground is what counts as its surface, m.
const SURFACE_M: f64 = 0.02;

/// Water of a cell of the host's terrain, for its own materials.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct GroundCell {
    /// Water between and on the grains, mm; none under standing water.
    pub film_mm: f32,
    /// In the pores, as a share of what they hold.
    pub soaked: f32,
    /// Standing water, mm.
    pub standing_mm: f32,
    /// Share under ice, by the weather of the moment; what freezing rain leaves is not where standing boxes keep it off.
    pub ice: f32,
}

/// The host's terrain and the water on it.
pub(super) struct HostGround {
    pub terrain: Terrain,
    /// Turns the host's axes at the grid's origin, whose altitude this is.
    pub to_enu: DMat3,
    pub altitude_m: f64,
    /// Where the grid lies, and each run of its cells.
    pub whole: Part,
    pub runs: Vec<Part>,
    /// Lowest and highest node.
    range_m: (f64, f64),
    pub water: TerrainWater,
    /// Whether `water` is a state of its own by now; else it is what `shown` makes of it.
    pub begun: bool,
    shown: Option<CellInputs>,
    shadow: Shadow,
    glaze: Glaze,
    /// Room for the rates of the cells.
    rates: Vec<f64>,
}

/// What a cell's water depends on where it has no state.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CellInputs {
    water: GroundWater,
    falling: Falling,
    wind: DVec2,
    humidity: f64,
    slot: f64,
    surroundings: u64,
}

/// How many thirds of the rain the boxes keep off each cell.
#[derive(Default)]
struct Shadow {
    made_for: Option<([f64; 3], DVec2, Vec<Shelter>)>,
    /// Empty where nothing is kept off anywhere.
    thirds: Vec<u8>,
}

impl Shadow {
    fn share(&self, cell: usize) -> f64 {
        self.thirds.get(cell).map_or(1.0, |t| f64::from(3 - t) / 3.0)
    }
}

/// Share of open ground under ice, and what the boxes keep off of freezing rain: by the weather of the moment.
#[derive(Default)]
struct Glaze {
    ice: f64,
    shadow: Shadow,
}

impl HostGround {
    pub fn new(grid: GroundGrid, world: &WorldFrame) -> Self {
        let frame = world.frame_at(grid.origin);
        let terrain = Terrain::new(grid);
        let water = TerrainWater::new(&terrain, |_| GroundWater::default());
        let (whole, runs) = Part::whole_and_runs(&terrain.grid, (&frame.world_to_enu, frame.place.altitude_m));
        Self {
            to_enu: frame.world_to_enu,
            altitude_m: frame.place.altitude_m,
            whole,
            runs,
            range_m: terrain.grid.range(),
            terrain,
            water,
            begun: false,
            shown: None,
            shadow: Shadow::default(),
            glaze: Glaze::default(),
            rates: Vec::new(),
        }
    }

    /// Finds what the standing boxes keep off, and says whether that may be something else than before. `falls_m_s`: of the drops
    /// in the middle of each third of the water; `wind` of the air, east and north.
    fn shade(&self, shadow: &mut Shadow, falls_m_s: [f64; 3], wind: DVec2, shelters: &[Shelter]) -> bool {
        let standing = || shelters.iter().filter(|s| s.stands());
        if let Some((falls, blown, list)) = &shadow.made_for
            && (*falls, *blown) == (falls_m_s, wind)
            && list.iter().eq(standing())
        {
            return false;
        }
        shadow.thirds.clear();
        if standing().next().is_some() {
            shadow.thirds.resize(self.terrain.grid.len(), 0);
            for fall in falls_m_s {
                self.shade_third(&mut shadow.thirds, wind.extend(-fall), standing());
            }
        }
        let mut list = shadow.made_for.take().map_or(Vec::new(), |made| made.2);
        list.clear();
        list.extend(standing());
        shadow.made_for = Some((falls_m_s, wind, list));
        true
    }

    /// Finds what the standing boxes keep off of the rain that falls under the weather `c`.
    fn shade_rain(&mut self, c: &Conditions, overs: &AreasOverGrid, shelters: &[Shelter]) {
        let mut shadow = std::mem::take(&mut self.shadow);
        let wind = DVec2::new(c.wind.east_m_s, c.wind.north_m_s);
        self.shade(&mut shadow, self.falls_m_s(c, overs), wind, shelters);
        self.shadow = shadow;
    }

    /// Takes the ice from the weather, what freezing rain leaves where it gets to. Says whether any of it may have changed.
    fn ice_over(&mut self, c: &Conditions, overs: &AreasOverGrid, shelters: &[Shelter]) -> bool {
        let mut glaze = std::mem::take(&mut self.glaze);
        let mut changed = glaze.ice != c.surface.ice;
        glaze.ice = c.surface.ice;
        if glaze.ice > 0.0 && c.precipitation.freezing * liquid(&c.precipitation) > 0.0 {
            let wind = DVec2::new(c.wind.east_m_s, c.wind.north_m_s);
            changed |= self.shade(&mut glaze.shadow, self.falls_m_s(c, overs), wind, shelters);
        } else {
            changed |= glaze.shadow.made_for.is_some() && glaze.ice > 0.0;
            glaze.shadow = Shadow::default();
        }
        self.glaze = glaze;
        changed
    }

    /// Share of a cell under ice.
    pub fn ice(&self, cell: usize) -> f32 {
        (self.glaze.ice * self.glaze.shadow.share(cell)) as f32
    }

    fn shade_third<'a>(&self, thirds: &mut [u8], velocity: DVec3, shelters: impl Iterator<Item = &'a Shelter> + Clone) {
        let grid = &self.terrain.grid;
        let in_world = self.to_enu.transpose() * velocity;
        let columns = grid.nodes[0] as usize;
        // Each box is asked where its shadow may lie; a cell counts once.
        for (i, shelter) in shelters.clone().enumerate() {
            let Some([x, y]) = self.shadow_within(shelter, velocity) else { continue };
            for (row, column) in (y[0]..=y[1]).flat_map(|row| (x[0]..=x[1]).map(move |column| (row, column))) {
                let cell = row * columns + column;
                let p = grid.node(cell, &self.to_enu) + self.to_enu.transpose() * (DVec3::Z * SURFACE_M);
                if sheltered(shelter, p, in_world) && !shelters.clone().take(i).any(|s| sheltered(s, p, in_world)) {
                    thirds[cell] += 1;
                }
            }
        }
    }

    /// First and last column and row in which the shadow of a box may lie.
    fn shadow_within(&self, shelter: &Shelter, velocity: DVec3) -> Option<[[usize; 2]; 2]> {
        let grid = &self.terrain.grid;
        let center = self.to_enu * (shelter.center_m - grid.origin);
        let radius = shelter.half_size_m.length();
        let after = |height: f64| ((center.z + radius - height) / -velocity.z).max(0.0);
        let ends = [0.0, after(self.range_m.0)].map(|t| center.truncate() + velocity.truncate() * t);
        let (low, high) = (ends[0].min(ends[1]) - radius, ends[0].max(ends[1]) + radius);
        if center.z + radius < self.range_m.0 {
            return None;
        }
        let part = |low: f64, high: f64, nodes: u32| {
            let last = f64::from(nodes - 1);
            let (first, end) = ((low / grid.cell_m).ceil().max(0.0), (high / grid.cell_m).floor().min(last));
            (first <= end).then_some([first as usize, end as usize])
        };
        Some([part(low.x, high.x, grid.nodes[0])?, part(low.y, high.y, grid.nodes[1])?])
    }

    /// Fall speeds of thirds of the heaviest rain over the grid; without rain, of steady rain.
    fn falls_m_s(&self, c: &Conditions, overs: &AreasOverGrid) -> [f64; 3] {
        let mut heaviest = c.precipitation;
        for over in overs.all().filter(|over| over.reaches) {
            if liquid(&over.shaft.falling) > liquid(&heaviest) {
                heaviest = over.shaft.falling;
            }
        }
        if liquid(&heaviest) <= 0.0 {
            heaviest.rain_mm_h = 3.0;
        }
        DropSizes::new(&heaviest, factor_in(&c.air, self.altitude_m)).thirds_m_s()
    }

    /// Leads the water through a step under the weather `c`.
    fn step(
        &mut self,
        c: &Conditions,
        forcing: &Forcing,
        seconds: f64,
        overs: &AreasOverGrid,
        shelters: &[Shelter],
    ) -> bool {
        let rains = forcing.liquid_mm_h > 0.0 || overs.all().any(|o| o.liquid_mm_h > 0.0);
        if !rains && self.water.is_dry() {
            return false;
        }
        let step = Step::new(forcing, seconds);
        if !rains {
            self.water.step(&self.terrain, &step, |_| false, |_| 0.0);
            return true;
        }
        self.shade_rain(c, overs, shelters);
        let own = liquid(&c.precipitation);
        let liquid_stays = 1.0 - c.precipitation.freezing;
        // What melts falls everywhere alike, less what snow takes of the rain.
        let melting = forcing.liquid_mm_h - own * liquid_stays;
        let hours = seconds / 3600.0;
        let fallen_mm = |liquid: f64| ((liquid * liquid_stays + melting) * hours).max(0.0);
        if overs.even() {
            let mm = fallen_mm(self.liquid(overs, own, 0));
            let shadow = &self.shadow;
            self.water.step(&self.terrain, &step, |_| mm != 0.0, |cell| mm * shadow.share(cell));
        } else {
            let mut rates = std::mem::take(&mut self.rates);
            self.liquids(overs, own, &mut rates);
            rates.iter_mut().enumerate().for_each(|(cell, rate)| *rate = fallen_mm(*rate) * self.shadow.share(cell));
            let rains = |run: usize| rates[run * RUN..].iter().take(RUN).any(|mm| *mm != 0.0);
            self.water.step(&self.terrain, &step, rains, |cell| rates[cell]);
            self.rates = rates;
        }
        true
    }

    /// Takes the water from what the weather says of all the ground, where it gets to.
    fn show(&mut self, c: &Conditions, water: &GroundWater, overs: &AreasOverGrid, shelters: &[Shelter]) {
        self.shade_rain(c, overs, shelters);
        let own = liquid(&c.precipitation);
        let kept = |liquid: f64| {
            let falling = Falling { rain_mm_h: liquid, drizzle_mm_h: 0.0, ..c.precipitation };
            let (wetness, puddles) = cover_under_rain(&falling, c.air.relative_humidity);
            let dry = 1.0 - c.surface.ice;
            let cover = crate::weather::SurfaceCover { wetness: wetness * dry, puddles: puddles * dry, ..c.surface };
            GroundWater::of_cover(&cover).max(water)
        };
        let mut last = (f64::NAN, *water);
        let mut at = |cell: usize| {
            let liquid = self.liquid(overs, own, cell);
            if liquid != last.0 {
                last = (liquid, if overs.all().next().is_some() && liquid != own { kept(liquid) } else { *water });
            }
            let share = self.shadow.share(cell);
            GroundWater {
                film_mm: last.1.film_mm * share,
                soaked_mm: last.1.soaked_mm * share,
                hollows_mm: last.1.hollows_mm * share,
            }
        };
        let cells: Vec<GroundWater> = (0..self.terrain.grid.len()).map(&mut at).collect();
        self.water = TerrainWater::new(&self.terrain, |cell| cells[cell]);
    }

    /// Leads the water from `from_s` through a step, under the weather in its middle; `water` is that of level, open ground at its
    /// beginning. Says whether it may have changed.
    pub fn lead(
        &mut self,
        world: &World,
        (from_s, seconds): (f64, f64),
        (c, forcing): (&Conditions, &Forcing),
        water: &GroundWater,
    ) -> Result<bool> {
        let overs = self.overs(world, from_s + 0.5 * seconds, c)?;
        let shelters = &world.set.shelters;
        if !self.begun {
            self.show(c, water, &overs, shelters);
            self.begun = true;
        }
        Ok(self.step(c, forcing, seconds, &overs, shelters))
    }

    /// Lets the water begin at its next step as the ground is then.
    pub fn begin_anew(&mut self) {
        (self.begun, self.shown) = (false, None);
    }

    /// Updates what follows from weather, areas and shelter without a state: the ice, and the water where it has none. Answers whether
    /// anything may have changed.
    pub fn refresh(&mut self, world: &World, model: GroundModel, state: Option<&GroundState>) -> Result<bool> {
        // Looked at as often as a state is stepped: weather and areas may change all the time.
        let slot_s = ((world.time_s / STEP_S).floor() * STEP_S).max(world.timeline.known_from_s());
        let c = world.timeline.at(slot_s);
        if self.begun && c.surface.ice == 0.0 && self.glaze.ice == 0.0 {
            return Ok(false);
        }
        let overs = self.overs(world, slot_s, &c)?;
        let shelters = &world.set.shelters;
        let iced = self.ice_over(&c, &overs, shelters);
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
