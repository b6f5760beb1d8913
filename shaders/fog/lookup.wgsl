// What fog does to a pixel, in closed form: no loop, no texture. The f64 twin and the derivations are in
// src/fog/reference.rs (ray and light), src/fog/light.rs (the layer's light, solved on the CPU) and src/fog/phase.rs.
//
// In the composition, with `behind` the pixel after the sky's aerial perspective over its full distance:
//     let fog = fog_along(u, ray.origin, ray.direction, range, plane);
//     out = fog_compose(fog, behind, air_radiance, air_transmittance)
// where the last two are the sky's aerial perspective at fog.distance (0 and 1 if the fog is near or has no air before
// it). So air lies in front of a far fog bank and behind the fog round the camera, without a seam between.
//!include "common/depth.wgsl"

const FOG_CLEAR: u32 = 0u;
const FOG_SLAB: u32 = 1u;
const FOG_EXPONENTIAL: u32 = 2u;
const FOG_LINEAR_LAW: u32 = 3u;
const FOG_EXPONENTIAL_LAW: u32 = 4u;
// 5: exponential-squared law.
// A band of this height, rad, covers all of the sky.
const FOG_WHOLE_SKY: f32 = 3.13845;

struct FogUniform {
    // Up at the camera.
    up: vec3f,
    kind: u32,
    to_sun: vec3f,
    // Of the camera, m.
    altitude: f32,
    // Slab: altitudes where the flanks begin and end; exponential: reference altitude, scale height.
    knots: vec4f,
    // Extinction of each channel over that at 550 nm.
    ratio: vec3f,
    // At 550 nm, 1/m; density of the compatibility laws.
    extinction: f32,
    // Scaled optical depth over depth at 550 nm.
    scaling: vec3f,
    // From the layer's top to the ground, at 550 nm.
    depth_total: f32,
    // Start and end of the linear law, m.
    linear: vec2f,
    // Band of sky that the compatibility laws cover, rad.
    sky_band: f32,
    // 1 if they measure from the camera's plane.
    plane_distance: u32,
    // Phase function: ln of Henyey-Greenstein g, ln of Draine g, Draine alpha, weight of Draine.
    lobes: vec4f,
    // Share of scattering counted as forward; smooth_g is the asymmetry of the rest.
    forward: f32,
    // 1/(planet radius + altitude), 1/m.
    curvature: f32,
    // Altitude at which rays without an object end, m.
    ground: f32,
    inverse_mu0: f32,
    // Diffusion exponent of absorbing layers.
    k: vec3f,
    absorbing: u32,
    // First scattering; colour of the compatibility laws.
    first: vec3f,
    patch_amount: f32,
    sky_radiance: vec3f,
    smooth_g: f32,
    ground_radiance: vec3f,
    // Sign of the Henyey-Greenstein g.
    hg_sign: f32,
    // Source terms c(mu) = [0] + mu [1].
    constant: array<vec4f, 2>,
    slope: array<vec4f, 2>,
    beam: array<vec4f, 2>,
    rise: array<vec4f, 2>,
    fall: array<vec4f, 2>,
    // Wave vector (camera-relative axes) and phase at the camera.
    patch_waves: array<vec4f, 6>,
}

// colour * transmittance + radiance.
struct Fog {
    radiance: vec3f,
    // Mean distance from which the fog's light comes, m.
    distance: f32,
    transmittance: vec3f,
}

struct LayerPath {
    depth: f32,
    first: f32,
    last: f32,
    end_altitude: f32,
    end_mu: f32,
}

fn fog_lobe(g: vec3f, versine: f32) -> vec3f {
    let d = (1.0 - g) * (1.0 - g) + 2.0 * g * versine;
    return (1.0 - g * g) / (d * sqrt(d)) * 0.07957747;
}

// The phase function per steradian, at the angle whose 1 - cos is `versine`, for sunlight that has travelled the
// optical path `slant`; derivation in src/fog/phase.rs, fog_phase_after.
fn fog_phase_after(u: FogUniform, slant: f32, versine: f32) -> f32 {
    let fs = min(u.forward * slant, 1e4);
    let share = select((1.0 - exp(-fs)) / max(fs, 1e-9), 1.0 - 0.5 * fs, fs < 1e-3);
    let order = inverseSqrt(share);
    let met = max(order * u.lobes.w, 1.0);
    let weight = 1.0 - pow(1.0 - u.lobes.w, order);
    let alpha = u.lobes.z / (met * met);
    let g = vec3f(u.hg_sign * exp(u.lobes.x * order), exp(u.lobes.y * met), u.smooth_g);
    let lobe = fog_lobe(g, versine);
    let c = 1.0 - versine;
    let draine = lobe.y * (1.0 + alpha * c * c) / (1.0 + alpha * (1.0 + 2.0 * g.y * g.y) * 0.33333333);
    let even = (1.0 - u.forward) * lobe.z;
    return even + share * (mix(lobe.x, draine, weight) - even);
}

