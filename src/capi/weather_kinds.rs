//! Kinds of weather
//!
//! These constants are the kinds of weather that a report names with words. Their numbers never change.

/// Kind of the air's dry particles.
pub type wk_aerosol_kind = u32;
/// Average continental air: soil, soot-poor industry, sulphates.
pub const WK_AEROSOL_CONTINENTAL: wk_aerosol_kind = 0;
/// Clean continental or rural air.
pub const WK_AEROSOL_CLEAN: wk_aerosol_kind = 1;
/// Open-sea air: sea salt.
pub const WK_AEROSOL_MARITIME: wk_aerosol_kind = 2;
/// Urban air with soot.
pub const WK_AEROSOL_URBAN: wk_aerosol_kind = 3;
/// Haze (METAR HZ): polluted continental air.
pub const WK_AEROSOL_HAZE: wk_aerosol_kind = 4;
/// Lifted mineral dust (METAR DU, DS).
pub const WK_AEROSOL_DUST: wk_aerosol_kind = 5;
/// Lifted sand (METAR SA, SS): coarser than dust.
pub const WK_AEROSOL_SAND: wk_aerosol_kind = 6;
/// Smoke of burning biomass (METAR FU).
pub const WK_AEROSOL_SMOKE: wk_aerosol_kind = 7;
/// Volcanic ash (METAR VA).
pub const WK_AEROSOL_VOLCANIC_ASH: wk_aerosol_kind = 8;
/// Arctic air.
pub const WK_AEROSOL_ARCTIC: wk_aerosol_kind = 9;

/// Fog and mist: suspended droplets at the ground.
pub type wk_fog_kind = u32;
/// No fog is reported. The extinction that visibility_m requires beyond that of clean air and precipitation is aerosol.
/// Haze, dust, sand, smoke and ash may take all of it. Other aerosols take at most that of a visibility of 5 km
/// (wk_weather_overrides.visibility_above_fog_m), and the rest is mist or fog all the same.
pub const WK_FOG_NONE: wk_fog_kind = 0;
/// Mist (METAR BR): droplets, visibility 1 to 5 km.
pub const WK_FOG_MIST: wk_fog_kind = 1;
/// Shallow fog (METAR MIFG): fog up to 2 m high, clear above.
pub const WK_FOG_SHALLOW: wk_fog_kind = 2;
/// Patches of fog (METAR BCFG).
pub const WK_FOG_PATCHES: wk_fog_kind = 3;
/// Part of the aerodrome in fog (METAR PRFG).
pub const WK_FOG_PARTIAL: wk_fog_kind = 4;
/// Fog (METAR FG): visibility below 1 km.
pub const WK_FOG_FOG: wk_fog_kind = 5;
/// Freezing fog (METAR FZFG): supercooled droplets.
pub const WK_FOG_FREEZING: wk_fog_kind = 6;

/// Cloud genera, and the two kinds that METAR names.
pub type wk_cloud_kind = u32;
/// Not known: Welkin chooses by height, cover and precipitation.
pub const WK_CLOUD_UNKNOWN: wk_cloud_kind = 0;
/// Low grey sheet.
pub const WK_CLOUD_STRATUS: wk_cloud_kind = 1;
/// Low lumpy sheet.
pub const WK_CLOUD_STRATOCUMULUS: wk_cloud_kind = 2;
/// Fair-weather heaps.
pub const WK_CLOUD_CUMULUS: wk_cloud_kind = 3;
/// Towering cumulus (METAR TCU).
pub const WK_CLOUD_TOWERING_CUMULUS: wk_cloud_kind = 4;
/// Cumulonimbus (METAR CB).
pub const WK_CLOUD_CUMULONIMBUS: wk_cloud_kind = 5;
/// Thick sheet that rains or snows.
pub const WK_CLOUD_NIMBOSTRATUS: wk_cloud_kind = 6;
/// Middle lumpy sheet.
pub const WK_CLOUD_ALTOCUMULUS: wk_cloud_kind = 7;
/// Middle grey sheet.
pub const WK_CLOUD_ALTOSTRATUS: wk_cloud_kind = 8;
/// High fibres of ice.
pub const WK_CLOUD_CIRRUS: wk_cloud_kind = 9;
/// High veil of ice.
pub const WK_CLOUD_CIRROSTRATUS: wk_cloud_kind = 10;
/// High ripples of ice.
pub const WK_CLOUD_CIRROCUMULUS: wk_cloud_kind = 11;

