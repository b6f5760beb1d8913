//! Falling snow, snow grains and ice crystals: sizes, numbers and fall speeds of flakes, and their swirl.
//!
//! *Sizes*. Melted diameters Dm are distributed as N0 exp(-lambda Dm), with lambda = 2.55 R^-0.48 per mm at the rate R,
//! mm/h (Gunn and Marshall 1958, for aggregates close to the melting point). Flakes are smaller in colder air: the
//! slope of the exponential over the diameter D is 1220 x 10^(-0.0245 T) per m at T degrees C (Ryan 1996). Only the
//! ratio of this slope to that at -1 C, for which Gunn and Marshall's sizes hold, is used. A flake of density c / D has
//! the mass of its melted drop if D^2 = Dm^3 rho / c, with c = 0.17 g/cm^3 mm (Holroyd 1971) and rho = 1 g/cm^3 for
//! water. The area that flakes hide is therefore a gamma distribution of order 4 over Dm, and the area-weighted mean of
//! Dm is 4 / lambda. Flakes larger than [`LARGEST_MM`] break up.
//!
//! *Number*. The flakes have the extinction of the weather's snow (`weather::hydrometeors`). Half of it is the area
//! that their ice hides, which is the share [`AREA_RATIO`] of the area of their discs; the other half is diffraction.
//! At their fall speeds the flakes must also give the rate, and c is solved from that
//! ([`FlakeSizes::density_mm_g_cm3`]). It stays near Holroyd's value unless a reported visibility sets the extinction.
//!
//! *Speeds*. The terminal speed is a D^b m/s, D in mm: aggregates of dendrites 0.8 D^0.16, the same densely rimed
//! 0.79 D^0.27, aggregates of plates, side planes, bullets and columns 0.69 D^0.41, graupel 1.3 D^0.66 (Locatelli and
//! Hobbs 1974, table 1). Plane crystals of any size fall at 0.31 m/s (Nakaya and Terada 1935). Aggregates are densely
//! rimed at 0 C and above, of plates and columns at -5 C, where columns grow, and of dendrites at -12 C and below.
//! Between these temperatures the speed is interpolated.
//!
//! *Swirl*. Above a Reynolds number Re of 116.5 the wake of a disc loses its axial symmetry (Natarajan and Acrivos
//! 1993). The flake then glides sideways and turns, so it falls on a helix. The helix replaces the lift force by which
//! older snow systems make flakes spiral. The sideways speed grows with Re by Landau's law, (1 - 116.5 / Re)^(1/2),
//! towards [`GLIDE`] times the fall speed. This limit is a slope of 10 degrees, half of the 20 degrees that thin discs
//! in air reach (Tinklenberg, Guala and Coletti 2023). No one has measured how fast flakes turn. A rate of
//! [`TURN_STROUHAL`] v / D is chosen, with the fall speed v and the diameter D: a turn takes a few tenths of a second
//! and is some centimetres wide.

use std::f64::consts::{FRAC_PI_4, TAU};

use crate::weather::{
    Falling,
    hydrometeors::{hail_extinction_per_m, ice_pellet_extinction_per_m, snow_extinction_per_m},
};

/// Share of a flake's disc that its ice covers. `weather::hydrometeors::snow_extinction_per_m` uses the same value.
pub const AREA_RATIO: f64 = 0.6;
/// Density of aggregates times their diameter, g/cm^3 mm (Holroyd 1971).
pub const HOLROYD_MM_G_CM3: f64 = 0.17;
/// Diameter of the largest flakes, mm.
pub const LARGEST_MM: f64 = 15.0;
/// Diameters of snow grains, mm: grains are below 1 mm (WMO).
pub const GRAINS_MM: (f64, f64) = (0.2, 1.0);
/// Diameters of single crystals, mm.
pub const CRYSTALS_MM: (f64, f64) = (0.3, 3.0);
/// Reynolds number above which a flake's wake pushes it sideways.
pub const WAKE_REYNOLDS: f64 = 116.5;
/// Largest ratio of the sideways speed to the fall speed: tan 10 degrees.
pub const GLIDE: f64 = 0.176;
/// Turns of the helix while a flake falls by its own diameter.
pub const TURN_STROUHAL: f64 = 0.02;
/// Kinematic viscosity of air at 0 C, m^2/s.
const VISCOSITY_M2_S: f64 = 1.33e-5;
/// Temperature for which Gunn and Marshall's sizes hold, C.
const GUNN_MARSHALL_C: f64 = -1.0;
/// Rate, mm/h, below which sizes stay the same and only the number of flakes goes down.
const LEAST_MM_H: f64 = 0.02;

