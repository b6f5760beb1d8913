//! GPU resources of the tables over the planet: textures, layouts and pipelines. Every pass is a full-screen fragment
//! pass into rgba16float, so that the same code runs on every kind of device.

use std::sync::Arc;

use bytemuck::bytes_of;
use wgpu::util::DeviceExt as _;

use super::recipe::{Name, Pass, PassKind};
use super::settings::SkySettings;
use super::uniforms::{DimsUniform, JobUniform};
use crate::error::Result;
use crate::gpu::Device;
use crate::gpu::bind::{self, Slot};
use crate::gpu::counts::DeviceWork;
use crate::gpu::pass::{FullscreenDesc, fullscreen};

/// Format of every table.
pub(crate) const TABLE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// A table: its texture, and a view of all of it.
pub(crate) struct SkyTable {
    pub texture: wgpu::Texture,
    pub view: wgpu::TextureView,
}

impl SkyTable {
    pub fn new(device: &Device, label: &str, (width, height): (u32, u32)) -> Self {
        let texture = table_texture(device, label, (width, height), 1);
        let view = texture.create_view(&Default::default());
        Self { texture, view }
    }
}

/// Creates a texture that passes draw into, that look-ups read, and that is copied for the cache and for queries.
pub(crate) fn table_texture(device: &Device, label: &str, size: (u32, u32), layers: u32) -> wgpu::Texture {
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TABLE_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Creates a uniform buffer with contents.
pub(crate) fn uniform_buffer(device: &Device, label: &str, contents: &[u8]) -> wgpu::Buffer {
    device.counts.add(DeviceWork::UploadBytes, contents.len() as u64);
    device.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some(label),
        contents,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
    })
}

/// Creates a layout of `slots`, numbered from 0.
pub(crate) fn layout(device: &Device, label: &str, slots: &[Slot]) -> wgpu::BindGroupLayout {
    let numbered: Vec<_> = (0..).zip(slots.iter().copied()).collect();
    bind::layout(&device.device, label, wgpu::ShaderStages::FRAGMENT, &numbered)
}

/// Creates a bind group of `resources`, numbered from 0.
pub(crate) fn bind(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = resources
        .iter()
        .enumerate()
        .map(|(i, resource)| wgpu::BindGroupEntry { binding: i as u32, resource: resource.clone() })
        .collect();
    device.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

/// Resource that binds a texture view.
pub(crate) fn tex(view: &wgpu::TextureView) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::TextureView(view)
}

/// Creates the linear sampler of all tables.
pub(crate) fn linear_sampler(device: &Device) -> wgpu::Sampler {
    device.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("sky tables"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    })
}

/// Pipelines, layouts and sampler that all builds with the same [`SkySettings`] share.
pub(crate) struct Builder {
    shared_layout: wgpu::BindGroupLayout,
    tables_layout: wgpu::BindGroupLayout,
    pipelines: Vec<(PassKind, wgpu::RenderPipeline)>,
    pub sampler: wgpu::Sampler,
}

/// Buffers that all builds of one detail share: table sizes, directions to sum over, and the job of each pass (its
/// scattering order, and whether the orders after it are added as a geometric series).
pub(crate) struct BuildBuffers {
    pub dims: wgpu::Buffer,
    rule: wgpu::Buffer,
    jobs: wgpu::Buffer,
    job_stride: u32,
}

impl BuildBuffers {
    pub fn new(device: &Device, settings: &SkySettings, passes: &[Pass]) -> Self {
        let job_stride = device.device.limits().min_uniform_buffer_offset_alignment.max(16);
        let mut jobs = vec![0; job_stride as usize * passes.len()];
        for (i, pass) in passes.iter().enumerate() {
            let job = JobUniform { order: pass.order, last: pass.last.into(), unused: [0; 2] };
            let at = job_stride as usize * i;
            jobs[at..at + 16].copy_from_slice(bytes_of(&job));
        }
        Self {
            dims: uniform_buffer(device, "sky dims", bytes_of(&DimsUniform::of(settings))),
            rule: uniform_buffer(device, "sky rule", bytemuck::cast_slice(&rule(settings))),
            jobs: uniform_buffer(device, "sky jobs", &jobs),
            job_stride,
        }
    }

    /// Offset of pass `index` in the buffer of jobs.
    pub fn job_offset(&self, index: usize) -> u32 {
        self.job_stride * index as u32
    }
}

