// Draws parts of lightning channels as lines of light in front of a host's picture. If the depth has several samples a
// pixel, the first one is used. A line is a drawn-out point of light: each part gives the same total light, however
// many pixels it covers.
//!include "common/guarded.wgsl"
//!include "common/host.wgsl"
//!include "between/veil.wgsl"

// Camera and picture of a draw.
struct ChannelUniform {
    // Matrix from camera-relative (east, north, up), m, to clip space.
    clip: mat4x4f,
    // Colour of the light in linear Rec. 709, with luminance 1.
    color: vec3f,
    // Solid angle of a pixel divided by the cube of the clip w of a unit direction, sr; 0 for parallel rays.
    pixel_sr: f32,
    // Size of the target, pixels.
    size: vec2f,
    // Area of a pixel for parallel rays, m^2; 0 otherwise.
    pixel_m2: f32,
    // Radius of a channel, m.
    radius: f32,
}

// Depth of the host's picture.
@group(0) @binding(1) var host_depth: HostDepth;
// Camera and picture of the draw.
@group(0) @binding(7) var<uniform> channel: ChannelUniform;

// Whether the host gives depth.
override HAS_DEPTH: bool = true;

// Standard deviation of a line's light across the line, pixels.
const SPREAD: f32 = 0.6;
// Number of standard deviations up to which a line is drawn.
const REACH: f32 = 3.5;
// Smallest clip w at which a part is drawn.
const NEAREST: f32 = 0.5;

// Values of a part of a channel for the fragments of its quad.
struct ChannelVarying {
    // Vertex stage: corner of the quad in clip space. Fragment stage: centre of the pixel, pixels.
    @builtin(position) position: vec4f,
    // x, y: one end of the line, pixels right of and below the target's upper left corner; z: spread of the line,
    // pixels.
    @location(0) @interpolate(flat) first: vec3f,
    // x, y: unit vector along the line in the picture; z: length of the line, pixels.
    @location(1) @interpolate(flat) along: vec3f,
    // xyz: unit vector from the camera to the middle of the part (east, north, up); w: distance of the middle, m.
    @location(2) @interpolate(flat) middle: vec4f,
    // x: luminance of a pixel that contains one pixel's length of the line, times exposure; y: distance of the middle
    // from the camera's plane, m.
    @location(3) @interpolate(flat) light: vec2f,
}

// Position of a place in clip space, pixels from the target's upper left corner.
fn pixel_of(clip: vec4f) -> vec2f {
    let ndc = clip.xy / clip.w * vec2f(1.0, frame.y_sign);
    return (0.5 + 0.5 * ndc * vec2f(1.0, -1.0)) * channel.size;
}

// Places a corner of the quad that a part lights. Inputs are its ends, relative to the camera, and its luminous
// intensity times exposure.
@vertex
fn channel_vertex(
    @builtin(vertex_index) corner: u32,
    @location(0) from_end: vec4f,
    @location(1) to_end: vec4f,
) -> ChannelVarying {
    var a = from_end.xyz;
    var b = to_end.xyz;
    var out = ChannelVarying(vec4f(2.0, 2.0, 0.0, 1.0), vec3f(0.0), vec3f(0.0), vec4f(0.0), vec2f(0.0));
    let w = vec2f((channel.clip * vec4f(a, 1.0)).w, (channel.clip * vec4f(b, 1.0)).w);
    if max(w.x, w.y) <= NEAREST {
        return out;
    }
    // Keep only the part in front of the camera.
    let cut = clamp((NEAREST - w.x) / select(w.y - w.x, 1.0, w.x == w.y), 0.0, 1.0);
    let whole = length(b - a);
    if w.x < NEAREST {
        a = mix(a, b, cut);
    } else if w.y < NEAREST {
        b = mix(a, b, cut);
    }
    let p = pixel_of(channel.clip * vec4f(a, 1.0));
    let q = pixel_of(channel.clip * vec4f(b, 1.0));
    let pixels = length(q - p);
    let along = select(vec2f(1.0, 0.0), (q - p) / max(pixels, 1e-6), pixels > 1e-4);
    let middle = 0.5 * (a + b);
    let range = max(length(middle), 0.1);
    let direction = middle / range;
    let middle_w = (channel.clip * vec4f(middle, 1.0)).w;
    // Luminous intensity of the part that is kept.
    let intensity = from_end.w * length(b - a) / max(whole, 1e-6);
    var luminance = intensity / max(channel.pixel_m2, 1e-12);
    var pixel_m = sqrt(channel.pixel_m2);
    if channel.pixel_sr > 0.0 {
        let per_metre = middle_w / range;
        let pixel_sr = channel.pixel_sr * per_metre * per_metre * per_metre;
        luminance = intensity / (range * range * pixel_sr);
        pixel_m = sqrt(pixel_sr) * range;
    }
    let wide = channel.radius / pixel_m;
    let spread = sqrt(SPREAD * SPREAD + wide * wide);
    let side = vec2f(select(-1.0, 1.0, (corner & 1u) != 0u), select(-1.0, 1.0, (corner & 2u) != 0u));
    let reach = REACH * spread;
    let across = vec2f(-along.y, along.x);
    let at = 0.5 * (p + q) + along * (side.x * (0.5 * pixels + reach)) + across * (side.y * reach);
    out.position = vec4f((2.0 * at / channel.size - 1.0) * vec2f(1.0, -1.0), 0.0, 1.0);
    out.first = vec3f(p, spread);
    out.along = vec3f(along, pixels);
    out.middle = vec4f(direction, range);
    out.light = vec2f(luminance / max(pixels, 1e-3), middle_w * frame.depth.plane_scale);
    return out;
}

// The error function within 4e-4.
fn erf(x: f32) -> f32 {
    let y = clamp(x, -4.0, 4.0);
    return tanh(y * (1.1283792 + 0.1009106 * y * y));
}

// Share of a line's light that falls on a pixel. Consecutive parts add up to one line without a visible joint.
fn line_share(in: ChannelVarying) -> f32 {
    let off = in.position.xy - in.first.xy;
    let spread = in.first.z;
    let along = dot(off, in.along.xy) / (1.4142136 * spread);
    let across = dot(off, vec2f(-in.along.y, in.along.x)) / spread;
    let length = max(in.along.z, 1e-3) / (1.4142136 * spread);
    return 0.5 * (erf(along) - erf(along - length)) * exp(-0.5 * across * across) * (0.3989423 / spread);
}

// Whether the host has drawn nothing in front of the part.
fn is_open(in: ChannelVarying) -> bool {
    if !HAS_DEPTH {
        return true;
    }
    let uv = in.position.xy / channel.size;
    let texels = vec2f(textureDimensions(host_depth));
    let depth = textureLoad(host_depth, vec2i(clamp(uv * texels, vec2f(0.0), texels - 1.0)), 0).r;
    let ndc = frame_ndc(uv);
    return view_range(frame.depth, depth, ndc) >= in.middle.w;
}

// Returns the light of the part in a pixel, premultiplied with alpha 0, so that it is added to the picture.
@fragment
fn channel_fragment(in: ChannelVarying) -> @location(0) vec4f {
    drawn = frame.drawn;
    let share = select(0.0, line_share(in), is_open(in));
    let ray = ViewRay(vec3f(0.0), in.middle.xyz, 1.0);
    let sky = sky_sample_in(vec2i(in.position.xy), in.middle.w);
    let through = veil_between(ray, in.middle.w, in.light.y, sky).transmittance;
    // Half of the largest half float, because two parts may fall on one pixel.
    return vec4f(capped(channel.color * through * (in.light.x * share), 3e4), 0.0);
}
