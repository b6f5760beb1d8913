//! Wind field: wind that is solved around terrain and boxes.

use crate::{
    context::Context,
    error::Result,
    flow::{WindFieldDesc, WindFieldReport},
};

impl Context {
    /// Sets a solved field of wind around terrain and boxes, from simulation time `start_s` on; `None` ends it. Inside
    /// the field its wind replaces the weather's: in [`Context::wind_at`], in the rain that lands on a surface or a
    /// windscreen, and for drops and flakes near a camera. A host's grid ([`Context::set_wind_grid`]) replaces the
    /// field.
    ///
    /// A field that is set again with another position moves there by whole cells if the move is shorter than half of
    /// the field along each axis. After a longer move, or with another size, mode, walls, scheme or pressure method, it
    /// starts anew. [`Context::update`] advances the field in steps that end at multiples of their length since time 0;
    /// [`crate::flow`] says how long they take. A field starts with the steady field of the wind at its start, and
    /// starts anew in this way after a leap of time of more than a minute ([`WindFieldReport::begun_s`]). Part of the
    /// saved state.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field; for a field that is too large, the message also gives the
    /// memory that it needs and the most that it may take. [`crate::Status::WrongOrder`] for a time before the last
    /// update or change. Nothing changes then.
    pub fn set_wind_field(&mut self, field: Option<&WindFieldDesc>, start_s: f64) -> Result<()> {
        self.held.flow.set(&self.world, field.copied(), start_s)
    }

    /// Returns the state of the wind field; `None` without one, and until its first steady state is found.
    pub fn wind_field_report(&self) -> Option<WindFieldReport> {
        self.held.flow.report()
    }
}
