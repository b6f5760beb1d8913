//!include "sky/maps.wgsl"
// Light along a piece of a ray, marched with few cells: columns of air in each cell by Simpson's rule, light that
// leaves the cell by (1 - e^-tau)/tau, so that thick air is as right as thin air.

override DIRECTIONAL: bool = true;

struct SkyLight {
    // Scattered once by gas and by haze, the phase functions left out; scattered more often; per unit irradiance.
    gas: Radiance,
    haze: Radiance,
    more: Radiance,
    // What would be scattered into the ray in a field of radiance 1.
    transfer: vec3f,
    // Optical depth of the piece.
    depth: vec3f,
}

// Light scattered more than once into a direction, per unit of scattering coefficient and of sun: 1/sr.
fn more_scattered(
    air: SkyAir, dims: SkyDims, sources: texture_2d<f32>, smp: sampler,
    altitude: Length, mu_s: Cosine, mu: Cosine, nu: Cosine,
) -> vec3f {
    let at = planet_texel(air, dims, altitude, mu_s);
    let tile = vec2f(f32(dims.suns), f32(dims.altitudes));
    if (!DIRECTIONAL) {
        return sky_decode(textureSampleLevel(sources, smp, at / tile, 0.0));
    }
    let sines = sqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 1e-9));
    let cos_azimuth = clamp((nu - mu * mu_s) / sines, -1.0, 1.0);
    let steps = vec2f(f32(dims.azimuths - 1u), f32(dims.zeniths - 1u));
    let d = vec2f(sky_acos(cos_azimuth), sky_acos(mu)) * (steps / SKY_PI);
    let i = min(floor(d), steps - 1.0);
    let f = d - i;
    let scale = 1.0 / (tile * (steps + 1.0));
    let uv = (at + i * tile) * scale;
    let step = tile * scale;
    let a = textureSampleLevel(sources, smp, uv, 0.0);
    let b = textureSampleLevel(sources, smp, uv + vec2f(step.x, 0.0), 0.0);
    let c = textureSampleLevel(sources, smp, uv + vec2f(0.0, step.y), 0.0);
    let e = textureSampleLevel(sources, smp, uv + step, 0.0);
    return sky_decode(mix(mix(a, b, f.x), mix(c, e, f.x), f.y));
}

// Marches from `start` to `end` metres along the ray. mu_s: the light's zenith cosine at the ray's start, nu: cosine of
// the angle between ray and light. The ray is cut at its perigee; cells are even in the square root of the altitude
// over each part's low end, which is even in length for a grazing part.
fn sky_march(
    air: SkyAir, dims: SkyDims, sources: texture_2d<f32>, smp: sampler,
    ray: SkyRay, start: Length, end: Length, cells: u32, mu_s: Cosine, nu: Cosine,
) -> SkyLight {
    let t_ray = ray.radius * ray.mu;
    let t_start = t_ray + start;
    let t_end = t_ray + end;
    let two_parts = t_start < 0.0 && t_end > 0.0;
    let per_part = select(cells, (2u * cells + 2u) / 3u, two_parts);
    let count = select(per_part, 2u * per_part, two_parts);
    var out = SkyLight(vec3f(0.0), vec3f(0.0), vec3f(0.0), vec3f(0.0), vec3f(0.0));
    var passed = vec3f(1.0);
    var s1 = 0.0;
    var density1 = vec3f(0.0);
    for (var k = 0u; k < count; k++) {
        let down = t_start < 0.0 && k < per_part;
        let index = select(k, k - per_part, two_parts && !down);
        // Low end of this part: signed distance from the perigee, altitude and radius; and the part's length.
        let t_low = max(select(t_start, -t_end, down), 0.0);
        let part = select(end - start, select(t_end, -t_start, down), two_parts);
        let low = altitude_along(ray.radius, ray.altitude, ray.mu, select(max(start, -t_ray), min(end, -t_ray), down));
        let h_low = max(select(low, ray.perigee, two_parts), 0.0);
        let r_low = air.bottom_m + h_low;
        let q_part = part * (part + 2.0 * t_low);
        let rise = q_part / (r_low + sqrt(r_low * r_low + q_part));
        let x = select(f32(index + 1u), f32(per_part - index - 1u), down) / f32(per_part);
        if (index == 0u) {
            s1 = select(0.0, part, down);
            density1 = air_density(air, h_low + select(0.0, rise, down));
        }
        let dh = rise * x * x;
        let q = dh * (2.0 * r_low + dh);
        let s2 = select(q / max(t_low + sqrt(t_low * t_low + q), 1e-6), part, x >= 1.0);
        let sm = 0.5 * (s1 + s2);
        let qm = sm * (sm + 2.0 * t_low);
        let rm = sqrt(r_low * r_low + qm);
        let hm = h_low + qm / (r_low + rm);
        let density2 = air_density(air, h_low + dh);
        let columns = abs(s2 - s1) / 6.0 * (density1 + 4.0 * air_density(air, hm) + density2);
        let depth = air_optical_depth(air, columns);
        // Where the middle is, seen from the ray's start.
        let before = select(select(start, -t_ray, two_parts), start + part, down);
        let distance = before + select(sm, -sm, down);
        let mu_s_here = clamp((ray.radius * mu_s + distance * nu) / rm, -1.0, 1.0);
        let mu_here = clamp(select(t_low + sm, -(t_low + sm), down) / rm, -1.0, 1.0);
        let weight = passed * air_escape(depth);
        let gas = weight * air.rayleigh_scattering * columns.x;
        let haze = weight * air.mie_scattering * columns.y;
        let sun = sun_transmittance(air, hm, mu_s_here);
        out.gas += gas * sun;
        out.haze += haze * sun;
        out.more += (gas + haze) * more_scattered(air, dims, sources, smp, hm, mu_s_here, mu_here, nu);
        out.transfer += gas + haze;
        out.depth += depth;
        passed *= exp(-depth);
        s1 = s2;
        density1 = density2;
    }
    return out;
}
