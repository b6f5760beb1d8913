// Rain on four nested cones about the camera; the model is explained in src/rain/cones.rs.
// The entry points read the depth: cones_single.wgsl and cones_multi.wgsl.
//!include "common/fullscreen.wgsl"
//!include "rain/drops.wgsl"

const CONES: u32 = 4u;
// Streaks of the texture's channels, and of all.
const STREAKS: vec4f = vec4f(48.0, 192.0, 768.0, 3072.0);
const ALL_STREAKS: f32 = 4080.0;
// Texels along either side of the texture.
const CONE_SIDE: f32 = 256.0;

struct ConeUniform {
    // Where the drops go as seen from the camera, and two directions across.
    axis: vec3f,
    // Mean fall speed, m/s.
    fall: f32,
    east: vec3f,
    pad0: f32,
    north: vec3f,
    pad1: f32,
    // Per cone: near end, far end and middle of its band, m; optical depth of its drops.
    bands: array<vec4f, CONES>,
    // Per cone: tiles round the axis at right angles to it; Mercator's latitude of a tile; drops per steradian; least
    // latitude of a tile at right angles to the axis, so that no streak is shorter than a pixel.
    shapes: array<vec4f, CONES>,
    // Per cone two sets: how far they have come, in latitude; share of the drops; offset.
    sets: array<vec4f, 8>,
}

@group(1) @binding(0) var<uniform> cones: ConeUniform;
@group(1) @binding(1) var streaks: texture_2d<f32>;
@group(1) @binding(2) var streaks_sampler: sampler;

// A direction on the cones.
struct OnCone {
    // Turns of azimuth about the axis; Mercator's latitude; sine of the angle from the axis.
    turn: f32,
    latitude: f32,
    sine: f32,
}

fn on_cone(d: vec3f) -> OnCone {
    let c = dot(d, cones.axis);
    let across = vec2f(dot(d, cones.east), dot(d, cones.north));
    let sine = max(length(across), 1e-4);
    let latitude = log(sine / (1.0 + abs(c)));
    // The azimuth at the axis itself is any.
    let azimuth = atan2(across.y, select(across.x, 1e-4, sine <= 1e-4));
    return OnCone(azimuth * 0.15915494, select(-latitude, latitude, c >= 0.0), sine);
}

// Optical depth over its mean of the set whose pattern has come so far, where `number` drops a steradian are to show.
fn pattern(at: OnCone, shape: vec4f, moved: vec4f, number: f32) -> f32 {
    // Each halving of the sine halves the tiles; where exactly differs from column to column, so that no ring shows.
    let halvings = -log2(at.sine);
    let whole = floor(halvings);
    let column = u32(i32(floor(at.turn * max(round(shape.x * exp2(-whole)), 1.0) * (CONE_SIDE / 4.0))));
    let chance = f32(random3(vec3u(column, u32(whole), 0x51u)).x >> 8u) / 16777216.0;
    let octave = whole + select(0.0, 1.0, halvings - whole > 0.25 + 0.75 * chance);
    let tiles = max(round(shape.x * exp2(-octave)), 1.0);
    let tall = max(shape.y, shape.w * exp2(octave));
    let uv = vec2f(at.turn * tiles + moved.z + 0.37 * octave, (at.latitude + moved.x) / tall + moved.w + 0.61 * octave);
    // A pixel in texels.
    let pixel = rain.pixel_angle * CONE_SIDE / at.sine;
    let size = pixel * max(tiles * 0.15915494, 1.0 / tall);
    let seen = textureSampleLevel(streaks, streaks_sampler, uv, max(log2(size), 0.0));
    // As many streaks as there are drops.
    let tile = at.sine * at.sine * 6.2831853 / tiles * tall;
    let wanted = number * tile;
    let before = vec4f(0.0, STREAKS.x, STREAKS.x + STREAKS.y, ALL_STREAKS - STREAKS.w);
    let shown = clamp((vec4f(wanted) - before) / STREAKS, vec4f(1.0, 0.0, 0.0, 0.0), vec4f(1.0));
    let mean = dot(shown, STREAKS) / ALL_STREAKS;
    return max(mix(1.0, dot(shown, seen) / mean, sqrt(min(ALL_STREAKS / max(wanted, 1.0), 1.0))), 0.0);
}

// All cones before what is at `range` along the ray `d`: premultiplied light, and what they hide.
fn rain_on_cones(d: vec3f, range: f32) -> vec4f {
    let at = on_cone(d);
    let velocity = rain.wind - vec3f(0.0, 0.0, cones.fall);
    var seen = vec4f(0.0);
    for (var j = 0u; j < CONES; j++) {
        let band = cones.bands[j];
        let before = clamp((range - band.x) / (band.y - band.x), 0.0, 1.0);
        let p = d * band.z;
        if before <= 0.0 || (shelters.count > 0u && sheltered(p, velocity)) {
            continue;
        }
        let shape = cones.shapes[j];
        let a = cones.sets[2u * j];
        let b = cones.sets[2u * j + 1u];
        let depth = a.y * pattern(at, shape, a, shape.z * a.y) + b.y * pattern(at, shape, b, shape.z * b.y);
        let cover = (1.0 - exp(-band.w * before * depth)) * exp(-rain.extinction * band.z);
        seen += vec4f(drop_light(p, d), 1.0) * (cover * (1.0 - seen.a));
    }
    return seen;
}
