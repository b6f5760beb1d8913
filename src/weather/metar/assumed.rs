//! Values assumed for fields that a report leaves out.

use super::parse::Parsed;
use super::phenomena::{Descriptor, Intensity, Phenomenon, WeatherGroup};
use crate::weather::model::{Weather, saturation_pressure_hpa};

/// Names in [`super::MetarReport::assumed`]. Each is the field of [`Weather`] that holds an assumed value; `time` is
/// the report's own time. The order is that of the bits in the C API and never changes.
pub const ASSUMED_FIELDS: [&str; 12] = [
    "wind",
    "wind.from_deg",
    "visibility_m",
    "precipitation",
    "clouds",
    "clouds[].base_m",
    "clouds[].cover",
    "vertical_visibility_m",
    "temperature_c",
    "relative_humidity",
    "pressure_hpa",
    "time",
];

/// Relative humidity for a report without a dew point.
const HUMIDITY: f64 = 0.7;

/// Highest temperature that is assumed if snow without rain, snow grains, ice pellets or ice crystals fall, snow is
/// blown, or drops freeze, C.
///
/// Below -0.4 C more snow than rain falls at 97.5 % of 6883 stations of the northern hemisphere (Jennings, Winchell,
/// Livneh and Molotch 2018, Nature Communications 9, 1148). Freezing rain, freezing drizzle and ice pellets occur most
/// often slightly below 0 C (Cortinas, Bernstein, Robbins and Strapp 2004, Weather and Forecasting 19, 377).
const FROZEN_C: f64 = -1.0;
/// Highest temperature that is assumed if rain and snow fall together, or an instrument cannot tell them apart, C. On
/// average over the same stations, both are equally likely at this temperature (Jennings et al. 2018).
const MIXED_C: f64 = 1.0;

/// Returns the upper bound that a group of weather sets to the temperature, C; `None` without one.
fn bound_c(g: &WeatherGroup) -> Option<f64> {
    use {Descriptor as D, Phenomenon as P};
    let has = |p: P| g.phenomena.contains(&p);
    let liquid = has(P::Rain) || has(P::Drizzle);
    let frozen = has(P::IcePellets) || has(P::SnowGrains) || has(P::IceCrystals) || (has(P::Snow) && !liquid);
    if g.descriptor == Some(D::Freezing) || frozen {
        Some(FROZEN_C)
    } else {
        (has(P::Snow) || has(P::UnknownPrecipitation)).then_some(MIXED_C)
    }
}

/// Returns the temperature at which air of dew point `dew_c` has [`HUMIDITY`], C: the inverse of
/// [`saturation_pressure_hpa`].
fn temperature_of_dew_c(dew_c: f64) -> f64 {
    let x = libm::log(saturation_pressure_hpa(dew_c) / HUMIDITY / 6.112);
    243.12 * x / (17.62 - x)
}

/// Sets temperature and humidity to the reported values, or to values that the reported weather and dew point allow.
/// Adds the names of assumed fields to `assumed`.
///
/// A missing temperature is 15 C, or follows from the dew point at a humidity of 70 %. It is at most the bound that the
/// weather at the station sets, but not below the reported dew point, and at most 60 C. Without a dew point the
/// humidity is 70 %.
pub(super) fn temperature_and_humidity(p: &Parsed, w: &mut Weather, assumed: &mut Vec<&'static str>) {
    if let Some(t) = p.temperature_c {
        w.temperature_c = t;
    } else {
        let here = p.weather.iter().filter(|g| g.intensity != Intensity::Vicinity);
        let bound = here.filter_map(bound_c).min_by(f64::total_cmp).unwrap_or(f64::INFINITY);
        let likely = p.dew_point_c.map_or(w.temperature_c, temperature_of_dew_c).min(bound);
        w.temperature_c = likely.max(p.dew_point_c.unwrap_or(likely)).min(60.0);
        assumed.push("temperature_c");
    }
    match p.dew_point_c {
        Some(dew) => w.set_dew_point_c(dew),
        None => w.relative_humidity = HUMIDITY,
    }
    if p.temperature_c.is_none() || p.dew_point_c.is_none() {
        assumed.push("relative_humidity");
    }
}

