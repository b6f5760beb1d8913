//! Gusts as sums of waves along the path of the mean wind, and the integrals of such waves.
//!
//! The mean wind carries eddies past a place (Taylor 1938). A gust is therefore a function of the path s, the integral
//! of the mean speed, and not of time. When the wind picks up, the same gusts pass faster and none starts anew.

use std::f64::consts::TAU;

use glam::DVec2;

use crate::chance::RandomStream;

/// Number of waves along the wind, and of waves across it.
const TONES: usize = 24;
/// Longest and shortest wave, m. Longer ones are changes of weather; shorter ones do not move a whole scene together.
const WAVES_M: (f64, f64) = (3000.0, 8.0);
/// Turbulence scale at 10 m above ground, m: 0.7 of the height (IEC 61400-1, 6.3).
const SCALE_M: f64 = 7.0;
/// Integral scales of Kaimal's spectrum along and across the wind, m (IEC 61400-1, annex C).
const LENGTHS_M: [f64; 2] = [8.1 * SCALE_M, 2.7 * SCALE_M];
/// Ratio of the standard deviation across the wind to that along it (IEC 61400-1, annex C).
pub(super) const ACROSS: f64 = 0.8;
/// Length of the wave by which the direction wanders, m: three minutes in the light winds that wander.
const WANDER_M: f64 = 600.0;
/// Number of orders of the wander's series. The first order left out is at most J_13(pi), 5e-8.
const ORDERS: usize = 12;

/// One wave: amplitude x cos(wavenumber s + phase), with the path s in m and the phase in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
struct GustWave {
    /// Wavenumber along the path, rad/m.
    wavenumber: f64,
    /// Amplitude, in standard deviations of the gusts.
    amplitude: f64,
    /// Phase, rad.
    phase: f64,
}

/// Gusts of a seed: two sums of waves with a variance of 1 each, whose wavelengths follow the spectrum of Kaimal et al.
/// (1972), and the wave that turns the wind.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Gusts {
    /// Waves of the gusts along the mean wind.
    along: [GustWave; TONES],
    /// Waves of the gusts across the mean wind.
    across: [GustWave; TONES],
    /// Wave by which the direction wanders.
    wander: GustWave,
}

/// Turbulence around the mean wind, per m/s of mean speed, in quantities that can be interpolated. Vectors (east,
/// north).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stir {
    /// Standard deviation of gusts along the wind.
    along: DVec2,
    /// Velocity that the wander adds to the mean, as a series in its wave with the orders -12 to 12. A wind d that
    /// turns by w sin p is the sum of J_n(w) d e^(i n p) (Jacobi and Anger).
    turning: [DVec2; 2 * ORDERS + 1],
}

impl Stir {
    /// Creates the turbulence of a wind whose mean blows towards `direction` (of length 1, 0 in a calm). `wander` is
    /// the largest angle by which the wander turns the wind, rad.
    pub fn new(direction: DVec2, turbulence_intensity: f64, wander: f64) -> Self {
        let mut turning = [DVec2::ZERO; 2 * ORDERS + 1];
        if wander > 0.0 {
            for n in 0..=ORDERS {
                let j = direction * libm::jn(n as i32, wander);
                turning[ORDERS + n] = j;
                // J_-n = (-1)^n J_n.
                turning[ORDERS - n] = if n % 2 == 0 { j } else { -j };
            }
            turning[ORDERS] -= direction;
        }
        Self { along: direction * turbulence_intensity, turning }
    }

    /// Combines the numbers of two turbulences one by one.
    fn zip(&self, other: &Self, f: impl Fn(DVec2, DVec2) -> DVec2) -> Self {
        Self {
            along: f(self.along, other.along),
            turning: std::array::from_fn(|i| f(self.turning[i], other.turning[i])),
        }
    }
}

/// Stretch of path along which the turbulence changes linearly from `from` at `start_m` to `to` after `length_m`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GustStretch {
    /// Path of the mean wind at the stretch's beginning, m.
    pub start_m: f64,
    /// Length of the stretch, m; 0 if the turbulence does not change.
    pub length_m: f64,
    /// Turbulence at the beginning.
    pub from: Stir,
    /// Turbulence at the end.
    pub to: Stir,
}

/// Returns the share of the variance in waves longer than L / x, where L is the integral scale: the integral of
/// Kaimal's 4 / (1 + 6 x)^(5/3) from 0 to x.
fn share_below(x: f64) -> f64 {
    1.0 - libm::pow(1.0 + 6.0 * x, -2.0 / 3.0)
}

/// Returns the complex exponential of an angle.
fn turn(angle: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(cos, sin)
}

