//! The spectrum of a sea on a fixed grid of frequencies: the energy of each system in each bin, and the share of it
//! that is drawn as single waves and as tiles.

use std::f64::consts::PI;

use glam::DVec2;

use super::{
    dispersion::wave_number,
    ice::SeaIce,
    spectrum::{depth_share, jonswap_shape},
    spreading::{donelan_banner_beta, sech_squared, sech_squared_share},
};
use crate::numerics::smoothstep;

/// Lowest frequency of the grid, rad/s: a period of 63 s.
pub(super) const LOWEST_RAD_S: f64 = 0.1;
/// Bins in an octave of frequency.
pub(super) const BINS_PER_OCTAVE: usize = 64;
/// Number of bins: 10.5 octaves, up to 145 rad/s, where waves are a centimetre long.
pub(super) const BINS: usize = 672;
/// Maximum number of systems: the wind sea and the swells.
pub(super) const MAX_SYSTEMS: usize = 5;

/// Frequencies, in multiples of the wind sea's peak frequency, between which the energy passes from single waves to
/// tiles.
const HANDOVER: [f64; 2] = [3.0, 4.0];
/// Ratio of the tiles' highest wave number to the wave number at which they begin. At most three tiles of the ladder
/// then have energy.
const TILED_RANGE: f64 = 45.0;
/// Highest wave number at which tiles have energy, 1/m: just below that of the finest tile's shortest waves, 565.
const FINEST_PER_M: f64 = 560.0;
/// Ratio of the two wave numbers between which the tiles' energy fades to 0.
const END_RATIO: f64 = 1.5;

/// Form of the spreading of a system over directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Spreading {
    /// Donelan and Banner's, whose parameter depends on w / wp, the frequency over the peak frequency.
    WindSea,
    /// Donelan and Banner's form with one parameter beta at all frequencies.
    Even(f64),
}

/// Waves of one origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WaveSystem {
    /// Variance, m^2.
    pub m0_m2: f64,
    pub peak_rad_s: f64,
    pub gamma: f64,
    /// Direction in which the system travels (east, north). The vector's length, at most 1, is the share of the waves
    /// that `spreading` puts around this direction. The rest is even over all directions.
    pub toward: DVec2,
    pub spreading: Spreading,
    /// Share of the variance that is given for deep water, 0 to 1. The depth takes some of this share away (TMA).
    pub deep_share: f64,
    /// Whether the depth shapes the spectrum (TMA).
    pub is_shaped: bool,
}

impl WaveSystem {
    /// Returns the parameter of the spreading at a frequency.
    pub fn beta(&self, w_rad_s: f64) -> f64 {
        match self.spreading {
            Spreading::WindSea => donelan_banner_beta(w_rad_s / self.peak_rad_s),
            Spreading::Even(beta) => beta,
        }
    }

    /// Returns the direction of the system.
    pub fn heading(&self) -> Heading {
        Heading { certain: self.toward.length().min(1.0), mean: libm::atan2(self.toward.y, self.toward.x) }
    }

    /// Returns the density of the variance over frequency without its level: the spectrum's shape at w / wp, times the
    /// share that the depth leaves.
    fn shape(&self, w_rad_s: f64, depth_m: f64) -> f64 {
        let deep = jonswap_shape(w_rad_s / self.peak_rad_s, self.gamma);
        if self.is_shaped && deep > 0.0 { deep * depth_share(w_rad_s, depth_m) } else { deep }
    }
}

/// Share of a system's waves that is spread around the system's direction, and this direction, rad from east to north.
/// The rest of the waves is even over all directions.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Heading {
    certain: f64,
    mean: f64,
}

impl Heading {
    /// Returns the share of waves that travel between two directions (radians from east to north, `first` below `last`,
    /// at most a turn apart).
    pub fn share_between(&self, first: f64, last: f64, beta: f64) -> f64 {
        let even = (last - first) / (2.0 * PI);
        if self.certain <= 0.0 || even >= 1.0 {
            return even;
        }
        let low = wrapped(first - self.mean);
        let high = low + (last - first);
        let below = |theta: f64| sech_squared_share(theta, beta);
        let inside = if high <= PI { below(high) - below(low) } else { 1.0 - below(low) + below(high - 2.0 * PI) };
        even + self.certain * (inside - even)
    }

