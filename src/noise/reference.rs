//! Noise in f64 at any point, the reference for `shaders/noise/lattice.wgsl` and `slice.wgsl`.

use glam::{DVec2, DVec3, UVec2, UVec3, Vec2Swizzles as _};

use super::settings::{NoiseKind, NoiseSettings, axes};

/// Means of cellular noise in two and in three dimensions, within 2e-4: the contribution of octaves too fine for a
/// texture. From a sum over 4 million points.
const CELLULAR_MEANS: [f64; 2] = [0.5705, 0.4796];

/// Hashes 32 bits, one to one (Wellons 2018, *Prospecting for Hash Functions*, lowbias32).
fn scramble(bits: u32) -> u32 {
    let mut v = bits;
    v = (v ^ (v >> 16)).wrapping_mul(0x7feb_352d);
    v = (v ^ (v >> 15)).wrapping_mul(0x846c_a68b);
    v ^ (v >> 16)
}

/// Hashes `key` together with `more`.
fn scrambled(key: u32, more: u32) -> u32 {
    scramble(key.wrapping_add(more))
}

/// Returns the keys of a seed's gradient noise and of its cellular noise.
pub(super) fn keys_of(seed: u64) -> [u32; 2] {
    let seed = scrambled(scramble(seed as u32), (seed >> 32) as u32);
    [scrambled(seed, 0), scrambled(seed, 1)]
}

/// Returns the weight of the far corner: 6 t^5 - 15 t^4 + 10 t^3, whose first and second derivatives are 0 at both ends
/// (Perlin 2002, section 3).
fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

fn mix(a: f64, b: f64, share: f64) -> f64 {
    a + share * (b - a)
}

fn signed(value: f64, is_minus: bool) -> f64 {
    if is_minus { -value } else { value }
}

/// Greater and lesser coordinate of the gradient vectors in two dimensions. They point 22.5 degrees off the axes and
/// the diagonals, along which the noise would show streaks. Their length is 1.25: the noise then deviates from its mean
/// as much as in three dimensions, by 0.27, and the same settings give the same cover in both.
const RAMP: DVec2 = DVec2::new(1.154_849_415_639_109, 0.478_354_290_456_363);

/// Returns the dot product of `from_corner` with one of eight gradient vectors.
fn ramp_2d(bits: u32, from_corner: DVec2) -> f64 {
    let along = RAMP * if bits & 0x8000_0000 == 0 { from_corner } else { from_corner.yx() };
    signed(along.x, bits & 0x4000_0000 != 0) + signed(along.y, bits & 0x2000_0000 != 0)
}

/// Returns the dot product of `from_corner` with a vector to one of the twelve edges of a cube (Perlin 2002, section
/// 4).
fn ramp_3d(bits: u32, from_corner: DVec3) -> f64 {
    let plane = ((bits >> 16) * 3) >> 16;
    let u = if plane == 2 { from_corner.y } else { from_corner.x };
    let v = if plane == 0 { from_corner.y } else { from_corner.z };
    signed(u, bits & 1 != 0) + signed(v, bits & 2 != 0)
}

/// Returns the cell of a coordinate on a ring of `period` cells, and the fraction within the cell.
fn cell_of(x: f64, period: u32) -> (u32, f64) {
    let low = x.floor();
    (low.rem_euclid(f64::from(period)) as u32, x - low)
}

/// Returns cell `cell + step` on the ring.
fn ring(cell: u32, step: i32, period: u32) -> u32 {
    (i64::from(cell) + i64::from(step)).rem_euclid(i64::from(period)) as u32
}

