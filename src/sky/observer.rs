//! Observer of the sky, and the lamps in it.

use super::Planet;
use super::uniforms::LampUniform;
use crate::error::{Error, Result, check_range};

/// Appearance of a lamp's disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Disc {
    /// A sun with limb darkening by wavelength (Hestroffer and Magnan 1998).
    Sun,
    /// A moon, lit from the given unit direction in the observer's frame, with the reflectance law of Lommel and
    /// Seeliger.
    Moon {
        /// Unit direction from the moon towards the sun, in the observer's level frame.
        lit_from: [f64; 3],
    },
}

/// A distant light: the sun or the moon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Unit direction towards the lamp in the observer's level frame (z up; x and y any level axes), geometric, without
    /// refraction.
    pub toward: [f64; 3],
    /// Irradiance at the top of the air on a surface facing the lamp, per wavelength of the planet, W m^-2 nm^-1,
    /// `[0, 1e6]`; 0 switches the lamp off.
    pub irradiance: [f64; 3],
    /// Angular radius of the disc, rad, `[0, 0.2]`; 0 draws no disc.
    pub angular_radius: f64,
    /// Appearance of the disc.
    pub disc: Disc,
    /// Whether the lamp's light in the air is drawn. If not, only its disc is, which costs almost nothing.
    /// [`Lamp::sun`] sets true.
    pub lights_air: bool,
}

impl Lamp {
    /// Creates the planet's sun in a direction.
    pub fn sun(planet: &Planet, direction: [f64; 3]) -> Self {
        Self {
            toward: direction,
            irradiance: planet.solar_irradiance,
            angular_radius: planet.sun_angular_radius_deg.to_radians(),
            disc: Disc::Sun,
            lights_air: true,
        }
    }

    /// Returns the planet's sun above the x axis at a zenith angle, rad.
    pub fn sun_at_zenith_angle(planet: &Planet, zenith_angle: f64) -> Self {
        Self::sun(planet, [zenith_angle.sin(), 0.0, zenith_angle.cos()])
    }

    /// Whether the lamp sends any light.
    pub fn is_lit(&self) -> bool {
        self.irradiance.iter().any(|e| *e > 0.0)
    }

    fn check(&self) -> Result<()> {
        let unit = |v: &[f64; 3]| (v.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-3;
        if !unit(&self.toward) {
            return Err(Error::range("lamp.toward", "a unit vector", format!("{:?}", self.toward)));
        }
        if let Disc::Moon { lit_from } = &self.disc
            && !unit(lit_from)
        {
            return Err(Error::range("lamp.disc.lit_from", "a unit vector", format!("{lit_from:?}")));
        }
        self.irradiance.iter().try_for_each(|e| check_range("lamp.irradiance", *e, 0.0, 1e6, "W m^-2 nm^-1"))?;
        check_range("lamp.angular_radius", self.angular_radius, 0.0, 0.2, "rad")
    }

    /// Values of the lamp as the look-ups read them.
    pub(crate) fn uniform(&self, planet: &Planet, layer: u32) -> LampUniform {
        let f = |v: [f64; 3]| v.map(|x| x as f32);
        let level = self.toward[0].hypot(self.toward[1]);
        let level = if level > 1e-6 { [self.toward[0] / level, self.toward[1] / level] } else { [1.0, 0.0] };
        let solid_angle = std::f64::consts::PI * self.angular_radius.sin().powi(2).max(1e-12);
        let shown = if self.angular_radius > 0.0 { 1.0 / solid_angle } else { 0.0 };
        let limb = planet.wavelengths_nm.map(limb_exponent);
        let (kind, limb, lit_from, scale) = match self.disc {
            // The mean of mu^a over the disc is 2/(2 + a).
            Disc::Sun => (0, limb, [0.0; 3], limb.map(|a| shown * (2.0 + a) / 2.0)),
            Disc::Moon { lit_from } => (1, [1.0; 3], lit_from, [shown / moon_mean(&self.toward, &lit_from); 3]),
        };
        LampUniform {
            toward: f(self.toward),
            angular_radius: self.angular_radius as f32,
            irradiance: f(self.irradiance),
            kind,
            limb: f(limb),
            inverse_radius: (1.0 / self.angular_radius.max(1e-6)) as f32,
            lit_from: f(lit_from),
            depth_from: 0.0,
            level: level.map(|x| x as f32),
            layer,
            unused_b: 0,
            disc: std::array::from_fn(|k| (self.irradiance[k] * scale[k]) as f32),
            depth_scale: 0.0,
            depth: [[0.0; 4]; 4],
        }
    }
}

/// Exponent of the sun's limb darkening, I = mu^a: the fit of Hestroffer and Magnan 1998 over 416 to 1099 nm.
fn limb_exponent(wavelength_nm: f64) -> f64 {
    -0.023 + 0.292 / (wavelength_nm * 1e-3).clamp(0.4, 1.1)
}

/// Mean of Lommel and Seeliger's law over the visible disc of the moon. Division by it gives the disc the irradiance of
/// the lamp.
fn moon_mean(direction: &[f64; 3], lit_from: &[f64; 3]) -> f64 {
    let cos_apart = direction.iter().zip(lit_from).map(|(a, b)| a * b).sum::<f64>().clamp(-1.0, 1.0);
    let sin_apart = (1.0 - cos_apart * cos_apart).sqrt();
    let n = 32;
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let (x, y) =
                ((2.0 * f64::from(i) + 1.0) / f64::from(n) - 1.0, (2.0 * f64::from(j) + 1.0) / f64::from(n) - 1.0);
            let mu = 1.0 - x * x - y * y;
            if mu > 0.0 {
                let mu = mu.sqrt();
                let mu0 = (x * sin_apart - mu * cos_apart).max(0.0);
                sum += mu0 / (mu0 + mu);
            }
        }
    }
    // The mean of a new moon is 0. The lower limit keeps the division by it finite.
    (sum / (std::f64::consts::FRAC_PI_4 * f64::from(n * n))).max(1e-4)
}

