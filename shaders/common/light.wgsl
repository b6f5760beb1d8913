// The host's own lamps; the f64 twin is in src/scene/light.rs.

const MAX_LIGHTS: u32 = 64u;

struct HostLight {
    // Camera-relative, m.
    position: vec3f,
    // Cosine of the beam's end; below -1 it has none.
    end: f32,
    direction: vec3f,
    // 1/(cosine of where the beam is full - that of its end).
    steepness: f32,
    // cd times the exposure.
    intensity: vec3f,
    pad: f32,
}

// Share of what a lamp sends in its middle that it sends at an angle to that, by the cosine.
fn light_beam(lamp: HostLight, cosine: f32) -> f32 {
    return smoothstep(0.0, 1.0, (cosine - lamp.end) * lamp.steepness);
}

// Illuminance of a lamp on a surface `to` from it that faces it.
fn light_at(lamp: HostLight, to: vec3f) -> vec3f {
    let d2 = max(dot(to, to), 0.01);
    return lamp.intensity * (light_beam(lamp, dot(to, lamp.direction) * inverseSqrt(d2)) / d2);
}
