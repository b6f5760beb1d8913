//! Stones of ice (hail and ice pellets) among the drops: the number of each size in each shell of the lattice, and
//! their landings on the ground, where they hop.
//!
//! Stones have a lattice of their own, a repeated cube of air as for drops ([`super::lattice`]). Each shell is twice as
//! wide as the one before and holds all stones of its volume, because hail is rare and seen from afar. Where stones are
//! too many for that, as pellets often are, each drawn stone represents several. Outer shells in which a stone would
//! represent more than `MOST_WEIGHT` are not drawn: their stones are extinction, drawn with the fog.

use glam::DVec3;

use super::{
    drops::GRAVITY_M_S2,
    ice::{Stone, StoneSizes},
    shells::{FADE, SPEED_UNIT},
};
use crate::{falling::lattice::fraction, weather::Falling};

/// Number of shells of the lattice.
const SHELLS: usize = 4;
/// Side of the innermost shell's cell, m.
const SIDE_M: f64 = 4.0;
/// Largest number of stones that one drawn stone may represent.
const MOST_WEIGHT: f64 = 16.0;
/// Number of classes of diameter, for pellets and for hail each.
const CLASSES: usize = 8;
/// Number of classes of pellets and of hail together.
pub(crate) const STONE_CLASSES: usize = 2 * CLASSES;

/// Side of a cell of the grid of landings, m.
const SIDE: f64 = 0.5;
/// Number of cells along one side of the square around the camera.
const CELLS: u32 = 40;
/// Time for which a stone is drawn after its landing, s: it hops, then lies.
const LIFE_S: f64 = 1.0;
/// Largest number of slots in a cell.
const MOST_SLOTS: u32 = 16;

/// Uniform block `StoneUniform` of `shaders/rain/stones.wgsl`, which describes the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct StoneUniform {
    pub air: [[u32; 4]; SHELLS],
    pub shells: [[f32; 4]; SHELLS],
    pub first: [u32; 4],
    pub upto: [[u32; SHELLS]; STONE_CLASSES],
    pub classes: [[f32; 4]; STONE_CLASSES],
    pub weight: [[f32; SHELLS]; STONE_CLASSES],
    pub cell: [i32; 2],
    pub place: [f32; 2],
    pub side: f32,
    pub life: f32,
    pub slots: u32,
    pub cells: u32,
    pub tick: u32,
    pub part: f32,
    pub share: f32,
    pub ground: f32,
    pub reach: f32,
    pub gravity: f32,
    pub pad: [f32; 2],
}

/// Returns the side of a shell's cell, m.
fn side_m(shell: usize) -> f64 {
    SIDE_M * f64::from(1u32 << shell)
}

/// Properties shared by the stones of one class.
struct StoneClass {
    /// Kind of stone.
    stone: Stone,
    /// Diameter, mm: the geometric mean of the class's bounds.
    diameter_mm: f64,
    /// Fall speed, m/s.
    speed_m_s: f64,
    /// Number of stones in a cubic metre of air.
    number_per_m3: f64,
}

impl StoneClass {
    /// Creates class `i`: the classes of pellets come before those of hail, each from small to large.
    fn new(sizes: &StoneSizes, i: usize) -> Self {
        let stone = Stone::ALL[i / CLASSES];
        let (low, high) = stone.range_mm();
        let edge = |k: usize| low * libm::pow(high / low, k as f64 / CLASSES as f64);
        let (a, b) = (edge(i % CLASSES), edge(i % CLASSES + 1));
        let diameter_mm = (a * b).sqrt();
        Self {
            stone,
            diameter_mm,
            speed_m_s: sizes.speed_m_s(stone, diameter_mm),
            number_per_m3: sizes.number_between(stone, a, b),
        }
    }
}

/// Stones in the air and on the ground around a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stones {
    /// Per class, pellets before hail, each from small to large: diameter, m; fall speed, [`SPEED_UNIT`]; share of the
    /// landings of the classes up to this one; 1 for clear ice, else 0.
    table: [[f32; 4]; STONE_CLASSES],
    /// Per class and shell: number of drawn stones of the classes up to this one.
    upto: [[u32; SHELLS]; STONE_CLASSES],
    /// Per class and shell: number of stones that each drawn stone represents.
    weight: [[f32; SHELLS]; STONE_CLASSES],
    /// Number of stones drawn in the air.
    pub drawn: u32,
    /// For pellets and for hail: distance up to which they are drawn, m, and extinction of all of them, 1/m.
    reach: [(f64, f64); 2],
    /// Number of drawn landings per second and m^2 of level ground.
    pub landings_per_m2_s: f64,
    /// Number of landings per second and m^2 that are left out because there are no more slots. The landings of the
    /// smallest stones are left out.
    pub left_out_per_m2_s: f64,
}

