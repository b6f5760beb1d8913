//! Radiance and transmittance of clouds along a ray, in f64, for queries: the computation of
//! `shaders/clouds/march.wgsl` and `shaders/clouds/about.wgsl`, with finer steps.
//!
//! # Error
//! `cargo test --test clouds radiance -- --nocapture` compares pictures with these rays.

use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::noise::CloudNoise;
use crate::{
    clouds::{
        field::{
            extinction::{Field, MOST_FRAYED},
            layer::{ICE, OverheadLayer},
            layers::CloudLayers,
            shape::{Shape, WIDTH_CELLS, about, dome, filled_below},
            thresholds::CLEAR,
        },
        light::{
            halo,
            layer_light::{LayerLight, light_on},
            media::media,
            sources::{Depths, Sources},
            transport::Transport,
        },
    },
    moment::Scene,
};

/// Scaled depth of the shortest step, whose length also stays between 1/128 and 1/24 of the layer's thickness.
const STEP_DEPTH: f64 = 0.25;
/// Ratio of a step's length to its distance from the eye, between the shortest and the longest step.
const STEP_ANGLE: f64 = 0.002;
/// Share of a layer's thickness by which the longest step goes up or down.
const STEP_RISE: f64 = 0.04;
/// Transmittance at which a ray ends.
const LEAST: f64 = 0.001;
/// Longest path that a ray is followed through a layer, from its entry, m.
const FARTHEST_M: f64 = 60e3;
/// Length, m, over which clouds fade out at the end of the path [`FARTHEST_M`]. Without this fade a cloud would end in
/// a flat face.
const FADES_M: f64 = 15e3;
/// Ends of the intervals into which the path to the sun is divided, in units of [`Shape::scale_m`].
const SUN_WAY: [f64; 5] = [0.05, 0.15, 0.3, 0.8, 2.0];
/// Number of first intervals in which solid noise frays the clouds' edges; farther on they are smooth.
const SUN_FRAYED: usize = 3;
/// Slope that rays take as the map's largest when they skip clear air, per [`Shape::scale_m`].
const MAP_SKIP: f64 = 6.0;
/// Slope that rays take as the solid noise's largest when they skip clear air, per [`Shape::solid_m`].
const SOLID_SKIP: f64 = 12.0;

/// Threshold above which there is no cloud: just below [`CLEAR`].
const CLEAR_FROM: f64 = CLEAR - 0.05;

/// Light of the clouds along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CloudsSeen {
    /// Radiance for red, green and blue, cd/m^2.
    pub light: DVec3,
    /// Transmittance of the clouds, 0 to 1. Light that droplets scatter into the narrow forward peak counts as
    /// transmitted.
    pub transmittance: f64,
    /// Mean distance of the visible cloud from the eye, m.
    pub distance_m: f64,
}

/// A layer with the light that falls on it.
struct MarchedLayer<'a> {
    /// Field of the layer's clouds.
    field: Field<'a>,
    /// Share of the layer that is drawn as a volume.
    share: f64,
    /// Light that falls on the layer.
    light: LayerLight,
    /// Index of the medium: 0 for droplets, [`ICE`] for ice.
    medium: usize,
    /// Ratio of scaled extinction to extinction. Scaled extinction leaves out what droplets scatter into the narrow
    /// forward peak ([`crate::clouds::light::transport::Scattering::scale`]).
    scale: f64,
}

/// Clouds around a place, for queries.
pub(crate) struct CloudRays<'a> {
    /// Layers above and below the place.
    layers: Vec<MarchedLayer<'a>>,
    /// Tables of the light within the clouds.
    light: LightWithin<'a>,
    /// Position of the place: m east and north of the world's origin, and m above the sea.
    place_m: DVec3,
    /// Radius of the planet, m.
    radius_m: f64,
    /// Whether a share of the layers above the place is a deck.
    pub has_deck: bool,
    /// Factors on the lengths of steps: on the shortest step ([`STEP_DEPTH`]), and on [`STEP_ANGLE`] and [`STEP_RISE`].
    longer: [f64; 2],
}

/// Tables of the light within clouds, for droplets and for ice.
enum LightWithin<'a> {
    /// Tables of the only medium.
    Given(Arc<Sources>),
    /// Tables computed when a ray first meets cloud of a medium; most rays meet none.
    Lazy {
        /// Noise of the clouds, which caches the tables of the last query.
        grown: &'a CloudNoise,
        /// Media: droplets (0) and ice (1).
        media: [Arc<Transport>; 2],
        /// Unit vector towards the sun (east, north, up).
        to_sun: DVec3,
        /// Tables of each medium, once they are computed.
        made: [OnceLock<Arc<Sources>>; 2],
    },
}

