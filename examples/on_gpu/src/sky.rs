//! The sky's first table and its uniform blocks, drawn through wgpu in one OpenGL context, step by step, the safest
//! first.

use std::{
    cell::Cell,
    ffi::{CString, c_void},
    time::{Duration, Instant},
};

use welkin::{
    gpu::{Device, DeviceOptions, shader},
    sky::{
        Planet, SkyModel, SkySettings, air_uniform,
        probe::{Probe, Question, Ray},
    },
};
use welkin_support::egl;
use wgpu::{
    hal::{api::Gles, gles},
    util::DeviceExt as _,
};

use crate::{Fallible, Found};

/// Time after which a driver counts as hanging.
const LIMIT: Duration = Duration::from_secs(8);
/// Size of the first table: sun angles and altitudes.
const SIZE: (u32, u32) = (64, 32);
/// Directions of the quadrature: zenith and azimuth.
const RULE: (u32, u32) = (8, 16);

struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    name: String,
}

/// How uniform blocks get their contents.
#[derive(Clone, Copy, PartialEq)]
enum Upload {
    /// At creation.
    Contents,
    /// Written through the queue.
    Written,
}

type GetStringI = unsafe extern "system" fn(u32, u32) -> *const u8;

/// Source of the loop bounds in the first table's shader.
#[derive(Clone, Copy, PartialEq)]
enum Bounds {
    /// From a uniform block, with a cap, as in Welkin.
    Capped,
    /// From a uniform block, without a cap.
    Uncapped,
    /// Constants in the source.
    Constants,
}

thread_local! {
    static GET_STRING_I: Cell<Option<GetStringI>> = const { Cell::new(None) };
}

/// Hides the extension for persistent mapping; wgpu then writes buffers by `glBufferSubData`.
unsafe extern "system" fn without_storage(name: u32, index: u32) -> *const u8 {
    let Some(real) = GET_STRING_I.get() else { return c"".as_ptr().cast() };
    // SAFETY: the driver's own function; its answer is a NUL-terminated string or NULL.
    unsafe {
        let text = real(name, index);
        let is_storage =
            !text.is_null() && std::ffi::CStr::from_ptr(text.cast()).to_bytes().ends_with(b"_buffer_storage");
        if is_storage { c"GL_hidden".as_ptr().cast() } else { text }
    }
}

impl Gpu {
    /// Creates wgpu on a context made here.
    fn in_context(no_storage: bool) -> Fallible<Self> {
        let context = egl::Context::new(egl::Api::Compatibility(4, 5), egl::Window::None);
        let _ = context.functions();
        let loader = |name: &str| -> *const c_void {
            let found = egl::proc_address(&CString::new(name).unwrap_or_default());
            if !no_storage || name != "glGetStringi" || found.is_null() {
                return found;
            }
            // SAFETY: the address is that function's.
            GET_STRING_I.set(Some(unsafe { std::mem::transmute::<*const c_void, GetStringI>(found) }));
            without_storage as *const c_void
        };
        // SAFETY: the context is current, and stays so until this process ends.
        let exposed = unsafe { gles::Adapter::new_external(loader, Default::default()) };
        let mut desc = wgpu::InstanceDescriptor::new_without_display_handle();
        desc.backends = wgpu::Backends::empty();
        desc.flags = wgpu::InstanceFlags::empty();
        let instance = wgpu::Instance::new(desc);
        // SAFETY: the adapter is external and needs nothing of the instance.
        let adapter =
            unsafe { instance.create_adapter_from_hal::<Gles>(exposed.ok_or("wgpu cannot use the context")?) };
        std::mem::forget(context);
        Self::of(instance, &adapter)
    }

