//! The map of where clouds grow: noise made normal by ranks, so that a threshold says how much of the plane lies above it.

use glam::{DVec2, UVec2};

use super::field::{MAP_CELLS, MAP_REACH, MAP_SIZE, Map};
use crate::noise::{cellular_2d, gradient_2d};

/// Octaves of the even sheets: the first has half as many cells as the map, so that clouds stand in groups.
const EVEN_OCTAVES: u32 = 4;
/// Amplitude of an octave over that of the one before, of the even and of the cellular sheets.
const PERSISTENCE: [f64; 2] = [0.55, 0.4];
const CELLULAR_OCTAVES: u32 = 3;

/// The number below which the share `p` of a normal spread lies, within 1e-8 (Acklam 2003, an algorithm for the inverse normal cumulative
/// distribution function).
pub fn normal_quantile(p: f64) -> f64 {
    const A: [f64; 6] = [
        -3.969_683_028_665_376e1,
        2.209_460_984_245_205e2,
        -2.759_285_104_469_687e2,
        1.383_577_518_672_69e2,
        -3.066_479_806_614_716e1,
        2.506_628_277_459_239,
    ];
    const B: [f64; 5] = [
        -5.447_609_879_822_406e1,
        1.615_858_368_580_409e2,
        -1.556_989_798_598_866e2,
        6.680_131_188_771_972e1,
        -1.328_068_155_288_572e1,
    ];
    const C: [f64; 6] = [
        -7.784_894_002_430_293e-3,
        -3.223_964_580_411_365e-1,
        -2.400_758_277_161_838,
        -2.549_732_539_343_734,
        4.374_664_141_464_968,
        2.938_163_982_698_783,
    ];
    const D: [f64; 4] =
        [7.784_695_709_041_462e-3, 3.224_671_290_700_398e-1, 2.445_134_137_142_996, 3.754_408_661_907_416];
    let sum = |terms: &[f64], x: f64| terms.iter().fold(0.0, |sum, c| sum * x + c);
    if p > 1.0 - 0.024_25 {
        return -normal_quantile(1.0 - p);
    }
    if p < 0.024_25 {
        let q = (-2.0 * libm::log(p.max(1e-300))).sqrt();
        return sum(&C, q) / (sum(&D, q) * q + 1.0);
    }
    let q = p - 0.5;
    sum(&A, q * q) * q / (sum(&B, q * q) * q * q + 1.0)
}

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
