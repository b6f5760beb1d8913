//! The world that is looked at: a context with terrain that Welkin draws, and the picture of it.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    capi::by_name::NamedCalls,
    frame::{DepthAccess, Frame, Stages},
    gpu::Device,
    heights::{HeightMap, HeightSettings},
    scene::Camera,
    terrain::{Rows, TerrainCells, TerrainDesc, TileKey},
};

use crate::{
    camera::FlyCamera,
    objects::{self, Objects, SITE},
    settings::{Part, Settings},
};

/// Elevation model of the Jacksboro fault, Tennessee, and its size on the ground, m east and north.
const HEIGHTS: &[u8] = include_bytes!("../../data/jacksboro_dem.png");
const SIZE_M: [f64; 2] = [29_983.0, 31_820.0];
const CELL_M: f64 = 80.0;
const TILE_CELLS: u32 = 256;
/// Number in cells beyond the model.
const NO_DATA_M: f32 = -9999.0;

/// A refusal: the part, and the field with the sentence.
pub type Refused = (Part, welkin::capi::by_name::Refusal);

/// The world, and the images that it is drawn into.
pub struct World {
    gpu: Arc<Device>,
    calls: NamedCalls,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    frame_id: u64,
    objects: Objects,
    /// Height of the site's ground, m.
    site_m: f64,
}

impl World {
    /// Creates the world of some settings; what the library refuses of them is returned beside it.
    ///
    /// # Errors
    /// A sentence, if there can be no world at all.
    pub fn new(gpu: &Arc<Device>, settings: &Settings, size: [u32; 2]) -> Result<(Self, Vec<Refused>), String> {
        let calls = NamedCalls::new(gpu, settings.world()).map_err(|refusal| refusal.message)?;
        let [color, depth] = images(&gpu.device, size);
        let objects = Objects::new(&gpu.device);
        let mut world = Self { gpu: gpu.clone(), calls, color, depth, frame_id: 0, objects, site_m: 0.0 };
        world.lay_terrain().map_err(|e| e.to_string())?;
        world.site_m = world.ground_m(DVec3::new(SITE[0], SITE[1], 0.0));
        let shelters = objects::shelters(world.site_m);
        let set = world.calls.with(|_, context| context.set_shelters(&shelters));
        set.unwrap_or(Ok(())).map_err(|e| e.to_string())?;
        let refused = settings.apply(&world.calls, None, 0.0);
        Ok((world, refused))
    }

    fn lay_terrain(&self) -> welkin::Result<()> {
        let [columns, rows] = SIZE_M.map(|m| (m / CELL_M) as u32);
        let heights = HeightMap::from_bytes(HEIGHTS, &HeightSettings::default())?.resampled(columns, rows)?;
        let height =
            |column: u32, row: u32| heights.height_m(column, row).filter(|h| h.is_finite()).unwrap_or(NO_DATA_M);
        let laid = self.calls.with(|_, context| {
            let origin = DVec3::new(-0.5 * SIZE_M[0], -0.5 * SIZE_M[1], 0.0);
            context.set_terrain(Some(TerrainDesc { origin, cell_m: CELL_M, tile_cells: TILE_CELLS }))?;
            for (east, north) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let corner = [east, north].map(|i| i * TILE_CELLS);
                let cells =
                    (0..TILE_CELLS * TILE_CELLS).map(|i| [corner[0] + i % TILE_CELLS, corner[1] + i / TILE_CELLS]);
                let heights: Vec<f32> = cells.map(|[column, row]| height(column, row)).collect();
                context.set_terrain_tile(&TerrainCells {
                    key: TileKey::new(east as i32, north as i32),
                    heights_m: Rows::of(&heights),
                    no_data_m: Some(NO_DATA_M),
                    ..TerrainCells::default()
                })?;
            }
            Ok(())
        });
        laid.unwrap_or(Ok(()))
    }

    /// Hands changed settings to the library. Returns what it refuses.
    pub fn apply(&mut self, settings: &Settings, before: &Settings, transition_s: f64) -> Vec<Refused> {
        settings.apply(&self.calls, Some(before), transition_s)
    }

    /// Calls of the context and its view.
    pub fn calls(&self) -> &NamedCalls {
        &self.calls
    }

    /// Advances simulation time, s. A jump back is not made.
    ///
    /// # Errors
    /// The library's sentence.
    pub fn update(&mut self, time_s: f64) -> Result<(), String> {
        let updated = self.calls.with(|_, context| context.update(time_s.max(context.time_s())));
        updated.unwrap_or(Ok(())).map_err(|e| e.to_string())
    }

    /// Height of the ground at a place, m; 0 beyond the terrain.
    pub fn ground_m(&self, place: DVec3) -> f64 {
        let point = self.calls.with(|_, context| context.terrain_at(place).ok().flatten()).flatten();
        point.map_or(0.0, |point| point.height_m)
    }

    /// Height of the site's ground, m.
    pub fn site_m(&self) -> f64 {
        self.site_m
    }

    /// Size of the picture, pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.color.width(), self.color.height()]
    }

    /// Gives the picture another size.
    pub fn resize(&mut self, size: [u32; 2]) {
        if size != self.size() {
            [self.color, self.depth] = images(&self.gpu.device, size);
        }
    }

    /// The picture: linear light of a display, 0 to 1.
    pub fn picture(&self) -> &wgpu::Texture {
        &self.color
    }

    /// Draws the picture.
    ///
    /// # Errors
    /// The library's sentence.
    pub fn draw(&mut self, camera: &FlyCamera) -> Result<(), String> {
        let aspect = f64::from(self.color.width()) / f64::from(self.color.height());
        let camera = camera.camera(aspect);
        self.draw_objects(&camera)?;
        self.frame_id += 1;
        let mut frame = Frame::new(self.frame_id, camera, &self.color, Some(&self.depth));
        frame.depth_access = DepthAccess::ReadWrite;
        let drawn = self.calls.with(|view, context| view.record(context, &frame, Stages::ALL));
        drawn.unwrap_or(Ok(())).map_err(|e| e.to_string())
    }

    /// Clears the images and draws the host's own things into them.
    fn draw_objects(&self, camera: &Camera) -> Result<(), String> {
        let scene = self.calls.with(|_, context| context.scene_at(camera.position, context.time_s()));
        let scene = scene.ok_or("the context is gone")?.map_err(|e| e.to_string())?;
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let [color, depth] = [&self.color, &self.depth].map(|image| image.create_view(&Default::default()));
        let store = wgpu::StoreOp::Store;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("studio"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        self.objects.draw(&self.gpu.queue, &mut pass, (camera, &scene), self.site_m);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
        Ok(())
    }
}

/// Colour and depth.
fn images(device: &wgpu::Device, [width, height]: [u32; 2]) -> [wgpu::Texture; 2] {
    use wgpu::TextureUsages as U;
    [(wgpu::TextureFormat::Rgba16Float, U::COPY_SRC), (wgpu::TextureFormat::Depth32Float, U::empty())].map(
        |(format, more)| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some("studio"),
                size: wgpu::Extent3d { width: width.max(1), height: height.max(1), depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: U::RENDER_ATTACHMENT | U::TEXTURE_BINDING | more,
                view_formats: &[],
            })
        },
    )
}
