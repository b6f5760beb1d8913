//! Where over the ground a layer's clouds are other than its cover says: a host's map of cover ([`CloudMap`]), and cells of cloud over rain
//! areas, so that no rain falls out of a clear sky. Twin of `shaders/clouds/placed.wgsl`.
//!
//! # Model
//! A part of a layer with a cover of its own is cut out of the field as all of a layer with this cover is: by threshold, dome and extinction of
//! that cover. These are found for each cell of a map, and go over from middle to middle.
//!
//! Rain areas ([`crate::falling::area::RainArea`]) bring a layer of their own, which is nowhere else, unless a closed one hides the sky: over an
//! area it is closed, and opens across an edge beyond the area's border, a little wider than its clouds are, so that the field shapes it. The
//! cell is an ellipse, about a polygon's corners. Its base is that of the lowest layer that makes rain and has it no higher than the area, or else
//! the area's.

use std::{
    f64::consts::SQRT_2,
    sync::{Arc, LazyLock},
};

use glam::{DVec2, DVec3};

use super::{
    cover::{threshold, typical},
    field::Shape,
    layer_map::{LayerMap, LayerMaps},
    overhead::{Layer, Overhead},
    uniforms::{AreaUniform, LAYERS, LayerUniform},
};
use crate::{
    error::Result,
    falling::{
        MAX_AREAS,
        area::{AreaRain, AreaShape, Shaft},
    },
    moment::{Scene, WeatherOver},
    weather::{CloudKind, CloudMap, CloudSlab},
};

/// Threshold above all of the map: no cloud.
pub(super) const CLEAR: f64 = 7.0;
/// Least cover that has clouds: below it the threshold rises to [`CLEAR`].
const LEAST: f64 = 1e-3;
/// Cover from which on dome and extinction follow it.
const SHAPED_FROM: f64 = 0.02;
/// Threshold over a rain area: one place of 30 000 is open.
const FILLED: f64 = -4.0;
/// Change of the threshold across the edge of a cell over a rain area, over the distance from cloud to cloud: less than the map's steepest
/// slopes, so that the field shapes the cell's faces.
const EDGE_SLOPE: f64 = 3.0;
/// How much less excess the anvil of such a cell needs than that of a layer: across its edge, by [`EDGE_SLOPE`], it reaches this much over that
/// many distances from cloud to cloud farther than its towers.
const ANVIL_WIDER: f64 = 2.2;
/// Part of the edge's width, from outside, at which the area's own border lies: one place of a hundred is open there.
const BORDER: f64 = 0.85;
/// Distance from cloud to cloud in such a cell, over the area's half width; and at least, m.
const SPACING: f64 = 0.4;
const LEAST_SPACING_M: f64 = 600.0;
/// Thickness of such a cell, at most, over the area's half width.
const DEEPEST: f64 = 2.0;
/// The same at least, m, where its kind is as thick.
const MOST_FLAT_M: f64 = 800.0;
/// Height of a layer's base over that of a rain area up to which its rain may be the layer's, m.
const SAME_BASE_M: f64 = 300.0;
/// Rate from which on showers fall from cumulonimbus, mm/h.
const HEAVY_MM_H: f64 = 10.0;
/// Least rate that asks for a cloud, mm/h.
const LEAST_MM_H: f64 = 0.05;

/// What one place of a layer is cut out by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    pub threshold: f64,
    pub dome: f64,
    pub extinction_per_m: f64,
}

impl Cut {
    fn of(shape: &Shape) -> Self {
        Self { threshold: shape.threshold, dome: shape.dome, extinction_per_m: shape.extinction_per_m }
    }

    /// Of a layer that covers so much.
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

/// A cell of cloud over a rain area: an ellipse.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AreaCell {
    /// Its middle, m east and north of the world's origin.
    pub(super) center_m: DVec2,
    /// The way to the right.
    pub(super) right: DVec2,
    /// Half its extent to the right and ahead, m: outside there is nothing of it.
    pub(super) semi_m: DVec2,
    /// Width inside of its border over which it sets in, m.
    pub(super) rim_m: f64,
}

