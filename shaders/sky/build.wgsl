//!include "common/fullscreen.wgsl"
//!include "sky/march.wgsl"
// Tables over the planet, by orders of scattering (the scheme of Bruneton and Neyret 2008, divided for fp16 render
// targets). `gather` marches the radiance of one order along the directions of a quadrature, at every sun angle and
// altitude. `scatter` applies the phase functions and gives the source of the next order. `light` gives irradiance and
// moments. The f64 reference is src/sky/reference/solve.rs.
//
// A table is an atlas of tiles, one for each direction; a tile covers (sun angle, altitude).

struct SkyJob {
    // Order that is gathered. Order 1 is light scattered once, and sunlight on the ground.
    order: u32,
    // 1 on the last order: the orders after it are added as a geometric series.
    last: u32,
    unused_a: u32,
    unused_b: u32,
}

@group(0) @binding(0) var<uniform> air: SkyAir;
@group(0) @binding(1) var<uniform> dims: SkyDims;
// x: node on (0, 1), y: weight (Gauss-Legendre); z, w: cosine and sine of an azimuth.
@group(0) @binding(2) var<uniform> rule: array<vec4f, 24>;
@group(0) @binding(3) var sky_sampler: sampler;
@group(0) @binding(4) var<uniform> job: SkyJob;
// Tables that a pass reads: source of the order, radiance along the directions of the quadrature, and light of the
// order before. Then the sums of sources and of light over all orders before, and the result of `norm`.
@group(1) @binding(0) var sky_sources: texture_2d<f32>;
@group(1) @binding(1) var radiances: texture_2d<f32>;
@group(1) @binding(2) var lights: texture_2d<f32>;
@group(1) @binding(3) var sources_sum: texture_2d<f32>;
@group(1) @binding(4) var lights_sum: texture_2d<f32>;
@group(1) @binding(5) var norms: texture_2d<f32>;

struct Place {
    altitude: Length,
    mu_s: Cosine,
    // Texel within the tile, and the tile.
    at: vec2u,
    tile: vec2u,
}

fn place_of(position: vec4f) -> Place {
    let px = vec2u(position.xy);
    let size = vec2u(dims.suns, dims.altitudes);
    let tile = px / size;
    let at = px - tile * size;
    let x = vec2f(at) / vec2f(size - 1u);
    return Place(altitude_from_coordinate(air, x.y), sun_from_coordinate(air, x.x), at, tile);
}

// Zenith cosine of row `m` of the quadrature, and the row's weight for one azimuth of a mirrored pair.
fn rule_row(altitude: Length, m: u32) -> vec2f {
    let half_size = dims.rule_zeniths;
    let node = rule[select(m - half_size, m, m < half_size)].xy;
    return rule_direction(air, altitude, m, half_size, node) * vec2f(1.0, SKY_PI / f32(dims.rule_azimuths));
}

// Cosine and sine of azimuth `p` of the quadrature; the azimuths are equally spaced on (0, pi).
fn rule_azimuth(p: u32) -> vec2f {
    return rule[p].zw;
}

fn cosine_between(mu_a: Cosine, mu_b: Cosine, cos_azimuth: f32) -> Cosine {
    return clamp(mu_a * mu_b + sqrt(max((1.0 - mu_a * mu_a) * (1.0 - mu_b * mu_b), 0.0)) * cos_azimuth, -1.0, 1.0);
}

// Sum of the haze's phase function around the sun over the directions of the quadrature. The sum would be 1 for an
// infinitely fine quadrature. The gather divides by it, so that a peak between two directions neither gains nor loses
// light.
@fragment
fn norm(in: FullscreenVarying) -> @location(0) vec4f {
    let here = place_of(in.position);
    var sum = 0.0;
    for (var m = 0u; m < 2u * rule_zeniths(dims); m++) {
        let d = rule_row(here.altitude, m);
        for (var p = 0u; p < rule_azimuths(dims); p++) {
            sum += d.y * mie_phase(cosine_between(d.x, here.mu_s, rule_azimuth(p).x), air.asymmetry_g);
        }
    }
    return vec4f(2.0 * sum, 0.0, 0.0, 1.0);
}

// Light that the ground reflects, per unit irradiance: albedo/pi (sun + sky). The sky of order n is the light of order
// n - 1 in `lights`; sunlight is added in order 1.
fn ground_light(mu_s: Cosine) -> Radiance {
    if (job.order == 1u) {
        return air.ground_albedo / SKY_PI * max(mu_s, 0.0) * sun_transmittance(air, 0.0, mu_s);
    }
    let at = planet_texel(air, dims, 0.0, mu_s) / vec2f(textureDimensions(lights));
    return air.ground_albedo / SKY_PI * textureSampleLevel(lights, sky_sampler, at, 0.0).rgb / LIGHT_SCALE;
}

// Irradiances and moments may be negative, so they are stored without a square root, times this factor.
const LIGHT_SCALE: f32 = 4096.0;

