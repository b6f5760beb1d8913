//! Splashes: a grid of slots on the ground. Drops land in each slot one after another, as many as the flux brings.

use glam::{DVec2, DVec3};

use super::classes::Classes;
use crate::falling::{lattice::short_seed, random3};

/// Side of a cell of the grid on the ground, m.
const SIDE_M: f64 = 0.5;
/// Number of cells along a side of the square around the camera in which splashes are drawn.
const CELLS: u32 = 40;
/// Lifetime of a splash, s. It covers the crown, which lasts some milliseconds per millimetre of the drop's diameter,
/// and the flight of the crown's droplets.
pub const LIFE_S: f64 = 0.08;
/// Distance from the camera at which splashes have faded out, m.
pub const REACH_M: f64 = 0.5 * SIDE_M * CELLS as f64;
/// Largest number of slots in a cell.
const MOST_SLOTS: u32 = 8;
/// Smallest diameter of drops whose crown is drawn, mm: the crowns of smaller drops are too small to see.
pub const LEAST_MM: f64 = 1.2;

/// Number of groups of drops. All groups have the same number of drops, and each group is drawn with its mean size.
const SIZES: usize = 8;
/// Ratio of the number of slots to the mean number of splashes at a time on level ground. It is above 1 because
/// windward slopes get more drops.
const MARGIN: f64 = 1.25;

/// Uniform block `SplashUniform` of `shaders/rain/splash.wgsl`, which describes the fields.
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
    pub ground: f32,
    pub reach: f32,
    pub pad: f32,
    pub depth_grain: [f32; 2],
    pub sizes: [[f32; 4]; SIZES],
}

/// Splash that is visible at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    /// Position relative to the camera, east and north, m.
    pub xy_m: DVec2,
    /// Age: 0 when the drop lands, 1 when the splash is gone.
    pub age: f64,
    /// Diameter of the drop, mm.
    pub diameter_mm: f64,
    /// Fall speed of the drop, m/s.
    pub speed_m_s: f64,
    /// Acceptance threshold: the drop lands if the ground gets at least this multiple of the flux on level ground. With
    /// a threshold below 1 it lands on level ground.
    pub chance: f64,
}

/// Number and sizes of splashes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splashes {
    /// Number of drawn splashes per second and m^2 of level ground.
    pub drawn_per_m2_s: f64,
    /// Number of splashes per second and m^2 that are left out because there are no more slots. The smallest splashes
    /// are left out.
    pub left_out_per_m2_s: f64,
    /// Mean diameter, mm, and fall speed, m/s, of groups of drawn splashes that are equal in number, the largest first.
    pub sizes: [(f64, f64); SIZES],
}

impl Splashes {
    /// Creates the splashes from each class's diameter (mm), fall speed (m/s) and flux (1/(m^2 s)). The largest drops
    /// get slots first.
    pub fn new(classes: &Classes) -> Self {
        let room = f64::from(MOST_SLOTS) / (LIFE_S * SIDE_M * SIDE_M);
        let mut s = Self { drawn_per_m2_s: 0.0, left_out_per_m2_s: 0.0, sizes: [(0.0, 0.0); SIZES] };
        let largest_first = || classes.flux.iter().rev().filter(|c| c.0 >= LEAST_MM);
        for &(_, _, flux) in largest_first() {
            let drawn = flux.min(room - s.drawn_per_m2_s);
            s.drawn_per_m2_s += drawn;
            s.left_out_per_m2_s += flux - drawn;
        }
        let part = s.drawn_per_m2_s / SIZES as f64;
        for (i, size) in s.sizes.iter_mut().enumerate().filter(|_| part > 0.0) {
            let (first, mut before) = (part * i as f64, 0.0);
            for &(d, v, flux) in largest_first() {
                // Share of this group that the class has.
                let inside = ((before + flux).min(first + part) - f64::max(before, first)).max(0.0) / part;
                *size = (size.0 + d * inside, size.1 + v * inside);
                before += flux;
            }
        }
        s
    }

    /// Returns the mean number of splashes visible at a time in one cell of level ground.
    fn standing(&self) -> f64 {
        self.drawn_per_m2_s * LIFE_S * SIDE_M * SIDE_M
    }

    /// Returns the number of slots tested in one draw.
    pub(crate) fn instances(&self) -> u32 {
        CELLS * CELLS * self.slots()
    }

