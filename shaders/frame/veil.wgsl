// What lies between the eye and a point: the light that the air and the fog send, and what they let through.
//!include "frame/uniform.wgsl"
//!include "frame/sky_link.wgsl"

// Lights that count: 1 the sun, 2 the moon too.
override LIGHTS: u32 = 1u;

// Light that reaches the eye beside what comes from behind, and the share of the latter that gets through.
struct Veil {
    light: vec3f,
    transmittance: vec3f,
}

fn local_to(light: FrameLight, d: vec3f) -> vec3f {
    let horizontal = length(light.direction.xy);
    let c = select(vec2f(1.0, 0.0), light.direction.xy / horizontal, horizontal > 1e-6);
    return vec3f(dot(d.xy, c), c.x * d.y - c.y * d.x, d.z);
}

fn air_between(d: vec3f, distance: f32) -> Veil {
    var veil = Veil(vec3f(0.0), vec3f(1.0));
    for (var i = 0u; i < LIGHTS; i++) {
        let light = frame.lights[i];
        let air = aerial(i, local_to(light, d), distance);
        veil.light += light.irradiance * frame.medium_share * air.light;
        veil.transmittance = air.transmittance;
    }
    veil.light += frame.night_floor * (1.0 - veil.transmittance);
    return veil;
}

// Air and fog together, for what lies `distance` metres along `d`.
fn veil_between(d: vec3f, distance: f32) -> Veil {
    let air = air_between(d, distance);
    let fog = fog_veil(d, distance);
    return Veil(air.light * fog.transmittance + fog.light, air.transmittance * fog.transmittance);
}
