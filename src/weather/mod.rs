//! The weather as the host says it, in SI units, and what follows from it.
//!
//! [`Weather`] is what a host or a report states; [`Conditions`] is what every effect reads. Transcendental functions here
//! come from `libm` (pure Rust), never from the platform: the same weather and time then give the same bits on every machine.

mod blend;
mod conditions;
mod kinds;
mod model;
pub mod timeline;
mod validate;

pub use conditions::{
    AerosolLayer, Air, CloudLightOverride, CloudSlab, Conditions, Falling, FogLayer, LN_20, SeaState, SurfaceCover,
    WindProfile,
};
pub use kinds::{AerosolKind, CloudKind, FogKind, LoftedKind, PrecipitationKind, SurfaceState};
pub use model::{
    Aerosol, CloudLayer, Fog, Lofted, MAX_CLOUD_LAYERS, Precipitation, Sea, Surface, Swell, Weather, Wind,
    cover_from_oktas, saturation_pressure_hpa,
};
pub use timeline::Timeline;
