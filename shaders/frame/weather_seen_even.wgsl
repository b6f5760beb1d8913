// Version of weather_seen.wgsl for interpolated pixels: reads the weather from the coarse grid, and lays the pixel's
// clouds, which the grid does not have, over it.
//!include "between/air.wgsl"
//!include "between/sky_sample.wgsl"
//!include "frame/even.wgsl"
//!include "frame/host_picture.wgsl"

// Layer 0: light times EVEN_WHITE * frame.even_scale. Layer 1: transmittance.
@group(3) @binding(0) var even_weather: texture_2d_array<f32>;
@group(3) @binding(1) var even_sampler: sampler;

override BACKGROUND: bool = true;
override MEDIUM: bool = true;

fn weather_seen(ray: ViewRay, seen: Seen, sky: SkySample) -> Veil {
    let at = vec2f(seen.pixel) / f32(EVEN_PIXELS) + 1.5;
    let uv = at / vec2f(textureDimensions(even_weather));
    let light = textureSampleLevel(even_weather, even_sampler, uv, 0, 0.0).rgb;
    let veil = Veil(light / (EVEN_WHITE * frame.even_scale), textureSampleLevel(even_weather, even_sampler, uv, 1, 0.0).rgb);
    if !select(MEDIUM, BACKGROUND, seen.range >= RANGE_SKY) {
        return veil;
    }
    return with_clouds(veil, sky, seen.range);
}
