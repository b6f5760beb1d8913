//! Tests of the stepped ground: mass, time, tools, cost, and what hosts give wrongly.

mod bank;

use glam::DVec3;

use super::{
    kind::BUILT_IN,
    laws::{SinkageSet, WheelLoad},
    *,
};
use crate::{chance::RandomStream, error::Status};

/// Level ground, with an edge beyond which there is none.
struct Plain {
    size: [i32; 2],
}

const WIDE_PLAIN: Plain = Plain { size: [1 << 20; 2] };

impl UndugGround for Plain {
    fn height_m(&self, cell: [i32; 2]) -> Option<f64> {
        (0..2).all(|i| cell[i].abs() < self.size[i]).then_some(0.0)
    }
}

/// Soil that stands as any wall.
fn firm(swell: f64) -> SoilKind {
    SoilKind {
        density_kg_m3: 2000.0,
        swell,
        repose_deg: 35.0,
        cohesion_kpa: 5000.0,
        friction_deg: 30.0,
        sinkage: None,
        ..BUILT_IN[0]
    }
}

fn site_of(kind: SoilKind, cell_m: f64) -> SoilSite {
    let horizons = vec![SoilHorizon { top_m: 0.0, kind: SoilKindId(7) }];
    let settings = SoilSettings { own_kinds: vec![kind], horizons, ..SoilSettings::default() };
    SoilSite::new(SoilSiteDesc { cell_m, settings }).unwrap()
}

/// Pose of a bucket of 1.5 m whose opening looks along the heading and by `tilt` above the horizontal.
fn bucket_pose(time_s: f64, edge: DVec3, heading: f64, tilt: f64) -> SoilToolPose {
    let forward = DVec3::new(heading.cos(), heading.sin(), 0.0);
    let left = DVec3::new(-forward.y, forward.x, 0.0);
    let facing = forward * tilt.cos() + DVec3::Z * tilt.sin();
    let up = DVec3::Z * tilt.cos() - forward * tilt.sin();
    let side = |offset: DVec3| [edge + offset + left * 0.75, edge + offset - left * 0.75];
    SoilToolPose { time_s, edge: side(DVec3::ZERO), upper: side(up * 1.2), facing, load_n: 0.0 }
}

fn bucket(struck_m3: f64) -> SoilToolShape {
    SoilToolShape::Bucket { struck_m3, heap_rise: 1.0 }
}

/// Sends poses and advances in frames of this rate.
fn play(site: &mut SoilSite, tool: SoilToolId, poses: &[SoilToolPose], rate_hz: f64) {
    let mut left = poses.iter().peekable();
    let end_s = poses.last().unwrap().time_s;
    for frame in 1.. {
        let time_s = f64::from(frame) / rate_hz;
        while let Some(pose) = left.next_if(|pose| pose.time_s <= time_s) {
            site.move_tool(tool, pose).unwrap();
        }
        site.advance(time_s, &WIDE_PLAIN).unwrap();
        if time_s > end_s {
            break;
        }
    }
}

fn rest(site: &mut SoilSite) {
    let end_s = site.time_s() + 600.0;
    site.advance(end_s, &WIDE_PLAIN).unwrap();
    assert!(site.is_quiet(), "still moving");
}