/// Position from which the sky is seen, and its lamps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer {
    /// Altitude above the planet's sphere, m, `[-1e4, 1e8]`; below 0 the sky is that of altitude 0.
    pub altitude_m: f64,
    /// Up to two lamps; lamps without light cost nothing.
    pub lamps: [Option<Lamp>; 2],
    /// Strength of refraction for the discs, as a share of the standard one, `[0, 1]`.
    pub refraction: f64,
    /// Whether the tables follow every change of altitude and sun, however small. Otherwise they are kept while both
    /// changes are small. The sine of each lamp's elevation may change by 2e-5, or by 2e-4 in a frame that works on the
    /// planet's tables. The altitude may change by the larger of two values. One is 0.2 % of the altitude plus 1 cm.
    /// The other is a thousandth of the air's smallest scale height (1.2 m in clear air), but at most 30 % of the
    /// altitude plus 5 cm. Kept tables are off by at most 0.4 % by day, and 0.9 % at dusk near the horizon.
    pub exact: bool,
}

impl Observer {
    /// Creates an observer at `altitude_m` with one sun above the x axis at `zenith_angle`, rad.
    pub fn under_sun(planet: &Planet, altitude_m: f64, zenith_angle: f64) -> Self {
        let lamps = [Some(Lamp::sun_at_zenith_angle(planet, zenith_angle)), None];
        Self { altitude_m, lamps, refraction: 1.0, exact: true }
    }

    /// Checks that every field is within its range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn check(&self) -> Result<()> {
        check_range("altitude_m", self.altitude_m, -1e4, 1e8, "m")?;
        check_range("refraction", self.refraction, 0.0, 1.0, "")?;
        self.lamps.iter().flatten().try_for_each(Lamp::check)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limb_darkens_more_in_the_blue_as_measured() {
        // Pierce and Slaughter 1977 as quoted by Hestroffer and Magnan: exponents about 0.65, 0.50, 0.40.
        for (nm, a) in [(440.0, 0.64), (550.0, 0.51), (680.0, 0.41)] {
            assert!((limb_exponent(nm) - a).abs() < 0.01, "{nm}");
        }
    }

    #[test]
    fn a_full_moon_is_flat_and_a_half_moon_is_half() {
        let toward = [0.0, 0.0, 1.0];
        assert!((moon_mean(&toward, &[0.0, 0.0, -1.0]) - 0.5).abs() < 0.02);
        let half = moon_mean(&toward, &[1.0, 0.0, 0.0]);
        assert!(half > 0.1 && half < 0.25, "{half}");
    }

    #[test]
    fn faults_are_named() {
        let earth = Planet::earth();
        let mut o = Observer::under_sun(&earth, 1.0, 0.5);
        assert!(o.check().is_ok());
        o.altitude_m = f64::NAN;
        assert!(o.check().unwrap_err().to_string().contains("altitude_m"));
        o.altitude_m = 0.0;
        o.lamps[1] = Some(Lamp { toward: [0.0; 3], ..Lamp::sun_at_zenith_angle(&earth, 0.0) });
        assert!(o.check().unwrap_err().to_string().contains("lamp.toward"));
    }
}
