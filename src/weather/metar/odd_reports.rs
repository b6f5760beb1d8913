//! Tests with reports as airports send them, with everything that the code form (WMO-No. 306, FM 15) allows, and with
//! damaged reports.

use crate::Status;
use crate::weather::{CloudKind, MetarReport, PrecipitationKind, Weather, derive};

/// Reports that must be read, most of them with one rare group.
const READ: &[&str] = &[
    "METAR EFHK 121150Z AUTO 00000KT 9999NDV NCD M12/M15 Q1031",
    "METAR LFPG 121200Z AUTO VRB02KT 9999 NSC 21/11 Q1019 NOSIG",
    "METAR ESSA 121220Z AUTO /////KT //// // ////// ///// Q////",
    "METAR EKCH 121220Z AUTO ///// //// // ///////// 12/10 Q1011",
    "METAR UUEE 121230Z 02005MPS 340V050 CAVOK 03/M02 Q1022 R24/CLRD70 NOSIG",
    "METAR ENGM 121220Z 36010KT 0300 R19R/0450U FZFG VV/// M06/M06 Q1020",
    "METAR KORD 121151Z 27012G25KT 3/4SM R28L/P2000FT/U +SN BLSN VV008 M04/M06 A2970 RMK AO2 SLP072 P0004 T10391056",
    "METAR KJFK 121151Z 04015KT M1/4SM R04R/1000V1800FT FG OVC001 10/10 A2992 RMK AO2 $",
    "METAR KSFO 121156Z P6SM FEW012 14/11 A3001",
    "METAR KBIL 162256Z 29017G27KT 10SM FEW070 SCT085 BKN110 M02/M02 A2961 RMK AO2 PK WND 29027/2250 WSHFT 2241",
    "SPECI KMIA 121813Z COR 14012G24KT 1 1/2SM +TSRAGR SQ BKN015TCU OVC040CB 25/24 A2986 RMK TSB05",
    "METAR KEWR 160128Z 18008KT 2 1/2SM R04R/4500VP6000FT RA BR SCT008 BKN022 OVC038 22/21 A3001 RMK AO2 RAB20E51",
    "METAR KABQ 100156Z 32010KT 280V340 10SM TS FEW033 BKN075CB OVC100 19/14 A2999 RMK AO2 TSB09RAB09E56",
    "METAR KMEM 230853Z AUTO 18014G18KT 11/2SM BR CLR 16/M02 A3008",
    "METAR CYYZ 121200Z CCD 07011KT 15SM -SHRASN BKN030 01/M01 A2971 RMK SC6 SLP068",
    "METAR CYVR 121200Z RTD 09005KT 3/8SM R08L/2600FT/D FG VV001 06/06 A3011",
    "METAR EGXE 121150Z 24010KT 9999 FEW020 12/08 Q1014 BLU NOSIG",
    "METAR EGVN 121150Z 24010KT 4000 BR BKN006 12/11 Q1004 YLO1 TEMPO 2000 AMB",
    "METAR EGQL 121150Z 27025G40KT 3000 SHGS BKN012CB 04/01 Q0989 BLACKGRN",
    "METAR EDDL 121150Z 24010KT 9999 -SHRA FEW015CB 12/08 Q1004 RERA WS ALL RWY",
    "METAR LOWI 121150Z 24010KT 9999 FEW040 12/08 Q1004 RETSRA WS R26 BECMG 26015G25KT",
    "METAR LSZH 121150Z 24010KT 9999 FEW040 12/08 Q1004 WS TKOF RWY28 TEMPO 4000 SHRA",
    "METAR UUDD 121130Z 15003MPS 0800 R32L/1200N SN SCT005 OVC020 M03/M04 Q0998 88490391 NOSIG",
    "METAR ULLI 121130Z 15003MPS 9999 OVC020 M03/M04 Q0998 R88/290095 TEMPO 1000 SHSN BKN005CB",
    "METAR BIRK 121130Z 15030G45KT 2000 DRSN OVC020 M03/M08 Q0958 R01/SNOCLO SNOCLO",
    "METAR ENZV 121120Z 24032KT 9999 FEW025 BKN040 09/05 Q1001 W///S/",
    "METAR ENAE 121120Z 24032KT 9999 FEW025 BKN040 09/05 Q1001 W10/S/",
    "METAR ENEK 121120Z 24032KT 9999 FEW025 BKN040 09/05 Q1001 W///H///",
    "METAR ENFB 121120Z 24032KT 9999 FEW025 BKN040 09/05 Q1001 W07/H75",
    "METAR ENLE 121120Z 24032KT 9999 FEW025 BKN040 M01/M05 Q1001 WM01/S6 NOSIG",
    "METAR EHAM 121125Z 24010KT 9999 VCTS FEW015CB 22/18 Q1009 BECMG NSW",
    "METAR EHRD 121125Z 24010KT 9999 VCSH FEW015TCU 22/18 Q1009",
    "METAR EHEH 121125Z AUTO 24010KT 0450 R21/0600D R03/////// FG BKN/// 08/08 Q1023",
    "METAR EHGG 121125Z AUTO 24010KT 9999 FEW///CB //////TCU 22/18 Q1009",
    "METAR LFBO 121130Z AUTO 30004KT 9999 ///015 15/14 Q1017",
    "METAR LFML 121130Z AUTO 30004KT 9999 ///015CB BKN015/// 15/14 Q1017",
    "METAR LEMG 121130Z 30004KT 4000 1500NE BCFG FEW002 15/14 Q1017",
    "METAR LIRF 121130Z 30004KT 6000NE 2000SW 4000N HZ FEW020 15/14 Q1017",
    "METAR OERK 121100Z 35022G35KT 1500 BLDU NSC 41/M03 Q1002",
    "METAR OMDB 121100Z 35010KT 0000 R12L/P2000N R30R/M0050N FG NSC 20/20 Q1016",
    "METAR HECA 121100Z 240P99KT 5000 SA NSC 41/03 Q1002",
    "METAR ROAH 121100Z 09070G99KT 1000 +SHRA BKN005 FEW010CB 26/25 Q0958 RMK A2830",
    "METAR RJTT 121100Z 36005KT 320V040 9999 FEW030 12/01 Q1021 NOSIG RMK 1CU030 A3015",
    "METAR ZBAA 121100Z 36005MPS 9999 -SS SKC M02/M22 Q1031",
    "METAR VIDP 121100Z 00000KT 0050 R28/0125 R29/0150 FG VV000 07/07 Q1019 NOSIG",
    "METAR WSSS 121100Z 24010KT 200V270 9999 -TSRA FEW015CB SCT017TCU BKN300 25/24 Q1010",
    "METAR YSSY 121100Z 16015KT 9999 SCT020 18/12 Q1022 FM1230 18020G32KT",
    "METAR SBGR 121100Z 00000KT 9999 SCT025 22/// Q1018",
    "METAR SBBR 121100Z 09004KT 9999 SCT025 ///18 Q1018",
    "METAR NZSP 121100Z 02008KT 9999 IC FEW020 M67/ A2830 RMK",
    "METAR UEEE 121100Z 00000MPS 0200 FZFG VV001 M52/M56 Q1042",
    "METAR PANC 121100Z 00000KT 1/8SM FZUP OVC002 M01/M01 A2940",
    "METAR KDCA 121100Z AUTO 17/12 A3001 RMK AO2",
    "METAR KASE 121100Z AUTO 24009KT 10SM CLR A3012 RMK AO2 TSNO",
    "METAR K1J0 121100Z AUTO 24009KT 7SM -UP OVC010 03/02 A2990",
    "METAR BGTL 121100Z 09035G55KT 0100 +SN +BLSN VV001 M21/M24 A2910",
    "METAR LROP 121100Z 24002MPS 9999 FEW016 BKN020 M01/M03 Q1022 8829//99",
    "METAR LPPT 121100Z 33015KT 9999 PRFG FEW001 15/15 Q1020 RE//",
    "METAR MMMX 121100Z 00000KT 5SM FU HZ SKC 18/03 A3030 NOSIG RMK HZY",
    "METAR COR SVVA 171100Z 00000KT 9999 FEW016 BKN250 21/19 Q1013 NOSIG=",
    "EGLL 121120Z AUTO 00000KT 9999 NCD 10/M00 Q1013\nTEMPO 3000 BR",
    "METAR EGPD 121120Z 20012KT 9999 DZ SHRA BKN012 10/09 Q1003 A2962 INTER 3000",
];