    /// Creates wgpu's own device.
    fn own(backends: wgpu::Backends) -> Fallible<Self> {
        let mut desc = wgpu::InstanceDescriptor::new_without_display_handle();
        desc.backends = backends;
        desc.flags = wgpu::InstanceFlags::empty();
        let instance = wgpu::Instance::new(desc);
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        }))?;
        Self::of(instance, &adapter)
    }

    fn of(instance: wgpu::Instance, adapter: &wgpu::Adapter) -> Fallible<Self> {
        let info = adapter.get_info();
        let name = format!("{} ({} {})", info.name, info.driver, info.driver_info);
        let (device, queue) = pollster::block_on(
            adapter.request_device(&wgpu::DeviceDescriptor { required_limits: adapter.limits(), ..Default::default() }),
        )?;
        // Leaked, because on drop wgpu waits for the GPU without a time limit.
        std::mem::forget((instance, adapter.clone(), device.clone(), queue.clone()));
        Ok(Self { device, queue, name })
    }

    /// Waits for the submitted work; ends the process if it does not finish.
    fn wait(&self) -> Fallible<()> {
        let begun = Instant::now();
        loop {
            match self
                .device
                .poll(wgpu::PollType::Wait { submission_index: None, timeout: Some(Duration::from_secs(1)) })
            {
                Ok(_) => return Ok(()),
                Err(wgpu::PollError::Timeout) if begun.elapsed() < LIMIT => {}
                Err(wgpu::PollError::Timeout) => {
                    println!("RESULT hangs the GPU does not finish within {} s", LIMIT.as_secs());
                    std::process::exit(4);
                }
                Err(e) => return Err(e.into()),
            }
        }
    }

    fn read(&self, buffer: &wgpu::Buffer) -> Fallible<Vec<u8>> {
        buffer.map_async(wgpu::MapMode::Read, .., |_| ());
        self.wait()?;
        Ok(buffer.get_mapped_range(..)?.to_vec())
    }
}

/// Uniform blocks that the shader of the first table reads.
struct Blocks {
    contents: [Vec<u8>; 4],
    buffers: [wgpu::Buffer; 4],
}

const NAMES: [&str; 4] = ["air", "dims", "rule", "job"];

impl Blocks {
    fn new(gpu: &Gpu, upload: Upload) -> Self {
        let mut dims = [0_u32; 20];
        dims[..8].copy_from_slice(&[SIZE.0, SIZE.1, 8, 8, RULE.0, RULE.1, 4, 16]);
        let rule: [[f32; 4]; 24] = std::array::from_fn(|i| {
            let angle = std::f32::consts::PI * (i as f32 + 0.5) / RULE.1 as f32;
            [(i as f32 + 0.5) / RULE.0 as f32, 1.0 / RULE.0 as f32, angle.cos(), angle.sin()]
        });
        let contents = [
            air_uniform(&Planet::earth()),
            bytemuck::bytes_of(&dims).to_vec(),
            bytemuck::cast_slice(&rule).to_vec(),
            bytemuck::bytes_of(&[1_u32, 0, 0, 0]).to_vec(),
        ];
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let buffers = contents.each_ref().map(|contents| match upload {
            Upload::Contents => {
                gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
            }
            Upload::Written => {
                let size = contents.len() as u64;
                let desc = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
                let buffer = gpu.device.create_buffer(&desc);
                gpu.queue.write_buffer(&buffer, 0, contents);
                buffer
            }
        });
        Self { contents, buffers }
    }

    /// Compares the words; reports the first that differs from what was written.
    fn compare(&self, got: &[u8]) -> Found {
        let mut at = 0;
        for (name, contents) in NAMES.iter().zip(&self.contents) {
            let got = &got[at..at + contents.len()];
            let words = contents.chunks(4).zip(got.chunks(4));
            if let Some((i, (wanted, got))) = words.enumerate().find(|(_, (a, b))| a != b) {
                let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
                return Found::Wrong(format!("{name}, word {i}: 0x{:08x}, not 0x{:08x}", word(got), word(wanted)));
            }
            at += contents.len();
        }
        Found::Right(format!("{at} bytes are as they were written"))
    }
}

/// Draws the contents of all blocks, 16 bytes per texel, without a loop.
const OUT: &str = "
@group(0) @binding(0) var<uniform> air: array<vec4u, 9>;
@group(0) @binding(1) var<uniform> dims: array<vec4u, 5>;
@group(0) @binding(2) var<uniform> rule: array<vec4u, 24>;
@group(0) @binding(4) var<uniform> job: array<vec4u, 1>;
@fragment fn out(in: FullscreenVarying) -> @location(0) vec4u {
    let x = u32(in.position.x);
    if (x < 9u) { return air[x]; }
    if (x < 14u) { return dims[x - 9u]; }
    if (x < 38u) { return rule[x - 14u]; }
    return job[0];
}
";