/// Kind of a flake, which decides its fall speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlakeKind {
    /// Aggregates of dendrites without rime: dry snow.
    Unrimed,
    /// Aggregates of plates, side planes, bullets and columns without rime.
    Columns,
    /// Densely rimed aggregates, which fall near the melting point.
    DenselyRimed,
    /// Graupel (snow pellets) of 0.1 to 0.2 g/cm^3. Snow grains fall as small graupel.
    Graupel,
    /// Single plane crystals.
    Crystal,
}

impl FlakeKind {
    /// All kinds with the names that programs use for them.
    pub const NAMES: [(&'static str, Self); 5] = [
        ("unrimed", Self::Unrimed),
        ("columns", Self::Columns),
        ("densely_rimed", Self::DenselyRimed),
        ("graupel", Self::Graupel),
        ("crystal", Self::Crystal),
    ];

    /// Returns the kind with this name, in which hyphens are read as underscores. `None` for an unknown name.
    pub fn from_name(name: &str) -> Option<Self> {
        let same = |known: &str| name.chars().map(|c| if c == '-' { '_' } else { c }).eq(known.chars());
        Self::NAMES.iter().find(|(known, _)| same(known)).map(|(_, kind)| *kind)
    }

    /// Returns the factor a and the exponent b of the terminal speed a D^b, m/s with D in mm.
    const fn law(self) -> (f64, f64) {
        match self {
            Self::Unrimed => (0.8, 0.16),
            Self::Columns => (0.69, 0.41),
            Self::DenselyRimed => (0.79, 0.27),
            Self::Graupel => (1.3, 0.66),
            Self::Crystal => (0.31, 0.0),
        }
    }

    /// Returns the terminal speed, m/s, of a flake of a diameter, mm; 0 for a diameter of 0.
    pub fn speed_m_s(self, diameter_mm: f64) -> f64 {
        let (a, b) = self.law();
        if diameter_mm > 0.0 { a * libm::pow(diameter_mm, b) } else { 0.0 }
    }
}

/// Returns the terminal speed of aggregates in air of a temperature, m/s: interpolated between the laws of
/// dendrites, of columns and of densely rimed dendrites.
pub fn aggregate_speed_m_s(diameter_mm: f64, temperature_c: f64) -> f64 {
    let between = |cold: FlakeKind, warm: FlakeKind, share: f64| {
        cold.speed_m_s(diameter_mm) * (1.0 - share) + warm.speed_m_s(diameter_mm) * share
    };
    if temperature_c < -5.0 {
        between(FlakeKind::Unrimed, FlakeKind::Columns, ((temperature_c + 12.0) / 7.0).max(0.0))
    } else {
        between(FlakeKind::Columns, FlakeKind::DenselyRimed, ((temperature_c + 5.0) / 5.0).min(1.0))
    }
}

/// Helix on which a flake falls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swirl {
    /// Radius of the helix, m; 0 if the flake falls straight.
    pub radius_m: f64,
    /// Turns per second.
    pub turns_per_s: f64,
}

impl Swirl {
    /// Creates the swirl of a flake from its diameter, mm, and its fall speed, m/s.
    pub fn new(diameter_mm: f64, speed_m_s: f64) -> Self {
        let d = 1e-3 * diameter_mm.max(1e-3);
        let reynolds = speed_m_s * d / VISCOSITY_M2_S;
        let turns_per_s = TURN_STROUHAL * speed_m_s / d;
        if reynolds <= WAKE_REYNOLDS {
            return Self { radius_m: 0.0, turns_per_s };
        }
        let aside = GLIDE * speed_m_s * (1.0 - WAKE_REYNOLDS / reynolds).sqrt();
        Self { radius_m: aside / (TAU * turns_per_s), turns_per_s }
    }
}

