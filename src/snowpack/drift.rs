//! Snow that the wind carries along the ground: from where it blows to where it is weaker.
//!
//! **Wind at the surface.** A wind that varies in space is taken as it is, with its direction, but for what blows
//! against the mean wind. Else the surface's shape bends the mean wind: slopes that face it quicken it and lee slopes
//! calm it by 0.58 of their slope (Liston and Elder 2006), crests quicken it and hollows calm it by 2 H / L (Jackson
//! and Hunt 1975). Behind what stands up the wind is calmed below a line that falls by 1 in [`LEE_RUN`] from its top:
//! the idea of Winstral and Marks (2002), with the length of drifts behind solid fences (Tabler 2003). Before it a line
//! rises as steeply to its top, and the wind below is calmed by the fourth power of how far below: a tenth five heights
//! before a wall and two thirds one height before it. The drift there ends up half as high as the wall, as fences get
//! it to windward (Tabler 1980, J. Glaciol. 26, 405).
//!
//! **Transport.** Along the wind the flux goes to what the wind can carry ([`saltation_kg_m_s`]): upwards over
//! [`ERODING_M`] where there is loose snow, downwards over [`LANDING_M`]. One sweep down the wind does this for a whole
//! step, whatever its length and the cells' size: what leaves a cell enters the next ones, what leaves the last ones is
//! blown out. As much comes in from the country about the field as its snow yields. What hops ([`saltation_kg_m_s`])
//! and what is suspended ([`suspension_kg_m_s`]) are carried side by side: the second grows over [`LIFTING_M`] and
//! lands over [`SINKING_M`], so that it reaches farther into a lee.
//!
//! The sweep goes from patch to patch down the wind, as from cell to cell: what leaves the last cells of one, and the
//! line of a lee over them, is what comes to the next. Patches that have no snow, get none and have none to their lee
//! are left out.

use glam::DVec2;

use super::{
    column::{Column, SnowParcel, UNITS},
    drift_state::{DriftFlux, DriftSweep},
    field::SnowField,
    inputs::SnowStep,
    laws::{DRY_THRESHOLD_M_S, new_density_kg_m3, saltation_kg_m_s, suspension_kg_m_s, threshold_m_s},
    patch::{NONE, Patch},
};

use crate::numerics::smoothstep;

/// Ways over which the flux of what hops grows and falls to 1/e, m.
const ERODING_M: f64 = 30.0;
const LANDING_M: f64 = 3.0;
/// Ways over which the flux of suspended snow grows and falls to 1/e, m: it is fully developed after some 500 to 1000 m
/// (Takeuchi 1980), and sinks half a metre at 0.4 m/s in a wind of 12 m/s.
const LIFTING_M: f64 = 250.0;
const SINKING_M: f64 = 15.0;
/// Run of the line below which the wind is calmed, over its fall.
const LEE_RUN: f64 = 12.0;
/// Share of the wind that the calm takes.
const CALMED: f64 = 0.85;
/// Least height of what casts a lee, m.
const LEAST_M: f64 = 1.0;
/// Distances over which slope and curvature of the surface are taken, m.
const SHAPES_M: [f64; 3] = [6.0, 10.0, 15.0];

/// How a sweep goes down the wind.
struct Way {
    /// Shares of the flux that go east or west, and north or south.
    shares: [f64; 2],
    /// Whether it goes west, and south.
    back: [bool; 2],
    /// Direction of the wind, unit.
    unit: DVec2,
    speed: f64,
    /// Way through a cell, m.
    through_m: f64,
}

impl Way {
    fn new(wind: DVec2, cell_m: f64) -> Self {
        let speed = wind.length();
        let unit = wind / speed;
        let sum = unit.x.abs() + unit.y.abs();
        Self {
            shares: [unit.x.abs() / sum, unit.y.abs() / sum],
            back: [unit.x < 0.0, unit.y < 0.0],
            unit,
            speed,
            through_m: cell_m / sum,
        }
    }

    /// The patch up or down the wind along an axis.
    fn beside(&self, patch: &Patch, axis: usize, leeward: bool) -> u32 {
        patch.near[2 * axis + usize::from(self.back[axis] != leeward)]
    }
}

/// Inputs of a whole sweep.
struct Sweep<'a> {
    way: &'a Way,
    /// Along the mean wind.
    mean: Through,
    /// Units of mass for a flux of 1 kg/(m s) over the length of a cell's side.
    per_flux: f64,
    cell_m: f64,
    landing_kg_m3: f64,
    /// The wind over cells is that at their places.
    is_local: bool,
    revision: u64,
}

