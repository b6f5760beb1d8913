// In place of weather_seen.wgsl for pixels between which the weather is even: it is looked up in its grid.
//!include "between/air.wgsl"
//!include "between/hung.wgsl"
//!include "frame/even.wgsl"
//!include "frame/host_picture.wgsl"

// Light by EVEN_WHITE * frame.even_scale; transmittance.
@group(3) @binding(0) var even_weather: texture_2d_array<f32>;
@group(3) @binding(1) var even_sampler: sampler;

fn weather_seen(ray: ViewRay, seen: Seen, hung: Hung) -> Veil {
    let at = vec2f(seen.pixel) / f32(EVEN_PIXELS) + 1.5;
    let uv = at / vec2f(textureDimensions(even_weather));
    let light = textureSampleLevel(even_weather, even_sampler, uv, 0, 0.0).rgb;
    return Veil(light / (EVEN_WHITE * frame.even_scale), textureSampleLevel(even_weather, even_sampler, uv, 1, 0.0).rgb);
}
