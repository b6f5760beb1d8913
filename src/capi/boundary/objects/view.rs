//! View and the handle for it.

use std::sync::{
    Arc, Mutex, MutexGuard, PoisonError,
    atomic::{AtomicBool, Ordering},
};

use super::context::ContextObject;
use crate::{
    capi::boundary::{device_cell::DeviceCell, handles::HandleObject},
    frame::View,
};

/// One camera or projector channel. Child of a wk_context.
pub struct wk_view {
    _opaque: [u8; 0],
}

/// A view, its context and the lock that makes its calls exclusive.
pub(in crate::capi) struct ViewObject {
    pub(in crate::capi) cell: Arc<DeviceCell>,
    pub(in crate::capi) context: Arc<ContextObject>,
    view: Mutex<View>,
    /// Whether the host samples the veil. Each frame then hands the veil over to the host.
    veil: AtomicBool,
    /// Whether the host samples the cube map of the surroundings.
    environment: AtomicBool,
    /// Whether the host samples the map of the clouds' shadows.
    cloud_shadows: AtomicBool,
}

impl ViewObject {
    /// Creates the object of a new view of a context. The host samples none of its textures yet.
    pub(in crate::capi) fn new(context: Arc<ContextObject>, view: View) -> Self {
        Self {
            cell: context.cell.clone(),
            context,
            view: Mutex::new(view),
            veil: AtomicBool::new(false),
            environment: AtomicBool::new(false),
            cloud_shadows: AtomicBool::new(false),
        }
    }

    /// Notes that the host samples the veil: later frames hand it over.
    pub(in crate::capi) fn uses_veil(&self) {
        self.veil.store(true, Ordering::Relaxed);
    }

    /// Whether the host samples the veil.
    pub(in crate::capi) fn has_veil(&self) -> bool {
        self.veil.load(Ordering::Relaxed)
    }

    /// Notes that the host samples the cube map: later frames hand it over.
    pub(in crate::capi) fn uses_environment(&self) {
        self.environment.store(true, Ordering::Relaxed);
    }

    /// Whether the host samples the cube map.
    pub(in crate::capi) fn has_environment(&self) -> bool {
        self.environment.load(Ordering::Relaxed)
    }

    /// Notes that the host samples the map of the clouds' shadows: later frames hand it over.
    pub(in crate::capi) fn uses_cloud_shadows(&self) {
        self.cloud_shadows.store(true, Ordering::Relaxed);
    }

    /// Whether the host samples the map of the clouds' shadows.
    pub(in crate::capi) fn has_cloud_shadows(&self) -> bool {
        self.cloud_shadows.load(Ordering::Relaxed)
    }

    pub(in crate::capi) fn lock(&self) -> MutexGuard<'_, View> {
        // A panic while this lock was held has poisoned the device already, and the device refuses later calls. The
        // lock's own poisoning says nothing more, so it is ignored.
        self.view.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl HandleObject for ViewObject {
    type C = wk_view;
    const KIND: u8 = 3;
    const NAME: &'static str = "wk_view";
    fn device(&self) -> Option<&Arc<DeviceCell>> {
        Some(&self.cell)
    }
}
