// What each part of the weather is worth in this very picture: at a coarse grid of its pixels, the composition with
// everything and without one part after the other. Output, by halves: relative change of luminance without air, without fog,
// without clear sky, and with a veil in place of drops but nothing else for them; 1 where the host drew something, -1 where it
// drew nothing, 0 under the mask; exposed luminance; optical depth of what drops hide.
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

fn gauged(p: Looked) -> vec4u {
    let ray = view_ray(frame.depth, p.ndc);
    // Everything, then without one part after the other. A loop over a count that no compiler knows: unrolled, the fog
    // took a software driver a minute to compile.
    var shown = array<f32, 5>();
    for (var k = 0u; k < frame.compositions; k++) {
        drawn = select(vec4f(1.0), vec4f(0.0), vec4u(k) == vec4u(1u, 2u, 3u, 4u));
        behind_share = frame.behind.y * drawn.z;
        shown[k] = exposed(p.host, weather_over(ray, p.range, p.plane, p.hung));
    }
    // The measure of error of the whole of Welkin: relative luminance over a hundredth of white.
    let less = vec4f(shown[1], shown[2], shown[3], select(shown[0], shown[4], frame.compositions > 4u));
    let change = clamp((less - shown[0]) / (shown[0] + 0.01) * (1.0 - p.mask), vec4f(-6e4), vec4f(6e4));
    let kind = select(1.0, -1.0, p.range >= RANGE_SKY) * select(1.0, 0.0, p.mask > 0.5);
    let hidden = depth_of_drawn(p.range);
    return vec4u(
        halves(change.x, change.y),
        halves(change.z, change.w),
        halves(kind, min(shown[0], 6e4)),
        halves(hidden, 0.0),
    );
}
