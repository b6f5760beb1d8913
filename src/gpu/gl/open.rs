//! Creation of a wgpu device on a host's OpenGL context.

use std::{
    ffi::{CStr, CString, c_void},
    panic::{AssertUnwindSafe, catch_unwind},
    sync::Arc,
    time::{Duration, Instant},
};

use wgpu::hal::{api::Gles, gles};

use super::{
    api::Api,
    check::{self, GlInfo},
    counting::Counting,
    desc::{GlHostDesc, GlMode},
    face::{FaceGuard, STORAGE},
    host::{Backend, GlHost, Inner, Sharing},
    image, later,
    mark::Mark,
    names::*,
    state::HostState,
    switch::{Switch, WhichContext},
    windows::Windows,
};
use crate::{
    error::{Error, Result, Status},
    gpu::{
        device::Device,
        known::{self, Fault},
    },
};

/// Device on a host's OpenGL, and the host itself.
pub struct GlDevice {
    /// Device; it enters the host's context by itself when it is dropped.
    pub device: Arc<Device>,
    /// Host's context and images.
    pub host: Arc<GlHost>,
}

/// Features that Welkin uses if the driver has them.
const WANTED: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
    .union(wgpu::Features::FLOAT32_FILTERABLE)
    .union(wgpu::Features::RG11B10UFLOAT_RENDERABLE)
    .union(wgpu::Features::DEPTH32FLOAT_STENCIL8)
    .union(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES)
    .union(wgpu::Features::DUAL_SOURCE_BLENDING);

/// Creates a device on the OpenGL context that is current on this thread, or on one that shares objects with it.
///
/// The host's context must be current. On return it is current again, with its state restored, in either mode.
///
/// # Errors
/// [`Status::InvalidArgument`] for a callback that is missing, or if `get_proc` returns NULL for a needed function;
/// [`Status::WrongOrder`] if no context or the wrong one is current, if `make_current` fails, or if nothing can be
/// drawn in the context now; [`Status::Unsupported`] if the context is older than OpenGL 3.3 or OpenGL ES 3.0;
/// [`Status::AlreadyWrapped`] if the context has a device already; [`Status::NoAdapter`] if wgpu cannot use the
/// context, or if its driver fails the test of known answers (`src/gpu/known.rs`) or does not finish the test in 6 s.
///
/// # Safety
/// The callbacks must do what their types declare until the device is gone. The contexts must outlive the device, or be
/// destroyed as a whole.
pub unsafe fn adopt(desc: &GlHostDesc) -> Result<GlDevice> {
    let Some(get_proc) = desc.get_proc else {
        return Err(Error::invalid("get_proc", "must not be NULL"));
    };
    let user = desc.user;
    // SAFETY: the caller vouches for `get_proc` and `user`; the name is NUL-terminated.
    let get = move |name: &CStr| function_or_null(unsafe { get_proc(user, name.as_ptr()) });
    let switch = desc.make_current.map(|call| Switch { call, user });
    check::loader_finds_all(&get)?;
    let (host, host_info) = load(&get)?;
    check::can_draw_now(&host, &host_info)?;
    match desc.mode {
        GlMode::HostContext => {
            if Mark::any_here(&host) {
                return Err(already_wrapped());
            }
            // Saves twice: the save that is kept needs the probe, and creating the probe changes bindings. The first
            // save, without the probe, restores these bindings.
            let mut state = HostState::new(&host, &host_info);
            state.save(&host, 0);
            let probe = make_probe(&host);
            state.restore(&host);
            state.save(&host, probe.0);
            state.normalise(&host, 0);
            let mut counting = Counting::new(&host, &host_info);
            let opened = counting.opens(&host, || open_known(&host, &host_info, &get, desc));
            let opened = finish(opened, &host, probe, &host_info);
            if opened.is_err() {
                counting.delete(&host);
            }
            let raised = state.restore(&host);
            let parts = opened?;
            log::debug!("OpenGL errors while opening: {raised:#x}");
            parts.into_device(host, host_info, Sharing::HostContext { state: Box::new(state), counting, switch }, desc)
        }
        GlMode::Shared => {
            let Some(switch) = switch else {
                return Err(Error::invalid("make_current", "must not be NULL in shared mode"));
            };
            let proof = Proof::leave(&host);
            host.Flush();
            let outcome = switch.to(WhichContext::Welkin).and_then(|()| {
                let (api, info) = load(&get)?;
                proof.check(&api)?;
                if Mark::any_here(&api) {
                    return Err(already_wrapped());
                }
                let probe = make_probe(&api);
                let mut state = HostState::new(&api, &info);
                state.save(&api, probe.0);
                state.normalise(&api, 0);
                let parts = finish(open_known(&api, &info, &get, desc), &api, probe, &info)?;
                api.Flush();
                Ok((parts, api, info))
            });
            let back = switch.to(WhichContext::Host);
            proof.remove(&host);
            let (parts, api, info) = outcome?;
            back?;
            let windows = Windows::new(&host);
            let sharing = Sharing::Shared { switch, host: Box::new(host), handover: desc.handover, windows };
            parts.into_device(api, info, sharing, desc)
        }
    }
}

