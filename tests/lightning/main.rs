//! Lightning: its schedule and queries, and how it is drawn.

mod drawn;
mod schedule;

use std::sync::{Arc, LazyLock};

use welkin::gpu::{Device, DeviceOptions};

/// One device for all tests.
fn device() -> Arc<Device> {
    static DEVICE: LazyLock<Arc<Device>> =
        LazyLock::new(|| Device::headless(&DeviceOptions::default()).expect("a software driver is installed"));
    DEVICE.clone()
}
