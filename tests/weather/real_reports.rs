//! 1,100 reports that stations sent, compared with the fields that the Aviation Weather Center decoded from them
//! (`data/README.md`).

use welkin::weather::{AerosolKind, CloudAmountRule, FogKind, MetarReport, PrecipitationKind, Weather, derive};

const CSV: &str = include_str!("data/reports.csv");
const KNOT: f64 = 1852.0 / 3600.0;
const MILE: f64 = 1609.344;

/// One report and the service's fields, `None` where its decoder found nothing.
struct Row {
    text: &'static str,
    elevation_m: Option<f64>,
    temperature_c: Option<f64>,
    dew_point_c: Option<f64>,
    from_deg: Option<f64>,
    speed_kt: Option<f64>,
    gust_kt: Option<f64>,
    visibility_mi: Option<f64>,
    pressure_in_hg: Option<f64>,
    weather: &'static str,
    sky: &'static str,
}

fn rows() -> Vec<Row> {
    let number = |t: &str| (!t.is_empty()).then(|| t.parse::<f64>().unwrap_or_else(|_| panic!("{t}")));
    CSV.lines()
        .skip(1)
        .map(|line| {
            let f: Vec<&str> = line.split(',').collect();
            assert_eq!(f.len(), 11, "{line}");
            Row {
                text: f[0],
                elevation_m: number(f[1]),
                temperature_c: number(f[2]),
                dew_point_c: number(f[3]),
                from_deg: number(f[4]),
                speed_kt: number(f[5]),
                gust_kt: number(f[6]),
                visibility_mi: number(f[7]),
                pressure_in_hg: number(f[8]),
                weather: f[9],
                sky: f[10],
            }
        })
        .collect()
}

fn read(row: &Row) -> MetarReport {
    Weather::from_metar(row.text).unwrap_or_else(|e| panic!("{}: {e}", row.text))
}

fn near(what: &str, row: &Row, ours: f64, theirs: f64, tolerance: f64) {
    assert!((ours - theirs).abs() <= tolerance, "{}: {what} {ours} beside {theirs}", row.text);
}

/// Checks that the report lists `name` as assumed exactly where the service found nothing.
fn assumed(name: &str, row: &Row, report: &MetarReport, found: bool) {
    assert_eq!(report.assumed.contains(&name), !found, "{}: {name} {:?}", row.text, report.assumed);
}

#[test]
fn every_real_report_is_read() {
    let rows = rows();
    assert_eq!(rows.len(), 1100);
    let unread: Vec<_> =
        rows.iter().map(read).filter(|r| !r.unread.is_empty()).map(|r| (r.station, r.unread)).collect();
    // A visibility in miles without the S of SM.
    assert_eq!(unread, [("KMER".to_owned(), vec!["8M".to_owned()])]);
}

#[test]
fn air_and_wind_are_those_that_the_service_decoded() {
    let mut elsewhere = 0;
    for row in &rows() {
        let r = read(row);
        let w = &r.weather;
        // The service reads tenths of degrees from the remarks. They round to the degrees in the body of the report,
        // except at some stations, whose remarks are of another minute.
        let tenths = if r.remarks.contains(" T") { 1.0 } else { 0.0 };
        assumed("temperature_c", row, &r, row.temperature_c.is_some());
        assumed("relative_humidity", row, &r, row.dew_point_c.is_some());
        assumed("pressure_hpa", row, &r, row.pressure_in_hg.is_some());
        assumed("wind", row, &r, row.speed_kt.is_some());
        row.temperature_c.into_iter().for_each(|t| near("temperature", row, w.temperature_c, t, tenths));
        elsewhere += usize::from(row.temperature_c.is_some_and(|t| (t - w.temperature_c).abs() > 0.5 + 1e-9));
        // A dew point above the temperature counts as saturation.
        let dew = row.dew_point_c.zip(row.temperature_c).map(|(d, t)| d.min(t));
        dew.into_iter().for_each(|d| near("dew point", row, w.dew_point_c(), d, tenths + 1e-9));
        // The service converts, and rounds to tenths of a hectopascal and hundredths of an inch.
        row.pressure_in_hg.into_iter().for_each(|p| near("pressure", row, w.pressure_hpa / 33.8639, p, 5e-3));
        row.speed_kt.into_iter().for_each(|s| near("wind", row, w.wind.speed_m_s / KNOT, s, 1e-9));
        // Calm air has no direction, and the service writes 0 for a variable direction.
        row.from_deg.into_iter().for_each(|d| near("direction", row, w.wind.from_deg, d, 0.0));
        assert_eq!(row.gust_kt, w.wind.gust_m_s.map(|g| (g / KNOT).round()), "{}", row.text);
    }
    assert!(elsewhere <= 12, "{elsewhere} temperatures are another minute's");
}

