//! What a picture needs, and no more
//!
//! With a tolerance, a view gauges its own pictures. In every eighth frame it composes a grid of 64 x 36 of its pixels
//! with everything and without each part of the weather, and reads the differences back some frames later without
//! waiting. Parts that change the picture by less than the tolerance fade out, and fade in again when they matter.
//! Under a budget of time, parts also fade out as the reported times demand, starting with those whose loss is
//! perceived least for the time that they save. They come back when there is time again. After a jump of camera, sun or
//! weather, and in frames with WK_FRAME_CUT or WK_FRAME_NO_HISTORY, everything is drawn.
//!
//! Error means the same everywhere in Welkin: |Y' - Y| / (Y + 0.01 white) of luminances after exposure, its 95th
//! percentile over the picture's pixels. A tolerance also bounds the worst pixel, by ten times as much.
//!
//! Leaving parts out changes no simulation: time, weather and state stay the same on all channels of a simulator.
//! Channels that must also leave out the same parts pin their plan: by hand (WK_BUDGET_HAS_PINNED_PARTS), or with one
//! that another view found (wk_view_save_plan, wk_view_load_plan).

use std::{
    ffi::{c_char, c_void},
    ptr::null,
};

use super::{
    boundary::guard,
    input,
    layout::{self, init_struct, struct_size},
    status::*,
    view::{ViewObject, wk_view},
};
use crate::{
    error::{Error, Status},
    plan::{Budget, GaveWay, PARTS, PartPlan, Reason},
};

include!(concat!(env!("OUT_DIR"), "/init_plan.rs"));

/// Parts of the weather that a picture may leave out.
pub type wk_part_flags = u32;
/// Air and haze between the camera and what the host drew.
pub const WK_PART_AIR: wk_part_flags = 1;
/// Fog, mist, dust and precipitation, as a layer.
pub const WK_PART_FOG: wk_part_flags = 2;
/// The clear sky above the horizon, behind clouds.
pub const WK_PART_SKY: wk_part_flags = 4;

/// Streaks and splashes of rain. Without this part all rain is a veil; without WK_PART_FOG too, no rain is drawn. Only
/// if the host has chosen no rain model for the view.
pub const WK_PART_RAIN: wk_part_flags = 8;
/// Single drops near the camera, and splashes. Without this part cones stand for them.
pub const WK_PART_DROPS: wk_part_flags = 16;

/// Which optional fields of a wk_budget are set.
pub type wk_budget_has_flags = u32;
/// tolerance
pub const WK_BUDGET_HAS_TOLERANCE: wk_budget_has_flags = 1;
/// pinned_parts
pub const WK_BUDGET_HAS_PINNED_PARTS: wk_budget_has_flags = 2;
/// milliseconds
pub const WK_BUDGET_HAS_MILLISECONDS: wk_budget_has_flags = 4;
/// importance_air, importance_fog and importance_sky
pub const WK_BUDGET_HAS_IMPORTANCE: wk_budget_has_flags = 8;
/// pinned_parts also decides WK_PART_RAIN and WK_PART_DROPS; without this bit both are drawn.
pub const WK_BUDGET_HAS_PINNED_RAIN: wk_budget_has_flags = 16;
/// importance_rain and importance_drops
pub const WK_BUDGET_HAS_RAIN_IMPORTANCE: wk_budget_has_flags = 32;

/// Why a part is drawn or not.
pub type wk_plan_reason = u32;
/// No tolerance was given: everything is drawn.
pub const WK_PLAN_REASON_EVERYTHING_ASKED: wk_plan_reason = 0;
/// This picture has not been gauged yet, or must not depend on earlier ones: everything is drawn.
pub const WK_PLAN_REASON_NOT_GAUGED: wk_plan_reason = 1;
/// The weather has none of it, or the recorded stages do not draw it.
pub const WK_PLAN_REASON_ABSENT: wk_plan_reason = 2;
/// Without it the error would exceed the tolerance.
pub const WK_PLAN_REASON_NEEDED: wk_plan_reason = 3;
/// The error without it is within the tolerance.
pub const WK_PLAN_REASON_WITHIN_TOLERANCE: wk_plan_reason = 4;
/// The host pinned it.
pub const WK_PLAN_REASON_PINNED: wk_plan_reason = 5;
/// The time allows no more.
pub const WK_PLAN_REASON_OUT_OF_TIME: wk_plan_reason = 6;

