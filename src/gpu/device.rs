//! Device: one queue, its capabilities and faults, and the entrance to a host's context.

use std::{
    collections::HashMap,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
};

use super::counts::{DeviceWork, WorkTotals};
use crate::error::{Error, Result, Status};

/// Capabilities of a device, which the host may query before it creates anything.
#[derive(Clone, Debug, PartialEq)]
pub struct Caps {
    /// Native graphics API in use.
    pub backend: wgpu::Backend,
    /// Name that the adapter reports.
    pub adapter_name: String,
    /// Name and version that the driver reports.
    pub driver: String,
    /// Feature tier, 0 or 1. Tier 1 has compute and indirect draws, whose counts stay on the GPU, with workgroups of
    /// 128 threads and 3 storage buffers per stage. Tier 0 lacks one of these (GL 3.3 to 4.2, macOS GL), or was asked
    /// for by [`DeviceOptions::force_tier0`].
    pub tier: u32,
    /// Whether the driver computes on the CPU.
    pub software: bool,
    /// Largest edge of a 2-D texture, pixels.
    pub max_texture_size: u32,
}

/// Options for a device that Welkin creates.
#[derive(Clone, Debug)]
pub struct DeviceOptions {
    /// Native graphics APIs that may be used. Default Vulkan, Metal, Direct3D 12 and OpenGL. `NOOP` draws nothing and
    /// needs no GPU.
    pub backends: wgpu::Backends,
    /// Whether to use no compute shaders even if the driver has them, as on a GL 3.3 host. Default no.
    pub force_tier0: bool,
    /// Whether to use the software driver. Default no.
    pub force_software: bool,
}

impl Default for DeviceOptions {
    fn default() -> Self {
        let backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12 | wgpu::Backends::GL;
        Self { backends, force_tier0: false, force_software: false }
    }
}

/// Depth texture to attach for a host's depth.
#[derive(Clone, Debug, PartialEq)]
pub struct AttachedDepth {
    /// Texture to attach.
    pub texture: wgpu::Texture,
    /// Whether shaders read a copy of `texture`. [`HostBinding::refresh_depth`] updates this copy.
    pub is_copied: bool,
}

/// Hooks that a device in an OpenGL host's context needs around every batch of GPU calls: to make the context current,
/// to wait for fences, to save and restore state.
pub trait HostBinding: Send + Sync {
    /// Called before the first GPU call of a batch.
    ///
    /// # Errors
    /// Any reason for which the host's context cannot be entered.
    fn enter(&self) -> Result<()>;
    /// Called after the last GPU call of a batch; must not fail.
    fn leave(&self);
    /// Returns the texture from which a host's `color` can be read, if wgpu cannot copy `color` itself.
    /// [`HostBinding::refresh`] fills it.
    fn reading(&self, _color: &wgpu::Texture) -> Option<wgpu::Texture> {
        None
    }
    /// Copies `color`, with everything submitted for it, to the texture that [`HostBinding::reading`] returns for it.
    ///
    /// # Errors
    /// The error with which the host's context refuses the copy.
    fn refresh(&self, _color: &wgpu::Texture) -> Result<()> {
        Ok(())
    }
    /// Returns the texture to attach for writing a host's depth. `depth` is the texture that shaders read. Returns
    /// `None` if `depth` itself can be attached.
    fn attached_depth(&self, _depth: &wgpu::Texture) -> Option<AttachedDepth> {
        None
    }
    /// Copies the host's depth to `depth` again, after everything that was submitted, if `depth` is a copy.
    ///
    /// # Errors
    /// The errors of [`HostBinding::refresh`].
    fn refresh_depth(&self, _depth: &wgpu::Texture) -> Result<()> {
        Ok(())
    }
    /// Reads and clears OpenGL's error flags, and returns the first as an error. Must be called while entered.
    fn raised(&self) -> Option<Error> {
        None
    }
    /// Called once, while entered, before the device's own objects are released. The binding must release its
    /// references to them.
    fn closing(&self);
    /// Called once, still entered, after the device's own objects were released.
    fn closed(&self);
    /// Called instead of `closing` and `closed` if the host's context cannot be entered. The binding must then make no
    /// GPU call, because the context, and with it all its objects, may no longer exist.
    fn forsaken(&self);
}

/// First field of a device to be dropped. Enters the host's context, in which the later fields are then released, and
/// calls the binding's `closing`. If the context cannot be entered, calls `forsaken` and releases nothing, because a
/// driver may crash at a call without a context.
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
            std::mem::forget(kept); // keeps the reference count above 0
        }
    }
}

/// Last field of a device to be dropped: calls the binding's `closed` and leaves the host's context, if [`Entrance`]
/// has entered it.
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

/// Proof that the host's context is current. Dropping it leaves the context.
#[must_use = "the host's context is left when this is dropped"]
pub struct Entered<'a>(Option<&'a dyn HostBinding>);

impl Drop for Entered<'_> {
    fn drop(&mut self) {
        if let Some(binding) = self.0 {
            binding.leave();
        }
    }
}

