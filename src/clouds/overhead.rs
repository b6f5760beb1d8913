//! Cloud layers around a camera or a queried place: layers as volumes, how much of them is a deck, and the light on
//! them.

use std::{f64::consts::PI, sync::Arc};

use glam::{DVec2, DVec3};

use super::{
    CloudModel,
    field::Shape,
    layer_map::LayerMap,
    placed::AreaCells,
    uniforms::{LAYERS, LayerLight},
};
use crate::{
    moment::Scene,
    weather::{CloudSlab, smoothstep},
    wind::LayerDrifts,
    world::light_above_clouds,
};

/// Number of the medium that is ice.
pub(super) const ICE: usize = 1;
/// Diameters of droplets for which tables are made, um.
pub(super) const LIQUID_UM: [f64; 5] = [8.0, 12.0, 16.0, 20.0, 30.0];
/// Heights of a closed layer's base over the camera between which the volume takes the deck's place, m.
const DECK_FROM_M: [f64; 2] = [200.0, 400.0];
/// Slant depths of a closed layer between which the sun's disc in it pales to a tenth of what is around it: a deck
/// shows none.
const DISC_PALES: [f64; 2] = [12.0, 14.0];

/// A layer of cloud, and how much of it is drawn as a volume: the rest is drawn as a deck.
#[derive(Clone, Copy)]
pub(super) struct OverheadLayer {
    pub shape: Shape,
    pub slab: CloudSlab,
    /// Its slot among those of the conditions.
    pub slot: usize,
    pub share: f64,
}

/// Layers of cloud over a place.
pub(super) struct CloudLayers {
    layers: [OverheadLayer; LAYERS],
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
    pub maps: [Option<Arc<LayerMap>>; LAYERS],
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

/// Returns the diameter nearest to the droplets of these layers, of those that there are tables for.
pub(super) fn nearest_diameter<'a>(slabs: impl Iterator<Item = &'a CloudSlab>) -> f64 {
    let add = |(water, sum): (f64, f64), s: &CloudSlab| {
        let liquid = s.cover * (1.0 - s.ice_fraction);
        (water + liquid, sum + liquid * s.droplet_radius_um)
    };
    let (water, sum) = slabs.fold((0.0, 0.0), add);
    let diameter = (2.0 * sum / water.max(1e-6)).max(1.0);
    let off = |um: &f64| (um / diameter).ln().abs();
    LIQUID_UM.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(diameter)
}

/// Width over which a pixel looks, pixels, and that from which on clouds in it differ, in distances from cloud to
/// cloud; both of `shaders/clouds`.
pub(super) const PIXEL_BLUR: f64 = 1.4;
pub(super) const BLUR_FROM: f64 = 0.15;

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
            layers: [layer(slots().next().unwrap_or((0, &CloudSlab::NONE))); LAYERS],
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
    pub fn carried_since(&self, before: &LayerDrifts) -> DVec2 {
        let OverheadLayer { slot, shape, .. } = &self.layers[0];
        shape.stretch.inverse() * (self.drifts.slots[*slot].way - before.slots[*slot].way) * shape.scale_m
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
        if self.count == LAYERS {
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
    /// Whether any of it may be seen along a direction.
    pub fn lies_toward(&self, scene: &Scene, direction: DVec3) -> bool {
        let at_m = scene.place.altitude_m;
        self.layers().iter().any(|layer| {
            let (base, top) = (layer.shape.base_m, layer.shape.base_m + layer.shape.thickness_m);
            (direction.z > 0.0 && top > at_m) || (direction.z < 0.0 && base < at_m)
        })
    }

    /// The mean light of its broken clouds as they look from the place, cd/m^2, their cover, and how far the base of
    /// the lowest of them lies over it, m. From below half of what is seen is lit from above and half through the
    /// cloud, from above all is lit.
    pub fn mean_radiance_and_cover(&self, scene: &Scene) -> ([f32; 4], f32) {
        let (mut light, mut clear, mut over) = ([0.0; 3], 1.0, f64::INFINITY);
        for layer in self.layers() {
            let (shape, cover) = (&layer.shape, layer.slab.cover);
            let of = light_on(scene, (shape, self.is_placed()), 1.0);
            // Bohren 1987 (American Journal of Physics 55, 524): what even cloud lets through, of g 0.85.
            let through = 2.0 / (2.0 + 0.15 * layer.slab.optical_depth);
            let is_over = shape.base_m > scene.place.altitude_m;
            let seen = if is_over { 0.5 } else { 1.0 - through };
            let level = scene.brighter().direction.z.max(0.0);
            for (i, light) in light.iter_mut().enumerate() {
                *light += cover * clear * seen * (of.sun[i] * level / PI + of.above[i]);
            }
            over = over
                .min(if is_over { shape.base_m } else { shape.base_m + shape.thickness_m } - scene.place.altitude_m);
            clear *= 1.0 - cover;
        }
        let cover = 1.0 - clear;
        let [r, g, b] = light.map(|v| (v / cover.max(1e-6)) as f32);
        ([r, g, b, cover as f32], over as f32)
    }
}

impl OverheadLayer {
    /// Returns the index of its medium: droplets, or ice.
    pub fn medium(&self) -> usize {
        if self.slab.ice_fraction > 0.5 { ICE } else { 0 }
    }
}

/// Light on a layer from sun, sky and the layers above it, and from the ground and the layers below it; times
/// `exposure`. It depends on where the layer lies, not on where the eye is. Only of clouds that a map or rain areas
/// place is the ground under them not known: it counts as the ground at the eye.
pub(super) fn light_on(scene: &Scene, (shape, is_placed): (&Shape, bool), exposure: f64) -> LayerLight {
    let (c, light) = (&scene.conditions, scene.brighter());
    let albedo = scene.ground_albedo;
    let top_m = shape.base_m + shape.thickness_m;
    let over = c.cloud_light_at(light.direction.z, albedo[1], top_m);
    let (direct, sky) = light_above_clouds(scene, top_m);
    let level = light.direction.z.max(0.0);
    let ground = &scene.ground;
    let at_eye = |i: usize| {
        let direct =
            ground.sun_lux[i] * scene.sun.direction.z.max(0.0) + ground.moon_lux[i] * scene.moon.direction.z.max(0.0);
        (direct + ground.sky_lux[i]) * albedo[i]
    };
    let under = |i: usize| {
        let [beam, even] = c.light_up_at(light.direction.z, albedo[i], shape.base_m);
        direct[i] * level * beam + sky[i] * even
    };
    LayerLight {
        sun: direct.map(|v| v * over.direct * exposure),
        above: [0, 1, 2].map(|i| (sky[i] * over.sky + direct[i] * level * over.diffuse) / PI * exposure),
        below: [0, 1, 2].map(|i| if is_placed { at_eye(i) } else { under(i) } / PI * exposure),
    }
}
