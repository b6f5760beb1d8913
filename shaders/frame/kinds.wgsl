// Which of the composition's draws a pixel belongs to, as a depth (src/frame/kinds.rs).
//!include "common/host.wgsl"
//!include "common/fullscreen.wgsl"
//!include "common/frame.wgsl"

@group(0) @binding(2) var host_depth: HostDepth;

override HAS_DEPTH: bool = true;

const KIND_ABOVE: f32 = 0.0;
const KIND_BELOW: f32 = 0.5;
const KIND_DRAWN: f32 = 1.0;

@fragment
fn kinds(in: FullscreenVarying) -> @builtin(frag_depth) f32 {
    let ndc = vec2f(in.uv.x * 2.0 - 1.0, (1.0 - in.uv.y * 2.0) * frame.y_sign);
    let far = select(KIND_BELOW, KIND_ABOVE, view_ray(frame.depth, ndc).direction.z >= 0.0);
    if !HAS_DEPTH {
        return far;
    }
    let depth = textureLoad(host_depth, vec2i(in.position.xy), 0).r;
    return select(far, KIND_DRAWN, view_range(frame.depth, depth, ndc) < RANGE_SKY);
}
