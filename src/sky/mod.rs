//! The sky from below the ground's level to space: clear air with haze and ozone, lit by sun and moon.
//!
//! # What is drawn
//! [`SkyTables`] hold what depends on the planet alone: light scattered more than once, by altitude, sun angle and
//! direction, and the light that arrives at a point from all directions, by altitude and sun angle. Fragment passes
//! build them into fp16 textures on every kind of device, at once or in steps. [`SkyVolume`] holds what depends on an
//! observer's altitude and the lamps' zenith angles: the sky by direction, and the air in front of objects. Turning the
//! camera changes neither. Shaders read both through `shaders/sky/lookup.wgsl` (functions `sky_radiance`, `aerial`,
//! `sky_transmittance`, `ground_radiance`, ..) and `shaders/sky/disc.wgsl` (`disc_radiance`) with
//! [`SkyVolume::bind_group`] as group 1.
//!
//! All users of one [`SkyLibrary`] (all contexts of a device) that show the same planet with the same settings share
//! the planet's tables and the work of building them.
//!
//! ```text
//! tables.update(&mut encoder, &planet, 1.0 / 80.0)?;          // a draft at once, whole tables in parts
//! volume.prepare(&mut encoder, &tables, &observer)?;          // draws only if altitude, sun or air changed
//! // pipelines: layouts [own, volume.layout()], constants tables.pipeline_constants()
//! pass.set_bind_group(1, volume.bind_group(), &[]);
//! ```
//!
//! # Units
//! Tables are per unit irradiance of a lamp; look-ups multiply by [`Lamp::irradiance`]. The observer's frame is level:
//! z up, x and y any two level axes. Directions and lamps use the same frame.
//!
//! # Errors of the default
//! The radiance with the default settings is compared with [`mod@reference`] at a fine resolution. The comparison
//! covers altitudes from 1 m to 200 km, the sun down to 95 degrees from the zenith, all directions, and distances from
//! 700 m. `cargo test --test sky_gpu default_model` prints these figures and fails where they are exceeded:
//!
//! | air | median | 95th percentile | worst | worst error of a transmittance above 1 % |
//! |---|---|---|---|---|
//! | clear, without ozone | 0.3 % | 1.6 % | 80 % | 0.01 % |
//! | with ozone | 0.35 % | 1.8 % | 40 % | 0.05 % |
//! | haze of 49 km visibility | 0.35 % | 2.4 % | 80 % | 0.07 % |
//!
//! The largest error is on the night side of the limb, seen from an altitude of 200 km in the direction away from the
//! sun, which is 5 degrees below the horizon. The light there is 3e-8 of the sun's irradiance. `docs/lab` charts cost
//! and error of every model.
//!
//! # Wavelengths
//! The default is three wavelengths, converted by [`spectral::Conversion`]. With more ([`SkySettings::wavelengths`])
//! the build combines them into three values at the default wavelengths that give the same colour ([`spectral`]).
//! Look-ups and pixels therefore do not change. The cost of the tables is proportional to the number of wavelengths.
//! The error of the worst channel relative to the luminance is 6 % with 3 wavelengths and 2.4 % with 9, against 15
//! wavelengths of the reference. The error is the root mean square over the sky in Earth's air with ozone, with the sun
//! at 30, 60, 85 and 90 degrees from the zenith (`cargo test --test sky_gpu spectral_set`; the long suite checks that
//! 15 wavelengths are within 1 % of 40). Transmittance, and with it the disc and the direct light on the ground, always
//! uses the three wavelengths.
//!
//! # Models
//! [`SkyModel`] lists the models with their errors. Transmittance is a closed form (`columns_along` in
//! `shaders/sky/ray.wgsl`), not a table.
//!
//! # What is not here
//! The sky has no `held.rs`, in which other rooms keep the state of their effect: the tables follow from planet, place
//! and lights, so that there is no state to advance or to save.

mod ahead;
mod cache;
#[cfg(not(feature = "lab"))]
pub(crate) mod candidates;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod candidates;
mod course;
mod disc;
mod followed;
mod kit;
mod level;
pub mod light;
pub mod observer;
mod observer_passes;
mod observer_tables;
mod passes;
pub mod probe;
mod recipe;
pub mod reference;
mod set;
pub mod settings;
pub mod sight;
mod solved;
pub mod tables;
mod uniforms;
mod view;
pub mod volume;
mod way;

pub use crate::almanac::{celestial, moon, sun};
pub use crate::planet::{self, Planet, spectral};
#[doc(hidden)]
pub use cache::{body_of_tables, takes_tables};
pub use kit::SkyLibrary;
pub use light::{LightTable, Sh9};
pub use observer::{Disc, Lamp, Observer};
pub use settings::{SkyModel, SkySettings};
pub use tables::{SkyTables, TablesProgress};
pub use uniforms::air_uniform;
pub use volume::SkyVolume;

pub(crate) use followed::FollowedSky;
pub(crate) use solved::{Sightline, SolvedSkies, SolvedSky};
pub(crate) use tables::AirChange;
pub(crate) use view::SkyView;
