//!include "sky/ray.wgsl"
// Parametrisations of the tables. Each map stands beside its inverse; a test checks every pair.

struct SkyDims {
    // Numbers of nodes in the tables over the planet: sun angles, altitudes, and directions into which the air scatters
    // light (zenith angles, and azimuths from the sun's): the directions of the sources.
    suns: u32,
    altitudes: u32,
    zeniths: u32,
    azimuths: u32,
    // Numbers of directions in the quadrature over the sphere: zenith angles on each side of the horizon, azimuths on
    // [0, pi].
    rule_zeniths: u32,
    rule_azimuths: u32,
    // Numbers of panels (of 4 nodes) in a march.
    build_panels: u32,
    sky_panels: u32,
    // Sizes of an observer's tables, texels: the sky above and below the horizon; then the volume of air, with its
    // slices.
    sky_azimuths: u32,
    sky_above: u32,
    sky_below: u32,
    air_panels: u32,
    air_azimuths: u32,
    air_above: u32,
    air_below: u32,
    air_slices: u32,
    // The sky's table and the volume lie in one texture: the sky's first texel in it, and the size of the texture. The
    // sky is stored transposed (rows along x, azimuths along y), which brings its height near the volume's.
    sky_x: u32,
    sky_y: u32,
    tables_width: u32,
    tables_height: u32,
}

// Largest numbers of directions and panels that the settings allow (src/sky/settings.rs). They bound the loops whatever
// the block contains.
const MOST_RULE_ZENITHS: u32 = 16u;
const MOST_RULE_AZIMUTHS: u32 = 24u;
const MOST_BUILD_PANELS: u32 = 16u;
const MOST_SKY_PANELS: u32 = 32u;
const MOST_AIR_PANELS: u32 = 16u;
// Largest number of panels in a pixel's march: the settings allow 4096 nodes (`march_cells`), four to a panel.
const MOST_MARCH_PANELS: u32 = 1024u;

fn rule_zeniths(dims: SkyDims) -> u32 {
    return min(dims.rule_zeniths, MOST_RULE_ZENITHS);
}

fn rule_azimuths(dims: SkyDims) -> u32 {
    return min(dims.rule_azimuths, MOST_RULE_AZIMUTHS);
}

// Sun angle, by its cosine. Let c lie midway between 0, where the sun sets at the ground, and -top_dip, where it sets
// at the top of the air. Below c steps are even in the cosine, above c they grow. The range ends SUN_BELOW below
// -top_dip, where nothing is lit.
const SUN_SPREAD: f32 = 0.3;
const SUN_BELOW: f32 = 0.22;

fn sun_coordinate(air: SkyAir, mu_s: Cosine) -> f32 {
    let center = -0.5 * air.top_dip;
    let u = (mu_s - center) / SUN_SPREAD;
    let x = select(u, u / (1.0 + abs(u)), u > 0.0);
    let lo = -(0.5 * air.top_dip + SUN_BELOW) / SUN_SPREAD;
    let hi = (1.0 - center) / (SUN_SPREAD + 1.0 - center);
    return clamp((x - lo) / (hi - lo), 0.0, 1.0);
}

fn sun_from_coordinate(air: SkyAir, coordinate: f32) -> Cosine {
    let center = -0.5 * air.top_dip;
    let lo = -(0.5 * air.top_dip + SUN_BELOW) / SUN_SPREAD;
    let hi = (1.0 - center) / (SUN_SPREAD + 1.0 - center);
    let x = mix(lo, hi, coordinate);
    let u = select(x, x / (1.0 - x), x > 0.0);
    return min(center + SUN_SPREAD * u, 1.0);
}

fn altitude_coordinate(air: SkyAir, altitude: Length) -> f32 {
    return sqrt(clamp(altitude / air.thickness_m, 0.0, 1.0));
}

fn altitude_from_coordinate(air: SkyAir, coordinate: f32) -> Length {
    return air.thickness_m * coordinate * coordinate;
}

