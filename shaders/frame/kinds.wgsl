// Writes the kind of each pixel as a depth; the kind says which draw of the composition covers the pixel
// (src/frame/pixels/kinds.rs).
//!include "common/host.wgsl"
//!include "common/fullscreen.wgsl"
//!include "common/frame.wgsl"

@group(0) @binding(2) var host_depth: HostDepth;

override HAS_DEPTH: bool = true;

// Depths of the kinds: sky above the level of the eye, sky and planet's ground below that level, and pixels on which
// the host drew.
const KIND_ABOVE: f32 = 0.0;
const KIND_BELOW: f32 = 0.5;
const KIND_DRAWN: f32 = 1.0;

// Kind of a pixel, and its range, m.
struct Kind {
    kind: f32,
    range: f32,
}

// Kind of a pixel by its depth sample and ray.
fn kind_of(in: FullscreenVarying) -> Kind {
    let ndc = frame_ndc(in.uv);
    let far = select(KIND_BELOW, KIND_ABOVE, view_ray(frame.depth, ndc).direction.z >= 0.0);
    if !HAS_DEPTH {
        return Kind(far, RANGE_SKY);
    }
    let range = view_range(frame.depth, textureLoad(host_depth, vec2i(in.position.xy), 0).r, ndc);
    return Kind(select(far, KIND_DRAWN, range < RANGE_SKY), range);
}

@fragment
fn kinds(in: FullscreenVarying) -> @builtin(frag_depth) f32 {
    return kind_of(in).kind;
}
