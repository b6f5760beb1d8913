// The host's lamps round the camera.
//!include "common/light.wgsl"

// Whether there are any. Read by what is drawn in every pixel.
override LAMPS: bool = false;

struct Lights {
    count: u32,
    lamps: array<HostLight, MAX_LIGHTS>,
}

@group(2) @binding(3) var<uniform> lights: Lights;

// How many there are. Counts of blocks are cut to the bits that the most of them needs, so that each loop ends whatever
// its block holds; not by `min`, since a driver that knows the end of a loop may write it out.
fn light_count() -> u32 {
    return lights.count & 127u;
}
