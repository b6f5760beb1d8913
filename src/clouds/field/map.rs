//! Map of where clouds grow. Its noises are sums of waves with given amplitudes (Fourier synthesis), and cells. The
//! noise at each texel is replaced by the normal quantile of its rank, so the share of the plane above a threshold is
//! known.
//!
//! # Model
//! k is the number of waves along the map's side, [`MAP_CELLS`] distances from cloud to cloud. The amplitudes of all
//! waves rise to the number [`BEND`] and fall as k^-(1 + H) beyond it, with H = 1/3 as in the inertial range of
//! turbulence (Kolmogorov 1941). Longer waves of their own, with H = [`LONG_HURST`], gather clouds into fields of every
//! size. Smooth tops and ragged outlines need two noises: the even noise has the waves below [`RAGGED_FROM`], from which
//! the height of a cloud follows, and the ragged noise those above it. The cells of the cellular noise are gathered by
//! waves with amplitudes k^-2.

use glam::{DVec2, UVec2};

use crate::{
    chance::{RandomStream, normal_quantile},
    fourier::{Complex, Transform},
    noise::cellular_2d,
};

/// Texels along a side of the map.
pub const MAP_SIZE: usize = 512;
/// Largest absolute number in the map.
pub const MAP_REACH: f64 = 4.0;
/// Number of clouds along the map's side, on average: the map's period in distances from cloud to cloud.
pub const MAP_CELLS: f64 = 16.0;
/// Ratio of the second sheet's period to the first's. The periods have no common multiple.
pub(crate) const SECOND_PERIOD: f64 = 1.618_033_988_749_895;
/// Mip levels by which the second sheet is read finer, because its waves are longer: log2 of [`SECOND_PERIOD`].
pub(crate) const SECOND_LEVEL: f64 = 0.694;
/// Angle by which the second sheet is turned, rad.
pub(crate) const SECOND_TURN_RAD: f64 = 0.9;
/// Offset of the second sheet, in periods.
pub(crate) const SECOND_OFFSET: DVec2 = DVec2::new(0.37, 0.71);

/// Number of waves along the map's side from which amplitudes fall.
const BEND: f64 = 8.0;
/// Amplitude of the long waves at [`BEND`], where the other waves have the amplitude 1/2.
const LONG_WAVES: f64 = 0.15;
/// Hurst exponent of the long waves: their amplitudes fall as the number of waves to the power -1.5.
const LONG_HURST: f64 = 0.5;
/// Number of waves at which the even noise has half of the amplitude and the ragged noise the other half.
const RAGGED_FROM: f64 = 9.0;
/// Hurst exponent of the ragged noise.
const RAGGED_HURST: f64 = 0.2;
/// Number of waves from which the ragged noise fades, so that its shortest waves span several texels.
const RAGGED_FADES: f64 = 192.0;
/// Ratio of the deviation of the waves that gather cells to the deviation of the cells.
const PATCHES: f64 = 0.8;
/// Number of waves from which the waves that gather cells have no amplitude.
const PATCHES_END: f64 = MAP_CELLS;
/// Ratio of an octave's amplitude to that of the previous octave in the cellular noise.
const PERSISTENCE: f64 = 0.4;
/// Number of octaves of the cellular noise.
const OCTAVES: u32 = 3;

/// Map of where clouds grow.
pub struct Map {
    /// Mip levels, the map itself first. A texel has two sheets of even noise, two of cellular noise, then two of ragged
    /// noise. Each texel is the mean of 2 x 2 texels of the next larger level.
    levels: Vec<Vec<[f32; 6]>>,
}

/// Returns the share of the waves' amplitude that the even noise has, at `k` waves along the map's side.
fn even_share(k: f64) -> f64 {
    let ratio = k / RAGGED_FROM;
    let square = ratio * ratio;
    1.0 / (1.0 + square * square)
}

/// Returns the amplitude of the even noise at `k` waves along the map's side, up to a factor.
fn even_amplitude(k: f64) -> f64 {
    let ratio = k / BEND;
    let waves = 1.0 / (1.0 / (ratio * ratio) + libm::pow(ratio, 4.0 / 3.0));
    let long = LONG_WAVES * libm::pow(ratio, -1.0 - LONG_HURST);
    (waves * waves + long * long).sqrt() * even_share(k)
}

