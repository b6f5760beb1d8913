//! Rain areas seen from a camera: the columns of their rain, and their optical depth along a ray. This file has the
//! formulas of `shaders/rain/shaft.wgsl` and `shaders/rain/area.wgsl` in f64.
//!
//! A column is the area's plan carried up to its cloud along the slant of the falling drops. The segment of a ray
//! inside the column is found exactly: the intersection with an ellipse or a convex polygon in the plan and with two
//! levels in height. The segment is cut where the rim and the soft top end, and the rain on each of the four pieces is
//! integrated with four Gauss points. The pattern of curtains is a sum of waves that fall with the drops. The result is
//! multiplied by the pattern's mean along the ray, which is exact for each of two stretches: the first half kilometre
//! inside the column, and the rest. The weather's own rain is drawn with the fog, so a column adds only the difference
//! between its own extinction and that of the weather's rain.

use glam::{DMat3, DVec2, DVec3};

use super::shells::HIDDEN_M;
use crate::{
    falling::{
        FallingLayer, MAX_AREAS,
        area::{MAX_CORNERS, Outline, Shaft},
        curtain::{AMOUNT, PATTERN_M, PERIOD_M, WAVES},
    },
    light::sinc,
    numerics::GAUSS_4,
    numerics::smoothstep,
    scene::depth::RANGE_SKY_M,
};

/// Depth of the columns below the level of their plan, m: they reach into valleys.
pub(crate) const BELOW_M: f64 = 1000.0;
/// Length of the front stretch of a column, m. Most of the light of a dense column comes from this stretch.
const FRONT_M: f64 = 500.0;

/// Structure `Column` of the block in `shaders/rain/area.wgsl`, which describes the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct ColumnUniform {
    pub center: [f32; 2],
    pub lean: [f32; 2],
    pub right: [f32; 2],
    pub semi: [f32; 2],
    pub rim: f32,
    pub ground: f32,
    pub top: f32,
    pub extinction: f32,
    pub fallen: f32,
    pub turn: f32,
    pub fine: f32,
    pub near: f32,
    pub corners: u32,
    pub later: u32,
    pub radius: f32,
    pub soft: f32,
    pub edges: [[f32; 4]; MAX_CORNERS],
}

impl ColumnUniform {
    /// Placeholder for no column.
    pub const NONE: Self = Self {
        center: [0.0; 2],
        lean: [0.0; 2],
        right: [1.0, 0.0],
        semi: [1.0; 2],
        rim: 1.0,
        ground: 0.0,
        top: 0.0,
        extinction: 0.0,
        fallen: 0.0,
        turn: 0.0,
        fine: 1.0,
        near: 0.0,
        corners: 0,
        later: 0,
        radius: 1.0,
        soft: 1.0,
        edges: [[0.0; 4]; MAX_CORNERS],
    };
}

/// Eye in the host's world, around which columns stand.
#[derive(Clone, Copy)]
pub(crate) struct EyeInWorld<'a> {
    /// Position in the host's world, m.
    pub position: DVec3,
    /// Rotation from the host's axes at the eye to east, north, up.
    pub to_enu: &'a DMat3,
    /// Altitude of the eye, m.
    pub altitude_m: f64,
}

/// Column of a rain area, in camera-relative east, north, up, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RainColumn {
    /// Centre of the plan, east and north of the camera, m.
    pub center: DVec2,
    shaft: Shaft,
    /// Height of the level at which the plan is given, relative to the camera, m.
    pub ground: f64,
    /// Height of the cloud's base, relative to the camera, m.
    pub top: f64,
    /// Extinction of the rain, 1/m. It fades to 0 at distances at which the column is too far to be seen.
    extinction: f64,
    /// Extinction of the drops that are drawn near the camera, 1/m.
    pub near: f64,
    /// Distance that the drops have fallen, m, modulo the pattern's period.
    fallen: f64,
    /// Later columns of the list that overlap this one: bit `j` is set for column `j`.
    pub later: u32,
}

