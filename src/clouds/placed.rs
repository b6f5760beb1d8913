//! Local cloud cover that overrides a layer's own: a host's map of cover ([`CloudMap`]), and cells of cloud over rain
//! areas, so that no rain falls out of a clear sky. Twin of `shaders/clouds/placed.wgsl`.
//!
//! # Model
//! A part of a layer with a cover of its own is cut out of the field as all of a layer with this cover is: by
//! threshold, dome and extinction of that cover. These are found for each cell of a map, and go over from middle to
//! middle.
//!
//! Cells over rain areas ([`super::cells`]) are a layer of their own, which is nowhere else: over an area it is closed,
//! and opens across an edge beyond the area's border, a little wider than its clouds are, so that the field shapes it.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{
    cells::{AreaCell, AreaClouds, CLEAR, FILLED, edge_m},
    cover::threshold,
    field::Shape,
    layer_map::{LayerMap, LayerMaps},
    overhead::{CloudLayers, OverheadLayer},
    uniforms::{AreaUniform, LAYERS, LayerUniform},
};
use crate::{
    error::Result,
    falling::MAX_AREAS,
    moment::{Scene, WeatherOver},
    weather::{CloudMap, CloudSlab},
};

/// Least cover that has clouds: below it the threshold rises to [`CLEAR`].
const LEAST: f64 = 1e-3;
/// Cover from which on dome and extinction follow it.
const SHAPED_FROM: f64 = 0.02;
/// How much less excess the anvil of such a cell needs than that of a layer: across its edge, by [`EDGE_SLOPE`], it
/// reaches this much over that many distances from cloud to cloud farther than its towers.
const ANVIL_WIDER: f64 = 2.2;
/// Thickness of a cell over the distance from cloud to cloud from which on its heads grow with its height, and how
/// rough they make it at most: by the map alone its sides would hang like curtains.
const HEADS: f64 = 2.0;
const MOST_ROUGH: f64 = 2.1;

/// Threshold by which one place of a layer is cut out, with its dome and extinction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CoverThreshold {
    pub threshold: f64,
    pub dome: f64,
    pub extinction_per_m: f64,
}

impl CoverThreshold {
    fn of(shape: &Shape) -> Self {
        Self { threshold: shape.threshold, dome: shape.dome, extinction_per_m: shape.extinction_per_m }
    }

    /// Creates the threshold of a layer of this cover.
    pub(super) fn with_cover(slab: &CloudSlab, cover: f64) -> Self {
        let at = |cover: f64| threshold(&CloudSlab { cover, ..*slab });
        let own = at(cover.max(LEAST));
        let shaped = Shape::still(slab, at(cover.max(SHAPED_FROM)));
        let threshold = CLEAR + (own - CLEAR) * (cover / LEAST).min(1.0);
        Self { threshold, ..Self::of(&shaped) }
    }

    pub(super) fn mix(self, to: &Self, t: f64) -> Self {
        let between = |a: f64, b: f64| a + (b - a) * t;
        Self {
            threshold: between(self.threshold, to.threshold),
            dome: between(self.dome, to.dome),
            extinction_per_m: between(self.extinction_per_m, to.extinction_per_m),
        }
    }

    fn put(&self, shape: &mut Shape) {
        let piled = shape.held * shape.dome * shape.dome;
        (shape.threshold, shape.dome, shape.extinction_per_m) = (self.threshold, self.dome, self.extinction_per_m);
        shape.held = piled / (self.dome * self.dome);
    }
}

/// Cells of cloud over rain areas, and what fills them.
#[derive(Clone, Copy, Debug)]
pub struct AreaCells {
    pub(super) cells: [AreaCell; MAX_AREAS],
    pub(super) count: usize,
    /// The layer that they are cells of.
    pub(super) layer: usize,
    pub(super) filled: CoverThreshold,
}

impl AreaCells {
    pub(super) fn all(&self) -> &[AreaCell] {
        &self.cells[..self.count]
    }

    /// Most that thresholds change a metre.
    pub(super) fn slope_per_m(&self) -> f64 {
        let rim_m = self.all().iter().map(|cell| cell.rim_m).fold(f64::INFINITY, f64::min);
        (CLEAR - FILLED) / rim_m
    }

    /// Hash of the cells, to notice changes.
    fn fingerprint(&self) -> f64 {
        self.all().iter().map(|c| c.center_m.dot(DVec2::new(1.0, 0.7)) + c.semi_m.x + c.semi_m.y + c.rim_m).sum()
    }
}

/// Where a layer's clouds are other than its cover says.
#[derive(Clone, Debug, Default)]
pub struct LocalCover {
    map: Option<Arc<LayerMap>>,
    areas: Option<Arc<AreaCells>>,
}

impl LocalCover {
    /// By a map alone.
    #[cfg(test)]
    pub(super) fn under(map: Arc<LayerMap>) -> Self {
        Self { map: Some(map), areas: None }
    }

