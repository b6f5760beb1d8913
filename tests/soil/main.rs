//! Soil of a context: mass under rain and snow, the same bits at any frame rate and after loading, one height for all,
//! water and frost in the ground, and what hosts give wrongly.

mod cost;
mod host;
mod weather;

use glam::DVec3;
use welkin::{
    Status,
    chance::RandomStream,
    context::Context,
    soil::{SoilKind, SoilKindId, SoilSettings, SoilToolId, SoilToolPose, SoilToolShape},
    terrain::{Rows, TerrainCells, TerrainDesc, TileKey},
};

use host::{CELL_M, KEYS, ORIGIN, SIDE, bucket, bucket_pose, context, drag, rain, site, snowfall, tile};

/// A tool with its poses.
type Work = (SoilToolShape, Vec<SoilToolPose>);

/// Random ways of three tools over the corner of four tiles, this many poses each.
fn random_works(count: i32) -> Vec<Work> {
    let mut chance = RandomStream::new(11, 45);
    let mut place = |spread: f64| DVec3::new(spread * (chance.even() - 0.5), spread * (chance.even() - 0.5), 0.0);
    let shapes = [bucket(0.3), SoilToolShape::Blade, SoilToolShape::Wheel { diameter_m: 1.2 }];
    let mut works = shapes.map(|shape| (shape, vec![bucket_pose(0.0, DVec3::Z * 0.2, 0.0, 0.2)])).to_vec();
    let mut at = [DVec3::ZERO; 3];
    for step in 1..=count {
        for (i, (_, poses)) in works.iter_mut().enumerate() {
            let (way, turn) = (place(0.8), place(8.0));
            at[i] = (at[i] + way).clamp(DVec3::splat(-3.0), DVec3::splat(3.0));
            at[i].z = 0.1 - 0.2 * (turn.x + 4.0) / 8.0;
            let pose = bucket_pose(f64::from(step) / 40.0, at[i], turn.y, if turn.x > 3.0 { -1.4 } else { 0.3 });
            poses.push(SoilToolPose { load_n: 2e4 * f64::from(i == 2), ..pose });
        }
    }
    works
}

/// Adds the tools of works.
fn add(context: &mut Context, works: &[Work]) -> Vec<SoilToolId> {
    works.iter().map(|(shape, poses)| context.add_soil_tool(*shape, &poses[0]).unwrap()).collect()
}

/// Plays works from one time to another in frames of a rate; each pose comes a little before its time.
fn play(context: &mut Context, works: &[Work], tools: &[SoilToolId], from_s: f64, to_s: f64, rate_hz: f64) {
    let sent = |time_s: f64| move |pose: &&SoilToolPose| pose.time_s > 0.0 && pose.time_s <= time_s + 0.1;
    let mut next: Vec<usize> = works.iter().map(|(_, poses)| poses.iter().filter(sent(from_s)).count() + 1).collect();
    if from_s == 0.0 {
        next.fill(1);
    }
    for frame in 0.. {
        let time_s = (from_s + f64::from(frame) / rate_hz).min(to_s);
        for (i, tool) in tools.iter().enumerate() {
            while let Some(pose) = works[i].1.get(next[i]).filter(|pose| pose.time_s <= time_s + 0.1) {
                context.move_soil_tool(*tool, pose).unwrap();
                next[i] += 1;
            }
        }
        context.update(time_s).unwrap();
        if frame % 64 == 0 {
            let books = context.soil_books().unwrap();
            assert!(books.is_balanced(), "{time_s}: {books:?}");
        }
        if time_s >= to_s {
            break;
        }
    }
}

/// A site in rain that turns to snow.
fn wet_site() -> Context {
    let mut context = context();
    context.set_weather(&rain(12.0), 0.0, 0.0).unwrap();
    context.set_weather(&snowfall(), 12.0, 2.0).unwrap();
    site(&mut context);
    context
}

