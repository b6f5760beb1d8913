//! Precipitation on the cells of a grid, and the share of each cell under ice. The precipitation includes that of rain
//! areas, and leaves out what boxes at rest (shelters that do not move) keep off.

use glam::{DMat3, DVec2, DVec3};

use super::{
    grid::CellGrid,
    host_rain::{AreaOverGrid, AreasOverGrid, CellBounds, Evens, liquid},
    terrain::RUN,
    water::{Forcing, GroundWater},
};
use crate::{
    error::Result,
    falling::{MAX_AREAS, drops::factor_in, sizes::DropSizes},
    surroundings::{Shelter, shelter::sheltered},
    weather::{Conditions, Falling, cover_under_rain},
    world::World,
};

/// Height above the ground of the point for which shelter from rain is tested, m.
const SURFACE_M: f64 = 0.02;

/// Rain that the boxes keep off each cell, in thirds. The rain's water is sorted by drop size and divided into three
/// equal parts, and a box keeps each third off a cell as a whole or not at all.
#[derive(Default)]
struct Shadow {
    /// Inputs of `thirds`: fall speeds, m/s, wind, east and north, m/s, and boxes.
    made_for: Option<([f64; 3], DVec2, Vec<Shelter>)>,
    /// Number of thirds kept off, 0 to 3, by cell; empty without boxes at rest.
    thirds: Vec<u8>,
}

impl Shadow {
    /// Returns the share of the rain that reaches a cell.
    fn share(&self, cell: usize) -> f64 {
        self.thirds.get(cell).map_or(1.0, |t| f64::from(3 - t) / 3.0)
    }
}

/// Ice of the present weather: the share of open ground under ice, and the freezing rain that boxes keep off.
#[derive(Default)]
struct Glaze {
    /// Share of open ground under ice, 0 to 1.
    ice: f64,
    /// Freezing rain that boxes keep off each cell.
    shadow: Shadow,
}

/// Inputs of a step in which rain falls on a grid.
#[derive(Clone, Copy)]
pub(super) struct RainStep<'a> {
    /// Weather in the middle of the step, and its effect on the ground.
    pub conditions: &'a Conditions,
    /// Evaporation in the step, and the liquid that reaches the ground: unfrozen rain and drizzle, and meltwater. Snow
    /// that is simulated takes up the rain that falls on it and adds its run-off.
    pub forcing: &'a Forcing,
    /// Length of the step, s.
    pub seconds: f64,
}

/// Position of a grid in the atmosphere, and the rain on its cells.
pub(super) struct GridRain {
    /// Rotation from the host's axes to east, north, up.
    pub to_enu: DMat3,
    /// Altitude from which the grid's heights are measured, m.
    pub altitude_m: f64,
    /// Bounds of the whole grid.
    pub whole: CellBounds,
    /// Bounds of each run of cells.
    pub runs: Vec<CellBounds>,
    /// Heights of the lowest and the highest node, m.
    range_m: (f64, f64),
    /// Rain that boxes keep off each cell.
    shadow: Shadow,
    /// Ice on the grid.
    glaze: Glaze,
    /// Liquid that reached the ground of every cell in the last step, with meltwater, mm, before boxes keep any of it
    /// off; `None` if cells differ.
    even_mm: Option<f64>,
    /// Liquid that reached the ground of each cell in the last step, with meltwater, mm, less the part that boxes keep
    /// off, if `even_mm` is `None`.
    rates: Vec<f64>,
}

impl GridRain {
    /// Creates the rain on a grid before its first step. `to_enu` is the rotation from the host's axes to east, north,
    /// up at the grid's origin, and `altitude_m` the altitude there.
    pub fn new(grid: &CellGrid<'_>, (to_enu, altitude_m): (DMat3, f64)) -> Self {
        let (whole, runs) = CellBounds::whole_and_runs(grid, (&to_enu, altitude_m));
        Self {
            to_enu,
            altitude_m,
            whole,
            runs,
            range_m: grid.range(),
            shadow: Shadow::default(),
            glaze: Glaze::default(),
            even_mm: Some(0.0),
            rates: Vec::new(),
        }
    }

