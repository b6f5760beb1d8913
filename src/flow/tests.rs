//! Tests of the field against published flows and against its own promises.

mod bits;
mod bluff;

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::{
    multigrid::GridLevel,
    pressure::Pressure,
    probe::{cavity, taylor_green},
    *,
};
use crate::error::Status;

/// Whether the long cases run too.
fn is_long() -> bool {
    std::env::var_os("WELKIN_ACCEPT").is_some()
}

/// Creates a field that must be valid.
fn field(settings: &FlowSettings, obstacles: &FlowObstacles, wind: impl Fn(DVec3) -> DVec3) -> FlowField {
    FlowField::new(settings, obstacles, wind).expect("a field")
}

/// Horizontal velocity on the vertical centre line of a lid-driven cavity, in speeds of the lid. Columns: height in
/// heights of the cavity; velocity at Re = 100 (Ghia et al. 1982); velocity at Re = 1000 (Botella and Peyret 1998).
const CAVITY: [[f64; 3]; 13] = [
    [1.0, 1.0, 1.0],
    [0.9766, 0.84123, 0.6644227],
    [0.9609, 0.73722, 0.5169277],
    [0.8516, 0.23151, 0.3372212],
    [0.7344, 0.00332, 0.1886747],
    [0.6172, -0.13641, 0.0570178],
    [0.5, -0.20581, -0.0620561],
    [0.4531, -0.21090, -0.1081999],
    [0.2813, -0.15662, -0.2803696],
    [0.1719, -0.10150, -0.3885691],
    [0.1016, -0.06434, -0.3004561],
    [0.0703, -0.04775, -0.2228955],
    [0.0547, -0.03717, -0.1812881],
];

/// Returns the largest difference of the horizontal velocity on the centre line from [`CAVITY`], in speeds of the lid.
fn cavity_error(re: f64, n: u32) -> f64 {
    let field = cavity(re, n).expect("a cavity");
    let column = if re < 500.0 { 1 } else { 2 };
    let error = |row: &[f64; 3]| (field.velocity_at(dvec3(0.5, row[0], 0.0)).x - row[column]).abs();
    CAVITY.iter().map(error).fold(0.0, f64::max)
}

#[test]
fn a_lid_drives_the_cavity_as_published() {
    let cases: &[(f64, u32)] =
        if is_long() { &[(100.0, 32), (100.0, 64), (100.0, 128), (1000.0, 128)] } else { &[(100.0, 32)] };
    for &(re, n) in cases {
        let error = cavity_error(re, n);
        println!("Re {re}, {n}^2: {:.2} % of the lid's speed", 100.0 * error);
        assert!(error < 0.015, "Re {re}, {n}^2: {error}");
    }
}

#[test]
fn whirls_keep_their_energy() {
    // Scheme, CFL number and bounds of the share of kinetic energy that is kept. The bounds of the default scheme are a
    // promise; those of the others enclose values that were computed with a spectral projection.
    let cases = [
        (Scheme::Reflection, 1.0, 0.98, 1.005),
        (Scheme::Reflection, 4.0, 0.95, 1.005),
        (Scheme::MacCormack, 1.0, 0.73, 0.82),
        (Scheme::MacCormack, 4.0, 0.42, 0.52),
        (Scheme::SemiLagrangian, 1.0, 0.62, 0.70),
        (Scheme::SemiLagrangian, 4.0, 0.38, 0.46),
    ];
    for (scheme, cfl, low, high) in cases {
        let kept = taylor_green(64, cfl, scheme).expect("whirls");
        println!("{scheme:?} CFL {cfl}: {kept:.4}");
        assert!((low..=high).contains(&kept), "{scheme:?} CFL {cfl}: {kept}");
    }
    assert_eq!(Scheme::default(), Scheme::Reflection);
}

/// Creates two shear layers with a sinusoidal disturbance and runs them to t = 0.8.
fn shear_layers(n: u32, cfl: f64, scheme: Scheme) -> FlowField {
    let h = 1.0 / f64::from(n);
    let sides = [[Side::Periodic; 2]; 3];
    let settings = FlowSettings { cells: [n, n, 1], cell_m: DVec3::splat(h), sides, scheme, ..Default::default() };
    let mut field = field(&settings, &FlowObstacles::default(), |p| {
        let y = p.y.rem_euclid(1.0);
        let from_layer = if y <= 0.5 { y - 0.25 } else { 0.75 - y };
        dvec3((15.0 * from_layer).tanh(), 0.05 * (std::f64::consts::TAU * p.x).sin(), 0.0)
    });
    let steps = (0.8 / (cfl * h)).round();
    (0..steps as u32).for_each(|_| field.step(0.8 / steps).expect("a step"));
    field
}

