// Rain on four nested cones about the camera; the model is explained in src/rain/cones.rs.
// The entry points read the depth: cones_view.wgsl.
//!include "common/fullscreen.wgsl"
//!include "rain/drops.wgsl"
//!include "rain/cone_block.wgsl"

// Streaks of the texture's channels, and of all.
const STREAKS: vec4f = vec4f(48.0, 192.0, 768.0, 3072.0);
const ALL_STREAKS: f32 = 4080.0;
// Texels along either side of the texture.
const CONE_SIDE: f32 = 256.0;

@group(1) @binding(1) var streaks: texture_2d<f32>;
@group(1) @binding(2) var streaks_sampler: sampler;
// Of each cone's band, a layer each, the open shares of its parts (rain/open.wgsl).
@group(1) @binding(3) var open_parts: texture_2d_array<f32>;
@group(1) @binding(4) var open_sampler: sampler;

// Whether anything near keeps rain off.
override SHELTERED: bool = false;

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

// Where the texture is looked at for a cone, without what moves its sets.
struct Look {
    uv: vec2f,
    // Latitude of a tile.
    tall: f32,
    // Level of detail.
    level: f32,
    // Drops in a tile.
    number: f32,
}

fn look_at(at: OnCone, shape: vec4f) -> Look {
    // Each halving of the sine halves the tiles; where exactly differs from column to column, so that no ring shows.
    let halvings = -log2(at.sine);
    let whole = floor(halvings);
    let column = u32(i32(floor(at.turn * max(round(shape.x * exp2(-whole)), 1.0) * (CONE_SIDE / 4.0))));
    let chance = f32(random3(vec3u(column, u32(whole), 0x51u)).x >> 8u) / 16777216.0;
    let octave = whole + select(0.0, 1.0, halvings - whole > 0.25 + 0.75 * chance);
    let tiles = max(round(shape.x * exp2(-octave)), 1.0);
    let tall = max(shape.y, shape.w * exp2(octave));
    // A pixel in texels.
    let pixel = rain.pixel_angle * CONE_SIDE / at.sine;
    let level = max(log2(pixel * tiles * 0.15915494) - 1.0, 0.0);
    let uv = vec2f(at.turn * tiles + 0.37 * octave, at.latitude / tall + 0.61 * octave);
    return Look(uv, tall, level, shape.z * at.sine * at.sine * 6.2831853 / tiles * tall);
}

// Optical depth over its mean of a set of so many drops a tile: how far it has come, its share, its offset.
fn pattern(look: Look, moved: vec4f) -> f32 {
    let uv = look.uv + vec2f(moved.z, moved.x / look.tall + moved.w);
    let seen = textureSampleLevel(streaks, streaks_sampler, uv, look.level);
    // As many streaks as there are drops.
    let wanted = look.number * moved.y;
    let before = vec4f(0.0, STREAKS.x, STREAKS.x + STREAKS.y, ALL_STREAKS - STREAKS.w);
    let shown = clamp((vec4f(wanted) - before) / STREAKS, vec4f(1.0, 0.0, 0.0, 0.0), vec4f(1.0));
    let mean = dot(shown, STREAKS) / ALL_STREAKS;
    return max(mix(1.0, dot(shown, seen) / mean, sqrt(min(ALL_STREAKS / max(wanted, 1.0), 1.0))), 0.0);
}

// Share of a band that the rain comes to and that lies before what is at `range`, for a pixel at `uv`.
fn open_share(uv: vec2f, j: u32, range: f32) -> f32 {
    let band = cones.bands[j];
    let before = clamp((range - band.x) / (band.y - band.x), 0.0, 1.0);
    if !SHELTERED {
        return before;
    }
    let open = textureSampleLevel(open_parts, open_sampler, uv, j, 0.0);
    let seen = clamp(4.0 * before - vec4f(0.0, 1.0, 2.0, 3.0), vec4f(0.0), vec4f(1.0));
    // Of a quarter that ends behind what is at `range`, what was found there counts only as far as it lies before that.
    let sure = min(open, open.xxyz);
    return dot(sure * seen + (open - sure) * max(2.0 * seen - 1.0, vec4f(0.0)), vec4f(0.25));
}

// All cones before what is at `range` along the ray `d` of the pixel at `uv`: premultiplied light, and what they hide.
fn rain_on_cones(d: vec3f, uv: vec2f, range: f32) -> vec4f {
    let at = on_cone(d);
    var seen = vec4f(0.0);
    let day = day_light(d);
    for (var j = cones.first; j < CONES; j++) {
        let band = cones.bands[j];
        let p = d * band.z;
        var fall = 1.0;
        if AREAS {
            fall = local_cones(p);
        }
        let before = fall * open_share(uv, j, range);
        if before * band.w <= 0.0 {
            continue;
        }
        var look = look_at(at, cones.shapes[j]);
        look.number *= fall;
        let a = cones.sets[2u * j];
        let b = cones.sets[2u * j + 1u];
        let depth = a.y * pattern(look, a) + b.y * pattern(look, b);
        let cover = (1.0 - exp(-band.w * before * depth)) * exp(-rain.extinction * band.z);
        // Only lamps light one band otherwise than another.
        let light = day + lamp_light(p, d);
        seen += vec4f(light, 1.0) * (cover * (1.0 - seen.a));
    }
    return seen;
}
