//! Surface of a window and the handle for it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::{
    capi::boundary::{device_cell::DeviceCell, handles::HandleObject},
    gpu::surface::Surface,
};

/// A window to present to. Child of a wk_device.
pub struct wk_surface {
    _opaque: [u8; 0],
}

/// A surface and the device that presents to it.
pub(in crate::capi) struct SurfaceObject {
    pub(in crate::capi) cell: Arc<DeviceCell>,
    surface: Mutex<Surface>,
}

impl SurfaceObject {
    /// Creates the object of a new surface of a device.
    pub(in crate::capi) fn new(cell: Arc<DeviceCell>, surface: Surface) -> Self {
        Self { cell, surface: Mutex::new(surface) }
    }

    pub(in crate::capi) fn lock(&self) -> MutexGuard<'_, Surface> {
        // A panic while this lock was held has poisoned the device already, and the device refuses later calls. The
        // lock's own poisoning says nothing more, so it is ignored.
        self.surface.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl HandleObject for SurfaceObject {
    type C = wk_surface;
    const KIND: u8 = 4;
    const NAME: &'static str = "wk_surface";
    fn device(&self) -> Option<&Arc<DeviceCell>> {
        Some(&self.cell)
    }
}
