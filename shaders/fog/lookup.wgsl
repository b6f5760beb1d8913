// Effect of fog on a pixel, in closed form: no texture, and no loop except those of patterns.wgsl. The f64 references,
// with the derivations, are src/fog/path.rs (path of a ray), src/fog/reference.rs (light along the ray) and
// src/fog/phase.rs. src/fog/light.rs solves the layer's light on the CPU.
//
// Axes: east, north, up at the camera. In the composition, `behind` is the pixel with the sky's aerial perspective over
// the pixel's full distance:
//     let fog = fog_along(u, ray.origin, ray.direction, range, plane);
//     out = air_radiance + air_transmittance * fog.radiance + fog.transmittance * (fog.shade * behind - air_radiance)
// air_radiance and air_transmittance are the sky's aerial perspective up to fog.distance: 0 and 1 if the fog is near or
// has no air in front of it. Air therefore lies in front of a distant fog bank and behind the fog around the camera,
// without a seam between the two cases.
//!include "common/depth.wgsl"
//!include "fog/patterns.wgsl"

// Features that a pipeline can draw, set by FogVariant::constants(). GPUs skip branches that the uniform does not
// select. Software drivers execute every branch, so a pipeline with few features is several times as fast there.
// Kinds of fog: bit k is the value k of FogUniform.kind.
override FOG_KINDS: u32 = 63u;
// Whether layers may absorb.
override FOG_ABSORBING: bool = true;
// Whether layers may have patches.
override FOG_PATCHES: bool = true;
// Whether there may be precipitation.
override FOG_FALLING: bool = true;
// Whether rain may have curtains.
override FOG_CURTAINS: bool = true;
// Whether all channels of a layer are equal, as in fog of water.
override FOG_NEUTRAL: bool = false;
// Whether slabs may have a lower edge.
override FOG_LIFTED: bool = true;

// Value of FogUniform.kind for no layer.
const FOG_CLEAR: u32 = 0u;
// Value of FogUniform.kind for a slab with linear flanks.
const FOG_SLAB: u32 = 1u;
// Value of FogUniform.kind for an exponential layer.
const FOG_EXPONENTIAL: u32 = 2u;
// Value of FogUniform.kind for the linear law.
const FOG_LINEAR_LAW: u32 = 3u;
// Value of FogUniform.kind for the exponential law.
const FOG_EXPONENTIAL_LAW: u32 = 4u;
// Kind 5, the exponential-squared law, needs no constant: fog_compatible draws it as the default case.
// Smallest height of the compatibility laws' sky band, rad, with which the band covers the whole sky: pi less a margin
// for f32 rounding.
const FOG_WHOLE_SKY: f32 = 3.13845;

// Optical depth at 550 nm along the ray that banks replace of the fog outside all banks (fog/banks.wgsl).
var<private> replaced_fog: f32 = 0.0;

// Whether this pipeline can draw a kind of fog.
fn fog_can(kind: u32) -> bool {
    return (FOG_KINDS & (1u << kind)) != 0u;
}

// Whether there may be a layer besides precipitation.
fn has_own_layer() -> bool {
    return (FOG_KINDS & 6u) != 0u;
}

// Effect of fog on a colour: colour * transmittance + radiance.
struct Fog {
    // Light scattered into the ray.
    radiance: vec3f,
    // Distance, m, up to which the air is drawn in front of the fog.
    distance: f32,
    // Share of the light from behind the fog that is left, per channel.
    transmittance: vec3f,
    // Share that is left of the air's light between the eye and an object: the layer shades the air inside it.
    shade: f32,
    // Light of sun or moon that is scattered exactly once, into the ray, divided by the phase function.
    once: vec3f,
}

// Path of a ray through a medium.
struct LayerPath {
    // Optical depth at 550 nm.
    depth: f32,
    // Distance at which the ray enters the medium, m.
    first: f32,
    // Distance at which the ray leaves the medium, m.
    last: f32,
}

