//! Cells of cloud over rain areas ([`crate::falling::area::RainArea`]): where the cells stand, what they are made of,
//! and how much of the sky they cover over a place. Without cells, rain would fall from a clear sky.
//!
//! # Model
//! A cell is an ellipse. Over a polygonal area it is the ellipse through the corners of the bounding rectangle. The
//! base of all cells is the base of the weather's lowest layer from which rain may fall, if this is at most
//! `SAME_BASE_M` above the lowest top of the areas' rain. Otherwise their base is this lowest top. If one of the
//! weather's layers is closed, there are no cells, because such a layer hides the sky.
//!
//! The light at a place equals the light under one layer of the cells' cloud, whose cover is the share of the sky that
//! the cells take up. A cell takes up as much as a level disc of equal area. Its share is the disc's view factor from
//! level ground (Hamilton and Morgan 1952). The disc lies at the horizontal distance r |d / s| from the place: r is the
//! disc's radius, d the vector to the cell's middle along the cell's axes, and s the cell's half widths. Cells with the
//! shares f together take up 1 - product (1 - f).

use std::{f64::consts::SQRT_2, sync::LazyLock};

use glam::{DMat3, DVec2, DVec3};

use super::thresholds::{CLEAR, FILLED, typical};
use crate::{
    error::Result,
    falling::{
        MAX_AREAS,
        area::{AreaRain, AreaShape, Shaft},
    },
    moment::WeatherOver,
    scene::LocalFrame,
    weather::{CloudKind, CloudSlab, Conditions},
};

/// Change of the threshold across a cell's edge, per distance from cloud to cloud. It is less than the map's steepest
/// slopes, so that the noise of the map shapes the cell's sides.
const EDGE_SLOPE: f64 = 3.0;
/// Position of the rain area's border in the cell's edge: distance from the edge's outer end as a share of the edge's
/// width. At the border, 1 % of the places have no cloud.
const BORDER: f64 = 0.85;
/// Ratio of the distance from cloud to cloud in all cells to half the width of the narrowest area.
const SPACING: f64 = 0.4;
/// Least distance from cloud to cloud in a cell, m.
const LEAST_SPACING_M: f64 = 600.0;
/// Largest ratio of the cells' thickness to half the width of the narrowest area.
const DEEPEST: f64 = 2.0;
/// Least thickness of a cell, m, unless its kind of cloud is thinner.
const MOST_FLAT_M: f64 = 800.0;
/// Largest height, m, of a layer's base above the lowest top of an area's rain at which the rain may come from that
/// layer.
const SAME_BASE_M: f64 = 300.0;
/// Least rain rate at which showers fall from cumulonimbus, mm/h.
const HEAVY_MM_H: f64 = 10.0;
/// Least rate for which a cell is made, mm/h.
const LEAST_MM_H: f64 = 0.05;

/// A cell of cloud over a rain area: an ellipse.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AreaCell {
    /// Middle of the cell, m east and north of the world's origin.
    pub(crate) center_m: DVec2,
    /// Unit vector to the cell's right (east, north).
    pub(crate) right: DVec2,
    /// Half extents to the right and ahead, m, including the whole edge.
    pub(crate) semi_m: DVec2,
    /// Width of the edge, m, measured inwards from the ellipse.
    pub(crate) rim_m: f64,
}

impl AreaCell {
    /// Returns how far a place is inside the cell's edge (0 at the ellipse or outside, 1 at the edge's inner end and
    /// farther in), and a lower bound of the place's distance from the ellipse, m (0 inside).
    pub(crate) fn at(&self, place_m: DVec2) -> (f64, f64) {
        let away = place_m - self.center_m;
        let p = DVec2::new(away.dot(self.right), away.dot(self.right.perp()));
        let k = p / self.semi_m;
        let [k1, k2] = [k.length(), (k / self.semi_m).length()];
        // To first order this is the distance to the ellipse, as for the area's own border.
        let depth = (1.0 - k1) * if k1 < 1e-4 { self.semi_m.min_element() } else { k1 / k2 };
        ((depth / self.rim_m).clamp(0.0, 1.0), (k1 - 1.0).max(0.0) * self.semi_m.min_element())
    }