/// Flakes of one part: aggregates, grains or crystals.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FlakeMode {
    /// Extinction, 1/m.
    extinction_per_m: f64,
    /// Slope of the exponential distribution of melted diameters, 1/mm. By Holroyd's density each diameter has one
    /// melted diameter. A slope of 0 says that the hidden area is spread evenly over the logarithm of the diameter.
    lambda: f64,
    /// Smallest and largest diameter, mm.
    range_mm: (f64, f64),
}

/// Returns the cumulative gamma distribution of order 4 at `x`.
fn gamma4(x: f64) -> f64 {
    1.0 - libm::exp(-x) * (1.0 + x * (1.0 + x * (0.5 + x / 6.0)))
}

impl FlakeMode {
    /// Returns the area that the part's flakes up to a diameter hide, as a share of the area that all its flakes hide,
    /// 0 to 1.
    fn area_below(&self, diameter_mm: f64) -> f64 {
        let (low, high) = self.range_mm;
        let d = diameter_mm.clamp(low, high);
        if self.lambda <= 0.0 {
            return libm::log(d / low) / libm::log(high / low);
        }
        let below = |d: f64| gamma4(self.lambda * libm::cbrt(HOLROYD_MM_G_CM3 * d * d));
        (below(d) - below(low)) / (below(high) - below(low))
    }
}

/// Flakes in a cubic metre of air. Plain data; any thread may use it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlakeSizes {
    /// Aggregates, grains, crystals.
    parts: [FlakeMode; 3],
    /// Rate of the snow, mm/h of water.
    rate_mm_h: f64,
    /// Temperature of the air, C.
    temperature_c: f64,
    /// Ratio of fall speeds to those at sea level.
    factor: f64,
}

/// Number of parts in [`FlakeSizes`]. Part 0 is aggregates, part 1 grains, part 2 crystals.
pub const PARTS: usize = 3;

impl FlakeSizes {
    /// Creates the sizes of snow in air of a temperature. `speed_factor` is the ratio of fall speeds at this altitude
    /// to those at sea level ([`super::drops::altitude_factor`]).
    pub fn new(falling: &Falling, temperature_c: f64, speed_factor: f64) -> Self {
        let of_snow = snow_extinction_per_m(falling.snow_mm_h);
        let solid =
            of_snow + ice_pellet_extinction_per_m(falling.ice_pellets_mm_h) + hail_extinction_per_m(falling.hail_mm_h);
        let extinction = if solid > 0.0 { falling.solid_extinction_per_m * (of_snow / solid) } else { 0.0 };
        let kinds = falling.snow_kinds_mm_h();
        let share = |i: usize| if falling.snow_mm_h > 0.0 { kinds[i] / falling.snow_mm_h } else { 0.0 };
        let colder = libm::exp10(0.0245 * (temperature_c - GUNN_MARSHALL_C).clamp(-40.0, 0.0));
        // Cold divides the slope over D by `colder`. The slope over Dm is divided by the power 2/3 of `colder`, because
        // D is proportional to Dm^(3/2).
        let lambda = 2.55 * libm::pow(kinds[0].max(LEAST_MM_H), -0.48) / libm::pow(colder, 2.0 / 3.0);
        let part =
            |i: usize, lambda: f64, range_mm| FlakeMode { extinction_per_m: extinction * share(i), lambda, range_mm };
        Self {
            parts: [part(0, lambda, (0.1, LARGEST_MM)), part(1, 0.0, GRAINS_MM), part(2, 0.0, CRYSTALS_MM)],
            rate_mm_h: falling.snow_mm_h,
            temperature_c,
            factor: speed_factor,
        }
    }

    /// Returns whether there are any flakes.
    pub fn is_any(&self) -> bool {
        self.parts.iter().any(|p| p.extinction_per_m > 0.0)
    }

    /// Returns two diameters of a part, mm. The part's flakes below the first hide a hundredth of the area that the
    /// part hides, and the flakes above the second hide another hundredth.
    pub fn range_mm(&self, part: usize) -> (f64, f64) {
        (self.diameter_mm(part, 0.01), self.diameter_mm(part, 0.99))
    }

