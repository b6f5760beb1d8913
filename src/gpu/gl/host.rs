//! Entering and leaving a host's OpenGL: makes contexts current, makes one context wait for the other, and restores the
//! host's state.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::{
    api::{Api, Sync as Fence, raised_in_welkin},
    check::{self, GlInfo},
    counting::Counting,
    desc::Handover,
    gate::Gate,
    image::GlImage,
    mark::Mark,
    names::*,
    state::HostState,
    switch::{Switch, WhichContext},
    target::{Entry, GlTarget, GlTargetDesc, Multisample},
    window::WindowSize,
    windows::Windows,
};
use crate::{
    error::{Error, Result, Status},
    gpu::device::{AttachedDepth, HostBinding},
};

/// Names of wgpu's own objects in the context.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Backend {
    pub(super) vertex_array: u32,
    pub(super) draw_framebuffer: u32,
    pub(super) copy_framebuffer: u32,
}

/// Context in which the device uses the host's OpenGL.
pub(super) enum Sharing {
    /// A second context, and the functions of the host's own.
    Shared { switch: Switch, host: Box<Api>, handover: Handover, windows: Windows },
    /// Host's context, and the state to restore.
    HostContext { state: Box<HostState>, counting: Counting, switch: Option<Switch> },
}

/// Everything of a host that its lock protects: OpenGL's functions, Welkin's objects in the context, and the targets.
pub(super) struct Inner {
    pub(super) api: Api,
    pub(super) sharing: Sharing,
    pub(super) mark: Mark,
    pub(super) backend: Backend,
    /// Framebuffer that is bound while state is read, and its two textures.
    pub(super) probe: (u32, [u32; 2]),
    /// Framebuffer to which textures are attached to query their formats.
    pub(super) scratch: u32,
    pub(super) tier0: bool,
    pub(super) targets: Vec<Entry>,
    /// Check of the window's size, created when the host's window is first a target.
    pub(super) window: Option<WindowSize>,
    /// Ids of the targets in use since the last enter.
    pub(super) active: Vec<u64>,
    /// Number last given to a target or to a use of one.
    pub(super) next_id: u64,
    /// Error that could not be returned when it occurred; the next call that can return an error returns it.
    pub(super) fault: Option<Error>,
    /// Whether the device is gone.
    pub(super) closed: bool,
}

/// OpenGL host: enters the host's context, and gives the host's images as wgpu textures.
///
/// Every wgpu call on the host's device, and every drop of an object of that device, must happen between
/// [`GlHost::enter`] (or [`Device::enter`](crate::gpu::Device::enter), which does the same) and the drop of the
/// returned guard. The device itself enters the host when it is dropped. Any thread may enter; others wait.
pub struct GlHost {
    info: GlInfo,
    gate: Gate,
    inner: Mutex<Inner>,
}

/// Guard of an entered host: Welkin's state is current. Dropping it leaves the host.
#[must_use = "the host is left when this is dropped"]
pub struct Current<'a>(&'a GlHost);

impl Drop for Current<'_> {
    fn drop(&mut self) {
        self.0.leave();
    }
}

impl GlHost {
    pub(super) fn new(info: GlInfo, inner: Inner) -> Arc<Self> {
        Arc::new(Self { info, gate: Gate::default(), inner: Mutex::new(inner) })
    }

    /// Returns the properties that the context in which Welkin draws reported about itself.
    pub fn info(&self) -> &GlInfo {
        &self.info
    }

    fn inner(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Enters the host. In shared mode the host's context or no context must be current on this thread; Welkin's
    /// context is current on return. In mode [`GlMode::HostContext`](super::GlMode) the host's own context must be
    /// current, unless the host gave `make_current`, which then makes it current; the host's state is saved. Entering
    /// again on the same thread costs nothing.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] if the right context cannot be made current or cannot be drawn in now; also any error
    /// from when the host was last left.
    pub fn enter(&self) -> Result<Current<'_>> {
        self.begin()?;
        Ok(Current(self))
    }