/// Returns the address from `get_proc`, or NULL if it cannot be one. For a missing function some drivers'
/// wglGetProcAddress returns 1, 2, 3 or -1 (OpenGL Wiki, Load OpenGL Functions); no system has a function there.
fn function_or_null(address: *const c_void) -> *const c_void {
    if matches!(address as isize, -1..=3) { std::ptr::null() } else { address }
}

/// Returns the error for a context that has a device already.
fn already_wrapped() -> Error {
    Error::new(Status::AlreadyWrapped, "this OpenGL context belongs to another device already: destroy that one first")
}

/// Loads the current context's functions, by their names in that context, and queries its properties.
fn load(get: &dyn Fn(&CStr) -> *const c_void) -> Result<(Api, GlInfo)> {
    // SAFETY: the caller of `adopt` vouches that `get` returns NULL or the named OpenGL function.
    let by = |get: &dyn Fn(&CStr) -> *const c_void| unsafe {
        let mut api = Api::load(get);
        api.load_suffixed(get);
        api
    };
    let api = by(get);
    let info = GlInfo::query(&api)?;
    let api = by(&later::finder(&info, get));
    Ok((api, info))
}

/// Creates the probe, a framebuffer with colour, depth and stencil that is bound while state is read, and its two
/// textures.
fn make_probe(api: &Api) -> (u32, [u32; 2]) {
    let color = image::make_texture(api, RGBA8, (1, 1), 1);
    let depth = image::make_texture(api, DEPTH24_STENCIL8, (1, 1), 1);
    let framebuffer = api.one(Api::GenFramebuffers);
    api.BindFramebuffer(FRAMEBUFFER, framebuffer);
    api.FramebufferTexture2D(FRAMEBUFFER, COLOR_ATTACHMENT0, TEXTURE_2D, color, 0);
    api.FramebufferTexture2D(FRAMEBUFFER, DEPTH_STENCIL_ATTACHMENT, TEXTURE_2D, depth, 0);
    api.BindFramebuffer(FRAMEBUFFER, 0);
    (framebuffer, [color, depth])
}

/// Test that Welkin's context is not the host's own, and that the two share objects.
struct Proof {
    texture: u32,
    /// Blend colour of the host.
    color_was: [f32; 4],
}

/// Blend colour that no host has by chance.
const STRANGE: [f32; 4] = [0.123, 0.457, 0.789, 0.031_25];

impl Proof {
    /// Leaves a texture (which is shared) and a blend colour (which is not) in the host's context.
    fn leave(host: &Api) -> Self {
        let color_was = host.floats(BLEND_COLOR);
        let bound = host.uint(TEXTURE_BINDING_2D);
        let texture = host.one(Api::GenTextures);
        host.BindTexture(TEXTURE_2D, texture);
        host.BindTexture(TEXTURE_2D, bound);
        let [r, g, b, a] = STRANGE;
        host.BlendColor(r, g, b, a);
        Self { texture, color_was }
    }

    fn check(&self, welkin: &Api) -> Result<()> {
        if welkin.floats::<4>(BLEND_COLOR) == STRANGE {
            return Err(
                WhichContext::Welkin.refuse("make another context current than the host's: it left the host's current")
            );
        }
        if welkin.IsTexture(self.texture) == 0 {
            return Err(WhichContext::Welkin
                .refuse("make a context current that shares objects with the host's: it shares none"));
        }
        Ok(())
    }

    fn remove(self, host: &Api) {
        let [r, g, b, a] = self.color_was;
        host.BlendColor(r, g, b, a);
        host.delete(Api::DeleteTextures, self.texture);
    }
}