/// Kind of precipitation. Choose RAIN for frontal (stratiform) rain, usually 1 to 10 mm/h, and RAIN with
/// WK_PRECIPITATION_SHOWERS for convective rain, 10 to 100 mm/h. Choose DRIZZLE for relief (orographic) rain, which has
/// many small drops, 0.5 to 3 mm/h, and for drizzle, 0.1 to 1 mm/h. docs/rain.md has the drop sizes of each type.
pub type wk_precipitation_kind = u32;
/// Nothing falls; the rate must be 0.
pub const WK_PRECIPITATION_NONE: wk_precipitation_kind = 0;
/// Drizzle (DZ), and relief rain: small drops.
pub const WK_PRECIPITATION_DRIZZLE: wk_precipitation_kind = 1;
/// Rain (RA): frontal, or convective with WK_PRECIPITATION_SHOWERS.
pub const WK_PRECIPITATION_RAIN: wk_precipitation_kind = 2;
/// Snow (SN).
pub const WK_PRECIPITATION_SNOW: wk_precipitation_kind = 3;
/// Rain and snow together (RASN).
pub const WK_PRECIPITATION_SLEET: wk_precipitation_kind = 4;
/// Frozen raindrops (PL).
pub const WK_PRECIPITATION_ICE_PELLETS: wk_precipitation_kind = 5;
/// Hail of 5 mm and more (GR).
pub const WK_PRECIPITATION_HAIL: wk_precipitation_kind = 6;
/// Small hail or snow pellets (GS).
pub const WK_PRECIPITATION_SMALL_HAIL: wk_precipitation_kind = 7;
/// Snow grains (SG): frozen drizzle.
pub const WK_PRECIPITATION_SNOW_GRAINS: wk_precipitation_kind = 8;
/// Ice crystals, diamond dust (IC).
pub const WK_PRECIPITATION_ICE_CRYSTALS: wk_precipitation_kind = 9;
/// Freezing drizzle (FZDZ).
pub const WK_PRECIPITATION_FREEZING_DRIZZLE: wk_precipitation_kind = 10;
/// Freezing rain (FZRA).
pub const WK_PRECIPITATION_FREEZING_RAIN: wk_precipitation_kind = 11;

/// Kind of matter that the wind lifts from the ground.
pub type wk_lofted_kind = u32;
/// Nothing.
pub const WK_LOFTED_NONE: wk_lofted_kind = 0;
/// Drifting snow below eye height (DRSN).
pub const WK_LOFTED_DRIFTING_SNOW: wk_lofted_kind = 1;
/// Blowing snow at and above eye height (BLSN).
pub const WK_LOFTED_BLOWING_SNOW: wk_lofted_kind = 2;
/// Drifting dust or sand below eye height (DRDU, DRSA).
pub const WK_LOFTED_DRIFTING_DUST: wk_lofted_kind = 3;
/// Blowing dust (BLDU) or a dust storm (DS).
pub const WK_LOFTED_BLOWING_DUST: wk_lofted_kind = 4;
/// Blowing sand (BLSA) or a sand storm (SS).
pub const WK_LOFTED_BLOWING_SAND: wk_lofted_kind = 5;
/// Blowing spray (BLPY).
pub const WK_LOFTED_BLOWING_SPRAY: wk_lofted_kind = 6;

/// State of the ground as an observer names it.
pub type wk_surface_state = u32;
/// Dry.
pub const WK_SURFACE_DRY: wk_surface_state = 0;
/// Damp: darker, no film.
pub const WK_SURFACE_DAMP: wk_surface_state = 1;
/// Wet: a film that shines.
pub const WK_SURFACE_WET: wk_surface_state = 2;
/// Standing water, puddles.
pub const WK_SURFACE_STANDING_WATER: wk_surface_state = 3;
/// Frost.
pub const WK_SURFACE_FROST: wk_surface_state = 4;
/// Ice.
pub const WK_SURFACE_ICE: wk_surface_state = 5;
/// Lying snow; see surface_snow_depth_m.
pub const WK_SURFACE_SNOW: wk_surface_state = 6;

#[cfg(test)]
mod tests {
    use crate::{
        capi::boundary::layout::{self, EnumInfo},
        weather::{AerosolKind, CloudKind, FogKind, LoftedKind, PrecipitationKind, SurfaceState},
    };

    fn agree(info: &EnumInfo, prefix: &str, rust: &[(u32, &str)]) {
        assert_eq!(info.values.len(), rust.len(), "{}", info.name);
        for ((c_name, c_value), (value, name)) in info.values.iter().zip(rust) {
            assert_eq!((*c_name, *c_value), (format!("{prefix}{}", name.to_uppercase()).as_str(), u64::from(*value)));
        }
    }

    #[test]
    fn every_kind_has_its_constant() {
        macro_rules! list {
            ($t:ty) => {
                <$t>::ALL.iter().map(|k| (*k as u32, k.name())).collect::<Vec<_>>()
            };
        }
        agree(&layout::WK_AEROSOL_KIND, "WK_AEROSOL_", &list!(AerosolKind));
        agree(&layout::WK_FOG_KIND, "WK_FOG_", &list!(FogKind));
        agree(&layout::WK_CLOUD_KIND, "WK_CLOUD_", &list!(CloudKind));
        agree(&layout::WK_PRECIPITATION_KIND, "WK_PRECIPITATION_", &list!(PrecipitationKind));
        agree(&layout::WK_LOFTED_KIND, "WK_LOFTED_", &list!(LoftedKind));
        agree(&layout::WK_SURFACE_STATE, "WK_SURFACE_", &list!(SurfaceState));
    }
}
