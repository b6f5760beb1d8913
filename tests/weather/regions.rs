//! Weather regions: the merged weather of places against a table written out here, and what holds at borders, along
//! ways, over time and after loading.

use glam::{DVec2, DVec3};
use welkin::{
    context::Context,
    rain::RainArea,
    regions::{MAX_REGION_CORNERS, MAX_WEATHER_REGIONS, RegionPlan, RegionShape, WeatherRegion},
    weather::{
        CloudKind, CloudLayer, Conditions, Fog, FogKind, Precipitation, PrecipitationKind, Weather, WeatherParts, Wind,
        derive,
    },
};

use super::host::{Dice, Host};

fn day() -> Weather {
    Weather { wind: Wind::of(6.0, 240.0), temperature_c: 12.0, ..Weather::default() }
}

/// Weathers of the regions of the table.
fn weathers() -> [Weather; 4] {
    let fog = Weather {
        visibility_m: 180.0,
        relative_humidity: 0.98,
        temperature_c: 4.0,
        fog: Fog::of(FogKind::Fog),
        ..Weather::default()
    };
    let snow = Weather {
        visibility_m: 900.0,
        temperature_c: -4.0,
        precipitation: Precipitation::of(PrecipitationKind::Snow, 2.5),
        wind: Wind::of(14.0, 350.0),
        ..Weather::default()
    };
    let storm = Weather {
        visibility_m: 3000.0,
        pressure_hpa: 988.0,
        temperature_c: 21.0,
        relative_humidity: 0.9,
        clouds: vec![CloudLayer::of(CloudKind::Cumulonimbus, 0.9, 700.0)],
        precipitation: Precipitation {
            hail: true,
            thunderstorm: true,
            ..Precipitation::of(PrecipitationKind::Rain, 40.0)
        },
        wind: Wind::of(22.0, 200.0),
        ..Weather::default()
    };
    let haze = Weather { visibility_m: 2500.0, temperature_c: 33.0, wind: Wind::of(3.0, 90.0), ..Weather::default() };
    [fog, snow, storm, haze]
}

/// Circle about (x, y) of a radius, with a perimeter.
fn circle(x: f64, y: f64, radius_m: f64, perimeter_m: f64) -> RegionPlan {
    RegionPlan {
        shape: RegionShape::Ellipse { half_m: [radius_m; 2] },
        center_m: [x, y, 0.0],
        perimeter_m,
        ..RegionPlan::default()
    }
}

/// Centres (x, y), radii and perimeters of the four circles of the table, m.
const CIRCLES: [[f64; 4]; 4] = [
    [0.0, 0.0, 3000.0, 800.0],
    [2500.0, 1000.0, 2500.0, 1500.0],
    [-1000.0, 3500.0, 2000.0, 600.0],
    [1500.0, -2500.0, 3500.0, 2000.0],
];

fn table(merges: WeatherParts) -> Vec<WeatherRegion> {
    let one = |(weather, [x, y, r, p]): (Weather, [f64; 4])| WeatherRegion {
        plan: circle(x, y, r, p),
        has: WeatherParts::ALL,
        merges,
        weather,
        ..WeatherRegion::default()
    };
    weathers().into_iter().zip(CIRCLES).map(one).collect()
}

/// Quantities that are sums of shares, as the table states them.
fn quantities(c: &Conditions) -> [f64; 16] {
    let f = &c.precipitation;
    [
        c.aerosol.extinction_per_m,
        c.fog.extinction_per_m,
        f.liquid_extinction_per_m,
        f.solid_extinction_per_m,
        f.rain_mm_h,
        f.snow_mm_h,
        f.hail_mm_h,
        f.thunder,
        c.air.temperature_c,
        c.air.relative_humidity,
        c.air.pressure_hpa,
        c.wind.east_m_s,
        c.wind.north_m_s,
        c.clouds.iter().map(|slab| slab.cover).sum(),
        c.surface.wetness,
        c.sea.significant_wave_height_m,
    ]
}

