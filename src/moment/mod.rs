//! What holds at a camera's place at a time: lights, air, clouds overhead, and the light on the ground.
//!
//! A context works it out ([`crate::context::Context::scene_at`]); every effect reads it.

use glam::{DMat3, DVec3};

use crate::{
    scene::Place,
    sky::{Disc, Lamp, Observer, Planet},
    weather::Conditions,
};

/// The sun or the moon as it stands over a place. Vectors are (east, north, up) there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Unit vector towards it, without refraction: what scattering sees.
    pub direction: DVec3,
    /// Unit vector towards it as it appears, lifted by refraction.
    pub apparent: DVec3,
    /// Unit vector in the disc's plane towards the middle of the lit limb (moon).
    pub bright_limb: DVec3,
    /// Angular radius, rad.
    pub angular_radius: f64,
    /// Lit part of the face, 0 to 1.
    pub lit: f64,
    /// Strength above the air at the planet's three wavelengths, relative to the sun at 1 au.
    pub spectrum: [f64; 3],
    /// Illuminance above the air on a surface facing it, lux in linear Rec. 709: their luminance-weighted sum is the
    /// illuminance.
    pub illuminance_lux: [f64; 3],
    /// Vertical over horizontal diameter of the disc, flattened by refraction.
    pub flattening: f64,
    /// Share of the direct light that clouds let through.
    pub direct_share: f64,
    /// Whether it adds to the picture.
    pub matters: bool,
}

/// Light that falls on level ground at a place, lux a channel of linear Rec. 709. Under fog the sun's and the moon's
/// aureoles, light scattered forward once, count as theirs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundLight {
    /// Direct sun on a surface that faces it, after air, clouds and fog.
    pub sun_lux: [f64; 3],
    /// Direct moon on a surface that faces it.
    pub moon_lux: [f64; 3],
    /// Sky, clouds and fog on level ground.
    pub sky_lux: [f64; 3],
    /// Everything on level ground as a luminance-weighted sum, lux.
    pub total_lux: f64,
    /// Luminance that an eye or a camera adapts to, cd/m^2: a grey ground and the sky above it.
    pub adaptation_cd_m2: f64,
}

/// Everything a view draws from, at one camera position and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    /// The camera's place.
    pub place: Place,
    /// Host axes to local east-north-up.
    pub world_to_enu: DMat3,
    /// Place on the map, m east and north of the world's origin.
    pub map_m: [f64; 2],
    /// How far the wind has carried the air, m east and north ([`Context::wind_displacement`]); 0 where no patch of fog or curtain of
    /// rain shows it.
    pub drift_m: [f64; 2],
    /// How far the curtains of the weather's rain have fallen, m, in their period.
    pub curtains_fallen_m: f64,
    /// The weather there.
    pub conditions: Conditions,
    /// The planet's air under that weather.
    pub planet: Planet,
    /// The sun.
    pub sun: Light,
    /// The moon.
    pub moon: Light,
    /// Linear Rec. 709 colours, cd/m^2 or lux, of light at the planet's three wavelengths under the sun of 1 au.
    pub color: [[f64; 3]; 3],
    /// Light on the ground.
    pub ground: GroundLight,
    /// Light on the low layer of fog, rain, snow or dust, if the place lies in one; else the same.
    pub above_fog: GroundLight,
    /// Airglow and starlight, cd/m^2 a channel.
    pub night_floor_cd_m2: [f64; 3],
    /// Zenith luminance of the cloud deck's underside, cd/m^2 a channel.
    pub deck_cd_m2: [f64; 3],
    /// Share of the sky that the deck hides.
    pub deck_cover: f64,
    /// Share of the clear sky's light that the air below the clouds scatters.
    pub medium_share: f64,
}

impl Scene {
    /// Whichever of sun and moon gives more light here.
    pub fn brighter(&self) -> &Light {
        if self.ground.sun_lux[1] >= self.ground.moon_lux[1] { &self.sun } else { &self.moon }
    }

    /// The sky's own view of this scene.
    pub(crate) fn observer(&self, exact: bool) -> Observer {
        let lamp = |light: &Light, disc| Lamp {
            toward: light.direction.to_array(),
            irradiance: light.spectrum,
            angular_radius: light.angular_radius,
            disc,
        };
        let moon = lamp(&self.moon, Disc::Moon { lit_from: self.moon_lit_from().to_array() });
        Observer {
            altitude_m: self.place.altitude_m.clamp(-1e4, 1e8),
            lamps: [Some(lamp(&self.sun, Disc::Sun)), self.moon.matters.then_some(moon)],
            refraction: 1.0,
            exact,
        }
    }

    /// The sun's direction as the moon's face sees it: in the plane of moon and bright limb, at the phase's angle.
    fn moon_lit_from(&self) -> DVec3 {
        let cos_phase = (2.0 * self.moon.lit - 1.0).clamp(-1.0, 1.0);
        let sin_phase = (1.0 - cos_phase * cos_phase).sqrt();
        (self.moon.bright_limb * sin_phase - self.moon.direction * cos_phase).normalize()
    }
}
