//! Answers about the environment against the table of rules, written out here in another form: at 100 places, in a
//! world with layers, in regions alone, merged and one over the other, in perimeters and in transitions.

use crate::common::{Random, message, packets, rain, region, request};
use welkin_cigi_host::geodesy::Place;
use welkin_cigi_host::session::Session;
use welkin_cigi_host::site::Site;
use welkin_cigi_host::wire::{
    AtmosphereControl, EnvironmentalRegionControl, MaritimeSurfaceConditionsControl, Order, Packet,
    TerrestrialSurfaceConditionsControl, Version, WeatherControl,
};
use welkin_cigi_host::world::Groundless;

/// A layer of the table: number, base, thickness, transition, temperature, humidity, visibility, wind, from, pressure,
/// aerosol.
type Row = (u8, [f64; 10]);

/// A region of the table: centre, sizes, corner, rotation, perimeter, merged or not, its layers, in the order of
/// arrival.
struct Shape {
    id: u16,
    centre: [f64; 2],
    size: [f64; 2],
    corner: f64,
    rotation: f64,
    perimeter: f64,
    is_merged: bool,
    layers: &'static [Row],
}

const AIR: [f64; 6] = [12.0, 70.0, 15_000.0, 6.0, 250.0, 1008.0];
const GLOBAL: &[Row] = &[
    (0, [0.0, 120.0, 30.0, 9.0, 100.0, 500.0, 1.0, 30.0, 1007.0, 0.25]),
    (2, [1500.0, 800.0, 200.0, -2.0, 95.0, 120.0, 20.0, 290.0, 830.0, 0.5]),
];
const REGIONS: &[Shape] = &[
    Shape {
        id: 9,
        centre: [43.4, 5.1],
        size: [6000.0, 4000.0],
        corner: 1000.0,
        rotation: 20.0,
        perimeter: 1500.0,
        is_merged: true,
        layers: &[(4, [0.0, 900.0, 40.0, 7.0, 96.0, 2500.0, 11.0, 200.0, 1006.0, 0.75])],
    },
    Shape {
        id: 2,
        centre: [43.42, 5.14],
        size: [5000.0, 5000.0],
        corner: 2500.0,
        rotation: -30.0,
        perimeter: 2000.0,
        is_merged: true,
        layers: &[
            (0, [0.0, 300.0, 50.0, 5.0, 99.0, 200.0, 0.5, 90.0, 1005.0, 0.125]),
            (5, [100.0, 1900.0, 100.0, -1.0, 90.0, 900.0, 14.0, 340.0, 990.0, 0.375]),
        ],
    },
    Shape {
        id: 5,
        centre: [43.38, 5.16],
        size: [7000.0, 2500.0],
        corner: 0.0,
        rotation: 75.0,
        perimeter: 800.0,
        is_merged: false,
        layers: &[(9, [0.0, 1600.0, 500.0, 30.0, 10.0, 700.0, 22.0, 120.0, 1001.0, 2.0])],
    },
];

fn weather(scope: u8, id: u16, row: &Row) -> WeatherControl {
    let (layer_id, [base, thickness, band, temperature, humidity, visibility, wind, from, pressure, aerosol]) = *row;
    WeatherControl {
        scope,
        entity_or_region_id: id,
        layer_id,
        weather_enable: true,
        humidity_percent: humidity as u8,
        air_temperature_c: temperature as f32,
        visibility_m: visibility as f32,
        transition_band_m: band as f32,
        bottom_transition_m: band as f32,
        top_transition_m: band as f32,
        base_elevation_m: base as f32,
        thickness_m: thickness as f32,
        horizontal_wind_mps: wind as f32,
        wind_from_deg: from as f32,
        pressure_hpa: pressure as f32,
        aerosol_g_m3: aerosol as f32,
        ..WeatherControl::default()
    }
}

