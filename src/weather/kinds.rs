//! Kinds of cloud, fog, precipitation and other matter that a weather report names, each with a number that never
//! changes (C hosts pass the number).

use crate::error::{Error, Result};

/// Declares a `u32` enum with public numbers, names and list of variants, so that C, files and people can name each
/// variant.
macro_rules! kinds {
    ($(#[$meta:meta])* $name:ident, $what:literal { $($(#[$vmeta:meta])* $variant:ident = $value:literal, $text:literal;)+ }) => {
        $(#[$meta])*
        #[repr(u32)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $name {
            $($(#[$vmeta])* $variant = $value,)+
        }

        impl $name {
            /// Every variant, in the order of its number.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)+];

            /// Returns the variant's name in lower case with underscores, as presets and files write it.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)+
                }
            }

            /// Returns the variant whose number is `value`.
            ///
            /// # Errors
            /// [`crate::Status::InvalidArgument`] for any other number. The message names the parameter and the
            /// accepted numbers.
            pub fn from_u32(value: u32) -> Result<Self> {
                match value {
                    $($value => Ok(Self::$variant),)+
                    _ => Err(Error::range($what, &format!("one of 0..={}", Self::ALL.len() - 1), value)),
                }
            }
        }
    };
}

kinds! {
    /// Kind of dry particles in the air. Sets the defaults of [`super::Aerosol`]'s optional fields.
    AerosolKind, "aerosol.kind" {
        /// Average continental air: soil dust, industrial particles with little soot, sulphates.
        Continental = 0, "continental";
        /// Clean continental or rural air.
        Clean = 1, "clean";
        /// Open-sea air: sea salt.
        Maritime = 2, "maritime";
        /// Urban air with soot.
        Urban = 3, "urban";
        /// Haze (METAR HZ): polluted continental air.
        Haze = 4, "haze";
        /// Lifted mineral dust (METAR DU, DS).
        Dust = 5, "dust";
        /// Lifted sand (METAR SA, SS): coarser than dust.
        Sand = 6, "sand";
        /// Smoke of burning biomass (METAR FU).
        Smoke = 7, "smoke";
        /// Volcanic ash (METAR VA).
        VolcanicAsh = 8, "volcanic_ash";
        /// Arctic air.
        Arctic = 9, "arctic";
    }
}

kinds! {
    /// Fog and mist: suspended droplets at the ground.
    FogKind, "fog.kind" {
        /// No fog is reported. The extinction that the visibility requires beyond that of clean air and precipitation
        /// is aerosol. Haze, dust, sand, smoke and volcanic ash may take all of it. Other aerosols take at most that of
        /// a visibility of 5 km (`Overrides::visibility_above_fog_m`), and the rest is mist or fog all the same.
        None = 0, "none";
        /// Mist (METAR BR): droplets, with a visibility of 1 to 5 km.
        Mist = 1, "mist";
        /// Shallow fog (METAR MIFG): lower than 2 m, with clear air above.
        Shallow = 2, "shallow";
        /// Patches of fog (METAR BCFG).
        Patches = 3, "patches";
        /// Part of the aerodrome in fog (METAR PRFG).
        Partial = 4, "partial";
        /// Fog (METAR FG): visibility below 1 km.
        Fog = 5, "fog";
        /// Freezing fog (METAR FZFG): supercooled droplets.
        Freezing = 6, "freezing";
    }
}

kinds! {
    /// Cloud genera, and towering cumulus, for which METAR has a code of its own.
    CloudKind, "clouds[].kind" {
        /// Unknown kind: `derive` chooses one by height, cover and precipitation.
        Unknown = 0, "unknown";
        /// Low grey sheet.
        Stratus = 1, "stratus";
        /// Low sheet of rounded masses.
        Stratocumulus = 2, "stratocumulus";
        /// Fair-weather cumulus.
        Cumulus = 3, "cumulus";
        /// Towering cumulus (METAR TCU).
        ToweringCumulus = 4, "towering_cumulus";
        /// Cumulonimbus (METAR CB).
        Cumulonimbus = 5, "cumulonimbus";
        /// Thick sheet that rains or snows.
        Nimbostratus = 6, "nimbostratus";
        /// Sheet of rounded masses at middle heights.
        Altocumulus = 7, "altocumulus";
        /// Grey sheet at middle heights.
        Altostratus = 8, "altostratus";
        /// High fibres of ice.
        Cirrus = 9, "cirrus";
        /// High veil of ice.
        Cirrostratus = 10, "cirrostratus";
        /// High ripples of ice.
        Cirrocumulus = 11, "cirrocumulus";
    }
}

kinds! {
    /// Kind of precipitation. Frontal (stratiform) rain is [`PrecipitationKind::Rain`]. Convective rain is
    /// [`PrecipitationKind::Rain`] with [`super::Precipitation::showers`]. Relief (orographic) rain, which has many
    /// small drops, is [`PrecipitationKind::Drizzle`] of 0.5 to 3 mm/h.
    PrecipitationKind, "precipitation.kind" {
        /// No precipitation; the rate must be 0.
        None = 0, "none";
        /// Drizzle (DZ), and relief rain: small drops.
        Drizzle = 1, "drizzle";
        /// Rain (RA): frontal, or convective with `showers`.
        Rain = 2, "rain";
        /// Snow (SN).
        Snow = 3, "snow";
        /// Rain and snow together (RASN).
        Sleet = 4, "sleet";
        /// Frozen raindrops (PL).
        IcePellets = 5, "ice_pellets";
        /// Hail of 5 mm and more (GR).
        Hail = 6, "hail";
        /// Small hail or snow pellets (GS).
        SmallHail = 7, "small_hail";
        /// Snow grains (SG): frozen drizzle.
        SnowGrains = 8, "snow_grains";
        /// Ice crystals, diamond dust (IC).
        IceCrystals = 9, "ice_crystals";
        /// Freezing drizzle (FZDZ).
        FreezingDrizzle = 10, "freezing_drizzle";
        /// Freezing rain (FZRA).
        FreezingRain = 11, "freezing_rain";
    }
}

kinds! {
    /// Kind of matter that the wind lifts from the ground.
    LoftedKind, "lofted.kind" {
        /// No lifted matter.
        None = 0, "none";
        /// Drifting snow below eye height (DRSN).
        DriftingSnow = 1, "drifting_snow";
        /// Blowing snow at and above eye height (BLSN).
        BlowingSnow = 2, "blowing_snow";
        /// Drifting dust or sand below eye height (DRDU, DRSA).
        DriftingDust = 3, "drifting_dust";
        /// Blowing dust (BLDU) or a dust storm (DS).
        BlowingDust = 4, "blowing_dust";
        /// Blowing sand (BLSA) or a sand storm (SS).
        BlowingSand = 5, "blowing_sand";
        /// Blowing spray (BLPY).
        BlowingSpray = 6, "blowing_spray";
    }
}

kinds! {
    /// State of the ground as an observer names it.
    SurfaceState, "surface.state" {
        /// Dry.
        Dry = 0, "dry";
        /// Damp: darker, without a film of water.
        Damp = 1, "damp";
        /// Wet: a shining film of water.
        Wet = 2, "wet";
        /// Standing water, puddles.
        StandingWater = 3, "standing_water";
        /// Frost.
        Frost = 4, "frost";
        /// Ice.
        Ice = 5, "ice";
        /// Lying snow; see `snow_depth_m`.
        Snow = 6, "snow";
    }
}

kinds! {
    /// Meaning of the amounts in the cloud groups of a report. National practices differ, and a report does not say
    /// which one it follows.
    CloudAmountRule, "cloud_amounts" {
        /// By the station's location indicator: [`CloudAmountRule::Sums`] in the United States and Canada, else
        /// [`CloudAmountRule::Layers`].
        ByStation = 0, "by_station";
        /// Each amount is the sky that the group's layer and all lower layers hide together (Federal Meteorological
        /// Handbook No. 1, 9.4.2 b and 9.5.2).
        Sums = 1, "sums";
        /// Each amount is the sky that the group's layer alone hides, as if there were no other cloud (WMO-No. 306, FM
        /// 15, 15.9.1.2).
        Layers = 2, "layers";
    }
}

impl PrecipitationKind {
    /// Liquid share of the precipitation's mass if the weather gives none: 1 for rain and drizzle, 0.5 for sleet, 0 for
    /// all other kinds.
    pub fn default_liquid_fraction(self) -> f64 {
        match self {
            Self::Drizzle | Self::Rain | Self::FreezingDrizzle | Self::FreezingRain => 1.0,
            Self::Sleet => 0.5,
            _ => 0.0,
        }
    }

    /// Whether the drops freeze where they land.
    pub fn is_freezing(self) -> bool {
        matches!(self, Self::FreezingDrizzle | Self::FreezingRain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers_are_dense<T: Copy + PartialEq + std::fmt::Debug>(all: &[T], read: impl Fn(u32) -> Result<T>) {
        for (i, k) in all.iter().enumerate() {
            assert_eq!(read(i as u32).unwrap(), *k);
        }
        assert!(read(all.len() as u32).is_err());
        assert!(read(u32::MAX).is_err());
    }

    #[test]
    fn every_number_names_one_kind_and_others_are_refused_by_name() {
        numbers_are_dense(AerosolKind::ALL, AerosolKind::from_u32);
        numbers_are_dense(FogKind::ALL, FogKind::from_u32);
        numbers_are_dense(CloudKind::ALL, CloudKind::from_u32);
        numbers_are_dense(PrecipitationKind::ALL, PrecipitationKind::from_u32);
        numbers_are_dense(LoftedKind::ALL, LoftedKind::from_u32);
        numbers_are_dense(SurfaceState::ALL, SurfaceState::from_u32);
        numbers_are_dense(CloudAmountRule::ALL, CloudAmountRule::from_u32);
        let e = CloudKind::from_u32(99).unwrap_err();
        assert!(e.to_string().contains("clouds[].kind") && e.to_string().contains("0..=11"), "{}", e);
    }
}
