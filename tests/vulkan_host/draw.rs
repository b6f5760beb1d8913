//! Small passes that stand for Welkin's effects: they read the host's depth and write its colour.

use welkin::gpu::vulkan::{HandOver, HostImage, ImageRole, VulkanHost};

const SHADER: &str = "
@group(0) @binding(0) var depth: texture_2d<f32>;
@vertex fn cover(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn from_depth(@builtin(position) p: vec4f) -> @location(0) vec4f {
    return vec4f(textureLoad(depth, vec2i(p.xy), 0).r, 1.0, 0.0, 0.0);
}
@fragment fn green() -> @location(0) vec4f { return vec4f(0.0, 1.0, 0.0, 0.0); }
";

/// Writes the depth to red and 1 to green; blue and alpha stay as the host left them.
pub fn red_from_depth(
    welkin: &VulkanHost,
    colour: &HostImage,
    depth: &HostImage,
    over: &HandOver<'_>,
) -> welkin::Result<()> {
    // SAFETY: the images are described truly.
    let (target, depths) = unsafe {
        let target = welkin.import("colour", colour, ImageRole::Colour)?;
        (target, welkin.import("depth", depth, ImageRole::Depth)?)
    };
    let layout = welkin.device.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: false },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        }],
    });
    let only_depth = depths
        .create_view(&wgpu::TextureViewDescriptor { aspect: wgpu::TextureAspect::DepthOnly, ..Default::default() });
    let group = welkin.device.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&only_depth) }],
    });
    let encoder = pass(welkin, &target, "from_depth", Some((&layout, &group)));
    let images = [(*colour, ImageRole::Colour, &target), (*depth, ImageRole::Depth, &depths)];
    // SAFETY: the images are described truly, the semaphores live; these tests keep to the queue contract.
    unsafe { welkin.submit(encoder, &HandOver { images: &images, ..*over }) }
}

/// Writes 1 to green; the other channels stay.
pub fn green(welkin: &VulkanHost, colour: &HostImage) -> welkin::Result<()> {
    // SAFETY: the image is described truly.
    let target = unsafe { welkin.import("colour", colour, ImageRole::Colour)? };
    let encoder = pass(welkin, &target, "green", None);
    let images = [(*colour, ImageRole::Colour, &target)];
    // SAFETY: as above.
    unsafe { welkin.submit(encoder, &HandOver { images: &images, ..HandOver::default() }) }
}

fn pass(
    welkin: &VulkanHost,
    target: &wgpu::Texture,
    entry: &str,
    group: Option<(&wgpu::BindGroupLayout, &wgpu::BindGroup)>,
) -> wgpu::CommandEncoder {
    let device = &welkin.device.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let groups: Vec<_> = group.iter().map(|g| Some(g.0)).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    let red_green =
        wgpu::ColorWrites::GREEN | if group.is_some() { wgpu::ColorWrites::RED } else { wgpu::ColorWrites::empty() };
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState { count: target.sample_count(), ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState { format: target.format(), blend: None, write_mask: red_green })],
        }),
        multiview_mask: None,
        cache: None,
    });
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    if let Some((_, group)) = group {
        pass.set_bind_group(0, group, &[]);
    }
    pass.draw(0..3, 0..1);
    drop(pass);
    encoder
}

/// Copies the colour, as effects that read it do: the image's last use is as the source of a copy.
pub fn copy(welkin: &VulkanHost, colour: &HostImage) -> welkin::Result<()> {
    // SAFETY: the image is described truly.
    let source = unsafe { welkin.import("colour", colour, ImageRole::Colour)? };
    let copy = welkin.device.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: source.size(),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: source.format(),
        usage: wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let mut encoder = welkin.device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_texture(source.as_image_copy(), copy.as_image_copy(), source.size());
    let images = [(*colour, ImageRole::Colour, &source)];
    // SAFETY: as above.
    unsafe { welkin.submit(encoder, &HandOver { images: &images, ..HandOver::default() }) }
}