/// How the wind goes through a cell.
#[derive(Clone, Copy)]
struct Through {
    /// Lengths of its direction's parts, together.
    sum: f64,
    /// Share of the flux that goes east or west.
    across: f64,
    /// Share of the way to its new flux that drift goes within a cell, where it grows and where it falls: of hopping
    /// and of suspended snow.
    grown: [[f64; 2]; 2],
}

impl Through {
    /// In this direction: the lengths of its parts.
    fn new([x, y]: [f64; 2], cell_m: f64) -> Self {
        let sum = x + y;
        let share = |l: f64| 1.0 - libm::exp(-cell_m / (sum * l));
        let grown = [[ERODING_M, LANDING_M], [LIFTING_M, SINKING_M]].map(|lengths| lengths.map(share));
        Self { sum, across: x / sum, grown }
    }
}

/// Height of ground and snow so many cells along an axis from a cell, m, and how many they were: fewer at the end of
/// the ground, and none where something stands.
fn along(
    field: &SnowField,
    (patch, place): (usize, [usize; 2]),
    axis: usize,
    forward: bool,
    cells: usize,
) -> (f64, usize) {
    let (mut at, mut patch, mut left) = (place, patch, cells);
    loop {
        let room = if forward { field.size[axis] - 1 - at[axis] } else { at[axis] };
        let next = field.patches[patch].near[2 * axis + usize::from(forward)];
        let ends = left <= room || next == NONE;
        if ends {
            let go = left.min(room);
            at[axis] = if forward { at[axis] + go } else { at[axis] - go };
            left -= go;
            break;
        }
        left -= room + 1;
        (patch, at[axis]) = (next as usize, if forward { 0 } else { field.size[axis] - 1 });
    }
    let (patch, cell) = (&field.patches[patch], at[1] * field.size[0] + at[0]);
    if patch.is_blocked(cell) { (f64::NAN, 0) } else { (patch.surface_m(cell), cells - left) }
}

/// Factor on the wind at a cell by the surface's slope and curvature, in the mean of several distances: over a single
/// one each drift would be repeated at that distance up the wind.
fn shaped(field: &SnowField, patch: usize, place: [usize; 2], unit: DVec2) -> f64 {
    let here = field.patches[patch].surface_m(place[1] * field.size[0] + place[0]);
    let (mut steep, mut crest) = (0.0, 0.0);
    for shape_m in SHAPES_M {
        let reach = (shape_m / field.cell_m).round().max(1.0) as usize;
        let at = |axis: usize, up: bool| match along(field, (patch, place), axis, up, reach) {
            (_, 0) => (here, 0.0),
            (height, cells) => (height, cells as f64 * field.cell_m),
        };
        let (mut slope, mut over) = (DVec2::ZERO, 0.0);
        for axis in 0..2 {
            let ((low, before), (high, after)) = (at(axis, false), at(axis, true));
            slope[axis] = if before + after > 0.0 { (high - low) / (before + after) } else { 0.0 };
            over += 0.25 * (2.0 * here - low - high);
        }
        steep += slope.dot(unit);
        crest += 8.0 * over / (reach as f64 * field.cell_m);
    }
    let share = 1.0 / SHAPES_M.len() as f64;
    1.0 + 0.58 * (share * steep).clamp(-0.5, 0.5) + (share * crest).clamp(-0.4, 0.4)
}

/// A calm's line over a cell, from the lines over its two neighbours on the side of what casts it: its height, m, lower
/// by the way through the cell, and the height of what casts it, m.
fn fallen(way: &Way, neighbours: [Option<[f64; 2]>; 2]) -> Option<[f64; 2]> {
    let (mut line, mut caster, mut sum) = (0.0, 0.0, 0.0);
    for (share, known) in way.shares.into_iter().zip(neighbours).filter_map(|(share, known)| Some((share, known?))) {
        line += share * known[0];
        caster += share * known[1];
        sum += share;
    }
    (sum > 0.0).then(|| [line / sum - way.through_m / LEE_RUN, caster / sum])
}

