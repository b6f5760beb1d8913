//! Conversion of a report to a weather: words of intensity become rates, classes become values.

use super::amounts;
use super::assumed;
use super::groups::CloudGroup;
use super::parse::Parsed;
use super::phenomena::{Descriptor, Intensity, Phenomenon, WeatherGroup};
use super::report::{MetarOptions, MetarReport};
use crate::error::{Result, Status};
use crate::weather::kinds::{AerosolKind, CloudAmountRule, CloudKind, FogKind, LoftedKind, PrecipitationKind};
use crate::weather::model::{Aerosol, CloudLayer, Fog, Lofted, Precipitation, Sea, Weather, Wind};
use crate::weather::{LN_20, air, hydrometeors, particles, precipitation};

/// Base of a layer whose height the report leaves out, m.
const ASSUMED_BASE_M: f64 = 600.0;
/// Vertical visibility of an obscured sky without a figure, m.
const ASSUMED_VERTICAL_M: f64 = 60.0;

/// Returns the rates for light, moderate and heavy precipitation, mm/h: about the middles of the classes (the heavy
/// class is open).
///
/// Rain: AMS Glossary (bounds 2.5 and 7.6 mm/h). Showers: WMO-No. 8 (2.5, 10 and 50). Drizzle: AMS (0.3 and 0.5). Snow
/// in melted water: Rasmussen et al. 1999 (1.0 and 2.5). The row of snow is not used: [`snow_rate_mm_h`] computes that
/// rate from the visibility.
fn class_rate_mm_h(kind: PrecipitationKind, convective: bool) -> [f64; 3] {
    use PrecipitationKind as K;
    match kind {
        K::None => [0.0; 3],
        K::Drizzle | K::FreezingDrizzle => [0.15, 0.4, 0.8],
        K::Rain | K::Hail | K::SmallHail if convective => [1.5, 6.0, 30.0],
        K::Rain | K::FreezingRain | K::IcePellets => [1.3, 5.0, 15.0],
        K::Hail | K::SmallHail => [1.3, 5.0, 15.0],
        K::Sleet => [1.0, 3.0, 8.0],
        K::Snow => [0.5, 1.7, 4.0],
        K::SnowGrains => [0.1, 0.3, 0.6],
        K::IceCrystals => [0.02, 0.05, 0.1],
    }
}

/// Bounds of the classes of rain, mm/h: steady (AMS) and convective (WMO-No. 8).
const RAIN_CLASSES_MM_H: [[(f64, f64); 3]; 2] =
    [[(0.1, 2.5), (2.5, 7.6), (7.6, 50.0)], [(0.1, 2.5), (2.5, 10.0), (10.0, 50.0)]];

/// Returns the rate of rain, mm/h: the middle of the class, but at most the rate with `extinction_per_m`, the
/// extinction that the reported visibility leaves for rain. The rate stays within the bounds of the class.
fn rain_rate_mm_h(kind: PrecipitationKind, intensity: Intensity, convective: bool, extinction_per_m: f64) -> f64 {
    let (lo, hi) = RAIN_CLASSES_MM_H[usize::from(convective)][class(intensity)];
    let middle = class_rate_mm_h(kind, convective)[class(intensity)];
    middle.min(hydrometeors::rain_rate_mm_h(extinction_per_m)).clamp(lo, hi)
}

/// Bounds of the classes of snowfall in melted water, mm/h (Rasmussen et al. 1999).
const SNOW_CLASSES_MM_H: [(f64, f64); 3] = [(0.05, 1.0), (1.0, 2.5), (2.5, 10.0)];

fn class(intensity: Intensity) -> usize {
    match intensity {
        Intensity::Light => 0,
        Intensity::Heavy => 2,
        _ => 1,
    }
}

