// The frame's fog.
//!include "fog/lookup.wgsl"

@group(0) @binding(4) var<uniform> fog: FogUniform;