/// Faults that wgpu has reported, and the state of the native device.
#[derive(Default)]
struct Faults {
    /// First fault since the last check.
    first: Mutex<Option<Error>>,
    /// Whether the native device is lost.
    lost: AtomicBool,
    /// Whether the GPU does not finish its work: see [`Device::give_up`].
    hung: AtomicBool,
}

/// A compiled shader module, and the names of its `override` constants.
#[derive(Clone)]
pub(crate) struct Shader {
    pub module: wgpu::ShaderModule,
    pub overrides: Arc<[String]>,
}

/// One native queue or GL context, with its capabilities and faults. Contexts and views share it. Any thread may use
/// it; an OpenGL host's context is entered by one thread at a time.
pub struct Device {
    // Fields are dropped in this order: see `Entrance`.
    _entrance: Option<Entrance>,
    /// Instance; kept for surfaces and for the order of destruction.
    pub instance: wgpu::Instance,
    /// Physical device.
    pub adapter: wgpu::Adapter,
    /// Logical device.
    pub device: wgpu::Device,
    /// Only queue of the device.
    pub queue: wgpu::Queue,
    /// Shader modules by name: parsing a shader takes longer than creating a pipeline from it.
    shaders: Mutex<HashMap<String, Shader>>,
    caps: Caps,
    faults: Arc<Faults>,
    /// Lock that lets one thread submit at a time.
    submission: Mutex<()>,
    /// Number of calls of [`Device::submit`] so far.
    submissions: AtomicU64,
    /// Counted work, for the benchmarks.
    pub(crate) counts: WorkTotals,
    /// Window images that are acquired but not yet presented or given back.
    of_windows: Mutex<Vec<wgpu::Texture>>,
    /// Hooks of the OpenGL host in whose context the device lives; `None` for all other devices.
    binding: Option<Arc<dyn HostBinding>>,
    _exit: Option<Exit>,
}

impl Device {
    /// Creates the device as [`Device::adopt`] does, without testing the driver. The caller trusts the driver or tests
    /// it.
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
            counts: WorkTotals::default(),
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

    /// Treats the device as a GPU from now on, even if its driver is a software driver.
    #[cfg(test)]
    pub(crate) fn take_for_gpu(&mut self) {
        self.caps.software = false;
    }

