// Light that drops scatter of a beam.
//!include "common/phase.wgsl"

// Phase function of a drop, 4 pi on the whole, for light from an angle of cosine `c`, 1 straight behind it: as `phase`
// of src/rain/light.rs.
fn drop_phase(c: f32) -> f32 {
    return 0.93 * henyey(0.9, c) + 0.07 * henyey(-0.35, c);
}

// The share of what surrounds a drop above the horizon in what it shows along a ray that rises by a sine `z`. As
// `sky_share` of src/rain/light.rs, which says what it stands for.
fn sky_share(z: f32) -> f32 {
    let level = 1.0 - min(abs(z), 1.0);
    return 0.5 + sign(z) * (0.4415 * (1.0 - level * level * sqrt(level)));
}
