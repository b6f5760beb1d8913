//! What the boundary keeps beside a device: whether a panic happened in it, and objects whose release must wait until
//! the host's context is current again.

use std::{
    any::Any,
    sync::{
        Arc, Mutex, PoisonError, RwLock, RwLockReadGuard,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, ThreadId},
};

use super::host::Host;
use crate::{
    error::{Error, Result, Status},
    frame::Shared,
    gpu::{Device, Entered},
};

/// A device as the boundary sees it; every child of the device holds one.
pub(super) struct DeviceCell {
    gpu: Arc<Device>,
    host: RwLock<Host>,
    poisoned: AtomicBool,
    /// The thread on which the host's context is current, for devices that have one.
    home: Option<ThreadId>,
    retired: Mutex<Vec<Arc<dyn Any + Send + Sync>>>,
    /// What all contexts of the device share; made with the first of them.
    shared: Mutex<Option<Arc<Shared>>>,
}

impl DeviceCell {
    /// A device with its owner.
    pub(super) fn new(gpu: Arc<Device>, host: Host) -> Arc<Self> {
        let home = host.is_bound_to_thread().then(|| thread::current().id());
        let host = RwLock::new(host);
        Arc::new(Self {
            gpu,
            host,
            poisoned: AtomicBool::new(false),
            home,
            retired: Mutex::default(),
            shared: Mutex::default(),
        })
    }

    /// The device itself.
    pub(super) fn gpu(&self) -> &Arc<Device> {
        &self.gpu
    }

    /// Whose device it is.
    pub(super) fn host(&self) -> RwLockReadGuard<'_, Host> {
        self.host.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// Pipelines and tables that the device's contexts share.
    ///
    /// # Errors
    /// Whatever keeps them from being made.
    pub(super) fn shared(&self) -> Result<Arc<Shared>> {
        let mut shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(shared) = &*shared {
            return Ok(shared.clone());
        }
        let _entered = self.enter()?;
        let made = Arc::new(Shared::new(&self.gpu)?);
        *shared = Some(made.clone());
        Ok(made)
    }

    /// Every later call but destroy is refused.
    pub(super) fn poison(&self) {
        self.poisoned.store(true, Ordering::Release);
    }

    /// # Errors
    /// [`Status::Poisoned`] after a panic.
    pub(super) fn check_alive(&self) -> Result<()> {
        if self.poisoned.load(Ordering::Acquire) {
            let text = "an earlier call on this device ended in a fault inside Welkin; destroy it and its children";
            return Err(Error::new(Status::Poisoned, text));
        }
        Ok(())
    }

    /// # Errors
    /// [`Status::DeviceLost`].
    pub(super) fn check_not_lost(&self) -> Result<()> {
        if self.gpu.is_lost() {
            return Err(Error::new(Status::DeviceLost, "the device is lost: destroy it and create a new one"));
        }
        Ok(())
    }

    /// # Errors
    /// [`Status::WrongOrder`] on another thread than the one that a host's context is bound to.
    pub(super) fn check_home(&self) -> Result<()> {
        if self.home.is_none_or(|home| home == thread::current().id()) {
            return Ok(());
        }
        let text = "this device draws in the host's OpenGL context: call it on the thread that created it";
        Err(Error::new(Status::WrongOrder, text))
    }

    /// Releases what waited for the host's context.
    fn release_retired(&self) {
        let waiting = std::mem::take(&mut *self.retired.lock().unwrap_or_else(PoisonError::into_inner));
        let _entered = self.gpu.enter().ok();
        drop(waiting);
    }

    /// Releases everything that it holds, at the end of the device, and gives the owner back.
    pub(super) fn close(&self) -> Host {
        self.release_retired();
        let shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner).take();
        let _entered = self.gpu.enter().ok();
        drop(shared);
        std::mem::replace(&mut *self.host.write().unwrap_or_else(PoisonError::into_inner), Host::Own)
    }

    /// Releases what waited for the host's context, before a call that enters it by itself.
    pub(super) fn drain(&self) {
        if self.home.is_some() && !self.retired.lock().unwrap_or_else(PoisonError::into_inner).is_empty() {
            self.release_retired();
        }
    }

    /// Makes the host's context current for a batch of GPU calls, and releases what waited for that.
    ///
    /// # Errors
    /// As [`Device::enter`].
    pub(super) fn enter(&self) -> Result<Entered<'_>> {
        let entered = self.gpu.enter()?;
        drop(std::mem::take(&mut *self.retired.lock().unwrap_or_else(PoisonError::into_inner)));
        Ok(entered)
    }

    /// Releases an object now if this thread may, else at the next GPU call.
    pub(super) fn retire(&self, object: Arc<dyn Any + Send + Sync>) {
        let may = self.home.is_none_or(|home| home == thread::current().id());
        if may {
            // A lost device has no context to enter; wgpu releases its objects without one.
            let _entered = self.gpu.enter().ok();
            drop(object);
            return;
        }
        self.retired.lock().unwrap_or_else(PoisonError::into_inner).push(object);
    }
}
