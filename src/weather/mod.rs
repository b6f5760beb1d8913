//! The weather as the host states it, in SI units, and the physical conditions derived from it.
//!
//! [`Weather`] is what a host or a report states; [`derive()`] turns it into [`Conditions`], which every effect reads.
//! Transcendental functions here come from `libm` (pure Rust), never from the platform, so that the same weather and
//! time give the same bits on every machine.

pub mod air;
mod aloft;
mod blend;
mod cloud_light;
mod cloud_map;
mod cloud_part;
mod cloud_slabs;
mod conditions;
mod derive;
mod height_air;
pub mod hydrometeors;
mod kinds;
pub mod lifting;
mod metar;
mod mix;
mod model;
mod nearness;
mod overrides;
mod particles;
mod parts;
mod precipitation;
mod presets;
mod surface;
pub mod timeline;
mod validate;

pub use cloud_light::CloudLight;
pub(crate) use cloud_light::{LAND_ALBEDO, ONSET_M};
pub use cloud_map::{CloudMap, MAX_CLOUD_MAP_CELLS};
pub use cloud_part::{slab_diffuse_reflectance, slab_reflectance};
pub use cloud_slabs::{cloud_optical_depth, water_path_for_rate_kg_m2};
pub use conditions::{
    AerosolLayer, Air, CloudLightOverride, CloudSlab, Conditions, GroundLayer, LN_20, SeaState, SurfaceCover,
    WindProfile,
};
pub use derive::{derive, derive_with};
pub use height_air::AirAtHeight;
pub use kinds::{AerosolKind, CloudAmountRule, CloudKind, FogKind, LoftedKind, PrecipitationKind, SurfaceState};
pub use metar::{ASSUMED_FIELDS, MAX_METAR_BYTES, MetarOptions, MetarPlaces, MetarReport, RunwayVisualRange};
pub use model::{
    Aerosol, CloudLayer, Fog, LayerWind, Lofted, MAX_CLOUD_LAYERS, Precipitation, Sea, Surface, Swell, Weather, Wind,
    cover_from_oktas, saturation_pressure_hpa,
};
pub use overrides::Overrides;
pub use particles::{humidity_growth, unlimited_visibility_m};
pub use parts::WeatherParts;
pub use precipitation::Falling;
pub(crate) use surface::cover_under_rain;
pub use surface::{
    fully_developed_wave_height_m, sea_roughness_length_m, snow_cover, wave_height_of_state_m, wetness_from_rain,
};
pub use timeline::Timeline;
