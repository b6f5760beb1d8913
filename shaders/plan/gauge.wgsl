// What each part of the weather is worth in this very picture: at a coarse grid of its pixels, the composition with
// everything and without one part after the other. Output, by halves: relative change of luminance without air, without
// fog, without clear sky, and with a veil in place of drops but nothing else for them; 1 where the host drew something,
// -1 where it drew nothing, 0 under the mask; exposed luminance; optical depth of what drops hide; the change without
// clouds as a volume, of which the gauge knows how many there are and not where.
//!include "frame/composite.wgsl"
//!include "frame/exposed.wgsl"

// Pixels of the picture are looked at through these, written by the variant for one or several samples.
struct Looked {
    host: vec3f,
    range: f32,
    plane: f32,
    ndc: vec2f,
    mask: f32,
    hung: Hung,
}

// The upper halves of two numbers: eight bits of each are enough.
fn halves(a: f32, b: f32) -> u32 {
    return ((bitcast<u32>(a) + 0x8000u) >> 16u) | ((bitcast<u32>(b) + 0x8000u) & 0xffff0000u);
}

// Compositions beside those of frame.compositions: a deck in the place of clouds, nothing but their mean light, and a
// gap between them.
const WITH_DECK: u32 = 5u;
const IN_CLOUD: u32 = 6u;
const IN_GAP: u32 = 7u;

// What hangs in the sky in a composition: of clouds a deck at most, so that what others are worth does not hang on what
// is drawn now.
fn hung_for(k: u32, ray: ViewRay, seen: Hung) -> Hung {
    var hung = hung_bare();
    hung.behind = seen.behind;
    if k > WITH_DECK {
        hung.deck = 0.0;
        hung.disc = 1.0;
    }
    let way = frame.clouds_over / select(ray.direction.z, 1e-4, abs(ray.direction.z) < 1e-4);
    if k == IN_CLOUD && way > 0.0 {
        hung.clouds = vec4f(frame.mean_cloud.rgb * frame.exposure, 0.0);
        hung.reach = vec3f(vec2f(log2(max(way, 1.0))), 1.0);
    }
    return hung;
}

// Of a sky of which clouds cover a share, the share that they cover along a slant ray through their layer.
fn slant_cover(d: vec3f) -> f32 {
    return 1.0 - pow(1.0 - min(frame.mean_cloud.w, 1.0), 1.0 / max(abs(d.z), 0.2));
}

fn gauged(p: Looked) -> vec4u {
    let ray = view_ray(frame.depth, p.ndc);
    // Everything, then without one part after the other. A loop over a count that no compiler knows: unrolled, the fog
    // took a software driver a minute to compile.
    var shown = array<f32, 8>();
    let has_clouds = frame.mean_cloud.w > 0.0;
    let count = select(frame.compositions, IN_GAP + 1u, has_clouds);
    for (var k = 0u; k < (count & 15u); k++) {
        drawn = select(vec4f(1.0), vec4f(0.0), vec4u(k) == vec4u(1u, 2u, 3u, 4u));
        behind_share = frame.behind.y * drawn.z;
        shown[k] = exposed(p.host, weather_over(ray, p.range, p.plane, hung_for(k, ray, p.hung)));
    }
    // The measure of error of the whole of Welkin: relative luminance over a hundredth of white.
    let less = vec4f(shown[1], shown[2], shown[3], select(shown[0], shown[4], frame.compositions > 4u));
    let change = clamp((less - shown[0]) / (shown[0] + 0.01) * (1.0 - p.mask), vec4f(-6e4), vec4f(6e4));
    // Clouds are not looked at themselves, as they may not be drawn now: as many pixels as they cover are in cloud,
    // evenly spread.
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
