//! Cover of a layer: the share of the sky that the layer hides as seen from the ground. The thresholds of the map are
//! found from it.
//!
//! Cover is the share of the solid angle within 75 degrees of the zenith in which the layer's slant optical depth
//! exceeds 0.1, or 0.03 for ice crystals, seen from below. The sides of clouds hide more of the sky than their bases
//! do, so thresholds are found by searching: `cargo run --release -p welkin-lab -- thresholds` prints `thresholds.in`.

use std::f64::consts::PI;

use glam::DVec2;

pub use super::thresholds::{threshold, typical};
use super::{extinction::Field, map::Map, shape::Shape, solid::Solid, thresholds::OKTAS};
use crate::{
    error::Result,
    weather::{CloudKind, CloudSlab},
};

/// Largest zenith angle that counts, degrees.
const RIM_DEG: f64 = 75.0;
/// Number of directions traced from a place.
const DIRECTIONS: usize = 48;
/// Number of steps along a ray through the layer.
const STEPS: usize = 48;
/// Slant optical depths that hide the sky: for droplets, for ice.
const HIDES: [f64; 2] = [0.1, 0.03];

/// Returns the cover seen from one place, m east and north. `hides` is the slant optical depth that hides the sky.
fn seen_from(field: &Field<'_>, place_m: DVec2, hides: f64) -> f64 {
    let s = &field.shape;
    let rim = RIM_DEG.to_radians().cos();
    let hidden = |i: usize| {
        // A spiral by the golden angle has directions of equal solid angle.
        let up = 1.0 - (1.0 - rim) * (i as f64 + 0.5) / DIRECTIONS as f64;
        let azimuth = PI * (3.0 - 5f64.sqrt()) * i as f64;
        let level = DVec2::from_angle(azimuth) * ((1.0 - up * up).sqrt() / up);
        let step_m = s.thickness_m / STEPS as f64;
        let mut depth = 0.0;
        (0..STEPS).any(|k| {
            let rise = (k as f64 + 0.5) * step_m;
            // Rays start one thickness below the base. Over many places the mean does not depend on this distance.
            let at = (place_m + level * (s.thickness_m + rise)).extend(s.base_m + rise);
            depth += field.extinction_per_m(at) * step_m / up;
            depth > hides
        })
    };
    (0..DIRECTIONS).filter(|i| hidden(*i)).count() as f64 / DIRECTIONS as f64
}

/// Returns the mean cover seen from `places` places that are many clouds apart.
pub fn seen(field: &Field<'_>, is_ice: bool, places: usize) -> f64 {
    // Fibres are stretched along the wind, so the places lie farther apart.
    let drawn_out = field.shape.stretch.determinant().recip();
    let far = 37.0 * field.shape.scale_m * drawn_out;
    let place = |i: usize| DVec2::new(far * i as f64, 0.618_034 * far * ((i * i) % 101) as f64);
    let hides = HIDES[usize::from(is_ice)];
    (0..places).map(|i| seen_from(field, place(i), hides)).sum::<f64>() / places as f64
}

/// Finds the thresholds at which the clouds of a kind have covers of 1 to 7 oktas on average over several seeds: one
/// line of `thresholds.in`.
///
/// # Errors
/// [`crate::Status::OutOfMemory`] if there is no memory for the noise.
pub fn find_thresholds(kind: CloudKind, seeds: &[(Map, Solid)], places: usize) -> Result<[f64; OKTAS]> {
    let mut row = [0.0; OKTAS];
    for (i, to) in row.iter_mut().enumerate() {
        let cover = (i as f64 + 1.0) / 8.0;
        let slab = typical(kind, cover)?;
        let (mut low, mut high) = (-4.0, 4.0);
        for _ in 0..12 {
            let middle = 0.5 * (low + high);
            let mean = seeds.iter().map(|s| seen(&field(&slab, s, middle), is_ice(&slab), places)).sum::<f64>();
            if mean > cover * seeds.len() as f64 { low = middle } else { high = middle }
        }
        *to = 0.5 * (low + high);
    }
    Ok(row)
}

/// Whether a layer is fibrous, and so made of ice crystals, which hide the sky at the smaller optical depth of `HIDES`.
pub fn is_ice(slab: &CloudSlab) -> bool {
    slab.fibre > 0.5
}

/// Returns the clouds of a layer with a threshold, in still air.
pub fn field<'a>(slab: &CloudSlab, (map, solid): &'a (Map, Solid), threshold: f64) -> Field<'a> {
    Field { shape: Shape::still(slab, threshold), map, solid, placed: Default::default() }
}

/// Returns the cover of a kind as seen from the ground when `cover` is requested: its mean and its standard deviation
/// over seeds.
///
/// # Errors
/// [`crate::Status::OutOfMemory`] if there is no memory for the noise.
pub fn seen_over_seeds(kind: CloudKind, cover: f64, seeds: u64, places: usize) -> Result<[f64; 2]> {
    if cover <= 0.0 {
        return Ok([0.0; 2]);
    }
    let slab = typical(kind, cover)?;
    let solid = Solid::new(0)?;
    let mut each = Vec::new();
    let mut made = (Map(Vec::new()), solid);
    for seed in 0..seeds {
        made.0 = Map::new(seed);
        each.push(seen(&field(&slab, &made, threshold(&slab)), is_ice(&slab), places));
    }
    let mean = each.iter().sum::<f64>() / each.len().max(1) as f64;
    let spread = each.iter().map(|c| (c - mean) * (c - mean)).sum::<f64>() / each.len().max(1) as f64;
    Ok([mean, spread.sqrt()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clouds::field::thresholds::THRESHOLDS;

    /// Number of places from which a seed's sky is seen. The standard error of their mean is below 1 percentage point.
    const PLACES: usize = 64;

    /// Eight seeds, or forty with `WELKIN_ACCEPT`.
    #[test]
    fn the_cover_that_is_seen_is_the_one_asked_for() {
        let seeds = if std::env::var_os("WELKIN_ACCEPT").is_some() { 40 } else { 8 };
        let made: Vec<(Map, Solid)> = (0..seeds).map(|s| (Map::new(s), Solid::new(s % 8).unwrap())).collect();
        for (kind, _) in THRESHOLDS {
            let mut line = String::new();
            for okta in [1.0, 1.5, 3.5, 4.0, 6.0, 7.0] {
                let cover = okta / 8.0;
                let slab = typical(kind, cover).unwrap();
                let one = |s: &(Map, Solid)| seen(&field(&slab, s, threshold(&slab)), is_ice(&slab), PLACES);
                let mean = made.iter().map(one).sum::<f64>() / made.len() as f64;
                line.push_str(&format!(" {cover:.3} {mean:.3};"));
                assert!((mean - cover).abs() < 0.03, "{kind:?} at {okta} oktas: {mean:.3}");
            }
            println!("{kind:?}: asked, seen{line}");
            let closed = typical(kind, 1.0).unwrap();
            assert_eq!(seen(&field(&closed, &made[0], threshold(&closed)), is_ice(&closed), PLACES), 1.0, "{kind:?}");
        }
        assert_eq!(seen_over_seeds(CloudKind::Cumulus, 0.0, 1, PLACES).unwrap(), [0.0; 2]);
    }
}
