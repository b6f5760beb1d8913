//! Drawing of what falls near the camera, shared by rain and snow: the streak camera and the layer before the picture
//! ([`streak`]), the air that things fall in ([`air`]), the list of what a picture shows ([`listing`]), and things that
//! are stepped through a wind that varies in space ([`stepping`]).
//!
//! What falls, how fast and where it starts is `src/falling`'s; what a drop or a flake looks like is `src/rain`'s and
//! `src/snow`'s.

mod air;
pub(crate) mod listing;
pub(crate) mod stepping;
pub(crate) mod streak;

pub(crate) use air::{MovingAir, begun_in_steps};
pub(crate) use streak::{
    DepthRead, FallingTexture, LAYER_FORMAT, LEAST_PIXELS, StreakCamera, StreakContrast, layer_pass,
};
