//! Wind: a mean that the weather gives, gusts of a published spectrum about it, and how far it has carried the air.
//!
//! The mean follows the logarithmic profile over the ground's roughness up to 100 m, and above it turns and grows to
//! the geostrophic wind ([`WindProfile::mean_at_height_m_s`](crate::weather::WindProfile::mean_at_height_m_s)); layers
//! of cloud go with it (`layers`). Gusts are 24 waves along and 24 across the wind whose lengths are spread as Kaimal
//! et al. (1972) found them, with the weather's turbulence intensity along the wind and 0.8 of it across (IEC 61400-1,
//! annex C); they pass along the path of the mean wind (Taylor 1938), the same over all the world. Where a report says
//! that the direction varies, a slow wave turns the wind within that range.
//!
//! [`Wind`] and a [`Drift`] answer for any time of a timeline in closed form: velocity, and its integral, the
//! displacement. What the wind carries is moved by the displacement, never by velocity times time: then no change
//! throws it.

mod carrying;
mod detour;
mod drift;
mod grid;
mod gusts;
mod height;
mod layers;
#[cfg(test)]
mod tests;
mod volume;

pub(crate) use carrying::{Carrying, Remembered, WindOver};
pub(crate) use detour::{DETOUR_SIDE, Detour, DetourMap};
pub use drift::{Blowing, Drift, Wind};
pub use grid::{MAX_NODES, WindGrid, WindGridKind};
pub use height::WindAt;
pub(crate) use layers::{LayerDrift, LayerDrifts, stretch, stretch_toward};
pub(crate) use volume::WindVolume;
