//! How finely a view draws clouds.

use crate::error::{Error, Result, check_range};

/// How finely a view draws clouds that are a volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloudSettings {
    /// How many steps a ray takes: twice the value, twice as many. Range \[0.125, 32\], default 2; of half of them
    /// `lab chart clouds` says that they err more than twice as much and cost hardly less.
    pub fineness: f64,
    /// One pixel of a square of so many on a side is marched in a frame, the others are taken over from earlier frames:
    /// 1, 2 or 4, default 4. Frames without history march all.
    pub square_side: u32,
    /// Whether the air between clouds and ground is drawn brighter where the sun shines through and darker in their
    /// shadows: shafts of light. Default false: on the mean over places. It takes 24 look-ups a pixel, and is drawn
    /// with [`crate::frame::Stages::SURFACE`] where the host gives depth and does not read the map of shadows itself
    /// ([`crate::frame::View::cloud_shadows`]).
    pub shafts: bool,
}

impl Default for CloudSettings {
    fn default() -> Self {
        Self { fineness: 2.0, square_side: 4, shafts: false }
    }
}

impl CloudSettings {
    /// Whether a view can draw by them.
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
