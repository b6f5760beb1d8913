// The weather before a pixel of the host's picture. Where a pipeline is for pixels between which it is even,
// weather_seen_even.wgsl stands here.
//!include "frame/weather.wgsl"
//!include "frame/host_picture.wgsl"

fn weather_seen(ray: ViewRay, seen: Seen, hung: Hung) -> Veil {
    return weather_over(ray, seen.range, seen.plane, hung);
}