    /// Enters as [`GlHost::enter`] does, without a guard. Each success needs one [`GlHost::leave`] on the same thread.
    ///
    /// # Errors
    /// The errors of [`GlHost::enter`].
    pub fn begin(&self) -> Result<()> {
        if self.gate.enter() > 1 {
            return Ok(());
        }
        let outcome = self.inner().begin(&self.info);
        if outcome.is_err() {
            self.gate.leave();
        }
        outcome
    }

    /// Reports an error that occurred when the host was last left, where it could not be returned. Each error is
    /// reported once.
    ///
    /// # Errors
    /// That error.
    pub fn check(&self) -> Result<()> {
        self.inner().fault.take().map_or(Ok(()), Err)
    }

    /// Undoes one [`GlHost::begin`]. When all are undone, pictures are copied back and the host continues: in its own
    /// context with its state restored, in shared mode with its context waiting for Welkin's.
    pub fn leave(&self) {
        match self.gate.depth() {
            0 => return,
            1 => self.inner().end(&self.info),
            _ => {}
        }
        self.gate.leave();
    }

    /// Returns the host's colour and depth as wgpu textures, valid until the host is left. Returns the same target,
    /// without allocation, as long as the host's objects do not change.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] if the host is not entered. For an image that cannot be used, an error that names its
    /// field, such as `target.color`.
    pub fn target(&self, device: &wgpu::Device, desc: &GlTargetDesc) -> Result<Arc<GlTarget>> {
        if self.gate.depth() == 0 {
            return Err(Error::new(Status::WrongOrder, "the OpenGL host must be entered before its target is used"));
        }
        self.inner().target(&self.info, device, desc)
    }
}

impl GlHost {
    /// Returns a host's depth texture or renderbuffer alone, for reading, as [`GlHost::target`] would give it. The
    /// image must have one sample.
    ///
    /// # Errors
    /// [`Status::Unsupported`] for a framebuffer; the errors of [`GlHost::target`].
    pub fn depth(
        &self,
        device: &wgpu::Device,
        image: GlImage,
        (width, height): (u32, u32),
        generation: u64,
    ) -> Result<wgpu::Texture> {
        if matches!(image, GlImage::Framebuffer { .. }) {
            let rest = "must be a texture or a renderbuffer here, not a framebuffer";
            return Err(Error::about(Status::Unsupported, "target.depth", rest));
        }
        // A target with one image as both colour and depth is built as a target that is only read.
        let multisample = Multisample::Each;
        let desc = GlTargetDesc {
            color: image,
            depth: Some(image),
            mask: None,
            surface_classes: None,
            normals: None,
            width,
            height,
            generation,
            multisample,
            write_depth: false,
        };
        Ok(self.target(device, &desc)?.color.clone())
    }
}

impl HostBinding for GlHost {
    fn enter(&self) -> Result<()> {
        self.begin()
    }

    fn leave(&self) {
        Self::leave(self);
    }

    fn raised(&self) -> Option<Error> {
        raised_in_welkin(self.inner().api.take_error())
    }

    fn reading(&self, color: &wgpu::Texture) -> Option<wgpu::Texture> {
        self.inner().entry_of(color)?.target.color_read.clone()
    }

    fn refresh(&self, color: &wgpu::Texture) -> Result<()> {
        let inner = self.inner();
        inner.entry_of(color).map_or(Ok(()), |entry| entry.read_again(&inner.api))
    }

    fn attached_depth(&self, depth: &wgpu::Texture) -> Option<AttachedDepth> {
        let inner = self.inner();
        let entry = inner.entry_with_depth(depth)?;
        let texture = entry.target.depth.clone()?;
        Some(AttachedDepth { texture, is_copied: entry.reads_copied_depth() })
    }