/// Weight of a circle at a distance from its centre: 1 inside, over the perimeter 1 - 3x^2 + 2x^3.
fn weight([x, y, r, p]: [f64; 4], at: DVec2) -> f64 {
    let out = (((at - DVec2::new(x, y)).length() - r) / p).clamp(0.0, 1.0);
    1.0 - out * out * (3.0 - 2.0 * out)
}

fn context(host: &Host, regions: &[WeatherRegion]) -> Context {
    let mut context = host.context();
    context.set_weather(&day(), 0.0, 0.0).unwrap();
    context.set_weather_regions(regions).unwrap();
    context
}

#[test]
fn the_merged_weather_is_that_of_the_table_at_a_hundred_places() {
    let host = Host::new();
    let base = quantities(&derive(&day()).unwrap());
    let own = weathers().map(|w| quantities(&derive(&w).unwrap()));
    let rayleigh = derive(&day()).unwrap().air.rayleigh_extinction_per_m;
    let (mut mixed, mut worst) = (0, 0.0f64);
    for merges in [false, true] {
        let context = context(&host, &table(if merges { WeatherParts::ALL } else { WeatherParts::NONE }));
        let mut dice = Dice(7);
        for _ in 0..100 {
            let mut coordinate = || dice.below(14_001) as f64 - 7000.0;
            let at = DVec2::new(coordinate(), coordinate());
            let w = CIRCLES.map(|c| weight(c, at));
            mixed += i32::from(w.iter().filter(|w| **w > 0.0 && **w < 1.0).count() > 1);
            let clear: f64 = w.iter().map(|w| 1.0 - w).product();
            let sum: f64 = w.iter().sum();
            let share = |k: usize| {
                if merges {
                    if sum > 0.0 { (1.0 - clear) * w[k] / sum } else { 0.0 }
                } else {
                    w[k] * w[k + 1..].iter().map(|w| 1.0 - w).product::<f64>()
                }
            };
            let got = context.conditions_at(at.extend(0.5), 0.0).unwrap();
            let found = quantities(&got);
            let mut want = base.map(|v| v * clear);
            for (k, own) in own.iter().enumerate() {
                for (want, own) in want.iter_mut().zip(own) {
                    *want += share(k) * own;
                }
            }
            for (i, (found, want)) in found.iter().zip(want).enumerate() {
                let off = (found - want).abs() / want.abs().max(1e-6);
                worst = worst.max(off);
                assert!(off < 1e-11, "quantity {i} at {at}, merging {merges}: {found} against {want}");
            }
            let whole = rayleigh + found[..4].iter().sum::<f64>();
            assert!((got.extinction_per_m / whole - 1.0).abs() < 1e-12, "extinctions add up at {at}");
        }
    }
    assert!(mixed >= 20, "{mixed} places lie in several perimeters");
    println!("largest difference from the table: {worst:e}");
}

