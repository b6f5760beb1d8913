//! Lightning
//!
//! A thunderstorm (WK_PRECIPITATION_THUNDERSTORM, a report with TS) flashes three times a minute in each square of 20
//! km by 20 km. The host may set another rate, and the places of the storm cells. Every flash is a function of the
//! context's seed, the time, the rate and the storm cells. All channels of a simulator therefore show the same flashes,
//! and any time can be shown again. Views draw the paths of flashes, the glow of clouds and air, and the light of
//! flashes on rain and wet ground. The host queries flashes to play thunder, and queries their light to light its own
//! scene:
//!
//! ```c
//! wk_flash flashes[16];
//! uint32_t count = 0;
//! wk_context_get_flashes(context, ear, last_s, now_s, 20e3, flashes, 16, sizeof flashes[0], &count);
//! for (uint32_t i = 0; i < count; i++)
//!     play_thunder_at(flashes[i].time_s + flashes[i].thunder_delay_s, flashes[i].distance_m);
//! ```
//!
//! A frame contains the light of flashes from the time of the view's previous frame to the frame's own time. No flash
//! is missed or drawn twice, whatever the frame rate. A frame contains the light of the last 1/60 s alone if it is the
//! view's first one, if it has WK_FRAME_CUT or WK_FRAME_NO_HISTORY, or if time has jumped by more than 0.5 s or
//! backwards.

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, Named, out, position},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, wk_context},
};
use crate::{
    error::{Error, Result, Status, check_range},
    lightning::{FlashEvent, FlashKind, FlashTrigger, LightningSettings, MAX_CELLS, MAX_MASTS, StormCell},
};

include!(concat!(env!("OUT_DIR"), "/init_lightning.rs"));

/// Flags of a wk_lightning.
pub type wk_lightning_flags = u32;
/// The host's rate, flashes_per_minute, replaces the weather's.
pub const WK_LIGHTNING_RATE: wk_lightning_flags = 1;

/// Flicker of flashes in a picture.
pub type wk_flicker = u32;
/// Flicker as in nature: many changes of luminance a second.
pub const WK_FLICKER_AS_IN_NATURE: wk_flicker = 0;
/// Limited flicker, for viewers whom flicker may harm: at most three changes of luminance in any second. A drawn flash
/// rises once and fades, which is two changes. The next drawn flash begins a second later at the earliest; flashes in
/// between are not drawn. Queries return all flashes and all of their light.
pub const WK_FLICKER_LIMITED: wk_flicker = 1;

/// Place where a flash ends: on the ground or in the cloud.
pub type wk_flash_kind = u32;
/// The flash strikes the ground.
pub const WK_FLASH_KIND_TO_GROUND: wk_flash_kind = 0;
/// The flash stays within the cloud.
pub const WK_FLASH_KIND_IN_CLOUD: wk_flash_kind = 1;

/// Rate and places of flashes, and how views draw them.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_lightning {
    /// sizeof(wk_lightning) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_LIGHTNING.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// WK_LIGHTNING_* flags. Default 0: the weather gives the rate.
    pub flags: wk_lightning_flags,
    /// Flicker of the drawn flashes. Default WK_FLICKER_AS_IN_NATURE.
    pub flicker: wk_flicker,
    /// Flashes a minute in each square of 20 km by 20 km, whatever the weather. The rate is used with
    /// WK_LIGHTNING_RATE, and only if there are no `cells`, which have rates of their own. Range [0, 60], default 0.
    pub flashes_per_minute: f64,
    /// Number of storm cells in `cells`, at most 16. If there are any, they replace the weather's storm cells. Default
    /// 0.
    pub cell_count: u32,
    /// Number of tall objects in `masts`, at most 64. Default 0.
    pub mast_count: u32,
    /// Five numbers for each cell. The first three are its middle in the host's world, m; the height has no effect. The
    /// fourth is the horizontal distance from the middle within which two thirds of the cell's flashes start, m, in [0,
    /// 1e5]. The fifth is the number of flashes a minute, in [0, 60]. Copied by the call. Default NULL.
    pub cells: *const f64,
    /// Three numbers for each mast: its tip in the host's world, m. Masts and the tops of shelters
    /// (wk_context_set_shelters) attract ground flashes, except flashes that the host triggers. Copied by the call.
    /// Default NULL.
    pub masts: *const f64,
}

impl wk_lightning {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_LIGHTNING,
        next: null(),
        flags: 0,
        flicker: WK_FLICKER_AS_IN_NATURE,
        flashes_per_minute: 0.0,
        cell_count: 0,
        mast_count: 0,
        cells: null(),
        masts: null(),
    };
}

