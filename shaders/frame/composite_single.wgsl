// The frame's composition over a host's picture with one sample a pixel.
//!include "frame/composite.wgsl"

@group(0) @binding(1) var host_color: texture_2d<f32>;
@group(0) @binding(2) var host_depth: texture_2d<f32>;
@group(0) @binding(3) var host_mask: texture_2d<f32>;

override HAS_DEPTH: bool = true;
override HAS_MASK: bool = false;

@fragment
fn composite(in: FullscreenVarying) -> @location(0) vec4f {
    let pixel = vec2i(in.position.xy);
    let ndc = vec2f(in.uv.x * 2.0 - 1.0, (1.0 - in.uv.y * 2.0) * frame.y_sign);
    var range = RANGE_SKY;
    var plane = RANGE_SKY;
    if HAS_DEPTH {
        let depth = textureLoad(host_depth, pixel, 0).r;
        range = view_range(frame.depth, depth, ndc);
        plane = view_plane(frame.depth, depth, ndc);
    }
    var mask = 0.0;
    if HAS_MASK {
        mask = textureLoad(host_mask, pixel, 0).r;
    }
    return compose(textureLoad(host_color, pixel, 0), range, plane, mask, ndc, vec2u(pixel));
}
