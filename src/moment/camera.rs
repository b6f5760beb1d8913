//! State at a camera at a time, `SceneMoment`: its scene, the weather elsewhere, and the host's surroundings.

use std::{cell::OnceCell, sync::Arc};

use glam::DVec3;

use super::{regions::WeatherOver, scene::Scene};
use crate::{
    error::Result,
    falling::FallingLayer,
    gpu::Device,
    light::{Exposure, ToneCurve},
    scene::{FlashLamp, HostLight, MAX_FLASH_LAMPS},
    surroundings::{HostSurroundings, OccluderMaps, Shelter, ShelterReach, WindMap, WindTexture, WindView},
    weather::{Conditions, GroundLayer},
    wind::{Carrying, Detour, WindVolume},
};

/// State at a camera at a time, from which every effect draws. The scene is computed once for all calls of a frame.
pub(crate) struct SceneMoment<'a> {
    /// Place, lights, air and the weather there.
    pub scene: Arc<Scene>,
    /// Position of the camera in the host's world, m.
    pub eye: DVec3,
    /// Simulation time, s.
    pub time_s: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Tone curve from luminance to the display.
    pub tone: ToneCurve,
    /// Exposure of a frame for which the host sets none.
    pub exposure: Exposure,
    /// Radius of the planet's ground, m.
    pub planet_radius_m: f64,
    /// The weather at other places and times.
    pub weather: WeatherOver<'a>,
    /// The weather at the camera, with the rain and drizzle of the rain areas there.
    pub here: Arc<Conditions>,
    /// Extinction of the precipitation outside all regions.
    pub falling: FallingLayer,
    /// Low layer of fog, mist or dust outside all regions.
    pub outer_fog: GroundLayer,
    /// The host's shelters: boxes that keep rain off.
    pub shelters: &'a [Shelter],
    /// The host's occluder maps, if it has set any.
    pub maps: Option<&'a OccluderMaps>,
    /// The host's lamps.
    pub lamps: &'a [HostLight],
    /// The wind that varies in space: a host's grid, or a solved field.
    pub wind_volume: Option<&'a WindVolume>,
    /// Texture of the wind in `wind_volume`, for shaders.
    pub wind_texture: &'a WindTexture,
    /// Detour of the patches of the weather's low layer in the wind of `wind_volume` (`src/wind/detour.rs`); `None`
    /// where there are no patches.
    pub detour: Option<Detour>,
    /// Wind that carries the air, computed at its first use.
    pub carried: OnceCell<Carrying<'a>>,
    /// Light of lightning flashes in this frame, set once it has been computed.
    pub flash: OnceCell<FlashLight>,
}

/// Light of lightning flashes, as a list of lamps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FlashLight {
    /// Lamps, of which the first `count` shine.
    pub lamps: [FlashLamp; MAX_FLASH_LAMPS],
    /// Number of `lamps` that shine.
    pub count: usize,
}

impl<'a> SceneMoment<'a> {
    /// Returns the wind that carries the air, from time 0 until now.
    ///
    /// # Errors
    /// As [`WeatherOver::check_time`].
    pub fn carrying(&self) -> Result<&Carrying<'a>> {
        if let Some(carrying) = self.carried.get() {
            return Ok(carrying);
        }
        let carrying = self.weather.carrying_until(self.time_s)?;
        Ok(self.carried.get_or_init(|| carrying))
    }

    /// Returns the wind now at a position of the host's world, m/s (east, north, up). `weathers` is the weather's wind
    /// there; a wind that varies in space replaces it or is added to it.
    pub fn wind_about(&self, position: DVec3, weathers: DVec3) -> DVec3 {
        self.wind_volume.and_then(|volume| volume.wind(position, weathers)).unwrap_or(weathers)
    }

    /// Returns the texture of the wind that varies in space, which shaders read (`shaders/surroundings/wind.wgsl`), and
    /// the camera's mapping into it. The mapping is `None` where the weather's wind blows everywhere: no shader then
    /// reads the texture.
    pub fn wind_texture(&self, device: &Device) -> (WindView, Option<WindMap>) {
        let map = self.wind_volume.map(|volume| WindMap::new(volume, self.eye));
        (self.wind_texture.view(device, self.wind_volume), map)
    }

    /// Returns the light of the flashes in this frame, as lamps: position relative to the camera, luminous flux, and
    /// whether the lamp is inside a cloud.
    pub fn flash_lamps(&self) -> &[FlashLamp] {
        self.flash.get().map_or(&[], |flash| &flash.lamps[..flash.count])
    }

    /// Whether any lamp shines: one of the host's or a flash.
    pub fn has_lamps(&self) -> bool {
        !(self.lamps.is_empty() && self.flash_lamps().is_empty())
    }

    /// Whether any of the host's occluder maps holds a surface.
    pub fn has_maps(&self) -> bool {
        self.maps.is_some_and(|m| m.ranges().is_some())
    }

    /// Returns the host's shelters, occluder maps and lamps as the camera needs them. `reach`: fall speed of the
    /// slowest particles drawn, m/s, and the largest distance at which they are drawn, m. `exposure`: exposure of the
    /// picture.
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
