//! Light by wavelength: the sun's spectrum, ozone's absorption, the eye's response, and the conversion of a spectrum to
//! a linear Rec. 709 colour, from a set of many wavelengths or from three.
//!
//! A colour is a triple of linear Rec. 709 luminances: `0.2126 r + 0.7152 g + 0.0722 b` is the luminance in cd/m^2, or
//! the illuminance in lux. A *transfer* is the ratio of a radiance to the sun's irradiance at the same wavelength
//! (1/sr), or the share of the irradiance that arrives (dimensionless): the effect of the air on sunlight. Transfers
//! are smooth over wavelength, while the sun's spectrum is not. Conversions therefore take transfers and multiply by
//! the sun's spectrum themselves.

use std::sync::LazyLock;

pub use super::spectra::{ozone_cross_section_m2, solar_irradiance};
use super::{
    model::Planet,
    rayleigh::{DOBSON_UNIT_PER_M2, rayleigh_optical_depth},
};
pub use crate::light::spectrum::{LUMINOUS_EFFICACY_LM_PER_W, apply, cie_1931, rec709_of_wavelength};
use crate::{
    error::{Error, Result, check_range},
    light::luminance,
};

/// Returns the colour of light with `transfer` at every wavelength, under the sun at 1 au: sums in steps of 1 nm.
pub fn rec709_of_transfer(transfer: impl Fn(f64) -> f64) -> [f64; 3] {
    let mut out = [0.0; 3];
    for nm in 360..=830 {
        let nm = f64::from(nm);
        let w = transfer(nm) * solar_irradiance(nm);
        let c = rec709_of_wavelength(nm);
        (0..3).for_each(|k| out[k] += w * c[k]);
    }
    out
}

/// Returns the colour of sunlight above the air at 1 au as illuminance on a surface facing it: about 133 klx, slightly
/// warmer than D65's white.
pub fn sun_rec709() -> [f64; 3] {
    static SUN: LazyLock<[f64; 3]> = LazyLock::new(|| rec709_of_transfer(|_| 1.0));
    *SUN
}

/// A set of wavelengths, each with its weight in the colour of a transfer.
#[derive(Clone, Debug)]
pub struct SpectralSet {
    /// Wavelengths, nm, ascending.
    pub wavelengths_nm: Vec<f64>,
    /// Colour of a unit transfer at each wavelength, cd/m^2: the sun's spectrum times the eye's response, integrated in
    /// steps of 1 nm over the hat function of linear interpolation between the wavelengths.
    pub weights: Vec<[f64; 3]>,
}

impl SpectralSet {
    /// Creates the set of `count` wavelengths, `[2, 200]`, evenly spaced from 390 to 710 nm. Beyond the ends, which
    /// contribute about 0.1 % of white or less, the end values are used.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for another count.
    pub fn new(count: usize) -> Result<Self> {
        check_range("count", count as f64, 2.0, 200.0, "wavelengths")?;
        let wavelengths_nm: Vec<f64> = (0..count).map(|i| 390.0 + 320.0 * i as f64 / (count - 1) as f64).collect();
        let weight = |i: usize| {
            let hat = |nm: f64| {
                let x = ((nm - 390.0) / 320.0).clamp(0.0, 1.0) * (count - 1) as f64;
                (1.0 - (x - i as f64).abs()).max(0.0)
            };
            rec709_of_transfer(hat)
        };
        let weights = (0..count).map(weight).collect();
        Ok(Self { wavelengths_nm, weights })
    }

    /// Returns the colour of transfers at the set's wavelengths.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if there are not as many transfers as wavelengths.
    pub fn rec709(&self, transfers: &[f64]) -> Result<[f64; 3]> {
        if transfers.len() != self.weights.len() {
            return Err(Error::range("transfers", &format!("{} values", self.weights.len()), transfers.len()));
        }
        let mut out = [0.0; 3];
        for (t, w) in transfers.iter().zip(&self.weights) {
            (0..3).for_each(|k| out[k] += t * w[k]);
        }
        Ok(out)
    }
}

