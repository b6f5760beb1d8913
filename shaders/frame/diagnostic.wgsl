// Draws one quantity of each pixel in false colours, in place of the picture: for developers (docs/diagnostics.md). If
// the picture has several samples per pixel, the first is used.
//!include "frame/host_picture.wgsl"
//!include "frame/composite.wgsl"
//!include "frame/exposed.wgsl"
//!include "frame/false_colors.wgsl"

// Quantity to draw, numbered as in src/stage/diagnostic.rs.
override DIAGNOSTIC: u32 = 1u;
// Whether nothing in the frame has the quantity.
override ABSENT: bool = false;

const DISTANCE: u32 = 1u;
const OPTICAL_DEPTH: u32 = 2u;
const WETNESS: u32 = 3u;
const PLAN_ERROR: u32 = 4u;
const OVERDRAW: u32 = 5u;

// Number of draws of a pixel for one step of the scale.
const DRAWS_OF_STEP: f32 = 4.0;

fn log10(x: f32) -> f32 {
    return log2(x) * 0.30103;
}

// Optical depth of air, clouds, fog and precipitation between the eye and the surface. It includes the precipitation
// that is drawn as single drops and flakes.
fn optical_depth(ray: ViewRay, seen: Seen) -> f32 {
    drawn = vec4f(1.0, 1.0, 1.0, 0.0);
    let air = Veil(vec3f(0.0), exp(-sky_path(ray.direction, seen.range).depth));
    let through = veil_before(ray, seen.range, seen.plane, air, sky_sample_in(seen.pixel, seen.range)).transmittance;
    return -log(max(dot(through, vec3f(0.2126, 0.7152, 0.0722)), 1e-9));
}

// Error due to what the plan leaves out of air, fog and clear sky: |Y' - Y| / (Y + 0.01), where Y is the exposed
// luminance (1 = white) and Y' is that of the planned picture.
fn plan_error(host: vec3f, ray: ViewRay, seen: Seen) -> f32 {
    let sky = sky_sample_in(seen.pixel, seen.range);
    // First everything, then what the plan draws. Drivers copy a function's code to every call; a loop has only one
    // call.
    var all = 0.0;
    var planned = 0.0;
    for (var i = 0u; i < 2u; i++) {
        all = planned;
        drawn = select(vec4f(1.0, 1.0, 1.0, frame.drawn.w), frame.drawn, i == 1u);
        planned = exposed(host, weather_over(ray, seen.range, seen.plane, sky));
    }
    return abs(planned - all) / (all + 0.01);
}

// Position of the quantity on the scale, 0 to 1.
fn measured(host: vec3f, ray: ViewRay, seen: Seen) -> f32 {
    if ABSENT {
        return 0.0;
    }
    if DIAGNOSTIC == DISTANCE {
        return log10(max(seen.range, 1.0)) / STEPS;
    }
    if DIAGNOSTIC == OPTICAL_DEPTH {
        return optical_depth(ray, seen) / STEPS;
    }
    if DIAGNOSTIC == WETNESS {
        water_cover = 0.0;
        drawn = frame.drawn;
        let veil = on_surface(Veil(vec3f(0.0), vec3f(1.0)), linear_host(host), ray, seen);
        return water_cover;
    }
    if DIAGNOSTIC == PLAN_ERROR {
        return log10(max(plan_error(host, ray, seen) * 1e4, 1.0)) / STEPS;
    }
    return textureLoad(drops, seen.pixel, 0).r / (STEPS * DRAWS_OF_STEP);
}

@fragment
fn diagnose(in: FullscreenVarying) -> @location(0) vec4f {
    let seen = seen_at(in);
    let host = textureLoad(host_color, seen.pixel, 0);
    return over_host(scale_color(measured(host.rgb, view_ray(frame.depth, seen.ndc), seen)), host, seen);
}