#[test]
fn a_cut_takes_the_mass_of_its_volume_and_swells() {
    for cell_m in [0.1, 0.05] {
        let mut site = site_of(firm(0.25), cell_m);
        let pose = |time_s: f64, x: f64| bucket_pose(time_s, DVec3::new(x, 0.33, -0.2), 0.3, 0.2);
        let tool = site.add_tool(bucket(5.0), &pose(0.0, 0.0)).unwrap();
        // The edge is turned by 0.3: it sweeps the width across the way.
        let poses: Vec<_> = (1..=60).map(|i| pose(f64::from(i) / 30.0, 2.0 * f64::from(i) / 60.0)).collect();
        play(&mut site, tool, &poses, 60.0);
        let report = site.report(tool).unwrap();
        let volume = 1.5 * 0.3f64.cos() * 2.0 * 0.2;
        assert!((report.mass_kg / (2000.0 * volume) - 1.0).abs() < 0.01, "{cell_m}: {report:?}");
        assert!((report.bulk_m3 / (1.25 * volume) - 1.0).abs() < 0.01, "{report:?}");
        assert!((report.kinds_kg[7] - report.mass_kg).abs() < 1e-6 && report.cut_kind == SoilKindId(7));
        assert!((report.cut_depth_m - 0.2).abs() < 0.002, "{report:?}");
        let floor = site.point(DVec3::new(1.0, 0.3, 0.0), &WIDE_PLAIN).unwrap().unwrap();
        assert!((floor.surface_m + 0.2).abs() < 1e-5 && floor.loose_m == 0.0, "{floor:?}");
        assert!(site.books().is_balanced(), "{:?}", site.books());
    }
}

#[test]
fn layers_come_up_by_their_depth() {
    let mut site = SoilSite::new(SoilSiteDesc::default()).unwrap();
    // Along the borders of cells: a cell that is cut in part gives its upper layers first.
    let pose = |time_s: f64, x: f64| bucket_pose(time_s, DVec3::new(x, 0.0, -0.5), 0.0, 0.2);
    let tool = site.add_tool(bucket(5.0), &pose(0.0, 0.05)).unwrap();
    play(&mut site, tool, &[pose(1.0, 1.05)], 60.0);
    let kinds = site.report(tool).unwrap().kinds_kg;
    let [topsoil, loam] = [SoilKindId::TOPSOIL, SoilKindId::LOAM].map(|kind| kinds[usize::from(kind.0)]);
    assert!((topsoil / (1.5 * 0.3 * 1561.0) - 1.0).abs() < 0.02, "{topsoil}");
    assert!((loam / (1.5 * 0.2 * 1803.0) - 1.0).abs() < 0.02, "{loam}");
    assert_eq!(site.point(DVec3::X * 0.5, &WIDE_PLAIN).unwrap().unwrap().kind, SoilKindId::LOAM);
    assert_eq!(site.point(DVec3::X * 9.0, &WIDE_PLAIN).unwrap().unwrap().kind, SoilKindId::TOPSOIL);
}

/// Poses of a dig that curves, lifts, turns over and swings back, at this rate.
fn cycle(rate_hz: f64) -> Vec<SoilToolPose> {
    let count = (4.0 * rate_hz) as i32;
    let pose = |i: i32| {
        let time_s = f64::from(i) / rate_hz;
        let t = (time_s / 4.0).min(1.0);
        let angle = 1.3 * t;
        let depth = 0.35 * (std::f64::consts::PI * (2.0 * t).min(1.0)).sin();
        let lift = 2.0 * (t - 0.5).max(0.0);
        let place = DVec3::new(3.0 * angle.sin(), 3.0 - 3.0 * angle.cos(), 0.05 - depth + lift);
        let tilt = if t < 0.75 { 0.2 + 1.8 * t } else { 1.55 - 9.0 * (t - 0.75) };
        bucket_pose(time_s, place, angle, tilt)
    };
    (1..=count).map(pose).collect()
}

fn dug_cycle(poses: &[SoilToolPose], frame_hz: f64, volume: f64) -> (SoilSite, SoilToolId) {
    let mut site = SoilSite::new(SoilSiteDesc::default()).unwrap();
    let first = SoilToolPose { time_s: 0.0, ..bucket_pose(0.0, DVec3::new(0.0, 0.0, 0.05), 0.0, 0.2) };
    let tool = site.add_tool(bucket(volume), &first).unwrap();
    play(&mut site, tool, poses, frame_hz);
    (site, tool)
}