/// All columns around a camera.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AreaField {
    /// Columns, in the order of the host's list.
    pub columns: Vec<RainColumn>,
    /// Weather's own rain, outside the columns.
    pub own: FallingLayer,
    /// Top of the weather's own rain, relative to the camera, m.
    pub own_top: f64,
    /// Extinction of the weather's own drops that are drawn near the camera, 1/m.
    pub own_near: f64,
    /// Distance up to which rain is drawn as drops or cones instead of as extinction, m.
    pub near_m: f64,
    /// Wave numbers of the pattern to the right, ahead and up (1/m), and phases (rad).
    pub waves: [[f64; 4]; WAVES],
}

/// Returns the mean, between the heights `a` and `b`, of a ramp that is 0 above `top` and 1 below `top - soft`.
fn ramp_mean(top: f64, soft: f64, a: f64, b: f64) -> f64 {
    let below = |z: f64| {
        let x = ((top - z) / soft).clamp(0.0, 1.0);
        // Integral of the ramp from `z` up to `top`.
        (((top - z) / soft - x).max(0.0) + 0.5 * x * x) * soft
    };
    if (b - a).abs() < 0.01 * soft {
        return ((top - 0.5 * (a + b)) / soft).clamp(0.0, 1.0);
    }
    (below(a) - below(b)) / (b - a)
}

impl RainColumn {
    /// Creates the column of a shaft as seen from an eye; `None` where it cannot be seen.
    fn new(shaft: Shaft, eye: EyeInWorld<'_>, own: &FallingLayer, time_s: f64) -> Option<Self> {
        let away = eye.to_enu * (shaft.center - eye.position);
        let distance = away.length() - shaft.radius_m;
        // Fades the column out from 150 to 250 km, where hardly anything of it can be seen, so that it does not vanish
        // abruptly.
        let shown = 1.0 - smoothstep(1.5e5, 2.5e5, distance);
        if shown <= 0.0 || shaft.top_m.max(own.top_m) <= shaft.ground_m - BELOW_M {
            return None;
        }
        // Lowers a far column on a curved planet: by how far the planet's level surface has sunk below the camera's
        // horizontal plane at the column's centre.
        let level = |altitude: f64| {
            let sunk = away.z - (shaft.center_altitude_m - eye.altitude_m);
            altitude - eye.altitude_m + sunk
        };
        Some(Self {
            center: away.truncate(),
            shaft,
            ground: level(shaft.ground_m),
            top: level(shaft.top_m),
            extinction: shaft.falling.liquid_extinction_per_m * shown,
            near: 0.0,
            fallen: (shaft.speed_m_s * time_s).rem_euclid(PERIOD_M),
            later: 0,
        })
    }

    /// Returns the area's shaft.
    pub fn shaft(&self) -> &Shaft {
        &self.shaft
    }

    /// Returns whether two columns may overlap.
    fn meets(&self, other: &Self) -> bool {
        // Adds the difference between the horizontal shifts of the two slanted columns over the height from the higher
        // cloud down to the valleys.
        let height = (self.top.max(other.top) - self.ground.min(other.ground) + BELOW_M).max(0.0);
        let aside = (self.shaft.lean - other.shaft.lean).length() * height;
        (self.center - other.center).length() < self.shaft.radius_m + other.shaft.radius_m + aside
    }

    /// Turns (east, north) to the plan's axes, (right, ahead).
    fn turned(&self, plan: DVec2) -> DVec2 {
        self.shaft.turned(plan)
    }

    /// Returns the share of the rain at a camera-relative place that belongs to this column, 0 to 1, regardless of
    /// other columns.
    fn share(&self, p: DVec3) -> f64 {
        let q = p.truncate() - self.center - self.shaft.lean * (p.z - self.ground);
        smoothstep(0.0, self.shaft.rim_m, self.shaft.outline.depth(self.turned(q)))
    }

