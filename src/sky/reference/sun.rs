//! Sunlight that reaches a point, and the light that is scattered once from it.

use super::march::Sample;
use super::medium::{Medium, mie_phase, rayleigh_phase};
use super::quadrature::linear;
use super::ray::{Ray, horizon_mu, sun_hidden};

/// Transmittance from a point to the sun, which is a point at infinity with the zenith angle cosine `mu_s`; 0 behind
/// the planet. Computed by quadrature.
pub fn sun_transmittance(medium: &Medium, altitude_m: f64, mu_s: f64) -> [f64; 3] {
    if sun_hidden(medium, altitude_m, mu_s) {
        return [0.0; 3];
    }
    medium.transmittance(&Ray::new(medium, altitude_m, mu_s).columns_to_space(medium))
}

/// Samples of the sun's zenith angle over its disc, with their shares. The disc is cut into strips parallel to the
/// horizon by the Gauss-Chebyshev rule of the second kind, which is exact for polynomials of degree below twice the
/// number of strips. With one strip the sun is a point.
pub fn disc_strips(sun_zenith: f64, angular_radius: f64, strips: usize) -> Vec<(f64, f64)> {
    let n = strips.max(1);
    (1..=n)
        .map(|k| {
            let a = std::f64::consts::PI * k as f64 / (n + 1) as f64;
            (sun_zenith + angular_radius * a.cos(), 2.0 / (n + 1) as f64 * a.sin() * a.sin())
        })
        .collect()
}

/// Table of the columns towards the sun, for the many look-ups of multiple scattering. It holds the logarithms of the
/// columns of gas and haze, which are interpolated linearly; ozone's column has a closed form. Tests compare the table
/// with quadrature.
pub struct SunTable {
    medium: Medium,
    altitudes: usize,
    angles: usize,
    /// Logarithms of the columns of gas and haze, in m at density 1, in the order [altitude][angle].
    columns: Vec<[f64; 2]>,
}

/// Smallest column in the table, m at density 1; shorter columns are raised to it. A millimetre of air takes no light.
const LEAST_COLUMN_M: f64 = 1e-3;

impl SunTable {
    /// Tabulates columns at `altitudes` x `angles` nodes (each at least 2).
    pub fn new(medium: &Medium, altitudes: usize, angles: usize) -> Self {
        let mut columns = Vec::with_capacity(altitudes * angles);
        for i in 0..altitudes {
            let x = i as f64 / (altitudes - 1) as f64;
            let h = medium.top_m * x * x;
            let horizon = horizon_mu(medium, h);
            for j in 0..angles {
                let y = j as f64 / (angles - 1) as f64;
                let ray = Ray::new(medium, h, horizon + (1.0 - horizon) * y * y);
                let [gas, haze, _] = ray.columns_to_space(medium);
                columns.push([gas, haze].map(|c| c.max(LEAST_COLUMN_M).ln()));
            }
        }
        Self { medium: *medium, altitudes, angles, columns }
    }

    /// Transmittance to the sun, as [`sun_transmittance`] computes it.
    pub fn transmittance(&self, altitude_m: f64, mu_s: f64) -> [f64; 3] {
        let h = altitude_m.clamp(0.0, self.medium.top_m);
        let horizon = horizon_mu(&self.medium, h);
        if mu_s < horizon {
            return [0.0; 3];
        }
        let (i, fi) = linear((h / self.medium.top_m).sqrt() * (self.altitudes - 1) as f64, self.altitudes);
        let y = ((mu_s - horizon) / (1.0 - horizon)).sqrt();
        let (j, fj) = linear(y * (self.angles - 1) as f64, self.angles);
        let at = |i: usize, j: usize| &self.columns[i * self.angles + j];
        let (a, b, c, d) = (at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
        let mix = |k: usize| (1.0 - fi) * ((1.0 - fj) * a[k] + fj * b[k]) + fi * ((1.0 - fj) * c[k] + fj * d[k]);
        let has_ozone = self.medium.extinction[2].iter().any(|b| *b > 0.0);
        let ozone = if has_ozone { Ray::new(&self.medium, h, mu_s).ozone_to_space(&self.medium) } else { 0.0 };
        let columns = [mix(0).exp(), mix(1).exp(), ozone];
        self.medium.transmittance(&columns)
    }
}

/// Light scattered once into a ray by gas and by haze, without the phase functions, per unit irradiance of the sun.
/// `samples` are those of the ray, with panels cut at the edges of the `shadow`. `sun` takes an altitude, m, and the
/// cosine of the sun's zenith angle there, and returns the transmittance to the sun.
pub fn scattered_once(
    ray: &Ray,
    samples: &[Sample],
    shadow: Option<(f64, f64)>,
    mu_s: f64,
    nu: f64,
    sun: impl Fn(f64, f64) -> [f64; 3],
) -> ([f64; 3], [f64; 3]) {
    let (mut gas, mut haze) = ([0.0; 3], [0.0; 3]);
    let r = ray.radius_m();
    for s in samples {
        if shadow.is_some_and(|(from, to)| s.distance_m > from && s.distance_m < to) {
            continue;
        }
        let t = sun(s.altitude_m, (r * mu_s + s.distance_m * nu) / (ray.bottom_m + s.altitude_m));
        for c in 0..3 {
            gas[c] += s.gas[c] * t[c];
            haze[c] += s.haze[c] * t[c];
        }
    }
    (gas, haze)
}

/// Radiance from the results of [`scattered_once`], with the phase functions applied.
pub fn with_phase(medium: &Medium, nu: f64, gas: &[f64; 3], haze: &[f64; 3]) -> [f64; 3] {
    let (p, m) = (rayleigh_phase(nu), mie_phase(nu, medium.asymmetry_g));
    std::array::from_fn(|c| p * gas[c] + m * haze[c])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;

    #[test]
    fn table_follows_quadrature() {
        let mut hazy = Planet::earth();
        hazy.mie.extinction_per_m = [3e-4; 3];
        for planet in [Planet::earth(), hazy] {
            let medium = Medium::of(&planet);
            let table = SunTable::new(&medium, 192, 512);
            let (mut sum, mut count) = (0.0, 0);
            for i in 0..60 {
                let h = 70_000.0 * (f64::from(i) / 59.3).powi(2);
                for deg in 0..200 {
                    let mu_s = (f64::from(deg) * 0.5).to_radians().cos();
                    let (a, b) = (table.transmittance(h, mu_s), sun_transmittance(&medium, h, mu_s));
                    for c in 0..3 {
                        (sum, count) = (sum + (a[c] - b[c]).abs(), count + 1);
                        assert!((a[c] - b[c]).abs() < 5e-4, "h {h} sun {} {a:?} {b:?}", f64::from(deg) * 0.5);
                    }
                }
            }
            let mean = sum / f64::from(count);
            assert!(mean < 2e-5 && mean > 1e-9, "mean error {mean}");
        }
    }

    #[test]
    fn strips_of_the_disc_average_exactly() {
        for n in [1, 2, 5, 9] {
            let strips = disc_strips(1.0, 0.1, n);
            let mean = |f: &dyn Fn(f64) -> f64| strips.iter().map(|(z, w)| w * f(*z)).sum::<f64>();
            assert!((mean(&|_| 1.0) - 1.0).abs() < 1e-12);
            assert!((mean(&|z| z) - 1.0).abs() < 1e-12);
            // The mean square distance from the centre line of a disc of radius a is a^2 / 4.
            if n > 1 {
                assert!((mean(&|z| (z - 1.0).powi(2)) - 0.0025).abs() < 1e-12);
            }
        }
    }
}
