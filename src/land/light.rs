//! Light on the drawn terrain: sun, moon and sky at the ground below the camera.

use glam::DVec3;

use super::eye::LandEye;
use crate::{
    error::Result,
    moment::Scene,
    stage::FrameContext,
    terrain::{CellRect, Terrain},
};

/// Height of the camera above the ground, m, up to which the light at the camera is used for the ground.
const AT_GROUND_M: f64 = 2.0;

/// Light on the ground, lux per channel of linear Rec. 709. Directions are east, north, up at the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LandLight {
    pub sun: DVec3,
    /// Direct light on a surface that faces the sun, as a mean over the shadows of clouds.
    pub sun_lux: [f64; 3],
    pub moon: DVec3,
    pub moon_lux: [f64; 3],
    /// Light of the sky on level ground.
    pub sky_lux: [f64; 3],
    /// Light that the ground reflects onto a surface that faces downwards.
    pub bounce_lux: [f64; 3],
}

impl LandLight {
    /// Whether the sun is the light that casts shadows, and not the moon.
    pub fn is_sunny(&self) -> bool {
        self.sun_lux[1] >= self.moon_lux[1]
    }

    /// Direction of the light that casts shadows; `None` in darkness.
    pub fn shaded(&self) -> Option<DVec3> {
        let (lux, direction) = if self.is_sunny() { (self.sun_lux, self.sun) } else { (self.moon_lux, self.moon) };
        (lux[1] > 0.0).then_some(direction)
    }

    /// Returns the light of a scene. `to_local` rotates from the scene's axes to the camera's.
    fn of(scene: &Scene, to_local: glam::DMat3) -> Self {
        let light = &scene.ground;
        let level = |i: usize| {
            light.sky_lux[i]
                + light.sun_lux[i] * scene.sun.direction.z.max(0.0)
                + light.moon_lux[i] * scene.moon.direction.z.max(0.0)
        };
        // Albedos are given at the planet's wavelengths, whose order is that of the channels.
        let bounce_lux = [0, 1, 2].map(|i| level(i) * scene.ground_albedo[i]);
        Self {
            sun: to_local * scene.sun.direction,
            sun_lux: light.sun_lux,
            moon: to_local * scene.moon.direction,
            moon_lux: light.moon_lux,
            sky_lux: light.sky_lux,
            bounce_lux,
        }
    }

    /// Returns the light at the ground below the camera; up to [`AT_GROUND_M`] above the ground it is the light at the
    /// camera. Outside the terrain's bounds the ground is that of the nearest place within them.
    ///
    /// # Errors
    /// As [`crate::world::World::scene_named`].
    pub fn below(context: &FrameContext<'_>, terrain: &Terrain, bounds: CellRect, eye: LandEye) -> Result<Self> {
        let scene = &context.now.scene;
        let end = |i: usize| [f64::from(bounds.low[i]), f64::from(bounds.high[i] - 1)];
        let plan = [0, 1].map(|i| eye.place[i].clamp(end(i)[0], end(i)[1]));
        let height = terrain.height_at(plan.into()).unwrap_or(0.0);
        if eye.place.z - height < AT_GROUND_M {
            return Ok(Self::of(scene, glam::DMat3::IDENTITY));
        }
        let cell_m = terrain.desc.cell_m;
        let local = DVec3::new(plan[0] * cell_m, plan[1] * cell_m, height);
        let position = terrain.desc.origin + terrain.to_enu.transpose() * local;
        let below = context.world.scene_named("terrain", position, context.now.time_s)?;
        Ok(Self::of(&below, scene.world_to_enu * below.world_to_enu.transpose()))
    }
}