fn layer_rise(curvature: f32, mu: f32, t: f32) -> f32 {
    let q = t * (2.0 * mu + curvature * t);
    return q / (1.0 + sqrt(max(1.0 + curvature * q, 0.0)));
}

fn layer_density(u: FogUniform, h: f32) -> f32 {
    return u.extinction * exp(min((u.knots.x - h) / u.knots.y, 60.0));
}

fn layer_depth_above(u: FogUniform, h: f32) -> f32 {
    if u.kind == FOG_EXPONENTIAL {
        return layer_density(u, h) * u.knots.y;
    }
    let k = u.knots;
    let in_top = k.w - clamp(h, k.z, k.w);
    let in_base = clamp(h, k.x, k.y);
    let top = in_top * in_top * 0.5 / max(k.w - k.z, 1e-3);
    let base = (k.y - in_base) * (k.y + in_base - 2.0 * k.x) * 0.5 / max(k.y - k.x, 1e-3);
    return u.extinction * (top + (k.z - clamp(h, k.y, k.z)) + base);
}

// Distances at which a ray that starts `drop` above four altitudes meets them going down.
fn layer_enter(curvature: f32, mu: f32, turn: f32, drop: vec4f) -> vec4f {
    let c = drop * (2.0 - curvature * drop);
    let disc = mu * mu - curvature * c;
    let t = min(c / max(sqrt(max(disc, vec4f(0.0))) - mu, vec4f(1e-20)), vec4f(turn));
    return select(select(t, vec4f(turn), disc < vec4f(0.0)), vec4f(0.0), drop <= vec4f(0.0));
}

// And going up, after the lowest point.
fn layer_leave(curvature: f32, mu: f32, turn: f32, drop: vec4f) -> vec4f {
    let c = drop * (2.0 - curvature * drop);
    let disc = mu * mu - curvature * c;
    let root = sqrt(max(disc, vec4f(0.0)));
    let t = select((root - mu) / max(curvature, 1e-30), -c / max(mu + root, vec4f(1e-20)), vec4<bool>(mu >= 0.0));
    let above = (disc < vec4f(0.0)) | (vec4<bool>(mu >= 0.0) & (drop >= vec4f(0.0)));
    return select(max(t, vec4f(turn)), vec4f(turn), above);
}

fn slab_part(u: FogUniform, bend: f32, cross: vec4f, low: f32, high: f32) -> f32 {
    let length = abs(cross.yzw - cross.xyz);
    let h = clamp(u.knots, vec4f(low), vec4f(high));
    let mean = 0.5 * (h.xz + h.yw) - bend * length.xz * length.xz / 12.0;
    let share = clamp((mean - u.knots.xz) / max(u.knots.yw - u.knots.xz, vec2f(1e-3)), vec2f(0.0), vec2f(1.0));
    return length.x * share.x + length.y + length.z * (1.0 - share.y);
}

// e^(z^2) erfc(z), z >= 0.
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

fn exponential_up(k: f32, scale: f32, mu: f32, rise: f32) -> f32 {
    let z = mu / sqrt(2.0 * k * scale);
    let x = rise / scale;
    return sqrt(1.57079633 * scale / k) * (scaled_erfc(z) - exp(-x) * scaled_erfc(sqrt(max(z * z + x, 0.0))));
}

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

