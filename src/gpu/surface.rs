//! Window that the host gave by its native handle: images to draw into, and their presentation.
//!
//! Welkin neither creates the window nor handles its events. The host keeps its event loop and says when the size has
//! changed. A window that was resized, hidden, minimised or lost is no fault: [`Surface::acquire`] returns a status for
//! each.

use std::ffi::c_void;
use std::num::{NonZeroIsize, NonZeroU32};
use std::ptr::NonNull;
use std::sync::Arc;

use raw_window_handle as rwh;

use super::{Device, DeviceOptions, instance, stand_in::StandIn};
use crate::error::{Error, Result, Status};

/// Native window. The pointers and numbers are the host's. The window must outlive its surface, and the connection
/// (display) must outlive the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NativeWindow {
    /// X11 through Xlib: `Display*`, screen number, `Window`.
    Xlib {
        /// `Display*`.
        display: *mut c_void,
        /// Screen number, as `DefaultScreen` gives it.
        screen: i32,
        /// `Window`.
        window: u64,
    },
    /// X11 through XCB: `xcb_connection_t*`, screen number, `xcb_window_t`.
    Xcb {
        /// `xcb_connection_t*`.
        connection: *mut c_void,
        /// Screen number, as `xcb_connect` gives it.
        screen: i32,
        /// `xcb_window_t`.
        window: u32,
    },
    /// Wayland: `wl_display*`, `wl_surface*`.
    Wayland {
        /// `wl_display*`.
        display: *mut c_void,
        /// `wl_surface*`.
        surface: *mut c_void,
    },
    /// Windows: `HWND` and the module's `HINSTANCE`.
    Win32 {
        /// `HWND`.
        hwnd: *mut c_void,
        /// `HINSTANCE` of the module that created the window.
        hinstance: *mut c_void,
    },
    /// macOS: `NSView*`, for use on the main thread only.
    AppKit {
        /// `NSView*`.
        ns_view: *mut c_void,
    },
}

impl NativeWindow {
    /// Takes the handles of a Rust window.
    ///
    /// # Errors
    /// [`Status::Unsupported`] for a window system that Welkin cannot present to, or for handles that are not available
    /// at the moment.
    pub fn of(window: &(impl rwh::HasWindowHandle + rwh::HasDisplayHandle)) -> Result<Self> {
        let gone = |e: rwh::HandleError| Error::unsupported(format!("the window has no handle now: {e}"));
        let display = window.display_handle().map_err(gone)?.as_raw();
        let window = window.window_handle().map_err(gone)?.as_raw();
        let pointer = |p: Option<NonNull<c_void>>| p.map_or(std::ptr::null_mut(), NonNull::as_ptr);
        Ok(match (display, window) {
            (rwh::RawDisplayHandle::Xlib(d), rwh::RawWindowHandle::Xlib(w)) => {
                #[allow(clippy::useless_conversion, reason = "c_ulong has 32 bits on Windows")]
                let window = u64::from(w.window);
                Self::Xlib { display: pointer(d.display), screen: d.screen, window }
            }
            (rwh::RawDisplayHandle::Xcb(d), rwh::RawWindowHandle::Xcb(w)) => {
                Self::Xcb { connection: pointer(d.connection), screen: d.screen, window: w.window.get() }
            }
            (rwh::RawDisplayHandle::Wayland(d), rwh::RawWindowHandle::Wayland(w)) => {
                Self::Wayland { display: d.display.as_ptr(), surface: w.surface.as_ptr() }
            }
            (_, rwh::RawWindowHandle::Win32(w)) => Self::Win32 {
                hwnd: w.hwnd.get() as *mut c_void,
                hinstance: w.hinstance.map_or(std::ptr::null_mut(), |h| h.get() as *mut c_void),
            },
            (_, rwh::RawWindowHandle::AppKit(w)) => Self::AppKit { ns_view: w.ns_view.as_ptr() },
            (_, other) => return Err(Error::unsupported(format!("Welkin does not present to {other:?}"))),
        })
    }

