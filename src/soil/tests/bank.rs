//! Tests of walls, slides and pressed bank, on ground that is changed cell by cell.

use super::{Plain, WIDE_PLAIN, firm};
use crate::soil::{
    SoilHorizon, SoilKind, SoilKindId,
    field::{SoilCell, SoilField},
    laws::SinkageSet,
    material::{DEPTH_UNITS, SoilMaterials, depth_units},
    patch::Pressed,
    walls::break_walls,
};

/// Strip of ground along x, six cells wide, in which cells from 0 on are dug to a height.
fn strip(kind: SoilKind, cell_m: f64, reach_m: f64, height_m: impl Fn(f64) -> f64) -> (SoilField, Plain) {
    let reach = (reach_m / cell_m).ceil() as i32;
    let plain = Plain { size: [reach, 3] };
    let horizon = SoilHorizon { top_m: 0.0, kind: SoilKindId(0) };
    let mut field = SoilField::new(SoilMaterials::new(cell_m, &[kind], vec![horizon]));
    for x in 1 - reach..reach {
        let depth = -height_m(f64::from(x) * cell_m);
        for y in -2..=2 {
            if let Some(cell) = field.find_or_add([x, y], &plain)
                && depth > 0.0
            {
                let _ = field.dig(cell, depth_units(depth));
            }
        }
    }
    (field, plain)
}

/// Lets walls fall and soil slide until all is at rest. Returns whether any wall fell.
fn settle(field: &mut SoilField, plain: &Plain) -> bool {
    let mut falls = false;
    for _ in 0..20_000 {
        let fell = break_walls(field, plain);
        falls |= fell;
        if field.settle(64, plain) && !fell {
            field.rest();
            return falls;
        }
    }
    panic!("never at rest");
}

#[test]
fn walls_stand_below_their_critical_height_and_fall_above() {
    let soil = SoilKind { density_kg_m3: 17e3 / 9.81, cohesion_kpa: 2.0, friction_deg: 30.0, ..firm(0.0) };
    let law = soil.wall_law();
    let critical_m = law.critical_height_m();
    for (share, falls) in [(0.9, false), (0.985, false), (1.015, true), (1.1, true)] {
        let height = |x: f64| if x < 0.0 { 0.0 } else { -share * critical_m };
        let (mut field, plain) = strip(soil, 0.1, 3.0, height);
        assert_eq!(settle(&mut field, &plain), falls, "{share}");
    }
    for slope_deg in [75.0f64, 60.0] {
        let slope = slope_deg.to_radians();
        let highest_m = law.face_height_m(slope);
        for (share, falls) in [(0.93, false), (1.07, true)] {
            let height_m = share * highest_m;
            let height = |x: f64| -((x + 0.05) * slope.tan()).clamp(0.0, height_m);
            let (mut field, plain) = strip(soil, 0.1, 0.5 + 1.5 * height_m, height);
            assert_eq!(settle(&mut field, &plain), falls, "{slope_deg} degrees, {share}");
        }
    }
}

#[test]
fn a_fallen_wall_reaches_from_crest_to_toe_as_its_swell_says() {
    for (swell, alpha_deg, depth_m, crest_m, toe_m) in
        [(0.0, 34.0, 1.0, 0.7413, 0.7413), (0.25, 34.0, 1.0, 0.7000, 0.7826)]
    {
        let soil = SoilKind { cohesion_kpa: 0.5, friction_deg: 20.0, repose_deg: alpha_deg, ..firm(swell) };
        let cell_m = 0.05;
        let (mut field, plain) = strip(soil, cell_m, 1.6, |x| if x < -0.01 { 0.0 } else { -depth_m });
        let dug = field.dug();
        assert!(settle(&mut field, &plain));
        assert_eq!(field.dug() - dug, field.lying(), "what fell lies there");
        let height_m = |x: i32| {
            let SoilCell { slot, cell } = field.find([x, 0]).unwrap();
            field.patch(slot).surface[cell] / DEPTH_UNITS
        };
        // The wall stood at the western border of cell 0. Straight through the slope between 20 and 80 % of its height.
        let points: Vec<[f64; 2]> = (-30..30).map(|x| [(f64::from(x) + 0.5) * cell_m, height_m(x)]).collect();
        let inner: Vec<_> = points.iter().filter(|p| (-0.8 * depth_m..=-0.2 * depth_m).contains(&p[1])).collect();
        let count = inner.len() as f64;
        let mean = [0, 1].map(|i| inner.iter().map(|p| p[i]).sum::<f64>() / count);
        let slope = inner.iter().map(|p| (p[0] - mean[0]) * (p[1] - mean[1])).sum::<f64>()
            / inner.iter().map(|p| (p[0] - mean[0]).powi(2)).sum::<f64>();
        let crest = -(mean[0] - mean[1] / slope);
        let toe = mean[0] + (-depth_m - mean[1]) / slope;
        println!(
            "swell {swell}: crest {crest:.4} m, toe {toe:.4} m, slope {:.2} degrees",
            (-slope).atan().to_degrees()
        );
        assert!((crest / crest_m - 1.0).abs() < 0.01 && (toe / toe_m - 1.0).abs() < 0.01, "{crest} {toe}");
    }
}

