//! Occluder map as a C host describes it.

use std::{ffi::c_void, ptr::null};

use glam::{DMat4, DVec3};

use super::{
    boundary::{layout::struct_size, numbers::*, objects::wk_texture},
    frame::{WK_CLIP_MINUS_ONE_TO_ONE, WK_CLIP_ZERO_TO_ONE, wk_clip_space},
    opengl_structs::wk_opengl_image,
    vulkan_structs::wk_vulkan_image,
};
use crate::{rain::Taken, scene::ClipSpace};

/// Flags of a map.
pub type wk_occluder_map_flags = u32;
/// The map's depth is reversed: 1 is near, 0 is far.
pub const WK_OCCLUDER_MAP_DEPTH_REVERSED: wk_occluder_map_flags = 1;
/// The first row of the image lies at clip y = -1. In OpenGL this is always so, and the flag need not be set.
pub const WK_OCCLUDER_MAP_FIRST_ROW_AT_MINUS_Y: wk_occluder_map_flags = 2;

/// A depth image of objects that keep rain off: one sample in each texel, and 8 to 4096 texels along each side.
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
    /// Flags of the map. Default 0.
    pub flags: wk_occluder_map_flags,
    /// Range of clip-space z. Default WK_CLIP_ZERO_TO_ONE.
    pub clip_space: wk_clip_space,
    /// Simulation time at which the objects stood as the map shows them, s. Default 0.
    pub time_s: f64,
    /// Velocity of the objects in the map, m/s; its length is at most 2000. With it, the map of a moving truck need not
    /// be rendered in every frame. Default 0, 0, 0.
    pub velocity_m_s: [f64; 3],
    /// The image on one of Welkin's own devices. Default NULL.
    pub texture: *const wk_texture,
    /// The image of a Vulkan host. Default NULL.
    pub vulkan: *const wk_vulkan_image,
    /// The image of an OpenGL host: a depth texture or renderbuffer. Default none.
    pub opengl: wk_opengl_image,
    /// Width of an OpenGL host's image, texels; must equal the image's own. Default 0.
    pub width: u32,
    /// Height of an OpenGL host's image, texels; must equal the image's own. Default 0.
    pub height: u32,
    /// For an OpenGL host's image: increase this number when you create an object again under an old name. Default 0.
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

    /// Returns the map's camera, and its objects' time and velocity, as the Rust API's struct. `bottom_left` says that
    /// the first row always lies at clip y = -1, as in OpenGL.
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
