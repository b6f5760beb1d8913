//! Steady state: after the first frames, Welkin allocates no memory of its own while recording and keeps none.
//!
//! wgpu allocates in every encoder and pass. So the number of allocations is compared with that of the same wgpu calls
//! without Welkin. Where the binary has line tables, a backtrace of each allocation in some frames also shows its
//! maker: the innermost caller that is wgpu's or Welkin's.

use std::{
    alloc::{GlobalAlloc, Layout, System},
    backtrace::Backtrace,
    cell::Cell,
    ptr::{null, null_mut},
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicI64, AtomicU64, Ordering::Relaxed},
    },
    time::Duration,
};

use glam::{DMat3, DVec3};
use welkin::{
    Status,
    almanac::Utc,
    capi::{abi, context::*, device::*, frame::*, status::*, texture::*, timeline::*, view::*},
    clouds::CloudModel,
    context::{Context, ContextDesc},
    flow::{WindFieldDesc, WindFieldMode},
    frame::{Frame, Shared, Stages, View},
    glass::{Windscreen, WiperArm},
    gpu::{Device, DeviceOptions},
    rain::{Planes, Shelter},
    scene::{Camera, WorldKind},
    sea::{SeaHull, SeaPoint, SeaRegion, SeaSettings},
    snowpack::LyingSnowModel,
    terrain::{Rows, TerrainCells, TerrainDesc, TileKey},
    weather::{CloudLayer, Fog, FogKind, Precipitation, PrecipitationKind, Surface, Weather, Wind},
};
use welkin_support::{accept, textures::texture};

struct Counting;

static CALLS: AtomicU64 = AtomicU64::new(0);
static LIVE: AtomicI64 = AtomicI64::new(0);
static ASKING: AtomicBool = AtomicBool::new(false);
static OWN: Mutex<Vec<String>> = Mutex::new(Vec::new());

thread_local! {
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

// SAFETY: every call goes to the system's allocator unchanged; counting and taking backtraces never enter themselves
// again.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        CALLS.fetch_add(1, Relaxed);
        LIVE.fetch_add(layout.size() as i64, Relaxed);
        if ASKING.load(Relaxed) && !INSIDE.replace(true) {
            let trace = Backtrace::force_capture().to_string();
            if let Some(line) = own_allocation(&trace) {
                OWN.lock().unwrap().push(line.to_owned());
            }
            INSIDE.set(false);
        }
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

/// Welkin's source line that allocated, from the innermost caller that is Welkin's or wgpu's; `None` for wgpu.
fn own_allocation(trace: &str) -> Option<&str> {
    // " 12: <wgpu_core::Type as Trait>::function" and below it, where there is a line table, " at
    // ./src/frame/view.rs:159".
    let ours = |line: &str| {
        let file = line.strip_prefix("at ").map(|f| f.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap_or(f));
        file.is_some_and(|f| f.trim_start_matches('.').starts_with("/src/"))
    };
    let theirs = |line: &str| {
        let name = line.split_once(": ").map_or("", |(_, f)| f).trim_start_matches(['<', '&']);
        name.starts_with("wgpu") || name.starts_with("naga")
    };
    trace.lines().map(str::trim_start).find(|l| ours(l) || theirs(l)).filter(|l| ours(l))
}

/// Weather with clouds, rain and fog.
fn rainy() -> Weather {
    let precipitation = Precipitation { kind: PrecipitationKind::Rain, rate_mm_h: 2.0, ..Default::default() };
    let clouds = [(0.4, 500.0), (0.8, 1200.0), (0.3, 7000.0)].map(|(cover, base)| CloudLayer::new(cover, base));
    Weather {
        visibility_m: 900.0,
        fog: Fog::of(FogKind::Fog),
        clouds: clouds.to_vec(),
        precipitation,
        ..Weather::default()
    }
}

/// Camera of frame `id`, which drives and turns.
fn camera(id: u64) -> Camera {
    let angle = id as f64 * 0.01;
    let place = DVec3::new(0.2 * id as f64, 0.1 * id as f64, 50.0);
    Camera::look_to(place, DVec3::new(angle.sin(), angle.cos(), 0.1), DVec3::Z, 1.0, 1.6, 0.1)
}

/// A host that records frames.
trait Host {
    /// Records frame `id` at `id` sixtieths of a second, waits for it, and returns whether tables were rebuilt.
    fn record(&mut self, id: u64) -> bool;
}

/// A Rust host under such a weather, which can also make the same wgpu calls without Welkin.
struct RustHost {
    device: Arc<Device>,
    context: Context,
    view: View,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    copy: wgpu::Texture,
    uniform: wgpu::Buffer,
    target: wgpu::TextureView,
    /// The depth with the pixels' kinds, which a software driver's composition tests against.
    kinds: Option<wgpu::TextureView>,
    /// A compute shader that does nothing, used for the bare calls.
    idle: wgpu::ComputePipeline,
    held: wgpu::BindGroup,
    list: wgpu::Buffer,
    times: wgpu::Buffer,
}

/// A compute shader that does nothing to `buffer`.
fn idle(device: &wgpu::Device, buffer: &wgpu::Buffer) -> (wgpu::ComputePipeline, wgpu::BindGroup) {
    let ty = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only: false },
        has_dynamic_offset: false,
        min_binding_size: wgpu::BufferSize::new(4),
    };
    let entry = wgpu::BindGroupLayoutEntry { binding: 0, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None };
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &[entry] });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(&layout)],
            ..Default::default()
        })),
        module: &device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl("@compute @workgroup_size(1) fn idle() {}".into()),
        }),
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let entries = [wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }];
    let held = device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
    (pipeline, held)
}

