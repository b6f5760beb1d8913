//! Candidates for drawing clouds, which the lab charts against each other, and their cost.

use super::{model::CloudModel, settings::CloudSettings};
use crate::plan::{
    Listed, StepWork, Units, Work,
    parts::{Part, Worth},
};

/// Clouds as a part of the plan, with two rungs: layers drawn as volumes, or the grey deck in their place. The
/// importance, 0.4, is that of clouds in the experiment on a simulator that `sky::candidates::AIR` cites.
pub const CLOUDS: Part =
    Part { name: "clouds", rungs: &["volume", "deck"], importance: 0.4, worth: Worth::Estimated(4) };

/// Work of the volume in a pixel that looks towards clouds. The unit is the work of a pixel in which no part is drawn.
/// Measured on a software driver (`cargo bench --bench speed -- clouds`): a frame with a clear sky takes as long as 20
/// copies of the picture, and the volume adds the time of 34 copies.
const MARCHED: f64 = 2.0;
/// Work of the volume in any pixel, in the unit of [`MARCHED`]: composing the finished clouds over the sky.
const LAID: f64 = 0.3;

/// Returns the work of the step from the volume to the deck in a picture of `pixels` pixels. `share` is the share of
/// them that look towards clouds.
pub(crate) fn clouds_work(pixels: u64, share: f64) -> StepWork {
    StepWork { fixed: pixels as f64 * (LAID + share * MARCHED), ..StepWork::default() }
}

/// A way to draw clouds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CloudMethod {
    /// Model that is drawn.
    pub model: CloudModel,
    /// Settings of the volume.
    pub settings: CloudSettings,
}

/// Work of a marched ray at fineness 1: each step reads the map and the noise, and the light where there is cloud.
const RAY: Units = Units { samples: 60.0, texels: 120.0, bytes: 0.0 };
/// Work of a pixel that is reprojected from the previous frame and laid over the sky.
const FOLLOWED: Units = Units { samples: 3.0, texels: 10.0, bytes: 32.0 };

/// Work of a pixel of the deck, which is computed in closed form.
const DECK: Units = Units { samples: 0.1, texels: 0.0, bytes: 0.0 };

impl CloudMethod {
    /// Returns the cost of the method.
    fn work(&self) -> Work {
        if self.model == CloudModel::Deck {
            return Work { pixel: DECK, ..Work::default() };
        }
        let rays = self.settings.fineness / f64::from(self.settings.square_side * self.settings.square_side);
        Work { pixel: FOLLOWED.plus(RAY, rays), ..Work::default() }
    }
}

/// Returns all candidates.
pub fn candidates() -> Vec<Listed<CloudMethod>> {
    let volume = |fineness, square_side| CloudMethod {
        model: CloudModel::Volume,
        settings: CloudSettings { fineness, square_side, shafts: false },
    };
    let named = [
        ("deck", CloudMethod { model: CloudModel::Deck, ..CloudMethod::default() }),
        ("volume-quarter-steps", volume(0.25, 4)),
        ("volume-half-steps", volume(0.5, 4)),
        ("volume", volume(1.0, 4)),
        ("volume-double-steps", volume(2.0, 4)),
        ("quarter-of-pixels", volume(1.0, 2)),
        ("every-pixel-half-steps", volume(0.5, 1)),
        ("every-pixel", volume(1.0, 1)),
        ("every-pixel-double-steps", volume(2.0, 1)),
        ("every-pixel-fourfold-steps", volume(4.0, 1)),
    ];
    named.map(|(name, method)| Listed { name, method, work: method.work() }).into()
}
