// Marches the clouds along the rays of some pixels of a picture, whether or not the host's objects hide them. The
// composition decides for every pixel and sample which clouds are in front of an object, so moving objects leave no
// trail.
//!include "common/guarded.wgsl"
//!include "common/fullscreen.wgsl"
//!include "clouds/march.wgsl"
//!include "clouds/picture.wgsl"
//!include "common/frame.wgsl"
//!include "clouds/shafts.wgsl"
//!include "between/shaft_light.wgsl"

// Pixels that this frame marches.
@group(0) @binding(7) var<uniform> picture: CloudsPicture;
// Placement of the shadow map.
@group(0) @binding(9) var<uniform> shadows: CloudShadows;
// Share of the direct light that clouds let through.
@group(0) @binding(10) var shadow_map: texture_2d<f32>;

// Whether the air in front of the clouds shows their shadows.
override SHAFTS: bool = false;

// Air between the eye and a distance along a ray. `between` places the samples of the shafts (shafts.wgsl).
fn air_before(ray: ViewRay, distance: f32, between: f32) -> Veil {
    if SHAFTS {
        let differs = cloud_shafts(shadows, shadow_map, cloud_sampler, ray.origin, ray.direction, distance, between);
        air_lit = shaft_light(ray.direction, differs);
    }
    return air_between(ray.direction, distance);
}

// Clouds of a marched pixel: radiance and transmittance, and reach.
struct MarchedPixel {
    @location(0) seen: vec4f,
    // log2 of the reach, m, times 1 - transmittance, so that a mean of texels is weighted by the visible cloud.
    @location(1) reach: vec4f,
}

@fragment
// Marches the ray of one pixel in each square.
fn march(in: FullscreenVarying) -> MarchedPixel {
    drawn = frame.drawn;
    let pixel = marched_pixel(picture, vec2u(in.position.xy));
    let ndc = pixel_ndc(picture, pixel, frame.y_sign);
    let ray = view_ray(frame.depth, ndc);
    cloud_origin = ray.origin;
    cloud_pixel = frame.pixel_angle;
    var seen = clouds_along(ray.direction, RANGE_SKY, clouds.jitter);
    if seen.transmittance < 1.0 {
        let between = shaft_between(vec2f(pixel));
        seen = clouds_behind(air_before(ray, cloud_middle(seen), between), seen);
    }
    // The cover is rounded as in the picture's half floats, because the reach is divided by it later.
    let cover = 1.0 - round(seen.transmittance * 2048.0) / 2048.0;
    return MarchedPixel(vec4f(capped(seen.light, 65504.0), seen.transmittance), vec4f(log2(seen.reach) * cover, 0.0, 0.0));
}
