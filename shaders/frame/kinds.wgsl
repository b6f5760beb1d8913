// Which of the composition's draws a pixel belongs to, as a depth (src/frame/kinds.rs).
//!include "common/host.wgsl"
//!include "common/fullscreen.wgsl"
//!include "common/frame.wgsl"

@group(0) @binding(2) var host_depth: HostDepth;

override HAS_DEPTH: bool = true;

const KIND_FAR: f32 = 0.0;
const KIND_DRAWN: f32 = 1.0;

@fragment
fn kinds(in: FullscreenVarying) -> @builtin(frag_depth) f32 {
    if !HAS_DEPTH {
        return KIND_FAR;
    }
    let ndc = vec2f(in.uv.x * 2.0 - 1.0, (1.0 - in.uv.y * 2.0) * frame.y_sign);
    let depth = textureLoad(host_depth, vec2i(in.position.xy), 0).r;
    return select(KIND_FAR, KIND_DRAWN, view_range(frame.depth, depth, ndc) < RANGE_SKY);
}
