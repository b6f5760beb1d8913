//! Runs WGSL functions of the library on the GPU over a list of inputs: one texel for each input, in 32-bit floats.

use std::sync::{Arc, Mutex, OnceLock};

use welkin::fog::LowAirUniform;
use welkin::gpu::{Device, DeviceOptions, flat_texture, pass, readback, shader};
use welkin_support::fullscreen;

/// Device that all tests of fog on the GPU share.
pub fn device() -> &'static Arc<Device> {
    static DEVICE: OnceLock<Arc<Device>> = OnceLock::new();
    DEVICE.get_or_init(|| Device::headless(&DeviceOptions::default()).expect("a graphics adapter"))
}

const WIDTH: u32 = 64;

fn float_texture(width: u32, height: u32, usage: wgpu::TextureUsages) -> wgpu::Texture {
    flat_texture(&device().device, "host", (width, height), wgpu::TextureFormat::Rgba32Float, usage)
}

/// Computes `answer(input)` for each input. `body` defines `fn answer(input: vec4f) -> vec4f`; it may read the uniform
/// `u` of type `uniform_type`, in which a fog, if there is one, comes first. `include` is the library's shader file
/// under test.
pub fn evaluate(include: &str, body: &str, uniform_type: &str, uniform: &[u8], inputs: &[[f32; 4]]) -> Vec<[f32; 4]> {
    evaluate_with(include, body, uniform_type, uniform, inputs, &[])
}

/// Computes as [`evaluate`] does, by a pipeline with these `override` constants.
pub fn evaluate_with(
    include: &str,
    body: &str,
    uniform_type: &str,
    uniform: &[u8],
    inputs: &[[f32; 4]],
    constants: &[(&str, f64)],
) -> Vec<[f32; 4]> {
    let d = device();
    let height = (inputs.len() as u32).div_ceil(WIDTH);
    let mut padded = inputs.to_vec();
    padded.resize((WIDTH * height) as usize, inputs[0]);
    let source = float_texture(WIDTH, height, wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST);
    d.queue.write_texture(
        source.as_image_copy(),
        bytemuck::cast_slice(&padded),
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(WIDTH * 16), rows_per_image: None },
        source.size(),
    );
    let target = float_texture(WIDTH, height, wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC);
    let buffer = d.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        // As large as the fog's own block with the detours of its patches.
        size: uniform.len().max(size_of::<LowAirUniform>()) as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    d.queue.write_buffer(&buffer, 0, uniform);
    let layout = layout();
    let pipeline = cached(&layout, include, body, uniform_type, constants);
    let group = d.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 4, resource: buffer.as_entire_binding() },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(&source.create_view(&Default::default())),
            },
        ],
    });
    let mut encoder = d.device.create_command_encoder(&Default::default());
    pass::draw(&mut encoder, "evaluate", &pipeline, &[&group], &target.create_view(&Default::default()));
    d.submit_and_wait(encoder).expect("the pass runs");
    let mut out = readback::rgba(d, &target).expect("readback");
    out.truncate(inputs.len());
    out
}

/// Returns the pipeline of a function, compiled once for each distinct function, because compiling takes far longer
/// than drawing.
fn cached(
    layout: &wgpu::BindGroupLayout,
    include: &str,
    body: &str,
    uniform_type: &str,
    constants: &[(&str, f64)],
) -> wgpu::RenderPipeline {
    static KNOWN: Mutex<Vec<(String, wgpu::RenderPipeline)>> = Mutex::new(Vec::new());
    let key = format!("{include}\n{body}\n{uniform_type}\n{constants:?}");
    let mut known = KNOWN.lock().expect("no test panics while it compiles");
    if let Some((_, p)) = known.iter().find(|(k, _)| *k == key) {
        return p.clone();
    }
    let made = pipeline(layout, include, body, uniform_type, constants);
    known.push((key, made.clone()));
    made
}

fn layout() -> wgpu::BindGroupLayout {
    static LAYOUT: OnceLock<wgpu::BindGroupLayout> = OnceLock::new();
    LAYOUT.get_or_init(make_layout).clone()
}

fn make_layout() -> wgpu::BindGroupLayout {
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    device().device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[
            entry(
                0,
                wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
            ),
            entry(
                4,
                wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
            ),
            entry(
                1,
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
            ),
        ],
    })
}

fn pipeline(
    layout: &wgpu::BindGroupLayout,
    include: &str,
    body: &str,
    uniform_type: &str,
    constants: &[(&str, f64)],
) -> wgpu::RenderPipeline {
    let d = device();
    let library = shader::assemble(include).expect("the library's shader assembles");
    let vertex = shader::assemble("common/fullscreen.wgsl").expect("assembles");
    let text = format!(
        "{library}\n{vertex}\n@group(0) @binding(0) var<uniform> u: {uniform_type};\n\
         @group(0) @binding(1) var inputs: texture_2d<f32>;\n{body}\n\
         @fragment fn evaluate(@builtin(position) p: vec4f) -> @location(0) vec4f {{\n\
           return answer(textureLoad(inputs, vec2i(p.xy), 0));\n}}\n"
    );
    let module = d.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let stages = (fullscreen::VERTEX, "evaluate", constants);
    fullscreen::pipeline(&d.device, &module, stages, &[layout], &[wgpu::TextureFormat::Rgba32Float.into()])
}
