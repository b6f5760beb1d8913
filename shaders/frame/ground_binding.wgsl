// Water on the ground.
//!include "ground/uniform.wgsl"

@group(0) @binding(6) var<uniform> ground: GroundUniform;
