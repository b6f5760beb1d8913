//! Views
//!
//! A wk_view is one camera or projector channel, with the data that it keeps between frames. A host draws opaque
//! things, then glass and lamps, then the cab, then the HUD. wk_view_record draws Welkin's stages between them:
//!
//!   PREPARE     tables and simulation textures; needs no target
//!   BACKGROUND  the sky behind everything; before or after the opaque things
//!   SURFACE     water and snow on surfaces, shadows of clouds, the sea, terrain; after the opaque things; needs depth
//!   MEDIUM      fog and aerial perspective on all that was drawn so far
//!   PARTICLES   rain, hail and snow near the camera, channels of lightning
//!   LENS        water and snow on the windscreen
//!   TONE        exposure, tone curve, encoding and dither of a scene-linear picture; nothing in display colour spaces
//!
//! The calls of one frame share frame_id and record stages in this order, each at most once. WK_STAGE_ALL does
//! everything in one call and lets neighbouring stages share one pass. Stages with nothing to draw cost nothing. When
//! the call returns, the work is submitted to the device's queue but not finished.

use std::{
    ffi::{c_char, c_void},
    ptr::null,
    sync::Arc,
    time::Instant,
};

use glam::DVec3;

pub use super::boundary::objects::view::*;
use super::{
    boundary::{
        call::Call,
        guard, handles,
        input::{self, List, Named, Room, out},
        layout::{self, init_struct, struct_size},
        numbers::*,
        objects::{ContextObject, wk_context},
    },
    frame::{WK_FRAME_MEASURE, wk_frame},
    host,
    weather::wk_weather,
    weather_convert::{from_c, overrides},
};
use crate::{
    error::{Error, Result, Status},
    frame::{CostItem, MOST_CALLS, MOST_FRAMES, Stages, View, time_limit},
    weather::{Conditions, derive_with},
};

include!(concat!(env!("OUT_DIR"), "/init_view.rs"));

/// Stages that a call records.
pub type wk_stage_flags = u32;
/// Tables and simulation textures; needs no target.
pub const WK_STAGE_PREPARE: wk_stage_flags = 1;
/// Sky behind everything: on the pixels at the far depth, or on all pixels if the target has no depth.
pub const WK_STAGE_BACKGROUND: wk_stage_flags = 2;
/// Water and snow on surfaces, shadows of clouds, and the sea and terrain that Welkin draws; after the host's opaque
/// objects.
pub const WK_STAGE_SURFACE: wk_stage_flags = 4;
/// Fog and aerial perspective on everything that the host has drawn.
pub const WK_STAGE_MEDIUM: wk_stage_flags = 8;
/// Rain, hail and snow near the camera, and the channels of lightning.
pub const WK_STAGE_PARTICLES: wk_stage_flags = 16;
/// Water and snow on the windscreen.
pub const WK_STAGE_LENS: wk_stage_flags = 32;
/// Exposure, tone curve, encoding and dither of a scene-linear picture: float targets and sRGB formats get
/// display-linear values, other formats get sRGB-encoded ones. With WK_COLOR_DISPLAY_LINEAR and WK_COLOR_DISPLAY_SRGB
/// the host has done these steps, and TONE does nothing, alone or with other stages.
pub const WK_STAGE_TONE: wk_stage_flags = 64;
/// Everything in one call.
pub const WK_STAGE_ALL: wk_stage_flags = 127;

/// Settings for a new view.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_view_desc {
    /// sizeof(wk_view_desc) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_VIEW_DESC.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
}

impl wk_view_desc {
    pub(crate) const INIT: Self =
        Self { struct_size: struct_size::<Self>(), struct_type: WK_STRUCT_TYPE_VIEW_DESC, next: null() };
}

/// Flags that say which optional fields of a wk_report are set.
pub type wk_report_flags = u32;
/// wk_report.ms.
pub const WK_REPORT_HAS_MS: wk_report_flags = 1;
/// wk_report.predicted_ms: the view has a budget, its picture was gauged and a time was reported.
pub const WK_REPORT_HAS_PREDICTED_MS: wk_report_flags = 2;
/// wk_report.reported_ms: wk_view_report_time was called after the frame.
pub const WK_REPORT_HAS_REPORTED_MS: wk_report_flags = 4;
/// wk_report.predicted_error and predicted_error_bound: the view has a budget and its picture was gauged.
pub const WK_REPORT_HAS_PREDICTED_ERROR: wk_report_flags = 8;
/// wk_report.checked_error_bound and checked_error: the gauge has measured a picture whose error was predicted.
pub const WK_REPORT_HAS_CHECKED_ERROR: wk_report_flags = 16;