#[test]
fn no_microgram_is_lost_and_frames_of_any_rate_leave_the_same_bits() {
    let works = random_works(700);
    let ends = [30.0, 60.0, 144.0].map(|rate| {
        let mut context = wet_site();
        let tools = add(&mut context, &works);
        play(&mut context, &works, &tools, 0.0, 19.0, rate);
        // A step of the snow is a minute long.
        context.update(125.0).unwrap();
        let books = context.soil_books().unwrap();
        assert!(books.is_balanced() && books.dug > 0 && books.lying > 0, "{books:?}");
        let snow = context.snow_balance().unwrap();
        let came = snow.began_kg + snow.fallen_kg + snow.blown_in_kg;
        let went = snow.blown_out_kg + snow.ran_off_kg + snow.sublimated_kg + snow.taken_kg + snow.lying_kg;
        assert!((came - went).abs() < 1e-9 * came && snow.fallen_kg > 0.0, "{snow:?}");
        let dug: Vec<_> = context.soil_changes(0).map(|change| change.tile).collect();
        assert!(KEYS.iter().all(|key| dug.contains(key)), "the work crosses all borders of tiles");
        (context.save().unwrap(), context.state_hash().unwrap())
    });
    assert!(ends[0] == ends[1] && ends[1] == ends[2]);
}

#[test]
fn a_loaded_context_digs_on_with_the_same_bits() {
    let works = random_works(320);
    let mut kept = wet_site();
    let tools = add(&mut kept, &works);
    play(&mut kept, &works, &tools, 0.0, 4.3, 60.0);
    let saved = kept.save().unwrap();
    let mut anew = context();
    assert!(anew.load(&saved).unwrap_err().to_string().contains("set the terrain and its tiles before"));
    site(&mut anew);
    anew.bring_soil(ORIGIN, SoilKindId::SAND, 500.0).unwrap();
    let before = anew.terrain_revision();
    anew.load(&saved).unwrap();
    assert_eq!(anew.save().unwrap(), saved);
    let listed = anew.soil_changes(before).count();
    assert_eq!(listed, kept.soil_changes(0).count(), "a load lists all that was dug");
    for (from_s, to_s) in [(4.3, 5.0), (5.0, 8.7), (8.7, 80.0)] {
        for context in [&mut kept, &mut anew] {
            play(context, &works, &tools, from_s, to_s, if to_s > 20.0 { 2.0 } else { 60.0 });
        }
        assert_eq!(kept.state_hash().unwrap(), anew.state_hash().unwrap(), "{to_s}");
        assert_eq!(kept.save().unwrap(), anew.save().unwrap(), "{to_s}");
    }
    assert!(kept.soil_books().unwrap().is_balanced());
    // Undug again by a state without soil.
    let mut bare = context();
    host::tiles(&mut bare);
    bare.update(1.0).unwrap();
    anew.load(&bare.save().unwrap()).unwrap();
    let at = ORIGIN + DVec3::new(0.5, 0.25, 0.0);
    assert_eq!(anew.terrain_at(at).unwrap().map(|p| p.height_m), bare.terrain_at(at).unwrap().map(|p| p.height_m));
    assert!(anew.soil().is_none() && anew.soil_changes(0).count() >= listed, "what was dug is listed as changed");
}

/// A site with a trench 0.5 m deep along x from -2 to 2 m, 1.5 m wide about y = 0.
fn trench(context: &mut Context) -> SoilToolId {
    let now_s = context.time_s();
    let tool = context.add_soil_tool(bucket(5.0), &drag(now_s, -2.0, 0.5)).unwrap();
    context.move_soil_tool(tool, &drag(now_s + 2.0, 2.0, 0.5)).unwrap();
    context.update(now_s + 2.0).unwrap();
    tool
}

fn height_m(context: &Context, x: f64, y: f64) -> f64 {
    context.terrain_at(ORIGIN + DVec3::new(x, y, 0.0)).unwrap().unwrap().height_m
}

