//! Ways to draw rain that the lab charts against each other, and their cost.

use super::settings::{RainModel, RainSettings};
use crate::particles::stepping::STATE_BYTES;
use crate::plan::parts::{Part, Worth};
use crate::plan::{Listed, StepWork, Units, Work};

/// Streaks and splashes of rain, with three rungs: single drops near the camera; cones instead; neither, so that all
/// rain is extinction in the fog's layer. The importance, 0.7, is that of particles in a thesis's experiment on a
/// simulator for machine operators.
pub const RAIN: Part =
    Part { name: "rain", rungs: &["drops", "cones", "none"], importance: 0.7, worth: Worth::Unseen(3) };

/// Work per pixel of the rain layer with its cones and splashes. The unit is the work of a pixel in a picture without
/// any part of the plan. Measured on a software driver (`cargo bench -- parts`).
const LAYER_OF_PIXEL: f64 = 0.3;
/// Work of one drop of the lattice, in the same unit as [`LAYER_OF_PIXEL`].
const ONE_DROP: f64 = 1.4;

/// Returns the work that two steps save: the step from drops to cones, and the step from cones to none. The picture has
/// `pixels` pixels and `drops` drops. The unit is that of [`LAYER_OF_PIXEL`].
pub(crate) fn rain_work(pixels: u64, drops: u32) -> [StepWork; 2] {
    [ONE_DROP * f64::from(drops), LAYER_OF_PIXEL * pixels as f64].map(|fixed| StepWork { fixed, ..StepWork::default() })
}

/// Work of one drop of the lattice: the test whether it is in the picture, and the streaks of the few drops that are in
/// the picture. Measured against cones at 640 x 360.
const DROP: Units = Units { samples: 20.0, texels: 1.0, bytes: 13.0 };
/// Work of stepping one drop: an exponential, a look-up of the wind, and its state read and written.
const STEP: Units = Units { samples: 2.0, texels: 1.0, bytes: 32.0 };
/// Work of each pixel whenever rain falls: the layer is cleared, read and composited.
const LAYER: Units = Units { samples: 0.2, texels: 1.0, bytes: 16.0 };
/// Work of the cones per pixel: its place on three cones, and six look-ups of streaks.
const CONES: Units = Units { samples: 3.0, texels: 6.0, bytes: 0.0 };

/// Returns the cost of the settings.
pub fn work(s: &RainSettings) -> Work {
    let most = s.most_drops.unwrap_or(400_000);
    let drops = Work {
        // All drops are tested in every frame, because they move.
        view: Units::default().plus(DROP, f64::from(most)),
        pixel: LAYER,
        ..Work::default()
    };
    match s.model {
        // Adds a little work for the rain in the fog, which is drawn anyway. There is no layer.
        RainModel::Veil => Work { pixel: Units { samples: 0.1, ..Units::default() }, ..Work::default() },
        RainModel::Cones => Work { pixel: LAYER.plus(CONES, 1.0), ..Work::default() },
        // Adds the work of the outer cones, and of the drops in one of the four shells.
        RainModel::Automatic => Work {
            view: Units::default().plus(DROP, 0.25 * f64::from(most)),
            pixel: LAYER.plus(CONES, 0.9),
            ..Work::default()
        },
        RainModel::Drops => drops,
        RainModel::Integrated => {
            Work { view: drops.view.plus(STEP, f64::from(most)), view_bytes: u64::from(most) * STATE_BYTES, ..drops }
        }
    }
}

/// Returns all candidates.
pub fn candidates() -> Vec<Listed<RainSettings>> {
    let of = |model, most_drops| RainSettings { model, most_drops, ..RainSettings::default() };
    let drops = |n| of(RainModel::Drops, Some(n));
    let integrated = |n| of(RainModel::Integrated, Some(n));
    let named = [
        ("veil", of(RainModel::Veil, None)),
        ("cones", of(RainModel::Cones, None)),
        ("drops-12k", drops(12_000)),
        ("drops-50k", drops(50_000)),
        ("drops-100k", drops(100_000)),
        ("drops-400k", drops(400_000)),
        ("drops-and-cones", of(RainModel::Automatic, None)),
        ("integrated-100k", integrated(100_000)),
        ("integrated-400k", integrated(400_000)),
    ];
    named.map(|(name, method)| Listed { name, method, work: work(&method) }).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Price;

    #[test]
    fn cones_cost_no_more_for_more_rain_and_drops_cost_by_their_number() {
        let all = candidates();
        let cost = |name: &str| {
            let c = all.iter().find(|c| c.name == name).unwrap();
            c.work.frame(640 * 360, true).at(&Price::default())
        };
        assert!(cost("veil") < cost("cones"));
        assert!(cost("drops-12k") < cost("drops-50k") && cost("drops-50k") < cost("drops-400k"));
        for c in &all {
            c.method.validate().unwrap();
        }
    }
}
