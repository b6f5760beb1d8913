//! An opaque object drawn into a host's colour and depth.

/// A triangle strip whose shader sets its position and its colour.
pub struct Opaque {
    /// WGSL with one vertex and one fragment entry point.
    pub shader: &'static str,
    pub vertices: u32,
    /// Comparison with the existing depth; passing depths are written.
    pub passes: wgpu::CompareFunction,
}

/// Records the draw over the contents of `color` and `depth`, with any number of samples.
pub fn draw_opaque(
    device: &wgpu::Device,
    opaque: &Opaque,
    color: &wgpu::Texture,
    depth: &wgpu::Texture,
) -> wgpu::CommandEncoder {
    let source = wgpu::ShaderSource::Wgsl(opaque.shader.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: depth.format(),
            depth_write_enabled: Some(true),
            depth_compare: Some(opaque.passes),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: color.sample_count(), ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(color.format().into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let (target, tested) = (color.create_view(&Default::default()), depth.create_view(&Default::default()));
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &tested,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.draw(0..opaque.vertices, 0..1);
    drop(pass);
    encoder
}