fn layer_path(u: FogUniform, h0: f32, mu: f32, t: f32) -> LayerPath {
    let k = u.curvature;
    let end_rise = layer_rise(k, mu, t);
    let end_altitude = h0 + end_rise;
    let end_mu = clamp((mu + k * t) / (1.0 + k * end_rise), -1.0, 1.0);
    if u.kind == FOG_EXPONENTIAL {
        let depth = exponential_path(u, h0, mu, t, end_altitude, end_mu);
        let length = min(depth / max(layer_density(u, min(h0, end_altitude)), 1e-20), t);
        let first = select(0.0, t - length, end_altitude < h0);
        return LayerPath(depth, first, first + length, end_altitude, end_mu);
    }
    let free = select(0.0, -mu / max(k, 1e-30), mu < 0.0);
    let turn = min(free, t);
    let low = h0 + layer_rise(k, mu, turn);
    let bend = k * (1.0 - mu * mu);
    let drop = h0 - u.knots;
    let down = min(layer_enter(k, mu, free, drop), vec4f(turn));
    let up = clamp(layer_leave(k, mu, free, drop), vec4f(turn), vec4f(t));
    let down_length = slab_part(u, bend, down, min(low, h0), h0);
    let up_length = slab_part(u, bend, up, low, max(end_altitude, low));
    let first = select(up.x, down.w, down_length > 0.0);
    let last = select(down.x, up.w, up_length > 0.0);
    return LayerPath(u.extinction * (down_length + up_length), first, last, end_altitude, end_mu);
}

fn attenuated(rate: vec3f, first: vec3f, last: vec3f, path: vec3f) -> vec3f {
    let x = rate * path;
    let small = abs(x) < vec3f(0.03);
    let series = first * path * (1.0 - x * (0.5 - x * (0.16666667 - x * 0.041666667)));
    return select((first - last) / select(rate, vec3f(1.0), small), series, small);
}

// Mean of x over [0, 1] weighted by e^(-r x).
fn mean_place(r: f32) -> f32 {
    let size = abs(r);
    let e = exp(-size);
    let mean = select(1.0 / max(size, 0.1) - e / max(1.0 - e, 0.05), 0.5 - size / 12.0, size < 0.1);
    return select(mean, 1.0 - mean, r < 0.0);
}

fn fog_term(c: array<vec4f, 2>, mu: f32) -> vec3f {
    return c[0].xyz + mu * c[1].xyz;
}

fn source_at(u: FogUniform, mu: f32, beam: vec3f, a: vec3f) -> vec3f {
    var j = fog_term(u.constant, mu) + fog_term(u.slope, mu) * a + beam * exp(-a * u.inverse_mu0);
    if u.absorbing != 0u {
        let below = u.scaling * u.depth_total - a;
        j += fog_term(u.rise, mu) * exp(-u.k * a) + fog_term(u.fall, mu) * exp(-u.k * below);
    }
    return j;
}

fn layer_radiance(u: FogUniform, mu: f32, versine: f32, path: LayerPath, above: vec2f, depth: f32) -> vec3f {
    let a0 = u.scaling * above.x;
    let a1 = u.scaling * above.y;
    let p = u.scaling * depth;
    let through = exp(-p);
    let slant = select(mu, clamp((above.x - above.y) / max(depth, 1e-12), -1.0, 1.0), depth > 1e-12);
    let way = depth * mean_place((1.0 - slant * u.inverse_mu0) * (1.0 - u.forward) * depth);
    let sunlight = max((above.x - slant * way) * u.inverse_mu0 + way, 0.0);
    let beam = fog_term(u.beam, mu) + u.first * fog_phase_after(u, sunlight, versine);

    let filled = attenuated(vec3f(1.0), vec3f(1.0), through, p);
    let ramp = a0 * filled - slant * (filled - p * through);
    let b0 = exp(-a0 * u.inverse_mu0);
    let b1 = exp(-a1 * u.inverse_mu0);
    var l = fog_term(u.constant, mu) * filled
        + fog_term(u.slope, mu) * ramp
        + beam * attenuated(vec3f(1.0 - slant * u.inverse_mu0), b0, b1 * through, p);
    let total = u.scaling * u.depth_total;
    if u.absorbing != 0u {
        l += fog_term(u.rise, mu) * attenuated(1.0 - slant * u.k, exp(-u.k * a0), exp(-u.k * a1) * through, p);
        l += fog_term(u.fall, mu)
            * attenuated(1.0 + slant * u.k, exp(-u.k * (total - a0)), exp(-u.k * (total - a1)) * through, p);
    }
    let toward_sky = clamp(path.end_mu * 100.0 + 0.5, 0.0, 1.0);
    let behind = mix(u.ground_radiance, u.sky_radiance, toward_sky);
    let rest = mix(total - a1, a1, vec3f(toward_sky)) / max(abs(path.end_mu), 0.005);
    let clear = exp(-rest);
    let end = behind * clear + source_at(u, mu, beam, a1) * (1.0 - clear);
    l += end * (through - exp(-u.ratio * depth));
    return max(l, vec3f(0.0));
}

