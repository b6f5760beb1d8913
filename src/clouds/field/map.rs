//! Map of where clouds grow. The noise at each texel is replaced by the normal quantile of its rank, so the share of
//! the plane above a threshold is known.

use glam::{DVec2, UVec2};

use crate::{
    chance::normal_quantile,
    noise::{cellular_2d, gradient_2d},
};

/// Texels along a side of the map.
pub const MAP_SIZE: usize = 256;
/// Largest absolute number in the map.
pub const MAP_REACH: f64 = 4.0;
/// Number of clouds along the map's side, on average: the map's period in distances from cloud to cloud.
pub const MAP_CELLS: f64 = 16.0;
/// Ratio of the second sheet's period to the first's. The periods have no common multiple.
pub(crate) const SECOND_PERIOD: f64 = 1.618_033_988_749_895;
/// Angle by which the second sheet is turned, rad.
pub(crate) const SECOND_TURN_RAD: f64 = 0.9;
/// Offset of the second sheet, in periods.
pub(crate) const SECOND_OFFSET: DVec2 = DVec2::new(0.37, 0.71);
/// Number of octaves of the sheets of gradient noise. The first octave has half as many cells along a side as the map
/// has clouds, so that clouds stand in groups.
const EVEN_OCTAVES: u32 = 4;
/// Ratio of an octave's amplitude to that of the previous octave: in the sheets of gradient noise, and in those of
/// cellular noise.
const PERSISTENCE: [f64; 2] = [0.55, 0.4];
/// Number of octaves of the cellular sheets.
const CELLULAR_OCTAVES: u32 = 3;

/// Texels of the map: two sheets of gradient noise, then two of cellular noise.
pub struct Map(pub Vec<[f32; 4]>);

/// Returns the noise of a sheet, before ranks replace it. `place` is in periods.
fn raw(sheet: u32, place: DVec2, seed: u32) -> f64 {
    let cells = MAP_CELLS as u32;
    let octaves = |count: u32, first: u32, persistence: f64, noise: &dyn Fn(DVec2, UVec2, u32) -> f64| {
        let one = |octave: u32| {
            let period = UVec2::splat(first << octave);
            let key = seed.wrapping_add(0x9e37_79b9u32.wrapping_mul(8 * sheet + octave + 1));
            persistence.powi(octave as i32) * noise(place * period.as_dvec2(), period, key)
        };
        (0..count).map(one).sum::<f64>()
    };
    if sheet < 2 {
        octaves(EVEN_OCTAVES, cells / 2, PERSISTENCE[0], &gradient_2d)
    } else {
        octaves(CELLULAR_OCTAVES, cells, PERSISTENCE[1], &cellular_2d)
    }
}

/// Returns the indices of the two texels around `x`, in periods of `size` texels, and the weight of the second.
pub(super) fn wrapped(x: f64, size: usize) -> (usize, usize, f64) {
    let x = (x * size as f64 - 0.5).rem_euclid(size as f64);
    let i = (x as usize).min(size - 1);
    (i, (i + 1) % size, x - i as f64)
}

impl Map {
    /// Interpolates the texels at `place`, in periods.
    pub fn at(&self, place: DVec2) -> [f64; 4] {
        let (i0, i1, x) = wrapped(place.x, MAP_SIZE);
        let (j0, j1, y) = wrapped(place.y, MAP_SIZE);
        let texel = |i: usize, j: usize| self.0[j * MAP_SIZE + i];
        let (a, b, c, d) = (texel(i0, j0), texel(i1, j0), texel(i0, j1), texel(i1, j1));
        [0, 1, 2, 3].map(|k| {
            let low = f64::from(a[k]) * (1.0 - x) + f64::from(b[k]) * x;
            let high = f64::from(c[k]) * (1.0 - x) + f64::from(d[k]) * x;
            low * (1.0 - y) + high * y
        })
    }

    /// Creates the map of a seed.
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

