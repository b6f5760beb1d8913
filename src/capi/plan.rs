//! Plan and budget of a view
//!
//! With a tolerance, a view gauges its own pictures. In every eighth frame it draws a grid of 64 x 36 of its pixels
//! with everything, and again without each part of the weather. It reads the differences back some frames later,
//! without waiting for the GPU. Parts that change the picture by less than the tolerance fade out, and fade in again
//! when they matter. Under a budget of time, further parts fade out until the reported times fit the budget, starting
//! with the parts that save the most time for the least visible loss. These parts come back when there is time again.
//! After a jump of camera, sun or weather, and in frames with WK_FRAME_CUT or WK_FRAME_NO_HISTORY, everything is drawn.
//!
//! A part has a number (WK_PART_), a name and rungs, which are its levels of detail. Rung 0 draws all of it; the last
//! rung draws nothing, or the cheapest substitute. Later versions append parts: wk_plan.part_count has their number,
//! wk_view_get_part_plan their names.
//!
//! Error means the same everywhere in Welkin: |Y' - Y| / (Y + 0.01 white). Y is the luminance of a pixel in the
//! complete picture, Y' its luminance where parts are left out, and white the luminance that the exposure shows as
//! white. The error of a picture is the 95th percentile over its pixels. A tolerance also limits the error of the worst
//! pixel, to ten times the tolerance.
//!
//! Leaving parts out changes no simulation: time, weather and state stay the same on all channels of a simulator.
//! Channels that must also leave out the same parts pin their plan: by hand (WK_PART_WISH_HAS_RUNG), or with a plan
//! that another view found (wk_view_save_plan, wk_view_load_plan).

use std::{
    ffi::{CString, c_char, c_void},
    ptr::null,
    sync::LazyLock,
};

use super::boundary::{
    guard,
    input::{self, List, Named},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ViewObject, wk_view},
};
use crate::{
    error::{Error, Result, Status},
    frame::PARTS,
    plan::{Budget, GaveWay, PartPlan, PartWish, Reason},
};

include!(concat!(env!("OUT_DIR"), "/init_plan.rs"));

/// A part of the weather that a picture can reduce or leave out, by its number.
pub type wk_part = u32;
/// Air and haze between the camera and what the host drew. Rungs: all, none.
pub const WK_PART_AIR: wk_part = 0;
/// Fog, mist, dust and precipitation, as a layer. Rungs: all, none.
pub const WK_PART_FOG: wk_part = 1;
/// The clear sky above the horizon, behind clouds. Rungs: all, none.
pub const WK_PART_SKY: wk_part = 2;
/// Streaks and splashes of rain, unless the host chose the view's rain model. Rungs: drops (single ones near the
/// camera), cones (in place of drops), none (all rain is extinction in the air; without WK_PART_FOG no rain is drawn at
/// all).
pub const WK_PART_RAIN: wk_part = 3;
/// Stars, planets and the glow of the night sky between them. Rungs: all, none (a uniform sky of the same light).
pub const WK_PART_STARS: wk_part = 4;
/// Clouds, where the context draws them as a volume. Rungs: volume, deck (as WK_CLOUD_MODEL_DECK).
pub const WK_PART_CLOUDS: wk_part = 5;
/// Flakes of falling snow, unless the host chose the view's snow model. Rungs: flakes, none (all snow is extinction in
/// the air; without WK_PART_FOG no snow is drawn at all).
pub const WK_PART_SNOW: wk_part = 6;

/// Flags that say which optional fields of a wk_part_wish are set.
pub type wk_part_wish_has_flags = u32;
/// importance
pub const WK_PART_WISH_HAS_IMPORTANCE: wk_part_wish_has_flags = 1;
/// rung
pub const WK_PART_WISH_HAS_RUNG: wk_part_wish_has_flags = 2;

/// Flags that say which optional fields of a wk_budget are set.
pub type wk_budget_has_flags = u32;
/// tolerance
pub const WK_BUDGET_HAS_TOLERANCE: wk_budget_has_flags = 1;
/// milliseconds
pub const WK_BUDGET_HAS_MILLISECONDS: wk_budget_has_flags = 2;

