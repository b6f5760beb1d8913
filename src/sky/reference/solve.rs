//! Multiple scattering by orders. The radiance of one order, integrated over all directions at the nodes of a grid, is
//! the source of the next order.
//!
//! Order 1 is light scattered once in the air. The ground counts as a scatterer like the air: light belongs to order n
//! if it was scattered n - 1 times by air and ground together before its last scattering in the air.

use std::f64::consts::PI;

use super::grid::{Altitudes, SunAngles, azimuths, zenith_rule};
use super::march::{Cutting, Sample, march};
use super::medium::{Medium, mie_phase};
use super::quadrature::{Gauss, cubic};
use super::ray::{End, Ray, shadow};
use super::resolution::Resolution;
use super::source::{Moments, Nodes, Place, Source};
use super::sun::{SunTable, scattered_once, with_phase};

/// Grids and rules of one solution.
pub struct Solver<'a> {
    pub medium: &'a Medium,
    pub altitudes: Altitudes,
    pub suns: SunAngles,
    pub sun_table: &'a SunTable,
    pub albedo: [f64; 3],
    pub resolution: Resolution,
    azimuths: Vec<f64>,
    below: Gauss,
    above: Gauss,
    panel_rule: Gauss,
    panel_altitudes: Vec<f64>,
    has_haze: bool,
    /// Whether the light is ignored, for each sun angle. It is ignored where the sun is so low that order 1 is below
    /// [`DARK`] of its brightest value at every altitude.
    dark: Vec<bool>,
}

/// Share of the brightest light below which light is ignored. Light of this strength is a millionth of the stars'
/// light.
const DARK: f64 = 1e-12;

/// Result of a sweep, the integration over all directions and sun angles, at one altitude.
struct Row {
    /// Source of gas, for each sun angle.
    gas: Vec<Moments>,
    /// Source of haze, ordered by sun angle, zenith angle and azimuth.
    haze: Vec<[f64; 3]>,
    /// Irradiance of a level surface facing up, for each sun angle.
    irradiance: Vec<[f64; 3]>,
}

/// A ray of the sweep with the values that do not depend on the sun.
struct Prepared {
    ray: Ray,
    /// Weight of the ray in the rule over zenith angles.
    weight: f64,
    samples: Vec<(Sample, Place)>,
    /// Interval of the ray inside the air, m from its start.
    span: (f64, f64),
    /// Distance to the ground, and transmittance over it, if the ray ends there.
    ground: Option<(f64, [f64; 3])>,
}

/// Light that falls on the air and the ground in a sweep.
enum SweepLight<'a> {
    /// Direct sunlight.
    Sun,
    /// Light that has been scattered before: its source in the air, and the radiance that the ground reflects for each
    /// sun angle.
    Scattered(&'a Source, &'a [[f64; 3]]),
}

impl<'a> Solver<'a> {
    pub fn new(medium: &'a Medium, albedo: [f64; 3], sun_table: &'a SunTable, resolution: &Resolution) -> Self {
        Self {
            medium,
            altitudes: Altitudes::new(medium, resolution.altitudes),
            suns: SunAngles::new(medium, resolution.sun_angles),
            sun_table,
            albedo,
            resolution: *resolution,
            azimuths: azimuths(resolution.azimuths),
            below: Gauss::new(resolution.zeniths / 2),
            above: Gauss::new(resolution.zeniths),
            panel_rule: Gauss::new(resolution.panel_points),
            panel_altitudes: medium.panel_altitudes(),
            has_haze: medium.scattering[1].iter().any(|b| *b > 0.0),
            dark: vec![false; resolution.sun_angles],
        }
    }

    /// Source of order 2: light scattered once, and the sunlit ground.
    pub fn first(&mut self, threads: usize) -> Nodes {
        let nodes = self.sweep(&SweepLight::Sun, threads);
        let suns = self.dark.len();
        let total = |node: usize| nodes.total(node).into_iter().fold(0.0, f64::max);
        let brightest = (0..nodes.gas.len()).map(total).fold(0.0, f64::max);
        for (sun, dark) in self.dark.iter_mut().enumerate() {
            *dark = (sun..nodes.gas.len()).step_by(suns).all(|node| total(node) <= DARK * brightest);
        }
        nodes
    }

    /// Source of the order that follows the order of `nodes`.
    pub fn next(&self, nodes: &Nodes, threads: usize) -> Nodes {
        let source = self.source(nodes);
        self.sweep(&SweepLight::Scattered(&source, &nodes.ground), threads)
    }

