//! What a camera's place and the present moment come to: lights, air and what the frame needs of them.

use glam::{DMat3, DVec3};

use super::Context;
use crate::scene::Place;

/// The sun or the moon as it stands over a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Towards it, local east-north-up, without refraction: what scattering sees.
    pub direction: DVec3,
    /// Towards it as it appears, lifted by refraction.
    pub apparent: DVec3,
    /// Towards where the bright limb points.
    pub bright_limb: DVec3,
    /// Angular radius, rad.
    pub angular_radius: f64,
    /// Lit part of the face.
    pub lit: f64,
    /// Illuminance above the air on a surface facing it, lux a channel.
    pub illuminance_lux: [f64; 3],
    /// Vertical over horizontal diameter.
    pub flattening: f64,
    /// Share of direct light that clouds let through.
    pub direct_share: f64,
    /// Whether it adds anything to the picture.
    pub matters: bool,
}

/// Everything a view draws from, at one camera position and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    /// The camera's place.
    pub place: Place,
    /// Host axes to local east-north-up.
    pub world_to_enu: DMat3,
    /// The sun.
    pub sun: Light,
    /// The moon.
    pub moon: Light,
    /// Airglow and starlight, cd/m^2 a channel.
    pub night_floor_cd_m2: [f64; 3],
    /// Zenith luminance of the cloud deck's underside, cd/m^2 a channel.
    pub deck_cd_m2: [f64; 3],
    /// Share of the sky that the deck hides.
    pub deck_cover: f64,
    /// Share of the clear sky's light that the air below a deck scatters.
    pub medium_share: f64,
    /// Illuminance on level ground, lux.
    pub ground_illuminance_lux: f64,
    /// Direct sun at the place on a surface facing it, lux a channel.
    pub sun_ground_lux: [f64; 3],
    /// The sky's light on level ground, lux a channel.
    pub sky_ground_lux: [f64; 3],
}

impl Context {
    /// What the camera at `position` draws from now.
    pub fn scene_at(&self, position: DVec3) -> Scene {
        let local = self.desc.world.frame_at(position);
        let direction = self.given_sun.map_or(DVec3::Z, |s| s.unit());
        let sun = Light {
            direction,
            apparent: direction,
            bright_limb: DVec3::Z,
            angular_radius: self.desc.planet.sun_angular_radius_deg.to_radians(),
            lit: 1.0,
            illuminance_lux: [128e3; 3],
            flattening: 1.0,
            direct_share: 1.0,
            matters: true,
        };
        Scene {
            place: local.place,
            world_to_enu: local.world_to_enu,
            sun,
            moon: Light { matters: false, illuminance_lux: [0.0; 3], ..sun },
            night_floor_cd_m2: [2e-4; 3],
            deck_cd_m2: [0.0; 3],
            deck_cover: 0.0,
            medium_share: 1.0,
            ground_illuminance_lux: 1e5 * direction.z.max(0.0) + 0.01,
            sun_ground_lux: [1e5; 3],
            sky_ground_lux: [1.2e4, 1.5e4, 2e4],
        }
    }
}