/// Costs and contents of a view's last frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_report {
    /// sizeof(wk_report) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_REPORT.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// The host's frame number; UINT64_MAX before the first frame.
    pub frame_id: u64,
    /// Number of render passes recorded for this frame so far, without those that build tables.
    pub passes: u32,
    /// Number of tables built, refined or blended for this frame so far; 0 when only the camera turned and the sky has
    /// its final quality.
    pub tables_rebuilt: u32,
    /// Exposure that was applied, display units per cd/m^2; 0 if nothing was drawn.
    pub exposure: f64,
    /// GPU memory that the view uses for itself, bytes.
    pub bytes: u64,
    /// Flags that say which of the optional fields are set.
    pub has: wk_report_flags,
    /// Always 0.
    pub reserved0: u32,
    /// Time of the frame's calls so far, including the wait for the GPU, ms. Set if the frame was measured
    /// (WK_FRAME_MEASURE).
    pub ms: f64,
    /// Time that the weather in this frame was predicted to take, ms, from the times that the host had reported before.
    pub predicted_ms: f64,
    /// Time that the host reported for this frame, ms.
    pub reported_ms: f64,
    /// Estimated error due to the parts that this frame left out, except those that were still fading: 95th percentile
    /// over the gauged pixels. All errors of this struct are in the measure of wk_budget.tolerance.
    pub predicted_error: f64,
    /// Upper bound, with 95 % confidence, of the error's 95th percentile over all pixels.
    pub predicted_error_bound: f64,
    /// Error bound that was predicted for the last gauged picture.
    pub checked_error_bound: f64,
    /// Error that the gauge measured in the picture for which checked_error_bound was predicted.
    pub checked_error: f64,
    /// Number of drops and hailstones around the camera; those inside the picture were drawn.
    pub drops: u32,
    /// Number of flakes around the camera; those inside the picture were drawn. 0 if no flakes were drawn.
    pub flakes: u32,
    /// Number of drops that each drawn drop represented: 1 unless more fell than wk_rain.most_drops; 0 without drops.
    pub drop_weight: f64,
    /// Rate of the splashes left out on level ground because the largest number of splashes was reached, 1/(m^2 s). The
    /// splashes of the smallest drops are left out first.
    pub splashes_left_out_per_m2_s: f64,
    /// Rate of the stones that did not bounce on level ground because the largest number of bouncing stones was
    /// reached, 1/(m^2 s). The smallest stones are left out first.
    pub stones_left_out_per_m2_s: f64,
    /// Contrast gain that rain was drawn with (wk_rain.contrast_gain): 1 is as in nature; 0 if no rain was drawn.
    pub contrast_gain: f64,
    /// Distance up to which flakes were drawn, m; farther away snow is extinction alone. 0 if no flakes were drawn.
    pub flakes_to_m: f64,
}

impl wk_report {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_REPORT,
        next: null(),
        frame_id: 0,
        passes: 0,
        tables_rebuilt: 0,
        exposure: 0.0,
        bytes: 0,
        has: 0,
        reserved0: 0,
        ms: 0.0,
        predicted_ms: 0.0,
        reported_ms: 0.0,
        predicted_error: 0.0,
        predicted_error_bound: 0.0,
        checked_error_bound: 0.0,
        checked_error: 0.0,
        drops: 0,
        flakes: 0,
        drop_weight: 0.0,
        splashes_left_out_per_m2_s: 0.0,
        stones_left_out_per_m2_s: 0.0,
        contrast_gain: 0.0,
        flakes_to_m: 0.0,
    };
}

/// Effect whose cost is measured.
pub type wk_effect = u32;
/// Tables of the sky for the whole planet: built when the air changes.
pub const WK_EFFECT_SKY_TABLES: wk_effect = 0;
/// Tables of the sky and the air as seen from the camera's height: built when height, sun or air change.
pub const WK_EFFECT_SKY_VIEW: wk_effect = 1;
/// Sky behind everything.
pub const WK_EFFECT_BACKGROUND: wk_effect = 2;
/// Fog and aerial perspective.
pub const WK_EFFECT_MEDIUM: wk_effect = 3;
/// Exposure, tone curve, encoding.
pub const WK_EFFECT_TONE: wk_effect = 4;
/// Several stages in one draw, where the target's format does not allow separate draws.
pub const WK_EFFECT_COMPOSITION: wk_effect = 5;
/// Textures for the host's own shaders.
pub const WK_EFFECT_VEIL: wk_effect = 6;
/// Acquiring the host's context and images, and returning them.
pub const WK_EFFECT_HAND_OVER: wk_effect = 7;
/// Rain, hail and snow near the camera, and the channels of lightning.
pub const WK_EFFECT_PARTICLES: wk_effect = 8;
/// Water and snow on surfaces, and the sea and terrain that Welkin draws.
pub const WK_EFFECT_SURFACE: wk_effect = 9;
/// Water on the windscreen: its simulation steps, which run after the sky's tables are built, and the stage LENS.
pub const WK_EFFECT_WINDSCREEN: wk_effect = 10;

