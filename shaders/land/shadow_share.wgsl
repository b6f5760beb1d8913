// Share of the sun's or the moon's disc that the ground leaves in view at a place, from the shadow maps. The width of
// the penumbra follows the distance of what hides the disc (percentage-closer soft shadows, Fernando 2005).
//!include "land/uniform.wgsl"
//!include "land/shadow_block.wgsl"

// Radii of the disc in a map, texels, between which the next coarser map replaces the map.
const COARSER: vec2f = vec2f(6.0, 8.0);
// Distances from a map's centre, as shares of half of its side, between which the next coarser map replaces the map.
const OUTER: vec2f = vec2f(0.85, 0.97);
// Least cosine between a triangle and the light for which depths are compared along the triangle's plane. Below it the
// ground is about to face away.
const GRAZING: f32 = 0.05;
// Distance that the ground may be off in a map that is older than the picture, texels.
const OLDER: f32 = 0.6;
// Number of comparisons across a wide penumbra.
const COMPARISONS: u32 = 16u;
// Number of places at which the depth of what hides the light is read.
const PLACES: u32 = 10u;
// Cosine and sine of the golden angle, and of 60 degrees.
const GOLDEN: vec2f = vec2f(-0.73736888, 0.67549029);
const SIXTH: vec2f = vec2f(0.5, 0.8660254);

fn turned(v: vec2f, by: vec2f) -> vec2f {
    return vec2f(v.x * by.x - v.y * by.y, v.y * by.x + v.x * by.y);
}

// Place in a shadow map.
struct ShadowPlace {
    uv: vec2f,
    depth: f32,
    // Change of the depth with the texture coordinates in the plane of the triangle.
    slope: vec2f,
    // Side of a texel in texture coordinates.
    texel: f32,
}

fn shadow_place(map: Cascade, place: vec3f, facet: vec3f, slack_m: f32) -> ShadowPlace {
    let at = vec4f(place, 1.0);
    let towards = max(dot(facet, map.depth.xyz) * map.size.x, GRAZING);
    let slope = -vec2f(dot(facet, map.u.xyz), dot(facet, map.v.xyz)) * (map.size.y / towards);
    let bias = OLDER * (map.texel.y + map.texel.x * (abs(slope.x) + abs(slope.y))) + slack_m * map.texel.w;
    return ShadowPlace(vec2f(dot(map.u, at), dot(map.v, at)), dot(map.depth, at) + bias, slope, map.texel.x);
}

// Share of the four texels around a place, shifted by `off` texels, that lets the light pass, interpolated. The
// triangle's plane may be higher than a texel's depth by the plane's slope over one texel.
fn compared(layer: u32, at: ShadowPlace, off: vec2f) -> f32 {
    let step = off * at.texel;
    let depth = at.depth + dot(at.slope, step) + at.texel * (abs(at.slope.x) + abs(at.slope.y));
    return textureSampleCompareLevel(shadow_compared, shadow_sampler, at.uv + step, layer, depth);
}

// Depth of the ground that hides the light from the triangle's plane in the middle of a texel, and 1; (0, 0) if nothing
// hides it.
fn hidden_by(layer: u32, at: ShadowPlace, texel: vec2i) -> vec2f {
    let side = vec2i(textureDimensions(shadow_depths));
    let depth = textureLoad(shadow_depths, clamp(texel, vec2i(0), side - 1), layer, 0).r;
    let step = (vec2f(texel) + 0.5) * at.texel - at.uv;
    return select(vec2f(0.0), vec2f(depth, 1.0), depth > at.depth + dot(at.slope, step));
}

// As hidden_by, at a place shifted by `off` texels.
fn hidden_near(layer: u32, at: ShadowPlace, off: vec2f) -> vec2f {
    return hidden_by(layer, at, vec2i(floor((at.uv + off * at.texel) * vec2f(textureDimensions(shadow_depths)))));
}

// Depth nearest to the light within half a block or more around a place.
fn shadow_top(layer: u32, uv: vec2f) -> f32 {
    let blocks = vec2i(textureDimensions(shadow_tops));
    let low = vec2i(floor(uv * vec2f(blocks) - 0.5));
    var top = 0.0;
    for (var i = 0; i < 4; i++) {
        let block = clamp(low + vec2i(i & 1, i >> 1u), vec2i(0), blocks - 1);
        top = max(top, textureLoad(shadow_tops, block, layer, 0).r);
    }
    return top;
}

