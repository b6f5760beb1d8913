// Draws the glow of clouds in the light of lamps and flashes, with fewer rays than the clouds have. This shader is
// assembled with lit_lamps.wgsl in place of lit.wgsl.
//!include "common/guarded.wgsl"
//!include "common/fullscreen.wgsl"
//!include "clouds/march.wgsl"
//!include "clouds/lamps.wgsl"
//!include "common/frame.wgsl"

// Light of the clouds divided by their cover, and log2 of their distance, m; 0 without clouds.
@fragment
fn glow(in: FullscreenVarying) -> @location(0) vec4f {
    drawn = frame.drawn;
    let uv = (in.position.xy - vec2f(0.0, lamps.row)) / lamps.size;
    let ray = view_ray(frame.depth, frame_ndc(uv));
    cloud_origin = ray.origin;
    let seen = clouds_along(ray.direction, RANGE_SKY, clouds.jitter);
    let cover = 1.0 - seen.transmittance;
    if cover < 1e-3 {
        return vec4f(0.0);
    }
    let middle = cloud_middle(seen);
    let light = seen.light * air_between(ray.direction, middle).transmittance / cover;
    return vec4f(capped(light, 65504.0), log2(middle));
}
