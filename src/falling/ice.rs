//! Falling ice, hail and pellets: how many stones of which size there are, how fast they fall, what they hide, what
//! lands.
//!
//! Pellets are frozen raindrops: Marshall and Palmer's (1948) sizes of the same water, swollen by freezing, from 0.5 to
//! 5 mm; they fall as spheres do (Heymsfield and Westbrook 2010). Small hail goes with them. Hail is exponential from 5
//! to 60 mm with N0 = 115 lambda^3.63 (Cheng and English 1983), so that a rate alone says how large the stones are;
//! they fall as Matson and Huggins (1980) photographed them. The numbers close: what falls is the rate. Diameters in mm
//! of spheres of ice.

use std::f64::consts::PI;

use glam::DVec3;

use super::sizes::SurfaceFlux;
use crate::weather::Falling;

/// Density of stones, kg/m^3.
pub const ICE_KG_M3: f64 = 900.0;
/// Sizes of pellets, mm.
pub const PELLETS_MM: (f64, f64) = (0.5, 5.0);
/// Sizes of hail, mm.
pub const HAIL_MM: (f64, f64) = (5.0, 60.0);

/// mm/h of water of stones of 1 mm, one per m^3, falling at 1 m/s.
const RATE: f64 = PI / 6.0 * 3.6e-3 * ICE_KG_M3 / 1000.0;
/// Hail of the least slope, per mm, has the most water that Cheng and English's law makes of any; more of it is more
/// stones, not larger ones. Of the steepest there is next to nothing.
const HAIL_SLOPES_PER_MM: (f64, f64) = (0.15, 3.0);
/// Density at sea level in the standard atmosphere, kg/m^3.
const SEA_LEVEL_KG_M3: f64 = 1.225;
/// Panels of Simpson's rule over the sizes of a kind.
const PANELS: usize = 96;

/// Kind of solid and nearly round precipitation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stone {
    /// Ice pellets and small hail.
    Pellet,
    /// Hail.
    Hail,
}

impl Stone {
    /// Both, in the order of their numbers.
    pub const ALL: [Self; 2] = [Self::Pellet, Self::Hail];

    /// Smallest and largest diameter, mm.
    pub fn range_mm(self) -> (f64, f64) {
        match self {
            Self::Pellet => PELLETS_MM,
            Self::Hail => HAIL_MM,
        }
    }

    /// Terminal speed, m/s, of a diameter where raindrops are `factor` times as fast as at sea level.
    pub fn speed_m_s(self, diameter_mm: f64, factor: f64) -> f64 {
        // Raindrops go with density^-0.4 (Foote and du Toit 1969).
        let density = SEA_LEVEL_KG_M3 * libm::pow(factor, -2.5);
        match self {
            Self::Pellet => sphere_speed_m_s(diameter_mm, density),
            // 11.45 sqrt(D in cm) in air of 0.993 kg/m^3 (Matson and Huggins 1980): a drag coefficient of 0.87.
            Self::Hail => 11.45 * (0.1 * diameter_mm * 0.993 / density).sqrt(),
        }
    }
}

/// Speed of a sphere of ice by its Best number: Re = (d^2 / 4) ((1 + 4 sqrt(X) / (d^2 sqrt(C)))^(1/2) - 1)^2 with d =
/// 8.0 and C = 0.35 (Heymsfield and Westbrook 2010).
fn sphere_speed_m_s(diameter_mm: f64, density: f64) -> f64 {
    const DELTA: f64 = 8.0;
    const C: f64 = 0.35;
    // Of air at 0 C, Pa s.
    const VISCOSITY: f64 = 1.72e-5;
    let d = 1e-3 * diameter_mm.max(1e-3);
    let best = 4.0 / 3.0 * ICE_KG_M3 * super::drops::GRAVITY_M_S2 * d * d * d * density / (VISCOSITY * VISCOSITY);
    let root = (1.0 + 4.0 * best.sqrt() / (DELTA * DELTA * C.sqrt())).sqrt() - 1.0;
    VISCOSITY * 0.25 * DELTA * DELTA * root * root / (density * d)
}

/// N0 exp(-lambda D) of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StoneMode {
    stone: Stone,
    /// 1/(m^3 mm).
    n0: f64,
    /// 1/mm.
    lambda: f64,
}

impl StoneMode {
    /// Integral of `f` times N over the kind's sizes.
    fn integral(&self, f: impl Fn(f64) -> f64) -> f64 {
        if self.n0 <= 0.0 {
            return 0.0;
        }
        let (low, high) = self.stone.range_mm();
        // Evenly in the logarithm of the size: D dln D.
        let step = libm::log(high / low) / PANELS as f64;
        let at = |i: usize| {
            let d = low * libm::exp(0.5 * step * i as f64);
            f(d) * libm::exp(-self.lambda * d) * d
        };
        let sum: f64 = (0..PANELS).map(|i| at(2 * i) + 4.0 * at(2 * i + 1) + at(2 * i + 2)).sum();
        self.n0 * sum * (step / 6.0)
    }