#[test]
fn frames_of_any_rate_leave_the_same_bits() {
    let poses = cycle(50.0);
    let texts = [30.0, 60.0, 144.0].map(|rate| {
        let (mut site, _) = dug_cycle(&poses, rate, 0.3);
        site.advance(4.0, &WIDE_PLAIN).unwrap();
        assert_eq!(site.time_s(), 4.0);
        assert!(site.books().is_balanced() && site.books().lying > 0, "some spills, some is carried");
        site.encode().unwrap()
    });
    assert!(texts[0] == texts[1] && texts[1] == texts[2]);
}

#[test]
fn a_curved_path_sampled_at_any_rate_takes_the_same_mass() {
    let dug = [30.0, 60.0, 144.0].map(|rate| {
        let (site, _) = dug_cycle(&cycle(rate), 60.0, 5.0);
        site.books().dug as f64 * 1e-9
    });
    assert!(dug[0] > 500.0, "{dug:?}");
    for other in &dug[..2] {
        assert!((other / dug[2] - 1.0).abs() < 0.005, "{dug:?}");
    }
}

#[test]
fn a_loaded_site_continues_with_the_same_bits() {
    let poses = cycle(50.0);
    let (mut site, tool) = dug_cycle(&poses[..120], 60.0, 0.3);
    let saved = site.encode().unwrap();
    let mut loaded = SoilSite::decode(&saved, &WIDE_PLAIN).unwrap();
    assert_eq!(loaded.encode().unwrap(), saved);
    for site in [&mut site, &mut loaded] {
        play(site, tool, &poses[120..], 60.0);
        site.end_tool(tool).unwrap();
        site.advance(20.0, &WIDE_PLAIN).unwrap();
    }
    assert_eq!(loaded.encode().unwrap(), site.encode().unwrap());
    assert!(site.books().is_balanced());
    let broken = [
        saved.replace("steps = ", "steps = 999999999999"),
        saved.replacen("loose = \"", "loose = \"1 ", 1),
        saved.replace("brought = \"0\"", "brought = \"1\""),
        saved.replace("shape = \"bucket\"", "shape = \"spoon\""),
        saved.replace("cell_m = 0.1", "cell_m = 0.0"),
        saved.replacen("masses = \"", "masses = \"7fffffffffffffff ", 1),
        saved[..saved.len() / 2].to_owned(),
    ];
    for text in broken {
        assert!(text != saved, "the text is changed");
        assert!(SoilSite::decode(&text, &WIDE_PLAIN).is_err());
    }
}

/// Random steps of three tools on sand over the corners of patches.
fn random_steps(count: i32) {
    let sand = SoilKind { cohesion_kpa: 0.5, ..BUILT_IN[0] };
    let mut site = site_of(sand, 0.25);
    let mut chance = RandomStream::new(7, 45);
    let mut place = |spread: f64| DVec3::new(spread * (chance.unit() - 0.5), spread * (chance.unit() - 0.5), 0.0);
    let first = bucket_pose(0.0, DVec3::ZERO, 0.0, 0.2);
    let wheel = SoilToolPose { load_n: 2e4, ..first };
    let shapes =
        [(bucket(0.4), first), (SoilToolShape::Blade, first), (SoilToolShape::Wheel { diameter_m: 1.2 }, wheel)];
    let tools = shapes.map(|(shape, pose)| site.add_tool(shape, &pose).unwrap());
    let mut at = [DVec3::ZERO; 3];
    for step in 1..=count {
        let time_s = f64::from(step) * SOIL_STEP_S;
        for (i, tool) in tools.into_iter().enumerate() {
            let way = place(0.6);
            let turn = place(8.0);
            at[i] = (at[i] + way).clamp(DVec3::splat(-3.0), DVec3::splat(3.0));
            at[i].z = 0.1 - 0.2 * (turn.x + 4.0) / 8.0;
            let pose = bucket_pose(time_s, at[i], turn.y, if turn.x > 3.0 { -1.4 } else { 0.3 });
            site.move_tool(tool, &SoilToolPose { load_n: 2e4 * f64::from(i == 2), ..pose }).unwrap();
        }
        site.advance(time_s, &WIDE_PLAIN).unwrap();
        if step % 500 == 0 {
            assert!(site.books().is_balanced(), "{step}: {:?}", site.books());
        }
    }
    let books = site.books();
    assert!(books.is_balanced() && books.dug > 0 && books.lying > 0, "{books:?}");
    assert!(site.field.patches.len() > 4, "the work crosses the borders of patches");
}

