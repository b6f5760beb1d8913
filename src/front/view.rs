//! The host's settings of a view's effects, and queries about them.

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

    /// Sets the quality of clouds that are drawn as a volume. Default: [`CloudSettings::default`].
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and its range; nothing changes then.
    pub fn set_clouds(&mut self, settings: CloudSettings) -> Result<()> {
        settings.validate()?;
        self.effects.clouds.settings = settings;
        Ok(())
    }

    /// Returns the map of the clouds' shadows, for a host that lights its own materials. Once this function has been
    /// called, the first [`View::record`] of each frame updates the map, and
    /// [`Stages::SURFACE`](crate::frame::Stages::SURFACE) no longer draws cloud shadows: the host does. Call this
    /// function after each frame for the map's placement. A host that draws before Welkin uses the placement of the
    /// last frame: clouds have moved by centimetres since then.
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

    /// Sets the windscreen through which the view looks; `None` removes it. A host sets it again before each frame in
    /// which the vehicle drives, the head turns or the wiper moves. The water stays on the glass as long as the glass
    /// keeps its size. After an error the windscreen is unchanged.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and its range; with `None`, [`crate::Status::DeviceLost`].
    pub fn set_windscreen(&mut self, screen: Option<&Windscreen>) -> Result<()> {
        let device = self.device.clone();
        // The windscreen's GPU objects are released in the host's context.
        let _entered = if screen.is_none() { Some(device.enter()?) } else { None };
        self.effects.glass.set(screen)
    }

    /// Returns the water on the windscreen as of the last frame, or `None` without one. The call waits for the GPU to
    /// read the water back: do not make it every frame.
    ///
    /// # Errors
    /// [`crate::Status::DeviceLost`], or a GPU fault.
    pub fn windscreen_report(&self) -> Result<Option<GlassReport>> {
        let _entered = self.device.enter()?;
        self.effects.glass.water(&self.device)
    }

    /// Returns the snow on the windscreen, or `None` without snow or windscreen; for tests and tools. Waits for the
    /// GPU.
    ///
    /// # Errors
    /// As [`View::windscreen_report`].
    pub fn windscreen_snow(&self) -> Result<Option<Snow>> {
        let _entered = self.device.enter()?;
        self.effects.glass.snow(&self.device)
    }

    /// Returns the cells of the windscreen's water, or `None` without water or windscreen; for tests and tools. Waits
    /// for the GPU.
    ///
    /// # Errors
    /// As [`View::windscreen_report`].
    pub fn windscreen_cells(&self) -> Result<Option<Cells>> {
        let _entered = self.device.enter()?;
        self.effects.glass.cells(&self.device)
    }
}
