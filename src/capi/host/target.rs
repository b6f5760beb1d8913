//! Code that all kinds of host share: reading a frame's target struct, and naming errors about an occluder map.

use std::ffi::c_void;

use crate::{
    capi::boundary::{layout, numbers::wk_struct_type},
    error::{Error, Result},
};

/// Reads a target struct and checks its chain; NULL gives the default, which has no images.
///
/// # Safety
/// `p` is NULL or points to a live tagged struct.
pub(super) unsafe fn target<T: layout::Layout>(p: *const c_void) -> Result<T> {
    // SAFETY: the caller's promise.
    let target = unsafe { layout::read_or_default(&"frame.target", p.cast::<T>())? };
    let next = layout::head_of(&target).next;
    let none: [wk_struct_type; 0] = [];
    // SAFETY: as above.
    unsafe { layout::check_chain(&"frame.target", next, &none)? };
    Ok(target)
}

/// Renames an occluder map's error to the header's field; `image` is the field with the depth image on this kind of
/// host.
pub(super) fn in_map(image: &'static str) -> impl Fn(Error) -> Error {
    move |e| e.map_field(|field| field.replacen("].depth", &format!("].{image}"), 1))
}