/// Returns the rate of snow that gives the reported visibility, mm/h of melted water. `extinction_per_m` is the
/// extinction of this visibility minus that of the air. `shared` says that the report also names fog, mist or any
/// matter lifted by the wind: snow then gets six tenths of the extinction. The rate is limited to the bounds of the
/// reported intensity.
fn snow_rate_mm_h(intensity: Intensity, extinction_per_m: f64, shared: bool) -> f64 {
    let (lo, hi) = SNOW_CLASSES_MM_H[class(intensity)];
    hydrometeors::snow_rate_mm_h(extinction_per_m * if shared { 0.6 } else { 1.0 }).clamp(lo, hi)
}

/// Returns the kind of a group's precipitation, and its liquid share if the group names liquid and frozen forms. `None`
/// means the usual share of the kind.
fn falling_kind(g: &WeatherGroup, temperature_c: f64) -> (PrecipitationKind, Option<f64>) {
    use {Phenomenon as P, PrecipitationKind as K};
    let has = |p: P| g.phenomena.contains(&p);
    let freezing = g.descriptor == Some(Descriptor::Freezing);
    let first = g.phenomena.iter().copied().find(|p| p.falls());
    // The predominant type is named first (WMO-No. 306, 15.8.9).
    let liquid_first = first.is_some_and(|p| matches!(p, P::Rain | P::Drizzle));
    let part = Some(if liquid_first { 0.6 } else { 0.4 });
    let liquid = has(P::Rain) || has(P::Drizzle);
    match first {
        None => (K::None, None),
        _ if freezing && liquid && !has(P::Rain) => (K::FreezingDrizzle, None),
        _ if freezing && liquid => (K::FreezingRain, None),
        _ if liquid && has(P::IcePellets) => (K::IcePellets, part),
        _ if liquid && has(P::Snow) => (K::Sleet, part),
        _ if has(P::Rain) => (K::Rain, None),
        Some(P::Drizzle) => (K::Drizzle, None),
        Some(P::Snow) => (K::Snow, None),
        Some(P::SnowGrains) => (K::SnowGrains, None),
        Some(P::IceCrystals) => (K::IceCrystals, None),
        Some(P::IcePellets) => (K::IcePellets, None),
        Some(P::Hail) => (K::Hail, None),
        Some(P::SmallHail) => (K::SmallHail, None),
        // Unknown precipitation: snow melts above about 2 C and survives below about 0 (Matsuo and Sasyo 1981).
        Some(P::UnknownPrecipitation) if freezing => (K::FreezingRain, None),
        Some(P::UnknownPrecipitation) if temperature_c > 2.0 => (K::Rain, None),
        Some(P::UnknownPrecipitation) if temperature_c > 0.0 => (K::Sleet, None),
        Some(P::UnknownPrecipitation) => (K::Snow, None),
        _ => (K::None, None),
    }
}

fn precipitation(p: &Parsed, w: &Weather) -> Precipitation {
    use Phenomenon as P;
    let here = |g: &&WeatherGroup| g.intensity != Intensity::Vicinity;
    // Thunder in the vicinity (VCTS) is not at the station.
    let thunder = p.weather.iter().filter(here).any(|g| g.descriptor == Some(Descriptor::Thunderstorm));
    let falls = |g: &&WeatherGroup| {
        here(g) && g.descriptor != Some(Descriptor::Blowing) && g.descriptor != Some(Descriptor::Drifting)
    };
    let Some(g) = p.weather.iter().filter(falls).find(|g| g.phenomena.iter().any(|x| x.falls())) else {
        return Precipitation { thunderstorm: thunder, ..Precipitation::default() };
    };
    let (kind, liquid_fraction) = falling_kind(g, w.temperature_c);
    let showers = g.descriptor == Some(Descriptor::Showers);
    let left = (LN_20 / w.visibility_m - air::RAYLEIGH_550_PER_M).max(0.0);
    let shared = w.fog.kind != FogKind::None || w.lofted.kind != LoftedKind::None;
    let rate_mm_h = match kind {
        PrecipitationKind::Snow => snow_rate_mm_h(g.intensity, left, shared),
        PrecipitationKind::Rain | PrecipitationKind::FreezingRain => {
            rain_rate_mm_h(kind, g.intensity, showers || thunder, left)
        }
        kind => class_rate_mm_h(kind, showers || thunder)[class(g.intensity)],
    };
    let hail = p.weather.iter().filter(here).any(|g| g.phenomena.iter().any(|x| matches!(x, P::Hail | P::SmallHail)));
    let hail_is_all = matches!(kind, PrecipitationKind::Hail | PrecipitationKind::SmallHail);
    Precipitation { kind, rate_mm_h, liquid_fraction, showers, thunderstorm: thunder, hail: hail && !hail_is_all }
}

