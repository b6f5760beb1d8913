//! Rain areas: the rain at each place, the picture from outside, on the rim and inside, and that areas move and are
//! saved as the weather is.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    context::{Context, ContextDesc, GivenDirection},
    frame::{Shared, Stages},
    gpu::{Device, DeviceOptions},
    rain::{AreaMotion, AreaRain, AreaShape, MAX_CORNERS, RainArea, RainModel, RainSettings},
    rain::{RainSurface, drops::factor_in},
    scene::{Place, WorldFrame, WorldKind},
    weather::{CloudKind, CloudLayer, Precipitation, PrecipitationKind, Weather},
};
use welkin_support::rain_scene::Host;

use crate::pictures::{paint, save};

pub fn shower(north_m: f64, rate_mm_h: f64) -> RainArea {
    RainArea {
        center_m: [0.0, north_m, 0.0],
        shape: AreaShape::Ellipse([2200.0, 1500.0]),
        rim_m: 400.0,
        rate_mm_h,
        kind: AreaRain::Showers,
        motion: AreaMotion::Own([0.0, 0.0]),
        ..RainArea::default()
    }
}

pub fn square(half_m: f64) -> AreaShape {
    let mut corners = [[0.0; 2]; MAX_CORNERS];
    corners[..4].copy_from_slice(&[[-half_m, -half_m], [half_m, -half_m], [half_m, half_m], [-half_m, half_m]]);
    AreaShape::Polygon(corners, 4)
}

pub fn fair(wind_m_s: f64) -> Weather {
    let mut weather = Weather { visibility_m: 45_000.0, ..Weather::default() };
    (weather.wind.speed_m_s, weather.wind.from_deg) = (wind_m_s, 270.0);
    weather
}

pub fn host(weather: &Weather, areas: &[RainArea]) -> Host {
    let mut host = Host::new((160, 90));
    // These tests draw the rain alone; tests/clouds checks the cloud over an area.
    host.context.set_cloud_model(CloudModel::Deck);
    host.context.set_weather(weather, 0.0, 0.0).unwrap();
    host.context.set_rain_areas(areas).unwrap();
    host
}

fn rate(context: &Context, x: f64, y: f64) -> f64 {
    context.rain_at(DVec3::new(x, y, 0.0), context.time_s()).unwrap().rate_mm_h
}

/// Mean luminance over a part of the picture, whose bounds are shares of its width and height.
fn mean(host: &Host, [x0, y0, x1, y1]: [f64; 4]) -> f64 {
    let (w, h) = host.size;
    let at = |v: f64, n: u32| (v * f64::from(n)) as u32;
    let pixels = host.pixels();
    let (mut sum, mut count) = (0.0, 0.0);
    for y in at(y0, h)..at(y1, h) {
        for x in at(x0, w)..at(x1, w) {
            let p = pixels[(y * w + x) as usize];
            sum += 0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2]);
            count += 1.0;
        }
    }
    sum / count
}

#[test]
fn rates_are_those_of_the_place_and_half_in_the_middle_of_the_rim() {
    let steady = Weather { precipitation: Precipitation::of(PrecipitationKind::Rain, 3.0), ..fair(0.0) };
    let polygon = RainArea { shape: square(1500.0), ..shower(0.0, 23.0) };
    for area in [shower(0.0, 23.0), polygon] {
        let host = host(&steady, &[area]);
        let at = |y: f64| rate(&host.context, 0.0, y);
        for (y, want) in [(0.0, 23.0), (1099.0, 23.0), (1300.0, 13.0), (1500.1, 3.0), (9000.0, 3.0), (-1300.0, 13.0)] {
            assert!((at(y) / want - 1.0).abs() < 2e-3, "{y} m: {} mm/h, want {want}", at(y));
        }
        // The rate that lands on a level surface is the same, and the drawn ground is not drier than that rate makes
        // it.
        let surface = RainSurface {
            position: DVec3::new(0.0, 1300.0, 0.0),
            normal: DVec3::Z,
            velocity_m_s: DVec3::ZERO,
            area_m2: 1.0,
        };
        assert!((host.context.rain_on(&surface, 0.0).unwrap().rate_mm_h / 13.0 - 1.0).abs() < 2e-3);
        let ground = |y: f64| host.context.ground_at(DVec3::new(0.0, y, 0.0)).unwrap();
        assert!(ground(0.0).puddles > ground(1300.0).puddles && ground(1300.0).puddles > ground(3000.0).puddles);
        assert!(rate(&host.context, 0.0, 0.0) > 0.0);
        assert!(host.context.rain_at(DVec3::new(0.0, 0.0, 1600.0), 0.0).unwrap().rate_mm_h <= 3.001, "over its cloud");
    }
    // An area without rain, laid over the first.
    let host = host(&steady, &[shower(0.0, 23.0), RainArea { rate_mm_h: 0.0, ..shower(1800.0, 0.0) }]);
    assert_eq!(rate(&host.context, 0.0, 1800.0), 0.0);
    let mut last = rate(&host.context, 0.0, -3000.0);
    for i in -300..500 {
        let now = rate(&host.context, 0.0, f64::from(i) * 10.0);
        assert!((now - last).abs() < 1.0, "{} m: {last} to {now} mm/h in 10 m", i * 10);
        last = now;
    }
}

