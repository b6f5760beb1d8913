//! State at a camera at a time, `SceneMoment`: its scene, the weather elsewhere, and the host's surroundings.

use std::cell::OnceCell;

use glam::DVec3;

use super::{regions::WeatherOver, scene::Scene};
use crate::{
    error::Result,
    falling::FallingLayer,
    gpu::Device,
    light::{Exposure, ToneCurve},
    scene::{FlashLamp, HostLight, MAX_FLASH_LAMPS},
    surroundings::{HostSurroundings, OccluderMaps, Shelter, ShelterReach, WindMap, WindTexture, WindView},
    weather::Conditions,
    wind::{Carrying, Detour, WindVolume},
};

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

    /// The host's shelters, occluder maps and lamps as the camera needs them. `reach`: fall speed of the slowest of
    /// what is drawn, m/s, and how far off any of it is, m; `exposure`: what it is exposed by.
    ///
    /// # Errors
    /// As [`SceneMoment::carrying`].
    pub fn host_surroundings(&self, reach: ShelterReach, exposure: f64) -> Result<HostSurroundings<'_>> {
        Ok(HostSurroundings {
            shelters: self.shelters,
            maps: self.maps,
            lights: self.lamps,
            flash: self.flash_lamps(),
            eye: self.eye,
            to_enu: self.scene.world_to_enu,
            time_s: self.time_s,
            wind_m_s: self.carrying()?.velocity_m_s(),
            near: reach,
            exposure,
        })
    }

    /// Whether anything may keep rain off.
    pub fn is_sheltered(&self) -> bool {
        !self.shelters.is_empty() || self.has_maps()
    }
}
