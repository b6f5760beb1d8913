// For a host's own materials (GLSL 3.30, GLSL ES 3.00): appearance of water on the host's ground, from the texture that
// Welkin hands over, by the laws with which Welkin draws it.
//   WelkinGround water = welkin_ground(ground_texture, uv);
//   albedo = welkin_wet_albedo(albedo, water);
//   vec2 film = welkin_film(water); // blend a mirror (index 1.333, f0 0.02, roughness film.y) over the share film.x
// `uv` is the position in the host's world times the rows of uv_from_world. The sampler's filter does not matter.

struct WelkinGround {
    // Darkness of the surface: 0 dry, 1 soaked.
    float soaked;
    // Share of the surface under a film, and under standing water.
    float film;
    float pool;
    // Share under ice.
    float ice;
    // Depth of standing water, mm; negative where none stands.
    float standing;
};

// Values of one node: how soaked it is (0 to 1), share under a film, level of standing water above the ground in mm,
// share under ice. The first two follow from the node's wetness:
//   wetness = 0.3 soaked + 0.7 (1 - exp(-film_mm / 0.15)), or 1 under standing water
// A film of 0.15 mm covers 1 - 1/e of the grains of asphalt.
vec4 welkin_ground_node(vec4 texel) {
    float wetness = texel.z > 0.0 ? 1.0 : 0.3 * texel.y + 0.7 * (1.0 - exp(texel.x / -0.15));
    return vec4(smoothstep(0.0, 0.3, wetness), smoothstep(0.3, 1.0, wetness), texel.zw);
}

// Interpolates between four nodes; `place` is in nodes from the south-western node.
WelkinGround welkin_ground_at(sampler2D ground, vec2 place) {
    vec2 last = vec2(textureSize(ground, 0)) - 1.0;
    vec2 low = clamp(floor(place), vec2(0.0), last - 1.0);
    vec2 part = clamp(place - low, vec2(0.0), vec2(1.0));
    ivec2 first = ivec2(low);
    vec4 a = welkin_ground_node(texelFetch(ground, first, 0));
    vec4 b = welkin_ground_node(texelFetch(ground, first + ivec2(1, 0), 0));
    vec4 c = welkin_ground_node(texelFetch(ground, first + ivec2(0, 1), 0));
    vec4 d = welkin_ground_node(texelFetch(ground, first + ivec2(1, 1), 0));
    vec4 water = mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
    // Grains of asphalt stand out of water up to 2 mm deep, so a puddle has a soft edge.
    return WelkinGround(water.x, water.y, smoothstep(0.2, 2.0, water.z), water.w, water.z);
}

// Water at a position of the texture.
WelkinGround welkin_ground(sampler2D ground, vec2 uv) {
    return welkin_ground_at(ground, uv * vec2(textureSize(ground, 0)) - 0.5);
}

// Albedo of a wet surface. Light that has entered the water is reflected at its surface from below and falls on the
// ground again (Angstrom 1925; Lekner and Dorf 1988, eq. 1 to 3). For soaked ground of dry albedo a:
//   wet albedo = a (1 - 0.0664) (1 - 0.4746) / (1 - 0.4746 a)
// A water surface reflects 0.0664 of diffuse light from above and 0.4746 of diffuse light from below (Fresnel's law,
// integrated over the half space).
vec3 welkin_wet_albedo(vec3 albedo, WelkinGround water) {
    vec3 below = (1.0 - 0.0664) * (1.0 - 0.4746) / (1.0 - 0.4746 * clamp(albedo, vec3(0.0), vec3(1.0)));
    return albedo * mix(vec3(1.0), below, water.soaked);
}

// Share of the surface under water, and its roughness: alpha of Beckmann or GGX, which is sqrt(2) times the RMS slope
// along one axis (Walter et al. 2007). The slope is 0.3 for a thin film, 0.15 for a closed one, 0 for calm standing
// water.
vec2 welkin_film(WelkinGround water) {
    float slope = mix(mix(0.3, 0.15, water.film), 0.0, water.pool);
    return vec2(mix(water.film, 1.0, water.pool), 1.4142136 * slope);
}

struct WelkinSnow {
    // Share of level ground under snow. Cover surfaces that face up with this share.
    float cover;
    // Depth, m.
    float depth;
    // Wetness: 0 dry, 1 as wet as snow can be.
    float wetness;
    // Albedo for visible light.
    float albedo;
};

// Values of one node: depth in m and, if there is snow, 1, wetness and albedo.
vec4 welkin_snow_node(vec4 texel) {
    return vec4(texel.x, vec3(1.0, texel.zw) * step(1e-7, texel.x));
}

// Snow on the same grid, from wk_ground_texture.snow_texture.
//   cover = tanh(depth / 0.025 m)
//   albedo = albedo of dry snow (1 - 0.15 wetness)
WelkinSnow welkin_snow(sampler2D ground, vec2 uv) {
    vec2 place = uv * vec2(textureSize(ground, 0)) - 0.5;
    vec2 last = vec2(textureSize(ground, 0)) - 1.0;
    vec2 low = clamp(floor(place), vec2(0.0), last - 1.0);
    vec2 part = clamp(place - low, vec2(0.0), vec2(1.0));
    ivec2 first = ivec2(low);
    vec4 a = welkin_snow_node(texelFetch(ground, first, 0));
    vec4 b = welkin_snow_node(texelFetch(ground, first + ivec2(1, 0), 0));
    vec4 c = welkin_snow_node(texelFetch(ground, first + ivec2(0, 1), 0));
    vec4 d = welkin_snow_node(texelFetch(ground, first + ivec2(1, 1), 0));
    vec4 lies = mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
    vec2 mean = lies.zw / max(lies.y, 0.001);
    return WelkinSnow(tanh(min(lies.x / 0.025, 10.0)), lies.x, mean.x, mean.y * (1.0 - 0.15 * mean.x));
}