#[test]
fn no_microgram_is_lost_in_random_steps() {
    random_steps(100_000);
}

#[test]
fn wheels_and_tracks_sink_by_their_law_and_only_once() {
    for (shape, load_n) in
        [(SoilToolShape::Wheel { diameter_m: 1.3 }, 9e3), (SoilToolShape::Track { contact_m: 3.0 }, 9e4)]
    {
        let mut site = site_of(SoilKind { sinkage: Some(SinkageSet::DRY_SAND), ..firm(0.1) }, 0.1);
        let pose = |time_s: f64, x: f64| {
            let edge = [0.3, -0.3].map(|y| DVec3::new(x, y, 0.0));
            SoilToolPose { time_s, edge, upper: edge, facing: DVec3::Z, load_n }
        };
        let tool = site.add_tool(shape, &pose(0.0, 0.0)).unwrap();
        let poses: Vec<_> = (1..=40).map(|i| pose(f64::from(i) * 0.05, 0.1 * f64::from(i))).collect();
        play(&mut site, tool, &poses, 60.0);
        let law_m = match shape {
            SoilToolShape::Wheel { diameter_m } => {
                SinkageSet::DRY_SAND.wheel_m(&WheelLoad { load_n, width_m: 0.6, diameter_m })
            }
            _ => SinkageSet::DRY_SAND.plate_m(0.6, 50.0),
        };
        let rut_m = |site: &SoilSite| -site.point(DVec3::new(2.0, 0.0, 0.0), &WIDE_PLAIN).unwrap().unwrap().change_m;
        assert!((rut_m(&site) / law_m - 1.0).abs() < 0.01, "{shape:?}: {} for {law_m}", rut_m(&site));
        assert!(!site.report(tool).unwrap().is_sinkage_beyond_range);
        let before = site.encode().unwrap();
        let back: Vec<_> = (41..=80).map(|i| pose(f64::from(i) * 0.05, 0.1 * f64::from(80 - i))).collect();
        play(&mut site, tool, &back, 60.0);
        let deeper = (rut_m(&site) - law_m).abs();
        assert!(deeper < 0.01 * law_m && before.contains("pressed"), "a second pass adds {deeper} m");
        assert_eq!(site.books(), SoilBooks::default(), "pressing moves no mass");
    }
}

