//! Properties of noise, for any implementation.

use glam::{DVec2, DVec3, UVec2, UVec3};
use welkin::noise::{
    NoiseImage, NoiseKind, NoiseSettings, cellular_2d, cellular_3d, gradient_2d, gradient_3d, noise_at,
};

/// Points of space that lie on no lattice, `count` of them in a cube of `side` cells (Kronecker's sequence by the
/// powers of the root of x^4 = x + 1; Roberts 2018).
fn points(count: u32, side: f64) -> impl Iterator<Item = DVec3> {
    const STEP: DVec3 = DVec3::new(0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_4);
    (1..=count).map(move |i| (STEP * f64::from(i)).fract() * side)
}

#[test]
fn noise_repeats_after_its_period_along_each_axis() {
    let period = UVec3::new(6, 5, 3);
    let mut largest = 0.0_f64;
    for p in points(2000, 9.0) {
        let p = p - 4.0;
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let q = p + axis * period.as_dvec3();
            let (p2, q2, period2) = (p.truncate(), q.truncate(), period.truncate());
            for step in [
                gradient_3d(q, period, 7) - gradient_3d(p, period, 7),
                cellular_3d(q, period, 7) - cellular_3d(p, period, 7),
                gradient_2d(q2, period2, 7) - gradient_2d(p2, period2, 7),
                cellular_2d(q2, period2, 7) - cellular_2d(p2, period2, 7),
            ] {
                largest = largest.max(step.abs());
            }
        }
        // The noise does not repeat earlier.
        let half = p + DVec3::X;
        assert!((gradient_3d(half, period, 7) - gradient_3d(p, period, 7)).abs() > 1e-9);
    }
    assert!(largest < 1e-12, "{largest:e}");
}

#[test]
fn gradient_noise_is_zero_at_the_corners_of_cells() {
    let period = UVec3::new(4, 7, 5);
    for i in -4..=8 {
        for j in -4..=8 {
            assert_eq!(gradient_2d(DVec2::new(f64::from(i), f64::from(j)), period.truncate(), 3), 0.0);
            for k in -4..=8 {
                let corner = DVec3::new(f64::from(i), f64::from(j), f64::from(k));
                assert_eq!(gradient_3d(corner, period, 3), 0.0);
            }
        }
    }
}

/// First and second derivative to one side of a face, by differences.
fn derivatives(f: impl Fn(f64) -> f64, h: f64) -> [f64; 2] {
    let [a, b, c] = [f(0.0), f(h), f(2.0 * h)];
    [(4.0 * b - 3.0 * a - c) / (2.0 * h), (a - 2.0 * b + c) / (h * h)]
}

#[test]
fn first_and_second_derivatives_are_continuous_across_faces() {
    let (mut first, mut second, mut steepest) = (0.0_f64, 0.0_f64, 0.0_f64);
    for p in points(500, 8.0) {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            // On a face of a cell.
            let p = p - axis * p + axis * p.dot(axis).floor();
            let along = |x: f64| gradient_3d(p + axis * x, UVec3::splat(8), 5);
            let plane = |x: f64| gradient_2d((p + axis * x).truncate(), UVec2::splat(8), 5);
            for [before, after] in [
                [derivatives(along, -1e-4), derivatives(along, 1e-4)],
                [derivatives(plane, -1e-4), derivatives(plane, 1e-4)],
            ] {
                first = first.max((before[0] - after[0]).abs());
                second = second.max((before[1] - after[1]).abs());
                steepest = steepest.max(after[1].abs());
            }
        }
    }
    // Third derivatives of some tens cause up to 2e-4 in these differences. A cubic fade would cause 12 in the second
    // derivative.
    assert!(first < 1e-5 && second < 0.05, "{first} {second}, of {steepest}");
}

/// Mean, standard deviation, least and greatest.
fn statistics(values: impl Iterator<Item = f64>) -> [f64; 4] {
    let (mut n, mut sum, mut squares, mut low, mut high) = (0.0, 0.0, 0.0, f64::MAX, f64::MIN);
    for v in values {
        (n, sum, squares) = (n + 1.0, sum + v, squares + v * v);
        (low, high) = (low.min(v), high.max(v));
    }
    let mean: f64 = sum / n;
    [mean, (squares / n - mean * mean).sqrt(), low, high]
}

