// Water on the ground.
//!include "ground/uniform.wgsl"

@group(0) @binding(6) var<uniform> ground: GroundUniform;
// Water of the host's terrain, node by node (src/ground/texture.rs), and its height over the grid's origin, m.
@group(0) @binding(7) var terrain_cells: texture_2d<f32>;
@group(0) @binding(8) var terrain_heights: texture_2d<f32>;
