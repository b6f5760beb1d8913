//! Water on the host's terrain: where it falls, stands and is absent; independent of the steps of time, and kept by a
//! saved state.

use glam::{DMat3, DVec3};
use welkin::{
    Status,
    context::{Context, ContextDesc, GivenDirection},
    frame::Stages,
    ground::GroundGrid,
    ground::{GroundCell, GroundModel},
    rain::{AreaMotion, AreaShape, Planes, RainArea, Shelter},
    weather::{Precipitation, PrecipitationKind, Surface, SurfaceState, Weather, Wind},
};

use crate::host::{Host, SIZE, ground, look, resealed};

pub const NODES: [u32; 2] = [40, 30];

/// A slope to the south with a bowl of 0.3 m in it, on cells of a metre; south-west corner at (-20, 0).
pub fn grid() -> GroundGrid {
    let at = |i: u32| {
        let (x, y) = (f64::from(i % NODES[0]) - 20.0, f64::from(i / NODES[0]));
        let away = ((x - 6.0).powi(2) + (y - 12.0).powi(2)).sqrt();
        (0.004 * y - 0.3 * (1.0 - away / 6.0).max(0.0)) as f32
    };
    let heights_m = (0..NODES[0] * NODES[1]).map(at).collect();
    GroundGrid { origin: DVec3::new(-20.0, 0.0, 0.0), cell_m: 1.0, nodes: NODES, heights_m, classes: Vec::new() }
}

pub fn simulated(host: &Host) -> Context {
    let desc = ContextDesc { ground: GroundModel::Simulated, seed: 7, ..ContextDesc::default() };
    let mut context = Context::new(host.device.clone(), host.context.shared().clone(), desc).unwrap();
    context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 40.0 })).unwrap();
    context
}

/// Rain of this rate, mm/h, in a wind from the west.
pub fn rain(rate_mm_h: f64, wind_m_s: f64) -> Weather {
    Weather {
        precipitation: Precipitation::of(PrecipitationKind::Rain, rate_mm_h),
        wind: Wind { gust_m_s: Some(wind_m_s), ..Wind::of(wind_m_s, 270.0) },
        ..Weather::default()
    }
}

pub fn roof(center: [f64; 3], half: [f64; 3]) -> Shelter {
    let (center_m, half_size_m) = (DVec3::from(center), DVec3::from(half));
    Shelter { center_m, axes: DMat3::IDENTITY, half_size_m, velocity_m_s: DVec3::ZERO, planes: Planes::NONE }
}

fn cells(context: &Context) -> Vec<GroundCell> {
    context.ground_cells().unwrap().collect()
}

fn at(x: f64, y: f64) -> DVec3 {
    DVec3::new(x, y, 0.0)
}

/// Sets the terrain, a roof over a part of it, and a shower over another.
pub fn put_terrain(context: &mut Context) {
    context.set_shelters(&[roof([-12.0, 8.0, 4.0], [5.0, 4.0, 0.2])]).unwrap();
    let area = RainArea {
        center_m: [30.0, 10.0, 0.0],
        shape: AreaShape::Ellipse([25.0, 25.0]),
        rim_m: 15.0,
        rate_mm_h: 40.0,
        motion: AreaMotion::Own([-0.01, 0.0]),
        ..RainArea::default()
    };
    context.set_rain_areas(&[area]).unwrap();
    context.set_ground_grid(Some(grid())).unwrap();
}

/// Half an hour of rain from 100 s on, then sun and wind; half of the terrain under a roof, a shower over a part of it.
fn shower(host: &Host) -> Context {
    let mut context = simulated(host);
    context.set_weather(&rain(12.0, 4.0), 100.0, 137.0).unwrap();
    let clear = Weather { wind: Wind::of(6.0, 200.0), ..Weather::preset("clear").unwrap() };
    context.set_weather(&clear, 1900.0, 61.0).unwrap();
    put_terrain(&mut context);
    context
}

#[test]
fn steps_of_any_size_come_to_the_same_cells() {
    let host = Host::new();
    let mut whole = shower(&host);
    let mut by_step = [0.7, 9.3, 59.9, 1000.0].map(|dt| (dt, shower(&host)));
    for end in [95.0, 150.0, 1905.0, 1955.0, 4000.0] {
        whole.update(end).unwrap();
        for (dt, context) in &mut by_step {
            while context.time_s() < end {
                context.update((context.time_s() + *dt).min(end)).unwrap();
            }
            assert!(cells(context) == cells(&whole), "steps of {dt} s to {end} s");
            assert_eq!(context.state_hash().unwrap(), whole.state_hash().unwrap(), "steps of {dt} s to {end} s");
        }
        let revision = whole.ground_revision();
        whole.update(end).unwrap();
        assert_eq!(whole.ground_revision(), revision, "standing time changes nothing");
    }
    assert!(cells(&whole).iter().any(|c| c.standing_mm > 1.0));
}