#[test]
fn pressed_soil_is_denser_and_gives_its_mass_back() {
    let kind = SoilKind { sinkage: Some(SinkageSet::SNOW_US), ..firm(0.0) };
    let mut field =
        SoilField::new(SoilMaterials::new(0.1, &[kind], vec![SoilHorizon { top_m: 0.0, kind: SoilKindId(0) }]));
    let cell = field.find_or_add([3, 3], &WIDE_PLAIN).unwrap();
    let sunk = depth_units(0.05);
    field.change(cell, |patch, cell, materials| {
        patch.set_press(cell, Pressed { packed: 10 * sunk, sunk, reached: sunk });
        patch.refresh(cell, materials);
    });
    // The pressed layer holds 0.5 m of soil in 0.45 m: a ninth more in each part of it.
    let half = field.dig(cell, depth_units(0.225)).mass();
    let rest = field.dig(cell, depth_units(0.225)).mass();
    let below = field.dig(cell, depth_units(0.45)).mass();
    let mass = |depth_m: f64| 2000.0 * 0.01 * depth_m * 1e9;
    for (found, wanted) in [(half, mass(0.25)), (rest, mass(0.25)), (below, mass(0.45))] {
        assert!((found as f64 / wanted - 1.0).abs() < 1e-4, "{found} for {wanted}");
    }
    assert_eq!(field.dug(), half + rest + below);
}

#[test]
fn a_checkerboard_dies_and_slopes_cross_patches_evenly() {
    let soil = firm(0.0);
    let horizon = SoilHorizon { top_m: 0.0, kind: SoilKindId(0) };
    let materials = SoilMaterials::new(0.1, &[soil], vec![horizon]);
    let parcel = |materials: &SoilMaterials, depth_m: f64| materials.loose(0, (depth_m * 0.01 * 2000.0 * 1e9) as i64);
    let mut field = SoilField::new(materials);
    for (x, y) in (-6..6).flat_map(|x| (-6..6).map(move |y| (x, y))) {
        let cell = field.find_or_add([x, y], &WIDE_PLAIN).unwrap();
        let depth_m = if (x + y) % 2 == 0 { 0.5 } else { 0.2 };
        let parcel = parcel(&field.materials, depth_m);
        field.put(cell, &parcel);
    }
    assert!(field.settle(20_000, &WIDE_PLAIN), "comes to rest");
    let height_m = |field: &SoilField, place: [i32; 2]| {
        field.find(place).map_or(0.0, |SoilCell { slot, cell }| field.patch(slot).surface[cell] / DEPTH_UNITS)
    };
    for (x, y) in (-3..3).flat_map(|x| (-3..3).map(move |y| (x, y))) {
        let mean = 0.25
            * [[1, 0], [-1, 0], [0, 1], [0, -1]].map(|o| height_m(&field, [x + o[0], y + o[1]])).iter().sum::<f64>();
        assert!((height_m(&field, [x, y]) - mean).abs() < 0.1 * 35f64.to_radians().tan(), "({x}, {y})");
    }
    // The same column within a patch and over a corner of four.
    let heaps = [[8, 8], [0, 0]].map(|middle| {
        let mut field = SoilField::new(field.materials.clone());
        let cell = field.find_or_add(middle, &WIDE_PLAIN).unwrap();
        let parcel = parcel(&field.materials, 20.0);
        field.put(cell, &parcel);
        assert!(field.settle(20_000, &WIDE_PLAIN));
        let around = (-12..=12).flat_map(|x| (-12..=12).map(move |y| [middle[0] + x, middle[1] + y]));
        around.map(|place| height_m(&field, place)).collect::<Vec<_>>()
    });
    let most = heaps[0].iter().zip(&heaps[1]).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(most < 1e-4 && heaps[0][12 * 25 + 12] > 0.4, "{most} m");
}
