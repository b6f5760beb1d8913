// Quadrature rules for the two integrals of the sky, transmittance to space and light scattered once, with nodes of
// equal cost.
struct Quad {
    rows: u32,
    columns: u32,
    panels: u32,
    n: u32,
}
@group(0) @binding(0) var<uniform> air: SkyAir;
@group(0) @binding(1) var<uniform> quad: Quad;
@group(0) @binding(2) var<uniform> dims: SkyDims;
@group(0) @binding(3) var nothing: texture_2d<f32>;
@group(0) @binding(4) var smp: sampler;

// 0: samples at 0.3 of a step; 1: midpoint; 2: trapezoid; 3: Gauss panels of 4; 4: Welkin's; 5: midpoint on Welkin's
// stretch.
override RULE: u32 = 4u;

// Returns position and weight of node i of n on (0, 1).
fn rule_node(i: u32, n: u32) -> vec2f {
    let step = 1.0 / f32(n);
    if (RULE == 0u) {
        let x = (f32(i) + 0.3) * step;
        return vec2f(x, select(step, x, i == 0u));
    }
    if (RULE == 2u) {
        let last = f32(n - 1u);
        return vec2f(f32(i) / last, select(1.0, 0.5, i == 0u || i == n - 1u) / last);
    }
    if (RULE == 3u) {
        let g = gauss_4(i % 4u);
        return vec2f((f32(i / 4u) + g.x) * 4.0 * step, g.y * 4.0 * step);
    }
    return vec2f((f32(i) + 0.5) * step, step);
}

fn altitude_of(row: u32) -> f32 {
    let y = f32(row) / f32(quad.rows - 1u);
    return air.thickness_m * 0.98 * y * y;
}

@fragment
fn transmittance(@builtin(position) p: vec4f) -> @location(0) vec4f {
    let h = altitude_of(u32(p.y) % quad.rows);
    let x = (f32(u32(p.x) % quad.columns) + 0.5) / f32(quad.columns);
    let horizon = horizon_mu(air, h);
    let ray = sky_ray(air, h, horizon + (1.0 - horizon) * x * x, false);
    if (RULE == 4u) {
        return vec4f(exp(-air_optical_depth(air, columns_to(air, ray, sky_columns(air, ray), air.thickness_m, 1.0))), 1.0);
    }
    var columns = vec3f(0.0);
    for (var i = 0u; i < quad.n; i++) {
        let node = rule_node(i, quad.n);
        let altitude = altitude_along(ray.radius, ray.altitude, ray.mu, node.x * ray.length);
        columns += node.y * ray.length * air_density(air, altitude);
    }
    return vec4f(exp(-air_optical_depth(air, columns)), 1.0);
}

const ALTITUDES = array<f32, 4>(2.0, 1500.0, 11000.0, 50000.0);
const SUNS = array<f32, 4>(0.52359878, 1.3089969, 1.5358897, 1.6057029);

// Row: altitude, sun, azimuth, four each; column: view from the horizon to the zenith.
@fragment
fn scattering(@builtin(position) p: vec4f) -> @location(0) vec4f {
    let row = u32(p.y) % 64u;
    var altitudes = ALTITUDES;
    var suns = SUNS;
    let h = altitudes[row / 16u];
    let sun = suns[(row / 4u) % 4u];
    let azimuth = f32(row % 4u) * SKY_PI / 3.0;
    let x = (f32(u32(p.x) % quad.columns) + 0.5) / f32(quad.columns);
    let horizon = horizon_mu(air, h);
    let mu = horizon + (1.0 - horizon) * x * x;
    let ray = sky_ray(air, h, mu, false);
    let mu_s = cos(sun);
    let nu = mu * mu_s + sqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 0.0)) * cos(azimuth);
    var once = vec3f(0.0);
    if (RULE == 4u) {
        let light = sky_march(air, dims, nothing, sources_of(air), smp, ray, 0.0, ray.length, max(quad.n / 4u, 1u), mu_s, nu);
        once = light.gas * rayleigh_phase(nu) + light.haze * mie_phase(nu, air.asymmetry_g);
        return vec4f(once, 1.0);
    }
    let stretch = stretch_of(air, ray, 0.0, ray.length, mu_s);
    let start = sky_columns(air, ray);
    let t_ray = ray.radius * ray.mu;
    for (var i = 0u; i < quad.n; i++) {
        let node = rule_node(i, quad.n);
        var distance = node.x * ray.length;
        var ds = node.y * ray.length;
        if (RULE == 5u) {
            let grown = stretch.spread * exp(stretch.k * node.x);
            distance = stretch.origin + stretch.sense * (grown - stretch.spread);
            ds = node.y * stretch.k * grown;
        }
        let altitude = clamp(altitude_along(ray.radius, ray.altitude, ray.mu, distance), 0.0, air.thickness_m);
        let r = air.bottom_m + altitude;
        let mu_s_here = clamp((ray.radius * mu_s + distance * nu) / r, -1.0, 1.0);
        let columns = columns_to(air, ray, start, altitude, select(-1.0, 1.0, t_ray + distance >= 0.0));
        let weight = ds * exp(-air_optical_depth(air, columns));
        let density = air_density(air, altitude);
        let sun_light = sun_transmittance(air, altitude, mu_s_here) * weight;
        let here = air.rayleigh_scattering * density.x * rayleigh_phase(nu) + air.mie_scattering * density.y * mie_phase(nu, air.asymmetry_g);
        // Welkin's march does this look-up for every node. It is done here too, with the weight 0, so that the costs
        // compare.
        let more = more_scattered(air, dims, nothing, sources_of(air), smp, altitude, mu_s_here, clamp((t_ray + distance) / r, -1.0, 1.0), nu);
        once += sun_light * here + weight * 0.0 * more;
    }
    return vec4f(once, 1.0);
}
