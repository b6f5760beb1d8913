//! Source of multiple scattering: light that air or ground has scattered before, and that the air at a point scatters
//! into a direction. This file has the tables of the source, and their look-ups.
//!
//! Gas: the Rayleigh phase function is a polynomial of degree 2, so the light that gas scatters into any direction
//! follows exactly from the second moments of the radiance, four numbers per wavelength (with the sun in the xz plane).
//!
//! Haze: a table over directions in the local frame (zenith angle, azimuth from the sun), with cubic interpolation
//! between its nodes.
//!
//! Both are per unit of scattering coefficient, so that they vary slowly with altitude.

use std::f64::consts::PI;

use super::grid::{Altitudes, SunAngles};
use super::quadrature::{cubic_weights, linear};

/// Second moments xx, yy, zz and xz of radiance, each at three wavelengths.
pub type Moments = [f64; 12];

/// Source of one order, or of a sum of orders, at the nodes.
#[derive(Clone, Debug)]
pub struct Nodes {
    /// Moments, ordered by altitude, then sun angle.
    pub gas: Vec<Moments>,
    /// Haze source, ordered by altitude, sun angle, zenith and azimuth; empty if haze does not scatter.
    pub haze: Vec<[f64; 3]>,
    /// Radiance that the ground reflects, for each sun angle of the grid.
    pub ground: Vec<[f64; 3]>,
}

impl Nodes {
    /// Adds the sources of gas and haze of `other`, times a factor for each node (altitude and sun angle) and
    /// wavelength. `ground` stays as it is.
    pub fn add(&mut self, other: &Self, factor: impl Fn(usize) -> [f64; 3]) {
        let directions = if self.gas.is_empty() { 0 } else { self.haze.len() / self.gas.len() };
        for (node, (a, b)) in self.gas.iter_mut().zip(&other.gas).enumerate() {
            let f = factor(node);
            (0..12).for_each(|k| a[k] += f[k % 3] * b[k]);
            let range = node * directions..(node + 1) * directions;
            for (a, b) in self.haze[range.clone()].iter_mut().zip(&other.haze[range]) {
                (0..3).for_each(|c| a[c] += f[c] * b[c]);
            }
        }
    }

    /// Radiance integrated over all directions at a node, per wavelength.
    pub fn total(&self, node: usize) -> [f64; 3] {
        let m = &self.gas[node];
        std::array::from_fn(|c| m[c] + m[3 + c] + m[6 + c])
    }
}

/// Position along a ray for a look-up of the source: the coordinates that do not depend on the sun.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Coordinate in altitude, in node units.
    pub altitude: f64,
    /// Cosine of the ray's zenith angle.
    pub mu: f64,
    /// Sine of the ray's zenith angle.
    pub sine: f64,
    /// Zenith angle of the ray, radians.
    pub zenith: f64,
}

/// Tables in the form that look-ups read.
pub struct Source {
    altitudes: Altitudes,
    suns: SunAngles,
    /// Moments on a grid finer than that of [`Nodes`] by the factors [`REFINE`], for linear interpolation.
    gas: Vec<Moments>,
    gas_size: (usize, usize),
    /// Haze source in the order of [`Nodes::haze`], on a grid finer by the factors [`REFINE_HAZE`] in altitude and sun
    /// angle. It is in single precision, because it is large.
    haze: Vec<[f32; 3]>,
    haze_size: (usize, usize),
    haze_directions: (usize, usize),
}

/// Factors by which cubic interpolation refines the tables in altitude and sun angle, so that look-ups can be linear.
const REFINE: (usize, usize) = (4, 8);
/// As [`REFINE`], for the table of haze.
const REFINE_HAZE: (usize, usize) = (2, 3);

