//! What the contexts and views of a device share: the composition's pipelines, the sky's pipelines and tables.

use std::sync::{Arc, Mutex, MutexGuard};

use super::composite::Composite;
use crate::{
    error::{Error, Result, Status},
    glass::GlassKit,
    gpu::Device,
    sky::SkyLibrary,
};

/// Pipelines and tables of one device, made once and used by all its contexts and views. Any thread.
pub struct Shared {
    composite: Mutex<Composite>,
    glass: Mutex<Option<GlassKit>>,
    pub(crate) sky: SkyLibrary,
}

impl Shared {
    /// Makes what every view needs.
    ///
    /// # Errors
    /// A GPU fault.
    pub fn new(device: &Device) -> Result<Self> {
        let shared =
            Self { composite: Mutex::new(Composite::new(device)), glass: Mutex::new(None), sky: SkyLibrary::default() };
        device.check_made()?;
        Ok(shared)
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
