//! Optics of the air at one altitude: densities, coefficients and phase functions.

use std::f64::consts::PI;

use crate::planet::Planet;

/// Number of media: gas, haze, ozone, always in this order.
pub const MEDIA: usize = 3;

/// Optical properties of a planet's air, as the integrals use them.
#[derive(Clone, Copy, Debug)]
pub struct Medium {
    /// Radius of the ground, m.
    pub bottom_m: f64,
    /// Altitude of the top of the air, m.
    pub top_m: f64,
    /// Extinction at density 1 per medium and wavelength, 1/m.
    pub extinction: [[f64; 3]; MEDIA],
    /// Scattering at density 1 of gas and haze per wavelength, 1/m.
    pub scattering: [[f64; 3]; 2],
    /// Scale heights of gas and haze, m.
    pub scale_height_m: [f64; 2],
    /// Centre and half width of the ozone layer, m.
    pub ozone_m: (f64, f64),
    /// Parameter g of the haze's phase function.
    pub asymmetry_g: f64,
}

impl Medium {
    /// Air of `planet`, which must have been checked.
    pub fn of(planet: &Planet) -> Self {
        Self {
            bottom_m: planet.bottom_radius_m,
            top_m: planet.thickness_m(),
            extinction: [
                planet.rayleigh.scattering_per_m,
                planet.mie.extinction_per_m,
                planet.absorption.extinction_per_m,
            ],
            scattering: [planet.rayleigh.scattering_per_m, planet.mie.scattering_per_m],
            scale_height_m: [planet.rayleigh.scale_height_m, planet.mie.scale_height_m],
            ozone_m: (planet.absorption.center_altitude_m, planet.absorption.half_width_m),
            asymmetry_g: planet.mie.asymmetry_g,
        }
    }

    /// Densities relative to those at the ground (gas, haze) or at the centre of the layer (ozone). Below altitude 0
    /// the densities of gas and haze stay at 1: real air 100 m down is 1 % denser, but with a scale height of
    /// centimetres the density would overflow. Above the top all densities are 0.
    pub fn density(&self, altitude_m: f64) -> [f64; MEDIA] {
        if altitude_m > self.top_m {
            return [0.0; MEDIA];
        }
        let [gas, haze] = self.scale_height_m;
        [exponential(altitude_m, gas), exponential(altitude_m, haze), self.ozone(altitude_m)]
    }

    /// Density of the ozone layer, a tent function of altitude.
    pub fn ozone(&self, altitude_m: f64) -> f64 {
        let (center, half_width) = self.ozone_m;
        if half_width <= 0.0 { 0.0 } else { (1.0 - (altitude_m - center).abs() / half_width).max(0.0) }
    }

    /// Optical depth per wavelength of columns, which are in metres at density 1.
    pub fn optical_depth(&self, columns_m: &[f64; MEDIA]) -> [f64; 3] {
        let [gas, haze, ozone] = &self.extinction;
        std::array::from_fn(|c| gas[c] * columns_m[0] + haze[c] * columns_m[1] + ozone[c] * columns_m[2])
    }

    /// Transmittance per wavelength of columns, which are in metres at density 1.
    pub fn transmittance(&self, columns_m: &[f64; MEDIA]) -> [f64; 3] {
        self.optical_depth(columns_m).map(|tau| (-tau).exp())
    }

    /// Altitudes that divide the air into intervals in which densities are smooth enough for one integration panel;
    /// ascending, from 0 to the top. A medium without extinction adds no altitude.
    pub fn panel_altitudes(&self) -> Vec<f64> {
        let mut marks = vec![0.0, self.top_m];
        for (h, beta) in self.scale_height_m.iter().zip(&self.extinction) {
            if beta.iter().any(|b| *b > 0.0) {
                marks.extend([1.0, 3.0, 7.0, 16.0].map(|k| k * h));
            }
        }
        if self.extinction[2].iter().any(|b| *b > 0.0) {
            let (center, half_width) = self.ozone_m;
            marks.extend([center - half_width, center, center + half_width]);
        }
        marks.retain(|m| (0.0..=self.top_m).contains(m));
        marks.sort_by(f64::total_cmp);
        // A mark is dropped if it is less than 10 % above the last mark that was kept, or above 95 % of the top. The
        // two ends always stay.
        let mut kept: Vec<f64> = vec![0.0];
        for m in marks {
            if m > kept[kept.len() - 1] * 1.1 + 1e-9 && m < self.top_m * 0.95 {
                kept.push(m);
            }
        }
        kept.push(self.top_m);
        kept
    }
}

