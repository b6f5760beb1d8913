//! Weather, clock, saving: ranges named as in the header, whole round trips.

use std::ptr::null_mut;

use welkin::capi::{context::*, report::*, status::*, timeline::*, weather::*, weather_kinds::*};

use super::world::{World, init, message};

fn set(world: &World, change: impl Fn(&mut wk_weather)) -> (wk_status, String) {
    let mut weather = init("wk_weather");
    change(&mut weather);
    // SAFETY: live pointers.
    let status = unsafe { wk_context_set_weather(world.context, &weather, 0.0, 0.0) };
    (status, message())
}

#[test]
fn ranges_are_named_as_the_header_names_them() {
    let world = World::new();
    type Change = fn(&mut wk_weather);
    let cases: [(&str, Change); 9] = [
        ("weather.visibility_m must be in [1, 1000000] m, got 0", |w| w.visibility_m = 0.0),
        ("weather.wind_speed_m_s must be in [0, 120] m/s", |w| w.wind_speed_m_s = -1.0),
        ("weather.wind_variable_to_deg must be in [0, 360]", |w| {
            (w.has, w.wind_variable_to_deg) = (WK_WEATHER_HAS_WIND_VARIABLE, 361.0);
        }),
        ("weather.swell_period_s must be in [1, 30] s", |w| w.has = WK_WEATHER_HAS_SWELL),
        ("weather.sea_state must be in [0, 9]", |w| (w.has, w.sea_state) = (WK_WEATHER_HAS_SEA_STATE, 10)),
        ("weather.sea_state must be in [0, 9]", |w| (w.has, w.sea_state) = (WK_WEATHER_HAS_SEA_STATE, 300)),
        ("weather.aerosol_asymmetry must be in [-0.99, 0.99]", |w| {
            (w.has, w.aerosol_asymmetry) = (WK_WEATHER_HAS_AEROSOL_ASYMMETRY, 1.0);
        }),
        ("weather.precipitation_rate_mm_h must be 0", |w| w.precipitation_rate_mm_h = 1.0),
        ("weather.clouds must not be NULL where its count is 2", |w| w.cloud_count = 2),
    ];
    for (wanted, change) in cases {
        let (status, text) = set(&world, change);
        assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{wanted}: {text}");
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    // A field whose bit is clear is not checked.
    assert_eq!(set(&world, |w| w.sea_state = 300).0, WK_OK);
}

#[test]
fn lists_have_a_limit_and_a_stride() {
    let world = World::new();
    let mut layers = vec![init::<wk_cloud_layer>("wk_cloud_layer"); 17];
    let stride = size_of::<wk_cloud_layer>() as u32;
    let (count, at) = (layers.len() as u32, layers.as_ptr());
    let (status, text) = set(&world, |w| (w.clouds, w.cloud_count) = (at, count));
    assert_eq!((status, text.contains("weather.cloud_count must be at most 16")), (WK_ERROR_INVALID_ARGUMENT, true));
    for bad in [0, 8, stride - 8, stride + 1] {
        let (status, text) = set(&world, |w| (w.clouds, w.cloud_count, w.cloud_stride) = (at, 2, bad));
        assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{bad}: {text}");
        assert!(text.contains("stride"), "{bad}: {text}");
    }
    layers[1].cover = 2.0;
    let at = layers.as_ptr();
    let (status, text) = set(&world, |w| (w.clouds, w.cloud_count) = (at, 2));
    assert_eq!(status, WK_ERROR_INVALID_ARGUMENT);
    assert!(text.contains("weather.clouds[1].cover must be in [0, 1], got 2"), "{text}");
    // With a stride of two elements the invalid one between them is skipped.
    let at = layers.as_ptr();
    let (status, text) = set(&world, |w| (w.clouds, w.cloud_count, w.cloud_stride) = (at, 3, 2 * stride));
    assert_eq!(status, WK_OK, "{text}");
}

#[test]
fn a_layer_has_a_wind_a_spacing_and_a_life_of_its_own() {
    const WIND: wk_cloud_layer_has_flags = WK_CLOUD_LAYER_HAS_WIND;
    type Change = fn(&mut wk_cloud_layer);
    let world = World::new();
    let set_layer = |change: Change| {
        let mut layer = wk_cloud_layer { cover: 0.5, base_m: 900.0, ..init("wk_cloud_layer") };
        change(&mut layer);
        set(&world, |w| (w.clouds, w.cloud_count) = (&raw const layer, 1))
    };
    assert_eq!(
        set_layer(|l| (l.has, l.wind_m_s, l.wind_from_deg, l.spacing_m, l.life_s) = (WIND, 30.0, 10.0, 4e3, 600.0)).0,
        WK_OK
    );
    assert_eq!(set_layer(|l| l.wind_m_s = 1e9).0, WK_OK, "a field whose bit is clear is not looked at");
    let cases: [(&str, Change); 6] = [
        ("weather.clouds[0].wind_m_s must be in [0, 150] m/s, got -1", |l| (l.has, l.wind_m_s) = (WIND, -1.0)),
        ("weather.clouds[0].wind_from_deg must be in [0, 360] degrees", |l| (l.has, l.wind_from_deg) = (WIND, 400.0)),
        ("weather.clouds[0].spacing_m must be finite and in [50, 200000], got NaN", |l| l.spacing_m = f64::NAN),
        ("weather.clouds[0].life_s must be in [60, 1000000] s", |l| l.life_s = 59.0),
        ("weather.clouds[0].cover must be in [0, 1]", |l| l.cover = 1.01),
        ("weather.clouds[0].kind must be one of WK_CLOUD_UNKNOWN, ", |l| l.kind = 12),
    ];
    for (want, change) in cases {
        let (status, text) = set_layer(change);
        assert_eq!((status, text.contains(want)), (WK_ERROR_INVALID_ARGUMENT, true), "{want}: {text}");
    }
}

#[test]
fn overrides_are_named_too() {
    let world = World::new();
    let mut overrides = init::<wk_weather_overrides>("wk_weather_overrides");
    (overrides.set, overrides.cloud_diffuse) = (WK_OVERRIDE_CLOUD_LIGHT, 1.5);
    let (status, text) = set(&world, |w| w.next = (&raw const overrides).cast());
    assert_eq!(status, WK_ERROR_INVALID_ARGUMENT);
    assert!(text.contains("wk_weather_overrides.cloud_diffuse must be in [0, 1], got 1.5"), "{text}");
}

#[test]
fn dates_before_the_last_update_are_refused() {
    let world = World::new();
    let weather = init::<wk_weather>("wk_weather");
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_context_update(world.context, 10.0), WK_OK);
        assert_eq!(wk_context_set_weather(world.context, &weather, 9.0, 0.0), WK_ERROR_WRONG_ORDER);
        assert!(message().contains("start_time_s"), "{}", message());
        assert_eq!(wk_context_update(world.context, 9.0), WK_ERROR_WRONG_ORDER);
        assert!(message().contains("time_s must be at least 10 s"), "{}", message());
        for bad in [f64::NAN, f64::INFINITY, 1e11] {
            assert_eq!(wk_context_update(world.context, bad), WK_ERROR_INVALID_ARGUMENT);
            assert!(message().contains("time_s must be"), "{}", message());
            for (start, duration, name) in [(bad, 0.0, "start_time_s"), (20.0, bad, "transition_s")] {
                let status = wk_context_set_weather(world.context, &weather, start * 100.0, duration);
                assert_eq!(status, WK_ERROR_INVALID_ARGUMENT, "{name} {bad}");
                assert!(message().contains(name), "{}", message());
            }
            assert_eq!(wk_context_set_clock(world.context, bad * 1e9, 0.0), WK_ERROR_INVALID_ARGUMENT);
            assert!(message().contains("utc_s must be"), "{}", message());
            assert_eq!(wk_context_set_clock(world.context, 0.0, bad), WK_ERROR_INVALID_ARGUMENT);
            assert!(message().contains("time_s must be"), "{}", message());
            assert_eq!(wk_context_set_exposure(world.context, WK_EXPOSURE_EV100, bad), WK_ERROR_INVALID_ARGUMENT);
            assert!(message().contains("value must be"), "{}", message());
        }
        assert_eq!(wk_context_set_exposure(world.context, 9, 0.0), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("mode must be one of WK_EXPOSURE_AUTO"), "{}", message());
        assert_eq!(wk_context_set_exposure(world.context, WK_EXPOSURE_OF_CONTEXT, 0.0), WK_ERROR_INVALID_ARGUMENT);
        assert_eq!(wk_context_set_exposure(world.context, WK_EXPOSURE_EV100, 12.0), WK_OK);
    }
}