// Altitudes along a ray, split at its lowest point: the fields of `RayCourse` in src/fog/path.rs.
struct RayCourse {
    // Altitude of the end, m.
    end_altitude: f32,
    // Cosine of the ray with the vertical at its end.
    end_mu: f32,
    // Distance at which the ray is level, m.
    level: f32,
    // Whether the distance `level` is within the ray's length.
    passes: bool,
    // Whether the ray only descends.
    falls: bool,
    // Lowest altitude, m.
    low: f32,
    // Cosine with which both parts of the ray rise from the lowest point.
    low_mu: f32,
    // Length of the part before the lowest point, m.
    before: f32,
    // Length of the part after the lowest point, m.
    after: f32,
    // Altitude at the upper end of the first part, m.
    high: f32,
    // Curvature of the altitude along the ray, 1/m.
    bend: f32,
}

// Returns the mean, over the optical path from 0 to s = `slant`, of the share of the delta-scaled beam that is really
// unscattered. After the path x this share is e^(-f x), so the mean is (1 - e^(-f s)) / (f s). f = `forward` is the
// share of scattering that counts as going straight on. src/fog/phase.rs says how the mean is used.
fn share_unscattered(forward: f32, slant: f32) -> f32 {
    let fs = min(forward * slant, 1e4);
    return select((1.0 - exp(-fs)) / max(fs, 1e-9), 1.0 - 0.5 * fs, fs < 1e-3);
}

// Returns the phase function per steradian for sunlight after the optical path `slant`, at the angle whose 1 - cos is
// `versine`: the smooth part, and the peak above it. src/fog/phase.rs has the derivation (fog_phase_after).
fn fog_phase_after(u: FogUniform, slant: f32, versine: f32) -> vec2f {
    let forward = u.scattering.z;
    let share = share_unscattered(forward, slant);
    let order = inverseSqrt(share);
    let met = max(order * u.lobes.w, 1.0);
    let e = exp(vec3f(u.lobes.xy, u.scattering.x) * vec3f(order, met, order));
    let g = vec3f(u.scattering.y * e.x, e.y, u.scattering.w);
    let d = (1.0 - g) * (1.0 - g) + 2.0 * g * versine;
    let lobe = (1.0 - g * g) / (d * sqrt(d)) * 0.07957747;
    let c = 1.0 - versine;
    let m2 = met * met;
    let draine = lobe.y * (m2 + u.lobes.z * c * c) / (m2 + u.lobes.z * (0.33333333 + 0.66666667 * g.y * g.y));
    let even = (1.0 - forward) * lobe.z;
    return vec2f(even, share * (mix(draine, lobe.x, e.z) - even));
}

// Returns the rise of a ray above its start after `t` metres, m.
fn layer_rise(curvature: f32, mu: f32, t: f32) -> f32 {
    let q = t * (2.0 * mu + curvature * t);
    return q / (1.0 + sqrt(max(1.0 + curvature * q, 0.0)));
}

// Returns the extinction of an exponential layer at the altitude `h`, 1/m.
fn layer_density(u: FogUniform, h: f32) -> f32 {
    return u.extinction * exp(min((u.knots.x - h) / u.knots.y, 60.0));
}

// Returns the optical depth at 550 nm of the precipitation above the altitude `h`.
fn falling_depth_above(u: FogUniform, h: f32) -> f32 {
    let f = u.falling;
    let in_top = f.z - clamp(h, f.y, f.z);
    return f.x * (in_top * in_top * 0.5 * f.w + f.y - min(h, f.y));
}

// Returns the optical depth at 550 nm of the layer and the precipitation above the altitude `h`.
fn layer_depth_above(u: FogUniform, h: f32) -> f32 {
    if !FOG_FALLING {
        return own_depth_above(u, h);
    }
    if !has_own_layer() {
        return falling_depth_above(u, h);
    }
    return own_depth_above(u, h) + falling_depth_above(u, h);
}