impl Source {
    /// Creates the look-up tables of the nodes' values; `directions` is the size of the haze's grid (zenith, azimuth).
    pub fn new(altitudes: &Altitudes, suns: &SunAngles, nodes: &Nodes, directions: (usize, usize)) -> Self {
        let (na, ns) = (altitudes.nodes_m.len(), suns.nodes.len());
        let (fine_a, fine_s) = ((na - 1) * REFINE.0 + 1, (ns - 1) * REFINE.1 + 1);
        let floor = 1e-13 * nodes.gas.iter().flat_map(|m| m[..9].iter()).fold(0.0, |a: f64, b| a.max(*b));
        let logs: Vec<Moments> = nodes.gas.iter().map(|m| moments_to_logs(m, floor)).collect();
        let along_suns = refine(&logs, na, ns, 1, REFINE.1);
        let mut gas = refine(&along_suns, 1, na, fine_s, REFINE.0);
        gas.iter_mut().for_each(|m| *m = logs_to_moments(m, floor));
        let count = directions.0 * directions.1;
        let haze_size = ((na - 1) * REFINE_HAZE.0 + 1, (ns - 1) * REFINE_HAZE.1 + 1);
        let mut haze = Vec::new();
        if !nodes.haze.is_empty() {
            let logs: Vec<[f32; 3]> = nodes.haze.iter().map(|v| v.map(|v| to_log(v, floor) as f32)).collect();
            let along_suns = refine(&logs, na, ns, count, REFINE_HAZE.1);
            haze = refine(&along_suns, 1, na, haze_size.1 * count, REFINE_HAZE.0);
            haze.iter_mut().for_each(|v| *v = v.map(|v| from_log(f64::from(v), floor) as f32));
        }
        Self {
            altitudes: altitudes.clone(),
            suns: suns.clone(),
            gas,
            gas_size: (fine_a, fine_s),
            haze,
            haze_size,
            haze_directions: directions,
        }
    }

    /// Position of a ray's sample.
    pub fn place(&self, altitude_m: f64, mu: f64) -> Place {
        let sine = ((1.0 - mu) * (1.0 + mu)).sqrt();
        Place { altitude: self.altitudes.coordinate(altitude_m), mu, sine, zenith: mu.clamp(-1.0, 1.0).acos() }
    }

    /// Light scattered into the ray by gas and by haze, per unit of their scattering coefficients. `mu_s` is the cosine
    /// of the sun's zenith angle at the position, and `nu` that of the angle between ray and sun. Haze is computed only
    /// if `with_haze` is set.
    pub fn at(&self, place: &Place, mu_s: f64, nu: f64, with_haze: bool) -> ([f64; 3], [f64; 3]) {
        let mu_s = mu_s.clamp(-1.0, 1.0);
        let sun_sine = ((1.0 - mu_s) * (1.0 + mu_s)).sqrt();
        let sun = self.suns.coordinate(mu_s.acos());
        let x = if sun_sine > 1e-9 { (nu - place.mu * mu_s) / sun_sine } else { place.sine };
        let x = x.clamp(-place.sine, place.sine);
        let gas = self.gas(place, sun, x);
        if !with_haze || self.haze.is_empty() {
            return (gas, [0.0; 3]);
        }
        let azimuth = if place.sine > 1e-9 { (x / place.sine).clamp(-1.0, 1.0).acos() } else { 0.0 };
        (gas, self.haze(place, sun, azimuth))
    }

    fn gas(&self, place: &Place, sun: f64, x: f64) -> [f64; 3] {
        let (na, ns) = self.gas_size;
        let (i, fi) = linear(place.altitude * REFINE.0 as f64, na);
        let (j, fj) = linear(sun * REFINE.1 as f64, ns);
        let row = i * ns + j;
        let (a, b, c, d) = (&self.gas[row], &self.gas[row + 1], &self.gas[row + ns], &self.gas[row + ns + 1]);
        let (wa, wb, wc, wd) = ((1.0 - fi) * (1.0 - fj), (1.0 - fi) * fj, fi * (1.0 - fj), fi * fj);
        let (x2, z2) = (x * x, place.mu * place.mu);
        // Factors of the moments in the sum of 1 + (d . d')^2 over the directions d' of the radiance. The ray's
        // direction is d.
        let (kx, ky, kz, kxz) = (1.0 + x2, 1.0 + (1.0 - x2 - z2).max(0.0), 1.0 + z2, 2.0 * x * place.mu);
        std::array::from_fn(|k| {
            let m = |n: usize| wa * a[n] + wb * b[n] + wc * c[n] + wd * d[n];
            let sum = kx * m(k) + ky * m(3 + k) + kz * m(6 + k) + kxz * m(9 + k);
            (3.0 / (16.0 * PI) * sum).max(0.0)
        })
    }

