//! Short waves in square tiles that repeat, summed by Fourier transforms. The tiles are a fixed ladder: each is eight
//! times as long as the next shorter one, and turned against that one.
//!
//! A tile has waves of 4 to 45 periods in its length. Between 4 and 5.7 periods the energy passes to it from the next
//! longer tile. These wave numbers are fixed, so that a change of weather changes amplitudes and no phase. Heights
//! between the samples come from cubic B-splines. The transforms give the coefficients of the splines, not the heights,
//! so that each wave keeps its own amplitude. The error that is left is images of the shortest waves.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::{
    bins::{Bins, LOWEST_RAD_S, MAX_SYSTEMS, wrapped},
    dispersion::{angular_frequency, group_speed_m_s},
    fft::{Complex, SIDE, Transform},
    mode::SeaMode,
    turn::{fraction, sin_cos},
};
use crate::{
    chance::{RandomStream, mixed},
    numerics::smoothstep,
};

/// Tiles that hold energy at the same time, at most.
pub(super) const TILES: usize = 3;
/// Length of the finest tile, m, ratio of lengths, and number of tiles in the ladder.
const FINEST_M: f64 = 0.5;
const RATIO: f64 = 8.0;
const LADDER: usize = 7;
/// Periods in a tile's length between which the energy passes to it from the next longer one.
const TAKEOVER: [f64; 2] = [4.0, 5.656_854_249_492_38];
/// Fewest periods in a tile's length.
pub(super) const LEAST_PERIODS: f64 = TAKEOVER[0];
/// Most periods in a tile's length: eight times the end of [`TAKEOVER`].
const MOST_PERIODS: i32 = 45;
/// Turn of each tile against the next shorter one, rad: the golden angle.
const TURN: f64 = 2.399_963_229_728_653;
/// Values at each sample: height, displacement along the tile's two axes, then velocity and acceleration, each first
/// vertical and then along the two axes.
pub(super) const VALUES: usize = 9;

/// A pair of waves of a tile: the wave vector (x, y), in periods along a side, and its opposite.
#[derive(Clone, Copy, Debug)]
struct WavePair {
    x: i32,
    y: i32,
    /// Direction of the first wave, rad from east to north.
    direction: f64,
    /// Phases at time 0 of both waves, turns.
    phases: [f64; 2],
    /// Amplitudes of both waves, m.
    amplitudes_m: [f64; 2],
}

/// Properties of all waves of one length. Rings are indexed by x^2 + y^2.
#[derive(Clone, Copy, Debug, Default)]
struct WaveRing {
    k_per_m: f64,
    frequency_hz: f64,
    /// Ratio of horizontal to vertical amplitude: coth(k h).
    stretch: f64,
    /// Variance of each system per unit area of wave vectors, before the spreading over directions, m^4, and the
    /// parameter of the spreading.
    densities: [f64; MAX_SYSTEMS],
    betas: [f64; MAX_SYSTEMS],
}

/// Waves of a tile of the ladder, for one spectrum.
#[derive(Clone, Debug)]
pub(super) struct WaveTile {
    level: usize,
    pub length_m: f64,
    /// Cosine and sine of the tile's turn.
    pub turn: DVec2,
    modes: Vec<WavePair>,
    rings: Vec<WaveRing>,
    /// Variance of heights, m^2, and mean square slope.
    pub variance_m2: f64,
    pub mean_square_slope: f64,
    /// Sums over the waves of k coth(k h) times variance times cos^2, sin^2 and cos sin of the direction, m. The first
    /// two add up to the fall of the mean level by horizontal motion.
    pub narrowing_m: [f64; 3],
    /// Variance of the compression of the surface.
    pub compression: f64,
    /// Variance of the images that the splines leave of the shortest waves, m^2.
    pub image_m2: f64,
    /// Length of the shortest wave, m.
    pub shortest_m: f64,
}

/// Returns the length of a tile of the ladder, m.
fn length_m(level: usize) -> f64 {
    (0..level).fold(FINEST_M, |length, _| length * RATIO)
}

