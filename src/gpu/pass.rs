//! The one kind of pass that most effects are: a full-screen triangle with a fragment shader.
//!
//! Tables, sky, fog and composition are all built of it, so they run on tier 0 as well. The vertex stage is
//! `common/fullscreen.wgsl`.

use super::Device;
use crate::error::Result;

/// What a full-screen pipeline is made of.
pub struct FullscreenDesc<'a> {
    /// Shader file below `shaders/`; it includes `common/fullscreen.wgsl`.
    pub shader: &'a str,
    /// Fragment entry point.
    pub entry: &'a str,
    /// One layout a bind group, in order.
    pub layouts: &'a [&'a wgpu::BindGroupLayout],
    /// One state a colour attachment.
    pub targets: &'a [wgpu::ColorTargetState],
    /// Values of `override` constants.
    pub constants: &'a [(&'a str, f64)],
    /// Samples of the attachments.
    pub samples: u32,
}

/// Makes the pipeline.
///
/// # Errors
/// A missing shader file; GPU faults come through [`Device::check`].
pub fn fullscreen(device: &Device, desc: &FullscreenDesc<'_>) -> Result<wgpu::RenderPipeline> {
    let module = device.shader(desc.shader)?;
    let groups: Vec<_> = desc.layouts.iter().map(|l| Some(*l)).collect();
    let layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(desc.shader),
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    let compilation_options = wgpu::PipelineCompilationOptions { constants: desc.constants, ..Default::default() };
    let targets: Vec<_> = desc.targets.iter().cloned().map(Some).collect();
    Ok(device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(desc.entry),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("fullscreen_vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState { count: desc.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(desc.entry),
            compilation_options,
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    }))
}

/// Draws a full-screen triangle with `pipeline` into `target`, clearing nothing.
pub fn draw(
    encoder: &mut wgpu::CommandEncoder,
    label: &str,
    pipeline: &wgpu::RenderPipeline,
    groups: &[&wgpu::BindGroup],
    target: &wgpu::TextureView,
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    for (i, group) in groups.iter().enumerate() {
        pass.set_bind_group(i as u32, *group, &[]);
    }
    pass.draw(0..3, 0..1);
}
