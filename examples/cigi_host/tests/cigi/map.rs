//! The mapping from what the host has said to what Welkin's weather takes.

use crate::common::{captures, message, rain, region};
use welkin_cigi_host::capture::datagrams;
use welkin_cigi_host::map::{FogValues, Mapped, PrecipitationKind, WindValues, map};
use welkin_cigi_host::session::Session;
use welkin_cigi_host::site::{CloudKind, Site, SurfaceState};
use welkin_cigi_host::wire::{
    AtmosphereControl, CelestialSphereControl, ComponentControl, Order, Packet, Version, WaveControl, WeatherControl,
};

/// Returns the mapping after the first `count` datagrams of a capture.
fn after(name: &str, count: usize, site: &str) -> Mapped {
    let capture = captures().into_iter().find(|capture| capture.name == name).expect("the capture");
    let mut session = Session::new(Site::from_toml(site).expect("a table"), Version::V3_3, Order::Little);
    for bytes in datagrams(&capture.bytes).expect("whole datagrams").iter().take(count) {
        session.receive(bytes).expect("a good message");
    }
    map(session.state(), session.site())
}

fn of(packets: &[Packet], site: &str) -> Mapped {
    let mut session = Session::new(Site::from_toml(site).expect("a table"), Version::V3_3, Order::Little);
    session.receive(&message(Version::V3_3, Order::Little, 1, packets)).expect("a good message");
    map(session.state(), session.site())
}

/// Whether two numbers agree to the precision of a 32-bit one.
fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * b.abs().max(1.0)
}

#[test]
fn versions_and_orders_map_alike() {
    for (name, count) in [("01-clear-noon", 4), ("02-fog-300m", 3), ("04-heavy-rain", 2), ("11-overlapping-regions", 2)]
    {
        let one = after(&format!("{name}.v33-le"), count, "");
        assert_eq!(one, after(&format!("{name}.v33-be"), count, ""), "{name}");
        let four = after(&format!("{name}.v40-le"), count, "");
        assert_eq!(four, after(&format!("{name}.v40-be"), count, ""), "{name}: also by early ids");
        assert_eq!(one.global, four.global, "{name}");
    }
}

#[test]
fn a_clear_noon_is_air_and_a_clock() {
    let mapped = after("01-clear-noon.v40-be", 2, "station_altitude_m = 430\nhours_ahead_of_utc = 2");
    // 21 June 2026, 12:00, two hours ahead of UTC.
    assert_eq!(mapped.utc_s, Some((1_782_000_000.0 + 36_000.0, 1)));
    assert!(mapped.is_running && mapped.has_sun_moon_stars == [true; 3] && mapped.star_intensity == 0.0);
    let global = &mapped.global;
    assert_eq!((global.temperature_c, global.relative_humidity), (Some(24.0), Some(0.45)));
    assert_eq!((global.visibility_m, global.pressure_hpa), (Some(40_000.0), Some(1016.0)));
    assert_eq!(global.wind, Some(WindValues { speed_m_s: 2.0, from_deg: 270.0, is_gusty: false }));
    assert!(global.clouds.is_empty() && global.fog.is_none() && global.precipitation.is_none());
}

#[test]
fn a_ground_fog_is_total_visibility_with_the_air_above_it() {
    let mapped = after("02-fog-300m.v33-le", 1, "station_altitude_m = 100");
    let global = &mapped.global;
    assert_eq!(global.fog, Some(FogValues { top_m: 200.0, visibility_inside_m: 180.0, coverage: 1.0 }));
    assert!(near(global.visibility_m.expect("one"), 180.0), "{:?}", global.visibility_m);
    assert_eq!(global.temperature_c, Some(7.0));
    assert!(global.visibility_above_fog_m.expect("one") > 1000.0);
    assert!(mapped.left_out.iter().any(|note| note.field == "scud_frequency_percent"));
    assert_eq!(after("02-fog-300m.v33-le", 3, "").global.fog, None);
}

