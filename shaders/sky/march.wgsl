//!include "sky/maps.wgsl"
// Light along an interval of a ray, by a Gauss rule with nodes that follow the density of the air.

override DIRECTIONAL: bool = true;

struct SkyLight {
    // Light per unit irradiance: scattered once by gas and by haze, without the phase functions; and scattered more
    // often.
    gas: Radiance,
    haze: Radiance,
    more: Radiance,
    // Light that would be scattered into the ray in a field of radiance 1.
    transfer: vec3f,
}

// Rectangle of the sources of one triple in their texture, as shares of its size: xy the corner, zw the size. The
// triples of a set lie one below the other.
fn sources_of(air: SkyAir) -> vec4f {
    return vec4f(0.0, air.layer / air.layers, 1.0, 1.0 / air.layers);
}

// Light scattered more than once into a direction, 1/sr, per unit of scattering coefficient and of sunlight.
fn more_scattered(
    air: SkyAir, dims: SkyDims, sources: texture_2d<f32>, place: vec4f, smp: sampler,
    altitude: Length, mu_s: Cosine, mu: Cosine, nu: Cosine,
) -> vec3f {
    let at = planet_texel(air, dims, altitude, mu_s);
    let tile = vec2f(f32(dims.suns), f32(dims.altitudes));
    if (!DIRECTIONAL) {
        return sky_decode(textureSampleLevel(sources, smp, at / tile * place.zw + place.xy, 0.0));
    }
    let sines = sqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 1e-9));
    let cos_azimuth = clamp((nu - mu * mu_s) / sines, -1.0, 1.0);
    let steps = vec2f(f32(dims.azimuths - 1u), f32(dims.zeniths - 1u));
    let d = source_coordinate(mu, cos_azimuth) * steps;
    let i = min(floor(d), steps - 1.0);
    let f = d - i;
    let scale = place.zw / (tile * (steps + 1.0));
    let uv = (at + i * tile) * scale + place.xy;
    let step = tile * scale;
    let a = textureSampleLevel(sources, smp, uv, 0.0);
    let b = textureSampleLevel(sources, smp, uv + vec2f(step.x, 0.0), 0.0);
    let c = textureSampleLevel(sources, smp, uv + vec2f(0.0, step.y), 0.0);
    let e = textureSampleLevel(sources, smp, uv + step, 0.0);
    return sky_decode(mix(mix(a, b, f.x), mix(c, e, f.x), f.y));
}

// Distribution of a march's nodes over an interval of a ray: s = spread (e^(k x) - 1) from its origin. Nodes are even
// in length within `spread` of the origin, and even in the logarithm of the length beyond.
struct Stretch {
    origin: Length,
    // 1: away from the ray's start; -1: towards it.
    sense: f32,
    spread: Length,
    k: f32,
}

// The origin is the lower end, where the air is dense; or the near end, if the air there hides the rest.
fn stretch_of(air: SkyAir, ray: SkyRay, a: Length, b: Length, mu_s: Cosine) -> Stretch {
    let near = altitude_along(ray.radius, ray.altitude, ray.mu, a);
    let far = altitude_along(ray.radius, ray.altitude, ray.mu, b);
    let density_near = air_density(air, near);
    let reds = air.rayleigh_scattering * density_near.x + air.mie_extinction * density_near.y;
    let sigma_near = max(reds.x, max(reds.y, reds.z));
    let is_near = near <= far || sigma_near * (b - a) > 2.0;
    let origin = select(b, a, is_near);
    let altitude = max(select(far, near, is_near), 0.0);
    let density = air_density(air, altitude);
    let gas = dot(air.rayleigh_scattering, vec3f(1.0)) * density.x + 1e-20;
    let haze = dot(air.mie_extinction, vec3f(1.0)) * density.y;
    let per_height = (gas / air.rayleigh_scale_height_m + haze / air.mie_scale_height_m) / (gas + haze);
    let mu = abs(ray.radius * ray.mu + origin) / (air.bottom_m + altitude);
    let sigma = select(0.0, sigma_near, is_near);
    let per_length = per_height * mu + sqrt(0.5 * per_height / air.bottom_m) + sigma * (1.0 + mu / (max(mu_s, 0.0) + 0.1));
    let spread = 1.0 / (per_length + 0.5 / max(b - a, 1e-3));
    return Stretch(origin, select(-1.0, 1.0, is_near), spread, log(1.0 + (b - a) / spread));
}

