// Marches a ray through the layers of cloud, and computes the radiance, transmittance and distance of the clouds.
//!include "between/air.wgsl"
//!include "clouds/about.wgsl"
//!include "clouds/halo.wgsl"
//!include "clouds/lit.wgsl"

// Factor on the number of steps: multiplies CLOUD_STEPS and divides the limits of a step's length.
override CLOUD_FINENESS: f32 = 1.0;
// Largest number of steps in one layer.
override CLOUD_STEPS: u32 = 96u;
// Largest scaled depth of a step in cloud.
override CLOUD_STEP_DEPTH: f32 = 0.4;
// Largest ratio of a step's length to its distance from the eye.
override CLOUD_STEP_ANGLE: f32 = 0.0035;
// Largest share of a layer's thickness by which a step goes up or down.
const CLOUD_STEP_RISE: f32 = 0.08;
// Scaled depth above which the light of a step is computed at its mean visible place, not half-way.
const CLOUD_THICK_STEP: f32 = 0.7;
// Transmittance at which a ray ends.
override CLOUD_LEAST: f32 = 0.01;

// Clouds along a ray.
struct CloudSeen {
    // Radiance, cd/m^2 times exposure.
    light: vec3f,
    // Transmittance of the clouds, 0 to 1. Light scattered into the narrow forward peak counts as transmitted.
    transmittance: f32,
    // Distances between which the visible cloud is nearly evenly spread, m.
    reach: vec2f,
}

