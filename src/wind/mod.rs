//! Wind: a mean from the weather, gusts around it with a published spectrum, and the displacement of the air by both.
//!
//! The mean wind follows the logarithmic profile over the ground's roughness up to 100 m. Above, it turns and grows to
//! the geostrophic wind ([`WindProfile::mean_at_height_m_s`](crate::weather::WindProfile::mean_at_height_m_s)); cloud
//! layers move with the wind at their height (`layers`). A gust has a velocity along the mean wind and one across it,
//! each a sum of 24 waves. The amplitudes follow the spectrum of Kaimal et al. (1972), with the weather's turbulence
//! intensity along the wind and 0.8 of it across (IEC 61400-1, annex C). All waves travel with the mean wind (Taylor
//! 1938) and are the same all over the world. Where a report says that the direction varies, a slow wave turns the wind
//! within that range.
//!
//! [`Wind`] computes the velocity at 10 m and its integral, the displacement ([`Drift`]), for any time of a timeline,
//! without stepping through time. Whatever the wind carries is moved by the displacement, never by velocity times time,
//! so that a change of the wind does not make it jump.

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
pub(crate) use height::up_share;
pub(crate) use layers::{LayerDrift, LayerDrifts, stretch, stretch_toward};
pub(crate) use volume::WindVolume;