#[test]
fn shear_layers_roll_up_as_on_a_finer_grid() {
    let n = 64;
    let schemes = if is_long() { Scheme::NAMES.as_slice() } else { &Scheme::NAMES[2..] };
    for (name, scheme) in schemes {
        for cfl in [1.0, 4.0] {
            let [coarse, fine] = [n, 2 * n].map(|n| shear_layers(n, cfl, *scheme));
            let (mut apart, mut all) = (0.0, 0.0);
            for at in 0..n * n {
                let place = |x: f64, y: f64| dvec3(f64::from(at % n) + x, f64::from(at / n) + y, 0.0) / f64::from(n);
                for (c, p) in [(0, place(0.0, 0.5)), (1, place(0.5, 0.0))] {
                    let [a, b] = [&coarse, &fine].map(|f| f.velocity_at(p)[c]);
                    apart += (a - b) * (a - b);
                    all += b * b;
                }
            }
            let error = (apart / all).sqrt();
            println!("{name} CFL {cfl}: {:.1} %", 100.0 * error);
            assert!(error < 0.05 || *scheme != Scheme::Reflection, "CFL {cfl}: {error}");
        }
    }
}

/// Returns three boxes: a block turned by 30 degrees, a thin wall, and a box that floats.
fn town_boxes() -> [FlowBox<'static>; 3] {
    [
        FlowBox::level(dvec3(20.3, 25.1, 4.0), dvec3(5.0, 4.0, 8.0), 30.0),
        FlowBox::level(dvec3(42.0, 20.0, 3.0), dvec3(0.2, 12.0, 6.5), 0.0),
        FlowBox::level(dvec3(30.0, 8.0, 12.0), dvec3(3.3, 3.3, 2.2), 0.0),
    ]
}

/// Returns the height of hills at a place, m.
fn hills(p: DVec2) -> f64 {
    4.0 + 3.0 * (0.11 * p.x).sin() * (0.09 * p.y).cos()
}

/// Creates a field around hills and the boxes of [`town_boxes`], in a wind of 8 m/s and more.
fn town(scheme: Scheme) -> FlowField {
    let cell_m = dvec3(2.0, 2.0, 1.5);
    let settings = FlowSettings { cells: [30, 21, 14], cell_m, scheme, ..Default::default() };
    let obstacles = FlowObstacles { terrain: Some(&hills), boxes: &town_boxes() };
    field(&settings, &obstacles, |p| dvec3(8.0 + 0.1 * p.z, 3.0, 0.0))
}

#[test]
fn no_air_is_made_between_walls_hills_and_boxes() {
    for (name, scheme) in Scheme::NAMES {
        let mut field = town(scheme);
        for step in 0..6 {
            let divergence = field.largest_divergence();
            println!("{name}, step {step}: {divergence:.1e}, {:?}", field.solved());
            assert!(divergence < 1e-3, "{name}, step {step}: {divergence}");
            // Steps of 0.05 to 1.6 s, in which the air passes about 0.2 to 6 cells.
            field.step(0.05 * f64::from(1 << step)).expect("a step");
        }
        let fastest = field.fastest_m_s();
        assert!((8.0..40.0).contains(&fastest), "{name}: {fastest} m/s");
    }
}

#[test]
fn the_same_bits_come_out_each_time() {
    let run = || {
        let mut field = town(Scheme::Reflection);
        (0..3).for_each(|_| field.step(0.3).expect("a step"));
        (0..200).map(|i| field.velocity_at(dvec3(0.3, 0.2, 0.1) * f64::from(i))).collect::<Vec<_>>()
    };
    assert_eq!(run(), run());
}

#[test]
fn a_uniform_wind_past_nothing_stays_uniform() {
    let wind = dvec3(7.0, -4.0, 0.0);
    for (name, scheme) in Scheme::NAMES {
        let settings = FlowSettings { cells: [24, 17, 9], scheme, ..Default::default() };
        let mut field = field(&settings, &FlowObstacles::default(), |_| wind);
        (0..20).for_each(|_| field.step(0.7).expect("a step"));
        for i in 0..300 {
            let p = dvec3(f64::from(i % 24), f64::from(i % 17), f64::from(i % 9)) * 4.0 + dvec3(1.0, 2.5, 0.3);
            let off = (field.velocity_at(p) - wind).length() / wind.length();
            assert!(off < 1e-5, "{name} at {p}: {off}");
        }
    }
}