// Returns the optical depth at 550 nm of the layer alone above the altitude `h`.
fn own_depth_above(u: FogUniform, h: f32) -> f32 {
    if fog_can(FOG_EXPONENTIAL) && u.kind == FOG_EXPONENTIAL {
        return layer_density(u, h) * u.knots.y;
    }
    let k = u.knots;
    let in_top = k.w - clamp(h, k.z, k.w);
    let in_base = clamp(h, k.x, k.y);
    let top = in_top * in_top * 0.5 * u.pair.y;
    if !FOG_LIFTED {
        return u.extinction * (top + k.z - min(h, k.z));
    }
    let base = (k.y - in_base) * (k.y + in_base - 2.0 * k.x) * 0.5 * u.pair.x;
    return u.extinction * (top + (k.z - clamp(h, k.y, k.z)) + base);
}

// Returns the distances after which a ray that starts at its lowest point with cosine `mu` >= 0 is `lift` higher.
fn layer_reach(curvature: f32, mu: f32, lift: vec2f) -> vec2f {
    let up = max(lift, vec2f(0.0));
    let c = up * (2.0 + curvature * up);
    return c / max(mu + sqrt(mu * mu + curvature * c), vec2f(1e-20));
}

// Returns the length of a ray's part between the two knots of a flank, m, and the mean over this part of (altitude -
// first knot) / height of the flank, 0 to 1. The ray passes the knots at the distances `reach`. `inverse` is 1/height
// of the flank, 1/m.
fn flank(bend: f32, reach: vec2f, knots: vec2f, inverse: f32, low: f32, high: f32) -> vec2f {
    let l = reach.y - reach.x;
    let h = clamp(knots, vec2f(low), vec2f(high));
    let mean = 0.5 * (h.x + h.y) - bend * l * l * 0.083333333;
    return vec2f(l, clamp((mean - knots.x) * inverse, 0.0, 1.0));
}

// Returns the optical depth of a part of a ray in a slab, divided by the slab's extinction, m. The part rises from
// altitude `low` to `high` over `length` metres. It passes the knots of the lower flank at the distances `base`, those
// of the upper flank at `top`. Without a lower edge the whole part lies above the lower flank. The f64 reference is
// `slab_part` in src/fog/path.rs.
fn slab_part(u: FogUniform, bend: f32, base: vec2f, top: vec2f, length: f32, low: f32, high: f32) -> f32 {
    let t = min(top, vec2f(length));
    let upper = flank(bend, t, u.knots.zw, u.pair.y, low, high);
    if !FOG_LIFTED {
        return t.x + upper.x * (1.0 - upper.y);
    }
    let b = min(base, vec2f(length));
    let lower = flank(bend, b, u.knots.xy, u.pair.x, low, high);
    return lower.x * lower.y + (t.x - b.y) + upper.x * (1.0 - upper.y);
}

// Returns e^(z^2) erfc(z) for z >= 0.
fn scaled_erfc(z: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.5 * z);
    var p = 0.17087277;
    p = -0.82215223 + t * p;
    p = 1.48851587 + t * p;
    p = -1.13520398 + t * p;
    p = 0.27886807 + t * p;
    p = -0.18628806 + t * p;
    p = 0.09678418 + t * p;
    p = 0.37409196 + t * p;
    p = 1.00002368 + t * p;
    return t * exp(-1.26551223 + t * p);
}

// Returns the optical depth of an upward path through an exponential layer, divided by the extinction at its start, m.
// The f64 reference is `exponential_up` in src/fog/path.rs, which describes `mu` and `rise`.
fn exponential_up(k: f32, scale: f32, mu: f32, rise: f32) -> f32 {
    let z = mu / sqrt(2.0 * k * scale);
    let x = rise / scale;
    return sqrt(1.57079633 * scale / k) * (scaled_erfc(z) - exp(-x) * scaled_erfc(sqrt(max(z * z + x, 0.0))));
}