fn patch_mean(u: FogUniform, origin: vec3f, direction: vec3f, first: f32, last: f32) -> f32 {
    let middle = 0.5 * (first + last);
    let half = 0.5 * (last - first);
    var sum = 0.0;
    for (var i = 0; i < 6; i++) {
        let wave = u.patch_waves[i];
        let along = dot(wave.xyz, direction);
        let x = along * half;
        let near = abs(x) < 1e-2;
        let sinc = select(sin(x) / select(x, 1.0, near), 1.0 - x * x / 6.0, near);
        sum += cos(wave.w + dot(wave.xyz, origin) + along * middle) * sinc;
    }
    return max(1.0 + u.patch_amount * 0.5 * sum, 0.0);
}

fn fog_layer(u: FogUniform, origin: vec3f, direction: vec3f, range: f32) -> Fog {
    let mu = clamp(dot(direction, u.up), -1.0, 1.0);
    let lift = dot(origin, u.up);
    let h0 = u.altitude + lift + 0.5 * u.curvature * (dot(origin, origin) - lift * lift);
    var t = range;
    if range >= RANGE_SKY && mu < 0.0 && h0 > u.ground {
        let turn = -mu / max(u.curvature, 1e-30);
        let ground = layer_enter(u.curvature, mu, turn, vec4f(h0 - u.ground)).x;
        if ground < turn {
            t = ground;
        }
    }
    let path = layer_path(u, h0, mu, t);
    var depth = path.depth;
    if u.patch_amount > 0.0 {
        depth *= patch_mean(u, origin, direction, path.first, path.last);
    }
    let above = min(vec2f(layer_depth_above(u, h0), layer_depth_above(u, path.end_altitude)), vec2f(u.depth_total));
    let to_sun = direction - u.to_sun;
    var fog: Fog;
    fog.radiance = layer_radiance(u, mu, 0.5 * dot(to_sun, to_sun), path, above, depth);
    fog.transmittance = exp(-u.ratio * depth);
    fog.distance = path.first + (path.last - path.first) * mean_place(depth);
    return fog;
}

fn fog_compatible(u: FogUniform, direction: vec3f, range: f32, plane: f32) -> Fog {
    let d = select(range, plane, u.plane_distance != 0u);
    var v: f32;
    switch u.kind {
        case FOG_LINEAR_LAW: { v = clamp((u.linear.y - d) / (u.linear.y - u.linear.x), 0.0, 1.0); }
        case FOG_EXPONENTIAL_LAW: { v = exp(-u.extinction * d); }
        default: { let x = u.extinction * d; v = exp(-x * x); }
    }
    if range >= RANGE_SKY {
        let x = clamp(asin(clamp(dot(direction, u.up), -1.0, 1.0)) / max(u.sky_band, 1e-6), 0.0, 1.0);
        v = select(1.0, x * x * (3.0 - 2.0 * x), u.sky_band > 0.0);
        if u.sky_band >= FOG_WHOLE_SKY {
            v = 0.0;
        }
    }
    return Fog(u.first * (1.0 - v), 0.0, vec3f(v));
}

// What fog does to the pixel whose ray starts at `origin` (relative to the camera) along `direction` (unit), with an
// object at `range` metres, `plane` from the camera's plane; RANGE_SKY for sky.
fn fog_along(u: FogUniform, origin: vec3f, direction: vec3f, range: f32, plane: f32) -> Fog {
    switch u.kind {
        case FOG_CLEAR: { return Fog(vec3f(0.0), 0.0, vec3f(1.0)); }
        case FOG_SLAB, FOG_EXPONENTIAL: { return fog_layer(u, origin, direction, range); }
        default: { return fog_compatible(u, direction, range, plane); }
    }
}

// `behind` seen through the fog alone.
fn fog_apply(fog: Fog, behind: vec3f) -> vec3f {
    return behind * fog.transmittance + fog.radiance;
}

// `behind` holds the air of the whole distance; `air_radiance` and `air_transmittance` are the air's up to fog.distance.
fn fog_compose(fog: Fog, behind: vec3f, air_radiance: vec3f, air_transmittance: vec3f) -> vec3f {
    return air_radiance + air_transmittance * fog.radiance + fog.transmittance * (behind - air_radiance);
}