/// Cost of one effect in a frame. Element of an array, without struct_size; calls take its sizeof instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_effect_cost {
    /// Effect whose cost this is.
    pub effect: wk_effect,
    /// Always 0.
    pub reserved0: u32,
    /// Name of the effect in English; lives as long as the library.
    pub name: *const c_char,
    /// Wall time around a submission that is waited for, including the CPU's share, ms. 0 if the effect did not run.
    pub ms: f64,
}

/// Creates a view of a context. `desc` NULL means WK_VIEW_DESC_INIT. On success `*out_view` is a new handle for
/// `wk_view_destroy`.
/// Thread: exclusive on the context.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_create(
    context: *mut wk_context,
    desc: *const wk_view_desc,
    out_view: *mut *mut wk_view,
) -> wk_status {
    guard("wk_view_create", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let place = out("out_view", out_view)?;
        // SAFETY: the caller's promise about `desc`.
        let desc = unsafe { layout::read_or_default(&"desc", desc)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"desc", desc.next, &[])? };
        object.cell.drain();
        let view = View::new(&object.read())?;
        let view = ViewObject::new(object, view);
        let handle = handles::insert::<_, ContextObject>(Arc::new(view), Some(context))?;
        // SAFETY: `place` was checked and is the caller's.
        unsafe { place.write(handle) };
        Ok(Status::Ok)
    })
}

/// Destroys a view. NULL does nothing.
/// Thread: any. GPU objects that need the host's OpenGL context are released at once if that context can be made
/// current on this thread, else at the next call that uses the GPU of this device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_destroy(view: *mut wk_view) -> wk_status {
    guard("wk_view_destroy", |_| {
        if !view.is_null() {
            let object = handles::remove::<ViewObject>("view", view)?;
            object.cell.clone().retire(object);
        }
        Ok(Status::Ok)
    })
}

/// Records the stages of a frame and submits them. `stages` is a union of WK_STAGE_ constants, not empty. Welkin checks
/// the frame before any work: after an error nothing is drawn, built or changed.
/// Thread: exclusive on the view; views of one context may record from several threads while none updates the context.
/// Errors: WK_ERROR_WRONG_ORDER if a stage is repeated or out of order; WK_ERROR_UNSUPPORTED and
/// WK_ERROR_INVALID_ARGUMENT naming the field; WK_ERROR_DEVICE_LOST; with wk_own_target.surface also the statuses of
/// wk_surface_acquire.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_record(
    view: *mut wk_view,
    frame: *const wk_frame,
    stages: wk_stage_flags,
) -> wk_status {
    guard("wk_view_record", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        // SAFETY: the caller's promise about `frame`.
        let c = unsafe { layout::read(&"frame", frame)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"frame", c.next, &[])? };
        layout::WK_STAGE_FLAGS.check(&"stages", stages.into())?;
        let stages = Stages::from_bits(stages)?;
        object.cell.check_not_lost()?;
        object.cell.drain();
        let measured = (c.flags & WK_FRAME_MEASURE != 0).then(Instant::now);
        // SAFETY: as above.
        unsafe { host::record(call, &object, &c, stages) }
            .map_err(|e| e.renamed("frame.camera.position", "frame.position_m"))?;
        if let Some(start) = measured {
            object.lock().add_hand_over(start);
        }
        Ok(Status::Ok)
    })
}

