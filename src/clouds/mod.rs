//! Clouds: layers of a volume that one can fly through, or the grey deck in their place.
//!
//! # Model
//! * Where there is cloud, [`field`]: a map that says how strongly cloud grows, fixed to the air that carries it, and
//!   solid noise that frays its edges; [`cover`] finds how much of the map is cloud where a cover is asked for.
//! * What light does in it, [`light`] with the tables of [`transport`]: scattered once as it is, more often as in a box
//!   of the depths about a place. Ice makes a [`halo`]. [`mod@reference`] follows photons through boxes, [`traced`]
//!   through the field itself.
//! * What a picture shows of it: rays are marched at one pixel of sixteen a frame, the others are taken over from the
//!   frame before.
//! * What mirrors and cube maps show of it: `round`, a small map of all directions.
//! * A host's map of where clouds stand, and cloud over rain areas: `placed`, `layer_map`, `cells`.
//! * What lamps and flashes make of it: [`lamp_light`], a small picture of its own (`lamps`).
//! * [`shadow`]: the light that it lets through to a place, and a map of that for pictures and for a host's own
//!   materials (`handed`).
//!
//! The deck is drawn with the sky (`shaders/between/sky.wgsl`).
//!
//! # Error
//! Of the drawn light: even slabs within 5 % or 0.01 of discrete ordinates, each face of a cube within 15 % or 0.03 of
//! what falls on the cube (`cargo test --lib clouds::probe -- --nocapture`); along rays through the field, against
//! photons, what `lab photons` prints, most under a low sun. Of the cover that is seen: 3 points (`clouds::cover`).
//!
pub mod candidates;
mod cells;
pub mod cover;
pub mod field;
pub mod halo;
mod handed;
mod held;
pub mod lamp_light;
mod lamps;
mod layer_map;
pub mod light;
pub mod map;
mod march;
#[cfg(test)]
mod mean_light;
mod overhead;
mod passes;
mod picture;
mod pipelines;
mod placed;
pub mod probe;
pub mod reference;
mod round;
mod rows;
pub mod settings;
pub mod shadow;
mod shadow_map;
mod shape;
mod tables;
pub mod traced;
pub mod transport;
mod uniforms;
mod view;

use serde::{Deserialize, Serialize};

pub(crate) use cells::over_place as cloud_over_areas;
pub use handed::{CloudShadows, SHADOW_SNIPPET_GLSL, SHADOW_SNIPPET_WGSL};
pub(crate) use held::HeldClouds;
pub(crate) use march::CloudRays;
pub use settings::CloudSettings;
pub(crate) use view::CloudsView;

/// How clouds are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CloudModel {
    /// A grey deck in closed form where more than half of the sky is covered; broken clouds only dim the light. The
    /// cheapest.
    Deck,
    /// Layers of a volume, marched ray by ray; a closed one seen from below is a deck. The default.
    #[default]
    Volume,
}

impl CloudModel {
    /// Its name in saved states.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Deck => "deck",
            Self::Volume => "volume",
        }
    }
}
