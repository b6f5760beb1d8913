//! Grid on which the source of multiple scattering is tabulated: altitudes, sun angles and directions.
//!
//! Altitudes are dense where the scatterers are, and sun angles are dense around the terminator. Both are uniform in a
//! coordinate that has a closed form, so that look-ups need no search.

use std::f64::consts::PI;

use super::medium::Medium;
use super::quadrature::Gauss;
use super::ray::horizon_mu;

/// Altitude nodes.
#[derive(Clone, Debug)]
pub struct Altitudes {
    top_m: f64,
    /// Height and share of each exponential term of the coordinate, share (1 - exp(-h / height)). Such a term makes the
    /// nodes dense below its height. The shares are scaled so that these terms and the linear one add up to 1 at the
    /// top.
    terms: Vec<(f64, f64)>,
    /// Share of the linear term.
    linear_share: f64,
    /// Nodes from 0 to the top, m.
    pub nodes_m: Vec<f64>,
}

impl Altitudes {
    /// Creates `n` nodes (at least 4).
    pub fn new(medium: &Medium, n: usize) -> Self {
        let present: Vec<f64> = (0..2)
            .filter(|i| medium.scattering[*i].iter().any(|b| *b > 0.0) && medium.scale_height_m[*i] > 0.0)
            .map(|i| 2.0 * medium.scale_height_m[i])
            .collect();
        let linear_share = if present.is_empty() { 1.0 } else { 0.3 };
        let terms = present
            .iter()
            .map(|h| (*h, (1.0 - linear_share) / present.len() as f64 / -(-medium.top_m / h).exp_m1()))
            .collect();
        let mut this = Self { top_m: medium.top_m, terms, linear_share, nodes_m: Vec::new() };
        this.nodes_m =
            (0..n).map(|i| invert(i as f64 / (n - 1) as f64, 0.0, medium.top_m, |h| this.share(h))).collect();
        (this.nodes_m[0], this.nodes_m[n - 1]) = (0.0, medium.top_m);
        this
    }

    fn share(&self, h: f64) -> f64 {
        self.terms.iter().map(|(height, share)| -share * (-h / height).exp_m1()).sum::<f64>()
            + self.linear_share * h / self.top_m
    }

    /// Coordinate in units of the node spacing.
    pub fn coordinate(&self, altitude_m: f64) -> f64 {
        self.share(altitude_m.clamp(0.0, self.top_m)) * (self.nodes_m.len() - 1) as f64
    }
}

/// Nodes of the sun's zenith angle.
#[derive(Clone, Debug)]
pub struct SunAngles {
    /// Sun angle at which the nodes are densest, and width of the dense part, rad.
    center: f64,
    width: f64,
    /// Share of the coordinate that follows the arc tangent of (angle - center) / width, which makes the nodes dense at
    /// the terminator. The rest is linear in the angle.
    crowd: f64,
    /// Values of the arc tangent at the angles 0 and pi.
    ends: (f64, f64),
    /// Nodes from 0 to pi, radians.
    pub nodes: Vec<f64>,
}

impl SunAngles {
    /// Creates `n` nodes (at least 4), dense around the sun angles at which the shadow's edge passes through the air.
    pub fn new(medium: &Medium, n: usize) -> Self {
        let dip = (-horizon_mu(medium, medium.top_m)).clamp(0.0, 1.0).asin();
        let (center, width) = (0.5 * PI + 0.3 * dip, (0.7 * dip).max(0.06));
        let ends = (((0.0 - center) / width).atan(), ((PI - center) / width).atan());
        let mut this = Self { center, width, crowd: 0.6, ends, nodes: Vec::new() };
        this.nodes = (0..n).map(|i| invert(i as f64 / (n - 1) as f64, 0.0, PI, |a| this.share(a))).collect();
        (this.nodes[0], this.nodes[n - 1]) = (0.0, PI);
        this
    }

    fn share(&self, angle: f64) -> f64 {
        let crowded = (((angle - self.center) / self.width).atan() - self.ends.0) / (self.ends.1 - self.ends.0);
        self.crowd * crowded + (1.0 - self.crowd) * angle / PI
    }

    /// Coordinate in units of the node spacing.
    pub fn coordinate(&self, angle: f64) -> f64 {
        self.share(angle) * (self.nodes.len() - 1) as f64
    }
}

/// Bisection for the position in [lo, hi] at which the increasing function `f` has the value `value`.
fn invert(value: f64, mut lo: f64, mut hi: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (lo + hi);
        if f(middle) < value {
            lo = middle;
        } else {
            hi = middle;
        }
    }
    0.5 * (lo + hi)
}

/// Directions over which radiance is integrated at one altitude: cosines of the zenith angle, with weights. The rule is
/// Gauss's in the square root of the difference from the horizon's cosine, on each side of the horizon. At the horizon
/// radiance has a steep gradient and a step.
pub fn zenith_rule(medium: &Medium, altitude_m: f64, rule_below: &Gauss, rule_above: &Gauss) -> Vec<(f64, f64)> {
    let horizon = horizon_mu(medium, altitude_m);
    let side = |rule: &Gauss, far: f64| -> Vec<(f64, f64)> {
        let range = far - horizon;
        let node = |(x, w): (&f64, &f64)| {
            let x = 0.5 + 0.5 * x;
            (horizon + range * x * x, range.abs() * x * w)
        };
        rule.nodes.iter().zip(&rule.weights).map(node).collect()
    };
    let mut nodes = side(rule_below, -1.0);
    nodes.extend(side(rule_above, 1.0));
    nodes
}

/// Midpoints of `n` equal intervals of [0, pi], rad. The sky is symmetric about the sun's vertical plane.
pub fn azimuths(n: usize) -> Vec<f64> {
    (0..n).map(|i| PI * (i as f64 + 0.5) / n as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;

    #[test]
    fn coordinates_and_nodes_are_inverse() {
        let mut small = Planet::earth();
        (small.bottom_radius_m, small.top_radius_m, small.mie.scale_height_m) = (1e4, 3e4, 0.0);
        for planet in [Planet::earth(), small] {
            let medium = Medium::of(&planet);
            let (altitudes, suns) = (Altitudes::new(&medium, 17), SunAngles::new(&medium, 33));
            for (i, h) in altitudes.nodes_m.iter().enumerate() {
                assert!((altitudes.coordinate(*h) - i as f64).abs() < 1e-6, "{i} {h}");
            }
            for (i, a) in suns.nodes.iter().enumerate() {
                assert!((suns.coordinate(*a) - i as f64).abs() < 1e-6, "{i} {a}");
            }
            assert!(altitudes.nodes_m.windows(2).all(|w| w[1] > w[0]) && suns.nodes.windows(2).all(|w| w[1] > w[0]));
        }
    }

    #[test]
    fn zenith_rule_integrates_each_side_of_the_horizon() {
        let medium = Medium::of(&Planet::earth());
        let (below, above) = (Gauss::new(6), Gauss::new(9));
        for h in [0.0, 10.0, 12_000.0, 100_000.0] {
            let rule = zenith_rule(&medium, h, &below, &above);
            let horizon = horizon_mu(&medium, h);
            let sum = |f: &dyn Fn(f64) -> f64| rule.iter().map(|(mu, w)| w * f(*mu)).sum::<f64>();
            assert!((sum(&|_| 1.0) - 2.0).abs() < 1e-12 && sum(&|mu| mu).abs() < 1e-12);
            let step = sum(&|mu| if mu > horizon { 1.0 } else { 0.0 });
            assert!((step - (1.0 - horizon)).abs() < 1e-12);
        }
    }
}
