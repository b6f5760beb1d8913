//! Instances of wgpu for devices of Welkin's own: which drivers are asked, in which order, and what they are not asked
//! for.

use crate::error::{Error, Result};

/// A connection to the window system that an instance may keep.
pub(super) type KeptDisplay = Box<dyn wgpu::wgt::WgpuHasDisplayHandle>;

/// The interfaces to try one after the other. OpenGL is asked alone and only where the others do not serve: merely
/// opening it makes some drivers write to the host's terminal.
pub(super) fn attempts(backends: wgpu::Backends) -> impl Iterator<Item = wgpu::Backends> {
    let (gl, noop) = (backends & wgpu::Backends::GL, backends & wgpu::Backends::NOOP);
    [backends - gl - noop, gl, noop].into_iter().filter(|backends| !backends.is_empty())
}

/// The answer for a list without any interface.
pub(super) fn none_wanted(backends: wgpu::Backends) -> Error {
    Error::range("backends", "at least one native interface", format!("{backends:?}"))
}

/// An instance of some interfaces, for windows of the connection `display` if there is one.
///
/// # Errors
/// [`crate::Status::NoAdapter`] where Vulkan cannot be opened.
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

/// Whether libwayland can look for a compositor. Where it cannot it says so on standard error, and a layer that comes
/// with Mesa (`VK_LAYER_MESA_device_select`) makes it look whenever an instance has `VK_KHR_wayland_surface`, which
/// wgpu always asks for.
#[cfg(all(unix, not(any(target_os = "macos", target_os = "ios"))))]
fn wayland_can_be_asked() -> bool {
    let is_absolute = |name: &str| std::env::var_os(name).is_some_and(|path| std::path::Path::new(&path).is_absolute());
    is_absolute("XDG_RUNTIME_DIR") || is_absolute("WAYLAND_DISPLAY") || std::env::var_os("WAYLAND_SOCKET").is_some()
}

/// An instance of Vulkan that knows no Wayland. Its windows are X11's, which bring their connection themselves.
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
    // SAFETY: no feature is lost but surfaces of Wayland. The list holds what the loader offers of what wgpu would like
    // to have; without this one wgpu answers as it does on a loader that does not offer it.
    let vulkan = unsafe { wgpu::hal::vulkan::Instance::init_with_callback(&desc, Some(Box::new(leave_out))) };
    let vulkan = vulkan.map_err(|e| Error::new(crate::Status::NoAdapter, format!("Vulkan cannot be opened: {e}")))?;
    // SAFETY: it was made just now, and nothing else has it.
    Ok(unsafe { wgpu::Instance::from_hal::<wgpu::hal::vulkan::Api>(vulkan) })
}