/// The conditions at a place report the rain there: in an area, on its rim and outside, under and above the clouds.
#[test]
fn conditions_of_a_place_are_those_of_the_rain_there() {
    // A visibility that leaves the rain all of its extinction.
    let precipitation = Precipitation::of(PrecipitationKind::Rain, 3.0);
    let steady = Weather { precipitation, visibility_m: 3000.0, ..fair(0.0) };
    let hail = Weather { precipitation: Precipitation::of(PrecipitationKind::Hail, 3.0), ..steady.clone() };
    for weather in [fair(0.0), steady, hail] {
        let drizzle = RainArea { kind: AreaRain::Drizzle, ..shower(1500.0, 2.0) };
        let (areas, dry) = (host(&weather, &[shower(0.0, 23.0), drizzle]), host(&weather, &[]));
        for (y, z) in [0.0, 1099.0, 1200.0, 1300.0, 1450.0, 1500.1, 2200.0, 2900.0, 9000.0, -1300.0]
            .into_iter()
            .flat_map(|y| [0.0, 700.0, 1300.0, 2500.0].map(|z| (y, z)))
        {
            let at = DVec3::new(0.0, y, z);
            let [(rain, c), (_, without)] = [&areas, &dry]
                .map(|h| (h.context.rain_at(at, 0.0).unwrap(), h.context.conditions_at(at, 0.0).unwrap()));
            let falls = &c.precipitation;
            let (rate, ice) = (falls.rain_mm_h + falls.drizzle_mm_h, falls.hail_mm_h + falls.ice_pellets_mm_h);
            assert!((rate - rain.rate_mm_h).abs() <= 1e-3 * rain.rate_mm_h, "{at}: {rate} {}", rain.rate_mm_h);
            assert!((ice - rain.ice_mm_h).abs() <= 1e-3 * rain.ice_mm_h, "{at}: {ice} {}", rain.ice_mm_h);
            // The weather's laws are fitted to drop sizes at sea level, within 0.5 % for each kind of rain and 3 % for
            // stones; in thinner air all drops and stones fall faster and are fewer.
            let faster = factor_in(&c.air, z) / factor_in(&c.air, 0.0);
            let truth = faster * (rain.extinction_per_m + rain.stone_extinction_per_m);
            let limit = 5e-3 * rain.extinction_per_m + 0.03 * rain.stone_extinction_per_m;
            assert!((falls.extinction_per_m() - truth).abs() <= limit, "{at}: {} {truth}", falls.extinction_per_m());
            let added = falls.extinction_per_m() - without.precipitation.extinction_per_m();
            let total = without.extinction_per_m + added;
            assert!((c.extinction_per_m / total - 1.0).abs() < 1e-9, "{at}: {} {total}", c.extinction_per_m);
            assert_eq!(c.visibility_m(), welkin::weather::LN_20 / c.extinction_per_m);
            // All other conditions are the weather's, and so are the parameters of a camera there.
            assert_eq!((c.air, c.aerosol, c.surface), (without.air, without.aerosol, without.surface));
            let scene = |h: &Host| h.context.scene_at(at, 0.0).unwrap().conditions;
            assert_eq!(scene(&areas), scene(&dry));
        }
    }
}