fn world() -> Vec<Packet> {
    let [temperature, humidity, visibility, wind, from, pressure] = AIR;
    let air = AtmosphereControl {
        humidity_percent: humidity as u8,
        air_temperature_c: temperature as f32,
        visibility_m: visibility as f32,
        horizontal_wind_mps: wind as f32,
        wind_from_deg: from as f32,
        pressure_hpa: pressure as f32,
        ..AtmosphereControl::default()
    };
    let mut all: Vec<Packet> = vec![air.into()];
    all.extend(GLOBAL.iter().map(|row| Packet::from(weather(0, 0, row))));
    for shape in REGIONS {
        let flag = u8::from(shape.is_merged);
        all.push(
            EnvironmentalRegionControl {
                region_id: shape.id,
                region_state: 1,
                merge_weather: flag,
                merge_aerosol: flag,
                latitude_deg: shape.centre[0],
                longitude_deg: shape.centre[1],
                size_x_m: shape.size[0] as f32,
                size_y_m: shape.size[1] as f32,
                corner_radius_m: shape.corner as f32,
                rotation_deg: shape.rotation as f32,
                transition_perimeter_m: shape.perimeter as f32,
                ..EnvironmentalRegionControl::default()
            }
            .into(),
        );
        all.extend(shape.layers.iter().map(|row| Packet::from(weather(1, shape.id, row))));
    }
    all
}

/// Weight of a region: by the nearest point of the rectangle that is smaller by the corner's radius.
fn region_weight(shape: &Shape, place: [f64; 3]) -> f64 {
    let (a, e2) = (6_378_137.0f64, 0.006_694_379_990_14);
    let w = 1.0 - e2 * shape.centre[0].to_radians().sin().powi(2);
    let north = (place[0] - shape.centre[0]).to_radians() * a * (1.0 - e2) / w.powf(1.5);
    let east = (place[1] - shape.centre[1]).to_radians() * a / w.sqrt() * shape.centre[0].to_radians().cos();
    let angle = shape.rotation.to_radians();
    let (x, y) = (north * angle.cos() + east * angle.sin(), -north * angle.sin() + east * angle.cos());
    let half = shape.size.map(|size| size / 2.0 - shape.corner);
    let near = (x.clamp(-half[0], half[0]), y.clamp(-half[1], half[1]));
    let outside = ((x - near.0).powi(2) + (y - near.1).powi(2)).sqrt() - shape.corner;
    if outside <= 0.0 { 1.0 } else { (1.0 - outside / shape.perimeter).max(0.0) }
}

fn layer_weight(row: &Row, altitude: f64) -> f64 {
    let [base, thickness, band, ..] = row.1;
    let beyond = (base - altitude).max(altitude - base - thickness).max(0.0);
    (1.0 - beyond / band).max(0.0)
}

/// Temperature, humidity, pressure, wind to the east and north, extinction.
fn quantities(t: f64, h: f64, p: f64, wind: [f64; 2], visibility: f64) -> [f64; 6] {
    let from = wind[1].to_radians();
    [t, h, p, -wind[0] * from.sin(), -wind[0] * from.cos(), 1.0 / visibility]
}

fn layer_quantities(row: &Row) -> [f64; 6] {
    let [_, _, _, t, h, v, wind, from, p, _] = row.1;
    quantities(t, h, p, [wind, from], v)
}

/// Layers over the atmosphere: means by weight as far as the strongest layer, and extinctions that add up.
fn layered(layers: &[(f64, &Row)]) -> [f64; 6] {
    let [t, h, v, wind, from, p] = AIR;
    let air = quantities(t, h, p, [wind, from], v);
    let strongest = layers.iter().map(|l| l.0).fold(0.0, f64::max);
    let total: f64 = layers.iter().map(|l| l.0).sum();
    let mut out = air;
    for i in 0..5 {
        let sum: f64 = layers.iter().map(|(w, row)| w * layer_quantities(row)[i]).sum();
        if total > 0.0 {
            out[i] = air[i] * (1.0 - strongest) + sum / total * strongest;
        }
    }
    out[5] += layers.iter().map(|(w, row)| w * (layer_quantities(row)[5] - air[5]).max(0.0)).sum::<f64>();
    out
}

