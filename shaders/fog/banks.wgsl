// Fog banks along a ray: the low layers of weather regions, seen from outside and from inside. src/fog/banks.rs
// describes the method and has the f64 reference.
//
// Inside its shape a bank has the layer's whole density, whose integral is exact but for the third order of the
// planet's curvature. In its perimeter, and where other regions overlap it, the depth is a sum over Gauss points of the
// bank's share there times the layer's density.
//!include "fog/lookup.wgsl"

// Whether the veil differs from place to place: there are banks.
override BY_PLACE: bool = false;
// Whether regions of banks overlap.
override BANKS_OVERLAP: bool = true;
// Shapes of the banks: bit k stands for kind k.
override BANK_SHAPES: u32 = 15u;

// Value of FogBank.kind for a rectangle with round corners.
const BANK_RECTANGLE: u32 = 0u;
// Value of FogBank.kind for an ellipse.
const BANK_ELLIPSE: u32 = 1u;
// Value of FogBank.kind for a convex polygon. Kind 3 is any other polygon.
const BANK_CONVEX: u32 = 2u;
// Least component of a direction on the plan.
const LEAST_WAY: f32 = 1e-7;

// Ray over the plan of a bank.
struct BankRay {
    bank: u32,
    // Position at the distance 0, m (east, north) from the camera, and its change per metre.
    origin: vec2f,
    direction: vec2f,
    // Both on the plan.
    start: vec2f,
    way: vec2f,
    // Altitude of the start, m, cosine with the vertical there, and length, m.
    h0: f32,
    mu: f32,
    t: f32,
}

// Distances along a ray between which it is inside a shape, m: none if the last is not beyond the first.
fn box_chord(start: vec2f, way: vec2f, half: vec2f) -> vec2f {
    let v = select(way, select(vec2f(-LEAST_WAY), vec2f(LEAST_WAY), way >= vec2f(0.0)), abs(way) < vec2f(LEAST_WAY));
    let a = (-half - start) / v;
    let b = (half - start) / v;
    let first = min(a, b);
    let last = max(a, b);
    return vec2f(max(first.x, first.y), min(last.x, last.y));
}

// As box_chord, for an ellipse with these half axes.
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

// As box_chord, for a rectangle with round corners: where the ray passes a corner, the corner's circle bounds it.
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

// As box_chord, for a convex polygon whose sides are moved outwards by `grown`.
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

// Distances along a ray between which it is inside the shape grown by `grown` metres on all sides. For a polygon that
// is not convex, those of a circle about it.
fn bank_chord(ray: BankRay, grown: f32) -> vec2f {
    let half = low_air.banks[ray.bank].half + grown;
    let kind = low_air.banks[ray.bank].kind;
    if (BANK_SHAPES & 2u) != 0u && kind == BANK_ELLIPSE {
        return ellipse_chord(ray.start, ray.way, half);
    }
    if (BANK_SHAPES & 4u) != 0u && kind == BANK_CONVEX {
        return convex_chord(ray, grown);
    }
    if (BANK_SHAPES & 8u) != 0u && kind > BANK_CONVEX {
        return ellipse_chord(ray.start, ray.way, vec2f(low_air.banks[ray.bank].radius + grown));
    }
    return rounded_chord(ray.start, ray.way, half, low_air.banks[ray.bank].corner + grown);
}

// Signed distance of a point of the plan from an ellipse, m: three steps along the ellipse's evolute.
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

// Signed distance of a point of the plan from a bank's polygon, m.
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
        // A ray to the right of the point crosses this side.
        let crosses = (b.y > p.y) != (a.y > p.y);
        if crosses && p.x < a.x + side.x * (p.y - a.y) / select(side.y, 1.0, side.y == 0.0) {
            inside = !inside;
        }
        a = b;
    }
    return select(1.0, -1.0, inside) * sqrt(nearest);
}

// Signed distance of a point of the plan from a bank's shape, m.
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