/// Returns the velocity of a vortex about `center` in a uniform wind of 1 m/s along x. Its largest tangential speed,
/// 0.5 m/s, is 4 m from the centre.
fn whirl(center: DVec2, p: DVec3) -> DVec3 {
    let from = (p.truncate() - center) / 4.0;
    let swirl = 0.5 * (0.5 - 0.5 * from.length_squared()).exp();
    dvec3(1.0 - swirl * from.y, swirl * from.x, 0.0)
}

#[test]
fn a_whirl_drifts_with_the_wind() {
    let sides = [[Side::Periodic; 2]; 3];
    for (cfl, bound) in [(1.0, 0.02), (4.0, 0.05)] {
        let settings = FlowSettings { cells: [96, 96, 1], cell_m: DVec3::splat(0.5), sides, ..Default::default() };
        let mut field = field(&settings, &FlowObstacles::default(), |p| whirl(dvec2(24.0, 24.0), p));
        let places: Vec<_> = (0..48 * 48).map(|i| dvec3(f64::from(i % 48), f64::from(i / 48) + 0.5, 0.0)).collect();
        let before: Vec<_> = places.iter().map(|p| field.velocity_at(*p).x).collect();
        (0..(96.0 / cfl) as u32).for_each(|_| field.step(cfl / 2.0).expect("a step"));
        let apart = |(p, b): (&DVec3, &f64)| (field.velocity_at(*p).x - b).abs();
        let worst = places.iter().zip(&before).map(apart).fold(0.0, f64::max) / 0.5;
        println!("CFL {cfl}: {:.1} % of the whirl's speed after once round", 100.0 * worst);
        assert!(worst < bound, "CFL {cfl}: {worst}");
    }
}

/// Creates a box `length` m long with a vortex 36 m from its inflow side. The vortex leaves a box of 48 m within 30 s,
/// and stays in a box of 96 m.
fn leaving(length: u32) -> FlowField {
    let sides = [[Side::Open; 2], [Side::Slip; 2], [Side::Periodic; 2]];
    let settings = FlowSettings { cells: [length, 32, 1], cell_m: DVec3::ONE, sides, ..Default::default() };
    field(&settings, &FlowObstacles::default(), |p| whirl(dvec2(36.0, 16.0), p))
}

#[test]
fn a_vortex_leaves_without_reflection() {
    let [mut short, mut long] = [48, 96].map(leaving);
    // The compared places are at least 9 m, about two radii of the vortex, from the outflow side. While the vortex
    // leaves, the velocities there may differ by 7 % of its speed, later by 1 %.
    for (second, bound) in (1..=30).map(|s| (s, if s < 25 { 0.07 } else { 0.01 })) {
        short.step(1.0).expect("a step");
        long.step(1.0).expect("a step");
        let mut worst = 0.0_f64;
        for i in 0..40 * 32 {
            let p = dvec3(f64::from(i % 40), f64::from(i / 40) + 0.5, 0.0);
            worst = worst.max((short.velocity_at(p) - long.velocity_at(p)).length() / 0.5);
        }
        println!("{second} s: {:.2} % of the whirl's speed", 100.0 * worst);
        assert!(worst < bound, "{second} s: {worst}");
    }
}

/// Creates the Poisson equation on n by n points with the value 0 on the boundary, for which the published rates hold.
fn dirichlet(n: usize) -> GridLevel {
    let mut lower = [0, 1, 2].map(|a| vec![if a < 2 { 1.0 } else { 0.0 }; n * n]);
    for i in 0..n {
        lower[0][i * n] = 0.0;
        lower[1][i] = 0.0;
    }
    let mut level = GridLevel::new([n, n, 1], [1.0; 3], lower);
    level.sum.iter_mut().filter(|sum| **sum > 0.0).for_each(|sum| *sum = 4.0);
    level
}

