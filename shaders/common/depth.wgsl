// Converts a depth sample and a pixel to a ray and a distance along it. src/scene/depth.rs has the f64 reference and
// the derivation, and computes the constants in f64.

// Range of a pixel in which nothing was drawn, m.
const RANGE_SKY: f32 = 1e12;

// Kinds of depth that a pipeline must read, one bit each: 1 perspective, 2 parallel rays, 4 logarithmic. The constant
// helps software drivers, which execute the code of all kinds in the shader.
override DEPTH_KINDS: u32 = 7u;

// Rays of a camera and the inverse of its depth buffer's mapping (ViewRays in src/scene/depth.rs).
struct DepthUniform {
    // Ray origin at the picture's centre and its change per unit of ndc, in camera-relative world axes, m.
    origin: vec3f,
    // e = turn_offset + turn_scale * depth is 0 at the far end (for logarithmic depth, at the near end).
    turn_offset: f32,
    origin_dx: vec3f,
    turn_scale: f32,
    origin_dy: vec3f,
    // 0 perspective, 1 parallel rays, 2 logarithmic.
    kind: u32,
    // Unnormalised ray direction at the picture's centre and its change per unit of ndc. Clip w is the distance along
    // the ray, in units of this vector's length.
    direction: vec3f,
    // Distance from the camera's plane per unit of clip w, m.
    plane_scale: f32,
    direction_dx: vec3f,
    // ln(c far + 1), for logarithmic depth.
    log_far: f32,
    direction_dy: vec3f,
    // 1/c, m, for logarithmic depth.
    inverse_c: f32,
    // The pole is affine in ndc: perspective w = scale / (e - pole), parallel t = (e - pole) * scale.
    pole: vec3f,
    scale: f32,
}

struct ViewRay {
    origin: vec3f,
    // Unit vector.
    direction: vec3f,
    // Metres along the ray per unit of clip w.
    slant: f32,
}

// Origin of a pixel's ray, camera-relative, m.
fn view_origin(u: DepthUniform, ndc: vec2f) -> vec3f {
    if (DEPTH_KINDS & 2u) == 0u {
        return u.origin;
    }
    return u.origin + ndc.x * u.origin_dx + ndc.y * u.origin_dy;
}

// Step along the ray per unit of view_depth.
fn view_step(u: DepthUniform, ndc: vec2f) -> vec3f {
    return u.direction + ndc.x * u.direction_dx + ndc.y * u.direction_dy;
}

// Ray of a pixel.
fn view_ray(u: DepthUniform, ndc: vec2f) -> ViewRay {
    let step = view_step(u, ndc);
    let slant = length(step);
    return ViewRay(view_origin(u, ndc), step / slant, slant);
}

// e^x - 1 for x >= 0, without cancellation at small x.
fn depth_expm1(x: f32) -> f32 {
    let series = x * (1.0 + x * (0.5 + x * (0.16666667 + x * (0.041666667 + x * 0.008333333))));
    return select(exp(x) - 1.0, series, x < 0.125);
}

fn depth_is_nan(x: f32) -> bool {
    // Compilers may assume that there is no NaN and fold x != x; a test of the bits is safe from that.
    return (bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u;
}

// Clip w of a depth sample, or metres along the ray for parallel rays. RANGE_SKY at the far end, beyond it, and for
// NaN.
fn view_depth(u: DepthUniform, depth: f32, ndc: vec2f) -> f32 {
    let turned = u.turn_offset + u.turn_scale * depth;
    let pole = u.pole.x + ndc.x * u.pole.y + ndc.y * u.pole.z;
    let far = select(turned <= 0.0, turned >= 1.0, u.kind == 2u);
    if depth_is_nan(depth) || far || (u.kind == 0u && turned <= pole) {
        return RANGE_SKY;
    }
    let e = clamp(turned, 0.0, 1.0);
    var w = u.scale / (e - pole);
    if (DEPTH_KINDS & 2u) != 0u && u.kind == 1u {
        w = (e - pole) * u.scale;
    }
    if (DEPTH_KINDS & 4u) != 0u && u.kind == 2u {
        w = depth_expm1(e * u.log_far) * u.inverse_c;
    }
    return clamp(w, 0.0, RANGE_SKY);
}

// Depth of an object in the unit of view_depth (x), and metres along its ray per unit of that depth (y). `distance` is
// the object's distance from the eye, m. The object is moved `nearer` metres towards the eye.
fn depth_of(u: DepthUniform, clip_w: f32, distance: f32, nearer: f32) -> vec2f {
    let slant = distance / max(clip_w, 0.05 * distance);
    let parallel = (DEPTH_KINDS & 2u) != 0u && u.kind == 1u;
    return select(vec2f(clip_w - nearer / slant, slant), vec2f(distance - nearer, 1.0), parallel);
}

// Share of an object that the host's picture leaves visible at a pixel: 0 if the object is 1/8 m or more behind the
// shown surface.
fn share_before(shown: f32, depth: vec2f) -> f32 {
    return clamp((shown - depth.x) * (4.0 * depth.y) + 0.5, 0.0, 1.0);
}

// ln(1 + x) for x >= 0, without cancellation at small x.
fn depth_ln_1p(x: f32) -> f32 {
    let series = x * (1.0 - x * (0.5 - x * (0.33333333 - x * (0.25 - x * (0.2 - x * 0.16666667)))));
    return select(log(1.0 + x), series, x < 0.125);
}

// Value in a logarithmic depth buffer for clip w: the inverse of view_depth, for the fragment shaders of opaque
// objects. Other kinds of depth follow from the projection. The f64 reference is ViewRays::depth_at.
fn written_depth(u: DepthUniform, w: f32) -> f32 {
    let e = depth_ln_1p(max(w, 0.0) / u.inverse_c) / u.log_far;
    return clamp((e - u.turn_offset) / u.turn_scale, 0.0, 1.0);
}

// Position at a depth in the unit of view_depth, camera-relative, m.
fn view_point(u: DepthUniform, depth: f32, ndc: vec2f) -> vec3f {
    return view_origin(u, ndc) + view_step(u, ndc) * depth;
}

// Distance along the pixel's ray to the surface of a depth sample, m; RANGE_SKY without a surface.
fn view_range(u: DepthUniform, depth: f32, ndc: vec2f) -> f32 {
    return min(view_depth(u, depth, ndc) * view_ray(u, ndc).slant, RANGE_SKY);
}

// Distance from the camera's plane to the surface of a depth sample, m; RANGE_SKY without a surface.
fn view_plane(u: DepthUniform, depth: f32, ndc: vec2f) -> f32 {
    return min(view_depth(u, depth, ndc) * u.plane_scale, RANGE_SKY);
}
