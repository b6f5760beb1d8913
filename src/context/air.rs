//! The planet's air as the weather makes it: gas by pressure and temperature, haze by visibility, ozone by its column.

use crate::{sky::Planet, weather::Conditions};

/// Dobson units that a planet file's ozone layer stands for.
const PLANET_OZONE_DU: f64 = 300.0;
/// Scale height of the standard atmosphere's air near the ground, m (15 C, R T / (M g)).
const STANDARD_SCALE_HEIGHT_M: f64 = 8434.5;

/// `planet` under the weather `c`: its gas scaled by the air's density and scale height, its haze replaced by the
/// weather's aerosol (Angstrom's law over the wavelengths, brought down to altitude 0), its ozone by the column.
///
/// The fog layer is not in it: it is drawn in front of the sky, by the fog.
pub fn planet_under(planet: &Planet, c: &Conditions) -> Planet {
    let mut p = *planet;
    for v in &mut p.rayleigh.scattering_per_m {
        *v *= c.air.rayleigh_density_ratio;
    }
    p.rayleigh.scale_height_m *= c.air.rayleigh_scale_height_m / STANDARD_SCALE_HEIGHT_M;
    let at_sea_level = c.aerosol.sea_level_factor();
    p.mie.extinction_per_m = c.aerosol.extinction_at(p.wavelengths_nm).map(|v| v * at_sea_level);
    p.mie.scattering_per_m = c.aerosol.scattering_at(p.wavelengths_nm).map(|v| v * at_sea_level);
    p.mie.scale_height_m = c.aerosol.scale_height_m;
    p.mie.asymmetry_g = c.aerosol.asymmetry;
    for v in &mut p.absorption.extinction_per_m {
        *v *= c.ozone_du / PLANET_OZONE_DU;
    }
    p
}
