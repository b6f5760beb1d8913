//! Layers of cloud over a place: which of them are volumes, which are a deck, and where the wind has carried them.

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

/// Heights of a closed layer's base over the camera between which the volume takes the deck's place, m.
const DECK_FROM_M: [f64; 2] = [200.0, 400.0];
/// Slant depths of a closed layer between which the sun's disc in it pales to a tenth of what is around it: a deck
/// shows none.
const DISC_PALES: [f64; 2] = [12.0, 14.0];

/// Layers of cloud over a place.
pub(crate) struct CloudLayers {
    layers: [OverheadLayer; MAX_CLOUD_LAYERS],
    count: usize,
    /// Number of layers of which something is drawn as a volume: the first ones, since only the uppermost are decks.
    drawn: usize,
    /// Some of what is above the place is drawn as a deck.
    pub has_deck: bool,
    /// East and north of the world's origin, m.
    pub place_m: DVec2,
    /// Diameter of the droplets, um, one of those for which tables are made.
    pub liquid_um: f64,
    /// How far the wind has carried the layers.
    pub drifts: LayerDrifts,
    /// Map of each layer whose clouds are other than its cover says; and (`areas`) the cells over rain areas
    /// ([`super::placed`]).
    pub maps: [Option<Arc<LayerMap>>; MAX_CLOUD_LAYERS],
    /// See `maps`.
    pub areas: Option<AreaCells>,
}

/// How much of the lowest layer above the camera is drawn as a volume. A closed one that hides the sky, seen from
/// further below, is a deck in the same light: nothing else is seen of it.
fn volume_share(scene: &Scene, lowest: &CloudSlab) -> f64 {
    if lowest.cover < 1.0 || scene.deck_cover < 1.0 {
        return 1.0;
    }
    let over_m = scene.conditions.air.station_altitude_m + lowest.base_m - scene.place.altitude_m;
    let near = 1.0 - smoothstep(DECK_FROM_M[0], DECK_FROM_M[1], over_m);
    let depth = lowest.optical_depth / scene.brighter().direction.z.max(0.01);
    near.max(1.0 - smoothstep(DISC_PALES[0], DISC_PALES[1], depth))
}

/// Width over which a pixel looks, pixels, and that from which on clouds in it differ, in distances from cloud to
/// cloud; both of `shaders/clouds`.
pub(crate) const PIXEL_BLUR: f64 = 1.4;
pub(crate) const BLUR_FROM: f64 = 0.15;

impl CloudLayers {
    /// Says whether one pixel spans several clouds of a layer below the camera, as far as its horizon; `pixel` in
    /// radians.
    pub fn is_coarse(&self, scene: &Scene, radius_m: f64, pixel: f64) -> bool {
        let coarse = |layer: &OverheadLayer| {
            let over_m = (scene.place.altitude_m - layer.shape.base_m).max(0.0);
            let farthest_m = (over_m * (2.0 * radius_m + over_m)).sqrt();
            PIXEL_BLUR * pixel * farthest_m > BLUR_FROM * layer.shape.scale_m
        };
        self.layers().iter().any(coarse)
    }

    /// Creates the layers at a scene's place for a model, where the wind has carried them by `drifts`; `None` where the
    /// model is no volume. `still`: [`Shape::of`], or a cache of it.
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
        // What is above a deck is hidden by it.
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

    /// Its layers of which something is drawn as a volume, from below.
    pub fn layers(&self) -> &[OverheadLayer] {
        &self.layers[..self.drawn]
    }

    /// All of them: what is drawn as a deck is cloud all the same.
    pub fn all(&self) -> &[OverheadLayer] {
        &self.layers[..self.count]
    }

    /// How far the wind has carried the lowest layer since these were the drifts, m east and north.
    pub fn carried_since(&self, earlier: &LayerDrifts) -> DVec2 {
        let OverheadLayer { slot, shape, .. } = &self.layers[0];
        shape.stretch.inverse() * (self.drifts.slots[*slot].way - earlier.slots[*slot].way) * shape.scale_m
    }

    /// Whether some of it leaves gaps.
    pub fn is_broken(&self) -> bool {
        self.is_placed() || self.layers().iter().any(|layer| layer.slab.cover < 1.0)
    }

    /// Draws nothing as a deck.
    pub fn show_all(&mut self) {
        self.layers.iter_mut().for_each(|layer| layer.share = 1.0);
        (self.drawn, self.has_deck) = (self.count, false);
    }

    /// Puts a layer among the others by its base; answers its place, or none where there is no room.
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
    /// Where the clouds of one of [`CloudLayers::all`] are other than its cover says.
    pub(crate) fn placed(&self, layer: usize) -> LocalCover {
        let areas = self.areas.as_ref().filter(|areas| areas.layer == layer);
        LocalCover { map: self.maps[layer].clone(), areas: areas.map(|areas| Arc::new(*areas)) }
    }

    /// Whether any are.
    pub(crate) fn is_placed(&self) -> bool {
        self.areas.is_some() || self.maps.iter().any(Option::is_some)
    }

    /// A number that changes as the cells over areas do, and one that is other for another map.
    pub(crate) fn fingerprint(&self) -> (f64, usize) {
        let map = self.maps.iter().flatten().next().map_or(0, |made| Arc::as_ptr(&made.map) as usize);
        (self.areas.as_ref().map_or(0.0, AreaCells::fingerprint), map)
    }

    /// Whether any of it may be seen along a direction.
    pub fn lies_toward(&self, scene: &Scene, direction: DVec3) -> bool {
        let at_m = scene.place.altitude_m;
        self.layers().iter().any(|layer| {
            let (base, top) = (layer.shape.base_m, layer.shape.base_m + layer.shape.thickness_m);
            (direction.z > 0.0 && top > at_m) || (direction.z < 0.0 && base < at_m)
        })
    }
}