    fn refresh_depth(&self, depth: &wgpu::Texture) -> Result<()> {
        let inner = self.inner();
        inner.entry_with_depth(depth).map_or(Ok(()), |entry| entry.refresh(&inner.api))
    }

    fn closing(&self) {
        let mut inner = self.inner();
        let targets = std::mem::take(&mut inner.targets);
        for mut entry in targets {
            inner.end_of(&entry);
            entry.made.delete(&inner.api);
        }
        if let Some(window) = inner.window.take() {
            window.delete(&inner.api);
        }
        inner.active.clear();
        inner.rest(&self.info);
        inner.backend = Backend::default(); // from here on its names may be reused
    }

    fn closed(&self) {
        let mut inner = self.inner();
        inner.closed = true;
        inner.api.delete(Api::DeleteFramebuffers, inner.scratch);
        inner.api.delete(Api::DeleteFramebuffers, inner.probe.0);
        inner.probe.1.iter().for_each(|t| inner.api.delete(Api::DeleteTextures, *t));
        let inner = &mut *inner;
        inner.mark.remove(&inner.api);
        if let Sharing::HostContext { counting, .. } = &mut inner.sharing {
            counting.delete(&inner.api);
        }
    }

    fn forsaken(&self) {
        let mut inner = self.inner();
        inner.closed = true;
        std::mem::forget(std::mem::take(&mut inner.targets));
        inner.mark.forget();
    }
}

impl Inner {
    /// Makes Welkin's state current.
    fn begin(&mut self, info: &GlInfo) -> Result<()> {
        if self.closed {
            return Err(Error::new(Status::WrongOrder, "the OpenGL host is closed"));
        }
        if let Some(fault) = self.fault.take() {
            return Err(fault);
        }
        match &mut self.sharing {
            Sharing::Shared { switch, host, handover, windows } => {
                windows.enter(host, *switch)?;
                let fence = match handover {
                    Handover::Fence => host.FenceSync(SYNC_GPU_COMMANDS_COMPLETE, 0),
                    Handover::Flush => std::ptr::null(),
                };
                host.Flush();
                let arrived = switch.to(WhichContext::Welkin).and_then(|()| here(&self.mark, &self.api, true));
                if let Err(e) = arrived {
                    // The switch back to the host's context may fail too, but the first error matters more.
                    let _ = switch.to(WhichContext::Host);
                    host.DeleteSync(fence);
                    return Err(e);
                }
                wait(&self.api, fence);
            }
            Sharing::HostContext { state, counting, switch } => {
                if let Some(switch) = switch {
                    switch.to(WhichContext::Host)?;
                }
                here(&self.mark, &self.api, false)?;
                check::can_draw_now(&self.api, info)?;
                state.save(&self.api, self.probe.0);
                state.normalise(&self.api, self.backend.vertex_array);
                if let Err(e) = counting.allows(&self.api) {
                    state.restore(&self.api);
                    return Err(e);
                }
            }
        }
        Ok(())
    }

    /// Ends the use of all targets and gives the context back to the host.
    fn end(&mut self, info: &GlInfo) {
        let mut fault = self.finish_targets().err();
        self.rest(info);
        match &mut self.sharing {
            Sharing::Shared { switch, host, handover, windows } => {
                let raised = self.api.take_error();
                let fence = match handover {
                    Handover::Fence => self.api.FenceSync(SYNC_GPU_COMMANDS_COMPLETE, 0),
                    Handover::Flush => std::ptr::null(),
                };
                self.api.Flush();
                match switch.to(WhichContext::Host) {
                    Ok(()) => {
                        wait(host, fence);
                        fault = fault.or_else(|| windows.check_back(host).err());
                        if self.closed {
                            windows.remove(host);
                        }
                        let active = &self.active;
                        for entry in self.targets.iter().filter(|e| active.contains(&e.target.id)) {
                            entry.images().for_each(|image| bind_again(host, image));
                        }
                    }
                    Err(e) => {
                        // The host's context is not current, so it cannot wait for the fence. Welkin's context still
                        // is.
                        self.api.DeleteSync(fence);
                        fault = fault.or(Some(e));
                    }
                }
                fault = fault.or_else(|| raised_in_welkin(raised));
            }
            Sharing::HostContext { state, .. } => {
                let raised = state.restore(&self.api);
                fault = fault.or_else(|| raised_in_welkin(raised));
            }
        }
        self.active.clear();
        self.fault = fault;
    }

