//! Snow that the wind carries along the ground: from where it blows to where it is weaker.
//!
//! **Wind at the surface.** A wind that varies in space is taken as it is. Else the surface's shape bends the mean wind: slopes that face
//! it quicken it and lee slopes calm it by 0.58 of their slope (Liston and Elder 2006), crests quicken it and hollows calm it by 2 H / L
//! (Jackson and Hunt 1975). Behind what stands up the wind is calmed below a line that falls by 1 in [`LEE_RUN`] from its top: the idea of
//! Winstral and Marks (2002), with the length of drifts behind solid fences (Tabler 2003).
//!
//! **Transport.** Along the wind the flux goes to what the wind can carry ([`saltation_kg_m_s`]): upwards over [`ERODING_M`] where there is
//! loose snow, downwards over [`LANDING_M`]. One sweep down the wind does this for a whole step, whatever its length and the cells' size:
//! what leaves a cell enters the next ones, what leaves the last ones is blown out. As much comes in from the country about the field as its
//! snow yields. Only what hops is carried; suspended snow is drawn and not moved.

use glam::DVec2;

use super::{
    column::{Column, Part, UNITS},
    field::{Books, Land, Step},
    laws::{DRY_THRESHOLD_M_S, new_density_kg_m3, saltation_kg_m_s, threshold_m_s},
};

/// Ways over which the flux grows and falls to 1/e, m.
const ERODING_M: f64 = 30.0;
const LANDING_M: f64 = 3.0;
/// Run of the line below which the wind is calmed, over its fall.
const LEE_RUN: f64 = 12.0;
/// What the calm takes of the wind.
const CALMED: f64 = 0.85;
/// Least height of what casts a lee, m.
const LEAST_M: f64 = 1.0;
/// Distance over which the surface's shape is looked at, m.
const SHAPE_M: f64 = 10.0;

/// Room for a sweep.
#[derive(Clone, Debug, Default)]
pub(super) struct Drift {
    /// Ground and snow, m.
    surface: Vec<f64>,
    /// Height of the lee's line over each cell, and of what casts it.
    lee: Vec<[f64; 2]>,
    /// What enters each cell, in units of mass.
    entering: Vec<i64>,
}

/// How a sweep goes down the wind.
struct Way {
    /// Shares of the flux that go east or west, and north or south.
    shares: [f64; 2],
    /// Whether it goes west, and south.
    back: [bool; 2],
    /// Of the wind.
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

    /// The neighbour up or down the wind along an axis.
    fn neighbour(&self, place: [usize; 2], nodes: [usize; 2], axis: usize, down: bool) -> Option<usize> {
        let mut to = place;
        to[axis] = if self.back[axis] == down { to[axis].checked_sub(1)? } else { to[axis] + 1 };
        (to[axis] < nodes[axis]).then(|| to[1] * nodes[0] + to[0])
    }
}

