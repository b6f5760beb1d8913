//! `Falling`, the precipitation of [`super::Conditions`]: the rates of its species and their extinction, from the kind
//! and rate of a weather's precipitation, or from a saved state.

use serde::{Deserialize, Serialize};

use super::hydrometeors::{
    drizzle_extinction_per_m, hail_extinction_per_m, ice_pellet_extinction_per_m, rain_extinction_per_m,
    shower_extinction_per_m, snow_extinction_per_m,
};
use super::kinds::PrecipitationKind;
use super::mix::mix;
use super::model::Precipitation;

/// Precipitation, as rates of liquid water at the ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "SavedFalling")]
pub struct Falling {
    /// Rain, mm/h.
    pub rain_mm_h: f64,
    /// Drizzle, mm/h.
    pub drizzle_mm_h: f64,
    /// Snow, snow grains and ice crystals, mm/h of melted water.
    pub snow_mm_h: f64,
    /// Share of the snow that falls as snow grains, 0 to 1.
    pub grain_share: f64,
    /// Share of the snow that falls as ice crystals, 0 to 1. Snow that is neither grains nor crystals falls as flakes.
    pub crystal_share: f64,
    /// Ice pellets and small hail, mm/h of melted water.
    pub ice_pellets_mm_h: f64,
    /// Hail, mm/h of melted water.
    pub hail_mm_h: f64,
    /// Share of the rain and drizzle that freezes where it lands, 0 to 1.
    pub freezing: f64,
    /// How convective the precipitation is, 0 (steady) to 1 (showers).
    pub showers: f64,
    /// Presence of thunder, 0 to 1.
    pub thunder: f64,
    /// Extinction by rain and drizzle, at 550 nm, 1/m.
    pub liquid_extinction_per_m: f64,
    /// Extinction by snow, ice pellets and hail, at 550 nm, 1/m.
    pub solid_extinction_per_m: f64,
}

/// [`Falling`] as saved in states. Older states hold the sum of both extinctions.
#[derive(Deserialize)]
struct SavedFalling {
    rain_mm_h: f64,
    drizzle_mm_h: f64,
    snow_mm_h: f64,
    #[serde(default)]
    grain_share: f64,
    #[serde(default)]
    crystal_share: f64,
    ice_pellets_mm_h: f64,
    hail_mm_h: f64,
    freezing: f64,
    showers: f64,
    thunder: f64,
    liquid_extinction_per_m: Option<f64>,
    solid_extinction_per_m: Option<f64>,
    extinction_per_m: Option<f64>,
}

impl From<SavedFalling> for Falling {
    fn from(s: SavedFalling) -> Self {
        let falling = Self {
            rain_mm_h: s.rain_mm_h,
            drizzle_mm_h: s.drizzle_mm_h,
            snow_mm_h: s.snow_mm_h,
            grain_share: s.grain_share,
            crystal_share: s.crystal_share,
            ice_pellets_mm_h: s.ice_pellets_mm_h,
            hail_mm_h: s.hail_mm_h,
            freezing: s.freezing,
            showers: s.showers,
            thunder: s.thunder,
            liquid_extinction_per_m: s.liquid_extinction_per_m.unwrap_or(0.0),
            solid_extinction_per_m: s.solid_extinction_per_m.unwrap_or(0.0),
        };
        match s.extinction_per_m {
            Some(whole) => by_species(falling).with_extinction(whole),
            None => falling,
        }
    }
}

impl Falling {
    /// No precipitation.
    pub(crate) const NONE: Self = Self {
        rain_mm_h: 0.0,
        drizzle_mm_h: 0.0,
        snow_mm_h: 0.0,
        grain_share: 0.0,
        crystal_share: 0.0,
        ice_pellets_mm_h: 0.0,
        hail_mm_h: 0.0,
        freezing: 0.0,
        showers: 0.0,
        thunder: 0.0,
        liquid_extinction_per_m: 0.0,
        solid_extinction_per_m: 0.0,
    };

    /// Returns the rates of snow as flakes, as snow grains and as ice crystals, mm/h of melted water. Their sum is
    /// [`Falling::snow_mm_h`].
    pub fn snow_kinds_mm_h(&self) -> [f64; 3] {
        let [grains, crystals] = [self.grain_share, self.crystal_share].map(|share| share * self.snow_mm_h);
        [(self.snow_mm_h - grains - crystals).max(0.0), grains, crystals]
    }

    /// Returns the rate of all precipitation, mm/h of liquid water.
    pub fn total_mm_h(&self) -> f64 {
        self.rain_mm_h + self.drizzle_mm_h + self.snow_mm_h + self.ice_pellets_mm_h + self.hail_mm_h
    }

    /// Returns the extinction by all precipitation, at 550 nm, 1/m.
    pub fn extinction_per_m(&self) -> f64 {
        self.liquid_extinction_per_m + self.solid_extinction_per_m
    }

