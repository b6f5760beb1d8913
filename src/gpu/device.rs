//! The device: one queue, its caps, its faults, and the way into a host's context.

use std::{
    collections::HashMap,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
};

use crate::error::{Error, Result, Status};

/// Capabilities of a device, which the host may query before it creates anything.
#[derive(Clone, Debug, PartialEq)]
pub struct Caps {
    /// Native graphics interface that serves it.
    pub backend: wgpu::Backend,
    /// The adapter's own name.
    pub adapter_name: String,
    /// The driver's own name and version.
    pub driver: String,
    /// 0 = no compute (GL 3.3 to 4.2, macOS GL), 1 = compute, with counts that stay on the GPU.
    pub tier: u32,
    /// A driver that computes on the CPU.
    pub software: bool,
    /// Largest edge of a 2-D texture, pixels.
    pub max_texture_size: u32,
}

/// Options for a device that Welkin creates.
#[derive(Clone, Debug)]
pub struct DeviceOptions {
    /// Native graphics interfaces that may serve; `noop` draws nothing and needs no GPU.
    pub backends: wgpu::Backends,
    /// Use no compute shaders even where there are any: how a GL 3.3 host would draw.
    pub force_tier0: bool,
    /// Take the software driver.
    pub force_software: bool,
}

impl Default for DeviceOptions {
    fn default() -> Self {
        let backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12 | wgpu::Backends::GL;
        Self { backends, force_tier0: false, force_software: false }
    }
}

/// A host's depth as it is attached.
#[derive(Clone, Debug, PartialEq)]
pub struct AttachedDepth {
    /// Texture to attach.
    pub texture: wgpu::Texture,
    /// Whether the depth that is read is a copy of it, which [`HostBinding::refresh_depth`] brings up to date.
    pub is_copied: bool,
}

/// Hooks that a host-owned device needs around every batch of GPU calls: making its context current, fences, state.
pub trait HostBinding: Send + Sync {
    /// Called before the first GPU call of a batch.
    ///
    /// # Errors
    /// Whatever keeps the host's context from being entered.
    fn enter(&self) -> Result<()>;
    /// Called after the last one; must not fail.
    fn leave(&self);
    /// The texture in which a host's `color` can be read, where wgpu cannot copy it itself; [`HostBinding::refresh`]
    /// fills it.
    fn reading(&self, _color: &wgpu::Texture) -> Option<wgpu::Texture> {
        None
    }
    /// Brings [`HostBinding::reading`] of `color` up to date with all that was submitted.
    ///
    /// # Errors
    /// A copy that the host's context refuses.
    fn refresh(&self, _color: &wgpu::Texture) -> Result<()> {
        Ok(())
    }
    /// Returns the texture to attach where a host's `depth`, as it is read, is to be written; `None` for that texture
    /// itself.
    fn attached_depth(&self, _depth: &wgpu::Texture) -> Option<AttachedDepth> {
        None
    }
    /// Brings a copy that `depth` is up to date with all that was submitted.
    ///
    /// # Errors
    /// As [`HostBinding::refresh`].
    fn refresh_depth(&self, _depth: &wgpu::Texture) -> Result<()> {
        Ok(())
    }
    /// The first error flag that OpenGL raised since the last question. Asked while entered.
    fn raised(&self) -> Option<Error> {
        None
    }
    /// Called once, entered, before the device's own objects go: whatever holds on to them must let go.
    fn closing(&self);
    /// Called once, still entered, when the device's own objects are gone.
    fn closed(&self);
    /// Called instead of both where the host's context is gone, and its objects with it.
    fn forsaken(&self);
}

/// The first thing to go with a device: enters the host's context for what goes after it. Without a context that
/// cannot be, and then nothing may be released: a driver need not survive a call without a context.
struct Entrance {
    binding: Arc<dyn HostBinding>,
    entered: Arc<AtomicBool>,
    kept: Option<(wgpu::Instance, wgpu::Adapter, wgpu::Device, wgpu::Queue)>,
}

