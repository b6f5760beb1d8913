//! The sky from below the ground's level to space: clear air with haze and ozone, lit by sun and moon.
//!
//! # What is drawn
//! [`SkyTables`] hold what depends on the planet alone: light scattered more than once, by altitude, sun angle and
//! direction, and the light on level ground. They are built by fragment passes into fp16 textures (every tier), at once or
//! by parts. [`SkyVolume`] holds what depends on an observer's altitude and the lamps' zenith angles: the sky by direction,
//! and the air in front of things. Turning the camera touches neither. Shaders look both up through
//! `shaders/sky/lookup.wgsl` (functions `sky_radiance`, `aerial`, `sky_transmittance`, `ground_radiance`, ..) and
//! `shaders/sky/disc.wgsl` (`disc_radiance`) with [`SkyVolume::bind_group`] as group 1.
//!
//! Those who show the same planet with the same settings through one [`SkyLibrary`] (all contexts of a device do) share its
//! tables and the work of building them.
//!
//! ```text
//! tables.update(&mut encoder, &planet, 1.0 / 16.0)?;          // follows a changing air by parts
//! volume.prepare(&mut encoder, &tables, &observer)?;          // draws only if altitude, sun or air changed
//! // pipelines: layouts [own, volume.layout()], constants tables.pipeline_constants()
//! pass.set_bind_group(1, volume.bind_group(), &[]);
//! ```
//!
//! # Units
//! Tables are per unit irradiance of a lamp; look-ups multiply by [`Lamp::irradiance`]. The observer's frame is level: z
//! up, x and y any two level axes, the same for directions and lamps.
//!
//! # Errors of the default
//! Against [`reference`] solved finely, over altitudes 1 m to 200 km, suns down to 95 degrees, all directions and
//! distances from 500 m (`tests/sky_gpu.rs` holds them): radiance of clear air median 0.3 %, 95th percentile 1.1 %; with
//! ozone 0.3 % and 2.2 %; in haze of 30 km visibility 0.4 % and 2.4 %. Transmittance 0.02 % where it is above 1 %. Not held:
//! light below 1e-7 of the sun's on the night side of the limb. Building a planet's tables takes 2 to 3 s on two cores of
//! a software driver; an observer's tables 17 ms and a picture of 640x360 32 ms there, 1/50 of a march of 64 nodes a
//! pixel (`cargo bench --bench speed`).
//!
//! # Models
//! [`SkyModel`] names them with their errors. Transmittance is a closed form (`columns_along` in `shaders/sky/ray.wgsl`),
//! not a table.

mod cache;
pub mod candidates;
pub mod celestial;
pub(crate) mod ephemeris;
mod kit;
pub mod light;
pub mod moon;
pub mod observer;
mod passes;
pub mod planet;
mod planet_file;
pub mod probe;
mod probe_csv;
mod recipe;
pub mod reference;
mod set;
pub mod settings;
pub mod sight;
pub mod spectral;
pub mod sun;
pub mod tables;
mod uniforms;
pub mod volume;

pub use kit::SkyLibrary;
pub use light::{LightTable, Sh9};
pub use observer::{Disc, Lamp, Observer};
pub use planet::Planet;
pub use probe_csv::probe_csv;
pub use settings::{SkyModel, SkySettings};
pub use tables::{SkyTables, TablesProgress};
pub use volume::SkyVolume;