/// Draws weathers that the host may set later, into small images of Welkin's own. Shaders are then compiled in advance,
/// and hardly any later frame waits for one. Each weather is drawn during the change from the previous weather of the
/// list (for the first, from the context's own), after the change, and with the sun at several heights. Where the
/// context has weather regions, each weather is also drawn with them around the camera: set them before. Call this
/// function behind a loading screen, before the view's first frame: the next frame begins as a view's first one does.
/// Afterwards the context is as before.
///
/// `frame` describes the later frames: give it their settings, and images of the same formats, samples and usages.
/// Welkin neither draws into these images nor waits for them. `calls` has the stages of each wk_view_record of one
/// frame, in order: 1 to 7 elements; NULL with `call_count` 0 means one call with WK_STAGE_ALL. `weathers` has 0 to 64
/// elements, `weather_stride` bytes apart; each may have a wk_weather_overrides in its chain. One call draws for about
/// `most_s`, in [0, 3600] s, but at least one case: one weather at one time of its change and one height of the sun.
/// The call returns WK_PENDING, which is no error, while cases remain: call it again with the same weathers. With other
/// weathers the drawing starts from the beginning.
/// Thread: exclusive on the view and on its context.
/// Errors: WK_ERROR_INVALID_ARGUMENT and WK_ERROR_UNSUPPORTED naming `weathers[i]`, `calls[i]` or the field of `frame`;
/// WK_ERROR_WRONG_ORDER while wk_context_update returns WK_PENDING; WK_ERROR_DEVICE_LOST. After an error the context is
/// as before, and the same call continues with the case that failed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_prepare(
    view: *mut wk_view,
    frame: *const wk_frame,
    calls: *const wk_stage_flags,
    call_count: u32,
    weathers: *const wk_weather,
    weather_count: u32,
    weather_stride: u32,
    most_s: f64,
) -> wk_status {
    guard("wk_view_prepare", |call| {
        let begun = Instant::now();
        let object = call.get::<ViewObject>("view", view)?;
        // SAFETY: the caller's promise about `frame`.
        let c = unsafe { layout::read(&"frame", frame)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"frame", c.next, &[])? };
        // SAFETY: the caller promises `call_count` numbers.
        let calls = unsafe { stages_of_calls(calls, call_count)? };
        // SAFETY: the caller promises `weather_count` structs at this stride.
        let weathers = unsafe { rehearsed_weathers(weathers, weather_count, weather_stride)? };
        let most = time_limit(most_s)?;
        object.cell.check_not_lost()?;
        object.cell.drain();
        let eye = DVec3::from_array(c.position_m);
        let begun_rehearsal = object.lock().begin_rehearsal(&object.context.read(), &calls, weathers, eye);
        let named = |e: Error| e.renamed("frame.camera.position", "frame.position_m");
        let rehearsal = begun_rehearsal.map_err(named)?;
        loop {
            let Some(moment) = object.lock().next_moment(&rehearsal) else { return Ok(Status::Ok) };
            let entered = rehearsal.enter(&mut object.context.write(), moment);
            // SAFETY: as above.
            let drawn = entered.and_then(|()| unsafe { rehearse(call, &object, &c, &calls) });
            object.lock().end_moment(&drawn);
            rehearsal.leave(&mut object.context.write())?;
            drawn.map_err(named)?;
            if begun.elapsed() >= most {
                let rest = object.lock().next_moment(&rehearsal);
                return Ok(if rest.is_some() { Status::Pending } else { Status::Ok });
            }
        }
    })
}

/// Draws the context's present state in frames of a rehearsal until a frame creates no pipeline, but in at most
/// [`MOST_FRAMES`] frames.
///
/// # Safety
/// As `host::record`.
unsafe fn rehearse(call: &mut Call, object: &ViewObject, c: &wk_frame, calls: &[Stages]) -> Result<()> {
    for _ in 0..MOST_FRAMES {
        let before = object.lock().begin_rehearsed_frame();
        // SAFETY: the caller's promise.
        let drawn = calls.iter().try_for_each(|stages| unsafe { host::record(call, object, c, *stages) });
        if !object.lock().end_rehearsed_frame(before) || drawn.is_err() {
            return drawn;
        }
    }
    Ok(())
}

/// Reads the stages of each call of a frame. An empty list gives one call with all stages.
///
/// # Safety
/// `calls` is NULL or points to `count` numbers.
unsafe fn stages_of_calls(calls: *const wk_stage_flags, count: u32) -> Result<Vec<Stages>> {
    // SAFETY: the caller's promise.
    let given = unsafe { input::slice("calls", calls, Named("call_count", count as usize), MOST_CALLS)? };
    let one = |(i, stages): (usize, &wk_stage_flags)| {
        layout::WK_STAGE_FLAGS.check(&format_args!("calls[{i}]"), u64::from(*stages))?;
        Stages::from_bits(*stages).map_err(|e| e.renamed("stages", &format!("calls[{i}]")))
    };
    if given.is_empty() { Ok(vec![Stages::ALL]) } else { given.iter().enumerate().map(one).collect() }
}

/// Largest number of weathers in a rehearsal.
const MOST_WEATHERS: usize = 64;

