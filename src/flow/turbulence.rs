//! Turbulence of the inflow: eddies that are long enough for the cells and short enough for the box.
//!
//! The turbulence is a sum of waves in all directions. The velocity of each is perpendicular to its wave vector, so the
//! sum is free of divergence (Kraichnan 1970, Phys. Fluids 13, 22). The waves have the energy of von Karman's spectrum
//! (1948): E(k) is proportional to x^4 / (1 + x^2)^(17/6), x = 1.339 L k, with L the integral length along the wind.
//! The wind carries them unchanged (Taylor 1938). The eddies mix the shear between the wake of a block and the wind;
//! without eddies the wake is too long (`src/flow/tests/bluff.rs`).

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec2, DVec3};

use super::WindFieldDesc;
use crate::chance::RandomStream;

/// Number of waves in the sum.
const WAVES: usize = 32;
/// Length of the shortest wave that the field carries, cells.
const FEWEST_CELLS: f64 = 4.0;
/// Integral of x^4 / (1 + x^2)^(17/6) from 0 to infinity: half the beta function of 5/2 and 1/3.
const WHOLE: f64 = 1.0325;
/// Standard deviations of the wind near the ground along the mean wind, across it and upward, divided by the friction
/// velocity, in neutral stratification (Panofsky and Dutton 1984, Atmospheric Turbulence, chapter 7).
const OVER_LAND: DVec3 = DVec3::new(2.4, 1.9, 1.25);
/// Integral length along the wind, m, over open grassland: 25 z^0.35 / z0^0.063 (Counihan 1975) at z = 10 m with z0 =
/// 0.03 m.
const INTEGRAL_M: f64 = 70.0;

/// Wave with the velocity sine x sin(k . place) + cosine x cos(k . place).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wave {
    /// Wave vector, rad/m.
    k_per_m: DVec3,
    /// Velocity of the sine part.
    sine: DVec3,
    /// Velocity of the cosine part.
    cosine: DVec3,
}

/// Turbulence of a seed: the waves that a field can carry, with their share of the whole variance. Waves of all lengths
/// together would have a variance of 1 in each component.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Turbulence([Wave; WAVES]);

/// Returns the share of the energy of von Karman's spectrum between two values of x.
fn share_between(low: f64, high: f64) -> f64 {
    const PARTS: u32 = 16;
    let ratio = libm::pow(high / low, 1.0 / f64::from(PARTS));
    let middle = |i: u32| low * libm::pow(ratio, f64::from(i) + 0.5);
    let of = |x: f64| x * libm::pow(x, 4.0) / libm::pow(1.0 + x * x, 17.0 / 6.0);
    (0..PARTS).map(|i| of(middle(i)) * libm::log(ratio)).sum::<f64>() / WHOLE
}

impl Turbulence {
    /// Creates the turbulence of an integral length, m, in a box whose shorter horizontal side is `side_m`, with cells
    /// of `cell_m`. `None` if the box is too small for any wave.
    pub fn new(seed: u64, integral_m: f64, cell_m: f64, side_m: f64) -> Option<Self> {
        let (longest, shortest) = (side_m / 2.0, FEWEST_CELLS * cell_m);
        if longest <= shortest {
            return None;
        }
        // A stream of random numbers of its own, which no other effect uses.
        let mut stream = RandomStream::seeded(seed ^ 0x7768_6972_6c73_2069);
        let mut random = || stream.unit();
        let x_of = |length_m: f64| 1.339 * integral_m * TAU / length_m;
        let (low, high) = (x_of(longest), x_of(shortest));
        let edge = |i: f64| low * libm::pow(high / low, i / WAVES as f64);
        let wave = |i: usize| {
            let part = random();
            let k = edge(i as f64 + part) / (1.339 * integral_m);
            // Directions follow the golden angle around a sphere, in an order that is independent of the wavelength.
            let place = ((i * 13) % WAVES) as f64 + 0.5;
            let (up, round) = (1.0 - 2.0 * place / WAVES as f64, place * PI * (3.0 - 5.0f64.sqrt()) + TAU * random());
            let (sin, cos) = libm::sincos(round);
            let level = (1.0 - up * up).sqrt();
            let toward = DVec3::new(level * cos, level * sin, up);
            let (one, other) = toward.any_orthonormal_pair();
            // Sine and cosine have half of the energy each.
            let size = (3.0 * share_between(edge(i as f64), edge(i as f64 + 1.0))).sqrt();
            let mut across = || {
                let (sin, cos) = libm::sincos(TAU * random());
                (one * cos + other * sin) * size
            };
            Wave { k_per_m: toward * k, sine: across(), cosine: across() }
        };
        Some(Self(std::array::from_fn(wave)))
    }

