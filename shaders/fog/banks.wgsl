// Fog banks along a ray: the low layers of weather regions, seen from outside and from inside. src/fog/banks.rs
// describes the method and has the f64 reference.
//
// Inside its shape a bank has the layer's whole density. The integral of this density is exact except for terms of the
// third order in the planet's curvature. In its perimeter the depth is a sum over Gauss points of the bank's share
// there times the layer's density. Banks whose regions overlap are integrated together, with the shares of all at each
// point.
//!include "fog/bank_shapes.wgsl"

// Whether there are fog banks, so that the fog differs from place to place.
override BY_PLACE: bool = false;
// Whether regions of banks overlap.
override BANKS_OVERLAP: bool = true;
// Number of the slab of the fog outside all banks. The slab of a bank has the number of the bank.
const OUTER_SLAB: u32 = 8u;

// Optical depth of each bank along the pixel's ray, and the distances between which the ray is in the bank.
// measure_banks() writes the paths of banks whose regions overlap.
var<private> bank_paths: array<LayerPath, 8>;
// Share of each bank in the fog at the point for which write_shares() was last called.
var<private> bank_shares: array<f32, 8>;

// Writes the shares that the banks `banks` (bit j: bank j) have in the fog at a point that lies `at` metres (east,
// north) from the camera. src/regions/mod.rs defines the shares.
fn write_shares(banks: u32, at: vec2f) {
    var shares: array<f32, 8>;
    var weights: array<f32, 8>;
    for (var j = 0u; j < min(low_air.bank_count.x, MOST_BANKS); j++) {
        if (banks & (1u << j)) == 0u {
            continue;
        }
        let w = bank_weight(j, bank_plan(j, at));
        if w <= 0.0 {
            continue;
        }
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
    bank_shares = shares;
}

// Density of the slab `u` at the altitude `h`, as a share of the slab's full density.
fn slab_density(u: FogUniform, h: f32) -> f32 {
    let below = clamp((u.knots.w - h) * u.pair.y, 0.0, 1.0);
    if !FOG_LIFTED {
        return below;
    }
    return below * clamp((h - u.knots.x) * u.pair.x, 0.0, 1.0);
}

// Altitude of a ray at the distance `s`, m. Terms of the third order in s / planet radius are left out.
fn bank_height(u: FogUniform, ray: BankRay, s: f32) -> f32 {
    return ray.h0 + s * (ray.mu + 0.5 * u.curvature * (1.0 - ray.mu * ray.mu) * s);
}

// Integral of the density of the slab `u` along a ray from the distance `first` to `last`, m. The density is full
// between the distances `full`.
fn slab_length(u: FogUniform, ray: BankRay, first: f32, last: f32, full: vec2f) -> f32 {
    let a = clamp(full.x, first, last);
    let b = clamp(full.y, a, last);
    // Two Gauss points in each flank, where the density is a parabola.
    let s = mix(vec4f(first, first, b, b), vec4f(a, a, last, last), vec4f(0.21132487, 0.78867513, 0.21132487, 0.78867513));
    let before = slab_density(u, bank_height(u, ray, s.x)) + slab_density(u, bank_height(u, ray, s.y));
    let after = slab_density(u, bank_height(u, ray, s.z)) + slab_density(u, bank_height(u, ray, s.w));
    return b - a + 0.5 * (before * (a - first) + after * (last - b));
}

// Position of Gauss point `i` in a piece of a ray, 0 to 1, and its weight. Points 0 to 2 and 7 to 9 belong to rules of
// three points, points 3 to 6 to a rule of four.
fn gauss_point(i: u32) -> vec2f {
    let k = select(i, i - 7u, i > 6u) & 3u;
    let three = vec2f(
        vec4f(0.11270167, 0.5, 0.88729833, 0.0)[k],
        vec4f(0.27777778, 0.44444444, 0.27777778, 0.0)[k],
    );
    let four = vec2f(
        vec4f(0.06943184, 0.33000948, 0.66999052, 0.93056816)[(i - 3u) & 3u],
        vec4f(0.17392742, 0.32607258, 0.32607258, 0.17392742)[(i - 3u) & 3u],
    );
    return select(three, four, i > 2u && i < 7u);
}

// Integral of a bank's share times the density of the slab `u` along a ray from the distance `first` to `last`, m.
// There are four Gauss points where the density is full, between the distances `full`, and three in each flank. Drivers
// copy a function's code to every call. With a call for each point, some drivers would compile the shader for ten
// seconds, so one loop runs over all points. The flanks are passes of this loop, not branches: software drivers run
// both sides of every branch, but a loop only as long as some pixel of a group needs.
fn shared_piece(u: FogUniform, ray: BankRay, first: f32, last: f32, full: vec2f) -> f32 {
    let a = clamp(full.x, first, last);
    let b = clamp(full.y, a, last);
    var sum = 0.0;
    for (var i = select(3u, 0u, a > first); i < select(7u, 10u, last > b) && last > first; i++) {
        let part = select(select(vec2f(a, b), vec2f(b, last), i > 6u), vec2f(first, a), i < 3u);
        let point = gauss_point(i);
        let s = mix(part.x, part.y, point.x);
        let weight = bank_weight(ray.bank, ray.start + ray.way * s);
        sum += point.y * (part.y - part.x) * weight * slab_density(u, bank_height(u, ray, s));
    }
    return sum;
}

// Ray from `origin` along `direction` to an object at the distance `range`, with its projection onto the plan of bank
// `k`.
fn bank_ray(k: u32, origin: vec3f, direction: vec3f, range: f32) -> BankRay {
    let reach = fog_reach(low_air.fog, origin, direction, range);
    let mu = clamp(direction.z, -1.0, 1.0);
    return over_bank(k, BankRay(k, origin.xy, direction.xy, vec2f(0.0), vec2f(0.0), reach.x, mu, reach.y));
}

// The ray `ray` with its projection onto the plan of bank `k`.
fn over_bank(k: u32, ray: BankRay) -> BankRay {
    let axes = low_air.banks[k].axes;
    let way = vec2f(dot(axes.xy, ray.direction), dot(axes.zw, ray.direction));
    return BankRay(k, ray.origin, ray.direction, bank_plan(k, ray.origin), way, ray.h0, ray.mu, ray.t);
}

// Distances along a ray, m, between which it is inside the bank's shape. For a polygon that is not convex, these are
// the ends of the middle third of the chord `outer` on the ray. For a ray that misses the shape, both are the middle of
// `outer`.
fn inner_chord(ray: BankRay, outer: vec2f) -> vec2f {
    if is_sampled(ray.bank) {
        let begin = max(outer.x, 0.0);
        let end = max(min(outer.y, ray.t), begin);
        return vec2f(mix(begin, end, 0.33333333), mix(begin, end, 0.66666667));
    }
    let inner = bank_chord(ray, 0.0);
    return select(vec2f(0.5 * (outer.x + outer.y)), inner, inner.y > inner.x);
}

// Four distances along a ray, m, at which it enters the slab `u`, enters the slab's full density, leaves the full
// density, and leaves the slab.
fn slab_levels(u: FogUniform, ray: BankRay) -> vec4f {
    let course = ray_course(u, ray.h0, ray.mu, ray.t);
    var base = vec2f(0.0);
    if FOG_LIFTED {
        base = layer_reach(u.curvature, course.low_mu, u.knots.xy - course.low);
    }
    let top = layer_reach(u.curvature, course.low_mu, u.knots.zw - course.low);
    let ends = slab_ends(course, ray.t, vec2f(base.x, top.y));
    let full = slab_ends(course, ray.t, vec2f(base.y, top.x));
    return vec4f(ends.x, full.x, full.y, ends.y);
}

// Path of a ray through the slab `u` where the ray is in its bank, whose region no other overlaps. `inner` is the chord
// of the bank's shape, `outer` that of the shape with its perimeter.
fn own_path(u: FogUniform, ray: BankRay, inner: vec2f, outer: vec2f) -> LayerPath {
    let levels = slab_levels(u, ray);
    let first = max(max(outer.x, levels.x), 0.0);
    let last = min(min(outer.y, levels.w), ray.t);
    if last <= first || u.extinction <= 0.0 {
        return LayerPath(0.0, 0.0, 0.0);
    }
    let full = levels.yz;
    let a = clamp(inner.x, first, last);
    let b = clamp(inner.y, a, last);
    let sampled = is_sampled(ray.bank);
    var length = 0.0;
    if !sampled {
        length = low_air.banks[ray.bank].strength * slab_length(u, ray, a, b, full);
    }
    for (var i = 0u; i < select(2u, 3u, sampled); i++) {
        let piece = select(select(vec2f(a, b), vec2f(b, last), i == 1u), vec2f(first, a), i == 0u);
        length += shared_piece(u, ray, piece.x, piece.y, full);
    }
    return LayerPath(u.extinction * length, first, last);
}

// Slab of bank `k`, or the fog outside all banks if `k` is OUTER_SLAB.
fn slab_of(k: u32) -> FogUniform {
    var u = low_air.fog;
    if k < OUTER_SLAB {
        u = low_air.banks[k].fog;
    }
    return u;
}

// Adds to `bank_paths` the paths of a ray through the banks `banks` (bit k: bank k), whose regions overlap. If `outer`,
// adds to `replaced_fog` the optical depth of the fog outside all banks that the regions replace. The ray is cut where
// it enters or leaves a shape, a perimeter or a slab's flank. Each piece has three Gauss points.
fn add_together(banks: u32, ray: BankRay, outer: bool) {
    var cuts: array<vec4f, 8>;
    var levels: array<vec4f, 9>;
    var regions = banks;
    let count = min(low_air.bank_count.x, MOST_BANKS);
    for (var k = 0u; k < count; k++) {
        regions |= select(0u, low_air.banks[k].overlaps, (banks & (1u << k)) != 0u);
    }
    var around = vec2f(ray.t, 0.0);
    for (var j = 0u; j < count; j++) {
        cuts[j] = vec4f(0.0);
        if (regions & (1u << j)) != 0u {
            let over = over_bank(j, ray);
            let chord = bank_chord(over, low_air.banks[j].perimeter);
            cuts[j] = vec4f(chord, inner_chord(over, chord));
            around = select(around, vec2f(min(around.x, chord.x), max(around.y, chord.y)), chord.y > chord.x);
        }
    }
    var ends = vec2f(ray.t, 0.0);
    for (var k = 0u; k <= OUTER_SLAB; k++) {
        levels[k] = vec4f(0.0);
        if select((banks & (1u << k)) != 0u, outer, k == OUTER_SLAB) {
            levels[k] = slab_levels(slab_of(k), ray);
            var reach = vec2f(max(max(levels[k].x, around.x), 0.0), min(min(levels[k].w, around.y), ray.t));
            if k < OUTER_SLAB {
                reach = vec2f(max(reach.x, cuts[k].x), min(reach.y, cuts[k].y));
                bank_paths[k] = LayerPath(0.0, reach.x, reach.y);
            }
            ends = select(ends, vec2f(min(ends.x, reach.x), max(ends.y, reach.y)), reach.y > reach.x);
        }
    }
    var s = ends.x;
    for (var i = 0u; i < 69u && s < ends.y; i++) {
        let least = vec4f(s + max(0.01, 1e-5 * s));
        var next = vec4f(ends.y);
        for (var j = 0u; j <= OUTER_SLAB; j++) {
            next = min(next, select(vec4f(ends.y), levels[j], levels[j] > least));
            if j < count {
                next = min(next, select(vec4f(ends.y), cuts[j], cuts[j] > least));
            }
        }
        let end = min(min(next.x, next.y), min(next.z, next.w));
        for (var g = 0u; g < 3u; g++) {
            let point = gauss_point(g);
            let at = mix(s, end, point.x);
            write_shares(regions, ray.origin + ray.direction * at);
            var all = 0.0;
            for (var k = 0u; k < count; k++) {
                all += bank_shares[k];
                if (banks & (1u << k)) != 0u && bank_shares[k] > 0.0 {
                    let u = low_air.banks[k].fog;
                    let density = u.extinction * slab_density(u, bank_height(u, ray, at));
                    bank_paths[k].depth += point.y * (end - s) * bank_shares[k] * density;
                }
            }
            if outer {
                let u = low_air.fog;
                let density = u.extinction * slab_density(u, bank_height(u, ray, at));
                replaced_fog += point.y * (end - s) * all * density;
            }
        }
        s = end;
    }
}

// Banks that a ray may meet before the distance `range`. Bit i is the bank at place i of `bank_order`, in which the
// farthest bank comes first.
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

// Index of the bank of the lowest bit that is set in `met`, a result of banks_met other than 0.
fn first_bank(met: u32) -> u32 {
    let lowest = met & (~met + 1u);
    let place = (u32((lowest & 0xAAu) != 0u) | (u32((lowest & 0xCCu) != 0u) << 1u)) | (u32((lowest & 0xF0u) != 0u) << 2u);
    return (low_air.bank_order >> (4u * place)) & 7u;
}

// Path of a ray through the slab with the number `slab` (slab_of) where the ray is in bank `k`, whose region no other
// overlaps.
fn path_apart(k: u32, slab: u32, origin: vec3f, direction: vec3f, range: f32) -> LayerPath {
    let ray = bank_ray(k, origin, direction, range);
    let outer = bank_chord(ray, low_air.banks[k].perimeter);
    if outer.y <= max(outer.x, 0.0) || outer.x >= ray.t {
        return LayerPath(0.0, 0.0, 0.0);
    }
    return own_path(slab_of(slab), ray, inner_chord(ray, outer), outer);
}

// Writes to `replaced_fog` the optical depth along a ray that the banks `met` replace of the fog outside all banks. If
// `paths`, also writes to `bank_paths` the paths through those of these banks whose regions overlap.
fn measure_banks(met: u32, origin: vec3f, direction: vec3f, range: f32, paths: bool) {
    replaced_fog = 0.0;
    let outer = has_own_layer() && low_air.fog.kind == FOG_SLAB;
    var together = 0u;
    if has_own_layer() || (BANKS_OVERLAP && paths) {
        var left = met;
        for (var i = 0u; i < MOST_BANKS && left != 0u; i++) {
            let k = first_bank(left);
            left &= left - 1u;
            if BANKS_OVERLAP && low_air.banks[k].overlaps != 0u {
                together |= 1u << k;
            } else if outer {
                replaced_fog += path_apart(k, OUTER_SLAB, origin, direction, range).depth;
            }
        }
    }
    if BANKS_OVERLAP && together != 0u && (outer || paths) {
        add_together(together, bank_ray(0u, origin, direction, range), outer);
    }
}

// Path of a ray through bank `k`. `paths` are the paths that measure_banks() wrote to `bank_paths`.
fn bank_path(k: u32, paths: array<LayerPath, 8>, origin: vec3f, direction: vec3f, range: f32) -> LayerPath {
    if BANKS_OVERLAP && low_air.banks[k].overlaps != 0u {
        var measured = paths;
        return measured[k];
    }
    return path_apart(k, k, origin, direction, range);
}

// Returns the effect of bank `k` along a ray with the path `path` through the bank. A path without depth has no effect.
fn bank_along(k: u32, path: LayerPath, origin: vec3f, direction: vec3f, range: f32) -> Fog {
    var fog = Fog(vec3f(0.0), 0.0, vec3f(1.0), 1.0, vec3f(0.0));
    if path.depth <= 0.0 {
        return fog;
    }
    let u = low_air.banks[k].fog;
    let h0 = fog_reach(low_air.fog, origin, direction, range).x;
    let mu = clamp(direction.z, -1.0, 1.0);
    let first_rise = layer_rise(u.curvature, mu, path.first);
    let entry_mu = clamp(mu + u.curvature * path.first, -1.0, 1.0);
    let mean_mu = clamp(mu + 0.5 * u.curvature * (path.first + path.last), -1.0, 1.0);
    let above = own_depth_above(u, h0 + first_rise);
    let ends = vec2f(above, max(above - mean_mu * path.depth, 0.0));
    let to_sun = direction - u.to_sun;
    let light = layer_radiance(u, mu, entry_mu, 0.5 * dot(to_sun, to_sun), ends, path.depth);
    fog.radiance = light.radiance;
    fog.once = light.once;
    fog.transmittance = fog_exp(-fog_channels(u.ratio) * path.depth);
    fog.distance = path.first + (path.last - path.first) * mean_place(path.depth) * u.lit;
    let inside = select((path.last - path.first) / max(range, 1e-3), 0.0, range >= RANGE_SKY);
    fog.shade = 1.0 - (1.0 - u.lit) * min(inside, 1.0);
    return fog;
}
