//! The passes of a picture's clouds: some pixels are marched, each square of them is followed back to the last frame, and the whole picture is
//! made of both.

use std::sync::Arc;

use super::{
    picture::{BEHIND, PAIR, Picture, SEEN},
    tables::CloudTables,
    uniforms::{CloudsUniform, PictureUniform},
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        pass::{self, FullscreenDesc},
    },
    stage::{FrameUniform, yes},
};

fn view(binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) }
}

fn buffer(binding: u32, buffer: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }
}

fn sampled(binding: u32, sampler: &wgpu::Sampler) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::Sampler(sampler) }
}

/// The pipelines, and the layout of the march's and of the two other passes' group.
struct Pipelines {
    layouts: [wgpu::BindGroupLayout; 2],
    march: wgpu::RenderPipeline,
    follow: wgpu::RenderPipeline,
    /// With a last frame, and without one.
    resolve: [wgpu::RenderPipeline; 2],
}

impl Pipelines {
    fn new(device: &Device, sky: &wgpu::BindGroupLayout) -> Result<Self> {
        let layout =
            |slots: &[(u32, Slot)]| bind::layout(&device.device, "clouds", wgpu::ShaderStages::FRAGMENT, slots);
        let layouts = [
            layout(&[
                (0, Slot::Uniform(size_of::<FrameUniform>())),
                (1, Slot::Uniform(size_of::<CloudsUniform>())),
                (2, Slot::Filtered),
                (3, Slot::FilteredVolume),
                (4, Slot::Filtered),
                (5, Slot::Sampler),
                (6, Slot::Sampler),
                (7, Slot::Uniform(size_of::<PictureUniform>())),
            ]),
            layout(&[
                (0, Slot::Uniform(size_of::<FrameUniform>())),
                (1, Slot::Uniform(size_of::<PictureUniform>())),
                (2, Slot::Filtered),
                (3, Slot::Filtered),
                (4, Slot::Filtered),
                (5, Slot::Sampler),
                (6, Slot::Texels),
                (7, Slot::Texels),
                (8, Slot::Texels),
            ]),
        ];
        let make = |shader, entry, layouts: &[&wgpu::BindGroupLayout], formats: &[wgpu::TextureFormat], history| {
            let targets: Vec<_> = formats.iter().map(|f| (*f).into()).collect();
            let constants: &[_] = if entry == "resolve" { &[("HISTORY", yes(history))] } else { &[] };
            pass::fullscreen(
                device,
                &FullscreenDesc { shader, entry, layouts, targets: &targets, constants, samples: 1 },
            )
        };
        let resolve = |history| make("clouds/resolve.wgsl", "resolve", &[&layouts[1]], &[SEEN, SEEN], history);
        Ok(Self {
            march: make("clouds/march_view.wgsl", "march", &[&layouts[0], sky], &[SEEN, PAIR], false)?,
            follow: make("clouds/follow.wgsl", "follow", &[&layouts[1]], &[SEEN, SEEN, PAIR], true)?,
            resolve: [resolve(true)?, resolve(false)?],
            layouts,
        })
    }
}

/// The passes of a view.
pub(super) struct CloudPasses {
    pub tables: CloudTables,
    block: wgpu::Buffer,
    picture_block: wgpu::Buffer,
    pipelines: Option<Pipelines>,
    picture: Option<Picture>,
    /// What the march is bound to, and with which tables of the sky.
    marched_of: Option<(wgpu::BindGroup, wgpu::BindGroup)>,
    none: wgpu::TextureView,
}

/// What the passes draw from.
pub(super) struct CloudFrame<'a> {
    pub clouds: CloudsUniform,
    pub picture: PictureUniform,
    /// The frame's block, and the sky's tables with their layout.
    pub frame: &'a wgpu::Buffer,
    pub sky: (&'a wgpu::BindGroupLayout, &'a wgpu::BindGroup),
    /// What stands behind the sky's own light.
    pub behind: Option<&'a wgpu::Texture>,
}

fn attachment(view: &wgpu::TextureView) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
    })
}

/// Runs one pass over all of its targets.
fn run(
    encoder: &mut wgpu::CommandEncoder,
    targets: &[&wgpu::TextureView],
    pipeline: &wgpu::RenderPipeline,
    groups: &[&wgpu::BindGroup],
) {
    let attachments: [_; 3] = std::array::from_fn(|i| targets.get(i).and_then(|t| attachment(t)));
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("clouds"),
        color_attachments: &attachments[..targets.len()],
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    for (i, group) in groups.iter().enumerate() {
        pass.set_bind_group(i as u32, *group, &[]);
    }
    pass.draw(0..3, 0..1);
}

impl CloudPasses {
    pub fn new(device: &Arc<Device>, seed: u64) -> Result<Self> {
        Ok(Self {
            tables: CloudTables::new(device, seed)?,
            block: bind::block(&device.device, "clouds", size_of::<CloudsUniform>()),
            picture_block: bind::block(&device.device, "clouds of a picture", size_of::<PictureUniform>()),
            pipelines: None,
            picture: None,
            marched_of: None,
            none: bind::nothing(&device.device, wgpu::TextureFormat::Rgba8Unorm),
        })
    }

