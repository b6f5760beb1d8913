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
//! light below 1e-7 of the sun's on the night side of the limb. Building a planet's tables takes 1.1 s on two idle cores of
//! a software driver; an observer's tables 17 ms and a picture of 640x360 32 ms there, 1/50 of a march of 64 nodes a
//! pixel (`cargo bench --bench speed`).
//!
//! # Wavelengths
//! Three by default, converted by [`spectral::Conversion`]. A set of [`SkySettings::wavelengths`] is summed while the tables
//! are built to the three transfers that look the same ([`spectral`]), so that look-ups and pixels do not know of it. Error of
//! the worst channel over the luminance against 40 wavelengths of the reference, rms over the sky (`tests/sky_gpu.rs`), sun
//! at 30, 60, 85 and 90 degrees:
//!
//! | wavelengths | clear air without ozone | with ozone | haze of 15 km visibility | tables, times those of 3 |
//! |---|---|---|---|---|
//! | 3 | 2.7, 2.7, 2.5, 3.1 % | 3.7, 4.3, 6.4, 9.6 % | 3.1, 3.5, 7.5, 11 % | 1 |
//! | 6 | 3.7, 3.2, 1.9, 1.5 % | 3.8, 3.3, 4.1, 8.4 % | 4.0, 2.8, 6.6, 10 % | 2 |
//! | 9 | 1.4, 1.2, 0.9, 0.7 % | 1.3, 1.2, 2.4, 4.8 % | 3.3, 2.1, 4.6, 5.8 % | 3 |
//! | 12 | 0.7, 0.6, 0.6, 0.4 % | 0.7, 0.6, 1.4, 2.7 % | 3.1, 2.0, 3.7, 4.0 % | 4 |
//! | 15 | 0.4, 0.4, 0.5, 0.3 % | 0.4, 0.4, 0.8, 1.1 % | 3.0, 1.9, 3.2, 3.1 % | 5 |
//!
//! What is left in haze is the tables' own error in the glow round the sun. Transmittance, and with it the disc and the
//! ground's direct light, stays that of the three wavelengths.
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
pub use uniforms::air_uniform;
pub use volume::SkyVolume;
