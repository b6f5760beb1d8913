//! The wind at a place: the weather's, or the wind that varies in space.

use std::sync::{Arc, PoisonError};

use glam::{DVec2, DVec3};

use super::{detours::DetourInputs, settings::HostWind, state::World};
use crate::{
    error::Result,
    weather::Conditions,
    wind::{Detour, DetourMap, WindAt, WindGrid, WindVolume},
};

/// Optical depth of the low layer beyond which its patches are not seen.
const SEEN_DEPTHS: f64 = 8.0;
/// Steps to which the inputs of detours are rounded: the weather's wind, m/s, and the binary logarithm of a patch's
/// size. While the weather changes, detours are then not recomputed in every frame.
const WIND_STEP_M_S: f64 = 0.125;
const SIZE_STEP: f64 = 1.0 / 32.0;

impl World {
    /// Returns the wind that varies in space at a time: the host's grid if there is one, else the solved field.
    pub fn wind_volume(&self, time_s: f64) -> Option<&WindVolume> {
        let host = self.set.host_wind.as_ref().map(|host| &host.volume);
        host.or(self.solved_wind.as_deref()).filter(|v| v.holds_at(time_s))
    }

    /// Replaces the host's grid by one that was validated; `None` removes it.
    pub fn set_wind_grid(&mut self, grid: Option<Arc<WindGrid>>) {
        self.set.host_wind = grid.map(|grid| self.host_wind(grid));
    }

    /// Returns a host's grid together with the form that queries and shaders read.
    pub(super) fn host_wind(&self, grid: Arc<WindGrid>) -> Arc<HostWind> {
        let volume = WindVolume::of_grid(&grid, self.frame.frame_at(grid.origin).world_to_enu);
        Arc::new(HostWind { grid, volume })
    }

    /// Returns the detours around a camera at `eye`: how far the air lags behind the wind's displacement. `None`
    /// without a wind that varies in space, and where no patches of the weather's low layer show the detours.
    pub fn detour(&self, eye: DVec3, c: &Conditions, time_s: f64) -> Option<Detour> {
        // A fog law of the host replaces the weather's low layer, and with it the patches.
        if self.set.undimmed || !c.fog.is_patchy() {
            return None;
        }
        let volume = self.wind_volume(time_s)?;
        if volume.distance_m(eye) * c.fog.extinction_per_m > SEEN_DEPTHS {
            return None;
        }
        let weathers_m_s = |height_m: f64| {
            let mean = DVec2::from_array(c.wind.mean_at_height_m_s(height_m));
            (mean / WIND_STEP_M_S).round() * WIND_STEP_M_S
        };
        let (terrain, tiles) = (self.set.terrain.as_deref(), self.set.tiles.as_deref());
        let inputs = DetourInputs {
            volume: volume.revision(),
            terrain: terrain.map(|t| t.hash).or(tiles.map(|t| t.revision)).unwrap_or_default(),
            weathers_m_s: [2.0, 20.0].map(weathers_m_s),
            life_m: libm::exp2((libm::log2(c.fog.drawn_patch_m()) / SIZE_STEP).round() * SIZE_STEP),
        };
        let mut kept = self.detours.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, map)) = kept.as_ref().filter(|(from, _)| *from == inputs) {
            return map.as_ref().map(|map| map.about(eye));
        }
        let origin = terrain.map(|t| t.origin).or(tiles.map(|t| t.desc.origin));
        let from_terrain = origin.map_or(DVec3::ZERO, |o| volume.to_enu * (volume.origin - o));
        let level_m = c.air.station_altitude_m - self.frame.frame_at(volume.origin).place.altitude_m;
        let ground_m = |place: DVec2| {
            let at = place + from_terrain.truncate();
            let height_m = terrain.map(|t| t.height_m(at)).or_else(|| tiles?.height_near(at));
            height_m.map_or(level_m, |height| height - from_terrain.z)
        };
        let map = DetourMap::new(volume, &ground_m, &weathers_m_s, inputs.life_m).map(Arc::new);
        *kept = Some((inputs, map.clone()));
        map.map(|map| map.about(eye))
    }

    /// Returns the wind with gusts at a place and time; heights are measured from the station's altitude.
    ///
    /// # Errors
    /// As [`World::conditions_at`].
    pub fn wind_at(&self, position: DVec3, time_s: f64) -> Result<WindAt> {
        let place = self.frame.place_at("position", position)?.place;
        let conditions = self.weather_at(position, time_s)?;
        let height_m = place.altitude_m - conditions.air.station_altitude_m;
        let wind = self.over().blowing_at(position, time_s)?.0.at_height(&conditions.wind, height_m);
        let Some(volume) = self.wind_volume(time_s) else { return Ok(wind) };
        let Some(found) = volume.at(volume.cells_at(position)) else { return Ok(wind) };
        let (own, rest) = (found.truncate(), 1.0 - found.w);
        Ok(WindAt {
            velocity_m_s: own + wind.velocity_m_s * rest,
            mean_m_s: own + wind.mean_m_s * rest,
            gust_deviation_m_s: wind.gust_deviation_m_s * rest,
        })
    }

    /// Returns the wind that carries particles falling past a place, m/s (east, north, up): the weather's wind at 10 m
    /// with its gusts, replaced or changed by the wind that varies in space where there is one.
    ///
    /// # Errors
    /// As [`World::weather_at`].
    pub fn carrying_at(&self, position: DVec3, time_s: f64) -> Result<DVec3> {
        let weathers = self.over().carrying_at(position, time_s)?;
        let about = self.wind_volume(time_s).and_then(|volume| volume.wind(position, weathers));
        Ok(about.unwrap_or(weathers))
    }
}
