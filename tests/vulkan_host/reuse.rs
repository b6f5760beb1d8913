//! Memory for image handles that is used again, the last freed first: where a handle is an address, as Mesa's are, a
//! new image then certainly has the handle of a destroyed one, which otherwise depends on earlier allocations of the
//! process.

use std::{
    alloc::{Layout, alloc},
    collections::HashMap,
    ffi::c_void,
    sync::{LazyLock, Mutex},
};

use ash::vk;

#[derive(Default)]
struct Store {
    layouts: HashMap<usize, Layout>,
    free: Vec<usize>,
}

static STORE: LazyLock<Mutex<Store>> = LazyLock::new(Mutex::default);

/// Allocation callbacks for the images of one test; their memory is never returned to the system.
pub fn callbacks() -> vk::AllocationCallbacks<'static> {
    vk::AllocationCallbacks {
        pfn_allocation: Some(give),
        pfn_reallocation: Some(refuse),
        pfn_free: Some(take_back),
        ..Default::default()
    }
}

unsafe extern "system" fn give(_: *mut c_void, size: usize, align: usize, _: vk::SystemAllocationScope) -> *mut c_void {
    let Ok(layout) = Layout::from_size_align(size.max(1), align) else { return std::ptr::null_mut() };
    let mut store = STORE.lock().unwrap();
    if let Some(i) = store.free.iter().rposition(|a| store.layouts[a] == layout) {
        return store.free.remove(i) as *mut c_void;
    }
    // SAFETY: the size is not 0.
    let place = unsafe { alloc(layout) };
    store.layouts.insert(place as usize, layout);
    place.cast()
}

/// Refuses to reallocate, because images do not grow.
unsafe extern "system" fn refuse(
    _: *mut c_void,
    _: *mut c_void,
    _: usize,
    _: usize,
    _: vk::SystemAllocationScope,
) -> *mut c_void {
    std::ptr::null_mut()
}

unsafe extern "system" fn take_back(_: *mut c_void, place: *mut c_void) {
    if !place.is_null() {
        STORE.lock().unwrap().free.push(place as usize);
    }
}