// Returns the optical depth at 550 nm of a ray through an exponential layer.
fn exponential_path(u: FogUniform, h0: f32, mu: f32, t: f32, end_altitude: f32, end_mu: f32) -> f32 {
    let k = max(u.curvature, 1e-15);
    let scale = u.knots.y;
    let turn = select(0.0, min(-mu / k, t), mu < 0.0);
    let low = h0 + layer_rise(u.curvature, mu, turn);
    if max(end_altitude - low, h0 - low) < scale {
        let e = exp(-vec3f(
            layer_rise(u.curvature, mu, t * 0.112701665),
            layer_rise(u.curvature, mu, t * 0.5),
            layer_rise(u.curvature, mu, t * 0.887298335),
        ) / scale);
        return layer_density(u, h0) * t * dot(e, vec3f(5.0, 8.0, 5.0) / 18.0);
    }
    if mu >= 0.0 {
        return layer_density(u, h0) * exponential_up(k, scale, mu, end_altitude - h0);
    }
    if end_mu <= 0.0 {
        return layer_density(u, end_altitude) * exponential_up(k, scale, -end_mu, h0 - end_altitude);
    }
    return layer_density(u, low)
        * (exponential_up(k, scale, 0.0, h0 - low) + exponential_up(k, scale, 0.0, end_altitude - low));
}

// Returns the course of a ray that starts at altitude `h0` with cosine `mu` and is `t` metres long.
fn ray_course(u: FogUniform, h0: f32, mu: f32, t: f32) -> RayCourse {
    let k = u.curvature;
    let end_rise = layer_rise(k, mu, t);
    let end_altitude = h0 + end_rise;
    let end_mu = clamp((mu + k * t) / (1.0 + k * end_rise), -1.0, 1.0);
    let level = -mu * u.radius;
    let passes = mu < 0.0 && t > level;
    let falls = mu < 0.0 && !passes;
    let bottom = h0 + mu * level / (1.0 + sqrt(max(1.0 - mu * mu, 0.0)));
    let low = select(select(h0, end_altitude, falls), bottom, passes);
    let low_mu = select(select(mu, max(-end_mu, 0.0), falls), 0.0, passes);
    let before = select(t, level, passes);
    let after = select(0.0, t - level, passes);
    let high = select(max(h0, end_altitude), h0, passes);
    let bend = k * (1.0 - mu * mu);
    return RayCourse(end_altitude, end_mu, level, passes, falls, low, low_mu, before, after, high, bend);
}

// Returns the distances from the eye at which a ray enters and leaves a slab. `reach` has the distances of the slab's
// lower and upper edge from the ray's lowest point.
fn slab_ends(c: RayCourse, t: f32, reach: vec2f) -> vec2f {
    let near = min(reach.x, c.before);
    let far = min(reach.y, c.before);
    let first = select(select(near, t - far, c.falls), c.level - far, c.passes);
    let last = select(select(far, t - near, c.falls), c.level + min(reach.y, c.after), c.passes);
    return vec2f(first, last);
}

// Returns the optical depth of a part of a ray through precipitation, which has no lower edge, divided by the
// extinction, m.
fn falling_part(u: FogUniform, bend: f32, top: vec2f, length: f32, low: f32, high: f32) -> f32 {
    let t = min(top, vec2f(length));
    let upper = flank(bend, t, u.falling.yz, u.falling.w, low, high);
    return t.x + upper.x * (1.0 - upper.y);
}

// Returns the path of a ray through the precipitation.
fn falling_path(u: FogUniform, c: RayCourse, t: f32) -> LayerPath {
    let top = layer_reach(u.curvature, c.low_mu, u.falling.yz - c.low);
    let length = falling_part(u, c.bend, top, c.before, c.low, max(c.high, c.low))
        + falling_part(u, c.bend, top, c.after, c.low, max(c.end_altitude, c.low));
    let ends = slab_ends(c, t, vec2f(0.0, top.y));
    return LayerPath(u.falling.x * length, ends.x, ends.y);
}