/// Returns the ratio of the variance of a wave's images to that of the wave: the spline lets the images through as ((n
/// / (N - n))^4)^2, with n = `periods` along a side and N = [`SIDE`].
fn image_share(periods: i32) -> f64 {
    let n = f64::from(periods.abs());
    let ratio = n / (SIDE as f64 - n);
    let fourth = ratio * ratio * ratio * ratio;
    fourth * fourth
}

/// Returns the share that one tile of the ladder holds of the energy of all tiles at a wave number.
fn ladder_share(level: usize, k_per_m: f64) -> f64 {
    let log = libm::log(k_per_m * length_m(level) / TAU);
    let [low, high] = TAKEOVER.map(libm::log);
    let ratio = libm::log(RATIO);
    let over = if level + 1 == LADDER { 1.0 } else { smoothstep(low, high, log) };
    let under = if level == 0 { 0.0 } else { smoothstep(low + ratio, high + ratio, log) };
    over - under
}

impl WaveTile {
    /// Creates a tile without energy.
    fn new(level: usize, seed: u64, depth_m: f64) -> Self {
        let angle = TURN * level as f64;
        let (sin, cos) = libm::sincos(angle);
        let length_m = length_m(level);
        let mut modes = Vec::new();
        for y in 0..=MOST_PERIODS {
            for x in -MOST_PERIODS..=MOST_PERIODS {
                let square = x * x + y * y;
                // Of each vector and its opposite, one is listed. Waves of fewer than 4 periods have energy only in the
                // longest tile of the ladder.
                if (y == 0 && x <= 0) || square > MOST_PERIODS * MOST_PERIODS {
                    continue;
                }
                let place = (level as u64) << 32 | ((x + 256) as u64) << 16 | y as u64;
                let mut chance = RandomStream::new(seed, mixed(place ^ 0x7469_6c65_0000_0000));
                let direction = libm::atan2(f64::from(y), f64::from(x)) + angle;
                modes.push(WavePair {
                    x,
                    y,
                    direction,
                    phases: [chance.even(), chance.even()],
                    amplitudes_m: [0.0; 2],
                });
            }
        }
        let ring = |square: i32| {
            let k = TAU / length_m * f64::from(square.max(1)).sqrt();
            let w = angular_frequency(k, depth_m);
            WaveRing {
                k_per_m: k,
                frequency_hz: w / TAU,
                stretch: 1.0 / libm::tanh(k * depth_m),
                ..WaveRing::default()
            }
        };
        Self {
            level,
            length_m,
            turn: DVec2::new(cos, sin),
            modes,
            rings: (0..=MOST_PERIODS * MOST_PERIODS).map(ring).collect(),
            variance_m2: 0.0,
            mean_square_slope: 0.0,
            narrowing_m: [0.0; 3],
            compression: 0.0,
            image_m2: 0.0,
            shortest_m: length_m / f64::from(MOST_PERIODS),
        }
    }

    /// Gives the waves the energies of a spectrum.
    fn fill(&mut self, bins: &Bins, depth_m: f64) {
        let (tiles, k_per_m) = (&bins.tiles_m2, &bins.k_per_m);
        let of_bin = |b: usize| tiles[b].iter().sum::<f64>() * ladder_share(self.level, k_per_m[b]);
        let asked: f64 = (0..tiles.len()).map(of_bin).sum();
        self.fill_rings(bins, depth_m);
        let cell = (TAU / self.length_m) * (TAU / self.length_m);
        let mut sum = 0.0;
        for mode in &mut self.modes {
            let ring = &self.rings[(mode.x * mode.x + mode.y * mode.y) as usize];
            for (amplitude, direction) in mode.amplitudes_m.iter_mut().zip([mode.direction, mode.direction + PI]) {
                let of = |s: usize| {
                    let density = ring.densities[s];
                    if density > 0.0 { density * bins.headings[s].density(direction, ring.betas[s]) } else { 0.0 }
                };
                let variance = cell * (0..bins.systems.len()).map(of).sum::<f64>();
                sum += variance;
                *amplitude = (2.0 * variance).sqrt();
            }
        }
        // The tile holds exactly the energy of its bins.
        let factor = if sum > 0.0 { (asked / sum).sqrt() } else { 0.0 };
        (self.variance_m2, self.mean_square_slope, self.narrowing_m) = (0.0, 0.0, [0.0; 3]);
        (self.compression, self.image_m2) = (0.0, 0.0);
        for mode in &mut self.modes {
            let ring = &self.rings[(mode.x * mode.x + mode.y * mode.y) as usize];
            for amplitude in &mut mode.amplitudes_m {
                *amplitude *= factor;
                let variance = 0.5 * *amplitude * *amplitude;
                let steep = ring.k_per_m * ring.stretch;
                self.variance_m2 += variance;
                self.mean_square_slope += ring.k_per_m * ring.k_per_m * variance;
                let along = DVec2::new(libm::cos(mode.direction), libm::sin(mode.direction));
                let parts = [along.x * along.x, along.y * along.y, along.x * along.y];
                self.narrowing_m.iter_mut().zip(parts).for_each(|(sum, part)| *sum += steep * variance * part);
                self.compression += steep * steep * variance;
                self.image_m2 += variance * (image_share(mode.x) + image_share(mode.y));
            }
        }
    }

