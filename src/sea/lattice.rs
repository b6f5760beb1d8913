//! Single waves on a fixed lattice of frequencies and directions.
//!
//! The lattice is a tree of cells. Its roots are half octaves of frequency over the whole circle of directions. Cells
//! are halved again and again in direction and frequency. Each cell has one wave, whose frequency, direction and phase
//! follow from the seed and the cell alone. The spectrum decides only which cells hold energy, so a change of weather
//! changes amplitudes and never a phase. Cells are jittered, so the sum never repeats.
//!
//! A cell hands its energy to its halves. The share of a half's energy that is handed down depends on the half's
//! measure, a weighted sum of its energy and its slope. The share rises smoothly from 0 at 0.94 of a threshold to 1 at
//! the threshold. The energy that a weak half does not take goes to the other half if that half is strong enough.
//! Otherwise the energy stays with the cell's own wave. So every sea has about the same number of waves, all about
//! equally strong. Every amplitude is a continuous function of the spectrum, and the energy of each half octave is kept
//! exactly.

use std::f64::consts::TAU;

use glam::DVec2;

use super::{
    bins::{BINS, BINS_PER_OCTAVE, Bins, MAX_SYSTEMS, bin_rad_s},
    dispersion::wave_number,
};
use crate::{
    chance::{RandomStream, mixed},
    numerics::smoothstep,
};

/// Bins of a half octave.
const ROOT_BINS: usize = BINS_PER_OCTAVE / 2;
/// Number of directions into which the finest cells divide the circle.
const DIRECTIONS: usize = 512;
/// Depth in the tree from which on cells are halved in frequency too.
const FIRST_FREQUENCY_HALVING: usize = 3;
/// Threshold of a cell's measure, as a share of the measure of all waves. It gives some 280 waves. Their sum repeats as
/// little as that of 240 equal waves: heights some kilometres apart then correlate by 0.2 to 0.26 at the worst of many
/// shifts.
const THRESHOLD: f64 = 1.0 / 390.0;
/// Share of the threshold from which a cell begins to take energy.
const BEGIN: f64 = 0.94;
/// Weight of energy in a cell's measure. The rest is the weight of slope, so that short waves are not too few.
const ENERGY_SHARE: f64 = 0.93;

/// Power by which the energy per octave falls over frequency above the peak (JONSWAP's tail).
const TAIL_POWER: f64 = 4.0;

/// One wave.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SeaWave {
    /// Amplitude of its height, m.
    pub amplitude_m: f64,
    /// Unit vector in which it travels, east and north.
    pub toward: DVec2,
    /// Wave number in turns per metre.
    pub turns_per_m: f64,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Phase at time and place 0, turns.
    pub phase: f64,
    /// Ratio of horizontal to vertical amplitude: coth(k h).
    pub stretch: f64,
}

/// A cell of the tree.
#[derive(Clone, Copy)]
struct LatticeCell {
    bin: usize,
    bins: usize,
    direction: usize,
    directions: usize,
    depth: usize,
}

/// Energy of a cell, and its measure.
#[derive(Clone, Copy, Default)]
struct CellEnergy {
    energy_m2: f64,
    measure: f64,
}

impl LatticeCell {
    /// Returns the two halves; `None` for the finest cells.
    fn halves(&self) -> Option<[Self; 2]> {
        let turns_next =
            self.depth >= FIRST_FREQUENCY_HALVING && (self.depth - FIRST_FREQUENCY_HALVING).is_multiple_of(2);
        let by_frequency = self.bins > 1 && (turns_next || self.directions == 1);
        let next = Self { depth: self.depth + 1, ..*self };
        if by_frequency {
            let bins = self.bins / 2;
            return Some([Self { bins, ..next }, Self { bins, bin: self.bin + bins, ..next }]);
        }
        if self.directions == 1 {
            return None;
        }
        let directions = self.directions / 2;
        Some([Self { directions, ..next }, Self { directions, direction: self.direction + directions, ..next }])
    }