@fragment
fn gather(in: FullscreenVarying) -> @location(0) vec4f {
    let here = place_of(in.position);
    let d = rule_row(here.altitude, here.tile.y);
    let nu = cosine_between(d.x, here.mu_s, rule_azimuth(here.tile.x).x);
    let below = here.tile.y < dims.rule_zeniths;
    let ray = sky_ray(air, here.altitude, d.x, below);
    let light = sky_march(air, dims, sky_sources, sources_of(air), sky_sampler, ray, 0.0, ray.length, min(dims.build_panels, MOST_BUILD_PANELS), here.mu_s, nu);
    var radiance = light.more;
    if (job.order == 1u) {
        let peak = max(textureLoad(norms, vec2i(here.at), 0).r, 1e-6);
        radiance = light.gas * rayleigh_phase(nu) + light.haze * mie_phase(nu, air.asymmetry_g) / peak;
    }
    if (below) {
        let mu_s_ground = clamp((ray.radius * here.mu_s + ray.length * nu) / air.bottom_m, -1.0, 1.0);
        radiance += exp(-air_optical_depth(air, columns_along(air, ray, ray.length))) * ground_light(mu_s_ground);
    }
    return sky_encode(radiance);
}

fn gathered(here: Place, m: u32, p: u32) -> vec3f {
    let texel = vec2u(p, m) * vec2u(dims.suns, dims.altitudes) + here.at;
    return sky_decode(textureLoad(radiances, vec2i(texel), 0));
}

struct Sums {
    @location(0) order: vec4f,
    @location(1) sum: vec4f,
}

// Sum of all terms of a geometric series after `term`, which follows `before`. In thick haze two small successive
// orders can have any ratio, and a series with a ratio near 1 would create colours from nothing; so the ratio is
// limited. The limit was chosen by comparison with the f64 reference. With 0.8 the error was 17 % (95th percentile) in
// haze of 7 km visibility and 41 % in haze of 3 km; with 0.55 it was 6.0 and 11.5 %. With 0.5, white ground under haze
// begins to lose light (3.1 to 4.6 %). Dust of many optical depths passes most of one order on to the next: with a
// limit of 0.55, noon in a dust storm was black.
fn tail(before: vec3f, term: vec3f) -> vec3f {
    let depth = air.mie_extinction.y * air.mie_scale_height_m;
    let limit = mix(0.55, 0.8, clamp(0.5 * (depth - 1.0), 0.0, 1.0));
    let ratio = clamp(term / max(before, vec3f(1e-12)), vec3f(0.0), vec3f(limit));
    return term * ratio / (1.0 - ratio);
}

@fragment
fn scatter(in: FullscreenVarying) -> Sums {
    let here = place_of(in.position);
    let steps = vec2f(f32(dims.azimuths - 1u), f32(dims.zeniths - 1u));
    let angle = source_direction(vec2f(here.tile) / steps);
    let mu = sin(angle.y);
    let sine = cos(angle.y);
    let azimuth = vec2f(cos(angle.x), sin(angle.x));
    var gas = vec3f(0.0);
    var haze = vec3f(0.0);
    var peak = 0.0;
    for (var m = 0u; m < 2u * rule_zeniths(dims); m++) {
        let d = rule_row(here.altitude, m);
        let base = mu * d.x;
        let turn = azimuth * (sine * sqrt(max(1.0 - d.x * d.x, 0.0)));
        for (var p = 0u; p < rule_azimuths(dims); p++) {
            let light = d.y * gathered(here, m, p);
            // Adds the direction and its mirror image.
            let part = turn * rule_azimuth(p);
            let nu_a = base + part.x + part.y;
            let nu_b = base + part.x - part.y;
            let phase = mie_phase(nu_a, air.asymmetry_g) + mie_phase(nu_b, air.asymmetry_g);
            gas += light * (rayleigh_phase(nu_a) + rayleigh_phase(nu_b));
            haze += light * phase;
            peak += d.y * phase;
        }
    }
    let density = air_density(air, here.altitude);
    let a = air.rayleigh_scattering * density.x;
    let b = air.mie_scattering * density.y;
    let mean = (a * gas + b * haze / max(peak, 1e-6)) / max(a + b, vec3f(1e-30));
    let source = select(vec3f(0.0), mean, a + b > vec3f(0.0)) * f32(here.at.x > 0u);
    let texel = vec2u(in.position.xy);
    var sum = source;
    if (job.order > 1u) {
        sum += sky_decode(textureLoad(sources_sum, vec2i(texel), 0));
    }
    if (job.last == 1u) {
        sum += tail(sky_decode(textureLoad(sky_sources, vec2i(texel), 0)), source);
    }
    return Sums(sky_encode(source), sky_encode(sum));
}

