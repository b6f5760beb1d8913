// Lamps and flashes that light clouds: LampsUniform of src/clouds/light/lamps.rs.
//!include "common/light.wgsl"

// A lamp or a flash that lights clouds.
struct CloudLamp {
    // Lamp or flash as all shaders read it.
    light: HostLight,
    // Radius of the source, m.
    radius: f32,
    // Ratio of the mean intensity over all directions to that in the middle of the beam.
    even: f32,
    // Above 0 for a source inside a cloud. The path from the source to a lit place is then taken as all cloud, and the
    // cloud on it is not measured.
    buried: f32,
    // Padding.
    pad: f32,
}

// All lamps and flashes that light clouds.
struct CloudLamps {
    // Number of lamps and flashes.
    count: u32,
    // First row of the glow in its target.
    row: f32,
    // Width and height of the glow's picture, texels.
    size: vec2f,
    // Lamps and flashes, of which the first `count` are in use.
    lamps: array<CloudLamp, 16>,
}

// Lamps and flashes of the frame.
@group(0) @binding(11) var<uniform> lamps: CloudLamps;
