//! Rain
//!
//! WK_STAGE_PARTICLES draws rain wherever the weather has it. The rate decides how many drops fall and how fast. Near
//! drops are drawn one by one, farther ones as streaks on cones around the camera. Both depend only on seed and time,
//! so all channels of a simulator draw the same rain and any time can be shown again. Only drops that follow a wind
//! varying in space depend on the frames drawn before. The wind carries the drops; the host's depth hides them; sky,
//! ground, sun and lamps light them. Drops splash on the surfaces that the picture shows within ten metres of the
//! camera.
//!
//! Give boxes that keep rain off: a roof, a bridge deck, a cab, a truck. A drop whose own path crossed a box is not
//! drawn, whatever the wind. The windward side of a box is therefore wet; its lee side and its inside are dry. Planes
//! cut a box to any convex shape (wk_shelter_shape): a gable roof, a cab with a slanted front.

use std::{ffi::c_void, ptr::null};

use glam::{DMat3, DVec3};

use super::boundary::{
    guard,
    input::{self, List},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, ViewObject, wk_context, wk_view},
};
use crate::{
    error::{Error, Result, Status},
    rain::{MAX_SHELTERS, Planes, RainModel, RainSettings, Shelter},
};

include!(concat!(env!("OUT_DIR"), "/init_rain.rs"));

/// Way in which a view draws rain. The rain that falls does not depend on it.
pub type wk_rain_model = u32;
/// Welkin chooses: single drops to 1.9 m and cones to 14.8 m. With a wk_budget, Welkin draws less rain where the
/// picture does not need more or the time does not allow more (WK_PART_RAIN). Near a wind that varies in space
/// (wk_context_set_wind_grid, wk_context_set_wind_field) the drops follow that wind, on devices with compute shaders.
pub const WK_RAIN_MODEL_AUTOMATIC: wk_rain_model = 0;
/// No drops: all rain is extinction in the air.
pub const WK_RAIN_MODEL_VEIL: wk_rain_model = 1;
/// Streaks on three nested cones around the camera, without splashes. This is the cheapest moving rain without compute
/// shaders (wk_caps.tier 0). Its cost depends only on the picture's size.
pub const WK_RAIN_MODEL_CONES: wk_rain_model = 2;
/// Single drops to 4 m, each at a place that seed and time give; cones beyond 4 m only where lamps light the rain.
pub const WK_RAIN_MODEL_DROPS: wk_rain_model = 3;
/// Drops to 4 m that follow a wind varying in space, step by step. Needs compute shaders (wk_caps.tier 1).
pub const WK_RAIN_MODEL_INTEGRATED: wk_rain_model = 4;

/// Value of wk_rain.shutter_s for the eye, which integrates light over about this time by day. Streaks are long and
/// faint.
pub const WK_RAIN_SHUTTER_EYE_S: f64 = 0.05;
/// Value of wk_rain.shutter_s for a video camera at 60 frames a second with its shutter open for a whole frame: the
/// default.
pub const WK_RAIN_SHUTTER_CAMERA_60_S: f64 = 0.016_666_666_666_666_666;
/// Value of wk_rain.shutter_s for a camera in good light. Streaks are short.
pub const WK_RAIN_SHUTTER_CAMERA_500_S: f64 = 0.002;
/// Value of wk_rain.contrast_gain for trainers: on an 8-bit display rain by day is then as visible as in a film.
pub const WK_RAIN_GAIN_TRAINER: f64 = 4.0;

/// Settings for drawing rain, hail and splashes in a view. The precipitation itself does not depend on them.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_rain {
    /// sizeof(wk_rain) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_RAIN.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Exposure time of a picture, s. Longer exposure makes streaks longer and fainter (WK_RAIN_SHUTTER_ constants).
    /// Range [1e-4, 0.1], default 1/60.
    pub shutter_s: f64,
    /// Largest number of drops to draw; if more fall, each drawn drop represents several. Range [1000, 8 000 000], or
    /// 0, the default: 400 000, and 100 000 on a software driver.
    pub most_drops: u32,
    /// A WK_RAIN_MODEL_ constant; 0, the default, lets Welkin choose.
    pub model: wk_rain_model,
    /// Contrast of rain relative to nature. Range [1, 16], or 0, the default: 1, as in nature. With a gain of g, one
    /// streak, stone or splash hides as much of the background as g of them one behind another would. This departs from
    /// physics, for displays on which rain by day cannot be seen otherwise (WK_RAIN_GAIN_TRAINER). Light, visibility,
    /// water and queries do not depend on the gain. Set the same value on all channels of a simulator.
    pub contrast_gain: f64,
}

impl wk_rain {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_RAIN,
        next: null(),
        shutter_s: 0.016_666_666_666_666_666,
        most_drops: 0,
        model: WK_RAIN_MODEL_AUTOMATIC,
        contrast_gain: 0.0,
    };
}

