// Light that drops scatter from a beam.
//!include "common/phase.wgsl"

// Returns the phase function of a drop, whose integral over all directions is 4 pi. `c` is the cosine of the scattering
// angle: 1 for light from straight behind the drop. The f64 reference is `phase` in src/rain/light.rs.
fn drop_phase(c: f32) -> f32 {
    return 0.93 * henyey(0.9, c) + 0.07 * henyey(-0.35, c);
}

// Returns the share of light from above the horizon in a drop seen along a ray whose sine of elevation is `z`. The f64
// reference is `sky_share` in src/rain/light.rs, which explains the formula.
fn sky_share(z: f32) -> f32 {
    let level = 1.0 - min(abs(z), 1.0);
    return 0.5 + sign(z) * (0.4415 * (1.0 - level * level * sqrt(level)));
}