    /// Returns the interval of t in which the point q + u t is at least `inset` m inside the outline. This point is the
    /// position of a ray in the plan at the distance t, m.
    fn chord(&self, q: DVec2, u: DVec2, inset: f64) -> Option<[f64; 2]> {
        match &self.shaft.outline {
            Outline::Ellipse(semi) => {
                let inner = *semi - inset;
                if inner.min_element() < 1.0 {
                    return None;
                }
                let (e, v) = (q / inner, u / inner);
                let a = v.length_squared().max(1e-16);
                let middle = -e.dot(v) / a;
                let left = 1.0 - (e + v * middle).length_squared();
                (left > 0.0).then(|| {
                    let half = (left / a).sqrt();
                    [middle - half, middle + half]
                })
            }
            Outline::Polygon(edges, count) => {
                let (mut first, mut last) = (-1e9f64, 1e9f64);
                for e in &edges[..*count] {
                    let (f, g) = (e.depth(q) - inset, e.normal.dot(u));
                    // A ray parallel to the edge, with g = 0 or -0, gets a far crossing of the right sign.
                    let t = -f
                        / if g.abs() >= 1e-9 {
                            g
                        } else if g >= 0.0 {
                            1e-9
                        } else {
                            -1e-9
                        };
                    if g >= 0.0 { first = first.max(t) } else { last = last.min(t) }
                }
                (last > first).then_some([first, last])
            }
        }
    }

    /// Returns the mean of the pattern between the distances `a` and `b`, m, along a ray whose position in the plan is
    /// q + u t and whose height is z + dz t. The pattern's mean over all places is 1.
    fn pattern(&self, waves: &[[f64; 4]; WAVES], q: DVec2, u: DVec2, (z, dz): (f64, f64), [a, b]: [f64; 2]) -> f64 {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let fine = self.fine();
        let at = (q + u * middle) * fine;
        let height = z + dz * middle - self.ground + self.fallen;
        let mut sum = 0.0;
        for (i, [kx, ky, kz, phase]) in waves.iter().enumerate() {
            let x = ((kx * u.x + ky * u.y) * fine + kz * dz) * half;
            let turn = self.turn() * (i as f64 + 1.0);
            sum += (kx * at.x + ky * at.y + kz * height + phase + turn).cos() * sinc(x);
        }
        let shown = smoothstep(PATTERN_M[0], PATTERN_M[1], middle);
        (1.0 + AMOUNT * shown * sum).max(0.0)
    }

    /// Returns the phase offset that gives each column its own pattern, rad.
    fn turn(&self) -> f64 {
        f64::from(self.shaft.index) * 2.4
    }

    /// Returns the factor by which the pattern of a small area is finer, 1 to 10.
    fn fine(&self) -> f64 {
        (2000.0 / self.shaft.radius_m).clamp(1.0, 10.0)
    }

    /// Returns the column in the layout of the shaders.
    pub fn uniform(&self) -> ColumnUniform {
        let two = |v: DVec2| v.as_vec2().to_array();
        let (semi, corners, mut edges) = match &self.shaft.outline {
            Outline::Ellipse(semi) => (*semi, 0, [[0.0; 4]; MAX_CORNERS]),
            Outline::Polygon(e, count) => {
                let row = |e: crate::falling::area::Edge| [e.normal.x as f32, e.normal.y as f32, e.offset as f32, 0.0];
                (DVec2::ONE, *count as u32, e.map(row))
            }
        };
        // Clears unused edges, which hold infinite numbers.
        edges[corners as usize..].fill([0.0; 4]);
        ColumnUniform {
            center: two(self.center),
            lean: two(self.shaft.lean),
            right: two(self.shaft.right),
            semi: two(semi),
            rim: self.shaft.rim_m as f32,
            ground: self.ground as f32,
            top: self.top as f32,
            extinction: self.extinction as f32,
            fallen: self.fallen as f32,
            turn: self.turn() as f32,
            fine: self.fine() as f32,
            near: self.near as f32,
            corners,
            later: self.later,
            radius: self.shaft.radius_m as f32,
            soft: self.shaft.soft_m() as f32,
            edges,
        }
    }
}