impl AreaCell {
    /// How far a place is filled, 0 to 1, and how far away all of it is, m.
    fn at(&self, place_m: DVec2) -> (f64, f64) {
        let away = place_m - self.center_m;
        let p = DVec2::new(away.dot(self.right), away.dot(self.right.perp()));
        let k = p / self.semi_m;
        let [k1, k2] = [k.length(), (k / self.semi_m).length()];
        // To first order, as the area's own border.
        let depth = (1.0 - k1) * if k1 < 1e-4 { self.semi_m.min_element() } else { k1 / k2 };
        ((depth / self.rim_m).clamp(0.0, 1.0), (k1 - 1.0).max(0.0) * self.semi_m.min_element())
    }

    /// Over an area whose column stands so at the base of a cloud; its edge is the area's own border.
    fn over(shaft: &Shaft, shape: &AreaShape, center_m: DVec2) -> Self {
        let (middle, semi) = match shape {
            AreaShape::Ellipse(semi) => (DVec2::ZERO, DVec2::from(*semi)),
            AreaShape::Polygon(corners, count) => {
                let all = || corners[..*count].iter().map(|c| DVec2::from(*c));
                let low = all().fold(DVec2::INFINITY, DVec2::min);
                let high = all().fold(DVec2::NEG_INFINITY, DVec2::max);
                // The ellipse about a rectangle.
                (0.5 * (low + high), 0.5 * SQRT_2 * (high - low))
            }
        };
        let middle = shaft.right * middle.x + shaft.right.perp() * middle.y;
        Self { center_m: center_m + middle, right: shaft.right, semi_m: semi, rim_m: 0.0 }
    }

    /// The same area with a soft edge `rim_m` wide, of which the share [`BORDER`] lies outside.
    fn with_edge(self, rim_m: f64) -> Self {
        Self { semi_m: self.semi_m + BORDER * rim_m, rim_m, ..self }
    }
}

/// Cells of cloud over rain areas, and what fills them.
#[derive(Clone, Copy, Debug)]
pub struct AreaCells {
    pub(super) cells: [AreaCell; MAX_AREAS],
    pub(super) count: usize,
    /// The layer that they are cells of.
    pub(super) layer: usize,
    pub(super) filled: Cut,
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

    /// A number that changes as they do.
    fn told(&self) -> f64 {
        self.all().iter().map(|c| c.center_m.dot(DVec2::new(1.0, 0.7)) + c.semi_m.x + c.semi_m.y + c.rim_m).sum()
    }
}

/// Where a layer's clouds are other than its cover says.
#[derive(Clone, Debug, Default)]
pub struct Placed {
    map: Option<Arc<LayerMap>>,
    areas: Option<Arc<AreaCells>>,
}

impl Placed {
    /// By a map alone.
    #[cfg(test)]
    pub(super) fn under(map: Arc<LayerMap>) -> Self {
        Self { map: Some(map), areas: None }
    }

