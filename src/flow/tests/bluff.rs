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
