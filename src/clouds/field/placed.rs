//! Local cloud cover that overrides a layer's own: a host's map of cover (`CloudMap`), and cells of cloud over rain
//! areas, so that no rain falls out of a clear sky. `shaders/clouds/placed.wgsl` has the same formulas.
//!
//! # Model
//! Where a layer has a cover of its own at a place, its clouds are cut out of the field as in a whole layer with this
//! cover: with the threshold, dome and extinction of the cover. For a map these three are found at the middle of each
//! cell and interpolated between the middles.
//!
//! Cells over rain areas ([`super::cells`]) are a separate layer with cloud nowhere else. Over an area the layer is
//! overcast. Beyond the area's border its cover falls to 0 across the cell's edge, which is several clouds wide, so
//! that the field gives the edge its shape.

use std::sync::Arc;

use glam::DVec2;

use super::{
    cells::AreaCell,
    cover_threshold::CoverThreshold,
    layer_map::LayerMap,
    shape::Shape,
    thresholds::{CLEAR, FILLED},
};
use crate::falling::MAX_AREAS;

/// Cells of cloud over rain areas, and the threshold inside them.
#[derive(Clone, Copy, Debug)]
pub struct AreaCells {
    /// Cells, of which the first `count` are in use.
    pub(crate) cells: [AreaCell; MAX_AREAS],
    /// Number of cells.
    pub(crate) count: usize,
    /// Index of the layer that has the cells.
    pub(crate) layer: usize,
    /// Threshold, dome and extinction inside the cells.
    pub(crate) filled: CoverThreshold,
}

impl AreaCells {
    /// Returns the cells that are in use.
    pub(crate) fn all(&self) -> &[AreaCell] {
        &self.cells[..self.count]
    }

    /// Returns the largest change of the threshold per metre.
    pub(crate) fn slope_per_m(&self) -> f64 {
        let rim_m = self.all().iter().map(|cell| cell.rim_m).fold(f64::INFINITY, f64::min);
        (CLEAR - FILLED) / rim_m
    }

    /// Returns a hash of the cells, to detect changes.
    pub(super) fn fingerprint(&self) -> f64 {
        self.all().iter().map(|c| c.center_m.dot(DVec2::new(1.0, 0.7)) + c.semi_m.x + c.semi_m.y + c.rim_m).sum()
    }
}

/// Local cover that overrides a layer's own.
#[derive(Clone, Debug, Default)]
pub struct LocalCover {
    /// Layer under the host's cover map.
    pub(super) map: Option<Arc<LayerMap>>,
    /// Cells over rain areas.
    pub(super) areas: Option<Arc<AreaCells>>,
}

impl LocalCover {
    /// Creates the local cover of a map alone.
    #[cfg(test)]
    pub(crate) fn under(map: Arc<LayerMap>) -> Self {
        Self { map: Some(map), areas: None }
    }

    /// Gives `shape` the local cover at a place, m east and north of the world's origin. Returns the distance within
    /// which the threshold stays the same, m, and its largest change per metre beyond.
    pub(crate) fn shape_at(&self, place_m: DVec2, shape: &mut Shape) -> [f64; 2] {
        let (mut steady_m, mut slope_per_m) = (f64::INFINITY, 0.0);
        let mut cut = CoverThreshold::of(shape);
        if let Some(map) = &self.map {
            (cut, steady_m) = map.at(place_m);
            slope_per_m = map.slope_per_m;
        }
        if let Some(areas) = &self.areas {
            let mut most = 0.0f64;
            for cell in areas.all() {
                let (share, away_m) = cell.at(place_m);
                (most, steady_m) = (most.max(share), steady_m.min(away_m));
            }
            cut = cut.mix(&areas.filled, most);
            slope_per_m += areas.slope_per_m();
        }
        if self.map.is_some() || self.areas.is_some() {
            cut.put(shape);
        }
        [steady_m, slope_per_m]
    }
}
