//! Path of a ray through a layer of fog, and its optical depth, in f64: the geometric part of the reference of
//! `shaders/fog/lookup.wgsl` (`reference.rs`).
//!
//! Let r0 be the distance of the ray's start from the planet's centre, mu the cosine of its angle with the vertical,
//! and k = 1/r0. After t metres its altitude is exactly
//!
//! ```text
//! h(t) = h0 + q / (1 + sqrt(1 + k q)),  q = t (2 mu + k t).
//! ```
//!
//! This form does not subtract two distances from the planet's centre, which would cancel. From its lowest point (its
//! start, its end, or where it is level) a ray only rises. If mu is the cosine there, the ray is d higher after the
//! distance
//!
//! ```text
//! t = c / (mu + sqrt(mu^2 + k c)),  c = d (2 + k d),
//! ```
//!
//! in which nothing cancels either. The path through a slab has three parts: the lower flank, the space of full
//! density, and the upper flank. Each flank contributes with its mean density along the path. This mean includes the
//! path's curvature.

use super::model::{FogKind, FogModel};

/// Path of a ray through the layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerPath {
    /// Optical depth at 550 nm.
    pub depth: f64,
    /// Distance at which the ray enters the layer, m.
    pub first: f64,
    /// Distance at which the ray leaves the layer, m.
    pub last: f64,
    /// Altitude of the ray's end, m.
    pub end_altitude: f64,
    /// Cosine of the ray with the vertical at its end.
    pub end_mu: f64,
}

/// Returns the rise of a ray above its start after `t` metres, m.
pub fn layer_rise(curvature: f64, mu: f64, t: f64) -> f64 {
    let q = t * (2.0 * mu + curvature * t);
    q / (1.0 + (1.0 + curvature * q).max(0.0).sqrt())
}

/// Returns the optical depth at 550 nm of the layer and the precipitation above the altitude `h`.
pub fn layer_depth_above(m: &FogModel, h: f64) -> f64 {
    own_depth_above(m, h) + falling_depth_above(m, h)
}

/// Returns the optical depth at 550 nm of the precipitation above the altitude `h`.
pub fn falling_depth_above(m: &FogModel, h: f64) -> f64 {
    let f = &m.falling;
    let in_top = f.top[1] - h.clamp(f.top[0], f.top[1]);
    f.extinction * (in_top * in_top * 0.5 * f.inverse_flank + f.top[0] - h.min(f.top[0]))
}

/// Returns the optical depth at 550 nm of the layer alone above the altitude `h`.
fn own_depth_above(m: &FogModel, h: f64) -> f64 {
    if m.kind == FogKind::Exponential {
        return m.extinction * ((m.knots[0] - h) / m.knots[1]).min(60.0).exp() * m.knots[1];
    }
    let [b0, b1, t0, t1] = m.knots;
    let in_top = t1 - h.clamp(t0, t1);
    let in_base = h.clamp(b0, b1);
    let top = in_top * in_top * 0.5 * m.inverse_flanks[1];
    let base = (b1 - in_base) * (b1 + in_base - 2.0 * b0) * 0.5 * m.inverse_flanks[0];
    m.extinction * (top + (t0 - h.clamp(b1, t0)) + base)
}

/// Returns the distance after which a ray that starts at its lowest point with cosine `mu` >= 0 is `lift` higher; 0 for
/// a negative `lift`.
fn layer_reach(curvature: f64, mu: f64, lift: f64) -> f64 {
    let c = lift.max(0.0) * (2.0 + curvature * lift.max(0.0));
    c / (mu + (mu * mu + curvature * c).sqrt()).max(1e-20)
}

/// Returns the optical depth of a part of a ray in a slab, divided by the slab's extinction, m. The part rises from
/// altitude `low` to `high` over `length` metres and passes the knots at the distances `reach`.
fn slab_part(m: &FogModel, bend: f64, reach: [f64; 4], length: f64, low: f64, high: f64) -> f64 {
    let r = reach.map(|x| x.min(length));
    let h = m.knots.map(|k| k.clamp(low, high));
    let share = |i: usize| {
        let l = r[i + 1] - r[i];
        let mean = 0.5 * (h[i] + h[i + 1]) - bend * l * l / 12.0;
        ((mean - m.knots[i]) * m.inverse_flanks[i / 2]).clamp(0.0, 1.0)
    };
    (r[1] - r[0]) * share(0) + (r[2] - r[1]) + (r[3] - r[2]) * (1.0 - share(2))
}