/// Draws an entry point into part of a target, and reads the target.
fn drawn(
    gpu: &Gpu,
    blocks: &Blocks,
    (text, entry): (&str, &str),
    format: wgpu::TextureFormat,
    (size, part): ((u32, u32), (u32, u32)),
    bindings: &[usize],
) -> Fallible<Vec<u8>> {
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let checks = wgpu::ShaderRuntimeChecks { force_loop_bounding: false, ..wgpu::ShaderRuntimeChecks::checked() };
    // SAFETY: as Welkin makes its shaders; whether the loops end is the question.
    let module = unsafe {
        gpu.device.create_shader_module_trusted(wgpu::ShaderModuleDescriptor { label: None, source }, checks)
    };
    let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("fullscreen_vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let entry_of = |i: &usize| wgpu::BindGroupEntry {
        binding: if *i == 3 { 4 } else { *i as u32 },
        resource: blocks.buffers[*i].as_entire_binding(),
    };
    let entries: Vec<_> = bindings.iter().map(entry_of).collect();
    let layout = pipeline.get_bind_group_layout(0);
    let group =
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &target.create_view(&Default::default()),
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.set_scissor_rect(0, 0, part.0, part.1);
    pass.draw(0..3, 0..1);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()?;
    let row = size.0 * format.block_copy_size(None).unwrap_or(4);
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(padded * size.1),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: Some(size.1) };
    let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(target.as_image_copy(), to, target.size());
    gpu.queue.submit([encoder.finish()]);
    let bytes = gpu.read(&buffer)?;
    Ok(bytes.chunks(padded as usize).flat_map(|line| &line[..row as usize]).copied().collect())
}

fn blocks_out(gpu: &Gpu, upload: Upload) -> Fallible<Found> {
    let blocks = Blocks::new(gpu, upload);
    let text = format!("{}{OUT}", shader::assemble("common/fullscreen.wgsl")?);
    let size = (39, 1);
    let got = drawn(gpu, &blocks, (&text, "out"), wgpu::TextureFormat::Rgba32Uint, (size, size), &[0, 1, 2, 3])?;
    Ok(blocks.compare(&got))
}

/// Draws part of the first table. Its first texel must be a sum of weights, near 1.
fn norm_of(gpu: &Gpu, upload: Upload, part: (u32, u32), bounds: Bounds) -> Fallible<Found> {
    let blocks = Blocks::new(gpu, upload);
    let mut text = shader::assemble("sky/build.wgsl")?;
    if bounds == Bounds::Uncapped {
        for count in ["zeniths", "azimuths"] {
            let capped = format!("min(dims.rule_{count}, MOST_RULE_{})", count.to_uppercase());
            if !text.contains(&capped) {
                return Ok(Found::Nothing(format!("the shader has no {capped}")));
            }
            text = text.replace(&capped, &format!("dims.rule_{count}"));
        }
    }
    if bounds == Bounds::Constants {
        text = text
            .replace("dims.rule_zeniths", &format!("{}u", RULE.0))
            .replace("dims.rule_azimuths", &format!("{}u", RULE.1));
    }
    let got = drawn(gpu, &blocks, (&text, "norm"), wgpu::TextureFormat::Rgba16Float, (SIZE, part), &[0, 1, 2])?;
    let value = half::f16::from_le_bytes([got[0], got[1]]).to_f32();
    let text = format!("the first texel is {value} on {}", gpu.name);
    Ok(if (0.2..5.0).contains(&value) { Found::Right(text) } else { Found::Wrong(text) })
}

const ONE: (u32, u32) = (1, 1);

pub fn vulkan() -> Fallible<Found> {
    let gpu = match Gpu::own(wgpu::Backends::VULKAN) {
        Ok(gpu) => gpu,
        Err(e) => return Ok(Found::Nothing(format!("there is no Vulkan driver: {e}"))),
    };
    norm_of(&gpu, Upload::Contents, ONE, Bounds::Capped)
}

