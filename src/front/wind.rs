//! The wind field by its name.

use crate::{
    context::Context,
    error::Result,
    flow::{WindFieldDesc, WindFieldReport},
};

impl Context {
    /// Sets a field of wind that goes round terrain and boxes, from simulation time `start_s` on; `None` ends it. While
    /// it is there the wind of every place in it is the field's: in [`Context::wind_at`], in what lands on a surface or
    /// a windscreen, and on drops and flakes near a camera. A host's grid ([`Context::set_wind_grid`]) blows in its
    /// place.
    ///
    /// Set it again with another place, and it moves by whole cells; with another size, mode or walls it begins anew.
    /// It is led by [`Context::update`], in steps on a grid that is anchored at time 0; how long these take:
    /// [`crate::flow`]. It begins with the steady field of its first moment, and again after a leap of time of more
    /// than a minute ([`WindFieldReport::begun_s`]). Part of the saved state.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; of one that is too large, with the memory that it needs and
    /// may take. [`crate::Status::WrongOrder`] for a time before the last update or change. Nothing changes then.
    pub fn set_wind_field(&mut self, field: Option<&WindFieldDesc>, start_s: f64) -> Result<()> {
        self.held.flow.set(&self.world, field.copied(), start_s)
    }

    /// How the wind field stands; `None` without one, and until its first steady state is found.
    pub fn wind_field_report(&self) -> Option<WindFieldReport> {
        self.held.flow.report()
    }
}
