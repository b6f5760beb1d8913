//! Lightning: its schedule and queries, and how it is drawn.

#[path = "../support/depth_texture.rs"]
mod depth;
mod drawn;
mod schedule;
#[path = "../support/coarse_sky.rs"]
mod sky;
#[path = "../support/textures.rs"]
mod textures;

use std::sync::{Arc, LazyLock};

use welkin::gpu::{Device, DeviceOptions};

/// One device for all tests.
fn device() -> Arc<Device> {
    static DEVICE: LazyLock<Arc<Device>> =
        LazyLock::new(|| Device::headless(&DeviceOptions::default()).expect("a software driver is installed"));
    DEVICE.clone()
}