// Gauss-Legendre rule of 4 nodes on (0, 1): node and weight.
fn gauss_4(i: u32) -> vec2f {
    let outer = i == 0u || i == 3u;
    let x = select(0.16999052, 0.43056816, outer);
    return vec2f(0.5 + select(x, -x, i < 2u), select(0.32607258, 0.17392742, outer));
}

// Marches from `start` to `end` metres along the ray. mu_s is the light's zenith cosine at the ray's start, and nu the
// cosine of the angle between ray and light. The ray is cut at its perigee and at the edges of the planet's shadow.
// Each interval takes `panels` panels of 4 nodes, or fewer if there are several intervals.
fn sky_march(
    air: SkyAir, dims: SkyDims, sources: texture_2d<f32>, place: vec4f, smp: sampler,
    ray: SkyRay, start: Length, end: Length, panels: u32, mu_s: Cosine, nu: Cosine,
) -> SkyLight {
    let t_ray = ray.radius * ray.mu;
    let shadow = shadow_stretch(air, ray, mu_s, nu);
    // Cuts inside the ray, in order. Cuts outside it are moved to its end.
    var cuts = vec3f(-t_ray, shadow);
    let margin = 1e-3 * (end - start);
    let known = vec3<bool>(true, vec2<bool>(shadow.y > shadow.x));
    let inside = (cuts > vec3f(start + margin)) & (cuts < vec3f(end - margin)) & known;
    cuts = select(vec3f(end), cuts, inside);
    cuts = vec3f(min(cuts.x, cuts.y), max(cuts.x, cuts.y), cuts.z);
    cuts = vec3f(cuts.x, min(cuts.y, cuts.z), max(cuts.y, cuts.z));
    cuts = vec3f(min(cuts.x, cuts.y), max(cuts.x, cuts.y), cuts.z);
    let stretches = 1u + u32(inside.x) + u32(inside.y) + u32(inside.z);
    let per_stretch = 4u * select((3u * panels + 4u) / 5u, panels, stretches == 1u);
    let columns_start = sky_columns(air, ray);
    var out = SkyLight(vec3f(0.0), vec3f(0.0), vec3f(0.0), vec3f(0.0));
    var stretch: Stretch;
    for (var k = 0u; k < stretches * per_stretch; k++) {
        let part = k / per_stretch;
        let index = k - part * per_stretch;
        if (index == 0u) {
            let a = select(select(select(cuts.z, cuts.y, part == 2u), cuts.x, part == 1u), start, part == 0u);
            let b = select(select(select(end, cuts.z, part == 2u), cuts.y, part == 1u), cuts.x, part == 0u);
            stretch = stretch_of(air, ray, a, b, mu_s);
        }
        let panel = index / 4u;
        let node = gauss_4(index - 4u * panel);
        let share = 4.0 / f32(per_stretch);
        let grown = stretch.spread * exp(stretch.k * (f32(panel) + node.x) * share);
        let s = grown - stretch.spread;
        let distance = stretch.origin + stretch.sense * s;
        let ds = node.y * share * stretch.k * grown;
        let altitude = clamp(altitude_along(ray.radius, ray.altitude, ray.mu, distance), 0.0, air.thickness_m);
        let r = air.bottom_m + altitude;
        let mu_here = clamp((t_ray + distance) / r, -1.0, 1.0);
        let mu_s_here = clamp((ray.radius * mu_s + distance * nu) / r, -1.0, 1.0);
        let columns = columns_to(air, ray, columns_start, altitude, select(-1.0, 1.0, t_ray + distance >= 0.0));
        let weight = ds * exp(-air_optical_depth(air, columns));
        let density = air_density(air, altitude);
        let gas = weight * air.rayleigh_scattering * density.x;
        let haze = weight * air.mie_scattering * density.y;
        let sun = sun_transmittance(air, altitude, mu_s_here);
        out.gas += gas * sun;
        out.haze += haze * sun;
        out.more += (gas + haze) * more_scattered(air, dims, sources, place, smp, altitude, mu_s_here, mu_here, nu);
        out.transfer += gas + haze;
    }
    return out;
}
