//! From a layer of the weather to the shape of its clouds.

use glam::DVec2;

use super::{cover::threshold, field::Shape};
use crate::weather::{CloudSlab, Conditions};

/// Height above which the wind no longer grows, m: that of the profile's end.
const FREE_WIND_M: f64 = 100.0;
/// Speed of the wind above the friction layer over that at its lower end (Stull 1988, chapter 1: winds of the lowest hundred metres are
/// some three quarters of the geostrophic).
const ABOVE_FRICTION: f64 = 1.3;
/// Time in which the clouds of a layer come and go, s: a fair-weather cumulus lives some 20 minutes (Stull 1988, chapter 13).
const LIFE_S: f64 = 1200.0;

fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// Wind of a layer over that at 10 m.
fn faster(c: &Conditions) -> f64 {
    let near = c.wind.speed_m_s();
    if near > 1e-6 { ABOVE_FRICTION * c.wind.speed_at_height_m_s(FREE_WIND_M) / near } else { 0.0 }
}

impl Shape {
    /// Of a layer at a moment at which the wind at 10 m has carried the air so far.
    pub(crate) fn new(c: &Conditions, slab: &CloudSlab, drift_m: DVec2, time_s: f64) -> Self {
        Self {
            base_m: c.air.station_altitude_m + slab.base_m,
            drift_m: drift_m * faster(c),
            evolution: DVec2::new(0.8, 0.6) * (time_s / LIFE_S),
            ..Self::still(slab, threshold(slab))
        }
    }

    /// Of a layer in still air over the sea, cut out of the map by a threshold.
    pub(super) fn still(slab: &CloudSlab, threshold: f64) -> Self {
        let heaps = (2.0 * slab.convection).min(1.0) * (1.0 - slab.cellular);
        let sheet = mix(mix(0.35, 0.6, slab.cellular), 1.5, heaps);
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