    /// Look-up tables of `nodes`.
    pub fn source(&self, nodes: &Nodes) -> Source {
        Source::new(&self.altitudes, &self.suns, nodes, self.resolution.haze_directions)
    }

    fn sweep(&self, light: &SweepLight<'_>, threads: usize) -> Nodes {
        let count = self.altitudes.nodes_m.len();
        let threads = threads.clamp(1, count);
        let mut rows: Vec<Option<Row>> = (0..count).map(|_| None).collect();
        if threads == 1 {
            rows.iter_mut().enumerate().for_each(|(i, row)| *row = Some(self.row(i, light)));
        } else {
            // Each thread takes every `threads`-th altitude, so that the low altitudes, which take longest, are shared
            // out.
            let mut shares: Vec<Vec<(usize, &mut Option<Row>)>> = (0..threads).map(|_| Vec::new()).collect();
            rows.iter_mut().enumerate().for_each(|(i, row)| shares[i % threads].push((i, row)));
            std::thread::scope(|scope| {
                for share in shares {
                    scope.spawn(move || share.into_iter().for_each(|(i, row)| *row = Some(self.row(i, light))));
                }
            });
        }
        self.collect(rows)
    }

    fn collect(&self, rows: Vec<Option<Row>>) -> Nodes {
        let mut nodes = Nodes { gas: Vec::new(), haze: Vec::new(), ground: Vec::new() };
        for (i, row) in rows.into_iter().flatten().enumerate() {
            if i == 0 {
                let reflect = |e: &[f64; 3]| std::array::from_fn(|c| self.albedo[c] / PI * e[c]);
                nodes.ground = row.irradiance.iter().map(reflect).collect();
            }
            nodes.gas.extend(row.gas);
            nodes.haze.extend(row.haze);
        }
        nodes
    }

    /// Sweep at one altitude, over all directions and sun angles.
    fn row(&self, index: usize, light: &SweepLight<'_>) -> Row {
        let altitude = self.altitudes.nodes_m[index];
        let rule = zenith_rule(self.medium, altitude, &self.below, &self.above);
        let rays: Vec<Prepared> = rule.iter().map(|(mu, w)| self.prepare(altitude, *mu, *w, light)).collect();
        let kernel = if self.has_haze { self.kernel(&rays) } else { Vec::new() };
        let mut row = Row { gas: Vec::new(), haze: Vec::new(), irradiance: Vec::new() };
        let mut radiance = vec![[0.0; 3]; rays.len() * self.azimuths.len()];
        let mut scratch = Vec::new();
        for (sun, dark) in self.suns.nodes.iter().zip(&self.dark) {
            let mu_s = sun.cos();
            if *dark {
                let (zeniths, count) = self.resolution.haze_directions;
                row.gas.push([0.0; 12]);
                row.irradiance.push([0.0; 3]);
                row.haze.resize(row.haze.len() + if self.has_haze { zeniths * count } else { 0 }, [0.0; 3]);
                continue;
            }
            for (j, ray) in rays.iter().enumerate() {
                for (l, azimuth) in self.azimuths.iter().enumerate() {
                    let sines = ((1.0 - ray.ray.mu * ray.ray.mu) * (1.0 - mu_s * mu_s)).max(0.0).sqrt();
                    let nu = (ray.ray.mu * mu_s + sines * azimuth.cos()).clamp(-1.0, 1.0);
                    radiance[j * self.azimuths.len() + l] = self.radiance(ray, mu_s, nu, light, &mut scratch);
                }
            }
            row.gas.push(self.moments(&rays, &radiance));
            row.irradiance.push(self.irradiance(&rays, &radiance));
            if self.has_haze {
                self.haze_source(&rays, &radiance, &kernel, &mut row.haze);
            }
        }
        row
    }