/// Rain also falls within the lower half of a low deck, for instance on a hill, a crane or a windscreen there.
#[test]
fn rain_falls_inside_of_a_low_deck_and_not_over_it() {
    for (kind, base_m, begins_m) in [
        (CloudKind::Stratus, 60.0, 250.0),
        (CloudKind::Stratus, 300.0, 450.0),
        (CloudKind::Nimbostratus, 600.0, 1100.0),
    ] {
        let precipitation = Precipitation::of(PrecipitationKind::Rain, 3.0);
        let weather = Weather { precipitation, clouds: vec![CloudLayer::of(kind, 1.0, base_m)], ..Weather::default() };
        let host = host(&weather, &[]);
        let rate = |z: f64| {
            let at = DVec3::new(0.0, 0.0, z);
            let (rain, c) = (host.context.rain_at(at, 0.0).unwrap(), host.context.conditions_at(at, 0.0).unwrap());
            assert!((c.precipitation.rain_mm_h - rain.rate_mm_h).abs() < 1e-3, "{z} m");
            rain.rate_mm_h
        };
        for z in [1.7, base_m, begins_m - 10.0] {
            assert!((rate(z) - 3.0).abs() < 0.01, "{kind:?} from {base_m} m: {} mm/h at {z} m", rate(z));
        }
        assert_eq!(rate(begins_m + 10.0), 0.0, "{kind:?} from {base_m} m");
    }
}

/// The query's closed form against the sum of what `rain_at` returns along the way.
#[test]
fn the_rain_between_two_points_is_the_sum_along_the_way() {
    // A visibility that leaves the rain all of its extinction.
    let precipitation = Precipitation::of(PrecipitationKind::Rain, 1.0);
    let steady = Weather { precipitation, visibility_m: 6000.0, ..fair(6.0) };
    for (weather, limit) in [(fair(6.0), 0.03), (steady, 0.05)] {
        let polygon =
            RainArea { shape: square(1200.0), center_m: [2300.0, 7000.0, 0.0], heading_deg: 20.0, ..shower(0.0, 12.0) };
        let host = host(&weather, &[shower(6500.0, 4.0), polygon]);
        let dry = super::areas::host(&weather, &[]);
        for (to, eye) in [([300.0, 9000.0, 500.0], 1.7), ([2000.0, 9000.0, 100.0], 1.7), ([0.0, 6500.0, 1.0], 900.0)] {
            let (from, to) = (DVec3::new(0.0, 0.0, eye), DVec3::from(to));
            let way = to - from;
            let n = 4000;
            let depth: f64 = (0..n)
                .map(|i| from + way * ((f64::from(i) + 0.5) / f64::from(n)))
                .map(|p| {
                    host.context.rain_at(p, 0.0).unwrap().extinction_per_m
                        - dry.context.rain_at(p, 0.0).unwrap().extinction_per_m
                })
                .sum::<f64>()
                * way.length()
                / f64::from(n);
            let through = |h: &Host| h.context.between(from, to, 0.0).unwrap().transmittance[1];
            let ratio = through(&host) / through(&dry);
            assert!(
                depth > 0.1 && (ratio / (-depth).exp() - 1.0).abs() < limit,
                "{to}: {ratio} for a depth of {depth}"
            );
        }
    }
}

/// Ways that are parallel to an area's bounds: along a side of its polygon, up and down, and over an area whose cloud
/// is lower than the weather's.
#[test]
fn the_rain_along_an_areas_sides_and_above_its_cloud_is_the_sum_along_the_way_too() {
    let precipitation = Precipitation::of(PrecipitationKind::Rain, 3.0);
    let clouds = vec![CloudLayer::of(CloudKind::Nimbostratus, 1.0, 1200.0)];
    let steady = Weather { precipitation, visibility_m: 3000.0, clouds, ..fair(0.0) };
    for (weather, top_m) in [(fair(0.0), 1500.0), (steady.clone(), 1500.0), (steady, 400.0)] {
        let area = RainArea { shape: square(500.0), top_m, rim_m: 100.0, ..shower(0.0, 50.0) };
        let (host, dry) = (host(&weather, &[area]), host(&weather, &[]));
        for (from, to) in [
            ([-800.0, 0.0, 2.0], [800.0, 0.0, 2.0]),
            ([800.0, 0.0, 2.0], [-800.0, 0.0, 2.0]),
            ([0.0, -800.0, 2.0], [0.0, 800.0, 2.0]),
            ([0.0, 800.0, 2.0], [0.0, -800.0, 2.0]),
            ([0.0, 0.0, 2.0], [0.0, 0.0, 700.0]),
            ([0.0, 0.0, 700.0], [0.0, 0.0, 2.0]),
            ([-700.0, 30.0, 600.0], [700.0, 30.0, 600.0]),
        ] {
            let (from, to) = (DVec3::from(from), DVec3::from(to));
            let n = 500;
            let extinction = |h: &Host, p| h.context.rain_at(p, 0.0).unwrap().extinction_per_m;
            let depth: f64 = (0..n)
                .map(|i| from.lerp(to, (f64::from(i) + 0.5) / f64::from(n)))
                .map(|p| extinction(&host, p) - extinction(&dry, p))
                .sum::<f64>()
                * (to - from).length()
                / f64::from(n);
            let through = |h: &Host| h.context.between(from, to, 0.0).unwrap().transmittance[1];
            let got = -(through(&host) / through(&dry)).ln();
            assert!(
                (got - depth).abs() < 0.02 + 0.03 * depth.abs(),
                "top {top_m}, {from} to {to}: {got}, want {depth}"
            );
        }
    }
    let clear = host(&fair(0.0), &[]);
    let above = clear.context.between(DVec3::Z * 130e3, DVec3::Z * 140e3, 0.0).unwrap();
    assert_eq!((above.transmittance[1], above.visibility_m), (1.0, f64::INFINITY));
}