#[test]
fn a_saved_terrain_goes_on_as_if_nothing_had_been() {
    let host = Host::new();
    let mut first = shower(&host);
    first.update(1234.5).unwrap();
    let saved = first.save().unwrap();
    first.update(1800.0).unwrap();
    let mut second = simulated(&host);
    second.load(&saved).unwrap();
    assert_eq!(second.ground_grid(), Some(&grid()), "the heights come with it");
    assert_eq!(second.shelters(), first.shelters(), "and what keeps them dry");
    second.set_ground_grid(Some(grid())).unwrap();
    second.update(1800.0).unwrap();
    assert!(cells(&first) == cells(&second));
    assert_eq!(first.save().unwrap(), second.save().unwrap());
    // A damaged state is refused, and the running context continues.
    let text = String::from_utf8(saved).unwrap();
    let line = text.lines().find(|l| l.starts_with("water = [")).unwrap();
    for (from, to) in [
        (line, line.replacen("[\"", "[\"ffffffffffffffff ", 1)),
        (line, line.replacen("[\"", "[\"7ff8000000000000 ", 1).replacen(" 3f", " ", 1)),
        ("cell_m = 1.0", "cell_m = -1.0".into()),
        ("nodes = [40, 30]", "nodes = [40, 31]".into()),
        ("nodes = [40, 30]", "nodes = [4000000000, 4000000000]".into()),
    ] {
        let broken = text.replacen(from, &to, 1);
        assert!(broken != text);
        let e = second.load(&resealed(&broken)).unwrap_err();
        assert!(e.status == Status::Parse && e.to_string().contains("terrain"), "{e}");
    }
    assert!(cells(&first) == cells(&second));
    // A state without a terrain removes it. A terrain that is set again begins as wet as the level ground.
    let mut third = shower(&host);
    let mut bare = simulated(&host);
    bare.set_weather(&rain(12.0, 4.0), 0.0, 0.0).unwrap();
    bare.update(1000.0).unwrap();
    third.load(&bare.save().unwrap()).unwrap();
    assert!(third.ground_grid().is_none() && third.ground_water() == bare.ground_water());
    third.set_ground_grid(Some(grid())).unwrap();
    let open = third.ground_at(at(0.0, 20.0)).unwrap();
    assert!((open.film_mm - bare.ground_water().unwrap().film_mm).abs() < 0.05, "{open:?}");
}

#[test]
fn it_is_dry_under_a_roof_but_for_the_wet_wedge_on_the_windward_side() {
    let host = Host::new();
    let mut context = simulated(&host);
    let flat = GroundGrid { heights_m: vec![0.0; 1200], ..grid() };
    context.set_ground_grid(Some(flat)).unwrap();
    context.set_shelters(&[roof([0.0, 15.0, 6.0], [6.0, 6.0, 0.1])]).unwrap();
    context.set_weather(&rain(8.0, 5.0), 0.0, 0.0).unwrap();
    context.update(3600.0).unwrap();
    let water = |x: f64| context.ground_at(at(x, 15.0)).unwrap().water_mm;
    let open = water(-15.0);
    assert!(open > 0.3, "{open}");
    // Drops fall at 3.5 to 8 m/s: over 6 m of height the wind of 5 m/s carries them 4 to 9 m to the east.
    for (x, dry) in [(-7.0, false), (-5.0, false), (-3.0, false), (4.0, true), (5.0, true), (7.0, true), (17.0, false)]
    {
        assert_eq!(water(x) == 0.0, dry, "{x}: {}", water(x));
        assert!(dry || water(x) > 0.99 * open, "{x}: {} of {open}", water(x));
    }
    let edge = [0.0, 1.0, 11.0, 12.0].map(water);
    assert!(
        edge.iter().any(|w| *w > 0.0 && *w < 0.95 * open),
        "thirds of the rain come along slants of their own: {edge:?}"
    );
    // A truck that drives by keeps nothing dry. A box that has stood there longer than the rain keeps the ground below
    // it dry.
    let mut truck = roof([-12.0, 15.0, 2.0], [3.0, 3.0, 2.0]);
    truck.velocity_m_s = DVec3::new(5.0, 0.0, 0.0);
    context.set_shelters(&[truck]).unwrap();
    context.update(7200.0).unwrap();
    assert!((context.ground_at(at(-12.0, 15.0)).unwrap().water_mm / open - 1.0).abs() < 0.05);
    assert!((context.ground_at(at(5.0, 15.0)).unwrap().water_mm / open - 1.0).abs() < 0.05);
}

