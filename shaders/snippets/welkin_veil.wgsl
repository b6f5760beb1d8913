// For a host's own transparent shader: effect of Welkin's air and fog on a fragment at `distance` metres from the eye.
//   let veil = welkin_veil(light_texture, through_texture, linear_clamp_sampler, uv, distance);
//   colour = colour * veil.through + veil.light * light_scale;
// `uv` is the fragment's position in the picture, (0, 0) at the target's first texel. Blend colour with alpha
// afterwards.

struct WelkinVeil {
    light: vec3f,
    through: vec3f,
}

// Texture coordinates of a position in the picture on a distance slice, 0 to 31.
fn welkin_veil_uv(uv: vec2f, slice: f32) -> vec2f {
    let tile = vec2f(slice - 8.0 * floor(slice / 8.0), floor(slice / 8.0));
    let texel = tile * vec2f(32.0, 18.0) + clamp(uv, vec2f(0.0), vec2f(1.0)) * vec2f(31.0, 17.0) + 0.5;
    return texel / vec2f(256.0, 72.0);
}

// Light that the weather adds in front of a fragment, and transmittance for the light behind.
fn welkin_veil(light: texture_2d<f32>, through: texture_2d<f32>, linear: sampler, uv: vec2f, distance: f32) -> WelkinVeil {
    let s = clamp(log(max(distance, 0.0) / 20.0 + 1.0) * 3.6396112, 0.0, 31.0);
    let near = min(floor(s), 30.0);
    let a = welkin_veil_uv(uv, near);
    let b = welkin_veil_uv(uv, near + 1.0);
    let t = s - near;
    return WelkinVeil(
        mix(textureSampleLevel(light, linear, a, 0.0).rgb, textureSampleLevel(light, linear, b, 0.0).rgb, t),
        mix(textureSampleLevel(through, linear, a, 0.0).rgb, textureSampleLevel(through, linear, b, 0.0).rgb, t),
    );
}
