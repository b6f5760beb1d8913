//! The planet: its fields with their ranges, the Earth, a planet at other wavelengths, the text of its file, and its
//! hash.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use super::{
    rayleigh::{DOBSON_UNIT_PER_M2, EARTH_RAYLEIGH_SCALE_HEIGHT_M, rayleigh_scattering_per_m},
    spectra,
};
use crate::{
    error::{Error, Result},
    light::EARTH_WAVELENGTHS_NM,
};

/// Gas: scatters without absorbing; its density falls exponentially with altitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rayleigh {
    /// Scattering coefficient at altitude 0 per wavelength, 1/m, `[0, 10]`.
    pub scattering_per_m: [f64; 3],
    /// Scale height, m, `[0, 1e6]`: the density falls to 1/e over it; 0 means that there is no gas above the ground.
    pub scale_height_m: f64,
}

/// Haze: scatters with a forward peak (Cornette and Shanks 1992) and absorbs; its density falls exponentially with
/// altitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mie {
    /// Scattering coefficient at altitude 0 per wavelength, 1/m, `[0, 10]`, not above the extinction.
    pub scattering_per_m: [f64; 3],
    /// Extinction coefficient (scattering + absorption) at altitude 0 per wavelength, 1/m, `[0, 10]`.
    pub extinction_per_m: [f64; 3],
    /// Scale height, m, `[0, 1e6]`: the density falls to 1/e over it; 0 means that there is no haze above the ground.
    pub scale_height_m: f64,
    /// Parameter g of the phase function, `[-0.9999, 0.9999]`; with a positive g, most light goes on forward, away from
    /// the sun.
    pub asymmetry_g: f64,
}

impl Mie {
    /// Returns the haze of [`Planet::earth`] at three wavelengths, nm, by the power law of Angstrom 1929.
    pub fn earth_at(wavelengths_nm: [f64; 3]) -> Self {
        let haze = wavelengths_nm.map(|nm: f64| 2.5e-5 * (nm / 550.0).powf(-1.3));
        Self {
            scattering_per_m: haze.map(|b| 0.95 * b),
            extinction_per_m: haze,
            scale_height_m: 1200.0,
            asymmetry_g: 0.76,
        }
    }
}

/// Ozone: absorbs without scattering. Its density profile is a tent: 1 at the centre, falling linearly to 0 at the half
/// width on both sides.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Absorption {
    /// Extinction coefficient at the centre per wavelength, 1/m, `[0, 10]`.
    pub extinction_per_m: [f64; 3],
    /// Altitude of the centre, m, `[0, 1e6]`.
    pub center_altitude_m: f64,
    /// Distance from the centre to where the layer ends, m, `[0, 1e6]`; 0 means that there is no layer.
    pub half_width_m: f64,
}

/// A planet with its air, ground and sun. Fields are public plain data: call [`Planet::check`] after setting them by
/// hand. The functions of [`crate::sky`] that build, solve or query a sky also call it; conversions such as
/// [`Planet::at_wavelengths`] do not.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Planet {
    /// The three wavelengths that are computed, nm, each in `[200, 4000]`. The numbers of all other triples are in the
    /// order of these wavelengths. Welkin's own colours require red, green, blue; radiances are right in any order.
    pub wavelengths_nm: [f64; 3],
    /// Spectral irradiance of the sun at the top of the air on a surface facing it, W m^-2 nm^-1, `[0, 1e6]`. Its ratio
    /// to the Earth's sun scales the light of sun and moon in pictures and queries. Radiances of [`crate::sky`] are in
    /// W m^-2 sr^-1 nm^-1; [`super::spectral`] converts them to luminous colours. With an irradiance of 1 they are
    /// radiances per unit irradiance.
    pub solar_irradiance: [f64; 3],
    /// Angular radius of the sun's disc, degrees, `[0, 10]`; 0 is a point.
    pub sun_angular_radius_deg: f64,
    /// Radius of the ground's sphere (altitude 0), m, `[1e3, 1e9]`.
    pub bottom_radius_m: f64,
    /// Radius where the air ends, m, above the bottom radius, at most 2e9. The air's density is cut to 0 there.
    pub top_radius_m: f64,
    /// Albedo of the ground, which reflects equally in all directions (Lambert), per wavelength, `[0, 1]`.
    pub ground_albedo: [f64; 3],
    /// Gas.
    pub rayleigh: Rayleigh,
    /// Haze. If it equals the Earth's, all haze comes from the weather; otherwise this haze is added to the weather's
    /// ([`Planet::own_haze`]).
    pub mie: Mie,
    /// Ozone.
    pub absorption: Absorption,
}

