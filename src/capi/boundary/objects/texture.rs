//! Texture of an own device and the handle for it.

use std::sync::{Arc, Mutex};

use crate::capi::boundary::{device_cell::DeviceCell, handles::HandleObject};

/// A 2-D texture of an own device. Child of a wk_device.
pub struct wk_texture {
    _opaque: [u8; 0],
}

/// A texture and the device it lives on.
pub(in crate::capi) struct TextureObject {
    pub(in crate::capi) cell: Arc<DeviceCell>,
    pub(in crate::capi) texture: wgpu::Texture,
    /// Format of the texture, a checked `wk_format`.
    pub(in crate::capi) format: u32,
    /// Lock that lets one read or write run at a time; each of them waits for the GPU.
    pub(in crate::capi) transfer: Mutex<()>,
}

impl HandleObject for TextureObject {
    type C = wk_texture;
    const KIND: u8 = 5;
    const NAME: &'static str = "wk_texture";
    fn device(&self) -> Option<&Arc<DeviceCell>> {
        Some(&self.cell)
    }
}