#[test]
fn heavy_rain_has_rate_extinction_cloud_and_wet_ground() {
    let rows = "components = [{ class = 0, component = 20, means = \"wiper\" }]";
    let mapped = after("04-heavy-rain.v33-be", 1, rows);
    let global = &mapped.global;
    let fall = global.precipitation.expect("rain");
    assert_eq!((fall.kind, fall.rate_mm_h, fall.liquid_fraction), (PrecipitationKind::Rain, 25.0, 1.0));
    assert!(!fall.showers && !fall.hail);
    // Air of 4000 m and rain of 1800 m together give 1800 m.
    let extinction = fall.extinction_per_m.expect("one");
    assert!(near(extinction, 20f64.ln() * (1.0 / 1800.0 - 1.0 / 4000.0)), "{extinction}");
    assert!(near(global.visibility_m.expect("one"), 1800.0));
    let [cloud] = global.clouds[..] else { panic!("{:?}", global.clouds) };
    assert_eq!(
        (cloud.kind, cloud.cover, cloud.base_m, cloud.thickness_m),
        (CloudKind::Nimbostratus, 1.0, 450.0, 3500.0)
    );
    // 60 m through droplets of 10 um: 0.33 g/m^3 (Stephens 1978).
    assert!((cloud.water_g_m3 - 0.333).abs() < 0.001, "{}", cloud.water_g_m3);
    assert_eq!(cloud.wind, WindValues { speed_m_s: 16.0, from_deg: 240.0, is_gusty: true });
    let surface = global.surface.expect("wet");
    assert_eq!((surface.state, surface.coverage, surface.snow_depth_m), (SurfaceState::Wet, 0.9, 0.0));
    let [wiper] = mapped.commands[..] else { panic!("{:?}", mapped.commands) };
    assert_eq!((wiper.class, wiper.component, wiper.state, wiper.value), (0, 20, 2, 0.75));
    assert_eq!(after("04-heavy-rain.v33-be", 2, "").global.precipitation.expect("rain").rate_mm_h, 60.0);
}

#[test]
fn a_thunderstorm_is_a_region_of_its_own() {
    let mapped = after("06-thunderstorm-region.v40-le", 2, "station_altitude_m = 1655");
    let [storm] = &mapped.regions[..] else { panic!("{:?}", mapped.regions) };
    assert_eq!(storm.id, 7);
    let weather = &storm.weather;
    assert_eq!((weather.clouds[0].kind, weather.clouds[0].base_m), (CloudKind::Cumulonimbus, 245.0));
    assert_eq!(weather.flashes_per_minute, 20.0);
    let fall = weather.precipitation.expect("rain");
    assert!(
        (fall.kind, fall.showers, fall.hail) == (PrecipitationKind::Rain, true, true) && near(fall.rate_mm_h, 54.0),
        "{fall:?}"
    );
    assert_eq!(mapped.global.precipitation, None);
    // A region whose host says nothing of the pressure or the sea leaves the world's.
    assert_eq!((weather.pressure_hpa, weather.sea.temperature_c), (None, None));
    assert!(after("06-thunderstorm-region.v40-le", 5, "").regions.is_empty(), "inactive");
    assert!(after("06-thunderstorm-region.v40-le", 6, "").regions.is_empty(), "destroyed");
}

#[test]
fn waves_become_swell_and_the_rest_of_the_sea() {
    let wave = |wave_id, height, length, to| WaveControl {
        wave_id,
        wave_enable: true,
        wave_height_m: height,
        wavelength_m: length,
        period_s: 10.0,
        direction_to_deg: to,
        ..WaveControl::default()
    };
    let off = WaveControl { wave_enable: false, ..wave(3, 9.0, 500.0, 1.0) };
    let all = [
        wave(0, 3.0, 160.0, 95.0).into(),
        wave(1, 1.5, 45.0, 65.0).into(),
        wave(2, 2.0, 20.0, 65.0).into(),
        off.into(),
    ];
    let sea = of(&all, "").global.sea;
    let [height, period, from] = sea.swell.expect("the longest");
    // Sines of height H have a significant height of sqrt(2) H, and energies add up.
    assert!(near(height, 3.0 * 2f64.sqrt()) && period == 10.0 && from == 275.0, "{sea:?}");
    assert!(near(sea.significant_wave_height_m.expect("two"), 2.5 * 2f64.sqrt()), "{sea:?}");
}

#[test]
fn ice_on_a_runway_is_the_most_severe_condition() {
    let mapped = after("09-icy-runway.v33-le", 1, "");
    assert_eq!(mapped.global.surface.map(|surface| surface.state), Some(SurfaceState::Dry));
    let surface = mapped.regions[0].weather.surface.expect("ice");
    assert_eq!((surface.state, surface.coverage), (SurfaceState::Ice, 0.9));
    assert!(mapped.left_out.iter().any(|note| note.reason.contains("most severe")));
    assert_eq!(
        after("09-icy-runway.v33-le", 3, "").regions[0].weather.surface.map(|s| s.state),
        Some(SurfaceState::Dry)
    );
}

