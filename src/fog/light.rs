//! Light inside a layer: the delta-Eddington solution of a plane-parallel slab. Sun and sky light the slab from above,
//! the ground from below by reflection.
//!
//! The radiance is approximated as I(tau, mu) = I0 + mu I1, where mu > 0 points down. The forward peak of the phase
//! function counts as unscattered (Joseph, Wiscombe and Weinman 1976; its share f is the phase function's second
//! moment, as in delta-M, Wiscombe 1977). With the albedo w, the asymmetry g and the sun's irradiance F, the moments of
//! the transfer equation are (Shettle and Weinman 1970):
//!
//! * dI1/dtau = -3 (1 - w) I0 + 3 w F / (4 pi) e^(-tau/mu0)
//! * dI0/dtau = -(1 - w g) I1 + 3 w g mu0 F / (4 pi) e^(-tau/mu0)
//!
//! The solution is a constant and a slope (w = 1) or two exponentials, plus one exponential of the beam. At the top, pi
//! (I0 + 2/3 I1) is the sky's irradiance. At the bottom, pi (I0 - 2/3 I1) is the ground's albedo times all downward
//! irradiance.

use std::f64::consts::PI;

/// Slab of one channel, in scaled optical depth. Irradiances may have any unit; radiances are in that unit per
/// steradian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// Scaled optical depth from top to bottom.
    pub depth: f64,
    /// Scaled single-scattering albedo.
    pub albedo: f64,
    /// Scaled asymmetry.
    pub asymmetry: f64,
    /// Cosine of the sun's zenith angle, > 0.
    pub mu0: f64,
    /// Irradiance of the sun at the top, on a surface facing it.
    pub sun: f64,
    /// Irradiance of the sky on a horizontal surface at the top.
    pub sky: f64,
    /// Reflectance of the ground at the bottom.
    pub ground: f64,
}

/// Returns the delta scaling of a medium with albedo `w` and moments `m`, as (w f, scaled albedo, scaled asymmetry),
/// where f is the share of scattering that counts as forward. Optical depths must be multiplied by 1 - w f.
pub fn delta_scaling(w: f64, m: [f64; 2]) -> (f64, f64, f64) {
    // A medium that scatters mostly backward has no forward peak.
    let f = if m[0] > 0.0 { m[1].max(0.0) } else { 0.0 };
    let wf = w * f;
    (wf, (w - wf) / (1.0 - wf), (m[0] - f) / (1.0 - f))
}

/// I0 and I1 as functions of the depth t: `constant + slope t + rise e^(-k t) + fall e^(-k (depth - t)) - beam
/// e^(-t/mu0)`, each for (I0, I1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// Slab of which this is the solution.
    pub slab: Slab,
    /// Diffusion exponent; 0 where the medium does not absorb.
    pub k: f64,
    /// Constant terms for I0 and I1.
    pub constant: [f64; 2],
    /// Factors of t.
    pub slope: [f64; 2],
    /// Factors of e^(-k t), which decreases from the top down.
    pub rise: [f64; 2],
    /// Factors of e^(-k (depth - t)), which decreases from the bottom up.
    pub fall: [f64; 2],
    /// Factors of -e^(-t/mu0), the terms of the direct beam.
    pub beam: [f64; 2],
}

/// Product of k and depth below which the medium is treated as not absorbing. The error is its square.
const CONSERVATIVE: f64 = 1e-4;

impl Slab {
    /// Solves the two equations with their boundary conditions.
    pub fn solve(&self) -> Solution {
        self.solve_beside(1e-7)
    }

