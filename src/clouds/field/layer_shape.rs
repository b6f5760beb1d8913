//! Shape of the clouds of a layer, from the weather's slab.

use glam::DVec2;

use super::{
    shape::{NO_ANVIL, Shape, filled_below},
    thresholds::threshold,
};
use crate::{
    chance::normal_quantile,
    weather::{CloudSlab, Conditions},
    wind::{LayerDrift, stretch, stretch_toward},
};

/// Interpolates linearly from `a` to `b`; `t` is the weight of `b`.
fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// Least value of the map's number at which a cloud reaches the layer's top: one place in seventy has more. With a
/// lower value, tops would be cut flat.
const HIGHEST: f64 = 2.2;
/// Least value of the map's number at which a cumulonimbus reaches the layer's top. It is lower than [`HIGHEST`],
/// because the cloud's towers spread there.
const HIGHEST_OF_TOWERS: f64 = 1.2;

/// Side of the cube of solid noise, in distances from cloud to cloud.
const SOLID_CELLS: f64 = 1.5;
/// Side of the cube of solid noise for fibrous clouds, in distances from cloud to cloud.
const SOLID_CELLS_OF_FIBRES: f64 = 0.8;
/// Largest distance from cloud to cloud, m, at which the size of the heads (bulges of a cloud) is still proportional to
/// this distance.
const HEADS_AS_CLOUDS_M: f64 = 1000.0;
/// Excess over the threshold above which a place of a cumulonimbus has an anvil above it.
const ANVIL_BEYOND: f64 = -0.2;
/// Distance that the top of fibres lies downwind of their base, in thicknesses: crystals fall for some kilometres into
/// slower air (Heymsfield 1975).
const LEAN: f64 = 3.0;

/// Number of places over which [`filled_share`] takes the mean.
const COLUMNS: usize = 32;

/// Returns the share of the layer's thickness that cloud fills, as a mean over the places that have cloud. Most tops
/// are below the layer's. The map's number has a normal distribution; edges are taken without fraying.
fn filled_share(shape: &Shape) -> f64 {
    let below = 0.5 * libm::erfc(-shape.threshold * std::f64::consts::FRAC_1_SQRT_2);
    let one = |i: usize| {
        let rank = below + (1.0 - below) * (i as f64 + 0.5) / COLUMNS as f64;
        filled_below(shape, normal_quantile(rank) - shape.threshold, 1.0)
    };
    (0..COLUMNS).map(one).sum::<f64>() / COLUMNS as f64
}

impl Shape {
    /// Creates the shape of a layer in still air, for a station at sea level.
    pub(crate) fn of(slab: &CloudSlab) -> Self {
        Self::still(slab, threshold(slab))
    }

    /// Returns the shape over the station's ground, carried by the wind's `drift`.
    pub(crate) fn carried(self, c: &Conditions, slab: &CloudSlab, drift: &LayerDrift) -> Self {
        Self {
            base_m: c.air.station_altitude_m + slab.base_m,
            drift_m: stretch(slab).inverse() * drift.way * slab.scale_m,
            evolution: DVec2::new(0.8, 0.6) * drift.lives,
            ..self
        }
    }

