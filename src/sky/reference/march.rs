//! Sample points along a span of a ray, closer together where the air is optically thick, with the transmittance from
//! each point back to the start of the span.

use super::medium::{MEDIA, Medium};
use super::quadrature::Gauss;
use super::ray::Ray;

/// Sample point of a ray, with the weights of gas and haze in every integral along the ray.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    /// Distance from the ray's origin, m.
    pub distance_m: f64,
    /// Altitude, m.
    pub altitude_m: f64,
    /// Cosine of the ray's zenith angle at the sample.
    pub mu: f64,
    /// Weight of gas per wavelength, dimensionless: path length x scattering coefficient of gas x transmittance back to
    /// the start of the span.
    pub gas: [f64; 3],
    /// Weight of haze per wavelength, dimensionless: path length x scattering coefficient of haze x transmittance back
    /// to the start of the span.
    pub haze: [f64; 3],
}

/// Settings that divide a ray into panels.
#[derive(Clone, Copy)]
pub struct Cutting<'a> {
    /// Altitudes at which panels end, ascending; the first is 0, the last the top of the air.
    pub altitudes_m: &'a [f64],
    /// Quadrature rule inside a panel, of at most 32 nodes.
    pub rule: &'a Gauss,
    /// Optical depth below which panels are not halved any more.
    pub panel_depth: f64,
}

/// Optical depth beyond which the air hides everything (e^-46 = 1e-20).
const BLACK: f64 = 46.0;
/// Largest number of halvings of a panel. Each of 2^24 pieces of the longest panel is shorter than a metre on the
/// Earth, and at most 140 m long on the largest planet that is accepted.
const MAX_HALVINGS: u32 = 24;

/// Fills `samples` (cleared first) with the samples of `ray` between the two distances of `span`, and returns each
/// medium's column over `span`: the integral of its density along the ray, m. `cuts` are further distances at which
/// panels end (the edges of the planet's shadow). Panels get no samples if the air between them and the start of `span`
/// hides everything.
pub fn march(
    ray: &Ray,
    medium: &Medium,
    cutting: &Cutting<'_>,
    span: (f64, f64),
    cuts: &[f64],
    samples: &mut Vec<Sample>,
) -> [f64; MEDIA] {
    samples.clear();
    let mut walk = RayWalk { ray, medium, cutting, columns: [0.0; MEDIA], samples };
    let mut marks = vec![span.0, span.1];
    marks.extend_from_slice(cuts);
    let to_perigee = -ray.radius_m() * ray.mu;
    marks.push(to_perigee);
    for h in cutting.altitudes_m {
        let u = ray.u_of_altitude(*h);
        if u > 0.0 {
            marks.extend([ray.distance_of(u, -1.0), ray.distance_of(u, 1.0)]);
        }
    }
    marks.retain(|s| (span.0..=span.1).contains(s));
    marks.sort_by(f64::total_cmp);
    for pair in marks.windows(2) {
        // Where two ends of panels coincide, rounding leaves a tiny interval, which is skipped.
        if pair[1] - pair[0] > 1e-12 * (pair[1].abs() + 1.0) {
            let side = if 0.5 * (pair[0] + pair[1]) < to_perigee { -1.0 } else { 1.0 };
            walk.panel(side, ray.u_at(pair[0]).0, ray.u_at(pair[1]).0, 0);
        }
    }
    walk.columns
}

struct RayWalk<'a> {
    ray: &'a Ray,
    medium: &'a Medium,
    cutting: &'a Cutting<'a>,
    columns: [f64; MEDIA],
    samples: &'a mut Vec<Sample>,
}