    /// Returns all waves.
    pub fn modes(&self) -> impl Iterator<Item = SeaMode> + '_ {
        self.modes.iter().flat_map(|mode| {
            let k_per_m = self.rings[(mode.x * mode.x + mode.y * mode.y) as usize].k_per_m;
            [0, 1].map(|i| SeaMode {
                k_per_m,
                direction: wrapped(mode.direction + i as f64 * PI),
                variance_m2: 0.5 * mode.amplitudes_m[i] * mode.amplitudes_m[i],
            })
        })
    }

    /// Multiplies the variance of all waves by a factor.
    pub fn strengthen(&mut self, factor: f64) {
        let root = factor.sqrt();
        self.modes.iter_mut().flat_map(|mode| &mut mode.amplitudes_m).for_each(|amplitude| *amplitude *= root);
        for sum in [&mut self.variance_m2, &mut self.mean_square_slope, &mut self.compression, &mut self.image_m2] {
            *sum *= factor;
        }
        self.narrowing_m.iter_mut().for_each(|sum| *sum *= factor);
    }

    fn fill_rings(&mut self, bins: &Bins, depth_m: f64) {
        let level = self.level;
        for ring in &mut self.rings {
            let w = TAU * ring.frequency_hz;
            ring.densities = [0.0; MAX_SYSTEMS];
            let (tiled, kept) = bins.shares(w, ring.k_per_m);
            let share = tiled * kept * ladder_share(level, ring.k_per_m);
            if share <= 0.0 || w < LOWEST_RAD_S {
                continue;
            }
            // Turns a density over frequency into one over wave vectors: dw/dk over k, since an element of their area
            // is k dk dtheta.
            let into = share * group_speed_m_s(ring.k_per_m, depth_m) / ring.k_per_m;
            for (s, system) in bins.systems.iter().enumerate() {
                ring.densities[s] = into * bins.density(s, w, ring.k_per_m);
                ring.betas[s] = system.beta(w);
            }
        }
    }

    /// Sums the waves at a time into B-spline coefficients of [`VALUES`] fields at [`SIDE`]^2 samples.
    pub fn sum(&self, time_s: f64, work: &mut TileWork, fields: &mut [[f64; VALUES]]) {
        work.clear();
        for mode in &self.modes {
            if mode.amplitudes_m != [0.0; 2] {
                let ring = &self.rings[(mode.x * mode.x + mode.y * mode.y) as usize];
                work.add(mode, ring, time_s);
            }
        }
        let TileWork { transform, squares, .. } = work;
        squares.iter_mut().for_each(|square| transform.square(square, MOST_PERIODS as usize));
        // All fields of a sample in turn, since they lie side by side.
        for (y, row) in fields.chunks_exact_mut(SIDE).enumerate() {
            for (x, texel) in row.iter_mut().enumerate() {
                for (pair, square) in texel.chunks_mut(2).zip(&work.squares) {
                    let sample = square[y][x];
                    pair.iter_mut().zip([sample.re, sample.im]).for_each(|(value, part)| *value = part);
                }
            }
        }
    }

    /// Returns the fields at a place, summed wave by wave: the exact values for tests of transforms and splines.
    #[cfg(test)]
    pub fn direct(&self, place_m: DVec2, time_s: f64) -> [f64; VALUES] {
        let mut out = [0.0; VALUES];
        for mode in &self.modes {
            let ring = &self.rings[(mode.x * mode.x + mode.y * mode.y) as usize];
            for (i, sign) in [1.0, -1.0].into_iter().enumerate() {
                let k = sign * DVec2::new(f64::from(mode.x), f64::from(mode.y)) / self.length_m;
                let (sin, cos) = sin_cos(k.dot(place_m) - ring.frequency_hz * time_s + mode.phases[i]);
                let (a, along) = (mode.amplitudes_m[i], k.normalize() * ring.stretch);
                let w = TAU * ring.frequency_hz;
                let d = [-along.x * a * sin, -along.y * a * sin];
                let v = [a * w * sin, along.x * a * w * cos, along.y * a * w * cos];
                let acc = [-a * w * w * cos, along.x * a * w * w * sin, along.y * a * w * w * sin];
                let all = [a * cos, d[0], d[1], v[0], v[1], v[2], acc[0], acc[1], acc[2]];
                out.iter_mut().zip(all).for_each(|(o, v)| *o += v);
            }
        }
        out
    }
}

