//! Model by which clouds are drawn.

use serde::{Deserialize, Serialize};

/// Model by which clouds are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CloudModel {
    /// A grey deck, computed in closed form, if more than half of the sky is covered. Broken clouds only dim the light.
    /// The cheapest model.
    Deck,
    /// Layers drawn as volumes, marched ray by ray. A closed layer 400 m or more above the camera is drawn as a deck if
    /// the sun's disc does not show through it. The default.
    #[default]
    Volume,
}

impl CloudModel {
    /// Returns the model's name in saved states.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Deck => "deck",
            Self::Volume => "volume",
        }
    }
}
