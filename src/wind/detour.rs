//! Detours: obstacles delay and deflect patches of fog and dust that drift with the wind near the ground.
//!
//! Patches move with the displacement of the weather's wind, which is the same everywhere. Where the wind varies in
//! space, the air at a place has come by another path. The path is traced back along the level wind w near the ground.
//! Let e be the wind that enters the grid, and s the distance that free air travels; w and e are divided by the speed
//! of e. The air at a place then lags by
//!
//! L = integral of (e - w) exp(-s / life) ds,
//!
//! where `life` is the distance that free air travels in a patch's life. The patches at the place are those that free
//! air would have carried L farther. Eddies stir patches: what happened to the air more than a patch's life ago no
//! longer shows, and no lag grows longer than `life`. With an infinite life L would be the drift of Darwin (1953).

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};

use super::WindVolume;

use crate::numerics::smooth;

/// Number of nodes along a side of a map: `DETOUR_SIDE` of `shaders/fog/uniform.wgsl`.
pub(crate) const DETOUR_SIDE: usize = 24;
/// Height above ground of the wind along which patches are traced, m.
const HEIGHT_M: f64 = 2.0;
/// Speed of the entering wind below which nothing drifts, m/s.
const LEAST_WIND_M_S: f64 = 0.2;
/// Number of steps back over three lives of a patch.
const STEPS: usize = 48;
/// Share of the map's width at each side over which detours fade to 0, so that the pattern continues unchanged outside.
/// A solved field blends into the weather's wind there; the entering wind is therefore sampled inside these edges.
const EDGE: f64 = 0.15;
/// Number of heights above ground at which a grid is sampled to find how high its obstacles reach.
const LEVELS: usize = 12;

/// Lag of the air near the ground behind the free air, around a grid of wind.
#[derive(Debug, PartialEq)]
pub(crate) struct DetourMap {
    /// Position of the south-western node in the host's world, on the grid's floor.
    origin: DVec3,
    /// Rotation from the host's axes at the origin to east, north, up.
    to_enu: DMat3,
    /// Distance between nodes, m.
    cell_m: DVec2,
    /// Lags east and north, m. East varies fastest, then north.
    pub lags_m: Vec<[f32; 2]>,
    /// Height above the floor at which half of the detour is left, m.
    half_height_m: f64,
}

/// Map of the lags, relative to a camera.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Detour {
    /// Map of the lags.
    pub map: Arc<DetourMap>,
    /// Reciprocal distance between nodes, east and north, 1/m.
    pub scale: DVec2,
    /// Position of the camera in the map, in nodes from its south-western node, east and north.
    pub camera: DVec2,
    /// Height of the floor above the camera, m.
    pub floor_m: f64,
    /// Inverse of the height above the floor at which no detour is left, 1/m.
    pub fade_per_m: f64,
}

/// Level wind of a grid at a height above ground.
struct LevelWind<'a> {
    /// Grid of wind.
    volume: &'a WindVolume,
    /// Function that returns the ground's height above the grid's origin, m. Its argument is a place, m east and north
    /// of the origin.
    ground_m: &'a dyn Fn(DVec2) -> f64,
    /// Weather's wind at this height, m/s (east, north).
    weathers_m_s: DVec2,
    /// Height above ground, m.
    height_m: f64,
}

impl LevelWind<'_> {
    /// Returns the wind at a place in metres east and north of the grid's origin, m/s (east, north); `None` outside the
    /// grid.
    fn at(&self, place: DVec2) -> Option<DVec2> {
        let up = (self.ground_m)(place) + self.height_m;
        let found = self.volume.at((place.extend(up)) / self.volume.cell_m)?;
        Some(found.truncate().truncate() + self.weathers_m_s * (1.0 - found.w))
    }

    /// Returns the mean wind on those sides of an area's inner part where the wind enters. `size` is the size of the
    /// whole area, m.
    fn entering(&self, size: DVec2) -> DVec2 {
        let along = |i: usize| (i as f64 + 0.5) / DETOUR_SIDE as f64;
        let sides = [
            (DVec2::X, DVec2::ZERO, DVec2::Y),
            (-DVec2::X, DVec2::X, DVec2::Y),
            (DVec2::Y, DVec2::ZERO, DVec2::X),
            (-DVec2::Y, DVec2::Y, DVec2::X),
        ];
        let winds = sides.map(|(inward, start, way)| {
            let places = (0..DETOUR_SIDE).map(|i| (EDGE + (1.0 - 2.0 * EDGE) * (start + way * along(i))) * size);
            let (sum, count) = places.filter_map(|p| self.at(p)).fold((DVec2::ZERO, 0), |(s, n), w| (s + w, n + 1));
            (inward, sum, f64::from(count))
        });
        let mean = |chosen: &dyn Fn(DVec2) -> bool| {
            let of = winds.iter().filter(|w| chosen(w.0));
            let (sum, count) = of.fold((DVec2::ZERO, 0.0), |(s, n), w| (s + w.1, n + w.2));
            sum / f64::max(count, 1.0)
        };
        let toward = mean(&|_| true).normalize_or_zero();
        mean(&|inward| inward.dot(toward) > 0.5)
    }
}

