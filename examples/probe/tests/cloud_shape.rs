//! Tests of the statistics of clouds' shape: on pictures whose statistics are known, and on the drawn clouds.

use std::{f64::consts::PI, fs, path::Path, process::Command};

use welkin::weather::CloudKind;
use welkin_probe::cloud_shape;
use welkin_support::{
    accept,
    cloud_shape::{CloudMask, CloudShape, clouds_of, measure},
};

/// Side of the pictures, pixels.
const SIDE: usize = 1024;
/// Side of a pixel, m.
const PIXEL_M: f64 = 20.0;

/// Pseudorandom numbers (SplitMix64, Steele, Lea and Flood 2014).
struct Chance(u64);

impl Chance {
    /// Returns the next number, 0 to 1, both ends left out.
    fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let v = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let v = (v ^ (v >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((v ^ (v >> 31)) >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }
}

/// Draws ellipses that do not touch each other, of these half axes in pixels, turned by `axis_deg`. Those that find no
/// room in a few tries are left out.
fn ellipses(half_axes: &[[f64; 2]], axis_deg: f64, chance: &mut Chance) -> CloudMask {
    let mut cloudy = vec![false; SIDE * SIDE];
    let (sine, cosine) = axis_deg.to_radians().sin_cos();
    for [long, short] in half_axes {
        for _ in 0..40 {
            let middle = [chance.even() * SIDE as f64, chance.even() * SIDE as f64];
            let within = |x: usize, y: usize, margin: f64| {
                let (x, y) = (x as f64 + 0.5 - middle[0], y as f64 + 0.5 - middle[1]);
                let (along, across) = (x * cosine + y * sine, y * cosine - x * sine);
                (along / (long + margin)).powi(2) + (across / (short + margin)).powi(2) < 1.0
            };
            let reach = |at: f64| {
                let (from, to) = ((at - long - 3.0).max(0.0) as usize, (at + long + 3.0).min(SIDE as f64) as usize);
                from..to
            };
            let box_of = || reach(middle[1]).flat_map(|y| reach(middle[0]).map(move |x| (x, y)));
            if box_of().any(|(x, y)| cloudy[y * SIDE + x] && within(x, y, 2.0)) {
                continue;
            }
            box_of().filter(|(x, y)| within(*x, *y, 0.0)).for_each(|(x, y)| cloudy[y * SIDE + x] = true);
            break;
        }
    }
    CloudMask::new(SIDE, |x, y| cloudy[y * SIDE + x])
}

fn shape_of(masks: &[CloudMask]) -> CloudShape {
    let shape = measure(masks, PIXEL_M);
    println!(
        "cover {:.3}, {} clouds, dimension {:?}, perimeters {:?}, areas {:?}, edges {:.3} at {:.0}, {:?}",
        shape.cover,
        shape.count,
        shape.dimension,
        shape.perimeter_exponent,
        shape.area_exponent,
        shape.edges.strongest(),
        shape.edges.axis_deg,
        shape.law
    );
    shape
}

#[test]
fn clouds_are_found_with_their_pixels_perimeters_and_cuts() {
    let rows = ["........", ".###....", ".#.#..#.", ".###...#", "........", "#.......", ".....#..", "........"];
    let mask = CloudMask::new(8, |x, y| rows[y].as_bytes()[x] == b'#');
    let (clouds, _) = clouds_of(&mask);
    let found: Vec<(usize, usize, bool)> = clouds.iter().map(|c| (c.pixels, c.perimeter, c.is_cut)).collect();
    // Pixels that touch at a corner are two clouds; edges on the picture's border do not count.
    assert_eq!(found, [(8, 16, false), (1, 4, false), (1, 3, true), (1, 3, true), (1, 4, false)]);
}

/// Discs have the dimension 1 and prefer no direction; the numbers of their diameters are those that were drawn, though
/// those at the border are cut.
#[test]
fn discs_are_round_and_as_many_as_were_drawn() {
    let mut chance = Chance(1);
    // Diameters by D^-1.8 from 60 m to 600 m and by D^-3.5 from there to 2500 m.
    let (low, brk, high, below, above) = (60.0f64, 600.0f64, 2500.0f64, 0.8, 2.5);
    let share = |from: f64, to: f64, b: f64| (1.0 - (to / from).powf(-b)) / b;
    let parts = [share(low, brk, below) * (low / brk).powf(-below), share(brk, high, above)];
    let diameter = |chance: &mut Chance| {
        let (from, to, b) =
            if chance.even() * (parts[0] + parts[1]) < parts[0] { (low, brk, below) } else { (brk, high, above) };
        from * (1.0 - chance.even() * (1.0 - (to / from).powf(-b))).powf(-1.0 / b)
    };
    let masks: Vec<CloudMask> = (0..6)
        .map(|_| {
            let mut radii: Vec<f64> = (0..1400).map(|_| 0.5 * diameter(&mut chance) / PIXEL_M).collect();
            radii.sort_by(|a, b| b.total_cmp(a));
            ellipses(&radii.iter().map(|r| [*r, *r]).collect::<Vec<_>>(), 0.0, &mut chance)
        })
        .collect();
    let shape = shape_of(&masks);
    assert!((shape.dimension.unwrap() - 1.0).abs() < 0.02);
    assert!(shape.edges.strongest() < 1.06);
    let law = shape.law.unwrap();
    assert!((law.below + 1.8).abs() < 0.1 && (law.above + 3.5).abs() < 0.4, "{law:?}");
    assert!((450.0..800.0).contains(&law.break_m), "{law:?}");
}

/// Edges that lie along a direction are found there.
#[test]
fn drawn_out_clouds_lie_along_their_direction() {
    let mut chance = Chance(2);
    for axis_deg in [0.0, 37.0, 118.0] {
        let mask = ellipses(&[[24.0, 12.0]; 500], axis_deg, &mut chance);
        let edges = shape_of(&[mask]).edges;
        let off = (edges.axis_deg - axis_deg + 90.0).rem_euclid(180.0) - 90.0;
        assert!(off.abs() < 3.0 && edges.strongest() > 1.4, "{axis_deg}: {edges:?}");
    }
}

/// Transforms rows of complex numbers by Cooley and Tukey (1965), radix 2.
fn transform(values: &mut [[f64; 2]]) {
    let count = values.len();
    for i in 0..count {
        let j = i.reverse_bits() >> (usize::BITS - count.trailing_zeros());
        if i < j {
            values.swap(i, j);
        }
    }
    let mut half = 1;
    while half < count {
        for k in 0..half {
            let (sine, cosine) = (PI * k as f64 / half as f64).sin_cos();
            for low in (k..count).step_by(2 * half) {
                let ([a, b], [c, d]) = (values[low], values[low + half]);
                let turned = [c * cosine - d * sine, c * sine + d * cosine];
                values[low] = [a + turned[0], b + turned[1]];
                values[low + half] = [a - turned[0], b - turned[1]];
            }
        }
        half *= 2;
    }
}

/// Returns a Gaussian surface whose spectrum falls as k^-(2 H + 2): fractional Brownian motion with the exponent H.
fn brownian_surface(exponent: f64, chance: &mut Chance) -> Vec<f64> {
    let wave = |i: usize| i.min(SIDE - i) as f64;
    let mut waves: Vec<[f64; 2]> = (0..SIDE * SIDE)
        .map(|i| {
            let k = wave(i % SIDE).hypot(wave(i / SIDE));
            let (length, angle) = ((-2.0 * chance.even().ln()).sqrt(), 2.0 * PI * chance.even());
            let length = if k > 0.0 { length * k.powf(-exponent - 1.0) } else { 0.0 };
            [length * angle.cos(), length * angle.sin()]
        })
        .collect();
    for _ in 0..2 {
        waves.chunks_mut(SIDE).for_each(transform);
        waves = (0..SIDE * SIDE).map(|i| waves[i % SIDE * SIDE + i / SIDE]).collect();
    }
    waves.into_iter().map(|[real, _]| real).collect()
}

/// Islands above the mean level of a fractional Brownian surface have coasts of dimension (3 - H) / 2, areas by the
/// exponent (2 - H) / 2, and so perimeters by 2 (2 - H) / (3 - H) (Kondev and Henley 1995). Long perimeters are rare in
/// four pictures, hence the wide tolerance of theirs; smoother surfaces have too few islands.
#[test]
fn islands_of_brownian_surfaces_have_their_known_exponents() {
    let mut chance = Chance(3);
    for hurst in [0.2, 1.0 / 3.0] {
        let mask = || {
            let surface = brownian_surface(hurst, &mut chance);
            let mut sorted = surface.clone();
            let (_, middle, _) = sorted.select_nth_unstable_by(SIDE * SIDE / 2, f64::total_cmp);
            let middle = *middle;
            CloudMask::new(SIDE, |x, y| surface[y * SIDE + x] > middle)
        };
        let masks: Vec<CloudMask> = std::iter::repeat_with(mask).take(4).collect();
        let shape = shape_of(&masks);
        let known = [(3.0 - hurst) / 2.0, 2.0 * (2.0 - hurst) / (3.0 - hurst), (2.0 - hurst) / 2.0];
        let found = [shape.dimension, shape.perimeter_exponent, shape.area_exponent].map(Option::unwrap);
        println!("H {hurst:.2}: found {found:.3?}, known {known:.3?}");
        for (found, (known, tolerance)) in found.into_iter().zip(known.into_iter().zip([0.04, 0.16, 0.06])) {
            assert!((found - known).abs() < tolerance, "H {hurst}: {found}, {known}");
        }
        assert!(shape.edges.strongest() < 1.08);
    }
}

/// Clusters of site percolation at the threshold 0.592746: the number of areas falls by 187/91 - 1, and the accessible
/// outline has the dimension 4/3 (Stauffer and Aharony 1994; Grossman and Aharony 1987).
#[test]
fn percolation_clusters_have_their_known_exponents() {
    let mut chance = Chance(4);
    let masks: Vec<CloudMask> = (0..2).map(|_| CloudMask::new(SIDE, |_, _| chance.even() < 0.592_746)).collect();
    let shape = shape_of(&masks);
    let (dimension, areas) = (shape.dimension.unwrap(), shape.area_exponent.unwrap());
    assert!((dimension - 4.0 / 3.0).abs() < 0.06 && (areas - 96.0 / 91.0).abs() < 0.13, "{dimension} {areas}");
}

#[test]
fn wrong_options_are_named() {
    let refused = |okta: f64, genus: &str, pixel_m: f64, wanted: &str| {
        let e = cloud_shape::answer(genus, okta / 8.0, 1, pixel_m).unwrap_err().to_string();
        assert!(e.contains(wanted), "{e}");
    };
    refused(3.0, "cumulus", 0.0, "--pixel must be in [1, 1000] m");
    refused(3.0, "nimbus", 20.0, "`nimbus` is no genus");
    refused(0.0, "cumulus", 20.0, "--okta must be above 0");
}

#[test]
fn the_drawn_clouds_are_measured() {
    let out = cloud_shape::answer("cumulus", 3.0 / 8.0, 1, PIXEL_M).unwrap();
    println!("{out}");
    let (head, tail) = out.split_once("\n\n").unwrap();
    let numbers: Vec<f64> = head.lines().nth(1).unwrap().split(',').map(|n| n.parse().unwrap()).collect();
    assert!(numbers.len() == 11 && (0.2..0.45).contains(&numbers[0]) && numbers[1] > 100.0, "{head}");
    assert!(tail.starts_with("diameter_m,clouds,per_km2_km\n") && tail.lines().count() > 10, "{tail}");
}

/// Runs a command and returns what it prints; an error with what it says otherwise.
fn output_of(command: &mut Command) -> Result<String, String> {
    let done = command.output().map_err(|e| format!("{command:?}: {e}"))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if done.status.success() { Ok(text(&done.stdout)) } else { Err(text(&done.stderr)) }
}

/// The public package objscale 2.2.0 (DeWitt and Garrett 2024) finds the same numbers in the drawn clouds, with
/// `WELKIN_ACCEPT=1`.
#[test]
fn objscale_finds_the_same_numbers() {
    if !accept() {
        println!("skipped: objscale is asked with WELKIN_ACCEPT=1");
        return;
    }
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("objscale");
    let python = dir.join("bin/python");
    let made = output_of(Command::new("python3").args(["-m", "venv"]).arg(&dir))
        .and_then(|_| output_of(Command::new(&python).args(["-m", "pip", "install", "--quiet", "objscale==2.2.0"])));
    if let Err(e) = made {
        println!("skipped: objscale could not be had from PyPI: {e}");
        return;
    }
    for (kind, okta) in [(CloudKind::Cumulus, 3.0), (CloudKind::Stratocumulus, 4.0), (CloudKind::Altocumulus, 2.0)] {
        let masks = cloud_shape::masks(kind, okta / 8.0, 4, PIXEL_M).unwrap();
        let shape = shape_of(&masks);
        let mut command = Command::new(&python);
        command.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/ask_objscale.py"));
        for (seed, mask) in masks.iter().enumerate() {
            let path = dir.join(format!("{seed}.raw"));
            fs::write(&path, mask.pixels().iter().map(|p| u8::from(*p)).collect::<Vec<_>>()).unwrap();
            command.arg(path);
        }
        let theirs: Vec<f64> =
            output_of(&mut command).unwrap().split_whitespace().map(|n| n.parse().unwrap()).collect();
        let ours = [shape.dimension, shape.perimeter_exponent, shape.area_exponent].map(|n| n.unwrap_or(f64::NAN));
        println!("{kind:?} at {okta} oktas: {ours:.4?}, objscale {theirs:.4?}");
        for (ours, theirs) in ours.into_iter().zip(theirs) {
            assert!((ours - theirs).abs() < 0.01 || ours.is_nan() && theirs.is_nan(), "{ours} {theirs}");
        }
    }
}
