//! The glow on the GPU: a ball of directions with zodiacal light and starlight at its corners, to which the shader adds airglow and air.

use glam::{DMat3, DVec3};

use super::{
    galaxy::{LATITUDES_DEG, LONGITUDES, equator_to_galactic, node, unresolved_s10},
    glow::{NightSky, S10_CD_M2, equator_to_sun_ecliptic, zodiacal_toward},
    uniforms::StarView,
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
    },
};

/// Rows of the ball from the south galactic pole to the north one, and corners a row: the last stands where the first does.
const ROWS: usize = 2 * LATITUDES_DEG.len() - 1;
const COLUMNS: usize = 2 * LONGITUDES + 1;
/// Angle that the sun moves on, rad, until the zodiacal light is found anew: six hours.
const STALE_RAD: f64 = 0.0044;

/// A corner of the ball.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Corner {
    /// Unit vector in J2000.0.
    direction: [f32; 3],
    /// Zodiacal light and starlight, S10.
    s10: [f32; 2],
}

/// `GlowUniform` of `shaders/stars/glow.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct GlowUniform {
    clip: [[f32; 4]; 4],
    to_world: [[f32; 4]; 3],
    colors: [[f32; 4]; 3],
    zenith_depth: [f32; 3],
    airglow: f32,
    lit_air: [f32; 3],
    layer_ratio2: f32,
    dusk: [f32; 3],
    share: f32,
    y_sign: f32,
    pad: [f32; 3],
}

/// How much of the night is there: luminance of the sky where it has not come yet, cd/m^2 a channel, and its share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Dusk {
    pub cd_m2: [f64; 3],
    pub share: f64,
}

/// What a view holds for the glow.
pub(super) struct GlowPass {
    block: wgpu::Buffer,
    corners: wgpu::Buffer,
    indices: wgpu::Buffer,
    group: wgpu::BindGroup,
    pipeline: wgpu::RenderPipeline,
    /// The sun's place in J2000.0 that the corners' zodiacal light is of.
    sun: Option<DVec3>,
}

impl GlowPass {
    /// For targets of `format`, of one sample a pixel.
    ///
    /// # Errors
    /// A missing shader file; GPU faults come through [`Device::check`].
    pub fn new(device: &Device, format: wgpu::TextureFormat) -> Result<Self> {
        use wgpu::BufferUsages as U;
        let buffer = |label, size: usize, usage| {
            device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: size as u64,
                usage: usage | U::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let block = buffer("glow", size_of::<GlowUniform>(), U::UNIFORM);
        let list = indices();
        let indices = buffer("glow", size_of::<u16>() * list.len(), U::INDEX);
        device.queue.write_buffer(&indices, 0, bytemuck::cast_slice(&list));
        let corners = buffer("glow", size_of::<Corner>() * ROWS * COLUMNS, U::VERTEX);
        let slots = [(0, Slot::Uniform(size_of::<GlowUniform>()))];
        let layout = bind::layout(&device.device, "glow", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots);
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("glow"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: block.as_entire_binding() }],
        });
        let pipeline = pipeline(device, &layout, format)?;
        Ok(Self { block, corners, indices, group, pipeline, sun: None })
    }

    /// Brings everything up for a draw of `sky` as `view` sees it.
    pub fn prepare(&mut self, device: &Device, sky: &NightSky, view: &StarView<'_>, dusk: &Dusk) {
        let sun = view.heavens.sun;
        if self.sun.is_none_or(|s| s.angle_between(sun) > STALE_RAD) {
            self.sun = Some(sun);
            device.queue.write_buffer(&self.corners, 0, bytemuck::cast_slice(&corners(sun)));
        }
        let column = |i: usize| view.heavens.to_world.col(i).as_vec3().extend(0.0).to_array();
        let units = |light: [f64; 3]| light.map(|v| (v * view.scale) as f32);
        let color = |i: usize| {
            let [r, g, b] = units(sky.colors[i].map(|c| c * S10_CD_M2));
            [r, g, b, 0.0]
        };
        let block = GlowUniform {
            clip: view.clip.as_mat4().to_cols_array_2d(),
            to_world: [column(0), column(1), column(2)],
            colors: [color(0), color(1), color(2)],
            zenith_depth: sky.zenith_depth.map(|d| d as f32),
            airglow: sky.airglow_s10() as f32,
            lit_air: units(sky.lit_air),
            layer_ratio2: sky.layer_ratio2() as f32,
            dusk: units(dusk.cd_m2),
            share: dusk.share as f32,
            y_sign: view.y_sign,
            pad: [0.0; 3],
        };
        device.queue.write_buffer(&self.block, 0, bytemuck::bytes_of(&block));
    }

    /// Draws what was prepared in place of what is there. Sets group 0, vertex buffer 0 and the index buffer.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        pass.draw_indexed(0..(self.indices.size() / 2) as u32, 0, 0..1);
    }

    /// Bytes on the GPU.
    pub fn bytes(&self) -> u64 {
        self.block.size() + self.corners.size() + self.indices.size()
    }
}

/// The ball's corners under a sun, row by row.
fn corners(sun: DVec3) -> Vec<Corner> {
    let to_equator: DMat3 = equator_to_galactic().transpose();
    let to_sun = equator_to_sun_ecliptic(sun);
    let pole = LATITUDES_DEG.len() - 1;
    let corner = |i: usize| {
        let (row, column) = (i / COLUMNS, i % COLUMNS);
        let latitude = if row < pole { -LATITUDES_DEG[pole - row] } else { LATITUDES_DEG[row - pole] };
        let galactic = node(latitude, column);
        let direction = to_equator * galactic;
        let s10 = [zodiacal_toward(to_sun * direction), unresolved_s10(galactic)];
        Corner { direction: direction.as_vec3().to_array(), s10: s10.map(|v| v as f32) }
    };
    (0..ROWS * COLUMNS).map(corner).collect()
}

/// Two triangles for each patch between rows and columns.
fn indices() -> Vec<u16> {
    let patch = |i: usize| {
        let at = (i / (COLUMNS - 1) * COLUMNS + i % (COLUMNS - 1)) as u16;
        let next = at + COLUMNS as u16;
        [at, at + 1, next, next, at + 1, next + 1]
    };
    (0..(ROWS - 1) * (COLUMNS - 1)).flat_map(patch).collect()
}

fn pipeline(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
) -> Result<wgpu::RenderPipeline> {
    let module = device.shader("stars/glow.wgsl")?;
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x2];
    let corners = wgpu::VertexBufferLayout {
        array_stride: size_of::<Corner>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &attributes,
    };
    let groups = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("glow"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    Ok(device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("glow"),
        layout: Some(&groups),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("glow_vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(corners)],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("glow_fragment"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader::assert_layout;

    #[test]
    fn offsets_agree_with_the_shader() {
        assert_layout!(
            "stars/glow.wgsl",
            "GlowUniform",
            GlowUniform,
            [clip, to_world, colors, zenith_depth, airglow, lit_air, layer_ratio2, dusk, share, y_sign]
        );
    }
}