/// Altitudes along a ray that starts at altitude `h0` with cosine `mu` and is `t` metres long, split at its lowest
/// point.
struct RayCourse {
    /// Altitude of the end, m.
    end_altitude: f64,
    /// Cosine of the ray with the vertical at its end.
    end_mu: f64,
    /// Distance at which the ray is level, m.
    level: f64,
    /// Whether the distance `level` is within the ray's length.
    passes: bool,
    /// Whether the ray only descends.
    falls: bool,
    /// Lowest altitude, m.
    low: f64,
    /// Cosine with which both parts of the ray rise from the lowest point.
    low_mu: f64,
    /// Length of the part before the lowest point, m.
    before: f64,
    /// Length of the part after the lowest point, m.
    after: f64,
    /// Altitude at the upper end of the first part, m.
    high: f64,
    /// Curvature of the altitude along the ray, 1/m.
    bend: f64,
}

/// Returns the course of a ray that starts at altitude `h0` with cosine `mu` and is `t` metres long.
fn ray_course(m: &FogModel, h0: f64, mu: f64, t: f64) -> RayCourse {
    let k = m.curvature;
    let end_altitude = h0 + layer_rise(k, mu, t);
    let end_mu = ((mu + k * t) / (1.0 + k * (end_altitude - h0))).clamp(-1.0, 1.0);
    let level = -mu / k.max(1e-30);
    let passes = mu < 0.0 && t > level;
    let falls = mu < 0.0 && !passes;
    let (low, low_mu) = if passes {
        // Altitude where the ray is level: r0 (sqrt(1 - mu^2) - 1) above its start.
        (h0 - mu * mu / (1.0 + (1.0 - mu * mu).max(0.0).sqrt()) / k.max(1e-30), 0.0)
    } else if falls {
        (end_altitude, (-end_mu).max(0.0))
    } else {
        (h0, mu)
    };
    let (before, after) = if passes { (level, t - level) } else { (t, 0.0) };
    let high = if passes { h0 } else { h0.max(end_altitude) };
    let bend = k * (1.0 - mu * mu);
    RayCourse { end_altitude, end_mu, level, passes, falls, low, low_mu, before, after, high, bend }
}

/// Returns the distances along a ray at which it enters and leaves a slab. `reach` has the distances of the slab's
/// lower and upper edge from the ray's lowest point.
fn slab_ends(c: &RayCourse, t: f64, reach: [f64; 2]) -> (f64, f64) {
    let [near, far] = reach.map(|x| x.min(c.before));
    if c.passes {
        (c.level - far, c.level + reach[1].min(c.after))
    } else if c.falls {
        (t - far, t - near)
    } else {
        (near, far)
    }
}

/// Returns the path of a ray from altitude `h0` with cosine `mu`, `t` metres long, through the precipitation.
pub fn falling_path(m: &FogModel, h0: f64, mu: f64, t: f64) -> LayerPath {
    let c = ray_course(m, h0, mu, t);
    let f = &m.falling;
    let reach = f.top.map(|h| layer_reach(m.curvature, c.low_mu, h - c.low));
    // Precipitation reaches down to the ground at any altitude, so no part of the ray lies below the precipitation.
    let part = |length: f64, high: f64| {
        let r = reach.map(|x| x.min(length));
        let [h0, h1] = f.top.map(|k| k.clamp(c.low, high));
        let l = r[1] - r[0];
        let mean = 0.5 * (h0 + h1) - c.bend * l * l / 12.0;
        r[0] + l * (1.0 - ((mean - f.top[0]) * f.inverse_flank).clamp(0.0, 1.0))
    };
    let length = part(c.before, c.high.max(c.low)) + part(c.after, c.end_altitude.max(c.low));
    let (first, last) = slab_ends(&c, t, [0.0, reach[1]]);
    LayerPath { depth: f.extinction * length, first, last, end_altitude: c.end_altitude, end_mu: c.end_mu }
}