/// A clear sky.
fn clear() -> Weather {
    Weather::default()
}

/// Heavy showers with thunder.
fn storm() -> Weather {
    let precipitation = Precipitation {
        kind: PrecipitationKind::Rain,
        rate_mm_h: 20.0,
        showers: true,
        thunderstorm: true,
        ..Default::default()
    };
    Weather { visibility_m: 6000.0, clouds: vec![CloudLayer::new(1.0, 900.0)], precipitation, ..Weather::default() }
}

impl RustHost {
    fn new(backends: wgpu::Backends) -> Self {
        Self::under(backends, &rainy(), ContextDesc::default().utc_at_zero)
    }

    fn under(backends: wgpu::Backends, weather: &Weather, utc_at_zero: Utc) -> Self {
        let options = DeviceOptions { backends, ..Default::default() };
        let device = Device::headless(&options).expect("a driver is installed");
        let shared = Arc::new(Shared::new(&device).unwrap());
        let mut desc = ContextDesc { utc_at_zero, ..ContextDesc::default() };
        desc.world.kind = WorldKind::Tangent;
        let mut context = Context::new(device.clone(), shared, desc).unwrap();
        context.set_weather(weather, 0.0, 0.0).unwrap();
        // A volume of clouds has passes that the bare calls do not have.
        context.set_cloud_model(CloudModel::Deck);
        let view = View::new(&context).unwrap();
        let uniform = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 1024,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let [list, times] = [wgpu::BufferUsages::VERTEX, wgpu::BufferUsages::INDIRECT].map(|usage| {
            device.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: 64,
                usage: wgpu::BufferUsages::STORAGE | usage,
                mapped_at_creation: false,
            })
        });
        let (idle, held) = idle(&device.device, &list);
        let color = texture(&device, (128, 72), wgpu::TextureFormat::Rgba16Float, 1);
        Self {
            target: color.create_view(&Default::default()),
            kinds: device.caps().software.then(|| {
                texture(&device, (128, 72), wgpu::TextureFormat::Depth32Float, 1).create_view(&Default::default())
            }),
            color,
            copy: texture(&device, (128, 72), wgpu::TextureFormat::Rgba16Float, 1),
            depth: texture(&device, (128, 72), wgpu::TextureFormat::Depth32Float, 1),
            device,
            context,
            view,
            uniform,
            idle,
            held,
            list,
            times,
        }
    }

    /// A host under clouds that are drawn as a volume.
    fn under_a_volume(backends: wgpu::Backends) -> Self {
        let mut host = Self::new(backends);
        host.context.set_cloud_model(CloudModel::Volume);
        host
    }

    /// Makes the same wgpu calls without Welkin: uploads, a copy, a pass that lists drops, one that draws them, and
    /// those of the composition.
    fn bare(&self) {
        let device = &self.device.device;
        for _ in 0..6 {
            self.device.queue.write_buffer(&self.uniform, 0, &[0; 512]);
        }
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("welkin") });
        encoder.copy_texture_to_texture(self.color.as_image_copy(), self.copy.as_image_copy(), self.color.size());
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.idle);
        pass.set_bind_group(0, &self.held, &[]);
        for _ in 0..3 {
            pass.dispatch_workgroups(1, 1, 1);
        }
        pass.dispatch_workgroups_indirect(&self.times, 0);
        drop(pass);
        // A software driver's composition begins with passes for a grid of the weather.
        let grid = ["grid", "cells"].into_iter().filter(|_| self.kinds.is_some());
        for label in grid.chain(["drops", "composite"]) {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(label),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &self.target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
                })],
                depth_stencil_attachment: self.kinds.as_ref().filter(|_| label == "composite").map(|view| {
                    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard };
                    wgpu::RenderPassDepthStencilAttachment { view, depth_ops: Some(ops), stencil_ops: None }
                }),
                ..Default::default()
            });
            pass.set_viewport(0.0, 0.0, 128.0, 72.0, 0.0, 1.0);
            if label == "drops" {
                pass.set_vertex_buffer(0, self.list.slice(..));
            }
        }
        self.device.queue.submit([encoder.finish()]);
        self.device.wait().unwrap();
    }
}

