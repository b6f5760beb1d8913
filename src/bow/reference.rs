//! The bows of one drop in f64: geometric optics, and the interference of the rays.

use std::f64::consts::PI;

use crate::light::spectrum::{REC709_FROM_XYZ, apply, cie_1931};

/// Returns the refractive index of pure water at 10 degrees Celsius (Quan and Fry 1995, equation 3), 400 to 700 nm.
pub fn water_index(wavelength_nm: f64) -> f64 {
    let (t, w) = (10.0, wavelength_nm);
    1.31405 - 2.02e-6 * t * t + (15.868 - 0.00423 * t) / w - 4382.0 / (w * w) + 1.1455e6 / (w * w * w)
}

/// Rays of one wavelength that are reflected `inside` times in a drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rays {
    /// Number of internal reflections: 1 makes the primary bow, 2 the secondary.
    pub inside: u32,
    /// Refractive index.
    pub index: f64,
}

/// Amplitudes and path difference of the two rays that leave a drop in one direction.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Pair {
    /// Amplitudes of the ray nearer to the drop's edge, then of the other ray, each in both polarisations. Their
    /// squares are the ratio of the scattered light to the light on a square whose side is the drop's radius, 1/sr.
    pub amplitudes: [[f64; 2]; 2],
    /// Optical path of the first ray less that of the second, in radii.
    pub ahead: f64,
}

impl Rays {
    /// Returns the cosines of incidence and refraction of a ray at `b` radii from the middle; the sines are `b` and
    /// `b / index`.
    fn cosines(&self, b: f64) -> [f64; 2] {
        [(1.0 - b * b).max(0.0).sqrt(), (1.0 - (b / self.index).powi(2)).sqrt()]
    }

    /// Returns the angle, rad, by which a drop turns a ray that meets it at `b` radii from its middle.
    pub fn turn(&self, b: f64) -> f64 {
        let k = f64::from(self.inside);
        k * PI + 2.0 * b.asin() - 2.0 * (k + 1.0) * (b / self.index).asin()
    }

    /// Returns the derivative of the turn by `b`.
    fn slope(&self, b: f64) -> f64 {
        let [ci, cr] = self.cosines(b);
        2.0 / ci.max(1e-9) - 2.0 * (f64::from(self.inside) + 1.0) / (self.index * cr)
    }

    /// Returns the `b` at which the turn is least: cos^2 i = (n^2 - 1) / (k (k + 2)) (Descartes; van de Hulst 1957,
    /// section 12.31).
    pub fn least(&self) -> f64 {
        let k = f64::from(self.inside);
        (1.0 - (self.index * self.index - 1.0) / (k * (k + 2.0))).sqrt()
    }

    /// Returns half of the second derivative of the turn at its minimum.
    fn bend(&self) -> f64 {
        let h = 1e-4;
        (self.slope(self.least() + h) - self.slope(self.least() - h)) / (4.0 * h)
    }

    /// Returns the optical path of a ray, in radii, less that of a ray that goes straight to the middle of the drop and
    /// leaves from there in the same direction, both in air. From one ray to its neighbour the path changes by b dD,
    /// where D is the turn.
    fn path(&self, b: f64) -> f64 {
        let [ci, cr] = self.cosines(b);
        2.0 * (f64::from(self.inside) + 1.0) * self.index * cr - 2.0 * ci
    }

    /// Returns the share of the amplitude that a ray keeps in both polarisations (Fresnel), with its sign.
    fn passed(&self, b: f64) -> [f64; 2] {
        let [ci, cr] = self.cosines(b);
        let n = self.index;
        let reflected = [(ci - n * cr) / (ci + n * cr), (cr - n * ci) / (cr + n * ci)];
        reflected.map(|r| (1.0 - r * r) * (-r).powi(self.inside as i32))
    }

    /// Returns the amplitudes of a ray in both polarisations, reduced by the divergence of neighbouring rays.
    fn amplitude(&self, b: f64, turned: f64) -> [f64; 2] {
        let spread = b / (turned.sin().abs().max(1e-6) * self.slope(b).abs());
        self.passed(b).map(|f| f * spread.sqrt())
    }

    /// Returns the distance of `angle` from the bow, rad: above 0 on the bright side of the bow, below 0 on the dark
    /// side. `angle` is measured from the antisolar point, rad.
    fn beyond(&self, angle: f64) -> f64 {
        let first = self.turn(self.least()) - PI;
        if self.inside == 1 { -first - angle } else { angle - first }
    }

