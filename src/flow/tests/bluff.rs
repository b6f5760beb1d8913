//! Air round blocks with sharp edges, by the default scheme with whirls below a cell: against what wind tunnels measured.

use glam::{DVec3, dvec3};

use super::*;

/// A field round a cube, 1 m an edge, of `n` cells an edge.
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

/// Mean drag coefficient of a cube of 10 cells an edge in 96 x 64 x 64 between two times, edges over the wind's speed.
fn drag(from: f64, to: f64) -> f64 {
    let center = dvec3(2.5, 3.2, 3.2);
    let mut field = round_cube([96, 64, 64], 10, center, 0.0, |_| DVec3::X);
    let dt = 0.2;
    let (mut sum, mut count) = (0.0, 0.0);
    for step in 1..=(to / dt) as u32 {
        field.step(dt).expect("a step");
        if f64::from(step) * dt > from {
            // Over half the density and the square of the speed, 1 each, and the area.
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

/// Edges behind a cube on the floor of a channel two edges high at which the flow along the floor comes back, in the mean of 30 edges
/// over the wind's speed.
fn reattachment() -> f64 {
    const N: u32 = 8;
    const ROUGHNESS: f64 = 1e-4;
    let profile = |z: f64| (1.0 + z.min(2.0 - z).max(0.0) / ROUGHNESS).ln() / (1.0 + 1.0 / ROUGHNESS).ln();
    let wind = |p: DVec3| DVec3::X * profile(p.z);
    let h = 1.0 / f64::from(N);
    let mut field = round_cube([10 * N, 7 * N, 2 * N], N, dvec3(3.5, 3.5, 0.5), ROUGHNESS, wind);
    field.set_mixing(0.16 / (1.0 + 1.0 / ROUGHNESS).ln(), h, |_| 0.0);
    let mut sums = [0.0; 5 * N as usize];
    let place = |i: usize| (i as f64 + 0.5) * h;
    for step in 1..=300 {
        field.step(0.15).expect("a step");
        if step > 100 {
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
    let found = reattachment();
    // Too far: what comes in has no turbulence. The bound holds it from getting worse.
    println!("the flow comes back to the floor {found:.2} edges behind a cube, published 1.6");
    assert!((1.2..4.0).contains(&found), "{found}");
}

#[test]
fn the_first_air_that_meets_a_cube_is_dammed_up_before_it() {
    let center = dvec3(3.0, 2.0, 2.0);
    let mut field = round_cube([24, 16, 16], 4, center, 0.0, |_| DVec3::X);
    (0..40).for_each(|_| field.step(0.1).expect("a step"));
    let force = |low: DVec3| field.pressure_force(low, center + 0.9);
    let [all, behind] = [center - 0.9, dvec3(center.x, center.y - 0.9, center.z - 0.9)].map(force);
    println!("all {all:.3}, behind {behind:.3}");
    // What the air before the cube pushes and what it sucks behind it, and nothing to the side.
    assert!(all.x > behind.x && behind.x > 0.0 && all.y.abs() + all.z.abs() < 0.02 * all.x, "{all} {behind}");
    assert_eq!(field.pressure_force(DVec3::ZERO, DVec3::ONE), DVec3::ZERO);
}
