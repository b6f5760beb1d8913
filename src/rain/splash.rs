//! Splashes: slots of a grid on the ground, each of which takes one drop after the other, as many as the flux brings.

use glam::{DVec2, DVec3};

use super::{
    lattice::{random3, short_seed},
    uniforms::Classes,
};

/// Side of a cell of the grid, m.
const SIDE_M: f64 = 0.5;
/// Cells along one side of the square round the camera.
const CELLS: u32 = 40;
/// Time that a crown stands, s: some milliseconds per millimetre of drop, and its droplets' flight.
pub const LIFE_S: f64 = 0.08;
/// Distance at which splashes have faded, m.
pub const REACH_M: f64 = 0.5 * SIDE_M * CELLS as f64;
/// Most slots of a cell.
const MOST_SLOTS: u32 = 8;
/// Most slots that are looked at in one draw.
pub(super) const MOST: u32 = MOST_SLOTS * CELLS * CELLS;
/// Drops below this diameter make no crown that could be seen, mm.
pub const LEAST_MM: f64 = 1.2;

/// `SplashUniform` of `shaders/rain/splash.wgsl`, which explains the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct SplashUniform {
    pub cell: [i32; 2],
    pub place: [f32; 2],
    pub side: f32,
    pub life: f32,
    pub slots: u32,
    pub cells: u32,
    pub tick: u32,
    pub part: f32,
    pub share: f32,
    pub diameter: f32,
    pub speed: f32,
    pub ground: f32,
    pub reach: f32,
    pub pad: f32,
}

/// A splash that stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    /// From the camera, east and north, m.
    pub xy_m: DVec2,
    /// 0 when it has landed, 1 when it is gone.
    pub age: f64,
}

/// How many splash, and of what size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splashes {
    /// Splashes a second and m^2 of level ground that are drawn.
    pub drawn_per_m2_s: f64,
    /// And those that the slots have no room for: the smallest.
    pub left_out_per_m2_s: f64,
    /// Mean diameter, mm, and fall speed of those that are drawn.
    pub diameter_mm: f64,
    /// See `diameter_mm`.
    pub speed_m_s: f64,
}

impl Splashes {
    /// From the drops of each class: diameter (mm), fall speed (m/s), flux (1/(m^2 s)); the largest first to be drawn.
    pub fn new(classes: &Classes) -> Self {
        let room = f64::from(MOST_SLOTS) / (LIFE_S * SIDE_M * SIDE_M);
        let mut s = Self { drawn_per_m2_s: 0.0, left_out_per_m2_s: 0.0, diameter_mm: 0.0, speed_m_s: 0.0 };
        for &(d, v, flux) in classes.flux.iter().rev().filter(|c| c.0 >= LEAST_MM) {
            let drawn = flux.min(room - s.drawn_per_m2_s);
            s.drawn_per_m2_s += drawn;
            s.left_out_per_m2_s += flux - drawn;
            s.diameter_mm += d * drawn;
            s.speed_m_s += v * drawn;
        }
        if s.drawn_per_m2_s > 0.0 {
            s.diameter_mm /= s.drawn_per_m2_s;
            s.speed_m_s /= s.drawn_per_m2_s;
        }
        s
    }

    /// Splashes that stand at a time in one cell, on the mean.
    fn standing(&self) -> f64 {
        self.drawn_per_m2_s * LIFE_S * SIDE_M * SIDE_M
    }

    /// Slots that are looked at in one draw.
    pub(crate) fn instances(&self) -> u32 {
        CELLS * CELLS * self.slots()
    }

    /// What has landed and stands at `time_s` round a camera at `position_m` (east, north, up of a point fixed to the world),
    /// ten metres to either side: the twin of `landing_of` in `shaders/rain/splash.wgsl`, whatever lies below.
    pub fn landings(&self, seed: u64, position_m: DVec3, time_s: f64) -> impl Iterator<Item = Landing> {
        let (u, seed) = (self.uniform((position_m, 0.0), time_s, 1.0), short_seed(seed));
        let unit = |v: u32| f64::from(v >> 8) / 16_777_216.0;
        (0..self.instances()).filter_map(move |instance| {
            let (slot, index) = (instance % u.slots, instance / u.slots);
            let half = (u.cells / 2) as i32;
            let step = [(index % u.cells) as i32 - half, (index / u.cells) as i32 - half];
            let key = [0, 1].map(|i| u.cell[i].wrapping_add(step[i]) as u32);
            let time = f64::from(u.part) + unit(random3([key[0], key[1], seed ^ slot])[0]);
            let turn = u.tick.wrapping_add(u32::from(time >= 1.0));
            let chance =
                random3([key[0] ^ turn.wrapping_mul(0x9e37_79b9), key[1], seed.wrapping_add(77u32.wrapping_mul(slot))]);
            let side = f64::from(u.side);
            let at = |i: usize| (f64::from(step[i]) + unit(chance[i])) * side - f64::from(u.place[i]);
            let landing = Landing { xy_m: DVec2::new(at(0), at(1)), age: time.fract() };
            (unit(chance[2]) < f64::from(u.share)).then_some(landing)
        })
    }

    fn slots(&self) -> u32 {
        self.standing().ceil() as u32
    }

    /// For a camera at a place (east, north, up of a point fixed to the world, m) so high above the ground, m; so large a
    /// share of them is shown.
    pub(crate) fn uniform(&self, (position_m, height_m): (DVec3, f64), time_s: f64, shown: f64) -> SplashUniform {
        let cell = |x: f64| (x / SIDE_M).floor();
        let turns = time_s / LIFE_S;
        let part = turns - turns.floor();
        SplashUniform {
            // Wraps after 10^9 m.
            cell: [position_m.x, position_m.y].map(|x| cell(x) as i64 as i32),
            place: [position_m.x, position_m.y].map(|x| (x - cell(x) * SIDE_M) as f32),
            side: SIDE_M as f32,
            life: LIFE_S as f32,
            slots: self.slots(),
            cells: CELLS,
            tick: (turns.floor() as i64) as u32,
            part: part as f32,
            share: (shown * self.standing() / f64::from(self.slots().max(1))) as f32,
            diameter: (self.diameter_mm * 1e-3) as f32,
            speed: self.speed_m_s as f32,
            ground: -height_m as f32,
            reach: REACH_M as f32,
            pad: 0.0,
        }
    }
}