// Share of nine texels around a place that hides the light, weighted by a quadratic spline. `turns` is 9, or 0 for
// none.
fn narrow_shadow(layer: u32, at: ShadowPlace, turns: i32) -> f32 {
    let texels = at.uv * vec2f(textureDimensions(shadow_depths));
    let middle = floor(texels);
    let off = texels - middle - 0.5;
    var hidden = 0.0;
    for (var i = 0; i < turns; i++) {
        let beside = vec2i(i % 3, i / 3) - 1;
        let side = 0.5 + vec2f(beside) * off;
        let weight = select(0.5 * side * side, 0.75 - off * off, beside == vec2i(0));
        hidden += weight.x * weight.y * hidden_by(layer, at, vec2i(middle) + beside).y;
    }
    return hidden;
}

// Share of a disc of this radius, texels, that lets the light pass. `turns` is COMPARISONS, or 0 for none.
fn wide_share(layer: u32, at: ShadowPlace, radius: f32, turns: u32) -> f32 {
    var towards = vec2f(1.0, 0.0);
    var sum = 0.0;
    for (var i = 0u; i < turns; i++) {
        sum += compared(layer, at, radius * sqrt((f32(i) + 0.5) / f32(COMPARISONS)) * towards);
        towards = turned(towards, GOLDEN);
    }
    return sum / f32(COMPARISONS);
}

// Sum of the depths of what hides the light within a radius, texels, and their number. The depths are read at one place
// in the middle, six on the rim and three halfway. `turns` is PLACES, or 0 for none.
fn hidden_around(layer: u32, at: ShadowPlace, radius: f32, turns: u32) -> vec2f {
    var found = vec2f(0.0);
    var towards = vec2f(radius, 0.0);
    for (var i = 0u; i < turns; i++) {
        let halfway = select(0.5, -0.5, i == 8u);
        let share = select(halfway, min(f32(i), 1.0), i < 7u);
        found += hidden_near(layer, at, share * towards);
        towards = turned(towards, SIXTH);
    }
    return found;
}

// Share of the disc in view, and the radius of the disc in the map as seen past what hides it, texels. Drivers that run
// both sides of a branch skip a loop of no turns, so each part that a place does not need gets 0 turns.
fn map_share(layer: u32, map: Cascade, at: ShadowPlace) -> vec2f {
    let most = map.texel.z * (shadow_top(layer, at.uv) - at.depth);
    let is_near = most > 0.5;
    let found = hidden_around(layer, at, 1.25 * min(most, COARSER.y) + 1.0, select(0u, PLACES, is_near));
    let radius = map.texel.z * max(found.x / max(found.y, 1.0) - at.depth, 0.0);
    let is_edge = !is_near || (found.y > 0.0 && found.y < f32(PLACES));
    let is_wide = is_edge && is_near && radius > 1.2;
    let narrow = 1.0 - narrow_shadow(layer, at, select(0, 9, is_edge && !is_wide));
    let wide = wide_share(layer, at, min(radius, COARSER.y), select(0u, COMPARISONS, is_wide));
    let share = select(narrow, wide, is_wide);
    return vec2f(select(share, 0.0, found.y == f32(PLACES)), select(0.0, radius, is_near));
}

// Weight of a map at a place: 1 around its centre, 0 at its rim.
fn map_weight(map: Cascade, at: ShadowPlace) -> f32 {
    let across = 2.0 * abs(at.uv - 0.5);
    let along = abs(at.depth * map.size.x + map.size.w) * map.size.z;
    return 1.0 - smoothstep(OUTER.x, OUTER.y, max(max(across.x, across.y), along));
}

// Share of the disc in view from `place`, m from the eye. `facet` is the normal of the triangle there. What is nearer
// to the place than `slack_m` hides nothing.
fn shadow_share(place: vec3f, facet: vec3f, slack_m: f32) -> f32 {
    let count = min(u32(land.shadow.shaded.z), CASCADES);
    var first = 0u;
    for (; first < count; first++) {
        let map = land.shadow.cascades[first];
        if map_weight(map, shadow_place(map, place, facet, slack_m)) > 0.0 {
            break;
        }
    }
    var share = 0.0;
    var rest = 1.0;
    for (var i = first; i < count && rest > 0.0; i++) {
        let map = land.shadow.cascades[i];
        let at = shadow_place(map, place, facet, slack_m);
        let found = map_share(i, map, at);
        let too_wide = select(smoothstep(COARSER.x, COARSER.y, found.y), 0.0, i == count - 1u);
        let weight = map_weight(map, at) * (1.0 - too_wide);
        share += rest * weight * found.x;
        rest *= 1.0 - weight;
    }
    return share + rest;
}