impl DetourMap {
    /// Creates the map of a grid of wind in the weather's wind. `ground_m` returns the ground's height above the grid's
    /// origin at a place in metres east and north of it, `weathers_m_s` the weather's wind at a height above ground.
    /// `life_m` is the distance that free air travels in a patch's life. It is limited here to a sixth of the grid, so
    /// that lags are gone at the grid's edges. `None` if less than 0.2 m/s of wind enters the grid.
    pub fn new(
        volume: &WindVolume,
        ground_m: &dyn Fn(DVec2) -> f64,
        weathers_m_s: &dyn Fn(f64) -> DVec2,
        life_m: f64,
    ) -> Option<Self> {
        let size = (DVec3::from(volume.nodes.map(|n| f64::from(n.max(1) - 1))) * volume.cell_m).truncate();
        let cell_m = size / (DETOUR_SIDE - 1) as f64;
        let level = |height_m: f64| LevelWind { volume, ground_m, weathers_m_s: weathers_m_s(height_m), height_m };
        let places = || (0..DETOUR_SIDE * DETOUR_SIDE).map(|i| [i % DETOUR_SIDE, i / DETOUR_SIDE]);
        let place = |[i, j]: [usize; 2]| DVec2::new(i as f64, j as f64) * cell_m;
        let life_m = life_m.min(size.min_element() / 6.0);
        let low = level(HEIGHT_M);
        let entering = low.entering(size);
        if cell_m.min_element() <= 0.0 || entering.length() < LEAST_WIND_M_S {
            return None;
        }
        let lag = |at: [usize; 2]| {
            let edge = (place(at) / size).min(1.0 - place(at) / size).min_element() / EDGE;
            let share = edge.min(1.0);
            followed(&low, (entering, size), place(at), life_m) * smooth(share)
        };
        let lags_m = places().map(|at| lag(at).as_vec2().to_array()).collect();
        // Relative variation of the wind over the area, at a height.
        let varies = |height_m: f64| {
            let level = level(height_m);
            let free = level.entering(size);
            let of = places().filter_map(|at| level.at(place(at)));
            of.map(|w| (w - free).length_squared()).sum::<f64>().sqrt() / free.length().max(LEAST_WIND_M_S)
        };
        let step_m = f64::from(volume.nodes[2].max(2) - 1) * volume.cell_m.z / LEVELS as f64;
        let heights = (0..LEVELS).map(|k| (k as f64 + 0.5) * step_m);
        let (most, sum) = heights.map(varies).fold((0.0, 0.0), |(most, sum), v| (f64::max(most, v), sum + v));
        let half_height_m = if most > 0.0 { (sum * step_m / most).max(HEIGHT_M) } else { HEIGHT_M };
        Some(Self { origin: volume.origin, to_enu: volume.to_enu, cell_m, lags_m, half_height_m })
    }

    /// Returns the map relative to a camera at `eye` in the host's world.
    pub fn about(self: &Arc<Self>, eye: DVec3) -> Detour {
        let camera = self.to_enu * (eye - self.origin);
        Detour {
            map: self.clone(),
            scale: 1.0 / self.cell_m,
            camera: camera.truncate() / self.cell_m,
            floor_m: -camera.z,
            fade_per_m: 0.5 / self.half_height_m,
        }
    }
}

