// The lamps and flashes that light clouds: LampsUniform of src/clouds/lamps.rs.

struct CloudLamp {
    // Camera-relative, m, and how far its light reaches about that.
    position: vec3f,
    radius: f32,
    // Cosine of the beam's end; below -1 it has none. 1/(cosine of where the beam is full - that of its end).
    direction: vec3f,
    end: f32,
    // In the beam's middle, cd times exposure.
    intensity: vec3f,
    steepness: f32,
    // The mean over all directions, of the middle's; above 0 where it shines in a cloud, whatever lies on the way.
    even: f32,
    buried: f32,
    pad: vec2f,
}

struct CloudLamps {
    count: u32,
    // First row of the target, and its texels.
    row: f32,
    size: vec2f,
    lamps: array<CloudLamp, 16>,
}

@group(0) @binding(11) var<uniform> lamps: CloudLamps;
