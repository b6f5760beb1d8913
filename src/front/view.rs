//! Settings of a view's effects by the host, and queries about them.

use crate::{
    clouds::{CloudSettings, CloudShadows},
    error::Result,
    frame::View,
    glass::{
        GlassReport, Windscreen,
        reference::{Cells, Snow},
    },
    rain::RainSettings,
    snow::SnowSettings,
};

impl View {
    /// Sets how rain is drawn. Default: [`RainSettings::default`].
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and its range; nothing changes then.
    pub fn set_rain(&mut self, settings: RainSettings) -> Result<()> {
        settings.validate_on(&self.device)?;
        self.effects.rain.settings = settings;
        Ok(())
    }

    /// Sets how finely clouds are drawn that are a volume. Default: [`CloudSettings::default`].
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and its range; nothing changes then.
    pub fn set_clouds(&mut self, settings: CloudSettings) -> Result<()> {
        settings.validate()?;
        self.effects.clouds.settings = settings;
        Ok(())
    }

    /// The map of the clouds' shadows, for a host that lights its own materials. From the first call on, the first call
    /// of each frame brings it up to date, and [`Stages::SURFACE`](crate::frame::Stages::SURFACE) lays no shadows of
    /// clouds any more: the host does. Ask after each frame for how the map lies; a host that draws before Welkin uses
    /// that of the last frame, in which clouds have moved by centimetres.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn cloud_shadows(&mut self) -> Result<CloudShadows> {
        let device = self.device.clone();
        let _entered = device.enter()?;
        let shadows = self.effects.clouds.shadows(&device);
        device.check_made()?;
        Ok(shadows)
    }

    /// Sets how falling snow is drawn. Default: [`SnowSettings::default`].
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and its range; nothing changes then.
    pub fn set_snow(&mut self, settings: SnowSettings) -> Result<()> {
        settings.validate()?;
        self.effects.snow.settings = settings;
        Ok(())
    }

    /// Sets the window that the view looks through; `None` takes it away. A host that drives, turns its head or wipes
    /// sets it anew before each frame: the water stays on the glass while its size does. Unchanged after an error.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and its range.
    pub fn set_windscreen(&mut self, screen: Option<&Windscreen>) -> Result<()> {
        let device = self.device.clone();
        // What goes with a window is freed in the host's context.
        let _entered = if screen.is_none() { Some(device.enter()?) } else { None };
        self.effects.glass.set(screen)
    }

    /// Water on the windscreen as of the last frame, or `None` without one. Reads it back and waits for the GPU: not
    /// for every frame.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn windscreen_report(&self) -> Result<Option<GlassReport>> {
        let _entered = self.device.enter()?;
        self.effects.glass.water(&self.device)
    }

    /// The snow on the windscreen, or `None` where there is none; for tests and tools. Waits for the GPU.
    ///
    /// # Errors
    /// As [`View::windscreen_report`].
    pub fn windscreen_snow(&self) -> Result<Option<Snow>> {
        let _entered = self.device.enter()?;
        self.effects.glass.snow(&self.device)
    }

    /// The cells of the windscreen's water, or `None` where it is dry; for tests and tools. Waits for the GPU.
    ///
    /// # Errors
    /// As [`View::windscreen_report`].
    pub fn windscreen_cells(&self) -> Result<Option<Cells>> {
        let _entered = self.device.enter()?;
        self.effects.glass.cells(&self.device)
    }
}