#[test]
fn a_bucket_carries_its_heap_pours_into_a_bed_and_the_bed_pours_onto_the_ground() {
    let mut site = site_of(firm(0.25), 0.1);
    let drag = |time_s: f64, x: f64| bucket_pose(time_s, DVec3::new(x, 0.0, -0.3), 0.0, 0.2);
    let tool = site.add_tool(bucket(0.6), &drag(0.0, 0.0)).unwrap();
    let full: Vec<_> = (1..=60).map(|i| drag(f64::from(i) / 30.0, f64::from(i) / 15.0)).collect();
    play(&mut site, tool, &full, 60.0);
    // 1.2 m by 1.5 m, heaped 1:1: 0.396 m^3 more than struck.
    let report = site.report(tool).unwrap();
    assert!((report.bulk_m3 - 0.996).abs() < 0.01 && (report.fill - 1.0).abs() < 0.01, "{report:?}");
    assert!(site.books().lying > 0, "the rest is pushed ahead");
    let curl = |time_s: f64, z: f64, tilt: f64| bucket_pose(time_s, DVec3::new(4.0, 0.0, z), 0.0, tilt);
    let curled = (1..=30).map(|i| curl(2.0 + f64::from(i) / 60.0, -0.3, 0.2 + 1.37 * f64::from(i) / 30.0));
    play(&mut site, tool, &curled.chain([curl(4.0, 3.0, 1.57)]).collect::<Vec<_>>(), 60.0);
    let carried = site.report(tool).unwrap();
    // Level, it keeps what rests at 35 degrees on its sides.
    let heap = super::laws::heap_volume_m3([1.5, 1.2], 35f64.to_radians().tan());
    assert!((carried.bulk_m3 / (0.6 + heap) - 1.0).abs() < 0.01, "{carried:?}");
    let bed_pose = |time_s: f64, tilt: f64| {
        let back = DVec3::new(6.0, 0.0, 1.0);
        let along = DVec3::new(tilt.cos(), 0.0, tilt.sin());
        let side = |p: DVec3| [p + DVec3::Y * 1.5, p - DVec3::Y * 1.5];
        let facing = DVec3::new(-tilt.sin(), 0.0, tilt.cos());
        SoilToolPose { time_s, edge: side(back), upper: side(back + along * 4.0), facing, load_n: 0.0 }
    };
    // The edge lies at the tail, and for a viewer who looks up out of the bed, left is where the tail is to the right.
    let flip = |pose: SoilToolPose| SoilToolPose {
        edge: [pose.edge[1], pose.edge[0]],
        upper: [pose.upper[1], pose.upper[0]],
        ..pose
    };
    let bed_shape = SoilToolShape::Bed { struck_m3: 6.0, heap_rise: 0.5 };
    let bed = match site.add_tool(bed_shape, &bed_pose(4.0, 0.0)) {
        Ok(bed) => (bed, false),
        Err(_) => (site.add_tool(bed_shape, &flip(bed_pose(4.0, 0.0))).unwrap(), true),
    };
    let bed_at = |time_s: f64, tilt: f64| if bed.1 { flip(bed_pose(time_s, tilt)) } else { bed_pose(time_s, tilt) };
    let turn = |i: i32| {
        let tilt = 1.57 - 2.57 * f64::from(i) / 30.0;
        bucket_pose(5.0 + f64::from(i) / 30.0, DVec3::new(8.0, 0.0, 3.0), 0.0, tilt)
    };
    let swing: Vec<_> = (0..=30).map(turn).collect();
    for time_s in [5.0, 6.0] {
        site.move_tool(bed.0, &bed_at(time_s, 0.0)).unwrap();
    }
    play(&mut site, tool, &swing, 60.0);
    let loaded = site.report(bed.0).unwrap();
    assert!(site.report(tool).unwrap().mass_kg < 1e-6, "{:?}", site.report(tool));
    assert!((loaded.mass_kg / carried.mass_kg - 1.0).abs() < 1e-9, "{loaded:?}");
    let lying = site.books().lying;
    site.end_tool(tool).unwrap();
    site.move_tool(bed.0, &bed_at(8.0, 1.0)).unwrap();
    site.advance(8.0, &WIDE_PLAIN).unwrap();
    assert!(site.books().lying - lying == (loaded.mass_kg * 1e9).round() as i128, "{:?}", site.books());
    let tail = site.point(DVec3::new(6.0, 0.0, 0.0), &WIDE_PLAIN).unwrap().unwrap();
    assert!(tail.loose_m > 0.1 && (tail.loose_kg_m3 / 1600.0 - 1.0).abs() < 0.01, "{tail:?}");
    site.end_tool(bed.0).unwrap();
    rest(&mut site);
    assert!(site.books().is_balanced() && site.books().held == 0);
}

