// The wind that varies in space, as src/surroundings/wind.rs uploads it: a node a texel, velocity times share, and the share of the
// weather's wind that it replaces. Whoever includes this declares `wind_values: texture_3d<f32>` and `wind_sampler` (linear, clamped).

struct WindMap {
    // From camera-relative metres to the texture.
    scale: vec3f,
    offset: vec3f,
    // The first node in the texture; the last is as far from its other end.
    first: vec3f,
}

// Velocity of the air at `p`, camera-relative, where the weather's is `weathers`, m/s.
fn wind_at(map: WindMap, p: vec3f, weathers: vec3f) -> vec3f {
    let at = p * map.scale + map.offset;
    let inside = all(at >= map.first) && all(at <= 1.0 - map.first);
    let found = textureSampleLevel(wind_values, wind_sampler, at, 0.0);
    return select(weathers, found.xyz + weathers * (1.0 - found.w), inside);
}
