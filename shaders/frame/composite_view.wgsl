// The frame's composition over a host's picture; where its depth alone has several samples a pixel, the first stands for them.
//!include "common/host.wgsl"
//!include "frame/composite.wgsl"

@group(0) @binding(1) var host_color: HostColor;
@group(0) @binding(2) var host_depth: HostDepth;
@group(0) @binding(3) var host_mask: texture_2d<f32>;

override HAS_DEPTH: bool = true;
override HAS_MASK: bool = false;

// Depths of the pixels to the left, right, above and below; the pixel's own beyond the picture's edge.
fn depth_around(pixel: vec2i, sample: i32) -> vec4f {
    let low = max(pixel - 1, vec2i(0));
    let high = min(pixel + 1, vec2i(textureDimensions(host_depth)) - 1);
    return vec4f(
        textureLoad(host_depth, vec2i(low.x, pixel.y), sample).r,
        textureLoad(host_depth, vec2i(high.x, pixel.y), sample).r,
        textureLoad(host_depth, vec2i(pixel.x, low.y), sample).r,
        textureLoad(host_depth, vec2i(pixel.x, high.y), sample).r,
    );
}

// The pixel of `in`, or one sample of it.
fn composed(in: FullscreenVarying, sample: i32) -> vec4f {
    let pixel = vec2i(in.position.xy);
    let ndc = vec2f(in.uv.x * 2.0 - 1.0, (1.0 - in.uv.y * 2.0) * frame.y_sign);
    var range = RANGE_SKY;
    var plane = RANGE_SKY;
    var facing = Facing(vec3f(0.0), 0.0, UNKNOWN_FACING);
    if HAS_DEPTH {
        let depth = textureLoad(host_depth, pixel, sample).r;
        range = view_range(frame.depth, depth, ndc);
        plane = view_plane(frame.depth, depth, ndc);
        if SURFACE {
            facing = surface_facing(ground, frame.depth, depth, depth_around(pixel, sample), ndc);
        }
    }
    var mask = 0.0;
    if HAS_MASK {
        mask = textureLoad(host_mask, pixel, 0).r;
    }
    return compose(textureLoad(host_color, pixel, sample), range, plane, facing, mask, ndc, vec2u(pixel));
}

@fragment
fn composite(in: FullscreenVarying) -> @location(0) vec4f {
    return composed(in, 0);
}