/// No quantity changes in a millimetre by more than 2e-3 / P of the difference between its two sides.
#[test]
fn every_quantity_is_continuous_across_a_perimeter() {
    let host = Host::new();
    let mut corners_m = [[0.0; 2]; MAX_REGION_CORNERS];
    corners_m[..5].copy_from_slice(&[
        [-900.0, -700.0],
        [1000.0, -800.0],
        [300.0, 100.0],
        [900.0, 900.0],
        [-800.0, 600.0],
    ]);
    let shapes = [
        RegionShape::Rectangle { half_m: [1200.0, 500.0], corner_radius_m: 200.0 },
        RegionShape::Ellipse { half_m: [2000.0, 150.0] },
        RegionShape::Polygon { corners_m, count: 5 },
    ];
    let storm = weathers()[2].clone();
    for shape in shapes {
        for perimeter_m in [3.0, 700.0] {
            let plan = RegionPlan { shape, perimeter_m, heading_deg: 25.0, ..RegionPlan::default() };
            let region =
                WeatherRegion { plan, has: WeatherParts::ALL, weather: storm.clone(), ..WeatherRegion::default() };
            let context = context(&host, &[region]);
            let at = |p: DVec2| {
                let place = p.extend(1.0);
                let wind = context.wind_at(place, 0.0).unwrap().velocity_m_s;
                let rain = context.rain_at(place, 0.0).unwrap();
                let mut all = quantities(&context.conditions_at(place, 0.0).unwrap()).to_vec();
                all.extend([wind.x, wind.y, rain.rate_mm_h]);
                all
            };
            let (inside, outside) = (at(DVec2::ZERO), at(DVec2::new(9000.0, 9000.0)));
            let mut moved = 0;
            let is_cold = |p: DVec2| {
                let temperature_c = context.conditions_at(p.extend(1.0), 0.0).unwrap().air.temperature_c;
                (temperature_c - inside[8]).abs() > 0.5 * (outside[8] - inside[8]).abs()
            };
            for i in 0..9 {
                let along = DVec2::from_angle(f64::from(i) * 0.73);
                // The middle of the perimeter, by bisection.
                let (mut near_m, mut far_m) = (0.0, 9000.0);
                while far_m - near_m > 1e-3 {
                    let middle_m = 0.5 * (near_m + far_m);
                    if is_cold(along * middle_m) { far_m = middle_m } else { near_m = middle_m }
                }
                for part in -15..=15 {
                    let p = along * (near_m + 0.1 * f64::from(part) * perimeter_m);
                    let (a, b) = (at(p), at(p + along * 1e-3));
                    for (k, ((a, b), (inside, outside))) in
                        a.iter().zip(&b).zip(inside.iter().zip(&outside)).enumerate()
                    {
                        let most = 2e-3 / perimeter_m * (inside - outside).abs() + 1e-12 * inside.abs().max(1.0);
                        assert!((a - b).abs() <= most, "quantity {k} at {p}, {shape:?} {perimeter_m}: {a} to {b}");
                        moved += i32::from((a - b).abs() > 0.3 * most);
                    }
                }
            }
            assert!(moved > 200, "{shape:?} {perimeter_m}: only {moved} steps in the perimeter");
        }
    }
}

#[test]
fn without_perimeter_a_region_is_a_step_at_its_border() {
    let host = Host::new();
    let region = WeatherRegion {
        plan: circle(0.0, 0.0, 1000.0, 0.0),
        has: WeatherParts::TEMPERATURE,
        weather: Weather { temperature_c: -10.0, ..Weather::default() },
        ..WeatherRegion::default()
    };
    let context = context(&host, &[region]);
    let at = |x: f64| context.conditions_at(DVec3::new(x, 0.0, 0.0), 0.0).unwrap().air.temperature_c;
    assert_eq!([at(999.999), at(1000.0), at(1000.001)], [-10.0, -10.0, 12.0]);
}

/// Optical depth at 550 nm between two places.
fn depth(context: &Context, from: DVec3, to: DVec3) -> f64 {
    -context.between(from, to, 0.0).unwrap().transmittance[1].ln()
}

#[test]
fn visibility_through_two_regions_is_the_integral_of_the_extinction() {
    let host = Host::new();
    let [fog, snow, ..] = weathers();
    let bank = |x: f64, weather: &Weather, parts| WeatherRegion {
        plan: circle(x, 0.0, 400.0, 300.0),
        has: parts,
        weather: weather.clone(),
        ..WeatherRegion::default()
    };
    let parts = WeatherParts::VISIBILITY | WeatherParts::PRECIPITATION;
    let thin = Weather { visibility_m: 1500.0, ..fog };
    for merges in [WeatherParts::NONE, parts] {
        let mut second = bank(1500.0, &snow, parts);
        second.merges = merges;
        let mut third = bank(2000.0, &thin, parts);
        third.merges = merges;
        let context = context(&host, &[bank(0.0, &thin, parts), second, third]);
        for [a, b] in [[-2000.0, 4000.0], [0.0, 2000.0], [100.0, 300.0], [650.0, 1100.0], [-3000.0, -2000.0]] {
            for y in [0.0, 250.0] {
                let at = |x: f64| DVec3::new(x, y, 0.5);
                let steps = 4000;
                let step_m = (b - a) / f64::from(steps);
                let extinction = |i: i32| {
                    context.conditions_at(at(a + (f64::from(i) + 0.5) * step_m), 0.0).unwrap().extinction_per_m
                };
                let want = (0..steps).map(extinction).sum::<f64>() * step_m;
                let (there, back) = (depth(&context, at(a), at(b)), depth(&context, at(b), at(a)));
                assert!((there / want - 1.0).abs() < 2e-3, "{a} to {b} at {y}: {there} against {want}");
                assert!((there / back - 1.0).abs() < 1e-3, "{a} to {b} at {y}: {there} and back {back}");
            }
        }
    }
}

