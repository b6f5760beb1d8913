//! Layer of cloud that follows a host's cover map ([`CloudMap`]): the threshold, dome and extinction with which the
//! clouds of each cell of the map are cut out of the field ([`super::placed`]).

use std::{
    f64::consts::{PI, SQRT_2},
    sync::Arc,
};

use glam::DVec2;
use half::f16;

use super::cover_threshold::CoverThreshold;
use crate::weather::{CloudMap, CloudSlab, MAX_CLOUD_LAYERS};

/// Number of intervals of the map's values, 0 to 1; thresholds are computed at their ends and interpolated between.
const STEPS: usize = 64;

/// A layer that follows a map, cell by cell.
#[derive(Debug)]
pub struct LayerMap {
    /// Slab of the layer.
    slab: CloudSlab,
    /// Map of the host.
    pub(crate) map: Arc<CloudMap>,
    /// Values of each cell, rounded to half floats: threshold, dome, extinction (1/m), and the distance within which
    /// the threshold stays the same, m.
    pub(crate) texels: Vec<[f32; 4]>,
    /// Largest change of the threshold per metre.
    pub(crate) slope_per_m: f64,
}

impl LayerMap {
    /// Creates the local thresholds of a layer from its slab and the map of its cover.
    pub(crate) fn new(slab: &CloudSlab, map: &Arc<CloudMap>) -> Self {
        // Nodes are dense where thresholds change fast: near 0 and 1.
        let node = |i: usize| (0.5 * PI * i as f64 / STEPS as f64).sin().powi(2);
        let cuts: [CoverThreshold; STEPS + 1] =
            std::array::from_fn(|i| CoverThreshold::with_cover(slab, slab.cover * node(i)));
        let cut = |left: f32| {
            let at = f64::from(left).sqrt().asin() * 2.0 / PI * STEPS as f64;
            let i = (at as usize).min(STEPS - 1);
            cuts[i].mix(&cuts[i + 1], at - i as f64)
        };
        let steady = steady_m(map);
        let half = |v: f64| f16::from_f64(v).to_f32();
        let texel = |(left, steady_m): (&f32, f64)| {
            let c = cut(*left);
            [c.threshold, c.dome, c.extinction_per_m, steady_m].map(half)
        };
        let texels: Vec<[f32; 4]> = map.cover.iter().zip(steady).map(texel).collect();
        let slope_per_m = steepest(&texels, map);
        Self { slab: *slab, map: map.clone(), texels, slope_per_m }
    }

    /// Returns threshold, dome and extinction at a place, and the distance within which the threshold stays the same,
    /// m.
    pub(crate) fn at(&self, place_m: DVec2) -> (CoverThreshold, f64) {
        let map = &self.map;
        let [columns, rows] = map.cells.map(|n| n as usize);
        let last = DVec2::new((columns - 1) as f64, (rows - 1) as f64);
        let cell = ((place_m - DVec2::from_array(map.first_m)) / map.cell_m).clamp(DVec2::ZERO, last);
        let low = cell.floor();
        let part = cell - low;
        let [x, y] = [low.x as usize, low.y as usize];
        let texel = |x: usize, y: usize| self.texels[y.min(rows - 1) * columns + x.min(columns - 1)];
        let corners = [texel(x, y), texel(x + 1, y), texel(x, y + 1), texel(x + 1, y + 1)];
        let [threshold, dome, extinction_per_m, steady_m] = [0, 1, 2, 3].map(|k| {
            let [a, b, c, d] = corners.map(|t| f64::from(t[k]));
            let (south, north) = (a + (b - a) * part.x, c + (d - c) * part.x);
            south + (north - south) * part.y
        });
        (CoverThreshold { threshold, dome, extinction_per_m }, steady_m)
    }

    /// Whether this is the layer of `slab` under `map`.
    fn is_of(&self, slab: &CloudSlab, map: &Arc<CloudMap>) -> bool {
        self.slab == *slab && Arc::ptr_eq(&self.map, map)
    }
}

/// Returns the largest change of the threshold from cell to cell, per metre.
fn steepest(texels: &[[f32; 4]], map: &CloudMap) -> f64 {
    let columns = map.cells[0] as usize;
    let change = |(i, t): (usize, &[f32; 4])| {
        let east = texels.get(i + 1).filter(|_| (i + 1) % columns != 0);
        let north = texels.get(i + columns);
        let [east, north] = [east, north].map(|n| n.map_or(0.0, |n| f64::from(n[0] - t[0])));
        DVec2::new(east, north).length()
    };
    // Between cells, the steepest change east and the steepest change north can belong to different corners.
    texels.iter().enumerate().map(change).fold(0.0, f64::max) * SQRT_2 / map.cell_m
}

/// Returns for each cell the distance within which the map stays the same, m. It is two cells less than the distance to
/// the nearest cell with another value, because values are interpolated between the centres of cells: one cell for the
/// place from which the distance is measured, one for the place at its end. The distance is at most 60 km.
fn steady_m(map: &CloudMap) -> Vec<f64> {
    let [columns, rows] = map.cells.map(|n| n as usize);
    let most = (columns + rows) as u32;
    let is_other = |i: usize, j: usize| map.cover[i] != map.cover[j];
    let near = |i: usize| {
        let (x, y) = ((i % columns) as i64, (i / columns) as i64);
        let steps = (0..9).map(move |k| (x + k % 3 - 1, y + k / 3 - 1));
        steps
            .filter(move |(x, y)| (0..columns as i64).contains(x) && (0..rows as i64).contains(y))
            .map(move |(x, y)| y as usize * columns + x as usize)
    };
    let mut away: Vec<u32> =
        (0..map.cover.len()).map(|i| if near(i).any(|j| is_other(i, j)) { 1 } else { most }).collect();
    // Chebyshev distance in a forward and a backward pass.
    for i in (0..away.len()).chain((0..away.len()).rev()) {
        away[i] = near(i).map(|j| away[j] + 1).min().unwrap_or(most).min(away[i]);
    }
    // Rays are followed no farther than 60 km.
    away.into_iter().map(|n| (f64::from(n.saturating_sub(2)) * map.cell_m).min(60e3)).collect()
}