/// An area without rain reduces the fog's extinction by that of rain, but not where the picture draws no rain.
#[test]
fn precipitation_drawn_alone_removes_no_light_that_was_not_drawn() {
    let precipitation = Precipitation::of(PrecipitationKind::Rain, 20.0);
    let weather = Weather { precipitation, visibility_m: 1500.0, ..fair(0.0) };
    let mut host = host(&weather, &[shower(3000.0, 0.0)]);
    host.look(DVec3::new(0.0, 0.0, 1.7), DVec3::new(0.0, 1.0, 0.05));
    let mut least = |stages: &[Stages]| {
        host.draw(|_, _| [0.0; 3]);
        stages.iter().for_each(|s| host.record(*s).unwrap());
        host.pixels().iter().flat_map(|p| p[..3].to_vec()).fold(f32::INFINITY, f32::min)
    };
    assert!(least(&[Stages::PREPARE.with(Stages::PARTICLES)]) >= 0.0);
    assert!(least(&[Stages::ALL.without(Stages::TONE)]) >= 0.0);
}

/// The drawn contrast of a white wall behind a shaft 5 km away is the one that the f64 integral gives.
#[test]
fn a_shaft_from_afar_takes_what_the_integral_says() {
    let mut host = Host::new((320, 180));
    host.context.set_weather(&fair(6.0), 0.0, 0.0).unwrap();
    host.look(DVec3::new(0.0, 0.0, 1.7), DVec3::new(0.0, 1.0, 0.08));
    host.boxes = vec![welkin_support::rain_scene::upright([0.0, 12_000.0, 900.0], [9000.0, 10.0, 1000.0])];
    let shown = |host: &mut Host, areas: &[RainArea], wall: f64| {
        host.context.set_rain_areas(areas).unwrap();
        host.draw(|_, _| [wall; 3]);
        host.record(Stages::PREPARE.with(Stages::MEDIUM).with(Stages::PARTICLES)).unwrap();
        host.pixels()
    };
    let beside =
        RainArea { center_m: [2600.0, 7500.0, 0.0], shape: square(1300.0), heading_deg: 20.0, ..shower(0.0, 4.0) };
    for areas in [vec![shower(6500.0, 4.0)], vec![shower(6500.0, 4.0), beside]] {
        let contrast = |host: &mut Host, areas: &[RainArea]| -> Vec<f64> {
            let (white, black) = (shown(host, areas, 30_000.0), shown(host, areas, 0.0));
            white.iter().zip(&black).map(|(b, a)| f64::from(b[1] - a[1])).collect()
        };
        let (clear, veiled) = (contrast(&mut host, &[]), contrast(&mut host, &areas));
        let (mut drawn, mut asked, mut worst, mut count) = (0.0, 0.0, 0.0f64, 0.0);
        for k in 0..600u32 {
            let (x, y) = (10 * (k % 32) + 3, 4 * (k / 32) + 30);
            let ndc = glam::DVec2::new((f64::from(x) + 0.5) / 160.0 - 1.0, 1.0 - (f64::from(y) + 0.5) / 90.0);
            let Some((p, _)) = host.cast(ndc).filter(|(p, _)| p.y > 9000.0) else { continue };
            let eye = host.camera.position;
            let with = host.context.between(eye, eye + p, 0.0).unwrap().transmittance[1];
            host.context.set_rain_areas(&[]).unwrap();
            let want = with / host.context.between(eye, eye + p, 0.0).unwrap().transmittance[1];
            host.context.set_rain_areas(&areas).unwrap();
            let at = (y * host.size.0 + x) as usize;
            let got = veiled[at] / clear[at];
            (drawn, asked, count) = (drawn + got, asked + want, count + 1.0);
            // The shaft's curtains make some pixels darker and some brighter.
            worst = worst.max((got - want).abs());
            assert!(want < 0.999 || (got - 1.0).abs() < 0.01, "{x} {y}: {got} beside the shaft");
        }
        assert!(asked / count < 0.8 && (drawn / asked - 1.0).abs() < 0.05, "{drawn} {asked} of {count}");
        assert!((0.02..0.3).contains(&worst), "{worst}");
    }
}

