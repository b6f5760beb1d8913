//! Contexts
//!
//! A wk_context has the weather, the time and the place that all views of a simulator share. Its answers depend only on
//! its description (wk_context_desc), its changes of weather (the timeline), its other settings and its time. Two
//! contexts with the same input therefore give the same answers on every machine.
//!
//! There are three kinds of world. FLAT: the ground is a plane, and altitude is the up coordinate. TANGENT:
//! east-north-up at the origin's place, with the curved planet below. ECEF: Earth-centred, Earth-fixed (WGS 84)
//! coordinates, or those of another planet (wk_context_set_planet). Axes of flat and tangent worlds are x east, y
//! north, z up (Z_UP) or x east, y up, z south (Y_UP, the usual OpenGL world). Directions in answers are unit vectors
//! (east, north, up) at the queried place; azimuths are degrees clockwise from true north.
//!
//! Altitudes are above mean sea level everywhere in this header. In an ECEF world mean sea level lies geoid_height_m of
//! wk_context_desc above the ellipsoid; with the default of 0, heights above the ellipsoid serve as altitudes.

use std::{
    ffi::{c_char, c_void},
    path::PathBuf,
    ptr::null,
    sync::Arc,
};

pub use super::boundary::objects::context::*;
use super::{
    boundary::{
        guard, handles,
        input::{self, out},
        layout::{self, init_struct, struct_size},
        numbers::*,
        objects::{DeviceObject, wk_device},
    },
    ground::wk_simulation_desc,
    sky::wk_sky_settings,
};
use crate::{
    context::{Context, ContextDesc},
    error::{Error, Result, Status},
    frame::{Exposure, ToneCurve},
    scene::{Axes, Place, WorldFrame, WorldKind},
    sky::{
        Planet,
        sun::{Utc, sun_position},
    },
};

include!(concat!(env!("OUT_DIR"), "/init_context.rs"));

/// Placement of the host's world on the planet.
pub type wk_world_kind = u32;
/// A plane: up is the same everywhere. Altitude is the up coordinate plus the origin's altitude.
pub const WK_WORLD_FLAT: wk_world_kind = 0;
/// East-north-up at the origin's place, with the curved planet below.
pub const WK_WORLD_TANGENT: wk_world_kind = 1;
/// Earth-centred, Earth-fixed (WGS 84). Axes and grid bearing have no effect. The origin (latitude_deg, longitude_deg
/// and altitude_m of wk_context_desc) is not the host's (0, 0, 0): it is the zero point of maps (of local cloud cover,
/// fog patches, waves and lightning), and the place whose sunlight dries a simulated ground (WK_GROUND_SIMULATED).
/// Altitudes are heights above the ellipsoid less geoid_height_m.
pub const WK_WORLD_ECEF: wk_world_kind = 2;

/// Directions of the host's axes in flat and tangent worlds.
pub type wk_axes = u32;
/// x east, y north, z up.
pub const WK_AXES_Z_UP: wk_axes = 0;
/// x east, y up, z south.
pub const WK_AXES_Y_UP: wk_axes = 1;

/// Source of the exposure: one value for all channels of a simulator, never measured from a view.
pub type wk_exposure_mode = u32;
/// Automatic, from the light that falls on level ground; exposure_value is a compensation in stops, [-20, 20].
pub const WK_EXPOSURE_AUTO: wk_exposure_mode = 0;
/// Exposure value at ISO 100: exposure_value, [-20, 30], is 15 for a sunny day, -4 for a moonlit night.
pub const WK_EXPOSURE_EV100: wk_exposure_mode = 1;
/// Factor: exposure_value is display units per cd/m^2, (0, 1e6].
pub const WK_EXPOSURE_FACTOR: wk_exposure_mode = 2;
/// The exposure of the context. For a wk_frame only; exposure_value is not used.
pub const WK_EXPOSURE_OF_CONTEXT: wk_exposure_mode = 3;

/// Curve from exposed luminance to display values.
pub type wk_tone_curve = u32;
/// Identity, clamped to the display's range.
pub const WK_TONE_LINEAR: wk_tone_curve = 0;
/// 1 - exp(-x) in each channel, with the exposed luminance x: bright skies never clip to white.
pub const WK_TONE_EXPONENTIAL: wk_tone_curve = 1;
/// Hable's filmic curve with his exposure bias of 2 and white at 11.2: an exposed luminance of 5.6 is shown as white.
pub const WK_TONE_FILMIC: wk_tone_curve = 2;

