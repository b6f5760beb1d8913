//! Colours of light at a planet's wavelengths.

use crate::{
    light::luminance,
    planet::{
        Planet,
        spectral::{Conversion, sun_rec709},
    },
};

/// Returns, for each of the planet's wavelengths, the linear Rec. 709 colour, lux, of the part of the sunlight above
/// the air that this wavelength represents. With a transfer factor for each wavelength, the colour of the transferred
/// light is the sum of these colours times their factors ([`Conversion::fitted`]). Where two wavelengths are too close
/// to tell colours apart, each wavelength is one channel.
///
/// The colours are adapted (von Kries) so that unscattered sunlight is white, as for daylight film and eyes. Without
/// this, sunlight would look yellow on a D65 display.
pub(super) fn color_columns(planet: &Planet) -> [[f64; 3]; 3] {
    let conversion = Conversion::of(planet);
    let white = sun_rec709();
    let lux = luminance(&white);
    [0, 1, 2].map(|k| [0, 1, 2].map(|c| conversion.matrix[c][k] / white[c] * lux))
}

/// Returns the colour of light whose `spectrum` holds factors of the sunlight at the planet's wavelengths. `columns`
/// are the colours of [`color_columns`].
pub(crate) fn color_of(columns: &[[f64; 3]; 3], spectrum: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| (0..3).map(|k| columns[k][i] * spectrum[k]).sum())
}