/// Sum of the drops' cover, drawn in a dark room where only they are bright.
fn brightness(host: &mut Host, position: DVec3, [x0, x1]: [f64; 2]) -> f64 {
    host.look(position, DVec3::Y);
    host.boxes = vec![welkin_support::rain_scene::upright([position.x, position.y + 12.0, 0.0], [60.0, 0.5, 60.0])];
    host.draw(|_, _| [0.0; 3]);
    host.record(Stages::PREPARE.with(Stages::PARTICLES)).unwrap();
    mean(host, [x0, 0.0, x1, 1.0])
}

#[test]
fn drops_fall_inside_half_of_them_in_the_middle_of_the_rim_and_none_outside() {
    let area = RainArea { shape: square(1500.0), rim_m: 1400.0, ..shower(0.0, 50.0) };
    // An even cloud layer: under the shower's own cloud drops would be brighter where less of it is overhead.
    let even = vec![CloudLayer::of(CloudKind::Nimbostratus, 1.0, 4000.0)];
    let mut host = host(&Weather { clouds: even, ..fair(0.0) }, &[area]);
    let eye = |x: f64| DVec3::new(x, 0.0, 2.0);
    let whole = [0.0, 1.0];
    let inside = brightness(&mut host, eye(0.0), whole);
    assert!(host.view.report().rain.drops > 0);
    let half = brightness(&mut host, eye(800.0), whole) / inside;
    assert!((half - 0.5).abs() < 0.06, "{half} of the drops in the middle of the rim");
    let outside = brightness(&mut host, eye(1600.0), whole) / inside;
    assert!(outside == 0.0 && host.view.report().rain.drops == 0, "{outside}");
    // At the border of an area with a narrow rim rain falls on one side only.
    host.context.set_rain_areas(&[RainArea { rim_m: 1.0, ..area }]).unwrap();
    let mut seen = Vec::new();
    for model in [RainModel::Drops, RainModel::Cones, RainModel::Automatic] {
        host.view.set_rain(RainSettings { model, ..RainSettings::default() }).unwrap();
        let inside = brightness(&mut host, eye(0.0), whole);
        let mut sides = |x: f64| [[0.0, 0.45], [0.55, 1.0]].map(|part| brightness(&mut host, eye(x), part) / inside);
        let [left, right] = sides(1500.0);
        assert!(left > 0.5 && right < 1e-3, "{model:?}: {left} {right} on the border");
        // From a dry place cones show the rain some metres away; from a place in the rain they show that it is dry some
        // metres away.
        let ([outside, _], [_, inside]) = (sides(1505.0), sides(1495.0));
        println!("{model:?}: {outside} from 5 m outside, {inside} from 5 m inside");
        seen.push((outside, inside));
    }
    // Beyond the drawn drops only the area's veil remains visible.
    for (outside, inside) in &seen[1..] {
        assert!((1.15..3.0).contains(&(outside / seen[0].0)) && *inside < 0.92, "{seen:?}");
    }
}

#[test]
fn a_camera_that_drives_through_the_rim_sees_no_jump() {
    let mut host = host(&fair(5.0), &[shower(0.0, 30.0)]);
    let mut shown = |y: f64| {
        host.look(DVec3::new(0.0, y, 1.7), DVec3::new(0.0, 1.0, 0.1));
        host.draw(|_, _| [600.0; 3]);
        host.record(Stages::PREPARE.with(Stages::BACKGROUND).with(Stages::MEDIUM).with(Stages::PARTICLES)).unwrap();
        (mean(&host, [0.0, 0.0, 1.0, 0.5]), mean(&host, [0.0, 0.6, 1.0, 1.0]))
    };
    let walk = |from: f64, step: f64, count: u32, shown: &mut dyn FnMut(f64) -> (f64, f64)| {
        let values: Vec<_> = (0..count).map(|i| shown(from + step * f64::from(i))).collect();
        let steps = values
            .windows(2)
            .map(|v| [(v[1].0 / v[0].0).ln().abs(), (v[1].1 / v[0].1).ln().abs()].into_iter().fold(0.0, f64::max));
        let all = (values[0].0 / values[values.len() - 1].0).ln().abs();
        (steps.fold(0.0, f64::max), all)
    };
    // From 1.5 km before the border to the middle in large steps, then in small steps where drops begin and where the
    // rim ends.
    let (most, all) = walk(-3000.0, 25.0, 120, &mut shown);
    assert!(all > 0.05 && most < 0.03, "{most} in 25 m, {all} in all");
    for from in [-1560.0, -1510.0, -1110.0] {
        let (most, _) = walk(from, 1.0, 40, &mut shown);
        assert!(most < 0.01, "{most} in 1 m behind {from}");
    }
}

