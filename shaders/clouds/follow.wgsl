// Computes the movement of each square of pixels since the last frame, and the range to which the last picture is
// clamped there.
//!include "common/fullscreen.wgsl"
//!include "clouds/picture.wgsl"
//!include "common/frame.wgsl"

// Pixels that this frame marches, and reprojection.
@group(0) @binding(1) var<uniform> picture: CloudsPicture;
// Radiance and transmittance of the marched pixels, one for each square.
@group(0) @binding(2) var marched: texture_2d<f32>;
// Logarithms (base 2) of the distances, m, between which the marched pixels have their clouds, each times 1 -
// transmittance (MarchedPixel of march_view.wgsl).
@group(0) @binding(3) var marched_reach: texture_2d<f32>;

// Values for one square of pixels.
struct FollowedSquare {
    // Smallest and largest radiance and transmittance of the squares around this one.
    @location(0) least: vec4f,
    @location(1) most: vec4f,
    // Offset from this square to its position in the last picture, pixels (x, y); LOST if that position is outside the
    // picture. Weight of the marched pixels in place of the last picture (z).
    @location(2) back: vec4f,
}

// Deviation from a plane through neighbouring squares, as a share of the range of their values, up to which a picture
// counts as smooth.
const SMOOTH: f32 = 0.03;
// Deviation at which a picture counts as fully structured.
const SHAPED: f32 = 0.1;

// Degree, 0 to 1, to which luminance (x) and transmittance (y) have no structure finer than these squares. Where it is
// 1, a picture interpolated between squares is complete.
fn smoothness(center: vec2f, near: array<vec2f, 4>, rounding: vec2f) -> f32 {
    let mean = 0.2 * (center + near[0] + near[1] + near[2] + near[3]);
    let range = max(max(near[0], near[1]), max(near[2], near[3])) - min(min(near[0], near[1]), min(near[2], near[3]));
    let diagonals = 0.25 * (near[0] - near[1] - near[2] + near[3]);
    let off = abs(center - mean);
    let left = max(off, 0.25 * off + abs(diagonals));
    let each = 1.0 - smoothstep(vec2f(SMOOTH), vec2f(SHAPED), left / max(range + rounding, vec2f(1e-6)));
    return min(each.x, each.y);
}

// Luminance and transmittance of a texel.
fn light_and_open(seen: vec4f) -> vec2f {
    return vec2f(dot(seen.rgb, vec3f(1.0 / 3.0)), seen.a);
}

@fragment
// Reprojects one square as if all its cloud lay at the cloud's mean distance.
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
        // At rest nothing is clamped, and nothing is blurred.
        out.most = vec4f(65504.0);
        return out;
    }
    let size = vec2i(textureDimensions(marched)) - 1;
    // At an edge of the picture the 3 x 3 squares are moved inward, so that all of them exist.
    let about = clamp(vec2i(square), min(vec2i(1), size), max(size - 1, vec2i(0)));
    let center = textureLoad(marched, about, 0);
    var least = min(own, center);
    var most = max(own, center);
    var near: array<vec2f, 4>;
    for (var k = 0u; k < 4u; k++) {
        let to = vec2i(select(-1, 1, (k & 1u) == 1u), select(-1, 1, (k & 2u) == 2u));
        let seen = textureLoad(marched, clamp(about + to, vec2i(0), size), 0);
        least = min(least, seen);
        most = max(most, seen);
        near[k] = light_and_open(seen);
    }
    let rounding = vec2f(2e-3 * light_and_open(most).x, 0.02);
    return FollowedSquare(least, most, vec4f(back, smoothness(light_and_open(center), near, rounding), 0.0));
}