impl RayWalk<'_> {
    /// Integrates one panel from `a` to `b`, two values of u = sqrt(altitude above the perigee) ([`Ray::u_at`]), and
    /// halves the panel while it is optically thick. `side` is -1 before the perigee, where u falls along the ray, and
    /// 1 after the perigee.
    fn panel(&mut self, side: f64, a: f64, b: f64, halvings: u32) {
        let rule = self.cutting.rule;
        let n = rule.len();
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let mut points = [[0.0; MEDIA + 2]; 32];
        let points = &mut points[..n.min(32)];
        let mut total = [0.0; MEDIA];
        for (i, point) in points.iter_mut().enumerate() {
            let u = middle + half * rule.nodes[i];
            // Rounding must not put the point above the top, where the density drops to 0.
            let altitude = (self.ray.perigee_altitude_m() + u * u).min(self.medium.top_m);
            let density = self.medium.density(altitude);
            // Before the perigee du is negative, because u falls as the distance grows.
            let ds = half * side * self.ray.stretch(u);
            *point = [density[0] * ds, density[1] * ds, density[2] * ds, ds, u];
            (0..MEDIA).for_each(|k| total[k] += rule.weights[i] * point[k]);
        }
        let (depths, before) = (self.medium.optical_depth(&total), self.medium.optical_depth(&self.columns));
        // Where the air before the panel hides everything at a wavelength, that wavelength needs no finer panels.
        let seen = || depths.iter().zip(&before).filter(|(_, before)| **before < BLACK).map(|(depth, _)| *depth);
        let thickest = seen().fold(0.0, f64::max);
        if thickest > self.cutting.panel_depth && halvings < MAX_HALVINGS {
            self.panel(side, a, middle, halvings + 1);
            self.panel(side, middle, b, halvings + 1);
            return;
        }
        if seen().next().is_some() {
            self.emit(side, points);
        }
        (0..MEDIA).for_each(|k| self.columns[k] += total[k]);
    }

    /// Appends the samples of one panel.
    fn emit(&mut self, side: f64, points: &[[f64; MEDIA + 2]]) {
        let rule = self.cutting.rule;
        let n = points.len();
        for (i, point) in points.iter().enumerate() {
            let mut columns = self.columns;
            for (j, other) in points.iter().enumerate() {
                let w = rule.running[i * n + j];
                (0..MEDIA).for_each(|k| columns[k] += w * other[k]);
            }
            let t = self.medium.transmittance(&columns.map(|c| c.max(0.0)));
            let [gas, haze, _, ds, u] = *point;
            let w = rule.weights[i];
            let altitude_m = self.ray.perigee_altitude_m() + u * u;
            let distance_m = self.ray.distance_of(u, side);
            let mu = (self.ray.radius_m() * self.ray.mu + distance_m) / (self.ray.bottom_m + altitude_m);
            debug_assert!(ds >= 0.0);
            let [beta_gas, beta_haze] = &self.medium.scattering;
            self.samples.push(Sample {
                distance_m,
                altitude_m,
                mu: mu.clamp(-1.0, 1.0),
                gas: std::array::from_fn(|c| w * gas * beta_gas[c] * t[c]),
                haze: std::array::from_fn(|c| w * haze * beta_haze[c] * t[c]),
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;

    /// The air is black in one colour and clear in the others. The black colour needs panels only down to a depth of
    /// [`BLACK`], so a ray has few panels.
    #[test]
    fn air_that_is_black_in_one_colour_needs_few_panels() {
        let mut planet = Planet::earth();
        planet.mie.extinction_per_m = [0.0, 0.0, 1e3];
        planet.mie.scattering_per_m = [0.0, 0.0, 1e2];
        planet.absorption.extinction_per_m = [0.0; 3];
        let medium = Medium::of(&planet);
        let (marks, rule) = (medium.panel_altitudes(), Gauss::new(8));
        let cutting = Cutting { altitudes_m: &marks, rule: &rule, panel_depth: 1.0 };
        let mut samples = Vec::new();
        for mu in [1.0, 0.0] {
            let ray = Ray::new(&medium, 1.0, mu);
            let (start, end, _) = ray.in_air(&medium).unwrap();
            let columns = march(&ray, &medium, &cutting, (start, end), &[], &mut samples);
            assert!(samples.len() < 8 * 250, "{mu}: {} samples", samples.len());
            let exact = ray.columns(&medium, start, end);
            assert!((columns[0] / exact[0] - 1.0).abs() < 1e-7);
            let sum: f64 = samples.iter().map(|s| s.gas[0]).sum();
            assert!((sum + medium.transmittance(&columns)[0] - 1.0).abs() < 1e-7);
        }
    }

    /// Gas absorbs nothing, so the gas weights of all samples sum to 1 - transmittance.
    #[test]
    fn weights_of_a_gas_sum_to_what_is_not_transmitted() {
        for thickness in [1e-3, 1.0, 30.0, 1e4] {
            let mut planet = Planet::earth().with_air_scaled(thickness);
            planet.mie.scattering_per_m = [0.0; 3];
            planet.mie.extinction_per_m = [0.0; 3];
            planet.absorption.extinction_per_m = [0.0; 3];
            let medium = Medium::of(&planet);
            let marks = medium.panel_altitudes();
            let rule = Gauss::new(8);
            let cutting = Cutting { altitudes_m: &marks, rule: &rule, panel_depth: 1.0 };
            let mut samples = Vec::new();
            for (altitude, mu) in [(1.0, 1.0), (1.0, 0.0), (3000.0, -0.01), (90_000.0, -0.16), (2e4, -1.0)] {
                let ray = Ray::new(&medium, altitude, mu);
                let (start, end, _) = ray.in_air(&medium).unwrap();
                let columns = march(&ray, &medium, &cutting, (start, end), &[0.3 * end], &mut samples);
                let t = medium.transmittance(&columns);
                let exact = ray.columns(&medium, start, end);
                for (c, t) in t.iter().enumerate() {
                    let sum: f64 = samples.iter().map(|s| s.gas[c]).sum();
                    assert!((sum + t - 1.0).abs() < 1e-7, "x{thickness} {altitude} {mu}: {sum} + {t}");
                }
                assert!((columns[0] / exact[0] - 1.0).abs() < 1e-7, "{altitude} {mu}");
            }
        }
    }
}
