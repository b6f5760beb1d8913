//! A scene that a view keeps between the calls of a frame, so that it is computed once for all these calls.

use std::sync::Arc;

use glam::DVec3;

use super::{
    settings::{GivenDirection, NightSettings},
    state::World,
};
use crate::{almanac::sun::Utc, error::Result, moment::Scene, planet::Planet, weather::Conditions, wind::Blowing};

/// A scene with the weather at its place, shared with the moments of frames: a copy takes longer than many an effect.
#[derive(Clone)]
pub(super) struct SharedScene {
    pub scene: Arc<Scene>,
    /// The weather at the camera, with the rain and drizzle of the rain areas there.
    pub here: Arc<Conditions>,
    /// The wind, if the scene needed it.
    pub wind: Option<Blowing>,
}

/// A scene, and the inputs from which it follows.
pub(crate) struct KeptScene {
    from: SceneInputs,
    shared: SharedScene,
    /// Number of scenes that have been computed in this slot.
    #[cfg(test)]
    pub count: u64,
}

/// Values of a world and a camera that determine a scene and can change. Equal inputs give equal scenes.
#[derive(Clone, Copy, PartialEq)]
struct SceneInputs {
    eye: DVec3,
    time_s: f64,
    /// Different in each world and after each change of its weather.
    timeline_revision: u64,
    surroundings_revision: u64,
    regions_revision: u64,
    utc_at_zero: Utc,
    given_sun: Option<GivenDirection>,
    given_moon: Option<GivenDirection>,
    undimmed: bool,
    planet: Planet,
    night: NightSettings,
    /// Cover of the simulated snow, its albedo, and the wind above which it drifts.
    snow: Option<[f64; 3]>,
}

impl World {
    /// Returns the present inputs of the scene at `eye`.
    fn scene_inputs(&self, eye: DVec3) -> SceneInputs {
        SceneInputs {
            eye,
            time_s: self.time_s,
            timeline_revision: self.timeline_revision,
            surroundings_revision: self.surroundings_revision,
            regions_revision: self.regions_revision,
            utc_at_zero: self.set.utc_at_zero,
            given_sun: self.set.given_sun,
            given_moon: self.set.given_moon,
            undimmed: self.set.undimmed,
            planet: self.set.planet,
            night: self.night,
            snow: self.snow.as_ref().map(|snow| [snow.cover, snow.country.albedo, snow.threshold_m_s]),
        }
    }

    /// Returns the present scene of a camera at `eye`; errors call this position `name`. The scene is the one in `kept`
    /// if that has the same time, place, weather and settings; else a new one, which replaces it.
    ///
    /// # Errors
    /// As [`World::scene_named`]; `kept` stays as it was.
    pub(super) fn scene_kept(&self, name: &str, eye: DVec3, kept: &mut Option<Box<KeptScene>>) -> Result<SharedScene> {
        let from = self.scene_inputs(eye);
        if let Some(known) = kept.as_deref().filter(|known| known.from == from) {
            return Ok(known.shared.clone());
        }
        let (scene, wind) = self.scene_and_wind(name, eye, self.time_s)?;
        let here = self.over().at_place(eye, self.time_s, scene.conditions);
        let Some(known) = kept else {
            let shared = SharedScene { scene: Arc::new(scene), here: Arc::new(here), wind };
            let new = KeptScene {
                from,
                shared: shared.clone(),
                #[cfg(test)]
                count: 1,
            };
            *kept = Some(Box::new(new));
            return Ok(shared);
        };
        replace(&mut known.shared.scene, scene);
        replace(&mut known.shared.here, here);
        (known.from, known.shared.wind) = (from, wind);
        #[cfg(test)]
        {
            known.count += 1;
        }
        Ok(known.shared.clone())
    }
}

/// Replaces a shared value, in its own place unless somebody else still has it.
fn replace<T>(shared: &mut Arc<T>, value: T) {
    match Arc::get_mut(shared) {
        Some(place) => *place = value,
        None => *shared = Arc::new(value),
    }
}