    /// Returns the diameter, mm, up to which flakes of a part hide `share` of the area that the part hides.
    pub fn diameter_mm(&self, part: usize, share: f64) -> f64 {
        let p = &self.parts[part];
        let (mut low, mut high) = p.range_mm;
        for _ in 0..50 {
            let middle = (low * high).sqrt();
            if p.area_below(middle) < share { low = middle } else { high = middle }
        }
        (low * high).sqrt()
    }

    /// Returns the area that the ice of a part's flakes between two diameters (mm) hides, m^2 per cubic metre: half of
    /// their extinction.
    pub fn area_between(&self, part: usize, a_mm: f64, b_mm: f64) -> f64 {
        let p = &self.parts[part];
        0.5 * p.extinction_per_m * (p.area_below(b_mm) - p.area_below(a_mm)).max(0.0)
    }

    /// Extinction, 1/m.
    pub fn extinction_per_m(&self) -> f64 {
        self.parts.iter().map(|p| p.extinction_per_m).sum()
    }

    /// Returns the terminal speed at this altitude of a flake of a part, m/s.
    pub fn speed_m_s(&self, part: usize, diameter_mm: f64) -> f64 {
        self.factor
            * match part {
                0 => aggregate_speed_m_s(diameter_mm, self.temperature_c),
                1 => FlakeKind::Graupel.speed_m_s(diameter_mm),
                _ => FlakeKind::Crystal.speed_m_s(diameter_mm),
            }
    }

    /// Returns the density times the diameter, c, with which the flakes give the rate, g/cm^3 mm (which is kg/m^2); 0
    /// without flakes. If the area of the discs is a (m^2 per cubic metre, of which [`AREA_RATIO`] is ice) and the
    /// flakes fall at v, the rate is (2/3) c a v.
    pub fn density_mm_g_cm3(&self) -> f64 {
        const PANELS: usize = 64;
        let mut flux = 0.0;
        for part in (0..PARTS).filter(|p| self.parts[*p].extinction_per_m > 0.0) {
            for i in 0..PANELS {
                let d = self.diameter_mm(part, (i as f64 + 0.5) / PANELS as f64);
                flux += self.speed_m_s(part, d) * 0.5 * self.parts[part].extinction_per_m / PANELS as f64;
            }
        }
        // Computes the rate in kg/(m^2 s) for c = 1 kg/m^2. A sphere of density c / D has the mass (pi/6) c D^2. Its
        // disc has the area (pi/4) D^2. The ratio of mass to area is (2/3) c.
        let of_one = flux / AREA_RATIO * (2.0 / 3.0);
        if of_one > 0.0 { self.rate_mm_h / 3600.0 / of_one } else { 0.0 }
    }
}

/// Returns the area that the ice of a flake of a diameter, mm, hides, m^2.
pub fn seen_area_m2(diameter_mm: f64) -> f64 {
    AREA_RATIO * FRAC_PI_4 * diameter_mm * diameter_mm * 1e-6
}

#[cfg(test)]
mod tests {
    use super::super::{drag::step, drops::GRAVITY_M_S2};
    use super::*;
    use crate::weather::{Precipitation, PrecipitationKind, Weather, derive};
    use glam::DVec3;

    /// Returns precipitation whose extinction follows from the rate, without a reported visibility.
    fn falling(kind: PrecipitationKind, rate: f64) -> Falling {
        let weather = Weather { precipitation: Precipitation::of(kind, rate), ..Weather::default() };
        let f = derive(&weather).unwrap().precipitation;
        Falling { solid_extinction_per_m: snow_extinction_per_m(f.snow_mm_h), ..f }
    }

    #[test]
    fn flakes_reach_their_terminal_speed_at_every_step() {
        for dt in [1e-4, 1e-3, 1e-2, 0.1, 0.25, 1.0, 10.0] {
            for (_, kind) in FlakeKind::NAMES {
                for d in [0.3, 5.0, 15.0] {
                    let terminal = kind.speed_m_s(d);
                    let mut v = DVec3::new(6.0, -2.0, 0.0);
                    let air = DVec3::new(8.0, 1.0, 0.0);
                    let steps = (60.0 * terminal / GRAVITY_M_S2 / dt).ceil().max(20.0) as usize;
                    for _ in 0..steps {
                        v = step(v, air, terminal, dt).0;
                    }
                    let off = (v - air + DVec3::Z * terminal).length() / terminal;
                    assert!(off < 1e-3, "{kind:?} of {d} mm, dt {dt}: {off}");
                }
            }
        }
    }

