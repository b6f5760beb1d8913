//! Rehearsal of weathers to come: views draw each weather ahead of time, so that nothing has to be compiled when it
//! comes. A moment of a rehearsal is one weather at one time of its change, under one elevation of the sun, or with
//! some of the context's weather regions around the camera.

use glam::DVec3;

use super::shared_world::Context;
use crate::{
    error::{Error, Result},
    regions::HeldRegion,
    weather::Conditions,
    world::GivenDirection,
};

/// Duration of the change to each weather, s, and shares of the change at which a picture is drawn.
const CHANGE_S: f64 = 60.0;
const SHARES: [f64; 12] = [0.005, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95, 0.98];
/// Times after the end of the change at which a picture is drawn, s: shortly after it, and when the ground is as wet or
/// white as in a shower.
const SETTLED_S: [f64; 2] = [1.0, 180.0];
/// Time for which each weather lasts before the next one comes, s.
const LASTS_S: f64 = 120.0;
/// Elevations of the sun under which each weather is drawn, degrees: day, a low sun, twilight, night.
const SUNS_DEG: [f64; 5] = [40.0, 4.0, -4.0, -9.0, -30.0];
/// Number of moments of each weather without weather regions around the camera.
const MOMENTS: usize = SHARES.len() + SETTLED_S.len() + SUNS_DEG.len();

/// Weathers to rehearse, and the state to which the context returns afterwards.
pub(crate) struct Rehearsal {
    saved: Vec<u8>,
    weathers: Vec<Conditions>,
    /// Position of the camera in the host's world, m.
    eye: DVec3,
    /// Weather regions that each weather is drawn with, one set after the other, as indices in the context's list.
    around: Vec<Vec<usize>>,
}

/// Returns the sets of weather regions that are drawn around the camera: one region of each shape, then all of them.
/// Pipelines differ by the shapes of the fog banks, and by whether banks overlap.
fn sets_around(context: &Context) -> Vec<Vec<usize>> {
    let regions = &context.world.set.weather_regions;
    let is_alike = |a: &HeldRegion, b: &HeldRegion| a.has == b.has && a.plan.shape.kind() == b.plan.shape.kind();
    let is_first = |i: &usize| !regions[..*i].iter().any(|before| is_alike(before, &regions[*i]));
    let mut sets: Vec<Vec<usize>> = (0..regions.len()).filter(is_first).map(|i| vec![i]).collect();
    if regions.len() > 1 {
        sets.push((0..regions.len()).collect());
    }
    sets
}

impl Rehearsal {
    /// Creates the rehearsal of weathers that follow each other, for a camera at `eye` (host's world, m). Nothing
    /// changes yet.
    ///
    /// # Errors
    /// As [`Context::save`]; [`crate::Status::InvalidArgument`] naming `frame.camera.position`.
    pub fn new(context: &Context, weathers: Vec<Conditions>, eye: DVec3) -> Result<Self> {
        context.world.frame.place_at("frame.camera.position", eye)?;
        Ok(Self { weathers, saved: context.save()?, eye, around: sets_around(context) })
    }

    /// Returns the weathers that are rehearsed.
    pub fn weathers(&self) -> &[Conditions] {
        &self.weathers
    }

    /// Returns the number of moments of all weathers.
    pub fn moments(&self) -> usize {
        self.moments_each() * self.weathers.len()
    }

    /// Returns the number of moments of one weather.
    fn moments_each(&self) -> usize {
        MOMENTS + self.around.len()
    }

    /// Brings the context from its state before the rehearsal to one of the moments. Call [`Self::leave`] before the
    /// next moment.
    ///
    /// # Errors
    /// As [`Context::update`], and [`crate::Status::InvalidArgument`] for a moment that the rehearsal does not have;
    /// call [`Self::leave`] then too.
    pub fn enter(&self, context: &mut Context, moment: usize) -> Result<()> {
        let (i, moment) = (moment / self.moments_each(), moment % self.moments_each());
        // The earlier weathers come first, so that their water and snow lie on the ground.
        for weather in self.weathers.iter().take(i) {
            let now_s = context.world.time_s;
            context.world.change_weather(*weather, now_s, 0.0)?;
            context.update(now_s + LASTS_S)?;
        }
        let now_s = context.world.time_s;
        let weather = self.weathers.get(i).ok_or_else(|| Error::range("moment", "in the rehearsal", i))?;
        context.world.change_weather(*weather, now_s, CHANGE_S)?;
        let changing = SHARES.iter().map(|share| CHANGE_S * share);
        let settled = SETTLED_S.iter().map(|after_s| CHANGE_S + after_s);
        let after_s = changing.chain(settled).nth(moment).unwrap_or(CHANGE_S);
        if let Some(set) = moment.checked_sub(MOMENTS) {
            context.world.bring_weather_regions(&self.around[set], self.eye);
        } else if let Some(sun) = moment.checked_sub(SHARES.len() + SETTLED_S.len()) {
            let azimuth_deg = context.world.set.given_sun.map_or(180.0, |sun| sun.azimuth_deg);
            context.set_sun(Some(GivenDirection { azimuth_deg, elevation_deg: SUNS_DEG[sun] }))?;
        }
        context.update(now_s + after_s)
    }

    /// Restores the state that the context had before the rehearsal.
    ///
    /// # Errors
    /// As [`Context::load`].
    pub fn leave(&self, context: &mut Context) -> Result<()> {
        context.load(&self.saved)
    }
}
