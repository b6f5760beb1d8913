// Clouds along the rays of some pixels of a picture. They are marched whether the host's things hide them or not: what stands before a cloud
// and what stands in it is told apart by the composition, for every pixel and sample, and leaves no trail where it moves.
//!include "common/fullscreen.wgsl"
//!include "clouds/march.wgsl"
//!include "clouds/picture.wgsl"
//!include "common/frame.wgsl"

@group(0) @binding(7) var<uniform> picture: CloudsPicture;

struct MarchedPixel {
    @location(0) seen: vec4f,
    // log2 of the reach, m, times 1 - transmittance, so that a mean of texels is that of what is seen.
    @location(1) reach: vec4f,
}

@fragment
fn march(in: FullscreenVarying) -> MarchedPixel {
    drawn = frame.drawn;
    let ndc = pixel_ndc(picture, marched_pixel(picture, vec2u(in.position.xy)), frame.y_sign);
    let ray = view_ray(frame.depth, ndc);
    cloud_origin = ray.origin;
    let seen = clouds_seen(ray.direction, RANGE_SKY, clouds.jitter);
    // As the half floats of the picture round it: the reach is divided by it again.
    let cover = 1.0 - round(seen.transmittance * 2048.0) / 2048.0;
    return MarchedPixel(vec4f(min(seen.light, vec3f(65504.0)), seen.transmittance), vec4f(log2(seen.reach) * cover, 0.0, 0.0));
}