impl Stones {
    /// Creates the stones of the precipitation where drops fall `speed_factor` times as fast as at sea level. At most
    /// `most` stones are drawn.
    pub fn new(falling: &Falling, speed_factor: f64, most: u32) -> Self {
        let sizes = StoneSizes::new(falling, speed_factor);
        let volume = SIDE_M.powi(3);
        let classes: [StoneClass; STONE_CLASSES] = std::array::from_fn(|i| StoneClass::new(&sizes, i));
        let mut s = Self {
            table: [[0.0; 4]; STONE_CLASSES],
            upto: [[0; SHELLS]; STONE_CLASSES],
            weight: [[0.0; SHELLS]; STONE_CLASSES],
            drawn: 0,
            reach: [(0.0, 0.0); 2],
            landings_per_m2_s: 0.0,
            left_out_per_m2_s: 0.0,
        };
        // Takes hail first: large stones are visible farthest.
        let mut left = f64::from(most);
        for kind in [Stone::Hail, Stone::Pellet] {
            let own = kind as usize * CLASSES..(kind as usize + 1) * CLASSES;
            let number: f64 = classes[own.clone()].iter().map(|c| c.number_per_m3 * volume).sum();
            let all = |shell: usize| number * f64::from(1u32 << (3 * shell));
            let fits = |last: &usize| all(*last) <= MOST_WEIGHT * left / (*last + 1) as f64;
            let last = (1..SHELLS).rev().find(fits).unwrap_or(0);
            let room = left / (last + 1) as f64;
            for shell in 0..=last {
                if number <= 0.0 {
                    break;
                }
                let share = (room / all(shell)).min(1.0);
                left -= all(shell) * share;
                s.reach[kind as usize].0 = 0.5 * side_m(shell);
                for i in own.clone() {
                    s.weight[i][shell] = (1.0 / share) as f32;
                    s.upto[i][shell] = (all(shell) * share * 256.0 * classes[i].number_per_m3 * volume / number) as u32;
                }
            }
        }
        s.count(&classes);
        s
    }

    /// Computes the landings and the table, and replaces the number of stones of each class, in 256ths, by the whole
    /// number of stones of all classes up to this one.
    fn count(&mut self, classes: &[StoneClass; STONE_CLASSES]) {
        let room = f64::from(MOST_SLOTS) / (LIFE_S * SIDE * SIDE);
        let mut landings = [0.0; STONE_CLASSES];
        for i in (0..STONE_CLASSES).rev() {
            let StoneClass { stone, diameter_mm: d, speed_m_s: speed, number_per_m3: number } = classes[i];
            landings[i] = (number * speed).min(room - self.landings_per_m2_s);
            self.landings_per_m2_s += landings[i];
            self.left_out_per_m2_s += number * speed - landings[i];
            self.reach[stone as usize].1 += number * std::f64::consts::FRAC_PI_2 * d * d * 1e-6;
            let clear = if stone == Stone::Pellet { 1.0 } else { 0.0 };
            self.table[i] = [(1e-3 * d) as f32, (speed / SPEED_UNIT).round() as f32, 0.0, clear];
        }
        let mut landed = 0.0;
        for (row, landing) in self.table.iter_mut().zip(landings) {
            landed += landing;
            row[2] = (landed / self.landings_per_m2_s.max(1e-12)) as f32;
        }
        for shell in 0..SHELLS {
            let mut sum = 0u64;
            for row in &mut self.upto {
                sum += u64::from(row[shell]);
                row[shell] = (sum / 256) as u32;
            }
            self.drawn += self.upto[STONE_CLASSES - 1][shell];
        }
    }

    /// Returns the optical depth of the drawn stones between the camera and objects beyond their reach. It includes
    /// only the stones' discs, which are half of their extinction. The other half is diffraction.
    pub fn hidden_depth(&self) -> f64 {
        let edge = 0.5 * (1.0 + FADE);
        self.reach.iter().map(|(reach, extinction)| 0.5 * extinction * edge * reach).sum()
    }

    /// Returns the distance beyond which no stone is drawn, m.
    pub fn reach_m(&self) -> f64 {
        self.reach[0].0.max(self.reach[1].0)
    }

    /// Returns the number of slots of landings tested in one draw.
    pub fn landings(&self) -> u32 {
        CELLS * CELLS * self.slots()
    }

    /// Returns the mean number of landed stones that are drawn at a time in one cell.
    fn standing(&self) -> f64 {
        self.landings_per_m2_s * LIFE_S * SIDE * SIDE
    }

    /// Returns the number of slots in a cell.
    fn slots(&self) -> u32 {
        self.standing().ceil() as u32
    }