/// Reason for the rung at which a part is drawn.
pub type wk_plan_reason = u32;
/// No tolerance was given: everything is drawn.
pub const WK_PLAN_REASON_EVERYTHING_ASKED: wk_plan_reason = 0;
/// This picture has not been gauged yet, or must not depend on earlier ones: everything is drawn.
pub const WK_PLAN_REASON_NOT_GAUGED: wk_plan_reason = 1;
/// The weather does not have this part, or the recorded stages do not draw it.
pub const WK_PLAN_REASON_ABSENT: wk_plan_reason = 2;
/// The error would exceed the tolerance with less of the part.
pub const WK_PLAN_REASON_NEEDED: wk_plan_reason = 3;
/// The error with less of the part is within the tolerance.
pub const WK_PLAN_REASON_WITHIN_TOLERANCE: wk_plan_reason = 4;
/// The host pinned the part.
pub const WK_PLAN_REASON_PINNED: wk_plan_reason = 5;
/// The budget of time allows no more of the part.
pub const WK_PLAN_REASON_OUT_OF_TIME: wk_plan_reason = 6;

/// A budget's limit that the picture exceeds, according to the estimates.
pub type wk_gave_way = u32;
/// Nothing had to give way.
pub const WK_GAVE_WAY_NOTHING: wk_gave_way = 0;
/// The tolerance: a better picture would take longer than the budget allows.
pub const WK_GAVE_WAY_TOLERANCE: wk_gave_way = 1;
/// Time and the tolerance: the picture takes longer than the budget allows, even if all parts that are not pinned are
/// left out.
pub const WK_GAVE_WAY_TIME: wk_gave_way = 2;

/// A host's wish for one part.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_part_wish {
    /// sizeof(wk_part_wish) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_PART_WISH.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Flags of the optional fields that are set. Default 0.
    pub has: wk_part_wish_has_flags,
    /// Part that the wish is about. Default WK_PART_AIR.
    pub part: wk_part,
    /// Optional: draw the part at exactly this rung, whatever the tolerance and the time, so that all channels draw the
    /// same. Range: below the part's wk_part_plan.rung_count. wk_plan.gave_way still says whether the tolerance or the
    /// time is exceeded.
    pub rung: u32,
    /// Must be 0.
    pub reserved: u32,
    /// Optional: importance of the part to viewers. A budget of time leaves out the less important parts first. Range
    /// [0, 1], default wk_part_plan.importance.
    pub importance: f64,
}

impl wk_part_wish {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_PART_WISH,
        next: null(),
        has: 0,
        part: 0,
        rung: 0,
        reserved: 0,
        importance: 0.0,
    };
}

/// Limits for a view's pictures: how wrong they may be, and how long they may take.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_budget {
    /// sizeof(wk_budget) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_BUDGET.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Flags of the optional fields that are set. Default 0: everything is drawn.
    pub has: wk_budget_has_flags,
    /// Number of wishes. Default 0. Parts without a wish are planned with their default importance.
    pub wish_count: u32,
    /// Bytes from one wish to the next: sizeof(wk_part_wish) of your header, which is the default.
    pub wish_stride: u32,
    /// Must be 0.
    pub reserved: u32,
    /// Wishes for single parts, at most one for each part; read during the call only. Default NULL.
    pub wishes: *const wk_part_wish,
    /// Optional: largest error that leaving parts out may cause. Range (0, 1]; an error of 0.01 is not visible.
    pub tolerance: f64,
    /// Optional: longest time that the weather may take in a frame, ms; wins over the tolerance. Range (0, 1000]. The
    /// plan knows times only from wk_view_report_time.
    pub milliseconds: f64,
}

impl wk_budget {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_BUDGET,
        next: null(),
        has: 0,
        wish_count: 0,
        wish_stride: struct_size::<wk_part_wish>(),
        reserved: 0,
        wishes: null(),
        tolerance: 0.0,
        milliseconds: 0.0,
    };
}

/// Plan of a view's last frame: the errors due to the parts that the frame left out, and the frame's cost. Errors are
/// estimates from the gauged pixels.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_plan {
    /// sizeof(wk_plan) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_PLAN.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Number of parts. Parts are numbered from 0.
    pub part_count: u32,
    /// The budget's limit that could not be kept.
    pub gave_way: wk_gave_way,
    /// Error of everything left out together: 95th percentile over the gauged pixels.
    pub error: f64,
    /// Upper bound, with 95 % confidence, of the 95th percentile over all pixels.
    pub error_bound: f64,
    /// Error of the worst gauged pixel.
    pub worst: f64,
    /// Work of the picture as planned, in units of the work of one pixel without any part; 0 before the first gauge.
    pub work: f64,
    /// Work of the picture with everything, in the same units.
    pub work_of_everything: f64,
    /// Time of the picture predicted from the times reported so far, ms; 0 before the first report.
    pub milliseconds: f64,
}