/// Returns the number of iterations that reduce the largest error tenfold, as a mean from 1e-1 to 1e-5 of the first
/// error.
fn iterations_per_decade(n: usize, relaxation: f32) -> f64 {
    let mut level = dirichlet(n);
    let halves = level.halves;
    let shape = |i: usize| (std::f64::consts::PI * (i + 1) as f64 / (n + 1) as f64).sin();
    let begin: Vec<f32> = (0..n * n).map(|i| (shape(i % n) * shape(i / n)) as f32).collect();
    let [mut x, b] = [0; 2].map(|_| vec![0.0; halves.len()]);
    halves.put(&begin, &mut x);
    let mut reached = [None; 2];
    for iteration in 1..20_000 {
        [0, 1].iter().for_each(|colour| level.relax(&mut x, &b, relaxation, *colour));
        let most = x.iter().fold(0.0_f32, |most, v| most.max(v.abs()));
        for (at, limit) in reached.iter_mut().zip([1e-1, 1e-5]) {
            if at.is_none() && most < limit {
                *at = Some(iteration);
            }
        }
        if let [Some(first), Some(last)] = reached {
            return f64::from(last - first) / 4.0;
        }
    }
    f64::INFINITY
}

#[test]
fn relaxation_takes_as_many_iterations_as_published() {
    let mut cases = vec![(64, 1.0, 985.0), (64, PressureMethod::best_relaxation(65), 24.0)];
    if is_long() {
        cases.extend([(128, 1.0, 3882.0), (128, PressureMethod::best_relaxation(129), 47.0)]);
    }
    for (n, relaxation, published) in cases {
        let taken = iterations_per_decade(n, relaxation);
        println!("{n}^2, relaxation {relaxation}: {taken} iterations a decade, published {published}");
        // With optimal over-relaxation the error after k iterations falls as `k r^k`: a decade takes more iterations
        // than the published `r^k`.
        let slack = if relaxation > 1.0 { 1.2 } else { 1.02 };
        assert!((0.95..slack).contains(&(taken / published)), "{n}^2, {relaxation}: {taken}, not {published}");
    }
}

/// Makes a wind around a box free of divergence. Returns the work for this, and the number of V-cycles or iterations
/// that reduce the residual to a tenth.
fn work(pressure: PressureMethod, n: u32, tolerance: f64) -> (Solved, f64) {
    let settings = FlowSettings { cells: [n, n, 1], cell_m: DVec3::ONE, pressure, tolerance, ..Default::default() };
    let settings = FlowSettings { sides: [[Side::Open; 2], [Side::Slip; 2], [Side::Slip; 2]], ..settings };
    let half = f64::from(n) / 2.0;
    let block = [FlowBox::level(dvec3(half, half + 0.2, 0.5), dvec3(half / 4.0, half / 5.0, 1.0), 20.0)];
    let mut field = field(&settings, &FlowObstacles { terrain: None, boxes: &block }, |_| DVec3::X);
    assert!(field.largest_divergence() <= 1.05 * tolerance, "{pressure:?}: {}", field.largest_divergence());
    (field.solved(), f64::from(field.solved().iterations) / -tolerance.log10())
}

#[test]
fn multigrid_beats_relaxation_at_equal_residual() {
    let sizes: &[u32] = if is_long() { &[64, 128] } else { &[64] };
    for &n in sizes {
        let relaxation = [PressureMethod::best_relaxation(n); 2];
        let (sor, _) = work(PressureMethod::Sor { relaxation, max_iterations: 100_000 }, n, 1e-4);
        let (multigrid, rate) = work(PressureMethod::Multigrid { max_cycles: 100 }, n, 1e-4);
        println!("{n}^2: relaxation {sor:?}; multigrid {multigrid:?}, {rate:.2} cycles a decade");
        assert!(multigrid.work < 0.5 * sor.work, "{multigrid:?} {sor:?}");
        assert!(rate < 2.0, "{rate} cycles a decade");
    }
}

#[test]
fn relaxation_of_two_is_refused_and_less_converges() {
    let sor = |relaxation| PressureMethod::Sor { relaxation: [relaxation; 2], max_iterations: 20_000 };
    for bad in [2.0, 2.5, 0.0, -1.0, f32::NAN] {
        let settings = FlowSettings { pressure: sor(bad), ..Default::default() };
        let e = FlowField::new(&settings, &FlowObstacles::default(), |_| DVec3::X).expect_err("refused");
        assert_eq!((e.status, e.field()), (Status::InvalidArgument, Some("flow.pressure.relaxation[0]")));
        assert!(e.to_string().contains("must be in (0, 2)"), "{e}");
    }
    work(sor(1.95), 32, 1e-4);
    assert_eq!(PressureMethod::FIVE_SWEEPS.check("flow.pressure"), Ok(()));
    let left = dirichlet(64);
    let mut pressure = Pressure::new(left);
    let (mut x, b) = (vec![0.0; 4096], vec![1.0; 4096]);
    let solved = pressure.solve(PressureMethod::FIVE_SWEEPS, &mut x, &b, 0.0);
    assert_eq!(solved.iterations, 5);
}