#[test]
fn terrain_water_and_lists_have_the_height_of_the_soil() {
    let mut context = context();
    context.set_weather(&rain(20.0), 0.0, 0.0).unwrap();
    site(&mut context);
    let (before, undug_m) = (context.terrain_revision(), height_m(&context, 0.0, 0.0));
    let tool = trench(&mut context);
    let report = context.soil_tool(tool).unwrap();
    assert!(report.mass_kg > 3000.0 && (report.cut_depth_m - 0.51).abs() < 0.02, "{report:?}");
    assert!((report.centre - ORIGIN).length() < 4.0, "the centre lies in the host's world: {report:?}");
    assert!((height_m(&context, 0.0, 0.0) - (undug_m - 0.5)).abs() < 0.02);
    assert!(context.terrain_revision() > before);
    let point = context.soil_at(ORIGIN).unwrap().unwrap();
    assert!((point.change_m + 0.5).abs() < 0.02 && point.kind == SoilKindId::LOAM, "{point:?}");
    let changes: Vec<_> = context.soil_changes(before).collect();
    assert!(changes.iter().all(|change| change.size == [16, 16] && change.revision > before), "{changes:?}");
    let mut lowest: f64 = 0.0;
    for change in &changes {
        for point in context.soil_cells(change.tile, change.first, change.size).unwrap().flatten() {
            lowest = lowest.min(point.change_m);
        }
    }
    assert!((lowest + 0.51).abs() < 0.02, "{lowest}");
    assert_eq!(context.soil_changes(context.terrain_revision()).count(), 0);
    // The rain of the whole tile runs into the pit.
    context.update(900.0).unwrap();
    let pit = context.ground_at(ORIGIN + DVec3::Z * (undug_m - 0.5)).unwrap();
    assert!(pit.in_puddle && pit.water_mm > 20.0, "{pit:?}");
    // The host raises the undug ground by a metre: the pit stays as deep.
    let deep_m = height_m(&context, 0.25, 0.25);
    for key in KEYS {
        let heights = tile(key, 1.0);
        let cells = TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() };
        context.update_terrain(&cells).unwrap();
    }
    assert!((height_m(&context, 0.25, 0.25) - deep_m - 1.0).abs() < 1e-4);
    // A tile that goes and comes back has its soil again.
    let books = context.soil_books().unwrap();
    let key = KEYS[3];
    context.remove_terrain_tile(key).unwrap();
    assert_eq!(context.soil_books().unwrap(), books);
    let heights = tile(key, 1.0);
    context.set_terrain_tile(&TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() }).unwrap();
    assert!((height_m(&context, 0.25, 0.25) - deep_m - 1.0).abs() < 1e-4);
    let saved = context.save().unwrap();
    context.load(&saved).unwrap();
    assert_eq!(context.save().unwrap(), saved);
    context.set_soil(None).unwrap();
    assert_eq!(height_m(&context, 0.0, 0.0), f64::from(tile(KEYS[3], 1.0)[0]));
}

#[test]
fn a_quiet_site_changes_nothing_and_an_undug_one_is_free() {
    let mut context = context();
    site(&mut context);
    context.update(1.0).unwrap();
    let revision = context.terrain_revision();
    context.update(7200.0).unwrap();
    assert_eq!((context.terrain_revision(), context.soil_changes(0).count()), (revision, 0));
    let tool = trench(&mut context);
    context.end_soil_tool(tool).unwrap();
    context.update(7300.0).unwrap();
    let revision = context.terrain_revision();
    context.update(9000.0).unwrap();
    assert_eq!(context.terrain_revision(), revision);
    let books = context.soil_books().unwrap();
    assert!(books.is_balanced() && books.taken > 0 && books.held == 0, "{books:?}");
}

