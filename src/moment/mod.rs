//! State at a camera's place at a time: lights, air, clouds overhead, and the light on the ground.
//!
//! A context works it out ([`crate::context::Context::scene_at`]); every effect reads it.

mod around;
mod regions;

use std::cell::OnceCell;

use glam::{DMat3, DVec3};

pub use around::LightAround;
pub(crate) use regions::{Region, WeatherOver};

use crate::{
    error::Result,
    falling::FallingLayer,
    gpu::Device,
    light::{Exposure, ToneCurve},
    planet::Planet,
    scene::{FlashLamp, HostLight, MAX_FLASH_LAMPS, Place},
    surroundings::{HostSurroundings, OccluderMaps, Shelter, ShelterReach, WindMap, WindTexture, WindView},
    weather::Conditions,
    wind::{Carrying, Detour, WindVolume},
};

/// Largest extinction that is accepted, 1/m: a visibility of 30 cm.
pub const MAX_EXTINCTION_PER_M: f64 = 10.0;

/// State at a camera at a time: every effect draws from it. Its scene is worked out once for all calls of a frame.
pub(crate) struct SceneMoment<'a> {
    /// Place, lights, air and the weather there.
    pub scene: Scene,
    /// The camera in the host's world, m.
    pub eye: DVec3,
    /// Simulation time, s.
    pub time_s: f64,
    /// Seed of everything that chance decides.
    pub seed: u64,
    /// From luminance to the display.
    pub tone: ToneCurve,
    /// Exposure of frames that bring none.
    pub exposure: Exposure,
    /// Radius of the planet's ground, m.
    pub planet_radius_m: f64,
    /// The weather at other places and times.
    pub weather: WeatherOver<'a>,
    /// That at the camera, with what falls in its region.
    pub here: Conditions,
    /// Extinction of what falls outside of all regions.
    pub falling: FallingLayer,
    /// Shelters, which keep rain off: the host's boxes, and its maps if there are any.
    pub shelters: &'a [Shelter],
    pub maps: Option<&'a OccluderMaps>,
    /// The host's lamps.
    pub lamps: &'a [HostLight],
    /// The wind that varies in space: a host's grid, or a solved field.
    pub wind_volume: Option<&'a WindVolume>,
    pub wind_texture: &'a WindTexture,
    /// How that leads the patches of the weather's low layer, where they show it.
    pub detour: Option<Detour>,
    pub carried: OnceCell<Carrying<'a>>,
    /// Light of flashes of lightning in this frame, once it is known.
    pub flash: OnceCell<FlashLight>,
}

/// Light of flashes of lightning: the places that it comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FlashLight {
    pub lamps: [FlashLamp; MAX_FLASH_LAMPS],
    pub count: usize,
}

impl<'a> SceneMoment<'a> {
    /// The wind that carries the air, up to now.
    ///
    /// # Errors
    /// For a time that the weather does not know.
    pub fn carrying(&self) -> Result<&Carrying<'a>> {
        if let Some(carrying) = self.carried.get() {
            return Ok(carrying);
        }
        let carrying = self.weather.carrying_until(self.time_s)?;
        Ok(self.carried.get_or_init(|| carrying))
    }

    /// The wind at a place of the host's world now, m/s (east, north, up), where the weather's is `weathers`: what
    /// varies in space replaces it there, or is added to it.
    pub fn wind_about(&self, position: DVec3, weathers: DVec3) -> DVec3 {
        self.wind_volume.and_then(|volume| volume.wind(position, weathers)).unwrap_or(weathers)
    }

    /// The wind that varies in space as shaders read it (`shaders/surroundings/wind.wgsl`), and where the camera is in
    /// it; none where the weather's wind blows everywhere, and then the texture is one that nothing reads.
    pub fn wind_texture(&self, device: &Device) -> (WindView, Option<WindMap>) {
        let map = self.wind_volume.map(|volume| WindMap::new(volume, self.eye));
        (self.wind_texture.view(device, self.wind_volume), map)
    }

    /// Light of flashes in this frame, as lamps: position relative to the camera, luminous flux, and whether it shines
    /// inside a cloud.
    pub fn flash_lamps(&self) -> &[FlashLamp] {
        self.flash.get().map_or(&[], |flash| &flash.lamps[..flash.count])
    }

    /// Whether any lamp shines, of the host's or of a flash.
    pub fn has_lamps(&self) -> bool {
        !(self.lamps.is_empty() && self.flash_lamps().is_empty())
    }

    /// Whether any map of the host's shows anything.
    pub fn has_maps(&self) -> bool {
        self.maps.is_some_and(|m| m.ranges().is_some())
    }

    /// The host's shelters, occluder maps and lamps as the camera needs them. `near`: fall speed of the slowest of what
    /// is drawn, m/s, and how far off any of it is, m; `exposure`: what it is exposed by.
    ///
    /// # Errors
    /// As [`SceneMoment::carrying`].
    pub fn host_surroundings(&self, near: ShelterReach, exposure: f64) -> Result<HostSurroundings<'_>> {
        Ok(HostSurroundings {
            shelters: self.shelters,
            maps: self.maps,
            lights: self.lamps,
            flash: self.flash_lamps(),
            eye: self.eye,
            to_enu: self.scene.world_to_enu,
            time_s: self.time_s,
            wind_m_s: self.carrying()?.velocity_m_s(),
            near,
            exposure,
        })
    }

    /// Whether anything may keep rain off.
    pub fn is_sheltered(&self) -> bool {
        !self.shelters.is_empty() || self.has_maps()
    }
}

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