    fn rate_mm_h(&self, factor: f64) -> f64 {
        self.integral(|d| RATE * d * d * d * self.stone.speed_m_s(d, factor))
    }

    fn of(self, rate_mm_h: f64, factor: f64) -> Self {
        let unit = Self { n0: 1.0, ..self }.rate_mm_h(factor);
        Self { n0: rate_mm_h.max(0.0) / unit, ..self }
    }

    fn pellets(rate_mm_h: f64, factor: f64) -> Self {
        let swollen = libm::cbrt(1000.0 / ICE_KG_M3);
        let lambda = 4.1 / swollen * libm::pow(rate_mm_h.max(1e-6), -0.21);
        Self { stone: Stone::Pellet, n0: 0.0, lambda }.of(rate_mm_h, factor)
    }

    fn hail(rate_mm_h: f64, factor: f64) -> Self {
        let (mut low, mut high) = HAIL_SLOPES_PER_MM;
        let part = |lambda: f64| Self { stone: Stone::Hail, n0: 115.0 * libm::pow(lambda, 3.63), lambda };
        // The steeper, the less; sizes are those at sea level whatever the altitude.
        for _ in 0..40 {
            let middle = (low * high).sqrt();
            if part(middle).rate_mm_h(1.0) > rate_mm_h { low = middle } else { high = middle }
        }
        if rate_mm_h > 0.0 { part(low).of(rate_mm_h, factor) } else { Self { n0: 0.0, ..part(high) } }
    }
}

/// The stones in a cubic metre. Plain data, any thread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoneSizes {
    parts: [StoneMode; 2],
    factor: f64,
}

impl StoneSizes {
    /// Creates the sizes of what falls at the ground, where drops are `speed_factor` times as fast as at sea level
    /// ([`super::drops::altitude_factor`]). The rate holds at every altitude.
    pub fn new(falling: &Falling, speed_factor: f64) -> Self {
        Self::of_rates(falling.ice_pellets_mm_h, falling.hail_mm_h, speed_factor)
    }

    /// Creates the sizes from rates of pellets and hail, mm/h of melted water.
    pub fn of_rates(pellets_mm_h: f64, hail_mm_h: f64, speed_factor: f64) -> Self {
        let parts = [StoneMode::pellets(pellets_mm_h, speed_factor), StoneMode::hail(hail_mm_h, speed_factor)];
        Self { parts, factor: speed_factor }
    }

    fn sum(&self, f: impl Fn(&StoneMode) -> f64) -> f64 {
        self.parts.iter().map(f).sum()
    }

    /// Stones of a kind with diameters from `a_mm` to `b_mm`, 1/m^3.
    pub fn number_between(&self, stone: Stone, a_mm: f64, b_mm: f64) -> f64 {
        let (low, high) = stone.range_mm();
        let (a, b) = (a_mm.max(low), b_mm.min(high));
        let part = &self.parts[stone as usize];
        if part.n0 <= 0.0 || a >= b {
            return 0.0;
        }
        part.n0 / part.lambda * (libm::exp(-part.lambda * a) - libm::exp(-part.lambda * b))
    }

    /// Stones, 1/m^3.
    pub fn number_per_m3(&self) -> f64 {
        self.sum(|p| p.integral(|_| 1.0))
    }

    /// Ice in the air, g/m^3.
    pub fn ice_g_m3(&self) -> f64 {
        PI / 6.0 * 1e-6 * ICE_KG_M3 * self.sum(|p| p.integral(|d| d * d * d))
    }

    /// Extinction, 1/m, any visible wavelength: geometric optics, Q = 2.
    pub fn extinction_per_m(&self) -> f64 {
        PI / 2.0 * 1e-6 * self.sum(|p| p.integral(|d| d * d))
    }

    /// Mean diameter of the stones in a volume, mm; 0 without any.
    pub fn mean_diameter_mm(&self) -> f64 {
        let number = self.number_per_m3();
        if number > 0.0 { self.sum(|p| p.integral(|d| d)) / number } else { 0.0 }
    }

    /// Terminal speed of a stone here, m/s.
    pub fn speed_m_s(&self, stone: Stone, diameter_mm: f64) -> f64 {
        stone.speed_m_s(diameter_mm, self.factor)
    }

    /// Returns the flux on one side of a surface, as [`super::sizes::DropSizes::on_surface`] does for drops.
    pub fn on_surface(&self, normal: DVec3, air_m_s: DVec3) -> SurfaceFlux {
        self.on_surface_of(normal, air_m_s, |_| true)
    }

