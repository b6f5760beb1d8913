// Water on the ground.
//!include "ground/uniform.wgsl"

@group(0) @binding(6) var<uniform> ground: GroundUniform;
// Water of the cells of the host's terrain (TerrainWater::texels in src/ground/terrain.rs).
@group(0) @binding(7) var terrain_cells: texture_2d<f32>;
