//! Hollows of a ground of which no heights are known: a sum of waves fixed to the host's world, in f64 the twin of
//! `shaders/ground/hollows.wgsl`.
//!
//! Waves rather than noise on a lattice: a picture's pixel averages each of them exactly, so that puddles far away fade to
//! their mean without flicker, and their sum is spread normally, so that the level of water follows from the share of ground
//! under it.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};

/// The pattern repeats after this distance, m: a multiple of every wave.
pub const PERIOD_M: f64 = 1e4;
/// Waves of the pattern, as many as the shader's `HOLLOW_WAVES`.
pub const WAVES: usize = 16;
/// Bands of lengths: the number of waves, the longest and the shortest, m, and their share of the variance. Each has waves
/// enough that what a far pixel still sees looks as irregular as what a near one does.
const BANDS: [(usize, f64, f64, f64); 3] = [(6, 17.0, 7.0, 0.45), (6, 5.3, 2.2, 0.35), (4, 1.7, 0.8, 0.2)];

#[derive(Clone, Copy, Debug, PartialEq)]
struct Wave {
    /// Turns to [`PERIOD_M`] along both axes: whole numbers.
    turns: DVec2,
    /// Turns.
    phase: f64,
    amplitude: f64,
}

/// The hollows of a world.
#[derive(Clone, Debug, PartialEq)]
pub struct Hollows {
    waves: [Wave; WAVES],
}

impl Hollows {
    /// Those of a world with this seed.
    pub fn new(seed: u64) -> Self {
        let mut state = seed;
        let mut waves = [Wave { turns: DVec2::ZERO, phase: 0.0, amplitude: 0.0 }; WAVES];
        let each = BANDS.iter().flat_map(|band| (0..band.0).map(move |i| (band, i)));
        for (k, (wave, (&(count, longest, shortest, share), i))) in waves.iter_mut().zip(each).enumerate() {
            let length = longest * libm::pow(shortest / longest, (i as f64 + uniform(&mut state)) / count as f64);
            // By the golden angle no two waves run alike.
            let (sin, cos) = libm::sincos(k as f64 * 2.399_963_229_728_653 + 0.7);
            wave.turns = (DVec2::new(cos, sin) * (PERIOD_M / length)).round();
            wave.phase = uniform(&mut state);
            wave.amplitude = (2.0 * share / count as f64).sqrt();
        }
        Self { waves }
    }

    /// Depth below the mean ground at a place of the pattern, in units of its root mean square.
    pub fn depth(&self, at: DVec2) -> f64 {
        self.waves.iter().map(|w| w.amplitude * libm::sin(TAU * w.turns_at(at).fract())).sum()
    }

    /// The waves as the shader reads them, for a camera at this place of the pattern: wave vector in turns per metre, phase
    /// in turns, amplitude.
    pub(super) fn seen_from(&self, at: DVec2) -> [[f32; 4]; WAVES] {
        self.waves.map(|w| {
            let k = w.turns / PERIOD_M;
            [k.x as f32, k.y as f32, w.turns_at(at).rem_euclid(1.0) as f32, w.amplitude as f32]
        })
    }
}

impl Wave {
    fn turns_at(&self, at: DVec2) -> f64 {
        // Whole turns are dropped before they cost digits.
        let at = at.rem_euclid(DVec2::splat(PERIOD_M)) / PERIOD_M;
        self.phase + self.turns.dot(at)
    }
}

/// The next number in [0, 1) (SplitMix64, Steele, Lea & Flood 2014).
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Axes of the pattern in the host's world: the two of its three axes that lie flattest on the ground. In an Earth-centred
/// world these are others on each of six sides of the planet.
pub(crate) fn pattern_axes(world_to_enu: &DMat3) -> [DVec3; 2] {
    let up = (world_to_enu.transpose() * DVec3::Z).abs();
    if up.z >= up.x && up.z >= up.y {
        [DVec3::X, DVec3::Y]
    } else if up.y >= up.x {
        [DVec3::X, DVec3::Z]
    } else {
        [DVec3::Y, DVec3::Z]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::reference::normal_quantile;

    #[test]
    fn the_share_under_water_is_the_one_asked_for() {
        let hollows = Hollows::new(3);
        let depths: Vec<f64> = (0..90_000)
            .map(|i| hollows.depth(DVec2::new(f64::from(i % 300) * 1.37, f64::from(i / 300) * 1.71)))
            .collect();
        for share in [0.05, 0.2, 0.35, 0.6] {
            let level = normal_quantile(1.0 - share);
            let got = depths.iter().filter(|d| **d > level).count() as f64 / depths.len() as f64;
            assert!((got - share).abs() < 0.02, "{share}: {got}");
        }
    }

    #[test]
    fn a_far_place_has_the_same_hollows_as_its_image_near_the_origin() {
        let hollows = Hollows::new(9);
        let at = DVec2::new(12.3, -45.6);
        for far in [DVec2::new(1e7, 0.0), DVec2::new(-3e7, 1e7)] {
            assert!((hollows.depth(at) - hollows.depth(at + far)).abs() < 1e-6);
        }
        assert!(Hollows::new(10).depth(at) != hollows.depth(at), "another seed is another ground");
    }
}