#[test]
fn statistics_are_those_of_noise_without_a_preferred_direction() {
    let period = UVec3::splat(64);
    let space = statistics(points(200_000, 64.0).map(|p| gradient_3d(p, period, 1)));
    let plane = statistics(points(200_000, 64.0).map(|p| gradient_2d(p.truncate(), period.truncate(), 1)));
    for [mean, deviation, low, high] in [space, plane] {
        println!("mean {mean:.5}, deviation {deviation:.4}, from {low:.3} to {high:.3}");
        // Plane and space alike, so that the same settings have the same cover.
        assert!(mean.abs() < 0.005 && (0.268..0.274).contains(&deviation), "{mean} {deviation}");
        assert!((-1.05..-0.75).contains(&low) && (0.75..1.05).contains(&high), "{low} {high}");
    }
    // The mean square of steps of half a cell: alike along the axes, and about so along diagonals.
    let steps = |axis: DVec3| {
        let step = 0.5 * axis.normalize();
        let of = |p: DVec3| {
            let space = gradient_3d(p + step, period, 1) - gradient_3d(p, period, 1);
            let at = p.truncate();
            let plane = gradient_2d(at + step.truncate(), period.truncate(), 1) - gradient_2d(at, period.truncate(), 1);
            DVec2::new(space * space, plane * plane)
        };
        points(50_000, 64.0).map(of).sum::<DVec2>() / 50_000.0
    };
    let (x, y, z) = (steps(DVec3::X), steps(DVec3::Y), steps(DVec3::Z));
    let (up, down) = (steps(DVec3::new(1.0, 1.0, 0.0)), steps(DVec3::new(1.0, -1.0, 0.0)));
    println!("x {x:.4}, y {y:.4}, z {z:.4}, diagonals {up:.4} {down:.4}");
    let alike = |a: f64, b: f64, within: f64| (a / b - 1.0).abs() < within;
    assert!(alike(x.x, y.x, 0.03) && alike(x.x, z.x, 0.03) && alike(x.y, y.y, 0.03), "axes");
    assert!(alike(up.x, down.x, 0.03) && alike(up.y, down.y, 0.03), "diagonals");
    assert!(alike(up.x, x.x, 0.2) && alike(up.y, x.y, 0.2), "diagonals and axes");
}

#[test]
fn cellular_noise_changes_no_faster_than_the_place() {
    let period = UVec3::splat(16);
    let (mut means, mut differing) = ([0.0; 2], 0);
    let count = 4000;
    for p in points(count, 16.0) {
        let values = [cellular_2d(p.truncate(), period.truncate(), 9), cellular_3d(p, period, 9)];
        for (mean, value) in means.iter_mut().zip(values) {
            assert!((0.0..=1.0).contains(&value), "{value}");
            *mean += value / f64::from(count);
        }
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let near = p + 1e-3 * axis;
            let steps = [
                cellular_2d(near.truncate(), period.truncate(), 9) - values[0],
                cellular_3d(near, period, 9) - values[1],
            ];
            assert!(steps.iter().all(|s| s.abs() < 1.001e-3), "{steps:?} at {p}");
            differing += u32::from(steps[1] != 0.0);
        }
    }
    println!("means {means:?}");
    assert!(differing > 2 * count, "{differing}");
}

#[test]
fn octaves_too_fine_for_a_texture_add_their_mean() {
    for kind in [NoiseKind::Gradient, NoiseKind::Cellular] {
        let settings = NoiseSettings { kind, octaves: 6, frequency: [8; 3], persistence: 0.6, amplitude: 0.3, seed: 4 };
        for (coarse, fine) in [([32, 32, 1], [1024, 1024, 1]), ([32, 32, 32], [1024, 1024, 1024])] {
            assert!(settings.octaves_in(coarse) < 3 && settings.octaves_in(fine) == 6);
            let mean = |size| statistics(points(60_000, 1.0).map(|p| noise_at(&settings, size, p)))[0];
            let (coarse, fine) = (mean(coarse), mean(fine));
            assert!((coarse - fine).abs() < 0.004, "{kind:?}: {coarse} {fine}");
        }
    }
}