    /// Updates the bounds after heights have changed: computes the bounds of these runs again and extends those of the
    /// whole grid.
    pub fn heights_changed(&mut self, grid: &CellGrid<'_>, runs: impl Iterator<Item = usize>) {
        for run in runs {
            let cells = run * RUN..((run + 1) * RUN).min(grid.len());
            let part = CellBounds::new(grid, (&self.to_enu, self.altitude_m), cells.clone());
            for height in &grid.heights_m[cells] {
                let height = f64::from(*height);
                self.range_m = (self.range_m.0.min(height), self.range_m.1.max(height));
            }
            self.whole.reach_over(&part);
            self.runs[run] = part;
        }
        self.shadow.made_for = None;
        self.glaze.shadow.made_for = None;
    }

    /// Finds the rain that boxes at rest keep off each cell. Returns whether it may have changed. `falls_m_s` are the
    /// fall speeds of the median drops of the three thirds of the water, sorted by drop size. `wind` is the wind, east
    /// and north, m/s.
    fn shade(
        &self,
        grid: &CellGrid<'_>,
        shadow: &mut Shadow,
        falls_m_s: [f64; 3],
        wind: DVec2,
        shelters: &[Shelter],
    ) -> bool {
        let standing = || shelters.iter().filter(|s| s.stands());
        if let Some((falls, blown, list)) = &shadow.made_for
            && (*falls, *blown) == (falls_m_s, wind)
            && list.iter().eq(standing())
        {
            return false;
        }
        shadow.thirds.clear();
        if standing().next().is_some() {
            shadow.thirds.resize(grid.len(), 0);
            for fall in falls_m_s {
                self.shade_third(grid, &mut shadow.thirds, wind.extend(-fall), standing());
            }
        }
        let mut list = shadow.made_for.take().map_or(Vec::new(), |made| made.2);
        list.clear();
        list.extend(standing());
        shadow.made_for = Some((falls_m_s, wind, list));
        true
    }

    /// Updates the rain that boxes at rest keep off each cell in the weather `c`.
    fn shade_rain(&mut self, grid: &CellGrid<'_>, c: &Conditions, overs: &AreasOverGrid, shelters: &[Shelter]) {
        let mut shadow = std::mem::take(&mut self.shadow);
        let wind = DVec2::new(c.wind.east_m_s, c.wind.north_m_s);
        self.shade(grid, &mut shadow, self.falls_m_s(c, overs), wind, shelters);
        self.shadow = shadow;
    }

    /// Sets the ice on the grid to that of the weather `c`. Ice from freezing rain forms only where the rain arrives.
    /// Returns whether the ice of any cell may have changed.
    pub fn ice_over(
        &mut self,
        grid: &CellGrid<'_>,
        c: &Conditions,
        overs: &AreasOverGrid,
        shelters: &[Shelter],
    ) -> bool {
        let mut glaze = std::mem::take(&mut self.glaze);
        let mut changed = glaze.ice != c.surface.ice;
        glaze.ice = c.surface.ice;
        if glaze.ice > 0.0 && c.precipitation.freezing * liquid(&c.precipitation) > 0.0 {
            let wind = DVec2::new(c.wind.east_m_s, c.wind.north_m_s);
            changed |= self.shade(grid, &mut glaze.shadow, self.falls_m_s(c, overs), wind, shelters);
        } else {
            changed |= glaze.shadow.made_for.is_some() && glaze.ice > 0.0;
            glaze.shadow = Shadow::default();
        }
        self.glaze = glaze;
        changed
    }

    /// Returns the share of a cell under ice.
    pub fn ice(&self, cell: usize) -> f32 {
        (self.glaze.ice * self.glaze.shadow.share(cell)) as f32
    }

