// Wind over the host's surfaces, for developers (docs/diagnostics.md): its speed in false colours, and arrows along it.
//!include "frame/false_colors.wgsl"
//!include "surroundings/wind.wgsl"

// WindUniform of src/frame/wind_picture.rs.
struct WindPicture {
    map: WindMap,
    // The weather's wind, used where no spatially varying wind is known, m/s (east, north, up).
    weathers: vec3f,
    varies: u32,
    // Camera's position east and north of a fixed point of the world, m.
    eye: vec2f,
}

@group(1) @binding(0) var<uniform> wind_picture: WindPicture;
@group(1) @binding(1) var wind_values: texture_3d<f32>;
@group(1) @binding(2) var wind_sampler: sampler;

// Height above the surface at which the wind is shown, m.
const WIND_OVER: f32 = 2.0;
// Wind speed for one step of the scale, m/s.
const WIND_OF_STEP: f32 = 4.0;
// Side of the square around an arrow, divided by the square's distance. The side is rounded to a power of two in
// metres.
const ARROW_SQUARE: f32 = 0.06;
// Position on the scale below which the picture is dark (black, blue), so that arrows are white.
const DARK_SHARE: f32 = 0.3;
// Speed below which a dot replaces the arrow, m/s.
const CALM: f32 = 0.3;

// Wind at WIND_OVER above a camera-relative position, m/s.
fn wind_over(surface: vec3f) -> vec3f {
    if wind_picture.varies == 0u {
        return wind_picture.weathers;
    }
    let place = wind_place(wind_picture.map, surface + vec3f(0.0, 0.0, WIND_OVER));
    let found = textureSampleLevel(wind_values, wind_sampler, place, 0.0);
    return wind_at(wind_picture.map, place, found, wind_picture.weathers);
}

// Whether the arrow in the square around a position covers the position.
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
