//! The site's table: its defaults, and that wrong keys and values are named.

use welkin_cigi_host::site::{CloudKind, LayerMeaning, Site};
use welkin_cigi_host::wire::{Family, Packet};

#[test]
fn an_empty_table_is_the_default_and_rows_change_it() {
    assert_eq!(Site::from_toml(""), Ok(Site::default()));
    let text = "station_altitude_m = 449\naltitudes = \"ellipsoid\"\ngeoid_height_m = 49.5\n\
                layers = [{ id = 13, means = \"haze\" }, { id = 3, means = \"nothing\" }]\n\
                clouds = [{ number = 12, kind = \"towering_cumulus\" }]\n\
                [severities]\nrain_mm_h = [0, 1, 2, 3, 4, 5]\n";
    let site = Site::from_toml(text).expect("a good table");
    assert_eq!((site.station_altitude_m, site.sea_level_m()), (449.0, 49.5));
    assert_eq!([13, 3, 2, 14].map(|id| site.layer(id)), {
        use LayerMeaning::{Cloud, Haze, Nothing};
        [Haze, Nothing, Cloud, Nothing]
    });
    assert_eq!([12, 13, 1, 10, 0].map(|number| site.cloud(number)), {
        use CloudKind::{Altocumulus, Stratus, ToweringCumulus};
        [Some(ToweringCumulus), None, Some(Altocumulus), Some(Stratus), None]
    });
    assert_eq!(site.severities.rain_mm_h[5], 5.0);
    assert_eq!(site.severities.snow_mm_h, Site::default().severities.snow_mm_h);
    assert_eq!(site.above_ellipsoid_m(500.0), 500.0);
    let level = Site::from_toml("geoid_height_m = 49.5").expect("a good table");
    assert_eq!((level.sea_level_m(), level.above_ellipsoid_m(500.0)), (0.0, 549.5));
}

#[test]
fn the_example_of_the_documents_is_good() {
    let document =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/cigi.md")).expect("docs/cigi.md");
    let example = document.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let site = Site::from_toml(example).expect("a good table");
    assert_ne!(site, Site::default());
}

#[test]
fn wrong_keys_and_values_are_named() {
    let cases = [
        ("station_altitude_m = 9001", "station_altitude_m must be in [-500, 9000], got 9001"),
        ("station_altitude_m = nan", "station_altitude_m"),
        ("geoid_height_m = -121", "geoid_height_m"),
        ("hours_ahead_of_utc = 15", "hours_ahead_of_utc"),
        ("databases = [0]", "databases must be in [1, 127]"),
        ("databases = [400]", "databases"),
        ("station = 4", "unknown field `station`"),
        ("altitudes = \"geoid\"", "unknown variant `geoid`"),
        ("[severities]\nrain_mm_h = [1, 2]", "rain_mm_h"),
        ("[severities]\nrain_mm_h = [1, 2, 3, 4, 5, 501]", "severities.rain_mm_h must be in [0, 500], got 501"),
        ("[severities]\nsnow_mm_h = [-1, 2, 3, 4, 5, 6]", "severities.snow_mm_h"),
        ("[severities]\nhail_mm_h = [inf, 2, 3, 4, 5, 6]", "severities.hail_mm_h"),
        ("[severities]\nflashes_per_minute = [1, 2, 3, 4, 5, 61]", "severities.flashes_per_minute"),
        ("layers = [{ id = 300, means = \"rain\" }]", "300"),
        ("layers = [{ id = 3, means = \"lava\" }]", "unknown variant `lava`"),
        ("layers = [{ id = 3 }]", "missing field `means`"),
        ("layers = [{ id = 12, means = \"rain\" }, { id = 12, means = \"snow\" }]", "layers.id: 12 must have one row"),
        ("clouds = [{ number = 10, kind = \"cirrus\" }]", "clouds.number must be in [11, 15], got 10"),
        ("surfaces = [{ id = 0, state = \"wet\" }]", "surfaces.id must be in [1, 65535], got 0"),
        ("surfaces = [{ id = 1, state = \"snow\", snow_depth_m = 21 }]", "surfaces.snow_depth_m"),
        ("components = [{ class = 64, component = 1, means = \"wiper\" }]", "components.class must be in [0, 63]"),
    ];
    for (text, named) in cases {
        let error = Site::from_toml(text).expect_err(text);
        assert!(error.contains(named), "{text}: {error}");
    }
}

#[test]
fn the_support_table_names_every_packet() {
    let document = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/cigi-packets.md"));
    let document = document.expect("docs/cigi-packets.md");
    let missing = Packet::LAYOUTS.iter().flat_map(|layout| [layout.name, layout.name_in(Family::V4)]);
    let missing: Vec<&str> = missing.filter(|name| !document.contains(name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}