#[test]
fn calendar_dates_become_unix_time() {
    let mut utc = 7.0;
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(wk_utc_from_calendar(2026, 6, 21, 10, 0, 0.0, &mut utc), WK_OK);
        assert!((utc - 1_782_036_000.0).abs() < 1e-3, "{utc}");
        let before = utc;
        assert_eq!(wk_utc_from_calendar(2026, 13, 1, 0, 0, 0.0, &mut utc), WK_ERROR_INVALID_ARGUMENT);
        assert_eq!(wk_utc_from_calendar(2026, 1, 1, 0, 0, f64::NAN, &mut utc), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("second must be in [0, 60) s"), "{}", message());
        assert_eq!(utc, before);
    }
}

#[test]
fn a_saved_state_comes_back_whole_or_not_at_all() {
    let (a, b) = (World::new(), World::new());
    let storm = wk_weather {
        visibility_m: 900.0,
        fog_kind: WK_FOG_FOG,
        precipitation_kind: WK_PRECIPITATION_DRIZZLE,
        precipitation_rate_mm_h: 0.3,
        ..init("wk_weather")
    };
    let sun = init::<wk_given_direction>("wk_given_direction");
    let hash = |w: &World| {
        let mut h = 0;
        // SAFETY: live pointers.
        assert_eq!(unsafe { wk_context_state_hash(w.context, &mut h) }, WK_OK);
        h
    };
    // SAFETY: live pointers.
    unsafe {
        assert_eq!(hash(&a), hash(&b));
        assert_eq!(wk_context_set_weather(a.context, &storm, 5.0, 60.0), WK_OK);
        assert_eq!(wk_context_set_moon(a.context, &sun), WK_OK);
        assert_eq!(wk_context_update(a.context, 30.0), WK_OK);
        assert_ne!(hash(&a), hash(&b));
        let mut size = 0;
        assert_eq!(wk_context_save(a.context, null_mut(), 0, &mut size), WK_OK);
        let mut state = vec![0xAA_u8; size + 1];
        let mut got = 0;
        assert_eq!(
            wk_context_save(a.context, state.as_mut_ptr().cast(), size - 1, &mut got),
            WK_ERROR_INVALID_ARGUMENT
        );
        assert!(message().contains(&format!("capacity must be at least {size}")), "{}", message());
        assert_eq!((got, state[0]), (size, 0xAA));
        assert_eq!(wk_context_save(a.context, state.as_mut_ptr().cast(), state.len(), &mut got), WK_OK);
        assert_eq!((got, state[size]), (size, 0xAA));
        let before = hash(&b);
        assert_eq!(wk_context_load(b.context, state.as_ptr().cast(), size / 2), WK_ERROR_PARSE);
        assert_eq!(wk_context_load(b.context, state.as_ptr().cast(), 0), WK_ERROR_PARSE);
        assert_eq!(hash(&b), before);
        assert_eq!(wk_context_load(b.context, state.as_ptr().cast(), size), WK_OK, "{}", message());
        assert_eq!(hash(&a), hash(&b));
    }
}