    /// Returns the density of waves over directions, 1/rad.
    pub fn density(&self, direction: f64, beta: f64) -> f64 {
        (1.0 - self.certain) / (2.0 * PI) + self.certain * sech_squared(wrapped(direction - self.mean), beta)
    }
}

/// Returns the unit vector (east, north) along which waves travel that come from the direction `from_deg`.
pub(super) fn toward_of(from_deg: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(from_deg.to_radians());
    DVec2::new(-sin, -cos)
}

/// Returns an angle within \[-pi, pi).
pub(super) fn wrapped(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI) + 0.5).floor()
}

/// Returns the frequency at a place on the grid, rad/s. A bin begins at the place of its own number and has its middle
/// 0.5 beyond that.
pub(super) fn bin_rad_s(bin: f64) -> f64 {
    LOWEST_RAD_S * libm::exp2(bin / BINS_PER_OCTAVE as f64)
}

/// The spectrum of a sea as it is drawn, in bins of frequency.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    pub systems: Vec<WaveSystem>,
    pub headings: [Heading; MAX_SYSTEMS],
    /// Variance per bin of each system drawn as single waves, m^2.
    pub waves_m2: Vec<[f64; MAX_SYSTEMS]>,
    /// Variance per bin of each system drawn in tiles, m^2.
    pub tiles_m2: Vec<[f64; MAX_SYSTEMS]>,
    /// Parameter of the spreading per bin and system.
    pub beta: Vec<[f64; MAX_SYSTEMS]>,
    /// Wave number per bin, 1/m.
    pub k_per_m: Vec<f64>,
    /// Level of each system, m^2 s. The density of its variance over frequency is the level times its shape.
    pub level: [f64; MAX_SYSTEMS],
    /// Wave number at which the tiles' energy ends, 1/m.
    pub end_per_m: f64,
    /// Ice that dampens the waves.
    pub ice: Option<SeaIce>,
    /// Frequency of the wind sea's peak, rad/s.
    peak_rad_s: f64,
    depth_m: f64,
}

impl Bins {
    /// Creates empty bins for a depth.
    pub fn new(depth_m: f64) -> Self {
        let none = vec![[0.0; MAX_SYSTEMS]; BINS];
        let k_per_m = (0..BINS).map(|b| wave_number(bin_rad_s(b as f64 + 0.5), depth_m)).collect();
        Self {
            systems: Vec::with_capacity(MAX_SYSTEMS),
            headings: [Heading::default(); MAX_SYSTEMS],
            waves_m2: none.clone(),
            tiles_m2: none.clone(),
            beta: none,
            k_per_m,
            level: [0.0; MAX_SYSTEMS],
            end_per_m: 0.0,
            ice: None,
            peak_rad_s: 1.0,
            depth_m,
        }
    }

    /// Fills the bins. The first system is the wind sea. `most_slope` is the mean square slope at which the tiles end;
    /// infinite if the settings give the height of the waves.
    pub fn fill(&mut self, systems: &[WaveSystem], most_slope: f64) {
        for bins in [&mut self.waves_m2, &mut self.tiles_m2] {
            bins.fill([0.0; MAX_SYSTEMS]);
        }
        self.systems.clear();
        self.systems.extend_from_slice(systems);
        self.headings.iter_mut().zip(systems).for_each(|(heading, system)| *heading = system.heading());
        self.peak_rad_s = systems[0].peak_rad_s;
        let asked: f64 = (0..systems.len()).map(|s| self.fill_system(s)).sum();
        self.end_per_m = self.end(most_slope);
        let mut drawn = 0.0;
        for b in 0..BINS {
            let (tiled, kept) = self.shares(bin_rad_s(b as f64 + 0.5), self.k_per_m[b]);
            for s in 0..systems.len() {
                let whole = self.waves_m2[b][s];
                self.tiles_m2[b][s] = whole * tiled * kept;
                self.waves_m2[b][s] = whole * (1.0 - tiled);
                drawn += self.tiles_m2[b][s] + self.waves_m2[b][s];
            }
        }
        // Waves beyond the tiles' end have some 1e-4 of the variance. The drawn waves are strengthened by as much.
        let factor = if drawn > 0.0 { asked / drawn } else { 1.0 };
        self.waves_m2.iter_mut().chain(&mut self.tiles_m2).flatten().for_each(|e| *e *= factor);
        self.level.iter_mut().for_each(|level| *level *= factor);
        if self.ice.is_some() {
            for b in 0..BINS {
                let kept = self.kept_by_ice(bin_rad_s(b as f64 + 0.5), self.k_per_m[b]);
                self.waves_m2[b].iter_mut().chain(&mut self.tiles_m2[b]).for_each(|energy| *energy *= kept);
            }
        }
    }

