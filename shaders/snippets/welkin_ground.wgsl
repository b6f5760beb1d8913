// For a host's own materials: appearance of water on the host's ground, from the texture that Welkin hands over, by the
// laws with which Welkin draws it.
//   let water = welkin_ground(ground_texture, uv);
//   albedo = welkin_wet_albedo(albedo, water);
//   let film = welkin_film(water); // blend a mirror (index 1.333, f0 0.02, roughness film.y) over the share film.x
// `uv` is the position in the host's world times the rows of uv_from_world. No sampler is needed.

struct WelkinGround {
    // Darkness of the surface: 0 dry, 1 soaked.
    soaked: f32,
    // Share of the surface under a film, and under standing water.
    film: f32,
    pool: f32,
    // Share under ice.
    ice: f32,
    // Depth of standing water, mm; negative where none stands.
    standing: f32,
}

// Values of one node: how soaked it is (0 to 1), share under a film, level of standing water above the ground in mm,
// share under ice. The first two follow from the node's wetness. In the formula, `soaked` is the texel's share of
// soaked pores, and film_mm its film:
//   wetness = 0.3 soaked + 0.7 (1 - exp(-film_mm / 0.15)), or 1 under standing water
// A film of 0.15 mm covers 1 - 1/e of the grains of asphalt.
fn welkin_ground_node(texel: vec4f) -> vec4f {
    let wetness = select(0.3 * texel.y + 0.7 * (1.0 - exp(texel.x / -0.15)), 1.0, texel.z > 0.0);
    return vec4f(smoothstep(0.0, 0.3, wetness), smoothstep(0.3, 1.0, wetness), texel.zw);
}

// Interpolates between four nodes; `place` is in nodes from the south-western node.
fn welkin_ground_at(ground: texture_2d<f32>, place: vec2f) -> WelkinGround {
    let last = vec2f(textureDimensions(ground)) - 1.0;
    let low = clamp(floor(place), vec2f(0.0), last - 1.0);
    let part = clamp(place - low, vec2f(0.0), vec2f(1.0));
    let first = vec2i(low);
    let a = welkin_ground_node(textureLoad(ground, first, 0));
    let b = welkin_ground_node(textureLoad(ground, first + vec2i(1, 0), 0));
    let c = welkin_ground_node(textureLoad(ground, first + vec2i(0, 1), 0));
    let d = welkin_ground_node(textureLoad(ground, first + vec2i(1, 1), 0));
    let water = mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
    // Grains of asphalt stand out of water up to 2 mm deep, so a puddle has a soft edge.
    return WelkinGround(water.x, water.y, smoothstep(0.2, 2.0, water.z), water.w, water.z);
}

// Water at a position of the texture.
fn welkin_ground(ground: texture_2d<f32>, uv: vec2f) -> WelkinGround {
    return welkin_ground_at(ground, uv * vec2f(textureDimensions(ground)) - 0.5);
}

// Albedo of a wet surface. Light that has entered the water is reflected at its surface from below and falls on the
// ground again (Angstrom 1925; Lekner and Dorf 1988, eq. 1 to 3). For soaked ground of dry albedo a:
//   wet albedo = a (1 - 0.0664) (1 - 0.4746) / (1 - 0.4746 a)
// A water surface reflects 0.0664 of diffuse light from above and 0.4746 of diffuse light from below (Fresnel's law,
// integrated over the half space).
fn welkin_wet_albedo(albedo: vec3f, water: WelkinGround) -> vec3f {
    let below = (1.0 - 0.0664) * (1.0 - 0.4746) / (1.0 - 0.4746 * clamp(albedo, vec3f(0.0), vec3f(1.0)));
    return albedo * mix(vec3f(1.0), below, water.soaked);
}

// Share of the surface under water, and its roughness: alpha of Beckmann or GGX, which is sqrt(2) times the RMS slope
// along one axis (Walter et al. 2007). The slope is 0.3 for a thin film, 0.15 for a closed one, 0 for calm standing
// water.
fn welkin_film(water: WelkinGround) -> vec2f {
    let slope = mix(mix(0.3, 0.15, water.film), 0.0, water.pool);
    return vec2f(mix(water.film, 1.0, water.pool), 1.4142136 * slope);
}

struct WelkinSnow {
    // Share of level ground under snow. Cover surfaces that face up with this share.
    cover: f32,
    // Depth, m.
    depth: f32,
    // Wetness: 0 dry, 1 as wet as snow can be.
    wetness: f32,
    // Albedo for visible light.
    albedo: f32,
}

// Values of one node: depth in m and, if there is snow, 1, wetness and albedo.
fn welkin_snow_node(texel: vec4f) -> vec4f {
    return vec4f(texel.x, vec3f(1.0, texel.zw) * step(1e-7, texel.x));
}

// Snow on the same grid, from wk_ground_texture.snow_texture.
//   cover = tanh(depth / 0.025 m)
//   albedo = albedo of dry snow (1 - 0.15 wetness)
fn welkin_snow(ground: texture_2d<f32>, uv: vec2f) -> WelkinSnow {
    let place = uv * vec2f(textureDimensions(ground)) - 0.5;
    let last = vec2f(textureDimensions(ground)) - 1.0;
    let low = clamp(floor(place), vec2f(0.0), last - 1.0);
    let part = clamp(place - low, vec2f(0.0), vec2f(1.0));
    let first = vec2i(low);
    let a = welkin_snow_node(textureLoad(ground, first, 0));
    let b = welkin_snow_node(textureLoad(ground, first + vec2i(1, 0), 0));
    let c = welkin_snow_node(textureLoad(ground, first + vec2i(0, 1), 0));
    let d = welkin_snow_node(textureLoad(ground, first + vec2i(1, 1), 0));
    let lies = mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
    let mean = lies.zw / max(lies.y, 0.001);
    return WelkinSnow(tanh(min(lies.x / 0.025, 10.0)), lies.x, mean.x, mean.y * (1.0 - 0.15 * mean.x));
}