    /// Creates the cell over an area from its shaft of rain, with an edge of width 0. `center_m` is the area's middle
    /// at the rain's top, m east and north.
    fn over(shaft: &Shaft, shape: &AreaShape, center_m: DVec2) -> Self {
        let (middle, semi) = match shape {
            AreaShape::Ellipse(semi) => (DVec2::ZERO, DVec2::from(*semi)),
            AreaShape::Polygon(corners, count) => {
                let all = || corners[..*count].iter().map(|c| DVec2::from(*c));
                let low = all().fold(DVec2::INFINITY, DVec2::min);
                let high = all().fold(DVec2::NEG_INFINITY, DVec2::max);
                // The ellipse through the rectangle's corners.
                (0.5 * (low + high), 0.5 * SQRT_2 * (high - low))
            }
        };
        let middle = shaft.right * middle.x + shaft.right.perp() * middle.y;
        Self { center_m: center_m + middle, right: shaft.right, semi_m: semi, rim_m: 0.0 }
    }

    /// Returns the cell with an edge of width `rim_m`, of which the share [`BORDER`] lies outside the area.
    pub(crate) fn with_edge(self, rim_m: f64) -> Self {
        Self { semi_m: self.semi_m + BORDER * rim_m, rim_m, ..self }
    }
}

/// Clouds of all rain areas at one time.
pub(crate) struct AreaClouds {
    /// Cells, of which the first `count` are in use.
    pub cells: [AreaCell; MAX_AREAS],
    /// Number of cells.
    pub count: usize,
    /// Height above the station of the lowest top of an area's rain, m.
    lowest_m: f64,
    /// Half the width of the narrowest area, m.
    half_m: f64,
    /// Slab of the cloud that the strongest rain falls from.
    brings: &'static CloudSlab,
}

impl AreaClouds {
    /// Creates the clouds around a place. `eye` is the place in the host's world, m, and `place_m` is the place in m
    /// east and north of the world's origin. `to_enu` rotates the host's axes to (east, north, up) there. Returns
    /// `None` if no area has rain of at least [`LEAST_MM_H`].
    ///
    /// # Errors
    /// [`WeatherOver::check_time`] refuses times for which the weather is not known.
    pub fn new(
        weather: &WeatherOver<'_>,
        conditions: &Conditions,
        to_enu: DMat3,
        eye: DVec3,
        place_m: DVec2,
        time_s: f64,
    ) -> Result<Option<Self>> {
        let mut cells = [AreaCell::default(); MAX_AREAS];
        let (mut count, mut lowest_m, mut half_m) = (0, f64::INFINITY, f64::INFINITY);
        let mut strongest = None::<(f64, &CloudSlab)>;
        for shaft in weather.shafts_at(time_s, conditions)? {
            let rate = shaft.falling.rain_mm_h + shaft.falling.drizzle_mm_h;
            let area = &weather.regions[shaft.index as usize].area;
            if rate < LEAST_MM_H {
                continue;
            }
            let leans = shaft.lean * (shaft.top_m - shaft.ground_m);
            let center_m = place_m + (to_enu * (shaft.center - eye)).truncate() + leans;
            cells[count] = AreaCell::over(&shaft, &area.shape, center_m);
            lowest_m = lowest_m.min(shaft.top_m - conditions.air.station_altitude_m);
            half_m = half_m.min(cells[count].semi_m.min_element());
            count += 1;
            if strongest.is_none_or(|(rate_before, _)| rate > rate_before) {
                strongest = Some((rate, brought(&shaft, area.kind)));
            }
        }
        Ok(strongest.map(|(_, brings)| Self { cells, count, lowest_m, half_m, brings }))
    }

    /// Returns the slab that the cells are made of, with cover 0. `others` are the other layers; each flag says whether
    /// a cover map places the layer's clouds. Returns `None` if one of these layers hides the sky.
    pub fn slab<'a>(&self, others: impl Iterator<Item = (&'a CloudSlab, bool)> + Clone) -> Option<CloudSlab> {
        let closes =
            |(slab, is_placed): (&CloudSlab, bool)| slab.cover >= 1.0 && slab.optical_depth > 5.0 && !is_placed;
        if others.clone().any(closes) {
            return None;
        }
        let fits = |slab: &&CloudSlab| makes_rain(slab) && slab.base_m <= self.lowest_m + SAME_BASE_M;
        let base_m = others.map(|(slab, _)| slab).find(fits).map_or(self.lowest_m, |slab| slab.base_m);
        let brings = self.brings;
        let thickness_m = brings.thickness_m.min(DEEPEST * self.half_m).max(MOST_FLAT_M.min(brings.thickness_m));
        Some(CloudSlab {
            base_m,
            cover: 0.0,
            thickness_m,
            optical_depth: brings.optical_depth * thickness_m / brings.thickness_m,
            scale_m: (SPACING * self.half_m).clamp(LEAST_SPACING_M, brings.scale_m),
            ..*brings
        })
    }
}