/// Values of regions in the order of arrival over what is below: weight, merged or not, value.
fn over<const N: usize>(below: [f64; N], regions: &[(f64, bool, [f64; N])]) -> [f64; N] {
    let share = |i: usize| {
        let later = regions[i + 1..].iter().filter(|r| !r.1);
        regions[i].0 * later.map(|r| 1.0 - r.0).product::<f64>()
    };
    let bare: f64 = regions.iter().map(|r| 1.0 - r.0).product();
    let total: f64 = (0..regions.len()).map(share).sum();
    let mut out = below;
    for (k, value) in out.iter_mut().enumerate().filter(|_| total > 0.0) {
        let mean = (0..regions.len()).map(|i| share(i) * regions[i].2[k]).sum::<f64>() / total;
        *value = bare * *value + (1.0 - bare) * mean;
    }
    out
}

fn expected_air(place: [f64; 3]) -> [f64; 6] {
    let global: Vec<(f64, &Row)> = GLOBAL.iter().map(|row| (layer_weight(row, place[2]), row)).collect();
    let mut regions = Vec::new();
    for shape in REGIONS {
        let own: Vec<(f64, &Row)> = shape.layers.iter().map(|row| (layer_weight(row, place[2]), row)).collect();
        let strongest = own.iter().map(|l| l.0).fold(0.0, f64::max);
        let weight = region_weight(shape, place) * strongest;
        if weight > 0.0 {
            let mut layers: Vec<(f64, &Row)> = own.iter().map(|(w, row)| (w / strongest, *row)).collect();
            layers.extend(global.iter().filter(|(_, row)| shape.layers.iter().all(|own| own.0 != row.0)));
            regions.push((weight, shape.is_merged, layered(&layers)));
        }
    }
    over(layered(&global), &regions)
}

fn expected_aerosols(place: [f64; 3]) -> Vec<(u8, f64)> {
    let amount = |row: &Row| row.1[9] * layer_weight(row, place[2]);
    let mut found = Vec::new();
    for id in 0..=9 {
        let of = |rows: &'static [Row]| rows.iter().find(|row| row.0 == id);
        let own = REGIONS.iter().filter_map(|s| Some((region_weight(s, place), s.is_merged, [amount(of(s.layers)?)])));
        let own: Vec<(f64, bool, [f64; 1])> = own.filter(|part| part.0 > 0.0).collect();
        let global = of(GLOBAL).map_or(0.0, amount);
        if global > 0.0 || own.iter().any(|part| part.2[0] > 0.0) {
            found.push((id, over([global], &own)[0]));
        }
    }
    found
}