/// Returns the amplitude of the ragged noise at `k` waves along the map's side, up to a factor.
fn ragged_amplitude(k: f64) -> f64 {
    let fades = k / RAGGED_FADES;
    libm::pow(k, -1.0 - RAGGED_HURST) * (1.0 - even_share(k)) / (1.0 + fades * fades)
}

/// Returns the amplitude of the waves that gather cells at `k` waves along the map's side, up to a factor.
fn patch_amplitude(k: f64) -> f64 {
    if k < PATCHES_END { 1.0 / (k * k) } else { 0.0 }
}

/// Returns two fields of noise, in the real and the imaginary parts: sums of all waves with the amplitude of their
/// number along the map's side and phases from `chance`.
fn waves(amplitude: fn(f64) -> f64, chance: &mut RandomStream) -> Vec<[Complex; MAP_SIZE]> {
    let mut square = vec![[Complex::ZERO; MAP_SIZE]; MAP_SIZE];
    let number = |i: usize| i.min(MAP_SIZE - i) as f64;
    for (y, row) in square.iter_mut().enumerate() {
        for (x, wave) in row.iter_mut().enumerate() {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * chance.unit());
            let k = (number(x) * number(x) + number(y) * number(y)).sqrt();
            if k > 0.0 {
                *wave = Complex::new(cos, sin).scaled(amplitude(k));
            }
        }
    }
    Transform::new().square(&mut square, MAP_SIZE);
    square
}

/// Returns the cells of a sheet at a place, in periods.
fn cells(sheet: u32, place: DVec2, seed: u32) -> f64 {
    let one = |octave: u32| {
        let period = UVec2::splat((MAP_CELLS as u32) << octave);
        let key = seed.wrapping_add(0x9e37_79b9u32.wrapping_mul(8 * sheet + octave + 1));
        PERSISTENCE.powi(octave as i32) * cellular_2d(place * period.as_dvec2(), period, key)
    };
    (0..OCTAVES).map(one).sum()
}

/// Scales values to mean 0 and deviation `deviation`.
fn scale(values: &mut [f64], deviation: f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / count;
    let factor = deviation / variance.sqrt();
    values.iter_mut().for_each(|v| *v = (*v - mean) * factor);
}

/// Returns the indices of the two texels around `x`, in periods of `size` texels, and the weight of the second.
pub(super) fn wrapped(x: f64, size: usize) -> (usize, usize, f64) {
    let x = (x * size as f64 - 0.5).rem_euclid(size as f64);
    let i = (x as usize).min(size - 1);
    (i, (i + 1) % size, x - i as f64)
}

impl Map {
    /// Returns the texels, east fastest: two sheets of even noise, two of cellular noise, then two of ragged noise.
    pub fn texels(&self) -> &[[f32; 6]] {
        &self.levels[0]
    }

    /// Returns the mip levels, the map itself first.
    pub(crate) fn levels(&self) -> &[Vec<[f32; 6]>] {
        &self.levels
    }

    /// Interpolates the texels at `place`, in periods, between the mip levels around `level`, which is at least 0.
    pub fn at(&self, place: DVec2, level: f64) -> [f64; 6] {
        let sharp = (level as usize).min(self.levels.len() - 1);
        let near = self.at_level(place, sharp);
        let part = level - sharp as f64;
        if part <= 0.0 || sharp + 1 == self.levels.len() {
            return near;
        }
        let far = self.at_level(place, sharp + 1);
        std::array::from_fn(|k| near[k] + (far[k] - near[k]) * part)
    }

    /// Interpolates the texels of a mip level at `place`, in periods.
    fn at_level(&self, place: DVec2, level: usize) -> [f64; 6] {
        let (size, texels) = (MAP_SIZE >> level, &self.levels[level]);
        let (i0, i1, x) = wrapped(place.x, size);
        let (j0, j1, y) = wrapped(place.y, size);
        let texel = |i: usize, j: usize| texels[j * size + i];
        let (a, b, c, d) = (texel(i0, j0), texel(i1, j0), texel(i0, j1), texel(i1, j1));
        std::array::from_fn(|k| {
            let low = f64::from(a[k]) * (1.0 - x) + f64::from(b[k]) * x;
            let high = f64::from(c[k]) * (1.0 - x) + f64::from(d[k]) * x;
            low * (1.0 - y) + high * y
        })
    }

