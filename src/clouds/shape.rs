//! From a layer of the weather to the shape of its clouds.

use glam::DVec2;

use super::{cover::threshold, field::Shape};
use crate::weather::{CloudSlab, Conditions};

/// Speed of the wind that carries clouds over that at 10 m: at 100 m over open land it is 1.4 times as fast (log law, roughness 0.03 m),
/// and above the friction layer 1.3 times as fast as there (Stull 1988, chapter 1). One number for all weathers: clouds are where the air
/// that carries them has come, and another ratio would move all at once.
const ALOFT: f64 = 1.8;
/// Time in which the clouds of a layer come and go, s: a fair-weather cumulus lives some 20 minutes (Stull 1988, chapter 13).
const LIFE_S: f64 = 1200.0;

fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

impl Shape {
    /// Of a layer at a moment at which the wind at 10 m has carried the air so far.
    pub(crate) fn new(c: &Conditions, slab: &CloudSlab, drift_m: DVec2, time_s: f64) -> Self {
        Self {
            base_m: c.air.station_altitude_m + slab.base_m,
            drift_m: drift_m * ALOFT,
            evolution: DVec2::new(0.8, 0.6) * (time_s / LIFE_S),
            ..Self::still(slab, threshold(slab))
        }
    }

    /// Of a layer in still air over the sea, cut out of the map by a threshold.
    pub(super) fn still(slab: &CloudSlab, threshold: f64) -> Self {
        let heaps = (2.0 * slab.convection).min(1.0) * (1.0 - slab.cellular);
        let sheet = mix(mix(0.35, 1.4, slab.cellular), 1.5, heaps);
        Self {
            base_m: slab.base_m,
            thickness_m: slab.thickness_m,
            scale_m: slab.scale_m,
            extinction_per_m: slab.optical_depth / slab.thickness_m,
            threshold,
            dome: mix(sheet, 0.4, slab.fibre),
            rough: mix(mix(mix(0.35, 0.5, slab.cellular), 0.9, heaps), 0.8, slab.fibre),
            soft: mix(mix(0.3, 0.12, heaps), 1.2, slab.fibre),
            cellular: slab.cellular,
            drift_m: DVec2::ZERO,
            evolution: DVec2::ZERO,
        }
    }
}