// Share of bank `k` in the fog at a point that lies `at` metres (east, north) from the camera, where other banks may
// overlap it (src/regions/mod.rs).
fn overlapped_share(k: u32, at: vec2f) -> f32 {
    var shares: array<f32, 8>;
    var weights: array<f32, 8>;
    let banks = low_air.banks[k].overlaps | (1u << k);
    for (var j = 0u; j < min(low_air.bank_count.x, MOST_BANKS); j++) {
        if (banks & (1u << j)) == 0u {
            continue;
        }
        let w = bank_weight(j, bank_plan(j, at));
        let merges = low_air.banks[j].merges == 1u;
        var merging = 0.0;
        var whole = w;
        for (var i = 0u; i < min(j, MOST_BANKS); i++) {
            merging += select(0.0, shares[i], weights[i] > 0.0);
            whole += weights[i];
        }
        let together = 1.0 - (1.0 - merging) * (1.0 - w);
        for (var i = 0u; i < min(j, MOST_BANKS); i++) {
            let joined = together * weights[i] / max(whole, 1e-9);
            shares[i] = select(shares[i] * (1.0 - w), joined, merges && weights[i] > 0.0);
            weights[i] *= select(1.0 - w, 1.0, merges);
        }
        shares[j] = select(w, together * w / max(whole, 1e-9), merges);
        weights[j] = select(0.0, w, merges);
    }
    return shares[k];
}

// Share of a bank in the fog at a distance along a ray.
fn bank_share(ray: BankRay, s: f32) -> f32 {
    if BANKS_OVERLAP && low_air.banks[ray.bank].overlaps != 0u {
        return overlapped_share(ray.bank, ray.origin + ray.direction * s);
    }
    return bank_weight(ray.bank, ray.start + ray.way * s);
}

// Density of a slab at an altitude, as a share of its extinction.
fn slab_density(u: FogUniform, h: f32) -> f32 {
    let below = clamp((u.knots.w - h) * u.pair.y, 0.0, 1.0);
    if !FOG_LIFTED {
        return below;
    }
    return below * clamp((h - u.knots.x) * u.pair.x, 0.0, 1.0);
}

// Altitude of a ray at a distance, m. Terms of the third order in the distance over the planet's radius are left out.
fn bank_height(u: FogUniform, ray: BankRay, s: f32) -> f32 {
    return ray.h0 + s * (ray.mu + 0.5 * u.curvature * (1.0 - ray.mu * ray.mu) * s);
}

// Integral of a bank's share times the density of the slab `u` over a part of a ray in a flank, m, by three Gauss
// points.
fn flank_piece(u: FogUniform, ray: BankRay, first: f32, last: f32) -> f32 {
    let s = mix(vec3f(first), vec3f(last), vec3f(0.11270167, 0.5, 0.88729833));
    let densities = vec3f(
        slab_density(u, bank_height(u, ray, s.x)),
        slab_density(u, bank_height(u, ray, s.y)),
        slab_density(u, bank_height(u, ray, s.z)),
    );
    let shares = vec3f(bank_share(ray, s.x), bank_share(ray, s.y), bank_share(ray, s.z));
    return dot(vec3f(0.27777778, 0.44444444, 0.27777778), shares * densities) * (last - first);
}

// Integral of the density of the slab `u` over a piece of a ray, m, that is full between the distances `full`.
fn slab_length(u: FogUniform, ray: BankRay, first: f32, last: f32, full: vec2f) -> f32 {
    let a = clamp(full.x, first, last);
    let b = clamp(full.y, a, last);
    // Two Gauss points in each flank, where the density is a parabola.
    let s = mix(vec4f(first, first, b, b), vec4f(a, a, last, last), vec4f(0.21132487, 0.78867513, 0.21132487, 0.78867513));
    let before = slab_density(u, bank_height(u, ray, s.x)) + slab_density(u, bank_height(u, ray, s.y));
    let after = slab_density(u, bank_height(u, ray, s.z)) + slab_density(u, bank_height(u, ray, s.w));
    return b - a + 0.5 * (before * (a - first) + after * (last - b));
}

// Integral of a bank's share times the density of the slab `u` over a piece of a ray, m: four Gauss points where the
// density is full, between the distances `full`, and three in each flank.
fn shared_piece(u: FogUniform, ray: BankRay, first: f32, last: f32, full: vec2f) -> f32 {
    if last <= first {
        return 0.0;
    }
    let a = clamp(full.x, first, last);
    let b = clamp(full.y, a, last);
    let s = mix(vec4f(a), vec4f(b), vec4f(0.06943184, 0.33000948, 0.66999052, 0.93056816));
    let weights = vec4f(0.17392742, 0.32607258, 0.32607258, 0.17392742);
    let shares = vec4f(bank_share(ray, s.x), bank_share(ray, s.y), bank_share(ray, s.z), bank_share(ray, s.w));
    return dot(weights, shares) * (b - a) + flank_piece(u, ray, first, a) + flank_piece(u, ray, b, last);
}

