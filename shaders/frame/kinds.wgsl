// Which of the composition's draws a pixel belongs to, as a depth (src/frame/kinds.rs).
//!include "common/host.wgsl"
//!include "common/fullscreen.wgsl"
//!include "common/frame.wgsl"
//!include "sky/disc.wgsl"

@group(0) @binding(2) var host_depth: HostDepth;

override HAS_DEPTH: bool = true;
// Open sky is told from the rest of it.
override OPEN_SKY: bool = true;

const KIND_OPEN_SKY: f32 = 0.0;
const KIND_SKY: f32 = 0.5;
const KIND_DRAWN: f32 = 1.0;

@fragment
fn kinds(in: FullscreenVarying) -> @builtin(frag_depth) f32 {
    let ndc = vec2f(in.uv.x * 2.0 - 1.0, (1.0 - in.uv.y * 2.0) * frame.y_sign);
    var kind = KIND_SKY;
    if OPEN_SKY {
        kind = select(KIND_SKY, KIND_OPEN_SKY, is_open_sky(view_ray(frame.depth, ndc).direction, frame.pixel_angle));
    }
    if HAS_DEPTH {
        let depth = textureLoad(host_depth, vec2i(in.position.xy), 0).r;
        kind = select(kind, KIND_DRAWN, view_range(frame.depth, depth, ndc) < RANGE_SKY);
    }
    return kind;
}
