//! Clouds
//!
//! Cloud layers come with the weather: from wk_cloud_layer, a report or a preset. wk_context_set_cloud_model sets how
//! views draw them. Conditions, precipitation and the mean light are the same for both models, deck and volume.
//! docs/clouds.md has costs and errors.
//!
//! Clouds drawn as a volume cast shadows. The host lights its picture by the mean light (wk_context_get_light). The
//! stage SURFACE then finds the place of each pixel from the host's depth, and multiplies the pixel by the ratio of the
//! light there to the mean light. A host that lights an object separately, such as a cab's interior, can query the
//! share at the object's place (wk_context_get_sun_share).

use std::{ffi::c_void, ptr::null};

use glam::DVec3;

use super::boundary::{
    guard,
    input::{self, out, position},
    layout::{self, init_struct, struct_size},
    numbers::*,
    objects::{ContextObject, ViewObject, wk_context, wk_view},
};
use crate::{
    clouds::{CloudModel, CloudSettings},
    error::Status,
};

include!(concat!(env!("OUT_DIR"), "/init_clouds.rs"));

/// Way to draw clouds.
pub type wk_cloud_model = u32;
/// A grey deck where more than half of the sky is covered; broken clouds only dim the light. It costs no more than a
/// clear sky.
pub const WK_CLOUD_MODEL_DECK: wk_cloud_model = 0;
/// Volumes that the camera can fly through, lit by the sun or moon, the sky and the ground. A closed layer seen from
/// below is drawn as a deck. Each frame computes one of every sixteen pixels (by default: see wk_clouds.square_side);
/// wk_frame.frame_id selects which, so increase it by one in every frame.
pub const WK_CLOUD_MODEL_VOLUME: wk_cloud_model = 1;

/// Sets how views draw clouds. Default WK_CLOUD_MODEL_VOLUME; a budget may draw the deck in place of the volume
/// (WK_PART_CLOUDS). The model is part of the saved state.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT for an unknown model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_cloud_model(
    context: *mut wk_context,
    cloud_model: wk_cloud_model,
) -> wk_status {
    guard("wk_context_set_cloud_model", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        input::check_enum("cloud_model", &layout::WK_CLOUD_MODEL, cloud_model)?;
        let model = if cloud_model == WK_CLOUD_MODEL_VOLUME { CloudModel::Volume } else { CloudModel::Deck };
        object.write().set_cloud_model(model);
        Ok(Status::Ok)
    })
}

/// Gets the share of the direct light of the sun or the moon, whichever is brighter, that clouds let through to a
/// place, in [0, 1]: low in the shadow of a cloud, high between two. With this share s, the direct sunlight at exactly
/// this place is sun_lux * s / direct_share (wk_ground_light, wk_celestial). With WK_CLOUD_MODEL_DECK the share is the
/// mean, wk_celestial.direct_share. The first call builds the noise field from which clouds are cut, which takes some
/// tenths of a second.
/// Thread: concurrent.
/// Errors: as wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_sun_share(
    context: *const wk_context,
    position_m: *const [f64; 3],
    time_s: f64,
    out_share: *mut f64,
) -> wk_status {
    guard("wk_context_get_sun_share", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller promises a readable position, or NULL.
        let at = unsafe { position("position_m", position_m)? };
        let to = out("out_share", out_share)?;
        let share =
            object.read().sun_share(DVec3::from_array(at), time_s).map_err(|e| e.renamed("position", "position_m"))?;
        // SAFETY: `out` found it to be neither NULL nor misaligned; the caller promises that it can be written.
        unsafe { to.write(share) };
        Ok(Status::Ok)
    })
}

/// Flags of a wk_clouds.
pub type wk_clouds_flags = u32;
/// Shafts of light: the air under broken clouds is brighter where the sun shines through and darker in the clouds'
/// shadows. Drawn with WK_STAGE_SURFACE, up to 10 km away, where the host gives depth and does not read the shadow map
/// itself (wk_view_get_cloud_shadows). The flag costs 24 texture look-ups a pixel. Without this flag the air has its
/// mean brightness everywhere.
pub const WK_CLOUDS_SHAFTS: wk_clouds_flags = 1;

/// Quality of clouds that a view draws as a volume.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_clouds {
    /// sizeof(wk_clouds) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_CLOUDS.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Relative number of steps along each ray: twice the value means twice as many steps. Range [0.125, 32], default
    /// 2.
    pub fineness: f64,
    /// Side of a square block of pixels: each frame computes one pixel of a block and takes the others from earlier
    /// frames. 1, 2 or 4, default 4. Frames with WK_FRAME_NO_HISTORY compute all.
    pub square_side: u32,
    /// WK_CLOUDS_* flags. Default 0.
    pub flags: wk_clouds_flags,
}

impl wk_clouds {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_CLOUDS,
        next: null(),
        fineness: 2.0,
        square_side: 4,
        flags: 0,
    };
}

/// Sets the quality of the clouds in a view; NULL returns to the default. A failed call changes nothing.
/// docs/lab/README.md has the cost and error of some choices.
/// Thread: exclusive on the view.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field and its range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_view_set_clouds(view: *mut wk_view, clouds: *const wk_clouds) -> wk_status {
    guard("wk_view_set_clouds", |call| {
        let object = call.get::<ViewObject>("view", view)?;
        let mut settings = CloudSettings::default();
        if !clouds.is_null() {
            // SAFETY: the caller's promise about `clouds`.
            let c = unsafe { layout::read(&"clouds", clouds)? };
            // SAFETY: as above.
            unsafe { layout::check_chain(&"clouds", c.next, &[])? };
            let shafts = c.flags & WK_CLOUDS_SHAFTS != 0;
            settings = CloudSettings { fineness: c.fineness, square_side: c.square_side, shafts };
        }
        object.lock().set_clouds(settings)?;
        Ok(Status::Ok)
    })
}
