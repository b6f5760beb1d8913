//! The context's tables of the sky: made once, led after the air by parts, at most once a frame however many views.

use std::{
    ops::Deref,
    sync::{Arc, MutexGuard},
};

use super::Context;
use crate::{
    error::{Error, Result, Status},
    gpu::Device,
    sky::{LightTable, Planet, SkyModel, SkySettings, SkyTables},
};

/// Largest share of a rebuild that one frame pays.
const SHARE_PER_FRAME: f32 = 1.0 / 16.0;

/// Tables that follow the weather's air.
pub(crate) struct FollowedSky {
    tables: SkyTables,
    frame_id: Option<u64>,
    light: Option<(u64, Arc<LightTable>)>,
}

impl FollowedSky {
    pub(super) fn new(device: &Arc<Device>, settings: &SkySettings) -> Result<Self> {
        let _entered = device.enter()?;
        Ok(Self { tables: SkyTables::new(device, settings)?, frame_id: None, light: None })
    }

    /// Leads the tables after `planet` by one frame's share of work; whole at the first frame, and where the picture may
    /// not depend on earlier ones. Says whether anything was built.
    pub fn follow(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        planet: &Planet,
        frame_id: u64,
        whole: bool,
    ) -> Result<bool> {
        if !whole && self.frame_id == Some(frame_id) {
            return Ok(false);
        }
        self.frame_id = Some(frame_id);
        let progress = self.tables.update(encoder, planet, if whole { 1.0 } else { SHARE_PER_FRAME })?;
        device.check()?;
        Ok(progress.work > 0.0)
    }

    /// The light of the tables as they are shown, read back once a revision; built for `planet` if nothing is yet.
    pub fn light_table(&mut self, device: &Device, planet: &Planet) -> Result<Arc<LightTable>> {
        if self.tables.planet().is_none() {
            let mut encoder = device.device.create_command_encoder(&Default::default());
            self.tables.update(&mut encoder, planet, 1.0)?;
            device.submit_and_wait(encoder)?;
        }
        let revision = self.tables.revision();
        if let Some((read, light)) = &self.light
            && *read == revision
        {
            return Ok(light.clone());
        }
        let light = Arc::new(self.tables.read_light()?);
        self.light = Some((revision, light.clone()));
        Ok(light)
    }
}

impl Deref for FollowedSky {
    type Target = SkyTables;

    fn deref(&self) -> &SkyTables {
        &self.tables
    }
}

impl Context {
    pub(crate) fn sky(&self) -> Result<MutexGuard<'_, FollowedSky>> {
        self.sky.lock().map_err(|_| Error::new(Status::Poisoned, "an earlier call panicked while building the sky"))
    }

    /// Whether the sky is marched per pixel.
    pub(crate) fn marches_sky(&self) -> bool {
        self.desc.sky.model == SkyModel::BruteForce
    }
}
