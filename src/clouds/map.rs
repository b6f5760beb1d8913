//! The map of where clouds grow: noise made normal by ranks, so that a threshold says how much of the plane lies above it.

use glam::{DVec2, UVec2};

use super::field::{MAP_CELLS, MAP_REACH, MAP_SIZE, Map};
use crate::{
    chance::normal_quantile,
    noise::{cellular_2d, gradient_2d},
};

/// Octaves of the even sheets: the first has half as many cells as the map, so that clouds stand in groups.
const EVEN_OCTAVES: u32 = 4;
/// Amplitude of an octave over that of the one before, of the even and of the cellular sheets.
const PERSISTENCE: [f64; 2] = [0.55, 0.4];
const CELLULAR_OCTAVES: u32 = 3;

/// What a sheet has before its ranks are taken.
fn raw(sheet: u32, at: DVec2, seed: u32) -> f64 {
    let cells = MAP_CELLS as u32;
    let octaves = |count: u32, first: u32, persistence: f64, noise: &dyn Fn(DVec2, UVec2, u32) -> f64| {
        let one = |octave: u32| {
            let period = UVec2::splat(first << octave);
            let key = seed.wrapping_add(0x9e37_79b9u32.wrapping_mul(8 * sheet + octave + 1));
            persistence.powi(octave as i32) * noise(at * period.as_dvec2(), period, key)
        };
        (0..count).map(one).sum::<f64>()
    };
    if sheet < 2 {
        octaves(EVEN_OCTAVES, cells / 2, PERSISTENCE[0], &gradient_2d)
    } else {
        octaves(CELLULAR_OCTAVES, cells, PERSISTENCE[1], &cellular_2d)
    }
}

impl Map {
    /// That of a seed.
    pub fn new(seed: u64) -> Self {
        let seed = (seed ^ (seed >> 32)) as u32;
        let count = MAP_SIZE * MAP_SIZE;
        let mut texels = vec![[0.0; 4]; count];
        for sheet in 0..4u32 {
            let at = |i: usize| DVec2::new((i % MAP_SIZE) as f64 + 0.5, (i / MAP_SIZE) as f64 + 0.5) / MAP_SIZE as f64;
            let mut ranked: Vec<(f64, usize)> = (0..count).map(|i| (raw(sheet, at(i), seed), i)).collect();
            ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (rank, (_, i)) in ranked.into_iter().enumerate() {
                let number = normal_quantile((rank as f64 + 0.5) / count as f64);
                texels[i][sheet as usize] = number.clamp(-MAP_REACH, MAP_REACH) as f32;
            }
        }
        Self(texels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_threshold_says_how_much_of_the_plane_lies_above_it() {
        let map = Map::new(7);
        for sheet in 0..4 {
            for (above, share) in [(0.0, 0.5), (1.0, 0.158_655), (-2.0, 0.977_25)] {
                let count = map.0.iter().filter(|t| f64::from(t[sheet]) > above).count();
                let got = count as f64 / map.0.len() as f64;
                assert!((got - share).abs() < 1e-4, "sheet {sheet}: {got} above {above}");
            }
        }
    }

    #[test]
    fn quantiles_are_those_of_the_normal_spread() {
        for (p, z) in [(0.5, 0.0), (0.841_344_746, 1.0), (0.001_349_898, -3.0), (0.977_249_868, 2.0)] {
            assert!((normal_quantile(p) - z).abs() < 1e-6, "{p}: {}", normal_quantile(p));
        }
    }
}
