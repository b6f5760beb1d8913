// Of each square of pixels: how far it has come since the last frame, and between what its picture of then is held.
//!include "common/fullscreen.wgsl"
//!include "clouds/picture.wgsl"
//!include "common/frame.wgsl"

@group(0) @binding(1) var<uniform> picture: CloudsPicture;
@group(0) @binding(2) var marched: texture_2d<f32>;
@group(0) @binding(3) var marched_reach: texture_2d<f32>;

struct FollowedSquare {
    @location(0) least: vec4f,
    @location(1) most: vec4f,
    // To where it was, in pixels; LOST where that was not in the picture.
    @location(2) back: vec4f,
}

@fragment
fn follow(in: FullscreenVarying) -> FollowedSquare {
    let square = vec2u(in.position.xy);
    let own = textureLoad(marched, vec2i(square), 0);
    let cover = 1.0 - own.a;
    let reach = textureLoad(marched_reach, vec2i(square), 0).rg / max(cover, 1e-4);
    let distance = select(1e6, exp2(0.5 * (reach.x + reach.y)), cover > 1e-4);
    let middle = min(square * picture.side + (picture.side >> 1u), picture.size - 1u);
    let ndc = pixel_ndc(picture, middle, frame.y_sign);
    let ray = view_ray(frame.depth, ndc);
    let was = picture.before * vec4f(ray.origin + ray.direction * distance - picture.moved, 1.0);
    let moved = (was.xy / max(was.w, 1e-6) - ndc) * vec2f(0.5, -0.5 * frame.y_sign);
    let back = moved * vec2f(picture.size);
    var out: FollowedSquare;
    if was.w <= 0.0 || any(abs(moved) > vec2f(1.0)) {
        out.back = vec4f(LOST);
        return out;
    }
    if length(back) < 0.02 {
        // At rest nothing is held, and nothing is blurred.
        out.most = vec4f(65504.0);
        return out;
    }
    var least = own;
    var most = own;
    let size = vec2i(textureDimensions(marched)) - 1;
    for (var k = 0u; k < 4u; k++) {
        let to = vec2i(select(-1, 1, (k & 1u) == 1u), select(-1, 1, (k & 2u) == 2u));
        let near = textureLoad(marched, clamp(vec2i(square) + to, vec2i(0), size), 0);
        least = min(least, near);
        most = max(most, near);
    }
    return FollowedSquare(least, most, vec4f(back, 0.0, 0.0));
}
