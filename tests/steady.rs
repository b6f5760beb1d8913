//! Steady state: after the first frames, recording allocates nothing of its own and keeps nothing.
//!
//! wgpu allocates in every encoder and pass, so the count is taken against the same wgpu calls made by hand.

use std::{
    alloc::{GlobalAlloc, Layout, System},
    sync::{
        Arc,
        atomic::{AtomicI64, AtomicU64, Ordering::Relaxed},
    },
};

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc},
    frame::{Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions},
    scene::Camera,
    weather::Weather,
};

struct Counting;

static CALLS: AtomicU64 = AtomicU64::new(0);
static LIVE: AtomicI64 = AtomicI64::new(0);

// SAFETY: every call goes to the system's allocator unchanged; the counters allocate nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        CALLS.fetch_add(1, Relaxed);
        LIVE.fetch_add(layout.size() as i64, Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size() as i64, Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

struct Bench {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    copy: wgpu::Texture,
    uniform: wgpu::Buffer,
    target: wgpu::TextureView,
}

fn texture(device: &Device, format: wgpu::TextureFormat) -> wgpu::Texture {
    use wgpu::TextureUsages as U;
    let color = if format.has_depth_aspect() { U::empty() } else { U::COPY_SRC | U::COPY_DST };
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 64, height: 36, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: U::RENDER_ATTACHMENT | U::TEXTURE_BINDING | color,
        view_formats: &[],
    })
}

impl Bench {
    fn new(backends: wgpu::Backends) -> Self {
        let options = DeviceOptions { backends, ..Default::default() };
        let device = Device::headless(&options).expect("a driver is installed");
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut context = Context::new(device.clone(), shared, ContextDesc::default()).unwrap();
        // Cloud layers, precipitation, mist: everything that a frame may ask of the weather.
        context.set_weather(&Weather::preset("rain").unwrap(), 0.0, 0.0).unwrap();
        let view = View::new(&context).unwrap();
        let uniform = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 1024,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let color = texture(&device, wgpu::TextureFormat::Rgba16Float);
        Self {
            target: color.create_view(&Default::default()),
            color,
            copy: texture(&device, wgpu::TextureFormat::Rgba16Float),
            depth: texture(&device, wgpu::TextureFormat::Depth32Float),
            device,
            context,
            view,
            uniform,
        }
    }

    /// One frame of a camera that turns while time goes on.
    fn record(&mut self, id: u64) {
        let angle = id as f64 * 0.01;
        self.context.update(id as f64 / 60.0).unwrap();
        let camera = Camera::look_to(
            DVec3::new(0.0, 0.0, 50.0),
            DVec3::new(angle.sin(), angle.cos(), 0.1),
            DVec3::Z,
            1.0,
            1.6,
            0.1,
        );
        let frame = Frame::new(id, camera, &self.color, Some(&self.depth));
        self.view.record(&self.context, &frame, Stages::ALL).unwrap();
        self.device.wait().unwrap();
    }

    /// The same wgpu calls without Welkin: uploads for frame, fog and moved lamps, a copy, a pass of one draw.
    fn bare(&self) {
        let device = &self.device.device;
        for _ in 0..3 {
            self.device.queue.write_buffer(&self.uniform, 0, &[0; 512]);
        }
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("welkin") });
        encoder.copy_texture_to_texture(self.color.as_image_copy(), self.copy.as_image_copy(), self.color.size());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("composite"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_viewport(0.0, 0.0, 64.0, 36.0, 0.0, 1.0);
        drop(pass);
        self.device.queue.submit([encoder.finish()]);
        self.device.wait().unwrap();
    }
}

/// Allocations a frame, and bytes that stayed, over `frames` frames.
fn count(frames: u64, mut frame: impl FnMut(u64)) -> (f64, i64) {
    let (calls, live) = (CALLS.load(Relaxed), LIVE.load(Relaxed));
    for id in 0..frames {
        frame(id);
    }
    ((CALLS.load(Relaxed) - calls) as f64 / frames as f64, LIVE.load(Relaxed) - live)
}

fn steady(backends: wgpu::Backends, frames: u64) {
    let mut bench = Bench::new(backends);
    for id in 0..100 {
        bench.record(id);
        bench.bare();
    }
    let (bare, _) = count(frames, |_| bench.bare());
    let (ours, kept) = count(frames, |id| bench.record(1000 + id));
    println!("{backends:?}: {ours:.2} allocations a frame, the same wgpu calls alone {bare:.2}, kept {kept} bytes");
    // The bare pass binds nothing; wgpu's lists for our pipeline and three bind groups make four allocations.
    assert!(ours <= bare + 5.0, "recording allocates {ours} times a frame, wgpu alone {bare}");
    assert!(kept < 64 * 1024, "{frames} frames kept {kept} bytes");
}

// One test, since the counters belong to the whole process.
#[test]
fn recording_allocates_nothing_of_its_own() {
    steady(wgpu::Backends::NOOP, 10_000);
    steady(wgpu::Backends::VULKAN | wgpu::Backends::GL, 500);
}