impl Host for RustHost {
    fn record(&mut self, id: u64) -> bool {
        self.context.update(id as f64 / 60.0).unwrap();
        let frame = Frame::new(id, camera(id), &self.color, Some(&self.depth));
        self.view.record(&self.context, &frame, Stages::ALL).unwrap();
        self.device.wait().unwrap();
        self.view.report().tables_rebuilt > 0
    }
}

/// Host that draws the same frames through the C functions.
struct CHost {
    device: *mut wk_device,
    context: *mut wk_context,
    view: *mut wk_view,
    color: *mut wk_texture,
    depth: *mut wk_texture,
    frame: wk_frame,
    target: wk_own_target,
    report: wk_report,
}

/// A struct with every field at its default.
fn init<T>(name: &str) -> T {
    let mut bytes = vec![0_u64; size_of::<T>().div_ceil(8)];
    assert_eq!(abi::init(name, &mut bytes, size_of::<T>() as u32), WK_OK);
    // SAFETY: `bytes` holds a `T`, for which every bit pattern is valid.
    unsafe { bytes.as_ptr().cast::<T>().read() }
}

impl CHost {
    fn new(backends: wk_backend_flags) -> Self {
        use welkin::capi::{clouds::*, weather::*, weather_kinds::*};
        let mut host = Self {
            device: null_mut(),
            context: null_mut(),
            view: null_mut(),
            color: null_mut(),
            depth: null_mut(),
            frame: init("wk_frame"),
            target: init("wk_own_target"),
            report: init("wk_report"),
        };
        let desc = wk_device_desc { backends, ..init("wk_device_desc") };
        let world = wk_context_desc { world_kind: WK_WORLD_TANGENT, ..init("wk_context_desc") };
        let layers = [500.0, 1200.0].map(|base_m| wk_cloud_layer { cover: 0.6, base_m, ..init("wk_cloud_layer") });
        let weather = wk_weather {
            visibility_m: 900.0,
            fog_kind: WK_FOG_FOG,
            precipitation_kind: WK_PRECIPITATION_RAIN,
            precipitation_rate_mm_h: 2.0,
            clouds: layers.as_ptr(),
            cloud_count: 2,
            ..init("wk_weather")
        };
        let texture = wk_texture_desc { width: 128, height: 72, ..init("wk_texture_desc") };
        let color = wk_texture_desc { format: WK_FORMAT_RGBA16_FLOAT, ..texture };
        let depth = wk_texture_desc { format: WK_FORMAT_R32_FLOAT, ..texture };
        // SAFETY: live pointers.
        unsafe {
            assert_eq!(wk_device_create(&desc, &mut host.device), WK_OK);
            assert_eq!(wk_context_create(host.device, &world, &mut host.context), WK_OK);
            assert_eq!(wk_context_set_weather(host.context, &weather, 0.0, 0.0), WK_OK);
            assert_eq!(wk_context_set_cloud_model(host.context, WK_CLOUD_MODEL_DECK), WK_OK);
            assert_eq!(wk_view_create(host.context, null(), &mut host.view), WK_OK);
            assert_eq!(wk_texture_create(host.device, &color, &mut host.color), WK_OK);
            assert_eq!(wk_texture_create(host.device, &depth, &mut host.depth), WK_OK);
        }
        host.target = wk_own_target { color: host.color, depth: host.depth, ..host.target };
        host
    }
}

