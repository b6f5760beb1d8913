//! GPU resources of the drawn terrain: pipeline, mesh, and the bind group of the pages and the shadow maps.

use glam::{DMat4, DVec4};

use super::{
    pages::PageTextures,
    patch::{PatchMesh, patch_layout},
    shadow::{ShadowMaps, no_maps},
    uniforms::{LandUniform, PatchInstance},
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        blocks::{Blocks, UniformBlock},
    },
    stage::{OpaqueDraw, OpaqueTarget},
};

/// Least ratio of the volume between three rows of a central projection's matrix to the product of their lengths.
const FLATTEST: f64 = 1e-9;

/// Key of the bind group: the textures of the pages' vertices and of the shadow maps' depths. These two suffice: the
/// other textures of the pages and of the shadow maps are replaced together with them.
type BoundTextures = (wgpu::Texture, Option<wgpu::Texture>);

/// Target of a pipeline, and the winding in the image of the triangles that it draws; `None` draws both sides.
type PipelineKey = (OpaqueTarget, Option<wgpu::FrontFace>);

/// Resources of a view.
pub(super) struct LandPass {
    block: UniformBlock,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    mesh: PatchMesh,
    /// Pipeline, and what it was made for.
    pipeline: Option<(PipelineKey, wgpu::RenderPipeline)>,
    compared: wgpu::Sampler,
    no_maps: [wgpu::TextureView; 2],
    /// Bind group, and the textures of pages and of shadow maps that it was made for.
    group: Option<(BoundTextures, wgpu::BindGroup)>,
}

impl LandPass {
    pub fn new(device: &Device, blocks: &Blocks) -> Self {
        let gpu = &device.device;
        let slots = [
            (0, Slot::Uniform(size_of::<LandUniform>())),
            (1, Slot::Texels),
            (2, Slot::Filtered),
            (3, Slot::Filtered),
            (4, Slot::Filtered),
            (5, Slot::Sampler),
            (6, Slot::Filtered),
            (7, Slot::ComparedArray),
            (8, Slot::TexelsArray),
            (9, Slot::TexelsArray),
            (10, Slot::Comparison),
        ];
        Self {
            block: blocks.block(device, size_of::<LandUniform>()),
            layout: bind::layout(gpu, "land", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots),
            sampler: gpu.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("land"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            compared: gpu.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("land shadows"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                compare: Some(wgpu::CompareFunction::GreaterEqual),
                ..Default::default()
            }),
            no_maps: no_maps(gpu),
            mesh: PatchMesh::new(device),
            pipeline: None,
            group: None,
        }
    }

    /// GPU memory, bytes.
    pub fn bytes(&self) -> u64 {
        self.mesh.bytes()
    }

    /// Draws the patches of a picture.
    ///
    /// # Errors
    /// [`crate::Status::Internal`] if a shader file is missing.
    pub fn draw(
        &mut self,
        device: &Device,
        opaque: &OpaqueDraw<'_>,
        (pages, maps): (&PageTextures, Option<&ShadowMaps>),
        (block, patches): (&LandUniform, &[PatchInstance]),
        pass: &mut wgpu::RenderPass<'_>,
    ) -> Result<()> {
        self.block.write(bytemuck::bytes_of(block));
        self.mesh.write(device, patches);
        let key = (opaque.target, upper_side(opaque.clip));
        let pipeline = match self.pipeline.take() {
            Some((made_for, pipeline)) if made_for == key => pipeline,
            _ => pipeline(device, opaque, &self.layout, key.1)?,
        };
        let textures = (pages.vertices.clone(), maps.map(|maps| maps.texture().clone()));
        let group = match self.group.take() {
            Some((bound, group)) if bound == textures => group,
            _ => self.bind(&device.device, pages, maps),
        };
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(1, &group, &[]);
        self.mesh.draw(pass, 0..patches.len() as u32);
        self.pipeline = Some((key, pipeline));
        self.group = Some((textures, group));
        Ok(())
    }

