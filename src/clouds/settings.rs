//! Detail with which a view draws clouds.

use crate::error::{Error, Result, check_range};

/// Detail with which a view draws clouds as volumes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudSettings {
    /// Fineness of the steps along a ray: twice the value takes twice as many steps. Range \[0.125, 32\], default 2.
    /// At half the default the error is more than twice as large and the cost hardly lower (`lab chart clouds`).
    pub fineness: f64,
    /// Side of a square of pixels. Each frame marches one pixel of every square and reprojects the others from earlier
    /// frames. 1, 2 or 4, default 4. Frames with [`crate::frame::FrameFlags::NO_HISTORY`] march all pixels; a view's
    /// first frame, and one after a cut, has squares of at most 2.
    pub square_side: u32,
    /// Whether shafts of light are drawn: the air between clouds and ground is brighter where the sun shines through,
    /// and darker in the clouds' shadows. Default false: the air has the mean light of all places. Shafts take 24
    /// look-ups a pixel. They are drawn with [`crate::frame::Stages::SURFACE`] where the host gives depth and does not
    /// read the shadow map itself ([`crate::frame::View::cloud_shadows`]).
    pub shafts: bool,
}

impl Default for CloudSettings {
    /// Returns the default settings.
    fn default() -> Self {
        Self { fineness: 2.0, square_side: 4, shafts: false }
    }
}

impl CloudSettings {
    /// Checks that a view can draw with these settings.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field and its range.
    pub fn validate(&self) -> Result<()> {
        check_range("clouds.fineness", self.fineness, 0.125, 32.0, "")?;
        if [1, 2, 4].contains(&self.square_side) {
            return Ok(());
        }
        Err(Error::range("clouds.square_side", "1, 2 or 4", self.square_side))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_out_of_range_are_refused_by_name() {
        let all = CloudSettings::default();
        all.validate().unwrap();
        for fineness in [0.1, 33.0, f64::NAN] {
            let e = CloudSettings { fineness, ..all }.validate().unwrap_err();
            assert!(e.to_string().starts_with("clouds.fineness must be in [0.125, 32]"), "{e}");
        }
        for square_side in [0, 3, 8] {
            let e = CloudSettings { square_side, ..all }.validate().unwrap_err();
            assert!(e.to_string().starts_with("clouds.square_side must be 1, 2 or 4"), "{e}");
        }
    }
}
