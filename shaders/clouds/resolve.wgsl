// Resolves the clouds of a whole picture from the pixels that this frame marched and from the last frame's picture,
// reprojected.
//!include "common/host.wgsl"
//!include "common/fullscreen.wgsl"
//!include "common/frame.wgsl"
//!include "clouds/picture.wgsl"
//!include "clouds/shafts.wgsl"

// Pixels that this frame marches, and reprojection.
@group(0) @binding(1) var<uniform> picture: CloudsPicture;
// Radiance and transmittance, and reach, of the pixels that this frame marched.
@group(0) @binding(2) var marched: texture_2d<f32>;
@group(0) @binding(3) var marched_reach: texture_2d<f32>;
// Layers of the last frame's picture.
@group(0) @binding(4) var last: texture_2d_array<f32>;
// Sampler that interpolates linearly.
@group(0) @binding(5) var linear: sampler;
// Smallest and largest radiance and transmittance around each square, and the square's offset (FollowedSquare of
// follow.wgsl).
@group(0) @binding(6) var least: texture_2d<f32>;
@group(0) @binding(7) var most: texture_2d<f32>;
@group(0) @binding(8) var back: texture_2d<f32>;

// Depth of the host's picture.
@group(1) @binding(0) var host_depth: HostDepth;
// Placement of the shadow map.
@group(1) @binding(1) var<uniform> shadows: CloudShadows;
// Share of the direct light that clouds let through.
@group(1) @binding(2) var shadow_map: texture_2d<f32>;
// Sampler that interpolates linearly and repeats the map.
@group(1) @binding(3) var repeating: sampler;

// Whether the last frame's picture may be used.
override HISTORY: bool = true;
// Whether there are shadows, and a host's depth to cast them on.
override SHADOWS: bool = true;
// Whether the air in front of the surfaces is shaded too.
override SHAFTS: bool = false;

// log2 of a distance beyond all clouds, m.
const NOWHERE: f32 = 24.0;

// Clouds of a resolved pixel.
struct ResolvedPixel {
    @location(0) seen: vec4f,
    // log2 of the distances of the reach, m (x, y); share of direct light at the surface that the host drew (z); share
    // of direct light in the air in front of the surface, less the mean over all places (w).
    @location(1) reach: vec4f,
}

// Share of direct light at the surface that the host drew (x), and share in the air in front of the surface, less the
// mean over all places (y). If the depth has several samples a pixel, the first one is used, because shadows of clouds
// have no sharp edges.
fn shadow_on(pixel: vec2u, ndc: vec2f) -> vec2f {
    if !SHADOWS {
        return vec2f(1.0, 0.0);
    }
    let depth = view_depth(frame.depth, textureLoad(host_depth, vec2i(pixel), 0).r, ndc);
    let share = cloud_shadow(shadows, shadow_map, repeating, view_point(frame.depth, depth, ndc));
    if !SHAFTS {
        return vec2f(share, 0.0);
    }
    let ray = view_ray(frame.depth, ndc);
    let range = min(depth * ray.slant, RANGE_SKY);
    let between = shaft_between(vec2f(pixel));
    return vec2f(share, cloud_shafts(shadows, shadow_map, repeating, ray.origin, ray.direction, range, between));
}

// Resolves one pixel.
fn resolved(in: FullscreenVarying) -> ResolvedPixel {
    let pixel = vec2u(in.position.xy);
    let among = among_marched(picture, pixel) / vec2f(textureDimensions(marched));
    let now = textureSampleLevel(marched, linear, among, 0.0);
    // A pixel may have clouds in the last picture but none on this frame's rays. They count as far away, behind all
    // that the host drew.
    let cover = 1.0 - now.a;
    let stands = textureSampleLevel(marched_reach, linear, among, 0.0).rg / max(cover, 1e-4);
    let reach = vec4f(select(vec2f(NOWHERE), stands, cover > 1e-4), shadow_on(pixel, frame_ndc(in.uv)));
    if !HISTORY {
        return ResolvedPixel(now, reach);
    }
    let square = min(pixel >> vec2u(side_power(picture)), textureDimensions(marched) - 1u);
    let followed = textureLoad(back, vec2i(square), 0);
    let to = followed.xy;
    let was = in.position.xy + to;
    let size = vec2f(picture.size);
    let lost = any(was < vec2f(0.0)) || any(was > size);
    let within = clamp(was, vec2f(0.5), size - 0.5) / vec2f(textureDimensions(last));
    // At rest the texel itself is taken. A filter rounds down a little in each frame, which would darken the clouds
    // until they are marched again.
    let filtered = textureSampleLevel(last, linear, within, 0, 0.0);
    let texel = textureLoad(last, vec2i(pixel), 0, 0);
    let kept = select(filtered, texel, all(to == vec2f(0.0))) * vec4f(vec3f(picture.exposed), 1.0);
    let held = clamp(kept, textureLoad(least, vec2i(square), 0), textureLoad(most, vec2i(square), 0));
    // Reprojection keeps a cloud's brightness, although the brightness depends on the direction. Where the picture is
    // smooth, the marched pixels alone are complete, so they are used instead.
    let likely = mix(held, now, followed.z);
    let is_marched = all(marched_pixel(picture, square) == pixel);
    return ResolvedPixel(select(likely, now, lost || is_marched), reach);
}

// Resolves one pixel.
@fragment
fn resolve(in: FullscreenVarying) -> ResolvedPixel {
    return resolved(in);
}

// If shadows have their own draw, the draw before it marks in the depth target the pixels on which the host drew.
struct ResolvedKind {
    @location(0) seen: vec4f,
    @location(1) reach: vec4f,
    @builtin(frag_depth) kind: f32,
}

// Depth that marks a pixel on which the host drew.
const KIND_DRAWN: f32 = 1.0;

@fragment
// Resolves one pixel without shadows, and marks it if the host drew on it.
fn resolve_kind(in: FullscreenVarying) -> ResolvedKind {
    let pixel = resolved(in);
    let depth = view_depth(frame.depth, textureLoad(host_depth, vec2i(in.position.xy), 0).r, frame_ndc(in.uv));
    return ResolvedKind(pixel.seen, pixel.reach, select(0.0, KIND_DRAWN, depth < RANGE_SKY));
}

// Writes the two components of `reach` that the first draw leaves out, and nothing else. Both outputs are declared,
// because virgl sends the output of a shader that has none at location 0 to the first target.
@fragment
fn resolve_shadow(in: FullscreenVarying) -> ResolvedPixel {
    let shadow = shadow_on(vec2u(in.position.xy), frame_ndc(in.uv));
    return ResolvedPixel(vec4f(0.0), vec4f(0.0, 0.0, shadow));
}