    /// As [`StoneSizes::on_surface`] of the stones whose fall speed, m/s, `comes` lets through.
    pub(crate) fn on_surface_of(&self, normal: DVec3, air_m_s: DVec3, comes: impl Fn(f64) -> bool) -> SurfaceFlux {
        let carried = air_m_s.dot(normal);
        let towards = |p: &StoneMode, d: f64| {
            let falls = p.stone.speed_m_s(d, self.factor);
            if comes(falls) { (falls * normal.z - carried).max(0.0) } else { 0.0 }
        };
        SurfaceFlux {
            drops_per_m2_s: self.sum(|p| p.integral(|d| towards(p, d))),
            rate_mm_h: self.sum(|p| p.integral(|d| RATE * d * d * d * towards(p, d))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        rain::drops::{altitude_factor, terminal_speed_m_s},
        weather::hydrometeors::{hail_extinction_per_m, ice_pellet_extinction_per_m},
    };

    const RATES: [f64; 10] = [0.01, 0.1, 0.5, 1.0, 3.0, 10.0, 30.0, 60.0, 150.0, 500.0];

    #[test]
    fn rates_close_at_any_altitude_and_no_ice_is_nothing() {
        for rate in RATES {
            for altitude in [0.0, 3000.0] {
                for (pellets, hail) in [(rate, 0.0), (0.0, rate), (0.3 * rate, 0.7 * rate)] {
                    let s = StoneSizes::of_rates(pellets, hail, altitude_factor(altitude));
                    let level = s.on_surface(DVec3::Z, DVec3::ZERO);
                    assert!((level.rate_mm_h / rate - 1.0).abs() < 1e-6, "{rate}: {level:?}");
                    // By sums over narrow classes, as they are drawn.
                    let (mut number, mut closed) = (0.0, 0.0);
                    for stone in Stone::ALL {
                        let (low, high) = stone.range_mm();
                        for i in 0..400 {
                            let edge = |i: i32| low * (high / low).powf(f64::from(i) / 400.0);
                            let (n, d) = (
                                s.number_between(stone, edge(i), edge(i + 1)),
                                edge(i) + 0.5 * (edge(i + 1) - edge(i)),
                            );
                            number += n;
                            closed += n * RATE * d.powi(3) * s.speed_m_s(stone, d);
                        }
                    }
                    assert!((number / s.number_per_m3() - 1.0).abs() < 1e-4, "{rate}: {number}");
                    assert!((closed / rate - 1.0).abs() < 2e-3, "{rate}: {closed}");
                }
            }
        }
        let none = StoneSizes::of_rates(0.0, 0.0, 1.0);
        assert_eq!((none.number_per_m3(), none.extinction_per_m(), none.mean_diameter_mm()), (0.0, 0.0, 0.0));
        assert_eq!(none.on_surface(DVec3::Z, DVec3::ZERO).rate_mm_h, 0.0);
    }

    #[test]
    fn visibility_counts_with_the_extinction_of_these_stones() {
        for i in 0..=40 {
            let rate = 0.1 * 1000f64.powf(f64::from(i) / 40.0);
            for (law, s) in [
                (ice_pellet_extinction_per_m(rate), StoneSizes::of_rates(rate, 0.0, 1.0)),
                (hail_extinction_per_m(rate), StoneSizes::of_rates(0.0, rate, 1.0)),
            ] {
                assert!((law / s.extinction_per_m() - 1.0).abs() < 0.03, "{rate}: {law} {}", s.extinction_per_m());
            }
        }
    }

    #[test]
    fn speeds_are_those_that_were_measured() {
        // Matson and Huggins: 5 to 25 mm, 1.6 km up where the air has 0.993 kg/m^3.
        let factor = libm::pow(SEA_LEVEL_KG_M3 / 0.993, 0.4);
        for (d, v) in [(5.0, 8.10), (10.0, 11.45), (25.0, 18.10)] {
            assert!((Stone::Hail.speed_m_s(d, factor) - v).abs() < 0.01, "{d}");
        }
        // A frozen drop falls nearly as fast as it fell before.
        for d in [0.5, 1.0, 2.0, 3.0] {
            let ratio = Stone::Pellet.speed_m_s(d * 1.036, 1.0) / terminal_speed_m_s(d);
            assert!((0.8..1.05).contains(&ratio), "{d} mm: {ratio}");
        }
        for stone in Stone::ALL {
            let (low, high) = stone.range_mm();
            let speeds: Vec<f64> =
                (0..=50).map(|i| stone.speed_m_s(low + (high - low) * f64::from(i) / 50.0, 1.0)).collect();
            assert!(speeds.windows(2).all(|s| s[1] > s[0]), "{speeds:?}");
        }
    }

    #[test]
    fn more_hail_is_larger_hail_and_walls_are_hit_in_wind() {
        let mean = |rate: f64| StoneSizes::of_rates(0.0, rate, 1.0).mean_diameter_mm();
        assert!(mean(0.5) < 5.8 && mean(5.0) > 6.0 && mean(30.0) > 8.0, "{} {} {}", mean(0.5), mean(5.0), mean(30.0));
        let s = StoneSizes::of_rates(2.0, 8.0, 1.0);
        let wind = DVec3::new(-12.0, 5.0, 0.0);
        let wall = s.on_surface(DVec3::X, wind);
        assert!((wall.drops_per_m2_s / (12.0 * s.number_per_m3()) - 1.0).abs() < 1e-9);
        assert_eq!(s.on_surface(-DVec3::X, wind).rate_mm_h, 0.0);
        assert!((wall.rate_mm_h / (12.0 * 3.6 * s.ice_g_m3()) - 1.0).abs() < 1e-9);
    }
}