impl AreaField {
    /// Creates a field without columns.
    pub fn empty() -> Self {
        let own = FallingLayer::NONE;
        Self { columns: Vec::new(), own, own_top: 0.0, own_near: 0.0, near_m: HIDDEN_M, waves: [[0.0; 4]; WAVES] }
    }

    /// Creates the field around an eye.
    pub fn new(shafts: impl Iterator<Item = Shaft>, eye: EyeInWorld<'_>, own: &FallingLayer, time_s: f64) -> Self {
        let mut field = Self::empty();
        field.set(shafts, eye, own, time_s);
        field
    }

    /// Replaces the columns, as [`AreaField::new`] would create them.
    pub fn set(&mut self, shafts: impl Iterator<Item = Shaft>, eye: EyeInWorld<'_>, own: &FallingLayer, time_s: f64) {
        self.columns.clear();
        self.columns.reserve_exact(MAX_AREAS);
        self.columns.extend(shafts.filter_map(|s| RainColumn::new(s, eye, own, time_s)));
        (self.own, self.own_top, self.own_near) = (*own, own.top_m - eye.altitude_m, 0.0);
        for i in 0..self.columns.len() {
            let later = (i + 1..self.columns.len()).filter(|j| self.columns[i].meets(&self.columns[*j]));
            self.columns[i].later = later.fold(0, |bits, j| bits | 1 << j);
        }
    }

    /// Returns the share of the rain at a camera-relative place that belongs to column `i`, without the rain that later
    /// columns replace.
    pub fn share(&self, i: usize, p: DVec3) -> f64 {
        let over = |j: &usize| self.columns[i].later & (1 << j) != 0;
        let left: f64 = (i + 1..self.columns.len()).filter(over).map(|j| 1.0 - self.columns[j].share(p)).product();
        self.columns[i].share(p) * left
    }

    /// Returns the optical depth that column `i` adds to a ray from `origin` (relative to the camera) along `d`, up to
    /// the distance `range`, m. It is below 0 where the weather's own rain, which the column replaces, is denser. If
    /// `patterned` is set, the depth includes the pattern of curtains. `None` if the ray misses the column.
    pub fn met(&self, i: usize, origin: DVec3, d: DVec3, range: f64, patterned: bool) -> Option<f64> {
        let c = &self.columns[i];
        let lean = c.shaft.lean;
        let q = c.turned(origin.truncate() - c.center - lean * (origin.z - c.ground));
        let u = c.turned(d.truncate() - lean * d.z);
        let [first, last] = c.chord(q, u, 0.0)?;
        // Bounds the ray by the valleys and by the higher of two clouds, the column's and the weather's: above its own
        // cloud the column still replaces the weather's rain.
        let up = if d.z.abs() < 1e-6 { 1e-6f64.copysign(d.z) } else { d.z };
        let [a, b] = [(c.ground - BELOW_M - origin.z) / up, (c.top.max(self.own_top) - origin.z) / up];
        let mut end = range.min(a.max(b)).min(last);
        if range >= RANGE_SKY_M && d.z < 0.0 && origin.z > c.ground {
            // If a ray meets no object, ends it at the level of the ground.
            end = end.min((c.ground - origin.z) / up);
        }
        let begin = first.max(a.min(b)).max(0.0);
        if end <= begin {
            return None;
        }
        let middle = 0.5 * (first + last);
        let [s0, s1] = c.chord(q, u, c.shaft.rim_m).unwrap_or([middle; 2]);
        let [s0, s1, soft] = [s0, s1, (c.top - c.shaft.soft_m() - origin.z) / up].map(|t| t.clamp(begin, end));
        let cuts = [begin, s0.min(soft), s0.max(soft.min(s1)), s1.max(soft), end];
        let (mut shared, mut fell) = (0.0, 0.0);
        for piece in cuts.windows(2) {
            let (from, length) = (piece[0], piece[1] - piece[0]);
            if length <= 0.0 {
                continue;
            }
            let (mut share, mut fallen) = (0.0, 0.0);
            for (x, w) in GAUSS_4.map(|(x, w)| (0.5 + 0.5 * x, 0.5 * w)) {
                let p = origin + d * (from + x * length);
                let here = w * self.share(i, p);
                share += here;
                fallen += here * ((c.top - p.z) / c.shaft.soft_m()).clamp(0.0, 1.0);
            }
            let [z0, z1] = [piece[0], piece[1]].map(|t| origin.z + d.z * t);
            shared += length * share * ramp_mean(self.own_top, self.own.soft_m, z0, z1);
            fell += length * fallen;
        }
        if patterned {
            // Applies the pattern of the column's front, which is most visible, and of the rest.
            let cut = (begin + FRONT_M).min(end);
            let [front, rest] = [[begin, cut], [cut, end]]
                .map(|way| (way[1] - way[0]) * c.pattern(&self.waves, q, u, (origin.z, d.z), way));
            fell *= (front + rest) / (end - begin);
        }
        let mut depth = c.extinction * fell - self.own.liquid_per_m * shared;
        // Subtracts the part of the extinction that is drawn as drops near the eye.
        let near = range.min(self.near_m);
        let half = origin + d * (0.5 * near);
        depth -= (c.near - self.own_near) * near * self.share(i, half);
        Some(depth)
    }

