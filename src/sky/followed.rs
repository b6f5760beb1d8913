//! Tables of the sky that follow the weather's air. They are built in steps, at most one step a frame for all views.

use std::{
    ops::{Deref, DerefMut},
    path::PathBuf,
    sync::Arc,
};

use super::{AirChange, LightTable, Planet, SkyLibrary, SkySettings, SkyTables};
use crate::{error::Result, gpu::Device};

/// Tables that follow the weather's air.
pub(crate) struct FollowedSky {
    tables: SkyTables,
    /// Directory of the cache.
    cache: Option<PathBuf>,
    /// First planet, while the cache lacks its tables; `None` without a cache.
    first: Option<Planet>,
    /// Frame in which the last step of a build was done.
    frame_id: Option<u64>,
    /// Light that was read back, and the revision of the tables that it belongs to.
    light: Option<(u64, Arc<LightTable>)>,
}

impl FollowedSky {
    pub fn new(
        device: &Arc<Device>,
        library: &SkyLibrary,
        settings: &SkySettings,
        cache: Option<PathBuf>,
    ) -> Result<Self> {
        let _entered = device.enter()?;
        Ok(Self {
            tables: SkyTables::of_library(library, device, settings)?,
            cache,
            first: None,
            frame_id: None,
            light: None,
        })
    }

    /// Directory of the cache for finished tables, if there is one.
    pub fn cache_dir(&self) -> Option<PathBuf> {
        self.cache.clone()
    }

    /// Changes the settings. Nothing is shown until the next build, as for new tables.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the setting; GPU faults. Nothing changes then.
    pub fn set_settings(&mut self, device: &Arc<Device>, library: &SkyLibrary, settings: &SkySettings) -> Result<()> {
        if self.tables.settings() != settings {
            *self = Self::new(device, library, settings, self.cache.clone())?;
        }
        Ok(())
    }

    /// Drops the shown tables if they belong to another body than `planet`. If no tables are shown then and there is a
    /// cache, shows the tables of `planet`, if the library has finished ones or the cache holds them. Otherwise
    /// `planet` becomes the first planet.
    fn begin(&mut self, planet: &Planet) -> Result<()> {
        if self.tables.planet().is_some_and(|shown| !is_same_body(shown, planet)) {
            self.tables.forget();
        }
        match &self.cache {
            Some(cache) if self.tables.planet().is_none() => self.tables.begin_with(planet, cache)?,
            _ => return Ok(()),
        }
        self.first = Some(*planet).filter(|_| self.tables.planet().is_none());
        Ok(())
    }

    /// Writes the tables of the first planet to the cache, if there is one, once they are built. Later tables are not
    /// kept, because a changing weather makes many.
    fn keep_first(&mut self) {
        if let (Some(set), Some(first), Some(cache)) = (self.tables.shown_whole(), self.first, &self.cache)
            && set.planet == first
        {
            self.tables.kit().keep(set, cache);
            self.first = None;
        }
    }

    /// Continues building the tables of the changing air, unless this frame has already done so. `share` is the work to
    /// do, as a share of a build with the default settings. The first frame gets a draft. A share of 1 builds the
    /// tables whole in any call, for pictures that must not depend on earlier pictures. Returns whether anything was
    /// built; a step of a fade does not count.
    pub fn build_toward(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        change: AirChange<'_>,
        frame_id: u64,
        share: f32,
    ) -> Result<bool> {
        if share < 1.0 && self.frame_id == Some(frame_id) {
            return Ok(false);
        }
        self.frame_id = Some(frame_id);
        self.begin(change.now)?;
        let share = if share < 1.0 { self.tables.paced(share) } else { share };
        let progress = self.tables.update_along(encoder, change, share)?;
        self.keep_first();
        device.check()?;
        Ok(progress.work > 0.0)
    }

    /// Light of the tables that are shown, read back from the GPU once a revision. If there are no tables yet, those of
    /// `planet` are built.
    pub fn light_table(&mut self, device: &Device, planet: &Planet) -> Result<Arc<LightTable>> {
        self.begin(planet)?;
        if self.tables.planet().is_none() {
            let mut encoder = device.device.create_command_encoder(&Default::default());
            self.tables.update(&mut encoder, planet, 1.0)?;
            self.keep_first();
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

/// Whether two planets are the same body, perhaps under different weathers: whether they have the same radii and the
/// same wavelengths.
fn is_same_body(a: &Planet, b: &Planet) -> bool {
    let body = |p: &Planet| (p.bottom_radius_m, p.top_radius_m, p.wavelengths_nm);
    body(a) == body(b)
}

impl DerefMut for FollowedSky {
    fn deref_mut(&mut self) -> &mut SkyTables {
        &mut self.tables
    }
}

impl Deref for FollowedSky {
    type Target = SkyTables;

    fn deref(&self) -> &SkyTables {
        &self.tables
    }
}