#[test]
fn cameras_in_different_areas_see_each_its_own() {
    let areas = [shower(0.0, 50.0), RainArea { kind: AreaRain::Drizzle, rim_m: 900.0, ..shower(9000.0, 1.0) }];
    let places = [DVec3::new(0.0, 0.0, 2.0), DVec3::new(0.0, 7900.0, 2.0), DVec3::new(0.0, 4500.0, 2.0)];
    let alone: Vec<_> = places
        .iter()
        .map(|p| {
            let mut host = host(&fair(4.0), &areas);
            (brightness(&mut host, *p, [0.0, 1.0]), host.pixels())
        })
        .collect();
    assert!(alone[0].0 > 0.0 && alone[1].0 > 0.0 && alone[2].0 == 0.0);
    let mut together = host(&fair(4.0), &areas);
    for _ in 0..2 {
        for (place, (_, want)) in places.iter().zip(&alone) {
            brightness(&mut together, *place, [0.0, 1.0]);
            assert!(together.pixels() == *want, "{place}: not as seen alone");
        }
    }
}

fn set_moving_areas(context: &mut Context) {
    context.set_weather(&fair(9.0), 0.0, 0.0).unwrap();
    let mut turned = fair(14.0);
    turned.wind.from_deg = 190.0;
    context.set_weather(&turned, 20.0, 15.0).unwrap();
    let with_wind = |north: f64, at_s: f64| RainArea { motion: AreaMotion::WithWind, at_s, ..shower(north, 20.0) };
    context.set_rain_areas(&[with_wind(0.0, 0.0), with_wind(700.0, 30.0), shower(-900.0, 5.0)]).unwrap();
}

#[test]
fn areas_go_with_the_wind_the_same_way_in_any_steps_and_after_loading() {
    let make = || {
        let mut host = Host::new((16, 16));
        set_moving_areas(&mut host.context);
        host.context
    };
    let (mut at_once, mut in_steps, mut loaded) = (make(), make(), make());
    at_once.update(60.0).unwrap();
    for i in 1..=240 {
        in_steps.update(f64::from(i) * 0.25).unwrap();
        if i == 200 {
            loaded.load(&in_steps.save().unwrap()).unwrap();
        }
    }
    loaded.update(60.0).unwrap();
    let bits = |c: &Context| -> Vec<u64> {
        (0..60).map(|i| rate(c, f64::from(i) * 60.0, f64::from(i) * 45.0 - 1000.0).to_bits()).collect()
    };
    assert!(bits(&at_once).iter().any(|b| f64::from_bits(*b) > 0.0));
    assert_eq!(bits(&at_once), bits(&in_steps));
    assert_eq!(bits(&at_once), bits(&loaded));
    assert_eq!(at_once.state_hash().unwrap(), in_steps.state_hash().unwrap());
    assert_eq!(at_once.state_hash().unwrap(), loaded.state_hash().unwrap());
    // The centre has moved as far as the wind has carried the air; the rain round it is the same.
    let moved = at_once.wind_displacement(60.0).unwrap();
    let there = RainArea { center_m: moved.to_array(), ..shower(0.0, 20.0) };
    let mut host = host(&fair(0.0), &[there]);
    host.context.update(60.0).unwrap();
    let mut alone = make();
    alone.set_rain_areas(&[RainArea { motion: AreaMotion::WithWind, ..shower(0.0, 20.0) }]).unwrap();
    alone.update(60.0).unwrap();
    for i in 0..40 {
        let (x, y) = (f64::from(i) * 90.0 - 1800.0, f64::from(i) * 60.0 - 1200.0);
        let [want, got] = [&host.context, &alone].map(|c| rate(c, moved.x + x, moved.y + y));
        assert!((want - got).abs() < 1e-6, "{x} {y}: {got} mm/h, want {want}");
    }
    assert!(moved.length() > 300.0);
}