/// Scratch space for the transforms of one tile.
#[derive(Clone, Debug)]
pub(super) struct TileWork {
    transform: Transform,
    /// Pairs of real fields as real and imaginary parts.
    squares: [Vec<[Complex; SIDE]>; VALUES.div_ceil(2)],
    /// Factors, indexed by the periods along one side: 1 / sinc^4, so that the B-spline gives back a wave's own
    /// amplitude.
    sharpening: Vec<f64>,
}

impl TileWork {
    pub fn new() -> Self {
        let sharpen = |n: i32| {
            let x = PI * f64::from(n) / SIDE as f64;
            let sinc = if n == 0 { 1.0 } else { libm::sin(x) / x };
            1.0 / (sinc * sinc * sinc * sinc)
        };
        Self {
            transform: Transform::new(),
            squares: std::array::from_fn(|_| vec![[Complex::ZERO; SIDE]; SIDE]),
            sharpening: (0..=MOST_PERIODS).map(sharpen).collect(),
        }
    }

    fn clear(&mut self) {
        self.squares.iter_mut().for_each(|square| square.fill([Complex::ZERO; SIDE]));
    }

    /// Adds a pair of waves to the transforms of all fields at a time.
    fn add(&mut self, mode: &WavePair, ring: &WaveRing, time_s: f64) {
        let turns = fraction(ring.frequency_hz * time_s);
        let factor = self.sharpening[mode.x.unsigned_abs() as usize] * self.sharpening[mode.y.unsigned_abs() as usize];
        let wave = |i: usize| {
            let (sin, cos) = sin_cos(mode.phases[i] - turns);
            Complex::new(cos, sin).scaled(0.5 * factor * mode.amplitudes_m[i])
        };
        // The wave along +k, and the conjugate of that along -k, both at the vector +k of the transform.
        let (c, d) = (wave(0), wave(1).conjugate());
        let (sum, difference) = (c.plus(d), c.minus(d));
        let w = TAU * ring.frequency_hz;
        let length = f64::from(mode.x * mode.x + mode.y * mode.y).sqrt();
        let along = [f64::from(mode.x) / length * ring.stretch, f64::from(mode.y) / length * ring.stretch];
        let height = sum;
        let shift = along.map(|u| sum.turned().scaled(u));
        let rise = difference.turned().scaled(-w);
        let flow = along.map(|u| difference.scaled(u * w));
        let lift = sum.scaled(-w * w);
        let push = along.map(|u| sum.turned().scaled(-u * w * w));
        let fields = [height, shift[0], shift[1], rise, flow[0], flow[1], lift, push[0], push[1]];
        let index = |n: i32| n.rem_euclid(SIDE as i32) as usize;
        for (i, square) in self.squares.iter_mut().enumerate() {
            let (a, b) = (fields[2 * i], fields.get(2 * i + 1).copied().unwrap_or(Complex::ZERO));
            let (at_x, at_y) = (index(mode.x), index(mode.y));
            let here = &mut square[at_y][at_x];
            *here = here.plus(a).plus(b.turned());
            let there = &mut square[index(-mode.y)][index(-mode.x)];
            *there = there.plus(a.conjugate()).plus(b.conjugate().turned());
        }
    }
}