/// A flash that the host triggers.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_flash_trigger {
    /// sizeof(wk_flash_trigger) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_FLASH_TRIGGER.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Simulation time of the flash's first stroke, s, not before the present. Range [-1e10, 1e10], default 0.
    pub time_s: f64,
    /// Position in the host's world, m, that a ground flash strikes, or over which a flash within the cloud passes. A
    /// flash that meets a shelter on its way ends there. Default 0, 0, 0.
    pub position_m: [f64; 3],
    /// Largest peak current of the flash's strokes, kA. Range [1, 500], or 0, the default: random.
    pub peak_ka: f64,
    /// Place where the flash ends. Default WK_FLASH_KIND_TO_GROUND.
    pub kind: wk_flash_kind,
    /// Number of strokes. Range [0, 26], default 0: random.
    pub strokes: u32,
}

impl wk_flash_trigger {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_FLASH_TRIGGER,
        next: null(),
        time_s: 0.0,
        position_m: [0.0, 0.0, 0.0],
        peak_ka: 0.0,
        kind: WK_FLASH_KIND_TO_GROUND,
        strokes: 0,
    };
}

/// A flash as seen and heard from a place. Element of an array, without struct_size; calls take its sizeof instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_flash {
    /// Number that identifies the flash within the context.
    pub id: u64,
    /// Simulation time of the flash's first stroke, s.
    pub time_s: f64,
    /// Place where the flash ends.
    pub kind: wk_flash_kind,
    /// Number of strokes. For a flash within the cloud: number of pulses of light.
    pub strokes: u32,
    /// Largest peak current of the flash's strokes or pulses, kA.
    pub peak_ka: f64,
    /// Point that a ground flash struck, or middle of the path of a flash within the cloud, in the host's world, m.
    pub position_m: [f64; 3],
    /// Distance from the queried place to the nearest point of the flash's path, m.
    pub distance_m: f64,
    /// Unit vector towards position_m, (east, north, up) at the queried place.
    pub direction: [f64; 3],
    /// Time from time_s to the beginning of the thunder at the queried place, s: distance_m / (331.3 + 0.606 t), with
    /// the air's temperature t in degrees Celsius.
    pub thunder_delay_s: f64,
}

impl wk_flash {
    fn of(f: &FlashEvent) -> Self {
        Self {
            id: f.id,
            time_s: f.time_s,
            kind: match f.kind {
                FlashKind::ToGround => WK_FLASH_KIND_TO_GROUND,
                FlashKind::InCloud => WK_FLASH_KIND_IN_CLOUD,
            },
            strokes: f.strokes,
            peak_ka: f.peak_ka,
            position_m: f.position.to_array(),
            distance_m: f.distance_m,
            direction: f.direction.to_array(),
            thunder_delay_s: f.thunder_delay_s,
        }
    }
}

/// Light of flashes at a place.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_flash_light {
    /// sizeof(wk_flash_light) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_FLASH_LIGHT.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Illuminance that each source gives to a surface facing it, summed over all sources, lux for each of red, green
    /// and blue (linear Rec. 709).
    pub facing_lux: [f64; 3],
    /// Illuminance on level ground, lux.
    pub level_lux: f64,
    /// Mean direction towards the light: unit vector (east, north, up) at the place. Straight up where there is no
    /// light.
    pub direction: [f64; 3],
}

impl wk_flash_light {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_FLASH_LIGHT,
        next: null(),
        facing_lux: [0.0, 0.0, 0.0],
        level_lux: 0.0,
        direction: [0.0, 0.0, 0.0],
    };
}

/// # Safety
/// `p` is NULL or points to a `wk_lightning`; its lists have as many elements as its counts say.
unsafe fn settings(p: *const wk_lightning) -> Result<LightningSettings> {
    // SAFETY: the caller's promise.
    let c = unsafe { layout::read(&"lightning", p)? };
    let counts = [("lightning.cell_count", c.cell_count), ("lightning.mast_count", c.mast_count)];
    let [cells, masts] = counts.map(|(name, count)| Named(name, count as usize));
    // SAFETY: as above.
    let (cells, masts): (&[[f64; 5]], &[[f64; 3]]) = unsafe {
        layout::check_chain(&"lightning", c.next, &[])?;
        (
            input::slice("lightning.cells", c.cells.cast(), cells, MAX_CELLS)?,
            input::slice("lightning.masts", c.masts.cast(), masts, MAX_MASTS)?,
        )
    };
    // Errors name a number by its index in the host's list.
    let place = |list: &str, first: usize, p: [f64; 3]| {
        let within =
            |(k, v): (usize, &f64)| check_range(&format!("lightning.{list}[{}]", first + k), *v, -1e12, 1e12, "m");
        p.iter().enumerate().try_for_each(within)?;
        Ok::<DVec3, Error>(DVec3::from_array(p))
    };
    let cell = |(i, [x, y, z, radius_m, rate]): (usize, &[f64; 5])| {
        let number = |k: usize| format!("lightning.cells[{}]", 5 * i + k);
        check_range(&number(3), *radius_m, 0.0, 1e5, "m")?;
        check_range(&number(4), *rate, 0.0, 60.0, "1/min")?;
        let position = place("cells", 5 * i, [*x, *y, *z])?;
        Ok(StormCell { position, radius_m: *radius_m, flashes_per_minute: *rate })
    };
    Ok(LightningSettings {
        flashes_per_minute: (c.flags & WK_LIGHTNING_RATE != 0).then_some(c.flashes_per_minute),
        cells: cells.iter().enumerate().map(cell).collect::<Result<_>>()?,
        masts: masts.iter().enumerate().map(|(i, m)| place("masts", 3 * i, *m)).collect::<Result<_>>()?,
        limits_flicker: c.flicker == WK_FLICKER_LIMITED,
    })
}