/// wgpu's objects on the host's context.
struct Opened {
    instance: wgpu::Instance,
    adapter: wgpu::Adapter,
    device: wgpu::Device,
    queue: wgpu::Queue,
}

/// wgpu's objects, and the names of Welkin's own objects in the context.
struct Parts {
    opened: Opened,
    backend: Backend,
    mark: Mark,
    probe: (u32, [u32; 2]),
    scratch: u32,
}

/// Opens wgpu on the current context and tests the driver by known answers. If shaders read bytes from blocks that
/// differ from those written, opens wgpu once more so that it writes blocks by `glBufferSubData`.
fn open_known(
    api: &Api,
    info: &GlInfo,
    get: &dyn Fn(&CStr) -> *const c_void,
    desc: &GlHostDesc,
) -> Result<(Backend, Opened)> {
    let has_storage = !desc.force_tier0 && STORAGE.iter().any(|name| info.has(name));
    let driver = format!("{} ({})", info.renderer, info.version_text);
    let opened = open(api, info, get, desc, false)?;
    match ask(&opened, api) {
        Ok(backend) => Ok((backend, opened)),
        Err(Fault::Blocks(what)) if has_storage => {
            log::warn!("OpenGL driver {driver}: blocks that are written through mapped memory are wrong: {what}");
            drop(opened);
            let opened = open(api, info, get, desc, true)?;
            ask(&opened, api).map(|backend| (backend, opened)).map_err(|fault| fault.refuse(&driver))
        }
        Err(fault) => Err(fault.refuse(&driver)),
    }
}

/// Tests the driver by known answers.
fn ask(opened: &Opened, api: &Api) -> std::result::Result<Backend, Fault> {
    let Opened { instance, adapter, device, queue } = opened;
    let trial = Device::around(instance.clone(), adapter.clone(), device.clone(), queue.clone(), true, None);
    let backend = first_picture(&trial, api)?;
    known::ask(&trial)?;
    Ok(backend)
}

/// Opens wgpu on the current context, whose state must be what wgpu assumes.
fn open(
    api: &Api,
    info: &GlInfo,
    get: &dyn Fn(&CStr) -> *const c_void,
    desc: &GlHostDesc,
    no_storage: bool,
) -> Result<Opened> {
    let refused = |text: String| Error::new(Status::NoAdapter, text);
    let shown = FaceGuard::show(api, info, desc.force_tier0, no_storage);
    let here = later::finder(info, get);
    let loader = |name: &str| match CString::new(name) {
        Ok(name) => FaceGuard::resolve(&name, here(&name)),
        Err(_) => std::ptr::null(),
    };
    let options = wgpu::GlBackendOptions {
        // Keeps Welkin's labels out of a host's debug messages.
        debug_fns: wgpu::GlDebugFns::Disabled,
        ..Default::default()
    };
    // wgpu's loader panics at unexpected values from a driver; the earlier checks leave few of these.
    let exposed = catch_unwind(AssertUnwindSafe(|| {
        // SAFETY: the context is current, and stays so until this function returns.
        unsafe { gles::Adapter::new_external(loader, options) }
    }))
    .map_err(|_| refused(format!("wgpu cannot read the OpenGL context {:?}", info.version_text)))?
    .ok_or_else(|| refused(format!("wgpu cannot use the OpenGL context {:?}", info.version_text)))?;
    drop(shown);
    let mut instance = wgpu::InstanceDescriptor::new_without_display_handle();
    // No backend: to open EGL here would make another context current without the host's knowledge.
    instance.backends = wgpu::Backends::empty();
    // No flags: above all not VALIDATION_INDIRECT_CALL, which needs compute shaders, missing in contexts of OpenGL 3.3.
    instance.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(instance);
    // SAFETY: the adapter is external and needs nothing of the instance.
    let adapter = unsafe { instance.create_adapter_from_hal::<Gles>(exposed) };
    let request = wgpu::DeviceDescriptor {
        label: Some("welkin"),
        required_features: adapter.features() & WANTED,
        required_limits: adapter.limits(),
        ..Default::default()
    };
    let (device, queue) = catch_unwind(AssertUnwindSafe(|| pollster::block_on(adapter.request_device(&request))))
        .map_err(|_| refused("wgpu cannot open a device on the OpenGL context".into()))?
        .map_err(|e| refused(format!("wgpu cannot open a device on the OpenGL context: {e}")))?;
    device.on_uncaptured_error(Arc::new(|e| log::error!("GPU fault: {e}"))); // until `Device` listens
    Ok(Opened { instance, adapter, device, queue })
}

