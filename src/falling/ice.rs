//! Falling ice, hail and pellets: number of stones by size, fall speed, extinction, and flux onto surfaces.
//!
//! Pellets are frozen raindrops. Their sizes are Marshall and Palmer's (1948) for the same water, enlarged by freezing,
//! from 0.5 to 5 mm. They fall like spheres (Heymsfield and Westbrook 2010). Small hail counts as pellets. Hail has an
//! exponential size distribution from 5 to 60 mm with N0 = 115 lambda^3.63 (Cheng and English 1983), so that the rate
//! alone determines the sizes. Hail falls as Matson and Huggins (1980) measured from photographs. The distributions are
//! normalised: the flux that falls equals the rate. Diameters are in mm, of spheres of ice.

use std::f64::consts::PI;

use glam::DVec3;

use super::sizes::SurfaceFlux;
use crate::weather::Falling;

/// Density of stones, kg/m^3.
pub const ICE_KG_M3: f64 = 900.0;
/// Smallest and largest pellet, mm.
pub const PELLETS_MM: (f64, f64) = (0.5, 5.0);
/// Smallest and largest hailstone, mm.
pub const HAIL_MM: (f64, f64) = (5.0, 60.0);

/// Rate of melted water, mm/h, from one stone of 1 mm per m^3 that falls at 1 m/s.
const RATE: f64 = PI / 6.0 * 3.6e-3 * ICE_KG_M3 / 1000.0;
/// Smallest and largest slope of hail's size distribution, 1/mm. The smallest slope gives the most water that Cheng and
/// English's law can give. At a higher rate there are more stones, not larger ones. The largest slope gives almost no
/// water.
const HAIL_SLOPES_PER_MM: (f64, f64) = (0.15, 3.0);
/// Density of the standard atmosphere at sea level, kg/m^3.
const SEA_LEVEL_KG_M3: f64 = 1.225;
/// Number of panels of Simpson's rule in an integral over the sizes of a kind.
const PANELS: usize = 96;

/// Kind of solid, nearly spherical precipitation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stone {
    /// Ice pellets and small hail.
    Pellet,
    /// Hail.
    Hail,
}

impl Stone {
    /// Both kinds, in the order of their discriminants.
    pub const ALL: [Self; 2] = [Self::Pellet, Self::Hail];

    /// Returns the smallest and the largest diameter, mm.
    pub fn range_mm(self) -> (f64, f64) {
        match self {
            Self::Pellet => PELLETS_MM,
            Self::Hail => HAIL_MM,
        }
    }

    /// Returns the terminal speed, m/s, of a stone of this kind. `factor` is the ratio of the speed of raindrops in the
    /// same air to that at sea level.
    pub fn speed_m_s(self, diameter_mm: f64, factor: f64) -> f64 {
        // Computes the air's density from the speed of raindrops, which is proportional to density^-0.4 (Foote and du
        // Toit 1969).
        let density = SEA_LEVEL_KG_M3 * libm::pow(factor, -2.5);
        match self {
            Self::Pellet => sphere_speed_m_s(diameter_mm, density),
            // 11.45 sqrt(D in cm) in air of 0.993 kg/m^3 (Matson and Huggins 1980): a drag coefficient of 0.87.
            Self::Hail => 11.45 * (0.1 * diameter_mm * 0.993 / density).sqrt(),
        }
    }
}

/// Returns the speed of a sphere of ice, m/s, in air of a density, kg/m^3. It follows from the Reynolds number Re as a
/// function of the Best number X (drag coefficient times Re^2): Re = (delta^2 / 4) ((1 + 4 sqrt(X) / (delta^2
/// sqrt(C)))^(1/2) - 1)^2 with delta = 8.0 and C = 0.35 (Heymsfield and Westbrook 2010).
fn sphere_speed_m_s(diameter_mm: f64, density: f64) -> f64 {
    const DELTA: f64 = 8.0;
    const C: f64 = 0.35;
    // Viscosity of air at 0 C, Pa s.
    const VISCOSITY: f64 = 1.72e-5;
    let d = 1e-3 * diameter_mm.max(1e-3);
    let best = 4.0 / 3.0 * ICE_KG_M3 * super::drops::GRAVITY_M_S2 * d * d * d * density / (VISCOSITY * VISCOSITY);
    let root = (1.0 + 4.0 * best.sqrt() / (DELTA * DELTA * C.sqrt())).sqrt() - 1.0;
    VISCOSITY * 0.25 * DELTA * DELTA * root * root / (density * d)
}