    /// Returns the block for a camera at `position_m` (east, north and up from a point fixed to the world), `height_m`
    /// above the ground, after the air has moved by `displacement_m`.
    pub(crate) fn uniform(&self, position_m: DVec3, height_m: f64, displacement_m: DVec3, time_s: f64) -> StoneUniform {
        let cell = |x: f64| (x / SIDE).floor();
        let turns = time_s / LIFE_S;
        let last = self.upto[STONE_CLASSES - 1];
        let air = |shell: usize| {
            let part = |x: f64| fraction(x, side_m(shell));
            let [x, y, z] = [0, 1, 2].map(|i| part(position_m[i]).wrapping_sub(part(displacement_m[i])));
            [x, y, z, part((time_s * SPEED_UNIT) % side_m(shell))]
        };
        let shells = |shell: usize| {
            let side = side_m(shell);
            [side, 0.25 * side * FADE, 0.5 * side * FADE, 0.0].map(|x| x as f32)
        };
        StoneUniform {
            air: std::array::from_fn(air),
            shells: std::array::from_fn(shells),
            first: [0, last[0], last[0] + last[1], last[0] + last[1] + last[2]],
            upto: self.upto,
            classes: self.table,
            weight: self.weight,
            // Wraps around after 10^9 m.
            cell: [position_m.x, position_m.y].map(|x| cell(x) as i64 as i32),
            place: [position_m.x, position_m.y].map(|x| (x - cell(x) * SIDE) as f32),
            side: SIDE as f32,
            life: LIFE_S as f32,
            slots: self.slots(),
            cells: CELLS,
            tick: (turns.floor() as i64) as u32,
            part: (turns - turns.floor()) as f32,
            share: (self.standing() / f64::from(self.slots().max(1))) as f32,
            ground: -height_m as f32,
            reach: (0.5 * SIDE * f64::from(CELLS)) as f32,
            gravity: GRAVITY_M_S2 as f32,
            pad: [0.0; 2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        gpu::shader,
        weather::{Precipitation, PrecipitationKind, Weather, derive},
    };

    /// Returns precipitation of one kind, with its rate in mm/h.
    fn falling(kind: PrecipitationKind, rate: f64) -> Falling {
        let weather = Weather { precipitation: Precipitation::of(kind, rate), ..Weather::default() };
        derive(&weather).unwrap().precipitation
    }

    #[test]
    fn offsets_are_those_of_the_shader() {
        shader::assert_layout!(
            "rain/stones_view.wgsl",
            "StoneUniform",
            StoneUniform,
            [
                first, upto, classes, weight, cell, place, side, life, slots, cells, tick, part, share, ground, reach,
                gravity
            ]
        );
    }

    #[test]
    fn shells_hold_all_hail_while_there_is_room_and_thinning_keeps_the_number() {
        for (kind, rate) in [
            (PrecipitationKind::Hail, 10.0),
            (PrecipitationKind::IcePellets, 3.0),
            (PrecipitationKind::SmallHail, 30.0),
        ] {
            let f = falling(kind, rate);
            let sizes = StoneSizes::new(&f, 1.0);
            for most in [20_000, 100_000, 400_000] {
                let s = Stones::new(&f, 1.0, most);
                assert!(s.drawn <= most, "{kind:?}: {} of {most}", s.drawn);
                let last = (2.0 * s.reach_m() / SIDE_M).log2() as usize;
                for shell in 0..=last {
                    let stood_for: f64 = (0..STONE_CLASSES)
                        .map(|i| {
                            let before = if i > 0 { s.upto[i - 1][shell] } else { 0 };
                            f64::from(s.upto[i][shell] - before) * f64::from(s.weight[i][shell])
                        })
                        .sum();
                    let all = sizes.number_per_m3() * SIDE_M.powi(3) * 8f64.powi(shell as i32);
                    assert!((stood_for - all).abs() < 0.02 * all + 2.0, "{kind:?} {shell}: {stood_for} of {all}");
                }
                let extinction: f64 = s.reach.iter().map(|r| r.1).sum();
                assert!((extinction / sizes.extinction_per_m() - 1.0).abs() < 0.05, "{kind:?}");
            }
        }
        let hail = Stones::new(&falling(PrecipitationKind::Hail, 10.0), 1.0, 100_000);
        assert!(hail.weight[STONE_CLASSES - 1][..3].iter().all(|w| *w == 1.0), "{:?}", hail.weight);
        let landings = StoneSizes::of_rates(0.0, 10.0, 1.0).on_surface(DVec3::Z, DVec3::ZERO).drops_per_m2_s;
        assert!((hail.landings_per_m2_s / landings - 1.0).abs() < 0.02 && hail.left_out_per_m2_s == 0.0, "{landings}");
        assert_eq!(
            (Stones::new(&falling(PrecipitationKind::Rain, 10.0), 1.0, 1000).drawn, hail.table[15][3]),
            (0, 0.0)
        );
    }
}
