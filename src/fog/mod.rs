//! Visibility and fog drawn into the host's picture from its depth.
//!
//! # Model
//! A reported visibility V is the meteorological optical range: the distance at which a black target keeps 5 % of its
//! contrast at 550 nm, so the **total** extinction at the station is -ln(0.05)/V = 2.996/V (Koschmieder 1924; WMO-No.
//! 8, 2018, chapter 9). Air and tall haze have their own room; what they leave is a **layer** near the ground: fog or
//! mist between a base and a soft top ([`Profile::Slab`]), or thinning exponentially ([`Profile::Exponential`]), and
//! what **falls** through it from the clouds ([`FallingLayer`]), on a flat or curved planet.
//!
//! * Transmittance along a ray is closed form: path lengths between the layer's altitudes on a sphere
//!   ([`reference::layer_path`]), exact to f32.
//! * Fog and what falls have heights and an optical depth of their own. What is drawn as drops, flakes or stones near
//!   the camera is left out of the latter ([`reference::fog_beside_drops`]).
//! * Light: the layer is lit by the direct sun and the sky above and the ground below. Multiple scattering is the
//!   delta-Eddington solution (Joseph, Wiscombe and Weinman 1976) of the layer, solved per channel in f64 once a frame
//!   ([`light`]); the first scattering keeps its true phase function (Nakajima and Tanaka 1988). Both are integrated
//!   along the pixel's ray in closed form. So fog conserves energy: it neither glows nor blackens, is bright at noon,
//!   brighter toward a low sun, dark at night, and everything far away converges to the same radiance, ground or sky.
//! * Patches are waves whose mean along a ray is closed form too ([`patterns`]). They go with the air; where the wind
//!   goes round something, a ray over that place takes the lag of the air there in eight parts (`wind/detour.rs`).
//! * The compatibility laws of older simulators (linear, exponential, exponential squared, on range or plane
//!   distance) are [`CompatibilityLaw`].
//!
//! # Error
//! The shader follows [`mod@reference`] to f32. The light of [`mod@reference`] itself, against adding and doubling over
//! optical depths from 0.3 to 16 and three heights of the sun, more than 8 degrees from the sun: median 4.5 %, 95th
//! percentile 19 %, the mean over directions within 12 %, in haze and in droplets
//! (`cargo test --test fog adding_and_doubling`). A layer's transmittance is exact. The mean of led patches along a ray
//! is within 1.4 % of the layer's mean density of a fine sum at p95 (`cargo test --lib tests::detour -- --nocapture`).
//!
//! # Cost
//! One function call in the full-screen composition (`shaders/fog/lookup.wgsl`, `fog_along`): no loop, no texture, no
//! table; about 12 exponentials and 12 square roots a pixel, fewer where light is neutral. On a software driver a frame
//! in patches takes 25 copies of a picture, and 38 where the wind leads them (`cargo bench --bench speed -- copies`).
//!
//! # Axes
//! Rays and directions are (east, north, up) at the camera, as everywhere in a frame.
//!
//! # What it needs of others
//! [`FogLight`]: direct sun at the layer's top, sky irradiance, ground albedo. [`Viewpoint`]: altitude of the
//! camera, planet and ground. Extinctions of air, haze and what falls, by species, at the station.
//!
//! # What is not here
//! No `passes.rs`: the composition draws the layer, which has no pass of its own.

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

pub(crate) use held::HeldFog;
pub(crate) use of_weather::{LowAir, dim};
pub(crate) use view::FogView;
