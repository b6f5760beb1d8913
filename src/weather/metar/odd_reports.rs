//! Tests: reports as airports send them, with everything the code form (WMO-No. 306, FM 15) allows, and what comes out of damage.

use crate::Status;
use crate::weather::{CloudKind, MetarReport, PrecipitationKind, Weather, derive};

/// Reports that must be read, most of them with one group that is rare.
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

/// Reports that must be refused, with the word at fault.
const REFUSED: &[(&str, &str)] = &[
    ("METAR EGLL 121120Z NIL", "NIL"),
    ("METAR UEEE 121100Z 00000MPS 9999 NSC M91/M92 Q1042", "M91/M92"),
    ("METAR UEEE 121100Z 00000MPS 9999 NSC M60/M99 Q1042", "M60/M99"),
    ("METAR UEEE 121100Z 00000MPS 9999 FEW015TCB 12/10 Q1042", "FEW015TCB"),
    ("METAR ENZV 121120Z 24032KT 9999 FEW025 09/05 Q1001 W60/S3", "W60/S3"),
    ("METAR ENZV 121120Z 24032KT 9999 FEW025 09/05 Q1001 8849", "8849"),
    ("METAR ENZV 121120Z 24032G20KT 9999 FEW025 09/05 Q1001", "24032G20KT"),
    ("METAR ENZV 121120Z 24032KT 9999 FEW025 09/05 Q1201", "Q1201"),
    ("METAR ENZV 121120Z 24032KT 1 FEW025 09/05 Q1001", "1 FEW"),
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
fn refusals_point_at_the_word() {
    for (text, word) in REFUSED {
        let e = Weather::from_metar(text).unwrap_err();
        let place = format!("line 1, column {}:", text.find(word).unwrap() + 1);
        assert!(e.status == Status::Parse && e.to_string().contains(&place), "{text}: {}", e);
    }
    let e = Weather::from_metar(REFUSED[1].0).unwrap_err();
    assert!(e.to_string().contains("M90 to 60"), "{}", e);
}

#[test]
fn odd_groups_mean_what_they_say() {
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
    assert_eq!(towering.assumed, ["clouds[].base_m"]);
    for missing in ["wind", "visibility_m", "clouds", "temperature_c", "relative_humidity", "pressure_hpa"] {
        assert!(of("ESSA").assumed.contains(&missing), "{missing}");
    }
    assert_eq!((of("YSSY").trend.as_str(), of("MMMX").remarks.as_str()), ("FM1230 18020G32KT", "HZY"));
}

/// 20,000 damaged reports: none panics, and what is accepted is a weather that derives.
#[test]
fn damaged_reports_neither_panic_nor_give_what_cannot_be() {
    // Linear congruence (Knuth, MMIX): the upper bits pick.
    let mut state = 0x5EED_u64;
    let mut pick = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    let pool: Vec<char> = "0123456789/MPVGRWSHKTQA+-= \n\tZé\u{0}".chars().collect();
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..20_000 {
        let mut text: Vec<char> = READ[pick(READ.len())].chars().collect();
        for _ in 0..=pick(2) {
            let at = pick(text.len().max(1)).min(text.len().saturating_sub(1));
            match pick(12) {
                0..=2 => text.insert(at, pool[pick(pool.len())]),
                3..=6 if !text.is_empty() => drop(text.remove(at)),
                7 => text.truncate(at.max(20)),
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
                assert!(e.status == Status::Parse && !e.to_string().contains("column 1: weather"), "{text:?}: {e}");
            }
        }
    }
    assert!(accepted > 1000 && refused > 1000, "{accepted} {refused}");
}
