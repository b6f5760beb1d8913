//! What the views of a device share: the composition's pipelines and the tables of the sky.

use std::sync::{Mutex, MutexGuard};

use super::composite::Composite;
use crate::{
    error::{Error, Result, Status},
    gpu::Device,
};

/// Pipelines and tables of one device, made once and used by all its contexts and views. Any thread.
pub struct Shared {
    composite: Mutex<Composite>,
    sky: super::sky_link::SharedSky,
}

impl Shared {
    /// Makes what every view needs.
    ///
    /// # Errors
    /// A missing shader file or a GPU fault.
    pub fn new(device: &Device) -> Result<Self> {
        Ok(Self { composite: Mutex::new(Composite::new(device)), sky: super::sky_link::SharedSky::new(device)? })
    }

    pub(super) fn composite(&self) -> Result<MutexGuard<'_, Composite>> {
        self.composite.lock().map_err(|_| Error::new(Status::Poisoned, "an earlier call panicked while composing"))
    }

    pub(super) fn sky_layouts(&self) -> [&wgpu::BindGroupLayout; 2] {
        self.sky.layouts()
    }

    pub(super) fn sky(&self) -> &super::sky_link::SharedSky {
        &self.sky
    }
}
