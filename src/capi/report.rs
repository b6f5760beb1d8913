//! Weather reports and presets
//!
//! These functions turn a METAR or SPECI report, as airports send it, into a wk_weather. Welkin reads the groups that
//! are present, in any order up to the pressure. Fields that the report leaves out or marks as missing keep their
//! defaults, or get values that the rest of the report makes likely; each has a bit in wk_metar.assumed. A calm wind
//! (00000KT) and one that nobody measured (/////KT) thus differ by WK_METAR_ASSUMED_WIND. Words that are no group of
//! the code change nothing and are counted.
//!
//! No report contains the altitude of its station: weather.station_altitude_m is 0 afterwards. Look wk_metar.station up
//! in your list of airports and set the altitude, because cloud bases, visibility and temperature refer to that height.

use std::{
    ffi::{CString, c_char, c_void},
    ptr::null,
    sync::OnceLock,
};

use super::{
    boundary::{
        guard, input,
        layout::{self, init_struct, struct_size},
        numbers::*,
    },
    weather::{wk_cloud_layer, wk_weather},
    weather_convert::{WeatherOut, weather_out},
};
use crate::{
    error::{Error, Result, Status},
    weather::{ASSUMED_FIELDS, CloudAmountRule, MetarOptions, MetarReport, Weather},
};

include!(concat!(env!("OUT_DIR"), "/init_report.rs"));

/// Properties of a report.
pub type wk_metar_flags = u32;
/// A special report (SPECI).
pub const WK_METAR_SPECIAL: wk_metar_flags = 1;
/// Made without an observer (AUTO).
pub const WK_METAR_AUTOMATIC: wk_metar_flags = 2;
/// A correction (COR).
pub const WK_METAR_CORRECTED: wk_metar_flags = 4;
/// The report gives only a lower limit of the visibility (CAVOK, 9999, 10SM), or no visibility.
pub const WK_METAR_VISIBILITY_IS_MINIMUM: wk_metar_flags = 8;

/// Fields that a report leaves out or marks as missing.
pub type wk_metar_assumed_flags = u32;
/// wind_speed_m_s and the rest of the wind: calm is assumed.
pub const WK_METAR_ASSUMED_WIND: wk_metar_assumed_flags = 0x1;
/// wind_from_deg: 0 is assumed.
pub const WK_METAR_ASSUMED_WIND_DIRECTION: wk_metar_assumed_flags = 0x2;
/// visibility_m: the visibility that humidity and precipitation allow is assumed. It is at most 1 km in fog, dust
/// storms and sandstorms, and at most 5 km in mist, haze, smoke, volcanic ash, dust and sand.
pub const WK_METAR_ASSUMED_VISIBILITY: wk_metar_assumed_flags = 0x4;
/// Present weather (`//`, or PWINO in the remarks): neither precipitation nor fog nor haze is assumed.
pub const WK_METAR_ASSUMED_PRECIPITATION: wk_metar_assumed_flags = 0x8;
/// Clouds (`//////`, or no group at all): none are assumed besides those that are reported.
pub const WK_METAR_ASSUMED_CLOUDS: wk_metar_assumed_flags = 0x10;
/// base_m of a layer (`BKN///`): 600 m is assumed.
pub const WK_METAR_ASSUMED_CLOUD_BASE: wk_metar_assumed_flags = 0x20;
/// cover of a layer (`///015`, `//////CB`): 3.5 eighths are assumed. With WK_CLOUD_AMOUNT_SUMS the group takes the
/// largest class of the groups below it instead (FEW if there are none), except above an overcast layer.
pub const WK_METAR_ASSUMED_CLOUD_COVER: wk_metar_assumed_flags = 0x40;
/// vertical_visibility_m (`VV///`): 60 m is assumed.
pub const WK_METAR_ASSUMED_VERTICAL_VISIBILITY: wk_metar_assumed_flags = 0x80;
/// temperature_c: 15 is assumed, or, if the dew point is reported, the temperature for a relative humidity of 0.7. The
/// assumed temperature is at most -1 in snow, ice pellets, snow grains, ice crystals and freezing precipitation or fog,
/// and at most 1 where rain and snow fall together or the precipitation is unknown. It is never below the reported dew
/// point.
pub const WK_METAR_ASSUMED_TEMPERATURE: wk_metar_assumed_flags = 0x100;
/// relative_humidity: 0.7 is assumed, or the humidity that a reported dew point gives at the assumed temperature.
pub const WK_METAR_ASSUMED_HUMIDITY: wk_metar_assumed_flags = 0x200;
/// pressure_hpa: 1013.25 is assumed.
pub const WK_METAR_ASSUMED_PRESSURE: wk_metar_assumed_flags = 0x400;
/// wk_metar.day, hour and minute: 0 is assumed.
pub const WK_METAR_ASSUMED_TIME: wk_metar_assumed_flags = 0x800;