/// Settings for a new context.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_context_desc {
    /// sizeof(wk_context_desc) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_CONTEXT_DESC.
    pub struct_type: wk_struct_type,
    /// NULL (the default), or a chain of wk_sky_settings and wk_simulation_desc.
    pub next: *const c_void,
    /// Placement of the host's world on the planet. Default WK_WORLD_FLAT.
    pub world_kind: wk_world_kind,
    /// Directions of the host's axes. Default WK_AXES_Z_UP.
    pub axes: wk_axes,
    /// Latitude of the host's (0, 0, 0), or of the origin of WK_WORLD_ECEF, degrees north. Range [-90, 90], default 50.
    pub latitude_deg: f64,
    /// Longitude of the host's (0, 0, 0), or of the origin of WK_WORLD_ECEF, degrees east. Range [-360, 360], default
    /// 10.
    pub longitude_deg: f64,
    /// Altitude above mean sea level of the host's (0, 0, 0), or of the origin of WK_WORLD_ECEF, m. Range [-1e4, 1e9],
    /// default 0.
    pub altitude_m: f64,
    /// Bearing of the world's north axis, degrees clockwise from true north. Range [-360, 360], default 0.
    pub grid_bearing_deg: f64,
    /// Seed of everything random. Default 0.
    pub seed: u64,
    /// Text of a planet file (TOML, UTF-8; docs/planets.md), read during the call. Default NULL: the Earth.
    pub planet_toml: *const c_char,
    /// Source of the exposure for frames that set none of their own. Default WK_EXPOSURE_AUTO; WK_EXPOSURE_OF_CONTEXT
    /// is refused here.
    pub exposure_mode: wk_exposure_mode,
    /// Curve from exposed luminance to display values. Default WK_TONE_EXPONENTIAL.
    pub tone_curve: wk_tone_curve,
    /// Value of the exposure, as wk_exposure_mode says. Default 0.
    pub exposure_value: f64,
    /// Universal time at simulation time 0, seconds since 1970-01-01T00:00:00Z without leap seconds (Unix time).
    /// Range: the years -2000 to 6000. Default 2026-06-21 10:00.
    pub utc_at_zero_s: f64,
    /// Path of a directory, UTF-8, for finished sky tables; Welkin creates it if needed. A later start with the same
    /// planet, sky settings and weather reads the tables instead of building them. Welkin writes a file of 2 MB for the
    /// tables of the first drawn weather, and one for each weather that wk_context_build_sky built. The newest 32 files
    /// stay in the directory, whichever program wrote them. If a file is damaged or cannot be written, Welkin logs that
    /// and builds the tables. Read during the call. Default NULL: no files.
    pub cache_dir: *const c_char,
    /// Height of mean sea level above the WGS 84 ellipsoid where the simulation takes place (the geoid's undulation),
    /// m: 47.8 at Frankfurt, -30 at New York. One number holds for the whole context; in nature the height varies by
    /// some metres over 100 km. Only WK_WORLD_ECEF uses the number: the coordinates of that world refer to the
    /// ellipsoid, but altitudes refer to mean sea level. Heights of fog and clouds are above the station, whose
    /// altitude refers to mean sea level too. Range [-120, 120], default 0.
    pub geoid_height_m: f64,
}

impl wk_context_desc {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_CONTEXT_DESC,
        next: null(),
        world_kind: WK_WORLD_FLAT,
        axes: WK_AXES_Z_UP,
        latitude_deg: 50.0,
        longitude_deg: 10.0,
        altitude_m: 0.0,
        grid_bearing_deg: 0.0,
        seed: 0,
        planet_toml: null(),
        exposure_mode: WK_EXPOSURE_AUTO,
        tone_curve: WK_TONE_EXPONENTIAL,
        exposure_value: 0.0,
        utc_at_zero_s: 1782036000.0,
        cache_dir: null(),
        geoid_height_m: 0.0,
    };
}

/// Converts an exposure of a context or frame; `None` for WK_EXPOSURE_OF_CONTEXT.
pub(super) fn exposure(mode: wk_exposure_mode, value: f64) -> Option<Exposure> {
    match mode {
        WK_EXPOSURE_AUTO => Some(Exposure::Auto { compensation_ev: value }),
        WK_EXPOSURE_EV100 => Some(Exposure::Ev100(value)),
        WK_EXPOSURE_FACTOR => Some(Exposure::Factor(value)),
        _ => None,
    }
}

