//! Layers of cloud over a place: which are drawn as volumes, which as a deck, and how far the wind has carried them.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{
    droplets::nearest_diameter,
    layer::OverheadLayer,
    layer_map::LayerMap,
    placed::{AreaCells, LocalCover},
    shape::Shape,
};
use crate::{
    clouds::model::CloudModel,
    moment::Scene,
    numerics::smoothstep,
    weather::{CloudSlab, MAX_CLOUD_LAYERS},
    wind::LayerDrifts,
};

/// Heights of a closed layer's base above the camera between which the volume changes to the deck, m.
const DECK_FROM_M: [f64; 2] = [200.0, 400.0];
/// Slant optical depths of a closed layer between which the volume changes to the deck. At these depths the sun's disc,
/// seen through the layer, pales to a tenth of its surroundings. A deck shows no disc.
const DISC_PALES: [f64; 2] = [12.0, 14.0];

/// Layers of cloud over a place, both above and below its altitude.
pub(crate) struct CloudLayers {
    /// Layers from the lowest up, of which the first `count` are in use.
    layers: [OverheadLayer; MAX_CLOUD_LAYERS],
    /// Number of layers.
    count: usize,
    /// Number of layers of which a share is drawn as a volume. They come first, since only the uppermost are decks.
    drawn: usize,
    /// Whether a share of the layers above the place is drawn as a deck.
    pub has_deck: bool,
    /// Position of the place east and north of the world's origin, m.
    pub place_m: DVec2,
    /// Diameter of the droplets, um: one of those that have tables.
    pub liquid_um: f64,
    /// How far the wind has carried the layers.
    pub drifts: LayerDrifts,
    /// Cover map of each layer for which the host gives one ([`super::placed`]).
    pub maps: [Option<Arc<LayerMap>>; MAX_CLOUD_LAYERS],
    /// Cells over rain areas.
    pub areas: Option<AreaCells>,
}

/// Returns the share of the lowest layer above the camera that is drawn as a volume. A closed layer that hides the sky
/// looks the same as a deck from further below.
fn volume_share(scene: &Scene, lowest: &CloudSlab) -> f64 {
    if lowest.cover < 1.0 || scene.deck_cover < 1.0 {
        return 1.0;
    }
    let over_m = scene.conditions.air.station_altitude_m + lowest.base_m - scene.place.altitude_m;
    let near = 1.0 - smoothstep(DECK_FROM_M[0], DECK_FROM_M[1], over_m);
    let depth = lowest.optical_depth / scene.brighter().direction.z.max(0.01);
    near.max(1.0 - smoothstep(DISC_PALES[0], DISC_PALES[1], depth))
}

/// Width of a pixel's filter, pixels. `shaders/clouds` repeats this number and [`BLUR_FROM`].
pub(crate) const PIXEL_BLUR: f64 = 1.4;
/// Width of a pixel, in distances from cloud to cloud, above which clouds are blurred.
pub(crate) const BLUR_FROM: f64 = 0.15;

impl CloudLayers {
    /// Whether one pixel spans several clouds of a layer below the camera, at any distance up to the horizon. `pixel`
    /// is the angle of a pixel, rad.
    pub fn is_coarse(&self, scene: &Scene, radius_m: f64, pixel: f64) -> bool {
        let coarse = |layer: &OverheadLayer| {
            let over_m = (scene.place.altitude_m - layer.shape.base_m).max(0.0);
            let farthest_m = (over_m * (2.0 * radius_m + over_m)).sqrt();
            PIXEL_BLUR * pixel * farthest_m > BLUR_FROM * layer.shape.scale_m
        };
        self.layers().iter().any(coarse)
    }

