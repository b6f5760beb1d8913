//! An opaque effect for tests: a level checkerboard of two luminances, at a given height in the host's flat world.

use std::sync::Arc;

use glam::{DMat4, DVec3};

use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        shader,
    },
    stage::{DrawContext, DrawnEffect, FrameContext, OpaqueDraw, OpaqueTarget, Outputs, Stages},
};

/// Half the side of the plane, which is centred below the camera, m.
pub(crate) const HALF_SIZE_M: f64 = 400.0;
/// Side of the plane's squares, m.
pub(crate) const SQUARE_M: f64 = 8.0;
/// Luminances of the plane's squares, cd/m^2.
pub(crate) const CD_M2: [f64; 2] = [3000.0, 500.0];

const SHADER: &str = "
struct Plane {
    clip: mat4x4f,
    // Height relative to the camera, half size, and the camera's position in the pattern of squares.
    height: f32,
    half_size: f32,
    origin: vec2f,
}
@group(1) @binding(0) var<uniform> plane: Plane;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) place: vec2f,
}

@vertex fn corner(@builtin(vertex_index) i: u32) -> Varying {
    let at = (vec2f(f32(i & 1u), f32(i >> 1u)) * 2.0 - 1.0) * plane.half_size;
    return Varying(plane.clip * vec4f(at, plane.height, 1.0), at + plane.origin);
}

fn shown(in: Varying) -> vec4f {
    if is_kept(in.position.xy) {
        discard;
    }
    let square = vec2i(floor(in.place / SQUARE));
    let odd = ((square.x + square.y) & 1) == 1;
    return vec4f(host_number(vec3f(select(BRIGHT, DARK, odd))), 1.0);
}

@fragment fn plain(in: Varying) -> @location(0) vec4f {
    return shown(in);
}

struct WithDepth {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment fn logarithmic(in: Varying) -> WithDepth {
    return WithDepth(shown(in), written_depth(frame.depth, 1.0 / in.position.w));
}
";

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct PlaneUniform {
    clip: [f32; 16],
    height: f32,
    half_size: f32,
    origin: [f32; 2],
}

/// State of the plane in a view; nothing is drawn unless a test sets its height.
#[derive(Default)]
pub(crate) struct PlaneView {
    /// Height of the plane over the world's origin, m.
    pub height_m: Option<f64>,
    eye: DVec3,
    made: Option<PlaneResources>,
}

struct PlaneResources {
    target: OpaqueTarget,
    pipeline: wgpu::RenderPipeline,
    buffer: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl PlaneView {
    fn uniform(&self, height_m: f64, clip: DMat4) -> PlaneUniform {
        let among = |v: f64| v.rem_euclid(2.0 * SQUARE_M) as f32;
        PlaneUniform {
            clip: clip.as_mat4().to_cols_array(),
            height: (height_m - self.eye.z) as f32,
            half_size: HALF_SIZE_M as f32,
            origin: [among(self.eye.x), among(self.eye.y)],
        }
    }
}

impl PlaneResources {
    fn new(device: &Arc<Device>, opaque: &OpaqueDraw<'_>) -> Result<Self> {
        let constants = [("SQUARE", SQUARE_M), ("BRIGHT", CD_M2[0]), ("DARK", CD_M2[1])];
        let constants: String = constants.iter().map(|(name, v)| format!("const {name}: f32 = {v:?};\n")).collect();
        let text = format!("{}{constants}{SHADER}", shader::assemble("common/opaque.wgsl")?);
        let device = &device.device;
        let source = wgpu::ShaderSource::Wgsl(text.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("plane"), source });
        let slots = [(0, Slot::Uniform(size_of::<PlaneUniform>()))];
        let layout = bind::layout(device, "plane", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("plane"),
            bind_group_layouts: &[Some(opaque.layout), Some(&layout)],
            immediate_size: 0,
        });
        let target = opaque.target;
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("plane"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
            depth_stencil: Some(target.depth_test()),
            multisample: wgpu::MultisampleState { count: target.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(if target.logarithmic { "logarithmic" } else { "plain" }),
                compilation_options: Default::default(),
                targets: &[Some(target.color_target())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let buffer = bind::block(device, "plane", size_of::<PlaneUniform>());
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("plane"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        Ok(Self { target, pipeline, buffer, group })
    }
}

impl DrawnEffect for PlaneView {
    fn gather(&mut self, context: &FrameContext<'_>, _given: &mut Outputs) -> Result<()> {
        self.eye = context.now.eye;
        Ok(())
    }

    fn stages(&self) -> Stages {
        Stages(0)
    }

    fn has_opaque(&self) -> bool {
        self.height_m.is_some()
    }

    fn draw_opaque(
        &mut self,
        context: &DrawContext<'_>,
        opaque: &OpaqueDraw<'_>,
        pass: &mut wgpu::RenderPass<'_>,
    ) -> Result<()> {
        let Some(height_m) = self.height_m else { return Ok(()) };
        let block = self.uniform(height_m, opaque.clip);
        let made = match self.made.take() {
            Some(made) if made.target == opaque.target => made,
            _ => PlaneResources::new(context.device, opaque)?,
        };
        context.device.queue.write_buffer(&made.buffer, 0, bytemuck::bytes_of(&block));
        pass.set_pipeline(&made.pipeline);
        pass.set_bind_group(1, &made.group, &[]);
        pass.draw(0..4, 0..1);
        self.made = Some(made);
        Ok(())
    }
}