    /// Makes a layer's shape that of a place, m east and north of the world's origin. Answers within which distance the
    /// place's threshold stays, m, and how much it changes a metre beyond.
    pub(super) fn shape_at(&self, place_m: DVec2, shape: &mut Shape) -> [f64; 2] {
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

impl CloudLayers {
    /// Puts clouds where a host's map says, and over rain areas. `eye` is the place in the host's world.
    ///
    /// # Errors
    /// For a time that the weather does not know.
    pub(super) fn place(
        &mut self,
        (scene, eye): (&Scene, DVec3),
        (over, time_s): (&WeatherOver<'_>, f64),
        made: &mut LayerMaps,
    ) -> Result<()> {
        if let Some(map) = over.cloud_map {
            self.follow(map, made);
        }
        if over.regions.is_empty() {
            return Ok(());
        }
        let at = (scene.world_to_enu, eye, self.place_m);
        let Some(clouds) = AreaClouds::new(over, &scene.conditions, at, time_s)? else { return Ok(()) };
        if let Some(layer) = self.bring(scene, &clouds) {
            let slab = &self.all()[layer].slab;
            let filled = CoverThreshold::of(&Shape::still(slab, FILLED));
            let cells = clouds.cells.map(|cell| cell.with_edge(edge_m(slab)));
            self.areas = Some(AreaCells { cells, count: clouds.count, layer, filled });
        }
        Ok(())
    }

    /// Lets layers follow a map.
    fn follow(&mut self, map: &Arc<CloudMap>, made: &mut LayerMaps) {
        let count = self.all().len();
        for i in 0..count {
            let slab = self.all()[i].slab;
            if map.is_of(slab.base_m) {
                self.maps[i] = Some(made.get(&slab, map));
            }
        }
        if self.maps.iter().any(Option::is_some) {
            // A deck would close what the map leaves open elsewhere.
            self.show_all();
        }
    }

    /// Puts the layer of cells over areas among the others. None where they need none.
    fn bring(&mut self, scene: &Scene, clouds: &AreaClouds) -> Option<usize> {
        let others = self.all().iter().zip(&self.maps).map(|(layer, map)| (&layer.slab, map.is_some()));
        let slab = clouds.slab(others)?;
        let filled = Shape::still(&slab, FILLED);
        let anvil = if filled.anvil < 0.0 { filled.anvil - ANVIL_WIDER } else { filled.anvil };
        let base_m = scene.conditions.air.station_altitude_m + slab.base_m;
        let larger = (slab.thickness_m / (HEADS * slab.scale_m)).max(1.0);
        let rough = (larger * larger * filled.rough).min(MOST_ROUGH.max(filled.rough));
        let solid_m = larger * filled.solid_m;
        let shape = Shape { base_m, threshold: CLEAR, anvil, rough, solid_m, ..filled };
        let slot = scene.conditions.clouds.iter().position(|s| s.cover <= 0.0)?;
        self.insert(OverheadLayer { shape, slab, slot, share: 1.0 })
    }

    /// Where the clouds of one of [`CloudLayers::all`] are other than its cover says.
    pub(super) fn placed(&self, layer: usize) -> LocalCover {
        let areas = self.areas.as_ref().filter(|areas| areas.layer == layer);
        LocalCover { map: self.maps[layer].clone(), areas: areas.map(|areas| Arc::new(*areas)) }
    }

    /// Whether any are.
    pub(super) fn is_placed(&self) -> bool {
        self.areas.is_some() || self.maps.iter().any(Option::is_some)
    }

    /// A number that changes as the cells over areas do, and one that is other for another map.
    pub(super) fn fingerprint(&self) -> (f64, usize) {
        let map = self.maps.iter().flatten().next().map_or(0, |made| Arc::as_ptr(&made.map) as usize);
        (self.areas.as_ref().map_or(0.0, AreaCells::fingerprint), map)
    }

    /// Puts what shaders know of it into the blocks of layers.
    pub(super) fn place_uniforms(&self, layers: &mut [LayerUniform; LAYERS]) {
        if !self.is_placed() {
            return;
        }
        let mut row = 0;
        for (i, (to, layer)) in layers.iter_mut().zip(self.layers()).enumerate() {
            let piled = layer.shape.held * layer.shape.dome * layer.shape.dome;
            to.cells[2] = piled as f32;
            if let Some(LayerMap { map, slope_per_m, .. }) = self.maps[i].as_deref() {
                let camera = (self.place_m - DVec2::from_array(map.first_m)) / map.cell_m;
                to.mapped = [camera.x, camera.y, 1.0 / map.cell_m, f64::from(row)].map(|v| v as f32);
                to.cells = [map.cells[0] as f32, map.cells[1] as f32, piled as f32, *slope_per_m as f32];
                row += map.cells[1];
            }
            if let Some(areas) = self.areas.as_ref().filter(|areas| areas.layer == i) {
                let CoverThreshold { threshold, dome, extinction_per_m } = areas.filled;
                to.filled = [threshold, dome, extinction_per_m, areas.count as f64].map(|v| v as f32);
                to.cells[3] += areas.slope_per_m() as f32;
            }
        }
    }

    /// The cells over rain areas as shaders know them.
    pub(super) fn area_uniforms(&self) -> [AreaUniform; MAX_AREAS] {
        let one = |cell: &AreaCell| {
            let center = cell.center_m - self.place_m;
            AreaUniform {
                place: [center.x, center.y, cell.right.x, cell.right.y].map(|v| v as f32),
                extent: [cell.semi_m.x, cell.semi_m.y, cell.rim_m, cell.semi_m.min_element()].map(|v| v as f32),
            }
        };
        let cells = self.areas.map_or([AreaCell::default(); MAX_AREAS], |areas| areas.cells);
        cells.map(|cell| one(&cell))
    }
}
