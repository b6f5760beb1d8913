//! The ways to draw rain that are charted against each other, with what they cost.

use super::settings::{RainModel, RainSettings};
use crate::particles::stepping::STATE_BYTES;
use crate::plan::parts::{Part, Worth};
use crate::plan::{Listed, StepWork, Units, Work};

/// Streaks and splashes of rain, at three rungs: single drops near the camera, cones in their place, or neither, so
/// that all rain is extinction in the fog's layer. Importance: that of particles in the machinery trainer's thesis.
pub const RAIN: Part =
    Part { name: "rain", rungs: &["drops", "cones", "none"], importance: 0.7, worth: Worth::Unseen(3) };

/// Work of the layer of rain, its cones and splashes a pixel, and of a drop of the lattice that is drawn one by one,
/// measured on a software driver (`cargo bench -- parts`) in units of a pixel with none of the parts.
const LAYER_OF_PIXEL: f64 = 0.3;
const ONE_DROP: f64 = 1.4;

/// Work of the steps from drops to cones and from cones to a veil, in a picture of so many pixels and drops.
pub(crate) fn rain_work(pixels: u64, drops: u32) -> [StepWork; 2] {
    [ONE_DROP * f64::from(drops), LAYER_OF_PIXEL * pixels as f64].map(|fixed| StepWork { fixed, ..StepWork::default() })
}

/// Work of a drop of the lattice: to ask whether the picture shows it, and the streaks of the few that it shows; as
/// measured against cones over 640 x 360.
const DROP: Units = Units { samples: 20.0, texels: 1.0, bytes: 13.0 };
/// Work of stepping one: an exponential, a look at the wind, its state read and written.
const STEP: Units = Units { samples: 2.0, texels: 1.0, bytes: 32.0 };
/// Work that every pixel pays once anything falls: the layer cleared, read and put before the picture.
const LAYER: Units = Units { samples: 0.2, texels: 1.0, bytes: 16.0 };
/// A pixel's place on three cones, and six looks at the streaks.
const CONES: Units = Units { samples: 3.0, texels: 6.0, bytes: 0.0 };

/// The cost of a setting.
pub fn work(s: &RainSettings) -> Work {
    let most = s.most_drops.unwrap_or(400_000);
    let drops = Work {
        // They move: every frame.
        view: Units::default().plus(DROP, f64::from(most)),
        pixel: LAYER,
        ..Work::default()
    };
    match s.model {
        // As much as the fog does anyway, and no layer.
        RainModel::Veil => Work { pixel: Units { samples: 0.1, ..Units::default() }, ..Work::default() },
        RainModel::Cones => Work { pixel: LAYER.plus(CONES, 1.0), ..Work::default() },
        // The farther cones, and as many drops as one shell of four has.
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

/// All candidates.
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