    /// Makes a layer's shape that of a place, m east and north of the world's origin. Answers within which distance the place's threshold
    /// stays, m, and how much it changes a metre beyond.
    pub(super) fn shape_at(&self, place_m: DVec2, shape: &mut Shape) -> [f64; 2] {
        let (mut steady_m, mut slope_per_m) = (f64::INFINITY, 0.0);
        let mut cut = Cut::of(shape);
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

/// The layer that a rain area brings where none is there that could make its rain, but for base and cover.
fn brought(shaft: &Shaft, rain: AreaRain) -> &'static CloudSlab {
    static KINDS: LazyLock<[CloudSlab; 4]> = LazyLock::new(|| {
        let kinds = [CloudKind::Stratus, CloudKind::Nimbostratus, CloudKind::ToweringCumulus, CloudKind::Cumulonimbus];
        kinds.map(|kind| typical(kind, 1.0).unwrap_or(CloudSlab::NONE))
    });
    let heavy = usize::from(shaft.falling.rain_mm_h >= HEAVY_MM_H);
    match rain {
        AreaRain::Drizzle => &KINDS[0],
        AreaRain::Rain => &KINDS[1],
        AreaRain::Showers => &KINDS[2 + heavy],
    }
}

/// Whether rain falls from such a layer: nimbostratus, or heaps that tower.
fn makes_rain(slab: &CloudSlab) -> bool {
    let deep_sheet = slab.convection < 0.1 && slab.thickness_m >= 1000.0 && slab.ice_fraction < 0.5;
    slab.convection > 0.7 || deep_sheet
}

impl Overhead {
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
        let mut cells = [AreaCell::default(); MAX_AREAS];
        let (mut count, mut lowest_m, mut most) = (0, f64::INFINITY, None::<(f64, &CloudSlab)>);
        let mut least_m = f64::INFINITY;
        for shaft in over.shafts_at(time_s, &scene.conditions)? {
            let rate = shaft.falling.rain_mm_h + shaft.falling.drizzle_mm_h;
            let area = &over.regions[shaft.index as usize].area;
            if rate < LEAST_MM_H {
                continue;
            }
            let leans = shaft.lean * (shaft.top_m - shaft.ground_m);
            let center_m = self.place_m + (scene.world_to_enu * (shaft.center - eye)).truncate() + leans;
            cells[count] = AreaCell::over(&shaft, &area.shape, center_m);
            count += 1;
            lowest_m = lowest_m.min(shaft.top_m);
            least_m = least_m.min(cells[count - 1].semi_m.min_element());
            if most.is_none_or(|(rate_before, _)| rate > rate_before) {
                most = Some((rate, brought(&shaft, area.kind)));
            }
        }
        let Some((_, brings)) = most else { return Ok(()) };
        if let Some(layer) = self.bring(scene, (brings, lowest_m), least_m) {
            let slab = &self.all()[layer].slab;
            let filled = Cut::of(&Shape::still(slab, FILLED));
            let cells = cells.map(|cell| cell.with_edge((CLEAR - FILLED) / EDGE_SLOPE * slab.scale_m));
            self.areas = Some(AreaCells { cells, count, layer, filled });
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

    /// Puts the layer of cells over areas among the others: `brings` at `lowest_m`, the lowest base of an area, or at that of the lowest layer
    /// that makes rain and is no higher. None where a closed layer hides the sky over all areas, of which the narrowest is `half_m` to a side.
    fn bring(&mut self, scene: &Scene, (brings, lowest_m): (&CloudSlab, f64), half_m: f64) -> Option<usize> {
        let closes = |layer: &Layer| layer.slab.cover >= 1.0 && layer.slab.optical_depth > 5.0;
        if self.all().iter().zip(&self.maps).any(|(layer, map)| closes(layer) && map.is_none()) {
            return None;
        }
        let fits = |layer: &&Layer| makes_rain(&layer.slab) && layer.shape.base_m <= lowest_m + SAME_BASE_M;
        let base_m = self.all().iter().find(fits).map_or(lowest_m, |layer| layer.shape.base_m);
        let thickness_m = brings.thickness_m.min(DEEPEST * half_m).max(MOST_FLAT_M.min(brings.thickness_m));
        let slab = CloudSlab {
            base_m: base_m - scene.conditions.air.station_altitude_m,
            cover: 0.0,
            thickness_m,
            optical_depth: brings.optical_depth * thickness_m / brings.thickness_m,
            scale_m: (SPACING * half_m).clamp(LEAST_SPACING_M, brings.scale_m),
            ..*brings
        };
        let filled = Shape::still(&slab, FILLED);
        let anvil = if filled.anvil < 0.0 { filled.anvil - ANVIL_WIDER } else { filled.anvil };
        let shape = Shape { base_m, threshold: CLEAR, anvil, ..filled };
        let slot = scene.conditions.clouds.iter().position(|s| s.cover <= 0.0)?;
        self.insert(Layer { shape, slab, slot, share: 1.0 })
    }

    /// Where the clouds of one of [`Overhead::all`] are other than its cover says.
    pub(super) fn placed(&self, layer: usize) -> Placed {
        let areas = self.areas.as_ref().filter(|areas| areas.layer == layer);
        Placed { map: self.maps[layer].clone(), areas: areas.map(|areas| Arc::new(*areas)) }
    }

    /// Whether any are.
    pub(super) fn is_placed(&self) -> bool {
        self.areas.is_some() || self.maps.iter().any(Option::is_some)
    }

    /// A number that changes as the cells over areas do, and one that is other for another map.
    pub(super) fn placed_told(&self) -> (f64, usize) {
        let map = self.maps.iter().flatten().next().map_or(0, |made| Arc::as_ptr(&made.map) as usize);
        (self.areas.as_ref().map_or(0.0, AreaCells::told), map)
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
                let Cut { threshold, dome, extinction_per_m } = areas.filled;
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
