//! Light on small things around a camera, such as drops and flakes: mean sky, mean ground, and the sun or moon.

use std::f64::consts::PI;

use glam::DVec3;

use super::scene::Scene;

/// Light on drops and flakes around a camera, per channel of linear Rec. 709, in cd/m^2 and lux.
/// [`LightAround::exposed`] multiplies it by an exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightAround {
    /// Mean luminance of the sky.
    pub above: DVec3,
    /// Mean luminance of the ground.
    pub below: DVec3,
    /// Illuminance by the sun or the moon, whichever is brighter.
    pub sun: DVec3,
    /// Unit vector towards the sun or moon of `sun`, (east, north, up).
    pub to_sun: DVec3,
}

impl LightAround {
    /// Creates the light of a scene from the mean of its sky and of its ground. In steady rain, single drops differ in
    /// brightness by less than 1 % from distant rain, which is drawn as part of the air, so that no ring shows where
    /// the single drops end.
    pub fn of(scene: &Scene) -> Self {
        let light = scene.brighter();
        let g = &scene.ground;
        let lux = if light == &scene.sun { g.sun_lux } else { g.moon_lux };
        let level = light.direction.z.max(0.0);
        let albedo = scene.ground_albedo;
        let below = [0, 1, 2].map(|i| albedo[i] * (g.sky_lux[i] + lux[i] * level) / PI);
        Self {
            above: DVec3::from(g.sky_lux) / PI,
            below: DVec3::from(below),
            sun: DVec3::from(lux),
            to_sun: light.direction,
        }
    }

    /// Multiplies all light by `exposure`, for a picture with that exposure.
    pub fn exposed(self, exposure: f64) -> Self {
        Self { above: self.above * exposure, below: self.below * exposure, sun: self.sun * exposure, ..self }
    }
}