/// Returns the lag of the air at a place of an area of this size, m (east, north). `entering` is the wind of free air,
/// m/s, and `life_m` the distance that free air travels in a patch's life.
fn followed(level: &LevelWind<'_>, (entering, size): (DVec2, DVec2), mut place: DVec2, life_m: f64) -> DVec2 {
    let (free, speed) = (entering.normalize_or_zero(), entering.length());
    let step = 3.0 * life_m / STEPS as f64;
    let (mut behind, mut was_within) = (DVec2::ZERO, false);
    for n in 0..STEPS {
        // The air is free before it enters and after it leaves.
        let is_within = place.cmpge(size * EDGE).all() && place.cmple(size * (1.0 - EDGE)).all();
        if was_within && !is_within {
            break;
        }
        was_within |= is_within;
        if !is_within {
            place -= free * step;
            continue;
        }
        let Some(first) = level.at(place) else { break };
        let middle = place - first / speed * (0.5 * step);
        let Some(wind) = level.at(middle) else { break };
        let way = wind / speed * step;
        behind += (free * step - way) * libm::exp(-(n as f64 + 0.5) * step / life_m);
        place -= way;
    }
    behind
}

impl Detour {
    /// Returns the lag of the air at a place relative to the camera, m (east, north).
    pub fn lag_m(&self, place: DVec3) -> DVec2 {
        let last = (DETOUR_SIDE - 1) as f64;
        let at = (self.camera + place.truncate() * self.scale).clamp(DVec2::ZERO, DVec2::splat(last));
        let low = at.floor().min(DVec2::splat(last - 1.0));
        let part = at - low;
        let node = |i: usize, j: usize| {
            let [x, y] = self.map.lags_m[(low.y as usize + j) * DETOUR_SIDE + low.x as usize + i];
            DVec2::new(f64::from(x), f64::from(y))
        };
        let row = |j: usize| node(0, j).lerp(node(1, j), part.x);
        let x = ((place.z - self.floor_m) * self.fade_per_m).clamp(0.0, 1.0);
        row(0).lerp(row(1), part.y) * (1.0 - smooth(x))
    }