    /// Returns the cell's wave, of the energy `energy_m2`.
    fn wave(&self, seed: u64, energy_m2: f64, depth_m: f64) -> SeaWave {
        let numbers = [self.bin, self.bins, self.direction, self.directions];
        let name = numbers.into_iter().fold(0u64, |name, number| (name << 16) | number as u64);
        let mut chance = RandomStream::new(seed, mixed(name));
        // Wide cells lie in the tail, whose energy per octave falls as w^-4. The random frequency in a cell follows
        // this fall.
        let bin = std::f64::consts::LN_2 / BINS_PER_OCTAVE as f64;
        let falls = 1.0 - libm::exp(-TAIL_POWER * bin * self.bins as f64);
        let w = bin_rad_s(self.bin as f64 - libm::log(1.0 - chance.even() * falls) / (TAIL_POWER * bin));
        let angle = (self.direction as f64 + chance.even() * self.directions as f64) * TAU / DIRECTIONS as f64;
        let phase = chance.even();
        let (sin, cos) = libm::sincos(angle);
        let k = wave_number(w, depth_m);
        SeaWave {
            amplitude_m: (2.0 * energy_m2).sqrt(),
            toward: DVec2::new(cos, sin),
            turns_per_m: k / TAU,
            frequency_hz: w / TAU,
            phase,
            stretch: 1.0 / libm::tanh(k * depth_m),
        }
    }
}

/// Lists the waves of a spectrum.
struct Lister<'a> {
    bins: &'a Bins,
    seed: u64,
    depth_m: f64,
    /// Weight of energy and of slope in the measure.
    weights: [f64; 2],
    waves: &'a mut Vec<SeaWave>,
}

impl Lister<'_> {
    fn amount(&self, cell: &LatticeCell) -> CellEnergy {
        let step = TAU / DIRECTIONS as f64;
        let (from, until) = (cell.direction as f64 * step, (cell.direction + cell.directions) as f64 * step);
        let mut amount = CellEnergy::default();
        for b in cell.bin..cell.bin + cell.bins {
            let mut energy_m2 = 0.0;
            for (s, heading) in self.bins.headings.iter().enumerate().take(self.bins.systems.len()) {
                let whole = self.bins.waves_m2[b][s];
                if whole > 0.0 {
                    let is_all = cell.directions == DIRECTIONS;
                    let share = if is_all { 1.0 } else { heading.share_between(from, until, self.bins.beta[b][s]) };
                    energy_m2 += whole * share;
                }
            }
            let k = self.bins.k_per_m[b];
            amount.energy_m2 += energy_m2;
            amount.measure += energy_m2 * (self.weights[0] + self.weights[1] * k * k);
        }
        amount
    }

    /// Lists the waves of a cell and of the cells inside it, with `scale` times the energy of the spectrum.
    fn list(&mut self, cell: &LatticeCell, amount: &CellEnergy, scale: f64) {
        // No half has enough for a wave if the whole has not.
        let halves = if amount.measure > BEGIN * THRESHOLD { cell.halves() } else { None };
        let Some(halves) = halves else {
            return self.push(cell, scale * amount.energy_m2);
        };
        let amounts = halves.map(|half| self.amount(&half));
        let strong = amounts.map(|half| smoothstep(BEGIN * THRESHOLD, THRESHOLD, half.measure));
        let [taken, left] = [0, 1].map(|is_left| {
            let share = |i: usize| if is_left == 1 { 1.0 - strong[i] } else { strong[i] };
            share(0) * amounts[0].energy_m2 + share(1) * amounts[1].energy_m2
        });
        let kept = (1.0 - strong[0]) * (1.0 - strong[1]);
        self.push(cell, scale * kept * left);
        if taken > 0.0 {
            let more = 1.0 + (1.0 - kept) * left / taken;
            for i in [0, 1].into_iter().filter(|i| strong[*i] > 0.0) {
                self.list(&halves[i], &amounts[i], scale * strong[i] * more);
            }
        }
    }

    /// Adds a cell's wave, of the energy `energy_m2`, unless that is 0.
    fn push(&mut self, cell: &LatticeCell, energy_m2: f64) {
        if energy_m2 > 0.0 {
            self.waves.push(cell.wave(self.seed, energy_m2, self.depth_m));
        }
    }
}