/// Part of a budget that could not be kept, by the estimates.
pub type wk_gave_way = u32;
/// Nothing had to give way.
pub const WK_GAVE_WAY_NOTHING: wk_gave_way = 0;
/// The tolerance: the time allows no better picture.
pub const WK_GAVE_WAY_TOLERANCE: wk_gave_way = 1;
/// Time, and the tolerance: even with every part left out, or with the parts that are pinned, the picture takes longer than
/// the budget.
pub const WK_GAVE_WAY_TIME: wk_gave_way = 2;

/// How wrong a view's pictures may be, and how long they may take.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_budget {
    /// sizeof(wk_budget) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_BUDGET.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Which optional fields are set. Default 0: everything is drawn.
    pub has: wk_budget_has_flags,
    /// Optional: draw exactly these parts, whatever the tolerance and the time, so that all channels draw the same; a
    /// union of WK_PART_ constants, 0 for none. wk_plan.gave_way still says what of a tolerance and a time is not kept.
    pub pinned_parts: wk_part_flags,
    /// Optional: largest error of what is left out. Range (0, 1]; 0.01 is not seen.
    pub tolerance: f64,
    /// Optional: longest time of the weather in a frame, ms; wins over the tolerance. Range (0, 1000]. The plan knows
    /// only the times of wk_view_report_time.
    pub milliseconds: f64,
    /// Optional, all three: importance of the parts to the viewer, which decides what is left out first under a budget
    /// of time. Range [0, 1], default 0.9, 0.9 and 0.2.
    pub importance_air: f64,
    /// As importance_air.
    pub importance_fog: f64,
    /// As importance_air.
    pub importance_sky: f64,
    /// Optional, both: the same for rain. Range [0, 1], default 0.7 and 0.7.
    pub importance_rain: f64,
    /// As importance_rain.
    pub importance_drops: f64,
}

impl wk_budget {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_BUDGET,
        next: null(),
        has: 0,
        pinned_parts: 0,
        tolerance: 0.0,
        milliseconds: 0.0,
        importance_air: 0.0,
        importance_fog: 0.0,
        importance_sky: 0.0,
        importance_rain: 0.0,
        importance_drops: 0.0,
    };
}

/// Parts that a view's last frame left out. Errors are estimates from the gauged pixels.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_plan {
    /// sizeof(wk_plan) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_PLAN.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// The parts of which anything is drawn.
    pub drawn: wk_part_flags,
    /// Part of the budget that could not be kept.
    pub gave_way: wk_gave_way,
    /// Error of everything left out together: 95th percentile over the gauged pixels.
    pub error: f64,
    /// Upper end of the 95 % confidence interval of that percentile over all pixels.
    pub error_bound: f64,
    /// Error of the worst gauged pixel.
    pub worst: f64,
    /// Work of the picture as planned, in units of a pixel with none of the parts; 0 before the first gauge.
    pub work: f64,
    /// Work of the picture with everything, in the same units.
    pub work_of_everything: f64,
    /// Predicted time of the picture from the times reported so far, ms; 0 before the first.
    pub milliseconds: f64,
}

impl wk_plan {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_PLAN,
        next: null(),
        drawn: 0,
        gave_way: 0,
        error: 0.0,
        error_bound: 0.0,
        worst: 0.0,
        work: 0.0,
        work_of_everything: 0.0,
        milliseconds: 0.0,
    };
}

