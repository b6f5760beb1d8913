//! Queries: the sky's light by direction
//!
//! These functions serve sensors, reflections and lighting that the host computes itself. They give the radiance of the
//! sky in a direction, as a picture shows it in pixels that the host did not draw. The radiance includes the clear air,
//! clouds as the context's cloud model draws them (wk_context_set_cloud_model), fog with precipitation, the glow of the
//! night sky, and below the horizon the planet's own ground. It excludes the discs of sun and moon
//! (wk_context_get_light has their light), stars and planets, rain areas, and everything that the host drew.
//!
//! The double-precision reference of the sky computes the answers on the calling thread, without work of the GPU. The
//! first query in a new state of the air solves the reference, which takes a second or two. Other threads that ask for
//! radiances wait meanwhile. While the weather changes, the air has a new state at every time. The solutions of the
//! last four states are kept for all contexts of a device. docs/reflections.md has the cost for each direction and the
//! difference from pictures.

use glam::DVec3;

use super::{
    boundary::{
        guard,
        input::{self, ListParameters, MAX_BATCH, position},
        numbers::*,
        objects::{ContextObject, wk_context},
    },
    query::{QueryPoint, time_or_now},
};
use crate::error::{Error, Status};

/// The sky's light from one direction. Element of an array, without struct_size; calls take its sizeof instead.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_sky_radiance {
    /// Radiance, cd/m^2, three channels of linear Rec. 709, never negative.
    pub radiance_cd_m2: [f64; 3],
}

/// Gets the sky's radiance at a place in several directions now, at most wk_caps.max_batch of them. A direction is a
/// vector (east, north, up) at the place, of length 1 within 0.001. `direction_size` and `radiance_size` are the
/// distances from one element to the next, bytes: 24 or more for directions, sizeof(wk_sky_radiance) of your header for
/// radiances.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the position or the first wrong direction; nothing is written then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_sky_radiance(
    context: *const wk_context,
    position_m: *const [f64; 3],
    directions: *const [f64; 3],
    count: u32,
    direction_size: u32,
    radiances: *mut wk_sky_radiance,
    radiance_size: u32,
) -> wk_status {
    let point = QueryPoint { context, position_m, time_s: None };
    let list = ListParameters { first: directions, count, size: direction_size };
    // SAFETY: the caller's promises are the same.
    unsafe { radiance("wk_context_get_sky_radiance", point, list, (radiances, radiance_size)) }
}

/// Gets the sky's radiance as wk_context_get_sky_radiance does, at a simulation time.
/// Thread: concurrent.
/// Errors: as wk_context_get_sky_radiance and wk_context_get_conditions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_sky_radiance_at(
    context: *const wk_context,
    position_m: *const [f64; 3],
    directions: *const [f64; 3],
    count: u32,
    direction_size: u32,
    time_s: f64,
    radiances: *mut wk_sky_radiance,
    radiance_size: u32,
) -> wk_status {
    let point = QueryPoint { context, position_m, time_s: Some(time_s) };
    let list = ListParameters { first: directions, count, size: direction_size };
    // SAFETY: the caller's promises are the same.
    unsafe { radiance("wk_context_get_sky_radiance_at", point, list, (radiances, radiance_size)) }
}

/// Checks the inputs of a query of radiances, and writes its answers.
///
/// # Safety
/// The position is NULL or three numbers. Each list is NULL or as long as its count says.
unsafe fn radiance(
    function: &'static str,
    point: QueryPoint,
    list: ListParameters<[f64; 3]>,
    (radiances, radiance_size): (*mut wk_sky_radiance, u32),
) -> wk_status {
    guard(function, |call| {
        let object = call.get::<ContextObject>("context", point.context)?;
        let ListParameters { first, count, size } = list;
        let list = input::Places::new("directions", "direction_size", first, count, size, MAX_BATCH)?;
        let room = input::Room::new("radiances", "radiance_size", radiances, count, radiance_size)?;
        // SAFETY: the caller's promise.
        let at = unsafe { position("position_m", point.position_m)? };
        // SAFETY: every index is below the count that the caller promises.
        let toward: Vec<DVec3> = (0..count as usize).map(|i| DVec3::from_array(unsafe { *list.at(i) })).collect();
        let context = object.read();
        let time_s = time_or_now(&context, point.time_s)?;
        let named = |e: Error| e.renamed("position", "position_m");
        let answers = context.sky_radiance(DVec3::from_array(at), &toward, time_s).map_err(named)?;
        for (i, radiance) in answers.iter().enumerate() {
            // SAFETY: as above.
            unsafe { room.write(i, &wk_sky_radiance { radiance_cd_m2: *radiance }) };
        }
        Ok(Status::Ok)
    })
}
