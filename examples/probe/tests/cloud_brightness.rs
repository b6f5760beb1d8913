//! Tests of the brightness of the drawn clouds, seen from straight above.

use std::f64::consts::TAU;

use glam::DVec3;
use welkin::{
    clouds::{
        cover::typical,
        traced::{GivenLight, LitLayer},
    },
    weather::CloudKind,
};

/// Pixels along a line, and the side of a pixel, m.
const PIXELS: usize = 1024;
const PIXEL_M: f64 = 20.0;
/// Lines of a field, and their distance from each other, m.
const LINES: usize = 12;
const APART_M: f64 = 3700.0;

/// Returns the mean power of waves 0 to PIXELS / 2 along lines, less their mean and trend.
fn power(lines: &[Vec<f64>]) -> Vec<f64> {
    let mut sums = vec![0.0; PIXELS / 2];
    for line in lines {
        let mean = line.iter().sum::<f64>() / PIXELS as f64;
        // A window against the jump from the end to the start (Hann).
        let window = |i: usize| 0.5 - 0.5 * (TAU * (i as f64 + 0.5) / PIXELS as f64).cos();
        for (k, sum) in sums.iter_mut().enumerate() {
            let (mut re, mut im) = (0.0, 0.0);
            for (i, v) in line.iter().enumerate() {
                let (sin, cos) = (TAU * ((k * i) % PIXELS) as f64 / PIXELS as f64).sin_cos();
                re += (v - mean) * window(i) * cos;
                im += (v - mean) * window(i) * sin;
            }
            *sum += re * re + im * im;
        }
    }
    sums
}

/// Slope of a power over wave numbers on logarithmic axes, from one wave length to another, m: a least-squares line
/// through the means of bands of equal width.
fn slope(power: &[f64], [longest_m, shortest_m]: [f64; 2]) -> f64 {
    const BANDS: usize = 12;
    let side_m = PIXELS as f64 * PIXEL_M;
    let (first, last) = ((side_m / longest_m).ln(), (side_m / shortest_m).ln());
    let points: Vec<[f64; 2]> = (0..BANDS)
        .filter_map(|band| {
            let edge = |i: usize| (first + (last - first) * i as f64 / BANDS as f64).exp();
            let within: Vec<usize> =
                (1..power.len()).filter(|k| (edge(band)..edge(band + 1)).contains(&(*k as f64))).collect();
            let count = within.len() as f64;
            (!within.is_empty()).then(|| {
                let log = within.iter().map(|k| (*k as f64).ln()).sum::<f64>() / count;
                [log, (within.iter().map(|k| power[*k]).sum::<f64>() / count).ln()]
            })
        })
        .collect();
    let count = points.len() as f64;
    let mean = |i: usize| points.iter().map(|p| p[i]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    let across: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    across / points.iter().map(|p| (p[0] - x) * (p[0] - x)).sum::<f64>()
}

#[test]
fn the_brightness_of_a_deck_has_the_spectrum_of_turbulence() {
    let slab = typical(CloudKind::Stratocumulus, 1.0).unwrap();
    let to_sun = DVec3::new(0.5, 0.4, (1.0f64 - 0.41).sqrt());
    let mut lines = Vec::new();
    for seed in 0..2 {
        let layer = LitLayer::new(&slab, seed, GivenLight::over_ground(to_sun, 0.045, 0.06)).unwrap();
        let above_m = slab.base_m + slab.thickness_m + 1.0;
        for line in 0..LINES {
            let eye = |i: usize| DVec3::new(i as f64 * PIXEL_M, line as f64 * APART_M, above_m);
            let seen = |i: usize| layer.model(eye(i), DVec3::new(0.0, 1e-3, -1.0).normalize(), [1.0; 2]).all;
            lines.push((0..PIXELS).map(seen).collect());
        }
    }
    let power = power(&lines);
    let [wide, fine] = [[5000.0, 300.0], [300.0, 80.0]].map(|range_m| slope(&power, range_m));
    println!("slope {wide:.2} from 5 km to 300 m, {fine:.2} from 300 to 80 m");
    assert!((wide + 5.0 / 3.0).abs() < 0.25, "{wide}");
    assert!(fine < wide - 0.2, "{fine}, {wide}");
}