/// Reports with words that are no group, and those words; everything else is read.
const UNREAD: &[(&str, &[&str])] = &[
    ("METAR UEEE 121100Z 00000MPS 9999 NSC M91/M92 Q1042", &["M91/M92"]),
    ("METAR UEEE 121100Z 00000MPS 9999 FEW015TCB 12/10 Q1042", &["FEW015TCB"]),
    ("METAR ENZV 121120Z 24032KT 9999 FEW025 09/05 Q1001 W60/S3", &["W60/S3"]),
    ("METAR ENZV 121120Z 24032KT 9999 FEW025 09/05 Q1001 8849", &["8849"]),
    ("METAR ENZV 121120Z 24032G20KT 9999 FEW025 09/05 Q1001", &["24032G20KT"]),
    ("METAR ENZV 121120Z 24032KT 9999 FEW025 09/05 Q1201", &["Q1201"]),
    ("METAR ENZV 121120Z 24032KT 1 FEW025 09/05 Q1001", &["1"]),
    ("METAR KCOF 191855Z 18015G22KT 7SM FEW049 SCT300 28/18 A3001 SLP162 RMK WND DATA ESTMD", &["SLP162"]),
    ("METAR LICJ 191855Z 18015KT 9999 FEW049 28/18 Q1012 CB/NE/E/W", &["CB/NE/E/W"]),
    ("METAR VIPK 130830Z 26004KT 1100 BR SKY OBS 10/07 Q1020 NOSIG", &["SKY", "OBS"]),
    ("METAR KCGF 260045Z 25005KY 10SM BKN040 20/10 A3005", &["25005KY"]),
    ("METAR KMER 111445Z 00000KT 8M OVC024 09/09 A3031", &["8M"]),
    ("METAR KDEN 321853Z 24009KT 10SM CLR 28/04 A3012", &["321853Z"]),
    // Words after an unknown word do not describe the weather now.
    ("METAR EGLL 121120Z 24010KT 9999 NCD 10/05 Q1013 TEMPORARY 3000 RA", &["TEMPORARY", "3000", "RA"]),
    ("METAR EGLL 121120Z 24010KT 9999 NCD 10/05 TEMPORARY 3000 RA Q1013", &["TEMPORARY", "3000", "RA"]),
];