    /// Returns both rays that leave at an angle from the antisolar point, rad; `None` on the dark side of the bow and
    /// within half a degree of it.
    pub fn pair(&self, angle: f64) -> Option<Pair> {
        let beyond = self.beyond(angle);
        if beyond < NEAR_RAD {
            return None;
        }
        let (least, turned) = (self.least(), self.turn(self.least()) + beyond);
        let find = |mut dark: f64, mut bright: f64| {
            for _ in 0..30 {
                let middle = 0.5 * (dark + bright);
                if self.turn(middle) < turned { dark = middle } else { bright = middle }
            }
            0.5 * (dark + bright)
        };
        let (mut low, mut high) = (([0.0; 2], self.path(0.0)), ([0.0; 2], self.path(1.0)));
        let most = self.turn(1.0);
        if turned < most {
            let b = find(least, 1.0);
            high = (self.amplitude(b, turned), self.path(b));
        } else {
            // All rays between the least turn and the edge turn by less than `turned`: this side has no ray. The path
            // continues linearly from that of the ray at the edge.
            high.1 += turned - most;
        }
        if turned < self.turn(0.0) {
            let b = find(least, 0.0);
            low = (self.amplitude(b, turned), self.path(b));
        }
        Some(Pair { amplitudes: [high.0, low.0], ahead: high.1 - low.1 })
    }

    /// Returns the light that a drop of `size` (its circumference divided by the wavelength) scatters to an angle from
    /// the antisolar point, relative to the light on a square whose side is the drop's radius, 1/sr. `pair` is
    /// [`Rays::pair`] of that angle.
    ///
    /// The bright side uses the uniform approximation of two rays that merge (Berry 1966, equation 28; Khare and
    /// Nussenzveig 1974). Near the bow and on its dark side Airy's approximation (1838) is used.
    pub fn intensity(&self, size: f64, angle: f64, pair: Option<&Pair>) -> f64 {
        let Some(pair) = pair else {
            let (b, bend) = (self.least(), self.bend());
            let sine = angle.sin().max(1e-6);
            let light = self.passed(b).map(|f| f * f).iter().sum::<f64>() / 2.0 * b / sine;
            let z = -size.powf(2.0 / 3.0) * self.beyond(angle) / bend.cbrt();
            return 2.0 * PI * light * size.cbrt() / bend.powf(2.0 / 3.0) * airy(z)[0].powi(2);
        };
        let z = (0.75 * size * pair.ahead.max(0.0)).powf(2.0 / 3.0);
        let [ai, slope] = airy(-z);
        let [with, against] = [z.sqrt() * ai * ai, slope * slope / z.sqrt()];
        let [high, low] = pair.amplitudes;
        let of = |i: usize| PI * ((high[i] + low[i]).powi(2) * with + (high[i] - low[i]).powi(2) * against);
        0.5 * (of(0) + of(1))
    }
}

/// Angle beyond the bow within which Airy's own form is used, rad.
const NEAR_RAD: f64 = 0.0087;

/// Returns Airy's function and its derivative: for |x| below 5 by the series about 0 (Abramowitz and Stegun 1964,
/// 10.4.2), otherwise by the asymptotic expansion (10.4.59 to 10.4.62, two terms).
pub fn airy(x: f64) -> [f64; 2] {
    if x.abs() < 5.0 {
        let (c1, c2) = (0.355_028_053_887_817_2, 0.258_819_403_792_806_8);
        let cube = x * x * x;
        let (mut f, mut g) = (1.0, x);
        let (mut sum, mut slope) = (c1 - c2 * x, -c2);
        for k in 1..40 {
            let n = 3.0 * f64::from(k);
            slope += c1 * f * x * x / (n - 1.0) - c2 * g * x * x / n;
            f *= cube / ((n - 1.0) * n);
            g *= cube / (n * (n + 1.0));
            sum += c1 * f - c2 * g;
        }
        return [sum, slope];
    }
    let root = x.abs().sqrt();
    let zeta = 2.0 / 3.0 * x.abs() * root;
    let quarter = root.sqrt();
    if x > 0.0 {
        let e = (-zeta).exp() / (2.0 * PI.sqrt());
        return [e / quarter * (1.0 - 5.0 / (72.0 * zeta)), -e * quarter * (1.0 + 7.0 / (72.0 * zeta))];
    }
    let (s, c) = (zeta + 0.25 * PI).sin_cos();
    let a = 1.0 / PI.sqrt();
    [a / quarter * (s - 5.0 / (72.0 * zeta) * c), -a * quarter * (c - 7.0 / (72.0 * zeta) * s)]
}

/// Wavelengths over which colours are summed, nm.
pub const WAVELENGTHS_NM: [f64; 11] = [420.0, 446.0, 472.0, 498.0, 524.0, 550.0, 576.0, 602.0, 628.0, 654.0, 680.0];

/// Returns the shares of the wavelengths in linear red, green and blue. They sum to 1 in each channel: white stays
/// white.
pub fn colour_shares() -> [[f64; 3]; WAVELENGTHS_NM.len()] {
    let of = WAVELENGTHS_NM.map(|nm| apply(&REC709_FROM_XYZ, &cie_1931(nm)));
    let sum: [f64; 3] = std::array::from_fn(|c| of.iter().map(|v| v[c]).sum());
    of.map(|v| std::array::from_fn(|c| v[c] / sum[c]))
}