impl Host for CHost {
    fn record(&mut self, id: u64) -> bool {
        let camera = camera(id);
        self.frame.frame_id = id;
        self.frame.position_m = camera.position.to_array();
        self.frame.view = camera.view.to_cols_array();
        self.frame.projection = camera.projection.to_cols_array();
        self.frame.flags = WK_FRAME_DEPTH_REVERSED;
        self.frame.target = (&raw const self.target).cast();
        // SAFETY: live handles and pointers.
        unsafe {
            assert_eq!(wk_context_update(self.context, id as f64 / 60.0), WK_OK);
            assert_eq!(wk_view_record(self.view, &self.frame, WK_STAGE_ALL), WK_OK);
            assert_eq!(wk_view_get_report(self.view, &mut self.report), WK_OK);
        }
        self.report.tables_rebuilt > 0
    }
}

impl Drop for CHost {
    fn drop(&mut self) {
        // SAFETY: live handles.
        unsafe {
            assert_eq!(wk_view_destroy(self.view), WK_OK);
            assert_eq!(wk_context_destroy(self.context), WK_OK);
            assert_eq!(wk_texture_destroy(self.color), WK_OK);
            assert_eq!(wk_texture_destroy(self.depth), WK_OK);
            assert_eq!(wk_device_destroy(self.device), WK_OK);
        }
    }
}

/// Mean number of allocations of the frames that built no table, bytes that were not freed, and number of frames that
/// built tables.
struct Count {
    calls: f64,
    kept: i64,
    rebuilt: u64,
}

fn count(frames: std::ops::Range<u64>, mut frame: impl FnMut(u64) -> bool) -> Count {
    let (live, mut calls, mut rebuilt, number) = (LIVE.load(Relaxed), 0, 0, frames.end - frames.start);
    for id in frames {
        let before = CALLS.load(Relaxed);
        if frame(id) {
            rebuilt += 1;
        } else {
            calls += CALLS.load(Relaxed) - before;
        }
    }
    Count { calls: calls as f64 / (number - rebuilt) as f64, kept: LIVE.load(Relaxed) - live, rebuilt }
}

/// Host behind a windscreen with a wiper, where Welkin may not allocate either. The number of passes depends on the
/// time between frames, so wgpu's allocations are not compared.
struct Behind(RustHost);

impl Host for Behind {
    fn record(&mut self, id: u64) -> bool {
        let position = 0.5 - 0.5 * (id as f64 * 0.07).cos();
        let arm = WiperArm { position, pivot_m: [0.3, -0.05], ..WiperArm::default() };
        let screen = Windscreen {
            velocity_m_s: DVec3::new(0.0, 0.0, -12.0),
            airflow_m_s: 8.0,
            arms: [Some(arm), None],
            ..Windscreen::default()
        };
        self.0.view.set_windscreen(Some(&screen)).unwrap();
        self.0.record(id)
    }
}

/// Checks frames in which Welkin may neither allocate nor keep memory, whatever number of passes they have.
fn quiet(name: &str, host: &mut dyn Host, warm: u64, frames: u64) {
    for id in 0..warm {
        host.record(id);
    }
    let counted = count(warm..warm + frames, |id| host.record(id));
    println!("{name}: {:.1} allocations a frame, kept {} bytes", counted.calls, counted.kept);
    assert!(counted.kept < 64 * 1024, "{name}: kept {} bytes", counted.kept);
    if cfg!(debug_assertions) {
        let own = own_allocations(host, warm + frames..warm + frames + 40);
        assert!(own.is_empty(), "{name}: {} times: {:#?}", own.len(), &own[..own.len().min(8)]);
    }
}

