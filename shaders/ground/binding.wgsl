// Bindings of the ground: its uniform block and the textures of the host's terrain.
//!include "ground/uniform.wgsl"

@group(0) @binding(6) var<uniform> ground: GroundUniform;
// Terrain of the host, one texel per node (src/ground/texture.rs). `terrain_cells` has its water. The first half of the
// rows of `terrain_surface` has the slopes to the east and the north, the height above the grid's origin in m, and the
// class. The second half has the snow: depth in m, density in kg/m^3, wetness, albedo.
@group(0) @binding(7) var terrain_cells: texture_2d<f32>;
@group(0) @binding(8) var terrain_surface: texture_2d<f32>;
