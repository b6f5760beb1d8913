//! Telling one OpenGL context from another, with OpenGL's own means: there is no portable call for it.
//!
//! Vertex arrays are never shared between contexts, but their names repeat. So each adopted context gets one whose
//! attribute 15 points to a number that no other mark of this process has.

use std::{
    ffi::c_void,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
};

use super::{api::Api, names::*};

const ATTRIBUTE: u32 = 15;

static NEXT: AtomicUsize = AtomicUsize::new(0x5745_4C4B);
static LIVE: Mutex<Vec<(u32, usize)>> = Mutex::new(Vec::new());

/// A mark in one context.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    array: u32,
    buffer: u32,
    number: usize,
}

impl Mark {
    /// Whether a live mark of this process is in the current context: then the context has a device already.
    pub(super) fn any_here(api: &Api) -> bool {
        let live = LIVE.lock().unwrap_or_else(PoisonError::into_inner).clone();
        live.iter().any(|&(array, number)| reads(api, array) == Some(number))
    }

    /// Marks the current context as one that has a device.
    pub(super) fn set(api: &Api) -> Self {
        let mark = Self::leave(api);
        LIVE.lock().unwrap_or_else(PoisonError::into_inner).push((mark.array, mark.number));
        mark
    }

    /// Marks the current context, so that it is known again.
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

    /// Takes the mark off the current context.
    pub(super) fn remove(&self, api: &Api) {
        api.delete(Api::DeleteVertexArrays, self.array);
        api.delete(Api::DeleteBuffers, self.buffer);
        self.forget();
    }

    /// Takes off what a context of the same share group can reach: its vertex array goes with its context.
    pub(super) fn remove_shared(&self, api: &Api) {
        api.delete(Api::DeleteBuffers, self.buffer);
    }

    /// Strikes the mark off the list: its context is gone.
    pub(super) fn forget(&self) {
        LIVE.lock().unwrap_or_else(PoisonError::into_inner).retain(|&(_, number)| number != self.number);
    }
}

/// The number at vertex array `array` of the current context, if there is such an array.
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