/// Sets fog, particles and lifted matter from all groups at the station.
fn obscurations(p: &Parsed, w: &mut Weather) {
    use {Descriptor as D, Phenomenon as P};
    for g in p.weather.iter().filter(|g| g.intensity != Intensity::Vicinity) {
        for &x in &g.phenomena {
            match (x, g.descriptor) {
                (P::Fog, d) => {
                    w.fog = Fog::of(match d {
                        Some(D::Shallow) => FogKind::Shallow,
                        Some(D::Patches) => FogKind::Patches,
                        Some(D::Partial) => FogKind::Partial,
                        Some(D::Freezing) => FogKind::Freezing,
                        _ => FogKind::Fog,
                    });
                }
                (P::Mist, _) if w.fog.kind == FogKind::None => w.fog = Fog::of(FogKind::Mist),
                (P::Haze, _) => w.aerosol = Aerosol::of(AerosolKind::Haze),
                (P::Smoke, _) => w.aerosol = Aerosol::of(AerosolKind::Smoke),
                (P::VolcanicAsh, _) => w.aerosol = Aerosol::of(AerosolKind::VolcanicAsh),
                (P::Snow, Some(D::Blowing)) => w.lofted = Lofted::of(LoftedKind::BlowingSnow),
                (P::Snow, Some(D::Drifting)) => w.lofted = Lofted::of(LoftedKind::DriftingSnow),
                (P::Dust | P::Sand, Some(D::Drifting)) => w.lofted = Lofted::of(LoftedKind::DriftingDust),
                (P::Dust, Some(D::Blowing)) | (P::DustStorm, _) => lift(w, LoftedKind::BlowingDust, AerosolKind::Dust),
                (P::Sand, Some(D::Blowing)) | (P::SandStorm, _) => lift(w, LoftedKind::BlowingSand, AerosolKind::Sand),
                (P::Dust, _) => w.aerosol = Aerosol::of(AerosolKind::Dust),
                (P::Sand, _) => w.aerosol = Aerosol::of(AerosolKind::Sand),
                (P::Spray, _) => w.lofted = Lofted::of(LoftedKind::BlowingSpray),
                _ => {}
            }
        }
    }
}

fn lift(w: &mut Weather, lofted: LoftedKind, aerosol: AerosolKind) {
    w.lofted = Lofted::of(lofted);
    w.aerosol = Aerosol::of(aerosol);
}

/// Sets the layers of the report by `rule`, and the vertical visibility.
fn clouds(p: &Parsed, rule: CloudAmountRule, w: &mut Weather, assumed: &mut Vec<&'static str>) {
    let groups =
        p.clouds.iter().filter_map(|g| if let CloudGroup::Layer { amount, .. } = g { Some(*amount) } else { None });
    let mut covers = amounts::covers(&groups.collect::<Vec<_>>(), rule).into_iter();
    let mut assume = |name, missing| {
        if missing && !assumed.contains(&name) {
            assumed.push(name);
        }
    };
    assume("clouds", p.clouds.is_empty() && !p.cavok);
    for group in &p.clouds {
        match *group {
            CloudGroup::Layer { amount, base_m, kind } => {
                assume("clouds[].base_m", base_m.is_none());
                assume("clouds[].cover", amount.is_none());
                let cover = covers.next().unwrap_or(0.0);
                w.clouds.push(CloudLayer::of(kind, cover, base_m.unwrap_or(ASSUMED_BASE_M).min(20_000.0)));
            }
            CloudGroup::Obscured(vertical_m) => {
                assume("vertical_visibility_m", vertical_m.is_none());
                w.vertical_visibility_m = Some(vertical_m.unwrap_or(ASSUMED_VERTICAL_M).min(10_000.0));
            }
            CloudGroup::Missing => assume("clouds", true),
            CloudGroup::Clear => {}
        }
    }
    name_the_thundercloud(w);
}

