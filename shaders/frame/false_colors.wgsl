// Diagnostic pictures: a scale of colours for a quantity of each pixel, and its display over the host's picture.
//!include "common/fullscreen.wgsl"
//!include "common/frame.wgsl"
//!include "common/tone.wgsl"
//!include "frame/host_picture.wgsl"

// Whether the target holds display values encoded by the sRGB curve.
override ENCODED: bool = false;

// Number of steps of the scale, from one colour to the next.
const STEPS: f32 = 5.0;

// Colours of the scale from 0 to 1, sRGB-encoded: black, blue, green, yellow, red, white.
fn scale_color(share: f32) -> vec3f {
    var colors = array<vec3f, 6>(
        vec3f(0.0),
        vec3f(0.0, 0.0, 1.0),
        vec3f(0.0, 1.0, 0.0),
        vec3f(1.0, 1.0, 0.0),
        vec3f(1.0, 0.0, 0.0),
        vec3f(1.0),
    );
    let at = clamp(share, 0.0, 1.0) * STEPS;
    let below = min(u32(at), 4u);
    return mix(colors[below], colors[below + 1u], at - f32(below));
}

// Reads the host's images at a pixel. If the pixel has several samples, the first is read.
fn seen_at(in: FullscreenVarying) -> Seen {
    let pixel = vec2i(in.position.xy);
    let ndc = frame_ndc(in.uv);
    var seen = Seen(pixel, 0, ndc, 0.0, RANGE_SKY, RANGE_SKY, 0.0);
    if HAS_DEPTH {
        seen.depth = textureLoad(host_depth, pixel, 0).r;
        seen.range = view_range(frame.depth, seen.depth, ndc);
        seen.plane = view_plane(frame.depth, seen.depth, ndc);
    }
    if HAS_MASK {
        seen.mask = textureLoad(host_mask, pixel, 0).r;
    }
    return seen;
}

// Puts the colour in place of the host's picture, except where the host's mask keeps the picture.
fn over_host(shown: vec3f, host: vec4f, seen: Seen) -> vec4f {
    var color = shown;
    if !ENCODED {
        color = srgb_decode(shown);
    }
    return vec4f(mix(color, host.rgb, seen.mask), host.a);
}
