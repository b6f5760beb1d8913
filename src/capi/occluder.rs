//! Maps of what keeps rain off
//!
//! For everything that boxes cannot describe, give up to four depth images of your world, of standing or moving things,
//! from any direction. A drop is gone where its own slanted path crosses a surface that a map shows.
//!
//! A map knows nothing of what its surfaces hide. Draw it along wk_rainfall.fall_velocity_m_s: then it hides nothing
//! that matters for half of the rain, and little for the rest. Where things stand below others (a pier below a deck),
//! add maps along slower drops: the same wind with fall speeds of 3.4 and 2.1 m/s. What a map shows is exact to two
//! texels.
//!
//! Welkin copies a map during the call. Work that you submitted to the queue before (or, with OpenGL, issued) is
//! included. Afterwards the image is yours again.

use std::{ffi::c_void, ptr::null};

use glam::{DMat4, DVec3};

use super::{
    boundary::guard,
    context::{ContextObject, wk_context},
    frame::{WK_CLIP_MINUS_ONE_TO_ONE, WK_CLIP_ZERO_TO_ONE, wk_clip_space},
    host,
    input::{self, List},
    layout::{init_struct, struct_size},
    opengl::wk_opengl_image,
    status::*,
    texture::wk_texture,
    vulkan::wk_vulkan_image,
};
use crate::{
    error::Status,
    rain::{MAX_OCCLUDER_MAPS, Taken},
    scene::ClipSpace,
};

include!(concat!(env!("OUT_DIR"), "/init_occluder.rs"));

/// Flags of a map.
pub type wk_occluder_map_flags = u32;
/// Its depth is reversed: 1 is near, 0 is far.
pub const WK_OCCLUDER_MAP_DEPTH_REVERSED: wk_occluder_map_flags = 1;
/// The first row of the image lies at clip y = -1: always so in OpenGL (there it need not be set).
pub const WK_OCCLUDER_MAP_FIRST_ROW_AT_MINUS_Y: wk_occluder_map_flags = 2;

/// A depth image of things that keep rain off: one sample, from 8 to 4096 texels along either side.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_occluder_map {
    /// sizeof(wk_occluder_map) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_OCCLUDER_MAP.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Matrix from the host's world to clip space, invertible: parallel rays or perspective, column-major. Default
    /// identity.
    pub clip_from_world: [f64; 16],
    /// Default 0.
    pub flags: wk_occluder_map_flags,
    /// Default WK_CLIP_ZERO_TO_ONE.
    pub clip_space: wk_clip_space,
    /// Simulation time of what it shows, s. Default 0.
    pub time_s: f64,
    /// Velocity of what it shows, m/s, at most 2000 in all, so that a truck's own map need not be drawn in every frame.
    /// Default 0, 0, 0.
    pub velocity_m_s: [f64; 3],
    /// The image on an own device. Default NULL.
    pub texture: *const wk_texture,
    /// The image of a Vulkan host. Default NULL.
    pub vulkan: *const wk_vulkan_image,
    /// The image of an OpenGL host: a depth texture or renderbuffer. Default none.
    pub opengl: wk_opengl_image,
    /// Texels of an OpenGL host's image; must be its own. Default 0.
    pub width: u32,
    /// Texels of an OpenGL host's image; must be its own. Default 0.
    pub height: u32,
    /// For an OpenGL host's image: raise it when you make an object again under an old name. Default 0.
    pub generation: u64,
}

impl wk_occluder_map {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_OCCLUDER_MAP,
        next: null(),
        clip_from_world: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        flags: 0,
        clip_space: WK_CLIP_ZERO_TO_ONE,
        time_s: 0.0,
        velocity_m_s: [0.0, 0.0, 0.0],
        texture: null(),
        vulkan: null(),
        opengl: wk_opengl_image::INIT,
        width: 0,
        height: 0,
        generation: 0,
    };

    /// From where it was taken, as the Rust side says it.
    pub(super) fn taken(&self, bottom_left: bool) -> Taken {
        Taken {
            clip_from_world: DMat4::from_cols_array(&self.clip_from_world),
            reversed: self.flags & WK_OCCLUDER_MAP_DEPTH_REVERSED != 0,
            clip: match self.clip_space {
                WK_CLIP_MINUS_ONE_TO_ONE => ClipSpace::MinusOneToOne,
                _ => ClipSpace::ZeroToOne,
            },
            first_row_at_minus_y: bottom_left || self.flags & WK_OCCLUDER_MAP_FIRST_ROW_AT_MINUS_Y != 0,
            time_s: self.time_s,
            velocity_m_s: DVec3::from_array(self.velocity_m_s),
        }
    }
}

/// Sets the maps of things that keep rain off, in place of those before. count 0 removes them. At most 4. After an
/// error the maps before stay. They are not part of a saved state, because each channel may have its own.
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