    /// Returns the velocity at a place, m, in coordinates that move with the air. The unit is the standard deviation of
    /// eddies of all lengths.
    pub fn at(&self, place_m: DVec3) -> DVec3 {
        self.0.iter().fold(DVec3::ZERO, |sum, wave| {
            let (sin, cos) = libm::sincos(wave.k_per_m.dot(place_m));
            sum + wave.sine * sin + wave.cosine * cos
        })
    }
}

/// Eddies in the wind that comes in over a field's sides.
pub(super) struct Whirls {
    /// Eddies; `None` if there are none.
    turbulence: Option<Turbulence>,
    /// Axes as columns: along the mean wind, across it, up.
    axes: DMat3,
    /// Standard deviation of eddies of all lengths along each of the axes, m/s.
    deviation_m_s: DVec3,
    /// Height below which the eddies fade towards the ground, m.
    least_m: f64,
}

impl Whirls {
    /// Creates the eddies of a mean wind (east, north) with a friction velocity, m/s. There are none if the friction
    /// velocity is 0 or the field is too small.
    pub fn new(seed: u64, desc: &WindFieldDesc, mean_m_s: DVec2, friction_velocity_m_s: f64) -> Self {
        let along = mean_m_s.try_normalize().unwrap_or(DVec2::X).extend(0.0);
        let side_m = |i: usize| f64::from(desc.cells[i]) * desc.cell_m[i];
        let (cell_m, side_m) = (desc.cell_m.max_element(), side_m(0).min(side_m(1)));
        Self {
            turbulence: if friction_velocity_m_s > 0.0 {
                Turbulence::new(seed, INTEGRAL_M, cell_m, side_m)
            } else {
                None
            },
            axes: DMat3::from_cols(along, DVec3::Z.cross(along), DVec3::Z),
            deviation_m_s: OVER_LAND * friction_velocity_m_s,
            least_m: cell_m,
        }
    }

    /// Returns the wind that the eddies add, m/s, at a place in the air that carries them and a height above the
    /// ground, m.
    pub fn at(&self, place_m: DVec3, height_m: f64) -> DVec3 {
        let Some(turbulence) = &self.turbulence else { return DVec3::ZERO };
        let local = self.axes.transpose() * turbulence.at(place_m);
        self.axes * (local * self.deviation_m_s) * (height_m / self.least_m).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENGTH_M: f64 = 20.0;

    fn whirls(seed: u64, cell_m: f64, side_m: f64) -> Turbulence {
        Turbulence::new(seed, LENGTH_M, cell_m, side_m).expect("room for whirls")
    }

    /// Returns the mean of a function of the turbulence at a place, over places and seeds.
    fn means(f: impl Fn(&Turbulence, DVec3) -> DVec3) -> DVec3 {
        let of = |seed: u64| {
            let whirls = whirls(seed, 0.25, 2000.0);
            (0..40).map(|i| f(&whirls, DVec3::new(97.0, 61.0, 37.0) * f64::from(i))).sum::<DVec3>() / 40.0
        };
        (0..400).map(of).sum::<DVec3>() / 400.0
    }

    #[test]
    fn whirls_have_the_energy_and_the_lengths_of_von_karmans() {
        let square = means(|w, p| w.at(p) * w.at(p));
        // Share of the variance in waves from 1 m to 1000 m.
        println!("variance {square}, due 0.952");
        assert!((square - 0.952).abs().max_element() < 0.04, "{square}");
        // Von Karman's longitudinal correlation at r = L / 2: 2^(2/3) / Gamma(1/3) z^(1/3) K_1/3(z) = 0.54 with z = r /
        // (1.339 L).
        let along = means(|w, p| w.at(p) * w.at(p + DVec3::X * 0.5 * LENGTH_M)).x / square.x;
        println!("correlation after half a length: {along:.3}");
        assert!((along - 0.54).abs() < 0.05, "{along}");
    }

    #[test]
    fn whirls_have_no_divergence_and_differ_by_seed() {
        let three = whirls(3, 1.0, 200.0);
        let (p, h) = (DVec3::new(12.0, -7.0, 3.0), 1e-4);
        let slope = |axis: DVec3| ((three.at(p + axis * h) - three.at(p - axis * h)) / (2.0 * h)).dot(axis);
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(slope);
        assert!((x + y + z).abs() < 1e-6 && x.abs() > 1e-4, "{x} {y} {z}");
        assert_eq!(three, whirls(3, 1.0, 200.0));
        assert_ne!(three, whirls(4, 1.0, 200.0));
        assert_eq!(Turbulence::new(3, LENGTH_M, 4.0, 30.0), None, "a box too small for any");
    }
}
