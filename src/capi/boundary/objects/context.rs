//! Context and the handle for it.

use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

use crate::{
    capi::boundary::{device_cell::DeviceCell, handles::HandleObject},
    context::Context,
};

/// Weather, time and place. Child of a wk_device, parent of views.
pub struct wk_context {
    _opaque: [u8; 0],
}

/// A context and its lock: changes of the context are exclusive, reads may run at the same time.
pub(in crate::capi) struct ContextObject {
    pub(in crate::capi) cell: Arc<DeviceCell>,
    context: RwLock<Context>,
}

impl ContextObject {
    /// Creates the object of a new context of a device.
    pub(in crate::capi) fn new(cell: Arc<DeviceCell>, context: Context) -> Self {
        Self { cell, context: RwLock::new(context) }
    }

    pub(in crate::capi) fn read(&self) -> RwLockReadGuard<'_, Context> {
        // A panic while this lock was held has poisoned the device already, and the device refuses later calls. The
        // lock's own poisoning says nothing more, so it is ignored.
        self.context.read().unwrap_or_else(PoisonError::into_inner)
    }

    pub(in crate::capi) fn write(&self) -> RwLockWriteGuard<'_, Context> {
        self.context.write().unwrap_or_else(PoisonError::into_inner)
    }
}

impl HandleObject for ContextObject {
    type C = wk_context;
    const KIND: u8 = 2;
    const NAME: &'static str = "wk_context";
    fn device(&self) -> Option<&Arc<DeviceCell>> {
        Some(&self.cell)
    }
}