impl Drop for Entrance {
    fn drop(&mut self) {
        let kept = self.kept.take();
        if self.binding.enter().is_ok() {
            self.entered.store(true, Ordering::Release);
            self.binding.closing();
        } else {
            self.binding.forsaken();
            std::mem::forget(kept); // a count that never falls to 0
        }
    }
}

/// The last thing to go with a device.
struct Exit {
    binding: Arc<dyn HostBinding>,
    entered: Arc<AtomicBool>,
}

impl Drop for Exit {
    fn drop(&mut self) {
        if self.entered.load(Ordering::Acquire) {
            self.binding.closed();
            self.binding.leave();
        }
    }
}

/// Proof that the host's context is current; leaves it when dropped.
#[must_use = "the host's context is left when this is dropped"]
pub struct Entered<'a>(Option<&'a dyn HostBinding>);

impl Drop for Entered<'_> {
    fn drop(&mut self) {
        if let Some(binding) = self.0 {
            binding.leave();
        }
    }
}

#[derive(Default)]
struct Faults {
    first: Mutex<Option<Error>>,
    lost: AtomicBool,
    /// The GPU does not finish: see [`Device::give_up`].
    hung: AtomicBool,
}

/// An assembled shader as the driver has it, and the names of its `override` constants.
#[derive(Clone)]
pub(crate) struct Shader {
    pub module: wgpu::ShaderModule,
    pub overrides: Arc<[String]>,
}

/// One native queue or GL context with what was found out about it. Shared by contexts and views.
pub struct Device {
    // Fields go in this order: see `Entrance`.
    _entrance: Option<Entrance>,
    /// Kept alive for surfaces and for the order of destruction.
    pub instance: wgpu::Instance,
    /// The physical device.
    pub adapter: wgpu::Adapter,
    /// The logical device.
    pub device: wgpu::Device,
    /// Its one queue.
    pub queue: wgpu::Queue,
    /// Shaders by name: reading one takes longer than making a pipeline of it.
    shaders: Mutex<HashMap<String, Shader>>,
    caps: Caps,
    faults: Arc<Faults>,
    submission: Mutex<()>,
    submissions: AtomicU64,
    /// Images of windows that are in hand, each from its acquisition until it is presented or given back.
    of_windows: Mutex<Vec<wgpu::Texture>>,
    binding: Option<Arc<dyn HostBinding>>,
    _exit: Option<Exit>,
}

impl Device {
    /// As [`Device::adopt`], from a driver that is trusted or is about to be asked.
    pub(super) fn around(
        instance: wgpu::Instance,
        adapter: wgpu::Adapter,
        device: wgpu::Device,
        queue: wgpu::Queue,
        force_tier0: bool,
        binding: Option<Arc<dyn HostBinding>>,
    ) -> Arc<Self> {
        let info = adapter.get_info();
        let limits = device.limits();
        let needed = wgpu::DownlevelFlags::COMPUTE_SHADERS | wgpu::DownlevelFlags::INDIRECT_EXECUTION;
        let compute = adapter.get_downlevel_capabilities().flags.contains(needed)
            && limits.max_compute_workgroup_size_x >= 128
            && limits.max_storage_buffers_per_shader_stage >= 3;
        let caps = Caps {
            backend: info.backend,
            adapter_name: info.name.clone(),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            tier: u32::from(compute && !force_tier0),
            software: info.device_type == wgpu::DeviceType::Cpu || info.name.contains("llvmpipe"),
            max_texture_size: limits.max_texture_dimension_2d,
        };
        let faults = Arc::new(Faults::default());
        watch(&device, &faults);
        let entered = Arc::new(AtomicBool::new(false));
        let kept = || (instance.clone(), adapter.clone(), device.clone(), queue.clone());
        let entrance =
            binding.clone().map(|binding| Entrance { binding, entered: entered.clone(), kept: Some(kept()) });
        let exit = binding.clone().map(|binding| Exit { binding, entered });
        let submission = Mutex::new(());
        let own = Self {
            _entrance: entrance,
            instance,
            adapter,
            device,
            queue,
            shaders: Mutex::default(),
            caps,
            faults,
            submission,
            submissions: AtomicU64::new(0),
            of_windows: Mutex::default(),
            binding,
            _exit: exit,
        };
        Arc::new(own)
    }