impl Builder {
    pub fn new(device: &Arc<Device>, settings: &SkySettings, passes: &[Pass]) -> Result<Self> {
        let block = Slot::Uniform(0);
        let shared = [block, block, block, Slot::Sampler, Slot::DynamicUniform(0)];
        let shared_layout = layout(device, "sky build", &shared);
        let tables_layout = layout(device, "sky build tables", &[Slot::Filtered; 6]);
        let mut pipelines: Vec<(PassKind, wgpu::RenderPipeline)> = Vec::new();
        for pass in passes {
            if pipelines.iter().all(|(k, _)| *k != pass.kind) {
                let layouts = [&shared_layout, &tables_layout];
                pipelines.push((pass.kind, pipeline(device, settings, pass, &layouts)?));
            }
        }
        Ok(Self { pipelines, sampler: linear_sampler(device), shared_layout, tables_layout })
    }

    /// Pipeline of a kind that was among the passes given to `new`.
    pub fn pipeline(&self, kind: PassKind) -> Option<&wgpu::RenderPipeline> {
        self.pipelines.iter().find(|(k, _)| *k == kind).map(|(_, p)| p)
    }

    /// Bind group of the uniforms and the sampler of a build, for one air.
    pub fn shared_group(&self, device: &Device, blocks: &BuildBuffers, air: &wgpu::Buffer) -> wgpu::BindGroup {
        let job = wgpu::BufferBinding { buffer: &blocks.jobs, offset: 0, size: wgpu::BufferSize::new(16) };
        let resources = [
            air.as_entire_binding(),
            blocks.dims.as_entire_binding(),
            blocks.rule.as_entire_binding(),
            wgpu::BindingResource::Sampler(&self.sampler),
            wgpu::BindingResource::Buffer(job),
        ];
        bind(device, &self.shared_layout, &resources)
    }

    /// Bind group of the tables that a pass reads.
    pub fn tables_group(&self, device: &Device, reads: [&wgpu::TextureView; 6]) -> wgpu::BindGroup {
        bind(device, &self.tables_layout, &reads.map(tex))
    }
}

/// Blend state for out = share * new + (1 - share) * old, where the blend constant is the share.
pub(crate) fn fade_blend() -> wgpu::BlendState {
    let over = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::Constant,
        dst_factor: wgpu::BlendFactor::OneMinusConstant,
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::BlendState { color: over, alpha: over }
}

/// Passes that draw tables as a mix of two, for fades.
pub(crate) struct FadePasses {
    layout: wgpu::BindGroupLayout,
    /// Pipeline that fades the light; the tables may have any size.
    light: wgpu::RenderPipeline,
    /// Pipeline that fades texel by texel.
    texels: wgpu::RenderPipeline,
    /// Size of the light table, texels.
    light_size: (u32, u32),
}

impl FadePasses {
    pub fn new(device: &Device, settings: &SkySettings) -> Result<Self> {
        let layout = layout(device, "sky fade", &[Slot::Filtered]);
        let target = wgpu::ColorTargetState {
            format: TABLE_FORMAT,
            blend: Some(fade_blend()),
            write_mask: wgpu::ColorWrites::ALL,
        };
        let sizes = [("SUNS", f64::from(settings.suns)), ("ALTITUDES", f64::from(settings.altitudes))];
        let make = |entry, constants| {
            let desc = FullscreenDesc {
                shader: "sky/copy.wgsl",
                entry,
                layouts: &[&layout],
                targets: std::slice::from_ref(&target),
                constants,
                samples: 1,
            };
            fullscreen(device, &desc)
        };
        let (light, texels) = (make("light", &sizes)?, make("copy", &[])?);
        Ok(Self { layout, light, texels, light_size: Name::Lights.size(settings) })
    }

    /// Bind group that reads a table.
    pub fn group(&self, device: &Device, table: &wgpu::TextureView) -> wgpu::BindGroup {
        bind(device, &self.layout, &[tex(table)])
    }

    /// Draws the light of `first` into `target`, and blends the light of `other` over it with the share that `other`
    /// gives.
    pub fn show_light(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        first: &wgpu::BindGroup,
        other: Option<(&wgpu::BindGroup, f32)>,
    ) {
        draw_over(encoder, &self.light, target, Some(self.light_size), [Some((first, 1.0)), other]);
    }

    /// Draws the mix of two tables into `target`, which has the same size as both. `share` is the weight of the second
    /// table.
    pub fn between(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        [first, other]: [&wgpu::BindGroup; 2],
        share: f32,
    ) {
        draw_over(encoder, &self.texels, target, None, [Some((first, 1.0)), Some((other, share))]);
    }
}

