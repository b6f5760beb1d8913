//! Hail and ice pellets around a view's camera, recounted only when the precipitation, the fall speeds or the largest
//! number of stones change.

use super::{
    settings::{RainModel, RainSettings},
    stones::Stones,
};
use crate::{
    falling::drops,
    moment::{Scene, SceneMoment},
    weather::Falling,
};

/// Precipitation that falls as stones around a camera.
#[derive(Default)]
pub(super) struct Ice {
    /// Precipitation at the camera; `None` without stones.
    here: Option<Falling>,
    /// Last count of stones: precipitation, factor on fall speeds at the station's altitude ([`drops::factor_in`]) and
    /// largest number for which they were counted, and the stones.
    counted: Option<(Falling, f64, u32, Stones)>,
}

impl Ice {
    /// Reads the precipitation at the camera.
    pub fn gather(&mut self, now: &SceneMoment<'_>) {
        let falling = now.weather.falling_at(now.eye, now.time_s, now.scene.conditions).precipitation;
        self.here = (falling.ice_pellets_mm_h + falling.hail_mm_h > 0.0).then_some(falling);
    }

    /// Returns whether a view with these settings draws any stones.
    pub fn is_drawn(&self, settings: &RainSettings) -> bool {
        self.here.is_some() && settings.model != RainModel::Veil
    }

    /// Returns the stones that a view with these settings draws, if any. `most` is the largest number of drawn drops,
    /// and also of stones.
    pub fn stones(&mut self, scene: &Scene, settings: &RainSettings, most: u32) -> Option<Stones> {
        let falling = self.here.filter(|_| self.is_drawn(settings))?;
        let air = &scene.conditions.air;
        let factor = drops::factor_in(air, air.station_altitude_m);
        match &self.counted {
            Some((f, x, m, stones)) if *f == falling && *x == factor && *m == most => Some(*stones),
            _ => {
                let stones = Stones::new(&falling, factor, most);
                self.counted = Some((falling, factor, most, stones));
                Some(stones)
            }
        }
    }
}