#[test]
fn faces_are_open_in_part() {
    let lattice = super::lattice::Lattice::new([8, 8, 8], DVec3::ONE).expect("a lattice");
    let slope = |p: DVec2| 0.5 + 0.25 * p.x;
    let boxes = [FlowBox::level(dvec3(6.0, 4.25, 6.0), dvec3(1.0, 0.75, 0.75), 0.0)];
    let open = FlowObstacles { terrain: Some(&slope), boxes: &boxes }.shares(&lattice).expect("shares").open;
    let share = |c: usize, i: [usize; 3]| f64::from(open[c][lattice.at(i)]);
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-4, "{a} is not {b}");
    // The slope is 1.0 m high at x = 2 and crosses z = 1 m there.
    near(share(0, [1, 2, 0]), 0.25);
    near(share(0, [2, 2, 0]), 0.0);
    near(share(0, [2, 2, 1]), 1.0);
    near(share(1, [1, 2, 0]), 0.125);
    near(share(2, [1, 2, 1]), 1.0);
    near(share(2, [2, 2, 1]), 0.0);
    // A roof thinner than a cell still closes a face.
    let roof = [FlowBox::level(dvec3(4.0, 4.0, 4.3), dvec3(2.0, 2.0, 0.01), 0.0)];
    let roofed = FlowObstacles { terrain: None, boxes: &roof }.shares(&lattice).expect("shares").open;
    near(roofed[2][lattice.at([4, 4, 4])].into(), 0.0);
    near(roofed[2][lattice.at([4, 4, 5])].into(), 1.0);
    // The box reaches from y = 3.5 to 5, z = 5.25 to 6.75.
    near(share(0, [6, 3, 5]), 1.0 - 0.5 * 0.75);
    near(share(0, [6, 4, 6]), 1.0 - 0.75);
    near(share(0, [5, 4, 6]), 0.25);
    near(share(0, [4, 4, 6]), 1.0);
    near(share(2, [5, 3, 6]), 0.5);
    near(share(2, [5, 3, 7]), 1.0);
}

#[test]
fn no_air_passes_a_thin_wall_or_enters_where_it_cannot_leave() {
    let settings = FlowSettings { cells: [20, 8, 8], cell_m: DVec3::ONE, ..Default::default() };
    let wall = [FlowBox::level(dvec3(10.3, 4.0, 4.0), dvec3(0.05, 5.0, 5.0), 0.0)];
    let mut field = field(&settings, &FlowObstacles { terrain: None, boxes: &wall }, |_| dvec3(5.0, 0.0, 0.0));
    for _ in 0..10 {
        assert!(field.velocity_at(dvec3(10.0, 4.0, 4.0)).x.abs() < 0.01);
        let behind = field.velocity_at(dvec3(15.0, 4.0, 4.0));
        assert!(behind.length() < 0.01, "{behind}");
        field.step(0.2).expect("a step");
    }
}

#[test]
fn settle_returns_whether_the_field_has_come_to_rest() {
    let settings = FlowSettings { cells: [24, 16, 1], cell_m: DVec3::ONE, ..Default::default() };
    let mut still = field(&settings, &FlowObstacles::default(), |_| DVec3::ZERO);
    assert_eq!(still.settle(1.0, 1e-3, 1), Ok(true));
    let mut even = field(&settings, &FlowObstacles::default(), |_| DVec3::X);
    assert_eq!(even.settle(1.0, 1e-3, 1), Ok(true));
    let post = [FlowBox::level(dvec3(8.0, 8.0, 0.5), dvec3(1.5, 1.5, 1.0), 0.0)];
    let mut behind = field(&settings, &FlowObstacles { terrain: None, boxes: &post }, |_| DVec3::X);
    assert_eq!(behind.settle(1.0, 1e-6, 1), Ok(false));
}