/// Meaning of the amounts in cloud groups. Nations differ, and a report does not say which practice it follows.
pub type wk_cloud_amount_rule = u32;
/// By the first letters of the station: sums in the United States with its territories and in Canada (K, C; P except PC
/// and PL; TI, TJ, NSTU, MUGM), layers elsewhere. American bases abroad report sums under the host country's letters:
/// set the rule for them.
pub const WK_CLOUD_AMOUNT_BY_STATION: wk_cloud_amount_rule = 0;
/// The amount of a group is the cover of its layer and all lower ones together (Federal Meteorological Handbook No. 1,
/// 9.4.2 b and 9.5.2).
pub const WK_CLOUD_AMOUNT_SUMS: wk_cloud_amount_rule = 1;
/// The amount of a group is the cover of its layer as if there were no other cloud (WMO-No. 306, FM 15, 15.9.1.2).
pub const WK_CLOUD_AMOUNT_LAYERS: wk_cloud_amount_rule = 2;

/// Options for reading a report.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_metar_options {
    /// sizeof(wk_metar_options) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_METAR_OPTIONS.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Meaning of the amounts in cloud groups. Default WK_CLOUD_AMOUNT_BY_STATION.
    pub cloud_amounts: wk_cloud_amount_rule,
    /// Must be 0.
    pub reserved0: u32,
}

impl wk_metar_options {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_METAR_OPTIONS,
        next: null(),
        cloud_amounts: WK_CLOUD_AMOUNT_BY_STATION,
        reserved0: 0,
    };
}

/// Place and time of a report, and the parts of it that wk_weather has no fields for. Offsets and lengths are bytes in
/// the text that you passed; 0 and 0 where the report has no such part.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_metar {
    /// sizeof(wk_metar) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_METAR.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// ICAO location indicator, NUL-terminated.
    pub station: [c_char; 8],
    /// Day of the month, UTC.
    pub day: u32,
    /// Hour, UTC.
    pub hour: u32,
    /// Minute, UTC.
    pub minute: u32,
    /// Properties of the report: a union of WK_METAR_SPECIAL and the flags that follow it.
    pub flags: wk_metar_flags,
    /// Fields that the report leaves out or marks as missing.
    pub assumed: wk_metar_assumed_flags,
    /// Rule by which the amounts of clouds were read: WK_CLOUD_AMOUNT_SUMS or WK_CLOUD_AMOUNT_LAYERS.
    pub cloud_amounts: wk_cloud_amount_rule,
    /// Lowest visibility in some direction, m, where the report states one besides the prevailing visibility
    /// (`4000 1500NE`, `9999 3100`), else 0. For information: the weather has the prevailing visibility.
    pub lowest_visibility_m: f64,
    /// Offset of the first runway visual range.
    pub runways_offset: u32,
    /// Length of the runway visual ranges, from the first to the last, bytes.
    pub runways_length: u32,
    /// Offset of the trend forecast, whose first word (NOSIG, BECMG, TEMPO) is included.
    pub trend_offset: u32,
    /// Length of the trend forecast, bytes.
    pub trend_length: u32,
    /// Offset of the remarks, after RMK.
    pub remarks_offset: u32,
    /// Length of the remarks, bytes.
    pub remarks_length: u32,
    /// Offset of the first word that is no group of the code.
    pub unread_offset: u32,
    /// Length of this first word, bytes.
    pub unread_length: u32,
    /// Number of words that are no group of the code.
    pub unread_count: u32,
    /// Always 0.
    pub reserved0: u32,
}