impl SpectralSet {
    /// Returns planets at the set's wavelengths, three by three (the last one repeated to fill the last planet). Their
    /// sun's irradiance is 1, so that radiances computed for them are transfers.
    pub fn planets(&self, planet: &Planet) -> Vec<Planet> {
        let three = |chunk: &[f64]| {
            let last = chunk[chunk.len() - 1];
            let nm = std::array::from_fn(|i| chunk.get(i).copied().unwrap_or(last));
            Planet { solar_irradiance: [1.0; 3], ..planet.at_wavelengths(nm) }
        };
        self.wavelengths_nm.chunks(3).map(three).collect()
    }

    /// Returns the colour of the triples computed for [`SpectralSet::planets`], in the same order.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if there are not as many triples as planets.
    pub fn rec709_of_triples(&self, triples: &[[f64; 3]]) -> Result<[f64; 3]> {
        if triples.len() != self.wavelengths_nm.len().div_ceil(3) {
            let accepted = format!("{} triples", self.wavelengths_nm.len().div_ceil(3));
            return Err(Error::range("triples", &accepted, triples.len()));
        }
        let flat: Vec<f64> = triples.iter().flatten().copied().take(self.weights.len()).collect();
        self.rec709(&flat)
    }
}

/// A planet at three wavelengths of a set, and the weights of these wavelengths in transfers at the three wavelengths
/// of the planet that [`parts`] splits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpectralTriple {
    /// Planet at these wavelengths; its solar irradiance does not matter.
    pub planet: Planet,
    /// Columns of a matrix, one for each wavelength of the triple: the three transfers at the split planet's
    /// wavelengths that have the same colour as a unit transfer at this wavelength alone.
    pub columns: [[f64; 3]; 3],
}

/// Splits `planet` into planets for a set of `count` wavelengths, a multiple of 3. The sum of all transfers, each times
/// its column, is a triple of transfers at the planet's own wavelengths. The conversion of the planet's own wavelengths
/// turns this triple into the set's colour. With a count of at most 3 the result is the planet itself.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] for a count above 200.
pub(crate) fn parts(planet: &Planet, count: u32) -> Result<Vec<SpectralTriple>> {
    let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    if count <= 3 {
        return Ok(vec![SpectralTriple { planet: *planet, columns: unit }]);
    }
    let set = SpectralSet::new(count as usize)?;
    let back = inverse(&Conversion::of(planet).matrix);
    let part = |(planet, weights): (Planet, &[[f64; 3]])| SpectralTriple {
        planet,
        columns: std::array::from_fn(|i| weights.get(i).map_or([0.0; 3], |w| apply(&back, w))),
    };
    Ok(set.planets(planet).into_iter().zip(set.weights.chunks(3)).map(part).collect())
}

/// Returns the inverse of an invertible matrix, by its adjugate.
fn inverse(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let minor = |r: usize, c: usize| {
        let (a, b) = ((r + 1) % 3, (r + 2) % 3);
        let (d, e) = ((c + 1) % 3, (c + 2) % 3);
        m[a][d] * m[b][e] - m[a][e] * m[b][d]
    };
    let determinant: f64 = (0..3).map(|c| m[0][c] * minor(0, c)).sum();
    std::array::from_fn(|r| std::array::from_fn(|c| minor(c, r) / determinant))
}

/// Conversion of the transfers at three wavelengths to a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conversion {
    /// Matrix from the three transfers to a colour, cd/m^2 (lux).
    pub matrix: [[f64; 3]; 3],
}

impl Conversion {
    /// Creates the conversion in which each wavelength gives one component of the colour: its transfer times that
    /// component of the sun's colour. The wavelengths must represent red, green and blue in this order
    /// (`EARTH_WAVELENGTHS_NM` do, as well as three can). Colours are never negative, and the conversion also suits
    /// lamps, fog and clouds given in Rec. 709.
    pub fn per_channel() -> Self {
        let sun = sun_rec709();
        let mut matrix = [[0.0; 3]; 3];
        (0..3).for_each(|c| matrix[c][c] = sun[c]);
        Self { matrix }
    }