    /// Creates the layers at a scene's place, carried by the wind's `drifts`. `None` if the model is not a volume.
    /// `still` is [`Shape::of`] or a cache of it.
    pub fn new(
        model: CloudModel,
        scene: &Scene,
        drifts: &LayerDrifts,
        mut still: impl FnMut(&CloudSlab) -> Shape,
    ) -> Option<Self> {
        let slots = || scene.conditions.clouds.iter().enumerate().filter(|(_, s)| s.cover > 0.0);
        let slabs = || slots().map(|(_, slab)| slab);
        if model == CloudModel::Deck {
            return None;
        }
        let (station_m, above_m) = (scene.conditions.air.station_altitude_m, scene.place.altitude_m);
        let is_above = |s: &CloudSlab| station_m + s.base_m > above_m;
        // A deck hides the layers above it.
        let share = slabs().find(|s| is_above(s)).map_or(1.0, |lowest| volume_share(scene, lowest));
        let mut layer = |(slot, slab): (usize, &CloudSlab)| OverheadLayer {
            shape: still(slab).carried(&scene.conditions, slab, &drifts.slots[slot]),
            slab: *slab,
            slot,
            share: if is_above(slab) { share } else { 1.0 },
        };
        let mut overhead = Self {
            layers: [layer(slots().next().unwrap_or((0, &CloudSlab::NONE))); MAX_CLOUD_LAYERS],
            has_deck: share < 1.0,
            count: 0,
            drawn: 0,
            place_m: DVec2::from_array(scene.map_m),
            liquid_um: nearest_diameter(slabs()),
            drifts: *drifts,
            maps: Default::default(),
            areas: None,
        };
        for layer in slots().map(layer) {
            overhead.layers[overhead.count] = layer;
            overhead.count += 1;
            overhead.drawn += usize::from(layer.share > 0.0);
        }
        Some(overhead)
    }

    /// Returns the layers of which a share is drawn as a volume, from the lowest.
    pub fn layers(&self) -> &[OverheadLayer] {
        &self.layers[..self.drawn]
    }

    /// Returns all layers, with those that are drawn as a deck.
    pub fn all(&self) -> &[OverheadLayer] {
        &self.layers[..self.count]
    }

    /// Returns the distance that the wind has carried the lowest layer since `earlier`, m east and north.
    pub fn carried_since(&self, earlier: &LayerDrifts) -> DVec2 {
        let OverheadLayer { slot, shape, .. } = &self.layers[0];
        shape.stretch.inverse() * (self.drifts.slots[*slot].way - earlier.slots[*slot].way) * shape.scale_m
    }

    /// Whether the drawn layers leave gaps.
    pub fn is_broken(&self) -> bool {
        self.is_placed() || self.layers().iter().any(|layer| layer.slab.cover < 1.0)
    }

    /// Makes all layers volumes, none a deck.
    pub fn show_all(&mut self) {
        self.layers.iter_mut().for_each(|layer| layer.share = 1.0);
        (self.drawn, self.has_deck) = (self.count, false);
    }

    /// Inserts a layer in the order of bases, and makes all layers volumes. Returns the layer's index, or `None` if the
    /// list is full.
    pub fn insert(&mut self, layer: OverheadLayer) -> Option<usize> {
        if self.count == MAX_CLOUD_LAYERS {
            return None;
        }
        let place = self.all().iter().take_while(|other| other.shape.base_m <= layer.shape.base_m).count();
        self.layers[place..=self.count].rotate_right(1);
        self.maps[place..=self.count].rotate_right(1);
        (self.layers[place], self.maps[place]) = (layer, None);
        self.count += 1;
        if self.count == 1 {
            self.liquid_um = nearest_diameter([CloudSlab { cover: 1.0, ..layer.slab }].iter());
        }
        self.show_all();
        Some(place)
    }
}

impl CloudLayers {
    /// Returns the local cover of the layer with an index in [`CloudLayers::all`].
    pub(crate) fn placed(&self, layer: usize) -> LocalCover {
        let areas = self.areas.as_ref().filter(|areas| areas.layer == layer);
        LocalCover { map: self.maps[layer].clone(), areas: areas.map(|areas| Arc::new(*areas)) }
    }

    /// Whether any layer has local cover.
    pub(crate) fn is_placed(&self) -> bool {
        self.areas.is_some() || self.maps.iter().any(Option::is_some)
    }

    /// Returns a hash of the cells over areas and the address of a map, to detect changes.
    pub(crate) fn fingerprint(&self) -> (f64, usize) {
        let map = self.maps.iter().flatten().next().map_or(0, |made| Arc::as_ptr(&made.map) as usize);
        (self.areas.as_ref().map_or(0.0, AreaCells::fingerprint), map)
    }

    /// Whether a layer may be seen along a direction.
    pub fn lies_toward(&self, scene: &Scene, direction: DVec3) -> bool {
        let at_m = scene.place.altitude_m;
        self.layers().iter().any(|layer| {
            let (base, top) = (layer.shape.base_m, layer.shape.base_m + layer.shape.thickness_m);
            (direction.z > 0.0 && top > at_m) || (direction.z < 0.0 && base < at_m)
        })
    }
}
