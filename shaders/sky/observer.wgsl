//!include "common/fullscreen.wgsl"
//!include "sky/march.wgsl"
//!include "sky/view.wgsl"
// Tables of an observer: the sky by direction, and the air in front of objects by direction and distance. They hold two
// colours. One is light scattered by gas or more than once, which is complete. The other is light scattered once by
// haze without its phase function. Pixels apply that function, so that the glow around the light is sharp.

struct SkyObserver {
    altitude: Length,
    // Zenith cosine of the light.
    mu_s: Cosine,
    // 1 draws the air in front of objects, 0 the sky.
    is_air: u32,
    unused: u32,
    edges: SkyEdges,
}

@group(0) @binding(0) var<uniform> air: SkyAir;
@group(0) @binding(1) var<uniform> dims: SkyDims;
@group(0) @binding(2) var sky_sources: texture_2d<f32>;
@group(0) @binding(3) var sky_sampler: sampler;
@group(0) @binding(4) var once_gas: texture_2d<f32>;
@group(0) @binding(5) var once_haze: texture_2d<f32>;
// Air at each triple of wavelengths. Not read if the planet's own three wavelengths are the only ones.
@group(0) @binding(6) var<uniform> airs: array<SkyAir, 5>;
@group(1) @binding(0) var<uniform> observer: SkyObserver;

override LAYERS: u32 = 1u;

struct SkyTexel {
    @location(0) smooth_light: vec4f,
    @location(1) haze_light: vec4f,
}

struct ViewTexel {
    mu: Cosine,
    nu: Cosine,
    below: bool,
}

fn view_texel(texel: vec2u, azimuths: u32, above: u32, below: u32) -> ViewTexel {
    let is_below = texel.y >= above;
    let row = select(texel.y, texel.y - above, is_below);
    let rows = select(above, below, is_below);
    // From space the row at the edge of the air looks straight up, because everything beyond the edge is exactly dark.
    let beyond = !is_below && row == rows - 1u && observer.edges.top > 0.0;
    let mu = select(view_mu(observer.edges, f32(row) / f32(rows - 1u), is_below), 1.0, beyond);
    let azimuth = SKY_PI * f32(texel.x) / f32(azimuths - 1u);
    let sines = sqrt(max((1.0 - mu * mu) * (1.0 - observer.mu_s * observer.mu_s), 0.0));
    return ViewTexel(mu, clamp(mu * observer.mu_s + sines * cos(azimuth), -1.0, 1.0), is_below);
}

// Zenith cosine of the light at the ray's start, which is not the observer if the observer is in space.
fn mu_s_at_start(ray: SkyRay, nu: Cosine) -> Cosine {
    let r = air.bottom_m + max(observer.altitude, 0.0);
    return clamp((r * observer.mu_s + ray.before * nu) / ray.radius, -1.0, 1.0);
}

// Light divided by the opacity of its air. This is the mean source, which hardly varies with distance.
fn as_source(light: vec3f, depth: vec3f) -> vec4f {
    return sky_encode_signed(light / max(air_opacity(depth), vec3f(1e-30)));
}

struct KeptLight {
    // Light scattered by gas or more than once; and light scattered once by haze, without the phase function.
    even: vec3f,
    haze: vec3f,
}

// Light from the ray's start to `end`, summed over all triples into the three values that tables keep.
fn kept_light(ray: SkyRay, end: Length, panels: u32, nu: Cosine) -> KeptLight {
    let mu_s = mu_s_at_start(ray, nu);
    if (LAYERS == 1u) {
        let light = sky_march(air, dims, sky_sources, sources_of(air), sky_sampler, ray, 0.0, end, panels, mu_s, nu);
        return KeptLight(light.gas * rayleigh_phase(nu) + light.more, light.haze);
    }
    var sum = KeptLight(vec3f(0.0), vec3f(0.0));
    for (var k = 0u; k < LAYERS; k++) {
        let part = airs[k];
        let light = sky_march(part, dims, sky_sources, sources_of(part), sky_sampler, ray, 0.0, end, panels, mu_s, nu);
        sum.even += air_part(part, light.gas * rayleigh_phase(nu) + light.more);
        sum.haze += air_part(part, light.haze);
    }
    return sum;
}

// Azimuth and row of the sky for a texel of an observer's tables.
fn sky_texel(px: vec2u) -> vec2u {
    return px.yx - vec2u(dims.sky_y, dims.sky_x);
}