#[test]
fn wrong_input_is_named_and_changes_nothing() {
    let mut context = context();
    let settings = SoilSettings::default;
    let e = context.set_soil(Some(settings())).unwrap_err();
    assert_eq!(e.status, Status::WrongOrder);
    host::tiles(&mut context);
    let kind = SoilKind {
        density_kg_m3: 1.0,
        swell: 0.2,
        repose_deg: 35.0,
        cohesion_kpa: 0.0,
        friction_deg: 30.0,
        sinkage: None,
        albedo: [0.2; 3],
    };
    let e = context.set_soil(Some(SoilSettings { own_kinds: vec![kind], ..settings() })).unwrap_err();
    assert!(e.to_string().starts_with("own_kinds[0].density_kg_m3 must be in [50, 10000] kg/m^3"), "{e}");
    context.set_soil(Some(settings())).unwrap();
    context.update(1.0).unwrap();
    let good = bucket_pose(1.5, DVec3::Z * 0.3, 0.0, 0.2);
    let tool = context.add_soil_tool(bucket(1.0), &good).unwrap();
    let hash = context.state_hash().unwrap();
    let next = SoilToolPose { time_s: 2.0, ..good };
    let inside_out = SoilToolPose { edge: [good.edge[1], good.edge[0]], upper: [good.upper[1], good.upper[0]], ..next };
    for (pose, wanted) in [
        (inside_out, "pose.facing must be out of the opening"),
        (SoilToolPose { edge: [DVec3::NAN, good.edge[1]], ..next }, "pose.edge[0] must be finite"),
        (SoilToolPose { load_n: -1.0, ..next }, "pose.load_n must be in [0, 10000000] N"),
        (bucket_pose(2.0, DVec3::X * 100.0, 0.0, 0.2), "pose.edge[0] must be over a tile of the terrain"),
        (bucket_pose(2.0, DVec3::new(0.0, 0.0, 60.0), 0.0, 0.2), "pose.edge[0] must be within 20 m of the pose"),
        (SoilToolPose { time_s: 0.5, ..next }, "pose.time_s must be more than 1.5 s"),
    ] {
        let e = context.move_soil_tool(tool, &pose).unwrap_err();
        assert!(e.to_string().starts_with(wanted), "{e}");
    }
    let late = context.add_soil_tool(bucket(1.0), &SoilToolPose { time_s: 0.5, ..good }).unwrap_err();
    assert!(
        late.status == Status::WrongOrder && late.to_string().starts_with("pose.time_s must be at least 1 s"),
        "{late}"
    );
    let e = context.bring_soil(ORIGIN, SoilKindId(9), 1.0).unwrap_err();
    assert!(e.to_string().starts_with("kind must be a known kind of soil, in [0, 6]"), "{e}");
    assert!(context.bring_soil(ORIGIN, SoilKindId::SAND, -1.0).unwrap_err().to_string().starts_with("mass_kg must be"));
    assert!(context.soil_tool(SoilToolId(99)).unwrap_err().to_string().starts_with("tool must be a tool"));
    let e = context.soil_cells(TileKey::new(9, 9), [0, 0], [1, 1]).err().unwrap();
    assert!(e.to_string().starts_with("tile must be the key of a tile"), "{e}");
    assert!(context.soil_cells(KEYS[0], [20, 0], [16, 1]).err().unwrap().to_string().starts_with("size[0] must be"));
    assert_eq!(context.state_hash().unwrap(), hash, "nothing has changed");
    // Another lattice ends the soil, and cells of more than 4 m take none.
    context.set_terrain(Some(TerrainDesc { cell_m: 8.0, tile_cells: SIDE, ..TerrainDesc::default() })).unwrap();
    assert!(context.soil().is_none());
    let e = context.set_soil(Some(settings())).unwrap_err();
    assert!(e.to_string().starts_with("terrain.cell_m must be in [0.01, 4] m"), "{e}");
    const { assert!(CELL_M < 4.0) };
}