/// Returns one octave of gradient noise in two dimensions (Perlin 2002): -0.85 to 0.85, 0 at the corners of cells, with
/// continuous second derivatives. `position` is in cells. The pattern repeats after `period` cells, at least 1 along
/// each axis. Each `key` gives another pattern.
pub fn gradient_2d(position: DVec2, period: UVec2, key: u32) -> f64 {
    let ((i, u), (j, v)) = (cell_of(position.x, period.x), cell_of(position.y, period.y));
    let corner = |a: i32, b: i32| {
        let column = scrambled(key, ring(i, a, period.x));
        let bits = scrambled(column, ring(j, b, period.y));
        ramp_2d(bits, DVec2::new(u - f64::from(a), v - f64::from(b)))
    };
    let row = |b| mix(corner(0, b), corner(1, b), fade(u));
    mix(row(0), row(1), fade(v))
}

/// Returns gradient noise as [`gradient_2d`] does, in three dimensions. Its extremes are a few hundredths beyond -1
/// and 1.
pub fn gradient_3d(position: DVec3, period: UVec3, key: u32) -> f64 {
    let ((i, u), (j, v), (k, w)) =
        (cell_of(position.x, period.x), cell_of(position.y, period.y), cell_of(position.z, period.z));
    let corner = |a: i32, b: i32, c: i32| {
        let column = scrambled(key, ring(i, a, period.x));
        let row = scrambled(column, ring(j, b, period.y));
        let bits = scrambled(row, ring(k, c, period.z));
        ramp_3d(bits, DVec3::new(u - f64::from(a), v - f64::from(b), w - f64::from(c)))
    };
    let row = |b, c| mix(corner(0, b, c), corner(1, b, c), fade(u));
    let face = |c| mix(row(0, c), row(1, c), fade(v));
    mix(face(0), face(1), fade(w))
}

/// Returns the coordinates of a cell's point, 0 to 1, from 10 bits each: the middle of one of 1024 steps.
fn point_of(bits: u32) -> DVec3 {
    let part = |bits: u32| (f64::from(bits & 1023) + 0.5) / 1024.0;
    DVec3::new(part(bits), part(bits >> 10), part(bits >> 22))
}

/// Returns one octave of cellular noise in two dimensions (Worley 1996, F1): 1 minus the distance to the nearest point,
/// in cells, and 0 for distances above 1. Each cell has one point. The arguments are those of [`gradient_2d`].
///
/// Points two cells away are farther than 1, so only this cell and its neighbours are searched.
pub fn cellular_2d(position: DVec2, period: UVec2, key: u32) -> f64 {
    let ((i, u), (j, v)) = (cell_of(position.x, period.x), cell_of(position.y, period.y));
    let mut nearest = 1.0_f64;
    for a in -1..=1 {
        let column = scrambled(key, ring(i, a, period.x));
        for b in -1..=1 {
            let point = point_of(scrambled(column, ring(j, b, period.y))).truncate();
            let to_point = point + DVec2::new(f64::from(a) - u, f64::from(b) - v);
            nearest = nearest.min(to_point.length_squared());
        }
    }
    1.0 - nearest.sqrt()
}

/// Returns cellular noise as [`cellular_2d`] does, in three dimensions.
pub fn cellular_3d(position: DVec3, period: UVec3, key: u32) -> f64 {
    let ((i, u), (j, v), (k, w)) =
        (cell_of(position.x, period.x), cell_of(position.y, period.y), cell_of(position.z, period.z));
    let mut nearest = 1.0_f64;
    for a in -1..=1 {
        let column = scrambled(key, ring(i, a, period.x));
        for b in -1..=1 {
            let row = scrambled(column, ring(j, b, period.y));
            for c in -1..=1 {
                let point = point_of(scrambled(row, ring(k, c, period.z)));
                let to_point = point + DVec3::new(f64::from(a) - u, f64::from(b) - v, f64::from(c) - w);
                nearest = nearest.min(to_point.length_squared());
            }
        }
    }
    1.0 - nearest.sqrt()
}

/// Returns the means that octaves too fine for a texture of `size` texels add to its gradient noise and to its cellular
/// noise.
pub(super) fn rests(settings: &NoiseSettings, size: [u32; 3]) -> [f64; 2] {
    let held = settings.octaves_in(size);
    let sum: f64 = amplitudes(settings).skip(held as usize).take((settings.octaves - held) as usize).sum();
    [0.5 * sum, CELLULAR_MEANS[axes(size) - 2] * sum]
}