#[test]
fn visibilities_are_those_that_the_service_decoded_or_more_where_they_are_open() {
    let mut open = 0;
    for row in &rows() {
        let r = read(row);
        match row.visibility_mi {
            // The service's values for 10SM, 9999 and CAVOK.
            Some(miles) if miles == 10.0 || miles == 6.21 => {
                open += 1;
                assert!(r.visibility_is_minimum && r.weather.visibility_m >= 0.999 * miles * MILE, "{}", row.text);
            }
            Some(miles) => {
                near("visibility", row, r.weather.visibility_m / MILE, miles, 0.0051);
                assert!(!r.visibility_is_minimum, "{}", row.text);
            }
            // The service does not read a number with a blank before its unit.
            None if row.text.contains("1/4 SM") => near("visibility", row, r.weather.visibility_m / MILE, 0.25, 1e-9),
            None => assumed("visibility_m", row, &r, false),
        }
    }
    assert!(open > 700, "{open}");
}

/// Meaning of a group of present weather, written by hand: kind, bounds of the rate in mm/h, fog, particles.
fn meaning(group: &str) -> (PrecipitationKind, (f64, f64), FogKind, AerosolKind) {
    use {AerosolKind as A, FogKind as F, PrecipitationKind as P};
    let (none, dry, air) = (P::None, (0.0, 0.0), A::Continental);
    match group {
        "-RA" | "-SHRA" => (P::Rain, (0.1, 2.5), F::None, air),
        "RA" => (P::Rain, (2.5, 7.6), F::None, air),
        "+RA" => (P::Rain, (7.6, 50.0), F::None, air),
        "-DZ" | "DZ" => (P::Drizzle, (0.1, 0.5), F::None, air),
        "-SN" => (P::Snow, (0.05, 1.0), F::None, air),
        "SN" => (P::Snow, (1.0, 2.5), F::None, air),
        "BR" => (none, dry, F::Mist, air),
        "FG" => (none, dry, F::Fog, air),
        "FZFG" => (none, dry, F::Freezing, air),
        "HZ" => (none, dry, F::None, A::Haze),
        "VCSH" => (none, dry, F::None, air),
        other => panic!("{other}"),
    }
}

#[test]
fn present_weather_is_that_which_the_service_decoded() {
    let mut seen = 0;
    for row in &rows() {
        let w = read(row).weather;
        // The service omits the sign of unknown precipitation (UP), whose kind depends on the temperature.
        if row.weather.contains("UP") {
            assert!(w.precipitation.rate_mm_h > 0.0, "{}", row.text);
            continue;
        }
        let groups: Vec<_> = row.weather.split_whitespace().map(meaning).collect();
        let falls = groups.iter().find(|g| g.0 != PrecipitationKind::None);
        let (kind, (least, most)) = falls.map_or((PrecipitationKind::None, (0.0, 0.0)), |g| (g.0, g.1));
        let fog = groups.iter().map(|g| g.2).max_by_key(|f| *f as u32).unwrap_or(FogKind::None);
        let aerosol = groups.iter().map(|g| g.3).max_by_key(|a| *a as u32).unwrap_or(AerosolKind::Continental);
        assert_eq!((w.precipitation.kind, w.fog.kind, w.aerosol.kind), (kind, fog, aerosol), "{}", row.text);
        assert!((least..=most).contains(&w.precipitation.rate_mm_h), "{}: {:?}", row.text, w.precipitation);
        seen += groups.len();
    }
    assert!(seen > 360, "{seen}");
}

/// Cloud groups as the service decoded them: class (0 for FEW to 3 for OVC) and base in feet; `None` for an obscured
/// sky.
fn groups(row: &Row) -> Option<Vec<(usize, f64)>> {
    // Of two groups without a blank between them the service reads only the second.
    let sky = if row.text.contains("SCT120BKN180") { "SCT:12000 BKN:18000" } else { row.sky };
    let class = |name: &str| ["FEW", "SCT", "BKN", "OVC"].iter().position(|c| *c == name);
    if sky.contains("OVX") {
        return None;
    }
    let pairs = sky.split_whitespace().filter_map(|g| g.split_once(':'));
    Some(pairs.map(|(amount, feet)| (class(amount).unwrap(), feet.parse().unwrap())).collect())
}

