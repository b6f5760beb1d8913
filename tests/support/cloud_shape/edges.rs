//! Directions of the edges of clouds.

use std::f64::consts::PI;

use super::mask::CloudMask;

/// Number of directions.
const DIRECTIONS: usize = 18;
/// Standard deviation of the blur, pixels. It removes the steps of the pixels: with 1 pixel, discs seem to have 1.5
/// times the mean along the axes.
const BLUR: f64 = 3.0;
/// Half the width of the blur, pixels.
const REACH: usize = 9;

/// Directions of the edges of clouds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeDirections {
    /// Length of the edges by direction, over the mean of all directions. The middle of direction i is 10 i degrees,
    /// from east (0) over north (90).
    pub lengths: [f64; DIRECTIONS],
    /// Direction along which most of the edges lie, degrees from east over north, 0 to 180.
    pub axis_deg: f64,
}

impl EdgeDirections {
    /// Returns the length in the strongest direction over the mean.
    pub fn strongest(&self) -> f64 {
        self.lengths.iter().copied().fold(0.0, f64::max)
    }
}

/// Returns the axis of directions: half the angle of their second harmonic, degrees.
fn axis_deg(lengths: &[f64; DIRECTIONS]) -> f64 {
    let (mut east, mut north) = (0.0, 0.0);
    for (i, length) in lengths.iter().enumerate() {
        let (sine, cosine) = (2.0 * PI * i as f64 / DIRECTIONS as f64).sin_cos();
        (east, north) = (east + length * cosine, north + length * sine);
    }
    (0.5 * north.atan2(east).to_degrees()).rem_euclid(180.0)
}

/// Blurs along rows, and returns rows as columns. Beyond the border the last pixel counts.
fn blurred(values: &[f32], side: usize, weights: &[f32]) -> Vec<f32> {
    let mut out = vec![0.0; values.len()];
    for y in 0..side {
        let row = &values[y * side..(y + 1) * side];
        for x in 0..side {
            let at = |k: usize| row[(x + k).saturating_sub(REACH).min(side - 1)];
            out[x * side + y] = weights.iter().enumerate().map(|(k, weight)| weight * at(k)).sum();
        }
    }
    out
}

/// Returns the directions of the edges in masks: of each place's gradient in the blurred mask, weighted by its length,
/// which adds up to the length of the edges. Places near the border do not count.
pub fn edge_directions(masks: &[CloudMask]) -> EdgeDirections {
    let weights: Vec<f32> =
        (0..=2 * REACH).map(|k| (-0.5 * ((k as f64 - REACH as f64) / BLUR).powi(2)).exp() as f32).collect();
    let sum: f32 = weights.iter().sum();
    let weights: Vec<f32> = weights.iter().map(|weight| weight / sum).collect();
    let mut lengths = [0.0; DIRECTIONS];
    for mask in masks {
        let side = mask.side();
        let values: Vec<f32> = mask.pixels().iter().map(|is_cloudy| f32::from(u8::from(*is_cloudy))).collect();
        let smooth = blurred(&blurred(&values, side, &weights), side, &weights);
        for y in REACH..side.saturating_sub(REACH) {
            for x in REACH..side - REACH {
                let i = y * side + x;
                let east = f64::from(smooth[i + 1] - smooth[i - 1]);
                let north = f64::from(smooth[i + side] - smooth[i - side]);
                if east != 0.0 || north != 0.0 {
                    // The edge lies across the gradient.
                    let turn = (north.atan2(east) / PI + 0.5).rem_euclid(1.0);
                    lengths[(turn * DIRECTIONS as f64).round() as usize % DIRECTIONS] += east.hypot(north);
                }
            }
        }
    }
    let mean = lengths.iter().sum::<f64>() / DIRECTIONS as f64;
    let lengths = lengths.map(|length| if mean > 0.0 { length / mean } else { 0.0 });
    EdgeDirections { lengths, axis_deg: axis_deg(&lengths) }
}