#[test]
fn weather_and_particles_are_those_of_the_table_at_100_places() {
    let mut session = Session::new(Site::default(), Version::V4_0, Order::Big);
    session.receive(&message(Version::V4_0, Order::Big, 1, &world())).expect("a good message");
    let mut random = Random(47);
    let mut kinds = [0; 4];
    for i in 0..100 {
        let altitude = [20.0, 600.0, 1700.0, 2400.0][i % 4] + random.between(0.0, 150.0);
        let place = [random.between(43.35, 43.46), random.between(5.03, 5.23), altitude];
        let weights: Vec<f64> = REGIONS.iter().map(|s| region_weight(s, place)).collect();
        kinds[0] += usize::from(weights.iter().all(|w| *w == 0.0));
        kinds[1] += usize::from(weights.contains(&1.0));
        kinds[2] += usize::from(weights.iter().filter(|w| **w > 0.0).count() > 1);
        kinds[3] += usize::from(weights.iter().any(|w| (0.01..0.99).contains(w)));
        let asked = Place { latitude_deg: place[0], longitude_deg: place[1], altitude_m: place[2] };
        session.receive(&message(Version::V4_0, Order::Big, 2, &[request(i as u8, 12, asked).into()])).expect("good");
        let answers = packets(session.frame(0, &mut Groundless::default()));
        let Packet::WeatherConditionsResponse(air) = answers[1] else { panic!("{answers:?}") };
        let [t, h, p, east, north, extinction] = expected_air(place);
        let from = (-east).atan2(-north).to_degrees().rem_euclid(360.0);
        let wanted = [t, 1.0 / extinction, east.hypot(north), from, p];
        let got =
            [air.air_temperature_c, air.visibility_m, air.horizontal_wind_mps, air.wind_from_deg, air.pressure_hpa];
        for (wanted, got) in wanted.into_iter().zip(got) {
            let scale = wanted.abs().max(1.0);
            assert!((wanted - f64::from(got)).abs() < 1e-6 * scale, "{place:?}: {wanted} {got}");
        }
        assert_eq!((air.request_id, air.humidity_percent), (i as u8, h.round() as u8));
        let particles: Vec<(u8, f64)> = answers[2..]
            .iter()
            .map(|answer| match answer {
                Packet::AerosolConcentrationResponse(a) => (a.layer_id, f64::from(a.aerosol_g_m3)),
                other => panic!("{other:?}"),
            })
            .collect();
        let wanted = expected_aerosols(place);
        assert_eq!(particles.len(), wanted.len(), "{place:?}: {particles:?} {wanted:?}");
        for (a, b) in particles.iter().zip(&wanted) {
            assert!(a.0 == b.0 && (a.1 - b.1).abs() < 1e-6, "{place:?}: {particles:?} {wanted:?}");
        }
    }
    assert!(kinds.iter().all(|count| *count >= 10), "places outside, inside, in several, in perimeters: {kinds:?}");
}

