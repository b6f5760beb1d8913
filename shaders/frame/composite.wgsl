// One pixel of the frame: sky behind, water on surfaces, air and fog between, tone on top. Host colour x T + L
// throughout.
//!include "common/guarded.wgsl"
//!include "common/fullscreen.wgsl"
//!include "frame/color_space.wgsl"
//!include "frame/on_surfaces.wgsl"
//!include "between/hung.wgsl"
//!include "between/shaft_light.wgsl"
//!include "frame/weather_seen.wgsl"

override TONE: bool = true;
override PARTICLES: bool = false;

// Clouds cast shadows on what the host drew.
override CLOUD_SHADOWS: bool = false;

// What the shadow of clouds leaves of the light on what the host drew, of that on the mean over places, in which the
// host lit it.
fn under_clouds(hung: Hung, range: f32) -> vec3f {
    if !CLOUD_SHADOWS || range >= RANGE_SKY {
        return vec3f(1.0);
    }
    return 1.0 + frame.cloud_shadow.rgb * (hung.reach.z - frame.cloud_shadow.w);
}

// Display-linear value of scene luminance.
fn display(luminance: vec3f) -> vec3f {
    // Saturated spectra lie outside of Rec. 709 and have negative parts there.
    return tone_curve(frame.tone, max(luminance, vec3f(0.0)) * frame.exposure);
}

// Drops before everything (rain/drops.wgsl), on which the exposure is already.
@group(0) @binding(5) var drops: texture_2d<f32>;

fn with_drops(veil: Veil, pixel: vec2i) -> Veil {
    let layer = textureLoad(drops, pixel, 0);
    // Blended halves may round beyond 1.
    let clear = max(1.0 - layer.a, 0.0);
    return Veil(veil.light * clear + layer.rgb / frame.exposure, veil.transmittance * clear);
}

fn compose(host: vec4f, seen: Seen) -> vec4f {
    drawn = frame.drawn;
    behind_share = frame.behind_drawn;
    let ray = view_ray(frame.depth, seen.ndc);
    let hung = hung_in(seen.pixel, seen.range);
    if CLOUD_SHAFTS {
        air_lit = shaft_light(ray.direction, hung.shafts);
    }
    var veil = weather_seen(ray, seen, hung);
    veil = on_surface(veil, linear_host(host.rgb), ray, seen);
    veil.transmittance *= under_clouds(hung, seen.range);
    if PARTICLES {
        veil = with_drops(veil, seen.pixel);
    }
    return vec4f(mix(written(host.rgb, veil, vec2u(seen.pixel)), host.rgb, seen.mask), host.a);
}

fn written(host: vec3f, veil: Veil, pixel: vec2u) -> vec3f {
    // Of a host with luminances all is shown by the tone curve, of one with a display's colours only what weather adds.
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