pub fn opengl() -> Fallible<Found> {
    use glow::HasContext;
    let context = egl::Context::new(egl::Api::Compatibility(4, 5), egl::Window::None);
    let gl = context.functions();
    // SAFETY: the context is current, and only its own names are used.
    unsafe {
        let texture = gl.create_texture()?;
        gl.bind_texture(glow::TEXTURE_2D, Some(texture));
        gl.tex_storage_2d(glow::TEXTURE_2D, 1, glow::RGBA8, 1, 1);
        let framebuffer = gl.create_framebuffer()?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, glow::TEXTURE_2D, Some(texture), 0);
        gl.clear_color(1.0, 0.0, 1.0, 1.0);
        gl.clear(glow::COLOR_BUFFER_BIT);
        let mut color = [0; 4];
        gl.read_pixels(0, 0, 1, 1, glow::RGBA, glow::UNSIGNED_BYTE, glow::PixelPackData::Slice(Some(&mut color)));
        let name = [glow::VENDOR, glow::RENDERER, glow::VERSION].map(|what| gl.get_parameter_string(what)).join(", ");
        std::mem::forget(context);
        let right = color == [255, 0, 255, 255];
        Ok(if right { Found::Right(name) } else { Found::Wrong(format!("{name}: a texel is {color:?}")) })
    }
}

pub fn blocks_read() -> Fallible<Found> {
    let gpu = Gpu::in_context(false)?;
    let blocks = Blocks::new(&gpu, Upload::Contents);
    let size = blocks.contents.iter().map(Vec::len).sum::<usize>() as u64;
    let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
    let desc = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
    let read = gpu.device.create_buffer(&desc);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut at = 0;
    for buffer in &blocks.buffers {
        encoder.copy_buffer_to_buffer(buffer, 0, &read, at, buffer.size());
        at += buffer.size();
    }
    gpu.queue.submit([encoder.finish()]);
    Ok(blocks.compare(&gpu.read(&read)?))
}

pub fn blocks_drawn() -> Fallible<Found> {
    blocks_out(&Gpu::in_context(false)?, Upload::Contents)
}

pub fn blocks_drawn_written() -> Fallible<Found> {
    blocks_out(&Gpu::in_context(false)?, Upload::Written)
}

pub fn blocks_drawn_plain() -> Fallible<Found> {
    blocks_out(&Gpu::in_context(true)?, Upload::Contents)
}

pub fn norm_constants() -> Fallible<Found> {
    norm_of(&Gpu::in_context(false)?, Upload::Contents, ONE, Bounds::Constants)
}

pub fn norm() -> Fallible<Found> {
    norm_of(&Gpu::in_context(false)?, Upload::Contents, ONE, Bounds::Capped)
}

pub fn norm_written() -> Fallible<Found> {
    norm_of(&Gpu::in_context(false)?, Upload::Written, ONE, Bounds::Capped)
}

pub fn norm_plain() -> Fallible<Found> {
    norm_of(&Gpu::in_context(true)?, Upload::Contents, ONE, Bounds::Capped)
}

pub fn norm_own() -> Fallible<Found> {
    norm_of(&Gpu::own(wgpu::Backends::GL)?, Upload::Contents, ONE, Bounds::Capped)
}

pub fn norm_whole() -> Fallible<Found> {
    norm_of(&Gpu::in_context(false)?, Upload::Contents, SIZE, Bounds::Capped)
}

pub fn norm_uncapped() -> Fallible<Found> {
    norm_of(&Gpu::in_context(false)?, Upload::Contents, ONE, Bounds::Uncapped)
}

/// With all of Welkin's safeguards: the device is either refused with a message, or draws.
pub fn welkin_own() -> Fallible<Found> {
    let device = match Device::headless(&DeviceOptions { backends: wgpu::Backends::GL, ..Default::default() }) {
        Ok(device) => device,
        Err(e) => return Ok(Found::Wrong(e.to_string())),
    };
    let mut probe = Probe::new(&device, &SkySettings::with_model(SkyModel::default()), &Planet::earth())?;
    let ray = Ray::at(1.0, 0.0, 0.0);
    let seen = probe.under_sun(Question::Sky, 1.0, 1.0, &[ray])?;
    let radiance = seen.first().ok_or("no answer")?.radiance;
    let text = format!("the sky is {radiance:?} on {}", device.caps().adapter_name);
    Ok(if radiance.iter().all(|r| *r > 0.0) { Found::Right(text) } else { Found::Wrong(text) })
}
