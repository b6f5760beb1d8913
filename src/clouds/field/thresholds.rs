//! Thresholds of the map that give a layer its cover, by kind of cloud. [`super::cover`] finds the numbers of
//! `THRESHOLDS`.

use crate::{
    chance::normal_quantile,
    error::Result,
    numerics::smoothstep,
    weather::{CloudKind, CloudLayer, CloudSlab, Weather, derive},
};

/// Threshold above all numbers of the map: no cloud.
pub(crate) const CLEAR: f64 = 7.0;
/// Threshold over a rain area: one place in 30 000 stays open.
pub(crate) const FILLED: f64 = -4.0;

/// Number of oktas with thresholds.
pub(super) const OKTAS: usize = 7;

/// Thresholds of the map by kind of cloud ([`CloudKind::ALL`] without the unknown kind) and oktas 1 to 7.
pub(super) const THRESHOLDS: [(CloudKind, [f64; OKTAS]); 11] = include!("thresholds.in");

/// Returns the slab that the weather derives for a kind and a cover when the host gives nothing else, with its base at
/// 2000 m.
///
/// # Errors
/// Errors of [`derive()`].
pub fn typical(kind: CloudKind, cover: f64) -> Result<CloudSlab> {
    let weather = Weather { clouds: vec![CloudLayer::of(kind, cover, 2000.0)], ..Weather::default() };
    let conditions = derive(&weather)?;
    Ok(*conditions.cloud_slabs().next().unwrap_or(&CloudSlab::NONE))
}

/// Returns the threshold of one kind at this cover: interpolated in its row of the table from 1 to 7 oktas, and
/// extrapolated beyond.
fn of_kind(row: &[f64; OKTAS], cover: f64) -> f64 {
    // Thresholds are nearly linear in the normal quantile of the cover.
    let quantile = |cover: f64| normal_quantile(cover.clamp(1e-9, 1.0 - 1e-9));
    let node = |i: usize| quantile((i as f64 + 1.0) / 8.0);
    let q = quantile(cover);
    let i = (0..OKTAS - 1).rev().find(|i| node(*i) <= q).unwrap_or(0);
    let t = (q - node(i)) / (node(i + 1) - node(i));
    row[i] + (row[i + 1] - row[i]) * t
}

/// Returns the threshold of the map at which a layer has its cover. For a layer between kinds, the kinds' thresholds
/// are weighted by how near the layer is to each.
pub fn threshold(slab: &CloudSlab) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for ((_, row), traits) in THRESHOLDS.iter().zip(traits()) {
        let off: f64 = traits.iter().zip(traits_of(slab)).map(|(a, b)| (a - b) * (a - b)).sum();
        let weight = 1.0 / (off * off + 1e-12);
        sum += weight * of_kind(row, slab.cover);
        weights += weight;
    }
    let threshold = (sum / weights).max(CLOSED);
    threshold + (CLOSED - threshold) * smoothstep(CLOSES, 1.0, slab.cover)
}

/// Threshold below all numbers of the map: no place is open.
const CLOSED: f64 = -7.0;
/// Cover above which thresholds blend to [`CLOSED`], so that nothing leaps when a layer closes.
const CLOSES: f64 = 0.99;

/// Returns the four numbers by which kinds of cloud differ.
fn traits_of(slab: &CloudSlab) -> [f64; 4] {
    [slab.convection, slab.cellular, slab.fibre, slab.ice_fraction]
}

/// Returns the numbers of [`traits_of`] for the kinds of [`THRESHOLDS`].
fn traits() -> &'static [[f64; 4]; 11] {
    static TRAITS: std::sync::OnceLock<[[f64; 4]; 11]> = std::sync::OnceLock::new();
    TRAITS.get_or_init(|| THRESHOLDS.map(|(kind, _)| typical(kind, 0.5).map_or([0.0; 4], |slab| traits_of(&slab))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_has_the_number_of_its_table_at_each_okta() {
        for (kind, row) in &THRESHOLDS {
            for (i, number) in row.iter().enumerate() {
                let found = of_kind(row, (i as f64 + 1.0) / 8.0);
                assert!((found - number).abs() < 1e-9, "{kind:?} at {} oktas: {found}, {number}", i + 1);
            }
        }
    }

    #[test]
    fn thresholds_fall_as_cover_grows_and_blend_between_kinds() {
        let (low, high) = (typical(CloudKind::Stratus, 0.5).unwrap(), typical(CloudKind::Cumulus, 0.5).unwrap());
        let mut last = f64::INFINITY;
        for i in 1..=100 {
            let slab = CloudSlab { cover: f64::from(i) / 100.0, ..high };
            assert!(threshold(&slab) < last, "cover {i} %");
            last = threshold(&slab);
        }
        let between = CloudSlab { convection: 0.5 * (low.convection + high.convection), ..high };
        let (a, b, c) = (threshold(&low), threshold(&between), threshold(&high));
        assert!(a.min(c) - 0.2 < b && b < a.max(c) + 0.2, "{a} {b} {c}");
    }
}
