//! Simulated water of level, open ground: a film, water in the pores, and water in hollows, all in mm averaged over the
//! whole ground.
//!
//! The state advances in steps that end at whole multiples of [`STEP_S`], so the result does not depend on how often a
//! caller asks for it. Each step is [`STEP_S`] long; only the first may be shorter. In a step the rain that does not
//! freeze wets the ground, pores fill, the film runs off into the hollows and away, hollows leak and overflow, and
//! everything dries by Penman's law. Each of these processes is solved over the whole step, so no step can overshoot.
//! Freezing, thawing and dew are not modelled. On the host's terrain (`terrain.rs`) each cell has film and pores by
//! these laws, and run-off collects in the hollows of the terrain.

use super::reference::{normal_density, normal_quantile, normal_share};
use crate::{
    surroundings::Meltwater,
    weather::{Conditions, SurfaceCover, saturation_pressure_hpa},
};

/// Length of a step, s.
pub const STEP_S: f64 = 10.0;

/// Capacity of the pores of the uppermost ground, mm: within the initial losses of rain on asphalt, 0.3 to 0.6 mm.
pub(crate) const PORES_MM: f64 = 0.4;
/// Time constant with which pores take up the water on them, s.
const SOAK_S: f64 = 90.0;
/// Run-off coefficient k of a film, mm^-2 s^-1: d film / dt = -k film^3 on a slope of 2 % and 5 m length. The flux per
/// metre of width is g sin(slope) / (3 nu) film^3 (Nusselt 1916), with the kinematic viscosity nu = 1.3e-6 m^2/s.
const RUN_OFF: f64 = 9.81 * 0.02 / (3.0 * 1.3e-6) / 5.0 * 1e-6;
/// Share of the run-off that flows into hollows. The rest leaves the ground.
const INTO_HOLLOWS: f64 = 0.4;
/// Root mean square depth of hollows, mm.
const HOLLOW_MM: f64 = 6.0;
/// Share of the ground under water at which the hollows overflow.
const OVERFLOW_SHARE: f64 = 0.35;
/// Leakage of standing water into the ground below, mm/h.
const LEAK_MM_H: f64 = 0.4;
/// Depth of asphalt's texture, mm. A film of the depth F, mm, covers the share 1 - exp(-F / 0.15 mm) of the ground.
const FILM_MM: f64 = 0.15;
/// Amount of water, mm, below which the rest in pores or hollows counts as none.
const LEAST_MM: f64 = 1e-4;
/// Wetness of soaked ground without a film. [`SurfaceCover::wetness`] calls this value damp.
const DAMP: f64 = 0.3;

/// Water on level, open ground.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct GroundWater {
    /// Water between and on the grains, mm.
    pub film_mm: f64,
    /// Water in the pores, mm, \[0, 0.4\].
    pub soaked_mm: f64,
    /// Water in the hollows, mm, averaged over all of the ground.
    pub hollows_mm: f64,
}

/// Liquid that reaches the ground and water that evaporates during a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forcing {
    /// Rate at which liquid reaches the ground, mm/h: rain and drizzle that do not freeze, and meltwater.
    pub liquid_mm_h: f64,
    /// Evaporation rate of open water, mm/h.
    pub evaporation_mm_h: f64,
}

impl Forcing {
    /// Creates the forcing of the conditions `c` under this sunlight on level ground, W/m^2.
    pub fn of(c: &Conditions, sunlight_w_m2: f64) -> Self {
        let f = &c.precipitation;
        let melting = if c.air.temperature_c > 0.0 { f.snow_mm_h + f.ice_pellets_mm_h + f.hail_mm_h } else { 0.0 };
        let liquid_mm_h = (f.rain_mm_h + f.drizzle_mm_h) * (1.0 - f.freezing) + melting;
        Self { liquid_mm_h, evaporation_mm_h: evaporation_mm_h(c, sunlight_w_m2) }
    }
}