// Returns the path of a ray through the layer.
fn layer_path(u: FogUniform, c: RayCourse, h0: f32, mu: f32, t: f32) -> LayerPath {
    if fog_can(FOG_EXPONENTIAL) && u.kind == FOG_EXPONENTIAL {
        let depth = exponential_path(u, h0, mu, t, c.end_altitude, c.end_mu);
        let length = min(depth / max(layer_density(u, min(h0, c.end_altitude)), 1e-20), t);
        let first = select(0.0, t - length, c.end_altitude < h0);
        return LayerPath(depth, first, first + length);
    }
    var base = vec2f(0.0);
    if FOG_LIFTED {
        base = layer_reach(u.curvature, c.low_mu, u.knots.xy - c.low);
    }
    let top = layer_reach(u.curvature, c.low_mu, u.knots.zw - c.low);
    let length = slab_part(u, c.bend, base, top, c.before, c.low, max(c.high, c.low))
        + slab_part(u, c.bend, base, top, c.after, c.low, max(c.end_altitude, c.low));
    let ends = slab_ends(c, t, vec2f(base.x, top.y));
    return LayerPath(u.extinction * length, ends.x, ends.y);
}

// Returns the path of a ray through two media: the sum of their depths, and the means of their ends weighted by depth.
fn both_paths(fog: LayerPath, falling: LayerPath) -> LayerPath {
    let depth = fog.depth + falling.depth;
    let share = select(1.0, falling.depth / max(depth, 1e-30), fog.depth > 0.0);
    return LayerPath(depth, mix(fog.first, falling.first, share), mix(fog.last, falling.last, share));
}

// Returns 1 - e^-x, where `through` = e^-x.
fn filled_by(x: vec3f, through: vec3f) -> vec3f {
    return select(1.0 - through, x * (1.0 - x * (0.5 - x * (0.16666667 - x * 0.041666667))), x < vec3f(0.03));
}

// Returns `v`, or its first component for all channels if they are equal.
fn fog_channels(v: vec3f) -> vec3f {
    if FOG_NEUTRAL {
        return vec3f(v.x);
    }
    return v;
}

// Returns the exponential of each channel.
fn fog_exp(v: vec3f) -> vec3f {
    if FOG_NEUTRAL {
        return vec3f(exp(v.x));
    }
    return exp(v);
}

// Integral of first e^(-rate s) ds over [0, path], where `last` = first e^(-rate path).
fn attenuated(rate: vec3f, first: vec3f, last: vec3f, path: vec3f) -> vec3f {
    if FOG_NEUTRAL {
        let x = rate.x * path.x;
        let series = first.x * path.x * (1.0 - x * (0.5 - x * (0.16666667 - x * 0.041666667)));
        let small = abs(x) < 0.03;
        return vec3f(select((first.x - last.x) / select(rate.x, 1.0, small), series, small));
    }
    let x = rate * path;
    let small = abs(x) < vec3f(0.03);
    let series = first * path * (1.0 - x * (0.5 - x * (0.16666667 - x * 0.041666667)));
    return select((first - last) / select(rate, vec3f(1.0), small), series, small);
}

// Returns the mean of x over [0, 1] with the weight e^(-r x), within 2 %.
fn mean_place(r: f32) -> f32 {
    let size = min(abs(r), 1e6);
    let p = 1.0 + size * (0.33333333 + size * 0.1754386);
    let mean = p / (size * p + 2.0);
    return select(mean, 1.0 - mean, r < 0.0);
}

// Returns the source term c(mu) = c[0] + mu c[1].
fn fog_term(c: array<vec4f, 2>, mu: f32) -> vec3f {
    return c[0].xyz + mu * c[1].xyz;
}

// Source of scattered light at the scaled depth `a` below the top, for a ray whose cosine with the vertical is `mu`.
fn source_at(u: FogUniform, mu: f32, beam: vec3f, a: vec3f) -> vec3f {
    var j = fog_term(u.constant, mu) + fog_term(u.slope, mu) * a + beam * fog_exp(-a * u.inverse_mu0);
    if FOG_ABSORBING && u.absorbing != 0u {
        let below = fog_channels(u.scaling) * u.depth_total - a;
        j += fog_term(u.rise, mu) * fog_exp(-u.k * a) + fog_term(u.fall, mu) * fog_exp(-u.k * below);
    }
    return j;
}