/// A box that keeps rain off, in the host's world.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_shelter {
    /// sizeof(wk_shelter) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SHELTER.
    pub struct_type: wk_struct_type,
    /// NULL (the default), or a wk_shelter_shape.
    pub next: *const c_void,
    /// Centre, m, within 1e12 m of the origin. Default 0, 0, 0.
    pub center_m: [f64; 3],
    /// Three axes, one after the other: unit vectors at right angles. Default: the world's axes.
    pub axes: [f64; 9],
    /// Half the size along each axis, m. Range [1e-3, 1e5], default 1, 1, 1.
    pub half_size_m: [f64; 3],
    /// Velocity, m/s; its length is at most 2000. Default 0, 0, 0. A box faster than 0.1 m/s keeps neither rain nor
    /// snow off the ground below it.
    pub velocity_m_s: [f64; 3],
}

impl wk_shelter {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SHELTER,
        next: null(),
        center_m: [0.0, 0.0, 0.0],
        axes: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        half_size_m: [1.0, 1.0, 1.0],
        velocity_m_s: [0.0, 0.0, 0.0],
    };
}

/// Planes that cut a wk_shelter to another convex shape. An extension: put it into wk_shelter.next. The part of the box
/// beyond any plane does not keep rain off. Describe a convex shape by the box around it and the planes of its faces.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_shelter_shape {
    /// sizeof(wk_shelter_shape) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_SHELTER_SHAPE.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Number of planes. Range [0, 16], default 0: the box stays whole.
    pub plane_count: u32,
    /// Must be 0.
    pub reserved0: u32,
    /// Four numbers for each plane: a unit normal in the box's axes that points out of the shape, and the plane's
    /// distance from the box's centre along this normal, m, within 1e6. The planes must leave some of the box. Default
    /// 0.
    pub planes: [f64; 64],
}

impl wk_shelter_shape {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_SHELTER_SHAPE,
        next: null(),
        plane_count: 0,
        reserved0: 0,
        planes: [
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, //
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, //
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, //
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, //
        ],
    };

    fn planes(&self) -> Result<Planes> {
        let planes = self.planes.as_chunks::<4>().0;
        if self.plane_count as usize > planes.len() {
            let accepted = format!("at most {}", planes.len());
            return Err(Error::range("wk_shelter_shape.plane_count", &accepted, self.plane_count));
        }
        Planes::new(&planes[..self.plane_count as usize])
    }
}

/// Sets how the view draws rain; NULL returns to the default. Unchanged after an error.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range; WK_ERROR_UNSUPPORTED for a model that the device
/// cannot draw, or for more drops than it can draw with the model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_set_rain(view: *mut wk_view, rain: *const wk_rain) -> wk_status {
    guard("wk_view_set_rain", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        let mut settings = RainSettings::default();
        if !rain.is_null() {
            // SAFETY: the caller's promise about `rain`.
            let c = unsafe { layout::read(&"rain", rain)? };
            // SAFETY: as above.
            unsafe { layout::check_chain(&"rain", c.next, &[])? };
            settings.shutter_s = c.shutter_s;
            settings.most_drops = (c.most_drops != 0).then_some(c.most_drops);
            settings.model = match c.model {
                WK_RAIN_MODEL_VEIL => RainModel::Veil,
                WK_RAIN_MODEL_CONES => RainModel::Cones,
                WK_RAIN_MODEL_DROPS => RainModel::Drops,
                WK_RAIN_MODEL_INTEGRATED => RainModel::Integrated,
                _ => RainModel::Automatic,
            };
            settings.contrast_gain = if c.contrast_gain == 0.0 { 1.0 } else { c.contrast_gain };
        }
        object.lock().set_rain(settings)?;
        Ok(Status::Ok)
    })
}

/// Sets the boxes that keep rain off, at most 32, and replaces those set before; count 0 removes all. Set moving boxes
/// again in every frame. Unchanged after an error.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the element, its field and range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_shelters(
    context: *mut wk_context,
    shelters: *const wk_shelter,
    count: u32,
    stride: u32,
) -> wk_status {
    guard("wk_context_set_shelters", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let mut list = [None; MAX_SHELTERS];
        let mut take = |i: usize, c: wk_shelter| {
            // SAFETY: the chain was checked.
            let shape = unsafe { layout::extension::<wk_shelter_shape>(c.next)? };
            let shelter = Shelter {
                center_m: DVec3::from_array(c.center_m),
                axes: DMat3::from_cols_array(&c.axes),
                half_size_m: DVec3::from_array(c.half_size_m),
                velocity_m_s: DVec3::from_array(c.velocity_m_s),
                planes: shape
                    .map_or(Ok(Planes::NONE), |s| s.planes().map_err(|e| e.within(&format!("shelters[{i}]"))))?,
            };
            let named = |e: Error| e.renamed("shelter", &format!("shelters[{i}]"));
            shelter.validate().map_err(named)?;
            list[i] = Some(shelter);
            Ok(())
        };
        // SAFETY: the caller's promise about `shelters`.
        unsafe {
            let list = List::parameters("shelters", count, stride, MAX_SHELTERS);
            input::each_with(&list, shelters, &[WK_STRUCT_TYPE_SHELTER_SHAPE], &mut take)?;
        }
        object.write().set_shelters(list.iter().flatten())?;
        Ok(Status::Ok)
    })
}