impl Forcing {
    /// Returns the forcing under snow whose melting is simulated. The snow absorbs the rain that falls on it and all
    /// falling snow and ice, and releases its own run-off.
    pub(crate) fn under_snow(self, c: &Conditions, snow: Meltwater) -> Self {
        let f = &c.precipitation;
        let rain_mm_h = (f.rain_mm_h + f.drizzle_mm_h) * (1.0 - f.freezing);
        Self { liquid_mm_h: rain_mm_h * (1.0 - snow.covered) + snow.runoff_mm_h, ..self }
    }
}

/// Returns the evaporation of open water, mm/h: Penman (1948) in SI units (Shuttleworth 1993, eq. 4.2.31), with an
/// albedo of 0.08 and Penman's net long-wave loss, sigma T^4 (0.56 - 0.092 sqrt(e)) (0.1 + 0.9 n/N), W/m^2. T is the
/// air temperature, K; sigma = 5.67e-8 W/(m^2 K^4); e is the vapour pressure, mmHg; n/N is the share of clear sky.
pub fn evaporation_mm_h(c: &Conditions, sunlight_w_m2: f64) -> f64 {
    let (t, humidity) = (c.air.temperature_c, c.air.relative_humidity);
    let saturated = 0.1 * saturation_pressure_hpa(t);
    let slope = saturated * 17.62 * 243.12 / ((243.12 + t) * (243.12 + t));
    let psychrometric = 0.665e-3 * 0.1 * c.air.station_pressure_hpa;
    let vapour_mm_hg = humidity * saturated / 0.133_322;
    let kelvin2 = (t + 273.15) * (t + 273.15);
    let clear = 1.0 - c.cloud_cover();
    let long_wave = 5.67e-8 * kelvin2 * kelvin2 * (0.56 - 0.092 * vapour_mm_hg.sqrt()).max(0.0) * (0.1 + 0.9 * clear);
    // MJ per square metre and day.
    let net = (0.92 * sunlight_w_m2 - long_wave) * 0.0864;
    let wind = 6.43 * (1.0 + 0.536 * c.wind.speed_at_height_m_s(2.0));
    let deficit = saturated * (1.0 - humidity).max(0.0);
    let mm_a_day = (slope * net + psychrometric * wind * deficit) / (2.45 * (slope + psychrometric));
    (mm_a_day / 24.0).max(0.0)
}

/// Returns the water that stands in hollows, mm over all of the ground, if the share c = `covered` of it is under
/// water: [`HOLLOW_MM`] (phi(z) - z c). z is the level, the normal quantile of 1 - c, and phi the normal density.
fn hollows_mm(covered: f64) -> f64 {
    if covered <= 0.0 {
        return 0.0;
    }
    let level = normal_quantile(1.0 - covered);
    HOLLOW_MM * (normal_density(level) - level * covered)
}

/// Returns the share of the ground under water, at most [`OVERFLOW_SHARE`], if `water_mm` stands in hollows: the
/// inverse of [`hollows_mm`], by bisection of the level.
fn covered_by(water_mm: f64) -> f64 {
    if water_mm <= 0.0 {
        return 0.0;
    }
    let wanted = water_mm / HOLLOW_MM;
    let (mut low, mut high) = (-1.0, 7.0);
    for _ in 0..48 {
        let level = 0.5 * (low + high);
        let holds = normal_density(level) - level * normal_share(-level);
        if holds > wanted { low = level } else { high = level }
    }
    normal_share(-0.5 * (low + high)).min(OVERFLOW_SHARE)
}

impl GroundWater {
    /// Creates the water of a ground with this cover. A wetness above 0.965 counts as 0.965, and a share of puddles
    /// above 0.35 as 0.35.
    pub fn of_cover(cover: &SurfaceCover) -> Self {
        let film = ((cover.wetness - DAMP) / (1.0 - DAMP)).clamp(0.0, 0.95);
        Self {
            film_mm: -FILM_MM * libm::log(1.0 - film),
            soaked_mm: PORES_MM * (cover.wetness / DAMP).clamp(0.0, 1.0),
            hollows_mm: hollows_mm(cover.puddles.clamp(0.0, OVERFLOW_SHARE)),
        }
    }

