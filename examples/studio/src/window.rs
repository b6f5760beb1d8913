//! The studio in a window.

use std::{sync::Arc, time::Instant};

use welkin::gpu::Device;
use winit::{
    application::ApplicationHandler,
    dpi::LogicalSize,
    event::WindowEvent,
    event_loop::{ActiveEventLoop, ControlFlow, EventLoop},
    window::{Window, WindowId},
};

use crate::{app::App, paint::Painter, panel};

/// Size of the window when it opens, points.
const SIZE: [u32; 2] = [1280, 760];

/// Opens the window, and returns when it is closed.
///
/// # Errors
/// A sentence, if there is no display or no driver that can present to it.
pub fn run() -> Result<(), String> {
    let events = EventLoop::new().map_err(|e| format!("no window can be opened: {e}; try --headless"))?;
    events.set_control_flow(ControlFlow::Wait);
    let mut studio = Windowed { open: None, failed: None };
    events.run_app(&mut studio).map_err(|e| e.to_string())?;
    studio.failed.map_or(Ok(()), Err)
}

/// The window, and what is in it.
struct Open {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    configuration: wgpu::SurfaceConfiguration,
    gpu: Arc<Device>,
    input: egui_winit::State,
    painter: Painter,
    app: App,
    /// Size of the picture in the panel, pixels.
    picture: [u32; 2],
    last: Instant,
}

struct Windowed {
    open: Option<Open>,
    failed: Option<String>,
}

/// Opens a driver of some kinds that can present to a window.
fn adapter(events: &ActiveEventLoop, window: &Arc<Window>, backends: wgpu::Backends) -> Result<Opened, String> {
    let display = Box::new(events.owned_display_handle());
    let description =
        wgpu::InstanceDescriptor { backends, ..wgpu::InstanceDescriptor::new_with_display_handle(display) };
    let instance = wgpu::Instance::new(description);
    let surface = instance.create_surface(window.clone()).map_err(|e| e.to_string())?;
    let options = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
    let adapter = pollster::block_on(instance.request_adapter(&options)).map_err(|e| e.to_string())?;
    Ok((instance, surface, adapter))
}

type Opened = (wgpu::Instance, wgpu::Surface<'static>, wgpu::Adapter);

impl Open {
    fn new(events: &ActiveEventLoop) -> Result<Self, String> {
        let said = |e: &dyn std::fmt::Display| e.to_string();
        let size = LogicalSize::new(SIZE[0], SIZE[1]);
        let attributes = Window::default_attributes().with_title("Welkin studio").with_inner_size(size);
        let window = Arc::new(events.create_window(attributes).map_err(|e| said(&e))?);
        // OpenGL only where there is nothing else: its libraries print when they are asked.
        let (instance, surface, adapter) = adapter(events, &window, wgpu::Backends::PRIMARY)
            .or_else(|_| adapter(events, &window, wgpu::Backends::GL))?;
        let wanted = wgpu::DeviceDescriptor { required_limits: adapter.limits(), ..Default::default() };
        let (device, queue) = pollster::block_on(adapter.request_device(&wanted)).map_err(|e| said(&e))?;
        // The panel's renderer wants numbers by the sRGB curve.
        let formats = surface.get_capabilities(&adapter).formats;
        let format = formats.iter().copied().find(|f| !f.is_srgb()).or(formats.first().copied());
        let format = format.ok_or("the driver cannot present to this window")?;
        let inner = window.inner_size();
        let configuration = surface
            .get_default_config(&adapter, inner.width.max(1), inner.height.max(1))
            .ok_or("the driver cannot present to this window")?;
        let configuration = wgpu::SurfaceConfiguration { format, ..configuration };
        surface.configure(&device, &configuration);
        let gpu = Device::adopt(instance, adapter, device, queue, false, None).map_err(|e| said(&e))?;
        let context = egui::Context::default();
        let input = egui_winit::State::new(
            context,
            egui::ViewportId::ROOT,
            &window,
            Some(window.scale_factor() as f32),
            None,
            Some(gpu.device.limits().max_texture_dimension_2d as usize),
        );
        let (painter, app) = (Painter::new(&gpu, format), App::new(&gpu, [16, 16])?);
        Ok(Self { window, surface, configuration, gpu, input, painter, app, picture: [16, 16], last: Instant::now() })
    }

    fn resize(&mut self, width: u32, height: u32) {
        if width > 0 && height > 0 {
            (self.configuration.width, self.configuration.height) = (width, height);
            self.surface.configure(&self.gpu.device, &self.configuration);
            self.window.request_redraw();
        }
    }

    /// Draws a frame. Asks for the next one if time runs or the panel moves.
    fn frame(&mut self) {
        let seconds = self.last.elapsed().as_secs_f64();
        self.last = Instant::now();
        if let Err(message) = self.app.step(seconds, self.picture) {
            self.app.message = message;
        }
        let image = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(image) | wgpu::CurrentSurfaceTexture::Suboptimal(image) => image,
            wgpu::CurrentSurfaceTexture::Outdated | wgpu::CurrentSurfaceTexture::Lost => {
                let size = self.window.inner_size();
                return self.resize(size.width, size.height);
            }
            _ => return,
        };
        let context = self.input.egui_ctx().clone();
        let texture = self.painter.show(self.app.world().picture());
        let input = self.input.take_egui_input(&self.window);
        let (app, mut picture) = (&mut self.app, self.picture);
        let output = context.run_ui(input, |ui| picture = panel::show(ui, app, texture));
        let waits = output.viewport_output.values().map(|v| v.repaint_delay).min();
        let changed = picture != self.picture;
        self.picture = picture;
        self.input.handle_platform_output(&self.window, output.platform_output.clone());
        self.painter.paint(&context, output, &image.texture);
        self.window.pre_present_notify();
        self.gpu.queue.present(image);
        self.app.tell();
        if changed || self.app.pace > 0.0 || self.app.is_stale() || waits.is_some_and(|wait| wait.is_zero()) {
            self.window.request_redraw();
        }
    }
}

impl ApplicationHandler for Windowed {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match Open::new(events) {
            Ok(open) => self.open = Some(open),
            Err(message) => {
                self.failed = Some(message);
                events.exit();
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        if open.input.on_window_event(&open.window, &event).repaint {
            open.window.request_redraw();
        }
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => open.resize(size.width, size.height),
            WindowEvent::RedrawRequested => open.frame(),
            _ => {}
        }
    }
}