    /// Returns the map's mip levels, the map itself first. Each texel is the mean of 2 x 2 texels of the next larger
    /// level.
    pub(crate) fn levels(&self) -> Vec<Vec<[f32; 4]>> {
        let mut levels = vec![self.0.clone()];
        let mut side = MAP_SIZE / 2;
        while side > 0 {
            let from = &levels[levels.len() - 1];
            let mean = |i: usize| {
                let first = 2 * (i / side) * (2 * side) + 2 * (i % side);
                [0, 1, 2, 3]
                    .map(|k| [0, 1, 2 * side, 2 * side + 1].map(|to| from[first + to][k]).iter().sum::<f32>() / 4.0)
            };
            let level = (0..side * side).map(mean).collect();
            levels.push(level);
            side /= 2;
        }
        levels
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        clouds::field::{
            layers::{BLUR_FROM, PIXEL_BLUR},
            solid::{SOLID_SIZE, solid_settings},
        },
        noise::NoiseImage,
    };

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

    /// Returns the share of the variance of a layer's number that a mean over a width removes, by the law in
    /// shaders/clouds/field.wgsl.
    fn lost(width: f64, law: &str) -> f64 {
        let text = include_str!("../../../shaders/clouds/field.wgsl");
        let (_, after) = text.split_once(&format!("const {law}: vec2f = vec2f(")).unwrap();
        let (numbers, _) = after.split_once(')').unwrap();
        let [over, power]: [f64; 2] =
            numbers.split(", ").map(|n| n.parse().unwrap()).collect::<Vec<_>>().try_into().unwrap();
        1.0 - (-(width / over).powf(power)).exp()
    }

    #[test]
    fn coarse_looks_lose_as_much_variance_as_the_map_and_the_noise_do() {
        let constants =
            [include_str!("../../../shaders/clouds/field.wgsl"), include_str!("../../../shaders/clouds/march.wgsl")];
        for (text, said) in constants
            .into_iter()
            .zip([format!("const BLUR_FROM: f32 = {BLUR_FROM:?};"), format!("const PIXEL_BLUR: f32 = {PIXEL_BLUR:?};")])
        {
            assert!(text.contains(&said), "{said}");
        }
        // The second sheet's cells are larger, so a width is a smaller share of them.
        let mean = |width: f64, of: &dyn Fn(f64) -> f64| 0.5 * (of(width) + of(width / SECOND_PERIOD));
        let variance = |level: &[f64]| {
            let mean = level.iter().sum::<f64>() / level.len() as f64;
            level.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / level.len() as f64
        };
        let held = |law: &str, [width, got, want]: [f64; 3]| {
            println!("{law} over {width}: {got:.3} of the variance lost, {want:.3} in truth");
            assert!((got - want).abs() < 0.07, "{law} over {width}: {got}, {want}");
        };
        let between = |levels: &[f64], at: f64| {
            let i = (at.max(0.0) as usize).min(levels.len() - 2);
            levels[i] + (levels[i + 1] - levels[i]) * (at.max(0.0) - i as f64)
        };
        let levels = Map::new(5).levels();
        for (sheet, law) in [(0, "EVEN_BLUR"), (2, "CELLULAR_BLUR")] {
            let kept: Vec<f64> =
                levels.iter().map(|t| variance(&t.iter().map(|t| f64::from(t[sheet])).collect::<Vec<_>>())).collect();
            for width in [0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0] {
                let texels = MAP_SIZE as f64 / MAP_CELLS;
                let want = 1.0 - mean(width, &|w: f64| between(&kept, (w * texels).log2())) / kept[0];
                held(law, [width, lost(width, law), want]);
            }
        }
        let image = NoiseImage::generate([SOLID_SIZE; 3], &solid_settings(5)).unwrap();
        let of_bytes = |level: &Vec<u8>| variance(&level.iter().map(|b| f64::from(*b) / 255.0).collect::<Vec<_>>());
        let whole = of_bytes(&image.levels()[0]);
        for (level, bytes) in image.levels().iter().enumerate().take(5) {
            let width = f64::from(1 << level) / f64::from(SOLID_SIZE);
            held("SOLID_BLUR", [width, lost(width, "SOLID_BLUR"), 1.0 - of_bytes(bytes) / whole]);
        }
        assert!(constants[0].contains("const SOLID_DEVIATION: f32 = 0.107;"));
        assert!((whole.sqrt() - 0.107).abs() < 0.003, "{}", whole.sqrt());
    }

    #[test]
    fn quantiles_are_those_of_the_normal_spread() {
        for (p, z) in [(0.5, 0.0), (0.841_344_746, 1.0), (0.001_349_898, -3.0), (0.977_249_868, 2.0)] {
            assert!((normal_quantile(p) - z).abs() < 1e-6, "{p}: {}", normal_quantile(p));
        }
    }
}