    /// Returns the optical depth that all columns add within the distance `range`, m, averaged over their pattern.
    pub fn depth_along(&self, origin: DVec3, d: DVec3, range: f64) -> f64 {
        (0..self.columns.len()).filter_map(|i| self.met(i, origin, d, range, false)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::falling::curtain::{self, COLUMN_LENGTHS_M};
    use crate::rain::{AreaMotion, AreaShape, RainArea};

    /// Extinction that a column adds at a place, from its description alone.
    fn added(field: &AreaField, i: usize, p: DVec3, patterned: bool) -> f64 {
        let c = &field.columns[i];
        if p.z < c.ground - BELOW_M || p.z > c.top.max(field.own_top) {
            return 0.0;
        }
        let q = c.turned(p.truncate() - c.center - c.shaft.lean * (p.z - c.ground));
        let begun = ((c.top - p.z) / c.shaft.soft_m()).clamp(0.0, 1.0);
        let own = ((field.own_top - p.z) / field.own.soft_m).clamp(0.0, 1.0);
        let wave = |(i, w): (usize, &[f64; 4])| {
            let at = q * c.fine();
            (w[0] * at.x + w[1] * at.y + w[2] * (p.z - c.ground + c.fallen) + w[3] + c.turn() * (i as f64 + 1.0)).cos()
        };
        let shown = if patterned { smoothstep(PATTERN_M[0], PATTERN_M[1], p.length()) } else { 0.0 };
        let more = (1.0 + AMOUNT * shown * field.waves.iter().enumerate().map(wave).sum::<f64>()).max(0.0);
        field.share(i, p) * (c.extinction * more * begun - field.own.liquid_per_m * own)
    }

    /// Returns three areas: an ellipse, a polygon with the same center, and a second ellipse that overlaps the first.
    fn areas() -> Vec<RainArea> {
        let ellipse = RainArea {
            center_m: [300.0, 5000.0, 0.0],
            shape: AreaShape::Ellipse([1500.0, 900.0]),
            heading_deg: 30.0,
            rim_m: 400.0,
            rate_mm_h: 12.0,
            ..RainArea::default()
        };
        let mut corners = [[0.0; 2]; MAX_CORNERS];
        corners[..5].copy_from_slice(&[
            [-900.0, -700.0],
            [800.0, -900.0],
            [1200.0, 100.0],
            [300.0, 1100.0],
            [-800.0, 700.0],
        ]);
        let polygon =
            RainArea { shape: AreaShape::Polygon(corners, 5), motion: AreaMotion::Own([3.0, -4.0]), ..ellipse };
        let beside = RainArea { center_m: [1300.0, 5600.0, 0.0], rate_mm_h: 30.0, ..ellipse };
        vec![ellipse, polygon, beside]
    }

    /// Creates the field of these areas around an eye 2 m above the ground; the weather's own rain has an extinction of
    /// `own_per_m`, 1/m.
    fn field(areas: &[RainArea], own_per_m: f64) -> AreaField {
        let shafts = areas.iter().enumerate().map(|(i, a)| {
            a.validate().unwrap();
            Shaft::new(a, i as u32, (DVec3::from(a.center_m), 0.0), (6.0, DVec2::new(1.5, 0.5)), 0.0)
        });
        let own = FallingLayer { liquid_per_m: own_per_m, top_m: 1200.0, ..FallingLayer::NONE };
        let eye = EyeInWorld { position: DVec3::Z * 2.0, to_enu: &DMat3::IDENTITY, altitude_m: 2.0 };
        let mut field = AreaField::new(shafts, eye, &own, 77.0);
        field.waves = curtain::waves(5, COLUMN_LENGTHS_M);
        field
    }

    /// Compares the closed form with a sum of small steps for each ray.
    #[test]
    fn what_a_ray_meets_is_the_integral_along_it() {
        for areas in [&areas()[..1], &areas()[1..2], &areas()[..]] {
            for own in [0.0, 4e-4] {
                let field = field(areas, own);
                let (mut seen, mut off) = (0.0, [(0.0f64, 0.0f64); 2]);
                for k in 0..400 {
                    let (azimuth, elevation) = (f64::from(k % 20) * 0.04 - 0.4, f64::from(k / 20) * 0.02 - 0.06);
                    let d = DVec3::new(azimuth.sin(), azimuth.cos(), elevation).normalize();
                    let range = if elevation < 0.0 {
                        2.0 / -d.z
                    } else if k % 3 == 0 {
                        5200.0
                    } else {
                        1e5
                    };
                    for patterned in [false, true] {
                        let met = |i| field.met(i, DVec3::ZERO, d, range, patterned).unwrap_or(0.0);
                        let got: f64 = (0..areas.len()).map(met).sum();
                        let h = 2.0;
                        let steps = (range.min(12e3) / h) as usize;
                        let at = |s: usize| d * ((s as f64 + 0.5) * h);
                        let step = |s| (0..areas.len()).map(|i| added(&field, i, at(s), patterned)).sum::<f64>() * h;
                        let want: f64 = (0..steps).map(step).sum();
                        seen += f64::from(u8::from(want != 0.0 && patterned));
                        let ratio = ((-got).exp() / (-want).exp() - 1.0).abs();
                        let (worst, squares) = &mut off[usize::from(patterned)];
                        *worst = worst.max(ratio);
                        *squares += ratio * ratio;
                    }
                }
                let [even, patterned] = off.map(|(worst, squares)| [worst, (squares / seen).sqrt()]);
                assert!(even[0] < 0.05 && even[1] < 0.01, "{} areas: {even:?}", areas.len());
                assert!(patterned[1] < 0.15, "{} areas: {patterned:?}", areas.len());
                assert!(seen > 100.0, "{seen}");
            }
        }
    }

    #[test]
    fn the_pattern_is_even_on_the_mean_and_falls_with_the_drops() {
        let mut field = field(&areas()[..1], 0.0);
        let c = field.columns[0];
        let at = |c: &RainColumn, field: &AreaField, x: f64, z: f64| {
            c.pattern(&field.waves, DVec2::new(x, 0.3 * x), DVec2::X, (z, 0.0), [1000.0, 1001.0])
        };
        let values: Vec<f64> = (0..4000).map(|i| at(&c, &field, f64::from(i) * 23.0, 700.0)).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let spread = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt();
        assert!((mean - 1.0).abs() < 0.05 && (0.3..0.7).contains(&spread), "{mean} {spread}");
        let mut lower = c;
        lower.fallen += 60.0;
        assert!((at(&c, &field, 40.0, 700.0) - at(&lower, &field, 40.0, 640.0)).abs() < 1e-9);
        field.waves = curtain::waves(6, COLUMN_LENGTHS_M);
        assert_ne!(at(&c, &field, 40.0, 700.0), values[0]);
    }
}
