// A ray through the layers of cloud: what they send to the eye, what they let through, and how far away they are.
//!include "between/air.wgsl"
//!include "clouds/about.wgsl"

// Most steps through one layer; depth of a step in cloud, scaled, at most; distance from which on steps grow with it.
override CLOUD_STEPS: u32 = 96u;
override CLOUD_STEP_DEPTH: f32 = 0.5;
override CLOUD_STEP_ANGLE: f32 = 0.004;
// What is let through at which a ray ends.
override CLOUD_LEAST: f32 = 0.01;

struct CloudSeen {
    // cd/m^2 over exposure; of what is behind, with what clouds scatter straight on.
    light: vec3f,
    transmittance: f32,
    // Mean distance of what is seen of them, m.
    distance: f32,
}

// Distances at which a ray from the camera crosses a sphere `height` above the planet's ground, in order; both the same where it does not.
fn cloud_crossings(direction: vec3f, height: f32) -> vec2f {
    let r = clouds.radius + clouds.altitude;
    let rise = height - clouds.altitude;
    // t^2 + 2 r mu t = rise (2 r + rise), solved without the difference of squares of large numbers.
    let b = r * direction.z;
    let c = rise * (2.0 * r + rise);
    let root = b * b + c;
    if root <= 0.0 {
        return vec2f(-b);
    }
    let q = -(b + select(-1.0, 1.0, b >= 0.0) * sqrt(root));
    let one = q;
    let other = -c / select(q, 1e-3, abs(q) < 1e-3);
    return vec2f(min(one, other), max(one, other));
}

struct CloudMarch {
    light: vec3f,
    transmittance: f32,
    distance: f32,
}

// One layer between two distances along a ray.
fn cloud_layer_along(layer: CloudLayer, direction: vec3f, first: f32, last: f32, seen: CloudMarch, jitter: f32) -> CloudMarch {
    var out = seen;
    let thickness = 1.0 / layer.size.y;
    let scaled = layer.medium.y;
    let fine = clamp(CLOUD_STEP_DEPTH / (layer.size.w * scaled), thickness / 64.0, thickness / 12.0);
    var gone = first;
    for (var i = 0u; i < CLOUD_STEPS && gone < last && out.transmittance > CLOUD_LEAST; i++) {
        let step = min(max(fine, CLOUD_STEP_ANGLE * gone), last - gone);
        let t = gone + jitter * step;
        let at = cloud_place(layer, direction, t);
        let here = cloud_here(layer, at);
        if here.gap > 0.0 {
            gone += max(step, cloud_skip(layer, here.gap, direction));
            continue;
        }
        let extinction = here.extinction * scaled;
        if extinction > 0.0 {
            let depths = cloud_depths(layer, at, here.excess);
            let s = cloud_scattered(layer.medium.x, depths, -direction, -log(out.transmittance));
            let light = layer.sun.rgb * s.sun + layer.above.rgb * s.sky + layer.below.rgb * s.ground;
            let left = exp(-extinction * step);
            let share = out.transmittance * (1.0 - left);
            out.light += light * share;
            out.distance += t * share;
            out.transmittance *= left;
        }
        gone += step;
    }
    return out;
}

// All layers up to `range`.
fn clouds_along(direction: vec3f, range: f32, jitter: f32) -> CloudSeen {
    var seen = CloudMarch(vec3f(0.0), 1.0, 0.0);
    let lowest = -(clouds.radius + clouds.altitude) * direction.z;
    let ground = cloud_crossings(direction, 0.0);
    let end = select(range, min(range, ground.x), direction.z < 0.0 && ground.y > ground.x && ground.x > 0.0);
    // On the way down layers come from above, on the way up from below.
    for (var turn = 0u; turn < 2u; turn++) {
        let falls = turn == 0u;
        if (falls && lowest <= 0.0) || (!falls && lowest > end) {
            continue;
        }
        for (var k = 0u; k < clouds.layer_count; k++) {
            let layer = clouds.layers[select(k, clouds.layer_count - 1u - k, falls)];
            let base = cloud_crossings(direction, layer.size.x);
            let top = cloud_crossings(direction, layer.size.x + 1.0 / layer.size.y);
            var first = select(base.y, top.x, falls);
            var last = select(top.y, base.x, falls);
            first = max(first, select(max(lowest, 0.0), 0.0, falls));
            last = min(last, select(end, min(end, max(lowest, 0.0)), falls));
            if last <= first || seen.transmittance < CLOUD_LEAST {
                continue;
            }
            seen = cloud_layer_along(layer, direction, first, min(last, first + 60.0e3), seen, jitter);
        }
    }
    let cover = 1.0 - seen.transmittance;
    let distance = select(1e6, seen.distance / max(cover, 1e-6), cover > 1e-4);
    return CloudSeen(seen.light, seen.transmittance, distance);
}

// With the air before them.
fn clouds_seen(direction: vec3f, range: f32, jitter: f32) -> CloudSeen {
    var seen = clouds_along(direction, range, jitter);
    if seen.transmittance < 1.0 {
        let air = air_between(direction, seen.distance);
        seen.light = seen.light * air.transmittance + air.light * frame.exposure * (1.0 - seen.transmittance);
    }
    return seen;
}
