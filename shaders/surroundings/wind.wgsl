// Wind that varies in space: a texture with one texel per node (src/surroundings/wind.rs). w: share of the weather's
// wind that the node's own wind replaces, 0 to 1. xyz: the node's own velocity (east, north, up), m/s, which already
// contains its weight in the blend. With w = 1 it is the whole wind; with w = 0 it is added to the weather's wind.
// Sample the texture at `wind_place` with its sampler (linear, clamped), and pass the result to `wind_at`, which
// returns xyz + (1 - w) weathers.

// Mapping from camera-relative positions to the texture.
struct WindMap {
    // Scale and offset from camera-relative metres to texture coordinates.
    scale: vec3f,
    offset: vec3f,
    // Texture coordinates of the first node; the last node is as far from the opposite end of the texture.
    first: vec3f,
}

// Returns the texture coordinates of a camera-relative place.
fn wind_place(map: WindMap, p: vec3f) -> vec3f {
    return p * map.scale + map.offset;
}

// Returns the velocity of the air at a place in the texture, m/s. `weathers` is the weather's wind there, `found` the
// sample of the texture.
fn wind_at(map: WindMap, place: vec3f, found: vec4f, weathers: vec3f) -> vec3f {
    let inside = all(place >= map.first) && all(place <= 1.0 - map.first);
    return select(weathers, found.xyz + weathers * (1.0 - found.w), inside);
}