/// Reports with groups joined, split, out of order, marked as missing or left out: every word is read.
const WHOLE: &[&str] = &[
    "KNXP 111456Z AUTO A3030 RMK AO2 SLPNO",
    "KMRH 111458Z AUTO RMK AO2 TSNO",
    "KJFX 092235Z AUTO 10SM CLR 14/11 A3015 RMK AO2 PWINO",
    "KONA 092235Z AUTO 14007KT 10SM 05/M02 RMK AO2",
    "KONA 092235Z AUTO 14007KT 10SM 05/M02",
    "K9L2 111458Z AUTO 00000KT 10SM SCT240 M A3026 RMK AO2",
    "KXYZ 111458Z AUTO M M M M/M AMMMM",
    "KAJO 111456Z AUTO 2 1/2SM BR CLR 07/07 A3022",
    "KGYR 092247Z KT 10SM BKN075 BKN180 25/08 A2972",
    "KSEE 111447Z 00000KT 1/4 SM FG OVC002 09/09 A3019",
    "KSEE 111447Z 24009 KT 1 1/4 SM BR OVC002 09/09 A3019",
    "KTRK 111445Z 00000KT 10SM SCT120BKN180 M04/M05 A3029",
    "KTRK 111445Z 00000KT10SM-SNBKN018 M04/M05A3029",
    "KCOF 281855Z FEW029TCU FEW040 SCT250 09008KT 7SM 32/25 A3008 RMK VIRGA",
    "KADW 252356Z COR AUTO 10008KT 10SM CLR 19/11 A2986",
    "EDDK 071350Z AUTO 25004KT 220V280 9999 3100 SHRA BKN036 BKN046 SCT///TCU 17/14 Q1013 BECMG NSW",
    "EDHI 180720Z 24004KT 210V270 2500 100NW R05/0300V0800U PRFG BR VV/// 13/13 Q1011",
    "EDDH 251020Z 26006KT 230V290 9999 R23///// R15///// FEW032 BKN080 26/19 Q1017 NOSIG",
    "UUDD 040830Z 20005MPS 170V240 9999 SCT039 27/17 Q1011 R88/60D NOSIG",
    "ESSA 210950Z 25010KT 210V280 9999 SCT029 17/10 Q1002 TEMP0 SCT035CB",
    "OMAA 200300Z 06006KT 8000 -RA FEW040 22/19 Q1012 WS ALL RWY TEMPO VRB30G45KT 1500 TSRA DIST CB TO NW",
    "YSDU 092109Z AUTO 08015G25KT 9999 // NCD 23/17 Q1016 RF00/0/004/6",
    "LSZL 300320Z AUTO 00000KT 9999NDV BKN060 OVC074 00/M04 Q1001 RMK=",
    "LEXX 24010KT 9999 FEW020 10/05 Q1013",
];

