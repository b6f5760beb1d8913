// Rain on three nested cones around the camera; src/rain/cones.rs explains the model. The entry points read the depth
// and are in cones_view.wgsl.
//!include "common/fullscreen.wgsl"
//!include "rain/drops.wgsl"
//!include "rain/cone_block.wgsl"

// Number of streaks in each of the texture's channels.
const STREAKS: vec4f = vec4f(48.0, 192.0, 768.0, 3072.0);
// Number of streaks in all channels.
const ALL_STREAKS: f32 = 4080.0;
// Width and height of the texture, texels.
const CONE_SIDE: f32 = 256.0;

@group(1) @binding(1) var streaks: texture_2d<f32>;
@group(1) @binding(2) var streaks_sampler: sampler;
// One layer for each stretch: the open share of each of its quarters (rain/open.wgsl).
@group(1) @binding(3) var open_parts: texture_2d_array<f32>;
@group(1) @binding(4) var open_sampler: sampler;

// Whether a box or an occluder map near the camera keeps rain off.
override SHELTERED: bool = false;
// Whether the innermost cone is drawn.
override INNERMOST: bool = true;
// Whether one set of streaks is replacing another.
override GROWING: bool = true;

// View direction in the cones' coordinates.
struct OnCone {
    // Azimuth about the axis in turns; Mercator's latitude.
    turn: f32,
    latitude: f32,
    // Square of the sine of the angle from the axis; minus the binary logarithm of that sine.
    square: f32,
    halvings: f32,
    // Number of times that the tiles about the axis are halved here, and the share of them that is left.
    octave: f32,
    left: f32,
}

// Number of sectors about the axis. The tiles are halved at a different angle from the axis in each sector.
const COLUMNS: f32 = 512.0;

// Returns the coordinates of the view direction `d`.
fn on_cone(d: vec3f) -> OnCone {
    let c = dot(d, cones.axis);
    let across = vec2f(dot(d, cones.east), dot(d, cones.north));
    let square = max(dot(across, across), 1e-8);
    let halvings = -0.5 * log2(square);
    let latitude = -0.6931472 * (halvings + log2(1.0 + abs(c)));
    // Avoids atan2(0, 0) at the axis itself, where the azimuth does not matter.
    let turn = 0.15915494 * atan2(across.y, select(across.x, 1e-4, square <= 1e-8));
    // Each halving of the sine halves the tiles. The exact angle differs from sector to sector, so that no ring shows.
    let whole = floor(halvings);
    let left = exp2(-whole);
    // Uses multiples of the golden ratio, which are spread evenly and differ much between neighbouring sectors.
    let chance = fract(floor(turn * COLUMNS * left) * 0.61803399 + whole * 0.37);
    let halved = halvings - whole > 0.25 + 0.75 * chance;
    let octave = whole + select(0.0, 1.0, halved);
    return OnCone(turn, select(-latitude, latitude, c >= 0.0), square, halvings, octave, left * select(1.0, 0.5, halved));
}

// Look-up in the texture for a cone, before its sets are moved.
struct Look {
    // Texture coordinates.
    uv: vec2f,
    // Tiles in a radian of latitude.
    along: f32,
    // Level of detail.
    level: f32,
    // Number of drops in a tile.
    number: f32,
}

// Returns the look-up for a cone with these rows of `shapes` and `looks`.
fn look_at(at: OnCone, shape: vec4f, detail: vec4f) -> Look {
    let tiles = max(round(shape.x * at.left), 1.0);
    // With one tile left, texels become smaller than pixels. Coarser levels keep them from aliasing.
    let beyond = max(at.octave - detail.z, 0.0);
    let level = detail.y + at.halvings - at.octave + beyond + min(beyond, 1.0);
    let along = min(shape.y, shape.w * at.left);
    let uv = vec2f(at.turn * tiles + 0.37 * at.octave, at.latitude * along + 0.61 * at.octave);
    return Look(uv, along, max(level, 0.0), shape.z * at.square * 6.2831853 / (along * tiles));
}

// Returns the ratio of a set's optical depth here to its mean. `moved` is the set's row of `sets` in `ConeUniform`.
fn pattern(look: Look, moved: vec4f) -> f32 {
    let uv = look.uv + vec2f(moved.z, moved.x * look.along + moved.w);
    let seen = textureSampleLevel(streaks, streaks_sampler, uv, look.level);
    // Multiplies by inverses of constants: software drivers do not turn a division by a constant into a product. As
    // many streaks are shown as there are drops, but never so few that single streaks stand out near the ends of the
    // axis.
    let wanted = look.number * moved.y;
    let before = vec4f(0.0, STREAKS.x, STREAKS.x + STREAKS.y, ALL_STREAKS - STREAKS.w);
    let shown = clamp((wanted - before) * (1.0 / STREAKS), vec4f(1.0, 0.25, 0.0, 0.0), vec4f(1.0));
    let over_mean = dot(shown, seen) * (ALL_STREAKS / dot(shown, STREAKS));
    return max(mix(1.0, over_mean, inverseSqrt(max(wanted * (1.0 / ALL_STREAKS), 1.0))), 0.0);
}