    /// Creates the shape of a layer in still air, for a threshold of the map and a station at sea level.
    pub(crate) fn still(slab: &CloudSlab, threshold: f64) -> Self {
        // 0 for sheets, 1 for heaps.
        let heaps = (2.0 * slab.convection).min(1.0) * (1.0 - slab.cellular);
        // 0 for fair-weather cumulus, 1 for cumulonimbus.
        let tall = (2.0 * slab.convection - 1.0).max(0.0);
        let sheet = mix(mix(0.35, 1.4, slab.cellular), mix(1.5, 0.2, tall), heaps);
        let dome = mix(sheet, 0.4, slab.fibre).max(mix(HIGHEST, HIGHEST_OF_TOWERS, tall) - threshold);
        // 0 for sheets, even if their cells are slightly convective (heaps up to 0.3), and 1 for heaps.
        let piled = ((heaps - 0.3) / 0.7).max(0.0);
        // Above `HEADS_AS_CLOUDS_M`, heads of heaps grow only as the distance from cloud to cloud to the power 0.4.
        let finer = (slab.scale_m / HEADS_AS_CLOUDS_M).max(1.0).powf(-0.6 * piled);
        let shape = Self {
            base_m: slab.base_m,
            thickness_m: slab.thickness_m,
            scale_m: slab.scale_m,
            extinction_per_m: slab.optical_depth / slab.thickness_m,
            threshold,
            dome,
            rough: mix(mix(mix(0.35, 0.5, slab.cellular), 0.9 * finer * mix(1.0, 0.7, tall), heaps), 1.2, slab.fibre),
            soft: mix(mix(mix(0.3, 0.12, heaps), 0.8, slab.cellular), 1.2, slab.fibre),
            cellular: slab.cellular,
            solid_m: mix(SOLID_CELLS, SOLID_CELLS_OF_FIBRES, slab.fibre) * finer * slab.scale_m,
            held: 1.4 * piled.max(slab.cellular) / (dome * dome),
            anvil: (ANVIL_BEYOND + 20.0 * (1.0 - slab.convection)).min(NO_ANVIL),
            stretch: stretch(slab),
            lean_m: stretch_toward(slab) * (LEAN * slab.fibre * slab.thickness_m),
            drift_m: DVec2::ZERO,
            evolution: DVec2::ZERO,
        };
        // Scale the extinction so that places with cloud have the layer's optical depth on average.
        Self { extinction_per_m: shape.extinction_per_m / filled_share(&shape), ..shape }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        clouds::field::{
            Map, Solid,
            cover::{field, typical},
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

    /// Returns the share of 4000 places of a layer that have cloud at a height, 0 to 1.
    fn share_at(field: &crate::clouds::field::Field<'_>, height: f64) -> f64 {
        let s = &field.shape;
        let place = |i: usize| DVec2::new((i % 63) as f64 * 0.7135, (i / 63) as f64 * 0.6131) * s.scale_m;
        let is_cloud = |i: &usize| {
            field.extinction_per_m(place(*i).extend(s.base_m + height * s.thickness_m)) > 0.1 * s.extinction_per_m
        };
        (0..4000).filter(is_cloud).count() as f64 / 4000.0
    }

    #[test]
    fn thunderclouds_have_anvils_and_no_heap_is_cut_flat() {
        let grown = (Map::new(3), Solid::new(3).unwrap());
        let at = |kind, cover, height| {
            let slab = typical(kind, cover).unwrap();
            share_at(&field(&slab, &grown, threshold(&slab)), height)
        };
        for cover in [0.1, 0.3] {
            let [tower, anvil, above] = [0.5, 0.9, 0.995].map(|h| at(CloudKind::Cumulonimbus, cover, h));
            println!(
                "cumulonimbus at {cover}: cloud over {tower:.3} half-way up, {anvil:.3} in the anvil, {above:.3} at the top"
            );
            assert!(anvil > 1.2 * tower && tower > 0.005 && above < 0.5 * anvil, "{tower} {anvil} {above}");
        }
        for kind in [CloudKind::Cumulus, CloudKind::ToweringCumulus] {
            let [low, top] = [0.2, 0.99].map(|h| at(kind, 0.5, h));
            println!("{kind:?}: cloud over {low:.3} low down, {top:.4} at the layer's top");
            assert!(top < 0.02 * low, "{kind:?}: {low} {top}");
        }
    }

    #[test]
    fn ice_is_drawn_out_along_the_wind() {
        let grown = (Map::new(3), Solid::new(3).unwrap());
        let off = |kind, along: DVec2| {
            let slab = crate::weather::CloudSlab { wind_m_s: [0.0, 30.0], ..typical(kind, 0.5).unwrap() };
            let field = field(&slab, &grown, threshold(&slab));
            let place = |i: usize| DVec2::new((i % 63) as f64 * 0.7135, (i / 63) as f64 * 0.6131) * slab.scale_m;
            let one = |i: usize| (field.strength(place(i)) - field.strength(place(i) + along * slab.scale_m)).abs();
            (0..2000).map(one).sum::<f64>() / 2000.0
        };
        let ratio = |kind| off(kind, DVec2::X * 0.2) / off(kind, DVec2::Y * 0.2);
        let [fibres, heaps] = [CloudKind::Cirrus, CloudKind::Cumulus].map(ratio);
        println!("change across the wind over that along it: cirrus {fibres:.2}, cumulus {heaps:.2}");
        assert!(fibres > 2.5 && (0.8..1.25).contains(&heaps), "{fibres} {heaps}");
    }
}