    /// Returns the precipitation with the total extinction `whole`, 1/m, of which liquid and solid keep their shares.
    /// Extinction without any species counts as solid, so that no drops are drawn for it.
    pub(crate) fn with_extinction(self, whole: f64) -> Self {
        let before = self.extinction_per_m();
        if before <= 0.0 {
            return Self { liquid_extinction_per_m: 0.0, solid_extinction_per_m: whole, ..self };
        }
        let liquid_extinction_per_m = whole * (self.liquid_extinction_per_m / before);
        Self { liquid_extinction_per_m, solid_extinction_per_m: whole - liquid_extinction_per_m, ..self }
    }
}

/// Share of the water that falls as hail if the weather has hail beside precipitation of another kind.
const HAIL_SHARE: f64 = 0.2;

/// Returns the rates of each species from the kind and rate of the precipitation. Hail beside another kind takes
/// [`HAIL_SHARE`] of the rate, and the liquid fraction divides the rest.
pub(super) fn falling(p: &Precipitation) -> Falling {
    use PrecipitationKind as K;
    let liquid = p.liquid_fraction.unwrap_or_else(|| p.kind.default_liquid_fraction());
    let hail_beside = if p.hail && p.kind != K::Hail { HAIL_SHARE * p.rate_mm_h } else { 0.0 };
    let rest = p.rate_mm_h - hail_beside;
    let (wet, frozen) = (rest * liquid, rest * (1.0 - liquid));
    let drizzle = matches!(p.kind, K::Drizzle | K::FreezingDrizzle);
    let flag = |on: bool| if on { 1.0 } else { 0.0 };
    let only = |on: bool, amount: f64| if on { amount } else { 0.0 };
    let pellets = matches!(p.kind, K::IcePellets | K::SmallHail);
    let f = Falling {
        rain_mm_h: only(!drizzle, wet),
        drizzle_mm_h: only(drizzle, wet),
        snow_mm_h: only(!pellets && p.kind != K::Hail, frozen),
        grain_share: flag(p.kind == K::SnowGrains),
        crystal_share: flag(p.kind == K::IceCrystals),
        ice_pellets_mm_h: only(pellets, frozen),
        hail_mm_h: hail_beside + only(p.kind == K::Hail, frozen),
        freezing: flag(p.kind.is_freezing()),
        showers: flag(p.showers || p.thunderstorm),
        thunder: flag(p.thunderstorm),
        liquid_extinction_per_m: 0.0,
        solid_extinction_per_m: 0.0,
    };
    by_species(f)
}

/// Returns these rates with the extinction of their drops, and of their flakes, pellets and hailstones.
pub(super) fn by_species(f: Falling) -> Falling {
    let [steady, showers] = [rain_extinction_per_m, shower_extinction_per_m].map(|law| law(f.rain_mm_h));
    Falling {
        liquid_extinction_per_m: mix(steady, showers, f.showers) + drizzle_extinction_per_m(f.drizzle_mm_h),
        solid_extinction_per_m: snow_extinction_per_m(f.snow_mm_h)
            + ice_pellet_extinction_per_m(f.ice_pellets_mm_h)
            + hail_extinction_per_m(f.hail_mm_h),
        ..f
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shower_is_as_thick_as_its_law() {
        let shower = falling(&Precipitation { showers: true, ..Precipitation::of(PrecipitationKind::Rain, 10.0) });
        assert_eq!(shower.extinction_per_m(), shower_extinction_per_m(10.0));
    }

    #[test]
    fn kinds_split_into_rates_that_keep_the_water() {
        for &kind in PrecipitationKind::ALL {
            for hail in [false, true] {
                let rate = if kind == PrecipitationKind::None { 0.0 } else { 4.0 };
                let f = falling(&Precipitation { hail, ..Precipitation::of(kind, rate) });
                assert!((f.total_mm_h() - rate).abs() < 1e-12, "{kind:?}");
                assert_eq!(f.extinction_per_m() > 0.0, rate > 0.0, "{kind:?}");
                assert_eq!(f.liquid_extinction_per_m > 0.0, f.rain_mm_h + f.drizzle_mm_h > 0.0, "{kind:?}");
            }
        }
        let sleet = falling(&Precipitation::of(PrecipitationKind::Sleet, 4.0));
        assert_eq!((sleet.rain_mm_h, sleet.snow_mm_h), (2.0, 2.0));
        let storm = falling(&Precipitation {
            hail: true,
            thunderstorm: true,
            ..Precipitation::of(PrecipitationKind::Rain, 10.0)
        });
        assert_eq!((storm.rain_mm_h, storm.hail_mm_h, storm.thunder, storm.showers), (8.0, 2.0, 1.0, 1.0));
    }
}
