//! Checks of a call before anything is done for it: a refused call costs nothing and changes nothing.

use super::view::View;
use crate::{
    error::{Error, Result, Status},
    stage::{Frame, Stages, can_copy, check_classes, check_color, check_depth, check_mask, check_normals},
};

impl View {
    /// Checks that the stages come in order and each at most once in the frame.
    fn check_order(&self, frame_id: u64, stages: Stages) -> Result<()> {
        if frame_id != self.history.report.frame_id || self.history.recorded == Stages(0) {
            return Ok(());
        }
        let last = 31 - self.history.recorded.0.leading_zeros();
        let first = stages.0.trailing_zeros();
        if first <= last {
            let (now, before) = (stages.0, self.history.recorded.0);
            let rest = format!(
                "{now:#x} of frame_id {frame_id} come after {before:#x}: each stage once, in rising order of its bit"
            );
            return Err(Error::about(Status::WrongOrder, "stages", rest));
        }
        Ok(())
    }

    /// Checks everything about a call except its images, before anything is done for it.
    ///
    /// # Errors
    /// The errors of [`View::record`].
    pub(crate) fn check_call(&self, frame: &Frame<'_>, stages: Stages) -> Result<()> {
        Stages::from_bits(stages.0)?;
        self.check_order(frame.frame_id, stages)?;
        frame.camera.validate()?;
        frame.depth_mapping.validate()?;
        frame.validate()
    }

    /// Checks that the images can be drawn into and read, even if there is nothing to draw now: a host should not learn
    /// of unsuitable images only when it starts to rain.
    pub(super) fn check_images(&self, frame: &Frame<'_>, stages: Stages) -> Result<()> {
        if !stages.draw() {
            return Ok(());
        }
        let color = frame.color.ok_or_else(|| Error::range("color", "given for stages other than PREPARE", "none"))?;
        check_color(color)?;
        if !can_copy(color) {
            self.reading(color)?;
        }
        if color.sample_count() > 1 && !self.cache.composite.lock()?.reads_samples() {
            let what = "above 1: this device cannot shade per sample; resolve first";
            return Err(Error::unsupported(what).within("color.samples"));
        }
        if let Some(depth) = frame.depth {
            check_depth(depth, color)?;
        }
        self.check_depth_access(frame, color)?;
        if let Some(mask) = frame.mask {
            check_mask(mask, color)?;
        }
        frame.surface_classes.map_or(Ok(()), |t| check_classes(t, color))?;
        frame.normals.map_or(Ok(()), |t| check_normals(t, color))?;
        for (name, image) in frame.image_layers().into_iter().skip(1) {
            if image.is_some() && image == frame.color_layer() {
                return Err(Error::range(name, "another texture than color", "the same"));
            }
        }
        self.effects.all().iter().try_for_each(|effect| effect.check(frame, stages))
    }

    /// Returns the texture from which Welkin reads a `color` that wgpu cannot copy.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming `color.usage` if the device has no such texture.
    pub(super) fn reading(&self, color: &wgpu::Texture) -> Result<wgpu::Texture> {
        self.device.reading(color).ok_or_else(|| {
            Error::range("color.usage", "one with RENDER_ATTACHMENT | COPY_SRC", format!("{:?}", color.usage()))
        })
    }
}