#[test]
fn no_quantity_jumps_where_a_perimeter_or_a_transition_ends() {
    let mut session = Session::new(Site::default(), Version::V3_3, Order::Little);
    session.receive(&message(Version::V3_3, Order::Little, 1, &world())).expect("a good message");
    let mut random = Random(48);
    for _ in 0..40 {
        let mut ends =
            [0, 1].map(|_| [random.between(43.3, 43.5), random.between(5.0, 5.25), random.between(0.0, 3000.0)]);
        let at = |end: [f64; 3]| {
            let place = Place { latitude_deg: end[0], longitude_deg: end[1], altitude_m: end[2] };
            let air = session.state().air_at(place);
            let from = air.wind_from_deg.to_radians();
            [
                air.temperature_c,
                air.pressure_hpa / 10.0,
                air.wind_mps * from.sin(),
                air.wind_mps * from.cos(),
                1e3 / air.visibility_m,
            ]
        };
        // Halve the way towards the larger half of the difference: a jump remains, a slope vanishes.
        for _ in 0..40 {
            let middle = [0, 1, 2].map(|i| (ends[0][i] + ends[1][i]) / 2.0);
            let apart =
                |a: [f64; 3], b: [f64; 3]| at(a).iter().zip(at(b)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
            let is_first = apart(ends[0], middle) > apart(middle, ends[1]);
            ends[usize::from(is_first)] = middle;
        }
        let rest = at(ends[0]).iter().zip(at(ends[1])).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(rest < 1e-6, "a jump of {rest} at {:?}", ends[0]);
    }
}

#[test]
fn later_regions_win_unless_they_are_merged_and_inactive_ones_do_not_count() {
    let air = AtmosphereControl {
        air_temperature_c: 20.0,
        visibility_m: 2e4,
        pressure_hpa: 1000.0,
        ..AtmosphereControl::default()
    };
    let shape = |id, merge| EnvironmentalRegionControl { merge_weather: merge, ..region(id, 43.4, 5.1) };
    let layer = |id, celsius| WeatherControl { air_temperature_c: celsius, ..rain(1, id) };
    let place = Place { latitude_deg: 43.4, longitude_deg: 5.1, altitude_m: 50.0 };
    let temperature = |extra: &[Packet]| {
        let mut session = Session::new(Site::default(), Version::V3_3, Order::Little);
        let all = [&[air.into()], extra].concat();
        session.receive(&message(Version::V3_3, Order::Little, 1, &all)).expect("a good message");
        session.state().air_at(place).temperature_c
    };
    let (one, two) = (layer(1, 10.0), layer(2, 6.0));
    let off = |control: WeatherControl| WeatherControl { weather_enable: false, ..control };
    let state = |id, region_state| EnvironmentalRegionControl { region_state, ..shape(id, 0) };
    let cases: [(&[Packet], f64); 9] = [
        (&[shape(1, 0).into(), shape(2, 0).into(), one.into(), two.into()], 6.0),
        (&[shape(1, 0).into(), shape(2, 0).into(), two.into(), one.into()], 10.0),
        (&[shape(1, 1).into(), shape(2, 1).into(), one.into(), two.into()], 8.0),
        (&[shape(1, 0).into(), shape(2, 1).into(), one.into(), two.into()], 8.0),
        (&[shape(1, 1).into(), shape(2, 0).into(), one.into(), two.into()], 6.0),
        (&[shape(1, 0).into(), shape(2, 0).into(), one.into(), off(two).into()], 10.0),
        (&[shape(1, 0).into(), one.into(), state(1, 0).into()], 20.0),
        (&[shape(1, 0).into(), one.into(), state(1, 2).into(), state(1, 1).into()], 20.0),
        // Weather for a region that comes later is kept.
        (&[one.into(), shape(1, 0).into()], 10.0),
    ];
    for (i, (packets, wanted)) in cases.into_iter().enumerate() {
        assert!((temperature(packets) - wanted).abs() < 1e-9, "case {i}: {}", temperature(packets));
    }
}

#[test]
fn sea_and_ground_are_the_region_s_over_the_world_s() {
    let sea = |scope, id, height, enabled| MaritimeSurfaceConditionsControl {
        scope,
        entity_or_region_id: id,
        surface_conditions_enable: enabled,
        sea_surface_height_m: height,
        water_temperature_c: 10.0 * height,
        clarity_percent: 50.0,
        ..MaritimeSurfaceConditionsControl::default()
    };
    let ground = |scope, id, condition, enabled| TerrestrialSurfaceConditionsControl {
        scope,
        entity_or_region_id: id,
        surface_condition_id: condition,
        surface_condition_enable: enabled,
        severity: 9,
        coverage_percent: 40,
    };
    let shape = |id, merge| EnvironmentalRegionControl {
        merge_maritime: merge,
        merge_terrestrial: merge,
        ..region(id, 43.4, 5.1)
    };
    let inside = Place { latitude_deg: 43.4, longitude_deg: 5.1, altitude_m: 0.0 };
    let outside = Place { latitude_deg: 42.0, ..inside };
    let answers = |all: &[Packet], place: Place| {
        let mut session = Session::new(Site::default(), Version::V3_3, Order::Big);
        let asked = request(200, 3, place);
        session.receive(&message(Version::V3_3, Order::Big, 1, &[all, &[asked.into()]].concat())).expect("good");
        let answers = packets(session.frame(0, &mut Groundless::default()));
        let mut heights = Vec::new();
        let mut conditions = Vec::new();
        for answer in &answers[1..] {
            match answer {
                Packet::MaritimeSurfaceConditionsResponse(sea) => {
                    heights.push((sea.request_id, sea.sea_surface_height_m, sea.water_temperature_c))
                }
                Packet::TerrestrialSurfaceConditionsResponse(ground) => conditions.push(ground.surface_condition_id),
                other => panic!("{other:?}"),
            }
        }
        (heights, conditions)
    };
    let base: Vec<Packet> =
        vec![sea(0, 0, 1.0, false).into(), ground(0, 0, 7, true).into(), shape(1, 1).into(), shape(2, 1).into()];
    let with = |extra: &[Packet]| [&base[..], extra].concat();
    let both: &[Packet] = &[
        sea(1, 1, 2.0, true).into(),
        sea(1, 2, 4.0, true).into(),
        ground(1, 1, 3, true).into(),
        ground(1, 2, 5, true).into(),
    ];
    // The world's sea counts whether or not it is enabled; nothing said: as warm as the air, at least freezing.
    assert_eq!(answers(&[], inside), (vec![(200, 0.0, 0.0)], vec![0]));
    assert_eq!(answers(&base, inside), (vec![(200, 1.0, 10.0)], vec![7]));
    assert_eq!(answers(&with(both), outside), (vec![(200, 1.0, 10.0)], vec![7]));
    assert_eq!(answers(&with(both), inside), (vec![(200, 3.0, 30.0)], vec![3, 5]));
    let last: &[Packet] = &[shape(2, 0).into()];
    assert_eq!(answers(&[&with(both)[..], last].concat(), inside), (vec![(200, 4.0, 40.0)], vec![5]));
    let off: &[Packet] = &[sea(1, 2, 4.0, false).into(), ground(1, 2, 5, false).into()];
    assert_eq!(answers(&[&with(both)[..], off].concat(), inside), (vec![(200, 2.0, 20.0)], vec![3]));
    let dry: &[Packet] = &[ground(1, 1, 0, true).into(), ground(1, 2, 0, true).into()];
    assert_eq!(answers(&[&with(both)[..], dry].concat(), inside).1, vec![0]);
    let clear: &[Packet] = &[ground(0, 0, 0, true).into()];
    assert_eq!(answers(&[&base[..], clear].concat(), outside).1, vec![0]);
}

#[test]
fn zeros_with_a_sign_and_places_beyond_the_earth_are_answered_as_their_nearest() {
    let layer = WeatherControl {
        base_elevation_m: 1000.0,
        thickness_m: 100.0,
        transition_band_m: -0.0,
        bottom_transition_m: -0.0,
        top_transition_m: -0.0,
        ..rain(0, 0)
    };
    let edge = EnvironmentalRegionControl { transition_perimeter_m: -0.0, ..region(3, 43.4, 5.1) };
    let air = AtmosphereControl {
        air_temperature_c: 20.0,
        visibility_m: 2e4,
        pressure_hpa: 1e3,
        ..AtmosphereControl::default()
    };
    let all = [air.into(), layer.into(), edge.into(), WeatherControl { visibility_m: 50.0, ..rain(1, 3) }.into()];
    let mut session = Session::new(Site::default(), Version::V4_0, Order::Little);
    session.receive(&message(Version::V4_0, Order::Little, 1, &all)).expect("a good message");
    let mut visibility = |latitude_deg, longitude_deg, altitude_m| {
        let asked = request(1, 4, Place { latitude_deg, longitude_deg, altitude_m });
        session.receive(&message(Version::V4_0, Order::Little, 2, &[asked.into()])).expect("a good message");
        let answers = packets(session.frame(0, &mut Groundless::default()));
        match answers[1..] {
            [Packet::WeatherConditionsResponse(air)] => (Some(air.visibility_m), session.notes().iter().count()),
            [] => (None, session.notes().iter().count()),
            _ => panic!("{answers:?}"),
        }
    };
    assert_eq!(visibility(43.4, 5.1, 10.0), (Some(50.0), 0));
    assert_eq!(visibility(42.0, 5.1, 999.0), (Some(2e4), 0));
    assert_eq!(visibility(42.0, 5.1, 1000.0), (Some(3000.0), 0));
    assert_eq!(visibility(1e308, 5.1, 0.0), (Some(2e4), 1));
    assert_eq!(visibility(43.4, -1e308, 0.0), (Some(2e4), 2));
    assert_eq!(visibility(43.4, 365.1, 0.0), (Some(2e4), 2));
    assert_eq!(visibility(43.4, -354.9, 0.0), (Some(50.0), 2));
    assert_eq!(visibility(43.4, 5.1, f64::MAX), (Some(2e4), 3));
    assert_eq!(visibility(43.4, f64::NAN, 0.0), (None, 4));
}
