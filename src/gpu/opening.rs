//! Opening of devices: created by Welkin, with or without a window, or taken over from existing wgpu objects.

use std::sync::Arc;

use super::{
    device::{Device, DeviceOptions, HostBinding},
    instance, known,
};
use crate::error::{Error, Result, Status};

impl Device {
    /// Creates a device without a window.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] if `backends` is empty; the errors of [`Device::from_instance`].
    pub fn headless(options: &DeviceOptions) -> Result<Arc<Self>> {
        let mut answer = Err(instance::none_wanted(options.backends));
        for backends in instance::attempts(options.backends) {
            answer = instance::open(backends, None).and_then(|opened| Self::from_instance(opened, options, None));
            if answer.is_ok() {
                break;
            }
        }
        answer
    }

    /// Creates a device on `instance`. It can present to `surface`, if one is given.
    ///
    /// # Errors
    /// [`Status::NoAdapter`] if no driver meets the request; the errors of [`Device::adopt`].
    pub fn from_instance(
        instance: wgpu::Instance,
        options: &DeviceOptions,
        surface: Option<&wgpu::Surface<'_>>,
    ) -> Result<Arc<Self>> {
        let request = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            force_fallback_adapter: options.force_software,
            compatible_surface: surface,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&request))
            .map_err(|e| Error::new(Status::NoAdapter, format!("no graphics adapter serves this request: {e}")))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&device_descriptor(&adapter, options)))
            .map_err(|e| Error::new(Status::NoAdapter, format!("the adapter gives no device: {e}")))?;
        Self::adopt(instance, adapter, device, queue, options.force_tier0, None)
    }

    /// Takes over existing wgpu objects: a Rust host's own, or those created on a GL or Vulkan host's handles. Without
    /// a `binding`, an OpenGL driver must first pass the test of known answers (`src/gpu/known.rs`); with one, it was
    /// tested when the host's context was opened.
    ///
    /// # Errors
    /// [`Status::NoAdapter`] if an OpenGL driver fails that test or does not finish it.
    pub fn adopt(
        instance: wgpu::Instance,
        adapter: wgpu::Adapter,
        device: wgpu::Device,
        queue: wgpu::Queue,
        force_tier0: bool,
        binding: Option<Arc<dyn HostBinding>>,
    ) -> Result<Arc<Self>> {
        // With a binding, the driver was tested when the host's context was opened.
        let is_unknown = binding.is_none() && adapter.get_info().backend == wgpu::Backend::Gl;
        let own = Self::around(instance, adapter, device, queue, force_tier0, binding);
        if is_unknown {
            let driver = format!("{} ({})", own.caps().adapter_name, own.caps().driver);
            known::ask(&own).map_err(|fault| fault.refuse(&driver))?;
        }
        Ok(own)
    }
}

/// Returns the features and limits that Welkin requests. The limits are the adapter's own, so that large targets fit.
/// For a forced tier 0 they are those of WebGL 2, with the adapter's largest texture sizes.
fn device_descriptor(adapter: &wgpu::Adapter, options: &DeviceOptions) -> wgpu::DeviceDescriptor<'static> {
    let mut limits = adapter.limits();
    if options.force_tier0 {
        limits = wgpu::Limits::downlevel_webgl2_defaults().using_resolution(limits);
    }
    wgpu::DeviceDescriptor {
        label: Some("welkin"),
        required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
        required_limits: limits,
        ..Default::default()
    }
}