/// Reads the weathers of a rehearsal.
///
/// # Safety
/// `weathers` is NULL or points to `count` structs, `stride` bytes apart, with readable cloud layers.
unsafe fn rehearsed_weathers(weathers: *const wk_weather, count: u32, stride: u32) -> Result<Vec<Conditions>> {
    let list = List {
        name: "weathers",
        count: Named("weather_count", count as usize),
        stride: Named("weather_stride", stride as usize),
        limit: MOST_WEATHERS,
    };
    let mut found = Vec::new();
    let mut take = |i: usize, _: wk_weather| {
        let (name, place) = (format!("weathers[{i}]"), weathers.wrapping_byte_add(i * stride as usize));
        // SAFETY: the list has this element, which `each_with` has checked; the caller's promise about its layers.
        let (given, overrides) = unsafe { (from_c(&name, place)?, overrides(&name, place)?) };
        found.push(derive_with(&given, &overrides).map_err(|e| e.within(&name))?);
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { input::each_with(&list, weathers, &[WK_STRUCT_TYPE_WEATHER_OVERRIDES], &mut take)? };
    Ok(found)
}

/// Gets costs and contents of the view's last frame.
/// Thread: exclusive on the view.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_get_report(view: *mut wk_view, out_report: *mut wk_report) -> wk_status {
    guard("wk_view_get_report", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        // SAFETY: the caller's promise about `out_report`.
        let place = unsafe { layout::out_struct(&"out_report", out_report)? };
        let report = *object.lock().report();
        let expected = report.prediction;
        let error = expected.error.unwrap_or_default();
        let [checked_error_bound, checked_error] = expected.checked.unwrap_or_default();
        let has = [
            (report.costs.is_some(), WK_REPORT_HAS_MS),
            (expected.milliseconds.is_some(), WK_REPORT_HAS_PREDICTED_MS),
            (report.reported_ms.is_some(), WK_REPORT_HAS_REPORTED_MS),
            (expected.error.is_some(), WK_REPORT_HAS_PREDICTED_ERROR),
            (expected.checked.is_some(), WK_REPORT_HAS_CHECKED_ERROR),
        ];
        place.set(&wk_report {
            frame_id: report.frame_id,
            passes: report.passes,
            tables_rebuilt: report.tables_rebuilt,
            exposure: report.exposure,
            bytes: report.bytes,
            drops: report.rain.drops,
            drop_weight: report.rain.drop_weight,
            splashes_left_out_per_m2_s: report.rain.splashes_left_out_per_m2_s,
            stones_left_out_per_m2_s: report.rain.stones_left_out_per_m2_s,
            contrast_gain: report.rain.contrast_gain,
            flakes: report.snow.flakes,
            flakes_to_m: report.snow.flakes_to_m,
            has: has.iter().filter(|f| f.0).fold(0, |all, f| all | f.1),
            ms: report.costs.map_or(0.0, |c| c.whole_ms),
            predicted_ms: expected.milliseconds.unwrap_or(0.0),
            reported_ms: report.reported_ms.unwrap_or(0.0),
            predicted_error: error.p95,
            predicted_error_bound: error.bound,
            checked_error_bound,
            checked_error,
            ..wk_report::INIT
        });
        Ok(Status::Ok)
    })
}

/// Gets the cost of each effect of the view's last frame, in the order of the WK_EFFECT_ constants. `*out_count` always
/// gets the number of effects, which is 0 if the frame was not measured (WK_FRAME_MEASURE). If `capacity` is too small,
/// nothing else is written and the call fails; with capacity 0 it succeeds. `cost_size` is sizeof(wk_effect_cost) of
/// your header. Later versions may have more effects.
/// Thread: exclusive on the view.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_get_costs(
    view: *mut wk_view,
    costs: *mut wk_effect_cost,
    capacity: u32,
    cost_size: u32,
    out_count: *mut u32,
) -> wk_status {
    guard("wk_view_get_costs", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        let count = out("out_count", out_count)?;
        let room = Room::new("costs", "cost_size", costs, capacity, cost_size)?;
        let found = object.lock().report().costs;
        let effects: &[CostItem] = if found.is_some() { &CostItem::ALL } else { &[] };
        // SAFETY: `count` was checked and is the caller's.
        unsafe { count.write(effects.len() as u32) };
        if capacity > 0 {
            room.check_capacity("capacity", effects.len())?;
            for (i, &effect) in effects.iter().enumerate() {
                let ms = found.map_or(0.0, |c| c.ms(effect));
                let cost = wk_effect_cost { effect: effect as u32, reserved0: 0, name: effect.name().as_ptr(), ms };
                // SAFETY: `i` is below the capacity that the caller promises.
                unsafe { room.write(i, &cost) };
            }
        }
        Ok(Status::Ok)
    })
}
