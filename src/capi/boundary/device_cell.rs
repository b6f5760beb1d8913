//! State that the boundary keeps with a device: its owner, what its contexts share, whether a call on the device has
//! panicked, and the objects that can be released only once the host's context is current again.

use std::{
    any::Any,
    sync::{
        Arc, Mutex, PoisonError, RwLock, RwLockReadGuard,
        atomic::{AtomicBool, Ordering},
    },
};

use super::owner::Host;
use crate::{
    error::{Error, Result, Status},
    gpu::{Device, Entered, Shared},
};

/// Device with the state that the boundary keeps for it; every child of the device holds a reference.
pub(in crate::capi) struct DeviceCell {
    gpu: Arc<Device>,
    host: RwLock<Host>,
    poisoned: AtomicBool,
    retired: Mutex<Vec<Arc<dyn Any + Send + Sync>>>,
    /// Pipelines and tables that all contexts of the device share; built with the first context.
    shared: Mutex<Option<Arc<Shared>>>,
}

impl DeviceCell {
    /// Creates the cell of a device and its owner.
    pub(in crate::capi) fn new(gpu: Arc<Device>, host: Host) -> Arc<Self> {
        let host = RwLock::new(host);
        Arc::new(Self {
            gpu,
            host,
            poisoned: AtomicBool::new(false),
            retired: Mutex::default(),
            shared: Mutex::default(),
        })
    }

    /// Returns the device itself.
    pub(in crate::capi) fn gpu(&self) -> &Arc<Device> {
        &self.gpu
    }

    /// Returns the owner of the device.
    pub(in crate::capi) fn host(&self) -> RwLockReadGuard<'_, Host> {
        self.host.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the pipelines and tables that the device's contexts share.
    ///
    /// # Errors
    /// Any failure to build them.
    pub(in crate::capi) fn shared(&self) -> Result<Arc<Shared>> {
        let mut shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(shared) = &*shared {
            return Ok(shared.clone());
        }
        let _entered = self.enter()?;
        let made = Arc::new(Shared::new(&self.gpu)?);
        *shared = Some(made.clone());
        Ok(made)
    }

    /// Poisons the device: every later call on it is refused, except those that destroy.
    pub(in crate::capi) fn poison(&self) {
        self.poisoned.store(true, Ordering::Release);
    }

    /// Checks that no call on the device has panicked.
    ///
    /// # Errors
    /// [`Status::Poisoned`] after a panic.
    pub(in crate::capi) fn check_alive(&self) -> Result<()> {
        if self.poisoned.load(Ordering::Acquire) {
            let text = "an earlier call on this device ended in a fault inside Welkin; destroy it and its children";
            return Err(Error::new(Status::Poisoned, text));
        }
        Ok(())
    }

    /// Checks that the GPU device is not lost.
    ///
    /// # Errors
    /// [`Status::DeviceLost`].
    pub(in crate::capi) fn check_not_lost(&self) -> Result<()> {
        if self.gpu.is_lost() {
            return Err(Error::new(Status::DeviceLost, "the device is lost: destroy it and create a new one"));
        }
        Ok(())
    }

    /// Releases all objects of the cell when the device is destroyed, and returns the device's owner.
    pub(in crate::capi) fn close(&self) -> Host {
        let waiting = self.take_retired();
        let shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner).take();
        self.release((waiting, shared));
        std::mem::replace(&mut *self.host.write().unwrap_or_else(PoisonError::into_inner), Host::Own)
    }

    /// Drops GPU objects. If they need the host's context and it cannot be entered here (from another thread, or
    /// because it is gone), they are abandoned, because a driver may crash at a call without a context.
    fn release<T>(&self, objects: T) {
        match self.gpu.enter_to_release() {
            Ok(entered) => {
                drop(objects);
                drop(entered);
            }
            Err(_) if !self.host().needs_context() => drop(objects),
            Err(e) => {
                log::warn!("objects of a device are given up: {e}");
                std::mem::forget(objects);
            }
        }
    }

    fn take_retired(&self) -> Vec<Arc<dyn Any + Send + Sync>> {
        std::mem::take(&mut *self.retired.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Releases the objects that wait for the host's context, if the context can be entered now. Call this before code
    /// that enters the context by [`Device::enter`]. That function releases no waiting objects; [`DeviceCell::enter`]
    /// does.
    pub(in crate::capi) fn drain(&self) {
        let waits = !self.retired.lock().unwrap_or_else(PoisonError::into_inner).is_empty();
        if waits && let Ok(_entered) = self.gpu.enter_to_release() {
            drop(self.take_retired());
        }
    }

    /// Makes the host's context current for a batch of GPU calls, and releases the objects that waited for the context.
    ///
    /// # Errors
    /// As [`Device::enter`].
    pub(in crate::capi) fn enter(&self) -> Result<Entered<'_>> {
        let entered = self.gpu.enter()?;
        drop(self.take_retired());
        Ok(entered)
    }

    /// Releases an object now if it needs no host's context or that context can be entered from here, else at the next
    /// [`DeviceCell::enter`] or [`DeviceCell::drain`].
    pub(in crate::capi) fn retire(&self, object: Arc<dyn Any + Send + Sync>) {
        match self.gpu.enter_to_release() {
            Ok(entered) => {
                drop(object);
                drop(entered);
            }
            Err(_) if !self.host().needs_context() => drop(object),
            Err(_) => self.retired.lock().unwrap_or_else(PoisonError::into_inner).push(object),
        }
    }
}
