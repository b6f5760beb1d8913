//! Falling snow: flakes sized by rate, kind and temperature, each where (seed, id, time and the wind's displacement)
//! puts it.
//!
//! The model: [`flakes`] has sizes, numbers, fall speeds and the helix that a flake falls on; [`lattice`] has the
//! places: repeated cells of air that a camera sees the nearest copies of, with no state and no update; [`shape`] what
//! a near flake looks like. One quad draws a flake: its shape where it is some pixels wide and moves by less than
//! itself while the shutter is open, else a disc, or a streak, as faint as its ice is thin; below a pixel it gets
//! fainter in place of smaller. Light is that of the sky, the ground, sun or moon, and lamps, scattered as ice does
//! ([`mod@reference`]). Flakes go into the layer that all that falls shares, behind the host's depth, and not under its
//! shelters and maps.
//!
//! *Near and far*: all snow is extinction in the fog's layer; of that the veil leaves to the flakes what they hide,
//! within their reach, so neither the mean nor the visibility depends on how many are drawn.
//!
//! *Settings*: [`SnowSettings`]. *Cost*: linear in the flakes drawn, and nothing where no snow falls. *Error*:
//! [`contrast`] says what all flakes together are worth in a picture; `docs/lab` what fewer of them cost in contrast.
//!
//! Near a wind that varies in space (`SceneMoment::wind_volume`) flakes are stepped (`particles::stepping`), from where
//! the lattice has them; on devices without compute shaders they go with the weather's wind.
//!
//! No `held.rs`: flakes follow from seed and time, and those that are stepped belong to a view and are not saved.

#[cfg(not(feature = "lab"))]
pub(crate) mod candidates;
#[cfg(feature = "lab")]
#[doc(hidden)]
pub mod candidates;
pub mod contrast;
pub mod lattice;
mod passes;
pub mod reference;
mod settings;
pub mod shape;
mod stepped;
mod uniforms;
mod view;

pub use crate::falling::flakes;
pub use crate::stage::SnowReport;
pub use settings::{SnowModel, SnowSettings};

pub(crate) use contrast::FlakeContrast;
pub(crate) use view::SnowView;
