//! A context that answers queries without a GPU, and the tests' random numbers.

use std::sync::Arc;

use welkin::{
    context::{Context, ContextDesc},
    frame::Shared,
    gpu::{Device, DeviceOptions},
};

/// A device that draws nothing and what its contexts share.
pub struct Host {
    device: Arc<Device>,
    shared: Arc<Shared>,
}

impl Host {
    pub fn new() -> Self {
        let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..Default::default() };
        let device = Device::headless(&options).unwrap();
        let shared = Arc::new(Shared::new(&device).unwrap());
        Self { device, shared }
    }

    pub fn context(&self) -> Context {
        Context::new(self.device.clone(), self.shared.clone(), ContextDesc::default()).unwrap()
    }
}

/// Random numbers by SplitMix64 (Steele, Lea and Flood 2014), good enough for choosing cases.
pub struct Dice(pub u64);

impl Dice {
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
}
