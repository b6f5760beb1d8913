//! Work that makes wgpu's backend change at least as much of OpenGL's state as Welkin does.

use welkin::gpu::gl::{GlDevice, GlTarget};

const SHADER: &str = r"
struct Out { @builtin(position) at: vec4f, @location(0) @interpolate(flat) number: u32 }
struct Numbers { a: vec4f, b: vec4f }
@group(0) @binding(0) var<uniform> numbers: Numbers;
@group(0) @binding(1) var image: texture_2d<f32>;
@group(0) @binding(2) var look: sampler;
@group(0) @binding(3) var volume: texture_3d<f32>;
@group(0) @binding(4) var layers: texture_2d_array<f32>;
@vertex fn bright_corner(@builtin(vertex_index) i: u32) -> Out {
    return Out(vec4f(f32((i & 1u) * 4u) - 1.0, f32((i >> 1u) * 4u) - 1.0, 0.5, 1.0), i);
}
@fragment fn bright(in: Out) -> @location(0) vec4f {
    return vec4f(2.5, -1.5, f32(in.number), 1.0);
}
@vertex fn corner(@location(0) place: vec2f, @location(1) shift: vec2f, @builtin(instance_index) i: u32) -> Out {
    return Out(vec4f(place + shift * 0.1, 0.5, 1.0), i);
}
struct Colors { @location(0) first: vec4f, @location(1) second: vec4f }
@fragment fn shade(in: Out) -> Colors {
    let uv = in.at.xy / 16.0;
    let c = textureSample(image, look, uv) + textureSampleLevel(volume, look, vec3f(uv, 0.5), 0.0)
        + textureLoad(layers, vec2i(in.at.xy) % 4, 1, 0) + numbers.a + numbers.b * f32(in.number);
    return Colors(c, c.bgra);
}
";
const COMPUTE: &str = r"
@group(0) @binding(0) var<storage, read_write> list: array<u32>;
@group(0) @binding(1) var out: texture_storage_2d<rgba16float, write>;
@compute @workgroup_size(8, 8) fn fill(@builtin(global_invocation_id) id: vec3u) {
    list[id.y * 16u + id.x] = id.x * 100u + id.y;
    textureStore(out, id.xy, vec4f(vec2f(id.xy), 1.0, 1.0));
}
";

fn texture(device: &wgpu::Device, format: wgpu::TextureFormat, layers: u32, volume: bool) -> wgpu::Texture {
    use wgpu::TextureUsages as U;
    let depth = format.is_depth_stencil_format();
    let mut usage = U::TEXTURE_BINDING | U::COPY_DST | U::COPY_SRC;
    if depth {
        usage = U::RENDER_ATTACHMENT | U::TEXTURE_BINDING;
    } else if !volume {
        usage |= U::RENDER_ATTACHMENT;
    }
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("exercise"),
        size: wgpu::Extent3d { width: 16, height: 16, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: if volume { wgpu::TextureDimension::D3 } else { wgpu::TextureDimension::D2 },
        format,
        usage,
        view_formats: &[],
    })
}

/// Draws, uploads, copies, computes and reads back; checks the numbers that come back.
pub fn run(adopted: &GlDevice, target: &GlTarget) {
    draw(adopted);
    bright(adopted);
    if adopted.device.caps().tier > 0 {
        compute(adopted);
    }
    // An imported texture can be copied like any other.
    let source = &target.color;
    if source.usage().contains(wgpu::TextureUsages::COPY_SRC) {
        let copy = adopted.device.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: source.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: source.format(),
            usage: wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let mut encoder = adopted.device.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_texture(source.as_image_copy(), copy.as_image_copy(), source.size());
        adopted.device.queue.submit([encoder.finish()]);
    }
}

