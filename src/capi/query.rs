//! Queries: light and visibility
//!
//! These functions answer for any place of the host's world. Functions that end in _at take a past or future simulation
//! time that the timeline of the weather still knows (see wk_context_get_conditions); the others answer for the
//! present. The answers are in closed form and need no work of the GPU, except those of wk_context_get_ambient and
//! wk_context_get_ambient_at, which read the sky's tables. If the host has set the direction of the sun or the moon,
//! that direction holds at all times. Directions are unit vectors (east, north, up) at the queried place. Light is in
//! lux and cd/m^2, in three channels of linear Rec. 709. The sum of the channels with the weights 0.2126, 0.7152 and
//! 0.0722 is the photometric value.
//!
//! Lists are (pointer, count, size of an element in your header). Welkin checks everything before it writes anything.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, ListParameters, MAX_BATCH, position},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    context::{Context, GroundLight, Light, LightAt},
    error::{Error, Result, Status},
    fog::Between,
};

include!(concat!(env!("OUT_DIR"), "/init_query.rs"));

/// The sun or the moon over a place.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_celestial {
    /// sizeof(wk_celestial) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_CELESTIAL.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Direction to the body, without refraction, as scattering uses it.
    pub direction: [f64; 3],
    /// Direction to the body as it appears, lifted by refraction.
    pub apparent: [f64; 3],
    /// For the moon: direction in the plane of the disc towards the middle of the lit limb. For the sun: (0, 0, 1).
    pub bright_limb: [f64; 3],
    /// Illuminance that a surface facing the body would receive above the air, lux per channel.
    pub illuminance_lux: [f64; 3],
    /// Azimuth, degrees clockwise from true north, [0, 360).
    pub azimuth_deg: f64,
    /// Elevation above the horizon, degrees, without refraction.
    pub elevation_deg: f64,
    /// Elevation above the horizon as it appears, degrees.
    pub apparent_elevation_deg: f64,
    /// Angular radius of the disc, rad.
    pub angular_radius: f64,
    /// Lit fraction of the disc.
    pub lit: f64,
    /// Ratio of the disc's vertical to its horizontal diameter.
    pub flattening: f64,
    /// Share of the body's direct light that passes the clouds above the place, averaged over all places at the same
    /// height.
    pub direct_share: f64,
}

impl wk_celestial {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_CELESTIAL,
        next: null(),
        direction: [0.0, 0.0, 0.0],
        apparent: [0.0, 0.0, 0.0],
        bright_limb: [0.0, 0.0, 0.0],
        illuminance_lux: [0.0, 0.0, 0.0],
        azimuth_deg: 0.0,
        elevation_deg: 0.0,
        apparent_elevation_deg: 0.0,
        angular_radius: 0.0,
        lit: 0.0,
        flattening: 0.0,
        direct_share: 0.0,
    };

    fn of(light: &Light) -> Self {
        let elevation = |d: DVec3| d.z.clamp(-1.0, 1.0).asin().to_degrees();
        let d = light.direction;
        Self {
            direction: d.to_array(),
            apparent: light.apparent.to_array(),
            bright_limb: light.bright_limb.to_array(),
            illuminance_lux: light.illuminance_lux,
            azimuth_deg: d.x.atan2(d.y).to_degrees().rem_euclid(360.0),
            elevation_deg: elevation(d),
            apparent_elevation_deg: elevation(light.apparent),
            angular_radius: light.angular_radius,
            lit: light.lit,
            flattening: light.flattening,
            direct_share: light.direct_share,
            ..Self::INIT
        }
    }
}

/// Light that arrives at a place, after air, clouds and fog. Light that fog has scattered almost straight on is
/// included in the direct light of the sun or the moon. Element of an array, without struct_size; calls take its sizeof
/// instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_ground_light {
    /// Direct sunlight on a surface facing the sun, lux per channel.
    pub sun_lux: [f64; 3],
    /// Direct moonlight on a surface facing the moon, lux per channel.
    pub moon_lux: [f64; 3],
    /// Light of sky, clouds and fog on level ground, lux per channel.
    pub sky_lux: [f64; 3],
    /// All light on level ground, luminance-weighted, lux.
    pub total_lux: f64,
}

impl wk_ground_light {
    fn of(light: &GroundLight) -> Self {
        Self { sun_lux: light.sun_lux, moon_lux: light.moon_lux, sky_lux: light.sky_lux, total_lux: light.total_lux }
    }
}

