// For a host's own materials: how the water on its ground looks, from the texture that Welkin hands over, by the laws
// Welkin draws it with.
//   let water = welkin_ground(ground_texture, uv);
//   albedo = welkin_wet_albedo(albedo, water);
//   let film = welkin_film(water); // blend a mirror of index 1.333 (f0 = 0.02) and roughness film.y over film.x of the surface
// `uv` goes over the grid's nodes: the place in the host's world times the rows of uv_from_world. No sampler is needed.

struct WelkinGround {
    // How dark: 0 dry, 1 soaked.
    soaked: f32,
    // Share of the surface under a film, and under standing water.
    film: f32,
    pool: f32,
    // Share under ice.
    ice: f32,
    // Depth of standing water, mm; negative where none stands.
    standing: f32,
}

// Of one node: how soaked, share under a film, level of standing water over the ground in mm, share under ice. Soaked
// pores make a wetness of 0.3, the film the rest: 0.15 mm cover 1 - 1/e of asphalt's grains.
fn welkin_ground_node(texel: vec4f) -> vec4f {
    let wetness = select(0.3 * texel.y + 0.7 * (1.0 - exp(texel.x / -0.15)), 1.0, texel.z > 0.0);
    return vec4f(smoothstep(0.0, 0.3, wetness), smoothstep(0.3, 1.0, wetness), texel.zw);
}

// Between four nodes; `place` in nodes from the south-western one.
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
    // A puddle's edge is as thin as what grains of asphalt reach through.
    return WelkinGround(water.x, water.y, smoothstep(0.2, 2.0, water.z), water.w, water.z);
}

fn welkin_ground(ground: texture_2d<f32>, uv: vec2f) -> WelkinGround {
    return welkin_ground_at(ground, uv * vec2f(textureDimensions(ground)) - 0.5);
}

// Light that enters water is thrown back at its surface from below and falls on the ground again (Angstrom 1925; Lekner
// & Dorf 1988, eq. 1 to 3; Fresnel's law over the half space sends back 0.0664 from above and 0.4746 from below).
fn welkin_wet_albedo(albedo: vec3f, water: WelkinGround) -> vec3f {
    let below = (1.0 - 0.0664) * (1.0 - 0.4746) / (1.0 - 0.4746 * clamp(albedo, vec3f(0.0), vec3f(1.0)));
    return albedo * mix(vec3f(1.0), below, water.soaked);
}

// Share of the surface under water and its roughness, alpha of Beckmann or GGX: sqrt(2) times the slope's root mean
// square along one axis (Walter et al. 2007), 0.3 of a thin film, 0.15 of a closed one, 0 of calm standing water.
fn welkin_film(water: WelkinGround) -> vec2f {
    let slope = mix(mix(0.3, 0.15, water.film), 0.0, water.pool);
    return vec2f(mix(water.film, 1.0, water.pool), 1.4142136 * slope);
}

struct WelkinSnow {
    // Share of level ground under snow: cover what faces up with it.
    cover: f32,
    // Depth, m.
    depth: f32,
    // 1 as wet as it can be.
    wetness: f32,
    // Of visible light.
    albedo: f32,
}

// Of one node: depth in m, and where there is snow 1, its wetness and its albedo.
fn welkin_snow_node(texel: vec4f) -> vec4f {
    return vec4f(texel.x, vec3f(1.0, texel.zw) * step(1e-7, texel.x));
}

// The snow on the same grid: of wk_ground_texture.snow_texture. 2.5 cm cover 0.76 of level ground; wet snow is darker
// by 0.15.
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
