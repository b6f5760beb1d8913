//! Query for the layers over a place: the weather's layers where the wind has carried them, with a host's map of cover
//! and the cells of cloud over rain areas (`cells.rs`). Both pictures and queries use it.

use std::sync::Arc;

use glam::DVec3;

use super::{
    cells::{AreaClouds, edge_m},
    cover_threshold::CoverThreshold,
    layer::OverheadLayer,
    layer_map::LayerMaps,
    layers::CloudLayers,
    placed::AreaCells,
    shape::Shape,
    thresholds::{CLEAR, FILLED},
};
use crate::{
    clouds::model::CloudModel,
    error::Result,
    moment::{Scene, WeatherOver},
    weather::{CloudMap, CloudSlab},
};

/// Amount by which the excess that an anvil needs is lower in a cell over a rain area than in a layer of the weather.
/// Excess is the noise map's number less the threshold; cloud grows where it is above 0. Outwards across a cell's edge
/// the excess falls by `EDGE_SLOPE` over each length of [`Shape::scale_m`], the distance from cloud to cloud. The lower
/// need therefore moves the anvil's border outwards by `ANVIL_WIDER / EDGE_SLOPE` of these lengths.
const ANVIL_WIDER: f64 = 2.2;
/// Ratio of a cell's thickness to the distance from cloud to cloud. In a cell of a larger ratio, the heads (bulges) of
/// the clouds grow in proportion to the thickness. With smaller heads, the sides of so deep a cell would look like
/// hanging cloth.
const HEADS: f64 = 2.0;
/// Largest [`Shape::rough`] (amplitude of the solid noise, as an excess) to which larger heads raise that of a cell.
const MOST_ROUGH: f64 = 2.1;

/// Query for the layers of cloud at a place and a time.
pub(crate) struct LayersQuery<'a> {
    /// Scene of the place: its weather and position.
    pub scene: &'a Scene,
    /// The scene's place in the host's world, m.
    pub eye: DVec3,
    /// Weather of the context over places and times.
    pub weather: &'a WeatherOver<'a>,
    /// Simulation time, s.
    pub time_s: f64,
}

impl LayersQuery<'_> {
    /// Whether there can be no cloud: the weather has none here, and there are no rain areas.
    pub fn is_clear(&self) -> bool {
        self.scene.conditions.cloud_slabs().next().is_none() && self.weather.regions.is_empty()
    }

    /// Finds the layers for a model; `None` if the model draws no volume. `maps` is the cache of the layers that follow
    /// a host's cover map. `still` returns a layer's shape in still air: [`Shape::of`] or a cache of it.
    ///
    /// # Errors
    /// [`WeatherOver::check_time`] refuses times for which the weather is not known.
    pub fn layers(
        &self,
        model: CloudModel,
        maps: &mut LayerMaps,
        still: impl FnMut(&CloudSlab) -> Shape,
    ) -> Result<Option<CloudLayers>> {
        let drifts = self.weather.layers_until(self.time_s)?;
        let mut overhead = CloudLayers::new(model, self.scene, &drifts, still);
        if let Some(overhead) = &mut overhead {
            overhead.place(self, maps)?;
        }
        Ok(overhead)
    }
}

impl CloudLayers {
    /// Applies a host's map of cover, and adds the cells over rain areas.
    ///
    /// # Errors
    /// [`WeatherOver::check_time`] refuses times for which the weather is not known.
    fn place(&mut self, query: &LayersQuery<'_>, maps: &mut LayerMaps) -> Result<()> {
        let LayersQuery { scene, eye, weather, time_s } = *query;
        if let Some(map) = weather.cloud_map {
            self.follow(map, maps);
        }
        if weather.regions.is_empty() {
            return Ok(());
        }
        let clouds = AreaClouds::new(weather, &scene.conditions, scene.world_to_enu, eye, self.place_m, time_s)?;
        let Some(clouds) = clouds else { return Ok(()) };
        if let Some(layer) = self.bring(scene, &clouds) {
            let slab = &self.all()[layer].slab;
            let filled = CoverThreshold::of(&Shape::still(slab, FILLED));
            let cells = clouds.cells.map(|cell| cell.with_edge(edge_m(slab)));
            self.areas = Some(AreaCells { cells, count: clouds.count, layer, filled });
        }
        Ok(())
    }

    /// Applies a host's map of cover to the layers whose bases lie in the map's range ([`CloudMap::base_m`]).
    fn follow(&mut self, map: &Arc<CloudMap>, made: &mut LayerMaps) {
        let count = self.all().len();
        for i in 0..count {
            let slab = self.all()[i].slab;
            if map.is_of(slab.base_m) {
                self.maps[i] = Some(made.get(&slab, map));
            }
        }
        if self.maps.iter().any(Option::is_some) {
            // All layers become volumes: a deck would be grey also where the map leaves gaps.
            self.show_all();
        }
    }

    /// Adds a layer that has cloud only in the cells over rain areas. Returns its index; `None` if the areas need no
    /// cells or the list of layers is full.
    ///
    /// In a deep cell the heads grow by the factor k = thickness / (`HEADS` x distance from cloud to cloud), which is
    /// at least 1. The side of the cube in which the solid noise repeats grows by k, and the noise's amplitude by k^2
    /// up to `MOST_ROUGH`.
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
}
