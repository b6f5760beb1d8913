//! Uniforms of one step: the laws of [`laws`] for a lattice, as integer tables for the cells.

use std::f64::consts::LN_2;

use bytemuck::{Pod, Zeroable};
use glam::DVec2;

use super::{
    frost::{self, Snowing},
    laws::{self, Arrivals},
    reach::Reach,
    windscreen::WiperArm,
};
use crate::falling::sizes::DropSizes;

/// Steps per second.
pub const STEPS_PER_S: f64 = 60.0;
/// Largest number of steps that one frame catches up. Beyond it, the glass takes its declared state.
pub const MAX_STEPS: i64 = 30;
/// Volume of one unit of water in a cell, m^3.
pub const VOLUME_UNIT_M3: f64 = 1e-13;
/// Number of drop classes: sixteen octaves of rarity ([`drop_classes`]) with sixteen parts each.
const DROP_CLASSES: usize = 256;
/// Number of bead classes: four in each octave of volume.
const BEAD_CLASSES: usize = 96;
/// Largest ratio of a bead's contact radius to the cell's edge. A bead then does not reach beyond the neighbouring
/// cells.
const LARGEST: f64 = 0.95;
/// Longest distance that a bead moves in a step, 1/65536 cell.
const FARTHEST: f64 = 58_000.0;
/// Number of units in the edge of a cell, for the positions of an arm.
const ARM_UNIT: f64 = 16.0;
/// Number of units in the length of an arm's direction vectors.
const DIRECTION_UNIT: f64 = 4096.0;

/// Uniform block `Step` of `shaders/glass/cells.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[doc(hidden)]
pub struct StepUniform {
    /// Hash of (seed, step), hash of the seed, columns, rows.
    pub key: [u32; 4],
    /// Limits for a random number of 32 bits: below them a cell gets at least 1, 2 or 3 drops. Then the probability per
    /// step, in 1/65536, that a fine bead dries.
    pub arrive: [u32; 4],
    /// Declared state: water per cell and step, in 1/256 unit; drops per cell and step, in 1/65536; index of the step;
    /// volume of the largest bead that rests, units.
    pub declared: [u32; 4],
    /// Largest volume of a cell, units; 1 if some cells get less than all of the rain.
    pub limits: [u32; 4],
    /// For each arm, three rows: (pivot x, y, inner radius, outer radius), in 1/16 cell; (direction of the blade at its
    /// lower angle in the step x, y, direction half way x, y), in 1/4096; (direction at its higher angle x, y, in
    /// 1/4096, half width, in 1/16 cell, 1 if there is an arm).
    pub arms: [[i32; 4]; 6],
    /// Volumes of drops, units, from common to rare.
    pub drops: [[u32; 4]; DROP_CLASSES / 4],
    /// Beads by class of volume: radius, in 1/256 cell, + 1024 x evaporation, in 1/4096 unit per step; motion x, y, in
    /// 1/65536 cell per step; 256 x driving force / retention.
    pub beads: [[i32; 4]; BEAD_CLASSES],
    /// Snow: limit for a random number of 32 bits, below which a flake lands on a cell. Then, in units of water, a
    /// flake, the melt per step (in 1/4096), and the largest amount in a cell.
    pub snow: [u32; 4],
    /// Shares of the rain that reach the nodes over the pane ([`Reach`]).
    pub reach: [[u32; 4]; 8],
}

/// Conditions on the glass during a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepConditions {
    /// Edge of a cell, m.
    pub cell_m: f64,
    /// Sizes of the raindrops.
    pub rain: DropSizes,
    /// Share of the weather's rain that reaches the glass, without the effect of boxes and maps.
    pub exposed: f64,
    /// Upward component of the glass's outward normal.
    pub up: f64,
    /// Speed of the glass against the air along its outward normal, m/s.
    pub approach_m_s: f64,
    /// Speed of the air up the glass, m/s.
    pub airflow_m_s: f64,
    /// Direction of gravity in the glass's (u, v), with length 1 on upright glass.
    pub down: DVec2,
    /// Relative humidity, 0 to 1.
    pub relative_humidity: f64,
    /// Temperature, degrees Celsius.
    pub temperature_c: f64,
    /// Snowfall.
    pub snow: Snowing,
    /// Heating of the glass, W/m^2.
    pub heat_w_m2: f64,
}

impl StepConditions {
    /// Returns the drops that arrive.
    pub fn arrivals(&self) -> Arrivals {
        Arrivals::of(&self.rain, self.exposed, self.up, self.approach_m_s)
    }