impl LightWithin<'_> {
    /// Returns the tables of a medium: 0 for droplets, [`ICE`] for ice.
    fn of(&self, medium: usize) -> &Sources {
        match self {
            Self::Given(sources) => sources,
            Self::Lazy { grown, media, to_sun, made } => {
                made[medium].get_or_init(|| grown.sources(medium, &media[medium], *to_sun))
            }
        }
    }
}

/// State of a march: what the ray has gathered so far.
#[derive(Clone, Copy)]
struct MarchState {
    /// Radiance for red, green and blue, cd/m^2.
    light: DVec3,
    /// Transmittance of the clouds met so far.
    transmittance: f64,
    /// Sum of distance times lost transmittance, m.
    distance: f64,
}

/// A place inside a layer's cloud.
struct AtPlace<'a> {
    /// Layer of the cloud.
    layer: &'a MarchedLayer<'a>,
    /// The layer's field with the local cover of this place.
    field: Field<'a>,
    /// Position, m east and north of the world's origin, and m above the sea.
    position_m: DVec3,
    /// Height in the layer, 0 at its base to 1 at its top.
    height: f64,
    /// Excess of the map's number over the threshold, with fraying, before the dome is subtracted.
    excess: f64,
}

impl<'a> CloudRays<'a> {
    /// Creates the clouds around a scene's place.
    pub(crate) fn new(overhead: &CloudLayers, grown: &'a CloudNoise, scene: &Scene, radius_m: f64) -> Self {
        let to_sun = scene.brighter().direction;
        let media = media(overhead.liquid_um);
        let lit = |(i, layer): (usize, &OverheadLayer)| MarchedLayer {
            field: grown.field(overhead, i),
            share: layer.share,
            light: light_on(scene, (&layer.shape, overhead.is_placed()), 1.0),
            medium: layer.medium(),
            scale: media[layer.medium()].scattering.scale(),
        };
        Self {
            layers: overhead.all().iter().enumerate().map(lit).collect(),
            place_m: overhead.place_m.extend(scene.place.altitude_m),
            radius_m,
            has_deck: overhead.has_deck,
            light: LightWithin::Lazy { grown, media, to_sun, made: Default::default() },
            longer: [1.0; 2],
        }
    }

    /// Creates the clouds of one layer in given light over level ground, seen from a place, without a halo. `longer`
    /// has the factors of [`CloudRays::longer`].
    pub(crate) fn given(
        field: Field<'a>,
        sources: &Arc<Sources>,
        light: LayerLight,
        place_m: DVec3,
        longer: [f64; 2],
    ) -> Self {
        let scale = sources.scattering.scale();
        Self {
            layers: vec![MarchedLayer { field, share: 1.0, light, medium: 0, scale }],
            light: LightWithin::Given(sources.clone()),
            place_m,
            radius_m: 1e9,
            has_deck: false,
            longer,
        }
    }

    /// Returns the distances at which a ray of direction `d` crosses a height above the sea, nearer one first, m. Both
    /// are equal if the ray does not cross it. `d` is a unit vector (east, north, up).
    fn crossings(&self, d: DVec3, height_m: f64) -> [f64; 2] {
        let (r, rise) = (self.radius_m + self.place_m.z, height_m - self.place_m.z);
        let b = r * d.z;
        let root = b * b + rise * (2.0 * r + rise);
        if root <= 0.0 {
            return [-b; 2];
        }
        let q = -(b + if b >= 0.0 { root.sqrt() } else { -root.sqrt() });
        let other = -rise * (2.0 * r + rise) / if q.abs() < 1e-9 { 1e-9 } else { q };
        [q.min(other), q.max(other)]
    }

    /// Returns the position at a distance `t` along a ray, m. The planet is a sphere.
    fn at(&self, d: DVec3, t: f64) -> DVec3 {
        let r = self.radius_m + self.place_m.z;
        let rise = t * (2.0 * d.z + t / r);
        let altitude_m = self.place_m.z + rise * r / (r + (r * (r + rise)).max(0.0).sqrt());
        (self.place_m.truncate() + d.truncate() * t * (self.radius_m / (self.radius_m + altitude_m))).extend(altitude_m)
    }

    /// Returns the intervals of a ray in the layers as (index of the layer, distances of its ends, m), in the order in
    /// which the ray meets them. Intervals on its way down come first, then intervals on its way up. Each is at most
    /// [`FARTHEST_M`] long.
    fn stretches(&self, d: DVec3, range_m: f64) -> Vec<(usize, [f64; 2])> {
        let lowest = -(self.radius_m + self.place_m.z) * d.z;
        let ground = self.crossings(d, 0.0);
        let meets = d.z < 0.0 && ground[1] > ground[0] && ground[0] > 0.0;
        let end = if meets { range_m.min(ground[0]) } else { range_m };
        let mut all = Vec::new();
        for falls in [true, false] {
            if (falls && lowest <= 0.0) || (!falls && lowest > end) {
                continue;
            }
            for i in 0..self.layers.len() {
                let k = if falls { self.layers.len() - 1 - i } else { i };
                let s = &self.layers[k].field.shape;
                let (base, top) = (self.crossings(d, s.base_m), self.crossings(d, s.base_m + s.thickness_m));
                let turn = lowest.max(0.0);
                let (first, last) =
                    if falls { (top[0].max(0.0), base[0].min(turn)) } else { (base[1].max(turn), top[1]) };
                let last = last.min(end);
                if last > first {
                    all.push((k, [first, last.min(first + FARTHEST_M)]));
                }
            }
        }
        all
    }

