// The wind over what the host drew, for developers (docs/diagnostics.md): its speed in false colours, and arrows along
// it.
//!include "frame/false_colors.wgsl"
//!include "surroundings/wind.wgsl"

// WindUniform of src/frame/wind_picture.rs.
struct WindPicture {
    map: WindMap,
    // The weather's wind, which blows where none is known that varies in space, m/s (east, north, up).
    weathers: vec3f,
    varies: u32,
    // The camera east and north of a place of the world that stays, m.
    eye: vec2f,
}

@group(1) @binding(0) var<uniform> wind_picture: WindPicture;
@group(1) @binding(1) var wind_values: texture_3d<f32>;
@group(1) @binding(2) var wind_sampler: sampler;

// Height over a surface, m.
const WIND_OVER: f32 = 2.0;
// m/s from one colour of the scale to the next.
const WIND_OF_STEP: f32 = 4.0;
// Side of the squares with an arrow each over the distance: a power of two in metres.
const ARROW_SQUARE: f32 = 0.06;
// Place on the scale up to which it is dark: black, blue.
const DARK_SHARE: f32 = 0.3;
// Slower air has a dot, m/s.
const CALM: f32 = 0.3;

// At so much over a camera-relative place, m/s.
fn wind_over(surface: vec3f) -> vec3f {
    if wind_picture.varies == 0u {
        return wind_picture.weathers;
    }
    let place = wind_place(wind_picture.map, surface + vec3f(0.0, 0.0, WIND_OVER));
    let found = textureSampleLevel(wind_values, wind_sampler, place, 0.0);
    return wind_at(wind_picture.map, place, found, wind_picture.weathers);
}

// Whether the arrow of the square about a place covers it.
fn is_arrow(surface: vec3f, range: f32) -> bool {
    let side = exp2(round(log2(max(ARROW_SQUARE * range, 0.25))));
    let middle = (floor((surface.xy + wind_picture.eye) / side) + 0.5) * side - wind_picture.eye;
    let wind = wind_over(vec3f(middle, surface.z)).xy;
    let off = (surface.xy - middle) / side;
    let speed = length(wind);
    if speed < CALM {
        return length(off) < 0.06;
    }
    let along = dot(off, wind) / speed;
    let across = abs(off.y * wind.x - off.x * wind.y) / speed;
    let is_head = along > 0.05 && across < 0.5 * (0.4 - along);
    return is_head || (abs(along) < 0.4 && along <= 0.05 && across < 0.04);
}

@fragment
fn wind(in: FullscreenVarying) -> @location(0) vec4f {
    let seen = seen_at(in);
    let host = textureLoad(host_color, seen.pixel, 0);
    if seen.range >= RANGE_SKY {
        return over_host(vec3f(0.0), host, seen);
    }
    let ray = view_ray(frame.depth, seen.ndc);
    let surface = ray.origin + ray.direction * seen.range;
    let share = length(wind_over(surface)) / (STEPS * WIND_OF_STEP);
    var shown = scale_color(share);
    if is_arrow(surface, seen.range) {
        shown = select(vec3f(1.0), vec3f(0.0), share > DARK_SHARE);
    }
    return over_host(shown, host, seen);
}