// Tile 0: irradiance of the sky on a level surface. Tiles 1 to 6: integrals of the radiance of sky and ground, times
// the real spherical harmonics 00, 1z, 1x, 2zz, 2xz, 2xx-yy in the frame (towards the sun, left, up). The integrals of
// the other harmonics up to degree 2 are 0 by symmetry.
@fragment
fn light(in: FullscreenVarying) -> Sums {
    let here = place_of(in.position);
    var order = vec3f(0.0);
    for (var m = 0u; m < 2u * rule_zeniths(dims); m++) {
        let d = rule_row(here.altitude, m);
        for (var p = 0u; p < rule_azimuths(dims); p++) {
            let x = sqrt(max(1.0 - d.x * d.x, 0.0)) * rule_azimuth(p).x;
            let yy = max(1.0 - d.x * d.x - x * x, 0.0);
            var f = max(d.x, 0.0);
            switch here.tile.x {
                case 1u: { f = 0.28209479; }
                case 2u: { f = 0.48860251 * d.x; }
                case 3u: { f = 0.48860251 * x; }
                case 4u: { f = 0.31539157 * (3.0 * d.x * d.x - 1.0); }
                case 5u: { f = 1.09254843 * x * d.x; }
                case 6u: { f = 0.54627422 * (x * x - yy); }
                default: {}
            }
            order += f * d.y * gathered(here, m, p);
        }
    }
    order *= 2.0 * LIGHT_SCALE;
    let texel = vec2u(in.position.xy);
    var sum = order;
    if (job.order > 1u) {
        sum += textureLoad(lights_sum, vec2i(texel), 0).rgb;
    }
    if (job.last == 1u) {
        let before = textureLoad(lights, vec2i(texel), 0).rgb;
        let sign_kept = before * order > vec3f(0.0);
        sum += select(vec3f(0.0), sign(order) * tail(abs(before), abs(order)), sign_kept);
    }
    return Sums(vec4f(order, 1.0), vec4f(sum, 1.0));
}

// Light scattered twice, and the share of light from all sides that the air around a point scatters back to the point
// (Hillaire 2020). Both are taken as equal in all directions.
@fragment
fn isotropic_gather(in: FullscreenVarying) -> Sums {
    let here = place_of(in.position);
    let d = rule_row(here.altitude, here.tile.y);
    let nu = cosine_between(d.x, here.mu_s, rule_azimuth(here.tile.x).x);
    let below = here.tile.y < dims.rule_zeniths;
    let ray = sky_ray(air, here.altitude, d.x, below);
    let light = sky_march(air, dims, sky_sources, sources_of(air), sky_sampler, ray, 0.0, ray.length, min(dims.build_panels, MOST_BUILD_PANELS), here.mu_s, nu);
    var radiance = (light.gas + light.haze) / (4.0 * SKY_PI);
    if (below) {
        let mu_s_ground = clamp((ray.radius * here.mu_s + ray.length * nu) / air.bottom_m, -1.0, 1.0);
        radiance += exp(-air_optical_depth(air, columns_along(air, ray, ray.length))) * ground_light(mu_s_ground);
    }
    return Sums(sky_encode(radiance), sky_encode(light.transfer));
}

@fragment
fn isotropic_scatter(in: FullscreenVarying) -> @location(0) vec4f {
    let here = place_of(in.position);
    var twice = vec3f(0.0);
    var back = vec3f(0.0);
    for (var m = 0u; m < 2u * rule_zeniths(dims); m++) {
        let weight = rule_row(here.altitude, m).y;
        for (var p = 0u; p < rule_azimuths(dims); p++) {
            let texel = vec2u(p, m) * vec2u(dims.suns, dims.altitudes) + here.at;
            twice += weight * gathered(here, m, p);
            back += weight * sky_decode(textureLoad(sky_sources, vec2i(texel), 0));
        }
    }
    // Counts both mirrored azimuths, and divides by 4 pi.
    let share = 0.5 / SKY_PI;
    let all = twice * share / (1.0 - min(back * share, vec3f(0.98)));
    return sky_encode(all * f32(here.at.x > 0u));
}

struct Once {
    @location(0) gas: vec4f,
    @location(1) haze: vec4f,
}

// Light scattered once as a function of (altitude, view angle, sun angle), without the phase functions, in the sun's
// azimuth (Elek 2008, 3.4).
@fragment
fn once(in: FullscreenVarying) -> Once {
    let here = place_of(in.position);
    let row = here.tile.y * 8u + here.tile.x;
    let mu = once_mu(air, here.altitude, row);
    let nu = cosine_between(mu, here.mu_s, 1.0);
    let ray = sky_ray(air, here.altitude, mu, row >= ONCE_ROWS);
    let light = sky_march(air, dims, sky_sources, sources_of(air), sky_sampler, ray, 0.0, ray.length, min(dims.sky_panels, MOST_SKY_PANELS), here.mu_s, nu);
    return Once(sky_encode(light.gas), sky_encode(light.haze));
}
