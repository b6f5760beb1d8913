// Vertices of the sea's mesh at rest. src/sea/mesh.rs describes the mesh; its tests have the twin of `rest_of`.
//!include "sea/uniform.wgsl"

// Length of the finest cells, m, and cells along a block's side.
const SEA_FINEST: f32 = 0.03125;
const SEA_CELLS: u32 = 8u;
// Distances, in sides of a level's blocks, between which vertices move onto those of the next level.
const SEA_MORPH_FROM: f32 = 2.52;
const SEA_MORPH_UNTIL: f32 = 2.98;

// Distance of a place from the camera by which levels are chosen, m.
fn mesh_distance(at: vec2f) -> f32 {
    let from_eye = abs(at - sea.eye);
    return max(max(from_eye.x, from_eye.y), sea.height);
}

// Place at rest of a block's vertex. `block` has the corner in finest cells and the level.
fn rest_of(block: vec4i, index: u32) -> vec2f {
    let cell = 1i << u32(block.z);
    let own = vec2i(i32(index % (SEA_CELLS + 1u)), i32(index / (SEA_CELLS + 1u)));
    let length = f32(cell) * SEA_FINEST;
    let at = vec2f(block.xy + own * cell) * SEA_FINEST;
    let past = mesh_distance(at) / (length * f32(SEA_CELLS)) - SEA_MORPH_FROM;
    let moved = clamp(past * (1.0 / (SEA_MORPH_UNTIL - SEA_MORPH_FROM)), 0.0, 1.0);
    return at - vec2f(own & vec2i(1)) * length * moved;
}
