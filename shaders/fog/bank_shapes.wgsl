// Shapes of fog banks on flat plans: where a ray enters and leaves a shape, how far a point is from a shape, and the
// weight of a bank's region at a point.
//!include "fog/lookup.wgsl"

// Shapes of banks that the pipeline can draw: bit k is kind k of FogBank.
override BANK_SHAPES: u32 = 15u;

// Value of FogBank.kind for a rectangle with round corners.
const BANK_RECTANGLE: u32 = 0u;
// Value of FogBank.kind for an ellipse.
const BANK_ELLIPSE: u32 = 1u;
// Value of FogBank.kind for a convex polygon. Kind 3 is any other polygon.
const BANK_CONVEX: u32 = 2u;
// Least absolute value of the component of a ray's direction across an edge. box_chord and convex_chord divide by this
// component and replace a smaller one by LEAST_WAY.
const LEAST_WAY: f32 = 1e-7;

// Ray, with its projection onto the plan of a bank; `bank` is the bank's index.
struct BankRay {
    bank: u32,
    // Position of the ray's start, m (east, north) from the camera (`origin`), and how far the ray goes east and north
    // per metre of its length (`direction`).
    origin: vec2f,
    direction: vec2f,
    // Position of the ray's start on the bank's plan, m (right, ahead), and how far the ray goes right and ahead per
    // metre of its length (`way`).
    start: vec2f,
    way: vec2f,
    // Altitude of the ray's start, m, cosine of the ray with the vertical there, and length of the ray, m.
    h0: f32,
    mu: f32,
    t: f32,
}

// Distances along a ray, m, between which it is inside a rectangle. The ray misses the rectangle if the second distance
// is not larger than the first.
fn box_chord(start: vec2f, way: vec2f, half: vec2f) -> vec2f {
    let v = select(way, select(vec2f(-LEAST_WAY), vec2f(LEAST_WAY), way >= vec2f(0.0)), abs(way) < vec2f(LEAST_WAY));
    let a = (-half - start) / v;
    let b = (half - start) / v;
    let first = min(a, b);
    let last = max(a, b);
    return vec2f(max(first.x, first.y), min(last.x, last.y));
}

// Chord of an ellipse with the half axes `half`, in the form of box_chord.
fn ellipse_chord(start: vec2f, way: vec2f, half: vec2f) -> vec2f {
    let e = start / half;
    let v = way / half;
    let a = max(dot(v, v), 1e-20);
    let middle = -dot(e, v) / a;
    let at = e + v * middle;
    let left = 1.0 - dot(at, at);
    let reach = sqrt(max(left, 0.0) / a);
    return select(vec2f(0.0, -1.0), vec2f(middle - reach, middle + reach), left > 0.0);
}

// Chord of a rectangle with round corners, in the form of box_chord. An end of the chord that lies in a corner is moved
// to the corner's circle.
fn rounded_chord(start: vec2f, way: vec2f, half: vec2f, radius: f32) -> vec2f {
    var chord = box_chord(start, way, half);
    if chord.y <= chord.x || radius <= 0.0 {
        return chord;
    }
    let inner = half - radius;
    let ends = chord;
    for (var k = 0u; k < 2u; k++) {
        let p = start + way * select(ends.x, ends.y, k == 1u);
        if all(abs(p) > inner) {
            let middle = select(-inner, inner, p > vec2f(0.0));
            let round = ellipse_chord(start - middle, way, vec2f(max(radius, 1e-3)));
            if round.y <= round.x {
                return vec2f(0.0, -1.0);
            }
            chord = select(vec2f(round.x, chord.y), vec2f(chord.x, round.y), k == 1u);
        }
    }
    return chord;
}

// Corner of a bank's polygon.
fn bank_corner(k: u32, i: u32) -> vec2f {
    let pair = low_air.banks[k].corners[(i >> 1u) & 7u];
    return select(pair.xy, pair.zw, (i & 1u) == 1u);
}

// Chord of a convex polygon whose sides are moved outwards by `grown` metres, in the form of box_chord.
fn convex_chord(ray: BankRay, grown: f32) -> vec2f {
    var chord = vec2f(-1e9, 1e9);
    let count = min(low_air.banks[ray.bank].count, 16u);
    var a = bank_corner(ray.bank, count - 1u);
    for (var i = 0u; i < count; i++) {
        let b = bank_corner(ray.bank, i);
        let outward = normalize(vec2f(b.y - a.y, a.x - b.x));
        let away = dot(outward, ray.start - a) - grown;
        let leaving = dot(outward, ray.way);
        let at = -away / select(leaving, select(-LEAST_WAY, LEAST_WAY, leaving >= 0.0), abs(leaving) < LEAST_WAY);
        chord = select(vec2f(max(chord.x, at), chord.y), vec2f(chord.x, min(chord.y, at)), leaving >= 0.0);
        a = b;
    }
    return chord;
}