/// exp(-h / H), 1 below altitude 0; a scale height of 0 means no medium above the ground.
fn exponential(altitude_m: f64, scale_height_m: f64) -> f64 {
    if altitude_m <= 0.0 { 1.0 } else { (-altitude_m / scale_height_m).exp() }
}

/// Phase function of gas, 1/sr: 3/(16 pi) (1 + nu^2) (Rayleigh). `nu` is the cosine of the angle between the directions
/// to the sun and of the view, both pointing away from the point.
pub fn rayleigh_phase(nu: f64) -> f64 {
    3.0 / (16.0 * PI) * (1.0 + nu * nu)
}

/// Phase function of haze, 1/sr (Cornette and Shanks 1992, eq. 8):
/// 3/(8 pi) (1 - g^2)/(2 + g^2) (1 + nu^2) / (1 + g^2 - 2 g nu)^(3/2). `nu` as in [`rayleigh_phase`], `|g| < 1`.
pub fn mie_phase(nu: f64, g: f64) -> f64 {
    // A negative g is mirrored into a forward peak, where (1 - g)^2 + 2 g (1 - nu) does not suffer from cancellation.
    let (nu, g) = if g < 0.0 { (-nu, -g) } else { (nu, g) };
    let d = (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - nu).max(0.0);
    3.0 / (8.0 * PI) * (1.0 - g) * (1.0 + g) / (2.0 + g * g) * (1.0 + nu * nu) / (d * d.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::reference::quadrature::Gauss;

    #[test]
    fn phase_functions_integrate_to_one() {
        let gauss = Gauss::new(48);
        let gas = gauss.integrate(-1.0, 1.0, |nu| 2.0 * PI * rayleigh_phase(nu));
        assert!((gas - 1.0).abs() < 1e-12, "{gas}");
        for g in [-0.9999, -0.8, -0.3, 0.0, 0.5, 0.8, 0.95, 0.99, 0.9999] {
            // y = ln(1 - nu) resolves the peak, whose width in 1 - nu is (1 - g)^2 / 2.
            let sign = if g < 0.0 { -1.0 } else { 1.0 };
            let mut sum = 0.0;
            let edges: Vec<f64> = (0..=60).map(|i| -40.0 + f64::from(i) * (40.0 + 2f64.ln()) / 60.0).collect();
            for pair in edges.windows(2) {
                sum += gauss.integrate(pair[0], pair[1], |y| 2.0 * PI * mie_phase(sign * (1.0 - y.exp()), g) * y.exp());
            }
            assert!((sum - 1.0).abs() < 1e-6, "g {g}: {sum}");
        }
    }

    #[test]
    fn haze_phase_has_the_known_peaks_and_sides() {
        // Multiplied by 4 pi: the peak, the value at 90 degrees, and the half-width at half maximum, computed
        // independently of the formula.
        let table = [(0.75, 32.8, 0.131, 12.4), (0.85, 90.6, 0.0676, 7.1), (0.95, 806.0, 0.0192, 2.25)];
        for (g, peak, side, half_width_deg) in table {
            let p = |deg: f64| 4.0 * PI * mie_phase(deg.to_radians().cos(), g);
            assert!((p(0.0) / peak - 1.0).abs() < 2e-3 && (p(90.0) / side - 1.0).abs() < 4e-3, "{g}");
            assert!((p(half_width_deg) / p(0.0) - 0.5).abs() < 0.01, "{g}: {}", p(half_width_deg) / p(0.0));
            assert!((mie_phase(0.3, g) - mie_phase(-0.3, -g)).abs() < 1e-15);
        }
        assert!((mie_phase(0.4, 0.0) - rayleigh_phase(0.4)).abs() < 1e-15);
        assert!(mie_phase(1.0, 0.9999).is_finite());
    }

    #[test]
    fn density_stays_finite_for_any_scale_height() {
        let mut planet = Planet::earth();
        for h in [0.0, 0.01, 1.0, 8450.0, 1e6] {
            (planet.rayleigh.scale_height_m, planet.mie.scale_height_m) = (h, h);
            let medium = Medium::of(&planet);
            for altitude in [-100.0, -1e-9, 0.0, 1e-9, 1.0, 1e5, 1e7] {
                assert!(medium.density(altitude).iter().all(|d| (0.0..=1.0).contains(d)), "{h} {altitude}");
            }
            assert!(medium.panel_altitudes().windows(2).all(|w| w[0] < w[1]));
        }
    }
}