    /// Returns the interval of a ray that lies over the map: distances from its origin, m. The second is less than the
    /// first for a ray that misses the map.
    pub fn over(&self, origin: DVec3, direction: DVec3) -> [f64; 2] {
        let at = self.camera + origin.truncate() * self.scale;
        let way = direction.truncate() * self.scale;
        let way = DVec2::select(way.abs().cmplt(DVec2::splat(1e-9)), DVec2::splat(1e-9), way);
        let (a, b) = (-at / way, (DVec2::splat((DETOUR_SIDE - 1) as f64) - at) / way);
        [a.min(b).max_element(), a.max(b).min_element()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wind::{WindGrid, WindGridKind};

    /// Radius of a pillar at the middle of an area of 240 m, m.
    const PILLAR_M: f64 = 12.0;
    const HALF_M: f64 = 120.0;

    /// Frictionless level flow around the pillar at the origin, eastward at 5 m/s far away.
    fn round_pillar(p: DVec2) -> DVec2 {
        let r2 = p.length_squared();
        if r2 <= PILLAR_M * PILLAR_M {
            return DVec2::ZERO;
        }
        let k = PILLAR_M * PILLAR_M / (r2 * r2);
        DVec2::new(1.0 - k * (p.x * p.x - p.y * p.y), -2.0 * k * p.x * p.y) * 5.0
    }

    fn volume(kind: WindGridKind, wind: impl Fn(DVec3) -> DVec2) -> WindVolume {
        let (nodes, cell_m) = ([121, 121, 5], DVec3::new(2.0, 2.0, 4.0));
        let place = |i: u32| DVec3::new(f64::from(i % 121), f64::from(i / 121 % 121), f64::from(i / 14641)) * cell_m;
        let velocity = |i| wind(place(i) - DVec2::splat(HALF_M).extend(0.0)).extend(0.0).as_vec3().to_array();
        let velocities_m_s = (0..121 * 121 * 5).map(velocity).collect();
        let origin = DVec3::new(-HALF_M, -HALF_M, 0.0);
        WindVolume::of_grid(&WindGrid { origin, cell_m, nodes, kind, velocities_m_s }, DMat3::IDENTITY)
    }

    fn map(volume: &WindVolume, weathers_m_s: DVec2, life_m: f64) -> Option<Arc<DetourMap>> {
        DetourMap::new(volume, &|_| 0.0, &|_| weathers_m_s, life_m).map(Arc::new)
    }

    fn lag(map: &Arc<DetourMap>, place: DVec2) -> DVec2 {
        map.about(DVec3::ZERO).lag_m(place.extend(0.0))
    }

    /// The lag by its definition, with small steps of Runge and Kutta's second order through the exact flow.
    fn truth(mut p: DVec2, life_m: f64) -> DVec2 {
        let step = 0.01;
        let (mut behind, mut s) = (DVec2::ZERO, 0.0);
        while s < 4.0 * life_m {
            let w = round_pillar(p - round_pillar(p) / 5.0 * (0.5 * step)) / 5.0;
            behind += (DVec2::X - w) * (-(s + 0.5 * step) / life_m).exp() * step;
            (p, s) = (p - w * step, s + step);
        }
        behind
    }

    #[test]
    fn air_is_behind_as_the_exact_flow_round_a_pillar_has_it() {
        let life_m = 40.0;
        let map = map(&volume(WindGridKind::Whole, |p| round_pillar(p.truncate())), DVec2::ZERO, life_m).expect("wind");
        let mut most = 0f64;
        // At the map's nodes, away from the edges, where the lag fades.
        for (i, j) in (4..20).flat_map(|i| (4..20).map(move |j| (i, j))) {
            let p = DVec2::new(f64::from(i), f64::from(j)) * (2.0 * HALF_M / 23.0) - HALF_M;
            if p.length() < 1.5 * PILLAR_M {
                continue;
            }
            let (got, want) = (lag(&map, p), truth(p, life_m));
            most = most.max(want.length());
            assert!((got - want).length() < 0.015 * life_m, "{p}: {got}, by the exact flow {want}");
        }
        assert!(most > 0.09 * life_m, "{most}");
        // Air is held up in front of the pillar, runs ahead beside it, and passes alike on both sides.
        let [before, beside] = [DVec2::new(-25.0, 0.0), DVec2::new(0.0, 28.0)].map(|p| lag(&map, p).x);
        assert!(before > 2.0 && beside < -0.5, "{before} {beside}");
        let [left, right] = [14.0, -14.0].map(|y| lag(&map, DVec2::new(-20.0, y)));
        assert!(left.y < -0.5 && (left.y + right.y).abs() < 1e-3, "{left} {right}");
        // Lags end at the map's edge, and far above the ground.
        assert_eq!(lag(&map, DVec2::new(0.0, HALF_M)), DVec2::ZERO);
        assert_eq!(map.about(DVec3::ZERO).lag_m(DVec3::new(-25.0, 0.0, 100.0)), DVec2::ZERO);
    }

    #[test]
    fn a_wind_without_obstacles_delays_no_air_in_any_kind_of_grid() {
        let even = |v: DVec2| move |_: DVec3| v;
        for (volume, weathers) in [
            (volume(WindGridKind::Whole, even(DVec2::new(3.0, -2.0))), DVec2::new(40.0, 1.0)),
            (volume(WindGridKind::Added, even(DVec2::ZERO)), DVec2::new(3.0, -2.0)),
            (volume(WindGridKind::Whole, |p| DVec2::new(3.0, -2.0) * (0.5 + 0.1 * p.z)), DVec2::ZERO),
        ] {
            let map = map(&volume, weathers, 100.0).expect("wind");
            assert!(map.lags_m.as_flattened().iter().all(|v| v.abs() < 1e-3));
        }
        assert_eq!(
            map(&volume(WindGridKind::Whole, even(DVec2::ZERO)), DVec2::X, 100.0),
            None,
            "a calm carries nothing"
        );
    }

    /// A wall of 6 m in a grid 16 m high delays only the air near the ground. On ground as high as the wall it delays
    /// no air.
    #[test]
    fn the_delay_by_an_obstacle_ends_above_it_and_follows_the_ground() {
        let wall = volume(WindGridKind::Whole, |p| {
            let low = if p.z < 6.0 && p.truncate().length() < 30.0 { 0.2 } else { 1.0 };
            DVec2::X * (5.0 * low)
        });
        let map = map(&wall, DVec2::ZERO, 40.0).expect("wind");
        let seen = map.about(DVec3::ZERO);
        let at = |z: f64| seen.lag_m(DVec3::new(10.0, 0.0, z)).x;
        assert!(at(0.0) > 15.0, "{}", at(0.0));
        let half = at(map.half_height_m) / at(0.0);
        assert!((half - 0.5).abs() < 1e-9 && (4.0..10.0).contains(&map.half_height_m), "{half} {}", map.half_height_m);
        // On a hill as high as the wall the wind is sampled above the layer of slow air.
        let hill = DetourMap::new(&wall, &|_| 7.0, &|_| DVec2::ZERO, 40.0).expect("wind");
        assert!(hill.lags_m.as_flattened().iter().all(|v| v.abs() < 1e-3));
    }
}
