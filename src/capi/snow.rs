//! Snow
//!
//! WK_STAGE_PARTICLES draws falling snow wherever the weather has it. Rate, kind and temperature give the sizes and
//! speeds of the flakes; seed and time alone give their places, so all channels of a simulator draw the same flakes.
//! Only flakes near a wind that varies in space depend on the frames drawn before. The wind carries the flakes; the
//! host's depth hides them; none fall under shelters and occluder maps; sky, ground, sun and lamps light them. Farther
//! away than flakes reach (wk_snow.most_flakes), snow is extinction in the air.

use std::{ffi::c_void, ptr::null};

use super::boundary::{
    guard,
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ViewObject, wk_view},
};
use crate::{
    error::Status,
    snow::{SnowModel, SnowSettings},
};

include!(concat!(env!("OUT_DIR"), "/init_snow.rs"));

/// Way in which a view draws falling snow. The snow that falls does not depend on it.
pub type wk_snow_model = u32;
/// Flakes near the camera. With a wk_budget there are none where the picture does not need them or the time does not
/// allow them (WK_PART_SNOW).
pub const WK_SNOW_MODEL_AUTOMATIC: wk_snow_model = 0;
/// No flakes: all snow is extinction in the air.
pub const WK_SNOW_MODEL_VEIL: wk_snow_model = 1;
/// Flakes, whatever a budget says.
pub const WK_SNOW_MODEL_FLAKES: wk_snow_model = 2;

/// Settings for drawing falling snow in a view. The snow that falls does not depend on them.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_snow {
    /// sizeof(wk_snow) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SNOW.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Exposure time of a picture, s: flakes that move farther than their own size in this time become streaks. Range
    /// [1e-4, 0.1], default 1/250, at which flakes in a light wind show their shapes.
    pub shutter_s: f64,
    /// Largest number of flakes to draw. A larger number lets flakes reach farther from the camera, up to 16 m. If more
    /// flakes fall than may be drawn, each drawn flake represents several. Range [1000, 8 000 000], or 0, the default:
    /// 1 000 000, and 60 000 on a software driver.
    pub most_flakes: u32,
    /// A WK_SNOW_MODEL_ constant; 0, the default, lets Welkin choose.
    pub model: wk_snow_model,
}

impl wk_snow {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SNOW,
        next: null(),
        shutter_s: 0.004,
        most_flakes: 0,
        model: WK_SNOW_MODEL_AUTOMATIC,
    };
}

/// Sets how the view draws falling snow; NULL returns to the default. Unchanged after an error.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_set_snow(view: *mut wk_view, snow: *const wk_snow) -> wk_status {
    guard("wk_view_set_snow", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        let mut settings = SnowSettings::default();
        if !snow.is_null() {
            // SAFETY: the caller's promise about `snow`.
            let c = unsafe { layout::read(&"snow", snow)? };
            // SAFETY: as above.
            unsafe { layout::check_chain(&"snow", c.next, &[])? };
            settings.shutter_s = c.shutter_s;
            settings.most_flakes = (c.most_flakes != 0).then_some(c.most_flakes);
            settings.model = match c.model {
                WK_SNOW_MODEL_VEIL => SnowModel::Veil,
                WK_SNOW_MODEL_FLAKES => SnowModel::Flakes,
                _ => SnowModel::Automatic,
            };
        }
        object.lock().set_snow(settings)?;
        Ok(Status::Ok)
    })
}