/// Returns the share of the wind that a lee leaves at a cell, up to a factor, and the line over it.
fn calmed(patch: &Patch, cell: usize, way: &Way, windward: [DriftFlux; 2]) -> (f64, Option<[f64; 2]>) {
    let fallen = fallen(way, windward.map(|air| air.lee)).map(|[line, caster]| [line, caster.max(LEAST_M)]);
    if patch.is_hole(cell) {
        return (1.0, fallen);
    }
    let (ground, stands) = (patch.surface_m(cell), patch.obstacle_m(cell));
    let top = ground + stands;
    match fallen.filter(|fallen| fallen[0] > top) {
        Some(lee) => (1.0 - CALMED * smoothstep(0.0, 1.0, (lee[0] - ground) / lee[1]), Some(lee)),
        None => (1.0, Some([top, stands.max(LEAST_M)])),
    }
}

/// Returns the share of the wind that is left at a cell by the calm before what stands to the lee, up to a factor, and
/// the line over it.
fn dammed(patch: &Patch, cell: usize, way: &Way, leeward: [Option<[f64; 2]>; 2]) -> (f64, Option<[f64; 2]>) {
    let fallen = fallen(way, leeward);
    if patch.is_hole(cell) {
        return (1.0, fallen);
    }
    let (ground, stands) = (patch.surface_m(cell), patch.obstacle_m(cell));
    let own = [ground + stands, stands];
    match fallen.filter(|fallen| fallen[0] > own[0]) {
        Some(front) => {
            let below = ((front[0] - ground) / front[1]).min(1.0);
            (1.0 - CALMED * below.powi(4), Some(front))
        }
        None => (1.0, (stands > 0.0).then_some(own)),
    }
}

impl DriftSweep {
    /// Carries snow by the wind of a step, if that is strong enough anywhere.
    pub fn blow(&mut self, field: &mut SnowField, step: &SnowStep<'_>) {
        let mean = step.wind.mean;
        let lies = field.patches.iter().any(|p| !p.is_bare());
        let too_calm = step.wind.local.is_none() && 1.7 * mean.length() <= DRY_THRESHOLD_M_S;
        if too_calm || mean.length() < 0.1 || !(lies || step.country.ice > 0) {
            return;
        }
        let way = Way::new(mean, field.cell_m);
        let inflow = inflow(field, step, &way);
        self.choose(field, &way, inflow != [[0; 2]; 2]);
        if self.winds(field, step, &way) <= DRY_THRESHOLD_M_S {
            return;
        }
        if step.wind.local.is_none() {
            self.dam(field, &way);
        }
        self.sweeps += 1;
        let sweep = Sweep {
            way: &way,
            mean: Through::new([way.unit.x.abs(), way.unit.y.abs()], field.cell_m),
            per_flux: step.seconds / field.cell_m * UNITS,
            cell_m: field.cell_m,
            landing_kg_m3: new_density_kg_m3(-5.0, way.speed),
            is_local: step.wind.local.is_some(),
            revision: step.revision,
        };
        for at in 0..self.order.len() {
            let patch = self.order[at] as usize;
            self.come(field, patch, &way, inflow);
            let edges = &field.patches[patch].edges;
            let comes = self.coming.iter().flatten().any(|air| air.snow != [0; 2]);
            if comes || !field.patches[patch].is_bare() || (edges.has_lee && !sweep.is_local) {
                self.sweep(field, patch, &sweep);
            }
        }
    }

    /// Puts the patches in the order of the wind, and finds which of them snow may reach and which have such in their
    /// lee.
    fn choose(&mut self, field: &mut SnowField, way: &Way, comes_in: bool) {
        self.order.clear();
        self.order.extend(0..field.patches.len() as u32);
        let along = |v: i32, axis: usize| if way.back[axis] { -v } else { v };
        let keys = |p: &u32| {
            let [x, y] = field.patches[*p as usize].key;
            [along(y, 1), along(x, 0)]
        };
        self.order.sort_unstable_by_key(keys);
        let any = |field: &SnowField, patch: u32, down: bool| {
            let near = [0, 1].map(|axis| way.beside(&field.patches[patch as usize], axis, down));
            near.into_iter().filter(|n| *n != NONE).any(|n| {
                let edges = &field.patches[n as usize].edges;
                edges.has_snow || (down && edges.has_lee)
            })
        };
        for patch in &self.order {
            let lies = comes_in || !field.patches[*patch as usize].is_bare() || any(field, *patch, false);
            field.patches[*patch as usize].edges.has_snow = lies;
        }
        for patch in self.order.iter().rev() {
            field.patches[*patch as usize].edges.has_lee = any(field, *patch, true);
        }
    }