// Texel in a (sun angle, altitude) tile, counted from the tile's corner, for hardware interpolation.
fn planet_texel(air: SkyAir, dims: SkyDims, altitude: Length, mu_s: Cosine) -> vec2f {
    let at = vec2f(sun_coordinate(air, mu_s), altitude_coordinate(air, altitude));
    return 0.5 + at * vec2f(f32(dims.suns - 1u), f32(dims.altitudes - 1u));
}

// Directions of a source. Azimuth is a share of pi and elevation a share of pi/2, each mapped by y = (1 + a) x/(a + x).
// Nodes are therefore dense towards the light's azimuth and at the horizon, where the glow around a low sun is.
// Coordinates in [0, 1]: x azimuth, y from nadir to zenith.
const SOURCE_SPREAD: vec2f = vec2f(3.0, 1.0);

fn source_coordinate(mu: Cosine, cos_azimuth: f32) -> vec2f {
    let azimuth = sky_acos(cos_azimuth) / SKY_PI;
    let elevation = 1.0 - sky_acos(abs(mu)) * (2.0 / SKY_PI);
    let y = (1.0 + SOURCE_SPREAD) * vec2f(azimuth, elevation) / (SOURCE_SPREAD + vec2f(azimuth, elevation));
    return vec2f(y.x, 0.5 + 0.5 * select(y.y, -y.y, mu < 0.0));
}

// Azimuth and elevation, rad, for a coordinate.
fn source_direction(coordinate: vec2f) -> vec2f {
    let y = vec2f(coordinate.x, abs(2.0 * coordinate.y - 1.0));
    let x = SOURCE_SPREAD * y / (1.0 + SOURCE_SPREAD - y);
    return vec2f(x.x * SKY_PI, select(0.5, -0.5, coordinate.y < 0.5) * SKY_PI * x.y);
}

// Direction of the quadrature: zenith cosine and weight, so that the sum of weight times f is the integral of f over
// mu. Nodes are dense at the horizon of `altitude` and never lie on it; the first half lies below the horizon.
fn rule_direction(air: SkyAir, altitude: Length, index: u32, half_size: u32, node: vec2f) -> vec2f {
    let horizon = horizon_mu(air, altitude);
    let y = node.x;
    if (index < half_size) {
        return vec2f(horizon - (1.0 + horizon) * y * y, (1.0 + horizon) * 2.0 * y * node.y);
    }
    return vec2f(horizon + (1.0 - horizon) * y * y, (1.0 - horizon) * 2.0 * y * node.y);
}

// The table of light scattered once has 64 view angles as 8 x 8 tiles, 32 above the horizon and 32 below it, dense at
// the horizon on both sides. A view angle is given by q = sin(angle/2), as in view.wgsl.
const ONCE_ROWS: u32 = 32u;

fn once_mu(air: SkyAir, altitude: Length, row: u32) -> Cosine {
    let horizon = sqrt(0.5 - 0.5 * horizon_mu(air, altitude));
    let v = f32(row % ONCE_ROWS) / f32(ONCE_ROWS - 1u);
    let q = horizon + v * v * select(-horizon, 1.0 - horizon, row >= ONCE_ROWS);
    return clamp(1.0 - 2.0 * q * q, -1.0, 1.0);
}

// Row of a direction on the given side of the horizon, and the fraction towards the next row.
fn once_row(air: SkyAir, altitude: Length, mu: Cosine, below: bool) -> vec2f {
    let horizon = sqrt(0.5 - 0.5 * horizon_mu(air, altitude));
    let over = horizon - sqrt(max(0.5 - 0.5 * mu, 0.0));
    let share = select(over / max(horizon, 1e-7), -over / max(1.0 - horizon, 1e-7), below);
    let row = sqrt(clamp(share, 0.0, 1.0)) * f32(ONCE_ROWS - 1u);
    let first = min(floor(row), f32(ONCE_ROWS - 2u));
    return vec2f(first + select(0.0, f32(ONCE_ROWS), below), row - first);
}