// Ray over the plan of bank `k`.
fn bank_ray(k: u32, origin: vec3f, direction: vec3f, range: f32) -> BankRay {
    let reach = fog_reach(low_air.fog, origin, direction, range);
    let mu = clamp(direction.z, -1.0, 1.0);
    return over_bank(k, BankRay(k, origin.xy, direction.xy, vec2f(0.0), vec2f(0.0), reach.x, mu, reach.y));
}

// A ray over the plan of bank `k`.
fn over_bank(k: u32, ray: BankRay) -> BankRay {
    let axes = low_air.banks[k].axes;
    let way = vec2f(dot(axes.xy, ray.direction), dot(axes.zw, ray.direction));
    return BankRay(k, ray.origin, ray.direction, bank_plan(k, ray.origin), way, ray.h0, ray.mu, ray.t);
}

// Distances along a ray between which it is inside the shape: for a polygon that is not convex, the middle third of the
// chord `outer`; for a ray that misses the shape, its middle.
fn inner_chord(ray: BankRay, outer: vec2f) -> vec2f {
    if (BANK_SHAPES & 8u) != 0u && low_air.banks[ray.bank].kind > BANK_CONVEX {
        let begin = max(outer.x, 0.0);
        let end = max(min(outer.y, ray.t), begin);
        return vec2f(mix(begin, end, 0.33333333), mix(begin, end, 0.66666667));
    }
    let inner = bank_chord(ray, 0.0);
    return select(vec2f(0.5 * (outer.x + outer.y)), inner, inner.y > inner.x);
}

// As shared_piece where regions overlap: cut where the ray enters and leaves each of them and its perimeter.
fn overlapped_piece(u: FogUniform, ray: BankRay, first: f32, last: f32, full: vec2f) -> f32 {
    var cuts: array<vec4f, 8>;
    let banks = low_air.banks[ray.bank].overlaps | (1u << ray.bank);
    let count = min(low_air.bank_count.x, MOST_BANKS);
    for (var j = 0u; j < count; j++) {
        cuts[j] = vec4f(first);
        if (banks & (1u << j)) != 0u {
            let over = over_bank(j, ray);
            let outer = bank_chord(over, low_air.banks[j].perimeter);
            cuts[j] = vec4f(outer, inner_chord(over, outer));
        }
    }
    var sum = 0.0;
    var s = first;
    for (var i = 0u; i < 34u && s < last; i++) {
        let least = s + max(0.01, 1e-5 * s);
        var next = last;
        for (var j = 0u; j < count; j++) {
            let later = select(vec4f(last), cuts[j], cuts[j] > vec4f(least));
            next = min(next, min(min(later.x, later.y), min(later.z, later.w)));
        }
        sum += shared_piece(u, ray, s, next, full);
        s = next;
    }
    return sum;
}

// Path of a ray through the slab `u` where it belongs to a bank.
fn shared_path(u: FogUniform, ray: BankRay, inner: vec2f, outer: vec2f) -> LayerPath {
    let course = ray_course(u, ray.h0, ray.mu, ray.t);
    var base = vec2f(0.0);
    if FOG_LIFTED {
        base = layer_reach(u.curvature, course.low_mu, u.knots.xy - course.low);
    }
    let top = layer_reach(u.curvature, course.low_mu, u.knots.zw - course.low);
    let ends = slab_ends(course, ray.t, vec2f(base.x, top.y));
    let full = slab_ends(course, ray.t, vec2f(base.y, top.x));
    let first = max(max(outer.x, ends.x), 0.0);
    let last = min(min(outer.y, ends.y), ray.t);
    if last <= first || u.extinction <= 0.0 {
        return LayerPath(0.0, 0.0, 0.0);
    }
    if BANKS_OVERLAP && low_air.banks[ray.bank].overlaps != 0u {
        return LayerPath(u.extinction * overlapped_piece(u, ray, first, last, full), first, last);
    }
    let a = clamp(inner.x, first, last);
    let b = clamp(inner.y, a, last);
    var length = shared_piece(u, ray, first, a, full) + shared_piece(u, ray, b, last, full);
    if (BANK_SHAPES & 8u) != 0u && low_air.banks[ray.bank].kind > BANK_CONVEX {
        length += shared_piece(u, ray, a, b, full);
    } else {
        length += low_air.banks[ray.bank].strength * slab_length(u, ray, a, b, full);
    }
    return LayerPath(u.extinction * length, first, last);
}