    /// Returns the share of the energy at a frequency that ice leaves; 1 without ice.
    fn kept_by_ice(&self, w_rad_s: f64, k_per_m: f64) -> f64 {
        let share = self.ice.map_or(1.0, |ice| ice.amplitude_share(w_rad_s / (2.0 * PI), k_per_m));
        share * share
    }

    /// Fills in the whole energy of a system, not yet divided into single waves and tiles. Returns the system's
    /// variance at the depth.
    fn fill_system(&mut self, s: usize) -> f64 {
        let system = self.systems[s];
        let (mut whole, mut deep) = (0.0, 0.0);
        // Two Gauss points a bin; dw = w dln w.
        let offset = 0.5 / 3f64.sqrt();
        let width = std::f64::consts::LN_2 / BINS_PER_OCTAVE as f64;
        for b in 0..BINS {
            let mut energy = 0.0;
            for node in [0.5 - offset, 0.5 + offset] {
                let w = bin_rad_s(b as f64 + node);
                let shape = if w < 0.3 * system.peak_rad_s { 0.0 } else { system.shape(w, self.depth_m) };
                energy += 0.5 * width * w * shape;
                if system.deep_share > 0.0 && shape > 0.0 {
                    deep += 0.5 * width * w * jonswap_shape(w / system.peak_rad_s, system.gamma);
                }
            }
            self.waves_m2[b][s] = energy;
            self.beta[b][s] = system.beta(bin_rad_s(b as f64 + 0.5));
            whole += energy;
        }
        let over = if system.deep_share > 0.0 { whole + system.deep_share * (deep - whole) } else { whole };
        self.level[s] = if over > 0.0 { system.m0_m2 / over } else { 0.0 };
        let level = self.level[s];
        self.waves_m2.iter_mut().for_each(|bin| bin[s] *= level);
        level * whole
    }

    /// Returns the wave number at which the tiles' energy ends: the end of the tiles' range, or a lower one if the mean
    /// square slope of all waves reaches `most_slope` before it.
    fn end(&self, most_slope: f64) -> f64 {
        let begin = wave_number(HANDOVER[0] * self.peak_rad_s, self.depth_m);
        let range = (TILED_RANGE * begin).min(FINEST_PER_M);
        let mut slope = 0.0;
        for b in 0..BINS {
            let k = self.k_per_m[b];
            let more: f64 = k * k * self.waves_m2[b].iter().sum::<f64>();
            if slope + more > most_slope {
                // The wave number is interpolated, so that the end moves continuously. This wave number lies in the
                // middle of the range in which the energy fades.
                let part = (most_slope - slope) / more;
                let next = self.k_per_m.get(b + 1).copied().unwrap_or(k);
                return range.min((k + part * (next - k)) * END_RATIO.sqrt());
            }
            slope += more;
        }
        range
    }

    /// Returns the share of the energy at a frequency that belongs to tiles, and the share of the tiles' energy that is
    /// kept.
    pub fn shares(&self, w_rad_s: f64, k_per_m: f64) -> (f64, f64) {
        let log = libm::log(w_rad_s / self.peak_rad_s);
        let tiled = smoothstep(libm::log(HANDOVER[0]), libm::log(HANDOVER[1]), log);
        let end = libm::log(self.end_per_m);
        let kept = 1.0 - smoothstep(end - libm::log(END_RATIO), end, libm::log(k_per_m));
        (tiled, kept)
    }

