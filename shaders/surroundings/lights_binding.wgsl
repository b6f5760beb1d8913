// The host's lamps around the camera.
//!include "common/light.wgsl"

// Whether there are any lamps. Shaders that run in every pixel read it to leave the loop out.
override LAMPS: bool = false;

// Number of lamps, and the lamps.
struct Lights {
    count: u32,
    lamps: array<HostLight, MAX_LIGHTS>,
}

@group(2) @binding(3) var<uniform> lights: Lights;

// Returns the number of lamps. Counts of blocks are masked to the bits that their maximum needs, so that each loop ends
// whatever its block holds. `min` would not do: a driver that knows the end of a loop may unroll it.
fn light_count() -> u32 {
    return lights.count & 127u;
}
