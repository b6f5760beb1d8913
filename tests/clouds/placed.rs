//! Clouds placed by a host's map, and clouds over rain areas.

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    context::GivenDirection,
    frame::FrameFlags,
    gpu::DeviceOptions,
    light::luminance,
    rain::{AreaMotion, AreaRain, AreaShape, RainArea},
    weather::{CloudKind, CloudLayer, CloudMap, Weather},
};
use welkin_support::seen_lux::seen_lux;

use crate::{
    asked::drawn_over_asked,
    drawn::{BROKEN, Sky, p95},
    shadows::over_ground,
};

/// Cloud in the west, none in the east.
fn half() -> CloudMap {
    let cover = (0..64).map(|x| if x < 32 { 1.0 } else { 0.0 }).collect();
    CloudMap { first_m: [-31_500.0, 0.0], cell_m: 1000.0, cells: [64, 1], base_m: [0.0, 20e3], cover }
}

fn sky(kind: CloudKind, cover: f64, base_m: f64) -> Sky {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let clouds = vec![CloudLayer::of(kind, cover, base_m)];
    sky.context.set_weather(&Weather { clouds, ..Weather::default() }, 0.0, 0.0).unwrap();
    sky.context.set_cloud_map(Some(half())).unwrap();
    sky
}

#[test]
fn questions_find_clouds_where_the_map_has_them() {
    let sky = sky(CloudKind::Stratus, 1.0, 800.0);
    let through = |x: f64| {
        let (from, to) = (DVec3::new(x, 0.0, 700.0), DVec3::new(x, 0.0, 1300.0));
        sky.context.between(from, to, 0.0).unwrap().transmittance[1]
    };
    let light = |x: f64| sky.context.light_at(DVec3::new(x, 0.0, 2.0), 0.0).unwrap();
    let share = |x: f64| sky.context.sun_share(DVec3::new(x, 0.0, 2.0), 0.0).unwrap();
    println!("through the layer: west {:.1e}, east {:.3}", through(-20e3), through(20e3));
    assert!(through(-20e3) < 1e-3 && through(20e3) > 0.97);
    assert!(share(-20e3) < 0.01 && share(20e3) == 1.0, "{} {}", share(-20e3), share(20e3));
    let [west, east] = [-20e3, 20e3].map(|x| light(x).arriving.total_lux);
    println!("light on the ground: west {west:.0} lux, east {east:.0} lux");
    assert!(west < 0.6 * east);
    let clear = Sky::new("LOWI 121150Z 00000KT CAVOK 15/05 Q1013", CloudModel::Volume);
    let shares = (light(20e3).sun.direct_share, clear.context.light_at(DVec3::Z, 0.0).unwrap().sun.direct_share);
    assert_eq!(shares, (1.0, 1.0));
}

#[test]
fn the_picture_of_a_mapped_layer_is_that_of_the_questions() {
    for (kind, cover, base_m, height_m) in [
        (CloudKind::Cumulus, 0.6, 1200.0, 2.0),
        (CloudKind::Stratus, 1.0, 800.0, 2.0),
        (CloudKind::Stratus, 1.0, 800.0, 2500.0),
    ] {
        let mut sky = sky(kind, cover, base_m);
        // Looks along the border of the covered half, so that both halves are visible.
        let rise = if height_m > 1000.0 { -0.25 } else { 0.4 };
        let mut off: Vec<f64> = [DVec3::new(0.0, 1.0, rise), DVec3::new(-1.0, 0.3, rise), DVec3::new(1.0, 0.3, rise)]
            .into_iter()
            .flat_map(|forward| drawn_over_asked(&mut sky, forward, height_m))
            .map(|ratio| (ratio - 1.0).abs())
            .collect();
        off.sort_by(f64::total_cmp);
        let [half, most] = [50, 90].map(|percent| off[off.len() * percent / 100]);
        println!("{kind:?} from {height_m} m: pictures off by {half:.4} in the median, {most:.3} at 90 %");
        assert!(half < 0.02 && most < 0.15, "{kind:?} from {height_m} m: {half} {most}");
    }
}