#[test]
fn bad_areas_are_named_and_leave_the_running_ones() {
    let mut host = host(&fair(0.0), &[shower(0.0, 20.0)]);
    let hash = host.context.state_hash().unwrap();
    let nan = f64::NAN;
    let star = {
        let mut c = [[0.0; 2]; MAX_CORNERS];
        for (i, c) in c.iter_mut().enumerate().take(5) {
            let (s, k) = (f64::from(i as u32) * 2.0 * std::f64::consts::TAU / 5.0).sin_cos();
            *c = [900.0 * s, 900.0 * k];
        }
        AreaShape::Polygon(c, 5)
    };
    let twice = {
        let mut c = [[0.0; 2]; MAX_CORNERS];
        for (i, c) in c.iter_mut().enumerate() {
            *c = [[-900.0, -900.0], [900.0, -900.0], [900.0, 900.0], [-900.0, 900.0]][i % 4];
        }
        AreaShape::Polygon(c, 8)
    };
    let flat = AreaShape::Polygon([[0.0; 2]; MAX_CORNERS], 4);
    let good = shower(0.0, 20.0);
    for (bad, name) in [
        (RainArea { shape: AreaShape::Ellipse([0.0, 500.0]), ..good }, "rain_areas[1].semi_axes_m"),
        (RainArea { shape: AreaShape::Ellipse([nan, 500.0]), ..good }, "rain_areas[1].semi_axes_m"),
        (RainArea { shape: flat, ..good }, "rain_areas[1].corners_m"),
        (RainArea { shape: star, ..good }, "rain_areas[1].corners_m"),
        (RainArea { shape: AreaShape::Polygon([[1.0; 2]; MAX_CORNERS], 9), ..good }, "rain_areas[1].corner_count"),
        (RainArea { shape: twice, ..good }, "rain_areas[1].corners_m"),
        (RainArea { shape: square(399.0), ..good }, "rain_areas[1].rim_m must be in [1, 399] m"),
        (RainArea { rim_m: 0.0, ..good }, "rain_areas[1].rim_m"),
        (RainArea { rim_m: 1501.0, ..good }, "rain_areas[1].rim_m"),
        (RainArea { rate_mm_h: -1.0, ..good }, "rain_areas[1].rate_mm_h"),
        (RainArea { rate_mm_h: nan, ..good }, "rain_areas[1].rate_mm_h"),
        (RainArea { rate_mm_h: f64::INFINITY, ..good }, "rain_areas[1].rate_mm_h"),
        (RainArea { center_m: [nan, 0.0, 0.0], ..good }, "rain_areas[1].center_m"),
        (RainArea { top_m: 1e6, ..good }, "rain_areas[1].top_m"),
        (RainArea { motion: AreaMotion::Own([0.0, 900.0]), ..good }, "rain_areas[1].velocity_m_s"),
        (RainArea { heading_deg: 1e3, ..good }, "rain_areas[1].heading_deg"),
        (RainArea { at_s: nan, ..good }, "rain_areas[1].at_s"),
    ] {
        let e = host.context.set_rain_areas(&[good, bad]).unwrap_err();
        assert!(e.to_string().contains(name), "{}", e);
        assert_eq!(host.context.state_hash().unwrap(), hash, "{name}: what ran has changed");
    }
    let e = host.context.set_rain_areas(&[good; 17]).unwrap_err();
    assert!(e.to_string().contains("16"), "{}", e);
    assert_eq!(host.context.rain_areas().len(), 1);
}