/// Converts a tone curve that has been checked.
pub(super) fn tone(curve: wk_tone_curve) -> ToneCurve {
    match curve {
        WK_TONE_LINEAR => ToneCurve::Linear,
        WK_TONE_FILMIC => ToneCurve::Filmic,
        _ => ToneCurve::Exponential,
    }
}

/// Reads the planet from a file's text; NULL is the Earth.
///
/// # Safety
/// `text` is NULL or a string.
pub(super) unsafe fn planet(param: &str, text: *const c_char) -> Result<Planet> {
    // SAFETY: the caller's promise.
    match unsafe { input::optional_text(param, text)? } {
        Some(text) => Planet::from_toml(text).map_err(|e| e.in_text(param)),
        None => Ok(Planet::earth()),
    }
}

/// Renames an exposure's error to the field exposure_value of the struct `param`.
pub(super) fn exposure_in(param: &str, e: Error) -> Error {
    e.map_field(|_| format!("{param}.exposure_value"))
}

/// Checks a description and converts it to that of the Rust API.
///
/// # Safety
/// `desc.planet_toml` and `desc.cache_dir` are NULL or strings, and the chain is checked.
unsafe fn description(desc: &wk_context_desc) -> Result<ContextDesc> {
    let kind = match desc.world_kind {
        WK_WORLD_TANGENT => WorldKind::Tangent,
        WK_WORLD_ECEF => WorldKind::Ecef,
        _ => WorldKind::Flat,
    };
    let axes = if desc.axes == WK_AXES_Y_UP { Axes::YUp } else { Axes::ZUp };
    let origin =
        Place { latitude_deg: desc.latitude_deg, longitude_deg: desc.longitude_deg, altitude_m: desc.altitude_m };
    let world = WorldFrame {
        kind,
        axes,
        origin,
        grid_bearing_deg: desc.grid_bearing_deg,
        geoid_height_m: desc.geoid_height_m,
        ..WorldFrame::default()
    };
    world.validate().map_err(|e| e.within("desc"))?;
    // SAFETY: the caller's promise.
    let planet = unsafe { planet("desc.planet_toml", desc.planet_toml)? };
    let exposure = exposure(desc.exposure_mode, desc.exposure_value).ok_or_else(|| {
        Error::range("desc.exposure_mode", "AUTO, EV100 or FACTOR in a context", "WK_EXPOSURE_OF_CONTEXT")
    })?;
    exposure.validate().map_err(|e| exposure_in("desc", e))?;
    let tone = tone(desc.tone_curve);
    let utc_at_zero = Utc(desc.utc_at_zero_s);
    sun_position(utc_at_zero, &world.origin).map_err(|e| e.renamed("utc", "desc.utc_at_zero_s"))?;
    // SAFETY: the caller's promise.
    let sky = unsafe { layout::extension::<wk_sky_settings>(desc.next)? }.unwrap_or(wk_sky_settings::INIT).to_rust();
    sky.check().map_err(|e| e.within("wk_sky_settings"))?;
    // SAFETY: the caller's promise.
    let simulation = unsafe { layout::extension::<wk_simulation_desc>(desc.next)? }.unwrap_or(wk_simulation_desc::INIT);
    let (ground, lying_snow) = (simulation.ground(), simulation.lying_snow());
    // SAFETY: the caller's promise.
    let cache_dir = unsafe { input::optional_text("desc.cache_dir", desc.cache_dir)? }.map(PathBuf::from);
    Ok(ContextDesc { world, planet, seed: desc.seed, exposure, tone, utc_at_zero, sky, ground, lying_snow, cache_dir })
}

/// Creates a context on a device. `desc` NULL means WK_CONTEXT_DESC_INIT. On success `*out_context` is a new handle for
/// `wk_context_destroy`. The weather is a clear standard day (WK_WEATHER_INIT) until you set another.
/// Thread: exclusive on the device.
/// Errors: WK_ERROR_PARSE for the planet file, with line and column; WK_ERROR_INVALID_ARGUMENT naming the field.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_create(
    device: *mut wk_device,
    desc: *const wk_context_desc,
    out_context: *mut *mut wk_context,
) -> wk_status {
    guard("wk_context_create", |call| {
        let object = call.get::<DeviceObject>("device", device)?;
        let place = out("out_context", out_context)?;
        // SAFETY: the caller's promise about `desc`.
        let desc = unsafe { layout::read_or_default(&"desc", desc)? };
        // SAFETY: as above.
        unsafe {
            layout::check_chain(&"desc", desc.next, &[WK_STRUCT_TYPE_SKY_SETTINGS, WK_STRUCT_TYPE_SIMULATION_DESC])?
        };
        // SAFETY: as above.
        let description = unsafe { description(&desc)? };
        let context = Context::new(object.cell.gpu().clone(), object.cell.shared()?, description)?;
        let context = ContextObject::new(object.cell.clone(), context);
        let handle = handles::insert::<_, DeviceObject>(Arc::new(context), Some(device))?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(handle) };
        Ok(Status::Ok)
    })
}

