//! Fog and reduced visibility, drawn into the host's picture by the picture's depth.
//!
//! # Model
//! A reported visibility V is the meteorological optical range: the distance at which a black target keeps 5 % of its
//! contrast at 550 nm. The **total** extinction at the station is therefore -ln(0.05)/V = 2.996/V (Koschmieder 1924;
//! WMO-No. 8, 2018, chapter 9). A part of it is that of air and tall haze, which `src/sky` draws. This room draws the
//! rest, on a flat or a curved planet, as two media:
//!
//! * a **layer** near the ground: fog, mist or dust between a base and a soft top ([`Profile::Slab`]), or a layer that
//!   thins exponentially ([`Profile::Exponential`]);
//! * **precipitation** ([`FallingLayer`]), which falls from the clouds through the layer.
//!
//! Methods:
//!
//! * The transmittance along a ray is a closed form: path lengths between the layer's altitudes on a sphere
//!   ([`reference::layer_path`]), exact to f32.
//! * The layer and the precipitation each have their own heights and optical depth. Near the camera a share of the
//!   precipitation is drawn as drops, flakes or stones; that share is subtracted from the optical depth of the
//!   precipitation ([`reference::fog_beside_drops`]).
//! * The direct sun, the sky above and the ground below light the layer. Multiple scattering is the delta-Eddington
//!   solution (Joseph, Wiscombe and Weinman 1976) of the layer, solved per channel in f64 once a frame ([`light`]). The
//!   first scattering keeps its true phase function (Nakajima and Tanaka 1988). Both are integrated along the pixel's
//!   ray in closed form. Fog therefore conserves energy: it neither glows nor blackens. It is bright at noon, brighter
//!   toward a low sun, and dark at night. With distance, ground and sky converge to the same radiance.
//! * Patches are a sum of waves, whose mean along a ray is also a closed form ([`patterns`]). They drift with the air.
//!   Air that flows round an obstacle lags behind (`wind/detour.rs`). The stretch of a ray where patches lag is divided
//!   into eight, each with the lag at its middle.
//! * [`CompatibilityLaw`] has the fog laws of older simulators: linear, exponential or exponential squared, over the
//!   distance from the camera or from its plane.
//!
//! # Error
//! The shader agrees with [`mod@reference`] to f32. The transmittance of a layer is exact. Two errors are tested:
//!
//! * Radiance of [`mod@reference`] against adding and doubling, in haze and in droplets, for optical depths from 0.3 to
//!   16, three heights of the sun, and directions more than 8 degrees from the sun. The median error is 4.5 %, the 95th
//!   percentile 19 %; the mean over directions is within 12 % (`cargo test --test fog adding_and_doubling`).
//! * Mean of patches along a ray past an obstacle to the wind, against a fine sum. For 95 % of the rays the error is at
//!   most 1.4 % of the layer's mean density (`cargo test --lib tests::detour -- --nocapture`).
//!
//! # Cost
//! Fog is one function call in the full-screen composition (`shaders/fog/lookup.wgsl`, `fog_along`). It reads no
//! texture and no table; its only loops are over the waves of patches and curtains. It takes about 12 exponentials and
//! 12 square roots a pixel, fewer where all channels have the same extinction and albedo. On a software driver a frame
//! in patches costs as much as 25 full-screen copies of the picture, and 38 where the patches flow round obstacles
//! (`cargo bench --bench speed -- copies`).
//!
//! # Axes
//! Rays and directions are (east, north, up) at the camera, as in all of a frame.
//!
//! # Inputs
//! * [`FogLight`]: direct sun at the layer's top, sky irradiance, ground albedo.
//! * [`Viewpoint`]: altitude of the camera, planet and ground.
//! * [`FogLayer`] and [`FallingLayer`]: extinction and heights of both media. The extinction of air and haze is in
//!   neither.
//!
//! # What is not here
//! There is no `passes.rs`: the composition draws the layer, which has no pass of its own.

mod banks;
#[cfg(not(feature = "lab"))]
pub(crate) mod candidates;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod candidates;
mod curtains;
mod held;
pub mod laws;
mod layer;
pub mod light;
mod model;
mod of_weather;
mod path;
pub mod patterns;
pub mod phase;
mod preparation;
mod probe;
pub mod queries;
pub mod reference;
mod uniforms;
mod view;
mod viewpoint;
mod visibility;

pub use crate::{falling::FallingLayer, light::Phase, moment::MAX_EXTINCTION_PER_M};
pub use laws::{CompatibilityLaw, DistanceKind, cull_distance_m};
pub use layer::{FogLayer, Law, Patches, Profile};
pub use model::{FallingModel, FogKind, FogModel};
pub use probe::probe;
pub use queries::{
    Between, extinction_of_rvr_per_m, lights_range_m, runway_visual_range_m, transmittance_between,
    vertical_visibility_m, visibility_between_m,
};
pub use reference::FogSample;
pub use uniforms::FogVariant;
#[cfg(not(feature = "lab"))]
pub(crate) use uniforms::{FogUniform, LowAirUniform};
#[cfg(feature = "lab")]
#[doc(hidden)]
pub use uniforms::{FogUniform, LowAirUniform};
pub use viewpoint::{FogLight, Viewpoint};
pub use visibility::{CONTRAST_THRESHOLD, koschmieder_extinction_per_m, koschmieder_visibility_m};

pub(crate) use banks::SkyBanks;
pub(crate) use held::HeldFog;
pub(crate) use of_weather::{LowAir, LowMedia, dim};
pub(crate) use view::FogView;