#[test]
fn freezing_rain_leaves_no_ice_under_a_roof_whether_simulated_or_loaded() {
    let host = Host::new();
    for model in [GroundModel::Simulated, GroundModel::Reported] {
        let fresh = || {
            let desc = ContextDesc { ground: model, seed: 7, ..ContextDesc::default() };
            let mut context = Context::new(host.device.clone(), host.context.shared().clone(), desc).unwrap();
            context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 40.0 })).unwrap();
            context.set_shelters(&[roof([0.0, 15.0, 6.0], [6.0, 6.0, 0.1])]).unwrap();
            context
        };
        let mut context = fresh();
        context.set_ground_grid(Some(GroundGrid { heights_m: vec![0.0; 1200], ..grid() })).unwrap();
        let freezing = Precipitation::of(PrecipitationKind::FreezingRain, 3.0);
        let weather = Weather { precipitation: freezing, temperature_c: -2.0, ..rain(3.0, 5.0) };
        context.set_weather(&weather, 600.0, 0.0).unwrap();
        context.update(500.0).unwrap();
        assert!(cells(&context).iter().all(|c| c.ice == 0.0));
        let before = context.ground_revision();
        context.update(1200.0).unwrap();
        assert!(context.ground_revision() > before, "{model:?}: who uploads cells is told of the ice");
        let water = cells(&context);
        let ice = |x: f64| water[15 * NODES[0] as usize + (x + 20.0) as usize].ice;
        let open = ice(-15.0);
        assert!(open > 0.8 && [-7.0, -5.0, -3.0, 17.0].iter().all(|x| ice(*x) == open), "{model:?}: {open}");
        assert!([5.0, 6.0, 7.0].iter().all(|x| ice(*x) == 0.0), "{model:?}: {} {}", ice(5.0), ice(7.0));
        let edge = [0.0, 1.0, 2.0, 3.0, 11.0, 12.0].map(ice);
        assert!(edge.iter().any(|i| *i > 0.0 && *i < open), "{model:?}: by thirds of the rain: {edge:?}");
        let mut second = fresh();
        second.load(&context.save().unwrap()).unwrap();
        if model == GroundModel::Reported {
            second.set_ground_grid(Some(context.ground_grid().unwrap().clone())).unwrap();
        }
        for t in [1200.0, 1234.5, 4000.0] {
            context.update(t).unwrap();
            second.update(t).unwrap();
            assert!(cells(&context) == cells(&second), "{model:?} at {t}");
            assert_eq!(context.state_hash().unwrap(), second.state_hash().unwrap(), "{model:?} at {t}");
        }
        // Without the roof there is ice there too: ice that a report names lies everywhere.
        context.set_shelters(&[]).unwrap();
        assert!(cells(&context).iter().all(|c| c.ice == open));
        context.set_shelters(second.shelters()).unwrap();
        let surface = Surface { state: Some(SurfaceState::Ice), ..Surface::default() };
        context.set_weather(&Weather { surface, temperature_c: -2.0, ..Weather::default() }, 4000.0, 0.0).unwrap();
        context.update(4020.0).unwrap();
        assert!(cells(&context).iter().all(|c| c.ice == 1.0), "{model:?}");
    }
}