#[test]
fn kinds_that_fall_together_are_one_kind() {
    let layer = |layer_id, severity| Packet::from(WeatherControl { layer_id, severity, ..rain(0, 0) });
    let cases: [(&[Packet], PrecipitationKind, [f64; 2], bool); 6] = [
        (&[layer(4, 2)], PrecipitationKind::Rain, [5.0, 1.0], false),
        (&[layer(5, 3)], PrecipitationKind::Snow, [2.0, 0.0], false),
        (&[layer(6, 3)], PrecipitationKind::Sleet, [2.0, 0.5], false),
        (&[layer(7, 1)], PrecipitationKind::Hail, [2.0, 0.0], false),
        (&[layer(4, 1), layer(5, 3)], PrecipitationKind::Sleet, [4.0, 0.5], false),
        (&[layer(4, 2), layer(7, 3)], PrecipitationKind::Rain, [5.0, 1.0], true),
    ];
    for (packets, kind, [rate, liquid], hail) in cases {
        let fall = of(packets, "").global.precipitation.expect("something falls");
        assert_eq!((fall.kind, fall.rate_mm_h, fall.liquid_fraction, fall.hail), (kind, rate, liquid, hail));
    }
}

#[test]
fn the_site_s_own_layers_are_mapped_and_values_without_a_place_are_reported() {
    let layer = |layer_id| WeatherControl { layer_id, ..rain(0, 0) };
    let rows = "layers = [{ id = 20, means = \"dust\" }, { id = 21, means = \"haze\" }, { id = 4, means = \"snow\" }]";
    let mapped = of(&[layer(20).into(), layer(21).into(), layer(4).into(), layer(22).into()], rows);
    assert!(mapped.global.lofted.is_some_and(|lofted| !lofted.is_sand && lofted.top_m == 900.0));
    assert_eq!(mapped.global.precipitation.map(|fall| fall.kind), Some(PrecipitationKind::Snow));
    let said: Vec<String> = mapped.left_out.iter().map(ToString::to_string).collect();
    assert!(
        said.iter().any(|line| line == "Weather Control: layer_id: the site's table has no row for the layer"),
        "{said:?}"
    );
    // Fog above the ground.
    let fog = WeatherControl { layer_id: 0, base_elevation_m: 400.0, ..rain(0, 0) };
    let high = of(&[fog.into()], "").global;
    assert!(high.fog.is_none() && high.clouds[0].kind == CloudKind::Stratus && high.clouds[0].base_m == 400.0);
    // Numbers that Welkin refuses come as the nearest that it takes.
    let air = AtmosphereControl {
        pressure_hpa: 1200.0,
        air_temperature_c: -99.0,
        vertical_wind_mps: 1.0,
        ..AtmosphereControl::default()
    };
    let component = ComponentControl { component_class: 3, ..ComponentControl::default() };
    let mapped = of(&[air.into(), component.into()], "");
    assert_eq!((mapped.global.pressure_hpa, mapped.global.temperature_c), (Some(1100.0), Some(-90.0)));
    assert_eq!(mapped.global.visibility_m, Some(1.0));
    let fields: Vec<&str> = mapped.left_out.iter().map(|note| note.field).collect();
    assert_eq!(fields, ["pressure_hpa", "vertical_wind_mps", "component_id"]);
}

#[test]
fn the_65th_region_pushes_out_the_first() {
    let mut all: Vec<Packet> = Vec::new();
    for id in (0..70).rev() {
        all.extend([Packet::from(region(id, 43.0, 5.0)), rain(1, id).into()]);
    }
    let mapped = of(&all, "");
    let ids: Vec<u16> = mapped.regions.iter().map(|region| region.id).collect();
    assert_eq!(ids, (0..64).rev().collect::<Vec<u16>>());
    assert!(mapped.left_out.iter().any(|note| note.field == "region_id"));
}

#[test]
fn dates_are_read_in_both_orders_and_wrong_ones_leave_the_former() {
    let sky = |date_mmddyyyy, hour| CelestialSphereControl {
        date_mmddyyyy,
        hour,
        date_time_valid: true,
        ..CelestialSphereControl::default()
    };
    let time = |packets: &[Packet]| of(packets, "").utc_s.map(|(time, _)| time);
    assert_eq!(time(&[]), None);
    assert_eq!(time(&[sky(1_011_970, 0).into()]), Some(0.0));
    assert_eq!(time(&[sky(2_292_024, 6).into()]), Some(1_709_186_400.0));
    assert_eq!(time(&[sky(20_240_229, 6).into()]), Some(1_709_186_400.0));
    for wrong in
        [sky(2_292_023, 0), sky(13_012_024, 0), sky(0, 0), sky(1_012_024, 24), sky(4_312_024, 0), sky(u32::MAX, 0)]
    {
        assert_eq!(time(&[wrong.into()]), None, "{wrong:?}");
        assert_eq!(time(&[sky(1_011_970, 1).into(), wrong.into()]), Some(3600.0), "{wrong:?}");
    }
    let kept = CelestialSphereControl { date_time_valid: false, ..sky(1_011_980, 0) };
    assert_eq!(time(&[sky(1_011_970, 1).into(), kept.into()]), Some(3600.0));
}
