// For a host's own materials (GLSL 3.30, GLSL ES 3.00): how the water on its ground looks, from the texture that Welkin
// hands over, by the laws Welkin draws it with.
//   WelkinGround water = welkin_ground(ground_texture, uv);
//   albedo = welkin_wet_albedo(albedo, water);
//   vec2 film = welkin_film(water); // blend a mirror of index 1.333 (f0 = 0.02) and roughness film.y over film.x of the surface
// `uv` goes over the grid's nodes: the place in the host's world times the rows of uv_from_world. How the sampler
// filters does not matter.

struct WelkinGround {
    // How dark: 0 dry, 1 soaked.
    float soaked;
    // Share of the surface under a film, and under standing water.
    float film;
    float pool;
    // Share under ice.
    float ice;
    // Depth of standing water, mm; negative where none stands.
    float standing;
};

// Of one node: how soaked, share under a film, level of standing water over the ground in mm, share under ice. Soaked
// pores make a wetness of 0.3, the film the rest: 0.15 mm cover 1 - 1/e of asphalt's grains.
vec4 welkin_ground_node(vec4 texel) {
    float wetness = texel.z > 0.0 ? 1.0 : 0.3 * texel.y + 0.7 * (1.0 - exp(texel.x / -0.15));
    return vec4(smoothstep(0.0, 0.3, wetness), smoothstep(0.3, 1.0, wetness), texel.zw);
}

// Between four nodes; `place` in nodes from the south-western one.
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
    // A puddle's edge is as thin as what grains of asphalt reach through.
    return WelkinGround(water.x, water.y, smoothstep(0.2, 2.0, water.z), water.w, water.z);
}

WelkinGround welkin_ground(sampler2D ground, vec2 uv) {
    return welkin_ground_at(ground, uv * vec2(textureSize(ground, 0)) - 0.5);
}

// Light that enters water is thrown back at its surface from below and falls on the ground again (Angstrom 1925; Lekner
// & Dorf 1988, eq. 1 to 3; Fresnel's law over the half space sends back 0.0664 from above and 0.4746 from below).
vec3 welkin_wet_albedo(vec3 albedo, WelkinGround water) {
    vec3 below = (1.0 - 0.0664) * (1.0 - 0.4746) / (1.0 - 0.4746 * clamp(albedo, vec3(0.0), vec3(1.0)));
    return albedo * mix(vec3(1.0), below, water.soaked);
}

// Share of the surface under water and its roughness, alpha of Beckmann or GGX: sqrt(2) times the slope's root mean
// square along one axis (Walter et al. 2007), 0.3 of a thin film, 0.15 of a closed one, 0 of calm standing water.
vec2 welkin_film(WelkinGround water) {
    float slope = mix(mix(0.3, 0.15, water.film), 0.0, water.pool);
    return vec2(mix(water.film, 1.0, water.pool), 1.4142136 * slope);
}

struct WelkinSnow {
    // Share of level ground under snow: cover what faces up with it.
    float cover;
    // Depth, m.
    float depth;
    // 1 as wet as it can be.
    float wetness;
    // Of visible light.
    float albedo;
};

// Of one node: depth in m, and where there is snow 1, its wetness and its albedo.
vec4 welkin_snow_node(vec4 texel) {
    return vec4(texel.x, vec3(1.0, texel.zw) * step(1e-7, texel.x));
}

// The snow on the same grid: of wk_ground_texture.snow_texture. 2.5 cm cover 0.76 of level ground; wet snow is darker
// by 0.15.
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
