// Draws the panorama: clouds in all directions from the camera, for mirrors and cube maps.
//!include "common/guarded.wgsl"
//!include "common/fullscreen.wgsl"
//!include "between/sky_sample.wgsl"
//!include "clouds/march.wgsl"

// Marches the ray of one texel of the panorama.
@fragment
fn round(in: FullscreenVarying) -> @location(0) vec4f {
    drawn = vec4f(1.0, 1.0, 1.0, 0.0);
    let place = floor(in.position.xy) / (ROUND_SIDE - 1.0);
    let direction = octahedron_direction(place);
    cloud_pixel = 4.0 / ROUND_SIDE;
    var seen = clouds_along(direction, RANGE_SKY, clouds.jitter);
    if seen.transmittance < 1.0 {
        seen = clouds_behind(air_between(direction, cloud_middle(seen)), seen);
    }
    return vec4f(capped(seen.light, 65504.0), seen.transmittance);
}