/// Reads a report by a rule. Returns the status, the covers in hundredths, and the structs that the call wrote.
fn by_rule(report: &std::ffi::CStr, rule: wk_cloud_amount_rule) -> (wk_status, Vec<f64>, wk_metar, wk_weather) {
    let options = wk_metar_options { cloud_amounts: rule, ..init("wk_metar_options") };
    let (mut weather, mut metar) = (init::<wk_weather>("wk_weather"), init::<wk_metar>("wk_metar"));
    let mut layers = [init::<wk_cloud_layer>("wk_cloud_layer"); 16];
    let size = size_of::<wk_cloud_layer>() as u32;
    // SAFETY: live pointers with the sizes given.
    let status = unsafe {
        let layers = layers.as_mut_ptr();
        wk_weather_from_metar_with(report.as_ptr(), &options, layers, 16, size, &mut weather, &mut metar)
    };
    let covers = layers[..weather.cloud_count as usize].iter().map(|l| (l.cover * 100.0).round() / 100.0);
    (status, covers.collect(), metar, weather)
}

#[test]
fn cloud_amounts_follow_the_station_or_the_rule_that_is_set() {
    let sums = vec![0.19, 0.31, 0.56];
    let layers = vec![0.19, 0.44, 0.75];
    let british = c"EGLL 121120Z 24010KT 9999 FEW010 SCT020 BKN040 10/05 Q1013";
    let american = c"KADW 121120Z 24010KT 10SM FEW010 SCT020 BKN040 10/05 A3001";
    for (report, rule, covers, taken) in [
        (british, WK_CLOUD_AMOUNT_BY_STATION, &layers, WK_CLOUD_AMOUNT_LAYERS),
        (american, WK_CLOUD_AMOUNT_BY_STATION, &sums, WK_CLOUD_AMOUNT_SUMS),
        (british, WK_CLOUD_AMOUNT_SUMS, &sums, WK_CLOUD_AMOUNT_SUMS),
        (american, WK_CLOUD_AMOUNT_LAYERS, &layers, WK_CLOUD_AMOUNT_LAYERS),
    ] {
        let (status, got, metar, _) = by_rule(report, rule);
        assert_eq!((status, &got, metar.cloud_amounts), (WK_OK, covers, taken), "{report:?}: {}", message());
    }
    let (status, ..) = by_rule(british, 3);
    assert_eq!(status, WK_ERROR_INVALID_ARGUMENT);
    assert!(message().contains("options.cloud_amounts must be"), "{}", message());
    assert!(message().contains("got 3"), "{}", message());
}