    /// Returns the handles in the form that wgpu takes.
    fn raw(&self) -> Result<(rwh::RawDisplayHandle, rwh::RawWindowHandle)> {
        Ok(match *self {
            Self::Xlib { display, screen, window } => {
                let display = Some(pointer("display", "a Display*", display)?);
                let window = std::ffi::c_ulong::try_from(window).ok().filter(|&w| w != 0);
                let window = window.ok_or_else(|| Error::range("window", "an X11 Window, not 0", 0))?;
                (rwh::XlibDisplayHandle::new(display, screen).into(), rwh::XlibWindowHandle::new(window).into())
            }
            Self::Xcb { connection, screen, window } => {
                let connection = Some(pointer("connection", "an xcb_connection_t*", connection)?);
                let window = NonZeroU32::new(window);
                let window = window.ok_or_else(|| Error::range("window", "an xcb_window_t, not 0", 0))?;
                (rwh::XcbDisplayHandle::new(connection, screen).into(), rwh::XcbWindowHandle::new(window).into())
            }
            Self::Wayland { display, surface } => {
                let display = pointer("display", "a wl_display*", display)?;
                let surface = pointer("surface", "a wl_surface*", surface)?;
                (rwh::WaylandDisplayHandle::new(display).into(), rwh::WaylandWindowHandle::new(surface).into())
            }
            Self::Win32 { hwnd, hinstance } => {
                let hwnd = NonZeroIsize::new(hwnd as isize);
                let mut window =
                    rwh::Win32WindowHandle::new(hwnd.ok_or_else(|| Error::range("hwnd", "an HWND", "NULL"))?);
                window.hinstance = NonZeroIsize::new(hinstance as isize);
                if window.hinstance.is_none() {
                    return Err(Error::range("hinstance", "the HINSTANCE that made the window", "NULL"));
                }
                (rwh::WindowsDisplayHandle::new().into(), window.into())
            }
            Self::AppKit { ns_view } => {
                let view = pointer("ns_view", "an NSView*", ns_view)?;
                (rwh::AppKitDisplayHandle::new().into(), rwh::AppKitWindowHandle::new(view).into())
            }
        })
    }
}

impl NativeWindow {
    /// Checks that the window exists. For a window that does not exist, X11 drivers crash, and the behaviour on Windows
    /// depends on the driver.
    ///
    /// # Safety
    /// The connection is live.
    unsafe fn check_exists(&self) -> Result<()> {
        #[cfg(all(unix, not(any(target_os = "macos", target_os = "ios"))))]
        {
            use super::x11;
            // SAFETY: the caller vouches for the connection.
            let exists = unsafe {
                match *self {
                    Self::Xlib { display, window, .. } => NonNull::new(display).map(|d| x11::exists_xlib(d, window)),
                    Self::Xcb { connection, window, .. } => {
                        NonNull::new(connection).map(|c| x11::exists_xcb(c, window))
                    }
                    _ => None,
                }
            };
            if exists.flatten() == Some(false) {
                return Err(gone());
            }
        }
        #[cfg(windows)]
        if let Self::Win32 { hwnd, .. } = *self
            && !super::win32::exists(hwnd)
        {
            return Err(gone());
        }
        Ok(())
    }
}

fn pointer(name: &str, accepted: &str, p: *mut c_void) -> Result<NonNull<c_void>> {
    NonNull::new(p).ok_or_else(|| Error::range(name, accepted, "NULL"))
}

/// Connection to the window system, which OpenGL needs before there is a window.
#[derive(Debug)]
struct Display(rwh::RawDisplayHandle);

// SAFETY: the host keeps the connection alive and allows its use from the threads that call Welkin
// (`device_for_window`'s contract). wgpu only passes the pointer to EGL.
unsafe impl Send for Display {}
// SAFETY: as above.
unsafe impl Sync for Display {}

impl rwh::HasDisplayHandle for Display {
    fn display_handle(&self) -> std::result::Result<rwh::DisplayHandle<'_>, rwh::HandleError> {
        // SAFETY: the host keeps the connection alive longer than the instance that holds this.
        Ok(unsafe { rwh::DisplayHandle::borrow_raw(self.0) })
    }
}

