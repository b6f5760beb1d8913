//! Night light behind the sky's own light in one direction, in f64, for queries. It is the light that `night_light` in
//! `shaders/between/sky.wgsl` computes from the layer of the night sky, without the points in that layer.

use glam::DVec3;

use super::{
    NightSky, StarSettings,
    places::to_world_and_sun,
    view::{LEAST_THROUGH, POINTS_BEGIN_DEG},
};
use crate::{
    almanac::Utc,
    error::Result,
    moment::Scene,
    world::{night_share, zenith_depth},
};

/// Light of the night sky behind the air's own light, over a place.
pub(crate) struct NightBehind {
    /// Luminance of an even sky, cd/m^2 a channel: used where no glow is drawn, and mixed with the glow in twilight.
    even_cd_m2: [f64; 3],
    /// The glow, and its share in the mix with the even sky, 0 to 1. `None` where no glow is drawn.
    glow: Option<(NightSky, f64)>,
}

impl NightBehind {
    /// Creates the night light of a scene at a universal time. `fog_depth` is the fog's optical depth straight up.
    /// No glow is computed by day, in bright twilight, or behind dense fog or a closed deck.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a time outside the almanac's range or a place out of range.
    pub fn new(scene: &Scene, utc: Utc, settings: &StarSettings, fog_depth: f64) -> Result<Self> {
        let even_cd_m2 = scene.night_floor_cd_m2;
        let open = (1.0 - scene.deck_cover) * (-fog_depth).exp();
        let elevation = scene.sun.direction.z.clamp(-1.0, 1.0).asin().to_degrees();
        let share = night_share(&scene.sun);
        if elevation >= POINTS_BEGIN_DEG.0 || open < LEAST_THROUGH || share == 0.0 {
            return Ok(Self { even_cd_m2, glow: None });
        }
        let (place, altitude_m) = (&scene.place, scene.place.altitude_m.max(0.0));
        let (to_world, sun) = to_world_and_sun(utc, place, settings.celestial_to_world)?;
        let depth = zenith_depth(&scene.planet, altitude_m);
        let sky = NightSky::under(&to_world, sun, altitude_m, depth, settings.airglow);
        Ok(Self { even_cd_m2, glow: Some((sky, share)) })
    }

    /// Luminance in a direction (east, north, up; unit), cd/m^2 a channel of linear Rec. 709.
    pub fn toward(&self, direction: DVec3) -> [f64; 3] {
        let Some((sky, share)) = &self.glow else { return self.even_cd_m2 };
        let night = sky.luminance(direction);
        [0, 1, 2].map(|k| self.even_cd_m2[k] + (night[k] - self.even_cd_m2[k]) * share)
    }
}