/// Size distribution N0 exp(-lambda D) of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StoneMode {
    /// Kind of stone.
    stone: Stone,
    /// N0, 1/(m^3 mm).
    n0: f64,
    /// Slope lambda, 1/mm.
    lambda: f64,
}

impl StoneMode {
    /// Returns the integral of `f` times the size distribution over the sizes of the kind.
    fn integral(&self, f: impl Fn(f64) -> f64) -> f64 {
        if self.n0 <= 0.0 {
            return 0.0;
        }
        let (low, high) = self.stone.range_mm();
        // Panels are equal in the logarithm of the size: dD = D dln D.
        let step = libm::log(high / low) / PANELS as f64;
        let at = |i: usize| {
            let d = low * libm::exp(0.5 * step * i as f64);
            f(d) * libm::exp(-self.lambda * d) * d
        };
        let sum: f64 = (0..PANELS).map(|i| at(2 * i) + 4.0 * at(2 * i + 1) + at(2 * i + 2)).sum();
        self.n0 * sum * (step / 6.0)
    }

    /// Returns the rate of melted water that the stones give, mm/h.
    fn rate_mm_h(&self, factor: f64) -> f64 {
        self.integral(|d| RATE * d * d * d * self.stone.speed_m_s(d, factor))
    }

    /// Returns the distribution with the N0 that gives this rate.
    fn of(self, rate_mm_h: f64, factor: f64) -> Self {
        let unit = Self { n0: 1.0, ..self }.rate_mm_h(factor);
        Self { n0: rate_mm_h.max(0.0) / unit, ..self }
    }

    /// Creates the distribution of pellets: Marshall and Palmer's, with diameters enlarged by freezing.
    fn pellets(rate_mm_h: f64, factor: f64) -> Self {
        let swollen = libm::cbrt(1000.0 / ICE_KG_M3);
        let lambda = 4.1 / swollen * libm::pow(rate_mm_h.max(1e-6), -0.21);
        Self { stone: Stone::Pellet, n0: 0.0, lambda }.of(rate_mm_h, factor)
    }

    /// Creates the distribution of hail, whose slope follows from the rate.
    fn hail(rate_mm_h: f64, factor: f64) -> Self {
        let (mut low, mut high) = HAIL_SLOPES_PER_MM;
        let part = |lambda: f64| Self { stone: Stone::Hail, n0: 115.0 * libm::pow(lambda, 3.63), lambda };
        // Bisects for the slope: the steeper it is, the lower the rate. The rate is that at sea level, so that sizes do
        // not depend on altitude.
        for _ in 0..40 {
            let middle = (low * high).sqrt();
            if part(middle).rate_mm_h(1.0) > rate_mm_h { low = middle } else { high = middle }
        }
        if rate_mm_h > 0.0 { part(low).of(rate_mm_h, factor) } else { Self { n0: 0.0, ..part(high) } }
    }
}

/// Size distribution of the stones in a cubic metre of air. Plain data, for any thread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoneSizes {
    /// Distributions of pellets and of hail.
    parts: [StoneMode; 2],
    /// Ratio of the speed of raindrops in the same air to that at sea level.
    factor: f64,
}

impl StoneSizes {
    /// Creates the size distribution of the stones in `falling`, at an altitude where drops fall `speed_factor` times
    /// as fast as at sea level ([`super::drops::altitude_factor`]). The rate is the same at every altitude.
    pub fn new(falling: &Falling, speed_factor: f64) -> Self {
        Self::of_rates(falling.ice_pellets_mm_h, falling.hail_mm_h, speed_factor)
    }

