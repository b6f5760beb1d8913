//! Falling snow near the camera, flake by flake. Rate, kind and temperature set the sizes of flakes; the place of each
//! flake is a function of (seed, id, time) and the wind's displacement.
//!
//! The model: [`flakes`] has sizes, numbers and fall speeds, and the helix on which a flake falls. [`lattice`] has the
//! places: cells of air that repeat in all directions. Each flake is drawn at the copy nearest to the camera; no state
//! is kept or updated. [`shape`] has the look of a near flake. One quad draws a flake. A flake that is some pixels wide
//! and moves by less than its own width during the exposure shows its shape. Other flakes are discs or streaks, whose
//! opacity is their share of ice. A flake smaller than a pixel gets fainter instead of smaller. Flakes are lit by the
//! sky, the ground, the sun or moon and lamps, with the phase function of ice ([`mod@reference`]). They are drawn into
//! the layer that rain and snow share. The host's depth hides flakes behind objects, and none fall under the host's
//! shelters and occluder maps.
//!
//! *Near and far*: the fog's layer contains the extinction of all snow. Within the flakes' reach, the extinction of the
//! drawn flakes is subtracted from that of the layer. So neither the mean of the picture nor the visibility depends on
//! how many flakes are drawn.
//!
//! *Settings*: [`SnowSettings`]. *Cost*: proportional to the number of drawn flakes, plus the layer's work per pixel;
//! none where no snow falls. *Error*: [`contrast`] estimates how much all flakes together change a picture; `docs/lab`
//! has the contrast lost with fewer flakes.
//!
//! Near a wind that varies in space (`SceneMoment::wind_volume`) flakes are stepped (`particles::stepping`), starting
//! from their places in the lattice. They move with the weather's wind instead on devices without compute shaders, and
//! if more flakes are drawn than a storage buffer of the device has room for.
//!
//! There is no `held.rs`: flakes follow from seed and time. Stepped flakes belong to a view and are not saved.

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