#[test]
fn areas_wet_their_part_and_hollows_fill_and_dry() {
    let host = Host::new();
    let mut context = simulated(&host);
    context.set_ground_grid(Some(grid())).unwrap();
    let area = RainArea {
        center_m: [20.0, 12.0, 0.0],
        shape: AreaShape::Ellipse([20.0, 40.0]),
        rim_m: 4.0,
        rate_mm_h: 30.0,
        motion: AreaMotion::Own([0.0, 0.0]),
        ..RainArea::default()
    };
    context.set_rain_areas(&[area]).unwrap();
    context.update(3600.0).unwrap();
    let dry = context.ground_at(at(-10.0, 12.0)).unwrap();
    assert_eq!((dry.water_mm, dry.wetness, dry.in_puddle), (0.0, 0.0, false));
    let (deep, rim, slope) = (at(6.0, 12.0), at(11.5, 12.0), at(12.0, 20.0));
    let [a, b, c] = [deep, rim, slope].map(|p| context.ground_at(p).unwrap());
    assert!(a.in_puddle && a.water_mm > 100.0 && a.wetness == 1.0, "{a:?}");
    assert!(!b.in_puddle && !c.in_puddle && c.film_mm > 0.5 && c.water_mm == c.film_mm, "{b:?} {c:?}");
    assert!(a.puddles > 0.005 && a.puddles < 0.1, "{a:?}");
    // High above the terrain, and beyond it, it is the world's ground.
    let above = context.ground_at(at(6.0, 12.0) + DVec3::Z * 5.0).unwrap();
    assert!(above.puddles > 0.5 && context.ground_at(at(19.1, 12.0)).unwrap().puddles > 0.5, "{above:?}");
    context.set_rain_areas(&[]).unwrap();
    let sun = Weather { relative_humidity: 0.4, temperature_c: 25.0, wind: Wind::of(6.0, 0.0), ..Weather::default() };
    context.set_weather(&sun, 3600.0, 0.0).unwrap();
    let mut last = f64::INFINITY;
    for hour in 3..12 {
        context.update(3600.0 * f64::from(hour)).unwrap();
        let now = context.ground_at(deep).unwrap();
        assert!(now.water_mm < last && now.water_mm > 0.0, "{now:?}");
        assert_eq!(context.ground_at(slope).unwrap().film_mm, 0.0);
        last = now.water_mm;
    }
    context.update(3600.0 * 24.0 * 20.0).unwrap();
    assert_eq!(context.ground_at(deep).unwrap().water_mm, 0.0);
}

/// Hills of Tennessee (USGS/NASA SRTM), a part of 120 x 100 nodes of about 80 m.
#[test]
fn in_real_hills_water_stands_in_their_closed_hollows_alone() {
    let data = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/data/jacksboro_dem.png");
    let dem = image::open(data).unwrap().into_luma16();
    let (columns, rows) = (120u32, 100u32);
    // Its first row is the northern one.
    let height = |x: u32, y: u32| f32::from(dem.get_pixel(140 + x, 240 - y).0[0]);
    let heights_m: Vec<f32> = (0..rows).flat_map(|y| (0..columns).map(move |x| height(x, y))).collect();
    // Cells that lie lower than all of their neighbours, and higher.
    let at = |x: u32, y: u32| heights_m[(y * columns + x) as usize];
    let around = |x: u32, y: u32| {
        (y - 1..=y + 1).flat_map(move |v| (x - 1..=x + 1).map(move |u| (u, v))).filter(move |p| *p != (x, y))
    };
    let inner = || (1..rows - 1).flat_map(|y| (1..columns - 1).map(move |x| (x, y)));
    let is_pit = |&(x, y): &(u32, u32)| around(x, y).all(|(u, v)| at(u, v) > at(x, y));
    let is_top = |&(x, y): &(u32, u32)| around(x, y).all(|(u, v)| at(u, v) < at(x, y));
    let (pits, tops): (Vec<_>, Vec<_>) = (inner().filter(is_pit).collect(), inner().filter(is_top).collect());
    assert!(pits.len() > 20 && tops.len() > 20, "{} {}", pits.len(), tops.len());
    let host = Host::new();
    let mut context = simulated(&host);
    let grid = GroundGrid {
        origin: DVec3::ZERO,
        cell_m: 80.0,
        nodes: [columns, rows],
        heights_m: heights_m.clone(),
        classes: Vec::new(),
    };
    context.set_ground_grid(Some(grid)).unwrap();
    context.set_weather(&rain(15.0, 3.0), 0.0, 0.0).unwrap();
    context.update(3600.0).unwrap();
    let water = cells(&context);
    let of = |&(x, y): &(u32, u32)| water[(y * columns + x) as usize];
    assert!(pits.iter().all(|p| of(p).standing_mm > 5.0 && of(p).film_mm == 0.0), "pits fill");
    assert!(tops.iter().all(|p| of(p).standing_mm == 0.0 && of(p).film_mm > 0.5), "tops shed");
    let share = water.iter().filter(|c| c.standing_mm > 0.0).count() as f64 / water.len() as f64;
    assert!((0.005..0.2).contains(&share), "{share}");
    // 15 mm have fallen on each cell. No more water stands than fell, and a good part of it has left the grid.
    let standing = water.iter().map(|c| f64::from(c.standing_mm)).sum::<f64>() / water.len() as f64;
    assert!(standing > 0.5 && standing < 14.0, "{standing} mm");
    println!("{} pits, {share:.3} of the ground under water, {standing:.2} mm over all of it", pits.len());
}