    /// Solves like [`Slab::solve`], but with terms that f32 can add: they are at most 1 / `margin` times their sum.
    pub(super) fn solve_beside(&self, margin: f64) -> Solution {
        let Self { depth, albedo: w, asymmetry: g, .. } = *self;
        let mut slab = *self;
        let k = (3.0 * (1.0 - w) * (1.0 - w * g)).sqrt();
        // The particular solution has a pole where the beam decreases exactly as the diffuse light does. Shift mu0 away
        // from it.
        if (1.0 - (k * slab.mu0).powi(2)).abs() < margin {
            slab.mu0 *= 1.0 - margin;
        }
        let mu0 = slab.mu0;
        let q = w * self.sun / (4.0 * PI);
        if k * depth < CONSERVATIVE {
            return slab.conservative(q, g);
        }
        let alpha = 3.0 * mu0 * mu0 * q * (1.0 + g * (1.0 - w)) / (1.0 - (k * mu0).powi(2));
        let beta = 3.0 * mu0 * ((1.0 - w) * alpha + q);
        let p = k / (1.0 - w * g);
        let e = (-k * depth).exp();
        let eb = (-depth / mu0).exp();
        // Rows: conditions at top and bottom; columns: rise, fall.
        let down = |i0: f64, i1: f64| i0 + i1 * 2.0 / 3.0;
        let net = |i0: f64, i1: f64| i0 - i1 * 2.0 / 3.0 - slab.ground * (i0 + i1 * 2.0 / 3.0);
        let m = [[down(1.0, p), e * down(1.0, -p)], [e * net(1.0, p), net(1.0, -p)]];
        let rhs = [slab.sky / PI + down(alpha, beta), net(alpha, beta) * eb + slab.ground * mu0 * slab.sun * eb / PI];
        let [c1, c2] = solve2(m, rhs);
        Solution {
            slab,
            k,
            constant: [0.0; 2],
            slope: [0.0; 2],
            rise: [c1, p * c1],
            fall: [c2, -p * c2],
            beam: [alpha, beta],
        }
    }

    /// Solves the equations of a medium that does not absorb, with q = w F / (4 pi).
    fn conservative(self, q: f64, g: f64) -> Solution {
        let Self { depth, mu0, .. } = self;
        let beam = [3.0 * mu0 * mu0 * q, 3.0 * mu0 * q];
        let eb = (-depth / mu0).exp();
        let a = self.ground;
        // Unknowns: I0 at the top without the beam (c0) and the constant I1 (c1).
        let m = [[1.0, 2.0 / 3.0], [1.0 - a, -(1.0 - a) * (1.0 - g) * depth - 2.0 / 3.0 * (1.0 + a)]];
        let top = self.sky / PI + beam[0] + beam[1] * 2.0 / 3.0;
        let bottom =
            eb * ((beam[0] - beam[1] * 2.0 / 3.0) - a * (beam[0] + beam[1] * 2.0 / 3.0) + a * mu0 * self.sun / PI);
        let [c0, c1] = solve2(m, [top, bottom]);
        Solution {
            slab: self,
            k: 0.0,
            constant: [c0, c1],
            slope: [-(1.0 - g) * c1, 0.0],
            rise: [0.0; 2],
            fall: [0.0; 2],
            beam,
        }
    }
}

/// Solves two linear equations with the rows `m` and the right-hand sides `r`.
fn solve2(m: [[f64; 2]; 2], r: [f64; 2]) -> [f64; 2] {
    let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    [(r[0] * m[1][1] - m[0][1] * r[1]) / det, (m[0][0] * r[1] - r[0] * m[1][0]) / det]
}

impl Solution {
    /// Returns (I0, I1) at the scaled depth `t` below the top.
    pub fn intensities(&self, t: f64) -> [f64; 2] {
        let (rise, fall) = ((-self.k * t).exp(), (-self.k * (self.slab.depth - t)).exp());
        let beam = (-t / self.slab.mu0).exp();
        [0, 1].map(|i| {
            self.constant[i] + self.slope[i] * t + self.rise[i] * rise + self.fall[i] * fall - self.beam[i] * beam
        })
    }

    /// Returns the downward irradiance on a horizontal surface at depth `t`, as (direct sun, everything else). The
    /// direct part includes the light of the forward peak, which a diffuse surface cannot tell from the sun.
    pub fn irradiance_down(&self, t: f64) -> [f64; 2] {
        let [i0, i1] = self.intensities(t);
        let direct = self.slab.mu0 * self.slab.sun * (-t / self.slab.mu0).exp();
        [direct, PI * (i0 + i1 * 2.0 / 3.0)]
    }