/// Cache of layers under maps, with up to [`MAX_CLOUD_LAYERS`] entries, of which the oldest is dropped first. An entry
/// is valid as long as its layer and its map stay the same.
#[derive(Default)]
pub(crate) struct LayerMaps(Vec<Arc<LayerMap>>);

impl LayerMaps {
    /// Returns the layer of `slab` under `map`, computed if the cache lacks it.
    pub(crate) fn get(&mut self, slab: &CloudSlab, map: &Arc<CloudMap>) -> Arc<LayerMap> {
        if let Some(made) = self.0.iter().find(|made| made.is_of(slab, map)) {
            return made.clone();
        }
        let new = Arc::new(LayerMap::new(slab, map));
        if self.0.len() >= MAX_CLOUD_LAYERS {
            self.0.remove(0);
        }
        self.0.push(new.clone());
        new
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        clouds::field::{
            Field, Map, Solid,
            cover::{field, is_ice, seen, threshold, typical},
            placed::LocalCover,
        },
        weather::CloudKind,
    };

    /// Creates a map with one value over the places from which cover is seen, and another west of them.
    fn map(here: f32, west: f32) -> Arc<CloudMap> {
        let cover = vec![west, here];
        Arc::new(CloudMap { first_m: [-2e5, 0.0], cell_m: 5e4, cells: [2, 1], base_m: [0.0, 2e4], cover })
    }

    fn under<'a>(slab: &CloudSlab, grown: &'a (Map, Solid), map: &Arc<CloudMap>) -> Field<'a> {
        let placed = LocalCover::under(Arc::new(LayerMap::new(slab, map)));
        Field { placed, ..field(slab, grown, threshold(slab)) }
    }

    const PLACES: usize = 48;

    #[test]
    fn a_layer_covers_what_its_map_says_where_it_says_so() {
        let seeds: Vec<(Map, Solid)> = (0..4).map(|s| (Map::new(s), Solid::new(s).unwrap())).collect();
        for kind in [CloudKind::Stratus, CloudKind::Stratocumulus, CloudKind::Cumulus, CloudKind::Cumulonimbus] {
            for (cover, left) in [(1.0, 0.25), (1.0, 0.5), (1.0, 0.75), (0.5, 1.0), (0.5, 0.5)] {
                let slab = typical(kind, cover).unwrap();
                let mean = |map: &Arc<CloudMap>| {
                    let one = |grown| seen(&under(&slab, grown, map), is_ice(&slab), PLACES);
                    seeds.iter().map(one).sum::<f64>() / seeds.len() as f64
                };
                let (there, beside) = (mean(&map(left, 0.0)), mean(&map(0.0, left)));
                println!(
                    "{kind:?} of cover {cover} at {left} of the map: seen {there:.3}, where it says 0 {beside:.3}"
                );
                assert!((there - cover * f64::from(left)).abs() < 0.03, "{kind:?} {cover} {left}: {there}");
                assert_eq!(beside, 0.0, "{kind:?}");
            }
            let closed = typical(kind, 1.0).unwrap();
            assert_eq!(seen(&under(&closed, &seeds[0], &map(1.0, 0.0)), false, PLACES), 1.0, "{kind:?}");
        }
    }

    #[test]
    fn cover_does_not_change_within_the_distance_that_the_map_states() {
        let cover: Vec<f32> = (0..30 * 20).map(|i| if (i % 30) < 7 || i / 30 > 16 { 1.0 } else { 0.0 }).collect();
        let map = CloudMap { first_m: [0.0; 2], cell_m: 1000.0, cells: [30, 20], base_m: [0.0, 2e4], cover };
        let layer = LayerMap::new(&typical(CloudKind::Cumulus, 1.0).unwrap(), &Arc::new(map));
        let mut longest_m = 0.0f64;
        for i in 0..4000 {
            let at = DVec2::new(
                (f64::from(i) * 0.754_877).fract() * 34e3 - 2e3,
                (f64::from(i) * 0.569_84).fract() * 24e3 - 2e3,
            );
            let (here, steady_m) = layer.at(at);
            longest_m = longest_m.max(steady_m);
            for k in 0..24 {
                let away = DVec2::from_angle(f64::from(k)) * steady_m * f64::from(k % 3 + 1) / 3.0;
                let there = layer.at(at + away).0.threshold;
                assert!((there - here.threshold).abs() < 1e-2, "{at}: {steady_m} m, {away}");
                let step = DVec2::from_angle(f64::from(k)) * 20.0;
                let change = (layer.at(at + step).0.threshold - here.threshold).abs() / 20.0;
                assert!(change < 1.01 * layer.slope_per_m, "{at}: {change} a metre, bound {}", layer.slope_per_m);
            }
        }
        assert!(longest_m >= 4000.0, "{longest_m}");
    }
}