impl wk_plan {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_PLAN,
        next: null(),
        part_count: 0,
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
    /// Reason for the rung.
    pub reason: wk_plan_reason,
    /// Rung at which the part is drawn once fading is over; 0, all of it, if the weather does not have the part.
    pub rung: u32,
    /// Number of the part's rungs.
    pub rung_count: u32,
    /// Always 0.
    pub reserved: u32,
    /// Name of the part in saved plans and messages, UTF-8. This text, rung_name and reason_text live as long as the
    /// process.
    pub name: *const c_char,
    /// Name of the rung.
    pub rung_name: *const c_char,
    /// Reason in a few words of English.
    pub reason_text: *const c_char,
    /// Importance that the part has unless a budget sets another.
    pub importance: f64,
    /// Share of the part that is drawn: 1 all of it, 0 its last rung; between 0 and 1 while the part fades, or on a
    /// rung between the first and the last.
    pub share: f64,
    /// Error that the picture would have if this part alone were drawn at its last rung, as of the last gauge.
    pub error: f64,
    /// Error that the worst gauged pixel would have if this part alone were drawn at its last rung, as of the last
    /// gauge.
    pub worst: f64,
    /// Work that the whole part adds, or would add, to this picture with everything, in the units of wk_plan.work.
    pub work: f64,
}

impl wk_part_plan {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_PART_PLAN,
        next: null(),
        reason: 0,
        rung: 0,
        rung_count: 0,
        reserved: 0,
        name: null(),
        rung_name: null(),
        reason_text: null(),
        importance: 0.0,
        share: 0.0,
        error: 0.0,
        worst: 0.0,
        work: 0.0,
    };

    fn of(number: usize, part: &PartPlan) -> Self {
        let reason = match part.reason {
            Reason::EverythingAsked => WK_PLAN_REASON_EVERYTHING_ASKED,
            Reason::NotGauged => WK_PLAN_REASON_NOT_GAUGED,
            Reason::Absent => WK_PLAN_REASON_ABSENT,
            Reason::Needed => WK_PLAN_REASON_NEEDED,
            Reason::WithinTolerance => WK_PLAN_REASON_WITHIN_TOLERANCE,
            Reason::OutOfTime => WK_PLAN_REASON_OUT_OF_TIME,
            Reason::Pinned => WK_PLAN_REASON_PINNED,
        };
        let (name, rungs) = &NAMES[number];
        Self {
            reason,
            rung: part.rung as u32,
            rung_count: rungs.len() as u32,
            name: name.as_ptr(),
            rung_name: rungs[part.rung].as_ptr(),
            reason_text: part.reason.text().as_ptr(),
            importance: part.part.importance,
            share: part.share.into(),
            error: part.last().p95,
            worst: part.last().worst,
            work: part.work,
            ..Self::INIT
        }
    }
}

/// Sets the limits for the view's pictures: tolerance and time. NULL removes them, and everything is drawn again. After
/// an error the previous limits stay.
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
            asked.tolerance = (c.has & WK_BUDGET_HAS_TOLERANCE != 0).then_some(c.tolerance);
            asked.milliseconds = (c.has & WK_BUDGET_HAS_MILLISECONDS != 0).then_some(c.milliseconds);
            let parts;
            (asked.wishes, parts) = wishes(&c)?;
            asked.validate(PARTS).map_err(|e| in_list(&parts, e))?;
        }
        object.cell.drain();
        object.lock().set_budget(asked)?;
        Ok(Status::Ok)
    })
}

/// Reports the time that the weather took in the last frame, ms, in (0, 1e5]. Measure the time in the same way as you
/// chose the budget: with a GPU timer, or around a call whose end you wait for. Under a budget of time the plan uses
/// the median of the last five reports.
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