/// Creates a device that can present to `window`, and to other windows of the same connection.
///
/// # Errors
/// [`Status::InvalidArgument`], which names a null handle or empty `backends`; [`Status::SurfaceOutdated`] if the
/// window does not exist; [`Status::NoAdapter`] or [`Status::Unsupported`] if no driver can present to it.
///
/// # Safety
/// The window's connection (display) must outlive the device. With X11, if the host or Welkin calls from several
/// threads, the host must have called `XInitThreads` first.
pub unsafe fn device_for_window(window: &NativeWindow, options: &DeviceOptions) -> Result<Arc<Device>> {
    let (display, _) = window.raw()?;
    let mut answer = Err(instance::none_wanted(options.backends));
    for backends in instance::attempts(options.backends) {
        answer = instance::open(backends, Some(Box::new(Display(display)))).and_then(|opened| {
            // SAFETY: the caller vouches for the window.
            let surface = unsafe { create(&opened, window)? };
            Device::from_instance(opened, options, Some(&surface))
        });
        if answer.is_ok() {
            break;
        }
    }
    answer
}

/// # Safety
/// The window must live as long as the surface.
unsafe fn create(instance: &wgpu::Instance, window: &NativeWindow) -> Result<wgpu::Surface<'static>> {
    let (raw_display_handle, raw_window_handle) = window.raw()?;
    // SAFETY: the caller vouches for the window's connection.
    unsafe { window.check_exists()? };
    let raw_display_handle = Some(raw_display_handle);
    let target = wgpu::SurfaceTargetUnsafe::RawHandle { raw_display_handle, raw_window_handle };
    // SAFETY: the caller vouches for the window.
    unsafe { instance.create_surface_unsafe(target) }
        .map_err(|e| Error::new(Status::Unsupported, format!("no driver can present to this window: {e}")))
}

/// Encoding of the colours that are drawn to the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SurfaceEncoding {
    /// Display-linear values, which the hardware encodes to sRGB when they are written.
    #[default]
    DisplayLinear,
    /// Values that are already sRGB-encoded.
    DisplaySrgb,
}

/// Time at which images reach the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pacing {
    /// At the screen's refresh, without tearing: [`Surface::acquire`] waits for it.
    #[default]
    Refresh,
    /// As soon as possible; the picture may tear.
    Immediate,
}

/// Settings of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SurfaceOptions {
    /// Width of the window's drawable area, pixels; 0 while it is minimised.
    pub width: u32,
    /// Height of the window's drawable area, pixels; 0 while it is minimised.
    pub height: u32,
    /// Encoding of the colours. Default: display-linear.
    pub encoding: SurfaceEncoding,
    /// Time at which images reach the screen. Default: at the refresh.
    pub pacing: Pacing,
}

/// Usages of the image that effects draw into.
const IMAGE_USAGE: wgpu::TextureUsages =
    wgpu::TextureUsages::RENDER_ATTACHMENT.union(wgpu::TextureUsages::COPY_SRC).union(wgpu::TextureUsages::COPY_DST);

/// Window to present to. Use it from one thread at a time; on macOS from the main thread.
pub struct Surface {
    // Drop order: an image before its surface, the surface before the device's instance.
    current: Option<wgpu::SurfaceTexture>,
    stand_in: Option<StandIn>,
    surface: wgpu::Surface<'static>,
    device: Arc<Device>,
    window: NativeWindow,
    options: Option<SurfaceOptions>,
    format: Option<wgpu::TextureFormat>,
    /// Whether the surface is configured for the window as it is now.
    ready: bool,
    /// Whether the surface must be created again.
    lost: bool,
}

// SAFETY: the raw handles inside are only passed to the driver, under `&mut self`, from the thread that the host calls
// from. The host's promise for them is the contract of `Surface::new`.
unsafe impl Send for Surface {}

impl std::fmt::Debug for Surface {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { window, options, format, .. } = self;
        let mut out = f.debug_struct("Surface");
        out.field("window", window).field("options", options).field("format", format).finish_non_exhaustive()
    }
}

impl Surface {
    /// Creates a surface on `window`, presented to by `device`. It gives images only after [`Surface::configure`].
    ///
    /// # Errors
    /// [`Status::InvalidArgument`], which names a null handle; [`Status::SurfaceOutdated`] if the window does not
    /// exist; [`Status::Unsupported`] if the device cannot present to this window (create the device with
    /// [`device_for_window`]); [`Status::DeviceLost`].
    ///
    /// # Safety
    /// The window must outlive the surface, and its connection must outlive the device.
    pub unsafe fn new(device: &Arc<Device>, window: &NativeWindow) -> Result<Self> {
        let _entered = device.enter()?;
        // SAFETY: the caller vouches for the window.
        let surface = unsafe { create(&device.instance, window)? };
        if surface.get_capabilities(&device.adapter).formats.is_empty() {
            return Err(Error::unsupported(format!(
                "the device ({}) cannot present to this window: it is gone, or the device was not made for it",
                device.caps().adapter_name
            )));
        }
        Ok(Self {
            current: None,
            stand_in: None,
            surface,
            device: device.clone(),
            window: *window,
            options: None,
            format: None,
            ready: false,
            lost: false,
        })
    }

