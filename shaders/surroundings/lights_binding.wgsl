// The host's lamps round the camera.
//!include "common/light.wgsl"

struct Lights {
    count: u32,
    lamps: array<HostLight, MAX_LIGHTS>,
}

@group(2) @binding(3) var<uniform> lights: Lights;
