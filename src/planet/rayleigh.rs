//! Scattering of air: cross-section and optical depth by Bodhaine et al. 1999, and constants for columns of gas.

/// Molecules in a vertical column of 1 Dobson unit, 1/m^2 (Loschmidt's number times 10 um).
pub const DOBSON_UNIT_PER_M2: f64 = 2.687e20;
/// Number density of air at 15 C and 1013.25 hPa, 1/m^3 (Bodhaine et al. 1999, section 3).
pub const AIR_DENSITY_15C_PER_M3: f64 = 2.546_899e25;
/// Scale height with which the density at 15 C gives Bodhaine's vertical optical depth, m: Bodhaine's column of
/// 2.1520e29 molecules/m^2 divided by [`AIR_DENSITY_15C_PER_M3`].
pub const EARTH_RAYLEIGH_SCALE_HEIGHT_M: f64 = 2.1520e29 / AIR_DENSITY_15C_PER_M3;

/// Returns the fraction in Bodhaine et al. 1999, equations 29 and 30; wavelength in um.
fn bodhaine_fraction(um: f64) -> f64 {
    let l2 = um * um;
    (1.045_599_6 - 341.290_61 / l2 - 0.902_308_50 * l2) / (1.0 + 0.002_705_988_9 / l2 - 85.968_563 * l2)
}

/// Returns the vertical Rayleigh optical depth of the Earth's air at sea level, 45 N, 1013.25 hPa (Bodhaine et al.
/// 1999, eq. 30). Wavelength in nm; the fit is for 250 to 1000 and is used unchanged outside.
pub fn rayleigh_optical_depth(wavelength_nm: f64) -> f64 {
    0.002_152_0 * bodhaine_fraction(wavelength_nm * 1e-3)
}

/// Returns the Rayleigh scattering coefficient of air at 15 C and 1013.25 hPa, 1/m: the cross-section of Bodhaine et
/// al. 1999, eq. 29, times [`AIR_DENSITY_15C_PER_M3`]. Wavelength in nm, for 250 to 1000.
pub fn rayleigh_scattering_per_m(wavelength_nm: f64) -> f64 {
    bodhaine_fraction(wavelength_nm * 1e-3) * 1e-32 * AIR_DENSITY_15C_PER_M3
}