fn smooth(x: f64) -> f64 {
    let t = x.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// What the surface's shape makes of the wind at a cell, up to a factor.
fn shaped(surface: &[f64], land: &Land, place: [usize; 2], unit: DVec2) -> f64 {
    let reach = (SHAPE_M / land.cell_m).round().max(1.0) as usize;
    let at = |axis: usize, up: bool| {
        let mut to = place;
        to[axis] = if up { (to[axis] + reach).min(land.nodes[axis] - 1) } else { to[axis].saturating_sub(reach) };
        (surface[to[1] * land.nodes[0] + to[0]], to[axis].abs_diff(place[axis]) as f64 * land.cell_m)
    };
    let here = surface[place[1] * land.nodes[0] + place[0]];
    let (mut slope, mut over) = (DVec2::ZERO, 0.0);
    for axis in 0..2 {
        let ((low, before), (high, after)) = (at(axis, false), at(axis, true));
        slope[axis] = (high - low) / (before + after);
        over += 0.25 * (2.0 * here - low - high);
    }
    let along = slope.dot(unit).clamp(-0.5, 0.5);
    let crest = (8.0 * over / (reach as f64 * land.cell_m)).clamp(-0.4, 0.4);
    1.0 + 0.58 * along + crest
}

impl Drift {
    /// Carries snow by the wind of a step, if that is strong enough anywhere.
    pub fn blow(&mut self, columns: &mut [Column], books: &mut Books, land: &Land, step: &Step<'_>) {
        let mean = step.wind.mean;
        let strongest = match step.wind.local {
            Some(local) => local.iter().fold(0.0, |most, w| w.length().max(most)),
            None => 1.7 * mean.length(),
        };
        let loose = columns.iter().any(|c| c.ice > 0);
        if strongest <= DRY_THRESHOLD_M_S || mean.length() < 0.1 || !(loose || step.country.ice > 0) {
            return;
        }
        let way = Way::new(mean, land.cell_m);
        self.begin(columns, land, step, &way);
        books.blown_in += self.entering.iter().sum::<i64>();
        let per_flux = (way.unit.x.abs() + way.unit.y.abs()) * step.seconds / land.cell_m * UNITS;
        let grown = [ERODING_M, LANDING_M].map(|l| 1.0 - libm::exp(-way.through_m / l));
        let landing = new_density_kg_m3(-5.0, way.speed);
        let [nx, ny] = land.nodes;
        for j in 0..ny {
            for i in 0..nx {
                let place = [if way.back[0] { nx - 1 - i } else { i }, if way.back[1] { ny - 1 - j } else { j }];
                let cell = place[1] * nx + place[0];
                let calm = self.calmed(land, &way, place);
                let mut leaving = self.entering[cell];
                if !land.is_blocked(cell) {
                    let speed = match step.wind.local {
                        // Against the mean wind nothing is carried: there the air turns round behind something.
                        Some(local) => local[cell].dot(way.unit).max(0.0),
                        None => way.speed * calm * shaped(&self.surface, land, place, way.unit),
                    };
                    let carries = (saltation_kg_m_s(speed, DRY_THRESHOLD_M_S) * per_flux) as i64;
                    leaving += exchange(&mut columns[cell], carries - leaving, speed, grown, landing);
                }
                for axis in 0..2 {
                    let part = if axis == 0 { (leaving as f64 * way.shares[0]) as i64 } else { leaving };
                    leaving -= part;
                    match way.neighbour(place, land.nodes, axis, true) {
                        Some(next) => self.entering[next] += part,
                        None => books.blown_out += part,
                    }
                }
            }
        }
    }

    /// Makes room, and lets in what the country about the field yields.
    fn begin(&mut self, columns: &[Column], land: &Land, step: &Step<'_>, way: &Way) {
        self.surface.clear();
        self.surface.extend(land.heights_m.iter().zip(columns).map(|(h, c)| h + c.depth_m()));
        self.lee.clear();
        self.lee.resize(land.len(), [0.0; 2]);
        self.entering.clear();
        self.entering.resize(land.len(), 0);
        let country = step.country;
        let threshold = threshold_m_s(country.is_wet(), country.density_kg_m3());
        if country.ice == 0 || way.speed <= threshold {
            return;
        }
        let flux = saltation_kg_m_s(way.speed, DRY_THRESHOLD_M_S) * step.seconds / land.cell_m * UNITS;
        let [nx, ny] = land.nodes;
        let (west, south) = (if way.back[0] { nx - 1 } else { 0 }, if way.back[1] { ny - 1 } else { 0 });
        for j in 0..ny {
            self.entering[j * nx + west] += (flux * way.unit.x.abs()) as i64;
        }
        for i in 0..nx {
            self.entering[south * nx + i] += (flux * way.unit.y.abs()) as i64;
        }
    }

    /// What a lee leaves of the wind at a cell, up to a factor.
    fn calmed(&mut self, land: &Land, way: &Way, place: [usize; 2]) -> f64 {
        let cell = place[1] * land.nodes[0] + place[0];
        let (mut line, mut caster, mut sum) = (0.0, 0.0, 0.0);
        for axis in 0..2 {
            if let Some(before) = way.neighbour(place, land.nodes, axis, false) {
                line += way.shares[axis] * self.lee[before][0];
                caster += way.shares[axis] * self.lee[before][1];
                sum += way.shares[axis];
            }
        }
        let (ground, stands) = (self.surface[cell], land.obstacle_m(cell));
        let top = ground + stands;
        let fallen = if sum > 0.0 { line / sum - way.through_m / LEE_RUN } else { top };
        if fallen > top {
            let height = (caster / sum).max(LEAST_M);
            self.lee[cell] = [fallen, height];
            return 1.0 - CALMED * smooth((fallen - ground) / height);
        }
        self.lee[cell] = [top, stands.max(LEAST_M)];
        1.0
    }
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
        column.add(Part { ice, water: 0, depth: depth.max(1) }, Column::drifted_albedo());
    }
    -ice
}