/// Two points of the host's world, m. Element of an array, without struct_size; calls take its sizeof instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_segment {
    /// Position of the observer.
    pub from_m: [f64; 3],
    /// Position of the object, at least a millimetre away.
    pub to_m: [f64; 3],
}

/// Transmittance and visibility between two points. Element of an array, without struct_size; calls take its sizeof
/// instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_between {
    /// Transmittance, per channel (wavelengths of the planet; 620, 550 and 450 nm for the Earth).
    pub transmittance: [f64; 3],
    /// Meteorological optical range along the segment, m: the distance at which 550 nm light would fall to 5 % if the
    /// air were everywhere as on this segment. Infinite if nothing attenuates light.
    pub visibility_m: f64,
}

impl wk_between {
    fn of(segment: &Between) -> Self {
        Self { transmittance: segment.transmittance, visibility_m: segment.visibility_m }
    }
}

/// Light of the sky on surfaces of any orientation.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_ambient {
    /// sizeof(wk_ambient) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_AMBIENT.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Radiance of sky (upper half) and lit ground (lower half) in nine real spherical harmonics, cd/m^2:
    /// sh9[3 * coefficient + channel], coefficients in the order 00; 1y, 1z, 1x; 2xy, 2yz, 2zz, 2xz, 2xx-yy
    /// (Ramamoorthi and Hanrahan 2001), x east, y north, z up.
    pub sh9: [f64; 27],
}

impl wk_ambient {
    pub(crate) const INIT: Self =
        Self { struct_size: struct_size::<Self>(), struct_type: WK_STRUCT_TYPE_AMBIENT, next: null(), sh9: [0.0; 27] };
}

/// Gets the sun over a place of the host's world, now.
/// Thread: concurrent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_sun(
    context: *const wk_context,
    position_m: *const [f64; 3],
    out_sun: *mut wk_celestial,
) -> wk_status {
    let point = QueryPoint { context, position_m, time_s: None };
    // SAFETY: the caller's promises are the same.
    unsafe { celestial("wk_context_get_sun", point, "out_sun", out_sun, |l| l.sun) }
}

/// Gets the sun over a place of the host's world at a simulation time.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_sun_at(
    context: *const wk_context,
    position_m: *const [f64; 3],
    time_s: f64,
    out_sun: *mut wk_celestial,
) -> wk_status {
    let point = QueryPoint { context, position_m, time_s: Some(time_s) };
    // SAFETY: the caller's promises are the same.
    unsafe { celestial("wk_context_get_sun_at", point, "out_sun", out_sun, |l| l.sun) }
}

/// Gets the moon over a place of the host's world, now.
/// Thread: concurrent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_moon(
    context: *const wk_context,
    position_m: *const [f64; 3],
    out_moon: *mut wk_celestial,
) -> wk_status {
    let point = QueryPoint { context, position_m, time_s: None };
    // SAFETY: the caller's promises are the same.
    unsafe { celestial("wk_context_get_moon", point, "out_moon", out_moon, |l| l.moon) }
}

/// Gets the moon over a place of the host's world at a simulation time.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_moon_at(
    context: *const wk_context,
    position_m: *const [f64; 3],
    time_s: f64,
    out_moon: *mut wk_celestial,
) -> wk_status {
    let point = QueryPoint { context, position_m, time_s: Some(time_s) };
    // SAFETY: the caller's promises are the same.
    unsafe { celestial("wk_context_get_moon_at", point, "out_moon", out_moon, |l| l.moon) }
}

/// Context, place and time of a query; no time means the present.
#[derive(Clone, Copy)]
pub(super) struct QueryPoint {
    pub(super) context: *const wk_context,
    pub(super) position_m: *const [f64; 3],
    pub(super) time_s: Option<f64>,
}

/// # Safety
/// The position is NULL or three numbers, `answer` NULL or a `wk_celestial`.
unsafe fn celestial(
    function: &'static str,
    point: QueryPoint,
    answer_name: &str,
    answer: *mut wk_celestial,
    which: fn(&LightAt) -> Light,
) -> wk_status {
    guard(function, |call| {
        let object = call.get::<ContextObject>("context", point.context)?;
        // SAFETY: the caller's promises.
        let (at, place) =
            unsafe { (position("position_m", point.position_m)?, layout::out_struct(&answer_name, answer)?) };
        let context = object.read();
        let light = context.light_at(DVec3::from_array(at), time_or_now(&context, point.time_s)?);
        place.set(&wk_celestial::of(&which(&light.map_err(|e| e.renamed("position", "position_m"))?)));
        Ok(Status::Ok)
    })
}