/// Makes sure that thunder has a cumulonimbus. If no layer is one, the lowest that covers half the sky becomes one, or
/// the lowest of all if none covers half.
fn name_the_thundercloud(w: &mut Weather) {
    let named = w.clouds.iter().any(|c| c.kind == CloudKind::Cumulonimbus);
    if !w.precipitation.thunderstorm || named {
        return;
    }
    let lowest = w.clouds.iter_mut().filter(|c| c.cover > 0.0).min_by(|a, b| {
        let thin = |c: &CloudLayer| c.cover < 0.5;
        thin(a).cmp(&thin(b)).then(a.base_m.total_cmp(&b.base_m))
    });
    if let Some(layer) = lowest {
        layer.kind = CloudKind::Cumulonimbus;
    }
}

fn wind(p: &Parsed, assumed: &mut Vec<&'static str>) -> Wind {
    let Some(g) = p.wind else {
        assumed.push("wind");
        return Wind::default();
    };
    let all_round = (g.variable && g.speed_m_s > 0.0).then_some((0.0, 360.0));
    if g.from_deg.is_none() && !g.variable {
        assumed.push("wind.from_deg");
    }
    Wind {
        gust_m_s: g.gust_m_s,
        variable_deg: p.wind_range.or(all_round),
        ..Wind::of(g.speed_m_s, g.from_deg.unwrap_or(0.0))
    }
}

/// Returns the visibility, m. If the report gives only a lower bound, the visibility follows from humidity and
/// precipitation, and is at least that bound. If the report gives no visibility, it is at most what the reported fog or
/// haze allows.
fn visibility_m(p: &Parsed, w: &Weather, assumed: &mut Vec<&'static str>) -> f64 {
    let (least, most) = match p.visibility {
        _ if p.cavok => (10_000.0, f64::INFINITY),
        Some(v) if !v.at_least => return v.metres.min(1e6),
        Some(v) => (v.metres, f64::INFINITY),
        None => {
            assumed.push("visibility_m");
            (0.0, assumed::visibility_bound_m(p))
        }
    };
    let falling = precipitation::falling(&w.precipitation).extinction_per_m();
    particles::unlimited_visibility_m(w.relative_humidity, falling).clamp(least, most)
}

/// Converts a report to its weather and circumstances.
///
/// # Errors
/// [`Status::Parse`] if [`Weather::validate`] refuses the weather. This guards against a group that is read with a
/// wider range than its field has.
pub(super) fn report(p: Parsed, options: &MetarOptions) -> Result<MetarReport> {
    let rule = match options.cloud_amounts {
        CloudAmountRule::ByStation => amounts::rule_of(&p.station),
        set => set,
    };
    let mut assumed = Vec::new();
    let weather = weather(&p, rule, &mut assumed)?;
    if p.time.is_none() {
        assumed.push("time");
    }
    let (day, hour, minute) = p.time.unwrap_or_default();
    Ok(MetarReport {
        weather,
        day,
        hour,
        minute,
        special: p.special,
        automatic: p.automatic,
        corrected: p.corrected,
        visibility_is_minimum: p.cavok || p.visibility.is_none_or(|v| v.at_least),
        lowest_visibility_m: p.lowest_visibility_m,
        cloud_amounts: rule,
        station: p.station,
        runways: p.runways,
        assumed,
        unread: p.unread,
        trend: p.trend,
        remarks: p.remarks,
        places: p.places,
    })
}

