//! Device and the handle for it.

use std::{ffi::CString, sync::Arc};

use crate::capi::boundary::{device_cell::DeviceCell, handles::HandleObject};

/// A native queue or OpenGL context. Parent of wk_contexts, surfaces and textures.
pub struct wk_device {
    _opaque: [u8; 0],
}

/// A device with the texts that `wk_caps` points to.
pub(in crate::capi) struct DeviceObject {
    pub(in crate::capi) cell: Arc<DeviceCell>,
    pub(in crate::capi) adapter_name: CString,
    pub(in crate::capi) driver: CString,
}

impl HandleObject for DeviceObject {
    type C = wk_device;
    const KIND: u8 = 1;
    const NAME: &'static str = "wk_device";
    fn device(&self) -> Option<&Arc<DeviceCell>> {
        Some(&self.cell)
    }
}
