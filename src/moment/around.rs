//! Light on the small things about a camera: the sky and the ground, each by its mean, and the sun or moon.

use std::f64::consts::PI;

use glam::DVec3;

use super::scene::Scene;

/// Light on the things that fall about a camera, cd/m^2 and lux or these times an exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightAround {
    /// Mean radiance of the sky.
    pub above: DVec3,
    /// That of the ground.
    pub below: DVec3,
    /// Irradiance of the sun or moon.
    pub sun: DVec3,
    /// Where it stands: east, north, up.
    pub to_sun: DVec3,
}

impl LightAround {
    /// Creates the light of a scene: the mean of its sky and of its ground. In steady rain that is within 1 % of the
    /// light of the veil, so that no ring shows where the veil takes over.
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

    /// In the units of a picture that is exposed so.
    pub fn exposed(self, exposure: f64) -> Self {
        Self { above: self.above * exposure, below: self.below * exposure, sun: self.sun * exposure, ..self }
    }
}