/// One line of a planet file: section and key, unit, accepted range, and access to the field in [`Planet`].
pub(crate) struct PlanetField {
    pub section: &'static str,
    pub key: &'static str,
    pub unit: &'static str,
    pub range: (f64, f64),
    pub get: fn(&Planet) -> &[f64],
    pub set: fn(&mut Planet) -> &mut [f64],
}

macro_rules! field {
    ($section:literal, $key:literal, $unit:literal, $range:expr, triple $($path:ident).+) => {
        PlanetField { section: $section, key: $key, unit: $unit, range: $range,
            get: |p| &p.$($path).+, set: |p| &mut p.$($path).+ }
    };
    ($section:literal, $key:literal, $unit:literal, $range:expr, one $($path:ident).+) => {
        PlanetField { section: $section, key: $key, unit: $unit, range: $range,
            get: |p| std::slice::from_ref(&p.$($path).+), set: |p| std::slice::from_mut(&mut p.$($path).+) }
    };
}

/// Every field of a planet, in the order of its file.
#[rustfmt::skip]
pub(crate) const FIELDS: [PlanetField; 15] = [
    field!("", "wavelengths_nm", "nm", (200.0, 4000.0), triple wavelengths_nm),
    field!("", "solar_irradiance", "W m^-2 nm^-1", (0.0, 1e6), triple solar_irradiance),
    field!("", "sun_angular_radius_deg", "deg", (0.0, 10.0), one sun_angular_radius_deg),
    field!("", "bottom_radius_m", "m", (1e3, 1e9), one bottom_radius_m),
    field!("", "top_radius_m", "m", (1e3, 2e9), one top_radius_m),
    field!("", "ground_albedo", "1", (0.0, 1.0), triple ground_albedo),
    field!("rayleigh", "scattering_per_m", "1/m", (0.0, 10.0), triple rayleigh.scattering_per_m),
    field!("rayleigh", "scale_height_m", "m", (0.0, 1e6), one rayleigh.scale_height_m),
    field!("mie", "scattering_per_m", "1/m", (0.0, 10.0), triple mie.scattering_per_m),
    field!("mie", "extinction_per_m", "1/m", (0.0, 10.0), triple mie.extinction_per_m),
    field!("mie", "scale_height_m", "m", (0.0, 1e6), one mie.scale_height_m),
    field!("mie", "asymmetry_g", "1", (-0.9999, 0.9999), one mie.asymmetry_g),
    field!("absorption", "extinction_per_m", "1/m", (0.0, 10.0), triple absorption.extinction_per_m),
    field!("absorption", "center_altitude_m", "m", (0.0, 1e6), one absorption.center_altitude_m),
    field!("absorption", "half_width_m", "m", (0.0, 1e6), one absorption.half_width_m),
];

impl PlanetField {
    /// Returns the name in the planet file: `mie.asymmetry_g`.
    pub fn name(&self) -> String {
        if self.section.is_empty() { self.key.to_owned() } else { format!("{}.{}", self.section, self.key) }
    }

    /// Returns the range that the field accepts, with its unit.
    pub fn accepted(&self) -> String {
        let (lo, hi) = self.range;
        let unit = if self.unit == "1" { String::new() } else { format!(" {}", self.unit) };
        let each = if (self.get)(&Planet::earth()).len() == 3 { "three numbers, each " } else { "" };
        format!("{each}in [{lo:?}, {hi:?}]{unit}")
    }

    fn check(&self, planet: &Planet) -> Result<()> {
        match (self.get)(planet).iter().find(|v| !(v.is_finite() && (self.range.0..=self.range.1).contains(*v))) {
            None => Ok(()),
            Some(bad) => Err(Error::range(&self.name(), &self.accepted(), bad)),
        }
    }
}

