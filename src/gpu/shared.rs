//! Objects that the contexts and views of a device share: pipelines and tables, each created once, at its first use.

use std::{
    any::Any,
    sync::{Arc, Mutex},
};

use super::device::Device;
use crate::error::{Error, Result, Status};

/// Pipelines and tables of one device, created once and used by all its contexts and views, on any thread.
pub struct Shared {
    kept: Mutex<Vec<Arc<dyn Any + Send + Sync>>>,
}

impl Shared {
    /// Creates an empty collection.
    ///
    /// # Errors
    /// A GPU fault that has not been reported yet.
    pub fn new(device: &Device) -> Result<Self> {
        device.check()?;
        Ok(Self { kept: Mutex::default() })
    }

    /// Returns the one object of type `T`; `make` creates it at the first call.
    ///
    /// # Errors
    /// The errors of `make`; the next call then tries again. [`Status::Poisoned`] after a panic in any call's `make`,
    /// whatever its type.
    pub(crate) fn get<T: Send + Sync + 'static>(&self, make: impl FnOnce() -> Result<T>) -> Result<Arc<T>> {
        let poisoned = || Error::new(Status::Poisoned, "an earlier call panicked while it made what views share");
        let mut kept = self.kept.lock().map_err(|_| poisoned())?;
        if let Some(found) = kept.iter().find_map(|k| k.clone().downcast::<T>().ok()) {
            return Ok(found);
        }
        let made = Arc::new(make()?);
        kept.push(made.clone());
        Ok(made)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::DeviceOptions;

    #[test]
    fn each_type_is_made_once_and_one_that_fails_is_tried_again() {
        let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
        let shared = Shared::new(&Device::headless(&options).unwrap()).unwrap();
        assert!(shared.get::<u32>(|| Err(Error::unsupported("not yet"))).is_err());
        let first = shared.get(|| Ok(7_u32)).unwrap();
        assert!(Arc::ptr_eq(&first, &shared.get(|| Ok(8_u32)).unwrap()) && *first == 7);
        assert_eq!(*shared.get(|| Ok("another type")).unwrap(), "another type");
    }
}