#[test]
fn a_blade_levels_and_pushes() {
    let mut site = site_of(firm(0.25), 0.1);
    for y in -6..=6 {
        site.bring(DVec3::new(2.0, 0.1 * f64::from(y), 0.0), SoilKindId(7), 30.0, &WIDE_PLAIN).unwrap();
    }
    let pose = |time_s: f64, x: f64| bucket_pose(time_s, DVec3::new(x, 0.0, 0.0), 0.0, 0.0);
    let tool = site.add_tool(SoilToolShape::Blade, &pose(0.0, 0.0)).unwrap();
    let poses: Vec<_> = (1..=80).map(|i| pose(f64::from(i) / 20.0, f64::from(i) / 20.0)).collect();
    play(&mut site, tool, &poses, 60.0);
    let loose_m = |x: f64| site.point(DVec3::new(x, 0.0, 0.0), &WIDE_PLAIN).unwrap().unwrap().loose_m;
    assert!(loose_m(2.0) < 0.005 && loose_m(3.0) < 0.005, "{} {}", loose_m(2.0), loose_m(3.0));
    assert!(loose_m(4.2) > 0.05, "{}", loose_m(4.2));
    assert!(site.books().is_balanced() && site.books().dug == 0);
}

#[test]
fn where_there_is_no_ground_nothing_is_dug_and_nothing_lost() {
    let plain = Plain { size: [20, 20] };
    let mut site = site_of(firm(0.25), 0.1);
    let pose = |time_s: f64, x: f64, z: f64, tilt: f64| bucket_pose(time_s, DVec3::new(x, 0.0, z), 0.0, tilt);
    let tool = site.add_tool(bucket(2.0), &pose(0.0, 1.0, -0.2, 0.2)).unwrap();
    site.move_tool(tool, &pose(1.0, 3.0, -0.2, 0.2)).unwrap();
    // Beyond the edge, the bucket turns over.
    site.move_tool(tool, &pose(2.0, 6.0, 2.0, -1.4)).unwrap();
    site.advance(2.0, &plain).unwrap();
    let held = site.report(tool).unwrap().mass_kg;
    assert!((held / (2000.0 * 1.5 * 0.95 * 0.2) - 1.0).abs() < 0.06, "{held} kg stays in the bucket");
    assert!(site.books().is_balanced() && site.books().lying == 0, "{:?}", site.books());
    // Loose soil slides up to the edge and no farther.
    site.bring(DVec3::new(1.9, 0.0, 0.0), SoilKindId(7), 500.0, &plain).unwrap();
    site.end_tool(tool).unwrap();
    site.advance(60.0, &plain).unwrap();
    assert!(site.is_quiet() && site.books().is_balanced() && site.books().taken > 0);
    assert!(!site.bring(DVec3::new(2.5, 0.0, 0.0), SoilKindId(7), 1.0, &plain).unwrap());
}

#[test]
fn an_undug_site_holds_and_costs_nothing() {
    let mut site = SoilSite::new(SoilSiteDesc::default()).unwrap();
    site.advance(1e9, &WIDE_PLAIN).unwrap();
    assert!(site.is_quiet() && site.field.patches.is_empty() && site.time_s() == 1e9);
    assert_eq!((site.revision(), site.books()), (0, SoilBooks::default()));
    let tool = site.add_tool(bucket(1.0), &bucket_pose(1e9, DVec3::new(0.0, 0.0, 2.0), 0.0, 0.2)).unwrap();
    site.move_tool(tool, &bucket_pose(1e9 + 1.0, DVec3::new(9.0, 0.0, 2.0), 0.0, 0.2)).unwrap();
    site.advance(1e9 + 1.0, &WIDE_PLAIN).unwrap();
    assert!(site.field.patches.is_empty(), "a bucket in the air touches nothing");
    site.bring(DVec3::ZERO, SoilKindId::SAND, 100.0, &WIDE_PLAIN).unwrap();
    site.end_tool(tool).unwrap();
    rest(&mut site);
    let ground = |site: &SoilSite| site.encode().unwrap().split_once("revision").unwrap().1.to_owned();
    let text = ground(&site);
    site.advance(2e9, &WIDE_PLAIN).unwrap();
    assert!(ground(&site) == text && text.contains("loose"), "at rest nothing changes");
}