fn read(text: &str) -> MetarReport {
    Weather::from_metar(text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn of(station: &str) -> MetarReport {
    read(READ.iter().find(|t| t.contains(station)).unwrap())
}

#[test]
fn odd_reports_are_read_and_give_weather() {
    for text in READ {
        let w = read(text).weather;
        derive(&w).unwrap_or_else(|e| panic!("{text}: {e}"));
    }
}

#[test]
fn words_that_are_no_group_are_named_and_the_rest_is_read() {
    for (text, words) in UNREAD {
        let report = read(text);
        assert_eq!(report.unread, *words, "{text}");
        assert_eq!(&text[report.places.unread.clone()], words[0], "{text}");
        derive(&report.weather).unwrap_or_else(|e| panic!("{text}: {e}"));
    }
    let read = |i: usize| read(UNREAD[i].0);
    assert_eq!(read(0).assumed, ["temperature_c", "relative_humidity"]);
    assert_eq!((read(4).assumed, read(5).assumed), (vec!["wind"], vec!["pressure_hpa"]));
    assert_eq!((read(12).assumed, read(12).day), (vec!["time"], 0));
    for report in [read(13), read(14)] {
        assert_eq!((report.weather.precipitation.kind, report.visibility_is_minimum), (PrecipitationKind::None, true));
    }
    for text in READ.iter().chain(WHOLE) {
        assert!(self::read(text).unread.is_empty(), "{text}: {:?}", self::read(text).unread);
    }
}

#[test]
fn groups_left_out_marked_glued_or_out_of_order_are_read() {
    let of = |station| read(WHOLE.iter().find(|t| t.contains(station)).unwrap());
    let all = ["wind", "temperature_c", "relative_humidity", "pressure_hpa", "visibility_m", "precipitation", "clouds"];
    assert_eq!(of("KMRH").assumed, all);
    assert_eq!(of("KNXP").assumed, ["wind", "temperature_c", "relative_humidity", "visibility_m", "clouds"]);
    assert_eq!(of("KJFX").assumed, ["wind", "precipitation"]);
    assert_eq!(of("KONA").assumed, ["pressure_hpa", "clouds"]);
    assert_eq!(of("K9L2").assumed, ["temperature_c", "relative_humidity"]);
    assert_eq!((of("KGYR").assumed, of("KAJO").assumed), (vec!["wind"], vec!["wind"]));
    assert!((of("KAJO").weather.visibility_m - 2.5 * 1609.344).abs() < 1e-9);
    assert!((of("KSEE 111447Z 0").weather.visibility_m - 0.25 * 1609.344).abs() < 1e-9);
    let parted = of("KSEE 111447Z 2").weather;
    assert!((parted.visibility_m - 1.25 * 1609.344).abs() < 1e-9 && parted.wind.from_deg == 240.0);
    let bases = |r: &MetarReport| r.weather.clouds.iter().map(|c| (c.base_m / 0.3048).round()).collect::<Vec<_>>();
    assert_eq!(bases(&of("KTRK 111445Z 00000KT 10SM")), [12_000.0, 18_000.0]);
    let glued = of("10SM-SN");
    assert_eq!((bases(&glued), glued.weather.precipitation.kind), (vec![1800.0], PrecipitationKind::Snow));
    assert_eq!((glued.weather.temperature_c, glued.assumed.len()), (-4.0, 0));
    let shuffled = of("KCOF");
    assert!(shuffled.weather.wind.from_deg == 90.0 && bases(&shuffled).len() == 3 && shuffled.assumed.is_empty());
    assert_eq!((of("EDDK").lowest_visibility_m, of("EDHI").lowest_visibility_m), (Some(3100.0), Some(100.0)));
    assert!(of("EDDK").visibility_is_minimum && of("EDHI").weather.visibility_m == 2500.0);
    assert_eq!(of("ESSA").trend, "TEMP0 SCT035CB");
    assert_eq!((of("LEXX").assumed, of("KADW").corrected), (vec!["time"], true));
}

#[test]
fn a_text_without_any_weather_is_refused_at_the_word_at_fault() {
    let cases = [
        ("METAR EGLL 121120Z NIL", "NIL", "an observation"),
        ("METAR EGLL 121120Z AUTO NIL", "NIL", "an observation"),
        ("METAR EGLL 121120Z", "", "a group of the weather"),
        ("METAR EGLL 121120Z TOMORROW FINE", "TOMORROW", "a group of the weather"),
        ("METAR 121120Z 24010KT", "121120Z", "a station"),
        ("METAR AUTO 24010KT", "AUTO", "a station"),
    ];
    for (text, word, expected) in cases {
        let e = Weather::from_metar(text).unwrap_err();
        let at = if word.is_empty() { text.len() } else { text.find(word).unwrap() };
        let place = format!("line 1, column {}: expected {expected}", at + 1);
        assert!(e.status == Status::Parse && e.to_string().contains(&place), "{text}: {e}");
    }
}

#[test]
fn places_lead_into_the_text() {
    let text = " EHAM 090625Z\t00000KT 0150 R18R/0350N  R22/0400U FG VV001 03/03 Q1027 TEMPO\n 0300 RMK é  QFE=";
    let report = read(text);
    assert_eq!(&text[report.places.runways.clone()], "R18R/0350N  R22/0400U");
    assert_eq!(&text[report.places.trend.clone()], "TEMPO\n 0300");
    assert_eq!(&text[report.places.remarks.clone()], "é  QFE");
    assert_eq!((report.trend.as_str(), report.places.unread), ("TEMPO 0300", 0..0));
    assert_eq!(read("EHAM 090625Z 00000KT 0150 RMK").places, Default::default());
}

#[test]
fn unusual_groups_are_decoded_by_their_definition() {
    let thunder = of("EHAM").weather;
    assert!(!thunder.precipitation.thunderstorm, "thunder in the vicinity is not here");
    assert!(of("KABQ").weather.precipitation.thunderstorm);
    let hail = of("SPECI KMIA").weather.precipitation;
    assert!(hail.thunderstorm && hail.hail && hail.kind == PrecipitationKind::Rain);
    let sea = |station| of(station).weather.sea;
    assert_eq!((sea("ENZV").state, sea("ENZV").temperature_c), (None, None));
    assert_eq!((sea("ENAE").temperature_c, sea("ENFB").significant_wave_height_m), (Some(10.0), Some(7.5)));
    assert_eq!((sea("ENEK").significant_wave_height_m, sea("ENLE").state), (None, Some(6)));
    assert_eq!(of("CYYZ").weather.precipitation.kind, PrecipitationKind::Sleet);
    assert!(of("CYYZ").corrected && !of("CYVR").corrected && of("K1J0").automatic);
    assert_eq!(of("KMEM").weather.visibility_m.round(), 2414.0);
    assert_eq!(of("KORD").runways[0].trend, 1);
    assert!((of("KORD").runways[0].range_m - 609.6).abs() < 1e-9 && of("KORD").runways[0].is_minimum);
    assert_eq!(of("UUEE").weather.wind.variable_deg, Some((340.0, 50.0)));
    assert_eq!((of("UEEE").weather.temperature_c, of("NZSP").weather.temperature_c), (-52.0, -67.0));
    assert_eq!(of("LIRF").weather.visibility_m, 6000.0);
    let towering = of("EHGG");
    assert_eq!(towering.weather.clouds[1].kind, CloudKind::ToweringCumulus);
    assert_eq!(towering.assumed, ["clouds[].base_m", "clouds[].cover"]);
    assert_eq!(of("LFBO").weather.clouds[0].base_m.round(), 457.0);
    for missing in
        ["wind", "visibility_m", "precipitation", "clouds", "temperature_c", "relative_humidity", "pressure_hpa"]
    {
        assert!(of("ESSA").assumed.contains(&missing), "{missing}");
    }
    assert_eq!((of("YSSY").trend.as_str(), of("MMMX").remarks.as_str()), ("FM1230 18020G32KT", "HZY"));
}

/// 20,000 damaged reports: none panics, and each that is accepted gives a weather from which conditions derive.
#[test]
fn damaged_reports_do_not_panic_and_give_possible_weather() {
    // A linear congruential generator (Knuth, MMIX); the upper bits choose.
    let mut state = 0x5EED_u64;
    let mut pick = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    let pool: Vec<char> = "0123456789/MPVGRWSHKTQA+-= \n\tZé\u{0}".chars().collect();
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..20_000 {
        let reports = [READ, WHOLE][pick(2)];
        let mut text: Vec<char> = reports[pick(reports.len())].chars().collect();
        for _ in 0..=pick(2) {
            let at = pick(text.len().max(1)).min(text.len().saturating_sub(1));
            match pick(12) {
                0..=2 => text.insert(at, pool[pick(pool.len())]),
                3..=6 if !text.is_empty() => drop(text.remove(at)),
                7 => text.truncate(at),
                _ if !text.is_empty() => text[at] = pool[pick(pool.len())],
                _ => {}
            }
        }
        let text: String = text.into_iter().collect();
        match Weather::from_metar(&text) {
            Ok(report) => {
                accepted += 1;
                derive(&report.weather).unwrap_or_else(|e| panic!("{text:?}: {e}"));
            }
            Err(e) => {
                refused += 1;
                assert!(e.status == Status::Parse && e.to_string().contains(", column "), "{text:?}: {e}");
            }
        }
    }
    assert!(accepted > 1000 && refused > 1000, "{accepted} {refused}");
}
