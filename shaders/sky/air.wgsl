// Air of a planet and its optical properties at one altitude. The f64 reference is src/sky/reference/medium.rs.
//!include "common/guarded.wgsl"

alias Length = f32;
alias PerLength = vec3f;
alias Cosine = f32;
alias Radiance = vec3f;

const SKY_PI: f32 = 3.14159265;

struct SkyAir {
    // Radius of altitude 0, and thickness of the air, m.
    bottom_m: f32,
    thickness_m: f32,
    // Angular radius of the sun's disc, rad.
    sun_angular_radius: f32,
    // Parameter g of the haze's phase function.
    asymmetry_g: f32,
    // Coefficients at density 1, 1/m.
    rayleigh_scattering: PerLength,
    rayleigh_scale_height_m: f32,
    mie_scattering: PerLength,
    mie_scale_height_m: f32,
    mie_extinction: PerLength,
    ozone_center_m: f32,
    ozone_extinction: PerLength,
    ozone_half_width_m: f32,
    ground_albedo: vec3f,
    // Negated cosine of the zenith angle of the planet's edge, seen from the top of the air.
    top_dip: f32,
    // Light can be computed for more than three wavelengths, three at a time. Tables keep the sum of all triples,
    // converted to light at the planet's own three wavelengths; the part of a triple may be negative. The fields are
    // the three columns of this triple's matrix (`parts` in src/planet/spectral.rs), the triple's index (`layer`) and
    // the number of triples (`layers`).
    part_a: vec3f,
    layer: f32,
    part_b: vec3f,
    layers: f32,
    part_c: vec3f,
    unused: f32,
}

// Densities of gas, haze (1 at and below altitude 0) and ozone (1 at the centre of its tent). They are not cut at the
// top of the air, where the reference has 0.
fn air_density(air: SkyAir, altitude: Length) -> vec3f {
    let h = max(altitude, 0.0);
    let gas = exp(-h / air.rayleigh_scale_height_m);
    let haze = exp(-h / air.mie_scale_height_m);
    let ozone = max(0.0, 1.0 - abs(altitude - air.ozone_center_m) / air.ozone_half_width_m);
    return vec3f(gas, haze, ozone);
}

// Optical depth per wavelength of columns given in metres at density 1.
fn air_optical_depth(air: SkyAir, columns: vec3f) -> vec3f {
    return air.rayleigh_scattering * columns.x + air.mie_extinction * columns.y + air.ozone_extinction * columns.z;
}

// (1 - e^-x)/x for x >= 0: the share of a layer's light that leaves the layer.
fn air_escape(x: vec3f) -> vec3f {
    let series = 1.0 - x * (0.5 - x * (0.16666667 - x * 0.041666667));
    return select((1.0 - exp(-x)) / max(x, vec3f(1e-6)), series, x < vec3f(0.05));
}

// 1 - e^-x for x >= 0, without cancellation.
fn air_opacity(x: vec3f) -> vec3f {
    return x * air_escape(x);
}

// 3/(16 pi) (1 + nu^2), 1/sr (Rayleigh). nu: cosine of the angle between the directions to the light and of the view.
fn rayleigh_phase(nu: Cosine) -> f32 {
    return 0.05968310 * (1.0 + nu * nu);
}

// 3/(8 pi) (1 - g^2)/(2 + g^2) (1 + nu^2)/(1 + g^2 - 2 g nu)^(3/2), 1/sr (Cornette and Shanks 1992, eq. 8). The
// denominator is written as (1 - |g|)^2 + 2 |g| (1 -+ nu), which does not suffer from cancellation at the peak.
fn mie_phase(nu: Cosine, g: f32) -> f32 {
    let a = abs(g);
    let b = (1.0 - a) * (1.0 - a);
    let d = b + 2.0 * a * max(1.0 - select(nu, -nu, g < 0.0), 0.0);
    return 0.11936621 * (1.0 - a) * (1.0 + a) / (2.0 + a * a) * (1.0 + nu * nu) / (d * sqrt(d));
}

// Radiances are stored in fp16 as their square roots, so that twilight (1e-8 of the sun) is not lost.
fn sky_encode(x: vec3f) -> vec4f {
    return vec4f(capped(sqrt(not_negative(x)), 65504.0), 1.0);
}

fn sky_decode(x: vec4f) -> vec3f {
    return x.rgb * x.rgb;
}

// Encodes values that may be negative: the three values that tables keep of a set of wavelengths.
fn sky_encode_signed(x: vec3f) -> vec4f {
    return vec4f(sign(x) * capped(sqrt(abs(x)), 65504.0), 1.0);
}

fn sky_decode_signed(x: vec4f) -> vec3f {
    return x.rgb * abs(x.rgb);
}

// Contribution of a triple's light to the three values that tables keep.
fn air_part(air: SkyAir, light: vec3f) -> vec3f {
    return air.part_a * light.x + air.part_b * light.y + air.part_c * light.z;
}

// Arc cosine within 7e-5 rad (Abramowitz and Stegun 1964, 4.4.45), without the branches of the exact function.
fn sky_acos(x: f32) -> f32 {
    let a = min(abs(x), 1.0);
    let p = sqrt(1.0 - a) * (1.5707288 + a * (-0.2121144 + a * (0.0742610 - a * 0.0187293)));
    return select(p, SKY_PI - p, x < 0.0);
}