    /// Ends every target in use; returns the first error.
    fn finish_targets(&mut self) -> Result<()> {
        let mut outcome = Ok(());
        for entry in self.targets.iter().filter(|e| self.active.contains(&e.target.id)) {
            outcome = outcome.and(entry.end(&self.api));
        }
        outcome
    }

    /// Detaches and unbinds the host's images, which would otherwise live on after the host deletes them.
    fn rest(&self, info: &GlInfo) {
        let api = &self.api;
        let colors = api.uint(MAX_COLOR_ATTACHMENTS).min(8);
        for framebuffer in [self.backend.draw_framebuffer, self.backend.copy_framebuffer] {
            if framebuffer == 0 {
                continue;
            }
            api.BindFramebuffer(FRAMEBUFFER, framebuffer);
            for i in 0..colors {
                api.FramebufferTexture2D(FRAMEBUFFER, COLOR_ATTACHMENT0 + i, TEXTURE_2D, 0, 0);
            }
            api.FramebufferTexture2D(FRAMEBUFFER, DEPTH_STENCIL_ATTACHMENT, TEXTURE_2D, 0, 0);
        }
        api.BindFramebuffer(FRAMEBUFFER, 0);
        api.UseProgram(0); // a current program lives on, even when wgpu has deleted it
        if matches!(self.sharing, Sharing::Shared { .. }) {
            for unit in 0..16 {
                api.ActiveTexture(TEXTURE0 + unit);
                api.BindTexture(TEXTURE_2D, 0);
                if info.at_least((3, 2), (3, 1)) {
                    api.BindTexture(TEXTURE_2D_MULTISAMPLE, 0);
                }
            }
            api.ActiveTexture(TEXTURE0);
            api.BindRenderbuffer(RENDERBUFFER, 0);
        }
    }
}

/// Checks that the marked context is current.
fn here(mark: &Mark, api: &Api, shared: bool) -> Result<()> {
    if mark.is_here(api) {
        return Ok(());
    }
    Err(if shared {
        WhichContext::Welkin.refuse("make the context current that it made current when the device was created")
    } else {
        let sentence = "the OpenGL context that the device was created with must be current on this thread";
        Error::new(Status::WrongOrder, sentence)
    })
}

/// Makes the GPU work of the current context wait for a fence of the other context.
fn wait(api: &Api, fence: Fence) {
    if !fence.is_null() {
        api.WaitSync(fence, 0, TIMEOUT_IGNORED);
        api.DeleteSync(fence);
    }
}

/// Binds an image once and restores the binding: only after that does OpenGL guarantee that the other context's changes
/// to the image are visible (OpenGL 4.6 core specification, section 5.3.3, rule 4).
fn bind_again(api: &Api, image: GlImage) {
    match image {
        GlImage::Texture { name, target } => {
            let query = if target == TEXTURE_2D { TEXTURE_BINDING_2D } else { TEXTURE_BINDING_2D_MULTISAMPLE };
            let was = api.uint(query);
            api.BindTexture(target, name);
            api.BindTexture(target, was);
        }
        GlImage::Renderbuffer { name } => {
            let was = api.uint(RENDERBUFFER_BINDING);
            api.BindRenderbuffer(RENDERBUFFER, name);
            api.BindRenderbuffer(RENDERBUFFER, was);
        }
        GlImage::Framebuffer { .. } => {}
    }
}
