// Interim sky and fog.
struct Aerial {
    light: vec3f,
    transmittance: vec3f,
}

fn sky_radiance(light: u32, d: vec3f) -> vec3f {
    return vec3f(0.02, 0.04, 0.08) * (1.0 - 0.6 * clamp(d.z, 0.0, 1.0));
}

fn view_transmittance(d: vec3f) -> vec3f {
    return select(vec3f(0.0), exp(-vec3f(0.05, 0.1, 0.2) / (d.z + 0.02)), d.z > 0.0);
}

fn aerial(light: u32, d: vec3f, distance: f32) -> Aerial {
    let t = exp(-distance * vec3f(1e-5, 2e-5, 4e-5));
    return Aerial(sky_radiance(light, vec3f(0.0, 0.0, 0.0)) * (1.0 - t), t);
}