#[test]
fn a_bank_is_passed_over_and_a_slant_way_leaves_it_through_its_top() {
    let host = Host::new();
    let fog = Weather { visibility_m: 500.0, fog: Fog { top_m: Some(100.0), ..Fog::of(FogKind::Fog) }, ..day() };
    let region = WeatherRegion {
        plan: circle(0.0, 0.0, 3000.0, 500.0),
        has: WeatherParts::FOG,
        weather: fog.clone(),
        ..WeatherRegion::default()
    };
    let with = context(&host, &[region]);
    let without = context(&host, &[]);
    let mut everywhere = host.context();
    everywhere.set_weather(&fog, 0.0, 0.0).unwrap();
    let more = |a: DVec3, b: DVec3| depth(&with, a, b) - depth(&without, a, b);
    let [left, right] = [-8000.0, 8000.0].map(|x| DVec3::new(x, 0.0, 400.0));
    assert!(more(left, right).abs() < 1e-9, "over the bank");
    let straight_down = more(DVec3::new(0.0, 0.0, 2000.0), DVec3::new(0.0, 0.0, 1.0));
    let slant = more(DVec3::new(0.0, 0.0, 1.0), DVec3::new(4000.0, 0.0, 401.0));
    let fog_per_m = derive(&fog).unwrap().fog.extinction_per_m;
    assert!((0.6..1.0).contains(&(straight_down / (100.0 * fog_per_m))), "{straight_down}");
    let longer = f64::sqrt(4000.0 * 4000.0 + 400.0 * 400.0) / 400.0;
    assert!((slant / straight_down / longer - 1.0).abs() < 0.02, "{slant} against {straight_down}");
    let seen = with.visibility_toward(DVec3::new(0.0, 0.0, 1.0), DVec3::X, 0.0).unwrap();
    let own = everywhere.visibility_toward(DVec3::new(0.0, 0.0, 1.0), DVec3::X, 0.0).unwrap();
    assert!((seen / own - 1.0).abs() < 0.2, "{seen} against {own}");
}

#[test]
fn sixty_four_regions_move_and_the_next_is_refused() {
    let host = Host::new();
    let moving = |i: usize| WeatherRegion {
        plan: RegionPlan { velocity_m_s: [300.0, 0.0], at_s: 10.0, ..circle(0.0, 9000.0 * i as f64, 1000.0, 500.0) },
        has: WeatherParts::TEMPERATURE,
        weather: Weather { temperature_c: -0.5 * i as f64, ..Weather::default() },
        ..WeatherRegion::default()
    };
    let mut regions: Vec<_> = (0..MAX_WEATHER_REGIONS).map(moving).collect();
    let mut context = context(&host, &regions);
    for time_s in [10.0, 100.0, 4000.0] {
        for i in [0, 1, 40, 63] {
            let at = DVec3::new(300.0 * (time_s - 10.0), 9000.0 * i as f64, 2.0);
            assert_eq!(context.conditions_at(at, time_s).unwrap().air.temperature_c, -0.5 * i as f64);
            let beside = at + DVec3::X * 1600.0;
            assert_eq!(context.conditions_at(beside, time_s).unwrap().air.temperature_c, 12.0);
        }
    }
    regions.push(moving(64));
    let e = context.set_weather_regions(&regions).expect_err("one too many").to_string();
    assert!(e.contains("weather_regions must be at most 64"), "{e}");
    assert_eq!(context.weather_region_count(), 64);
}

