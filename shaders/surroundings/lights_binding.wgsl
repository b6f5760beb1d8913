// The host's lamps around the camera.
//!include "common/light.wgsl"

// Whether there are any lamps. Shaders that run in every pixel read it to leave the loop out.
override LAMPS: bool = false;

// Block of lamps.
struct Lights {
    // Number of lamps.
    count: u32,
    lamps: array<HostLight, MAX_LIGHTS>,
}

@group(2) @binding(3) var<uniform> lights: Lights;

// Returns the number of lamps. It is masked to the bits that its maximum needs, so that each loop ends whatever the
// block holds. `min` would give the driver a fixed end of the loop, which it may then unroll.
fn light_count() -> u32 {
    return lights.count & 127u;
}