    /// Returns the upward irradiance at depth `t`.
    pub fn irradiance_up(&self, t: f64) -> f64 {
        let [i0, i1] = self.intensities(t);
        PI * (i0 - i1 * 2.0 / 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slab(depth: f64, w: f64, mu0: f64, ground: f64) -> Solution {
        let (wf, albedo, asymmetry) = delta_scaling(w, [0.85, 0.85 * 0.85]);
        Slab { depth: depth * (1.0 - wf), albedo, asymmetry, mu0, sun: 1.0 / mu0, sky: 0.0, ground }.solve()
    }

    /// Reference: slab of Henyey-Greenstein g = 0.85 by discrete ordinates, (depth, mu0, albedo, R, T diffuse +
    /// direct). Delta-Eddington is a two-stream method, whose fluxes are known to err by a few hundredths.
    #[test]
    fn fluxes_follow_the_slab_table() {
        let table = [
            (1.0, 1.0, 1.0, 0.04232, None),
            (4.0, 1.0, 1.0, 0.19092, None),
            (16.0, 1.0, 1.0, 0.55721, None),
            (64.0, 1.0, 1.0, 0.84628, None),
            (1.0, 0.5, 1.0, 0.16488, None),
            (4.0, 0.5, 1.0, 0.41602, None),
            (16.0, 0.5, 1.0, 0.69740, None),
            (64.0, 0.5, 1.0, 0.89497, None),
            (1.0, 1.0, 0.99, 0.04079, Some(0.57960)),
            (4.0, 1.0, 0.99, 0.17284, Some(0.74785)),
            (16.0, 1.0, 0.99, 0.41773, Some(0.30610)),
            (64.0, 1.0, 0.99, 0.47197, Some(0.01134)),
        ];
        for (depth, mu0, w, r, t_diffuse) in table {
            let s = slab(depth, w, mu0, 0.0);
            let up = s.irradiance_up(0.0);
            assert!((up - r).abs() < 0.03, "depth {depth} mu0 {mu0} albedo {w}: R {up}, truth {r}");
            let [direct, diffuse] = s.irradiance_down(s.slab.depth);
            if let Some(t) = t_diffuse {
                let t = t + (-depth / mu0).exp();
                assert!((direct + diffuse - t).abs() < 0.02, "depth {depth} albedo {w}: T {} of {t}", direct + diffuse);
            }
            if w == 1.0 {
                assert!((up + direct + diffuse - 1.0).abs() < 1e-12, "R + T = {}", up + direct + diffuse);
            }
        }
    }

    #[test]
    fn light_that_enters_leaves_to_the_ground_and_to_space() {
        for ground in [0.0, 0.1, 0.6, 1.0] {
            for depth in [0.0, 1e-6, 0.3, 5.0, 80.0] {
                for mu0 in [0.01, 0.3, 1.0] {
                    let mut s = slab(depth, 1.0, mu0, ground).slab;
                    s.sky = 0.4;
                    let s = s.solve();
                    let down = s.irradiance_down(s.slab.depth).iter().sum::<f64>();
                    let kept = down * (1.0 - ground) + s.irradiance_up(0.0);
                    assert!((kept - 1.4).abs() < 1e-9, "ground {ground} depth {depth} mu0 {mu0}: {kept} of 1.4");
                }
            }
        }
    }

    #[test]
    fn a_little_absorption_is_continuous_with_none() {
        for depth in [0.1, 3.0, 50.0] {
            let none = slab(depth, 1.0, 0.6, 0.2);
            let little = slab(depth, 1.0 - 1e-7, 0.6, 0.2);
            for x in [0.0, 0.3, 1.0] {
                let t = x * none.slab.depth;
                let (a, b) = (none.intensities(t), little.intensities(t));
                assert!((a[0] - b[0]).abs() < 2e-4 * a[0].abs(), "{depth} {x}: {a:?} {b:?}");
            }
        }
        // At the pole of the beam, k mu0 = 1.
        let s =
            Slab { depth: 2.0, albedo: 0.5, asymmetry: 0.0, mu0: 1.0 / 1.5f64.sqrt(), sun: 1.0, sky: 0.0, ground: 0.0 };
        let near = Slab { mu0: s.mu0 * 0.99, ..s };
        let (a, b) = (s.solve().intensities(1.0)[0], near.solve().intensities(1.0)[0]);
        assert!(a.is_finite() && (a / b - 1.0).abs() < 0.05, "{a} {b}");
    }
}