#[test]
fn a_reported_ground_is_spread_over_the_hollows() {
    let mut host = Host::new();
    let context = &mut host.context;
    context.set_ground_grid(Some(grid())).unwrap();
    context.set_shelters(&[roof([-12.0, 8.0, 4.0], [5.0, 4.0, 0.2])]).unwrap();
    let surface = Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() };
    let reported = Weather { surface, wind: Wind::of(0.0, 0.0), ..Weather::default() };
    context.set_weather(&reported, 0.0, 0.0).unwrap();
    let [deep, slope, dry] = [at(6.0, 12.0), at(-2.0, 20.0), at(-12.0, 8.0)].map(|p| context.ground_at(p).unwrap());
    assert!(deep.in_puddle && deep.water_mm > 10.0, "{deep:?}");
    assert!(!slope.in_puddle && slope.film_mm > 0.2 && slope.wetness > 0.9, "{slope:?}");
    assert_eq!(dry.water_mm, 0.0);
    context.set_shelters(&[]).unwrap();
    assert!(context.ground_at(at(-12.0, 8.0)).unwrap().film_mm > 0.2);
    context.set_weather(&Weather::preset("clear").unwrap(), 0.0, 0.0).unwrap();
    assert_eq!(context.ground_at(at(6.0, 12.0)).unwrap().water_mm, 0.0);
    context.set_ground_grid(None).unwrap();
    assert!(context.ground_cells().is_none() && context.ground_grid().is_none());
}

#[test]
fn a_bad_grid_is_refused_and_the_running_one_stays() {
    let host = Host::new();
    let mut context = shower(&host);
    context.update(600.0).unwrap();
    let before = cells(&context);
    for (bad, name) in [
        (GroundGrid { cell_m: -1.0, ..grid() }, "ground_grid.cell_m"),
        (GroundGrid { nodes: [1, 30], ..grid() }, "ground_grid.nodes[0]"),
        (GroundGrid { nodes: [40, 513], ..grid() }, "ground_grid.nodes[1]"),
        (GroundGrid { heights_m: vec![f32::NAN; 1200], ..grid() }, "ground_grid.heights_m[0]"),
    ] {
        let e = context.set_ground_grid(Some(bad)).unwrap_err();
        assert!(e.status == Status::InvalidArgument && e.to_string().contains(name), "{e}");
    }
    context.set_ground_grid(Some(grid())).unwrap();
    assert!(cells(&context) == before, "the same grid again keeps its water");
}

#[test]
fn large_grids_are_set_stepped_and_saved_soon() {
    let host = Host::new();
    for side in [64u32, 256, 512] {
        let at = |i: u32| {
            let (x, y) = (f64::from(i % side), f64::from(i / side));
            (0.3 * (x * 0.37).sin() * (y * 0.29).cos() + 0.05 * (x * 1.7 + y * 2.3).sin()) as f32
        };
        let heights_m: Vec<f32> = (0..side * side).map(at).collect();
        let mut context = simulated(&host);
        context.set_weather(&rain(6.0, 5.0), 0.0, 0.0).unwrap();
        context.set_shelters(&[roof([10.0, 10.0, 4.0], [5.0, 5.0, 0.2])]).unwrap();
        let ms = |start: std::time::Instant| start.elapsed().as_secs_f64() * 1e3;
        let start = std::time::Instant::now();
        let grid = GroundGrid { origin: DVec3::ZERO, cell_m: 1.0, nodes: [side, side], heights_m, classes: Vec::new() };
        context.set_ground_grid(Some(grid)).unwrap();
        let set = ms(start);
        let start = std::time::Instant::now();
        context.update(600.0).unwrap();
        let step = ms(start) / 60.0;
        let area = RainArea { center_m: [0.0; 3], motion: AreaMotion::Own([1.0, 0.0]), ..RainArea::default() };
        context.set_rain_areas(&[RainArea { shape: AreaShape::Ellipse([60.0, 60.0]), rim_m: 60.0, ..area }]).unwrap();
        let start = std::time::Instant::now();
        context.update(900.0).unwrap();
        let uneven = ms(start) / 30.0;
        let start = std::time::Instant::now();
        let saved = context.save().unwrap().len();
        println!(
            "{side}^2: set {set:.1} ms, step {step:.3} ms, in a rim {uneven:.3} ms, save {:.1} ms {saved} bytes",
            ms(start)
        );
        assert!(uneven < 1e3 && step < 1e3, "{side}: {step} ms, {uneven} ms");
        context.set_rain_areas(&[]).unwrap();
        assert!(cells(&context).iter().all(|c| c.film_mm.is_finite() && c.standing_mm.is_finite()));
    }
}

