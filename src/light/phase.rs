//! Phase functions of droplets and other particles, and their moments, in f64: the reference of `fog_phase_after` in
//! `shaders/fog/lookup.wgsl` and of `shaders/common/phase.wgsl`.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

/// Phase function of particles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Phase {
    /// Water droplets of this mean diameter, micrometres, \[5, 50\] (Jendersie and d'Eon 2023); fog has 10 to 25.
    Droplets {
        /// Mean diameter, micrometres.
        diameter_um: f64,
    },
    /// Henyey and Greenstein (1941) with asymmetry g, \[-0.95, 0.95\]; haze and dust have 0.6 to 0.75.
    HenyeyGreenstein {
        /// Mean cosine of the scattering angle.
        g: f64,
    },
    /// Blend between droplets and Henyey and Greenstein's function, for changes of weather from one to the other.
    Between {
        /// Mean diameter of the droplets, micrometres, \[5, 50\].
        diameter_um: f64,
        /// Asymmetry of the Henyey-Greenstein function, \[-0.95, 0.95\].
        g: f64,
        /// Share of the Henyey-Greenstein function, \[0, 1\]: 0 is droplets alone.
        share: f64,
    },
}

/// A blend of a Henyey-Greenstein and a Draine (2003) lobe: the form of all phase functions here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseLobes {
    /// Asymmetry of the Henyey-Greenstein lobe.
    pub g_hg: f64,
    /// Asymmetry parameter of the Draine lobe.
    pub g_draine: f64,
    /// Draine's alpha.
    pub alpha: f64,
    /// Weight of the Draine lobe; the Henyey-Greenstein lobe has the rest.
    pub w_draine: f64,
}

impl PhaseLobes {
    /// Returns the lobes of a phase function. Droplets: Jendersie and d'Eon, "An Approximate Mie Scattering Function
    /// for Fog and Cloud Rendering", 2023, equations 4 to 7.
    pub fn new(phase: &Phase) -> Self {
        match *phase {
            Phase::Droplets { diameter_um: d } => Self {
                g_hg: (-0.099_056_7 / (d - 1.671_54)).exp(),
                g_draine: (-2.206_79 / (d + 3.910_29) - 0.428_934).exp(),
                alpha: (3.624_89 - 8.292_88 / (d + 5.528_25)).exp(),
                w_draine: (-0.599_085 / (d - 0.641_583) - 0.665_888).exp(),
            },
            Phase::HenyeyGreenstein { g } => Self { g_hg: g, g_draine: 0.0, alpha: 0.0, w_draine: 0.0 },
            Phase::Between { diameter_um, g, share } => {
                let droplets = Self::new(&Phase::Droplets { diameter_um });
                Self {
                    g_hg: droplets.g_hg + (g - droplets.g_hg) * share,
                    w_draine: droplets.w_draine * (1.0 - share),
                    ..droplets
                }
            }
        }
    }

    /// Returns the first two Legendre moments of the blend (mean cosine, and mean of P2) in closed form. Moment l of
    /// the Henyey-Greenstein lobe is g^l. For Draine's lobe, cos^2 P_l is a sum of neighbouring Legendre polynomials.
    pub fn moments(&self) -> [f64; 2] {
        let (g, a) = (self.g_draine, self.alpha);
        let norm = 1.0 + a * (1.0 + 2.0 * g * g) / 3.0;
        let d1 = (g + a * (0.6 * g + 0.4 * g.powi(3))) / norm;
        let d2 = (g * g + a * (12.0 / 35.0 * g.powi(4) + 11.0 / 21.0 * g * g + 2.0 / 15.0)) / norm;
        let mix = |hg: f64, draine: f64| hg + (draine - hg) * self.w_draine;
        [mix(self.g_hg, d1), mix(self.g_hg.powi(2), d2)]
    }
}

/// Returns the phase function, 1/sr, of light that was scattered `order` >= 1 times in a row (1: the phase function
/// itself), at the angle with 1 - cos equal to `versine`. The function takes `versine` rather than the cosine because
/// near the forward peak of droplets (1 - g = 0.007) the cosine has too few digits in f32.
///
/// Light that is scattered n = `order` times by a Henyey-Greenstein lobe is spread by a lobe of g^n. In a blend whose
/// Draine lobe has the weight w, the share (1 - w)^n of the light was scattered by the Henyey-Greenstein lobe only. The
/// rest was scattered by Draine's lobe about n w times, at least once. This number is the exponent of Draine's g, and
/// alpha is divided by its square, so the lobe becomes more isotropic.
pub fn lobes_phase(lobes: &PhaseLobes, order: f64, versine: f64) -> f64 {
    let lobe = |g: f64| {
        let d = (1.0 - g) * (1.0 - g) + 2.0 * g * versine;
        (1.0 - g * g) / (d * d.sqrt())
    };
    let met = (order * lobes.w_draine).max(1.0);
    let weight = 1.0 - (1.0 - lobes.w_draine).powf(order);
    let g = lobes.g_draine.powf(met);
    let alpha = lobes.alpha / (met * met);
    let cos = 1.0 - versine;
    let draine = lobe(g) * (1.0 + alpha * cos * cos) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
    let hg = lobe(lobes.g_hg.signum() * lobes.g_hg.abs().powf(order));
    (hg + (draine - hg) * weight) / (4.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the integrals over the sphere of p, p cos and p P2, with a substitution that resolves the forward peak.
    fn integrals(lobes: &PhaseLobes) -> [f64; 3] {
        let n = 20_000;
        let (lo, hi) = ((1e-9f64).ln(), 2f64.ln());
        let mut out = [0.0; 3];
        for i in 0..n {
            let v = (lo + (hi - lo) * (i as f64 + 0.5) / n as f64).exp();
            let c = 1.0 - v;
            let w = lobes_phase(lobes, 1.0, v) * 2.0 * PI * v * (hi - lo) / n as f64;
            out[0] += w;
            out[1] += w * c;
            out[2] += w * 0.5 * (3.0 * c * c - 1.0);
        }
        out
    }

    #[test]
    fn phase_functions_integrate_to_one_and_to_their_moments() {
        let mut all: Vec<Phase> = [5.0, 10.0, 15.0, 30.0, 50.0].map(|d| Phase::Droplets { diameter_um: d }).to_vec();
        all.extend([-0.5, 0.0, 0.7, 0.85, 0.95].map(|g| Phase::HenyeyGreenstein { g }));
        all.extend([0.0, 0.3, 0.9, 1.0].map(|share| Phase::Between { diameter_um: 15.0, g: 0.6, share }));
        for phase in all {
            let lobes = PhaseLobes::new(&phase);
            let [one, c1, c2] = integrals(&lobes);
            let [m1, m2] = lobes.moments();
            assert!((one - 1.0).abs() < 2e-4, "{phase:?}: {one}");
            assert!((c1 - m1).abs() < 3e-4 && (c2 - m2).abs() < 3e-4, "{phase:?}: {c1} {m1}, {c2} {m2}");
        }
    }
}