/// Returns the path of a ray from altitude `h0` with cosine `mu`, `t` metres long, through the layer.
pub fn layer_path(m: &FogModel, h0: f64, mu: f64, t: f64) -> LayerPath {
    let c = ray_course(m, h0, mu, t);
    let RayCourse { end_altitude, end_mu, .. } = c;
    if m.kind == FogKind::Exponential {
        let depth = exponential_path(m, h0, mu, t, end_altitude, end_mu);
        // The layer has no edge: `first` and `last` bound the part with most of the depth, at the denser end of the
        // ray.
        let dense = m.extinction * ((m.knots[0] - h0.min(end_altitude)) / m.knots[1]).min(60.0).exp();
        let length = (depth / dense.max(1e-20)).min(t);
        let first = if end_altitude < h0 { t - length } else { 0.0 };
        return LayerPath { depth, first, last: first + length, end_altitude, end_mu };
    }
    let reach = m.knots.map(|h| layer_reach(m.curvature, c.low_mu, h - c.low));
    let length = slab_part(m, c.bend, reach, c.before, c.low, c.high.max(c.low))
        + slab_part(m, c.bend, reach, c.after, c.low, end_altitude.max(c.low));
    let (first, last) = slab_ends(&c, t, [reach[0], reach[3]]);
    LayerPath { depth: m.extinction * length, first, last, end_altitude, end_mu }
}

/// Returns e^(z^2) erfc(z) for z >= 0, within 1.2e-7 relative (Chebyshev fit of Press et al., Numerical Recipes, 1992,
/// 6.2).
fn scaled_erfc(z: f64) -> f64 {
    const C: [f64; 10] = [
        -1.265_512_23,
        1.000_023_68,
        0.374_091_96,
        0.096_784_18,
        -0.186_288_06,
        0.278_868_07,
        -1.135_203_98,
        1.488_515_87,
        -0.822_152_23,
        0.170_872_77,
    ];
    let t = 1.0 / (1.0 + 0.5 * z);
    t * C.iter().rev().fold(0.0, |a, c| a * t + c).exp()
}

/// Returns the optical depth of an upward path through an exponential layer, divided by the extinction at its start, m.
/// The altitude grows by `rise` from a point where the ray has cosine `mu` >= 0. This is the Chapman integral with a
/// parabolic altitude.
fn exponential_up(k: f64, scale: f64, mu: f64, rise: f64) -> f64 {
    let z = mu / (2.0 * k * scale).sqrt();
    let x = rise / scale;
    (std::f64::consts::FRAC_PI_2 * scale / k).sqrt()
        * (scaled_erfc(z) - (-x).exp() * scaled_erfc((z * z + x).max(0.0).sqrt()))
}

/// Returns the optical depth at 550 nm of a ray through an exponential layer.
fn exponential_path(m: &FogModel, h0: f64, mu: f64, t: f64, end_altitude: f64, end_mu: f64) -> f64 {
    let k = m.curvature.max(1e-15);
    let scale = m.knots[1];
    let at = |h: f64| m.extinction * ((m.knots[0] - h) / scale).min(60.0).exp();
    let turn = if mu < 0.0 { (-mu / k).min(t) } else { 0.0 };
    let low = h0 + layer_rise(m.curvature, mu, turn);
    if (end_altitude - low).max(h0 - low) < scale {
        // Three Gauss nodes for a small range of altitude, where the closed form would subtract almost equal numbers.
        let node = |x: f64| (-layer_rise(m.curvature, mu, t * x) / scale).exp();
        let sum = (node(0.112_701_665) + node(0.887_298_335)) * 5.0 / 18.0 + node(0.5) * 8.0 / 18.0;
        return at(h0) * t * sum;
    }
    if mu >= 0.0 {
        return at(h0) * exponential_up(k, scale, mu, end_altitude - h0);
    }
    if end_mu <= 0.0 {
        return at(end_altitude) * exponential_up(k, scale, -end_mu, h0 - end_altitude);
    }
    at(low) * (exponential_up(k, scale, 0.0, h0 - low) + exponential_up(k, scale, 0.0, end_altitude - low))
}

/// Returns the path of a ray through two media: the sum of their optical depths, and the means of their ends weighted
/// by these depths.
pub(super) fn both_paths(fog: &LayerPath, falling: &LayerPath) -> LayerPath {
    let depth = fog.depth + falling.depth;
    let share = if fog.depth > 0.0 { falling.depth / depth } else { 1.0 };
    let mix = |a: f64, b: f64| a + (b - a) * share;
    LayerPath { depth, first: mix(fog.first, falling.first), last: mix(fog.last, falling.last), ..*falling }
}