    /// Returns the clouds along a ray of direction `d` within `range_m`.
    pub fn seen(&self, d: DVec3, range_m: f64) -> CloudsSeen {
        let mut seen = MarchState { light: DVec3::ZERO, transmittance: 1.0, distance: 0.0 };
        for (k, stretch) in self.stretches(d, range_m) {
            let share = self.layers[k].share;
            if seen.transmittance > LEAST && share > 0.0 {
                let after = self.layer(&self.layers[k], d, stretch, seen);
                seen.light = seen.light.lerp(after.light, share);
                seen.transmittance += (after.transmittance - seen.transmittance) * share;
                seen.distance += (after.distance - seen.distance) * share;
            }
        }
        let cover = (1.0 - seen.transmittance).max(1e-9);
        CloudsSeen {
            light: seen.light,
            transmittance: seen.transmittance,
            distance_m: (seen.distance / cover).max(1.0),
        }
    }

    /// Marches a ray through one layer, between the distances `first` and `last`, m. Adds the layer's light to `seen`.
    fn layer(&self, layer: &MarchedLayer<'_>, d: DVec3, [first, last]: [f64; 2], mut seen: MarchState) -> MarchState {
        let s = &layer.field.shape;
        let scaled = s.extinction_per_m * layer.scale;
        let fine = self.longer[0] * (STEP_DEPTH / scaled).clamp(s.thickness_m / 128.0, s.thickness_m / 24.0);
        let rise = (d.z + first / (self.radius_m + self.place_m.z)).abs();
        let coarse = fine.max(self.longer[1] * STEP_RISE * s.thickness_m / rise.max(1e-6));
        let mut gone = first;
        while gone < last && seen.transmittance > LEAST {
            let step = (self.longer[1] * STEP_ANGLE * gone).clamp(fine, coarse).min(last - gone);
            let t = gone + 0.5 * step;
            let position_m = self.at(d, t);
            let height = (position_m.z - s.base_m) / s.thickness_m;
            let (field, steady) = layer.field.here(position_m);
            let over = field.over(position_m);
            let frays = field.frays(position_m);
            let fades = ((first + FARTHEST_M - t) / FADES_M).clamp(0.0, 1.0);
            let extinction = field.dense(over - dome(&field.shape, over, height) + frays) * layer.scale * fades;
            if extinction <= 0.0 {
                gone += step.max(skip((&field.shape, steady), [over, frays], height, d));
                continue;
            }
            let place = AtPlace { layer, field, position_m, height, excess: over + frays };
            let left = (-extinction * step).exp();
            let share = seen.transmittance * (1.0 - left);
            seen.light += self.scattered(&place, -d, seen.transmittance) * share;
            seen.distance += t * share;
            seen.transmittance *= left;
            gone += step;
        }
        seen
    }

    /// Returns the light that a place scatters into a direction per unit of scaled depth, cd/m^2. `transmittance` is
    /// the transmittance of the clouds from the eye to the place.
    fn scattered(&self, place: &AtPlace<'_>, direction: DVec3, transmittance: f64) -> DVec3 {
        let sources = self.light.of(place.layer.medium);
        let s = sources.scattered(&place.depths(sources.to_sun), direction, -transmittance.ln());
        let light = &place.layer.light;
        let is_ice = place.layer.medium == ICE;
        let halo = if is_ice { halo::excess(&sources.scattering, -direction.dot(sources.to_sun)) } else { [0.0; 3] };
        DVec3::from_array(light.sun) * (s.sun + s.once * DVec3::from_array(halo))
            + DVec3::from_array(light.above) * s.sky
            + DVec3::from_array(light.below) * s.ground
    }

    /// Returns the optical depth of the clouds between the place and a point `offset` away, m (east, north, up); all
    /// scattering counts as loss. A layer that a picture shows as a deck counts as the cloud that the deck replaces.
    pub fn depth(&self, offset: DVec3) -> f64 {
        let range_m = offset.length();
        let d = offset / range_m;
        let one = |(k, [first, last]): (usize, [f64; 2])| {
            let of = &self.layers[k];
            let s = &of.field.shape;
            let most = (0.1 / s.extinction_per_m).clamp(s.thickness_m / 1024.0, s.thickness_m / 64.0);
            let steps = ((last - first) / most).ceil().clamp(1.0, 16384.0);
            let step = (last - first) / steps;
            let at = |i: usize| of.field.extinction_per_m(self.at(d, first + (i as f64 + 0.5) * step));
            step * (0..steps as usize).map(at).sum::<f64>()
        };
        self.stretches(d, range_m).into_iter().map(one).sum()
    }
}