// Returns the integral of the source over the optical path `path` between the scaled depths a0 and a1 below the top.
// `transmitted` is the transmittance of the path; `slant` is the decrease of the depth per unit of path.
fn source_along(
    u: FogUniform, mu: f32, beam: vec3f, a0: vec3f, a1: vec3f, slant: vec3f, path: vec3f, transmitted: vec3f,
) -> vec3f {
    let filled = filled_by(path, transmitted);
    let ramp = a0 * filled - slant * (filled - path * transmitted);
    let b0 = fog_exp(-a0 * u.inverse_mu0);
    let b1 = fog_exp(-a1 * u.inverse_mu0);
    var l = fog_term(u.constant, mu) * filled
        + fog_term(u.slope, mu) * ramp
        + beam * attenuated(1.0 - slant * u.inverse_mu0, b0, b1 * transmitted, path);
    if FOG_ABSORBING && u.absorbing != 0u {
        let below0 = fog_channels(u.scaling) * u.depth_total - a0;
        let below1 = fog_channels(u.scaling) * u.depth_total - a1;
        l += fog_term(u.rise, mu) * attenuated(1.0 - slant * u.k, fog_exp(-u.k * a0), fog_exp(-u.k * a1) * transmitted, path);
        l += fog_term(u.fall, mu)
            * attenuated(1.0 + slant * u.k, fog_exp(-u.k * below0), fog_exp(-u.k * below1) * transmitted, path);
    }
    return l;
}

// Returns the light in a ray near the level, whose forward lobe reaches above and below the horizon. `path` is the
// unscaled optical path, `left` its transmittance. src/fog/reference.rs describes the model.
fn grazing_light(
    u: FogUniform, mu: f32, beam: vec3f, a0: vec3f, a1: vec3f, slant: f32, path: vec3f, left: vec3f,
) -> vec3f {
    let total = fog_channels(u.scaling) * u.depth_total;
    let unforward = fog_channels(u.scaling / u.ratio);
    let s = unforward * slant;
    let spread = sqrt(slant * slant + u.spread * u.spread);
    let up = 0.5 * (1.0 + slant / spread);
    let near = min(0.5 * total, vec3f(spread));
    let to_sky = (u.sky_radiance - source_at(u, mu, beam, near)) * up;
    let to_ground = (u.ground_radiance - source_at(u, mu, beam, total - near)) * (1.0 - up);
    let sky1 = fog_exp(-a1 / spread) * left;
    let ground1 = fog_exp((a1 - total) / spread) * left;
    let edges = to_sky * attenuated(1.0 - s / spread, fog_exp(-a0 / spread), sky1, path)
        + to_ground * attenuated(1.0 + s / spread, fog_exp((a0 - total) / spread), ground1, path);
    return source_along(u, mu, beam, a0, a1, s, path, left) + (1.0 - unforward) * edges;
}

// Light scattered into a ray.
struct LayerLight {
    // Radiance of all light scattered into the ray.
    radiance: vec3f,
    // Light scattered exactly once, divided by the phase function (Fog.once).
    once: vec3f,
}