/// Returns the amplitudes of the octaves, without end.
fn amplitudes(settings: &NoiseSettings) -> impl Iterator<Item = f64> {
    let persistence = settings.persistence;
    std::iter::successors(Some(settings.amplitude), move |a| Some(a * persistence))
}

/// Returns the noise at a point of a texture of `size` texels, 0 to 1, before it is rounded to a byte. `position` is in
/// textures: 0 to 1 is one texture, and the noise repeats beyond it. The middle of texel i of n is at (i + 0.5) / n. A
/// depth of 1 means two dimensions.
///
/// For settings that [`NoiseSettings::check`] refuses, the result is meaningless.
pub fn noise_at(settings: &NoiseSettings, size: [u32; 3], position: DVec3) -> f64 {
    let is_plane = axes(size) == 2;
    let [gradient_key, cellular_key] = keys_of(settings.seed);
    let [mut gradient, mut cellular] = rests(settings, size);
    let held = settings.octaves_in(size);
    for (octave, amplitude) in (0..held).zip(amplitudes(settings)) {
        let period = UVec3::from(settings.frequency).max(UVec3::ONE) << octave;
        let position = position * period.as_dvec3();
        if settings.kind != NoiseKind::Cellular {
            let key = scrambled(gradient_key, octave);
            let noise = if is_plane {
                gradient_2d(position.truncate(), period.truncate(), key)
            } else {
                gradient_3d(position, period, key)
            };
            gradient += amplitude * (0.5 + 0.5 * noise);
        }
        if settings.kind != NoiseKind::Gradient {
            let key = scrambled(cellular_key, octave);
            cellular += amplitude
                * if is_plane {
                    cellular_2d(position.truncate(), period.truncate(), key)
                } else {
                    cellular_3d(position, period, key)
                };
        }
    }
    let (gradient, cellular) = (gradient.clamp(0.0, 1.0), cellular.clamp(0.0, 1.0));
    match settings.kind {
        NoiseKind::Gradient => gradient,
        NoiseKind::Cellular => cellular,
        NoiseKind::GradientOverCellular => cellular + gradient * (1.0 - cellular),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the distance to the nearest of all points of a period and of its repetitions.
    fn distance(position: DVec3, period: UVec3, key: u32, axes: usize) -> f64 {
        let size = period.as_dvec3();
        let mut nearest = f64::MAX;
        for i in 0..period.x {
            for j in 0..period.y {
                for k in 0..if axes == 3 { period.z } else { 1 } {
                    let row = scrambled(scrambled(key, i), j);
                    let bits = if axes == 3 { scrambled(row, k) } else { row };
                    let point = point_of(bits) + UVec3::new(i, j, k).as_dvec3();
                    let mut way = (point - position + 0.5 * size).rem_euclid(size) - 0.5 * size;
                    if axes == 2 {
                        way.z = 0.0;
                    }
                    nearest = nearest.min(way.length());
                }
            }
        }
        nearest
    }

    #[test]
    fn cellular_noise_finds_the_nearest_of_all_points() {
        let period = UVec3::new(5, 6, 7);
        let mut far = 0;
        for i in 0..3000 {
            let at = DVec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5) * f64::from(i) * 3.0;
            let (plane, space) = (distance(at, period, 3, 2), distance(at, period, 3, 3));
            far += u32::from(space > 1.0);
            assert!((cellular_2d(at.truncate(), period.truncate(), 3) - (1.0 - plane).max(0.0)).abs() < 1e-9, "{at}");
            assert!((cellular_3d(at, period, 3) - (1.0 - space).max(0.0)).abs() < 1e-9, "{at}");
        }
        assert!(far > 0, "{far} places are farther than 1 from all points");
    }
}