impl Planet {
    /// Returns the Earth on a clear day.
    ///
    /// - Wavelengths [`EARTH_WAVELENGTHS_NM`].
    /// - Gas: [`rayleigh_scattering_per_m`] (Bodhaine et al. 1999) at 15 C and 1013.25 hPa; the scale height is the one
    ///   that gives the vertical optical depth of the same paper.
    /// - Haze: clean continental air, extinction 2.5e-5/m at 550 nm (a meteorological optical range of 82 km
    ///   with the gas), wavelength exponent 1.3 (Angstrom 1929), single-scattering albedo 0.95, g = 0.76, scale height
    ///   1.2 km.
    /// - Ozone: 300 Dobson units in a tent from 10 to 40 km, cross-sections of Serdyuchenko et al. 2014 at 233 K.
    /// - Sun: spectral irradiance of ASTM G173 (extraterrestrial), W m^-2 nm^-1, and angular radius of the disc, both
    ///   at 1 au.
    /// - Ground: grey, albedo 0.15 (land without snow). Radius: IUGG mean, 6371.0 km; the air is cut at 100 km.
    pub fn earth() -> Self {
        Self::earth_at(EARTH_WAVELENGTHS_NM)
    }

    /// Returns [`Planet::earth`] at other wavelengths, nm, each in `[365, 835]`.
    pub fn earth_at(wavelengths_nm: [f64; 3]) -> Self {
        Self {
            wavelengths_nm,
            solar_irradiance: wavelengths_nm.map(spectra::solar_irradiance),
            sun_angular_radius_deg: 0.26656,
            bottom_radius_m: 6_371_000.0,
            top_radius_m: 6_471_000.0,
            ground_albedo: [0.15; 3],
            rayleigh: Rayleigh {
                scattering_per_m: wavelengths_nm.map(rayleigh_scattering_per_m),
                scale_height_m: EARTH_RAYLEIGH_SCALE_HEIGHT_M,
            },
            mie: Mie::earth_at(wavelengths_nm),
            absorption: Absorption {
                extinction_per_m: wavelengths_nm
                    .map(|nm| 300.0 * DOBSON_UNIT_PER_M2 / 15_000.0 * spectra::ozone_cross_section_m2(nm)),
                center_altitude_m: 25_000.0,
                half_width_m: 15_000.0,
            },
        }
    }

