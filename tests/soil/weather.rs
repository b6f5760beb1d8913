//! Rain that weakens walls, sand without water, and frost that stops a bucket.

use glam::DVec3;
use welkin::{
    context::Context,
    soil::{SoilBlade, SoilHorizon, SoilKind, SoilKindId, SoilSettings, SoilToolId, SoilToolReport},
    weather::{Weather, Wind},
};

use crate::{
    host::{ORIGIN, bucket, context, drag, rain, tiles},
    trench,
};

/// A soil whose upright walls stand up to 0.8 m while it is moist.
fn weak() -> SoilSettings {
    let kind = SoilKind {
        density_kg_m3: 1733.0,
        swell: 0.2,
        repose_deg: 33.0,
        cohesion_kpa: 2.0,
        friction_deg: 30.0,
        sinkage: None,
        albedo: [0.2; 3],
    };
    let horizons = vec![SoilHorizon { top_m: 0.0, kind: SoilKindId(7) }];
    SoilSettings { own_kinds: vec![kind], horizons, ..SoilSettings::default() }
}

fn dry(temperature_c: f64) -> Weather {
    Weather { temperature_c, relative_humidity: 0.6, wind: Wind::of(3.0, 200.0), ..Weather::default() }
}

/// Returns how far the crest beside the middle of the trench has come down, m.
fn fallen_m(context: &Context) -> f64 {
    -context.soil_at(ORIGIN + DVec3::Y).unwrap().unwrap().change_m
}

#[test]
fn a_wall_stands_moist_and_falls_dry_or_after_hours_of_rain() {
    let mut context = context();
    context.set_weather(&dry(15.0), 0.0, 0.0).unwrap();
    tiles(&mut context);
    context.set_soil(Some(weak())).unwrap();
    let tool = trench(&mut context);
    context.end_soil_tool(tool).unwrap();
    context.update(7200.0).unwrap();
    assert!(fallen_m(&context).abs() < 0.01, "stands in dry weather: {}", fallen_m(&context));
    context.set_weather(&rain(8.0), 7200.0, 0.0).unwrap();
    context.update(7200.0 + 1800.0).unwrap();
    assert!(fallen_m(&context).abs() < 0.01, "half an hour of rain: {}", fallen_m(&context));
    context.update(7200.0 + 4.0 * 3600.0).unwrap();
    assert!(fallen_m(&context) > 0.05, "four hours of rain: {}", fallen_m(&context));
    assert!(context.soil_books().unwrap().is_balanced());

    // The same sand without any water has no cohesion.
    let mut bone_dry = crate::context();
    bone_dry.set_weather(&dry(15.0), 0.0, 0.0).unwrap();
    tiles(&mut bone_dry);
    bone_dry.set_soil(Some(SoilSettings { saturation: 0.0, ..weak() })).unwrap();
    trench(&mut bone_dry);
    bone_dry.update(10.0).unwrap();
    assert!(fallen_m(&bone_dry) > 0.05, "{}", fallen_m(&bone_dry));
}

/// Returns the report of a bucket halfway through the ground at a depth, which it begins to cross now.
fn cut(context: &mut Context, tool: SoilToolId, depth_m: f64) -> SoilToolReport {
    let now_s = context.time_s();
    for (after_s, x, depth_m) in [(0.5, -2.0, -0.5), (1.0, -2.0, depth_m), (2.0, 0.0, depth_m)] {
        context.move_soil_tool(tool, &drag(now_s + after_s, x, depth_m)).unwrap();
    }
    context.update(now_s + 1.8).unwrap();
    context.soil_tool(tool).unwrap()
}

#[test]
fn frost_stops_a_bucket_and_says_so() {
    let mut context = context();
    context.set_weather(&dry(-10.0), 0.0, 0.0).unwrap();
    tiles(&mut context);
    context.set_soil(Some(weak())).unwrap();
    let tool = context.add_soil_tool(bucket(5.0), &drag(0.0, -2.0, -0.5)).unwrap();
    // After an hour the frozen crust is so thin that a bucket breaks it.
    context.update(3600.0).unwrap();
    let early = cut(&mut context, tool, 0.05);
    assert!(early.mass_kg > 50.0 && !early.is_stopped_by_frost, "{early:?}");
    // After a day the crust is 0.2 m thick.
    context.update(86_400.0).unwrap();
    let books = context.soil_books().unwrap();
    let stopped = cut(&mut context, tool, 0.15);
    assert!(stopped.is_stopped_by_frost && stopped.cut_depth_m < 0.05, "{stopped:?}");
    assert_eq!(context.soil_books().unwrap().dug, books.dug, "nothing is dug");
    // The edge is in the ground, and the resistance of what it met can still be queried.
    let blade = SoilBlade { rake: 1.0, soil_metal: 0.4, adhesion_kpa: 0.0, surcharge_kpa: 0.0 };
    assert!(context.soil_resistance(tool, &blade).unwrap().force_n >= 0.0);
    // The ground thaws, because there were more degree days above 0 C than below.
    context.set_weather(&dry(15.0), 86_410.0, 0.0).unwrap();
    context.update(86_400.0 * 2.0).unwrap();
    let thawed = cut(&mut context, tool, 0.15);
    assert!(!thawed.is_stopped_by_frost && context.soil_books().unwrap().dug > books.dug, "{thawed:?}");
    let force = context.soil_resistance(tool, &blade).unwrap();
    assert!(force.force_n > 500.0 && force.horizontal_n > 0.0, "{force:?}");
    assert!((thawed.saturation - 0.3).abs() < 0.2, "{thawed:?}");
}
