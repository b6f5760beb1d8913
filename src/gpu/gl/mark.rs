//! Recognition of OpenGL contexts by OpenGL's own means, because no portable call tells one context from another.
//!
//! Vertex arrays are never shared between contexts, but their names repeat. So each context that Welkin must recognise
//! gets a vertex array whose attribute 15 points to a number that no other mark in this process has.

use std::{
    ffi::c_void,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
};

use super::{api::Api, names::*};

const ATTRIBUTE: u32 = 15;

/// Number for the next mark to be created.
static NEXT: AtomicUsize = AtomicUsize::new(0x5745_4C4B);
/// Vertex array and number of each live mark: one that [`Mark::set`] made for a device that still exists.
static LIVE: Mutex<Vec<(u32, usize)>> = Mutex::new(Vec::new());

/// Mark in one context.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    array: u32,
    buffer: u32,
    number: usize,
}

impl Mark {
    /// Whether the current context has a live mark of this process, and so a device already.
    pub(super) fn any_here(api: &Api) -> bool {
        let live = LIVE.lock().unwrap_or_else(PoisonError::into_inner).clone();
        live.iter().any(|&(array, number)| reads(api, array) == Some(number))
    }

    /// Marks the current context as the context of a device.
    pub(super) fn set(api: &Api) -> Self {
        let mark = Self::leave(api);
        LIVE.lock().unwrap_or_else(PoisonError::into_inner).push((mark.array, mark.number));
        mark
    }

    /// Marks the current context, so that it can be recognised. The mark is not added to the list of live marks.
    pub(super) fn leave(api: &Api) -> Self {
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let (array_was, buffer_was) = (api.uint(VERTEX_ARRAY_BINDING), api.uint(ARRAY_BUFFER_BINDING));
        let array = api.one(Api::GenVertexArrays);
        let buffer = api.one(Api::GenBuffers);
        api.BindVertexArray(array);
        api.BindBuffer(ARRAY_BUFFER, buffer);
        // SAFETY: NULL data allocates without reading; with a buffer bound the pointer is an offset, and the attribute
        // is never enabled.
        unsafe {
            api.BufferData(ARRAY_BUFFER, 4, std::ptr::null(), STATIC_DRAW);
            api.VertexAttribPointer(ATTRIBUTE, 1, BYTE, 0, 0, number as *const c_void);
        }
        api.BindVertexArray(array_was);
        api.BindBuffer(ARRAY_BUFFER, buffer_was);
        Self { array, buffer, number }
    }

    /// Whether the current context is the marked one.
    pub(super) fn is_here(&self, api: &Api) -> bool {
        reads(api, self.array) == Some(self.number)
    }

    /// Removes the mark from the current context.
    pub(super) fn remove(&self, api: &Api) {
        api.delete(Api::DeleteVertexArrays, self.array);
        api.delete(Api::DeleteBuffers, self.buffer);
        self.forget();
    }

    /// Deletes the mark's buffer, which can be reached from another context of the share group. The vertex array is
    /// deleted with its context.
    pub(super) fn remove_shared(&self, api: &Api) {
        api.delete(Api::DeleteBuffers, self.buffer);
    }

    /// Removes the mark from the list of live marks only. Makes no OpenGL call, because the context may no longer
    /// exist.
    pub(super) fn forget(&self) {
        LIVE.lock().unwrap_or_else(PoisonError::into_inner).retain(|&(_, number)| number != self.number);
    }
}

/// Returns the number stored in vertex array `array` of the current context, if there is such an array.
fn reads(api: &Api, array: u32) -> Option<usize> {
    if api.IsVertexArray(array) == 0 {
        return None;
    }
    let was = api.uint(VERTEX_ARRAY_BINDING);
    let mut pointer = std::ptr::null();
    api.BindVertexArray(array);
    // SAFETY: one pointer is written.
    unsafe { api.GetVertexAttribPointerv(ATTRIBUTE, VERTEX_ATTRIB_ARRAY_POINTER, &mut pointer) };
    api.BindVertexArray(was);
    Some(pointer as usize)
}