#[test]
fn shadows_stand_under_the_mapped_half_alone() {
    let mut sky = sky(CloudKind::Cumulus, 0.5, 3000.0);
    let whole = CloudMap { cover: vec![1.0; 64], ..half() };
    let mut left_dark = |map: CloudMap| {
        sky.context.set_cloud_map(Some(map)).unwrap();
        let seen = over_ground(&mut sky, 1e6, FrameFlags::NO_HISTORY);
        let brightest = seen.iter().fold(0.0, |most: f64, v| most.max(*v));
        let dark = |columns: std::ops::Range<usize>| {
            let within = seen.iter().enumerate().filter(|(i, _)| columns.contains(&(i % 96)));
            let dark: Vec<bool> = within.map(|(_, v)| *v < 0.7 * brightest).collect();
            dark.iter().filter(|d| **d).count() as f64 / dark.len() as f64
        };
        [dark(0..24), dark(72..96)]
    };
    // The picture is 4.8 km wide; the sun stands in the south-east, so that shadows lie 3 km west of their clouds.
    let shifted = |x: f64| CloudMap { first_m: [half().first_m[0] + x, 0.0], ..half() };
    let [all, west, none] = [whole, shifted(2000.0), shifted(-20e3)].map(&mut left_dark);
    println!("ground in shadow, west and east: {all:.2?} under clouds, {west:.2?} with a border, {none:.2?} beside");
    assert!(all[0] > 0.15 && all[1] > 0.15, "{all:?}");
    assert!(west[0] > 0.1 && west[1] < 0.05, "{west:?}");
    assert_eq!(none, [0.0; 2]);
}

#[test]
fn a_map_is_saved_refused_and_taken_off() {
    let mut sky = sky(CloudKind::Stratus, 1.0, 800.0);
    let place = DVec3::new(20e3, 0.0, 2.0);
    let share = |sky: &Sky| sky.context.sun_share(place, 0.0).unwrap();
    let (hash, state) = (sky.context.state_hash().unwrap(), sky.context.save().unwrap());
    let bad = CloudMap { cover: vec![f32::NAN; 64], ..half() };
    let e = sky.context.set_cloud_map(Some(bad)).unwrap_err().to_string();
    assert!(e.starts_with("cloud_map.cover[0] must be in [0, 1]"), "{e}");
    assert_eq!((sky.context.state_hash().unwrap(), share(&sky)), (hash, 1.0), "nothing has changed");
    sky.context.set_cloud_map(None).unwrap();
    assert!(share(&sky) < 0.01 && sky.context.state_hash().unwrap() != hash);
    let mut other = Sky::new(BROKEN, CloudModel::Volume);
    other.context.load(&state).unwrap();
    assert_eq!((other.context.state_hash().unwrap(), share(&other)), (hash, 1.0));
    assert_eq!(other.context.cloud_map(), Some(&half()));
    // Two channels show the same.
    sky.context.set_cloud_map(Some(half())).unwrap();
    let forward = DVec3::new(-0.3, 1.0, 0.4);
    let [a, b] = [&mut sky, &mut other].map(|sky| sky.look(forward, 2.0, None, FrameFlags::NO_HISTORY));
    assert!(a == b);
    // A larger map takes more room.
    let bytes = sky.view.report().bytes;
    let larger = CloudMap { cells: [64, 3], cover: half().cover.repeat(3), ..half() };
    sky.context.set_cloud_map(Some(larger)).unwrap();
    sky.look(forward, 2.0, None, FrameFlags::NO_HISTORY);
    assert_eq!(sky.view.report().bytes - bytes, 8 * 2 * 64);
}

/// Returns the transmittance of clouds straight up from a place.
fn up(sky: &Sky, x: f64, y: f64) -> f64 {
    // Above the base of the areas, where no rain takes light.
    let (from, to) = (DVec3::new(x, y, 1500.0), DVec3::new(x, y, 14e3));
    sky.context.between(from, to, 0.0).unwrap().transmittance[1]
}

const CLEAR: &str = "LOWI 121150Z 00000KT CAVOK 15/05 Q1013";

/// Places of a grid in a square of 12 km around the middle of an area, m east and north of it.
fn places() -> impl Iterator<Item = (f64, f64)> {
    (0..13 * 13).map(|i| (f64::from(i % 13 - 6) * 1000.0, f64::from(i / 13 - 6) * 1000.0))
}