    /// Makes the host's context current until the returned value is dropped. Does nothing for a device without a
    /// [`HostBinding`].
    ///
    /// # Errors
    /// [`Status::DeviceLost`] if the device is lost, and any reason for which the host's context cannot be entered.
    pub fn enter(&self) -> Result<Entered<'_>> {
        if self.is_lost() {
            return Err(Error::new(Status::DeviceLost, "the device is lost: destroy it and create a new one"));
        }
        self.enter_to_release()
    }

    /// Enters as [`Device::enter`] does, even if the device is lost: objects that the device created in the host's
    /// context still exist and must be deleted in it.
    ///
    /// # Errors
    /// Any reason for which the host's context cannot be entered.
    pub(crate) fn enter_to_release(&self) -> Result<Entered<'_>> {
        if let Some(binding) = &self.binding {
            binding.enter()?;
        }
        Ok(Entered(self.binding.as_deref()))
    }

    /// Returns the texture from which a host's `color` can be read, if wgpu cannot copy `color` itself.
    pub(crate) fn reading(&self, color: &wgpu::Texture) -> Option<wgpu::Texture> {
        self.binding.as_ref().and_then(|b| b.reading(color))
    }

    /// Copies `color`, with everything submitted for it, to the texture that [`Device::reading`] returns for it.
    ///
    /// # Errors
    /// The error with which the host's context refuses the copy.
    pub(crate) fn refresh(&self, color: &wgpu::Texture) -> Result<()> {
        self.binding.as_ref().map_or(Ok(()), |b| b.refresh(color))
    }

    /// Returns the texture to attach for writing a host's `depth`.
    pub(crate) fn attached_depth(&self, depth: &wgpu::Texture) -> AttachedDepth {
        let other = self.binding.as_ref().and_then(|b| b.attached_depth(depth));
        other.unwrap_or_else(|| AttachedDepth { texture: depth.clone(), is_copied: false })
    }

    /// Copies the host's depth to `depth` again, after everything that was submitted, if `depth` is a copy.
    ///
    /// # Errors
    /// The error with which the host's context refuses the copy.
    pub(crate) fn refresh_depth(&self, depth: &wgpu::Texture) -> Result<()> {
        self.binding.as_ref().map_or(Ok(()), |b| b.refresh_depth(depth))
    }

    /// Whether `texture` is a window's image that is acquired now.
    pub(crate) fn is_of_window(&self, texture: &wgpu::Texture) -> bool {
        self.of_windows().contains(texture)
    }

    /// Locks the list of window images that are acquired now.
    pub(super) fn of_windows(&self) -> MutexGuard<'_, Vec<wgpu::Texture>> {
        self.of_windows.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the native device is lost.
    pub fn is_lost(&self) -> bool {
        self.faults.lost.load(Ordering::Acquire)
    }

    /// Returns the first GPU fault since the last call, if any. wgpu reports faults here instead of panicking.
    pub fn take_fault(&self) -> Option<Error> {
        self.faults.first.lock().map_or(None, |mut f| f.take())
    }

    /// Returns the first GPU fault since the last check as an error.
    ///
    /// # Errors
    /// The fault.
    pub fn check(&self) -> Result<()> {
        self.take_fault().map_or(Ok(()), Err)
    }

    /// Checks as [`Device::check`] does, and reads OpenGL's error flag: only this flag says that there was no memory
    /// for an image. Called while entered, after images were created.
    ///
    /// # Errors
    /// The fault; [`Status::OutOfMemory`] or [`Status::Internal`] for OpenGL's flag.
    pub(crate) fn check_made(&self) -> Result<()> {
        self.check()?;
        match &self.binding {
            Some(binding) => binding.raised(),
            None => self.raised_in_own(),
        }
        .map_or(Ok(()), Err)
    }

    /// Reads the error flag of OpenGL on a device without a [`HostBinding`].
    #[cfg(not(any(target_os = "macos", target_os = "ios")))]
    fn raised_in_own(&self) -> Option<Error> {
        if self.caps.backend != wgpu::Backend::Gl || self.is_lost() {
            return None;
        }
        // SAFETY: the only call on the context reads its error flag, under the lock that all of wgpu's calls take.
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

    /// Marks the device as lost and destroys it, as a driver crash would. For tests of the lost path.
    pub fn simulate_loss(&self) {
        self.faults.lost.store(true, Ordering::Release);
        let _entered = self.enter_to_release();
        self.device.destroy();
    }

    /// Assembles the shader file `name` and creates its module, unless it is cached.
    ///
    /// # Errors
    /// [`Status::Internal`] if the file or an include is missing.
    pub fn shader(&self, name: &str) -> Result<wgpu::ShaderModule> {
        self.shader_and_overrides(name).map(|shader| shader.module)
    }

    /// Returns the module of [`Self::shader`] and the names of its `override` constants.
    pub(crate) fn shader_and_overrides(&self, name: &str) -> Result<Shader> {
        let mut shaders = self.shaders.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = shaders.get(name) {
            return Ok(known.clone());
        }
        // Debug builds make a NaN visible; other builds draw it as black or white.
        let text =
            if cfg!(debug_assertions) { super::shader::assemble_checked(name) } else { super::shader::assemble(name) }?;
        let overrides = super::shader::overrides(&text);
        let desc = wgpu::ShaderModuleDescriptor { label: Some(name), source: wgpu::ShaderSource::Wgsl(text.into()) };
        // By default wgpu counts the iterations of each loop to end endless ones. On a GPU that takes 1/16 of the time
        // of the clouds.
        let checks = wgpu::ShaderRuntimeChecks { force_loop_bounding: false, ..wgpu::ShaderRuntimeChecks::checked() };
        // SAFETY: all shaders are this crate's own, and each of their loops ends whatever its blocks hold
        // (tests/shaders/loops.rs); bounds checks stay on.
        let module = unsafe { self.device.create_shader_module_trusted(desc, checks) };
        let made = Shader { module, overrides };
        shaders.insert(name.to_owned(), made.clone());
        Ok(made)
    }

    /// Submits the commands. Only one thread submits at a time, so that semaphores and barriers staged for a Vulkan
    /// host go with the submission for which they were staged.
    pub fn submit(&self, encoder: wgpu::CommandEncoder) {
        let commands = encoder.finish();
        let _turn = self.turn();
        self.submissions.fetch_add(1, Ordering::Relaxed);
        self.queue.submit([commands]);
    }

    /// Number of calls of [`Device::submit`] so far.
    pub fn submissions(&self) -> u64 {
        self.submissions.load(Ordering::Relaxed)
    }

    /// Writes bytes into a buffer before the next submission.
    pub(crate) fn write_buffer(&self, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) {
        self.counts.add(DeviceWork::UploadBytes, bytes.len() as u64);
        self.queue.write_buffer(buffer, offset, bytes);
    }

    /// Writes texels into a texture before the next submission.
    pub(crate) fn write_texture(
        &self,
        texels: wgpu::TexelCopyTextureInfo<'_>,
        bytes: &[u8],
        layout: wgpu::TexelCopyBufferLayout,
        size: wgpu::Extent3d,
    ) {
        self.counts.add(DeviceWork::UploadBytes, bytes.len() as u64);
        self.queue.write_texture(texels, bytes, layout, size);
    }

    /// Returns the work that the device has done since it was created, each total with its name: pipelines created and
    /// the calling threads' time for them, bytes uploaded, gauges drawn and read, readbacks, and tables computed.
    #[cfg(any(test, feature = "lab"))]
    #[doc(hidden)]
    pub fn work(&self) -> Vec<(&'static str, u64)> {
        self.counts.totals()
    }

    /// Takes the lock for submitting; it is held until the returned guard is dropped.
    pub(crate) fn turn(&self) -> MutexGuard<'_, ()> {
        self.submission.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Turns uncaptured errors and device loss into values that calls return, so that nothing panics or prints.
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