impl wk_metar {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_METAR,
        next: null(),
        station: [0, 0, 0, 0, 0, 0, 0, 0],
        day: 0,
        hour: 0,
        minute: 0,
        flags: 0,
        assumed: 0,
        cloud_amounts: WK_CLOUD_AMOUNT_BY_STATION,
        lowest_visibility_m: 0.0,
        runways_offset: 0,
        runways_length: 0,
        trend_offset: 0,
        trend_length: 0,
        remarks_offset: 0,
        remarks_length: 0,
        unread_offset: 0,
        unread_length: 0,
        unread_count: 0,
        reserved0: 0,
    };

    fn of(report: &MetarReport) -> Self {
        let flags = [
            (report.special, WK_METAR_SPECIAL),
            (report.automatic, WK_METAR_AUTOMATIC),
            (report.corrected, WK_METAR_CORRECTED),
            (report.visibility_is_minimum, WK_METAR_VISIBILITY_IS_MINIMUM),
        ];
        let bit = |name: &&str| ASSUMED_FIELDS.iter().position(|f| f == name).map_or(0, |i| 1 << i);
        let places = &report.places;
        let [runways, trend, remarks, unread] =
            [&places.runways, &places.trend, &places.remarks, &places.unread].map(|p| [p.start as u32, p.len() as u32]);
        let mut answer = Self {
            assumed: report.assumed.iter().map(bit).fold(0, |all, bit| all | bit),
            cloud_amounts: report.cloud_amounts as u32,
            lowest_visibility_m: report.lowest_visibility_m.unwrap_or(0.0),
            runways_offset: runways[0],
            runways_length: runways[1],
            trend_offset: trend[0],
            trend_length: trend[1],
            remarks_offset: remarks[0],
            remarks_length: remarks[1],
            unread_offset: unread[0],
            unread_length: unread[1],
            unread_count: report.unread.len() as u32,
            day: report.day,
            hour: report.hour,
            minute: report.minute,
            flags: flags.iter().filter(|f| f.0).fold(0, |all, f| all | f.1),
            ..Self::INIT
        };
        for (to, from) in answer.station[..7].iter_mut().zip(report.station.bytes()) {
            *to = from as c_char;
        }
        answer
    }
}

/// Reads a METAR or SPECI report (NUL-terminated text of at most 4096 bytes) into `*out_weather`, with cloud amounts by
/// the station's rule. The weather's cloud layers are written to `layers`, which has room for `layer_capacity` elements
/// of `layer_size` bytes (sizeof(wk_cloud_layer) of your header; 16 elements always suffice). out_weather->clouds
/// points there: keep `layers` as long as the weather. `out_metar` may be NULL. out_weather->station_altitude_m is 0:
/// set it from a list of airports.
/// Thread: any.
/// Errors: WK_ERROR_PARSE for a text without a station, without an observation (NIL) or without any group of the
/// weather: the message has line and column, what was expected there and what was found. WK_ERROR_PARSE for a text that
/// is too long; WK_ERROR_INVALID_ARGUMENT if the layers do not fit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_weather_from_metar(
    report: *const c_char,
    layers: *mut wk_cloud_layer,
    layer_capacity: u32,
    layer_size: u32,
    out_weather: *mut wk_weather,
    out_metar: *mut wk_metar,
) -> wk_status {
    guard("wk_weather_from_metar", |_| {
        // SAFETY: the caller's promises.
        let places = unsafe { places(layers, layer_capacity, layer_size, out_weather, out_metar)? };
        // SAFETY: the caller's promise.
        let text = unsafe { input::text("report", report)? };
        answer(text, &MetarOptions::default(), places)
    })
}

/// Reads a report as wk_weather_from_metar does, with `options`. NULL means all defaults.
/// Thread: any.
/// Errors: as wk_weather_from_metar; WK_ERROR_INVALID_ARGUMENT for an unknown rule.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_weather_from_metar_with(
    report: *const c_char,
    options: *const wk_metar_options,
    layers: *mut wk_cloud_layer,
    layer_capacity: u32,
    layer_size: u32,
    out_weather: *mut wk_weather,
    out_metar: *mut wk_metar,
) -> wk_status {
    guard("wk_weather_from_metar_with", |_| {
        // SAFETY: the caller's promises.
        let places = unsafe { places(layers, layer_capacity, layer_size, out_weather, out_metar)? };
        // SAFETY: the caller's promise.
        let text = unsafe { input::text("report", report)? };
        // SAFETY: the caller's promise.
        let c = unsafe { layout::read_or_default(&"options", options)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"options", c.next, &[])? };
        let rule = CloudAmountRule::from_u32(c.cloud_amounts).map_err(|e| e.within("options"))?;
        answer(text, &MetarOptions { cloud_amounts: rule }, places)
    })
}

/// Output structs of the caller for a report.
type ReportRoom = (WeatherOut, Option<layout::OutStruct<wk_metar>>);

/// Checks the output structs of the caller for a report.
///
/// # Safety
/// As `weather_out`; `out_metar` is NULL or a `wk_metar`.
///
/// # Errors
/// Names the wrong parameter.
unsafe fn places(
    layers: *mut wk_cloud_layer,
    layer_capacity: u32,
    layer_size: u32,
    out_weather: *mut wk_weather,
    out_metar: *mut wk_metar,
) -> Result<ReportRoom> {
    // SAFETY: the caller's promises.
    let weather = unsafe { weather_out(layers, layer_capacity, layer_size, out_weather)? };
    if out_metar.is_null() {
        return Ok((weather, None));
    }
    // SAFETY: the caller's promise.
    Ok((weather, Some(unsafe { layout::out_struct(&"out_metar", out_metar)? })))
}

