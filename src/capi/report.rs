//! Weather reports and presets
//!
//! Turns a METAR or SPECI report, as airports send it, into a wk_weather. Fields that the report leaves out keep their
//! defaults.

use std::{
    ffi::{CString, c_char, c_void},
    ptr::null,
    sync::OnceLock,
};

use super::{
    boundary::guard,
    input,
    layout::{self, init_struct, struct_size},
    status::*,
    weather::{wk_cloud_layer, wk_weather},
    weather_convert::weather_out,
};
use crate::{
    error::{Error, Status},
    weather::{MetarReport, Weather},
};

include!(concat!(env!("OUT_DIR"), "/init_report.rs"));

/// Flags of a report.
pub type wk_metar_flags = u32;
/// A special report (SPECI).
pub const WK_METAR_SPECIAL: wk_metar_flags = 1;
/// Made without an observer (AUTO).
pub const WK_METAR_AUTOMATIC: wk_metar_flags = 2;
/// A correction (COR).
pub const WK_METAR_CORRECTED: wk_metar_flags = 4;
/// The report says only that visibility is at least so much (CAVOK, 9999, 10SM).
pub const WK_METAR_VISIBILITY_IS_MINIMUM: wk_metar_flags = 8;

/// Place and time of a report.
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
    /// Flags of a report.
    pub flags: wk_metar_flags,
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
    };

    fn of(report: &MetarReport) -> Self {
        let flags = [
            (report.special, WK_METAR_SPECIAL),
            (report.automatic, WK_METAR_AUTOMATIC),
            (report.corrected, WK_METAR_CORRECTED),
            (report.visibility_is_minimum, WK_METAR_VISIBILITY_IS_MINIMUM),
        ];
        let mut answer = Self {
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

/// Reads a METAR or SPECI report (NUL-terminated text of at most 4096 bytes) into `*out_weather`. Its cloud layers go to
/// `layers`, which has room for `layer_capacity` of `layer_size` bytes (sizeof(wk_cloud_layer) of your header; 16 always
/// suffice), and out_weather->clouds leads there: keep it as long as the weather. `out_metar` may be NULL.
/// Thread: any.
/// Errors: WK_ERROR_PARSE with line and column of the group at fault, what was expected there and what was found;
/// WK_ERROR_INVALID_ARGUMENT if the layers do not fit.
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
        let (text, weather) =
            unsafe { (input::text("report", report)?, weather_out(layers, layer_capacity, layer_size, out_weather)?) };
        let metar = if out_metar.is_null() {
            None
        } else {
            // SAFETY: the caller's promise.
            Some(unsafe { layout::out_struct(&"out_metar", out_metar)? })
        };
        let report = Weather::from_metar(text).map_err(|e| e.in_text("report"))?;
        weather.set(&report.weather)?;
        if let Some(metar) = metar {
            metar.set(&wk_metar::of(&report));
        }
        Ok(Status::Ok)
    })
}

/// Writes the weather of a named preset to `*out_weather`; layers as in wk_weather_from_metar. wk_get_preset lists the
/// names.
/// Thread: any.
/// Errors: WK_ERROR_INVALID_ARGUMENT for a name that is not listed; the message lists them.
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

/// Gets name and one-line description of the preset `index`, from 0 in the order of a menu. Both texts live as long as
/// the process. Either pointer may be NULL.
/// Thread: any.
/// Errors: WK_ERROR_INVALID_ARGUMENT beyond the last one.
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
