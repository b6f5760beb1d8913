//! wgpu instances for Welkin's own devices: which graphics APIs are tried, in which order, and how Vulkan is opened
//! without Wayland.

use crate::error::{Error, Result};

/// Connection to the window system that an instance may hold.
pub(super) type KeptDisplay = Box<dyn wgpu::wgt::WgpuHasDisplayHandle>;

/// Yields the sets of graphics APIs to try, in order: all native ones but OpenGL together, then OpenGL, then `NOOP`.
/// OpenGL comes alone and after the other native ones, because merely opening it makes some drivers write to the host's
/// terminal.
pub(super) fn attempts(backends: wgpu::Backends) -> impl Iterator<Item = wgpu::Backends> {
    let (gl, noop) = (backends & wgpu::Backends::GL, backends & wgpu::Backends::NOOP);
    [backends - gl - noop, gl, noop].into_iter().filter(|backends| !backends.is_empty())
}

/// Returns the error for a set without any graphics API.
pub(super) fn none_wanted(backends: wgpu::Backends) -> Error {
    Error::range("backends", "at least one native interface", format!("{backends:?}"))
}

/// Opens an instance of `backends`, for windows of the connection `display` if there is one.
///
/// # Errors
/// [`crate::Status::NoAdapter`] if Vulkan must be opened without Wayland and this fails.
pub(super) fn open(backends: wgpu::Backends, display: Option<KeptDisplay>) -> Result<wgpu::Instance> {
    #[cfg(all(unix, not(any(target_os = "macos", target_os = "ios"))))]
    if backends.contains(wgpu::Backends::VULKAN) && !wayland_can_be_asked() {
        return without_wayland();
    }
    let mut desc = match display {
        Some(display) => wgpu::InstanceDescriptor::new_with_display_handle(display),
        None => wgpu::InstanceDescriptor::new_without_display_handle(),
    };
    desc.backends = backends;
    #[cfg(windows)]
    if backends.contains(wgpu::Backends::GL) {
        super::win32::stay_loaded();
    }
    desc.flags = wgpu::InstanceFlags::empty();
    desc.backend_options.noop.enable = backends.contains(wgpu::Backends::NOOP);
    Ok(wgpu::Instance::new(desc))
}

/// Whether libwayland is able to look for a compositor. If it is not, libwayland prints an error on standard error. A
/// Vulkan layer that comes with Mesa (`VK_LAYER_MESA_device_select`) makes libwayland look whenever an instance has
/// `VK_KHR_wayland_surface`, which wgpu always requests.
#[cfg(all(unix, not(any(target_os = "macos", target_os = "ios"))))]
fn wayland_can_be_asked() -> bool {
    let is_absolute = |name: &str| std::env::var_os(name).is_some_and(|path| std::path::Path::new(&path).is_absolute());
    is_absolute("XDG_RUNTIME_DIR") || is_absolute("WAYLAND_DISPLAY") || std::env::var_os("WAYLAND_SOCKET").is_some()
}

/// Opens a Vulkan instance without Wayland. Its windows are those of X11, which bring their own connection.
#[cfg(all(unix, not(any(target_os = "macos", target_os = "ios"))))]
fn without_wayland() -> Result<wgpu::Instance> {
    let desc = wgpu::hal::InstanceDescriptor {
        name: "welkin",
        flags: wgpu::InstanceFlags::empty(),
        memory_budget_thresholds: wgpu::MemoryBudgetThresholds::default(),
        backend_options: wgpu::BackendOptions::default(),
        telemetry: None,
        display: None,
    };
    let leave_out = |args: wgpu::hal::vulkan::CreateInstanceCallbackArgs<'_, '_, '_>| {
        args.extensions.retain(|name| *name != ash::khr::wayland_surface::NAME);
    };
    // SAFETY: nothing but Wayland surfaces is lost. The list has the extensions that wgpu wants and the loader offers;
    // with this one removed, wgpu behaves as on a loader that does not offer it.
    let vulkan = unsafe { wgpu::hal::vulkan::Instance::init_with_callback(&desc, Some(Box::new(leave_out))) };
    let vulkan = vulkan.map_err(|e| Error::new(crate::Status::NoAdapter, format!("Vulkan cannot be opened: {e}")))?;
    // SAFETY: the instance was just created and nothing else refers to it.
    Ok(unsafe { wgpu::Instance::from_hal::<wgpu::hal::vulkan::Api>(vulkan) })
}
