//! The parser against another one, the crate `metar`, and against values by hand where that refuses real reports.

use metar::{CloudDensity, Data, Metar, Pressure, Visibility, Wind, WindDirection, WindSpeed};
use welkin::weather::{MetarReport, Weather};

const REPORTS: &str = include_str!("../../examples/data/metar.txt");
const REAL: &str = include_str!("data/reports.csv");
const KNOT: f64 = 1852.0 / 3600.0;
const MILE: f64 = 1609.344;

fn read(text: &str) -> MetarReport {
    Weather::from_metar(text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn compare(text: &str, theirs: &Metar) {
    let ours = read(text);
    let w = &ours.weather;
    assert_eq!(ours.station, theirs.station);
    let time = (theirs.time.date.into(), theirs.time.hour.into(), theirs.time.minute.into());
    assert_eq!((ours.day, ours.hour, ours.minute), time, "{text}");
    if let Data::Known(t) = theirs.temperature {
        assert_eq!(w.temperature_c, f64::from(t), "{text}");
    }
    if let (Data::Known(dew), Data::Known(t)) = (theirs.dewpoint, theirs.temperature) {
        assert!((w.dew_point_c() - f64::from(dew.min(t))).abs() < 1e-6, "{text}");
    }
    match theirs.pressure {
        Pressure::Hectopascals(Data::Known(p)) => assert!((w.pressure_hpa - f64::from(p)).abs() < 1e-3, "{text}"),
        Pressure::InchesOfMercury(Data::Known(p)) => {
            assert!((w.pressure_hpa - f64::from(p) * 33.8639).abs() < 1e-2, "{text}");
        }
        _ => assert!(ours.assumed.contains(&"pressure_hpa"), "{text}"),
    }
    wind(text, &ours, theirs);
    match theirs.visibility {
        Data::Known(Visibility::Metres(9999) | Visibility::CAVOK) => assert!(ours.visibility_is_minimum),
        Data::Known(Visibility::Metres(m)) => assert_eq!(w.visibility_m, f64::from(m)),
        Data::Known(Visibility::StatuteMiles(m)) if m != 10.0 => {
            assert!((w.visibility_m - f64::from(m) * MILE).abs() < 0.01, "{text}");
        }
        _ => assert!(ours.visibility_is_minimum, "{text}"),
    }
    // The other parser counts a group of only slashes as a layer.
    let layers: Vec<_> = theirs.cloud_layers.iter().filter(|l| matches!(l.density, Data::Known(_))).collect();
    assert_eq!((w.clouds.len(), ours.runways.len()), (layers.len(), theirs.rvr.len()), "{text}");
    for (a, b) in w.clouds.iter().zip(layers) {
        let Data::Known(hundreds) = b.height else { panic!("{text}") };
        assert!((a.base_m - f64::from(hundreds) * 30.48).abs() < 1e-9);
        assert_eq!(a.cover == 1.0, b.density == Data::Known(CloudDensity::Overcast), "{text}");
    }
}

fn wind(text: &str, ours: &MetarReport, theirs: &Metar) {
    let wind = &ours.weather.wind;
    let Wind::Present { dir, speed, .. } = &theirs.wind else { panic!("{text}: no report says CALM") };
    let (speed, gust, unit) = match speed {
        WindSpeed::Knots { speed, gusting } => (*speed, *gusting, KNOT),
        WindSpeed::MetresPerSecond { speed, gusting } => (*speed, *gusting, 1.0),
        WindSpeed::KilometresPerHour { speed, gusting } => (*speed, *gusting, 1.0 / 3.6),
        WindSpeed::Greater => panic!("{text}: more than can be told"),
    };
    let Data::Known(speed) = speed else {
        assert!(ours.assumed.contains(&"wind"), "{text}");
        return;
    };
    assert!((wind.speed_m_s - f64::from(speed) * unit).abs() < 1e-9, "{text}: {wind:?}");
    let gust = gust.and_then(|g| if let Data::Known(g) = g { Some(f64::from(g) * unit) } else { None });
    assert_eq!(wind.gust_m_s.is_some(), gust.is_some(), "{text}: {wind:?}");
    assert!(wind.gust_m_s.zip(gust).is_none_or(|(a, b)| (a - b).abs() < 1e-9), "{text}: {wind:?}");
    match *dir {
        WindDirection::Heading(Data::Known(degrees)) => assert_eq!(wind.from_deg, f64::from(degrees), "{text}"),
        WindDirection::Heading(Data::Unknown) => assert!(ours.assumed.contains(&"wind.from_deg"), "{text}"),
        WindDirection::Variable => assert_eq!(wind.variable_deg, (speed > 0).then_some((0.0, 360.0)), "{text}"),
    }
}

#[test]
fn another_grammar_reads_the_same_figures() {
    for text in REPORTS.lines().filter(|l| !l.is_empty() && !l.starts_with('#')) {
        compare(text, &Metar::parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}")));
    }
}

#[test]
fn another_grammar_reads_the_same_figures_in_real_reports() {
    let (mut both, mut ours_alone) = (0, 0);
    for text in REAL.lines().skip(1).filter_map(|l| l.split(',').next()) {
        match Metar::parse(text) {
            Ok(theirs) => {
                both += 1;
                compare(text, &theirs);
            }
            Err(_) => {
                ours_alone += 1;
                read(text);
            }
        }
    }
    println!("{both} reports are read by both, {ours_alone} by Welkin alone");
    assert!(both > 900, "{both}");
}

/// Wind written by hand, in the report's unit: direction, mean, gust.
type ByHand = (Option<f64>, f64, Option<f64>);

/// Reports that the other parser refuses, with values by hand: wind in the stated unit, visibility in metres.
#[test]
fn what_the_other_grammar_refuses_is_read_as_by_hand() {
    let table: [(&str, f64, ByHand, f64, &str); 9] = [
        ("KDLP 092235Z AUTO 03020KT M1/4SM FG OVC003 15/15 A3000", KNOT, (Some(30.0), 20.0, None), 0.25 * MILE, ""),
        (
            "KJFK 121151Z 04015G28KT M1/4SM R04R/1000V1800FT FG OVC001 10/10 A2992",
            KNOT,
            (Some(40.0), 15.0, Some(28.0)),
            0.25 * MILE,
            "",
        ),
        ("ROAH 121100Z 24109G120KT 1000 +SHRA BKN005 26/25 Q0958", KNOT, (Some(241.0), 9.0, Some(120.0)), 1000.0, ""),
        ("ROAH 121100Z 090105G135KT 1000 +SHRA BKN005 26/25 Q0958", KNOT, (Some(90.0), 105.0, Some(135.0)), 1000.0, ""),
        ("UHPP 121100Z 330P49MPS 0500 +SN BLSN VV001 M06/M07 Q0968", 1.0, (Some(330.0), 49.0, None), 500.0, ""),
        ("ZMUB 121100Z 330036KMH 5000 HZ NSC 06/M07 Q1028", 1.0 / 3.6, (Some(330.0), 36.0, None), 5000.0, ""),
        ("KGYR 092247Z KT 3SM BR BKN075 25/24 A2972", KNOT, (None, 0.0, None), 3.0 * MILE, "wind"),
        ("KONA 092235Z AUTO ///07KT 2 1/2SM BR CLR 05/M02 A3001", KNOT, (None, 7.0, None), 2.5 * MILE, "wind.from_deg"),
        ("EDDK 071350Z AUTO VRB02KT 4000 1100 SHRA BKN036 17/14 Q1013", KNOT, (None, 2.0, None), 4000.0, ""),
    ];
    for (text, unit, (from, mean, gust), visibility_m, assumed) in table {
        let r = read(text);
        let wind = r.weather.wind;
        assert!((wind.speed_m_s - mean * unit).abs() < 1e-9, "{text}: {wind:?}");
        assert_eq!(wind.from_deg, from.unwrap_or(0.0), "{text}");
        assert_eq!(wind.gust_m_s.map(|g| (g / unit).round()), gust, "{text}");
        assert!((r.weather.visibility_m - visibility_m).abs() < 1e-9, "{text}: {}", r.weather.visibility_m);
        assert_eq!(r.assumed, Vec::from_iter(Some(assumed).filter(|a| !a.is_empty())), "{text}");
        assert!(r.unread.is_empty(), "{text}: {:?}", r.unread);
    }
}
