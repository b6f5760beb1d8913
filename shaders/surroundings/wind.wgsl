// The wind that varies in space, as src/surroundings/wind.rs uploads it: a node a texel, velocity times share, and the
// share of the weather's wind that it replaces. Look the texture up at `wind_place` with its sampler (linear, clamped),
// and give `wind_at` what is there.

struct WindMap {
    // From camera-relative metres to the texture.
    scale: vec3f,
    offset: vec3f,
    // The first node in the texture; the last is as far from its other end.
    first: vec3f,
}

// Where a camera-relative place lies in the texture.
fn wind_place(map: WindMap, p: vec3f) -> vec3f {
    return p * map.scale + map.offset;
}

// Velocity of the air at a place in the texture, m/s, where the weather's is `weathers` and the texture has `found`.
fn wind_at(map: WindMap, place: vec3f, found: vec4f, weathers: vec3f) -> vec3f {
    let inside = all(place >= map.first) && all(place <= 1.0 - map.first);
    return select(weathers, found.xyz + weathers * (1.0 - found.w), inside);
}