    /// Creates the map of a seed.
    pub fn new(seed: u64) -> Self {
        let count = MAP_SIZE * MAP_SIZE;
        let quantile = |rank: usize| normal_quantile((rank as f64 + 0.5) / count as f64).clamp(-MAP_REACH, MAP_REACH);
        let quantiles: Vec<f32> = (0..count).map(|rank| quantile(rank) as f32).collect();
        let mut texels = vec![[0.0; 6]; count];
        for (kind, noise) in noises(seed).into_iter().enumerate() {
            for (sheet, values) in noise.into_iter().enumerate() {
                let mut ranked: Vec<(f64, usize)> = values.into_iter().zip(0..count).collect();
                ranked.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                for ((_, i), number) in ranked.into_iter().zip(&quantiles) {
                    texels[i][2 * kind + sheet] = *number;
                }
            }
        }
        Self { levels: mip_levels(texels) }
    }
}

/// Returns the mip levels of a map's texels.
fn mip_levels(texels: Vec<[f32; 6]>) -> Vec<Vec<[f32; 6]>> {
    let mut levels = vec![texels];
    let mut side = MAP_SIZE / 2;
    while side > 0 {
        let from = &levels[levels.len() - 1];
        let mean = |i: usize| {
            let first = 2 * (i / side) * (2 * side) + 2 * (i % side);
            std::array::from_fn(|k| {
                [0, 1, 2 * side, 2 * side + 1].map(|step| from[first + step][k]).iter().sum::<f32>() / 4.0
            })
        };
        let level = (0..side * side).map(mean).collect();
        levels.push(level);
        side /= 2;
    }
    levels
}

/// Returns the even, the cellular and the ragged noise of a seed, each in two sheets, before ranks replace it.
fn noises(seed: u64) -> [[Vec<f64>; 2]; 3] {
    let waves = |what: u64, amplitude: fn(f64) -> f64| {
        let square = waves(amplitude, &mut RandomStream::new(seed, what));
        let all = || square.iter().flatten();
        [all().map(|v| v.re).collect::<Vec<f64>>(), all().map(|v| v.im).collect()]
    };
    let folded = (seed ^ (seed >> 32)) as u32;
    let mut cellular = waves(1, patch_amplitude);
    for (sheet, gathered) in cellular.iter_mut().enumerate() {
        let at = |i: usize| DVec2::new((i % MAP_SIZE) as f64 + 0.5, (i / MAP_SIZE) as f64 + 0.5) / MAP_SIZE as f64;
        let mut values: Vec<f64> = (0..gathered.len()).map(|i| cells(sheet as u32 + 2, at(i), folded)).collect();
        scale(&mut values, 1.0);
        scale(gathered, PATCHES);
        gathered.iter_mut().zip(values).for_each(|(to, cell)| *to += cell);
    }
    [waves(0, even_amplitude), cellular, waves(2, ragged_amplitude)]
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
        for sheet in 0..6 {
            for (above, share) in [(0.0, 0.5), (1.0, 0.158_655), (-2.0, 0.977_25)] {
                let count = map.texels().iter().filter(|t| f64::from(t[sheet]) > above).count();
                let got = count as f64 / map.texels().len() as f64;
                assert!((got - share).abs() < 1e-4, "sheet {sheet}: {got} above {above}");
            }
        }
    }

    /// Returns the share of the variance of a noise that a mean over a width removes, by a law in
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
        // The second sheet's noise is larger, so a width is a smaller share of them.
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
        let map = Map::new(5);
        let levels = map.levels();
        // The waves that gather cells are too long to be removed.
        assert!(constants[0].contains("const CELLS_SHARE: f32 = 0.61;"));
        assert!((1.0 / (1.0 + PATCHES * PATCHES) - 0.61f64).abs() < 0.005);
        for (sheet, law, share) in [(0, "EVEN_BLUR", 1.0), (2, "CELLULAR_BLUR", 0.61), (4, "RAGGED_BLUR", 1.0)] {
            let kept: Vec<f64> =
                levels.iter().map(|t| variance(&t.iter().map(|t| f64::from(t[sheet])).collect::<Vec<_>>())).collect();
            for width in [0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0] {
                let texels = MAP_SIZE as f64 / MAP_CELLS;
                let want = 1.0 - mean(width, &|w: f64| between(&kept, (w * texels).log2())) / kept[0];
                held(law, [width, share * lost(width, law), want]);
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
