//! What the contexts and views of a device share: the composition's pipelines, the sky's pipelines and tables.

use std::sync::{Mutex, MutexGuard};

use super::composite::Composite;
use crate::{
    error::{Error, Result, Status},
    gpu::Device,
    sky::SkyLibrary,
};

/// Pipelines and tables of one device, made once and used by all its contexts and views. Any thread.
pub struct Shared {
    composite: Mutex<Composite>,
    pub(crate) sky: SkyLibrary,
}

impl Shared {
    /// Makes what every view needs.
    ///
    /// # Errors
    /// A GPU fault.
    pub fn new(device: &Device) -> Result<Self> {
        let shared = Self { composite: Mutex::new(Composite::new(device)), sky: SkyLibrary::default() };
        device.check()?;
        Ok(shared)
    }

    pub(super) fn composite(&self) -> Result<MutexGuard<'_, Composite>> {
        self.composite.lock().map_err(|_| Error::new(Status::Poisoned, "an earlier call panicked while composing"))
    }
}