/// Reads the report and writes the results to the caller's structs.
///
/// # Errors
/// As [`Weather::from_metar`], about the parameter `report`; [`Status::InvalidArgument`] if the layers do not fit.
fn answer(text: &str, options: &MetarOptions, (weather, metar): ReportRoom) -> Result<Status> {
    let report = Weather::from_metar_with(text, options).map_err(|e| e.in_text("report"))?;
    weather.set(&report.weather)?;
    if let Some(metar) = metar {
        metar.set(&wk_metar::of(&report));
    }
    Ok(Status::Ok)
}

/// Writes the weather of a named preset to `*out_weather`, and its cloud layers as wk_weather_from_metar does.
/// wk_get_preset gives the names.
/// Thread: any.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an unknown name; the message lists the known ones.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_weather_from_preset(
    name: *const c_char,
    layers: *mut wk_cloud_layer,
    layer_capacity: u32,
    layer_size: u32,
    out_weather: *mut wk_weather,
) -> wk_status {
    guard("wk_weather_from_preset", |_| {
        // SAFETY: the caller's promises.
        let (name, weather) =
            unsafe { (input::text("name", name)?, weather_out(layers, layer_capacity, layer_size, out_weather)?) };
        weather.set(&Weather::preset(name)?)?;
        Ok(Status::Ok)
    })
}

/// Gets the name and the one-line description of the preset `index`. Indices begin at 0 and are in an order that suits
/// a menu. Both texts live as long as the process. Either pointer may be NULL.
/// Thread: any.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an index beyond the last preset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_get_preset(
    index: u32,
    out_name: *mut *const c_char,
    out_description: *mut *const c_char,
) -> wk_status {
    static TEXTS: OnceLock<Vec<[CString; 2]>> = OnceLock::new();
    guard("wk_get_preset", |_| {
        let texts = TEXTS.get_or_init(|| {
            let both = |name| [name, Weather::preset_description(name).unwrap_or_default()];
            Weather::preset_names().map(|n| both(n).map(|t| CString::new(t).unwrap_or_default())).collect()
        });
        let Some(found) = texts.get(index as usize) else {
            return Err(Error::range("index", &format!("below {}", texts.len()), index));
        };
        let name = layout::optional_out(&"out_name", out_name)?;
        let description = layout::optional_out(&"out_description", out_description)?;
        for (place, text) in [(name, &found[0]), (description, &found[1])] {
            if let Some(place) = place {
                // SAFETY: checked, and the caller's.
                unsafe { place.write(text.as_ptr()) };
            }
        }
        Ok(Status::Ok)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_assumed_field_has_its_bit() {
        let bits = [
            (WK_METAR_ASSUMED_WIND, "wind"),
            (WK_METAR_ASSUMED_WIND_DIRECTION, "wind.from_deg"),
            (WK_METAR_ASSUMED_VISIBILITY, "visibility_m"),
            (WK_METAR_ASSUMED_PRECIPITATION, "precipitation"),
            (WK_METAR_ASSUMED_CLOUDS, "clouds"),
            (WK_METAR_ASSUMED_CLOUD_BASE, "clouds[].base_m"),
            (WK_METAR_ASSUMED_CLOUD_COVER, "clouds[].cover"),
            (WK_METAR_ASSUMED_VERTICAL_VISIBILITY, "vertical_visibility_m"),
            (WK_METAR_ASSUMED_TEMPERATURE, "temperature_c"),
            (WK_METAR_ASSUMED_HUMIDITY, "relative_humidity"),
            (WK_METAR_ASSUMED_PRESSURE, "pressure_hpa"),
            (WK_METAR_ASSUMED_TIME, "time"),
        ];
        assert_eq!(bits.map(|b| b.1), ASSUMED_FIELDS);
        assert!(bits.iter().enumerate().all(|(i, b)| b.0 == 1 << i));
        for (rule, value) in [
            (CloudAmountRule::ByStation, WK_CLOUD_AMOUNT_BY_STATION),
            (CloudAmountRule::Sums, WK_CLOUD_AMOUNT_SUMS),
            (CloudAmountRule::Layers, WK_CLOUD_AMOUNT_LAYERS),
        ] {
            assert_eq!(rule as u32, value);
        }
    }
}