    #[test]
    fn flakes_hide_what_the_weathers_snow_hides_and_make_its_rate_near_holroyds_density() {
        for (rate, t) in [(0.1, -15.0), (1.0, -5.0), (1.0, 0.0), (3.0, -2.0), (5.0, 0.5)] {
            let f = falling(PrecipitationKind::Snow, rate);
            let s = FlakeSizes::new(&f, t, 1.0);
            assert!((s.extinction_per_m() / f.solid_extinction_per_m - 1.0).abs() < 1e-12);
            let n = 200;
            let edge = |i: i32| 0.1 * (LARGEST_MM / 0.1).powf(f64::from(i) / f64::from(n));
            let area: f64 = (0..n).map(|i| s.area_between(0, edge(i), edge(i + 1))).sum();
            assert!((area / (0.5 * f.solid_extinction_per_m) - 1.0).abs() < 1e-9, "{area}");
            let c = s.density_mm_g_cm3();
            assert!((0.1..0.3).contains(&c), "{rate} mm/h at {t} C: {c}");
        }
    }

    #[test]
    fn colder_snow_is_smaller_heavier_snow_is_larger_and_kinds_have_their_sizes() {
        let mean = |rate, t| FlakeSizes::new(&falling(PrecipitationKind::Snow, rate), t, 1.0).diameter_mm(0, 0.5);
        assert!(mean(1.0, -15.0) < 0.6 * mean(1.0, 0.0) && mean(3.0, 0.0) > 1.5 * mean(0.5, 0.0));
        assert!((3.0..6.0).contains(&mean(1.0, -1.0)), "{}", mean(1.0, -1.0));
        let grains = FlakeSizes::new(&falling(PrecipitationKind::SnowGrains, 0.3), -3.0, 1.0);
        assert!(grains.area_between(0, 0.0, 99.0) == 0.0 && grains.area_between(1, 0.0, 1.0) > 0.0);
        let crystals = FlakeSizes::new(&falling(PrecipitationKind::IceCrystals, 0.05), -20.0, 1.0);
        assert!(crystals.area_between(2, 0.0, 99.0) > 0.0 && crystals.speed_m_s(2, 1.0) == 0.31);
        let sleet = FlakeSizes::new(&falling(PrecipitationKind::Sleet, 2.0), 1.0, 1.0);
        assert!(sleet.is_any() && !FlakeSizes::new(&falling(PrecipitationKind::Rain, 2.0), 1.0, 1.0).is_any());
        assert!(!FlakeSizes::new(&Falling::NONE, 0.0, 1.0).is_any());
    }

    #[test]
    fn the_cold_and_the_warm_end_of_aggregates_are_the_published_laws() {
        for d in [0.5, 2.0, 8.0] {
            assert_eq!(aggregate_speed_m_s(d, -30.0), FlakeKind::Unrimed.speed_m_s(d));
            assert!((aggregate_speed_m_s(d, -5.0) - FlakeKind::Columns.speed_m_s(d)).abs() < 1e-12);
            assert_eq!(aggregate_speed_m_s(d, 1.0), FlakeKind::DenselyRimed.speed_m_s(d));
        }
        assert_eq!(FlakeKind::from_name("densely-rimed"), Some(FlakeKind::DenselyRimed));
        assert_eq!(FlakeKind::from_name("hail"), None);
    }

    #[test]
    fn small_flakes_fall_straight_and_large_ones_on_a_helix_of_some_centimetres() {
        let of = |d: f64| Swirl::new(d, aggregate_speed_m_s(d, 0.0));
        assert_eq!(of(1.0).radius_m, 0.0);
        let large = of(8.0);
        assert!((0.003..0.05).contains(&large.radius_m) && (1.0..6.0).contains(&large.turns_per_s), "{large:?}");
        let aside = TAU * large.turns_per_s * large.radius_m / aggregate_speed_m_s(8.0, 0.0);
        assert!(aside < GLIDE && aside > 0.5 * GLIDE, "{aside}");
    }
}