// Distances at which a ray crosses a sphere `height` above the planet's ground, in order. Both are the same if the ray
// does not cross the sphere.
fn cloud_crossings(direction: vec3f, height: f32) -> vec2f {
    let r = clouds.radius + cloud_eye();
    let rise = height - cloud_eye();
    // t^2 + 2 r mu t = rise (2 r + rise), solved without differences between squares of large numbers.
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

// State of a march: what the ray has gathered so far.
struct CloudMarch {
    // Radiance so far, cd/m^2 times exposure.
    light: vec3f,
    // Transmittance so far.
    transmittance: f32,
    // Sums of the distance, m, and of its square, km^2, each times lost transmittance.
    distance: vec2f,
}

// Position of the mean visible place in a step of this scaled depth, as a share of the step. The extinction is even in
// the step, or with `at_face` rises linearly from the cloud's face at the start of the step (within 4 % of the
// integral).
fn cloud_seen_at(depth: f32, at_face: bool) -> f32 {
    let left = exp(-depth);
    return select(1.0 / depth - left / (1.0 - left), 0.667 / sqrt(sqrt(1.0 + 0.32 * depth * depth)), at_face);
}

// Width of a pixel's filter, pixels. With 1 the map's texels still show as rings.
const PIXEL_BLUR: f32 = 1.4;

// Angle of a pixel, rad.
var<private> cloud_pixel: f32 = 0.0;

// Width of a pixel on a layer, m: the geometric mean of the widths across and along the ray. The width along the ray is
// reduced by the thickness of the layer.
fn cloud_pixel_width(layer: CloudLayer, t: f32, rise: f32) -> f32 {
    let across = PIXEL_BLUR * cloud_pixel * t / CLOUD_FINENESS;
    let along = max(across, (across - 1.0 / layer.size.y) / max(rise, 0.05));
    return sqrt(across * along);
}

// Splits the transmittance of a ray into the part in gaps (x) and the part in cloud (y). `open` is that split at the
// previous place, where the share of cloud was shares.x. At this place, `cells` distances from cloud to cloud farther
// on, the share of cloud is shares.y. On a steep path cloud stands over cloud; on a level path the ray meets new
// clouds.
fn cloud_open(open: vec2f, shares: vec2f, cells: f32) -> vec2f {
    let grown = open.x * (shares.y - shares.x) / max(1.0 - shares.x, 1e-6);
    let shrunk = open.y * (shares.y / max(shares.x, 1e-6) - 1.0);
    let stacked = open.y + select(shrunk, grown, shares.y > shares.x);
    let all = open.x + open.y;
    // Limited to the total: rounding above it would make the part in gaps negative.
    let cloudy = clamp(mix(shares.y * all, stacked, exp(-cells / CLOUD_CELL)), 0.0, all);
    return vec2f(all - cloudy, cloudy);
}

// Purpose of the look-up of a ray's next place: to find cloud.
const CLOUD_SEEKS: u32 = 0u;
// Purpose of a look-up: to begin the first step at the face of a cloud that was found.
const CLOUD_AT_FACE: u32 = 1u;
// Purpose of a look-up: to compute the light of a thick step at its mean visible place.
const CLOUD_WITHIN: u32 = 2u;
// No look-up: the step needs no other place.
const CLOUD_FOUND: u32 = 3u;

// State of a step along a ray.
struct CloudStep {
    // Purpose of the next look-up: CLOUD_SEEKS and the constants after it.
    looks_for: u32,
    // Distance from the camera at which the step begins, m.
    begun: f32,
    // Distance of the place whose extinction holds for the whole step, m.
    at: f32,
    // Distance of the next place to look up, m.
    next: f32,
    // Length of the step, m.
    length: f32,
    // Whether the step begins at the face of a cloud.
    at_face: bool,
    // Place at which the light of the step is computed.
    place: CloudPlace,
    // Cloud at that place.
    here: CloudHere,
}

// Scaled depth of a step.
fn cloud_step_depth(layer: CloudLayer, step: CloudStep) -> f32 {
    return step.here.extinction * layer.medium.y * step.length;
}

// Returns the step after the place at `next` was looked up, once cloud was found there or before. `clear.x` is the
// distance of the last place without cloud since the last cloud; `clear.y` is the amount by which the excess there fell
// short of cloud, or 0.
fn cloud_looked(before: CloudStep, layer: CloudLayer, place: CloudPlace, here: CloudHere, clear: vec2f, jitter: f32) -> CloudStep {
    var step = before;
    if before.looks_for == CLOUD_WITHIN {
        step.place = place;
        step.here.excess = here.excess;
        step.looks_for = CLOUD_FOUND;
    } else {
        // Steps begin at the face of a cloud that a ray enters. Otherwise faces would show where steps begin.
        let face = clear.x + (before.at - clear.x) * clear.y / max(clear.y + cloud_inside(here), 1e-6);
        let at_face = before.looks_for == CLOUD_AT_FACE;
        if here.extinction > 0.0 {
            step.place = place;
            step.here = here;
            step.at = before.next;
            step.begun = select(before.begun, before.next - jitter * before.length, at_face);
            step.at_face = at_face;
        }
        let depth = cloud_step_depth(layer, step);
        step.looks_for = select(CLOUD_FOUND, CLOUD_WITHIN, depth > CLOUD_THICK_STEP);
        step.next = step.begun + cloud_seen_at(depth, step.at_face) * step.length;
        if !at_face && clear.y > 0.0 && face > 0.0 {
            step.looks_for = CLOUD_AT_FACE;
            step.next = face + jitter * before.length;
        }
    }
    return step;
}

// Marches one layer between two distances along a ray.
fn cloud_layer_along(layer: CloudLayer, direction: vec3f, first: f32, last: f32, seen: CloudMarch, jitter: f32) -> CloudMarch {
    var out = seen;
    let thickness = 1.0 / layer.size.y;
    let fine = clamp(CLOUD_STEP_DEPTH / (layer.size.w * layer.medium.y), thickness / 96.0, thickness / 16.0) / CLOUD_FINENESS;
    let rise = abs(direction.z + first / (clouds.radius + cloud_eye()));
    let coarse = max(fine, CLOUD_STEP_RISE * thickness / (CLOUD_FINENESS * max(rise, 1e-6)));
    let most = u32(f32(CLOUD_STEPS) * CLOUD_FINENESS);
    let halo = cloud_halo(layer.medium.x, direction);
    var gone = first;
    var tried = 0u;
    // Distance of the last place without cloud since the last cloud (x), and the excess that was missing for cloud
    // there, or 0 (y).
    var clear = vec2f(first, 0.0);
    // Transmittance of the ray, split into gaps and cloud where clouds are blurred (cloud_open), and the share of cloud
    // at the last place.
    var open = vec2f(out.transmittance, 0.0);
    var cloudy_share = 0.0;
    while out.transmittance > CLOUD_LEAST {
        // Goes on to the next step with cloud. All rays of a GPU's wave look up a place at the same time, each for its
        // own purpose, and compute light only for steps with cloud.
        var step: CloudStep;
        while step.looks_for != CLOUD_FOUND && (step.looks_for != CLOUD_SEEKS || (tried < most && gone < last)) {
            if step.looks_for == CLOUD_SEEKS {
                step.begun = gone;
                // The less of a step is visible, the longer the step: its length is multiplied by the transmittance to
                // the power -1/4, chosen from a chart (docs/lab/clouds.csv).
                let grown = select(inverseSqrt(sqrt(out.transmittance)), 1.0, clear.y > 0.0);
                step.length = min(clamp(CLOUD_STEP_ANGLE / CLOUD_FINENESS * gone, fine, coarse) * grown, last - gone);
                step.at = gone + jitter * step.length;
                step.next = step.at;
                if CLOUD_COARSE {
                    cloud_blur = cloud_blur_over(layer, cloud_pixel_width(layer, step.at, rise));
                }
                tried++;
            }
            let place = cloud_place(layer, direction, step.next);
            var here = cloud_here(layer, place);
            here.extinction *= cloud_fades(step.at - first);
            if step.looks_for == CLOUD_SEEKS && here.extinction <= 0.0 {
                clear = vec2f(step.at, -cloud_inside(here));
                open = vec2f(open.x + open.y, 0.0);
                cloudy_share = 0.0;
                gone += max(step.length, cloud_skip(layer, here, place.height, direction));
            } else {
                step = cloud_looked(step, layer, place, here, clear, jitter);
            }
        }
        if step.looks_for != CLOUD_FOUND {
            break;
        }
        clear.y = 0.0;
        gone = step.begun + step.length;
        open = cloud_open(open, vec2f(cloudy_share, step.here.share), length(direction.xy) * step.length * layer.size.z);
        cloudy_share = step.here.share;
        let stretch = CloudStretch(direction, step.begun, step.length, step.at, -log(max(open.y, 1e-9) / max(cloudy_share, 1e-6)));
        let share = open.y * (1.0 - exp(-cloud_step_depth(layer, step)));
        out.light += cloud_lit(layer, step.place, step.here, stretch, halo) * share;
        out.distance += vec2f(step.at, step.at * step.at * 1e-6) * share;
        open.y -= share;
        out.transmittance = open.x + open.y;
    }
    return out;
}

// Blends the states before and after a layer of which only the share `share` is drawn as a volume. The rest is drawn as
// a deck.
fn cloud_part(before: CloudMarch, after: CloudMarch, share: f32) -> CloudMarch {
    return CloudMarch(
        mix(before.light, after.light, share),
        mix(before.transmittance, after.transmittance, share),
        mix(before.distance, after.distance, share),
    );
}

// Marches all layers up to `range`.
fn clouds_along(direction: vec3f, range: f32, jitter: f32) -> CloudSeen {
    var seen = CloudMarch(vec3f(0.0), 1.0, vec2f(0.0));
    let lowest = -(clouds.radius + cloud_eye()) * direction.z;
    let ground = cloud_crossings(direction, 0.0);
    let end = select(range, min(range, ground.x), direction.z < 0.0 && ground.y > ground.x && ground.x > 0.0);
    // On the way down layers come from above, on the way up from below.
    let turns = select(2u, 1u, lowest > end);
    for (var turn = select(0u, 1u, lowest <= 0.0); turn < turns; turn++) {
        let falls = turn == 0u;
        for (var k = 0u; k < cloud_layers(); k++) {
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
            let behind = cloud_layer_along(layer, direction, first, min(last, first + CLOUD_FARTHEST), seen, jitter);
            seen = cloud_part(seen, behind, layer.medium.z);
        }
    }
    let cover = max(1.0 - seen.transmittance, 1e-6);
    let middle = seen.distance.x / cover;
    // An even distribution reaches sqrt(3) standard deviations to either side.
    let half = 1e3 * sqrt(3.0 * max(seen.distance.y / cover - middle * middle * 1e-6, 0.0));
    return CloudSeen(seen.light, seen.transmittance, max(middle + vec2f(-half, half), vec2f(1.0)));
}

// Mean distance of the visible cloud, m.
fn cloud_middle(seen: CloudSeen) -> f32 {
    return 0.5 * (seen.reach.x + seen.reach.y);
}

// Applies the air in front of the clouds to their radiance.
fn clouds_behind(air: Veil, seen: CloudSeen) -> CloudSeen {
    let light = seen.light * air.transmittance + air.light * frame.exposure * (1.0 - seen.transmittance);
    return CloudSeen(light, seen.transmittance, seen.reach);
}
