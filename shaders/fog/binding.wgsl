// Binding of a frame's fog.
//!include "fog/uniform.wgsl"

@group(0) @binding(4) var<uniform> low_air: LowAir;
