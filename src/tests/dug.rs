//! Drawn soil on the software driver: it shows where and what `Context::soil_at` says, and nowhere else.

use glam::DVec3;

use super::{
    land::{clear_images, host_with, looking},
    opaque::{
        SIZE,
        host::{Host, Mapped, ndc, pixels},
    },
};
use crate::{
    context::GivenDirection,
    frame::Stages,
    soil::{SoilKindId, SoilSettings, SoilToolPose, SoilToolShape},
    terrain::SurfaceClass,
    weather::Weather,
};

const CELL_M: f64 = 0.25;
/// Albedo of concrete, the material of buildings, on which the soil lies.
const CONCRETE: [f64; 3] = [0.27, 0.26, 0.24];
/// Middle of the heap, and end of the trench, from the terrain's origin, m.
const HEAP: DVec3 = DVec3::new(64.0, 64.0, 0.0);
const TRENCH: DVec3 = DVec3::new(72.0, 64.0, 0.0);

fn picture(host: &mut Host, case: &Mapped) -> Vec<DVec3> {
    clear_images(&host.device, [&host.color, &host.depth]);
    host.record(case, Stages::SURFACE, |_| ());
    host.colors().iter().map(|c| DVec3::new(c[0].into(), c[1].into(), c[2].into())).collect()
}

fn origin(host: &Host) -> DVec3 {
    host.context.world.set.tiles.as_ref().unwrap().desc.origin
}

/// Camera above a place of the terrain that looks straight down.
fn above(host: &Host, place: DVec3, over: f64) -> Mapped {
    looking(origin(host) + place + DVec3::Z * over, DVec3::new(0.0, 1e-3, -1.0))
}

/// Level concrete of 128 m with this weather.
fn level_host(weather: &str) -> Host {
    let mut host = host_with(CELL_M, |_, _| 0.0);
    host.context.set_default_surface_class(SurfaceClass::Building);
    host.context.set_weather(&Weather::preset(weather).unwrap(), 0.0, 0.0).unwrap();
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 90.0, elevation_deg: 12.0 })).unwrap();
    host.context.update(0.0).unwrap();
    host
}

/// Pours a heap of a kind, 15 t, which slides to its angle of repose.
fn heap(host: &mut Host, kind: SoilKindId) {
    for _ in 0..30 {
        host.context.bring_soil(origin(host) + HEAP, kind, 500.0).unwrap();
        host.context.update(host.context.world.time_s + 0.5).unwrap();
    }
    host.context.update(host.context.world.time_s + 8.0).unwrap();
}

/// Digs a trench of 4 m into the layer below the topsoil, with a bucket that carries all of it away.
fn trench(host: &mut Host) {
    let pose = |host: &Host, time_s: f64, x: f64| {
        let at = origin(host) + TRENCH + DVec3::X * x;
        SoilToolPose {
            time_s,
            edge: [0.75, -0.75].map(|y| at + DVec3::new(0.0, y, -0.5)),
            upper: [0.75, -0.75].map(|y| at + DVec3::new(-0.2, y, 1.6)),
            facing: DVec3::new(1.0, 0.0, 0.2),
            load_n: 0.0,
        }
    };
    let begin_s = host.context.world.time_s;
    let shape = SoilToolShape::Bucket { struck_m3: 20.0, heap_rise: 1.0 };
    let first = pose(host, begin_s, 0.0);
    let tool = host.context.add_soil_tool(shape, &first).unwrap();
    for i in 1..=8 {
        let next = pose(host, begin_s + 0.5 * f64::from(i), 0.5 * f64::from(i));
        host.context.move_soil_tool(tool, &next).unwrap();
    }
    host.context.update(begin_s + 4.0).unwrap();
    host.context.end_soil_tool(tool).unwrap();
    host.context.update(begin_s + 8.0).unwrap();
}