    /// Creates the conversion of a planet's wavelengths: fitted, or per channel if [`Conversion::fitted`] refuses them,
    /// for example because two of them are too close to tell colours apart.
    pub fn of(planet: &Planet) -> Self {
        Self::fitted(&planet.wavelengths_nm).unwrap_or_else(|_| Self::per_channel())
    }

    /// Creates the conversion that fits best, in relative least squares, a family of transfers of air: direct sunlight,
    /// thin and thick skies under suns of 1 to 20 air masses, three amounts of haze, ozone crossed once or twice as
    /// often as gas. Sunlight that is dimmed equally at all wavelengths keeps its colour exactly. Wavelengths may be in
    /// any order. At `EARTH_WAVELENGTHS_NM` it is a little better than [`Conversion::per_channel`] in clear air (9
    /// against 13 % of the luminance in the worst channel, rms over skies and suns) and worse in haze (20 against 12
    /// %): use [`Conversion::per_channel`] there.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] unless the three wavelengths are at least 5 nm apart and lie in `[365, 835]`.
    pub fn fitted(wavelengths_nm: &[f64; 3]) -> Result<Self> {
        for (i, nm) in wavelengths_nm.iter().enumerate() {
            check_range("wavelengths_nm", *nm, 365.0, 835.0, "nm")?;
            if wavelengths_nm[..i].iter().any(|other| (nm - other).abs() < 5.0) {
                return Err(Error::range("wavelengths_nm", "at least 5 nm apart", nm));
            }
        }
        let sun = sun_rec709();
        let mut normal = [[0.0; 2]; 2];
        let mut right = [[0.0; 2]; 3];
        for air in airs() {
            let exact = rec709_of_transfer(|nm| air.transfer(nm));
            let y = luminance(&exact);
            let s = wavelengths_nm.map(|nm| air.transfer(nm) / y);
            // The third column keeps white: it is the sun less the other two.
            let x = [s[0] - s[2], s[1] - s[2]];
            for i in 0..2 {
                (0..2).for_each(|j| normal[i][j] += x[i] * x[j]);
                (0..3).for_each(|c| right[c][i] += x[i] * (exact[c] / y - sun[c] * s[2]));
            }
        }
        let determinant = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
        let matrix = std::array::from_fn(|c| {
            let a = (right[c][0] * normal[1][1] - normal[0][1] * right[c][1]) / determinant;
            let b = (normal[0][0] * right[c][1] - right[c][0] * normal[1][0]) / determinant;
            [a, b, sun[c] - a - b]
        });
        Ok(Self { matrix })
    }

    /// Returns the colour of three transfers.
    pub fn rec709(&self, transfers: &[f64; 3]) -> [f64; 3] {
        apply(&self.matrix, transfers)
    }

    /// Returns the colour of three spectral radiances, W m^-2 sr^-1 nm^-1 (or irradiances, W m^-2 nm^-1), computed with
    /// the planet's [`Planet::solar_irradiance`]; `wavelengths_nm` are the planet's.
    pub fn rec709_of_radiance(&self, wavelengths_nm: &[f64; 3], radiance: &[f64; 3]) -> [f64; 3] {
        self.rec709(&std::array::from_fn(|c| radiance[c] / solar_irradiance(wavelengths_nm[c])))
    }
}

/// A simple model of the transfer of air, for the fit.
struct AirSample {
    /// Vertical optical depth of the haze at 550 nm.
    haze: f64,
    /// Air masses of gas and haze that direct sunlight crosses.
    sun_masses: f64,
    /// Air masses of ozone.
    ozone_masses: f64,
    /// 0: direct light; 1 and 2: light scattered by thin air, without and with haze; 3: by thick air.
    kind: u8,
}

