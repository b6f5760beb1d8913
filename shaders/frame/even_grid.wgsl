// Draws the coarse grid of the weather.
//!include "frame/even.wgsl"
//!include "frame/composite_view.wgsl"

// Texel of the grid in both layers.
struct EvenTexel {
    // Light times EVEN_WHITE * frame.even_scale; alpha is log2 of the range, m.
    @location(0) light: vec4f,
    // Transmittance; alpha is 1 next to a disc of sun or moon, which may be small enough to fall between texels.
    @location(1) transmittance: vec4f,
}

// Whether a direction is within `angle`, rad, of the disc of the sun or the moon.
fn is_near_disc(d: vec3f, angle: f32) -> bool {
    let real = unrefracted(d);
    for (var i = 0u; i < SKY_DISCS; i++) {
        let lamp = sky_view.lamps[i];
        if length(real - lamp.toward) < lamp.angular_radius + angle {
            return true;
        }
    }
    return false;
}

@fragment
fn even_grid(in: FullscreenVarying) -> EvenTexel {
    let at = (vec2i(in.position.xy) - 1) * EVEN_PIXELS;
    let pixel = clamp(at, vec2i(0), vec2i(frame.picture) - 1);
    let uv = (vec2f(at) + 0.5) / frame.picture;
    let ndc = frame_ndc(uv);
    var seen = Seen(pixel, 0, ndc, 0.0, RANGE_SKY, RANGE_SKY, 0.0);
    if HAS_DEPTH {
        seen.depth = textureLoad(host_depth, pixel, 0).r;
        seen.range = view_range(frame.depth, seen.depth, ndc);
        seen.plane = view_plane(frame.depth, seen.depth, ndc);
    }
    drawn = frame.drawn;
    behind_share = frame.behind_drawn;
    let ray = view_ray(frame.depth, ndc);
    // Clouds change from pixel to pixel; each pixel lays its own clouds over the interpolated value.
    let veil = weather_over(ray, seen.range, seen.plane, sky_sample_with(NO_CLOUDS));
    let disc = BACKGROUND && DISCS && is_near_disc(ray.direction, 2.0 * f32(EVEN_PIXELS) * frame.pixel_angle);
    let light = min(veil.light * (EVEN_WHITE * frame.even_scale), vec3f(EVEN_MOST));
    return EvenTexel(vec4f(light, log2(max(seen.range, 1e-3))), vec4f(veil.transmittance, f32(disc)));
}
