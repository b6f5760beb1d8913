//! Light, for all rooms: luminance, the default wavelengths and the colours of wavelengths, phase functions, exposure
//! and tone curves.

pub mod phase;
pub mod spectrum;
pub mod tone;

pub use phase::{Phase, PhaseLobes};
pub use tone::{Exposure, ToneCurve};

/// Wavelengths that stand for red, green and blue by default, nm.
///
/// They give the least colour error against 42 wavelengths, over clear and hazy skies with suns from noon to 6 degrees
/// below the horizon. For this error a channel's light is scaled by the sun's Rec. 709 component
/// (`planet::spectral::Conversion::per_channel`). The choice was among all triples in steps of 5 nm that contain 550
/// nm, at which visibility is defined. The error is 1 % in luminance, and 13 % of the luminance in the worst channel.
/// With the often used 680, 550 and 440 nm these errors are 15 % and 71 % (35 % and 156 % in haze): air hardly dims a
/// low sun at 680 nm, while the eye's red lies at 600 to 620 nm.
pub const EARTH_WAVELENGTHS_NM: [f64; 3] = [620.0, 550.0, 450.0];

/// Luminance, cd/m^2, of a linear Rec. 709 colour.
pub fn luminance(rec709: &[f64; 3]) -> f64 {
    0.212_639_006 * rec709[0] + 0.715_168_679 * rec709[1] + 0.072_192_315 * rec709[2]
}

/// Returns sin x / x: the mean of cos t for t from -x to x.
pub(crate) fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-2 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}