/// Draws with numbers outside of [0, 1], with a flat number that one corner gives to the whole triangle, and into a
/// target that is never read.
fn bright(adopted: &GlDevice) {
    let device = &adopted.device.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let format = wgpu::TextureFormat::Rgba16Float;
    let target = |usage| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: 16, height: 16, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    };
    let read = target(wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC);
    let never_read = target(wgpu::TextureUsages::RENDER_ATTACHMENT);
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("bright_corner"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("bright"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    for texture in [&never_read, &read] {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &texture.create_view(&Default::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.draw(0..3, 0..1);
    }
    adopted.device.queue.submit([encoder.finish()]);
    let texel: Vec<f32> = read_back(adopted, &read)[..8]
        .chunks_exact(2)
        .map(|b| half::f16::from_le_bytes([b[0], b[1]]).to_f32())
        .collect();
    assert_eq!(texel, [2.5, -1.5, 2.0, 1.0], "nothing is clamped, and the last corner gives its number");
}

fn draw(adopted: &GlDevice) {
    let (device, queue) = (&adopted.device.device, &adopted.device.queue);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("exercise"),
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let [first, second, image] = [0, 1, 2].map(|_| texture(device, format, 1, false));
    let (volume, layers) = (texture(device, format, 4, true), texture(device, format, 3, false));
    let depth = texture(device, wgpu::TextureFormat::Depth24PlusStencil8, 1, false);
    queue.write_texture(
        image.as_image_copy(),
        &[200; 16 * 16 * 4],
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(64), rows_per_image: None },
        image.size(),
    );
    let buffer = |usage, bytes: &[u8]| {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("exercise"),
            size: bytes.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&buffer, 0, bytes);
        buffer
    };
    let places: Vec<u8> = [-1.0f32, -1.0, 3.0, -1.0, -1.0, 3.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let vertices = buffer(wgpu::BufferUsages::VERTEX, &places);
    let shifts = buffer(wgpu::BufferUsages::VERTEX, &[0; 16]);
    let elements = buffer(wgpu::BufferUsages::INDEX, &[0, 0, 1, 0, 2, 0, 0, 0]);
    let numbers = buffer(wgpu::BufferUsages::UNIFORM, &[0; 32]);
    let blend = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::Constant,
        dst_factor: wgpu::BlendFactor::OneMinusConstant,
        operation: wgpu::BlendOperation::ReverseSubtract,
    };
    let attribute =
        |shader_location| wgpu::VertexAttribute { format: wgpu::VertexFormat::Float32x2, offset: 0, shader_location };
    let (per_vertex, per_instance) = ([attribute(0)], [attribute(1)]);
    let layout = |step_mode, attributes| wgpu::VertexBufferLayout { array_stride: 8, step_mode, attributes };
    let face = wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Always,
        fail_op: wgpu::StencilOperation::Invert,
        depth_fail_op: wgpu::StencilOperation::Zero,
        pass_op: wgpu::StencilOperation::IncrementWrap,
    };
    let state = wgpu::ColorTargetState {
        format,
        blend: Some(wgpu::BlendState { color: blend, alpha: blend }),
        write_mask: wgpu::ColorWrites::RED | wgpu::ColorWrites::ALPHA,
    };
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("exercise"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: Default::default(),
            buffers: &[
                Some(layout(wgpu::VertexStepMode::Vertex, &per_vertex)),
                Some(layout(wgpu::VertexStepMode::Instance, &per_instance)),
            ],
        },
        primitive: wgpu::PrimitiveState {
            front_face: wgpu::FrontFace::Cw,
            cull_mode: Some(wgpu::Face::Front),
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: depth.format(),
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: wgpu::StencilState { front: face, back: face, read_mask: 0x33, write_mask: 0x77 },
            bias: wgpu::DepthBiasState { constant: 4, slope_scale: 2.0, clamp: 0.0 },
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("shade"),
            compilation_options: Default::default(),
            targets: &[Some(state.clone()), Some(state)],
        }),
        multiview_mask: None,
        cache: None,
    });
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    let views = [
        image.create_view(&Default::default()),
        volume.create_view(&Default::default()),
        layers.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        }),
    ];
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            entry(0, numbers.as_entire_binding()),
            entry(1, wgpu::BindingResource::TextureView(&views[0])),
            entry(2, wgpu::BindingResource::Sampler(&sampler)),
            entry(3, wgpu::BindingResource::TextureView(&views[1])),
            entry(4, wgpu::BindingResource::TextureView(&views[2])),
        ],
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("exercise") });
    let attachments = [&first, &second].map(|t| t.create_view(&Default::default()));
    let color = |view| {
        let load = wgpu::LoadOp::Clear(wgpu::Color { r: 0.5, g: 0.25, b: 0.75, a: 1.0 });
        let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
        Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
    };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("exercise"),
        color_attachments: &[color(&attachments[0]), color(&attachments[1])],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth.create_view(&Default::default()),
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(9), store: wgpu::StoreOp::Discard }),
        }),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.set_vertex_buffer(0, vertices.slice(..));
    pass.set_vertex_buffer(1, shifts.slice(..));
    pass.set_index_buffer(elements.slice(..), wgpu::IndexFormat::Uint16);
    pass.set_blend_constant(wgpu::Color { r: 0.3, g: 0.4, b: 0.5, a: 0.6 });
    pass.set_stencil_reference(0x42);
    pass.set_viewport(2.0, 3.0, 9.0, 8.0, 0.25, 0.75);
    pass.set_scissor_rect(1, 1, 12, 13);
    pass.draw_indexed(0..3, 0, 0..2);
    pass.draw(0..3, 0..1);
    drop(pass);
    encoder.copy_texture_to_texture(first.as_image_copy(), second.as_image_copy(), first.size());
    queue.submit([encoder.finish()]);
    let texels = read_back(adopted, &second);
    // Outside of the scissor is the clear colour: exactly the requested one, whatever the host's clamps and scales are.
    assert_eq!(texels[..4], [128, 64, 191, 255], "the clear colour");
}

/// The bytes of a 16 x 16 texture with 4 bytes a texel.
fn read_back(adopted: &GlDevice, texture: &wgpu::Texture) -> Vec<u8> {
    let buffer = adopted.device.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 256 * 16,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = adopted.device.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(256), rows_per_image: None },
        },
        texture.size(),
    );
    adopted.device.queue.submit([encoder.finish()]);
    mapped(adopted, &buffer)
}

fn mapped(adopted: &GlDevice, buffer: &wgpu::Buffer) -> Vec<u8> {
    buffer.map_async(wgpu::MapMode::Read, .., |r| r.unwrap());
    adopted.device.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = buffer.get_mapped_range(..).unwrap().to_vec();
    buffer.unmap();
    bytes
}

fn compute(adopted: &GlDevice) {
    let device = &adopted.device.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(COMPUTE.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let buffer = |usage| {
        device.create_buffer(&wgpu::BufferDescriptor { label: None, size: 1024, usage, mapped_at_creation: false })
    };
    let list = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let back = buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
    let out = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 16, height: 16, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::STORAGE_BINDING,
        view_formats: &[],
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: list.as_entire_binding() },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(&out.create_view(&Default::default())),
            },
        ],
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(2, 2, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&list, 0, &back, 0, 1024);
    adopted.device.queue.submit([encoder.finish()]);
    let bytes = mapped(adopted, &back);
    assert_eq!(bytes[4 * (3 * 16 + 2)..][..4], 203u32.to_le_bytes(), "computed numbers");
}
