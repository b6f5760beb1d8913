//! Reading of a frame's target struct, and errors about an occluder map, the same for every kind of host.

use std::ffi::c_void;

use crate::{
    capi::boundary::{layout, numbers::wk_struct_type},
    error::{Error, Result},
};

/// Reads a target struct and checks its chain; NULL gives the default, which has no images.
///
/// # Safety
/// `p` is NULL or leads to a live tagged struct.
pub(super) unsafe fn target<T: layout::Layout>(p: *const c_void) -> Result<T> {
    // SAFETY: the caller's promise.
    let target = unsafe { layout::read_or_default(&"frame.target", p.cast::<T>())? };
    let next = layout::head_of(&target).next;
    let none: [wk_struct_type; 0] = [];
    // SAFETY: as above.
    unsafe { layout::check_chain(&"frame.target", next, &none)? };
    Ok(target)
}

/// An occluder map's error with the field's name in the header: `image` is the one that holds the depth on this host.
pub(super) fn in_map(image: &'static str) -> impl Fn(Error) -> Error {
    move |e| e.map_field(|field| field.replacen("].depth", &format!("].{image}"), 1))
}