/// The tiles that hold the energy of a spectrum.
#[derive(Clone, Debug)]
pub(super) struct WaveTiles {
    seed: u64,
    depth_m: f64,
    /// Tiles of three neighbouring levels, indexed by the level modulo 3.
    pub tiles: Vec<WaveTile>,
}

impl WaveTiles {
    pub fn new(seed: u64, depth_m: f64) -> Self {
        let tiles = (0..TILES).map(|level| WaveTile::new(level, seed, depth_m)).collect();
        Self { seed, depth_m, tiles }
    }

    /// Gives the tiles the energy of a spectrum.
    pub fn fill(&mut self, bins: &Bins) {
        // The longest tile that holds energy follows from the longest wave in tiles that has energy.
        let tiled = |b: &usize| bins.tiles_m2[*b].iter().sum::<f64>() > 0.0;
        let longest_per_m = (0..bins.tiles_m2.len()).find(tiled).map_or(1e9, |b| bins.k_per_m[b]);
        let holds = |level: &usize| ladder_share(*level, longest_per_m) > 0.0;
        let longest = (0..LADDER).rev().find(holds).unwrap_or(0).max(TILES - 1);
        for level in longest + 1 - TILES..=longest {
            let tile = &mut self.tiles[level % TILES];
            if tile.level != level {
                *tile = WaveTile::new(level, self.seed, self.depth_m);
            }
            tile.fill(bins, self.depth_m);
        }
    }
}

/// Values of the B-spline fields at a place, and derivatives along the tile's sides, per metre.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sampled {
    pub values: [f64; VALUES],
    /// Derivatives along x and y of height and displacement.
    pub along_x: [f64; 3],
    pub along_y: [f64; 3],
}

/// Returns the weights of a cubic B-spline for four samples, and the derivatives of the weights. The place lies between
/// the middle two samples, at `t` in \[0, 1) from the second.
fn spline(t: f64) -> ([f64; 4], [f64; 4]) {
    let (t2, u) = (t * t, 1.0 - t);
    let t3 = t2 * t;
    let weights =
        [u * u * u / 6.0, (3.0 * t3 - 6.0 * t2 + 4.0) / 6.0, (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0) / 6.0, t3 / 6.0];
    let slopes = [-0.5 * u * u, 1.5 * t2 - 2.0 * t, -1.5 * t2 + t + 0.5, 0.5 * t2];
    (weights, slopes)
}