    /// Returns the density over frequency of a system, m^2 s, at a frequency with its wave number.
    pub fn density(&self, s: usize, w_rad_s: f64, k_per_m: f64) -> f64 {
        self.level[s] * self.systems[s].shape(w_rad_s, self.depth_m) * self.kept_by_ice(w_rad_s, k_per_m)
    }

    /// Returns the variance of what is drawn, m^2.
    #[cfg(test)]
    pub fn variance_m2(&self) -> f64 {
        self.waves_m2.iter().chain(&self.tiles_m2).flatten().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wind_sea(hs: f64, tp: f64) -> WaveSystem {
        WaveSystem {
            m0_m2: hs * hs / 16.0,
            peak_rad_s: 2.0 * PI / tp,
            gamma: 3.3,
            toward: DVec2::X,
            spreading: Spreading::WindSea,
            deep_share: 0.0,
            is_shaped: true,
        }
    }

    #[test]
    fn bins_hold_the_variance_that_was_asked() {
        for (hs, tp, depth) in [(2.139, 6.232, 4000.0), (9.0, 11.0, 30.0), (0.2, 1.8, 4000.0)] {
            let mut bins = Bins::new(depth);
            bins.fill(&[wind_sea(hs, tp)], f64::INFINITY);
            assert!((4.0 * bins.variance_m2().sqrt() / hs - 1.0).abs() < 1e-12, "{hs}");
            let tiled: f64 = bins.tiles_m2.iter().flatten().sum();
            // In deep water 1.0 % of the variance lies above 3 times the peak's frequency, and 0.32 % above 4 times.
            let share = tiled / bins.variance_m2();
            assert!(depth < 1000.0 || (0.0032..0.010).contains(&share), "{share}");
        }
    }

    #[test]
    fn depths_take_the_share_of_tma_from_growing_seas_only() {
        let deep = WaveSystem { deep_share: 1.0, ..wind_sea(2.139, 6.232) };
        let mut bins = Bins::new(5.0);
        bins.fill(&[deep], f64::INFINITY);
        let hs = 4.0 * bins.variance_m2().sqrt();
        assert!((hs / 1.285 - 1.0).abs() < 1.5e-3, "{hs}");
    }

    #[test]
    fn shares_of_directions_add_up_and_follow_the_density() {
        for toward in [DVec2::X, DVec2::new(-0.6, -0.3), DVec2::ZERO] {
            let system = WaveSystem { toward, ..wind_sea(1.0, 5.0) };
            for beta in [0.4, 2.28, 9.0] {
                let n = 512;
                let step = 2.0 * PI / f64::from(n);
                let (mut sum, mut worst) = (0.0, 0.0f64);
                for i in 0..n {
                    let from = f64::from(i) * step;
                    let share = system.heading().share_between(from, from + step, beta);
                    sum += share;
                    worst = worst.max((share / step - system.heading().density(from + 0.5 * step, beta)).abs());
                }
                assert!((sum - 1.0).abs() < 1e-12, "{toward} {beta}: {sum}");
                assert!(worst < 2e-2 * beta, "{toward} {beta}: {worst}");
            }
        }
    }

    #[test]
    fn slopes_end_the_tiles() {
        let mut bins = Bins::new(4000.0);
        let slopes = |bins: &Bins| -> f64 {
            let of = |b: usize| bins.waves_m2[b].iter().chain(&bins.tiles_m2[b]).sum::<f64>();
            (0..BINS).map(|b| bins.k_per_m[b].powi(2) * of(b)).sum()
        };
        bins.fill(&[wind_sea(2.139, 6.232)], f64::INFINITY);
        let whole = slopes(&bins);
        bins.fill(&[wind_sea(2.139, 6.232)], 0.02);
        assert!(whole > 0.027 && (slopes(&bins) / 0.02 - 1.0).abs() < 0.01, "{whole} {}", slopes(&bins));
    }
}
