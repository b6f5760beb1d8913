//! Candidate methods of drawing the night sky, which the lab compares by cost and error.

use super::catalogue::catalogue;
use crate::plan::parts::{Part, Worth};
use crate::plan::{Listed, StepWork, Units, Work};

/// Stars, planets and the glow between them. The rungs are all of these, or an even sky of the glow's mean luminance.
/// The gauge measures how the picture changes without them and without the clear sky's own light, both together
/// (`Worth::Composed`).
pub const STARS: Part = Part { name: "stars", rungs: &["all", "none"], importance: 0.3, worth: Worth::Composed(2) };

/// Work of the night sky's layer for one pixel, in units of the work for a pixel without any part.
const LAYER_OF_PIXEL: f64 = 0.1;

/// Work of the night sky's layer in a picture of `pixels` pixels.
pub(crate) fn stars_work(pixels: u64) -> StepWork {
    StepWork { fixed: LAYER_OF_PIXEL * pixels as f64, ..StepWork::default() }
}

/// Method of drawing the night sky.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StarMethod {
    /// Glow, and in front of it the points that an eye could see against the sky.
    #[default]
    Visible,
    /// Glow and all stars and planets, however faint. Only for comparison.
    All,
    /// The glow alone.
    Glow,
    /// An even sky of the glow's mean luminance.
    Even,
}

/// Work for one drawn star: the transform from J2000.0 to the picture for each corner of its quad, and 16 pixels.
const POINT: Units = Units { samples: 40.0, texels: 0.0, bytes: 16.0 * 8.0 };
/// Work for one pixel of the glow, written and read.
const GLOW: Units = Units { samples: 1.0, texels: 1.0, bytes: 8.0 };
/// Work for one pixel of the even sky.
const EVEN: Units = Units { samples: 0.1, texels: 0.0, bytes: 0.0 };
/// Share of the catalogue that an eye sees under a dark sky; half of the stars are below the horizon.
const VISIBLE_SHARE: f64 = 0.3;

impl StarMethod {
    fn work(self) -> Work {
        let points = |share: f64| Work {
            // Points move with the sky's rotation, so they are drawn every frame.
            view: Units::default().plus(POINT, share * catalogue().len() as f64),
            pixel: GLOW,
            ..Work::default()
        };
        match self {
            Self::Visible => points(VISIBLE_SHARE),
            Self::All => points(1.0),
            Self::Glow => points(0.0),
            Self::Even => Work { pixel: EVEN, ..Work::default() },
        }
    }
}

/// All candidates.
pub fn candidates() -> Vec<Listed<StarMethod>> {
    let named = [
        ("visible-stars", StarMethod::Visible),
        ("all-stars", StarMethod::All),
        ("glow-alone", StarMethod::Glow),
        ("even-night", StarMethod::Even),
    ];
    named.map(|(name, method)| Listed { name, method, work: method.work() }).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Price;

    #[test]
    fn more_stars_cost_more_and_an_even_sky_least() {
        let costs: Vec<f64> =
            candidates().iter().map(|c| c.work.frame(640 * 360, true).at(&Price::default())).collect();
        let [visible, all, glow, even] = costs[..] else { panic!("{costs:?}") };
        assert!(all > visible && visible > glow && glow > even, "{costs:?}");
    }
}
