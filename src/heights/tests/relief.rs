//! Terrain of noise: the same bits for the same seed, tiles that fit, and the laws of fractional Brownian motion.

use super::{
    super::{NoiseTerrain, ReliefKind},
    *,
};

fn hash(map: &HeightMap) -> u64 {
    let bytes = map.heights_m().iter().flat_map(|h| h.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[test]
fn a_seed_gives_one_terrain() {
    let map = |kind, seed| {
        let terrain = NoiseTerrain { kind, seed, ..Default::default() };
        HeightMap::generate(64, 48, 10.0, [-5000.0, 300.0], &terrain).unwrap()
    };
    let hashes =
        [(ReliefKind::Fractal, 0), (ReliefKind::Fractal, 1), (ReliefKind::Ridged, 0), (ReliefKind::Ridged, 1 << 40)]
            .map(|(kind, seed)| hash(&map(kind, seed)));
    // Bits that every machine must give.
    assert_eq!(
        hashes.map(|h| format!("{h:016x}")),
        ["a5ea949fc747444e", "10246ae71f667466", "bc61d2950c461cdb", "3afb237dfc2ab1e6"]
    );
}

#[test]
fn neighbouring_maps_fit_together() {
    for kind in [ReliefKind::Fractal, ReliefKind::Ridged] {
        let terrain = NoiseTerrain { kind, seed: 7, ..Default::default() };
        let whole = HeightMap::generate(32, 16, 25.0, [1e6, -3200.0], &terrain).unwrap();
        let part = HeightMap::generate(16, 16, 25.0, [1e6 + 400.0, -3200.0], &terrain).unwrap();
        for (x, y) in (0..16).flat_map(|x| (0..16).map(move |y| (x, y))) {
            assert_eq!(part.height_m(x, y), whole.height_m(x + 16, y));
        }
    }
}

/// Mean squared difference of heights `lag` samples apart.
fn structure(map: &HeightMap, lag: u32) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (x, y) in (0..map.columns() - lag).flat_map(|x| (0..map.rows()).map(move |y| (x, y))) {
        let step = f64::from(map.height_m(x + lag, y).unwrap() - map.height_m(x, y).unwrap());
        (sum, count) = (sum + step * step, count + 1.0);
    }
    sum / count
}

/// Squared differences of heights grow as distance^2H (Mandelbrot and Van Ness 1968, corollary 3.4).
#[test]
fn differences_grow_as_the_hurst_exponent_says() {
    for hurst in [0.3, 0.5, 0.8] {
        let mut sums = [0.0; 2];
        for seed in 0..10 {
            let terrain = NoiseTerrain { seed, hurst, wavelength_m: 131_072.0, ..Default::default() };
            let map = HeightMap::generate(512, 48, 1.0, [0.0, 0.0], &terrain).unwrap();
            sums = [sums[0] + structure(&map, 20), sums[1] + structure(&map, 80)];
        }
        let found = 0.5 * (sums[1] / sums[0]).ln() / 4_f64.ln();
        println!("H {hurst}: {found:.3}");
        assert!((found - hurst).abs() < 0.05, "H {hurst}: {found}");
    }
}

/// Sharpest bends downwards and upwards of a single octave along a line, between places `step_m` apart.
fn sharpest_bends(kind: ReliefKind, step_m: f64) -> [f64; 2] {
    let terrain = NoiseTerrain { kind, wavelength_m: 400.0, ..Default::default() };
    let height = |i: i32| terrain.height_m(step_m * f64::from(i), 137.0, 400.0);
    let bends = (0..(8000.0 / step_m) as i32).map(|i| height(i - 1) - 2.0 * height(i) + height(i + 1));
    bends.fold([0.0, 0.0], |[down, up], bend| [f64::min(down, bend), f64::max(up, bend)])
}

/// If the step is halved, bends shrink to a quarter on smooth ground, and to half at a crease.
#[test]
fn crests_of_ridges_are_creases_and_all_else_is_smooth() {
    let ratios = |kind| {
        let (wide, near) = (sharpest_bends(kind, 1.0), sharpest_bends(kind, 0.5));
        [wide[0] / near[0], wide[1] / near[1]]
    };
    let (fractal, ridged) = (ratios(ReliefKind::Fractal), ratios(ReliefKind::Ridged));
    println!("{fractal:?} {ridged:?}");
    assert!((ridged[0] - 2.0).abs() < 0.3, "{ridged:?}");
    assert!([fractal[0], fractal[1], ridged[1]].iter().all(|ratio| (ratio - 4.0).abs() < 0.3));
    let terrain = |kind| NoiseTerrain { kind, ..Default::default() };
    let map = |kind| HeightMap::generate(256, 256, 25.0, [0.0, 0.0], &terrain(kind)).unwrap();
    assert!(map(ReliefKind::Ridged).range_m().unwrap()[0] >= 0.0);
    let mean = map(ReliefKind::Fractal).mean_m().unwrap();
    assert!(mean.abs() < 60.0, "{mean}");
}

/// Octaves finer than two samples would alias: halving the distance of samples adds one and changes no other.
#[test]
fn a_finer_map_adds_one_octave() {
    let terrain = NoiseTerrain { hurst: 0.5, amplitude_m: 100.0, wavelength_m: 800.0, ..Default::default() };
    let map = |cell| HeightMap::generate(32, 32, cell, [0.0, 0.0], &terrain).unwrap();
    let (coarse, fine) = (map(20.0), map(10.0));
    let mut most = 0.0_f32;
    for (x, y) in (0..16).flat_map(|x| (0..16).map(move |y| (x, y))) {
        most = most.max((coarse.height_m(x, y).unwrap() - fine.height_m(2 * x, 2 * y).unwrap()).abs());
    }
    // 800, 400 .. 50 m, then 25 m: the sixth octave.
    let amplitude = 100.0 * 0.5_f32.powf(0.5 * 5.0);
    assert!(most > 0.3 * amplitude && most <= 0.85 * amplitude, "{most} {amplitude}");
}