#[test]
fn every_reported_layer_is_there_and_american_sums_stay_in_their_classes() {
    /// Bounds of the classes, eighths.
    const CLASSES: [(f64, f64); 4] = [(0.0, 2.0), (3.0, 4.0), (5.0, 7.0), (8.0, 8.0)];
    const MIDDLES: [f64; 4] = [1.5, 3.5, 6.0, 8.0];
    let (mut sums, mut layers, mut hidden) = (0, 0, 0);
    for row in &rows() {
        let r = read(row);
        let Some(groups) = groups(row) else {
            hidden += 1;
            assert!(r.weather.vertical_visibility_m.is_some() && r.weather.clouds.is_empty(), "{}", row.text);
            continue;
        };
        assumed("clouds", row, &r, !row.sky.is_empty());
        assert_eq!(r.weather.clouds.len(), groups.len(), "{}", row.text);
        let american = !row.text.starts_with('Y');
        assert_eq!(r.cloud_amounts, if american { CloudAmountRule::Sums } else { CloudAmountRule::Layers });
        let mut open = 1.0;
        for (layer, (class, feet)) in r.weather.clouds.iter().zip(groups) {
            near("base", row, layer.base_m / 0.3048, feet, 1e-6);
            assert!(layer.cover > 0.0, "{}: {:?}", row.text, r.weather.clouds);
            open *= 1.0 - layer.cover;
            if american {
                sums += 1;
                let (least, most) = CLASSES[class];
                let eighths = 8.0 * (1.0 - open);
                assert!(eighths > least - 1e-9 && eighths < most + 1e-9, "{}: {eighths} eighths", row.text);
            } else {
                layers += 1;
                near("cover", row, 8.0 * layer.cover, MIDDLES[class], 1e-12);
            }
        }
        let conditions = derive(&r.weather).unwrap();
        let light = conditions.cloud_light(0.5, 0.2);
        let parts = [light.direct, light.diffuse, light.direct + light.diffuse, light.sky];
        assert!(parts.iter().all(|part| (0.0..=1.0).contains(part)), "{}: {light:?}", row.text);
        let kept = conditions.clouds.iter().filter(|s| s.cover > 0.0).count();
        assert!(kept >= r.weather.clouds.len(), "{}: {kept} layers are left", row.text);
    }
    assert!(sums > 800 && layers > 80 && hidden == 14, "{sums} {layers} {hidden}");
}

#[test]
fn named_reports_have_the_amounts_of_their_nation() {
    let covers = |text: &str| -> Vec<f64> {
        let report = Weather::from_metar(text).unwrap_or_else(|e| panic!("{text}: {e}"));
        report.weather.clouds.iter().map(|c| (c.cover * 100.0).round() / 100.0).collect()
    };
    assert_eq!(covers("EGLL 121120Z 24010KT 9999 FEW010 SCT020 BKN040 10/05 Q1013"), [0.19, 0.44, 0.75]);
    assert_eq!(covers("LFPG 121120Z 24010KT 9999 OVC020 BKN045 10/05 Q1013"), [1.0, 0.75]);
    let five = covers("KADW 121055Z AUTO 24010KT 10SM FEW080 FEW110 FEW130 BKN150 BKN190 10/05 A3001");
    assert!(five.len() == 5 && five.iter().all(|c| *c > 0.0), "{five:?}");
}

#[test]
fn a_host_sets_the_height_of_the_station_by_its_name() {
    for row in rows().iter().step_by(10) {
        let mut report = read(row);
        assert_eq!(report.weather.station_altitude_m, 0.0, "reports do not carry it");
        let list = |station: &str| row.text.starts_with(station).then_some(row.elevation_m).flatten();
        report.weather.station_altitude_m = list(&report.station).unwrap();
        assert!(derive(&report.weather).is_ok(), "{}", row.text);
    }
}

/// The program of the article on reports compiles as C99 against the header.
#[test]
#[cfg(unix)]
fn the_articles_program_compiles() {
    let article = include_str!("../../docs/reports.md");
    let code = article.split("```c\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a program in it");
    let source = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("report_of_the_article.c");
    let head = "#include <stdio.h>\n#include <string.h>\n#include <welkin.h>\n";
    let whole = format!("{head}{code}int main(void) {{ return report(NULL, \"\") == 0; }}\n");
    std::fs::write(&source, whole).expect("the target directory is writable");
    let include = concat!("-I", env!("CARGO_MANIFEST_DIR"), "/include");
    let strict = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only", include];
    let output = std::process::Command::new("gcc").args(strict).arg(&source).output().expect("gcc is there");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