/// Returns the largest visibility that the present weather allows if the report gives none, m: 1 km in fog and in dust
/// and sand storms; 5 km in mist, haze, smoke, volcanic ash, dust and sand (WMO-No. 306, code table 4678 and 15.8.17);
/// infinite otherwise. Phenomena that are shallow, patchy, partial, drifting or only in the vicinity set no bound.
pub(super) fn visibility_bound_m(p: &Parsed) -> f64 {
    use {Descriptor as D, Phenomenon as P};
    let bound = |g: &WeatherGroup| {
        let aside = matches!(g.descriptor, Some(D::Shallow | D::Patches | D::Partial | D::Drifting));
        let least = |x: &P| match x {
            _ if aside => f64::INFINITY,
            P::Fog | P::DustStorm | P::SandStorm => 1000.0,
            P::Mist | P::Haze | P::Smoke | P::Dust | P::Sand | P::VolcanicAsh => 5000.0,
            _ => f64::INFINITY,
        };
        g.phenomena.iter().map(least).fold(f64::INFINITY, f64::min)
    };
    p.weather.iter().filter(|g| g.intensity != Intensity::Vicinity).map(bound).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{PrecipitationKind as K, derive};

    fn of(groups: &str) -> Weather {
        let text = format!("METAR KXYZ 121150Z AUTO 24008KT {groups} OVC010 A2992 RMK AO2");
        let report = Weather::from_metar(&text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert!(report.assumed.contains(&"temperature_c"), "{text}: {:?}", report.assumed);
        report.weather
    }

    #[test]
    fn precipitation_limits_the_assumed_temperature() {
        for (groups, celsius) in [
            ("10SM", 15.0),
            ("3SM RA BR", 15.0),
            ("3SM TSRA", 15.0),
            ("1SM SN", FROZEN_C),
            ("1SM -SHSN", FROZEN_C),
            ("1/4SM SN BLSN", FROZEN_C),
            ("3SM DRSN", FROZEN_C),
            ("2SM -FZRA", FROZEN_C),
            ("2SM FZDZ BR", FROZEN_C),
            ("1/4SM FZFG", FROZEN_C),
            ("2SM FZUP", FROZEN_C),
            ("3SM PLRA", FROZEN_C),
            ("3SM SG", FROZEN_C),
            ("3SM IC", FROZEN_C),
            ("3SM RASN", MIXED_C),
            ("3SM -SNRA", MIXED_C),
            ("3SM UP", MIXED_C),
            ("3SM RA VCSHSN", 15.0),
        ] {
            assert_eq!(of(groups).temperature_c, celsius, "{groups}");
        }
    }

    #[test]
    fn ground_and_drops_go_with_the_assumed_temperature() {
        let snow = derive(&of("1/2SM SN")).unwrap();
        assert_eq!((snow.surface.wetness, snow.precipitation.rain_mm_h), (0.0, 0.0), "snow on dry ground");
        let freezing = of("2SM FZRA");
        assert!(freezing.temperature_c < 0.0 && derive(&freezing).unwrap().surface.ice > 0.9);
        let unknown = of("5SM UP").precipitation;
        assert!(unknown.kind == K::Sleet && unknown.rate_mm_h < 5.0, "{unknown:?}");
    }

    #[test]
    fn fog_and_haze_bound_a_missing_visibility() {
        let of = |groups: &str| {
            let report =
                Weather::from_metar(&format!("METAR LFXX 121100Z AUTO 09004KT //// {groups} NSC 14/13 Q1018")).unwrap();
            assert!(
                report.assumed == ["visibility_m"] && report.visibility_is_minimum,
                "{groups}: {:?}",
                report.assumed
            );
            report.weather.visibility_m
        };
        assert_eq!((of("FG"), of("+DS"), of("BR"), of("-RA HZ")), (1000.0, 1000.0, 5000.0, 5000.0));
        assert!(of("BCFG") > 5000.0 && of("VCFG") > 5000.0 && of("-RA") > 5000.0);
    }

    #[test]
    fn a_dew_point_alone_is_kept() {
        for (dew, groups, celsius) in
            [(18.0, "9999", 23.8), (18.0, "9999 RA", 23.8), (-4.0, "2000 SN", -1.0), (-4.0, "9999", 0.8)]
        {
            let sign = if dew < 0.0 { "M" } else { "" };
            let text = format!("METAR SBBR 121100Z 09004KT {groups} SCT025 ///{sign}{:02} Q1018", f64::abs(dew));
            let w = Weather::from_metar(&text).unwrap().weather;
            assert!((w.dew_point_c() - dew).abs() < 1e-6 && (w.temperature_c - celsius).abs() < 0.1, "{text}: {w:?}");
        }
    }
}
