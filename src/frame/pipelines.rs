//! What the views of a device share: the pipelines of the composition and of windscreens.

use std::sync::{Arc, Mutex, MutexGuard};

use super::composite::Composite;
use crate::{
    error::{Error, Result, Status},
    glass::GlassKit,
    gpu::Device,
};

/// Pipelines of one device. Any thread.
pub(super) struct Pipelines {
    composite: Mutex<Composite>,
    glass: Mutex<Option<GlassKit>>,
}

impl Pipelines {
    /// Makes what every view needs.
    ///
    /// # Errors
    /// A GPU fault.
    pub fn new(device: &Device) -> Result<Self> {
        let made = Self { composite: Mutex::new(Composite::new(device)), glass: Mutex::new(None) };
        device.check_made()?;
        Ok(made)
    }

    pub(super) fn composite(&self) -> Result<MutexGuard<'_, Composite>> {
        self.composite.lock().map_err(|_| Error::new(Status::Poisoned, "an earlier call panicked while composing"))
    }

    /// Calls `f` with what windscreens are drawn with, made at its first use.
    pub(super) fn with_glass<T>(&self, device: &Arc<Device>, f: impl FnOnce(&mut GlassKit) -> Result<T>) -> Result<T> {
        let mut kit = self
            .glass
            .lock()
            .map_err(|_| Error::new(Status::Poisoned, "an earlier call panicked over a windscreen"))?;
        if kit.is_none() {
            *kit = Some(GlassKit::new(device)?);
        }
        kit.as_mut().map_or_else(|| Err(Error::new(Status::Internal, "no windscreen kit")), f)
    }
}