    /// Returns the larger film, the larger water in pores and the larger water in hollows of the two.
    pub(crate) fn max(&self, other: &Self) -> Self {
        Self {
            film_mm: self.film_mm.max(other.film_mm),
            soaked_mm: self.soaked_mm.max(other.soaked_mm),
            hollows_mm: self.hollows_mm.max(other.hollows_mm),
        }
    }

    /// Returns the sum of all water, mm.
    pub fn total_mm(&self) -> f64 {
        self.film_mm + self.soaked_mm + self.hollows_mm
    }

    /// Returns wetness and share of puddles.
    pub fn cover(&self) -> (f64, f64) {
        (wetness_of(self.film_mm, self.soaked_mm), covered_by(self.hollows_mm))
    }

    /// Returns the state `seconds` later under this forcing.
    pub fn after(&self, forcing: &Forcing, seconds: f64) -> Self {
        let step = Step::new(forcing, seconds);
        let top = step.surface(self.film_mm, self.soaked_mm, forcing.liquid_mm_h * seconds / 3600.0);
        let hollows_mm = (self.hollows_mm + INTO_HOLLOWS * top.ran_off_mm).min(hollows_mm(OVERFLOW_SHARE));
        let left = (hollows_mm - (step.evaporated_mm + step.leaked_mm) * covered_by(hollows_mm)).max(0.0);
        // Takes a remainder below LEAST_MM for none.
        Self { film_mm: top.film_mm, soaked_mm: top.soaked_mm, hollows_mm: if left < LEAST_MM { 0.0 } else { left } }
    }
}

/// Values of a step that are the same for all cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Step {
    /// Evaporation of open water, mm.
    pub evaporated_mm: f64,
    /// Leakage of standing water into the ground below, mm.
    pub leaked_mm: f64,
    /// Share of the pores' free capacity that fills in the step.
    soaking: f64,
    /// 2 k t, with the run-off coefficient k ([`RUN_OFF`]) and the length t of the step.
    run_off: f64,
    /// Share of the water in pores that is left after the step, on ground without a film.
    drying: f64,
}

/// Film and pores after a step, and the water that left them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfaceWater {
    /// Film after the step, mm.
    pub film_mm: f64,
    /// Water in the pores after the step, mm.
    pub soaked_mm: f64,
    /// Water that ran off in the step, mm.
    pub ran_off_mm: f64,
    /// Water that evaporated in the step, mm.
    pub evaporated_mm: f64,
}

impl Step {
    /// Computes the values that are the same for all cells in a step of `seconds`.
    pub fn new(forcing: &Forcing, seconds: f64) -> Self {
        let evaporated_mm = forcing.evaporation_mm_h * seconds / 3600.0;
        Self {
            evaporated_mm,
            leaked_mm: LEAK_MM_H * seconds / 3600.0,
            soaking: 1.0 - libm::exp(-seconds / SOAK_S),
            run_off: 2.0 * RUN_OFF * seconds,
            drying: libm::exp(-evaporated_mm / PORES_MM),
        }
    }

    /// Returns the water that pores take up from a film, mm.
    fn soaked_up(&self, film_mm: f64, soaked_mm: f64) -> f64 {
        film_mm.min((PORES_MM - soaked_mm) * self.soaking)
    }

    /// Returns film and pores after the step on ground without standing water. `rain_mm` is the rain that falls in the
    /// step.
    pub fn surface(&self, film_mm: f64, soaked_mm: f64, rain_mm: f64) -> SurfaceWater {
        // Adds half of the rain before the run-off and half after it, for second-order accuracy.
        let half = 0.5 * rain_mm;
        let up = self.soaked_up(film_mm + half, soaked_mm);
        let (film, soaked) = (film_mm + half - up, soaked_mm + up);
        // Exact solution of d film / dt = -k film^3.
        let left = film / (1.0 + self.run_off * film * film).sqrt();
        let wet = left + half;
        let from_film = wet.min(self.evaporated_mm);
        // Pores lose water at a rate proportional to the water in them.
        let kept = match self.evaporated_mm - from_film {
            0.0 => soaked,
            more if more == self.evaporated_mm => soaked * self.drying,
            more => soaked * libm::exp(-more / PORES_MM),
        };
        let kept = if kept < LEAST_MM { 0.0 } else { kept };
        SurfaceWater {
            film_mm: wet - from_film,
            soaked_mm: kept,
            ran_off_mm: film - left,
            evaporated_mm: from_film + (soaked - kept),
        }
    }