    fn bind(&self, device: &wgpu::Device, pages: &PageTextures, maps: Option<&ShadowMaps>) -> wgpu::BindGroup {
        let [depths, tops] = maps.map_or_else(|| self.no_maps.clone(), ShadowMaps::views);
        let views = [&pages.vertices, &pages.slopes, &pages.classes[0], &pages.classes[1], &pages.dug]
            .map(|texture| texture.create_view(&Default::default()));
        let texture = |binding: u32, i: usize| bind::view(binding, &views[i]);
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("land"),
            layout: &self.layout,
            entries: &[
                self.block.entry(0),
                texture(1, 0),
                texture(2, 1),
                texture(3, 2),
                texture(4, 3),
                bind::sampler(5, &self.sampler),
                texture(6, 4),
                bind::view(7, &depths),
                bind::view(8, &depths),
                bind::view(9, &tops),
                bind::sampler(10, &self.compared),
            ],
        })
    }
}

/// Returns the winding in the image of triangles that show their upper side, from a matrix to clip space. `None` with
/// parallel rays: their matrix has no centre of projection for a triangle to face.
///
/// The homogeneous coordinates x, y, w of a triangle's corners have the orientation of its image. They follow from the
/// corners by the matrix's rows for x, y and w. The determinant of these rows then says which orientation the upper
/// side has.
fn upper_side(clip: DMat4) -> Option<wgpu::FrontFace> {
    let rows = clip.transpose();
    let [x, y, w] = [rows.x_axis, rows.y_axis, rows.w_axis].map(DVec4::truncate);
    let volume = x.cross(y).dot(w);
    let is_central = volume.abs() > FLATTEST * x.length() * y.length() * w.length();
    is_central.then_some(if volume < 0.0 { wgpu::FrontFace::Ccw } else { wgpu::FrontFace::Cw })
}

/// Creates the pipeline for a target. It draws the triangles whose winding in the image is `side`, or all.
fn pipeline(
    device: &Device,
    opaque: &OpaqueDraw<'_>,
    own: &wgpu::BindGroupLayout,
    side: Option<wgpu::FrontFace>,
) -> Result<wgpu::RenderPipeline> {
    let module = device.shader("land/land.wgsl")?;
    let target = opaque.target;
    let layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("land"),
        bind_group_layouts: &[Some(opaque.layout), Some(own)],
        immediate_size: 0,
    });
    Ok(device.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("land"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("land_vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(patch_layout())],
        },
        primitive: wgpu::PrimitiveState {
            front_face: side.unwrap_or_default(),
            cull_mode: side.map(|_| wgpu::Face::Back),
            ..Default::default()
        },
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
    }))
}

#[cfg(test)]
mod tests {
    use glam::{DMat4, DVec3};

    use super::upper_side;
    use crate::scene::Camera;

    #[test]
    fn the_upper_side_has_the_winding_of_its_corners_in_the_image() {
        let ground = [DVec3::new(-1.0, 4.0, -2.0), DVec3::new(2.0, 5.0, -2.0), DVec3::new(0.0, 9.0, -2.5)];
        for (up, mirror) in [(DVec3::Z, 1.0), (DVec3::Z, -1.0), (DVec3::X, 1.0), (-DVec3::Z, 1.0)] {
            let camera = Camera::look_to(DVec3::ZERO, DVec3::new(0.1, 1.0, -0.4), up, 0.9, 1.7, 0.1);
            let mirrored = DMat4::from_scale(DVec3::new(1.0, mirror, 1.0));
            let clip = mirrored * camera.projection * DMat4::from_mat3(camera.rotation());
            let [a, b, c] = ground.map(|corner| clip.project_point3(corner).truncate());
            let is_ccw = (b - a).perp_dot(c - a) > 0.0;
            let expected = if is_ccw { wgpu::FrontFace::Ccw } else { wgpu::FrontFace::Cw };
            assert_eq!(upper_side(clip), Some(expected), "up {up}, rows by {mirror}");
        }
        assert_eq!(upper_side(DMat4::from_scale(DVec3::new(0.1, 0.2, 0.01))), None, "parallel rays");
    }
}
