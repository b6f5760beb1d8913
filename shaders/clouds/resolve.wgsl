// The clouds of a whole picture, from the pixels that were marched in this frame and from the last frame's picture, seen anew.
//!include "common/fullscreen.wgsl"
//!include "clouds/picture.wgsl"
//!include "common/frame.wgsl"

@group(0) @binding(1) var<uniform> picture: CloudsPicture;
@group(0) @binding(2) var marched: texture_2d<f32>;
@group(0) @binding(3) var marched_distance: texture_2d<f32>;
@group(0) @binding(4) var last: texture_2d<f32>;
@group(0) @binding(5) var last_sampler: sampler;

// Between the marched pixels.
fn spread(pixel: vec2u) -> vec4f {
    let within = vec2f(f32(picture.place % picture.side), f32(picture.place / picture.side));
    let at = (vec2f(pixel) - within) / f32(picture.side);
    let low = floor(at);
    let f = at - low;
    let most = vec2i(textureDimensions(marched)) - 1;
    let a = clamp(vec2i(low), vec2i(0), most);
    let b = clamp(vec2i(low) + 1, vec2i(0), most);
    let top = mix(textureLoad(marched, a, 0), textureLoad(marched, vec2i(b.x, a.y), 0), f.x);
    let bottom = mix(textureLoad(marched, vec2i(a.x, b.y), 0), textureLoad(marched, b, 0), f.x);
    return mix(top, bottom, f.y);
}

@fragment
fn resolve(in: FullscreenVarying) -> @location(0) vec4f {
    let pixel = vec2u(in.position.xy);
    let square = min(pixel / picture.side, textureDimensions(marched) - 1u);
    let own = textureLoad(marched, square, 0);
    if all(marched_pixel(picture, square) == pixel) {
        return own;
    }
    let now = spread(pixel);
    if picture.exposed == 0.0 {
        return now;
    }
    let ndc = pixel_ndc(picture, pixel, frame.y_sign);
    let ray = view_ray(frame.depth, ndc);
    let distance = exp2(textureLoad(marched_distance, square, 0).r);
    let before = picture.before * vec4f(ray.direction * distance - picture.moved, 1.0);
    let was = before.xy / max(before.w, 1e-6);
    let uv = vec2f(0.5 + 0.5 * was.x, 0.5 - 0.5 * was.y * frame.y_sign);
    if before.w <= 0.0 || any(uv < vec2f(0.0)) || any(uv > vec2f(1.0)) {
        return now;
    }
    let here = (vec2f(pixel) + 0.5) / vec2f(picture.size);
    let off = length((uv - here) * vec2f(picture.size));
    if off < 0.02 {
        // At rest nothing is blurred.
        let kept = textureLoad(last, pixel, 0);
        return vec4f(kept.rgb * picture.exposed, kept.a);
    }
    let kept = textureSampleLevel(last, last_sampler, uv, 0.0);
    var least = own;
    var most = own;
    let size = vec2i(textureDimensions(marched)) - 1;
    for (var k = 0u; k < 4u; k++) {
        let to = vec2i(select(-1, 1, (k & 1u) == 1u), select(-1, 1, (k & 2u) == 2u));
        let near = textureLoad(marched, clamp(vec2i(square) + to, vec2i(0), size), 0);
        least = min(least, near);
        most = max(most, near);
    }
    return clamp(vec4f(kept.rgb * picture.exposed, kept.a), least, most);
}