/// Welkin's source lines that allocate in `frames`, whether tables were rebuilt or not.
fn own_allocations(host: &mut dyn Host, frames: std::ops::Range<u64>) -> Vec<String> {
    for id in frames {
        ASKING.store(true, Relaxed);
        host.record(id);
        ASKING.store(false, Relaxed);
    }
    std::mem::take(&mut OWN.lock().unwrap())
}

const WARM: u64 = 100;

fn steady(name: &str, host: &mut dyn Host, frames: u64, bare: f64) {
    for id in 0..WARM {
        host.record(id);
    }
    let counted = count(WARM..WARM + frames, |id| host.record(id));
    let Count { calls, kept, rebuilt } = counted;
    println!(
        "{name}: {calls:.2} allocations a frame, the same wgpu calls alone {bare:.2}; {rebuilt} of {frames} frames rebuilt \
         tables; kept {kept} bytes"
    );
    // The bare pass binds nothing; wgpu's lists for Welkin's pipelines and bind groups need a few more allocations, 7
    // on lavapipe.
    assert!(calls <= bare + 8.0, "{name}: recording allocates {calls} times a frame, wgpu alone {bare}");
    assert!(kept < 64 * 1024, "{name}: {frames} frames kept {kept} bytes");
    assert!(rebuilt > 0 && rebuilt < frames / 2, "{name}: the sun moves: {rebuilt}");
    if cfg!(debug_assertions) {
        let own = own_allocations(host, WARM + frames..WARM + frames + 40);
        assert!(
            own.is_empty(),
            "{name}: Welkin allocates itself, {} times: {:#?}",
            own.len(),
            &own[..own.len().min(8)]
        );
    }
}

/// Steps a wind field round a house, once with gusts and once to its steady state.
fn wind_fields_allocate_nothing() {
    for mode in [WindFieldMode::Running, WindFieldMode::Steady] {
        let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
        let device = Device::headless(&options).unwrap();
        let mut context =
            Context::new(device.clone(), Arc::new(Shared::new(&device).unwrap()), ContextDesc::default()).unwrap();
        let house = Shelter {
            center_m: DVec3::Z * 6.0,
            axes: DMat3::IDENTITY,
            half_size_m: DVec3::splat(6.0),
            velocity_m_s: DVec3::ZERO,
            planes: Planes::NONE,
        };
        context.set_shelters([&house]).unwrap();
        let field = WindFieldDesc { cells: [16, 16, 8], mode, ..WindFieldDesc::default() };
        context.set_wind_field(Some(&field), 0.0).unwrap();
        let mut to =
            |time_s: f64| while context.update_within(time_s, Duration::from_secs(600)).unwrap() == Status::Pending {};
        to(10.0);
        let before = CALLS.load(Relaxed);
        (0..20).for_each(|i| to(10.0 + 0.5 * f64::from(i)));
        assert_eq!(CALLS.load(Relaxed) - before, 0, "{mode:?}");
    }
}

/// Queries of a sea at times that follow each other, under a weather that changes.
fn sea_queries_allocate_nothing() {
    let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
    let device = Device::headless(&options).unwrap();
    let mut context =
        Context::new(device.clone(), Arc::new(Shared::new(&device).unwrap()), ContextDesc::default()).unwrap();
    context.set_sea(Some(SeaSettings::default())).unwrap();
    let corners_m = vec![[-30.0, -30.0], [30.0, -30.0], [0.0, 40.0]];
    context.set_sea_regions(vec![SeaRegion { corners_m, velocity_m_s: [3.0, 0.0], ..SeaRegion::default() }]).unwrap();
    context.set_sea_hulls(&[SeaHull { speed_m_s: 5.0, turn_deg_s: 3.0, ..SeaHull::default() }]).unwrap();
    let blowing = |speed| Weather { wind: Wind::of(speed, 250.0), ..Weather::default() };
    context.set_weather(&blowing(6.0), 0.0, 0.0).unwrap();
    context.set_weather(&blowing(12.0), 10.0, 3600.0).unwrap();
    let (places, mut out) = ([DVec3::ZERO, DVec3::X * 20.0], [SeaPoint::default(); 2]);
    let mut ask = |time_s: f64| {
        context.sea_at(&places, time_s, 0.0, &mut out).unwrap();
        context.sea_statistics(time_s).unwrap();
    };
    (0..4).for_each(|i| ask(20.0 + f64::from(i)));
    let before = CALLS.load(Relaxed);
    (0..20).for_each(|i| ask(30.0 + f64::from(i)));
    assert_eq!(CALLS.load(Relaxed) - before, 0);
}

