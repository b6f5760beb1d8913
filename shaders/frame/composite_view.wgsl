// Composition over a host's picture. If only its depth has several samples per pixel, the first sample is used.
//!include "frame/host_picture.wgsl"
//!include "frame/composite.wgsl"

// Composes the pixel of `in`, or one sample of it.
fn composed(in: FullscreenVarying, sample: i32) -> vec4f {
    let pixel = vec2i(in.position.xy);
    let ndc = frame_ndc(in.uv);
    var seen = Seen(pixel, sample, ndc, 0.0, RANGE_SKY, RANGE_SKY, 0.0);
    if HAS_DEPTH {
        seen.depth = textureLoad(host_depth, pixel, sample).r;
        seen.range = view_range(frame.depth, seen.depth, ndc);
        seen.plane = view_plane(frame.depth, seen.depth, ndc);
    }
    if HAS_MASK {
        seen.mask = textureLoad(host_mask, pixel, 0).r;
    }
    return compose(textureLoad(host_color, pixel, sample), seen);
}

@fragment
fn composite(in: FullscreenVarying) -> @location(0) vec4f {
    return composed(in, 0);
}