/// Returns the air samples of the fit: all combinations of haze, sun, ozone and kind. They are indexed by arithmetic,
/// because chained flattening iterators compile to a read of an inner iterator that does not exist yet: harmless, but
/// reported by valgrind in a host's program.
fn airs() -> [AirSample; 144] {
    const HAZES: [f64; 3] = [0.03, 0.2, 0.6];
    const SUN_MASSES: [f64; 6] = [1.0, 1.5, 2.5, 5.0, 10.0, 20.0];
    std::array::from_fn(|i| {
        let (sun_masses, haze) = (SUN_MASSES[i / 8 % 6], HAZES[i / 48]);
        let ozone = if i / 4 % 2 == 0 { 1.0 } else { 2.0 };
        AirSample { haze, sun_masses, ozone_masses: sun_masses * ozone, kind: (i % 4) as u8 }
    })
}

impl AirSample {
    fn transfer(&self, nm: f64) -> f64 {
        let gas = rayleigh_optical_depth(nm);
        let haze = self.haze * (nm / 550.0).powf(-1.3);
        let ozone = self.ozone_masses * 300.0 * DOBSON_UNIT_PER_M2 * ozone_cross_section_m2(nm);
        // Scattered light has crossed only a part of the air.
        let dimmed = |share: f64| (-share * self.sun_masses * (gas + haze) - ozone).exp();
        match self.kind {
            0 => dimmed(1.0),
            1 => gas * dimmed(0.7),
            2 => (gas + 0.3 * haze) * dimmed(0.7),
            _ => -(-15.0 * (gas + haze)).exp_m1() * dimmed(0.5),
        }
    }
}

