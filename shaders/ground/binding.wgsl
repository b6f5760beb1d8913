// Water on the ground.
//!include "ground/uniform.wgsl"

@group(0) @binding(6) var<uniform> ground: GroundUniform;
// Of the host's terrain, node by node (src/ground/texture.rs): its water; slopes to the east and the north, height over
// the grid's origin in metres, class; and in as many rows more its snow: depth in m, density in kg/m^3, wetness,
// albedo.
@group(0) @binding(7) var terrain_cells: texture_2d<f32>;
@group(0) @binding(8) var terrain_surface: texture_2d<f32>;