// Returns the light that is scattered into a ray. The f64 reference is `layer_radiance` in src/fog/reference.rs, which
// describes the parameters.
fn layer_radiance(u: FogUniform, mu: f32, entry_mu: f32, versine: f32, ends: vec2f, depth: f32) -> LayerLight {
    let above = select(ends, max(2.0 * u.depth_total - ends, vec2f(0.5 * u.depth_total)), ends > vec2f(u.depth_total));
    let scaling = fog_channels(u.scaling);
    let a0 = scaling * above.x;
    let a1 = scaling * above.y;
    let total = scaling * u.depth_total;
    let path = scaling * depth;
    let full = fog_channels(u.ratio) * depth;
    let through = fog_exp(-path);
    let left = fog_exp(-full);
    let mean = select(entry_mu, clamp((ends.x - ends.y) / max(depth, 1e-12), -1.0, 1.0), depth > 1e-12);
    let slant = entry_mu + (mean - entry_mu) * 2.0 / (2.0 + depth);
    let level = vec3f(slant);
    let way = depth * mean_place((1.0 - slant * u.inverse_mu0) * (1.0 - 0.5 * u.scattering.z) * depth);
    let sunlight = max((above.x - slant * way) * u.inverse_mu0 + way, 0.0);
    let phase = fog_phase_after(u, sunlight, versine);
    let beam = fog_term(u.beam, mu) + u.first * phase.x;
    let toward_sky = clamp(slant * 100.0 + 0.5, 0.0, 1.0);
    let rest = mix(total - a1, a1, vec3f(toward_sky)) / max(abs(slant), 0.005);
    let edge = a1 - level * rest;
    let clear = fog_exp(-rest);

    let rate = vec3f(1.0 - slant * u.inverse_mu0);
    let b0 = fog_exp(-a0 * u.inverse_mu0);
    let b1 = fog_exp(-a1 * u.inverse_mu0);
    let beyond = attenuated(rate, b1, fog_exp(-edge * u.inverse_mu0) * clear, rest);
    let met = attenuated(rate, b0, b1 * through, path);
    let aureole = u.first * phase.y * (met + beyond * (through - left));

    let steep = smoothstep(0.5, 2.0, abs(slant) / u.spread);
    var l = vec3f(0.0);
    if steep < 1.0 {
        l = (1.0 - steep) * grazing_light(u, mu, beam, a0, a1, slant, full, left);
    }
    if steep > 0.0 {
        let behind = mix(u.ground_radiance, u.sky_radiance, toward_sky);
        let end = behind * clear + source_along(u, mu, beam, a1, edge, level, rest, clear);
        l += steep * (source_along(u, mu, beam, a0, a1, level, path, through) + end * (through - left));
    }
    return LayerLight(max(l + aureole, vec3f(0.0)), u.first * share_unscattered(u.scattering.z, sunlight) * met);
}

// Returns the altitude at which a ray starts, m, and its length in fog, m. A ray without an object ends at the ground
// if it meets the ground.
fn fog_reach(u: FogUniform, origin: vec3f, direction: vec3f, range: f32) -> vec2f {
    let mu = clamp(direction.z, -1.0, 1.0);
    let lift = origin.z;
    let h0 = u.altitude + lift + 0.5 * u.curvature * (dot(origin, origin) - lift * lift);
    let d = h0 - u.ground;
    let c = d * (2.0 - u.curvature * d);
    let disc = mu * mu - u.curvature * c;
    let meets_ground = range >= RANGE_SKY && mu < 0.0 && d > 0.0 && disc > 0.0;
    return vec2f(h0, select(range, c / (sqrt(max(disc, 0.0)) - mu), meets_ground));
}