// Banks that a ray may meet in front of `range`: bit i stands for the i-th bank from afar.
fn banks_met(origin: vec3f, direction: vec3f, range: f32) -> u32 {
    let reach = fog_reach(low_air.fog, origin, direction, range);
    let mu = clamp(direction.z, -1.0, 1.0);
    let bend = 0.5 * low_air.fog.curvature * (1.0 - mu * mu);
    var met = 0u;
    for (var i = 0u; i < min(low_air.bank_count.y, MOST_BANKS); i++) {
        let k = (low_air.bank_order >> (4u * i)) & 7u;
        let axes = low_air.banks[k].axes;
        let way = vec2f(dot(axes.xy, direction.xy), dot(axes.zw, direction.xy));
        let grown = low_air.banks[k].radius + low_air.banks[k].perimeter;
        let circle = ellipse_chord(bank_plan(k, origin.xy), way, vec2f(grown));
        let first = max(circle.x, 0.0);
        let last = min(circle.y, reach.y);
        // A ray is lowest where it is level, or at an end.
        let level = clamp(-0.5 * mu / max(bend, 1e-12), first, last);
        let lowest = reach.x + level * (mu + bend * level);
        let knots = low_air.banks[k].fog.knots;
        let other = low_air.fog.knots;
        let top = select(knots.w, max(knots.w, other.w), has_own_layer());
        met |= select(0u, 1u << i, last > first && lowest < top);
    }
    return met;
}

// Index of the bank whose bit is the lowest of `met`, which is not 0.
fn first_bank(met: u32) -> u32 {
    let lowest = met & (~met + 1u);
    let place = (u32((lowest & 0xAAu) != 0u) | (u32((lowest & 0xCCu) != 0u) << 1u)) | (u32((lowest & 0xF0u) != 0u) << 2u);
    return (low_air.bank_order >> (4u * place)) & 7u;
}

// Optical depth at 550 nm of the fog outside all banks that the banks `met` replace along a ray.
fn fog_of_banks(met: u32, origin: vec3f, direction: vec3f, range: f32) -> f32 {
    var depth = 0.0;
    if BY_PLACE && has_own_layer() && low_air.fog.kind == FOG_SLAB {
        var left = met;
        for (var i = 0u; i < MOST_BANKS && left != 0u; i++) {
            let k = first_bank(left);
            left &= left - 1u;
            let ray = bank_ray(k, origin, direction, range);
            let outer = bank_chord(ray, low_air.banks[k].perimeter);
            if outer.y > max(outer.x, 0.0) {
                depth += shared_path(low_air.fog, ray, inner_chord(ray, outer), outer).depth;
            }
        }
    }
    return depth;
}

// Returns the effect of bank `k` along a ray. Where the ray does not meet the bank, the transmittance is 1.
fn bank_along(k: u32, origin: vec3f, direction: vec3f, range: f32) -> Fog {
    let ray = bank_ray(k, origin, direction, range);
    let outer = bank_chord(ray, low_air.banks[k].perimeter);
    var fog = Fog(vec3f(0.0), 0.0, vec3f(1.0), 1.0, vec3f(0.0));
    if outer.y <= max(outer.x, 0.0) || outer.x >= ray.t {
        return fog;
    }
    let u = low_air.banks[k].fog;
    let path = shared_path(u, ray, inner_chord(ray, outer), outer);
    if path.depth <= 0.0 {
        return fog;
    }
    let first_rise = layer_rise(u.curvature, ray.mu, path.first);
    let entry_mu = clamp(ray.mu + u.curvature * path.first, -1.0, 1.0);
    let mean_mu = clamp(ray.mu + 0.5 * u.curvature * (path.first + path.last), -1.0, 1.0);
    let above = own_depth_above(u, ray.h0 + first_rise);
    let ends = vec2f(above, max(above - mean_mu * path.depth, 0.0));
    let to_sun = direction - u.to_sun;
    let light = layer_radiance(u, ray.mu, entry_mu, 0.5 * dot(to_sun, to_sun), ends, path.depth);
    fog.radiance = light.radiance;
    fog.once = light.once;
    fog.transmittance = fog_exp(-fog_channels(u.ratio) * path.depth);
    fog.distance = path.first + (path.last - path.first) * mean_place(path.depth) * u.lit;
    let inside = select((path.last - path.first) / max(range, 1e-3), 0.0, range >= RANGE_SKY);
    fog.shade = 1.0 - (1.0 - u.lit) * min(inside, 1.0);
    return fog;
}
