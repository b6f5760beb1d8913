//! Pictures in linear colour: exposure, display, and the difference between two.

use image::RgbImage;
use welkin::light::luminance;
use welkin::plan::{Difference, difference};
use welkin::{Error, Result};

/// A picture in linear Rec. 709, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub texels: Vec<[f64; 3]>,
}

/// Errors of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// In luminance, as in Welkin's stated errors.
    pub luminance: Difference,
    /// 1 minus the similarity of structure and colour as displayed, 0 to 1.
    pub perceptual: f64,
}

impl Picture {
    /// The luminances of its pixels.
    pub fn luminances(&self) -> Vec<f64> {
        self.texels.iter().map(luminance).collect()
    }

    /// The luminance shown as white, such that the picture's logarithmic mean is 18 % of it.
    pub fn white(&self) -> f64 {
        let bright: Vec<f64> = self.luminances().into_iter().filter(|y| *y > 0.0 && y.is_finite()).collect();
        let mean = bright.iter().map(|y| y.ln()).sum::<f64>() / bright.len().max(1) as f64;
        mean.exp().max(1e-12) / 0.18
    }

    /// The displayed picture: exposed by `white`, with a soft shoulder, in sRGB.
    pub fn display(&self, white: f64) -> RgbImage {
        let byte = |v: f64| {
            let v = if v.is_finite() { 1.0 - (-1.6 * v.max(0.0) / white).exp() } else { 1.0 };
            let s = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
            (255.0 * s + 0.5) as u8
        };
        RgbImage::from_fn(self.width, self.height, |x, y| {
            image::Rgb(self.texels[(y * self.width + x) as usize].map(byte))
        })
    }

    /// The errors of this picture relative to `truth`, with both exposed for the truth.
    ///
    /// # Errors
    /// Pictures of different sizes.
    pub fn figures(&self, truth: &Self) -> Result<Figures> {
        let white = truth.white();
        let luminance = difference(&self.luminances(), &truth.luminances(), white)?;
        let fault = |e: image_compare::CompareError| Error::invalid("pictures", format!("of one size: {e}"));
        let (a, b) = (self.display(white), truth.display(white));
        let alike = image_compare::rgb_hybrid_compare(&a, &b).map_err(fault)?.score;
        Ok(Figures { luminance, perceptual: (1.0 - alike).max(0.0) })
    }
}
