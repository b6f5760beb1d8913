//! From a layer of the weather to the shape of its clouds.

use glam::DVec2;

use super::{
    cover::threshold,
    field::{Shape, filled_below},
};
use crate::{
    chance::normal_quantile,
    weather::{CloudSlab, Conditions},
    wind::LayerDrift,
};

fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// Number of the map at which a cloud reaches the layer's top, at least: one place of seventy. Where more did, tops would be cut flat.
const HIGHEST: f64 = 2.2;

/// Columns whose mean stands for all.
const COLUMNS: usize = 32;

/// How much of its thickness a cloudy column of a layer fills on the mean: the tops of most are below the layer's. The map's number is spread
/// normally, edges are taken unfrayed.
fn filled_share(of: &Shape) -> f64 {
    let below = 0.5 * libm::erfc(-of.threshold * std::f64::consts::FRAC_1_SQRT_2);
    let one = |i: usize| {
        let rank = below + (1.0 - below) * (i as f64 + 0.5) / COLUMNS as f64;
        filled_below(of, normal_quantile(rank) - of.threshold, 1.0)
    };
    (0..COLUMNS).map(one).sum::<f64>() / COLUMNS as f64
}

impl Shape {
    /// Of a layer that has come so far.
    pub(crate) fn new(c: &Conditions, slab: &CloudSlab, drift: &LayerDrift) -> Self {
        Self {
            base_m: c.air.station_altitude_m + slab.base_m,
            drift_m: drift.way * slab.scale_m,
            evolution: DVec2::new(0.8, 0.6) * drift.lives,
            ..Self::still(slab, threshold(slab))
        }
    }

    /// Of a layer in still air over the sea, cut out of the map by a threshold.
    pub(super) fn still(slab: &CloudSlab, threshold: f64) -> Self {
        let heaps = (2.0 * slab.convection).min(1.0) * (1.0 - slab.cellular);
        let sheet = mix(mix(0.35, 1.4, slab.cellular), 1.5, heaps);
        let shape = Self {
            base_m: slab.base_m,
            thickness_m: slab.thickness_m,
            scale_m: slab.scale_m,
            extinction_per_m: slab.optical_depth / slab.thickness_m,
            threshold,
            dome: mix(sheet, 0.4, slab.fibre).max(HIGHEST - threshold),
            rough: mix(mix(mix(0.35, 0.5, slab.cellular), 0.9, heaps), 0.8, slab.fibre),
            soft: mix(mix(mix(0.3, 0.12, heaps), 0.8, slab.cellular), 1.2, slab.fibre),
            cellular: slab.cellular,
            drift_m: DVec2::ZERO,
            evolution: DVec2::ZERO,
        };
        // The layer's optical depth is that of its clouds on the mean.
        Self { extinction_per_m: shape.extinction_per_m / filled_share(&shape), ..shape }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        clouds::{
            cover::{field, typical},
            field::{Map, Solid},
        },
        weather::CloudKind,
    };

    #[test]
    fn columns_with_cloud_have_the_optical_depth_of_their_layer_on_the_mean() {
        let grown = (Map::new(3), Solid::new(3).unwrap());
        for kind in [CloudKind::Cumulus, CloudKind::ToweringCumulus, CloudKind::Stratocumulus, CloudKind::Stratus] {
            for cover in [0.25, 0.5, 0.75, 1.0] {
                let slab = typical(kind, cover).unwrap();
                let field = field(&slab, &grown, threshold(&slab));
                let step_m = slab.thickness_m / 64.0;
                let column = |i: usize| {
                    let at = DVec2::new((i % 63) as f64 * 0.7135, (i / 63) as f64 * 0.6131) * slab.scale_m;
                    let height = |k: usize| slab.base_m + (k as f64 + 0.5) * step_m;
                    (0..64).map(|k| field.extinction_per_m(at.extend(height(k)))).sum::<f64>() * step_m
                };
                let cloudy: Vec<f64> = (0..4000).map(column).filter(|depth| *depth > 0.1).collect();
                let mean = cloudy.iter().sum::<f64>() / cloudy.len() as f64 / slab.optical_depth;
                println!("{kind:?} at {cover}: {mean:.2} of the layer's optical depth");
                assert!((mean - 1.0).abs() < 0.2, "{kind:?} at {cover}: {mean}");
            }
        }
    }
}
