//! Colours of light at a planet's wavelengths.

use crate::{
    light::luminance,
    planet::{
        Planet,
        spectral::{Conversion, sun_rec709},
    },
};

/// Linear Rec. 709 colours, lux, of unscattered sunlight's parts at each of the planet's wavelengths: what a transfer
/// of light at these wavelengths looks like is their sum weighted by it ([`Conversion::fitted`]; each wavelength as one
/// channel where two of them are too close to tell colours apart).
///
/// Adapted (von Kries) to unscattered sunlight as white, as daylight film and eyes are: on a D65 display it would look
/// yellow.
pub(super) fn color_columns(planet: &Planet) -> [[f64; 3]; 3] {
    let conversion = Conversion::of(planet);
    let white = sun_rec709();
    let lux = luminance(&white);
    [0, 1, 2].map(|k| [0, 1, 2].map(|c| conversion.matrix[c][k] / white[c] * lux))
}

/// Colour of a transfer at the planet's wavelengths.
pub(crate) fn color_of(columns: &[[f64; 3]; 3], spectrum: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| (0..3).map(|k| columns[k][i] * spectrum[k]).sum())
}