pub(super) fn time_or_now(context: &Context, time_s: Option<f64>) -> Result<f64> {
    let Some(time_s) = time_s else { return Ok(context.time_s()) };
    context.check_time(time_s)?;
    Ok(time_s)
}

/// Gets the light that arrives at places of the host's world now, at most wk_caps.max_batch of them. Only clouds above
/// the height of a place dim its light, by their mean effect on all places at that height. `position_size` and
/// `light_size` are the distances from one element to the next, bytes: 24 or more for positions,
/// sizeof(wk_ground_light) of your header for lights.
/// Thread: concurrent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_light(
    context: *const wk_context,
    positions_m: *const [f64; 3],
    count: u32,
    position_size: u32,
    lights: *mut wk_ground_light,
    light_size: u32,
) -> wk_status {
    let places = ListParameters { first: positions_m, count, size: position_size };
    // SAFETY: the caller's promises are the same.
    unsafe { light("wk_context_get_light", context, places, None, (lights, light_size)) }
}

/// Gets the light as wk_context_get_light does, at a simulation time.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_light_at(
    context: *const wk_context,
    positions_m: *const [f64; 3],
    count: u32,
    position_size: u32,
    time_s: f64,
    lights: *mut wk_ground_light,
    light_size: u32,
) -> wk_status {
    let places = ListParameters { first: positions_m, count, size: position_size };
    // SAFETY: the caller's promises are the same.
    unsafe { light("wk_context_get_light_at", context, places, Some(time_s), (lights, light_size)) }
}

/// # Safety
/// Each list is NULL or as long as its count says.
unsafe fn light(
    function: &'static str,
    context: *const wk_context,
    places: ListParameters<[f64; 3]>,
    time_s: Option<f64>,
    (lights, light_size): (*mut wk_ground_light, u32),
) -> wk_status {
    guard(function, |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let ListParameters { first, count, size } = places;
        let places = input::Places::new("positions_m", "position_size", first, count, size, MAX_BATCH)?;
        let room = input::Room::new("lights", "light_size", lights, count, light_size)?;
        let context = object.read();
        let time_s = time_or_now(&context, time_s)?;
        let answer = |i: usize| {
            // SAFETY: `i` is below the count that the caller promises.
            let at = unsafe { position(&format!("positions_m[{i}]"), places.at(i))? };
            let light = context.light_at(DVec3::from_array(at), time_s);
            let named = |e: Error| e.renamed("position", &format!("positions_m[{i}]"));
            Ok(wk_ground_light::of(&light.map_err(named)?.arriving))
        };
        let answers = (0..count as usize).map(answer).collect::<Result<Vec<_>>>()?;
        for (i, light) in answers.iter().enumerate() {
            // SAFETY: as above.
            unsafe { room.write(i, light) };
        }
        Ok(Status::Ok)
    })
}

/// Gets transmittance and visibility between pairs of points now, at most wk_caps.max_batch of them. The answers
/// include air, haze, fog, precipitation and clouds drawn as a volume. They exclude clouds drawn as a deck and the
/// host's objects. `segment_size` and `between_size` are sizeof(wk_segment) and sizeof(wk_between) of your header.
/// Thread: concurrent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_between(
    context: *const wk_context,
    segments: *const wk_segment,
    count: u32,
    segment_size: u32,
    between: *mut wk_between,
    between_size: u32,
) -> wk_status {
    let pairs = ListParameters { first: segments, count, size: segment_size };
    // SAFETY: the caller's promises are the same.
    unsafe { way("wk_context_get_between", context, pairs, None, (between, between_size)) }
}

/// Gets transmittance and visibility as wk_context_get_between does, at a simulation time.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_between_at(
    context: *const wk_context,
    segments: *const wk_segment,
    count: u32,
    segment_size: u32,
    time_s: f64,
    between: *mut wk_between,
    between_size: u32,
) -> wk_status {
    let pairs = ListParameters { first: segments, count, size: segment_size };
    // SAFETY: the caller's promises are the same.
    unsafe { way("wk_context_get_between_at", context, pairs, Some(time_s), (between, between_size)) }
}

