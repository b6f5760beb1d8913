//! Scene at a camera's place at a time: air, sun and moon, clouds overhead, and the light on the ground.

use glam::{DMat3, DVec3};

use crate::{planet::Planet, scene::Place, weather::Conditions};

/// Largest extinction that is accepted, 1/m: a visibility of 30 cm.
pub const MAX_EXTINCTION_PER_M: f64 = 10.0;

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
    /// Share of the direct light that clouds above the place let through, on the mean over places at its height.
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
    /// How far the wind has carried the air, m east and north (`Context::wind_displacement`); 0 where no patch of fog
    /// or curtain of rain shows it.
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
    /// The moon gives more light here than the sun, above clouds and fog: under both, whichever stands higher would be
    /// left.
    pub moon_is_brighter: bool,
    /// Light on the ground.
    pub ground: GroundLight,
    /// Share of it that the ground sends up again, at the planet's three wavelengths: the planet's, and as much as snow
    /// covers of it that snow's albedo.
    pub ground_albedo: [f64; 3],
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
    /// Whichever of sun and moon gives more light here, above clouds and fog.
    pub fn brighter(&self) -> &Light {
        if self.moon_is_brighter { &self.moon } else { &self.sun }
    }

    /// Sun and moon, as far as they light the picture.
    pub(crate) fn lamps(&self) -> u32 {
        1 + u32::from(self.moon.matters)
    }
}