    /// Makes textures for a picture of this size, and answers whether the last one's are kept.
    pub fn hold(&mut self, device: &Device, size: (u32, u32), side: u32) -> bool {
        if self.picture.as_ref().is_some_and(|p| p.of == (size, side)) {
            return true;
        }
        self.picture = Some(Picture::new(device, size, side));
        false
    }

    /// Lets go what is of a picture's size.
    pub fn forget(&mut self) {
        self.picture = None;
    }

    /// The picture that will hold the clouds once they are drawn.
    pub fn next(&self) -> Option<wgpu::TextureView> {
        self.picture.as_ref().map(|p| p.next().layers.clone())
    }

    /// Bytes of GPU memory.
    pub fn bytes(&self) -> u64 {
        CloudTables::BYTES + self.picture.as_ref().map_or(0, Picture::bytes)
    }

    /// What the march is bound to.
    fn march_group(&self, device: &Device, layout: &wgpu::BindGroupLayout, frame: &wgpu::Buffer) -> wgpu::BindGroup {
        let (solid, light) = (self.tables.solid.view(), self.tables.light.view());
        device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("clouds marched"),
            layout,
            entries: &[
                buffer(0, frame),
                buffer(1, &self.block),
                view(2, &self.tables.map),
                view(3, &solid),
                view(4, &light),
                sampled(5, &self.tables.repeating),
                sampled(6, &self.tables.clamping),
                buffer(7, &self.picture_block),
            ],
        })
    }

    /// What the passes after the march are bound to: the one that follows squares, and the one that makes a whole picture of each of the two
    /// last ones.
    fn picture_groups(
        &self,
        device: &Device,
        layout: &wgpu::BindGroupLayout,
        frame: &wgpu::Buffer,
        picture: &Picture,
    ) -> [wgpu::BindGroup; 3] {
        let none = [&self.none; 4];
        let [least, most, back] = &picture.followed;
        let from = |i: usize| [&picture.whole[i].written[0], least, most, back];
        [none, from(0), from(1)].map(|[last, least, most, back]| {
            device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("clouds of a picture"),
                layout,
                entries: &[
                    buffer(0, frame),
                    buffer(1, &self.picture_block),
                    view(2, &picture.marched[0]),
                    view(3, &picture.marched[1]),
                    view(4, last),
                    sampled(5, &self.tables.clamping),
                    view(6, least),
                    view(7, most),
                    view(8, back),
                ],
            })
        })
    }

    /// Marches a frame's pixels and makes the picture of them. Answers the passes that it took.
    pub fn draw(&mut self, device: &Device, encoder: &mut wgpu::CommandEncoder, of: &CloudFrame<'_>) -> Result<u32> {
        if self.pipelines.is_none() {
            self.pipelines = Some(Pipelines::new(device, of.sky.0)?);
        }
        let (Some(pipelines), Some(mut picture)) = (&self.pipelines, self.picture.take()) else { return Ok(0) };
        device.queue.write_buffer(&self.block, 0, bytemuck::bytes_of(&of.clouds));
        device.queue.write_buffer(&self.picture_block, 0, bytemuck::bytes_of(&of.picture));
        let [march_layout, picture_layout] = &pipelines.layouts;
        let marched = match &self.marched_of {
            Some((sky, group)) if sky == of.sky.1 => group.clone(),
            _ => self.march_group(device, march_layout, of.frame),
        };
        self.marched_of = Some((of.sky.1.clone(), marched.clone()));
        let groups = match &picture.groups {
            Some(groups) => groups.clone(),
            None => self.picture_groups(device, picture_layout, of.frame, &picture),
        };
        let [seen, reach] = &picture.marched;
        run(encoder, &[seen, reach], &pipelines.march, &[&marched, of.sky.1]);
        let has_history = of.picture.exposed > 0.0;
        if has_history {
            let [least, most, back] = &picture.followed;
            run(encoder, &[least, most, back], &pipelines.follow, &[&groups[0]]);
        }
        let [seen, reach] = &picture.next().written;
        let resolve = &pipelines.resolve[usize::from(!has_history)];
        run(encoder, &[seen, reach], resolve, &[&groups[1 + picture.newest]]);
        if let Some(behind) = of.behind {
            copy_layer(encoder, behind, &picture.next().texture);
        }
        picture.newest = 1 - picture.newest;
        picture.groups = Some(groups);
        self.picture = Some(picture);
        Ok(2 + u32::from(has_history))
    }
}

/// Copies what stands behind the sky's own light into its layer.
fn copy_layer(encoder: &mut wgpu::CommandEncoder, from: &wgpu::Texture, to: &wgpu::Texture) {
    let origin = wgpu::Origin3d { x: 0, y: 0, z: BEHIND };
    let size = wgpu::Extent3d { depth_or_array_layers: 1, ..to.size() };
    encoder.copy_texture_to_texture(
        from.as_image_copy(),
        wgpu::TexelCopyTextureInfo { origin, ..to.as_image_copy() },
        size,
    );
}