#[test]
fn pictures_of_a_shaft_from_afar_at_its_edge_and_inside() {
    let mut host = Host::new((640, 360));
    let mut weather = fair(7.0);
    for (sky, cloud, azimuth_deg) in [("clear", None, 220.0), ("facing", None, 20.0), ("overcast", Some(1.0), 140.0)] {
        weather.clouds = cloud.iter().map(|c| CloudLayer::of(CloudKind::Stratocumulus, *c, 1500.0)).collect();
        host.context.set_sun(Some(GivenDirection { azimuth_deg, elevation_deg: 25.0 })).unwrap();
        host.context.set_weather(&weather, 0.0, 0.0).unwrap();
        let mut means = Vec::new();
        for (place, away) in [("5km", 6500.0), ("edge", 1800.0), ("rim", 1250.0), ("inside", 0.0)] {
            host.context.set_rain_areas(&[RainArea { center_m: [600.0, away, 0.0], ..shower(0.0, 25.0) }]).unwrap();
            host.look(DVec3::new(0.0, 0.0, 1.7), DVec3::new(0.1, 1.0, 0.12));
            paint(&host);
            host.record(Stages::ALL).unwrap();
            save(&host, &format!("area_{sky}_{place}.png"));
            // The shaft against the sky beside it, just above the horizon.
            means.push((mean(&host, [0.45, 0.5, 0.6, 0.6]), mean(&host, [0.02, 0.5, 0.12, 0.6])));
        }
        let (shaft, beside) = means[0];
        assert!(
            sky == "facing" || shaft < 0.98 * beside,
            "{sky}: a shaft is darker than the sky that it hangs before: {shaft} {beside}"
        );
    }
}

/// The OpenGL driver, without compute shaders, draws the same as the Vulkan driver.
#[test]
fn both_drivers_draw_the_same_shaft_and_the_same_rim() {
    let mut beside = RainArea { center_m: [2600.0, 7500.0, 0.0], shape: square(1300.0), ..shower(0.0, 4.0) };
    beside.heading_deg = 20.0;
    let pictures: Vec<_> = [DeviceOptions::default().backends, wgpu::Backends::GL]
        .into_iter()
        .map(|backends| {
            let options = DeviceOptions { backends, force_tier0: true, ..DeviceOptions::default() };
            let mut host = Host::on(Device::headless(&options).unwrap(), (160, 90));
            host.context.set_weather(&fair(6.0), 0.0, 0.0).unwrap();
            let mut drawn = Vec::new();
            for north_m in [6500.0, 1300.0] {
                host.context.set_rain_areas(&[shower(north_m, 15.0), beside]).unwrap();
                host.look(DVec3::new(0.0, 0.0, 1.7), DVec3::new(0.0, 1.0, 0.1));
                host.draw(|_, _| [600.0; 3]);
                host.record(Stages::ALL).unwrap();
                drawn.push(host.pixels());
            }
            drawn
        })
        .collect();
    for (a, b) in pictures[0].iter().zip(&pictures[1]) {
        let off = |(a, b): (&[f32; 4], &[f32; 4])| f64::from((a[1] - b[1]).abs());
        let mean = a.iter().zip(b).map(off).sum::<f64>() / a.len() as f64;
        let apart = a.iter().zip(b).filter(|p| off(*p) > 0.02).count();
        assert!(mean < 2e-3 && apart < a.len() / 100, "{mean} on the mean, {apart} pixels");
    }
}

/// In Earth-centred coordinates an area lies on the curved ground, moves along it, and does not appear on the opposite
/// side of the Earth.
#[test]
fn areas_lie_on_a_round_planet_too() {
    let host = Host::new((16, 16));
    let world = WorldFrame { kind: WorldKind::Ecef, ..WorldFrame::default() };
    let shared = Arc::new(Shared::new(&host.device).unwrap());
    let desc = ContextDesc { world, ..ContextDesc::default() };
    let mut context = Context::new(host.device.clone(), shared, desc).unwrap();
    context.set_weather(&fair(0.0), 0.0, 0.0).unwrap();
    let place =
        |latitude_deg: f64, longitude_deg: f64| Place { latitude_deg, longitude_deg, altitude_m: 0.0 }.to_ecef();
    let start = place(48.0, 11.0);
    let area = RainArea { center_m: start.to_array(), motion: AreaMotion::Own([0.0, 20.0]), ..shower(0.0, 20.0) };
    let equator = RainArea { center_m: place(0.0, 11.0).to_array(), ..shower(0.0, 20.0) };
    context.set_rain_areas(&[area, equator]).unwrap();
    let rate = |at: DVec3, time_s: f64| context.rain_at(at, time_s).unwrap().rate_mm_h;
    assert!((rate(start, 0.0) - 20.0).abs() < 1e-3 && rate(place(48.03, 11.0), 0.0) == 0.0);
    // The area is 20 km to the north more than a quarter of an hour later.
    assert!(rate(start, 1000.0) == 0.0 && (rate(place(48.18, 11.0), 1000.0) - 20.0).abs() < 1e-3);
    assert!(rate(place(0.0, 11.0), 0.0) > 19.0);
    assert_eq!(rate(place(0.0, -169.0), 0.0), 0.0, "straight below it");
}
