//! The planet's air as the weather makes it: gas by pressure and temperature, haze by visibility, ozone by its column.

use crate::{moment::MAX_EXTINCTION_PER_M, planet::Planet, weather::Conditions};

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
    let extinction = c.aerosol.extinction_at(p.wavelengths_nm).map(|v| v * at_sea_level);
    let scattering = c.aerosol.scattering_at(p.wavelengths_nm).map(|v| v * at_sea_level);
    // What a planet may have hides everything within half a metre: more of it shows nothing else.
    p.mie.extinction_per_m = extinction.map(|v| v.min(MAX_EXTINCTION_PER_M));
    let held = |i: usize| if extinction[i] > MAX_EXTINCTION_PER_M { MAX_EXTINCTION_PER_M / extinction[i] } else { 1.0 };
    p.mie.scattering_per_m = [0, 1, 2].map(|i| (scattering[i] * held(i)).min(p.mie.extinction_per_m[i]));
    p.mie.scale_height_m = c.aerosol.scale_height_m;
    p.mie.asymmetry_g = c.aerosol.asymmetry;
    for v in &mut p.absorption.extinction_per_m {
        *v *= c.ozone_du / PLANET_OZONE_DU;
    }
    p
}