/// Steps of snow that falls, drifts and slides on four tiles, and of rain that melts it.
fn snow_on_tiles_allocates_nothing() {
    let options = DeviceOptions { backends: wgpu::Backends::NOOP, ..DeviceOptions::default() };
    let device = Device::headless(&options).unwrap();
    let desc = ContextDesc { lying_snow: LyingSnowModel::Simulated, ..ContextDesc::default() };
    let mut context = Context::new(device.clone(), Arc::new(Shared::new(&device).unwrap()), desc).unwrap();
    context.set_terrain(Some(TerrainDesc { tile_cells: 32, ..TerrainDesc::default() })).unwrap();
    let heights: Vec<f32> = (0..32 * 32).map(|c| (c % 32) as f32 * 0.2 + (c % 7) as f32).collect();
    for key in [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| TileKey::new(x, y)) {
        let cells = TerrainCells { key, heights_m: Rows::of(&heights), ..TerrainCells::default() };
        context.set_terrain_tile(&cells).unwrap();
    }
    let weather = |temperature_c, kind| Weather {
        temperature_c,
        precipitation: Precipitation::of(kind, 2.0),
        wind: Wind::of(14.0, 250.0),
        surface: Surface { snow_depth_m: 0.3, ..Surface::default() },
        ..Weather::default()
    };
    let mut hour = 0.0;
    for (temperature_c, kind) in [(-5.0, PrecipitationKind::Snow), (4.0, PrecipitationKind::Rain)] {
        context.set_weather(&weather(temperature_c, kind), hour * 3600.0, 0.0).unwrap();
        // By then the change of the weather has ended and its start is dropped.
        hour += 2.0;
        context.update(hour * 3600.0).unwrap();
        OWN.lock().unwrap().clear();
        let before = CALLS.load(Relaxed);
        ASKING.store(true, Relaxed);
        (1..=60).for_each(|i| context.update(hour * 3600.0 + 60.0 * f64::from(i)).unwrap());
        ASKING.store(false, Relaxed);
        assert_eq!(CALLS.load(Relaxed) - before, 0, "{kind:?}: {:?}", OWN.lock().unwrap());
        hour += 1.0;
    }
    assert!(context.snow_balance().unwrap().ran_off_kg > 0.0);
}

/// All checks are one test, because the counters belong to the whole process.
#[test]
fn recording_allocates_nothing_of_its_own() {
    // wgpu's own backtraces are off: they would be counted, and would hold the lock that the test's backtraces need.
    // SAFETY: nothing else runs in this process yet that reads the environment.
    unsafe { std::env::set_var("RUST_LIB_BACKTRACE", "0") };
    wind_fields_allocate_nothing();
    sea_queries_allocate_nothing();
    snow_on_tiles_allocates_nothing();
    for (backends, frames) in [(wgpu::Backends::NOOP, 10_000), (wgpu::Backends::VULKAN | wgpu::Backends::GL, 500)] {
        let mut host = RustHost::new(backends);
        for id in 0..WARM {
            host.record(id);
            host.bare();
        }
        let bare = count(0..frames, |_| {
            host.bare();
            false
        });
        let mut host = RustHost::new(backends);
        steady(&format!("{backends:?}"), &mut host, frames, bare.calls);
        if backends == wgpu::Backends::NOOP {
            quiet("behind a windscreen", &mut Behind(RustHost::new(backends)), WARM, 2000);
            quiet("under clouds of a volume", &mut RustHost::under_a_volume(backends), WARM, 1000);
            let night = Utc(1_768_773_600.0);
            quiet("a clear night", &mut RustHost::under(backends, &clear(), night), WARM, 1000);
            // Three flashes a minute come and go meanwhile; the first one creates the pipelines of all.
            quiet("a storm", &mut RustHost::under(backends, &storm(), night), 3600, 3600);
            // The long soak of the acceptance suite: most of an hour at 60 frames a second.
            let frames = if accept() { 200_000 } else { frames };
            steady("noop through the C functions", &mut CHost::new(WK_BACKEND_NOOP), frames, bare.calls);
        }
    }
}