    /// Returns the format of the images; `None` until the surface is first configured with a size above 0.
    pub fn format(&self) -> Option<wgpu::TextureFormat> {
        self.format
    }

    /// Returns the configured size of the images, pixels; (0, 0) before the first configure.
    pub fn size(&self) -> (u32, u32) {
        self.options.map_or((0, 0), |o| (o.width, o.height))
    }

    /// Configures the surface, for the first time or after its window has changed. An acquired image is discarded.
    ///
    /// A width or height of 0 means a minimised window: the call succeeds, and [`Surface::acquire`] returns
    /// [`Status::SurfaceOutdated`] until the surface is configured with a size above 0.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for a size beyond the device's largest texture; [`Status::Unsupported`] if the
    /// window has no format for the encoding; [`Status::SurfaceOutdated`] if the window is gone or refuses to be
    /// configured; [`Status::OutOfMemory`]; [`Status::DeviceLost`].
    pub fn configure(&mut self, options: &SurfaceOptions) -> Result<()> {
        let max = self.device.caps().max_texture_size;
        for (name, value) in [("width", options.width), ("height", options.height)] {
            if value > max {
                return Err(Error::range(name, &format!("in [0, {max}] pixels"), value));
            }
        }
        let device = self.device.clone();
        let _entered = device.enter()?;
        self.give_back();
        self.stand_in = None;
        self.ready = false;
        self.options = Some(*options);
        if options.width == 0 || options.height == 0 {
            return Ok(());
        }
        // SAFETY: the window's connection outlives the device by the contract of `new`.
        unsafe { self.window.check_exists().inspect_err(|_| self.lost = true)? };
        if self.lost {
            // SAFETY: the window outlives this surface by the contract of `new`.
            self.surface = unsafe { create(&device.instance, &self.window)? };
            self.lost = false;
        }
        let caps = self.surface.get_capabilities(&device.adapter);
        if caps.formats.is_empty() {
            self.lost = true;
            return Err(gone());
        }
        let format = choose_format(&caps.formats, options.encoding)?;
        self.format = Some(format);
        let direct = caps.usages.contains(IMAGE_USAGE);
        let config = wgpu::SurfaceConfiguration {
            usage: if direct { IMAGE_USAGE } else { wgpu::TextureUsages::RENDER_ATTACHMENT },
            format,
            color_space: wgpu::SurfaceColorSpace::Auto,
            width: options.width,
            height: options.height,
            present_mode: match options.pacing {
                Pacing::Refresh => wgpu::PresentMode::AutoVsync,
                Pacing::Immediate => wgpu::PresentMode::AutoNoVsync,
            },
            desired_maximum_frame_latency: 2,
            alpha_mode: wgpu::CompositeAlphaMode::Auto,
            view_formats: Vec::new(),
        };
        self.surface.configure(&device.device, &config);
        if let Some(fault) = device.take_fault() {
            self.lost = true;
            return Err(outdated(&fault.to_string()));
        }
        if !direct {
            self.stand_in = Some(StandIn::new(&device, (options.width, options.height), format, IMAGE_USAGE)?);
            device.check_made()?;
        }
        self.ready = true;
        Ok(())
    }

