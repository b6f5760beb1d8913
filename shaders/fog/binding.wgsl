// Binding of a frame's fog.
//!include "fog/uniform.wgsl"

// Fog of the frame and the detours of its patches.
@group(0) @binding(4) var<uniform> low_air: LowAir;