/// Returns the first `N` fields of a tile, at least 3, and the derivatives of the first three, at a place in the tile's
/// axes, m.
#[inline]
pub(super) fn sample<const N: usize>(fields: &[[f64; VALUES]], length_m: f64, place_m: DVec2) -> Sampled {
    let per_m = SIDE as f64 / length_m;
    let at = |v: f64| {
        let turns = v / length_m;
        let texels = SIDE as f64 * (turns - turns.floor());
        let whole = texels.floor();
        (whole as usize, texels - whole)
    };
    let ((x, tx), (y, ty)) = (at(place_m.x), at(place_m.y));
    let ((wx, sx), (wy, sy)) = (spline(tx), spline(ty));
    let mut out = Sampled::default();
    for j in 0..4 {
        let row = ((y + j + SIDE - 1) % SIDE) * SIDE;
        let (mut value, mut slope) = ([0.0; N], [0.0; 3]);
        for i in 0..4 {
            let texel = &fields[row + (x + i + SIDE - 1) % SIDE];
            value.iter_mut().zip(texel).for_each(|(sum, v)| *sum += wx[i] * v);
            slope.iter_mut().zip(texel).for_each(|(sum, v)| *sum += sx[i] * v);
        }
        out.values.iter_mut().zip(value).for_each(|(sum, v)| *sum += wy[j] * v);
        for n in 0..3 {
            out.along_x[n] += per_m * wy[j] * slope[n];
            out.along_y[n] += per_m * sy[j] * value[n];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::bins::{Spreading, WaveSystem};
    use super::*;

    fn filled(hs: f64, tp: f64, depth_m: f64) -> (Bins, WaveTiles) {
        let system = WaveSystem {
            m0_m2: hs * hs / 16.0,
            peak_rad_s: TAU / tp,
            gamma: 3.3,
            toward: DVec2::new(0.6, 0.8),
            spreading: Spreading::WindSea,
            deep_share: 0.0,
            is_shaped: true,
        };
        let mut bins = Bins::new(depth_m);
        bins.fill(&[system], f64::INFINITY);
        let mut tiles = WaveTiles::new(9, depth_m);
        tiles.fill(&bins);
        (bins, tiles)
    }

    #[test]
    fn three_tiles_hold_the_energy_of_every_sea() {
        for (hs, tp, depth) in
            [(0.05, 1.1, 4000.0), (0.2, 1.8, 4000.0), (2.1, 6.2, 4000.0), (9.0, 11.0, 60.0), (9.0, 19.6, 4000.0)]
        {
            let (bins, tiles) = filled(hs, tp, depth);
            let asked: f64 = bins.tiles_m2.iter().flatten().sum();
            let held: f64 = tiles.tiles.iter().map(|t| t.variance_m2).sum();
            assert!((held / asked - 1.0).abs() < 1e-9, "{hs} {tp}: {held} {asked}");
            let slope = |b: usize| bins.k_per_m[b].powi(2) * bins.tiles_m2[b].iter().sum::<f64>();
            let wanted: f64 = (0..bins.k_per_m.len()).map(slope).sum();
            let drawn: f64 = tiles.tiles.iter().map(|t| t.mean_square_slope).sum();
            assert!((drawn / wanted - 1.0).abs() < 0.02, "{hs} {tp}: slopes {drawn} {wanted}");
        }
    }

    #[test]
    fn transforms_and_splines_give_the_sum_of_the_waves() {
        let (_, tiles) = filled(2.1, 6.2, 4000.0);
        let mut work = TileWork::new();
        let mut fields = vec![[0.0; VALUES]; SIDE * SIDE];
        for tile in &tiles.tiles {
            let time = 1e5 + 0.37;
            tile.sum(time, &mut work, &mut fields);
            let mut off = [0.0f64; VALUES];
            let mut whole = [0.0f64; VALUES];
            for i in 0..40 {
                let place = DVec2::new(0.618_03 * f64::from(i), 1.3 * f64::from(i * i)) * tile.length_m * 0.37;
                let (found, truth) = (sample::<VALUES>(&fields, tile.length_m, place), tile.direct(place, time));
                for n in 0..VALUES {
                    off[n] += (found.values[n] - truth[n]).powi(2);
                    whole[n] += truth[n].powi(2);
                }
            }
            let rms = (off[0] / 40.0).sqrt();
            println!(
                "{} m: rms error of heights {:.3} mm, said {:.3}",
                tile.length_m,
                1e3 * rms,
                1e3 * tile.image_m2.sqrt()
            );
            assert!(rms <= 1.4 * tile.image_m2.sqrt() && tile.image_m2.sqrt() < 1e-3, "{} m: {rms}", tile.length_m);
            for n in 0..VALUES {
                let share = (off[n] / whole[n].max(1e-30)).sqrt();
                assert!(share < 0.1, "{} m, field {n}: {share}", tile.length_m);
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_spline() {
        let (_, tiles) = filled(2.1, 6.2, 4000.0);
        let tile = tiles.tiles.iter().max_by(|a, b| a.variance_m2.total_cmp(&b.variance_m2)).expect("some");
        let mut fields = vec![[0.0; VALUES]; SIDE * SIDE];
        tile.sum(3.0, &mut TileWork::new(), &mut fields);
        let h = 1e-5 * tile.length_m;
        for i in 0..20 {
            let place = DVec2::new(1.37 * f64::from(i), -2.11 * f64::from(i));
            let at = |d: DVec2| sample::<3>(&fields, tile.length_m, place + d).values;
            let found = sample::<3>(&fields, tile.length_m, place);
            for n in 0..3 {
                let x = (at(DVec2::X * h)[n] - at(-DVec2::X * h)[n]) / (2.0 * h);
                let y = (at(DVec2::Y * h)[n] - at(-DVec2::Y * h)[n]) / (2.0 * h);
                assert!((found.along_x[n] - x).abs() < 1e-5 && (found.along_y[n] - y).abs() < 1e-5, "{n}");
            }
        }
    }
}
