// Measures how much each part of the weather changes this picture. For each pixel of a coarse grid it composes the
// picture with everything, and again without one part after another. Output in this order, as upper halves of 32-bit
// floats, packed in pairs:
// - relative changes of luminance without air, without fog, without clear sky, and with a veil in place of drops;
// - kind of the pixel: 1 where the host drew something, -1 where it drew nothing, 0 under the mask;
// - exposed luminance;
// - optical depth of the drops and flakes that are drawn one by one;
// - relative change with a deck in place of clouds drawn as a volume. The cover of these clouds is known here, but
// their places are not.
//!include "frame/composite.wgsl"
//!include "frame/exposed.wgsl"

// Pixel of the picture. The variants for one and for several samples fill it.
struct Looked {
    host: vec3f,
    range: f32,
    plane: f32,
    ndc: vec2f,
    mask: f32,
    sky: SkySample,
}

// Packs the upper halves of two numbers, rounded: eight bits of mantissa are enough.
fn halves(a: f32, b: f32) -> u32 {
    return ((bitcast<u32>(a) + 0x8000u) >> 16u) | ((bitcast<u32>(b) + 0x8000u) & 0xffff0000u);
}

// Indices of the compositions that follow those of frame.compositions. Composition with a deck in place of clouds:
const WITH_DECK: u32 = 5u;
// Composition of a pixel in a cloud, with the mean light of clouds:
const IN_CLOUD: u32 = 6u;
// Composition of a pixel in a gap between clouds:
const IN_GAP: u32 = 7u;

// Sky objects in a composition. Clouds are at most a deck, so that the contributions of other parts do not depend on
// the rung at which clouds are drawn now.
fn sky_sample_for(k: u32, ray: ViewRay, seen: SkySample) -> SkySample {
    var sky = bare_sky_sample();
    sky.behind = seen.behind;
    if k > WITH_DECK {
        sky.deck = 0.0;
        sky.disc = 1.0;
    }
    let way = frame.clouds_over / select(ray.direction.z, 1e-4, abs(ray.direction.z) < 1e-4);
    if k == IN_CLOUD && way > 0.0 {
        sky.clouds = vec4f(frame.mean_cloud.rgb * frame.exposure, 0.0);
        sky.reach = vec3f(vec2f(log2(max(way, 1.0))), 1.0);
    }
    return sky;
}

// Share of clouds along a slant ray through their layer, from their cover of the sky.
fn slant_cover(d: vec3f) -> f32 {
    return 1.0 - pow(1.0 - min(frame.mean_cloud.w, 1.0), 1.0 / max(abs(d.z), 0.2));
}

fn gauged(p: Looked) -> vec4u {
    let ray = view_ray(frame.depth, p.ndc);
    // First everything, then without one part after another. The compiler must not know the loop's count: when it
    // unrolled the loop, a software driver took a minute to compile the fog.
    var shown = array<f32, 8>();
    let has_clouds = frame.mean_cloud.w > 0.0;
    let count = select(frame.compositions, IN_GAP + 1u, has_clouds);
    for (var k = 0u; k < (count & 15u); k++) {
        drawn = select(vec4f(1.0), vec4f(0.0), vec4u(k) == vec4u(1u, 2u, 3u, 4u));
        behind_share = frame.behind.y * drawn.z;
        shown[k] = exposed(p.host, weather_over(ray, p.range, p.plane, sky_sample_for(k, ray, p.sky)));
    }
    // Error measure of the whole library, (Y' - Y) / (Y + 0.01) in exposed luminance (1 = white). Y' is the luminance
    // without the part.
    let less = vec4f(shown[1], shown[2], shown[3], select(shown[0], shown[4], frame.compositions > 4u));
    let change = clamp((less - shown[0]) / (shown[0] + 0.01) * (1.0 - p.mask), vec4f(-6e4), vec4f(6e4));
    // The real clouds are not sampled here, because they may not be drawn now. Instead, evenly spread pixels count as
    // in a cloud, in the share that `slant_cover` gives.
    let cell = floor((0.5 + 0.5 * p.ndc) * vec2f(64.0, 36.0));
    let in_cloud = fract(dot(cell, vec2f(0.7548777, 0.5698403))) < slant_cover(ray.direction);
    let with_volume = select(shown[IN_GAP], shown[IN_CLOUD], in_cloud);
    let off = abs(shown[WITH_DECK] - with_volume) / (with_volume + 0.01) * (1.0 - p.mask);
    let clouds = select(0.0, min(off, 6e4), has_clouds);
    let kind = select(1.0, -1.0, p.range >= RANGE_SKY) * select(1.0, 0.0, p.mask > 0.5);
    let hidden = depth_of_drawn(p.range);
    return vec4u(
        halves(change.x, change.y),
        halves(change.z, change.w),
        halves(kind, min(shown[0], 6e4)),
        halves(hidden, clouds),
    );
}
