//! GPU textures of the water on the host's terrain: one upload serves all views and the host's own shaders.

use std::sync::{Arc, MutexGuard, PoisonError};

use glam::DVec3;

use super::{
    held::HeldGround,
    texture::{GroundTexture, TerrainTextures, UploadedTerrain, uv_from_world},
    window::{DrawnTerrain, TerrainWindow},
};
use crate::{
    error::{Error, Result, Status},
    gpu::Device,
    surroundings::LyingSnow,
    world::World,
};

/// Submits the transition of textures to reading after they were written.
fn hand_over<'a>(device: &Device, textures: impl Iterator<Item = &'a wgpu::Texture>) {
    let label = wgpu::CommandEncoderDescriptor { label: Some("ground texture") };
    let mut encoder = device.device.create_command_encoder(&label);
    let state = wgpu::TextureUses::RESOURCE;
    let each = textures.map(|texture| wgpu::TextureTransition { texture, selector: None, state });
    encoder.transition_resources(std::iter::empty(), each);
    device.submit(encoder);
}

impl HeldGround {
    /// Returns the water on the host's terrain as an up-to-date texture for the host's own materials. Changes since the
    /// last call, which come at most every 10 s of simulation time, are uploaded and submitted. The texture object
    /// stays the same until another grid is set or loaded; the next call of this function or the next frame of a view
    /// then drops it.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] without a terrain, [`Status::DeviceLost`], or a GPU fault.
    pub fn texture(&mut self, device: &Arc<Device>, snow: Option<&LyingSnow>) -> Result<GroundTexture> {
        let Some((grid, to_enu)) = self.drawn_terrain() else {
            return Err(Error::new(
                Status::WrongOrder,
                "the ground's texture comes after wk_context_set_ground_grid: there is no terrain",
            ));
        };
        let rows = uv_from_world(&DrawnTerrain::of_grid(grid, to_enu));
        let _entered = device.enter()?;
        let mut textures = self.locked();
        let Some(UploadedTerrain { water, generation, revision, .. }) = self.fill(device, &mut textures, snow).cloned()
        else {
            return Err(Error::new(Status::Internal, "a terrain without textures"));
        };
        let snow = textures.host_snow(device, snow.filter(|s| s.cells.len() as u32 == water.width() * water.height()));
        if std::mem::take(&mut textures.written) {
            hand_over(device, std::iter::once(&water).chain(&snow));
        }
        device.check()?;
        Ok(GroundTexture { texture: water, snow, generation, revision, uv_from_world: rows })
    }

    /// Returns the water and the snow on the tiles around a place, for the host's own materials; see
    /// [`Context::terrain_texture`](crate::context::Context::terrain_texture).
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for a `center` outside the world, [`Status::WrongOrder`] if no tile reaches into the
    /// window, [`Status::DeviceLost`], or a GPU fault.
    pub fn terrain_texture(&mut self, device: &Arc<Device>, world: &World, center: DVec3) -> Result<GroundTexture> {
        world.frame.place_at("center", center)?;
        let none = || {
            let wanted =
                "the terrain's texture comes after wk_context_set_terrain_tile: no tile reaches into the window";
            Error::new(Status::WrongOrder, wanted)
        };
        let drawn = world.set.tiles.as_deref().and_then(|terrain| DrawnTerrain::window(terrain, center));
        let rows = uv_from_world(&drawn.ok_or_else(none)?);
        let _entered = device.enter()?;
        let mut window = self.host_window.take().unwrap_or_else(|| Box::new(TerrainWindow::for_host()));
        let before = window.writes;
        let ice = world.timeline.at(world.time_s).surface.ice;
        if let Some(shown) = self.shown_tiles(world, ice) {
            window.views(device, center, &shown);
        }
        let textures = window.textures().cloned();
        let revision = window.writes;
        self.host_window = Some(window);
        let [water, snow] = textures.ok_or_else(none)?;
        let snow = world.snow.is_some().then_some(snow);
        if before != revision {
            hand_over(device, std::iter::once(&water).chain(&snow));
        }
        device.check()?;
        Ok(GroundTexture { texture: water, snow, generation: 1, revision, uv_from_world: rows })
    }

    /// Returns the texture views of the terrain's water and surface for drawing, brought up to date if `wanted`. `None`
    /// without a grid, or if they were never wanted. If `wanted`, the host's GPU context must be current
    /// ([`Device::enter`]).
    pub fn views(
        &self,
        device: &Arc<Device>,
        wanted: bool,
        snow: Option<&LyingSnow>,
    ) -> [Option<wgpu::TextureView>; 2] {
        let mut textures = self.locked();
        let filled = if wanted { self.fill(device, &mut textures, snow) } else { textures.filled() };
        filled.map_or([None, None], |f| f.views.clone().map(Some))
    }

    /// Updates and returns the textures; `None` without a grid. The host's GPU context must be current
    /// ([`Device::enter`]).
    fn fill<'a>(
        &self,
        device: &Arc<Device>,
        textures: &'a mut TerrainTextures,
        snow: Option<&LyingSnow>,
    ) -> Option<&'a UploadedTerrain> {
        let Some(held) = &self.host else {
            *textures = TerrainTextures::default();
            return None;
        };
        let numbers = [self.generation, self.revision, self.classes_revision];
        textures.upload(device, &held.terrain, &held.water, |cell| held.ice(cell), numbers);
        textures.upload_snow(device, snow.filter(|s| s.cells.len() == held.terrain.grid.len()))
    }

    /// Locks the textures.
    fn locked(&self) -> MutexGuard<'_, TerrainTextures> {
        // A panic may have left textures half-written; they are then written again.
        self.textures.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