/// Replaces the planet: its air, ground and sun. `planet_toml` is a planet file's text (TOML, UTF-8), read during the
/// call; NULL means the Earth. Tangent and ECEF worlds lie on WGS 84 if the planet's radius is between the Earth's
/// polar and equatorial radius, otherwise on a sphere of that radius. Set a planet of another radius before terrain,
/// simulated ground and regions of the sea: they keep the directions of the planet on which they were set. Light and
/// queries use the new planet at once, without blending. The sky's tables follow as after a change of weather: a draft
/// fades in over sixteen frames, and later frames refine it. If the radius, the top of the air or the wavelengths
/// differ, the next frame shows a draft of the new planet at once (docs/planets.md).
/// Thread: exclusive.
/// Errors: WK_ERROR_PARSE for the text, with line and column; WK_ERROR_INVALID_ARGUMENT naming the field. After an
/// error the planet stays as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_planet(context: *mut wk_context, planet_toml: *const c_char) -> wk_status {
    guard("wk_context_set_planet", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise.
        let planet = unsafe { planet("planet_toml", planet_toml)? };
        object.write().set_planet(&planet)?;
        Ok(Status::Ok)
    })
}

/// Sets the curve from luminance to display values for the next frames, in place of tone_curve of wk_context_desc.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an unknown curve.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_tone_curve(context: *mut wk_context, curve: wk_tone_curve) -> wk_status {
    guard("wk_context_set_tone_curve", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        input::check_enum("curve", &layout::WK_TONE_CURVE, curve)?;
        object.write().set_tone_curve(tone(curve));
        Ok(Status::Ok)
    })
}

/// Receives the completed share of a long operation, from 0 to 1, never less than before. Return 0 to go on; anything
/// else ends the operation with WK_ERROR_ABORTED. The function must not call Welkin and must not unwind. It may draw by
/// the host's own means, even with the OpenGL context that Welkin uses.
pub type wk_progress_fn = Option<unsafe extern "C" fn(user: *mut c_void, share: f64) -> i32>;

/// Builds the sky's tables completely for the context's planet and present weather, so that no frame has to build them.
/// Call this function at load time, behind a progress bar. The call reuses tables that another context of the device
/// already shows or that lie in the context's cache_dir, and writes new tables to cache_dir. Without this call the
/// first frame shows a draft of the sky, which differs from the finished sky by at most 3 of 255 display steps, and 120
/// frames refine it without a visible step; a frame with WK_FRAME_NO_HISTORY then builds all tables itself
/// (docs/first-frames.md). `progress` may be NULL; else it is called about sixteen times, the last time with 1. An
/// aborted build leaves the context as it was and writes no file.
/// Thread: exclusive on the context; with an OpenGL host, the thread where its OpenGL context is (or can be made)
/// current. While `progress` runs, the host may use that OpenGL context.
/// Errors: WK_ERROR_ABORTED; WK_ERROR_DEVICE_LOST.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_build_sky(
    context: *mut wk_context,
    progress: wk_progress_fn,
    user: *mut c_void,
) -> wk_status {
    guard("wk_context_build_sky", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        object.cell.drain();
        object.read().build_sky(&mut |share| {
            // SAFETY: the host gave both for this call.
            progress.is_none_or(|f| unsafe { f(user, f64::from(share)) } == 0)
        })?;
        Ok(Status::Ok)
    })
}

/// Destroys a context. NULL does nothing.
/// Thread: any. Where the host's OpenGL context is not (and cannot be made) current, GPU objects are released at a
/// later call on the device.
/// Errors: WK_ERROR_IN_USE while it has views.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_destroy(context: *mut wk_context) -> wk_status {
    guard("wk_context_destroy", |_| {
        if !context.is_null() {
            let object = handles::remove::<ContextObject>("context", context)?;
            object.cell.clone().retire(object);
        }
        Ok(Status::Ok)
    })
}
