// Composition of one pixel: the sky behind, water on surfaces, air and fog in front, then the tone curve. Each layer is
// a transmittance T and a light L: host colour x T + L.
//!include "common/guarded.wgsl"
//!include "common/fullscreen.wgsl"
//!include "frame/color_space.wgsl"
//!include "frame/on_surfaces.wgsl"
//!include "between/sky_sample.wgsl"
//!include "between/shaft_light.wgsl"
//!include "frame/weather_seen.wgsl"

// Whether the stages TONE and PARTICLES are drawn.
override TONE: bool = true;
override PARTICLES: bool = false;

// Whether clouds cast shadows on the host's surfaces.
override CLOUD_SHADOWS: bool = false;

// Factor for the light on what the host drew, in the shadows of clouds: the light at the position, divided by the mean
// over all positions. The host has lit its surfaces with this mean.
fn under_clouds(sky: SkySample, range: f32) -> vec3f {
    if !CLOUD_SHADOWS || range >= RANGE_SKY {
        return vec3f(1.0);
    }
    return 1.0 + frame.cloud_shadow.rgb * (sky.reach.z - frame.cloud_shadow.w);
}

// Display-linear value of a scene luminance.
fn display(luminance: vec3f) -> vec3f {
    // Saturated spectral colours lie outside of Rec. 709 and have negative channels there.
    return tone_curve(frame.tone, max(luminance, vec3f(0.0)) * frame.exposure);
}

// Layer of drops in front of everything (rain/drops.wgsl); the exposure is already applied to it.
@group(0) @binding(5) var drops: texture_2d<f32>;

// Lays the layer of drops and flakes over the veil.
fn with_drops(veil: Veil, pixel: vec2i) -> Veil {
    let layer = textureLoad(drops, pixel, 0);
    // Blended half floats may round to more than 1.
    let clear = max(1.0 - layer.a, 0.0);
    return Veil(veil.light * clear + layer.rgb / frame.exposure, veil.transmittance * clear);
}

// Colour of a pixel with the weather, for the host's target; `host` is the colour without the weather.
fn compose(host: vec4f, seen: Seen) -> vec4f {
    drawn = frame.drawn;
    behind_share = frame.behind_drawn;
    let ray = view_ray(frame.depth, seen.ndc);
    let sky = sky_sample_in(seen.pixel, seen.range);
    if CLOUD_SHAFTS {
        air_lit = shaft_light(ray.direction, sky.shafts);
    }
    var veil = weather_seen(ray, seen, sky);
    veil = on_surface(veil, linear_host(host.rgb), ray, seen);
    veil.transmittance *= under_clouds(sky, seen.range);
    if PARTICLES {
        veil = with_drops(veil, seen.pixel);
    }
    return vec4f(mix(written(host.rgb, veil, vec2u(seen.pixel)), host.rgb, seen.mask), host.a);
}

// Value for the host's target: the host's colour behind a veil, after tone curve, encoding and dither.
fn written(host: vec3f, veil: Veil, pixel: vec2u) -> vec3f {
    // The tone curve applies to all light of a scene-linear host, and only to the weather's light of a display host.
    let behind = linear_host(host) * veil.transmittance;
    var light = veil.light;
    var shown = vec3f(0.0);
    if is_space(SCENE_LINEAR) {
        light += behind;
        if !TONE {
            return light / frame.cd_m2_per_unit;
        }
    } else {
        shown = behind;
    }
    shown += display(light);
    if ENCODES && frame.encode == 1u {
        shown = srgb_encode(shown);
    }
    if DITHERS && frame.dither_step > 0.0 {
        shown = dither(shown, frame.dither_step, pixel, frame.seed);
    }
    return marked(shown, veil.light + veil.transmittance, frame.dither_step == 0.0);
}