    /// Returns the drops that may have landed and whose splash is visible at `time_s`, within ten metres to each side
    /// of a camera at `position_m` (east, north and up from a point fixed to the world). They include drops that land
    /// only on slopes that get more drops than level ground. `arrival_of` in `shaders/rain/splash.wgsl` computes the
    /// same in f32. The height of the ground is not yet known here.
    pub fn landings(&self, seed: u64, position_m: DVec3, time_s: f64) -> impl Iterator<Item = Landing> {
        let (u, seed) = (self.uniform((position_m, 0.0), time_s, 1.0, [0.0; 2]), short_seed(seed));
        let sizes = self.sizes;
        let unit = |v: u32| f64::from(v >> 8) / 16_777_216.0;
        (0..self.instances()).map(move |instance| {
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
            let (diameter_mm, speed_m_s) = sizes[chance[0] as usize % SIZES];
            let chance = unit(chance[2]) / f64::from(u.share);
            Landing { xy_m: DVec2::new(at(0), at(1)), age: time.fract(), diameter_mm, speed_m_s, chance }
        })
    }

    /// Returns the number of slots in a cell.
    fn slots(&self) -> u32 {
        ((MARGIN * self.standing()).ceil() as u32).min(MOST_SLOTS)
    }

    /// Returns the block for a camera at a place (east, north and up from a point fixed to the world, m) and a height
    /// above the ground, m. The share `shown` of the splashes is drawn. `depth_grain` is the error of the host's depth:
    /// an absolute step, and a relative part.
    pub(crate) fn uniform(
        &self,
        (position_m, height_m): (DVec3, f64),
        time_s: f64,
        shown: f64,
        depth_grain: [f64; 2],
    ) -> SplashUniform {
        let cell = |x: f64| (x / SIDE_M).floor();
        let turns = time_s / LIFE_S;
        let part = turns - turns.floor();
        SplashUniform {
            // Wraps around after 10^9 m.
            cell: [position_m.x, position_m.y].map(|x| cell(x) as i64 as i32),
            place: [position_m.x, position_m.y].map(|x| (x - cell(x) * SIDE_M) as f32),
            side: SIDE_M as f32,
            life: LIFE_S as f32,
            slots: self.slots(),
            cells: CELLS,
            tick: (turns.floor() as i64) as u32,
            part: part as f32,
            share: (shown * self.standing() / f64::from(self.slots().max(1))) as f32,
            ground: -height_m as f32,
            reach: REACH_M as f32,
            pad: 0.0,
            depth_grain: depth_grain.map(|v| v as f32),
            sizes: self.sizes.map(|(d, v)| [(d * 1e-3) as f32, v as f32, 0.0, 0.0]),
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

    #[test]
    fn offsets_are_those_of_the_shader() {
        shader::assert_layout!(
            "rain/drops_view.wgsl",
            "SplashUniform",
            SplashUniform,
            [cell, place, side, life, slots, cells, tick, part, share, ground, reach, depth_grain, sizes]
        );
    }

    #[test]
    fn splash_sizes_have_the_mean_of_the_drops_that_splash() {
        for rate in [1.0, 20.0, 150.0] {
            let weather =
                Weather { precipitation: Precipitation::of(PrecipitationKind::Rain, rate), ..Weather::default() };
            let classes = Classes::new(&derive(&weather).unwrap().precipitation, 1.0, u32::MAX);
            let s = Splashes::new(&classes);
            assert!(s.sizes.windows(2).all(|w| w[0].0 >= w[1].0 && w[0].1 >= w[1].1), "{:?}", s.sizes);
            assert!(s.sizes[0].0 > 1.4 * s.sizes[7].0 && s.sizes[7].0 >= LEAST_MM, "{rate}: {:?}", s.sizes);
            if s.left_out_per_m2_s == 0.0 {
                let all = classes.flux.iter().filter(|c| c.0 >= LEAST_MM).map(|c| c.0 * c.2).sum::<f64>();
                let mean = s.sizes.iter().map(|c| c.0).sum::<f64>() / SIZES as f64;
                assert!((mean * s.drawn_per_m2_s / all - 1.0).abs() < 1e-9, "{rate}: {mean}");
            }
        }
    }
}