/// Returns the distance along a ray from a place outside clouds within which there is no cloud, m: `cloud_skip` of the
/// shader. The threshold stays the same within `steady_m`, and beyond it changes by at most `slope_per_m` per metre.
/// `over` is the excess at the place before dome and fraying, `frays` the amount that the solid noise adds to it.
pub(crate) fn skip(
    (s, [steady_m, slope_per_m]): (&Shape, [f64; 2]),
    [over, frays]: [f64; 2],
    height: f64,
    d: DVec3,
) -> f64 {
    let domed = s.dome_over(over);
    let gap = (domed * height * height).min(s.anvil) - over;
    let leaning = 2.0 * s.lean_m.length() / s.thickness_m * d.z.abs();
    let level = d.truncate().length() + leaning;
    let round = 2.0 * domed * height / s.thickness_m * (-d.z).max(0.0);
    let within = |slope_per_m: f64| {
        let steep = (MAP_SKIP / s.scale_m + slope_per_m) * level + round;
        let by_map = (gap - MOST_FRAYED * s.rough) / (steep + 1e-6);
        let by_noise = (gap - frays) / (steep + SOLID_SKIP * s.rough / s.solid_m);
        by_map.max(by_noise)
    };
    // The threshold stays the same within `steady_m` and may change beyond.
    let steady = steady_m / level.max(1e-3);
    let near = if s.threshold > CLEAR_FROM { steady } else { within(0.0).min(steady) };
    near.max(within(slope_per_m))
}

impl AtPlace<'_> {
    /// Returns the length of cloud at full extinction from the place towards the sun, m: `cloud_sun_way` of the shader.
    fn sun_way(&self, to_sun: DVec3) -> f64 {
        let s = &self.field.shape;
        let z = if to_sun.z >= 0.0 { to_sun.z.max(1e-3) } else { to_sun.z.min(-1e-3) };
        let rise = z / s.thickness_m;
        let way = if rise > 0.0 { 1.0 - self.height } else { self.height } / rise.abs();
        let (mut gone, mut depth) = (0.0, 0.0);
        for (i, end) in SUN_WAY.into_iter().enumerate() {
            let end = (end * s.scale_m).min(way);
            if gone >= way {
                break;
            }
            let t = 0.5 * (gone + end);
            let height = self.height + rise * t;
            let at = self.position_m.truncate() + to_sun.truncate() * t;
            let at = at.extend(s.base_m + height * s.thickness_m);
            let (there, _) = self.layer.field.here(at);
            let over = there.over(at);
            if i < SUN_FRAYED {
                let excess = over - dome(&there.shape, over, height) + there.frays(at);
                depth += (excess / s.soft).clamp(0.0, 1.0) * (end - gone);
            } else {
                depth += stretch(&there.shape, over, [self.height + rise * gone, rise], end - gone);
            }
            gone = end;
        }
        depth
    }

    /// Returns the scaled depths of cloud around the place: `cloud_depths` of the shader.
    fn depths(&self, to_sun: DVec3) -> Depths {
        let s = &self.field.shape;
        let scaled = s.extinction_per_m * self.layer.scale;
        let about = about(s, self.excess, self.height);
        let [above, below, level] = [about.above_m, about.below_m, about.edge_m].map(|m| m * scaled);
        let to_sun_depth = self.sun_way(to_sun) * scaled;
        let sine = to_sun.truncate().length();
        let edge = level.max(0.02);
        let other = (WIDTH_CELLS * s.scale_m * scaled - edge).max(edge);
        let near = edge.max(to_sun_depth * sine);
        Depths { above, below, to_sun: to_sun_depth, near, far: other, left: edge, right: other }
    }
}

/// Returns the length of cloud at full extinction along an interval of a ray, m: `cloud_stretch` of the shader. All
/// places of the interval have this excess. The interval begins at `height` and rises by `rise` per metre.
fn stretch(s: &Shape, excess: f64, [height, rise]: [f64; 2], length: f64) -> f64 {
    let to = height + rise * length;
    let (low, high) = (height.min(to).clamp(0.0, 1.0), height.max(to).clamp(0.0, 1.0));
    let top = high.max((low + 0.02).min(1.0));
    let bottom = low.min(top - 0.02);
    let filled = filled_below(s, excess, top) - filled_below(s, excess, bottom);
    length * filled / (top - bottom)
}