    /// Returns the capabilities of this device.
    pub fn caps(&self) -> &Caps {
        &self.caps
    }

    /// Draws as on a GPU from now on.
    #[cfg(test)]
    pub(crate) fn take_for_gpu(&mut self) {
        self.caps.software = false;
    }

    /// Makes the host's context current for as long as the answer lives; does nothing for own devices.
    ///
    /// # Errors
    /// Whatever keeps the host's context from being entered, and [`Status::DeviceLost`].
    pub fn enter(&self) -> Result<Entered<'_>> {
        if self.is_lost() {
            return Err(Error::new(Status::DeviceLost, "the device is lost: destroy it and create a new one"));
        }
        self.enter_to_release()
    }

    /// Enters as [`Device::enter`] does, also when the device is lost: what the device made in the host's context is
    /// still there and must be deleted in it.
    ///
    /// # Errors
    /// Whatever keeps the host's context from being entered.
    pub(crate) fn enter_to_release(&self) -> Result<Entered<'_>> {
        if let Some(binding) = &self.binding {
            binding.enter()?;
        }
        Ok(Entered(self.binding.as_deref()))
    }

    /// The texture in which a host's `color` can be read, where wgpu cannot copy it itself.
    pub(crate) fn reading(&self, color: &wgpu::Texture) -> Option<wgpu::Texture> {
        self.binding.as_ref().and_then(|b| b.reading(color))
    }

    /// Brings [`Device::reading`] of `color` up to date with all that was submitted.
    ///
    /// # Errors
    /// A copy that the host's context refuses.
    pub(crate) fn refresh(&self, color: &wgpu::Texture) -> Result<()> {
        self.binding.as_ref().map_or(Ok(()), |b| b.refresh(color))
    }

    /// Returns the texture to attach where a host's `depth` is to be written.
    pub(crate) fn attached_depth(&self, depth: &wgpu::Texture) -> AttachedDepth {
        let other = self.binding.as_ref().and_then(|b| b.attached_depth(depth));
        other.unwrap_or_else(|| AttachedDepth { texture: depth.clone(), is_copied: false })
    }

    /// Brings a copy that `depth` is up to date with all that was submitted.
    ///
    /// # Errors
    /// A copy that the host's context refuses.
    pub(crate) fn refresh_depth(&self, depth: &wgpu::Texture) -> Result<()> {
        self.binding.as_ref().map_or(Ok(()), |b| b.refresh_depth(depth))
    }

    /// Whether `texture` is a window's image that is in hand.
    pub(crate) fn is_of_window(&self, texture: &wgpu::Texture) -> bool {
        self.of_windows().contains(texture)
    }

    /// The windows' images that are in hand.
    pub(super) fn of_windows(&self) -> MutexGuard<'_, Vec<wgpu::Texture>> {
        self.of_windows.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the native device is gone.
    pub fn is_lost(&self) -> bool {
        self.faults.lost.load(Ordering::Acquire)
    }

    /// The first GPU fault since the last call, if any: wgpu reports them here instead of panicking.
    pub fn take_fault(&self) -> Option<Error> {
        self.faults.first.lock().map_or(None, |mut f| f.take())
    }

    /// Fails with the first GPU fault since the last check.
    ///
    /// # Errors
    /// The fault.
    pub fn check(&self) -> Result<()> {
        self.take_fault().map_or(Ok(()), Err)
    }

    /// As [`Device::check`], after images were made, while entered: OpenGL says only when asked that there is no memory
    /// for one.
    ///
    /// # Errors
    /// The fault.
    pub(crate) fn check_made(&self) -> Result<()> {
        self.check()?;
        match &self.binding {
            Some(binding) => binding.raised(),
            None => self.raised_in_own(),
        }
        .map_or(Ok(()), Err)
    }

    /// The error flag of an own device on OpenGL.
    #[cfg(not(any(target_os = "macos", target_os = "ios")))]
    fn raised_in_own(&self) -> Option<Error> {
        if self.caps.backend != wgpu::Backend::Gl || self.is_lost() {
            return None;
        }
        // SAFETY: the context is only asked for its error flag, under the lock that all of wgpu's calls take.
        let error = unsafe {
            let hal = self.device.as_hal::<wgpu::hal::gles::Api>()?;
            glow::HasContext::get_error(&*hal.context().lock())
        };
        super::gl::raised_in_welkin(error)
    }

    #[cfg(any(target_os = "macos", target_os = "ios"))]
    fn raised_in_own(&self) -> Option<Error> {
        None
    }

    /// Destroys the native device as a driver crash would; for tests of the lost path.
    pub fn simulate_loss(&self) {
        self.faults.lost.store(true, Ordering::Release);
        let _entered = self.enter_to_release();
        self.device.destroy();
    }

    /// Assembles shader file `name` and hands it to the driver.
    ///
    /// # Errors
    /// [`Status::Internal`] if an include is missing.
    pub fn shader(&self, name: &str) -> Result<wgpu::ShaderModule> {
        self.shader_and_overrides(name).map(|shader| shader.module)
    }

    /// As [`Self::shader`], with the names of its `override` constants.
    pub(crate) fn shader_and_overrides(&self, name: &str) -> Result<Shader> {
        let mut shaders = self.shaders.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = shaders.get(name) {
            return Ok(known.clone());
        }
        // Tests see a value that is not a number, which others draw as black or white.
        let text =
            if cfg!(debug_assertions) { super::shader::assemble_checked(name) } else { super::shader::assemble(name) }?;
        let overrides = super::shader::overrides(&text);
        let desc = wgpu::ShaderModuleDescriptor { label: Some(name), source: wgpu::ShaderSource::Wgsl(text.into()) };
        // By default wgpu counts the turns of each loop, to end those that never would. That takes a sixteenth of what
        // clouds cost on a GPU.
        let checks = wgpu::ShaderRuntimeChecks { force_loop_bounding: false, ..wgpu::ShaderRuntimeChecks::checked() };
        // SAFETY: all shaders are this crate's own, and each loop in them ends whatever its blocks hold
        // (tests/shaders/loops.rs); bounds are checked as ever.
        let module = unsafe { self.device.create_shader_module_trusted(desc, checks) };
        let made = Shader { module, overrides };
        shaders.insert(name.to_owned(), made.clone());
        Ok(made)
    }

    /// Submits. One thread at a time: what a Vulkan host stages for its own submission goes with no other.
    pub fn submit(&self, encoder: wgpu::CommandEncoder) {
        let commands = encoder.finish();
        let _turn = self.turn();
        self.submissions.fetch_add(1, Ordering::Relaxed);
        self.queue.submit([commands]);
    }

    /// How often work was submitted here so far.
    pub fn submissions(&self) -> u64 {
        self.submissions.load(Ordering::Relaxed)
    }

    /// The right to submit, until the answer is dropped.
    pub(crate) fn turn(&self) -> MutexGuard<'_, ()> {
        self.submission.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Turns uncaptured errors and loss into values that calls return: nothing panics or prints.
fn watch(device: &wgpu::Device, faults: &Arc<Faults>) {
    let sink = faults.clone();
    device.on_uncaptured_error(Arc::new(move |e: wgpu::Error| {
        let status = match &e {
            wgpu::Error::OutOfMemory { .. } => Status::OutOfMemory,
            _ => Status::Internal,
        };
        log::error!("GPU fault: {e}");
        if let Ok(mut first) = sink.first.lock() {
            first.get_or_insert_with(|| Error::new(status, format!("GPU fault: {e}")));
        }
    }));
    let sink = Arc::downgrade(faults);
    device.set_device_lost_callback(move |reason, text| {
        if let Some(sink) = sink.upgrade()
            && reason != wgpu::DeviceLostReason::Destroyed
        {
            log::error!("device lost: {text}");
            sink.lost.store(true, Ordering::Release);
        }
    });
}

mod waits;

#[cfg(test)]
mod tests;