#[test]
fn wrong_input_is_named_and_changes_nothing() {
    let desc = SoilSiteDesc::default;
    let e = SoilSite::new(SoilSiteDesc { cell_m: 0.0, ..desc() }).unwrap_err();
    assert!(e.to_string().starts_with("cell_m must be in [0.01, 4] m"));
    let fault = |settings| SoilSite::new(SoilSiteDesc { settings, ..desc() }).unwrap_err().to_string();
    let settings = SoilSettings::default;
    let kind = SoilKind { swell: -0.1, ..BUILT_IN[0] };
    assert!(
        fault(SoilSettings { own_kinds: vec![kind], ..settings() })
            .starts_with("own_kinds[0].swell must be in [0, 1.5]")
    );
    let deep = vec![SoilHorizon { top_m: 0.1, kind: SoilKindId(0) }];
    assert!(
        fault(SoilSettings { horizons: deep, ..settings() }).starts_with("horizons[0].top_m must be 0, the surface")
    );
    let unknown = vec![SoilHorizon { top_m: 0.0, kind: SoilKindId(7) }];
    assert!(
        fault(SoilSettings { horizons: unknown, ..settings() })
            .contains("horizons[0].kind must be a known kind of soil")
    );

    assert!(fault(SoilSettings { saturation: 1.5, ..settings() }).starts_with("saturation must be in [0, 1]"));

    let mut site = SoilSite::new(desc()).unwrap();
    let good = bucket_pose(1.0, DVec3::ZERO, 0.0, 0.2);
    let tool = site.add_tool(bucket(1.0), &good).unwrap();
    let before = site.encode().unwrap();
    let next = SoilToolPose { time_s: 2.0, ..good };
    let swapped = SoilToolPose { edge: [good.edge[1], good.edge[0]], upper: [good.upper[1], good.upper[0]], ..next };
    let far = bucket_pose(2.0, DVec3::X * 100.0, 0.0, 0.2);
    for (pose, wanted) in [
        (swapped, "pose.facing must be out of the opening"),
        (SoilToolPose { facing: -good.facing, ..next }, "pose.facing must be out of the opening"),
        (SoilToolPose { upper: [good.upper[1], good.upper[0]], ..next }, "pose.facing must be out of the opening"),
        (SoilToolPose { facing: DVec3::ZERO, ..next }, "pose.facing must be finite"),
        (SoilToolPose { edge: [DVec3::NAN, good.edge[1]], ..next }, "pose.edge[0] must be finite"),
        (SoilToolPose { upper: good.edge, ..next }, "pose.upper[0] must be in [0.02, 20] m"),
        (SoilToolPose { load_n: -1.0, ..next }, "pose.load_n must be in [0, 10000000] N"),
        (SoilToolPose { time_s: f64::NAN, ..next }, "pose.time_s must be in [-10000000000, 10000000000] s"),
        (SoilToolPose { time_s: 1.1e10, ..next }, "pose.time_s must be in [-10000000000, 10000000000] s"),
        (far, "pose.edge[0] must be within 20 m of the pose before"),
        (good, "pose.time_s must be more than 1 s"),
        (SoilToolPose { time_s: 1e9, ..next }, "pose.time_s must be at most 600 s after the pose before"),
    ] {
        let e = site.move_tool(tool, &pose).unwrap_err();
        assert!(e.to_string().starts_with(wanted), "{e}");
    }
    let e = site.add_tool(bucket(f64::NAN), &good).unwrap_err();
    assert!(e.to_string().starts_with("shape.struck_m3 must be in [0.001, 1000] m^3"), "{e}");
    assert!(
        site.move_tool(SoilToolId(9), &next).unwrap_err().to_string().starts_with("tool must be a tool of this site")
    );
    for (mass, kind, wanted) in
        [(-1.0, 0, "mass_kg must be in [0, 1000000] kg"), (1.0, 200, "kind must be a known kind of soil, in [0, 6]")]
    {
        let e = site.bring(DVec3::ZERO, SoilKindId(kind), mass, &WIDE_PLAIN).unwrap_err();
        assert!(e.to_string().starts_with(wanted), "{e}");
    }
    assert!(site.bring(DVec3::splat(f64::NAN), SoilKindId(0), 1.0, &WIDE_PLAIN).is_err());
    for until_s in [f64::INFINITY, 1.1e10, -1.1e10] {
        let e = site.advance(until_s, &WIDE_PLAIN).unwrap_err();
        assert!(e.to_string().starts_with("until_s must be in [-10000000000, 10000000000] s"), "{e}");
    }
    assert_eq!(site.encode().unwrap(), before, "nothing has changed");
    site.advance(1.0, &WIDE_PLAIN).unwrap();
    let late = site.add_tool(bucket(1.0), &SoilToolPose { time_s: 0.5, ..good }).unwrap_err();
    assert_eq!(late.status, Status::WrongOrder);
    site.end_tool(tool).unwrap();
    assert_eq!(site.move_tool(tool, &next).unwrap_err().status, Status::WrongOrder);
}