// Returns the effect of the layer and the precipitation, which are lit as one medium.
fn fog_layer(u: FogUniform, origin: vec3f, direction: vec3f, range: f32, hidden: f32) -> Fog {
    let mu = clamp(direction.z, -1.0, 1.0);
    let reach = fog_reach(u, origin, direction, range);
    let h0 = reach.x;
    let t = reach.y;
    let course = ray_course(u, h0, mu, t);
    var path = LayerPath(0.0, 0.0, 0.0);
    if has_own_layer() {
        path = layer_path(u, course, h0, mu, t);
        path.depth = max(path.depth - replaced_fog, 0.0);
        if FOG_PATCHES && u.patch_amount > 0.0 {
            path.depth *= patch_mean(origin, direction, path.first, path.last);
        }
    }
    if FOG_FALLING && u.falling.x > 0.0 {
        var falling = falling_path(u, course, t);
        if FOG_CURTAINS && u.curtain_amount > 0.0 {
            let curtains = curtain_mean(origin, direction, falling.first, falling.last);
            let even = falling.depth;
            falling.depth = max(even * (1.0 + curtains.x), 0.0) + 0.5 * even * even * curtains.y;
        }
        falling.depth = max(falling.depth - hidden, 0.0);
        path = both_paths(path, falling);
    }
    let depth = path.depth;
    let ends = vec2f(layer_depth_above(u, h0), layer_depth_above(u, course.end_altitude));
    let to_sun = direction - u.to_sun;
    var fog: Fog;
    let entry_mu = clamp(mu + u.curvature * path.first, -1.0, 1.0);
    let light = layer_radiance(u, mu, entry_mu, 0.5 * dot(to_sun, to_sun), ends, depth);
    fog.radiance = light.radiance;
    fog.once = light.once;
    fog.transmittance = fog_exp(-fog_channels(u.ratio) * depth);
    fog.distance = path.first + (path.last - path.first) * mean_place(depth) * u.lit;
    let inside = select((path.last - path.first) / max(range, 1e-3), 0.0, range >= RANGE_SKY);
    fog.shade = 1.0 - (1.0 - u.lit) * min(inside, 1.0);
    return fog;
}

// Returns the effect of a fog law of older simulators.
fn fog_compatible(u: FogUniform, direction: vec3f, range: f32, plane: f32) -> Fog {
    let d = select(range, plane, u.plane_distance != 0u);
    var v: f32;
    switch u.kind {
        case FOG_LINEAR_LAW: { v = clamp((u.pair.y - d) / (u.pair.y - u.pair.x), 0.0, 1.0); }
        case FOG_EXPONENTIAL_LAW: { v = exp(-u.extinction * d); }
        default: { let x = u.extinction * d; v = exp(-x * x); }
    }
    if range >= RANGE_SKY {
        let x = clamp(asin(clamp(direction.z, -1.0, 1.0)) / max(u.sky_band, 1e-6), 0.0, 1.0);
        v = select(1.0, x * x * (3.0 - 2.0 * x), u.sky_band > 0.0);
        if u.sky_band >= FOG_WHOLE_SKY {
            v = 0.0;
        }
    }
    return Fog(u.first * (1.0 - v), 0.0, vec3f(v), 1.0, vec3f(0.0));
}

// Returns the effect of fog on the pixel whose ray starts at `origin`, relative to the camera, along the unit vector
// `direction`. The object that the pixel shows lies at the distance `range`, m, along the ray and `plane`, m, from the
// camera's plane. Both are RANGE_SKY for sky.
fn fog_along(u: FogUniform, origin: vec3f, direction: vec3f, range: f32, plane: f32) -> Fog {
    return fog_beside_drops(u, origin, direction, range, plane, 0.0);
}

// Returns the effect of fog as fog_along does, where drops, flakes and stones are drawn one by one. `hidden` is their
// optical depth, which is subtracted from that of the precipitation, down to 0.
fn fog_beside_drops(u: FogUniform, origin: vec3f, direction: vec3f, range: f32, plane: f32, hidden: f32) -> Fog {
    var fog = Fog(vec3f(0.0), 0.0, vec3f(1.0), 1.0, vec3f(0.0));
    // A pipeline for a single kind of fog needs no branch.
    let is_layer = FOG_KINDS == 2u || FOG_KINDS == 4u || (FOG_KINDS == 1u && FOG_FALLING);
    if is_layer || ((FOG_KINDS & 7u) != 0u && u.kind <= FOG_EXPONENTIAL && (u.kind != FOG_CLEAR || u.falling.x > 0.0)) {
        fog = fog_layer(u, origin, direction, range, hidden);
    } else if (FOG_KINDS & 56u) != 0u && u.kind >= FOG_LINEAR_LAW {
        fog = fog_compatible(u, direction, range, plane);
    }
    return fog;
}

// Returns `behind` seen through the fog alone.
fn fog_apply(fog: Fog, behind: vec3f) -> vec3f {
    return behind * fog.transmittance + fog.radiance;
}
