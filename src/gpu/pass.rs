//! Kinds of passes that effects use: a full-screen triangle with a fragment shader, quads drawn over a layer, a mesh,
//! or a compute shader.
//!
//! Tables, sky, fog and composition use full-screen passes only, so they also run on tier 0. The vertex stage of
//! full-screen passes is `common/fullscreen.wgsl`.

use std::time::Instant;

use super::{
    counts::DeviceWork,
    device::{Device, Shader},
};
use crate::error::Result;

/// Pipelines of a pass, each created when it is first needed and found by its key.
pub(crate) struct PassPipelines<K, P>(Vec<(K, P)>);

impl<K: PartialEq, P> PassPipelines<K, P> {
    pub const NONE: Self = Self(Vec::new());

    pub fn get(&self, key: &K) -> Option<&P> {
        self.0.iter().find(|(k, _)| k == key).map(|(_, made)| made)
    }

    /// Creates the pipeline for `key` if there is none yet.
    ///
    /// # Errors
    /// The errors of `make`.
    pub fn prepare(&mut self, key: K, make: impl FnOnce(&K) -> Result<P>) -> Result<()> {
        if self.get(&key).is_none() {
            let made = make(&key)?;
            self.0.push((key, made));
        }
        Ok(())
    }
}

/// Counts a pipeline whose creation began at `begun`, and logs its time.
fn count(device: &Device, (shader, entry): (&str, &str), begun: Instant) {
    device.counts.add_timed([DeviceWork::Pipelines, DeviceWork::PipelineTime], begun);
    log::debug!("pipeline {entry} of {shader}: {:.1} ms", begun.elapsed().as_secs_f64() * 1e3);
}

/// Description of a full-screen pipeline.
pub struct FullscreenDesc<'a> {
    /// Shader file below `shaders/`; it includes `common/fullscreen.wgsl`.
    pub shader: &'a str,
    /// Fragment entry point.
    pub entry: &'a str,
    /// Bind group layouts, in order.
    pub layouts: &'a [&'a wgpu::BindGroupLayout],
    /// States of the colour attachments, in order.
    pub targets: &'a [wgpu::ColorTargetState],
    /// Values of `override` constants.
    pub constants: &'a [(&'a str, f64)],
    /// Samples per pixel of the attachments.
    pub samples: u32,
}

/// Creates a full-screen pipeline.
///
/// # Errors
/// [`crate::Status::Internal`] for a missing shader file. GPU faults come through [`Device::check`].
pub fn fullscreen(device: &Device, desc: &FullscreenDesc<'_>) -> Result<wgpu::RenderPipeline> {
    fullscreen_at(device, desc, None)
}

/// Creates a pipeline as [`fullscreen`] does. With `tested`, the triangle lies at that depth in [0, 1] and is tested
/// against a depth attachment.
///
/// # Errors
/// The errors of [`fullscreen`].
pub(crate) fn fullscreen_at(
    device: &Device,
    desc: &FullscreenDesc<'_>,
    tested: Option<(f64, wgpu::DepthStencilState)>,
) -> Result<wgpu::RenderPipeline> {
    let begun = Instant::now();
    let Shader { module, overrides } = device.shader_and_overrides(desc.shader)?;
    // A variant lacks the constants of the code that it leaves out. In a whole shader a missing constant is a fault.
    let is_whole = !desc.shader.contains(':');
    let constants: Vec<_> =
        desc.constants.iter().copied().filter(|(name, _)| is_whole || overrides.iter().any(|o| o == name)).collect();
    let groups: Vec<_> = desc.layouts.iter().map(|l| Some(*l)).collect();
    let layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(desc.shader),
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    let compilation_options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
    let at = tested.as_ref().map(|(depth, _)| ("FULLSCREEN_DEPTH", *depth));
    let vertex_constants = at.as_slice();
    let targets: Vec<_> = desc.targets.iter().cloned().map(|t| Some(compiled_once(device, t))).collect();
    let pipeline = device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(desc.entry),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("fullscreen_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions { constants: vertex_constants, ..Default::default() },
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: tested.map(|(_, test)| test),
        multisample: wgpu::MultisampleState { count: desc.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(desc.entry),
            compilation_options,
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    });
    count(device, (desc.shader, desc.entry), begun);
    Ok(pipeline)
}

/// Returns the state for a test against a depth attachment. `write` says whether the draw also writes its depth there.
pub(crate) fn depth_test(
    format: wgpu::TextureFormat,
    compare: wgpu::CompareFunction,
    write: bool,
) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(write),
        depth_compare: Some(compare),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

/// Returns a target whose pipeline llvmpipe compiles once instead of twice. Unless the target blends, llvmpipe compiles
/// a second version of the shader for blocks of pixels that a triangle covers wholly. A blend that replaces the
/// target's values draws the same picture. For other drivers, and for a format that cannot blend, `target` is returned
/// as it is.
pub(crate) fn compiled_once(device: &Device, target: wgpu::ColorTargetState) -> wgpu::ColorTargetState {
    let features = target.format.guaranteed_format_features(device.device.features()).flags;
    let can = device.caps().software && features.contains(wgpu::TextureFormatFeatureFlags::BLENDABLE);
    match target.blend {
        None if can && !target.write_mask.is_empty() => {
            wgpu::ColorTargetState { blend: Some(wgpu::BlendState::REPLACE), ..target }
        }
        _ => target,
    }
}