/// Checks that a field depends only on the numbers of its air. The arrays that a step exchanges also have unused
/// entries, which must stay 0.
#[test]
fn a_field_depends_only_on_the_numbers_of_its_air() {
    let mut moved = town(Scheme::Reflection);
    moved.step(0.4).expect("a step");
    moved.shift([2, -1, 1], |p| dvec3(4.0 + 0.1 * p.z, 1.0, 0.0)).expect("a shift");
    let mut led = town(Scheme::Reflection);
    led.step(0.4).expect("a step");
    for field in [&mut moved, &mut led] {
        // A restored field has the same numbers, and its own unused entries.
        let mut read = town(Scheme::Reflection);
        let (numbers, last_dt, _) = read.numbers_mut();
        numbers.zip(field.numbers()).for_each(|(to, from)| to.clone_from(from));
        *last_dt = field.last_step().0;
        for _ in 0..4 {
            for f in [&mut *field, &mut read] {
                f.set_wind(|p| dvec3(4.0 + 0.1 * p.z, 1.0, 0.0)).expect("a wind");
                f.fill_ghosts();
                f.step(0.4).expect("a step");
            }
            assert!(field.numbers().eq(read.numbers()));
        }
    }
}

/// Checks that the present wind decides through which sides air comes in, whatever the wind at the start of the field.
#[test]
fn a_weak_wind_after_a_strong_one_opens_the_sides_that_it_passes() {
    let settings = FlowSettings { cells: [8, 8, 8], cell_m: DVec3::splat(2.0), ..FlowSettings::default() };
    let weak = |_| dvec3(1.0, 1e-3, 0.0);
    let mut led = field(&settings, &FlowObstacles::default(), |_| dvec3(20.0, 0.0, 0.0));
    led.set_wind(weak).expect("a wind");
    assert_eq!(led.roles, field(&settings, &FlowObstacles::default(), weak).roles);
}

#[test]
fn bad_input_is_refused_by_name_and_leaves_the_field() {
    let good = FlowSettings { cells: [8, 8, 4], ..Default::default() };
    let periodic = [[Side::Periodic, Side::Open], [Side::Open; 2], [Side::Slip; 2]];
    let fast = Side::NoSlip([400.0, 0.0, 0.0]);
    let cases = [
        (FlowSettings { cells: [0, 8, 8], ..good }, "flow.cells[0]"),
        (FlowSettings { cells: [4096, 4096, 4096], ..good }, "flow.cells"),
        (FlowSettings { cells: [1, 1, 8], ..good }, "flow.cells"),
        (FlowSettings { cell_m: dvec3(1.0, f64::NAN, 1.0), ..good }, "flow.cell_m[1]"),
        (FlowSettings { tolerance: 0.0, ..good }, "flow.tolerance"),
        (FlowSettings { viscosity_m2_s: -1.0, ..good }, "flow.viscosity_m2_s"),
        (FlowSettings { sides: periodic, ..good }, "flow.sides[0]"),
        (FlowSettings { sides: [[fast; 2]; 3], ..good }, "flow.sides[0].velocity"),
        (FlowSettings { pressure: PressureMethod::Multigrid { max_cycles: 0 }, ..good }, "flow.pressure.max_cycles"),
    ];
    let refused = |settings: &FlowSettings, obstacles: &FlowObstacles, wind: DVec3, name: &str| {
        let e = FlowField::new(settings, obstacles, |_| wind).expect_err(name);
        assert_eq!((e.status, e.field()), (Status::InvalidArgument, Some(name)), "{e}");
    };
    for (settings, name) in cases {
        refused(&settings, &FlowObstacles::default(), DVec3::X, name);
    }
    refused(&good, &FlowObstacles::default(), dvec3(500.0, 0.0, 0.0), "flow.wind");
    refused(&good, &FlowObstacles::default(), DVec3::NAN, "flow.wind");
    let hole = |p: DVec2| if p.x > 5.0 { f64::NAN } else { 1.0 };
    let holed = FlowObstacles { terrain: Some(&hole), boxes: &[] };
    refused(&good, &holed, DVec3::X, "flow.terrain");
    let far = [FlowBox::level(dvec3(-50.0, 5.0, 5.0), DVec3::ONE, 0.0)];
    refused(&good, &FlowObstacles { terrain: None, boxes: &far }, DVec3::X, "flow.boxes[0].center_m");
    let mut field = field(&good, &FlowObstacles::default(), |_| DVec3::X);
    let before = field.velocity_at(DVec3::splat(5.0));
    assert_eq!(field.set_obstacles(&holed).expect_err("a hole").field(), Some("flow.terrain"));
    for dt in [f64::NAN, -1.0, 1e6] {
        assert_eq!(field.step(dt).expect_err("a time").field(), Some("flow.dt_s"));
    }
    assert_eq!(field.velocity_at(DVec3::splat(5.0)), before);
    assert_eq!(Scheme::from_name("upwind").expect_err("no scheme").field(), Some("scheme"));
}
