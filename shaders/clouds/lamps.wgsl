// The lamps and flashes that light clouds: LampsUniform of src/clouds/light/lamps.rs.
//!include "common/light.wgsl"

struct CloudLamp {
    light: HostLight,
    // How far its light reaches about its place, m.
    radius: f32,
    // Mean of its light over all directions, of that in its middle.
    even: f32,
    // Above 0 where it shines in a cloud, whatever lies on the way.
    buried: f32,
    pad: f32,
}

struct CloudLamps {
    count: u32,
    // First row of the target, and its texels.
    row: f32,
    size: vec2f,
    lamps: array<CloudLamp, 16>,
}

@group(0) @binding(11) var<uniform> lamps: CloudLamps;
