// For a host's own transparent shader (GLSL 3.30, GLSL ES 3.00): effect of Welkin's air and fog on a fragment at
// `distance` metres from the eye.
//   vec3 through, light = welkin_veil(light_texture, through_texture, uv, distance, through);
//   colour = colour * through + light * light_scale;
// `uv` is the fragment's position in the picture, (0, 0) at the target's first texel. The samplers must filter
// linearly.

// Texture coordinates of a position in the picture on a distance slice, 0 to 31.
vec2 welkin_veil_uv(vec2 uv, float slice) {
    vec2 tile = vec2(slice - 8.0 * floor(slice / 8.0), floor(slice / 8.0));
    vec2 texel = tile * vec2(32.0, 18.0) + clamp(uv, vec2(0.0), vec2(1.0)) * vec2(31.0, 17.0) + 0.5;
    return texel / vec2(256.0, 72.0);
}

// Returns the light that the weather adds in front of a fragment. `transmittance` gets the share of the light behind
// that passes.
vec3 welkin_veil(sampler2D light, sampler2D through, vec2 uv, float distance, out vec3 transmittance) {
    float s = clamp(log(max(distance, 0.0) / 20.0 + 1.0) * 3.6396112, 0.0, 31.0);
    float near = min(floor(s), 30.0);
    vec2 a = welkin_veil_uv(uv, near);
    vec2 b = welkin_veil_uv(uv, near + 1.0);
    transmittance = mix(textureLod(through, a, 0.0).rgb, textureLod(through, b, 0.0).rgb, s - near);
    return mix(textureLod(light, a, 0.0).rgb, textureLod(light, b, 0.0).rgb, s - near);
}
