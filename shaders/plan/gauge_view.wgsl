// The gauge over a host's picture; where that has several samples a pixel, the first stands for them.
//!include "common/host.wgsl"
//!include "plan/gauge.wgsl"

@group(0) @binding(1) var host_color: HostColor;
@group(0) @binding(2) var host_depth: HostDepth;
@group(0) @binding(3) var host_mask: texture_2d<f32>;

override HAS_DEPTH: bool = true;
override HAS_MASK: bool = false;

@fragment
fn gauge(in: FullscreenVarying) -> @location(0) vec4u {
    let size = vec2f(textureDimensions(host_color));
    let place = floor(in.uv * size);
    let pixel = vec2i(place);
    let uv = (place + 0.5) / size;
    let ndc = vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * frame.y_sign);
    behind_pixel = pixel;
    var p = Looked(textureLoad(host_color, pixel, 0).rgb, RANGE_SKY, RANGE_SKY, ndc, 0.0);
    if HAS_DEPTH {
        let depth = textureLoad(host_depth, pixel, 0).r;
        p.range = view_range(frame.depth, depth, ndc);
        p.plane = view_plane(frame.depth, depth, ndc);
    }
    if HAS_MASK {
        p.mask = textureLoad(host_mask, pixel, 0).r;
    }
    return gauged(p);
}
