//! The bows of one drop against Mie's theory.

use std::f64::consts::PI;

use welkin::bow::reference::{Rays, airy, water_index};

use crate::mie::intensities;

const NM: f64 = 550.0;
const STEP_DEG: f64 = 0.1;

/// Returns the light of drops around a radius (micrometres, spread by 15 %), smoothed by the light's disc, at angles
/// from the point opposite to the light: by the model with external reflection added, and by Mie's theory.
fn both(radius_um: f64, degrees: &[f64]) -> [Vec<f64>; 2] {
    let n = water_index(NM);
    let rays = [Rays { inside: 1, index: n }, Rays { inside: 2, index: n }];
    let angles: Vec<f64> = degrees.iter().map(|d| d.to_radians()).collect();
    let cosines: Vec<f64> = angles.iter().map(|a| -a.cos()).collect();
    let pairs = rays.map(|r| angles.iter().map(|a| r.pair(*a)).collect::<Vec<_>>());
    let (mut model, mut mie) = (vec![0.0; angles.len()], vec![0.0; angles.len()]);
    const SIZES: i32 = 24;
    for k in 0..SIZES {
        let x = 2.0 * PI * radius_um * (1.0 + 0.3 * ((f64::from(k) + 0.5) / f64::from(SIZES) - 0.5)) * 1e3 / NM;
        for (i, light) in intensities(x, n, &cosines).into_iter().enumerate() {
            mie[i] += light / f64::from(SIZES);
            let bows: f64 = (0..2).map(|b| rays[b].intensity(x, angles[i], pairs[b][i].as_ref())).sum();
            model[i] += (bows + outside(n, angles[i])) / f64::from(SIZES);
        }
    }
    [model, mie].map(|v| smoothed(&v))
}

/// Returns the external reflection of a drop in the same unit: a quarter of Fresnel's reflectance.
fn outside(n: f64, angle: f64) -> f64 {
    // The ray is turned by pi - 2 i, where i is the angle of incidence.
    let ci = (0.5 * angle).cos();
    let cr = (1.0 - (1.0 - ci * ci) / (n * n)).sqrt();
    let [s, p] = [(ci - n * cr) / (ci + n * cr), (cr - n * ci) / (cr + n * ci)];
    0.25 * 0.5 * (s * s + p * p)
}

fn smoothed(v: &[f64]) -> Vec<f64> {
    let reach = (0.266 / STEP_DEG) as isize;
    let of = |i: usize| {
        let (mut sum, mut all) = (0.0, 0.0);
        for k in -reach..=reach {
            let chord = (1.0 - (k as f64 * STEP_DEG / 0.266).powi(2)).max(0.0).sqrt();
            let j = (i as isize + k).clamp(0, v.len() as isize - 1) as usize;
            sum += v[j] * chord;
            all += chord;
        }
        sum / all
    };
    (0..v.len()).map(of).collect()
}

/// Angle and height of the largest value between two angles, and the width at three quarters of it, degrees.
fn bow(degrees: &[f64], v: &[f64], from: f64, to: f64) -> [f64; 3] {
    let inside = || (0..v.len()).filter(|i| (from..to).contains(&degrees[*i]));
    let most = inside().max_by(|a, b| v[*a].total_cmp(&v[*b])).expect("some");
    let side = |step: isize| {
        let mut i = most as isize;
        while (1..v.len() as isize - 1).contains(&i) && v[i as usize] > 0.75 * v[most] {
            i += step;
        }
        degrees[i as usize]
    };
    [degrees[most], v[most], side(1) - side(-1)]
}

#[test]
fn both_bows_are_those_of_mie() {
    let degrees: Vec<f64> = (0..440).map(|i| 20.0 + f64::from(i) * STEP_DEG).collect();
    for (radius_um, secondary) in [(10.0, false), (40.0, true), (100.0, true), (300.0, true)] {
        let [model, mie] = both(radius_um, &degrees);
        for (name, from, to) in [("primary", 30.0, 46.0), ("secondary", 49.0, 60.0)] {
            if name == "secondary" && !secondary {
                continue;
            }
            let (ours, theirs) = (bow(&degrees, &model, from, to), bow(&degrees, &mie, from, to));
            println!(
                "{radius_um} um, {name}: at {:.1} degrees, {:.4} 1/sr, {:.1} wide; Mie {:.1}, {:.4}, {:.1}",
                ours[0], ours[1], ours[2], theirs[0], theirs[1], theirs[2]
            );
            let off = (ours[0] - theirs[0]).abs();
            assert!(off < 0.25, "{radius_um} {name}: {off} degrees");
            assert!((ours[1] / theirs[1] - 1.0).abs() < 0.15, "{radius_um} {name}: {ours:?} {theirs:?}");
            assert!((ours[2] / theirs[2] - 1.0).abs() < 0.25, "{radius_um} {name}: {ours:?} {theirs:?}");
        }
        // Alexander's band.
        let dark =
            |v: &[f64]| v.iter().zip(&degrees).filter(|(_, d)| (45.5..48.5).contains(*d)).map(|(v, _)| v).sum::<f64>();
        println!("{radius_um} um: dark band {:.5} of Mie's {:.5}", dark(&model), dark(&mie));
    }
}

#[test]
fn least_turns_are_those_of_descartes() {
    // The angles of van de Hulst 1957, table 21, for index 4/3: 138.0 and 129.0 (231.0) degrees.
    let least = |inside| {
        let rays = Rays { inside, index: 4.0 / 3.0 };
        rays.turn(rays.least()).to_degrees()
    };
    assert!((least(1) - 137.97).abs() < 0.05 && (least(2) - 230.9).abs() < 0.1, "{} {}", least(1), least(2));
    // Water of 10 degrees at the sodium line: 1.3337.
    assert!((water_index(589.3) - 1.3337).abs() < 1e-4);
}

#[test]
fn airy_has_its_tabulated_values() {
    // Abramowitz and Stegun 1964, tables 10.11 and 10.13.
    for (x, ai, slope) in [
        (0.0, 0.355_028_05, -0.258_819_40),
        (1.0, 0.135_292_42, -0.159_147_44),
        (-1.0, 0.535_560_88, -0.010_160_57),
        (-2.338_107_41, 0.0, 0.701_210_82),
        (-4.087_949_44, 0.0, -0.803_111_37),
        (-5.520_559_83, 0.0, 0.865_204_03),
        (-10.0, 0.040_241_23, 0.996_265_04),
    ] {
        let [a, d] = airy(x);
        assert!((a - ai).abs() < 1e-3 && (d - slope).abs() < 2e-3, "Ai({x}) = {a}, Ai'({x}) = {d}");
    }
}