#[test]
fn assumed_values_of_a_report_are_flagged_and_its_parts_are_located() {
    let of = |report| by_rule(report, WK_CLOUD_AMOUNT_BY_STATION);
    let (status, _, calm, _) = of(c"EDDF 121320Z AUTO 00000KT 9999 NCD 10/05 Q1013");
    assert_eq!((status, calm.assumed), (WK_OK, 0));
    let (status, _, unknown, weather) = of(c"EDDF 121320Z AUTO /////KT 9999 NCD 10/05 Q1013");
    assert_eq!((status, unknown.assumed, weather.wind_speed_m_s), (WK_OK, WK_METAR_ASSUMED_WIND, 0.0));
    let (status, _, bare, _) = of(c"KNXP 111456Z AUTO A3030 RMK AO2 PWINO");
    let all = WK_METAR_ASSUMED_WIND
        | WK_METAR_ASSUMED_VISIBILITY
        | WK_METAR_ASSUMED_PRECIPITATION
        | WK_METAR_ASSUMED_CLOUDS
        | WK_METAR_ASSUMED_TEMPERATURE
        | WK_METAR_ASSUMED_HUMIDITY;
    assert_eq!((status, bare.assumed), (WK_OK, all));
    let text =
        c"EDHI 180720Z 24004KT 2500 100NW R05/0300V0800U R23/P1500 FG FEW/// 13/13 Q1011 SLP162 TEMPO 0300 RMK QFE";
    let (status, _, m, weather) = of(text);
    assert_eq!((status, m.assumed, m.lowest_visibility_m), (WK_OK, WK_METAR_ASSUMED_CLOUD_BASE, 100.0));
    let part = |at: u32, length: u32| &text.to_str().unwrap()[at as usize..(at + length) as usize];
    assert_eq!(part(m.runways_offset, m.runways_length), "R05/0300V0800U R23/P1500");
    assert_eq!(part(m.trend_offset, m.trend_length), "TEMPO 0300");
    assert_eq!(part(m.remarks_offset, m.remarks_length), "QFE");
    assert_eq!((part(m.unread_offset, m.unread_length), m.unread_count), ("SLP162", 1));
    assert_eq!(weather.station_altitude_m, 0.0, "reports do not carry it");
    // A caller of the first version gets its own fields, and none of the later ones.
    let mut old = wk_metar { struct_size: 40, unread_count: 7, ..init("wk_metar") };
    let mut weather = init::<wk_weather>("wk_weather");
    // SAFETY: live pointers; no layers.
    let status = unsafe {
        let report = c"EDDF 121320Z AUTO /////KT 9999 NCD 10/05 Q1013";
        wk_weather_from_metar(report.as_ptr(), null_mut(), 0, 0, &mut weather, &mut old)
    };
    assert_eq!((status, old.day, old.assumed, old.unread_count), (WK_OK, 12, 0, 7), "{}", message());
}