    fn haze(&self, place: &Place, sun: f64, azimuth: f64) -> [f64; 3] {
        let (nz, np) = self.haze_directions;
        let (na, ns) = self.haze_size;
        let (i, fi) = linear(place.altitude * REFINE_HAZE.0 as f64, na);
        let (j, fj) = linear(sun * REFINE_HAZE.1 as f64, ns);
        let (z0, wz) = mirrored(place.zenith / PI * (nz - 1) as f64, nz);
        let (p0, wp) = mirrored(azimuth / PI * (np - 1) as f64, np);
        let mut out = [0.0; 3];
        for (node, w) in [
            (i * ns + j, (1.0 - fi) * (1.0 - fj)),
            (i * ns + j + 1, (1.0 - fi) * fj),
            ((i + 1) * ns + j, fi * (1.0 - fj)),
            ((i + 1) * ns + j + 1, fi * fj),
        ] {
            let base = node * nz * np;
            for (dz, wz) in wz.iter().enumerate() {
                let (z, over_pole) = fold(z0 + dz as isize, nz);
                for (dp, wp) in wp.iter().enumerate() {
                    let (p, _) = fold(p0 + dp as isize, np);
                    // Across the pole the azimuth changes by pi.
                    let p = if over_pole { np - 1 - p } else { p };
                    let v = &self.haze[base + z * np + p];
                    let weight = w * wz * wp;
                    (0..3).for_each(|c| out[c] += weight * f64::from(v[c]));
                }
            }
        }
        out.map(|v| v.max(0.0))
    }
}

/// Logarithm of a value, at least that of the floor. In twilight the light falls by a factor of e for each 0.7 degrees
/// that the sun sinks. On a grid with steps of about that size, the logarithm can be interpolated, but not the light
/// itself.
fn to_log(v: f64, floor: f64) -> f64 {
    v.max(floor).max(f64::MIN_POSITIVE).ln()
}

/// Inverse of `to_log`; values up to twice the floor become 0.
fn from_log(v: f64, floor: f64) -> f64 {
    let v = v.exp();
    if v > 2.0 * floor { v } else { 0.0 }
}

/// Logarithms of the moments xx, yy and zz. The mixed moment xz becomes a share of its bound, xz / sqrt(xx zz).
fn moments_to_logs(m: &Moments, floor: f64) -> Moments {
    std::array::from_fn(|k| {
        if k < 9 {
            return to_log(m[k], floor);
        }
        let bound = (m[k - 9] * m[k - 3]).max(0.0).sqrt();
        if bound > floor { m[k] / bound } else { 0.0 }
    })
}

/// Inverse of `moments_to_logs`.
fn logs_to_moments(m: &Moments, floor: f64) -> Moments {
    let mut out: Moments = std::array::from_fn(|k| if k < 9 { from_log(m[k], floor) } else { 0.0 });
    for k in 9..12 {
        out[k] = m[k].clamp(-1.0, 1.0) * (out[k - 9] * out[k - 3]).sqrt();
    }
    out
}

/// First node and weights of cubic interpolation at `x` (node units). The four nodes may reach one node beyond either
/// end.
fn mirrored(x: f64, n: usize) -> (isize, [f64; 4]) {
    let x = x.clamp(0.0, (n - 1) as f64);
    let first = (x as isize).min(n as isize - 2) - 1;
    (first, cubic_weights(x - first as f64))
}

/// Mirrors an index at both ends, and returns whether it was beyond an end.
fn fold(i: isize, n: usize) -> (usize, bool) {
    let last = n as isize - 1;
    if i < 0 {
        (-i as usize, true)
    } else if i > last {
        ((2 * last - i) as usize, true)
    } else {
        (i as usize, false)
    }
}

/// Cubic refinement by `factor` along the middle axis of a table [outer][n][inner].
fn refine<T: Real, const K: usize>(
    table: &[[T; K]],
    outer: usize,
    n: usize,
    inner: usize,
    factor: usize,
) -> Vec<[T; K]> {
    let fine = (n - 1) * factor + 1;
    let mut out = Vec::with_capacity(outer * fine * inner);
    for o in 0..outer {
        for f in 0..fine {
            let (first, w) = super::quadrature::cubic(f as f64 / factor as f64, n);
            let w = w.map(T::from_f64);
            for i in 0..inner {
                let at = |k: usize| &table[(o * n + first + k) * inner + i];
                let (a, b, c, d) = (at(0), at(1), at(2), at(3));
                out.push(std::array::from_fn(|k| w[0] * a[k] + w[1] * b[k] + w[2] * c[k] + w[3] * d[k]));
            }
        }
    }
    out
}

/// Precisions in which tables are kept.
trait Real: Copy + std::ops::Add<Output = Self> + std::ops::Mul<Output = Self> {
    fn from_f64(v: f64) -> Self;
}

impl Real for f64 {
    fn from_f64(v: f64) -> Self {
        v
    }
}

impl Real for f32 {
    fn from_f64(v: f64) -> Self {
        v as f32
    }
}