/// Creates the objects that stay in the context beside wgpu's own. If opening failed, deletes the probe instead.
fn finish(opened: Result<(Backend, Opened)>, api: &Api, probe: (u32, [u32; 2]), info: &GlInfo) -> Result<Parts> {
    match opened {
        Ok((backend, opened)) => {
            let scratch = api.one(Api::GenFramebuffers);
            Ok(Parts { opened, backend, mark: Mark::set(api), probe, scratch })
        }
        Err(e) => {
            log::error!("{} {}: {e}", info.renderer, info.version_text);
            api.delete(Api::DeleteFramebuffers, probe.0);
            probe.1.iter().for_each(|t| api.delete(Api::DeleteTextures, *t));
            Err(e)
        }
    }
}

/// Clears one texel, copies it and reads it back. The bindings after each step show the names of wgpu's own objects.
fn first_picture(opened: &Device, api: &Api) -> std::result::Result<Backend, Fault> {
    let vertex_array = api.uint(VERTEX_ARRAY_BINDING);
    let texture = |usage| {
        opened.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage,
            view_formats: &[],
        })
    };
    let drawn = texture(wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC);
    let copied = texture(wgpu::TextureUsages::COPY_DST);
    let mut encoder = opened.device.create_command_encoder(&Default::default());
    let color = wgpu::Color { r: 1.0, g: 0.0, b: 1.0, a: 1.0 };
    drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &drawn.create_view(&Default::default()),
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(color), store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    }));
    opened.queue.submit([encoder.finish()]);
    let draw_framebuffer = api.uint(DRAW_FRAMEBUFFER_BINDING);
    let mut encoder = opened.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_texture(drawn.as_image_copy(), copied.as_image_copy(), drawn.size());
    opened.queue.submit([encoder.finish()]);
    let copy_framebuffer = api.uint(READ_FRAMEBUFFER_BINDING);
    // Must come before the texel is read, which would wait without a limit.
    if !finishes(api, known::LIMIT) {
        opened.give_up();
        return Err(Fault::Hang);
    }
    let mut texel = [0u8; 4];
    // SAFETY: one texel of four bytes is read into four bytes; the copy's source is attached for reading.
    unsafe { api.ReadPixels(0, 0, 1, 1, RGBA, UNSIGNED_BYTE, texel.as_mut_ptr().cast()) };
    drop((drawn, copied));
    let _ = opened.device.poll(wgpu::PollType::Poll);
    if texel != [255, 0, 255, 255] {
        let text =
            format!("the OpenGL context does not draw what it is told: a texel should be magenta and is {texel:?}");
        return Err(Error::new(Status::NoAdapter, text).into());
    }
    Ok(Backend { vertex_array, draw_framebuffer, copy_framebuffer })
}

/// Whether the GPU finishes the current context's commands within `limit`.
fn finishes(api: &Api, limit: Duration) -> bool {
    let fence = api.FenceSync(SYNC_GPU_COMMANDS_COMPLETE, 0);
    let begun = Instant::now();
    let mut answer = TIMEOUT_EXPIRED;
    while answer == TIMEOUT_EXPIRED && begun.elapsed() < limit {
        let step = limit.saturating_sub(begun.elapsed()).min(Duration::from_millis(100));
        answer = api.ClientWaitSync(fence, SYNC_FLUSH_COMMANDS_BIT, step.as_nanos() as u64);
    }
    api.DeleteSync(fence);
    // A context without the function, or one that refuses the wait, cannot be waited for; the read of the texel then
    // shows whether the GPU finishes.
    answer != TIMEOUT_EXPIRED
}

impl Parts {
    fn into_device(self, api: Api, info: GlInfo, sharing: Sharing, desc: &GlHostDesc) -> Result<GlDevice> {
        let Opened { instance, adapter, device, queue } = self.opened;
        let inner = Inner {
            api,
            sharing,
            mark: self.mark,
            backend: self.backend,
            probe: self.probe,
            tier0: desc.force_tier0,
            scratch: self.scratch,
            targets: Vec::new(),
            window: None,
            active: Vec::new(),
            next_id: 0,
            fault: None,
            closed: false,
        };
        let host = GlHost::new(info, inner);
        let device = Device::adopt(instance, adapter, device, queue, desc.force_tier0, Some(host.clone()))?;
        Ok(GlDevice { device, host })
    }
}
