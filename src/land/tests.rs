//! Tests of the drawn terrain without a device: patches that meet have the same vertices.

use std::collections::HashMap;

use glam::{DMat3, DMat4, DVec2, DVec3};

use super::{
    cells::CellReader,
    eye::LandEye,
    light::LandLight,
    page::{PageRect, PageWriter, VERTICES},
    patch::patch_indices,
    reference::vertex,
    relief::{NodeKey, Relief},
    selection::{LandFrustum, LandPatch, LevelDistances, select},
    uniforms::{LandPicture, LandUniform, PatchInstance},
};
use crate::{
    chance::RandomStream,
    scene::WorldFrame,
    terrain::{DugCell, DugColor, Rows, SurfaceClass, Terrain, TerrainCells, TerrainDesc, TileKey},
};

const SIDE: u32 = 128;

/// Rough ground: hills of 64 cells with a step between neighbours that differs from cell to cell.
fn height(x: i32, y: i32) -> f32 {
    let (u, v) = (f64::from(x), f64::from(y));
    let rough = f64::from((x.wrapping_mul(73_856_093) ^ y.wrapping_mul(19_349_663)) & 255) / 255.0;
    (9.0 * libm::sin(u / 10.0) * libm::cos(v / 13.0) + 30.0 * libm::sin(u / 97.0 + v / 71.0) + rough) as f32
}

/// Terrain of `count` x `count` tiles; cells where `is_hole` is true have no ground.
fn terrain(count: i32, is_hole: impl Fn(i32, i32) -> bool) -> Terrain {
    let desc = TerrainDesc { origin: DVec3::ZERO, cell_m: 1.0, tile_cells: SIDE };
    let mut terrain = Terrain::new(desc, &WorldFrame::default()).unwrap();
    for north in 0..count {
        for east in 0..count {
            let place = |i: i32| (east * SIDE as i32 + i % SIDE as i32, north * SIDE as i32 + i / SIDE as i32);
            let cells = (SIDE * SIDE) as i32;
            let heights: Vec<f32> = (0..cells).map(|i| height(place(i).0, place(i).1)).collect();
            let class = |i: i32| (!is_hole(place(i).0, place(i).1)).then_some(SurfaceClass::Vegetation);
            let classes: Vec<_> = (0..cells).map(class).collect();
            let key = TileKey::new(east, north);
            let cells =
                TerrainCells { key, heights_m: Rows::of(&heights), classes: Rows::of(&classes), ..Default::default() };
            terrain.set_tile(&cells).unwrap();
        }
    }
    terrain
}

