// The host's lamps round the camera.
//!include "common/light.wgsl"

// Whether there are any. Read by what is drawn in every pixel.
override LAMPS: bool = false;

struct Lights {
    count: u32,
    lamps: array<HostLight, MAX_LIGHTS>,
}

@group(2) @binding(3) var<uniform> lights: Lights;