    /// Finds the wind over the cells that snow may reach. Answers the strongest, m/s.
    fn winds(&self, field: &mut SnowField, step: &SnowStep<'_>, way: &Way) -> f64 {
        let mut strongest: f64 = if step.wind.local.is_some() { 0.0 } else { 1.7 * way.speed };
        let columns = field.size[0];
        for at in self.order.iter().map(|at| *at as usize) {
            if !field.patches[at].edges.has_snow {
                continue;
            }
            let mut wind = std::mem::take(&mut field.patches[at].edges.wind);
            wind.clear();
            let patch = &field.patches[at];
            wind.extend((0..patch.heights_m.len()).map(|cell| {
                let place = [cell % columns, cell / columns];
                let Some(local) = step.wind.local else { return [shaped(field, at, place, way.unit), 0.0] };
                let on = [0, 1].map(|i| patch.key[i] * field.size[i] as i32 + place[i] as i32);
                let found = local(on, patch.surface_m(cell));
                strongest = strongest.max(found.length());
                // Against the mean wind nothing is carried: there the air turns round behind something.
                let along = |axis: usize| (if way.back[axis] { -found[axis] } else { found[axis] }).max(0.0);
                [along(0), along(1)]
            }));
            field.patches[at].edges.wind = wind;
        }
        strongest
    }

    /// Calms the wind before what stands up, from patch to patch against the wind.
    fn dam(&mut self, field: &mut SnowField, way: &Way) {
        let [nx, ny] = field.size;
        for at in self.order.iter().rev().map(|at| *at as usize) {
            let mut any = field.patches[at].has_obstacles();
            for (axis, fronts) in self.fronts.iter_mut().enumerate() {
                let behind = way.beside(&field.patches[at], axis, true);
                fronts.clear();
                fronts.extend(field.patches.get(behind as usize).into_iter().flat_map(|p| &p.edges.fronts[axis]));
                any |= fronts.iter().any(Option::is_some);
                fronts.resize(field.size[1 - axis], None);
            }
            let patch = &mut *field.patches[at];
            if !any || !patch.edges.has_snow {
                patch.edges.fronts.iter_mut().for_each(Vec::clear);
                continue;
            }
            let [by_rows, by_columns] = &mut self.fronts;
            for j in 0..ny {
                let row = if way.back[1] { j } else { ny - 1 - j };
                for i in 0..nx {
                    let column = if way.back[0] { i } else { nx - 1 - i };
                    let cell = row * nx + column;
                    let (left, front) = dammed(patch, cell, way, [by_rows[row], by_columns[column]]);
                    patch.edges.wind[cell][0] *= left;
                    (by_rows[row], by_columns[column]) = (front, front);
                }
            }
            for (own, fronts) in patch.edges.fronts.iter_mut().zip(&mut self.fronts) {
                std::mem::swap(own, fronts);
            }
        }
    }

    /// Finds what comes to a patch: from those up the wind, or what the country about the field yields.
    fn come(&mut self, field: &mut SnowField, patch: usize, way: &Way, inflow: [[i64; 2]; 2]) {
        for (axis, inflow) in inflow.into_iter().enumerate() {
            let before = way.beside(&field.patches[patch], axis, false);
            let coming = &mut self.coming[axis];
            coming.clear();
            match field.patches.get(before as usize).map(|p| &p.edges) {
                Some(edges) if edges.swept == self.sweeps => coming.extend_from_slice(&edges.left[axis]),
                Some(_) => coming.resize(field.size[1 - axis], DriftFlux::default()),
                None => {
                    coming.resize(field.size[1 - axis], DriftFlux { snow: inflow, lee: None });
                    field.books.blown_in += inflow.iter().sum::<i64>() * field.size[1 - axis] as i64;
                }
            }
        }
    }