    fn cutting(&self) -> Cutting<'_> {
        Cutting { altitudes_m: &self.panel_altitudes, rule: &self.panel_rule, panel_depth: 1.5 }
    }

    fn prepare(&self, altitude: f64, mu: f64, weight: f64, light: &SweepLight<'_>) -> Prepared {
        let ray = Ray::new(self.medium, altitude, mu);
        let mut samples = Vec::new();
        let mut prepared = Prepared { ray, weight, samples: Vec::new(), span: (0.0, 0.0), ground: None };
        let Some((start, end, how)) = ray.in_air(self.medium) else { return prepared };
        prepared.span = (start, end);
        let columns = march(&ray, self.medium, &self.cutting(), (start, end), &[], &mut samples);
        if how == End::Ground {
            prepared.ground = Some((end, self.medium.transmittance(&columns)));
        }
        let place = |s: &Sample| match light {
            SweepLight::Sun => Place { altitude: 0.0, mu: s.mu, sine: 0.0, zenith: 0.0 },
            SweepLight::Scattered(source, _) => source.place(s.altitude_m, s.mu),
        };
        prepared.samples = samples.into_iter().map(|s| (s, place(&s))).collect();
        prepared
    }

    /// Radiance of the present order along one ray.
    fn radiance(
        &self,
        p: &Prepared,
        mu_s: f64,
        nu: f64,
        light: &SweepLight<'_>,
        scratch: &mut Vec<Sample>,
    ) -> [f64; 3] {
        let r = p.ray.radius_m();
        let mut out = match light {
            SweepLight::Sun => self.sunlit(p, mu_s, nu, scratch),
            SweepLight::Scattered(source, _) => {
                let mut sum = [0.0; 3];
                for (s, place) in &p.samples {
                    let mu_s_there = (r * mu_s + s.distance_m * nu) / (p.ray.bottom_m + s.altitude_m);
                    let (gas, haze) = source.at(place, mu_s_there, nu, haze_matters(s));
                    (0..3).for_each(|c| sum[c] += s.gas[c] * gas[c] + s.haze[c] * haze[c]);
                }
                sum
            }
        };
        if let Some((distance, t)) = &p.ground {
            let mu_s_there = ((r * mu_s + distance * nu) / self.medium.bottom_m).clamp(-1.0, 1.0);
            let ground = self.ground(mu_s_there, light);
            (0..3).for_each(|c| out[c] += t[c] * ground[c]);
        }
        out
    }

    /// Radiance of light scattered once. If the shadow's edge crosses the ray, the ray's panels are cut there.
    fn sunlit(&self, p: &Prepared, mu_s: f64, nu: f64, scratch: &mut Vec<Sample>) -> [f64; 3] {
        let dark = shadow(&p.ray, mu_s, nu).filter(|(from, to)| *from < p.span.1 && *to > p.span.0);
        scratch.clear();
        match dark {
            Some((from, to)) if from <= p.span.0 && to >= p.span.1 => return [0.0; 3],
            Some((from, to)) => {
                march(&p.ray, self.medium, &self.cutting(), p.span, &[from, to], scratch);
            }
            None => scratch.extend(p.samples.iter().map(|(s, _)| *s)),
        }
        let sun = |h: f64, mu_s: f64| self.sun_table.transmittance(h, mu_s);
        let (gas, haze) = scattered_once(&p.ray, scratch, dark, mu_s, nu, sun);
        with_phase(self.medium, nu, &gas, &haze)
    }

    /// Radiance that the ground reflects under a sun at `mu_s`.
    fn ground(&self, mu_s: f64, light: &SweepLight<'_>) -> [f64; 3] {
        match light {
            SweepLight::Sun => {
                let t = self.sun_table.transmittance(0.0, mu_s);
                std::array::from_fn(|c| self.albedo[c] / PI * mu_s.max(0.0) * t[c])
            }
            SweepLight::Scattered(_, ground) => {
                let (first, w) = cubic(self.suns.coordinate(mu_s.acos()), ground.len());
                std::array::from_fn(|c| (0..4).map(|k| w[k] * ground[first + k][c]).sum::<f64>().max(0.0))
            }
        }
    }

    /// Second moments of the radiance at a node.
    fn moments(&self, rays: &[Prepared], radiance: &[[f64; 3]]) -> Moments {
        let n = self.azimuths.len();
        let mut out = [0.0; 12];
        for (j, ray) in rays.iter().enumerate() {
            let mu = ray.ray.mu;
            let sine2 = (1.0 - mu) * (1.0 + mu);
            for (l, azimuth) in self.azimuths.iter().enumerate() {
                let x2 = sine2 * azimuth.cos() * azimuth.cos();
                let w = 2.0 * PI / n as f64 * ray.weight;
                let parts = [x2, sine2 - x2, mu * mu, mu * sine2.sqrt() * azimuth.cos()];
                let value = &radiance[j * n + l];
                for (p, part) in parts.iter().enumerate() {
                    (0..3).for_each(|c| out[3 * p + c] += w * part * value[c]);
                }
            }
        }
        out
    }

    /// Irradiance of a horizontal surface from above.
    fn irradiance(&self, rays: &[Prepared], radiance: &[[f64; 3]]) -> [f64; 3] {
        let n = self.azimuths.len();
        let mut out = [0.0; 3];
        for (j, ray) in rays.iter().enumerate().filter(|(_, ray)| ray.ray.mu > 0.0) {
            let w = 2.0 * PI / n as f64 * ray.weight * ray.ray.mu;
            radiance[j * n..(j + 1) * n].iter().for_each(|v| (0..3).for_each(|c| out[c] += w * v[c]));
        }
        out
    }

    /// Phase function of the haze between the directions of the haze table and those of the quadrature, times the
    /// quadrature's weight and 2 pi, as cosine series in azimuth. The order is [zenith of the table][ray][mode]. Rows
    /// are normalised so that equal light from all sides is scattered equally into all directions. For sharp peaks the
    /// quadrature alone does not achieve that.
    fn kernel(&self, rays: &[Prepared]) -> Vec<f64> {
        let (zeniths, modes) = (self.resolution.haze_directions.0, self.azimuths.len());
        // Enough azimuths for the sharpest peak that the modes can represent.
        let fine = azimuths(8 * modes);
        let cosines: Vec<f64> = fine.iter().flat_map(|a| (0..modes).map(move |m| (m as f64 * a).cos())).collect();
        let mut kernel = vec![0.0; zeniths * rays.len() * modes];
        for z in 0..zeniths {
            let (sin_z, cos_z) = (PI * z as f64 / (zeniths - 1) as f64).sin_cos();
            let row = &mut kernel[z * rays.len() * modes..(z + 1) * rays.len() * modes];
            for (ray, out) in rays.iter().zip(row.chunks_exact_mut(modes)) {
                let mu = ray.ray.mu;
                let sines = sin_z * ((1.0 - mu) * (1.0 + mu)).sqrt();
                for (a, cosines) in fine.iter().zip(cosines.chunks_exact(modes)) {
                    let nu = (cos_z * mu + sines * a.cos()).clamp(-1.0, 1.0);
                    let p = mie_phase(nu, self.medium.asymmetry_g) * ray.weight * 2.0 * PI / fine.len() as f64;
                    out.iter_mut().zip(cosines).for_each(|(o, c)| *o += p * c);
                }
            }
            let sum: f64 = row.iter().step_by(modes).sum();
            if sum > 0.0 {
                row.iter_mut().for_each(|v| *v /= sum);
            }
        }
        kernel
    }

    /// Haze source at one node. The radiance is expanded in cosine series, scattered mode by mode, and summed at the
    /// azimuths of the table.
    fn haze_source(&self, rays: &[Prepared], radiance: &[[f64; 3]], kernel: &[f64], source: &mut Vec<[f64; 3]>) {
        let modes = self.azimuths.len();
        let mut series = vec![[0.0; 3]; rays.len() * modes];
        for (j, line) in radiance.chunks_exact(modes).enumerate() {
            for (m, coefficient) in series[j * modes..(j + 1) * modes].iter_mut().enumerate() {
                let norm = if m == 0 { 1.0 } else { 2.0 } / modes as f64;
                for (a, v) in self.azimuths.iter().zip(line) {
                    let w = norm * (m as f64 * a).cos();
                    (0..3).for_each(|c| coefficient[c] += w * v[c]);
                }
            }
        }
        let (zeniths, count) = self.resolution.haze_directions;
        for z in 0..zeniths {
            let row = &kernel[z * series.len()..(z + 1) * series.len()];
            let mut scattered = vec![[0.0; 3]; modes];
            for (k, (w, v)) in row.iter().zip(&series).enumerate() {
                (0..3).for_each(|c| scattered[k % modes][c] += w * v[c]);
            }
            for p in 0..count {
                let a = PI * p as f64 / (count - 1) as f64;
                let mut sum = [0.0; 3];
                for (m, v) in scattered.iter().enumerate() {
                    let cosine = (m as f64 * a).cos();
                    (0..3).for_each(|c| sum[c] += cosine * v[c]);
                }
                // A truncated series of a sharp peak falls below 0 beside the peak.
                source.push(sum.map(|v| v.max(0.0)));
            }
        }
    }
}

/// Whether haze contributes noticeably to a sample's light. The look-up of the haze's source is the expensive part.
pub fn haze_matters(s: &Sample) -> bool {
    (0..3).any(|c| s.haze[c] > 1e-7 * s.gas[c] && s.haze[c] > 1e-14)
}