/// Seconds of the fastest of several runs.
fn least_s(runs: usize, mut act: impl FnMut()) -> f64 {
    let time = |act: &mut dyn FnMut()| {
        let begun = std::time::Instant::now();
        act();
        begun.elapsed().as_secs_f64()
    };
    (0..runs).map(|_| time(&mut act)).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_frame_of_digging_costs_a_few_sweeps_of_its_window() {
    for cell_m in [0.1, 0.05] {
        let pose = |i: i32| {
            let mut pose =
                bucket_pose(f64::from(i) * SOIL_STEP_S, DVec3::new(f64::from(i) / 60.0, 0.0, -0.3), 0.0, 0.2);
            for point in pose.edge.iter_mut().chain(&mut pose.upper) {
                point.y *= 2.0;
            }
            pose
        };
        let mut frames = vec![f64::INFINITY; 180];
        let mut cells = 0;
        for _ in 0..7 {
            let mut site = SoilSite::new(SoilSiteDesc { cell_m, ..SoilSiteDesc::default() }).unwrap();
            let tool = site.add_tool(bucket(1.0), &pose(0)).unwrap();
            for (i, least) in (1..).zip(&mut frames) {
                site.move_tool(tool, &pose(i)).unwrap();
                let time_s = f64::from(i) * SOIL_STEP_S;
                *least = least.min(least_s(1, || site.advance(time_s, &WIDE_PLAIN).map(drop).unwrap()));
            }
            cells = site.field.patches.len() * super::patch::CELLS;
        }
        // The window that was dug or heaped, on which nothing flows: the cheapest sweep.
        let side = cells.isqrt();
        let margin = (side + 2) * (side + 2);
        let heights: Vec<f64> = (0..margin).map(|i| ((i * 7919) % 512) as f64).collect();
        let grades = vec![1000.0; margin];
        let inputs = crate::slides::SlopeInputs { size: [side; 2], heights: &heights, grades: &grades };
        let (mut east, mut north) = (vec![0.0; side * side], vec![0.0; side * side]);
        let sweeps_s = 8.0 * least_s(20, || _ = crate::slides::edge_flows(&inputs, &mut east, &mut north));
        frames.sort_unstable_by(f64::total_cmp);
        let [middle, worst] = [frames[frames.len() / 2], frames[frames.len() - 1]];
        println!(
            "{cell_m} m: {} cells; a frame takes {:.2} and the worst {:.2} times eight sweeps ({:.3} ms)",
            cells,
            middle / sweeps_s,
            worst / sweeps_s,
            1e3 * sweeps_s
        );
        assert!(middle < 6.0 * sweeps_s && worst < 24.0 * sweeps_s, "{middle} s, {worst} s for {sweeps_s} s");
    }
}
