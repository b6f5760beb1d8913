//! Snow that drifts and falls with a solved field of wind: behind a fence, about a hill, under porches.

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc},
    flow::WindFieldDesc,
    ground::GroundGrid,
    snowpack::LyingSnowModel,
    weather::{Precipitation, PrecipitationKind, Surface, Weather, Wind},
};

use crate::{host::Host, terrain::roof};

const NODES: [u32; 2] = [90, 60];
/// South-western node.
const CORNER: [f64; 2] = [-35.0, -30.0];

/// Ground of this height on cells of a metre, in a west wind, after `hours`.
fn after(
    (hours, wind_m_s, snow_mm_h): (f64, f64, f64),
    depth_m: f64,
    set: impl Fn(&mut Context),
    height: impl Fn(f64, f64) -> f64,
) -> Context {
    let host = Host::new();
    let desc = ContextDesc { lying_snow: LyingSnowModel::Simulated, seed: 3, ..ContextDesc::default() };
    let mut context = Context::new(host.device.clone(), host.context.shared().clone(), desc).unwrap();
    let at = |i: u32| height(CORNER[0] + f64::from(i % NODES[0]), CORNER[1] + f64::from(i / NODES[0])) as f32;
    let weather = Weather {
        temperature_c: -6.0,
        relative_humidity: 1.0,
        precipitation: Precipitation::of(PrecipitationKind::Snow, snow_mm_h),
        surface: Surface { snow_depth_m: depth_m, ..Surface::default() },
        wind: Wind { gust_m_s: Some(wind_m_s), ..Wind::of(wind_m_s, 270.0) },
        ..Weather::default()
    };
    context.set_weather(&weather, 0.0, 0.0).unwrap();
    let heights_m = (0..NODES[0] * NODES[1]).map(at).collect();
    let origin = DVec3::new(CORNER[0], CORNER[1], 0.0);
    context
        .set_ground_grid(Some(GroundGrid { origin, cell_m: 1.0, nodes: NODES, heights_m, classes: Vec::new() }))
        .unwrap();
    set(&mut context);
    let field = WindFieldDesc {
        floor_center: DVec3::new(10.0, 0.0, 0.0),
        cell_m: DVec3::splat(2.0),
        cells: [48, 32, 12],
        ..WindFieldDesc::default()
    };
    context.set_wind_field(Some(&field), 0.0).unwrap();
    // A field holds for a minute around its time only.
    for half_minute in 1..=(hours * 120.0) as u32 {
        context.update(30.0 * f64::from(half_minute)).unwrap();
    }
    context
}

fn lies(context: &Context, x: f64, y: f64) -> f64 {
    context.snow_at(DVec3::new(x, y, 0.0)).unwrap().mass_kg_m2
}

/// Returns the mean depth of snow along a line to the east.
fn along(context: &Context, [from, to]: [i32; 2], y: f64) -> f64 {
    (from..to).map(|x| lies(context, f64::from(x), y)).sum::<f64>() / f64::from(to - from)
}

#[test]
fn a_fence_casts_its_drift_in_a_solved_field() {
    let fence = |context: &mut Context| context.set_shelters(&[roof([0.0, 0.0, 2.0], [1.0, 12.0, 2.0])]).unwrap();
    let context = after((6.0, 14.0, 0.0), 0.2, fence, |_, _| 0.0);
    let (lee, before, far) =
        (along(&context, [2, 14], 0.0), along(&context, [-30, -20], 0.0), along(&context, [45, 54], 0.0));
    println!("fence of 4 m, 6 h of 14 m/s: lee {lee:.1} kg/m^2, before {before:.1}, far {far:.1}");
    let line: Vec<_> = (-30..54).step_by(3).map(|x| (x, lies(&context, f64::from(x), 0.0).round())).collect();
    println!("{line:?}");
    assert!(lee > 1.3 * far && lee > 1.3 * before);
    // Most of the drift of a solid fence lies within some seven heights behind it.
    let more = |range: [i32; 2]| (along(&context, range, 0.0) - before).max(0.0) * f64::from(range[1] - range[0]);
    assert!(more([2, 30]) > 4.0 * more([30, 54]), "{} {}", more([2, 30]), more([30, 54]));
}