    /// Creates the size distribution from the rates of pellets and hail, mm/h of melted water.
    pub fn of_rates(pellets_mm_h: f64, hail_mm_h: f64, speed_factor: f64) -> Self {
        let parts = [StoneMode::pellets(pellets_mm_h, speed_factor), StoneMode::hail(hail_mm_h, speed_factor)];
        Self { parts, factor: speed_factor }
    }

    /// Returns the sum of `f` over the parts.
    fn sum(&self, f: impl Fn(&StoneMode) -> f64) -> f64 {
        self.parts.iter().map(f).sum()
    }

    /// Returns the number of stones of a kind with diameters from `a_mm` to `b_mm`, 1/m^3.
    pub fn number_between(&self, stone: Stone, a_mm: f64, b_mm: f64) -> f64 {
        let (low, high) = stone.range_mm();
        let (a, b) = (a_mm.max(low), b_mm.min(high));
        let part = &self.parts[stone as usize];
        if part.n0 <= 0.0 || a >= b {
            return 0.0;
        }
        part.n0 / part.lambda * (libm::exp(-part.lambda * a) - libm::exp(-part.lambda * b))
    }

    /// Returns the number of stones, 1/m^3.
    pub fn number_per_m3(&self) -> f64 {
        self.sum(|p| p.integral(|_| 1.0))
    }

    /// Returns the mass of ice in the air, g/m^3.
    pub fn ice_g_m3(&self) -> f64 {
        PI / 6.0 * 1e-6 * ICE_KG_M3 * self.sum(|p| p.integral(|d| d * d * d))
    }

    /// Returns the extinction at any visible wavelength, 1/m (geometric optics: extinction efficiency 2).
    pub fn extinction_per_m(&self) -> f64 {
        PI / 2.0 * 1e-6 * self.sum(|p| p.integral(|d| d * d))
    }

    /// Returns the mean diameter of the stones in a volume of air, mm; 0 without stones.
    pub fn mean_diameter_mm(&self) -> f64 {
        let number = self.number_per_m3();
        if number > 0.0 { self.sum(|p| p.integral(|d| d)) / number } else { 0.0 }
    }

    /// Returns the terminal speed of a stone in this air, m/s.
    pub fn speed_m_s(&self, stone: Stone, diameter_mm: f64) -> f64 {
        stone.speed_m_s(diameter_mm, self.factor)
    }

    /// Returns the flux onto the front of a surface. `normal` is the unit vector out of that front (east, north, up);
    /// `air_m_s` is the velocity of the air relative to the surface. Stones that come from behind the surface are not
    /// included.
    pub fn on_surface(&self, normal: DVec3, air_m_s: DVec3) -> SurfaceFlux {
        self.on_surface_of(normal, air_m_s, |_| true)
    }

    /// Returns the flux of [`StoneSizes::on_surface`], but only of the stones whose fall speed, m/s, satisfies `comes`.
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

    /// Precipitation rates of the tests, mm/h.
    const RATES: [f64; 10] = [0.01, 0.1, 0.5, 1.0, 3.0, 10.0, 30.0, 60.0, 150.0, 500.0];

    #[test]
    fn rates_close_at_any_altitude_and_no_ice_is_nothing() {
        for rate in RATES {
            for altitude in [0.0, 3000.0] {
                for (pellets, hail) in [(rate, 0.0), (0.0, rate), (0.3 * rate, 0.7 * rate)] {
                    let s = StoneSizes::of_rates(pellets, hail, altitude_factor(altitude));
                    let level = s.on_surface(DVec3::Z, DVec3::ZERO);
                    assert!((level.rate_mm_h / rate - 1.0).abs() < 1e-6, "{rate}: {level:?}");
                    // Sums over narrow size classes, as they are drawn.
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
        // Matson and Huggins: stones of 5 to 25 mm at an altitude of 1.6 km, where the air has 0.993 kg/m^3.
        let factor = libm::pow(SEA_LEVEL_KG_M3 / 0.993, 0.4);
        for (d, v) in [(5.0, 8.10), (10.0, 11.45), (25.0, 18.10)] {
            assert!((Stone::Hail.speed_m_s(d, factor) - v).abs() < 0.01, "{d}");
        }
        // A frozen drop falls nearly as fast as it did when liquid.
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