#[test]
fn no_rain_falls_out_of_a_clear_sky() {
    let corners = [[-4000.0, -1500.0], [4000.0, -1500.0], [4000.0, 1500.0], [-4000.0, 1500.0]];
    let mut all = [[0.0; 2]; 8];
    all[..4].copy_from_slice(&corners);
    let shapes = [AreaShape::Ellipse([4000.0, 2000.0]), AreaShape::Polygon(all, 4)];
    let tower = CloudLayer::of(CloudKind::Cumulonimbus, 0.1, 1200.0);
    let heaps = CloudLayer::of(CloudKind::Cumulus, 0.2, 1200.0);
    for (clouds, kind) in [
        (vec![], AreaRain::Showers),
        (vec![heaps], AreaRain::Rain),
        (vec![heaps, tower], AreaRain::Showers),
        (vec![], AreaRain::Drizzle),
    ] {
        for shape in shapes {
            let mut sky = Sky::new(CLEAR, CloudModel::Volume);
            let weather = Weather { clouds: clouds.clone(), ..Weather::default() };
            sky.context.set_weather(&weather, 0.0, 0.0).unwrap();
            let beside = |sky: &Sky| places().map(|(x, y)| up(sky, x + 30e3, y)).collect::<Vec<_>>();
            let before = beside(&sky);
            let area = RainArea { shape, kind, heading_deg: 30.0, ..RainArea::default() };
            sky.context.set_rain_areas(&[area]).unwrap();
            let rates = |(x, y): (f64, f64)| sky.context.rain_at(DVec3::new(x, y, 2.0), 0.0).unwrap().rate_mm_h;
            let wet: Vec<f64> = places().filter(|p| rates(*p) > 0.1).map(|(x, y)| up(&sky, x, y)).collect();
            let worst = wet.iter().fold(0.0, |most: f64, t| most.max(*t));
            println!("{} layers, {kind:?}: {} wet places, at most {worst:.1e} comes through", clouds.len(), wet.len());
            assert!(wet.len() > 10 && worst < 0.05, "{worst}");
            assert_eq!(beside(&sky), before, "beside nothing changes");
            // An area without rain brings no cloud.
            sky.context.set_rain_areas(&[RainArea { rate_mm_h: 0.0, ..area }]).unwrap();
            assert_eq!(beside(&sky), before);
        }
    }
}

#[test]
fn clouds_over_rain_are_drawn_as_they_are_asked() {
    let mut sky = Sky::new(BROKEN, CloudModel::Volume);
    let shape = AreaShape::Ellipse([2500.0, 1500.0]);
    let area = RainArea { center_m: [0.0, 9000.0, 0.0], shape, top_m: 1500.0, rate_mm_h: 0.1, ..RainArea::default() };
    sky.context.set_rain_areas(&[area]).unwrap();
    let forward = DVec3::new(0.0, 1.0, 0.2);
    let mut off: Vec<f64> = drawn_over_asked(&mut sky, forward, 2.0).iter().map(|ratio| (ratio - 1.0).abs()).collect();
    off.sort_by(f64::total_cmp);
    let [half, most] = [50, 85].map(|percent| off[off.len() * percent / 100]);
    println!("pictures off by {half:.4} in the median, {most:.3} at 85 %");
    assert!(half < 0.02 && most < 0.15, "{half} {most}");
}

/// Returns how far cloud reaches from the middle of a thunderstorm between two heights, in sixteen directions, m.
fn reaches_m(sky: &Sky, heights_m: [f64; 2]) -> [f64; 16] {
    let has_cloud = |x: f64, y: f64| {
        let [low, high] = heights_m.map(|z| DVec3::new(x, y, z));
        sky.context.between(low, high, 0.0).unwrap().transmittance[1] < 0.5
    };
    std::array::from_fn(|k| {
        let (sine, cosine) = (k as f64 * std::f64::consts::FRAC_PI_8).sin_cos();
        let steps = (0..100).rev().map(|i| 100.0 * f64::from(i));
        steps.into_iter().find(|r| has_cloud(r * cosine, r * sine)).unwrap_or(0.0)
    })
}

/// Returns the mean of [`reaches_m`] over the directions.
fn reach_m(sky: &Sky, heights_m: [f64; 2]) -> f64 {
    reaches_m(sky, heights_m).iter().sum::<f64>() / 16.0
}

#[test]
fn the_anvil_of_a_thunderstorm_is_wider_than_its_towers() {
    let mut sky = Sky::new(CLEAR, CloudModel::Volume);
    let shape = AreaShape::Ellipse([4000.0; 2]);
    let kind = AreaRain::Showers;
    let storm = RainArea { shape, kind, rate_mm_h: 40.0, top_m: 1500.0, ..RainArea::default() };
    sky.context.set_rain_areas(&[storm]).unwrap();
    // Heights of the towers, and of the anvil below the top.
    let [tower, anvil] = [[4000.0, 5500.0], [8000.0, 9000.0]].map(|heights| reach_m(&sky, heights));
    println!("towers reach {tower:.0} m from the middle, the anvil {anvil:.0} m");
    assert!(tower > 3500.0 && anvil > 1.15 * tower, "{tower} {anvil}");
    // The sides of the storm bulge instead of hanging straight down.
    let sides: Vec<_> = (0..8).map(|i| reaches_m(&sky, [3000.0, 3200.0].map(|h| h + 500.0 * f64::from(i)))).collect();
    let steps = sides.windows(2).flat_map(|two| (0..16).map(|k| (two[1][k] - two[0][k]).abs()));
    let bulges = steps.sum::<f64>() / (16 * 7) as f64;
    println!("half a kilometre higher its sides lie {bulges:.0} m farther in or out");
    assert!(bulges > 250.0, "{bulges}");
}