/// Sets the rate and the places of flashes, and how views draw them; NULL returns to the default. The settings are part
/// of the saved state. A failed call changes nothing.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_lightning(
    context: *mut wk_context,
    lightning: *const wk_lightning,
) -> wk_status {
    guard("wk_context_set_lightning", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `lightning`.
        let set = if lightning.is_null() { LightningSettings::default() } else { unsafe { settings(lightning)? } };
        object.write().set_lightning(set)?;
        Ok(Status::Ok)
    })
}

/// Triggers a flash, whatever the weather. The flash is part of the saved state until 120 s after its time_s. At most
/// 64 triggered flashes are kept at a time. A failed call triggers nothing.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range, or if there are too many flashes;
/// WK_ERROR_WRONG_ORDER for a time before the present.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_trigger_flash(
    context: *mut wk_context,
    flash: *const wk_flash_trigger,
) -> wk_status {
    guard("wk_context_trigger_flash", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `flash`.
        let c = unsafe { layout::read(&"flash", flash)? };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"flash", c.next, &[])? };
        let trigger = FlashTrigger {
            time_s: c.time_s,
            position: DVec3::from_array(c.position_m),
            kind: if c.kind == WK_FLASH_KIND_IN_CLOUD { FlashKind::InCloud } else { FlashKind::ToGround },
            peak_ka: (c.peak_ka != 0.0).then_some(c.peak_ka),
            strokes: (c.strokes != 0).then_some(c.strokes),
        };
        object.write().trigger_flash(&trigger).map_err(|e| e.renamed("flash.position", "flash.position_m"))?;
        Ok(Status::Ok)
    })
}

/// Gets the flashes that begin at or after `from_s` and before `until_s`, past or future, in order of time. `until_s`
/// is from 0 to 3600 s later than `from_s`. Flashes that start farther from the position than `most_distance_m`, in [0,
/// 50000] m, measured horizontally, are left out. `*out_count` gets the number of flashes found. With capacity 0
/// nothing else is written, and the call succeeds. If `capacity` is too small, the call writes only the number and
/// fails. `flash_size` is sizeof(wk_flash) of your header. If the timeline no longer knows the weather of a time, the
/// call uses the earliest weather that the timeline knows.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_flashes(
    context: *const wk_context,
    position_m: *const [f64; 3],
    from_s: f64,
    until_s: f64,
    most_distance_m: f64,
    flashes: *mut wk_flash,
    capacity: u32,
    flash_size: u32,
    out_count: *mut u32,
) -> wk_status {
    guard("wk_context_get_flashes", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promise about `position_m`.
        let at = DVec3::from_array(unsafe { position("position_m", position_m)? });
        let count = out("out_count", out_count)?;
        let room = input::Room::new("flashes", "flash_size", flashes, capacity, flash_size)?;
        let found = object.read().flashes_near(at, (from_s, until_s), most_distance_m);
        let found = found.map_err(|e| e.renamed("position", "position_m"))?;
        // SAFETY: `count` was checked and is the caller's.
        unsafe { count.write(found.len() as u32) };
        if capacity > 0 {
            room.check_capacity("capacity", found.len())?;
            for (i, flash) in found.iter().enumerate() {
                // SAFETY: `i` is below the capacity that the caller promises.
                unsafe { room.write(i, &wk_flash::of(flash)) };
            }
        }
        Ok(Status::Ok)
    })
}

/// Gets the light of flashes at a place of the host's world, averaged from `time_s` - `exposure_s` to `time_s`.
/// `exposure_s` is in [0, 1] s; with 0 the call gets the light at `time_s` itself. Use the answer to light the host's
/// own scene, and pass the time since the host's last frame as `exposure_s`.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the parameter.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_flash_light(
    context: *const wk_context,
    position_m: *const [f64; 3],
    time_s: f64,
    exposure_s: f64,
    out_light: *mut wk_flash_light,
) -> wk_status {
    guard("wk_context_get_flash_light", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promises.
        let (at, place) =
            unsafe { (position("position_m", position_m)?, layout::out_struct(&"out_light", out_light)?) };
        let light = object.read().lightning_at(DVec3::from_array(at), time_s, exposure_s);
        let light = light.map_err(|e| e.renamed("position", "position_m"))?;
        place.set(&wk_flash_light {
            facing_lux: light.facing_lux,
            level_lux: light.level_lux,
            direction: light.direction.to_array(),
            ..wk_flash_light::INIT
        });
        Ok(Status::Ok)
    })
}
