// Light of the host's own lamps; the f64 reference is in src/scene/light.rs.

const MAX_LIGHTS: u32 = 64u;

struct HostLight {
    // Position relative to the camera, (east, north, up), m.
    position: vec3f,
    // Cosine of the angle at which the beam ends; below -1 for a lamp that shines to all sides.
    end: f32,
    direction: vec3f,
    // 1 / (cosine of the angle up to which the beam is full - `end`).
    steepness: f32,
    // Luminous intensity times the exposure, cd.
    intensity: vec3f,
    pad: f32,
}

// Ratio of a lamp's intensity at an angle from its axis to that on the axis; `cosine` is that of the angle.
fn light_beam(lamp: HostLight, cosine: f32) -> f32 {
    return smoothstep(0.0, 1.0, (cosine - lamp.end) * lamp.steepness);
}

// Illuminance of a lamp at a surface that faces it; `to` is the vector from the lamp to the surface.
fn light_at(lamp: HostLight, to: vec3f) -> vec3f {
    let d2 = max(dot(to, to), 0.01);
    return lamp.intensity * (light_beam(lamp, dot(to, lamp.direction) * inverseSqrt(d2)) / d2);
}