// Draws both sky and air with one entry point. Most of the time that a software driver takes to compile is for the
// march, which both share.
@fragment
fn observed(in: FullscreenVarying) -> SkyTexel {
    let is_air = observer.is_air == 1u;
    let px = vec2u(in.position.xy);
    let slice = select(0u, px.x / dims.air_azimuths, is_air);
    let size = select(
        vec3u(dims.sky_azimuths, dims.sky_above, dims.sky_below),
        vec3u(dims.air_azimuths, dims.air_above, dims.air_below),
        is_air,
    );
    // Sums instead of a select: llvmpipe of Mesa 22.3 crashes where a select transposes the picture.
    let air_px = vec2u(px.x - slice * dims.air_azimuths, px.y);
    let texel = observer.is_air * air_px + (1u - observer.is_air) * sky_texel(px);
    let view = view_texel(texel, size.x, size.y, size.z);
    let ray = sky_ray(air, observer.altitude, view.mu, view.below);
    let w = max(f32(slice), 0.05) / f32(dims.air_slices - 1u);
    let end = select(ray.length, slice_distance(w, ray.length), is_air);
    let light = kept_light(ray, end, select(min(dims.sky_panels, MOST_SKY_PANELS), min(dims.air_panels, MOST_AIR_PANELS), is_air), view.nu);
    if !is_air && !view.below {
        return SkyTexel(sky_encode_signed(light.even), sky_encode_signed(light.haze));
    }
    let depth = air_optical_depth(air, columns_along(air, ray, end));
    return SkyTexel(as_source(light.even, depth), as_source(light.haze, depth));
}

struct TableLight {
    gas: vec3f,
    haze: vec3f,
}

// Light from the table of light scattered once, at a point inside the air.
fn once_at(altitude: Length, mu: Cosine, mu_s: Cosine, below: bool) -> TableLight {
    let at = planet_texel(air, dims, altitude, mu_s);
    let row = once_row(air, altitude, mu, below);
    let tile = vec2f(f32(dims.suns), f32(dims.altitudes));
    let a = (at + vec2f(row.x % 8.0, floor(row.x / 8.0)) * tile) / (8.0 * tile);
    let b = (at + vec2f((row.x + 1.0) % 8.0, floor((row.x + 1.0) / 8.0)) * tile) / (8.0 * tile);
    let gas = mix(textureSampleLevel(once_gas, sky_sampler, a, 0.0), textureSampleLevel(once_gas, sky_sampler, b, 0.0), row.y);
    let haze =
        mix(textureSampleLevel(once_haze, sky_sampler, a, 0.0), textureSampleLevel(once_haze, sky_sampler, b, 0.0), row.y);
    return TableLight(sky_decode(gas), sky_decode(haze));
}

// Light along a whole ray. From space it is the light at the point where the ray enters the air, with the sun angle
// there.
@fragment
fn sky_from_table(in: FullscreenVarying) -> SkyTexel {
    let view = view_texel(sky_texel(vec2u(in.position.xy)), dims.sky_azimuths, dims.sky_above, dims.sky_below);
    let ray = sky_ray(air, observer.altitude, view.mu, view.below);
    let light = once_at(ray.altitude, ray.mu, mu_s_at_start(ray, view.nu), view.below);
    let even = light.gas * rayleigh_phase(view.nu) * f32(ray.length > 0.0);
    let haze = light.haze * f32(ray.length > 0.0);
    if (view.below) {
        let depth = air_optical_depth(air, columns_along(air, ray, ray.length));
        return SkyTexel(as_source(even, depth), as_source(haze, depth));
    }
    return SkyTexel(sky_encode(even), sky_encode(haze));
}

// Light along the first part of a ray: the light of the whole ray less the light from beyond the part, which the part
// dims.
@fragment
fn volume_from_table(in: FullscreenVarying) -> SkyTexel {
    let px = vec2u(in.position.xy);
    let slice = px.x / dims.air_azimuths;
    let texel = vec2u(px.x - slice * dims.air_azimuths, px.y);
    let view = view_texel(texel, dims.air_azimuths, dims.air_above, dims.air_below);
    let ray = sky_ray(air, observer.altitude, view.mu, view.below);
    let w = max(f32(slice), 0.05) / f32(dims.air_slices - 1u);
    let end = slice_distance(w, ray.length);
    let mu_s = mu_s_at_start(ray, view.nu);
    let altitude = clamp(altitude_along(ray.radius, ray.altitude, ray.mu, end), 0.0, air.thickness_m);
    let r = air.bottom_m + altitude;
    let mu_end = clamp((ray.radius * ray.mu + end) / r, -1.0, 1.0);
    let mu_s_end = clamp((ray.radius * mu_s + end * view.nu) / r, -1.0, 1.0);
    let whole = once_at(ray.altitude, ray.mu, mu_s, view.below);
    let rest = once_at(altitude, mu_end, mu_s_end, view.below);
    let depth = air_optical_depth(air, columns_along(air, ray, end));
    let is_part = f32(slice + 1u < dims.air_slices);
    let even = max(whole.gas - is_part * exp(-depth) * rest.gas, vec3f(0.0)) * rayleigh_phase(view.nu);
    let haze = max(whole.haze - is_part * exp(-depth) * rest.haze, vec3f(0.0));
    return SkyTexel(as_source(even, depth), as_source(haze, depth));
}