#[test]
fn soil_shows_where_it_was_dug_and_heaped_and_nowhere_else() {
    let mut host = level_host("overcast");
    let case = above(&host, 0.5 * (HEAP + TRENCH) + DVec3::X, 13.0);
    let before = picture(&mut host, &case);
    host.context.set_soil(Some(SoilSettings::default())).unwrap();
    assert!(picture(&mut host, &case) == before, "soil that nobody has dug is not seen");
    heap(&mut host, SoilKindId::SAND);
    trench(&mut host);
    let after = picture(&mut host, &case);
    let (rays, depths) = (case.rays(), host.depths(0));
    // By kind: number of pixels, and sum of what is drawn over what is expected.
    let mut kinds = std::collections::BTreeMap::<SoilKindId, (f64, DVec3)>::new();
    let mut same = 0;
    for i in pixels() {
        let direction = rays.view_ray(ndc(i)).direction;
        let place = case.camera.position + direction * rays.view_range(f64::from(depths[i]), ndc(i));
        let around = [-1.0, 0.0, 1.0].map(|x| [-1.0, 0.0, 1.0].map(|y| place + DVec3::new(x, y, 0.0) * 1.5 * CELL_M));
        let around = around.map(|row| row.map(|at| host.context.soil_at(at).unwrap().unwrap()));
        let own = around[1][1];
        let all = || around.iter().flatten();
        if all().all(|p| p.covered == 0.0 && p.change_m == 0.0) {
            // The light on the ground is that below the eye, and depends on the ground's highest place.
            let change = (after[i] / before[i] - 1.0).abs().max_element();
            assert!(change < 2e-3, "pixel {i} at {place}: {} {}", before[i], after[i]);
            same += 1;
        } else if all().all(|p| p.covered == 1.0 && p.kind == own.kind) {
            let open = 0.5 + 0.5 * host.context.terrain_at(place).unwrap().unwrap().normal.z;
            let light = open + 0.15 * (1.0 - open);
            let expected = DVec3::from_array([0, 1, 2].map(|c| own.albedo[c] / CONCRETE[c])) * light;
            let sum = kinds.entry(own.kind).or_default();
            *sum = (sum.0 + 1.0, sum.1 + after[i] / before[i] / expected);
        }
    }
    println!("{same} pixels of concrete, by kind: {kinds:?}");
    assert!(same > 500);
    assert_eq!(kinds.keys().copied().collect::<Vec<_>>(), [SoilKindId::SAND, SoilKindId::LOAM]);
    for (kind, (count, sum)) in kinds {
        let off = (sum / count - 1.0).abs().max_element();
        assert!(count > 15.0 && off < 0.05, "{kind:?}: {count} pixels, {off}");
    }
}

#[test]
fn soil_has_the_same_mean_colour_at_every_distance() {
    let mut host = level_host("overcast");
    host.context.set_soil(Some(SoilSettings::default())).unwrap();
    // Light that the soil takes from the ground's, over the whole picture, cd.
    let lost = |host: &mut Host, over: f64, before: &[DVec3]| {
        let case = above(host, HEAP, over);
        let after = picture(host, &case);
        after.iter().zip(before).map(|(a, b)| (*b - *a) / *b).sum::<DVec3>() * over * over
    };
    let heights = [12.0, 24.0, 48.0];
    let before = heights.map(|over| {
        let case = above(&host, HEAP, over);
        picture(&mut host, &case)
    });
    heap(&mut host, SoilKindId::COAL);
    let sums = [0, 1, 2].map(|i| lost(&mut host, heights[i], &before[i]));
    println!("{sums:.0?}");
    for sum in sums {
        assert!((sum / sums[0] - 1.0).abs().max_element() < 0.06, "{sums:?}");
    }
}

#[test]
fn clods_roughen_soil_near_the_eye_and_fade_with_distance() {
    let mut host = level_host("clear");
    host.context.set_soil(Some(SoilSettings::default())).unwrap();
    heap(&mut host, SoilKindId::SAND);
    // The sun shines along the axis of the picture's rows: without clods each place of the heap is as bright as the one
    // on the other side of the axis. Root mean square difference of the two over their mean, on the sunny side.
    let mut roughness = |over: f64| {
        let case = above(&host, HEAP + DVec3::X * 1.2, over);
        let colors = picture(&mut host, &case);
        let (rays, depths) = (case.rays(), host.depths(0));
        let is_near = |i: &usize| {
            let range = rays.view_range(f64::from(depths[*i]), ndc(*i));
            let place = case.camera.position + rays.view_ray(ndc(*i)).direction * range;
            let at = place - origin(&host) - HEAP;
            at.y.abs() < 0.7 && (0.5..1.6).contains(&at.x)
        };
        let other = |i: usize| (SIZE.1 as usize - 1 - i / SIZE.0 as usize) * SIZE.0 as usize + i % SIZE.0 as usize;
        let squares: Vec<f64> = pixels()
            .filter(is_near)
            .map(|i| (colors[i].y, colors[other(i)].y))
            .map(|(a, b)| 2.0 * ((a - b) / (a + b)).powi(2))
            .collect();
        (squares.len(), (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
    };
    let (near, far) = (roughness(3.0), roughness(12.0));
    println!("near {near:?}, far {far:?}");
    assert!(near.0 > 100 && near.1 > 0.05, "{near:?}");
    assert!(far.0 > 10 && far.1 < 0.4 * near.1, "{near:?}, {far:?}");
}

#[test]
fn soil_that_is_taken_away_leaves_the_ground_as_it_was() {
    let mut host = level_host("overcast");
    let case = above(&host, HEAP, 20.0);
    let before = picture(&mut host, &case);
    host.context.set_soil(Some(SoilSettings::default())).unwrap();
    heap(&mut host, SoilKindId::CLAY);
    assert!(picture(&mut host, &case) != before);
    host.context.set_soil(None).unwrap();
    assert!(picture(&mut host, &case) == before);
}