#[test]
fn a_hills_windward_side_and_lee_differ_in_a_solved_field() {
    let hill = |x: f64, y: f64| 8.0 * (-(x * x + y * y) / 120.0).exp();
    let context = after((6.0, 10.0, 0.5), 0.2, |_| {}, hill);
    let (windward, lee) = (along(&context, [-12, -3], 0.0), along(&context, [4, 13], 0.0));
    let line: Vec<_> = (-30..54).step_by(3).map(|x| (x, lies(&context, f64::from(x), 0.0).round())).collect();
    println!("hill of 8 m, 6 h of 10 m/s: windward {windward:.1}, lee {lee:.1} kg/m^2: {line:?}");
    assert!(lee > 1.2 * windward, "{windward} {lee}");
}

#[test]
fn flakes_blow_under_a_windward_porch_and_leave_that_to_the_lee_bare() {
    let house = |context: &mut Context| {
        let walls = roof([0.0, 0.0, 4.0], [6.0, 8.0, 4.0]);
        let porches = [-1.0, 1.0].map(|side| roof([side * 8.0, 0.0, 3.0], [2.0, 8.0, 0.1]));
        context.set_shelters(&[walls, porches[0], porches[1]]).unwrap();
    };
    let context = after((2.0, 6.0, 2.0), 0.0, house, |_, _| 0.0);
    let (windward, lee, open) = (lies(&context, -9.0, 0.0), lies(&context, 9.0, 0.0), lies(&context, -25.0, 0.0));
    println!(
        "2 h of 2 mm/h: under the windward porch {windward:.2}, the lee one {lee:.2}, in the open {open:.2} kg/m^2"
    );
    assert!((open / 4.0 - 1.0).abs() < 0.02 && lee < 0.02 * open && windward > 0.5 * open);
    // In the calm behind the house flakes fall steeply, so that its snow shadow is shorter than with the undisturbed
    // wind.
    let behind: Vec<_> = (7..40).map(|x| lies(&context, f64::from(x), 0.0)).collect();
    println!("behind it: {behind:.1?}");
}

#[test]
fn snow_in_a_solved_field_does_not_depend_on_how_time_is_cut() {
    let hash = |updates_s: f64| {
        let host = Host::new();
        let desc = ContextDesc { lying_snow: LyingSnowModel::Simulated, seed: 3, ..ContextDesc::default() };
        let mut context = Context::new(host.device.clone(), host.context.shared().clone(), desc).unwrap();
        // A wind that grows, so that the field of a minute is not that of the next.
        let weather = |wind_m_s: f64| Weather {
            temperature_c: -6.0,
            surface: Surface { snow_depth_m: 0.3, ..Surface::default() },
            wind: Wind { gust_m_s: Some(wind_m_s), ..Wind::of(wind_m_s, 270.0) },
            ..Weather::default()
        };
        context.set_weather(&weather(9.0), 0.0, 0.0).unwrap();
        context.set_weather(&weather(16.0), 0.0, 400.0).unwrap();
        let (origin, heights_m) = (DVec3::new(CORNER[0], CORNER[1], 0.0), vec![0.0; 90 * 60]);
        context
            .set_ground_grid(Some(GroundGrid { origin, cell_m: 1.0, nodes: NODES, heights_m, classes: Vec::new() }))
            .unwrap();
        context.set_shelters(&[roof([0.0, 0.0, 2.0], [1.0, 12.0, 2.0])]).unwrap();
        let field = WindFieldDesc {
            floor_center: DVec3::new(10.0, 0.0, 0.0),
            cell_m: DVec3::splat(4.0),
            cells: [24, 16, 8],
            ..WindFieldDesc::default()
        };
        context.set_wind_field(Some(&field), 0.0).unwrap();
        let mut time_s = 0.0;
        while time_s < 420.0 {
            time_s = f64::min(time_s + updates_s, 420.0);
            context.update(time_s).unwrap();
        }
        context.state_hash().unwrap()
    };
    let by_minutes = hash(60.0);
    for updates_s in [7.0, 45.0, 59.5] {
        assert_eq!(hash(updates_s), by_minutes, "updates of {updates_s} s");
    }
}
