//! Materials of the drawn ground: colours of each class of surface, and the noise that varies them.
//!
//! A colour is the mean over many metres of the ground. Fine noise adds grains and tufts to it, and broad noise adds
//! patches of metres to hundreds of metres. Each octave of the noise has the mean 0 and fades out before it becomes
//! finer than the pixels, so the mean colour is the same at every distance.

use glam::{DMat3, DVec3};

/// Octaves of the noise: the first half is fine, the second half is broad.
pub(super) const OCTAVES: usize = 8;
/// Lengths of the octaves, m. No length is a multiple of another, so that their patterns never repeat together.
const LENGTHS_M: [f64; OCTAVES] = [0.043, 0.19, 0.71, 2.9, 13.1, 59.0, 241.0, 983.0];
/// Angle by which each octave is turned against the previous one, rad: no two octaves have parallel lattices.
const TURN: f64 = 0.61;
/// Number of materials: one for each class of surface.
pub(super) const MATERIALS: usize = 7;

/// Colours of a material, linear Rec. 709 albedo; the fourth number of each is unused.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Material {
    /// Mean colour.
    pub albedo: [f32; 4],
    /// Change of the colour by fine noise of amplitude 1.
    pub fine: [f32; 4],
    /// Change of the colour by broad noise of amplitude 1.
    pub broad: [f32; 4],
}

const fn material(albedo: [f32; 3], fine: [f32; 3], broad: [f32; 3]) -> Material {
    const fn four(v: [f32; 3]) -> [f32; 4] {
        [v[0], v[1], v[2], 0.0]
    }
    Material { albedo: four(albedo), fine: four(fine), broad: four(broad) }
}

/// Materials by class number: for class 0 the grass of natural ground, then soil, rock, asphalt, grass, the bed of
/// water and concrete. The luminances of four of them are within the ranges of Oke 1987, table 1.1, for visible light:
/// grass 0.05 to 0.10, dry soil 0.10 to 0.20, asphalt 0.05 to 0.20, concrete 0.10 to 0.35.
pub(super) const CLASS_MATERIALS: [Material; MATERIALS] = [
    material([0.070, 0.080, 0.038], [0.013, 0.015, 0.007], [0.012, 0.009, 0.006]),
    material([0.190, 0.140, 0.095], [0.030, 0.023, 0.017], [0.024, 0.018, 0.012]),
    material([0.215, 0.200, 0.180], [0.036, 0.034, 0.031], [0.027, 0.024, 0.020]),
    material([0.105, 0.104, 0.101], [0.013, 0.013, 0.013], [0.005, 0.005, 0.005]),
    material([0.062, 0.082, 0.032], [0.013, 0.016, 0.006], [0.012, 0.009, 0.005]),
    material([0.110, 0.100, 0.075], [0.018, 0.017, 0.013], [0.012, 0.011, 0.008]),
    material([0.270, 0.260, 0.240], [0.018, 0.017, 0.016], [0.012, 0.011, 0.010]),
];

/// Place of one octave's lattice relative to the eye.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Octave {
    /// Cell of the octave's lattice that holds the eye, and the octave's seed.
    pub cell: [i32; 4],
    /// Place of the eye in this cell, 0 to 1, and cells per metre.
    pub place: [f32; 4],
    /// Cosine and sine of the octave's angle; footprints of a pixel between which the octave fades out, m.
    pub turn: [f32; 4],
}

/// Rotation of an octave's lattice about the vertical.
fn turned(octave: usize) -> DMat3 {
    let (sine, cosine) = libm::sincos(TURN * octave as f64);
    DMat3::from_cols(DVec3::new(cosine, sine, 0.0), DVec3::new(-sine, cosine, 0.0), DVec3::Z)
}

/// Returns the octaves for an eye at `eye_m`, m along the lattice's axes from its origin.
pub(super) fn octaves(eye_m: DVec3) -> [Octave; OCTAVES] {
    std::array::from_fn(|i| {
        let length = LENGTHS_M[i];
        let at = turned(i) * eye_m / length;
        let low = at.floor();
        let part = at - low;
        // Cells count modulo 2^32: the pattern of the shortest octave, 4.3 cm, repeats after 180 000 km.
        let cell = |v: f64| v.rem_euclid(4_294_967_296.0) as u32 as i32;
        let (sine, cosine) = libm::sincos(TURN * i as f64);
        Octave {
            cell: [cell(low.x), cell(low.y), cell(low.z), (i as i32 + 1).wrapping_mul(0x3c6e_f372)],
            place: [part.x as f32, part.y as f32, part.z as f32, (1.0 / length) as f32],
            turn: [cosine as f32, sine as f32, (length / 6.0) as f32, (length / 2.2) as f32],
        }
    })
}
