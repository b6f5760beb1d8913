//! Rehearsal of weathers to come: the moments in which views draw them ahead of time, so that nothing has to be compiled
//! once they come.

use super::shared_world::Context;
use crate::{
    error::{Error, Result},
    weather::Conditions,
    world::GivenDirection,
};

/// Duration of the change to each weather, s, and shares of it at which it is drawn.
const CHANGE_S: f64 = 60.0;
const SHARES: [f64; 5] = [0.02, 0.15, 0.4, 0.7, 0.9];
/// Time after the change at which the ground is as wet or white as it gets in a shower, s.
const SETTLED_S: f64 = 180.0;
/// Elevations of the sun under which each weather is drawn, degrees: day, a low sun, twilight, night.
const SUNS_DEG: [f64; 5] = [40.0, 4.0, -4.0, -9.0, -30.0];
/// Moments of each weather.
const MOMENTS: usize = SHARES.len() + 1 + SUNS_DEG.len();

/// Weathers to rehearse, and the state to which the context returns.
pub(crate) struct Rehearsal {
    saved: Vec<u8>,
    weathers: Vec<Conditions>,
}

impl Rehearsal {
    /// Creates the rehearsal of weathers that follow each other. Nothing changes yet.
    ///
    /// # Errors
    /// Those of [`Context::save`].
    pub fn new(context: &Context, weathers: Vec<Conditions>) -> Result<Self> {
        Ok(Self { weathers, saved: context.save()? })
    }

    /// Weathers that are rehearsed.
    pub fn weathers(&self) -> &[Conditions] {
        &self.weathers
    }

    /// Number of moments in all.
    pub fn moments(&self) -> usize {
        MOMENTS * self.weathers.len()
    }

    /// Brings the context to one of the moments.
    ///
    /// # Errors
    /// Those of [`Context::update`]; call [`Self::leave`] then too.
    pub fn enter(&self, context: &mut Context, moment: usize) -> Result<()> {
        let (i, moment) = (moment / MOMENTS, moment % MOMENTS);
        let now_s = context.world.time_s;
        let weather = |i: usize| self.weathers.get(i).ok_or_else(|| Error::range("moment", "in the rehearsal", i));
        if i > 0 {
            context.world.change_weather(*weather(i - 1)?, now_s, 0.0)?;
        }
        context.world.change_weather(*weather(i)?, now_s, CHANGE_S)?;
        let after_s = match moment.checked_sub(SHARES.len()) {
            None => CHANGE_S * SHARES[moment],
            Some(0) => CHANGE_S + SETTLED_S,
            Some(sun) => {
                let given = context.world.set.given_sun.map_or(180.0, |sun| sun.azimuth_deg);
                context.set_sun(Some(GivenDirection { azimuth_deg: given, elevation_deg: SUNS_DEG[sun - 1] }))?;
                CHANGE_S
            }
        };
        context.update(now_s + after_s)
    }

    /// Returns the context to where it was.
    ///
    /// # Errors
    /// Those of [`Context::load`].
    pub fn leave(&self, context: &mut Context) -> Result<()> {
        context.load(&self.saved)
    }
}