#[test]
fn light_near_a_storm_is_that_of_its_sky() {
    let mut sky = Sky::new(CLEAR, CloudModel::Volume);
    sky.context.set_sun(Some(GivenDirection { azimuth_deg: 200.0, elevation_deg: 50.0 })).unwrap();
    for (kind, half_m) in [(AreaRain::Showers, 4000.0), (AreaRain::Rain, 8000.0)] {
        let shape = AreaShape::Ellipse([half_m; 2]);
        let area = RainArea { shape, kind, rate_mm_h: 0.1, top_m: 1200.0, ..RainArea::default() };
        sky.context.set_rain_areas(&[area]).unwrap();
        let (mut worst, mut before) = (0.0f64, None);
        for share in [0.0, 0.5, 0.8, 1.0, 1.2, 1.5, 2.0, 4.0] {
            let place = DVec3::new(share * half_m, 0.0, 2.0);
            let light = sky.context.light_at(place, 0.0).unwrap();
            let (sky_lux, direct) = (luminance(&light.arriving.sky_lux), light.sun.direct_share);
            let off = sky_lux / seen_lux(&sky.context, place, (12, 24)) - 1.0;
            println!("{kind:?}, {share} of its half width off: {sky_lux:.0} lux, off by {off:+.2}; direct {direct:.3}");
            worst = worst.max(off.abs());
            assert!(before.is_none_or(|before| before < direct), "less of the cloud is overhead");
            before = Some(direct);
        }
        assert!(worst < 0.25, "{worst}");
    }
    // Far away nothing changes.
    let place = DVec3::new(300e3, 0.0, 2.0);
    let lux = |sky: &Sky| sky.context.light_at(place, 0.0).unwrap().arriving.total_lux;
    let with = lux(&sky);
    sky.context.set_rain_areas(&[]).unwrap();
    assert!((with / lux(&sky) - 1.0).abs() < 1e-2, "{with}");
}

/// The cloud moves with the same wind as its rain area.
#[test]
fn a_cloud_goes_with_its_rain() {
    let mut sky = Sky::new(CLEAR, CloudModel::Volume);
    let motion = AreaMotion::Own([2.0, 0.0]);
    sky.context.set_rain_areas(&[RainArea { motion, ..RainArea::default() }]).unwrap();
    let share = |x: f64, t: f64| sky.context.sun_share(DVec3::new(x, 0.0, 1400.0), t).unwrap();
    assert!(share(0.0, 0.0) < 0.01 && share(12e3, 0.0) == 1.0, "{} {}", share(0.0, 0.0), share(12e3, 0.0));
    assert!(share(0.0, 6000.0) == 1.0 && share(12e3, 6000.0) < 0.01);
}

/// The OpenGL driver draws the cells that the Vulkan one draws.
#[test]
fn both_drivers_draw_the_same_cell() {
    let area = RainArea { center_m: [0.0, 9000.0, 0.0], rate_mm_h: 0.1, ..RainArea::default() };
    for (name, report, areas, map) in [
        ("neither", BROKEN, vec![], None),
        ("a map", BROKEN, vec![], Some(half())),
        ("an area", CLEAR, vec![area], None),
    ] {
        let pictures = [DeviceOptions::default().backends, wgpu::Backends::GL].map(|backends| {
            let options = DeviceOptions { backends, force_tier0: true, ..DeviceOptions::default() };
            let mut sky = Sky::on(&options, report, CloudModel::Volume);
            sky.context.set_rain_areas(&areas).unwrap();
            sky.context.set_cloud_map(map.clone()).unwrap();
            sky.look(DVec3::new(0.0, 1.0, 0.2), 2.0, None, FrameFlags::NO_HISTORY)
        });
        let off = p95(&pictures[0], &pictures[1]);
        println!("{name}: the drivers are {off:.4} apart at 95 %");
        assert!(off < 0.01, "{name}: {off}");
    }
}