/// Returns the sun's limb darkening: brightness relative to the disc's centre at a point where the line of sight meets
/// the photosphere at an angle of cosine `mu` (1 at the centre, 0 at the limb). The law is 1 - u - v + u mu + v mu^2.
/// Its coefficients u and v are those of Cox 2000 (Allen's Astrophysical Quantities, section 14.7), interpolated
/// linearly between wavelengths and constant outside 380 to 1000 nm.
pub fn limb_darkening(wavelength_nm: f64, mu: f64) -> f64 {
    const TABLE: [(f64, f64, f64); 8] = [
        (380.0, 0.92, -0.05),
        (400.0, 0.91, -0.05),
        (450.0, 0.99, -0.17),
        (500.0, 0.97, -0.22),
        (550.0, 0.93, -0.23),
        (600.0, 0.88, -0.23),
        (800.0, 0.73, -0.22),
        (1000.0, 0.64, -0.20),
    ];
    let nm = wavelength_nm.clamp(TABLE[0].0, TABLE[7].0);
    let i = TABLE.iter().rposition(|row| row.0 <= nm).unwrap_or(0).min(6);
    let (a, b) = (TABLE[i], TABLE[i + 1]);
    let f = (nm - a.0) / (b.0 - a.0);
    let (u, v) = (a.1 + f * (b.1 - a.1), a.2 + f * (b.2 - a.2));
    let mu = mu.clamp(0.0, 1.0);
    1.0 - u - v + u * mu + v * mu * mu
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::spectrum::REC709_FROM_XYZ;

    #[test]
    fn the_sun_has_its_known_sums() {
        let sum = |f: &dyn Fn(f64) -> f64| (360..=830).map(|nm| f(f64::from(nm))).sum::<f64>();
        // Luminous solar constant: 133.3 klx (Darula, Kittler and Gueymard 2005); its chromaticity 0.3234, 0.3333.
        let sun = sun_rec709();
        assert!((luminance(&sun) / 133_334.0 - 1.0).abs() < 0.005, "{}", luminance(&sun));
        let equal = apply(&REC709_FROM_XYZ, &[0.3234, 0.3333, 0.3433]).map(|v| v / 0.3333);
        for c in 0..3 {
            assert!((sun[c] / luminance(&sun) / equal[c] - 1.0).abs() < 0.01, "{sun:?} {equal:?}");
        }
        // Part of the solar constant between 360 and 830 nm.
        assert!((sum(&solar_irradiance) - 730.0).abs() < 15.0, "{}", sum(&solar_irradiance));
    }

    #[test]
    fn ozone_has_the_chappuis_band() {
        // Peak near 602 nm of about 5.1e-25 m^2 (Serdyuchenko et al. 2014), a thirtieth of it in the blue.
        let peak = ozone_cross_section_m2(602.0);
        assert!((peak / 5.0e-25 - 1.0).abs() < 0.05, "{peak}");
        assert!(ozone_cross_section_m2(440.0) < peak / 30.0 && ozone_cross_section_m2(900.0) == 0.0);
        assert!((ozone_cross_section_m2(550.0) / 3.3e-25 - 1.0).abs() < 0.03);
    }

    #[test]
    fn sets_and_conversions_keep_the_sun_white() {
        let sun = sun_rec709();
        for count in [2, 4, 8, 40] {
            let set = SpectralSet::new(count).unwrap();
            let all = set.rec709(&vec![0.25; count]).unwrap();
            assert!((0..3).all(|c| (all[c] / sun[c] * 4.0 - 1.0).abs() < 1e-9));
            assert!(set.rec709(&[1.0]).unwrap_err().to_string().contains("transfers"));
        }
        for nm in [[620.0, 550.0, 450.0], [440.0, 520.0, 600.0]] {
            let all = Conversion::fitted(&nm).unwrap().rec709(&[0.25; 3]);
            assert!((0..3).all(|c| (all[c] / sun[c] * 4.0 - 1.0).abs() < 1e-9));
        }
        assert_eq!(Conversion::per_channel().rec709(&[1.0; 3]), sun);
        assert!(Conversion::fitted(&[550.0, 551.0, 450.0]).unwrap_err().to_string().contains("wavelengths_nm"));
        assert!(SpectralSet::new(1).is_err());
        // Order does not matter to the fit.
        let a = Conversion::fitted(&[620.0, 550.0, 450.0]).unwrap().rec709(&[0.9, 0.6, 0.2]);
        let b = Conversion::fitted(&[450.0, 620.0, 550.0]).unwrap().rec709(&[0.2, 0.9, 0.6]);
        assert!((0..3).all(|c| (a[c] / b[c] - 1.0).abs() < 1e-9));
    }

    #[test]
    fn parts_of_a_set_stand_for_its_colour() {
        let earth = Planet::earth();
        let own = parts(&earth, 3).unwrap();
        assert_eq!((own.len(), own[0].planet, own[0].columns[1]), (1, earth, [0.0, 1.0, 0.0]));
        let set = SpectralSet::new(12).unwrap();
        let parts = parts(&earth, 12).unwrap();
        let transfer = |nm: f64| 0.2 + (550.0 / nm).powi(4);
        let mut three = [0.0; 3];
        for part in &parts {
            for (nm, column) in part.planet.wavelengths_nm.iter().zip(part.columns) {
                (0..3).for_each(|c| three[c] += transfer(*nm) * column[c]);
            }
        }
        let direct: Vec<f64> = set.wavelengths_nm.iter().map(|nm| transfer(*nm)).collect();
        let (seen, exact) = (Conversion::of(&earth).rec709(&three), set.rec709(&direct).unwrap());
        assert!((0..3).all(|c| (seen[c] / exact[c] - 1.0).abs() < 1e-9), "{seen:?} {exact:?}");
    }

    #[test]
    fn limb_darkening_agrees_with_another_law() {
        for nm in [450.0, 550.0, 620.0] {
            // Hestroffer and Magnan 1998: mu^a.
            let a = -0.023 + 292.0 / nm;
            for mu in [1.0, 0.8, 0.6, 0.4, 0.3f64] {
                assert!((limb_darkening(nm, mu) - mu.powf(a)).abs() < 0.02, "{nm} {mu}");
            }
            // Mean over the disc, with the weight 2 mu dmu.
            let n = 2000;
            let mus = (0..n).map(|i| ((f64::from(i) + 0.5) / f64::from(n)).sqrt());
            let mean = mus.map(|mu| limb_darkening(nm, mu)).sum::<f64>() / f64::from(n);
            assert!((mean - 2.0 / (2.0 + a)).abs() < 0.01);
        }
    }
}
