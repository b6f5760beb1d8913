//! The planet's air under the weather: gas by pressure and temperature, haze by visibility in addition to the planet's
//! own, and ozone by its column.

use crate::{
    moment::MAX_EXTINCTION_PER_M,
    planet::{Mie, Planet},
    weather::Conditions,
};

/// Ozone column that a planet file's ozone layer represents, Dobson units.
const PLANET_OZONE_DU: f64 = 300.0;
/// Scale height of the standard atmosphere's air near the ground, m (15 C, R T / (M g)).
const STANDARD_SCALE_HEIGHT_M: f64 = 8434.5;

/// Returns `planet` under the weather `c`. Its gas is scaled by the air's density and scale height. Its haze is the
/// weather's aerosol (Angstrom's law over the wavelengths, converted to altitude 0) and the planet's own haze
/// ([`Planet::own_haze`]). Its ozone follows the column.
///
/// The fog layer is not included: the fog is drawn in front of the sky.
pub fn planet_under(planet: &Planet, c: &Conditions) -> Planet {
    let mut p = *planet;
    for v in &mut p.rayleigh.scattering_per_m {
        *v *= c.air.rayleigh_density_ratio;
    }
    p.rayleigh.scale_height_m *= c.air.rayleigh_scale_height_m / STANDARD_SCALE_HEIGHT_M;
    let at_sea_level = c.aerosol.sea_level_factor();
    let weathers = Mie {
        extinction_per_m: c.aerosol.extinction_at(p.wavelengths_nm).map(|v| v * at_sea_level),
        scattering_per_m: c.aerosol.scattering_at(p.wavelengths_nm).map(|v| v * at_sea_level),
        scale_height_m: c.aerosol.scale_height_m,
        asymmetry_g: c.aerosol.asymmetry,
    };
    p.mie = capped(match planet.own_haze() {
        Some(own) => both(&own, &weathers),
        None => weathers,
    });
    for v in &mut p.absorption.extinction_per_m {
        *v *= c.ozone_du / PLANET_OZONE_DU;
    }
    p
}

/// Limits haze to [`MAX_EXTINCTION_PER_M`], which hides everything within half a metre; more would look the same.
fn capped(haze: Mie) -> Mie {
    let extinction = haze.extinction_per_m;
    let extinction_per_m = extinction.map(|v| v.min(MAX_EXTINCTION_PER_M));
    let share =
        |i: usize| if extinction[i] > MAX_EXTINCTION_PER_M { MAX_EXTINCTION_PER_M / extinction[i] } else { 1.0 };
    let scattering_per_m = [0, 1, 2].map(|i| (haze.scattering_per_m[i] * share(i)).min(extinction_per_m[i]));
    Mie { extinction_per_m, scattering_per_m, ..haze }
}

/// Combines two hazes in the same air. Coefficients at altitude 0 add up. Vertical optical depths at the second
/// wavelength add up too, so the scale height is the mean weighted by extinction. The asymmetry is the mean weighted by
/// scattering at that wavelength, so the scattered light keeps its mean cosine.
fn both(a: &Mie, b: &Mie) -> Mie {
    let mean = |[x, y]: [f64; 2], [p, q]: [f64; 2]| if p + q > 0.0 { (x * p + y * q) / (p + q) } else { x };
    let sum = |x: &[f64; 3], y: &[f64; 3]| [0, 1, 2].map(|i| x[i] + y[i]);
    Mie {
        scattering_per_m: sum(&a.scattering_per_m, &b.scattering_per_m),
        extinction_per_m: sum(&a.extinction_per_m, &b.extinction_per_m),
        scale_height_m: mean([a.scale_height_m, b.scale_height_m], [a.extinction_per_m[1], b.extinction_per_m[1]]),
        asymmetry_g: mean([a.asymmetry_g, b.asymmetry_g], [a.scattering_per_m[1], b.scattering_per_m[1]]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::weather::{Weather, derive};

    fn under(planet: &Planet, visibility_m: f64) -> Mie {
        planet_under(planet, &derive(&Weather { visibility_m, ..Weather::default() }).unwrap()).mie
    }

    #[test]
    fn own_haze_stays_and_the_weathers_adds_to_it() {
        let dusty = Planet::from_toml(include_str!("../../examples/data/planet_dusty.toml")).unwrap();
        let own = dusty.own_haze().unwrap();
        // Air so clear that the weather has no haze.
        assert_eq!(under(&dusty, 1e6), own);
        let without = Planet { mie: Mie::earth_at(dusty.wavelengths_nm), ..dusty };
        for visibility_m in [60_000.0, 8000.0, 3000.0] {
            let (mixed, weathers) = (under(&dusty, visibility_m), under(&without, visibility_m));
            assert!(weathers.extinction_per_m[1] > 1e-5);
            for i in 0..3 {
                assert_eq!(mixed.extinction_per_m[i], own.extinction_per_m[i] + weathers.extinction_per_m[i]);
                assert_eq!(mixed.scattering_per_m[i], own.scattering_per_m[i] + weathers.scattering_per_m[i]);
            }
            let depth = |m: &Mie| m.extinction_per_m[1] * m.scale_height_m;
            assert!((depth(&mixed) / (depth(&own) + depth(&weathers)) - 1.0).abs() < 1e-12);
            let forward = |m: &Mie| m.scattering_per_m[1] * m.asymmetry_g;
            assert!((forward(&mixed) / (forward(&own) + forward(&weathers)) - 1.0).abs() < 1e-12);
            planet_under(&dusty, &derive(&Weather { visibility_m, ..Weather::default() }).unwrap()).check().unwrap();
        }
    }

    #[test]
    fn haze_of_the_earth_is_the_weathers_to_the_bit() {
        let c = derive(&Weather { visibility_m: 8000.0, ..Weather::default() }).unwrap();
        let earth = planet_under(&Planet::earth(), &c);
        assert_eq!(earth.mie.extinction_per_m, c.aerosol.extinction_at(earth.wavelengths_nm));
        assert_eq!(earth.mie.scattering_per_m, c.aerosol.scattering_at(earth.wavelengths_nm));
        assert_eq!((earth.mie.scale_height_m, earth.mie.asymmetry_g), (c.aerosol.scale_height_m, c.aerosol.asymmetry));
    }
}