    /// Sweeps over a patch: what comes to it becomes what leaves it.
    fn sweep(&mut self, field: &mut SnowField, patch: usize, sweep: &Sweep<'_>) {
        let way = sweep.way;
        let [nx, ny] = field.size;
        let [by_rows, by_columns] = &mut self.coming;
        let patch = &mut *field.patches[patch];
        patch.edges.swept = self.sweeps;
        let mut changes = false;
        for j in 0..ny {
            let row = if way.back[1] { ny - 1 - j } else { j };
            for i in 0..nx {
                let column = if way.back[0] { nx - 1 - i } else { i };
                let before = [by_rows[row], by_columns[column]];
                let ([across, along], lee, changed) = sweep.cell(patch, row * nx + column, before);
                changes |= changed;
                by_rows[row] = DriftFlux { snow: across, lee };
                by_columns[column] = DriftFlux { snow: along, lee };
            }
        }
        if changes {
            patch.changed(sweep.revision);
        }
        for axis in 0..2 {
            if way.beside(patch, axis, true) == NONE {
                field.books.blown_out += self.coming[axis].iter().flat_map(|air| air.snow).sum::<i64>();
            }
            std::mem::swap(&mut self.coming[axis], &mut patch.edges.left[axis]);
        }
    }
}

impl Sweep<'_> {
    /// Exchanges snow between the air over a cell and its column. Answers what leaves the cell along the row and along
    /// the column, hopping and suspended, the lee's line over it, and whether its column of snow has changed.
    fn cell(
        &self,
        patch: &mut Patch,
        cell: usize,
        windward: [DriftFlux; 2],
    ) -> ([[i64; 2]; 2], Option<[f64; 2]>, bool) {
        let (calm, lee) = if self.is_local { (1.0, None) } else { calmed(patch, cell, self.way, windward) };
        let mut leaving = [0, 1].map(|kind| windward[0].snow[kind] + windward[1].snow[kind]);
        if leaving == [0; 2] && patch.is_bare() {
            return ([[0; 2]; 2], lee, false);
        }
        let (speed, through) = self.wind(patch.edges.wind[cell], calm);
        let mut changes = false;
        // Over what stands there, and over holes, it only passes.
        if !patch.is_blocked(cell) {
            let mut column = patch.column(cell);
            for (kind, flux) in [saltation_kg_m_s, suspension_kg_m_s].into_iter().enumerate() {
                let carries = (flux(speed, DRY_THRESHOLD_M_S) * through.sum * self.per_flux) as i64;
                let lacking = carries - leaving[kind];
                let gained = exchange(&mut column, lacking, speed, through.grown[kind], self.landing_kg_m3);
                leaving[kind] += gained;
                changes |= gained != 0;
            }
            if changes {
                patch.put(cell, column);
            }
        }
        let across = leaving.map(|snow| (snow as f64 * through.across) as i64);
        ([across, [leaving[0] - across[0], leaving[1] - across[1]]], lee, changes)
    }

    /// Speed of the wind over a cell, m/s, and how it goes through: as it blows there, or along the mean wind.
    fn wind(&self, own: [f64; 2], calm: f64) -> (f64, Through) {
        if !self.is_local {
            return (self.way.speed * calm * own[0], self.mean);
        }
        let speed = libm::hypot(own[0], own[1]);
        if speed > 0.0 { (speed, Through::new(own.map(|v| v / speed), self.cell_m)) } else { (0.0, self.mean) }
    }
}

/// Returns the snow that the country about a field yields to each row and each column of cells at its border.
fn inflow(field: &SnowField, step: &SnowStep<'_>, way: &Way) -> [[i64; 2]; 2] {
    let country = step.country;
    let threshold = threshold_m_s(country.is_wet(), country.density_kg_m3());
    if country.ice == 0 || way.speed <= threshold {
        return [[0; 2]; 2];
    }
    let fluxes = [saltation_kg_m_s, suspension_kg_m_s]
        .map(|flux| flux(way.speed, DRY_THRESHOLD_M_S) * step.seconds / field.cell_m * UNITS);
    [way.unit.x.abs(), way.unit.y.abs()].map(|part| fluxes.map(|flux| (flux * part) as i64))
}

/// Takes from a column towards `lacking` more in the air, or lands what is too much; answers what the air has gained.
fn exchange(column: &mut Column, lacking: i64, speed: f64, [eroded, landed]: [f64; 2], landing_kg_m3: f64) -> i64 {
    if lacking > 0 {
        let loose = column.ice > 0 && speed > threshold_m_s(column.is_wet(), column.density_kg_m3());
        return if loose { column.erode((lacking as f64 * eroded) as i64) } else { 0 };
    }
    let ice = (-lacking as f64 * landed) as i64;
    let depth = (ice as f64 / landing_kg_m3) as i64;
    if ice > 0 {
        column.add(SnowParcel { ice, water: 0, depth: depth.max(1) }, Column::drifted_albedo());
    }
    -ice
}
