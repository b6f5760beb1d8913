// Clouds along the rays of some pixels of a picture; where the host's depth has several samples a pixel, the first stands for them.
//!include "common/host.wgsl"
//!include "common/fullscreen.wgsl"
//!include "clouds/march.wgsl"
//!include "clouds/picture.wgsl"

@group(0) @binding(7) var host_depth: HostDepth;
@group(0) @binding(8) var<uniform> picture: CloudsPicture;

override HAS_DEPTH: bool = true;

struct MarchedPixel {
    @location(0) seen: vec4f,
    // log2 of the distance, m.
    @location(1) distance: vec4f,
}

@fragment
fn march(in: FullscreenVarying) -> MarchedPixel {
    drawn = frame.drawn;
    let pixel = marched_pixel(picture, vec2u(in.position.xy));
    let ndc = pixel_ndc(picture, pixel, frame.y_sign);
    var range = RANGE_SKY;
    if HAS_DEPTH {
        range = view_range(frame.depth, textureLoad(host_depth, vec2i(pixel), 0).r, ndc);
    }
    let seen = clouds_seen(view_ray(frame.depth, ndc).direction, range, clouds.jitter);
    return MarchedPixel(vec4f(min(seen.light, vec3f(65504.0)), seen.transmittance), vec4f(log2(max(seen.distance, 1.0))));
}
