// Weather in front of a pixel of the host's picture. Pipelines for interpolated pixels use weather_seen_even.wgsl
// instead.
//!include "frame/weather.wgsl"
//!include "frame/host_picture.wgsl"

// Weather in front of the surface in a pixel, or the sky.
fn weather_seen(ray: ViewRay, seen: Seen, sky: SkySample) -> Veil {
    return weather_over(ray, seen.range, seen.plane, sky);
}