// Whether the share of a bank is sampled along its chord, because the bank's polygon is not convex.
fn is_sampled(k: u32) -> bool {
    return (BANK_SHAPES & 8u) != 0u && low_air.banks[k].kind > BANK_CONVEX;
}

// Distances along a ray, m, between which it is inside the bank's shape, grown outwards by `grown` metres: an ellipse
// has half axes longer by `grown`. For a polygon that is not convex, the distances are those of a circle about the
// polygon, grown likewise.
fn bank_chord(ray: BankRay, grown: f32) -> vec2f {
    let half = low_air.banks[ray.bank].half + grown;
    let kind = low_air.banks[ray.bank].kind;
    if (BANK_SHAPES & 2u) != 0u && kind == BANK_ELLIPSE {
        return ellipse_chord(ray.start, ray.way, half);
    }
    if (BANK_SHAPES & 4u) != 0u && kind == BANK_CONVEX {
        return convex_chord(ray, grown);
    }
    if is_sampled(ray.bank) {
        return ellipse_chord(ray.start, ray.way, vec2f(low_air.banks[ray.bank].radius + grown));
    }
    return rounded_chord(ray.start, ray.way, half, low_air.banks[ray.bank].corner + grown);
}

// Signed distance of a point of the plan from an ellipse, m, negative inside. Each of three steps takes the nearest
// point of the ellipse's circle of curvature at the last estimate; the centre of this circle lies on the evolute.
fn ellipse_distance(half: vec2f, p: vec2f) -> f32 {
    let q = abs(p);
    let spread = half.x * half.x - half.y * half.y;
    var t = vec2f(0.70710678);
    for (var i = 0u; i < 3u; i++) {
        let center = vec2f(spread, -spread) * t * t * t / half;
        let bent = length(t * half - center);
        let away = q - center;
        t = clamp((away * (bent / max(length(away), 1e-6)) + center) / half, vec2f(0.0), vec2f(1.0));
        t /= max(length(t), 1e-9);
    }
    let outside = dot(q / half, q / half) > 1.0;
    return select(-1.0, 1.0, outside) * length(q - t * half);
}

// Signed distance of a point of the plan from a bank's polygon, m, negative inside.
fn polygon_distance(k: u32, p: vec2f) -> f32 {
    let count = min(low_air.banks[k].count, 16u);
    var nearest = 1e30;
    var inside = false;
    var a = bank_corner(k, count - 1u);
    for (var i = 0u; i < count; i++) {
        let b = bank_corner(k, i);
        let side = b - a;
        let away = p - a;
        let along = clamp(dot(away, side) / max(dot(side, side), 1e-6), 0.0, 1.0);
        let off = away - side * along;
        nearest = min(nearest, dot(off, off));
        // The point is inside if a line from the point to the right crosses an odd number of sides.
        let crosses = (b.y > p.y) != (a.y > p.y);
        if crosses && p.x < a.x + side.x * (p.y - a.y) / select(side.y, 1.0, side.y == 0.0) {
            inside = !inside;
        }
        a = b;
    }
    return select(1.0, -1.0, inside) * sqrt(nearest);
}

// Signed distance of a point of the plan from a bank's shape, m, negative inside.
fn bank_distance(k: u32, p: vec2f) -> f32 {
    let half = low_air.banks[k].half;
    let kind = low_air.banks[k].kind;
    if (BANK_SHAPES & 2u) != 0u && kind == BANK_ELLIPSE {
        return ellipse_distance(half, p);
    }
    if (BANK_SHAPES & 12u) != 0u && kind >= BANK_CONVEX {
        return polygon_distance(k, p);
    }
    let corner = low_air.banks[k].corner;
    let q = abs(p) - half + corner;
    return length(max(q, vec2f(0.0))) + min(max(q.x, q.y), 0.0) - corner;
}

// Position on a bank's plan of a point that lies `at` metres (east, north) from the camera.
fn bank_plan(k: u32, at: vec2f) -> vec2f {
    let axes = low_air.banks[k].axes;
    return low_air.banks[k].camera + vec2f(dot(axes.xy, at), dot(axes.zw, at));
}

// Weight of a bank's region at a point of its plan.
fn bank_weight(k: u32, p: vec2f) -> f32 {
    let x = clamp(bank_distance(k, p) / max(low_air.banks[k].perimeter, 1e-3), 0.0, 1.0);
    return low_air.banks[k].strength * (1.0 - x * x * (3.0 - 2.0 * x));
}