fn weather(p: &Parsed, rule: CloudAmountRule, assumed: &mut Vec<&'static str>) -> Result<Weather> {
    let mut w = Weather { wind: wind(p, assumed), ..Weather::default() };
    assumed::temperature_and_humidity(p, &mut w, assumed);
    match p.pressure_hpa {
        Some(hpa) => w.pressure_hpa = hpa,
        None => assumed.push("pressure_hpa"),
    }
    obscurations(p, &mut w);
    // The rate of snow needs the visibility, and a visibility without an upper bound needs the rate. The rate is
    // therefore computed from a first value of the visibility.
    w.visibility_m = p.visibility.map_or(10_000.0, |v| v.metres);
    w.precipitation = precipitation(p, &w);
    w.visibility_m = visibility_m(p, &w, assumed);
    if p.weather_unknown && p.weather.is_empty() {
        assumed.push("precipitation");
    }
    clouds(p, rule, &mut w, assumed);
    w.runway_visual_range_m = p.runways.iter().map(|r| r.range_m).min_by(f64::total_cmp).map(|m| m.min(10_000.0));
    if let Some(sea) = p.sea {
        let background = w.aerosol.kind == AerosolKind::Continental;
        w.aerosol = if background { Aerosol::of(AerosolKind::Maritime) } else { w.aerosol };
        w.sea = Sea {
            state: sea.state,
            significant_wave_height_m: sea.wave_height_m,
            temperature_c: sea.temperature_c,
            swell: None,
        };
    }
    w.validate().map_err(|e| e.with_status(Status::Parse).found_in("METAR line 1, column 1"))?;
    Ok(w)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covers(station: &str, rule: CloudAmountRule, groups: &str) -> (Vec<f64>, CloudAmountRule) {
        let text = format!("METAR {station} 121150Z 24008KT 9999 {groups} 12/08 Q1015");
        let report = Weather::from_metar_with(&text, &MetarOptions { cloud_amounts: rule }).unwrap();
        (report.weather.clouds.iter().map(|c| c.cover).collect(), report.cloud_amounts)
    }

    fn assert_near(got: &[f64], want: &[f64]) {
        let near = got.len() == want.len() && got.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near, "{got:?} where {want:?} is wanted");
    }

    #[test]
    fn amounts_count_by_the_station_or_by_the_rule_that_is_set() {
        use CloudAmountRule as R;
        let [few, sct, bkn] = [1.5, 3.5, 6.0].map(|eighths| eighths / 8.0);
        let groups = "FEW010 SCT020 BKN040";
        let sums = [few, (sct - few) / (1.0 - few), (bkn - sct) / (1.0 - sct)];
        for (station, set, taken) in [
            ("EGLL", R::ByStation, R::Layers),
            ("KADW", R::ByStation, R::Sums),
            ("EGLL", R::Sums, R::Sums),
            ("KADW", R::Layers, R::Layers),
        ] {
            let (got, said) = covers(station, set, groups);
            assert_near(&got, &if taken == R::Sums { sums } else { [few, sct, bkn] });
            assert_eq!(said, taken, "{station}");
        }
        assert_near(&covers("LFPG", R::ByStation, "OVC020 BKN045").0, &[1.0, bkn]);
        // The highest group gives the total hidden sky.
        let clear: f64 = covers("KADW", R::ByStation, groups).0.iter().map(|c| 1.0 - c).product();
        assert!((1.0 - clear - bkn).abs() < 1e-12, "{clear}");
    }

    #[test]
    fn towers_count_in_american_sums_and_beside_other_layers() {
        use CloudAmountRule as R;
        let [few, sct, bkn] = [1.5, 3.5, 6.0].map(|eighths| eighths / 8.0);
        assert_near(&covers("LOWI", R::ByStation, "FEW015CB SCT020 BKN040").0, &[few, sct, bkn]);
        let sums = [few, (sct - few) / (1.0 - few), (bkn - sct) / (1.0 - sct)];
        assert_near(&covers("KABQ", R::ByStation, "FEW033 SCT075CB BKN100").0, &sums);
    }
}