// Returns the share of a stretch of the ray that rain reaches and that lies nearer than `range`, for the pixel at `uv`.
fn open_share(uv: vec2f, j: u32, range: f32) -> f32 {
    let stretch = cones.stretches[j];
    let before = clamp((range - stretch.x) / (stretch.y - stretch.x), 0.0, 1.0);
    let open = textureSampleLevel(open_parts, open_sampler, uv, j, 0.0);
    let seen = clamp(4.0 * before - vec4f(0.0, 1.0, 2.0, 3.0), vec4f(0.0), vec4f(1.0));
    // An open quarter behind a sheltered one is known to be open only from its middle, where it was tested. Where the
    // surface at `range` cuts the quarter, the quarter counts from that middle on.
    let sure = min(open, open.xxyz);
    return dot(sure * seen + (open - sure) * max(2.0 * seen - 1.0, vec4f(0.0)), vec4f(0.25));
}

// Returns the share of a band that rain reaches and that lies nearer than `range`. The outermost band consists of two
// stretches of equal length.
fn open_band(uv: vec2f, j: u32, range: f32) -> f32 {
    if !SHELTERED {
        let band = cones.bands[j];
        return clamp((range - band.x) / (band.y - band.x), 0.0, 1.0);
    }
    if j < CONES - 1u {
        return open_share(uv, j, range);
    }
    return 0.5 * (open_share(uv, j, range) + open_share(uv, j + 1u, range));
}

// Returns the optical depth of a set of cone `j` in front of the surface at `range`, along the ray `d` of the pixel at
// `uv`.
fn rain_on_cone(at: OnCone, d: vec3f, uv: vec2f, j: u32, moved: vec4f, range: f32) -> f32 {
    var fall = 1.0;
    if AREAS {
        fall = local_cones(d * cones.bands[j].z);
    }
    var look = look_at(at, cones.shapes[j], cones.looks[j]);
    look.number *= fall;
    return fall * open_band(uv, j, range) * cones.bands[j].w * moved.y * pattern(look, moved);
}

// Adds cone `j`, of optical depth `hidden`, behind the nearer cones in `seen`. Returns premultiplied light, and
// opacity.
fn before_others(d: vec3f, day: vec3f, j: u32, hidden: f32, seen: vec4f) -> vec4f {
    let cover = (1.0 - exp(-hidden)) * cones.looks[j].x;
    // A lamp at the eye lights the band as it would light its geometric middle: this is the mean over the band.
    let middle = sqrt(cones.bands[j].x * cones.bands[j].y);
    return seen + vec4f(day + lamp_light(d * middle, d), 1.0) * (cover * (1.0 - seen.a));
}

// Returns all cones in front of the surface at `range`: premultiplied light, and opacity. Unrolled by hand, because
// software drivers take twice as long for a loop.
fn rain_on_cones(d: vec3f, uv: vec2f, range: f32) -> vec4f {
    let at = on_cone(d);
    let day = day_light(d);
    let second = rain_on_cone(at, d, uv, 1u, cones.sets[1], range);
    var hidden = vec3f(0.0, second, rain_on_cone(at, d, uv, 2u, cones.sets[2], range));
    if INNERMOST {
        hidden.x = rain_on_cone(at, d, uv, 0u, cones.sets[0], range);
    }
    if GROWING {
        let more = rain_on_cone(at, d, uv, cones.growing, cones.sets[3], range);
        hidden += select(vec3f(0.0), vec3f(more), vec3u(0u, 1u, 2u) == vec3u(cones.growing));
    }
    if !LAMPS {
        // All cones have the same light. The part of a cone that nearer cones cover is of second order and is left out.
        let clear = vec3f(cones.looks[0].x, cones.looks[1].x, cones.looks[2].x);
        return vec4f(day, 1.0) * (1.0 - exp(-dot(clear, hidden)));
    }
    var seen = vec4f(0.0);
    if INNERMOST {
        seen = before_others(d, day, 0u, hidden.x, seen);
    }
    seen = before_others(d, day, 1u, hidden.y, seen);
    return before_others(d, day, 2u, hidden.z, seen);
}
