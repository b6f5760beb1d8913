//! Reference of the drawn terrain: rays traced to the triangles of the ground in f64, and the vertices of
//! `shaders/land/vertex.wgsl` in the shader's single precision.

use glam::{DVec2, DVec3};

pub(crate) use super::shadow::DISC;
use super::{
    page::VERTICES,
    selection::PATCH,
    uniforms::{LandUniform, PatchInstance},
};
use crate::terrain::Terrain;

/// Returns the distance along a ray to the ground, m; `None` if the ray meets no ground within `farthest_m`. `origin`
/// is in metres along the lattice's axes from its origin, and `direction` is a unit vector along these axes.
pub(crate) fn ray_to_ground(terrain: &Terrain, origin: DVec3, direction: DVec3, farthest_m: f64) -> Option<f64> {
    let cell_m = terrain.desc.cell_m;
    let plan = DVec2::new(direction.x, direction.y) / cell_m;
    let start = DVec2::new(origin.x, origin.y) / cell_m;
    // Distance along the ray at which it enters `square`, m.
    let mut begin = 0.0;
    let mut square = start.floor();
    loop {
        let next = |i: usize| {
            let edge = if plan[i] > 0.0 { square[i] + 1.0 } else { square[i] };
            if plan[i] == 0.0 { f64::INFINITY } else { (edge - start[i]) / plan[i] }
        };
        let (x, y) = (next(0), next(1));
        let end = x.min(y).min(farthest_m);
        let found = [true, false].into_iter().filter_map(|south| {
            let range = range_to_triangle(terrain, square, south, origin, direction)?;
            (range >= begin - 1e-9 && range <= end + 1e-9 && range > 0.0).then_some(range)
        });
        if let Some(range) = found.reduce(f64::min) {
            return Some(range);
        }
        if end >= farthest_m {
            return None;
        }
        begin = end;
        let axis = usize::from(y < x);
        square[axis] += plan[axis].signum();
    }
}

/// Number of rays to a disc.
const RAYS: u32 = 9;

/// Returns the share of a disc of the sun's size, in the direction `light`, that the ground does not hide from `place`:
/// the share of free rays to points spread over the disc. `place` is in metres along the lattice's axes from the
/// lattice's origin. No ground may be higher than `top_m`.
pub(crate) fn disc_share(terrain: &Terrain, place: DVec3, light: DVec3, top_m: f64) -> f64 {
    let side = light.any_orthonormal_vector();
    let axes = [side, light.cross(side)];
    let seen = (0..RAYS).filter(|i| {
        let part = (f64::from(*i) + 0.5) / f64::from(RAYS);
        let (sine, cosine) = libm::sincos(2.399_963_229_728_653 * f64::from(*i));
        let off = DISC * part.sqrt() * (axes[0] * cosine + axes[1] * sine);
        let ray = (light + off).normalize();
        let over_all = (top_m - place.z).max(0.0) / ray.z.max(1e-4);
        ray_to_ground(terrain, place, ray, over_all + 1.0).is_none()
    });
    seen.count() as f64 / f64::from(RAYS)
}

/// Distance along a ray, m, to the plane of one of the two triangles of a square; `None` if the ray meets the plane on
/// the other side of the square's diagonal, or if the triangle has no ground. The caller checks that the ray is over
/// the square.
fn range_to_triangle(terrain: &Terrain, square: DVec2, south: bool, origin: DVec3, direction: DVec3) -> Option<f64> {
    let [x, y] = [square.x as i32, square.y as i32];
    let height = |place| terrain.cell_at(place).map(|cell| f64::from(terrain.height(cell)));
    let low = height([x, y])?;
    let far = height([x + 1, y + 1])?;
    let third = height(if south { [x + 1, y] } else { [x, y + 1] })?;
    let cell_m = terrain.desc.cell_m;
    let (along, across) = ((third - low) / cell_m, (far - third) / cell_m);
    let slope = if south { DVec2::new(along, across) } else { DVec2::new(across, along) };
    let over = origin.z - low - slope.dot(DVec2::new(origin.x, origin.y) - square * cell_m);
    let fall = slope.dot(DVec2::new(direction.x, direction.y)) - direction.z;
    let range = over / fall;
    let at = (DVec2::new(origin.x, origin.y) + range * DVec2::new(direction.x, direction.y)) / cell_m - square;
    let inside = if south { at.x >= at.y - 1e-9 } else { at.y >= at.x - 1e-9 };
    (range.is_finite() && inside).then_some(range)
}

/// Vertex of a patch: its place from the eye along the lattice's axes, m. `height` returns the height of a vertex of
/// the page.
pub(super) fn vertex(
    land: &LandUniform,
    patch: &PatchInstance,
    index: i32,
    height: impl Fn([i32; 2]) -> f32,
) -> [f32; 3] {
    let level = patch.kind & 255;
    let quarter = [(patch.kind >> 8 & 1) as i32, (patch.kind >> 9 & 1) as i32];
    let at = [index % (PATCH + 1), index / (PATCH + 1)];
    let odd = at.map(|v| v & 1);
    let cell = [0, 1].map(|i| patch.low[i] + (at[i] << level));
    let coarse_cell = [0, 1].map(|i| patch.low[i] + ((at[i] - odd[i]) << level));
    let in_page = [0, 1].map(|i| quarter[i] * PATCH + at[i]);
    debug_assert!(in_page.iter().all(|v| *v < VERTICES));
    let own = place(land, cell, height(in_page));
    let coarse = place(land, coarse_cell, height([0, 1].map(|i| in_page[i] - odd[i])));
    let morph = morph(land, cell, level);
    [0, 1, 2].map(|i| if morph >= 1.0 { coarse[i] } else { own[i] + (coarse[i] - own[i]) * morph })
}

fn place(land: &LandUniform, cell: [i32; 2], height: f32) -> [f32; 3] {
    let plan = [0, 1].map(|i| (cell[i] as f32 - land.eye[i]) * land.cell_m);
    [plan[0], plan[1], (height - land.eye[2]) - land.eye[3]]
}

fn morph(land: &LandUniform, cell: [i32; 2], level: u32) -> f32 {
    let flat = [0, 1].map(|i| (cell[i] as f32 - land.eye[i]) * land.spread);
    let distance = (flat[0] * flat[0] + flat[1] * flat[1] + land.above * land.above).sqrt();
    let [start, scale, ..] = land.levels[level as usize];
    ((distance - start) * scale).clamp(0.0, 1.0)
}
