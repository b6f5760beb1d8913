//! Drawing of precipitation near the camera, shared by rain and snow: the streak camera and the layer in front of the
//! picture ([`streak`]), the air in which things fall ([`air`]), the list of things in the picture ([`listing`]), and
//! particles stepped through a wind that varies in space ([`stepping`]).
//!
//! `src/falling` has the physics: sizes, numbers and fall speeds. `src/rain` and `src/snow` have the places and the
//! look of drops and flakes.

mod air;
pub(crate) mod listing;
pub(crate) mod stepping;
pub(crate) mod streak;

pub(crate) use air::{MovingAir, begun_in_steps};
pub(crate) use streak::{
    DepthRead, FallingTexture, LAYER_FORMAT, LEAST_PIXELS, StreakCamera, StreakContrast, layer_pass,
};