    /// Returns the time in which the largest bead dries, s. The cap's radius follows r^2 = r0^2 - 2 k t / (3 f) for V =
    /// f r^3 and an evaporation of k r. Infinite in saturated air.
    pub fn drying_s(&self) -> f64 {
        let r = LARGEST * self.cell_m;
        let per_m = laws::evaporation_m3_s(r, self.relative_humidity, self.temperature_c, self.airflow_m_s) / r;
        1.5 * laws::volume_factor() * r * r / per_m
    }
}

/// Cache of the uniforms that depend on the conditions alone.
pub struct Tables {
    /// Conditions for which `numbers` was computed.
    of: Option<StepConditions>,
    numbers: StepUniform,
}

impl Default for Tables {
    fn default() -> Self {
        Self { of: None, numbers: StepUniform::zeroed() }
    }
}

/// Returns the 32-bit PCG hash of a number (Jarzynski & Olano 2020).
pub fn pcg(v: u32) -> u32 {
    let state = v.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// Returns a hash of two numbers.
fn key(a: u64, b: u64) -> u32 {
    [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32].into_iter().fold(0x9e37_79b9, |k, part| pcg(k ^ part))
}

/// Returns the hash of a seed for patterns that stay in place on the glass.
pub fn seed_key(seed: u64) -> u32 {
    key(seed, 0x0067_6c61_7373)
}

impl Tables {
    /// Computes the numbers again if the conditions have changed.
    fn update(&mut self, acting: &StepConditions) {
        if self.of != Some(*acting) {
            self.numbers = numbers(acting);
            self.of = Some(*acting);
        }
    }

    /// Returns whether drops arrive at the glass.
    pub fn arrive(&mut self, acting: &StepConditions) -> bool {
        if acting.exposed <= 0.0 || acting.rain.number_per_m3() <= 0.0 {
            return false;
        }
        self.update(acting);
        self.numbers.arrive[0] > 0
    }

    /// Returns whether snow lands, and how much of a cell's snow melts in a step, units.
    pub fn snows(&mut self, acting: &StepConditions) -> (bool, f64) {
        self.update(acting);
        let [chance, _, melt, _] = self.numbers.snow;
        (acting.exposed > 0.0 && chance > 0, f64::from(melt) / 4096.0)
    }

    /// Returns the largest amount of snow in a cell, units.
    pub fn most_snow(&self) -> f64 {
        f64::from(self.numbers.snow[3])
    }

    /// Returns the direction in (u, v) in which the largest beads of a cell run, with any length; 0 if they rest.
    pub fn flow(&self) -> DVec2 {
        let largest = &self.numbers.beads[4 * (31 - (self.numbers.limits[0] | 1).leading_zeros()) as usize];
        DVec2::new(largest[1].into(), largest[2].into())
    }

    /// Returns the uniforms of `step`. `arms` has the wipers, each with the angles of its blade at the beginning and at
    /// the end of the step, rad.
    #[doc(hidden)]
    pub fn at(
        &mut self,
        (acting, reach): (&StepConditions, &Reach),
        seed: u64,
        step: i64,
        size: [u32; 2],
        arms: &[Option<(WiperArm, [f64; 2])>; 2],
    ) -> StepUniform {
        self.update(acting);
        let mut n = self.numbers;
        n.key = [key(seed, step as u64), seed_key(seed), size[0], size[1]];
        n.declared[2] = step as u32;
        (n.reach, n.limits[1]) = (reach.words(), u32::from(*reach != Reach::ALL));
        for (i, arm) in arms.iter().enumerate() {
            let rows = arm.as_ref().map_or([[0; 4]; 3], |(arm, angles)| arm_numbers(arm, *angles, acting.cell_m));
            n.arms[3 * i..3 * i + 3].copy_from_slice(&rows);
        }
        n
    }
}

/// Returns the uniforms that depend on the conditions alone.
fn numbers(acting: &StepConditions) -> StepUniform {
    let mut n = StepUniform::zeroed();
    let arrivals = acting.arrivals();
    let per_cell = acting.cell_m * acting.cell_m / STEPS_PER_S;
    let mean = arrivals.number_m2_s * per_cell;
    // Takes the chances of at least 1, 2 and 3 drops from the Poisson distribution. Four and more drops count as three.
    let none = libm::exp(-mean);
    let at_least = [1.0 - none, 1.0 - none * (1.0 + mean), 1.0 - none * (1.0 + mean + 0.5 * mean * mean)];
    let chance = |p: f64| (p.clamp(0.0, 1.0) * 4_294_967_295.0) as u32;
    let units = |m3: f64, scale: f64, most: f64| (m3 / VOLUME_UNIT_M3 * scale).round().min(most) as u32;
    let fine = 2e-4;
    let loss = |r: f64| {
        laws::evaporation_m3_s(r, acting.relative_humidity, acting.temperature_c, acting.airflow_m_s) / STEPS_PER_S
    };
    let dries = loss(fine) / (laws::volume_factor() * fine * fine * fine);
    n.arrive = [chance(at_least[0]), chance(at_least[1]), chance(at_least[2]), (dries * 65_536.0).ceil() as u32];
    let water = units(arrivals.water_m_s * per_cell, 256.0, 2e6);
    n.declared = [water, (mean * 65_536.0).min(1e5) as u32, 0, 0];
    n.limits[0] = units(laws::volume_factor() * (LARGEST * acting.cell_m).powi(3), 1.0, 1.6e7);
    let stays = acting.exposed * acting.snow.stays_m_s(acting.up, acting.approach_m_s);
    let flake = units(acting.snow.flake_m3.min(frost::of_a_flake_m3(acting.cell_m)), 1.0, 1e8);
    let wind = acting.approach_m_s.abs().max(acting.airflow_m_s.abs());
    let melts = frost::melts_m_s(acting.heat_w_m2, acting.temperature_c, wind);
    n.snow = [
        if flake > 0 { chance(stays * per_cell / (f64::from(flake) * VOLUME_UNIT_M3)) } else { 0 },
        flake,
        units(melts * per_cell, 4096.0, 4e9),
        units(frost::most_m3(acting.cell_m), 1.0, 4e8),
    ];
    drop_classes(&arrivals, &mut n.drops);
    for i in 0..BEAD_CLASSES {
        let octave = (i as f64 + 0.5) / 4.0;
        let volume = libm::exp(octave * LN_2) * VOLUME_UNIT_M3;
        let (row, rests) = bead(acting, volume, loss(laws::radius_m(volume)));
        n.beads[i] = row;
        if rests {
            n.declared[3] = libm::exp(i as f64 / 4.0 * LN_2) as u32;
        }
    }
    n
}

/// Returns the row of a class of beads, and whether its beads can rest on the glass.
fn bead(acting: &StepConditions, volume: f64, loss: f64) -> ([i32; 4], bool) {
    let r = laws::radius_m(volume);
    let held = laws::retention_n(r);
    let pull = acting.down * (laws::WATER * laws::GRAVITY * volume);
    let force = pull + DVec2::new(0.0, laws::drag_n(r, acting.airflow_m_s));
    let drive = libm::sqrt(force.x * force.x + force.y * force.y);
    let full = r >= 0.93 * LARGEST * acting.cell_m;
    let mut speed = laws::speed_m_s(volume, drive) / STEPS_PER_S / acting.cell_m * 65_536.0;
    if full && drive > 0.0 {
        // Lets a cell that is full lose its water at the speed of a film, about a tenth of a cell per step.
        speed = speed.max(6_000.0);
    }
    let motion = if drive > 0.0 { force * (speed.min(FARTHEST) / drive) } else { DVec2::ZERO };
    let ratio = if full { 65_535.0 } else { (256.0 * drive / held).min(65_535.0) };
    let radius = (r / acting.cell_m * 256.0).min(1023.0) as i32;
    let loss = (loss / VOLUME_UNIT_M3 * 4096.0).round().min(1e6) as i32;
    ([radius + 1024 * loss, motion.x.round() as i32, motion.y.round() as i32, ratio as i32], ratio < 140.0)
}

/// Fills in the mean volumes of the drop classes. The rarity R of a drop is the share of larger drops. Class 16 k + j
/// has the drops with (31 - j) / 16 <= 2^(k + 1) R < (32 - j) / 16. Large drops, which are rare and heavy, therefore
/// have classes of their own. The last class also has all rarer drops.
fn drop_classes(arrivals: &Arrivals, drops: &mut [[u32; 4]; DROP_CLASSES / 4]) {
    if arrivals.number_m2_s <= 0.0 {
        return;
    }
    let mut classes = arrivals.classes.iter();
    // Starts from the largest drops. `left` is the rest of the present diameter class, as a share of all drops.
    let (mut left, mut volume) = (0.0, 0.0);
    let mut from = 0.0;
    for i in (0..DROP_CLASSES).rev() {
        let (octave, part) = ((i / 16) as i32, (i % 16) as f64);
        let to = (32.0 - part) / 16.0 * libm::scalbn(0.5, -octave);
        let (mut due, mut water) = (to - from, 0.0);
        let share = due;
        while due > 0.0 {
            if left <= 0.0 {
                let Some((d, flux)) = classes.next() else { break };
                (left, volume) = (flux / arrivals.number_m2_s, laws::drop_volume_m3(*d));
            }
            let taken = left.min(due);
            water += taken * volume;
            (left, due) = (left - taken, due - taken);
        }
        if due > 0.0 {
            water += due * volume;
        }
        drops[i / 4][i % 4] = (water / share / VOLUME_UNIT_M3).round() as u32;
        from = to;
    }
}

/// Returns the three rows of [`StepUniform::arms`] for a wiper whose blade moves between two angles, rad.
fn arm_numbers(arm: &WiperArm, [before, now]: [f64; 2], cell_m: f64) -> [[i32; 4]; 3] {
    let place = |m: f64| (m / cell_m * ARM_UNIT).round() as i32;
    // Limits the sector to 170 degrees: the test of cells needs it within the half plane around its middle direction.
    let widest = 170f64.to_radians();
    let before = before.clamp(now - widest, now + widest);
    let (low, high) = if before < now { (before, now) } else { (now, before) };
    let unit = |angle: f64| {
        let (s, c) = libm::sincos(angle);
        [(c * DIRECTION_UNIT).round() as i32, (s * DIRECTION_UNIT).round() as i32]
    };
    let ([lx, ly], [mx, my], [hx, hy]) = (unit(low), unit(0.5 * (low + high)), unit(high));
    let outer = place(arm.length_m).min(30_000);
    let half_width = place(0.5 * arm.blade_width_m);
    [
        [place(arm.pivot_m[0]), place(arm.pivot_m[1]), place(arm.inner_radius_m), outer],
        [lx, ly, mx, my],
        [hx, hy, half_width, 1],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    /// Returns the conditions of a car in rain of this rate.
    pub fn driving(rain_mm_h: f64) -> StepConditions {
        StepConditions {
            cell_m: 0.004,
            rain: DropSizes::of_rain(rain_mm_h, 1.0),
            exposed: 1.0,
            up: 0.5,
            approach_m_s: 12.0,
            airflow_m_s: 5.0,
            down: DVec2::new(0.0, -0.87),
            relative_humidity: 0.9,
            temperature_c: 12.0,
            snow: Snowing::default(),
            heat_w_m2: 0.0,
        }
    }

    #[test]
    fn classes_hold_all_the_water_that_arrives() {
        for rate in [0.1, 5.0, 50.0, 500.0] {
            let (acting, mut sum) = (driving(rate), 0.0);
            let n = numbers(&acting);
            for i in 0..DROP_CLASSES {
                let octave = (i / 16) as f64;
                // The rarest class also includes all rarer drops.
                let share = 0.5f64.powf(octave + 5.0) * if i == DROP_CLASSES - 1 { 17.0 } else { 1.0 };
                sum += share * f64::from(n.drops[i / 4][i % 4]) * VOLUME_UNIT_M3;
            }
            let arrivals = acting.arrivals();
            let mean = arrivals.water_m_s / arrivals.number_m2_s;
            assert!((sum / mean - 1.0).abs() < 5e-3, "{rate} mm/h: {sum} {mean}");
            let sorted: Vec<u32> = n.drops.iter().flatten().copied().collect();
            assert!(sorted.windows(2).all(|w| w[0] <= w[1]), "common drops are small");
        }
    }

    #[test]
    fn extremes_stay_in_range() {
        for rate in [0.0, 1e-9, 500.0] {
            for approach_m_s in [-400.0, 0.0, 400.0] {
                for airflow_m_s in [-100.0, 0.0, 100.0] {
                    let acting = StepConditions { approach_m_s, airflow_m_s, relative_humidity: 0.0, ..driving(rate) };
                    let n = numbers(&acting);
                    assert!(n.arrive[0] >= n.arrive[1] && n.arrive[1] >= n.arrive[2]);
                    assert!(n.beads.iter().all(|b| b[1].abs() <= 58_000 && b[2].abs() <= 58_000 && b[0] >= 0));
                }
            }
        }
    }

    #[test]
    fn offsets_agree_with_the_shader() {
        shader::assert_layout!(
            "glass/cells.wgsl",
            "Step",
            StepUniform,
            [key, arrive, declared, limits, arms, drops, beads, reach]
        );
    }
}
