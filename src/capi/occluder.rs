//! Maps of objects that keep rain off
//!
//! For shelter that boxes cannot describe, pass at most four depth images of your world, with standing or moving
//! objects, seen from any direction. A drop is not drawn if its own slanted path crosses a surface in a map.
//!
//! A map does not show what is hidden behind its surfaces. Render it along wk_rainfall.fall_velocity_m_s, the path of
//! the median drop. Then the hidden parts do not matter for half of the rain, and matter little for the other half.
//! Where objects stand below others (a pier below a deck), add maps along the paths of slower drops, with the same wind
//! and fall speeds of 3.4 and 2.1 m/s. The edges of mapped surfaces are exact to two texels.
//!
//! Welkin copies a map during the call. The copy includes the results of work that you submitted to the queue (or, with
//! OpenGL, issued) before the call. Afterwards the image is yours again.

pub use super::occluder_map::*;
use super::{
    boundary::{
        guard,
        input::{self, List},
        layout::init_struct,
        numbers::*,
        objects::{ContextObject, wk_context},
    },
    host,
};
use crate::{error::Status, rain::MAX_OCCLUDER_MAPS};

include!(concat!(env!("OUT_DIR"), "/init_occluder.rs"));

/// Sets the maps of objects that keep rain off, at most 4, and replaces those set before; count 0 removes all. After an
/// error the previous maps stay. No map is part of a saved state, because each channel may have maps of its own.
/// Thread: exclusive.
/// Errors: WK_ERROR_INVALID_ARGUMENT and WK_ERROR_UNSUPPORTED naming the element, its field and what is accepted;
/// WK_ERROR_BAD_HANDLE; WK_ERROR_DEVICE_LOST.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_set_occluder_maps(
    context: *mut wk_context,
    maps: *const wk_occluder_map,
    count: u32,
    stride: u32,
) -> wk_status {
    guard("wk_context_set_occluder_maps", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        let mut list = [None; MAX_OCCLUDER_MAPS];
        let mut take = |i: usize, c: wk_occluder_map| {
            list[i] = Some(c);
            Ok(())
        };
        // SAFETY: the caller's promise about `maps`.
        unsafe {
            input::each(&List::parameters("maps", count, stride, MAX_OCCLUDER_MAPS), maps, &mut take)?;
        }
        object.cell.check_not_lost()?;
        object.cell.drain();
        // SAFETY: the caller's promise about the images.
        unsafe { host::set_occluder_maps(call, &object, list.iter().flatten())? };
        Ok(Status::Ok)
    })
}