/// Lists the single waves of a spectrum into `waves`.
pub(super) fn list(bins: &Bins, seed: u64, depth_m: f64, waves: &mut Vec<SeaWave>) {
    waves.clear();
    let of_bin = |bin: &[f64; MAX_SYSTEMS]| bin.iter().sum::<f64>();
    let energy: f64 = bins.waves_m2.iter().map(of_bin).sum();
    let slope: f64 = bins.waves_m2.iter().zip(&bins.k_per_m).map(|(bin, k)| of_bin(bin) * k * k).sum();
    if energy <= 0.0 {
        return;
    }
    let weights = [ENERGY_SHARE / energy, (1.0 - ENERGY_SHARE) / slope];
    let mut lister = Lister { bins, seed, depth_m, weights, waves };
    for bin in (0..BINS).step_by(ROOT_BINS) {
        let root = LatticeCell { bin, bins: ROOT_BINS, direction: 0, directions: DIRECTIONS, depth: 0 };
        let amount = lister.amount(&root);
        lister.list(&root, &amount, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::bins::{Spreading, WaveSystem};
    use super::super::spreading::beta_of_width;
    use super::*;

    /// Returns the correlation of heights at two places `shift_m` apart, for waves of fixed amplitudes.
    fn correlation(waves: &[SeaWave], shift_m: DVec2) -> f64 {
        let of = |w: &SeaWave| w.amplitude_m * w.amplitude_m * (TAU * w.turns_per_m * w.toward.dot(shift_m)).cos();
        waves.iter().map(of).sum::<f64>() / waves.iter().map(|w| w.amplitude_m * w.amplitude_m).sum::<f64>()
    }

    fn wind_sea(hs: f64, tp: f64) -> WaveSystem {
        WaveSystem {
            m0_m2: hs * hs / 16.0,
            peak_rad_s: TAU / tp,
            gamma: 3.3,
            toward: DVec2::X,
            spreading: Spreading::WindSea,
            deep_share: 0.0,
            is_shaped: true,
        }
    }

    fn swell(hs: f64, tp: f64, width_deg: f64) -> WaveSystem {
        let spreading = Spreading::Even(beta_of_width(width_deg.to_radians()));
        let toward = DVec2::new(0.8, 0.6);
        WaveSystem { gamma: 7.0, spreading, is_shaped: false, toward, ..wind_sea(hs, tp) }
    }

    fn calm(tp: f64) -> WaveSystem {
        WaveSystem { m0_m2: 0.0, ..wind_sea(0.0, tp) }
    }

    fn listed(systems: &[WaveSystem], seed: u64, depth_m: f64) -> (Bins, Vec<SeaWave>) {
        let (mut bins, mut waves) = (Bins::new(depth_m), Vec::new());
        bins.fill(systems, f64::INFINITY);
        list(&bins, seed, depth_m, &mut waves);
        (bins, waves)
    }

    #[test]
    fn all_seas_list_about_as_many_waves_and_keep_their_energy_by_band() {
        let mut counts = Vec::new();
        for systems in [
            vec![wind_sea(2.1, 6.2)],
            vec![wind_sea(0.2, 1.8)],
            vec![wind_sea(9.0, 11.0)],
            vec![calm(2.0), swell(2.0, 12.0, 15.0)],
            vec![calm(2.0), swell(1.0, 16.0, 6.0)],
            vec![wind_sea(0.4, 2.5), swell(2.0, 13.0, 15.0)],
            vec![wind_sea(1.5, 5.0), swell(1.0, 10.0, 15.0), swell(1.0, 14.0, 10.0)],
        ] {
            let (bins, waves) = listed(&systems, 3, 4000.0);
            let squares: f64 = waves.iter().map(|w| w.amplitude_m.powi(2)).sum();
            let fourths: f64 = waves.iter().map(|w| w.amplitude_m.powi(4)).sum();
            let equal = squares * squares / fourths;
            println!("{} waves, as repeating as {equal:.0} equal ones", waves.len());
            counts.push(waves.len());
            for root in (0..BINS).step_by(ROOT_BINS) {
                let asked: f64 = bins.waves_m2[root..root + ROOT_BINS].iter().flatten().sum();
                let (low, high) = (bin_rad_s(root as f64) / TAU, bin_rad_s((root + ROOT_BINS) as f64) / TAU);
                let inside = waves.iter().filter(|w| (low..high).contains(&w.frequency_hz));
                let drawn: f64 = inside.map(|w| 0.5 * w.amplitude_m.powi(2)).sum();
                assert!((drawn - asked).abs() <= 1e-9 * squares, "{root}: {drawn} {asked}");
            }
        }
        assert!(counts.iter().all(|n| (200..=320).contains(n)), "{counts:?}");
    }

    #[test]
    fn amplitudes_follow_the_weather_and_phases_stay() {
        let key = |w: &SeaWave| (w.frequency_hz.to_bits(), w.phase.to_bits());
        let of = |tp: f64| {
            let (_, waves) = listed(&[wind_sea(2.1, tp)], 5, 4000.0);
            waves.iter().map(|w| (key(w), w.amplitude_m)).collect::<std::collections::BTreeMap<_, _>>()
        };
        let sigma = 2.1 / 4.0;
        let mut before = of(6.0);
        for i in 1..60 {
            let now = of(6.0 + 1e-3 * f64::from(i));
            // All waves together change by little, those that come or go too; most are the same waves.
            let gone = before.iter().filter(|(key, _)| !now.contains_key(key)).map(|(_, a)| a * a);
            let changed = now.iter().map(|(key, a)| (a - before.get(key).unwrap_or(&0.0)).powi(2));
            let change = (0.5 * (gone.sum::<f64>() + changed.sum::<f64>())).sqrt();
            assert!(change < 0.015 * sigma, "{i}: {change}");
            let kept = now.keys().filter(|key| before.contains_key(key)).count();
            assert!(kept * 100 > now.len() * 95, "{i}: {kept} of {}", now.len());
            before = now;
        }
    }

    /// Largest difference of correlations at shifts of 300 m to 5 km between waves and the spectrum that they draw.
    fn repetition(systems: &[WaveSystem], seed: u64, rings: u32) -> f64 {
        let (bins, waves) = listed(systems, seed, 4000.0);
        // The spectrum's own correlation, by a fine quadrature over bins and directions.
        let mut fine = Vec::new();
        for b in 0..BINS {
            for (s, system) in bins.systems.iter().enumerate() {
                let energy = bins.waves_m2[b][s];
                if energy < 1e-6 * bins.variance_m2() {
                    continue;
                }
                for d in 0..96 {
                    let (from, until) = (f64::from(d) * TAU / 96.0, f64::from(d + 1) * TAU / 96.0);
                    let share = energy * system.heading().share_between(from, until, bins.beta[b][s]);
                    if share > 1e-7 * bins.variance_m2() {
                        let (sin, cos) = (0.5 * (from + until)).sin_cos();
                        fine.push((share, DVec2::new(cos, sin) * bins.k_per_m[b]));
                    }
                }
            }
        }
        let whole: f64 = fine.iter().map(|f| f.0).sum();
        let mut worst = 0.0f64;
        for ring in 0..rings {
            let distance = 300.0 * (5000.0f64 / 300.0).powf(f64::from(ring) / f64::from(rings));
            for turn in 0..180 {
                let angle = PI * (f64::from(turn) + 0.37 * f64::from(ring % 3)) / 180.0;
                let shift = DVec2::new(angle.cos(), angle.sin()) * distance;
                let drawn = correlation(&waves, shift);
                if drawn.abs() < worst {
                    continue;
                }
                let own = fine.iter().map(|(e, k)| e * k.dot(shift).cos()).sum::<f64>() / whole;
                worst = worst.max((drawn - own).abs());
            }
        }
        worst
    }

    #[test]
    fn the_sea_does_not_repeat() {
        let rings = if std::env::var_os("WELKIN_ACCEPT").is_some() { 1000 } else { 16 };
        for (name, systems) in [
            ("wind sea of 60 m", vec![wind_sea(2.1, 6.2)]),
            ("wind sea of 200 m", vec![wind_sea(6.0, 11.3)]),
            ("pure swell of 225 m", vec![calm(2.0), swell(2.0, 12.0, 15.0)]),
            ("narrow swell of 100 m", vec![calm(2.0), swell(1.5, 8.0, 10.0)]),
        ] {
            for seed in 1..if rings > 100 { 6 } else { 2 } {
                let worst = repetition(&systems, seed, rings);
                println!("{name}, seed {seed}: {worst:.3}");
                // The search of acceptance tries 180,000 shifts, among which a few lie near 0.26.
                let most = if rings > 100 { 0.28 } else { 0.25 };
                assert!(worst < most, "{name}, seed {seed}: {worst}");
            }
        }
    }
}
