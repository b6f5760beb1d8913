//! Ways to draw falling snow that the lab charts against each other, and their cost.

use super::settings::{SnowModel, SnowSettings};
use crate::plan::parts::{Part, Worth};
use crate::plan::{Listed, StepWork, Units, Work};

/// Flakes, with two rungs: single flakes near the camera, or none, so that all snow is extinction in the fog's layer.
/// The importance, 0.7, is that of particles, as for rain ([`crate::rain::candidates::RAIN`]).
pub const SNOW: Part = Part { name: "snow", rungs: &["flakes", "none"], importance: 0.7, worth: Worth::Unseen(3) };

/// Work per pixel of the layer of rain and snow, for the plan. The unit is the work of a pixel in a picture without any
/// part of the plan. The value is derived from the times of `cargo bench --bench speed -- falling`. Their unit is
/// another one: the time of a pass that copies the picture. `cargo bench --bench speed -- parts` prints the work of
/// snow in the plan's unit.
const LAYER_OF_PIXEL: f64 = 0.1;
/// Work of one flake of the lattice, for the plan, in the same unit as [`LAYER_OF_PIXEL`].
const ONE_FLAKE: f64 = 0.5;

/// Returns the work that the step from flakes to none saves, for a picture of `pixels` pixels with `flakes` flakes. The
/// unit is that of [`LAYER_OF_PIXEL`].
pub(crate) fn snow_work(pixels: u64, flakes: u32) -> [StepWork; 1] {
    let fixed = ONE_FLAKE * f64::from(flakes) + LAYER_OF_PIXEL * pixels as f64;
    [StepWork { fixed, ..StepWork::default() }]
}

/// Work of one flake of the lattice in the lab's model of cost: its place, the test whether it is in the picture, and
/// the pixels of the few flakes that are in the picture.
const FLAKE: Units = Units { samples: 8.0, texels: 1.0, bytes: 8.0 };
/// Work of each pixel in the lab's model of cost whenever snow falls: the layer is cleared, read and composited.
const LAYER: Units = Units { samples: 0.2, texels: 1.0, bytes: 16.0 };

/// Returns the work of drawing snow with these settings. If they leave the largest number of flakes open, the default
/// number on a GPU is used.
fn work(settings: &SnowSettings) -> Work {
    match settings.model {
        // Adds a little work for the snow in the fog, which is drawn anyway. There is no layer.
        SnowModel::Veil => Work { pixel: Units { samples: 0.1, ..Units::default() }, ..Work::default() },
        SnowModel::Automatic | SnowModel::Flakes => Work {
            // All flakes are tested in every frame, because they move.
            view: Units::default().plus(FLAKE, f64::from(settings.most_flakes.unwrap_or(1_000_000))),
            pixel: LAYER,
            ..Work::default()
        },
    }
}

/// Returns all candidates.
pub fn candidates() -> Vec<Listed<SnowSettings>> {
    let flakes = |n| SnowSettings { model: SnowModel::Flakes, most_flakes: Some(n), ..SnowSettings::default() };
    let named = [
        ("veil", SnowSettings { model: SnowModel::Veil, ..SnowSettings::default() }),
        ("flakes-20k", flakes(20_000)),
        ("flakes-250k", flakes(250_000)),
        ("automatic", SnowSettings::default()),
        ("flakes-1m", flakes(1_000_000)),
        ("flakes-4m", flakes(4_000_000)),
    ];
    let candidate = |(name, method): (&'static str, SnowSettings)| Listed { name, method, work: work(&method) };
    named.into_iter().map(candidate).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Price;

    #[test]
    fn flakes_cost_by_their_number() {
        let all = candidates();
        let cost = |name: &str| {
            let c = all.iter().find(|c| c.name == name).unwrap();
            c.work.frame(640 * 360, true).at(&Price::default())
        };
        assert!(cost("veil") < cost("flakes-20k") && cost("flakes-20k") < cost("flakes-250k"));
        let per_flake = (cost("flakes-4m") - cost("flakes-1m")) / 3e6;
        assert!((per_flake / ((cost("flakes-1m") - cost("flakes-250k")) / 750e3) - 1.0).abs() < 1e-9);
        all.iter().for_each(|c| c.method.validate().unwrap());
    }
}