/// One way to make a region invalid, and what the error must say.
type Spoil = (&'static str, fn(&mut WeatherRegion));

#[test]
fn bad_regions_are_refused_by_name_and_the_old_ones_stay() {
    let host = Host::new();
    let good = table(WeatherParts::NONE);
    let mut context = context(&host, &good);
    let before = context.save().unwrap();
    let spoils: [Spoil; 13] = [
        ("weather_regions[2].center_m", |r| r.plan.center_m[1] = f64::NAN),
        ("weather_regions[2].center_m", |r| r.plan.center_m[2] = -1e6),
        ("weather_regions[2].heading_deg", |r| r.plan.heading_deg = 361.0),
        ("weather_regions[2].perimeter_m", |r| r.plan.perimeter_m = -1.0),
        ("weather_regions[2].velocity_m_s", |r| r.plan.velocity_m_s[0] = 401.0),
        ("weather_regions[2].at_s", |r| r.plan.at_s = f64::INFINITY),
        ("weather_regions[2].strength", |r| r.plan.strength = 1.1),
        ("weather_regions[2].has", |r| r.has = WeatherParts(0x800)),
        ("weather_regions[2].merges", |r| r.merges = WeatherParts(1 << 31)),
        ("weather_regions[2].vertical_wind_m_s", |r| r.vertical_wind_m_s = f64::NAN),
        ("weather_regions[2].weather.visibility_m", |r| r.weather.visibility_m = f64::NAN),
        ("weather_regions[2].corner_radius_m must be in [0, 50]", |r| {
            r.plan.shape = RegionShape::Rectangle { half_m: [100.0, 50.0], corner_radius_m: 51.0 };
        }),
        ("weather_regions[2].corners_m", |r| {
            let mut corners_m = [[0.0; 2]; MAX_REGION_CORNERS];
            corners_m[1..4].copy_from_slice(&[[100.0, 100.0], [100.0, 0.0], [0.0, 150.0]]);
            r.plan.shape = RegionShape::Polygon { corners_m, count: 4 };
        }),
    ];
    for (wanted, spoil) in spoils {
        let mut regions = good.clone();
        spoil(&mut regions[2]);
        let e = context.set_weather_regions(&regions).expect_err(wanted).to_string();
        assert!(e.contains(wanted), "{wanted}: {e}");
        assert_eq!(context.save().unwrap(), before, "{wanted}");
    }
}

#[test]
fn regions_are_saved_hashed_and_equal_on_two_channels() {
    let host = Host::new();
    let mut regions = table(WeatherParts::WIND);
    regions[1].plan.velocity_m_s = [20.0, -7.0];
    regions[3].vertical_wind_m_s = -4.0;
    let (mut one, mut two) = (context(&host, &regions), context(&host, &regions));
    let plain = context(&host, &[]).state_hash().unwrap();
    for step in 1..=60 {
        one.update(f64::from(step)).unwrap();
    }
    two.update(60.0).unwrap();
    assert_eq!(one.state_hash().unwrap(), two.state_hash().unwrap());
    let mut loaded = host.context();
    loaded.load(&one.save().unwrap()).unwrap();
    assert_eq!(loaded.state_hash().unwrap(), one.state_hash().unwrap());
    for i in 0..50 {
        let at = DVec3::new(f64::from(i) * 150.0 - 3500.0, f64::from(i % 7) * 800.0 - 2400.0, f64::from(i));
        let all = |c: &Context| (c.conditions_at(at, 75.0).unwrap(), c.wind_at(at, 75.0).unwrap());
        assert_eq!(all(&one), all(&two), "{at}");
        assert_eq!(all(&one), all(&loaded), "{at}");
    }
    let changed = |change: fn(&mut WeatherRegion)| {
        let mut regions = regions.clone();
        change(&mut regions[1]);
        let mut context = context(&host, &regions);
        context.update(60.0).unwrap();
        context.state_hash().unwrap()
    };
    let changes: [fn(&mut WeatherRegion); 6] = [
        |r| r.plan.strength = 0.5,
        |r| r.plan.at_s = 1.0,
        |r| r.plan.shape = RegionShape::Rectangle { half_m: [2500.0; 2], corner_radius_m: 2500.0 },
        |r| r.has = WeatherParts::WIND,
        |r| r.merges = WeatherParts::NONE,
        |r| r.weather.temperature_c = -4.5,
    ];
    for (i, change) in changes.into_iter().enumerate() {
        assert!(![plain, one.state_hash().unwrap()].contains(&changed(change)), "change {i}");
    }
    two.set_weather_regions(&[]).unwrap();
    let mut without = context(&host, &[]);
    without.update(60.0).unwrap();
    assert_eq!(two.state_hash().unwrap(), without.state_hash().unwrap());
}

/// The air is displaced alike at every place, so that nothing that moves with it jumps at a border; the wind differs.
#[test]
fn the_wind_differs_by_place_and_the_displacement_does_not() {
    let host = Host::new();
    let gale = WeatherRegion {
        plan: circle(0.0, 0.0, 2000.0, 400.0),
        has: WeatherParts::WIND,
        weather: Weather { wind: Wind::of(25.0, 180.0), ..Weather::default() },
        vertical_wind_m_s: 6.0,
        ..WeatherRegion::default()
    };
    let (with, without) = (context(&host, &[gale]), context(&host, &[]));
    assert_eq!(with.wind_displacement(700.0).unwrap(), without.wind_displacement(700.0).unwrap());
    let (inside, outside) = (DVec3::new(0.0, 0.0, 10.0), DVec3::new(5000.0, 0.0, 10.0));
    let mean = with.wind_at(inside, 30.0).unwrap().mean_m_s;
    assert!((mean.y - 25.0).abs() < 1e-9 && mean.x.abs() < 1e-9, "{mean}");
    assert!((mean.z - 0.6).abs() < 1e-12, "a tenth of the way to 100 m: {mean}");
    assert_eq!(with.wind_at(inside + DVec3::Z * 490.0, 30.0).unwrap().mean_m_s.z, 6.0);
    assert_eq!(with.wind_at(outside, 30.0).unwrap(), without.wind_at(outside, 30.0).unwrap());
    let gusts: Vec<f64> = (0..300).map(|t| with.wind_at(inside, f64::from(t)).unwrap().velocity_m_s.y - 25.0).collect();
    let deviation = (gusts.iter().map(|g| g * g).sum::<f64>() / gusts.len() as f64).sqrt();
    let stated = with.wind_at(inside, 0.0).unwrap().gust_deviation_m_s;
    assert!((0.4..1.8).contains(&(deviation / stated)), "{deviation} against {stated}");
}

#[test]
fn a_region_far_away_changes_no_bit_and_rain_areas_stay_as_they_are() {
    let host = Host::new();
    let far = WeatherRegion {
        plan: circle(-90_000.0, 0.0, 3000.0, 3000.0),
        has: WeatherParts::ALL,
        weather: weathers()[1].clone(),
        ..WeatherRegion::default()
    };
    let area = RainArea { center_m: [3000.0, 0.0, 0.0], ..RainArea::default() };
    let [mut with, mut without] = [context(&host, &[far]), context(&host, &[])];
    for context in [&mut with, &mut without] {
        context.set_rain_areas(&[area]).unwrap();
    }
    for i in 0..40 {
        let at = DVec3::new(f64::from(i) * 200.0, 30.0, f64::from(i) * 3.0);
        let all = |c: &Context| {
            let between = c.between(at, DVec3::new(0.0, 9000.0, 50.0), 20.0).unwrap();
            let seen = c.visibility_toward(at, DVec3::X, 20.0).unwrap();
            let weather = (c.conditions_at(at, 20.0).unwrap(), c.wind_at(at, 20.0).unwrap());
            (weather, c.rain_at(at, 20.0).unwrap(), between, seen)
        };
        assert_eq!(all(&with), all(&without), "{at}");
    }
}
