//! The context's tables of the sky.

use std::sync::{Arc, Mutex, MutexGuard};

use super::{Context, air::planet_under};
use crate::{
    error::{Error, Result, Status},
    sky::FollowedSky,
};

impl Context {
    pub(crate) fn sky(&self) -> Result<MutexGuard<'_, FollowedSky>> {
        self.sky.lock().map_err(|_| Error::new(Status::Poisoned, "an earlier call panicked while building the sky"))
    }

    /// Builds the tables of the sky for the weather of the present time now, in sixteen parts with a wait for the GPU after
    /// each, and shows them, so that no frame has to. Tables that another context of the device shows, or that lie in
    /// [`super::ContextDesc::cache_dir`], are taken instead; new ones are written there. `progress` is told the share done,
    /// 1 at last; when it answers false the build ends, and the context stays as it was.
    ///
    /// # Errors
    /// [`Status::Aborted`], [`Status::DeviceLost`], or a GPU fault.
    pub fn build_sky(&self, progress: &mut dyn FnMut(f32) -> bool) -> Result<()> {
        let planet = planet_under(&self.desc.planet, &self.timeline.at(self.time_s));
        planet.check()?;
        // Not under the sky's lock: frames and queries of other threads go on while parts are built.
        let kit = self.sky()?.kit().clone();
        let set = kit.build(&planet, self.desc.cache_dir.as_deref(), progress)?;
        let _entered = self.device.enter()?;
        self.sky()?.show_now(set)
    }

    /// The same for a view to keep.
    pub(crate) fn sky_tables(&self) -> &Arc<Mutex<FollowedSky>> {
        &self.sky
    }
}