#[test]
fn reading_a_report_returns_its_cloud_layers_or_names_the_column_at_fault() {
    let world = World::new();
    let report = c"METAR LBBG 041600Z AUTO 12012MPS 1400 R04/P1500N R22/P1500U +SN BKN022 OVC050 M04/M07 Q1020";
    let mut weather = init::<wk_weather>("wk_weather");
    let mut metar = init::<wk_metar>("wk_metar");
    let mut layers = [init::<wk_cloud_layer>("wk_cloud_layer"); 16];
    let size = size_of::<wk_cloud_layer>() as u32;
    // SAFETY: live pointers with the sizes given.
    unsafe {
        let read = |text: *const _, capacity, size, w: &mut wk_weather, m: &mut wk_metar, l: &mut [wk_cloud_layer]| {
            wk_weather_from_metar(text, l.as_mut_ptr(), capacity, size, w, m)
        };
        let few = read(report.as_ptr(), 1, size, &mut weather, &mut metar, &mut layers);
        assert_eq!(few, WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("layer_capacity must be at least 2"), "{}", message());
        assert_eq!((weather.visibility_m, metar.day, layers[0].cover), (40_000.0, 0, 0.0), "nothing is written");
        let narrow = read(report.as_ptr(), 16, 12, &mut weather, &mut metar, &mut layers);
        assert_eq!(narrow, WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("layer_size must be sizeof(wk_cloud_layer)"), "{}", message());
        let wrong = read(c"METAR LBBG 041600Z 12012QQQ".as_ptr(), 16, size, &mut weather, &mut metar, &mut layers);
        assert_eq!(wrong, WK_ERROR_PARSE);
        assert!(message().contains("column"), "{}", message());
        assert_eq!(read(std::ptr::null(), 16, size, &mut weather, &mut metar, &mut layers), WK_ERROR_INVALID_ARGUMENT);
        assert_eq!(read(c"\xff".as_ptr(), 16, size, &mut weather, &mut metar, &mut layers), WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("report must be UTF-8"), "{}", message());
        let good = read(report.as_ptr(), 16, size, &mut weather, &mut metar, &mut layers);
        assert_eq!(good, WK_OK, "{}", message());
        assert_eq!((weather.visibility_m, weather.cloud_count, weather.temperature_c), (1400.0, 2, -4.0));
        assert_eq!((weather.wind_speed_m_s, weather.wind_from_deg), (12.0, 120.0));
        assert_eq!(weather.precipitation_kind, WK_PRECIPITATION_SNOW);
        assert!(weather.precipitation_rate_mm_h > 0.0 && weather.has & WK_WEATHER_HAS_RUNWAY_VISUAL_RANGE != 0);
        assert_eq!((metar.day, metar.hour, metar.flags & WK_METAR_AUTOMATIC), (4, 16, WK_METAR_AUTOMATIC));
        assert_eq!(std::ffi::CStr::from_ptr(metar.station.as_ptr()).to_str(), Ok("LBBG"));
        assert_eq!(weather.clouds, layers.as_ptr());
        assert_eq!(wk_context_set_weather(world.context, &weather, 0.0, 0.0), WK_OK, "{}", message());
    }
}

#[test]
fn every_preset_has_a_name_and_is_a_weather() {
    let world = World::new();
    let mut layers = [init::<wk_cloud_layer>("wk_cloud_layer"); 16];
    let size = size_of::<wk_cloud_layer>() as u32;
    let mut weather = init::<wk_weather>("wk_weather");
    let (mut name, mut what, mut count) = (std::ptr::null(), std::ptr::null(), 0);
    // SAFETY: live pointers with the sizes given.
    unsafe {
        while wk_get_preset(count, &mut name, &mut what) == WK_OK {
            assert!(!std::ffi::CStr::from_ptr(what).is_empty());
            let status = wk_weather_from_preset(name, layers.as_mut_ptr(), 16, size, &mut weather);
            assert_eq!(status, WK_OK, "{}", message());
            assert_eq!(wk_context_set_weather(world.context, &weather, 0.0, 0.0), WK_OK, "{}", message());
            count += 1;
        }
        assert!(count > 10 && message().contains(&format!("index must be below {count}")), "{count} {}", message());
        let unknown = wk_weather_from_preset(c"nice".as_ptr(), layers.as_mut_ptr(), 16, size, &mut weather);
        assert_eq!(unknown, WK_ERROR_INVALID_ARGUMENT);
        assert!(message().contains("clear"), "{}", message());
        assert_eq!(wk_get_preset(0, null_mut(), null_mut()), WK_OK);
    }
}
