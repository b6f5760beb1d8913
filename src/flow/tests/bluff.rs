//! Tests of the air around blocks with sharp edges against measurements in wind tunnels, by the default scheme with
//! eddies smaller than a cell.

use glam::{DVec3, dvec3};

use super::{turbulence::Turbulence, *};

/// Creates a field around a cube with edges of 1 m and `n` cells along an edge.
fn round_cube(cells: [u32; 3], n: u32, center: DVec3, roughness_m: f64, wind: impl Fn(DVec3) -> DVec3) -> FlowField {
    let settings = FlowSettings {
        cells,
        cell_m: DVec3::splat(1.0 / f64::from(n)),
        sides: [[Side::Open; 2], [Side::Slip; 2], [Side::Slip; 2]],
        tolerance: 1e-3,
        has_eddies: true,
        roughness_m,
        ..FlowSettings::default()
    };
    let cube = [FlowBox::level(center, DVec3::splat(0.5), 0.0)];
    field(&settings, &FlowObstacles { terrain: None, boxes: &cube }, wind)
}

/// Returns the mean drag coefficient of a cube between two times, in edges divided by the wind's speed. The edge has 10
/// cells, the field 96 x 64 x 64.
fn drag(begin: f64, end: f64) -> f64 {
    let center = dvec3(2.5, 3.2, 3.2);
    let mut field = round_cube([96, 64, 64], 10, center, 0.0, |_| DVec3::X);
    let dt = 0.2;
    let (mut sum, mut count) = (0.0, 0.0);
    for step in 1..=(end / dt) as u32 {
        field.step(dt).expect("a step");
        if f64::from(step) * dt > begin {
            // `c = F / (0.5 rho v^2 A)` with `rho`, `v` and `A` equal to 1.
            sum += 2.0 * field.pressure_force(center - 0.7, center + 0.7).x;
            count += 1.0;
        }
    }
    sum / count
}

#[test]
fn a_cube_has_the_drag_that_was_measured() {
    if !is_long() {
        return;
    }
    let found = drag(20.0, 40.0);
    println!("drag coefficient of a cube: {found:.3}, published 1.05");
    assert!((found / 1.05 - 1.0).abs() < 0.2, "{found}");
}

/// Standard deviations of the velocity along a turbulent channel, across it and upward, in friction velocities,
/// approximately as in Moser, Kim and Mansour (1999, Phys. Fluids 11, 943). The first number is the distance from the
/// nearer wall in halves of the channel's height.
const CHANNEL: [(f64, DVec3); 6] = [
    (0.0, DVec3::ZERO),
    (0.05, dvec3(2.4, 1.4, 0.85)),
    (0.1, dvec3(2.1, 1.35, 0.95)),
    (0.25, dvec3(1.75, 1.2, 0.98)),
    (0.5, dvec3(1.35, 0.95, 0.83)),
    (1.0, dvec3(0.8, 0.62, 0.6)),
];

/// Returns the standard deviations of [`CHANNEL`] at any distance from a wall, in the same units.
fn deviation(y: f64) -> DVec3 {
    let i = CHANNEL.iter().rposition(|(at, _)| *at <= y).unwrap_or(0).min(CHANNEL.len() - 2);
    let [(low, a), (high, b)] = [CHANNEL[i], CHANNEL[i + 1]];
    a.lerp(b, ((y - low) / (high - low)).clamp(0.0, 1.0))
}

/// Returns the length of the reverse flow along the floor behind a cube, in edges. The cube, with `N` cells along an
/// edge, stands in a turbulent channel two edges high; the mean is over a time of 30 edges divided by the wind's speed.
fn reattachment<const N: u32>() -> f64 {
    const ROUGHNESS: f64 = 1e-4;
    let profile = |z: f64| (1.0 + z.min(2.0 - z).max(0.0) / ROUGHNESS).ln() / (1.0 + 1.0 / ROUGHNESS).ln();
    let wind = |p: DVec3| DVec3::X * profile(p.z);
    let h = 1.0 / f64::from(N);
    let mut field = round_cube([10 * N, 7 * N, 2 * N], N, dvec3(3.5, 3.5, 0.5), ROUGHNESS, wind);
    let friction_velocity = 0.4 / (1.0 + 1.0 / ROUGHNESS).ln();
    field.set_mixing(0.4 * friction_velocity, h, |_| 0.0);
    // The integral length is half an edge, a quarter of the channel's height.
    let whirls = Turbulence::new(1, 0.5, h, 7.0).expect("room for whirls");
    let dt = 2.4 * h;
    let [first, last] = [15.0, 45.0].map(|t: f64| (t / dt) as u32);
    let mut sums = vec![0.0; 5 * N as usize];
    let place = |i: usize| (i as f64 + 0.5) * h;
    for step in 1..=last {
        let gone = DVec3::X * 0.9 * f64::from(step) * dt;
        let blown = |p: DVec3| {
            let own = if p.x < h { whirls.at(p - gone) } else { DVec3::ZERO };
            wind(p) + own * deviation(p.z.min(2.0 - p.z).max(0.0)) * friction_velocity
        };
        field.set_wind(blown).expect("a wind");
        field.step(dt).expect("a step");
        if step > first {
            let along = |i| field.velocity_at(dvec3(4.0 + place(i), 3.5, 0.5 * h)).x;
            sums.iter_mut().enumerate().for_each(|(i, sum)| *sum += along(i));
        }
    }
    let last = sums[..sums.len() - 1].iter().rposition(|v| *v < 0.0).expect("air that flows back");
    place(last) + h * sums[last] / (sums[last] - sums[last + 1])
}

#[test]
fn behind_a_cube_on_the_floor_the_flow_turns_and_comes_back() {
    if !is_long() {
        return;
    }
    let (coarse, found) = (reattachment::<8>(), reattachment::<16>());
    println!(
        "the flow comes back to the floor {found:.2} edges behind a cube of 16 cells an edge, {coarse:.2} of 8, published 1.6"
    );
    assert!(found < coarse && (found / 1.6 - 1.0).abs() < 0.25, "{found}, {coarse}");
}

#[test]
fn the_first_air_that_meets_a_cube_is_dammed_up_before_it() {
    let center = dvec3(3.0, 2.0, 2.0);
    let mut field = round_cube([24, 16, 16], 4, center, 0.0, |_| DVec3::X);
    (0..40).for_each(|_| field.step(0.1).expect("a step"));
    let force = |low: DVec3| field.pressure_force(low, center + 0.9);
    let [all, behind] = [center - 0.9, dvec3(center.x, center.y - 0.9, center.z - 0.9)].map(force);
    println!("all {all:.3}, behind {behind:.3}");
    // The pressure in front and the suction behind both push the cube downwind, and nothing pushes it aside.
    assert!(all.x > behind.x && behind.x > 0.0 && all.y.abs() + all.z.abs() < 0.02 * all.x, "{all} {behind}");
    assert_eq!(field.pressure_force(DVec3::ZERO, DVec3::ONE), DVec3::ZERO);
}