/// Gets the plan of the view's last frame.
/// Thread: exclusive on the view.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_get_plan(view: *mut wk_view, out_plan: *mut wk_plan) -> wk_status {
    guard("wk_view_get_plan", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        // SAFETY: the caller's promise about `out_plan`.
        let place = unsafe { layout::out_struct(&"out_plan", out_plan)? };
        let view = object.lock();
        let plan = view.plan();
        place.set(&wk_plan {
            part_count: plan.parts.len() as u32,
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

/// Gets how much of one part the view's last frame drew, and why. The part's name can be read before any frame too.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_INVALID_ARGUMENT for a number that no part has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_get_part_plan(
    view: *mut wk_view,
    part: wk_part,
    out_part: *mut wk_part_plan,
) -> wk_status {
    guard("wk_view_get_part_plan", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        input::check_enum("part", &layout::WK_PART, part)?;
        // SAFETY: the caller's promise about `out_part`.
        let place = unsafe { layout::out_struct(&"out_part", out_part)? };
        place.set(&wk_part_plan::of(part as usize, &object.lock().plan().parts[part as usize]));
        Ok(Status::Ok)
    })
}

/// Writes the view's plan as UTF-8 text: the rung of each part, and the settings of the sky. wk_view_load_plan reads
/// the text, also in other views or on another day. `*out_size` always gets the number of bytes needed. If `capacity`
/// is too small, nothing else is written and the call fails; with `buffer` NULL and `capacity` 0 it succeeds.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_WRONG_ORDER while the view has a budget but has not gauged its picture yet: for some frames after
/// each jump of camera, sun or weather.
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

/// Pins every part at its rung in a plan that wk_view_save_plan wrote, as wishes with WK_PART_WISH_HAS_RUNG do. The
/// rest of the view's budget stays; wk_view_set_budget removes the pins.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_PARSE for bytes that are no saved plan, or that are a plan of another version, naming line and
/// column or the field; WK_ERROR_INVALID_ARGUMENT naming the setting of the sky that differs between the plan and the
/// view's context. After an error the view's plan stays as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_load_plan(view: *mut wk_view, plan: *const c_void, size: usize) -> wk_status {
    guard("wk_view_load_plan", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        layout::check_pointer(&"plan", plan.cast::<u8>())?;
        // SAFETY: the caller promises `size` readable bytes.
        let bytes = unsafe { input::slice("plan", plan.cast::<u8>(), Named("size", size), usize::MAX)? };
        object.cell.drain();
        object.lock().load_plan(bytes).map_err(|e| e.in_text("plan"))?;
        Ok(Status::Ok)
    })
}

/// Names of the parts and of their rungs, for C.
static NAMES: LazyLock<Vec<(CString, Vec<CString>)>> = LazyLock::new(|| {
    let text = |name: &&str| CString::new(*name).unwrap_or_default();
    PARTS.iter().map(|p| (text(&p.name), p.rungs.iter().map(text).collect())).collect()
});

/// Renames the wish in an error: the Rust API numbers wishes by part, the header by their index in the list.
fn in_list(parts: &[usize], e: Error) -> Error {
    let of = |i: usize| format!("budget.wishes[{i}]");
    let place = parts.iter().position(|part| e.field().is_some_and(|f| f.starts_with(&of(*part))));
    place.map_or(e.clone(), |i| e.renamed(&of(parts[i]), &of(i)))
}

/// Returns the wishes by the number of their part, and the part of each element of the host's list.
fn wishes(c: &wk_budget) -> Result<(Vec<PartWish>, Vec<usize>)> {
    let mut wishes = vec![PartWish::default(); if c.wish_count > 0 { PARTS.len() } else { 0 }];
    let mut parts = Vec::new();
    let mut take = |i: usize, w: wk_part_wish| {
        let name = format!("budget.wishes[{i}]");
        layout::WK_PART_WISH_HAS_FLAGS.check(&format!("{name}.has"), w.has.into())?;
        let part = w.part as usize;
        if parts.contains(&part) {
            return Err(Error::range(&format!("{name}.part"), "a part that is not in the list yet", w.part));
        }
        parts.push(part);
        wishes[part] = PartWish {
            importance: (w.has & WK_PART_WISH_HAS_IMPORTANCE != 0).then_some(w.importance),
            rung: (w.has & WK_PART_WISH_HAS_RUNG != 0).then_some(w.rung as usize),
        };
        Ok(())
    };
    let list = List {
        name: "budget.wishes",
        count: Named("budget.wish_count", c.wish_count as usize),
        stride: Named("budget.wish_stride", c.wish_stride as usize),
        limit: PARTS.len(),
    };
    // SAFETY: the caller's promise about the list.
    unsafe { input::each(&list, c.wishes, &mut take)? };
    Ok((wishes, parts))
}
