//! Scene at a camera's place at a time: air, sun and moon, clouds overhead, and the light on the ground.

use glam::{DMat3, DVec3};

use crate::{planet::Planet, scene::Place, weather::Conditions};

/// Largest extinction that is accepted, 1/m: a visibility of 30 cm.
pub const MAX_EXTINCTION_PER_M: f64 = 10.0;

/// The sun or the moon as seen from a place. Vectors are (east, north, up) at the place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Unit vector towards the sun or moon, without refraction: the direction that scattering uses.
    pub direction: DVec3,
    /// Unit vector towards its apparent position, which refraction lifts.
    pub apparent: DVec3,
    /// Unit vector in the plane of the disc towards the middle of the lit limb (moon).
    pub bright_limb: DVec3,
    /// Angular radius, rad.
    pub angular_radius: f64,
    /// Lit share of the face, 0 to 1.
    pub lit: f64,
    /// Strength above the air at the planet's three wavelengths, relative to the sun at 1 au.
    pub spectrum: [f64; 3],
    /// Illuminance above the air on a surface that faces the sun or moon, lux in linear Rec. 709. The
    /// luminance-weighted sum of the channels is the illuminance.
    pub illuminance_lux: [f64; 3],
    /// Ratio of the vertical to the horizontal diameter of the disc, which refraction flattens.
    pub flattening: f64,
    /// Share of the direct light that the clouds above the place let through, as a mean over all places at the same
    /// height.
    pub direct_share: f64,
    /// Whether the light of the sun or moon is bright enough to be drawn.
    pub matters: bool,
}

/// Light at the ground of a place, lux per channel of linear Rec. 709. Under fog, light that is scattered forward once
/// (the aureole) counts as direct light of the sun or moon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundLight {
    /// Direct sunlight on a surface that faces the sun, after air, clouds and fog.
    pub sun_lux: [f64; 3],
    /// Direct moonlight on a surface that faces the moon.
    pub moon_lux: [f64; 3],
    /// Light of sky, clouds and fog on level ground.
    pub sky_lux: [f64; 3],
    /// All light on level ground as a luminance-weighted sum, lux.
    pub total_lux: f64,
    /// Luminance to which an eye or a camera adapts, cd/m^2: grey ground with the sky above it.
    pub adaptation_cd_m2: f64,
}

/// Place, weather, air and lights from which a view draws, at one camera position and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    /// The camera's place.
    pub place: Place,
    /// Rotation from the host's axes to local (east, north, up).
    pub world_to_enu: DMat3,
    /// Position on the map, m east and north of the world's origin.
    pub map_m: [f64; 2],
    /// Distance over which the wind has carried the air, m east and north (`Context::wind_displacement`); 0 where no
    /// fog patches or rain curtains show it.
    pub drift_m: [f64; 2],
    /// Distance over which the curtains of the weather's rain have fallen, m, modulo their period.
    pub curtains_fallen_m: f64,
    /// The weather at the place.
    pub conditions: Conditions,
    /// The planet's air under that weather.
    pub planet: Planet,
    /// The sun.
    pub sun: Light,
    /// The moon.
    pub moon: Light,
    /// Linear Rec. 709 colours, cd/m^2 or lux, of light at the planet's three wavelengths under a sun at 1 au.
    pub color: [[f64; 3]; 3],
    /// Whether the moon gives more direct light here than the sun. The two are compared without clouds and fog, because
    /// clouds and fog would leave only the light of the one that stands higher.
    pub moon_is_brighter: bool,
    /// Light on the ground.
    pub ground: GroundLight,
    /// Albedo of the ground at the planet's three wavelengths: the planet's own, and the snow's for the share of the
    /// ground that snow covers.
    pub ground_albedo: [f64; 3],
    /// Light on top of the low layer of fog, rain, snow or dust, if the place lies in one; otherwise equal to `ground`.
    pub above_fog: GroundLight,
    /// Mean luminance of the moonless sky, cd/m^2 per channel.
    pub night_floor_cd_m2: [f64; 3],
    /// Zenith luminance of the cloud deck's underside, cd/m^2 per channel.
    pub deck_cd_m2: [f64; 3],
    /// Share of the sky that the deck hides.
    pub deck_cover: f64,
    /// Mean share of sunlight, direct and diffuse, that the clouds let through to the air below them.
    pub medium_share: f64,
}

impl Scene {
    /// Returns the sun or the moon, whichever gives more direct light here without clouds and fog.
    pub fn brighter(&self) -> &Light {
        if self.moon_is_brighter { &self.moon } else { &self.sun }
    }

    /// Returns the number of lights that contribute to the picture: the sun, and the moon if it is bright enough to be
    /// drawn.
    pub(crate) fn lamps(&self) -> u32 {
        1 + u32::from(self.moon.matters)
    }
}