/// Returns e^(i k y) at y = `length`, and the integrals of it and of y e^(i k y) from 0 to `length`.
fn wave(k: f64, length: f64) -> [DVec2; 3] {
    if k == 0.0 {
        return [DVec2::X, DVec2::X * length, DVec2::X * (0.5 * length * length)];
    }
    let half = turn(0.5 * k * length);
    // Computing 1 - cos by the half angle keeps its digits in a short stretch.
    let (sin, versine) = (2.0 * half.x * half.y, 2.0 * half.y * half.y);
    let (end, plain) = (DVec2::new(1.0 - versine, sin), DVec2::new(sin, versine) / k);
    // Integration by parts: (Y e^(ikY) - plain) / (i k).
    let ramp = end * length - plain;
    [end, plain, DVec2::new(ramp.y, -ramp.x) / k]
}

/// Velocities that wander and gusts add to the mean wind at a point of a stretch, and the displacement of the air by
/// both.
pub(super) struct Stirred {
    /// Velocity by the wander, per m/s of mean speed.
    pub turned: DVec2,
    /// Velocity by gusts, per m/s of mean speed.
    pub gust: DVec2,
    /// Displacement by both since the start of the stretch, m.
    pub way_m: DVec2,
}

impl Gusts {
    /// Creates the gusts of a seed.
    pub fn new(seed: u64) -> Self {
        // A constant of its own keeps the gusts independent of everything else that uses the seed.
        let mut stream = RandomStream::seeded(seed ^ 0x7769_6e64_2067_7573);
        let mut random = || stream.unit();
        let mut tones = |scale_m: f64| -> [GustWave; TONES] {
            let (low, high) = (scale_m / WAVES_M.0, scale_m / WAVES_M.1);
            let edge = |i: f64| low * libm::pow(high / low, i / TONES as f64);
            let whole = share_below(high) - share_below(low);
            std::array::from_fn(|i| {
                let variance = (share_below(edge(i as f64 + 1.0)) - share_below(edge(i as f64))) / whole;
                GustWave {
                    wavenumber: TAU / scale_m * edge(i as f64 + random()),
                    amplitude: (2.0 * variance).sqrt(),
                    phase: TAU * random(),
                }
            })
        };
        let (along, across) = (tones(LENGTHS_M[0]), tones(LENGTHS_M[1]));
        let wander = GustWave { wavenumber: TAU / WANDER_M, amplitude: 1.0, phase: TAU * random() };
        Self { along, across, wander }
    }

    /// Returns the velocities and displacements that the turbulence adds over the first `y_m` of a stretch.
    pub fn over(&self, stretch: &GustStretch, y_m: f64) -> Stirred {
        let (from, rise, there) = (&stretch.from, &stretch.rise_per_m(), &stretch.stir_after(y_m));
        // In standard deviations: the value after `y_m`, the integral of the value, and that of the value times the
        // path.
        let [along, across] = [&self.along, &self.across].map(|tones| {
            tones.iter().fold([0.0; 3], |sums, t| {
                let start = turn(t.wavenumber * stretch.start_m + t.phase) * t.amplitude;
                let wave = wave(t.wavenumber, y_m);
                std::array::from_fn(|i| sums[i] + start.rotate(wave[i]).x)
            })
        });
        let gust = |stir: &Stir, i: usize| stir.along * along[i] + stir.along.perp() * (ACROSS * across[i]);
        let phase = self.wander.wavenumber * stretch.start_m + self.wander.phase;
        let turned = |stir: &Stir, i: usize| -> DVec2 {
            let of_order =
                |(n, c): (f64, DVec2)| turn(n * phase).rotate(wave(n * self.wander.wavenumber, y_m)[i].rotate(c));
            orders(&stir.turning).map(of_order).sum()
        };
        Stirred {
            turned: turned(there, 0),
            gust: gust(there, 0),
            way_m: gust(from, 1) + gust(rise, 2) + turned(from, 1) + turned(rise, 2),
        }
    }
}

/// Iterates over the coefficients of a series with their orders. Empty if all are 0, as where the wind does not wander.
fn orders(series: &[DVec2; 2 * ORDERS + 1]) -> impl Iterator<Item = (f64, DVec2)> {
    let present = series.iter().any(|c| *c != DVec2::ZERO);
    let count = if present { series.len() } else { 0 };
    series[..count].iter().enumerate().map(|(i, c)| (i as f64 - ORDERS as f64, *c))
}

impl GustStretch {
    /// Returns the turbulence after `y_m` of the stretch.
    pub fn stir_after(&self, y_m: f64) -> Stir {
        let part = if self.length_m > 0.0 { y_m / self.length_m } else { 0.0 };
        self.from.zip(&self.to, |a, b| a + (b - a) * part)
    }

    /// Returns the change of the turbulence per metre of the stretch.
    fn rise_per_m(&self) -> Stir {
        let length = if self.length_m > 0.0 { self.length_m } else { f64::INFINITY };
        self.from.zip(&self.to, |a, b| (b - a) / length)
    }
}