/// One part of a plan.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_part_plan {
    /// sizeof(wk_part_plan) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_PART_PLAN.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Reason why it is drawn or not.
    pub reason: wk_plan_reason,
    /// 0.
    pub reserved: u32,
    /// The reason in a few words of English; lives as long as the process.
    pub reason_text: *const c_char,
    /// Drawn share: 1 all, 0 nothing, in between while it fades.
    pub share: f64,
    /// Error of the picture without this part alone, as last gauged.
    pub error: f64,
    /// The same at the worst gauged pixel.
    pub worst: f64,
    /// Work that it adds, or would add, to this picture with everything, in units of a pixel with none of the parts.
    pub work: f64,
}

impl wk_part_plan {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_PART_PLAN,
        next: null(),
        reason: 0,
        reserved: 0,
        reason_text: null(),
        share: 0.0,
        error: 0.0,
        worst: 0.0,
        work: 0.0,
    };

    fn of(part: &PartPlan) -> Self {
        let reason = match part.reason {
            Reason::EverythingAsked => WK_PLAN_REASON_EVERYTHING_ASKED,
            Reason::NotGauged => WK_PLAN_REASON_NOT_GAUGED,
            Reason::Absent => WK_PLAN_REASON_ABSENT,
            Reason::Needed => WK_PLAN_REASON_NEEDED,
            Reason::WithinTolerance => WK_PLAN_REASON_WITHIN_TOLERANCE,
            Reason::OutOfTime => WK_PLAN_REASON_OUT_OF_TIME,
            Reason::Pinned => WK_PLAN_REASON_PINNED,
        };
        Self {
            reason,
            reason_text: part.reason.text().as_ptr(),
            share: part.share.into(),
            error: part.worth.p95,
            worst: part.worth.worst,
            work: part.work,
            ..Self::INIT
        }
    }
}

/// Sets the tolerance and the time of the view's pictures; NULL draws everything again. Unchanged after an error.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_set_budget(view: *mut wk_view, budget: *const wk_budget) -> wk_status {
    guard("wk_view_set_budget", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        let mut asked = Budget::default();
        if !budget.is_null() {
            // SAFETY: the caller's promise about `budget`.
            let c = unsafe { layout::read(&"budget", budget)? };
            // SAFETY: as above.
            unsafe { layout::check_chain(&"budget", c.next, &[])? };
            layout::WK_BUDGET_HAS_FLAGS.check(&"budget.has", c.has.into())?;
            layout::WK_PART_FLAGS.check(&"budget.pinned_parts", c.pinned_parts.into())?;
            asked.tolerance = (c.has & WK_BUDGET_HAS_TOLERANCE != 0).then_some(c.tolerance);
            asked.milliseconds = (c.has & WK_BUDGET_HAS_MILLISECONDS != 0).then_some(c.milliseconds);
            if c.has & WK_BUDGET_HAS_IMPORTANCE != 0 {
                asked.importance[..3].copy_from_slice(&[c.importance_air, c.importance_fog, c.importance_sky]);
            }
            if c.has & WK_BUDGET_HAS_RAIN_IMPORTANCE != 0 {
                asked.importance[3..].copy_from_slice(&[c.importance_rain, c.importance_drops]);
            }
            let rain = if c.has & WK_BUDGET_HAS_PINNED_RAIN != 0 { 0 } else { WK_PART_RAIN | WK_PART_DROPS };
            let pinned = FLAGS.map(|p| (c.pinned_parts | rain) & p != 0);
            asked.pinned = (c.has & WK_BUDGET_HAS_PINNED_PARTS != 0).then_some(pinned);
        }
        asked.validate()?;
        object.cell.drain();
        object.lock().set_budget(asked)?;
        Ok(Status::Ok)
    })
}

/// Reports the time that the weather took in the last frame, ms, measured as for the budget (your GPU timer, or a call
/// that you wait for). Under a budget of time the plan uses the median of the last five reports.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_INVALID_ARGUMENT outside of (0, 1e5] ms; nothing changes then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_report_time(view: *mut wk_view, milliseconds: f64) -> wk_status {
    guard("wk_view_report_time", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        object.lock().report_time(milliseconds)?;
        Ok(Status::Ok)
    })
}

