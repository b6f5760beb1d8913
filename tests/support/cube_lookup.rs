//! A host's own shader that looks up a cube map by direction.

use std::sync::Arc;

use welkin::gpu::{Device, readback};

/// Draws the centres of all texels of a level, the six faces side by side.
const SHADER: &str = "
@group(0) @binding(0) var cube: texture_cube<f32>;
@group(0) @binding(1) var nearest: sampler;
override SIZE: f32;
override LEVEL: f32;

@vertex
fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32((i << 1u) & 2u) * 2.0 - 1.0, 1.0 - f32(i & 2u) * 2.0, 0.0, 1.0);
}

@fragment
fn look(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let face = u32(at.x / SIZE);
    let s = 2.0 * (at.x / SIZE - f32(face)) - 1.0;
    let t = 2.0 * at.y / SIZE - 1.0;
    var d: vec3f;
    switch face {
        case 0u: { d = vec3f(1.0, -t, -s); }
        case 1u: { d = vec3f(-1.0, -t, s); }
        case 2u: { d = vec3f(s, 1.0, t); }
        case 3u: { d = vec3f(s, -1.0, -t); }
        case 4u: { d = vec3f(s, -t, 1.0); }
        default: { d = vec3f(-s, -t, -1.0); }
    }
    return textureSampleLevel(cube, nearest, d, LEVEL);
}";

/// Texels of a level: `size` rows of the six faces.
pub fn faces(device: &Arc<Device>, cube: &wgpu::Texture, size: u32, level: u32) -> Vec<[f32; 4]> {
    let gpu = &device.device;
    let target = crate::textures::texture(device, (6 * size, size), wgpu::TextureFormat::Rgba16Float, 1);
    let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let constants = [("SIZE", f64::from(size)), ("LEVEL", f64::from(level))];
    let pipeline = gpu.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("look"),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            targets: &[Some(target.format().into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let view = cube.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::Cube),
        ..Default::default()
    });
    let nearest = gpu.create_sampler(&Default::default());
    let group = gpu.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&nearest) },
        ],
    });
    let mut encoder = gpu.create_command_encoder(&Default::default());
    let attached = target.create_view(&Default::default());
    welkin::gpu::pass::draw(&mut encoder, "look up", &pipeline, &[&group], &attached);
    device.submit_and_wait(encoder).unwrap();
    readback::rgba(device, &target).unwrap()
}