    /// Returns film and pores after the step under standing water. The standing water takes all water that the pores do
    /// not.
    pub fn below_water(&self, film_mm: f64, soaked_mm: f64, rain_mm: f64) -> SurfaceWater {
        let up = self.soaked_up(film_mm + rain_mm, soaked_mm);
        SurfaceWater { film_mm: 0.0, soaked_mm: soaked_mm + up, ran_off_mm: film_mm + rain_mm - up, evaporated_mm: 0.0 }
    }
}

/// Returns the wetness, as [`SurfaceCover::wetness`], of a film of F mm over pores with S mm: 0.3 S / [`PORES_MM`] +
/// 0.7 (1 - exp(-F / [`FILM_MM`])).
pub(crate) fn wetness_of(film_mm: f64, soaked_mm: f64) -> f64 {
    DAMP * soaked_mm / PORES_MM + (1.0 - DAMP) * (1.0 - libm::exp(-film_mm / FILM_MM))
}

/// Returns the depth of water, mm, at a point of a ground under `water`: the film plus the water that stands there.
/// `hollow` is the depth of the pattern at the point, in units of its root mean square.
pub fn depth_at_mm(water: &GroundWater, hollow: f64) -> f64 {
    let covered = covered_by(water.hollows_mm);
    if covered <= 0.0 {
        return water.film_mm;
    }
    water.film_mm + HOLLOW_MM * (hollow - normal_quantile(1.0 - covered)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{Weather, derive};

    /// Returns the conditions in a wind of `wind` m/s; the humidity is from 0 to 1.
    fn conditions(temperature_c: f64, relative_humidity: f64, wind: f64) -> Conditions {
        let mut w = Weather { temperature_c, relative_humidity, ..Weather::default() };
        w.wind.speed_m_s = wind;
        derive(&w).unwrap()
    }

    /// Ground with soaked pores, a film and water in its hollows.
    const WET: GroundWater = GroundWater { film_mm: 0.8, soaked_mm: PORES_MM, hollows_mm: 0.7 };

    #[test]
    fn open_water_evaporates_as_penman_says() {
        // By hand, for 20 C, humidity 0.5, 3 m/s at 2 m, 1013.25 hPa, clear sky, 600 W/m^2: es 2.336 kPa (WMO), slope
        // 0.1445, psychrometric constant 0.0674 kPa/K, e 8.76 mmHg, long wave 5.67e-8 293.15^4 (0.56 - 0.2723) = 120.5
        // W/m^2, net 37.28 MJ/d, wind 16.77: (5.387 + 1.320) / (2.45 0.2119) = 12.92 mm/d.
        let c = conditions(20.0, 0.5, 3.0 * (10.0f64 / 0.03).ln() / (2.0f64 / 0.03).ln());
        let got = 24.0 * evaporation_mm_h(&c, 600.0);
        assert!((got / 12.92 - 1.0).abs() < 0.02, "{got}");
        let at = |t, h, u, sun| evaporation_mm_h(&conditions(t, h, u), sun);
        assert!(at(20.0, 0.5, 8.0, 300.0) > at(20.0, 0.5, 2.0, 300.0), "wind dries");
        assert!(at(20.0, 0.5, 2.0, 600.0) > at(20.0, 0.5, 2.0, 0.0), "the sun dries");
        assert!(at(20.0, 0.9, 5.0, 0.0) < at(20.0, 0.4, 5.0, 0.0), "damp air does not");
        assert_eq!(at(5.0, 1.0, 3.0, 0.0), 0.0, "nor does saturated air at night");
    }

    #[test]
    fn water_in_hollows_and_the_share_under_it_are_each_others_inverse() {
        for share in [0.01, 0.1, 0.25, 0.349] {
            assert!((covered_by(hollows_mm(share)) - share).abs() < 1e-6, "{share}: {}", covered_by(hollows_mm(share)));
        }
        assert_eq!((covered_by(0.0), hollows_mm(0.0)), (0.0, 0.0));
    }

    #[test]
    fn no_water_comes_from_nowhere() {
        let rain = Forcing { liquid_mm_h: 6.0, evaporation_mm_h: 0.1 };
        let mut water = GroundWater::default();
        for i in 1..2000 {
            let before = water;
            water = water.after(&rain, STEP_S);
            let gained = rain.liquid_mm_h * STEP_S / 3600.0;
            assert!(water.total_mm() <= before.total_mm() + gained + 1e-12, "step {i}");
            assert!(water.film_mm >= 0.0 && water.soaked_mm >= 0.0 && water.hollows_mm >= 0.0);
        }
        // Steady state at 6 mm/h: run-off equals rain, k F^3 = R.
        let film = (6.0 / 3600.0 / RUN_OFF).cbrt();
        assert!((water.film_mm / film - 1.0).abs() < 0.02, "{} {film}", water.film_mm);
        let (wetness, puddles) = water.cover();
        assert!(wetness > 0.9 && puddles > 0.3, "{wetness} {puddles}");
    }

    #[test]
    fn drying_is_monotone_and_ends() {
        let dry = Forcing { liquid_mm_h: 0.0, evaporation_mm_h: 0.4 };
        let mut water = WET;
        let mut hours = 0.0;
        while water.total_mm() > 0.0 && hours < 100.0 {
            let next = water.after(&dry, STEP_S);
            assert!(next.film_mm <= water.film_mm && next.soaked_mm <= water.soaked_mm);
            assert!(next.total_mm() < water.total_mm() && next.cover().0 <= water.cover().0);
            (water, hours) = (next, hours + STEP_S / 3600.0);
        }
        assert!((2.0..60.0).contains(&hours), "{hours} h");
    }

    #[test]
    fn a_long_step_is_stable_and_close_to_short_ones() {
        let f = Forcing { liquid_mm_h: 2.0, evaporation_mm_h: 0.2 };
        let fine = (0..3600).fold(WET, |w, _| w.after(&f, 1.0));
        let coarse = (0..360).fold(WET, |w, _| w.after(&f, STEP_S));
        assert!((fine.film_mm / coarse.film_mm - 1.0).abs() < 0.02, "{fine:?} {coarse:?}");
        assert!((fine.hollows_mm / coarse.hollows_mm - 1.0).abs() < 0.02, "{fine:?} {coarse:?}");
        let huge = WET.after(&Forcing { liquid_mm_h: 500.0, evaporation_mm_h: 2.0 }, 1e6);
        assert!(huge.total_mm().is_finite() && huge.film_mm >= 0.0 && huge.hollows_mm <= hollows_mm(OVERFLOW_SHARE));
    }

    #[test]
    fn water_of_a_reported_cover_gives_that_cover_again() {
        for (wetness, puddles) in [(0.0, 0.0), (0.3, 0.0), (0.7, 0.1), (0.95, 0.3)] {
            let cover = SurfaceCover { wetness, puddles, ice: 0.0, snow_depth_m: 0.0 };
            let (w, p) = GroundWater::of_cover(&cover).cover();
            assert!((w - wetness).abs() < 1e-6 && (p - puddles).abs() < 1e-6, "{wetness} {puddles}: {w} {p}");
        }
    }

    #[test]
    fn water_is_deepest_in_the_hollows() {
        assert_eq!(depth_at_mm(&WET, -1.0), WET.film_mm);
        assert!(depth_at_mm(&WET, 2.0) > 5.0 && depth_at_mm(&WET, 2.0) < 15.0, "{}", depth_at_mm(&WET, 2.0));
    }
}
