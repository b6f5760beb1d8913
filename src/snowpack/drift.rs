//! Snow that the wind carries along the ground: it erodes where the wind is strong and lands where it is weaker.
//!
//! **Wind at the surface.** A wind that varies in space is used as it is, with its direction. Its component along the
//! cells' rows or columns counts as 0 where it points against that of the mean wind. Otherwise the surface's shape
//! changes the mean wind by the factor 1 + 0.58 s + 2 H / L. s is the slope along the wind, positive where it faces the
//! wind (Liston and Elder 2006). H is the height of a crest and L its half-width at half the height; in a hollow H is
//! negative (Jackson and Hunt 1975). Behind an obstacle the wind is calmed below a line that falls by 1 in [`LEE_RUN`]
//! from the obstacle's top: the idea of Winstral and Marks (2002), with the length of drifts behind solid fences
//! (Tabler 2003). In front of an obstacle of height H a line rises to its top with the same slope. At the depth d below
//! this line the wind is multiplied by 1 - [`CALMED`] (d / H)^4: it loses a tenth at five heights before a wall and
//! three fifths at one height. The drift there ends up half as high as the wall, as is found on the windward side of
//! fences (Tabler 1980, J. Glaciol. 26, 405).
//!
//! **Transport.** Along the wind the flux Q approaches the capacity Qc of the wind: dQ/dx = (Qc - Q) / L. L is
//! [`ERODING_M`] if Q < Qc and there is loose snow, and [`LANDING_M`] if Q > Qc. One sweep down the wind solves this
//! for a whole step, of any length and with cells of any size. Snow that leaves a cell enters its neighbours to
//! leeward, and snow that leaves the field's cells at the leeward border is blown out. The country around the field
//! supplies the full capacity of the mean wind if that wind can move the country's snow, else nothing. Saltating
//! ([`saltation_kg_m_s`]) and suspended snow ([`suspension_kg_m_s`]) are carried separately: suspended snow grows over
//! [`LIFTING_M`] and lands over [`SINKING_M`], so it reaches farther into a lee. The capacities of both are the fluxes
//! that these two functions return.
//!
//! The sweep goes from patch to patch down the wind as it does from cell to cell: the snow that leaves the last cells
//! of one patch, and the lee's line over these cells, enter the next patch. Patches are left out if they have no snow,
//! receive none and have no snow to leeward. In a wind that varies in space, snow to leeward does not matter, because
//! no lines are used.

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

/// Length over which the lack of saltating snow against the wind's capacity falls to 1/e, m.
const ERODING_M: f64 = 30.0;
/// Length over which an excess of saltating snow falls to 1/e, m.
const LANDING_M: f64 = 3.0;
/// Length over which the lack of suspended snow against the wind's capacity falls to 1/e, m: the flux is fully
/// developed after some 500 to 1000 m (Takeuchi 1980).
const LIFTING_M: f64 = 250.0;
/// Length over which an excess of suspended snow falls to 1/e, m: snow that sinks 0.5 m at 0.4 m/s is carried 15 m by a
/// wind of 12 m/s.
const SINKING_M: f64 = 15.0;
/// Horizontal run per unit of fall of the line below which the wind in a lee is calmed.
const LEE_RUN: f64 = 12.0;
/// Share of its speed that the wind loses at the foot of an obstacle.
const CALMED: f64 = 0.85;
/// Least height that is assumed for an object that casts a lee, m.
const LEAST_M: f64 = 1.0;
/// Distances from a cell at which the surface's slope and curvature are measured, m.
const SHAPES_M: [f64; 3] = [6.0, 10.0, 15.0];

/// Direction of a sweep down the wind.
struct Way {
    /// Shares of the flux that leave a cell across its east or west side, and across its north or south side; their sum
    /// is 1.
    shares: [f64; 2],
    /// Whether the sweep goes west, and whether it goes south.
    back: [bool; 2],
    /// Unit vector along the wind.
    unit: DVec2,
    /// Speed of the mean wind at 10 m, m/s.
    speed: f64,
    /// Mean length of the wind's paths through a cell, m.
    through_m: f64,
}

impl Way {
    /// Creates the way of a wind, (east, north), m/s, over cells of `cell_m`.
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

    /// Returns the index of the neighbouring patch along an axis (0: east, 1: north), to leeward or to windward;
    /// [`NONE`] without one.
    fn beside(&self, patch: &Patch, axis: usize, leeward: bool) -> u32 {
        patch.near[2 * axis + usize::from(self.back[axis] != leeward)]
    }
}

/// Inputs that all cells of a sweep share.
struct Sweep<'a> {
    way: &'a Way,
    /// Passage through a cell along the mean wind.
    mean: Through,
    /// Mass per m^2 of a cell that a flux of 1 kg/(m s) across one of its sides brings in the step, in units of mass
    /// ([`UNITS`] make 1 kg/m^2).
    per_flux: f64,
    /// Side of a cell, m.
    cell_m: f64,
    /// Density of the snow that the wind lays down, kg/m^3.
    landing_kg_m3: f64,
    /// Whether the wind varies in space and is given for each cell.
    is_local: bool,
    /// Revision for patches whose snow changes.
    revision: u64,
}

