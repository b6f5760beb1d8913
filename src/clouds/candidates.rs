//! The ways to draw clouds that are charted against each other, with what they cost.

use crate::plan::{
    StepWork,
    parts::{Part, Worth},
};

/// Clouds, at two rungs: layers of a volume, or the grey deck in their place. How much they matter: 0.4 in the machinery trainer's
/// experiment.
pub const CLOUDS: Part =
    Part { name: "clouds", rungs: &["volume", "deck"], importance: 0.4, worth: Worth::Estimated(4) };

/// Work of the volume in a pixel that looks towards it, and in any pixel, in units of a pixel with none of the parts, measured on a
/// software driver (`cargo bench --bench speed -- clouds`): 34 copies beyond a clear sky, whose frame has 20.
const MARCHED: f64 = 2.0;
const LAID: f64 = 0.3;

/// Work of the step from the volume to the deck in a picture of so many pixels, a share of which looks towards the clouds.
pub(crate) fn clouds_work(pixels: u64, share: f64) -> StepWork {
    StepWork { fixed: pixels as f64 * (LAID + share * MARCHED), ..StepWork::default() }
}