/// Returns the width of the edge of a cell made of this slab, m.
pub(crate) fn edge_m(slab: &CloudSlab) -> f64 {
    (CLEAR - FILLED) / EDGE_SLOPE * slab.scale_m
}

/// Returns the view factor of a level disc from level ground that lies `height_m` below it and `aside_m` to the side of
/// its middle, 0 to 1 (Hamilton and Morgan 1952).
fn view_factor(radius_m: f64, height_m: f64, aside_m: f64) -> f64 {
    let [r2, h2, d2] = [radius_m, height_m, aside_m].map(|v| v * v);
    let sum = h2 + d2 + r2;
    0.5 * (1.0 - (h2 + d2 - r2) / (sum * sum - 4.0 * r2 * d2).max(f64::MIN_POSITIVE).sqrt())
}

/// Returns one layer under which a place has the same light as under the cells of rain areas. Its cover is the share of
/// the sky that the cells hide there. `None` without cells. The place is `eye` in the host's world.
///
/// # Errors
/// [`WeatherOver::check_time`] refuses times for which the weather is not known.
pub(crate) fn over_place(
    weather: &WeatherOver<'_>,
    conditions: &Conditions,
    (local, eye): (&LocalFrame, DVec3),
    time_s: f64,
) -> Result<Option<CloudSlab>> {
    if weather.regions.is_empty() {
        return Ok(None);
    }
    let Some(clouds) = AreaClouds::new(weather, conditions, local.world_to_enu, eye, DVec2::ZERO, time_s)? else {
        return Ok(None);
    };
    let is_placed = |slab: &CloudSlab| weather.cloud_map.is_some_and(|map| map.is_of(slab.base_m));
    let others = conditions.clouds.iter().filter(|slab| slab.cover > 0.0).map(|slab| (slab, is_placed(slab)));
    let Some(slab) = clouds.slab(others) else { return Ok(None) };
    let height_m = (slab.base_m + conditions.air.station_altitude_m - local.place.altitude_m).max(0.0);
    let open = clouds.cells[..clouds.count].iter().fold(1.0, |open, cell| {
        // The cell's outline is taken where the threshold is 0, so that half of the places on it have cloud.
        let cell = cell.with_edge(edge_m(&slab));
        let semi_m = cell.semi_m - cell.rim_m * CLEAR / (CLEAR - FILLED);
        let away = DVec2::new(cell.center_m.dot(cell.right), cell.center_m.dot(cell.right.perp()));
        let radius_m = (semi_m.x * semi_m.y).sqrt();
        open * (1.0 - view_factor(radius_m, height_m, (away / semi_m).length() * radius_m))
    });
    // An infinite distance from cloud to cloud says that the cells' cloud is closed at any cover.
    Ok(Some(CloudSlab { cover: 1.0 - open, scale_m: f64::INFINITY, ..slab }))
}

/// Returns a slab of the kind of cloud from which an area's rain falls. Its base and cover are meaningless.
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

/// Whether rain may fall from a layer: nimbostratus, towering cumulus or cumulonimbus.
fn makes_rain(slab: &CloudSlab) -> bool {
    let deep_sheet = slab.convection < 0.1 && slab.thickness_m >= 1000.0 && slab.ice_fraction < 0.5;
    slab.convection > 0.7 || deep_sheet
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_view_factor_is_that_of_a_sum_over_the_disc() {
        for [r, h, d] in
            [[3000.0, 1000.0, 0.0], [3000.0, 1000.0, 2500.0], [500.0, 1000.0, 4000.0], [800.0, 40.0, 801.0]]
        {
            let (rings, turns) = (2000, 400);
            let mut sum = 0.0;
            for i in 0..rings {
                let s = r * (f64::from(i) + 0.5) / f64::from(rings);
                for k in 0..turns {
                    let angle = std::f64::consts::TAU * (f64::from(k) + 0.5) / f64::from(turns);
                    let q = DVec2::from_angle(angle) * s - DVec2::X * d;
                    let away2 = q.length_squared() + h * h;
                    sum += h * h / (std::f64::consts::PI * away2 * away2) * s;
                }
            }
            sum *= r / f64::from(rings) * std::f64::consts::TAU / f64::from(turns);
            let closed = view_factor(r, h, d);
            assert!((closed - sum).abs() < 2e-3, "{r} {h} {d}: {closed} against {sum}");
        }
        assert_eq!([view_factor(100.0, 0.0, 50.0), view_factor(100.0, 0.0, 150.0)], [1.0, 0.0]);
    }
}
