//! Full-screen pipelines for the shaders of the lab, benchmarks and tests. The library creates its own pipelines by
//! file name.

/// Creates a pipeline from a module's entry points: the vertex stage, and the fragment stage with the values of its
/// constants.
pub fn pipeline(
    gpu: &wgpu::Device,
    module: &wgpu::ShaderModule,
    (vertex, fragment, constants): (&str, &str, &[(&str, f64)]),
    layouts: &[&wgpu::BindGroupLayout],
    targets: &[wgpu::ColorTargetState],
) -> wgpu::RenderPipeline {
    let groups: Vec<_> = layouts.iter().map(|layout| Some(*layout)).collect();
    let targets: Vec<_> = targets.iter().cloned().map(Some).collect();
    let layout = gpu.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    gpu.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The vertex stage of `common/fullscreen.wgsl`.
pub const VERTEX: &str = "fullscreen_vertex";