    /// Returns the ratio of the sun's irradiance to that of the Earth's sun at 1 au, at each wavelength.
    pub(crate) fn sun_ratios(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.solar_irradiance[i] / spectra::solar_irradiance(self.wavelengths_nm[i]))
    }

    /// Returns the planet's own haze, which is in its air besides the weather's haze. `None` if the weather alone gives
    /// the haze: if the planet's haze is the Earth's ([`Mie::earth_at`], to 1e-9 of each number), or there is none.
    pub fn own_haze(&self) -> Option<Mie> {
        let numbers = |m: &Mie| {
            let [s, e] = [m.scattering_per_m, m.extinction_per_m];
            [s[0], s[1], s[2], e[0], e[1], e[2], m.scale_height_m, m.asymmetry_g]
        };
        let (own, earth) = (numbers(&self.mie), numbers(&Mie::earth_at(self.wavelengths_nm)));
        let differs = own.iter().zip(earth).any(|(a, b)| (a - b).abs() > 1e-9 * b.abs());
        let is_there = self.mie.scale_height_m > 0.0 && self.mie.extinction_per_m.iter().any(|e| *e > 0.0);
        (differs && is_there).then_some(self.mie)
    }

    /// Returns the planet at three other wavelengths, nm, each in `[365, 835]`. Every spectrum except the haze's is the
    /// Earth's (Bodhaine's gas, ozone's cross-section, the sun's spectrum; a flat one for the ground) times a factor.
    /// The factor is linear between this planet's three wavelengths and constant outside. Between two neighbouring
    /// wavelengths of the three, haze follows a power of the wavelength (Angstrom 1929). This power law is extrapolated
    /// beyond the outer two. At the planet's own wavelengths all values are unchanged.
    pub fn at_wavelengths(&self, wavelengths_nm: [f64; 3]) -> Self {
        let shaped = |own: [f64; 3], law: &dyn Fn(f64) -> f64| {
            let factor = |i: usize| own[i] / law(self.wavelengths_nm[i]).max(f64::MIN_POSITIVE);
            let factors = [factor(0), factor(1), factor(2)];
            wavelengths_nm.map(|nm| law(nm) * spectra::between(&self.wavelengths_nm, &factors, nm))
        };
        let flat = |_: f64| 1.0;
        let mut out = Self { wavelengths_nm, ..*self };
        out.solar_irradiance = shaped(self.solar_irradiance, &spectra::solar_irradiance);
        out.ground_albedo = shaped(self.ground_albedo, &flat);
        out.rayleigh.scattering_per_m = shaped(self.rayleigh.scattering_per_m, &rayleigh_scattering_per_m);
        let haze = |own: &[f64; 3]| wavelengths_nm.map(|nm| spectra::power_between(&self.wavelengths_nm, own, nm));
        out.mie.extinction_per_m = haze(&self.mie.extinction_per_m);
        out.mie.scattering_per_m = haze(&self.mie.scattering_per_m);
        for (s, e) in out.mie.scattering_per_m.iter_mut().zip(out.mie.extinction_per_m) {
            *s = s.min(e);
        }
        out.absorption.extinction_per_m = shaped(self.absorption.extinction_per_m, &spectra::ozone_cross_section_m2);
        out
    }

    /// Returns the planet with the coefficients of its gas, haze and ozone multiplied by `factor`.
    pub fn with_air_scaled(mut self, factor: f64) -> Self {
        for list in [
            &mut self.rayleigh.scattering_per_m,
            &mut self.mie.scattering_per_m,
            &mut self.mie.extinction_per_m,
            &mut self.absorption.extinction_per_m,
        ] {
            list.iter_mut().for_each(|v| *v *= factor);
        }
        self
    }

    /// Returns the thickness of the air, m.
    pub fn thickness_m(&self) -> f64 {
        self.top_radius_m - self.bottom_radius_m
    }

    /// Writes the planet as a planet file that [`Planet::from_toml`] reads back bit for bit.
    pub fn to_toml(&self) -> String {
        let mut out = String::new();
        let mut section = "";
        for field in &FIELDS {
            if field.section != section {
                section = field.section;
                let _ = write!(out, "\n[{section}]\n");
            }
            let values: Vec<String> = (field.get)(self).iter().map(|v| format!("{v:?}")).collect();
            let value = if values.len() == 1 { values[0].clone() } else { format!("[{}]", values.join(", ")) };
            let _ = writeln!(out, "{} = {value}  # {}", field.key, field.accepted());
        }
        out
    }

    /// Checks every field against its range and the fields against each other.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`]; the message names the key, its unit and the accepted range.
    pub fn check(&self) -> Result<()> {
        FIELDS.iter().try_for_each(|f| f.check(self))?;
        if self.top_radius_m <= self.bottom_radius_m {
            let accepted = format!("above bottom_radius_m = {:?} m", self.bottom_radius_m);
            return Err(Error::range("top_radius_m", &accepted, self.top_radius_m));
        }
        for (s, e) in self.mie.scattering_per_m.iter().zip(self.mie.extinction_per_m) {
            if *s > e * (1.0 + 1e-12) {
                let accepted = format!("at most mie.extinction_per_m = {e:?} 1/m (extinction contains scattering)");
                return Err(Error::range("mie.scattering_per_m", &accepted, s));
            }
        }
        Ok(())
    }

    /// Returns a hash that names cached tables of this planet (FNV-1a, 64 bits, over the fields' bits). It is equal for
    /// equal fields on every machine, and in every version in which the fields mean the same.
    pub fn hash(&self) -> u64 {
        let mut h: u64 = 0xcbf2_9ce4_8422_2325;
        let mut eat = |bytes: &[u8]| {
            for b in bytes {
                h = (h ^ u64::from(*b)).wrapping_mul(0x0000_0100_0000_01b3);
            }
        };
        for field in &FIELDS {
            eat(field.name().as_bytes());
            for v in (field.get)(self) {
                // + 0.0 turns -0 into 0, because the two mean the same.
                eat(&(v + 0.0).to_bits().to_le_bytes());
            }
        }
        h
    }
}