/// Returns the radiance of the ground divided by the radiance that the host drew.
fn shown(host: &mut Host, eye: DVec3, azimuth_deg: f64, elevation_deg: f64) -> Vec<f32> {
    let camera = look(eye, azimuth_deg, elevation_deg, 1.0);
    let pixels = host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [2000.0; 3]));
    pixels.iter().map(|p| p[1] / 2000.0).collect()
}

#[test]
fn the_picture_is_dark_where_the_terrain_is_wet_and_dry_under_a_roof() {
    let mut host = Host::new();
    let flat = |dent: f32| {
        let mut heights_m = vec![0.0f32; 1200];
        // A square of 6 x 6 m round (8, 15).
        for (x, y) in (25..31).flat_map(|x| (12..18).map(move |y| (x, y))) {
            heights_m[y * 40 + x] = -dent;
        }
        GroundGrid { heights_m, ..grid() }
    };
    let mut context = simulated(&host);
    context.set_ground_grid(Some(flat(0.03))).unwrap();
    context.set_shelters(&[roof([-8.0, 15.0, 4.0], [5.0, 5.0, 0.2])]).unwrap();
    let (wet, dry) = (rain(10.0, 0.0), Weather { wind: Wind::of(0.0, 0.0), ..Weather::default() });
    context.set_weather(&wet, 0.0, 0.0).unwrap();
    context.set_weather(&dry, 3600.0, 0.0).unwrap();
    context.update(3700.0).unwrap();
    host.context = context;
    // Straight down from 20 m: the darkening of the ground, and a little reflection.
    let pixel = |pixels: &[f32], x: u32, y: u32| pixels[(y * SIZE.0 + x) as usize];
    let middle = |host: &mut Host, x: f64, y: f64| {
        let pixels = shown(host, DVec3::new(x, y, 20.0), 0.0, -90.0);
        pixel(&pixels, SIZE.0 / 2, SIZE.1 / 2)
    };
    let [sheltered, open, pool] = [-8.0, -17.0 + 16.0, 8.0].map(|x| middle(&mut host, x, 15.0));
    assert_eq!(sheltered, 1.0, "no drop came there, though the rain's slant of this moment is not asked");
    assert!((0.4..0.9).contains(&open) && (0.4..0.9).contains(&pool), "{open} {pool}");
    // A surface above the terrain does not have the terrain's water: a deck above the puddle has that of level ground.
    let deck = |host: &mut Host| {
        let eye = DVec3::new(8.0, 15.0, 26.0);
        let pixels = host.shoot(look(eye, 0.0, -90.0, 1.0), Stages::SURFACE, |d| Some((-20.0 / d.z, [2000.0; 3])));
        pixel(&pixels.iter().map(|p| p[1] / 2000.0).collect::<Vec<_>>(), SIZE.0 / 2, SIZE.1 / 2)
    };
    let above = deck(&mut host);
    assert!(above < 1.0 && above != pool, "{above} {pool}");
    // Towards the horizon standing water mirrors the sky as a level surface, a film as a rough one.
    let low = shown(&mut host, DVec3::new(8.0, -3.0, 2.0), 0.0, -6.5);
    let far = |x: u32| f64::from(pixel(&low, x, SIZE.1 / 2));
    assert!((far(SIZE.0 / 2) - far(4)).abs() > 0.02, "{} {}", far(SIZE.0 / 2), far(4));
    // Without the grid the same weather draws the pattern's puddles, and nothing of the terrain.
    let with = shown(&mut host, DVec3::new(8.0, 15.0, 20.0), 0.0, -90.0);
    host.context.set_ground_grid(None).unwrap();
    assert!(shown(&mut host, DVec3::new(8.0, 15.0, 20.0), 0.0, -90.0) != with);
}