/// Passage of the wind through a cell.
#[derive(Clone, Copy)]
struct Through {
    /// Sum of the absolute components of the wind's unit direction.
    sum: f64,
    /// Share of the flux that leaves the cell across its east or west side.
    across: f64,
    /// Shares 1 - exp(-x / L) by which the flux approaches the capacity over the path x through a cell: first for
    /// saltating, then for suspended snow, each with L for a growing and for a falling flux.
    grown: [[f64; 2]; 2],
}

impl Through {
    /// Creates the passage for a direction, given by the absolute values of its components.
    fn new([x, y]: [f64; 2], cell_m: f64) -> Self {
        let sum = x + y;
        let share = |l: f64| 1.0 - libm::exp(-cell_m / (sum * l));
        let grown = [[ERODING_M, LANDING_M], [LIFTING_M, SINKING_M]].map(|lengths| lengths.map(share));
        Self { sum, across: x / sum, grown }
    }
}

/// Returns the height of ground and snow, m, at the cell that lies `cells` cells along an axis (0: east, 1: north) from
/// a cell, given by the index of its patch and its column and row. Also returns the number of cells actually gone:
/// fewer at the edge of the ground. It is 0, and the height NaN, if the cell where the way ends is blocked.
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

/// Returns the factor 1 + 0.58 s + 2 H / L on the wind at a cell (see the head of this file), with 0.58 s of at most
/// 0.29 and 2 H / L of at most 0.4 in magnitude. Both are means over the distances `SHAPES_M`: with a single distance,
/// each drift would cause another at that distance upwind.
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

/// Returns the line over a cell below which an object calms the wind: the height of the line, m, and the height of the
/// object, m. Both are means over the two neighbouring cells on the object's side (`neighbours`), weighted by the
/// shares of the flux. The line's mean is lowered by its fall over the path through the cell. `None` if neither
/// neighbour has a line.
fn fallen(way: &Way, neighbours: [Option<[f64; 2]>; 2]) -> Option<[f64; 2]> {
    let (mut line, mut caster, mut sum) = (0.0, 0.0, 0.0);
    for (share, known) in way.shares.into_iter().zip(neighbours).filter_map(|(share, known)| Some((share, known?))) {
        line += share * known[0];
        caster += share * known[1];
        sum += share;
    }
    (sum > 0.0).then(|| [line / sum - way.through_m / LEE_RUN, caster / sum])
}

/// Returns the factor on the wind at a cell by the lee of an object to windward, 1 - [`CALMED`] smoothstep(d / H), and
/// the lee's line over the cell. d is the depth of the cell's surface below the line and H the object's height. A cell
/// that reaches above the line begins a new line at its own top.
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

/// Returns the factor on the wind at a cell by the calm in front of an object to leeward, 1 - [`CALMED`] (d / H)^4, and
/// the calm's line over the cell. d is the depth of the cell's surface below the line and H the object's height. A cell
/// that reaches above the line begins a new one if an object stands on it, else it has no line.
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
    /// Carries snow by the wind of a step, if the wind is strong enough anywhere.
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

    /// Sorts the patches down the wind. Marks the patches that snow may lie on or reach (`has_snow`), and those with
    /// such a patch to leeward (`has_lee`). `comes_in` says whether snow drifts in over the field's border.
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

    /// Finds the wind over the cells that snow may reach. Returns an upper bound of its speed, m/s.
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
                // Carries no snow against the mean wind: air that flows against it recirculates behind an object.
                let along = |axis: usize| (if way.back[axis] { -found[axis] } else { found[axis] }).max(0.0);
                [along(0), along(1)]
            }));
            field.patches[at].edges.wind = wind;
        }
        strongest
    }

    /// Calms the wind in front of obstacles, from patch to patch against the wind.
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

    /// Finds the fluxes that enter a patch from the patches to windward. If there is no patch to windward, the fluxes
    /// are `inflow`, from the country around the field.
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

    /// Goes over a patch's cells down the wind: exchanges snow between air and columns, and stores the fluxes that
    /// leave the patch.
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
    /// Exchanges snow between the air over a cell and its column. `windward` has the fluxes that enter along the row
    /// and along the column. Returns the snow that leaves the cell along the row and along the column, each saltating
    /// and suspended, in units of mass; the lee's line over the cell; and whether its column has changed.
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
        // Snow passes over obstacles and holes without landing.
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

    /// Returns the speed of the wind over a cell, m/s, and its passage through the cell. `own` is the cell's entry of
    /// [`Edges::wind`](super::drift_state::Edges), and `calm` the factor by a lee, which is used only with a uniform
    /// wind.
    fn wind(&self, own: [f64; 2], calm: f64) -> (f64, Through) {
        if !self.is_local {
            return (self.way.speed * calm * own[0], self.mean);
        }
        let speed = libm::hypot(own[0], own[1]);
        if speed > 0.0 { (speed, Through::new(own.map(|v| v / speed), self.cell_m)) } else { (0.0, self.mean) }
    }
}

/// Returns the snow that drifts in the step from the surrounding country into each row (first) and each column (second)
/// of cells at the field's border: saltating and suspended, in units of mass.
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

/// Erodes a column if the air carries less than its capacity (`lacking` > 0) and the wind can move the column's snow.
/// Lands snow if the air carries more. `eroded` and `landed` are the shares of the difference that move within the
/// cell. Returns the gain of the air, in units of mass.
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