#[test]
fn one_octave_is_the_noise_itself_and_more_are_a_sum() {
    let size = [256; 3];
    let one = NoiseSettings { octaves: 1, amplitude: 0.5, ..Default::default() };
    let at = |settings: &NoiseSettings, p| noise_at(settings, size, p);
    let two = NoiseSettings { octaves: 2, ..one };
    for p in points(200, 1.0) {
        // At most 0.5 + 0.25: nothing is clamped. The second octave is the first one at twice the frequency, with
        // another key.
        let second = at(&two, p) - at(&one, p);
        assert!((0.0..=0.26).contains(&second), "{second}");
        let corner = (p * 6.0).floor() / 6.0;
        assert!((at(&one, corner) - 0.25).abs() < 1e-12, "amplitude over 2 where the noise is 0");
    }
}

/// Returns the correlation of two images, -1 to 1.
fn correlation(a: &NoiseImage, b: &NoiseImage) -> f64 {
    let values = |i: &NoiseImage| i.levels()[0].iter().map(|n| f64::from(*n)).collect::<Vec<_>>();
    let (a, b) = (values(a), values(b));
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (ma, mb) = (mean(&a), mean(&b));
    let product = |f: &dyn Fn(f64, f64) -> f64| a.iter().zip(&b).map(|(a, b)| f(a - ma, b - mb)).sum::<f64>();
    product(&|a, b| a * b) / (product(&|a, _| a * a) * product(&|_, b| b * b)).sqrt()
}

#[test]
fn another_seed_is_another_pattern_and_the_same_one_the_same() {
    let of = |seed, kind| {
        let settings = NoiseSettings { seed, kind, octaves: 3, frequency: [16; 3], ..Default::default() };
        NoiseImage::generate([256, 256, 1], &settings).unwrap()
    };
    for kind in [NoiseKind::Gradient, NoiseKind::Cellular, NoiseKind::GradientOverCellular] {
        let first = of(1, kind);
        assert_eq!(first, of(1, kind));
        for seed in [0, 2, 3, 1 << 32, (1 << 32) + 1, u64::MAX] {
            let c = correlation(&first, &of(seed, kind));
            assert!(c.abs() < 0.1, "{kind:?} {seed}: {c}");
        }
    }
    assert!(correlation(&of(1, NoiseKind::Gradient), &of(1, NoiseKind::Cellular)).abs() < 0.1);
}

#[test]
fn four_tiles_side_by_side_show_no_seam() {
    for (size, kind) in [
        ([128, 128, 1], NoiseKind::Gradient),
        ([128, 128, 1], NoiseKind::Cellular),
        ([64, 32, 32], NoiseKind::GradientOverCellular),
    ] {
        let settings = NoiseSettings { kind, frequency: [4, 3, 2], seed: 11, ..Default::default() };
        let image = NoiseImage::generate(size, &settings).unwrap();
        let at = |p: [u32; 3]| {
            let [x, y, z] = [0, 1, 2].map(|i| (p[i] % size[i]) as usize);
            i32::from(image.levels()[0][(z * size[1] as usize + y) * size[0] as usize + x])
        };
        for axis in 0..if size[2] == 1 { 2 } else { 3 } {
            // The largest step from each layer across this axis to the next one.
            let mut steps = vec![0; size[axis] as usize];
            for i in 0..size[0] * size[1] * size[2] {
                let p = [i % size[0], i / size[0] % size[1], i / (size[0] * size[1])];
                let mut next = p;
                next[axis] += 1;
                let step = &mut steps[p[axis] as usize];
                *step = (*step).max((at(next) - at(p)).abs());
            }
            let seam = steps.pop().unwrap();
            let inner = *steps.iter().max().unwrap();
            assert!(seam <= inner && seam > 0, "{kind:?}, axis {axis}: {seam} across the seam, {inner} inside");
        }
    }
}