/// Description of a pipeline of quads: a triangle strip of four corners per instance, premultiplied and blended over
/// the target.
pub struct QuadsDesc<'a> {
    /// Name in captures.
    pub label: &'a str,
    /// Module and entry point of the vertex stage, and values of its `override` constants.
    pub vertex: (&'a wgpu::ShaderModule, &'a str, &'a [(&'a str, f64)]),
    /// Module and entry point of the fragment stage, and values of its `override` constants.
    pub fragment: (&'a wgpu::ShaderModule, &'a str, &'a [(&'a str, f64)]),
    /// Bind group layouts, in order.
    pub layouts: &'a [Option<&'a wgpu::BindGroupLayout>],
    /// Layouts of the per-instance vertex buffers.
    pub buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    /// Format of the layer, which has one sample per pixel.
    pub format: wgpu::TextureFormat,
    /// Whether to count how often each pixel is drawn, instead of running `fragment`.
    pub counts: bool,
}

/// Creates a pipeline of quads.
///
/// # Errors
/// The errors of [`fullscreen`].
pub fn quads(device: &Device, desc: &QuadsDesc<'_>) -> Result<wgpu::RenderPipeline> {
    let begun = Instant::now();
    let counting = desc.counts.then(|| device.shader("common/count.wgsl")).transpose()?;
    let fragment = counting.as_ref().map_or(desc.fragment, |module| (module, "count", &[]));
    let layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(desc.label),
        bind_group_layouts: desc.layouts,
        immediate_size: 0,
    });
    let options = |constants| wgpu::PipelineCompilationOptions { constants, ..Default::default() };
    let pipeline = device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(desc.label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: desc.vertex.0,
            entry_point: Some(desc.vertex.1),
            compilation_options: options(desc.vertex.2),
            buffers: desc.buffers,
        },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: fragment.0,
            entry_point: Some(fragment.1),
            compilation_options: options(fragment.2),
            targets: &[Some(wgpu::ColorTargetState {
                format: desc.format,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    });
    count(device, (desc.label, desc.vertex.1), begun);
    Ok(pipeline)
}

/// Description of a mesh pipeline: triangles from a vertex buffer, which replace what the target holds.
pub(crate) struct MeshDesc<'a> {
    /// Shader file below `shaders/`.
    pub shader: &'a str,
    /// Entry point of the vertex stage.
    pub vertex: &'a str,
    /// Entry point of the fragment stage.
    pub fragment: &'a str,
    /// Bind group layouts, in order.
    pub layouts: &'a [Option<&'a wgpu::BindGroupLayout>],
    /// Layout of the vertex buffer.
    pub vertices: wgpu::VertexBufferLayout<'a>,
    /// Format of the target, which has one sample per pixel.
    pub format: wgpu::TextureFormat,
}

/// Creates a mesh pipeline.
///
/// # Errors
/// The errors of [`fullscreen`].
pub(crate) fn mesh(device: &Device, desc: &MeshDesc<'_>) -> Result<wgpu::RenderPipeline> {
    let begun = Instant::now();
    let module = device.shader(desc.shader)?;
    let layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(desc.shader),
        bind_group_layouts: desc.layouts,
        immediate_size: 0,
    });
    let pipeline = device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(desc.shader),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(desc.vertex),
            compilation_options: Default::default(),
            buffers: &[Some(desc.vertices.clone())],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(desc.fragment),
            compilation_options: Default::default(),
            targets: &[Some(desc.format.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    count(device, (desc.shader, desc.fragment), begun);
    Ok(pipeline)
}

/// Description of a compute pipeline.
pub(crate) struct ComputeDesc<'a> {
    /// Shader file below `shaders/`.
    pub shader: &'a str,
    /// Entry point.
    pub entry: &'a str,
    /// Bind group layouts, in order; `None` for a group that the shader does not use.
    pub layouts: &'a [Option<&'a wgpu::BindGroupLayout>],
    /// Values of `override` constants.
    pub constants: &'a [(&'a str, f64)],
}

/// Creates a compute pipeline.
///
/// # Errors
/// The errors of [`fullscreen`].
pub(crate) fn compute(device: &Device, desc: &ComputeDesc<'_>) -> Result<wgpu::ComputePipeline> {
    let begun = Instant::now();
    let module = device.shader(desc.shader)?;
    let layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(desc.entry),
        bind_group_layouts: desc.layouts,
        immediate_size: 0,
    });
    let pipeline = device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(desc.entry),
        layout: Some(&layout),
        module: &module,
        entry_point: Some(desc.entry),
        compilation_options: wgpu::PipelineCompilationOptions { constants: desc.constants, ..Default::default() },
        cache: None,
    });
    count(device, (desc.shader, desc.entry), begun);
    Ok(pipeline)
}

/// Draws a full-screen triangle with `pipeline` into `target`, without clearing it.
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