/// Gets what the view's last frame left out.
/// Thread: exclusive on the view.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_get_plan(view: *mut wk_view, out_plan: *mut wk_plan) -> wk_status {
    guard("wk_view_get_plan", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        // SAFETY: the caller's promise about `out_plan`.
        let place = unsafe { layout::out_struct(&"out_plan", out_plan)? };
        let plan = *object.lock().plan();
        let drawn = plan.parts.iter().zip(FLAGS);
        place.set(&wk_plan {
            drawn: drawn.filter(|(p, _)| p.share > 0.0).fold(0, |all, (_, flag)| all | flag),
            error: plan.error.p95,
            error_bound: plan.error.bound,
            worst: plan.error.worst,
            work: plan.work,
            work_of_everything: plan.work_of_everything,
            milliseconds: plan.milliseconds.unwrap_or(0.0),
            gave_way: match plan.gave_way {
                GaveWay::Nothing => WK_GAVE_WAY_NOTHING,
                GaveWay::Tolerance => WK_GAVE_WAY_TOLERANCE,
                GaveWay::Time => WK_GAVE_WAY_TIME,
            },
            ..wk_plan::INIT
        });
        Ok(Status::Ok)
    })
}

/// Gets how much of one part (a single WK_PART_ constant) the view's last frame drew, and why.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_INVALID_ARGUMENT for no or several parts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_get_part_plan(
    view: *mut wk_view,
    part: wk_part_flags,
    out_part: *mut wk_part_plan,
) -> wk_status {
    guard("wk_view_get_part_plan", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        let Some(i) = FLAGS.iter().position(|f| *f == part) else {
            let names = "one of WK_PART_AIR, WK_PART_FOG, WK_PART_SKY, WK_PART_RAIN, WK_PART_DROPS";
            return Err(Error::range("part", names, part));
        };
        // SAFETY: the caller's promise about `out_part`.
        let place = unsafe { layout::out_struct(&"out_part", out_part)? };
        place.set(&wk_part_plan::of(&object.lock().plan().parts[i]));
        Ok(Status::Ok)
    })
}

/// Writes the view's plan, for wk_view_load_plan on other channels or another day: the parts that are drawn, and the
/// settings of the sky. UTF-8 text. `*out_size` gets the bytes needed, even if `capacity` is too small (then nothing
/// else is written and the call fails) or `buffer` is NULL with `capacity` 0 (then it succeeds).
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_WRONG_ORDER while the view has a budget but has not gauged its picture yet: some frames follow each
/// jump of camera, sun or weather.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_save_plan(
    view: *mut wk_view,
    buffer: *mut c_void,
    capacity: usize,
    out_size: *mut usize,
) -> wk_status {
    guard("wk_view_save_plan", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        let saved = object.lock().save_plan()?;
        // SAFETY: the caller's promises.
        unsafe { input::answer_bytes(saved.as_bytes(), buffer, capacity, out_size)? };
        Ok(Status::Ok)
    })
}

/// Pins a plan that wk_view_save_plan wrote, as WK_BUDGET_HAS_PINNED_PARTS does; the rest of the view's budget stays, and
/// wk_view_set_budget ends it.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_PARSE for bytes that are no such plan or of another version, naming line and column or the field;
/// WK_ERROR_INVALID_ARGUMENT naming the setting of the sky in which the view's context differs. After an error the
/// view's plan stays as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_load_plan(view: *mut wk_view, plan: *const c_void, size: usize) -> wk_status {
    guard("wk_view_load_plan", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        layout::check_pointer(&"plan", plan.cast::<u8>())?;
        // SAFETY: the caller promises `size` readable bytes.
        let bytes = unsafe { input::slice("plan", plan.cast::<u8>(), size, usize::MAX)? };
        object.cell.drain();
        object.lock().load_plan(bytes)?;
        Ok(Status::Ok)
    })
}

/// In the order of [`Part::ALL`].
const FLAGS: [wk_part_flags; PARTS] = [WK_PART_AIR, WK_PART_FOG, WK_PART_SKY, WK_PART_RAIN, WK_PART_DROPS];