/// # Safety
/// Each list is NULL or as long as its count says.
unsafe fn way(
    function: &'static str,
    context: *const wk_context,
    pairs: ListParameters<wk_segment>,
    time_s: Option<f64>,
    (between, between_size): (*mut wk_between, u32),
) -> wk_status {
    guard(function, |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let ListParameters { first, count, size } = pairs;
        let pairs = input::Places::new("segments", "segment_size", first, count, size, MAX_BATCH)?;
        let room = input::Room::new("between", "between_size", between, count, between_size)?;
        let context = object.read();
        let time_s = time_or_now(&context, time_s)?;
        let answer = |i: usize| {
            let pair = pairs.at(i);
            // SAFETY: `i` is below the count that the caller promises.
            let (from, to) = unsafe {
                let part = |name: &str, p: *const [f64; 3]| position(&format!("segments[{i}].{name}"), p);
                (part("from_m", &raw const (*pair).from_m)?, part("to_m", &raw const (*pair).to_m)?)
            };
            let between = context.between(DVec3::from_array(from), DVec3::from_array(to), time_s);
            let named = |e: Error| e.renamed("from", "from_m").renamed("to", "to_m").within(&format!("segments[{i}]"));
            Ok(wk_between::of(&between.map_err(named)?))
        };
        let answers = (0..count as usize).map(answer).collect::<Result<Vec<_>>>()?;
        for (i, between) in answers.iter().enumerate() {
            // SAFETY: as above.
            unsafe { room.write(i, between) };
        }
        Ok(Status::Ok)
    })
}

/// Gets the slant visual range from a place at a simulation time, m: the distance up to which a black object is seen
/// along `direction`, a vector (east, north, up) at the place, of length 1 within 0.001. At that distance 5 % of the
/// object's contrast is left, because air, fog, rain, snow and clouds drawn as a volume let 5 % of the light at 550 nm
/// pass. The range is infinite if more than 5 % is left where the ray leaves the air or meets the planet's ground.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions; WK_ERROR_INVALID_ARGUMENT naming the direction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_visibility_at(
    context: *const wk_context,
    position_m: *const [f64; 3],
    direction: *const [f64; 3],
    time_s: f64,
    out_visibility_m: *mut f64,
) -> wk_status {
    guard("wk_context_get_visibility_at", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let place = input::out("out_visibility_m", out_visibility_m)?;
        // SAFETY: the caller's promises.
        let [at, toward] = unsafe { [position("position_m", position_m)?, position("direction", direction)?] };
        let context = object.read();
        let [at, toward] = [at, toward].map(DVec3::from_array);
        let seen = context.visibility_toward(at, toward, time_s).map_err(|e| e.renamed("position", "position_m"))?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(seen) };
        Ok(Status::Ok)
    })
}

/// Gets the sky's light on surfaces of any orientation at a place. The call reads the sky's tables. It builds them if
/// no frame has done so yet. The first call after each change of the tables waits for the GPU.
/// Thread: exclusive; with an OpenGL host, the thread where its context is (or can be made) current.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the position; WK_ERROR_DEVICE_LOST.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_ambient(
    context: *mut wk_context,
    position_m: *const [f64; 3],
    out_ambient: *mut wk_ambient,
) -> wk_status {
    // SAFETY: the caller's promises are the same.
    unsafe { ambient("wk_context_get_ambient", context, position_m, None, out_ambient) }
}

/// Gets the sky's light as wk_context_get_ambient does, at a simulation time. The distribution of the clear sky's light
/// over directions is that of the present tables. The sky's brightness, clouds and fog are those at `time_s`.
/// Thread: as wk_context_get_ambient.
/// Errors: as wk_context_get_ambient and wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_ambient_at(
    context: *mut wk_context,
    position_m: *const [f64; 3],
    time_s: f64,
    out_ambient: *mut wk_ambient,
) -> wk_status {
    // SAFETY: the caller's promises are the same.
    unsafe { ambient("wk_context_get_ambient_at", context, position_m, Some(time_s), out_ambient) }
}

/// # Safety
/// The position is NULL or three numbers, the answer NULL or as large as it says.
unsafe fn ambient(
    function: &'static str,
    context: *mut wk_context,
    position_m: *const [f64; 3],
    time_s: Option<f64>,
    out_ambient: *mut wk_ambient,
) -> wk_status {
    guard(function, |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promises.
        let (at, place) =
            unsafe { (position("position_m", position_m)?, layout::out_struct(&"out_ambient", out_ambient)?) };
        object.cell.drain();
        let context = object.read();
        let time_s = time_or_now(&context, time_s)?;
        let sh = context.ambient_at(DVec3::from_array(at), time_s).map_err(|e| e.renamed("position", "position_m"))?;
        let mut answer = wk_ambient::INIT;
        for (to, from) in answer.sh9.iter_mut().zip(sh.as_flattened()) {
            *to = f64::from(*from);
        }
        place.set(&answer);
        Ok(Status::Ok)
    })
}