/// Draws tables into a target, one over the other, each with its share. `size` limits the draw to the corner at the
/// first texel; all other texels are cleared.
fn draw_over(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::RenderPipeline,
    view: &wgpu::TextureView,
    size: Option<(u32, u32)>,
    tables: [Option<(&wgpu::BindGroup, f32)>; 2],
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("sky fade"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    if let Some((width, height)) = size {
        pass.set_scissor_rect(0, 0, width, height);
    }
    for (group, share) in tables.into_iter().flatten() {
        let t = f64::from(share.clamp(0.0, 1.0));
        pass.set_blend_constant(wgpu::Color { r: t, g: t, b: t, a: t });
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Pass that adds up the light of several triples of wavelengths, whose tables are built one after the other.
pub(crate) struct PartPass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl PartPass {
    pub fn new(device: &Device) -> Result<Self> {
        let layout = layout(device, "sky part", &[Slot::Filtered, Slot::Uniform(0)]);
        let add = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let blend = Some(wgpu::BlendState { color: add, alpha: wgpu::BlendComponent::REPLACE });
        let target = wgpu::ColorTargetState { format: TABLE_FORMAT, blend, write_mask: wgpu::ColorWrites::ALL };
        let desc = FullscreenDesc {
            shader: "sky/part.wgsl",
            entry: "part",
            layouts: &[&layout],
            targets: &[target],
            constants: &[],
            samples: 1,
        };
        let pipeline = fullscreen(device, &desc)?;
        Ok(Self { layout, pipeline })
    }

    /// Bind group of one triple's table and air.
    pub fn group(&self, device: &Device, table: &wgpu::TextureView, air: &wgpu::Buffer) -> wgpu::BindGroup {
        bind(device, &self.layout, &[tex(table), air.as_entire_binding()])
    }

    /// Adds the light of a triple to `target`. The `first` triple clears the target before.
    pub fn add(&self, encoder: &mut wgpu::CommandEncoder, target: &SkyTable, triple: &wgpu::BindGroup, first: bool) {
        let load = if first { wgpu::LoadOp::Clear(wgpu::Color::BLACK) } else { wgpu::LoadOp::Load };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("sky part"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &target.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, triple, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn pipeline(
    device: &Device,
    settings: &SkySettings,
    pass: &Pass,
    layouts: &[&wgpu::BindGroupLayout],
) -> Result<wgpu::RenderPipeline> {
    let target: wgpu::ColorTargetState = TABLE_FORMAT.into();
    let entry = match pass.kind {
        PassKind::Norm => "norm",
        PassKind::Gather => "gather",
        PassKind::Scatter => "scatter",
        PassKind::Light => "light",
        PassKind::IsotropicGather => "isotropic_gather",
        PassKind::IsotropicScatter => "isotropic_scatter",
        PassKind::Once => "once",
    };
    let directional = crate::stage::flag(settings.model.is_directional());
    let desc = FullscreenDesc {
        shader: "sky/build.wgsl",
        entry,
        layouts,
        targets: &vec![target; pass.draws.len()],
        constants: &[("DIRECTIONAL", directional)],
        samples: 1,
    };
    fullscreen(device, &desc)
}

/// Nodes of both quadrature rules over directions, in the form that the shaders read: node and weight of the rule over
/// zenith angles, then cosine and sine of an azimuth.
fn rule(settings: &SkySettings) -> [[f32; 4]; 24] {
    let mut out = gauss(settings.rule_zeniths as usize);
    let n = settings.rule_azimuths as usize;
    for (i, slot) in out.iter_mut().enumerate().take(n) {
        let azimuth = std::f64::consts::PI * (i as f64 + 0.5) / n as f64;
        (slot[2], slot[3]) = (azimuth.cos() as f32, azimuth.sin() as f32);
    }
    out
}

/// Gauss-Legendre rule with `n` nodes on (0, 1): (node, weight, 0, 0).
fn gauss(n: usize) -> [[f32; 4]; 24] {
    let mut out = [[0.0; 4]; 24];
    for (i, slot) in out.iter_mut().enumerate().take(n) {
        // Newton's iteration for a root of P_n, starting from Tricomi's estimate.
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut p0, mut p1) = (1.0, x);
            for k in 2..=n {
                let k = k as f64;
                (p0, p1) = (p1, ((2.0 * k - 1.0) * x * p1 - (k - 1.0) * p0) / k);
            }
            slope = n as f64 * (x * p1 - p0) / (x * x - 1.0);
            x -= p1 / slope;
        }
        *slot = [(0.5 + 0.5 * x) as f32, (1.0 / ((1.0 - x * x) * slope * slope)) as f32, 0.0, 0.0];
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rule_integrates_polynomials() {
        for n in [2, 5, 8, 16] {
            let r = gauss(n);
            for k in 0..2 * n as i32 {
                let sum: f64 = r[..n].iter().map(|a| f64::from(a[1]) * f64::from(a[0]).powi(k)).sum();
                assert!((sum * f64::from(k + 1) - 1.0).abs() < 2e-5, "n {n} degree {k}: {sum}");
            }
        }
    }
}