    /// Adds 1 to `thirds` for each cell that boxes shelter from drops of this velocity, (east, north, up), m/s.
    fn shade_third<'a>(
        &self,
        grid: &CellGrid<'_>,
        thirds: &mut [u8],
        velocity: DVec3,
        shelters: impl Iterator<Item = &'a Shelter> + Clone,
    ) {
        let in_world = self.to_enu.transpose() * velocity;
        let columns = grid.nodes[0] as usize;
        // Tests only cells that a box's shadow may reach. A cell in the shadow of several boxes counts once.
        for (i, shelter) in shelters.clone().enumerate() {
            let Some([x, y]) = self.shadow_within(grid, shelter, velocity) else { continue };
            for (row, column) in (y[0]..=y[1]).flat_map(|row| (x[0]..=x[1]).map(move |column| (row, column))) {
                let cell = row * columns + column;
                let p = grid.node(cell, &self.to_enu) + self.to_enu.transpose() * (DVec3::Z * SURFACE_M);
                if sheltered(shelter, p, in_world) && !shelters.clone().take(i).any(|s| sheltered(s, p, in_world)) {
                    thirds[cell] += 1;
                }
            }
        }
    }

    /// Returns the first and last column, and the first and last row, to which the shadow of a box can reach; `None` if
    /// it cannot reach the grid.
    fn shadow_within(&self, grid: &CellGrid<'_>, shelter: &Shelter, velocity: DVec3) -> Option<[[usize; 2]; 2]> {
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

    /// Returns the fall speeds for each third of the water in the heaviest rain over the grid; without rain, in steady
    /// rain of 3 mm/h.
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

    /// Returns whether there is ice on open ground; boxes may still keep it off every cell.
    pub fn is_iced(&self) -> bool {
        self.glaze.ice > 0.0
    }

    /// Finds how much liquid reaches the ground of each cell in a step.
    pub fn fall(&mut self, grid: &CellGrid<'_>, step: &RainStep<'_>, overs: &AreasOverGrid, shelters: &[Shelter]) {
        let RainStep { conditions: c, forcing, seconds } = *step;
        self.shade_rain(grid, c, overs, shelters);
        let own = liquid(&c.precipitation);
        let liquid_stays = 1.0 - c.precipitation.freezing;
        // Liquid beside the weather's rain, mm/h, the same everywhere: meltwater, less the rain that lying snow takes
        // up.
        let melting = forcing.liquid_mm_h - own * liquid_stays;
        let hours = seconds / 3600.0;
        let fallen_mm = |liquid: f64| ((liquid * liquid_stays + melting) * hours).max(0.0);
        if overs.even() {
            self.even_mm = Some(fallen_mm(self.liquid(grid, overs, own, 0)));
        } else {
            let mut rates = std::mem::take(&mut self.rates);
            self.liquids(grid, overs, own, &mut rates);
            rates.iter_mut().enumerate().for_each(|(cell, rate)| *rate = fallen_mm(*rate) * self.shadow.share(cell));
            (self.even_mm, self.rates) = (None, rates);
        }
    }

    /// Returns whether liquid may reach the ground in a run of cells in the step of [`Self::fall`]. If all cells get
    /// the same precipitation, what boxes keep off is ignored.
    pub fn rains_on(&self, run: usize) -> bool {
        match self.even_mm {
            Some(mm) => mm != 0.0,
            None => self.rates[run * RUN..].iter().take(RUN).any(|mm| *mm != 0.0),
        }
    }

    /// Returns the liquid that reaches the ground of a cell in the step of [`Self::fall`], with meltwater, mm, less the
    /// part that boxes keep off.
    pub fn fallen_mm(&self, cell: usize) -> f64 {
        match self.even_mm {
            Some(mm) => mm * self.shadow.share(cell),
            None => self.rates[cell],
        }
    }

    /// Returns the water with which each cell begins. This is `water`, the water of level, open ground, but with more
    /// of it in rain areas and less where boxes keep rain off.
    pub fn first_water(
        &mut self,
        grid: &CellGrid<'_>,
        (c, water): (&Conditions, &GroundWater),
        overs: &AreasOverGrid,
        shelters: &[Shelter],
    ) -> Vec<GroundWater> {
        self.shade_rain(grid, c, overs, shelters);
        let own = liquid(&c.precipitation);
        let kept = |liquid: f64| {
            let falling = Falling { rain_mm_h: liquid, drizzle_mm_h: 0.0, ..c.precipitation };
            let (wetness, puddles) = cover_under_rain(&falling, c.air.relative_humidity);
            let dry = 1.0 - c.surface.ice;
            let cover = crate::weather::SurfaceCover { wetness: wetness * dry, puddles: puddles * dry, ..c.surface };
            GroundWater::of_cover(&cover).max(water)
        };
        let mut last = (f64::NAN, *water);
        let at = |cell: usize| {
            let liquid = self.liquid(grid, overs, own, cell);
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
        (0..grid.len()).map(at).collect()
    }
}

impl GridRain {
    /// Returns rain and drizzle at a cell, mm/h; `own` is the rate of the weather outside the areas.
    fn liquid_with(&self, grid: &CellGrid<'_>, overs: &AreasOverGrid, evens: &Evens, own: f64, cell: usize) -> f64 {
        overs.list.iter().zip(evens).fold(own, |sum, (over, even)| {
            let Some(over) = over else { return sum };
            let (share, begun) = even.unwrap_or_else(|| {
                let altitude = self.altitude_m + f64::from(grid.heights_m[cell]);
                let p = grid.node(cell, &self.to_enu);
                (over.shaft.share_at(p, &self.to_enu, altitude), over.shaft.begun(altitude))
            });
            sum * (1.0 - share) + over.liquid_mm_h * share * begun
        })
    }

    /// Returns rain and drizzle at a cell, mm/h. Shares of areas that are uniform over the whole grid are taken from
    /// `overs.evens`, all others are computed for the cell.
    fn liquid(&self, grid: &CellGrid<'_>, overs: &AreasOverGrid, own: f64, cell: usize) -> f64 {
        self.liquid_with(grid, overs, &overs.evens, own, cell)
    }

    /// Finds rain and drizzle at each cell, mm/h, with one evaluation for a run of cells over which all areas are
    /// uniform.
    fn liquids(&self, grid: &CellGrid<'_>, overs: &AreasOverGrid, own: f64, liquids: &mut Vec<f64>) {
        liquids.clear();
        let count = grid.len();
        for (run, part) in self.runs.iter().enumerate() {
            let cells = run * RUN..((run + 1) * RUN).min(count);
            let evens = part.evens(overs, &self.to_enu);
            if overs.are_even(&evens) {
                liquids.resize(cells.end, self.liquid_with(grid, overs, &evens, own, cells.start));
            } else {
                liquids.extend(cells.map(|cell| self.liquid_with(grid, overs, &evens, own, cell)));
            }
        }
    }

    /// Returns the world's rain areas at a time, and which of them reach the grid; `c` is the weather at that time.
    pub fn overs(&self, world: &World, time_s: f64, c: &Conditions) -> Result<AreasOverGrid> {
        let mut overs = AreasOverGrid { list: [None; MAX_AREAS], evens: [None; MAX_AREAS] };
        if world.set.regions.is_empty() {
            return Ok(overs);
        }
        let places = overs.list.iter_mut().zip(&mut overs.evens);
        for ((place, even), shaft) in places.zip(world.over().shafts_at(time_s, c)?) {
            let (most, over_all) = self.whole.even(&shaft, &self.to_enu);
            let liquid_mm_h = if most > 0.0 { liquid(&shaft.falling) } else { 0.0 };
            *even = over_all;
            *place = Some(AreaOverGrid { shaft, reaches: most > 0.0, liquid_mm_h });
        }
        Ok(overs)
    }
}