    /// Returns the next image to draw into. Draw it, then show it by [`Surface::present`]. Until then, further calls
    /// return the same image.
    ///
    /// # Errors
    /// [`Status::SurfaceOutdated`]: configure again, with the window's present size (also while it is minimised);
    /// [`Status::Pending`]: the window shows nothing now (it is hidden, or the screen is busy), skip this frame;
    /// [`Status::WrongOrder`] before the first configure; [`Status::DeviceLost`]; a GPU fault.
    pub fn acquire(&mut self) -> Result<wgpu::Texture> {
        let device = self.device.clone();
        let _entered = device.enter()?;
        let Some(options) = self.options else {
            return Err(Error::new(Status::WrongOrder, "the surface must be configured before it gives images"));
        };
        if let Some(image) = &self.current {
            return Ok(self.picture(image));
        }
        if !self.ready {
            let (w, h) = (options.width, options.height);
            let why = if w == 0 || h == 0 {
                format!("the window has no area ({w} x {h} pixels)")
            } else {
                "the window changed".into()
            };
            return Err(outdated(&why));
        }
        use wgpu::CurrentSurfaceTexture as Next;
        let image = match self.surface.get_current_texture() {
            Next::Success(image) => image,
            // The image can still be drawn into; the next call reports that the window has changed.
            Next::Suboptimal(image) => {
                self.ready = false;
                image
            }
            Next::Timeout => {
                return Err(Error::new(Status::Pending, "the screen gave no image in time: skip this frame"));
            }
            Next::Occluded => return Err(Error::new(Status::Pending, "the window is hidden: skip this frame")),
            Next::Outdated => {
                self.ready = false;
                return Err(outdated("the window changed"));
            }
            Next::Lost => {
                (self.ready, self.lost) = (false, true);
                return Err(outdated("the surface was lost"));
            }
            Next::Validation => {
                self.ready = false;
                return Err(device.take_fault().unwrap_or_else(|| outdated("the surface gave no image")));
            }
        };
        let picture = self.picture(&image);
        device.of_windows().push(image.texture.clone());
        self.current = Some(image);
        Ok(picture)
    }

    /// Discards an acquired image. wgpu does not take an image back from a lost device, and panics if the surface is
    /// dropped before the image; so on a lost device the image's texture is destroyed, even if others hold it.
    fn give_back(&mut self) {
        if let Some(image) = self.take_image()
            && self.device.is_lost()
        {
            image.texture.destroy();
        }
    }

    /// Takes the acquired image, and removes it from the device's list of window images.
    fn take_image(&mut self) -> Option<wgpu::SurfaceTexture> {
        let image = self.current.take()?;
        self.device.of_windows().retain(|known| *known != image.texture);
        Some(image)
    }

    /// Returns the texture that the host draws into for an acquired image.
    fn picture(&self, image: &wgpu::SurfaceTexture) -> wgpu::Texture {
        self.stand_in.as_ref().map_or_else(|| image.texture.clone(), |s| s.texture.clone())
    }

    /// Shows the acquired image, after the work submitted for it.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] if no image was acquired; [`Status::SurfaceOutdated`] and [`Status::DeviceLost`] as in
    /// [`Surface::acquire`].
    pub fn present(&mut self) -> Result<()> {
        let device = self.device.clone();
        let _entered = device.enter()?;
        let Some(image) = self.take_image() else {
            return Err(Error::new(Status::WrongOrder, "there is no image to present: acquire one first"));
        };
        if let Some(stand_in) = &self.stand_in {
            stand_in.copy_to(&device, &image.texture);
        }
        device.queue.present(image);
        if let Some(fault) = device.take_fault() {
            self.ready = false;
            return Err(outdated(&fault.to_string()));
        }
        Ok(())
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        self.give_back();
    }
}

fn gone() -> Error {
    Error::new(Status::SurfaceOutdated, "window: it does not exist, or no longer; make a surface on another one")
}

fn outdated(why: &str) -> Error {
    let message = format!("{why}: configure the surface again, with the window's present size");
    Error::new(Status::SurfaceOutdated, message)
}

/// Chooses the window's format for an encoding: of those with 8 bits per channel, the one that the window prefers.
fn choose_format(offered: &[wgpu::TextureFormat], encoding: SurfaceEncoding) -> Result<wgpu::TextureFormat> {
    let wanted = match encoding {
        SurfaceEncoding::DisplayLinear => [wgpu::TextureFormat::Bgra8UnormSrgb, wgpu::TextureFormat::Rgba8UnormSrgb],
        SurfaceEncoding::DisplaySrgb => [wgpu::TextureFormat::Bgra8Unorm, wgpu::TextureFormat::Rgba8Unorm],
    };
    offered.iter().copied().find(|f| wanted.contains(f)).ok_or_else(|| {
        Error::unsupported(format!("the window offers {offered:?}, none of which serves {encoding:?}"))
            .within("encoding")
    })
}

#[cfg(test)]
mod tests;
