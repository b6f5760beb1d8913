//! Lightning
//!
//! A thunderstorm (WK_PRECIPITATION_THUNDERSTORM, a report with TS) flashes three times a minute in each square of 20
//! km by 20 km. The host may set another rate, and the places of the storm cells. Every flash is a function of the
//! context's seed, the time, the rate and the storm cells: all channels see the same flashes, and any time can be shown
//! again. Views draw the lightning channels, the glow of clouds and air, and the light of flashes on rain and wet
//! ground. The host queries flashes to play thunder, and their light to light its own scene:
//!
//! ```c
//! wk_flash flashes[16];
//! uint32_t count = 0;
//! wk_context_get_flashes(context, ear, last_s, now_s, 20e3, flashes, 16, sizeof flashes[0], &count);
//! for (uint32_t i = 0; i < count; i++)
//!     play_thunder_at(flashes[i].time_s + flashes[i].thunder_delay_s, flashes[i].distance_m);
//! ```
//!
//! A frame has the light of flashes from the time of the view's previous frame to its own: no flash is missed or
//! doubled, whatever the frame rate.

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

/// Flags of the settings in a wk_lightning.
pub type wk_lightning_flags = u32;
/// flashes_per_minute: the host's rate replaces the weather's.
pub const WK_LIGHTNING_RATE: wk_lightning_flags = 1;

/// Flicker of flashes in a picture.
pub type wk_flicker = u32;
/// Flicker as in nature: many changes of luminance a second.
pub const WK_FLICKER_AS_IN_NATURE: wk_flicker = 0;
/// Limited flicker, for viewers whom flicker may harm: at most three changes of luminance a second. Each drawn flash
/// rises once and fades, and the next one comes a second later at the earliest. Queries of flashes and of their light
/// do not change.
pub const WK_FLICKER_LIMITED: wk_flicker = 1;

/// Place where a flash ends.
pub type wk_flash_kind = u32;
/// To the ground.
pub const WK_FLASH_KIND_TO_GROUND: wk_flash_kind = 0;
/// Within the cloud.
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
    /// Flags of the settings that are set. Default 0: the rate of the weather.
    pub flags: wk_lightning_flags,
    /// Flicker of the drawn flashes. Default WK_FLICKER_AS_IN_NATURE.
    pub flicker: wk_flicker,
    /// Flashes a minute in each square of 20 km by 20 km, whatever the weather; used with WK_LIGHTNING_RATE. Range [0,
    /// 60], default 0.
    pub flashes_per_minute: f64,
    /// Number of storm cells in `cells`, at most 16; they replace the weather's. Default 0.
    pub cell_count: u32,
    /// Number of tall objects in `masts`, at most 64. Default 0.
    pub mast_count: u32,
    /// Five numbers for each cell: its middle in the host's world, m (the height does not matter); the distance from it
    /// within which two of three flashes start, m, in [0, 1e5]; flashes a minute in [0, 60]. Copied. Default NULL.
    pub cells: *const f64,
    /// Three numbers for each mast: its tip in the host's world, m. Masts attract ground flashes; so do the tops of
    /// shelters. Copied. Default NULL.
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
    /// Simulation time of its first stroke, s, not before the present. Range [-1e10, 1e10], default 0.
    pub time_s: f64,
    /// Place where it strikes in the host's world, m; a flash within the cloud passes over it. A shelter in its path
    /// ends it. Default 0, 0, 0.
    pub position_m: [f64; 3],
    /// Largest peak current of its strokes, kA. Range [1, 500], or 0, the default: random.
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
    /// Simulation time of its first stroke, s.
    pub time_s: f64,
    /// Place where it ends.
    pub kind: wk_flash_kind,
    /// Number of strokes; for a flash within the cloud, number of steps of its light.
    pub strokes: u32,
    /// Largest peak current of its strokes, kA.
    pub peak_ka: f64,
    /// Position where it struck, or of the middle of its path in the cloud, in the host's world, m.
    pub position_m: [f64; 3],
    /// Distance to the nearest point of its channel, m.
    pub distance_m: f64,
    /// Unit vector towards position_m, (east, north, up) at the queried place.
    pub direction: [f64; 3],
    /// Time from the flash to the beginning of its thunder, s: distance_m / (331.3 + 0.606 t), with the air's
    /// temperature t in degrees Celsius.
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
    /// Illuminance on surfaces that face the sources, summed over all sources, lux per channel.
    pub facing_lux: [f64; 3],
    /// Illuminance on level ground, lux.
    pub level_lux: f64,
    /// Unit vector towards the middle of the light, (east, north, up) at the place; straight up where there is no
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
/// `p` is a `wk_lightning` whose lists are as long as they say.
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

/// Sets the rate and the places of flashes, and how views draw them; NULL returns to the default. Part of the saved
/// state. Unchanged after an error.
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

/// Triggers a flash, whatever the weather. The flash is part of the saved state until 120 s after it; there are at most
/// 64 such flashes at a time. Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range, or for too many flashes; WK_ERROR_WRONG_ORDER for
/// a time before the present.
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

/// Gets the flashes that begin between `from_s` and `until_s`, past or future, in order of time. The times are at most
/// 3600 s apart. Only flashes within the horizontal distance `most_distance_m`, in [0, 50000] m, of the position count.
/// `*out_count` gets their number in any case. If `capacity` is too small, nothing else is written and the call fails;
/// with capacity 0 it succeeds. `flash_size` is sizeof(wk_flash) of your header. For times whose weather the timeline
/// has dropped, the earliest weather that it still has applies.
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

/// Gets the light of flashes at a place of the host's world, averaged over the time `exposure_s`, in [0, 1] s, that
/// ends at `time_s`; with 0, at that instant. Use it to light the host's own scene, with the time since its last frame
/// as exposure.
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