/// A frustum that sees everything.
fn everything() -> LandFrustum {
    let w = DMat4::from_cols_array(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    LandFrustum::new(w, DVec3::ZERO, 1.0)
}

fn uniform_of(detail: &LevelDistances, eye: LandEye, top: u8) -> LandUniform {
    LandPicture {
        eye,
        detail: *detail,
        cell_m: 1.0,
        to_local: DMat3::IDENTITY,
        curvature: 0.0,
        altitude_m: 0.0,
        has_dug: false,
        light: LandLight::default(),
        shadows_to_m: 0.0,
    }
    .uniform(DMat4::IDENTITY, top)
}

/// Vertices on the rims of all patches of a picture, as the shader places them.
struct Mesh {
    patches: Vec<(LandPatch, Vec<[u32; 3]>)>,
}

impl Mesh {
    fn new(terrain: &Terrain, relief: &Relief, detail: &mut LevelDistances, eye: DVec3) -> Self {
        let mut patches = Vec::new();
        select(relief, detail, &everything(), &mut patches);
        let eye = LandEye::new(eye);
        let land = uniform_of(detail, eye, relief.top());
        let (mut writer, mut pages) = (PageWriter::default(), HashMap::new());
        let mut vertices = |patch: &LandPatch| -> Vec<[u32; 3]> {
            let page: &Vec<f32> = pages.entry(patch.page).or_insert_with(|| {
                writer.write_vertices(&mut CellReader::new(terrain), patch.page, PageRect::vertices());
                writer.vertices.clone()
            });
            let quarter = (patch.quarter[0] | patch.quarter[1] << 1) as u32;
            let low = [0, 1].map(|i| patch.low()[i] - eye.cell[i]);
            let instance = PatchInstance { low, slot: 0, kind: u32::from(patch.page.level) | quarter << 8 };
            let place = |i| vertex(&land, &instance, i, |[x, y]| page[(y * VERTICES + x) as usize]);
            rim().map(|i| place(i).map(f32::to_bits)).collect()
        };
        Self { patches: patches.iter().map(|patch| (*patch, vertices(patch))).collect() }
    }

    /// Edges of patches' triangles on the patches' rims that are not shared by two patches, bit for bit.
    fn open_edges(&self) -> Vec<[[f32; 3]; 2]> {
        let mut edges: HashMap<[[u32; 3]; 2], i32> = HashMap::new();
        for (_, rim) in &self.patches {
            for i in 0..rim.len() {
                // An edge is passed once in each direction. Vertices that have moved onto each other are one.
                let (a, b) = (rim[i], rim[(i + 1) % rim.len()]);
                if a != b {
                    let (key, turn) = if a < b { ([a, b], 1) } else { ([b, a], -1) };
                    *edges.entry(key).or_insert(0) += turn;
                }
            }
        }
        let open = edges.into_iter().filter(|(_, turns)| *turns != 0);
        open.map(|(edge, _)| edge.map(|v| v.map(f32::from_bits))).collect()
    }
}

/// Indices of the vertices on the rim of a patch, in its triangles' sense.
fn rim() -> impl Iterator<Item = i32> {
    let at = |x: i32, y: i32| y * 9 + x;
    (0..8)
        .map(move |i| at(i, 0))
        .chain((0..8).map(move |i| at(8, i)))
        .chain((0..8).map(move |i| at(8 - i, 8)))
        .chain((0..8).map(move |i| at(0, 8 - i)))
}

#[test]
fn the_triangles_of_a_patch_meet_each_other_and_its_rim() {
    let mut edges: HashMap<[u16; 2], i32> = HashMap::new();
    let indices: Vec<u16> = patch_indices().collect();
    for corners in indices.chunks(3) {
        for i in 0..3 {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            *edges.entry([a.min(b), a.max(b)]).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    let rim: Vec<u16> = rim().map(|i| i as u16).collect();
    for i in 0..rim.len() {
        let (a, b) = (rim[i], rim[(i + 1) % rim.len()]);
        *edges.entry([a.min(b), a.max(b)]).or_insert(0) -= if a < b { 1 } else { -1 };
    }
    assert!(edges.len() > 200 && edges.values().all(|turns| *turns == 0));
}

/// Random place of an eye over the terrain, cells and metres.
fn random_eye(chance: &mut RandomStream, side: f64) -> DVec3 {
    let height = 400.0 * chance.unit() * chance.unit();
    DVec3::new((1.4 * chance.unit() - 0.2) * side, (1.4 * chance.unit() - 0.2) * side, 40.0 + height)
}

fn random_detail(chance: &mut RandomStream, relief: &mut Relief, eye: DVec3) -> LevelDistances {
    let plan = DVec2::new(eye.x, eye.y);
    let above = (eye.z - relief.reference_m(plan, 1.0)).max(0.0);
    // Levels that reach unequally far.
    let wanted: [f64; 8] = std::array::from_fn(|_| 160.0 * chance.unit());
    let reach = LevelDistances::reach_for(|level| wanted[level.min(7)]);
    LevelDistances { eye: plan, above, spread: 1.0, reach }
}

/// The mesh of each view has only the terrain's outer edge as its edge.
#[test]
fn patches_that_meet_share_their_vertices_to_the_bit() {
    let terrain = terrain(2, |_, _| false);
    let side = f64::from(2 * SIDE);
    let mut relief = Relief::default();
    relief.update(&terrain, |_| ());
    let (mut chance, mut levels) = (RandomStream::new(7, 1), [0; 8]);
    for view in 0..1000 {
        let eye = random_eye(&mut chance, side);
        let mut detail = random_detail(&mut chance, &mut relief, eye);
        let mesh = Mesh::new(&terrain, &relief, &mut detail, eye);
        mesh.patches.iter().for_each(|(patch, _)| levels[usize::from(patch.page.level)] += 1);
        let cell = LandEye::new(eye).cell;
        let part = [0, 1].map(|i| (eye[i] - f64::from(cell[i])) as f32);
        for edge in mesh.open_edges() {
            let is_outer = (0..2).any(|axis| {
                [0.0, side as f32].iter().any(|end| {
                    let at = end - cell[axis] as f32 - part[axis];
                    edge.iter().all(|v| (v[axis] - at).abs() < 1e-3)
                })
            });
            assert!(is_outer, "view {view} from {eye}: {edge:?} is open");
        }
    }
    assert!(levels[..4].iter().all(|count| *count > 100), "{levels:?}");
}

/// The bank of a wide pit, five cells deep, whose wall runs across the lattice at an angle: light falls on it as on a
/// straight wall, though its cells are a stair.
#[test]
fn a_wall_of_soil_faces_one_way_at_any_angle_to_the_lattice() {
    for angle_deg in [0.0f64, 8.0, 20.0, 35.0, 45.0] {
        let facing = DVec2::from_angle(angle_deg.to_radians());
        let mut terrain = terrain(1, |_, _| false);
        let slot = terrain.slot(TileKey::new(0, 0)).unwrap();
        let color = DugColor { albedo: [90; 3], share: 255 };
        let cell = |cell: usize| {
            let place = DVec2::new((cell % SIDE as usize) as f64, (cell / SIDE as usize) as f64);
            let depth = 5.0 * (0.5 - (place - 32.0).dot(facing)).clamp(0.0, 1.0);
            let color = if depth > 0.0 { color } else { DugColor::default() };
            DugCell { cell, height_m: -depth as f32, color }
        };
        let cells: Vec<DugCell> = (0..(SIDE * SIDE) as usize).map(cell).collect();
        terrain.set_dug(slot, &cells, 1);
        (terrain.soil_revision, terrain.surface_soil) = (1, color);
        let mut writer = PageWriter::default();
        let page = NodeKey { level: 2, x: 0, y: 0 };
        let rect = PageRect::texels(2);
        writer.write_texels(&mut CellReader::new(&terrain), page, rect, 1);
        let slopes = writer.slopes.iter().map(|s| [s[0], s[1]].map(|bits| f64::from(half::f16::from_bits(bits))));
        let walls = slopes.map(DVec2::from_array).filter(|slope| slope.length() > 1.0);
        let off: Vec<f64> = walls.map(|slope| slope.angle_to(facing).abs().to_degrees()).collect();
        let rms = (off.iter().map(|v| v * v).sum::<f64>() / off.len() as f64).sqrt();
        println!("{angle_deg} degrees: {} texels, {rms:.1} degrees off", off.len());
        assert!(off.len() > 30 && rms < 2.0, "{angle_deg}: {rms}");
    }
}
