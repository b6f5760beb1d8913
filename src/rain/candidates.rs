//! The ways to draw rain that are charted against each other, with what they cost.

use super::{RainModel, RainSettings, STATE_BYTES, source::SourceLod};
use crate::plan::parts::{Part, Worth};
use crate::plan::{Listed, StepWork, Units, Work};

/// Streaks and splashes of rain, at three rungs: single drops near the camera, cones in their place, or neither, so that all rain is
/// extinction in the fog's layer. Importance: that of particles in the machinery trainer's thesis.
pub const RAIN: Part =
    Part { name: "rain", rungs: &["drops", "cones", "none"], importance: 0.7, worth: Worth::Unseen(3) };

/// Work of the layer of rain, its cones and splashes a pixel, and of a drop of the lattice that is drawn one by one, measured on a
/// software driver (`cargo bench -- parts`) in units of a pixel with none of the parts.
const LAYER_OF_PIXEL: f64 = 0.4;
const ONE_DROP: f64 = 0.4;

/// Work of the steps from drops to cones and from cones to a veil, in a picture of so many pixels and drops.
pub(crate) fn rain_work(pixels: u64, drops: u32) -> [StepWork; 2] {
    [ONE_DROP * f64::from(drops), LAYER_OF_PIXEL * pixels as f64].map(|fixed| StepWork { fixed, ..StepWork::default() })
}

/// A way to draw rain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RainMethod {
    /// What the library offers, as [`crate::frame::View::set_rain`] takes it.
    Offered(RainSettings),
    /// Level of detail of an older system, drawn from its list ([`SourceLod::drops`]): compared with only.
    Source(SourceLod),
}

/// Work of a drop of the lattice: to ask whether the picture shows it, and the streaks of the few that it shows; as measured
/// against cones over 640 x 360.
const DROP: Units = Units { samples: 20.0, texels: 1.0, bytes: 13.0 };
/// Work of stepping one: an exponential, a look at the wind, its state read and written.
const STEP: Units = Units { samples: 2.0, texels: 1.0, bytes: 32.0 };
/// Work that every pixel pays once anything falls: the layer cleared, read and put before the picture.
const LAYER: Units = Units { samples: 0.2, texels: 1.0, bytes: 16.0 };
/// A pixel's place on four cones, and eight looks at the streaks.
const CONES: Units = Units { samples: 4.0, texels: 8.0, bytes: 0.0 };

impl RainMethod {
    fn work(self) -> Work {
        let drops = |n: u32| Work {
            // They move: every frame.
            view: Units::default().plus(DROP, f64::from(n)),
            pixel: LAYER,
            ..Work::default()
        };
        match self {
            Self::Offered(s) => match s.model {
                // As much as the fog does anyway, and no layer.
                RainModel::Veil => Work { pixel: Units { samples: 0.1, ..Units::default() }, ..Work::default() },
                RainModel::Cones => Work { pixel: LAYER.plus(CONES, 1.0), ..Work::default() },
                // The farther cones, and as many drops as one shell of four has.
                RainModel::Automatic => Work {
                    view: Units::default().plus(DROP, 0.25 * f64::from(s.most_drops.unwrap_or(400_000))),
                    pixel: LAYER.plus(CONES, 0.9),
                    ..Work::default()
                },
                RainModel::Drops => drops(s.most_drops.unwrap_or(400_000)),
                RainModel::Integrated => {
                    let n = s.most_drops.unwrap_or(400_000);
                    let drawn = drops(n);
                    Work { view: drawn.view.plus(STEP, f64::from(n)), view_bytes: u64::from(n) * STATE_BYTES, ..drawn }
                }
            },
            Self::Source(lod) => drops(lod.drop_count()),
        }
    }
}

/// All candidates.
pub fn candidates() -> Vec<Listed<RainMethod>> {
    let offered =
        |model, most_drops| RainMethod::Offered(RainSettings { model, most_drops, ..RainSettings::default() });
    let drops = |n| offered(RainModel::Drops, Some(n));
    let integrated = |n| offered(RainModel::Integrated, Some(n));
    let source = |seeds, copies| RainMethod::Source(SourceLod { seeds, copies, ..SourceLod::default() });
    let named = [
        ("veil", offered(RainModel::Veil, None)),
        ("cones", offered(RainModel::Cones, None)),
        ("drops-12k", drops(12_000)),
        ("drops-50k", drops(50_000)),
        ("drops-100k", drops(100_000)),
        ("drops-400k", drops(400_000)),
        ("drops-and-cones", offered(RainModel::Automatic, None)),
        ("integrated-100k", integrated(100_000)),
        ("integrated-400k", integrated(400_000)),
        ("source-20k", source(20_000, 0)),
        ("source-140k", source(140_000, 0)),
        ("source-replicated-140k", source(20_000, 6)),
    ];
    let candidate = |(name, method): (&'static str, RainMethod)| Listed {
        name,
        method,
        work: method.work(),
        offered: matches!(method, RainMethod::Offered(_)),
    };
    named.into_iter().map(candidate).collect()
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
        assert_eq!(cost("source-140k"), cost("source-replicated-140k"));
        for c in &all {
            if let RainMethod::Offered(s) = c.method {
                s.validate().unwrap();
            }
        }
    }
}
