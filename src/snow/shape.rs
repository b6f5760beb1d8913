//! Shape of a flake in f64: the reference of `shaders/snow/shape.wgsl`.
//!
//! A flake is a disc eroded by noise. Its opacity is max(1 - exp(-5 W), 0) with W = `OFFSET` + `NOISE` n - r^2. Here r
//! is the distance from the middle in radii, and n is noise between -1 and 1 that differs from flake to flake. The
//! formula is that of a procedural flake in an older system, in which the noise could erode a flake completely. The
//! test below requires a mean opacity above 0.05 of each of 600 flakes. `OFFSET` and `NOISE` are such that the opacity,
//! averaged over the disc and over these flakes, is the share of a flake's disc that its ice covers
//! (`falling::flakes::AREA_RATIO`). Near flakes therefore cover as much as far ones, which are drawn as faint discs.

use crate::{falling::random3, numerics::smooth};

/// Number of octaves of the noise.
const OCTAVES: u32 = 4;
/// Number of cells of the coarsest octave of noise in a flake's radius.
const CELLS: f64 = 2.2;
/// Constant added to the noise.
const OFFSET: f64 = 0.8563;
/// Weight of the noise.
const NOISE: f64 = 2.0;

/// Returns a random number from -1 to 1 at a corner of the noise's cells.
fn corner(cell: [i32; 2], seed: u32) -> f64 {
    f64::from(random3([cell[0] as u32, cell[1] as u32, seed])[0] >> 8) * (2.0 / 16_777_215.0) - 1.0
}

/// Returns value noise, -1 to 1: random numbers at the corners of cells of side 1, with cubic interpolation between
/// them.
fn noise(p: [f64; 2], seed: u32) -> f64 {
    let cell = p.map(|v| v.floor() as i32);
    let w = p.map(|v| v - v.floor()).map(smooth);
    let at = |x: i32, y: i32| corner([cell[0] + x, cell[1] + y], seed);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    mix(mix(at(0, 0), at(1, 0), w[0]), mix(at(0, 1), at(1, 1), w[0]), w[1])
}

/// Returns the opacity, 0 to 1, of the flake of a seed at a place, which is given in radii from the flake's middle.
pub fn flake_shape(place: [f64; 2], seed: u32) -> f64 {
    let square = place[0] * place[0] + place[1] * place[1];
    if square >= 1.0 {
        return 0.0;
    }
    let (mut sum, mut strength, mut scale) = (0.0, 0.5, CELLS);
    for i in 0..OCTAVES {
        sum += strength * noise(place.map(|v| v * scale), seed.wrapping_add(i));
        strength *= 0.5;
        scale *= 2.0;
    }
    (1.0 - libm::exp(-5.0 * (OFFSET + NOISE * sum - square))).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::falling::flakes::AREA_RATIO;

    /// Returns the mean of a flake's shape over the unit disc, by 40 x 40 midpoints.
    fn mean(seed: u32) -> f64 {
        let n = 40;
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
        let sum: f64 =
            (0..n).flat_map(|y| (0..n).map(move |x| (x, y))).map(|(x, y)| flake_shape([at(x), at(y)], seed)).sum();
        sum * 4.0 / f64::from(n * n) / std::f64::consts::PI
    }

    #[test]
    fn flake_shapes_have_the_mean_area_of_flakes_and_differ_by_seed() {
        let all: Vec<f64> = (0..600).map(|i| mean(i * 7919)).collect();
        let mid = all.iter().sum::<f64>() / all.len() as f64;
        assert!((mid / AREA_RATIO - 1.0).abs() < 0.02, "{mid}");
        assert!(all.iter().all(|m| *m > 0.05), "a flake is never nothing: {all:?}");
        let apart = |a: u32, b: u32| {
            let points = (0..20).map(|i| [f64::from(i) / 20.0 - 0.5, 0.3]);
            points.map(|p| (flake_shape(p, a) - flake_shape(p, b)).abs()).sum::<f64>()
        };
        assert!(apart(1, 2) > 0.5 && apart(5, 5) == 0.0);
    }
}
