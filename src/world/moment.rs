//! State at a camera of a world: its scene, and the host's surroundings.

use std::cell::OnceCell;

use glam::DVec3;

use super::{
    kept::{KeptScene, SharedScene},
    state::World,
};
use crate::{error::Result, moment::SceneMoment};

impl World {
    /// Returns the state at a camera at `eye`; errors call this position `name`. `kept` is the scene of an earlier
    /// call; it is reused if nothing has changed since.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is not a place on or above the planet.
    pub fn moment(&self, name: &str, eye: DVec3, kept: &mut Option<Box<KeptScene>>) -> Result<SceneMoment<'_>> {
        let SharedScene { scene, here, wind } = self.scene_kept(name, eye, kept)?;
        let weather = self.over();
        let carried = wind.map(|now| weather.wind.carrying_as(self.time_s, now));
        Ok(SceneMoment {
            eye,
            time_s: self.time_s,
            seed: self.seed,
            tone: self.tone,
            exposure: self.exposure,
            planet_radius_m: self.set.planet.bottom_radius_m,
            weather,
            here,
            falling: self.falling(&scene.conditions),
            outer_fog: self.outer_fog(&scene.conditions, self.time_s)?,
            shelters: &self.set.shelters,
            maps: self.maps.as_deref(),
            lamps: &self.lights,
            wind_volume: self.wind_volume(self.time_s),
            wind_texture: &self.wind_texture,
            detour: self.detour(eye, &scene.conditions, self.time_s),
            carried: carried.map_or_else(OnceCell::new, OnceCell::from),
            flash: OnceCell::new(),
            scene,
        })
    }
}
