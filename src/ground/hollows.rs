//! Hollows of a ground whose heights are unknown: a sum of waves that is fixed to the host's world. This is the f64
//! reference of `shaders/ground/hollows.wgsl`.
//!
//! Waves have two advantages over noise on a lattice. The average of each wave over a pixel is known exactly, so
//! distant puddles fade to their mean without flicker. The sum of the waves is normally distributed, so the water level
//! follows from the share of ground under water.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};

use crate::chance::RandomStream;

/// Distance along each axis after which the pattern repeats, m. Each wave makes a whole number of turns in it.
pub const PERIOD_M: f64 = 1e4;
/// Number of waves in the pattern.
pub const WAVES: usize = 16;
/// Turns of each wave in [`PERIOD_M`] along the first and the second axis of the pattern ([`pattern_axes`]), whole
/// numbers. They are the same in all worlds; only the phases depend on the seed. The shader has them as constants: some
/// software drivers take longer to read a uniform block than to add a wave.
///
/// The waves form three bands, with wavelengths of 14.9 to 7.7 m, 4.9 to 2.2 m and 1.4 to 0.8 m. Each band has enough
/// waves to look irregular even where pixels are too coarse for the shorter bands. The directions of successive waves
/// differ by the golden angle.
const TURNS: [(i32, i32); WAVES] = [
    (513, 432),
    (-684, 28),
    (569, -567),
    (-43, 940),
    (-706, -846),
    (1295, 174),
    (-1672, 1164),
    (531, -2365),
    (1352, 2357),
    (-2875, -916),
    (3489, -1613),
    (-1736, 4151),
    (-2345, -6515),
    (6797, 3570),
    (-9348, 2467),
    (6685, -10404),
];
/// Number of waves in each band, and the band's share of the variance.
const BANDS: [(usize, f64); 3] = [(6, 0.45), (6, 0.35), (4, 0.2)];

/// Hollows of one world.
#[derive(Clone, Debug, PartialEq)]
pub struct Hollows {
    /// Phase of each wave, turns.
    phases: [f64; WAVES],
}

/// Returns the turns of a wave per [`PERIOD_M`], along both axes.
fn turns(wave: usize) -> DVec2 {
    let (east, north) = TURNS[wave];
    DVec2::new(east.into(), north.into())
}

/// Returns the amplitude of a wave, in units of the pattern's root mean square depth.
fn amplitude(wave: usize) -> f64 {
    let mut first = 0;
    for (count, share) in BANDS {
        if wave < first + count {
            return (2.0 * share / count as f64).sqrt();
        }
        first += count;
    }
    0.0
}

impl Hollows {
    /// Creates the hollows of a world with this seed.
    pub fn new(seed: u64) -> Self {
        let mut stream = RandomStream::seeded(seed);
        // Every second random number is skipped: for seed 0, the skipped ones gave the wavelengths in TURNS.
        let phases = [(); WAVES].map(|()| {
            stream.unit();
            stream.unit()
        });
        Self { phases }
    }

    /// Returns the depth below the mean ground at a place of the pattern (m along its axes), in units of the depth's
    /// root mean square.
    pub fn depth(&self, place: DVec2) -> f64 {
        (0..WAVES).map(|k| amplitude(k) * libm::sin(TAU * self.turns_at(k, place).fract())).sum()
    }

    /// Returns the phases of the waves for a camera at this place of the pattern, in turns, in groups of four as the
    /// shader reads them.
    pub(super) fn seen_from(&self, place: DVec2) -> [[f32; 4]; WAVES / 4] {
        std::array::from_fn(|four| std::array::from_fn(|i| self.turns_at(4 * four + i, place).rem_euclid(1.0) as f32))
    }

    /// Returns the phase of a wave at a place, turns.
    fn turns_at(&self, wave: usize, place: DVec2) -> f64 {
        // Removes whole periods first: large coordinates would cost precision.
        let place = place.rem_euclid(DVec2::splat(PERIOD_M)) / PERIOD_M;
        self.phases[wave] + turns(wave).dot(place)
    }
}

/// Returns the axes of the pattern in the host's world: the two of the world's three axes that are closest to
/// horizontal. In an Earth-centred world the planet has six sides, and the choice changes from each side to the next.
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

    #[test]
    fn the_shader_has_the_same_waves() {
        let text = crate::gpu::shader::assemble("ground/hollows.wgsl").unwrap();
        let fours = |of: &dyn Fn(usize) -> String| {
            let four = |first: usize| (first..first + 4).map(of).collect::<Vec<_>>().join(", ");
            (0..WAVES).step_by(4).map(|first| format!("    vec4f({}),\n", four(first))).collect::<String>()
        };
        for (name, numbers) in [
            ("WAVES_EAST", fours(&|k| format!("{:.4}", turns(k).x / PERIOD_M))),
            ("WAVES_NORTH", fours(&|k| format!("{:.4}", turns(k).y / PERIOD_M))),
            ("WAVES_AMPLITUDE", fours(&|k| format!("{:.7}", amplitude(k)))),
        ] {
            let table = format!("const {name}: array<vec4f, 4> = array<vec4f, 4>(\n{numbers});");
            assert!(text.contains(&table), "{table}");
        }
        let variance: f64 = (0..WAVES).map(|k| 0.5 * amplitude(k).powi(2)).sum();
        assert!((variance - 1.0).abs() < 1e-12, "{variance}");
    }
}
