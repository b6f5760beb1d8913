// The gauge over a host's picture. In a picture with several samples a pixel, the first sample stands for the pixel.
//!include "frame/host_picture.wgsl"
//!include "plan/gauge.wgsl"

@fragment
fn gauge(in: FullscreenVarying) -> @location(0) vec4u {
    let size = vec2f(textureDimensions(host_color));
    let place = floor(in.uv * size);
    let pixel = vec2i(place);
    let uv = (place + 0.5) / size;
    let ndc = frame_ndc(uv);
    var p = Looked(textureLoad(host_color, pixel, 0).rgb, RANGE_SKY, RANGE_SKY, ndc, 0.0, sky_sample_in(pixel, RANGE_SKY));
    if HAS_DEPTH {
        let depth = textureLoad(host_depth, pixel, 0).r;
        p.range = view_range(frame.depth, depth, ndc);
        p.plane = view_plane(frame.depth, depth, ndc);
    }
    p.sky = sky_sample_in(pixel, p.range);
    if HAS_MASK {
        p.mask = textureLoad(host_mask, pixel, 0).r;
    }
    return gauged(p);
}
