//! The fog along one ray in f64: the truth that tests and queries call, and the twin of `shaders/fog/lookup.wgsl`
//! (same names, same order of parameters).
//!
//! # Path through a layer
//! With r0 the distance of the ray's start from the planet's centre, mu the cosine of its angle with the vertical and
//! k = 1/r0, the altitude after t metres is h0 + q/(1 + sqrt(1 + k q)) with q = t (2 mu + k t): exact, and without the
//! cancellation of sqrt(r^2) - R. Seen from its lowest point (its start, its end, or where it is level) a ray only
//! rises, and meets an altitude d higher after c/(mu + sqrt(mu^2 + k c)), c = d (2 + k d): a form that only adds. So a slab
//! with linear flanks is three path lengths; a flank counts with its mean, in which the path's curvature enters.
//!
//! # Light along the ray
//! The source J of scattered light (see [`super::light`]) depends on the depth below the layer's top only. Along the ray
//! that depth is taken as linear in optical path (exact for flat layers), so
//! each exponential of it integrates to an exponential. Of all scattering the share f is forward, about the ray, and
//! leaves what arrives there; the transfer equation, whose extinction is the full one, becomes
//! dI/dt = I - (1 - f) J - f K, with K the mean of the radiance over the forward lobe. A host's object is attenuated by
//! the full depth, and what it hides is its share of the same field: a black target's contrast is e^-t.
//!
//! * **Steep rays**: the lobe is narrow beside the angle to the horizon, K is the field in the ray's own direction, and
//!   the solution is the scaled one, L = integral of J e^(-t') dt' + I_behind (e^(-t') - e^-t), with scaled depth t'.
//! * **Rays near the level**: the lobe sees the light of the fog above and the dark of the ground below. With s the
//!   ray's cosine, w the lobe's spread and r = sqrt(s^2 + w^2), the share (1 + s/r)/2 of it looks up with the mean
//!   cosine r (from E max(x, 0) = (s + r)/2 of a spread distribution), and each half is J, seen through to its edge
//!   (sky or ground) by e^(-depth/r). Without this, dark ground shone through fog of any depth toward the horizon.

use glam::DVec3;

use super::laws::DistanceKind;
use super::light::Solution;
use super::patterns::{Curtains, PATCH_WAVES, patch_mean};
use super::phase::{fog_phase_after, share_unscattered};
use crate::light::PhaseLobes;
use crate::scene::depth::RANGE_SKY_M;

/// What a model does: the shader's switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum FogKind {
    /// Nothing.
    Clear = 0,
    /// Slab with linear flanks.
    Slab = 1,
    /// Exponential layer.
    Exponential = 2,
    /// Linear law.
    Linear = 3,
    /// Exponential law.
    ExponentialLaw = 4,
    /// Exponential-squared law.
    ExponentialSquared = 5,
}

/// A band of this height, rad, or more covers all of the sky: pi, less what f32 rounds away.
const WHOLE_SKY: f64 = 0.999 * std::f64::consts::PI;

/// Spread of the forward lobe in elevation, rad: how far from the level a ray must be to see only ground or only sky
/// through it. Fitted to adding and doubling (`tests/fog/light.rs`): .1 to .2 serve droplets and haze alike.
pub(super) const FORWARD_SPREAD: f64 = 0.12;

/// One light source term c(mu) = `even` + mu `odd`, per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Term {
    /// Independent of direction.
    pub even: DVec3,
    /// Times the cosine of the view with up.
    pub odd: DVec3,
}

impl Term {
    fn at(&self, mu: f64) -> DVec3 {
        self.even + self.odd * mu
    }
}

/// All that a frame's fog needs, prepared in f64; [`FogModel::uniform`] is its form for shaders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogModel {
    /// What is drawn.
    pub kind: FogKind,
    /// Distance of the compatibility laws.
    pub distance: DistanceKind,
    /// Altitude of the camera, m.
    pub altitude: f64,
    /// 1/(planet radius + altitude), 1/m; 0 for a flat world.
    pub curvature: f64,
    /// Altitude at which rays without an object end in the ground, m.
    pub ground: f64,
    /// Slab: altitudes where the flanks begin and end (base 0, base 1, top 0, top 1), m. Exponential: reference
    /// altitude, scale height.
    pub knots: [f64; 4],
    /// 1/height of the slab's flanks, 1/m.
    pub inverse_flanks: [f64; 2],
    /// Extinction at 550 nm, 1/m; density of the compatibility laws.
    pub extinction: f64,
    /// Start and end of the linear law, m.
    pub linear: [f64; 2],
    /// Band of the sky that the compatibility laws cover, rad.
    pub sky_band: f64,
    /// Extinction of each channel over that at 550 nm.
    pub ratio: DVec3,
    /// Scaled (delta) optical depth over depth at 550 nm.
    pub scaling: DVec3,
    /// Depth at 550 nm from the layer's top to the ground.
    pub depth_total: f64,
    /// Unit vector to the sun.
    pub to_sun: DVec3,
    /// 1/cosine of the sun's zenith angle, as the slab was solved.
    pub inverse_mu0: f64,
    /// Phase function.
    pub lobes: PhaseLobes,
    /// Share of scattering counted as forward, and asymmetry of the rest.
    pub forward: f64,
    /// See `forward`.
    pub smooth: f64,
    /// Whether the exponential terms are used.
    pub absorbing: bool,
    /// Diffusion exponent per channel.
    pub k: DVec3,
    /// Source terms: constant, per scaled depth, beam, from the top, from the bottom.
    pub constant: Term,
    /// Per scaled depth.
    pub slope: Term,
    /// Times e^(-depth/mu0).
    pub beam: Term,
    /// Times e^(-k depth).
    pub rise: Term,
    /// Times e^(-k (total - depth)).
    pub fall: Term,
    /// First scattering: times phase and e^(-depth/mu0). The colour of the compatibility laws.
    pub first: DVec3,
    /// Mean radiance of the sky above the layer.
    pub sky_radiance: DVec3,
    /// Radiance of the ground below it.
    pub ground_radiance: DVec3,
    /// The layer's light per channel, as it was solved; `None` without a layer.
    pub solutions: Option<[Solution; 3]>,
    /// Share of the light above the layer that reaches the camera: that of the air inside it.
    pub lit: f64,
    /// Patches: share, and waves as (wave vector, phase at the camera).
    pub patch_amount: f64,
    /// See `patch_amount`.
    pub patch_waves: [(DVec3, f64); PATCH_WAVES],
    /// What falls through it and above it.
    pub falling: FallingModel,
}

/// What falls, as a medium of its own: the same everywhere below the altitude where it begins, and in curtains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingModel {
    /// Extinction at 550 nm, 1/m; 0 where nothing falls.
    pub extinction: f64,
    /// Altitudes between which it falls off to nothing, m.
    pub top: [f64; 2],
    /// 1/their distance, 1/m.
    pub inverse_flank: f64,
    /// Curtains of the rain among it.
    pub curtains: Curtains,
}

impl FallingModel {
    /// Nothing falls.
    pub const NONE: Self = Self { extinction: 0.0, top: [0.0; 2], inverse_flank: 1.0, curtains: Curtains::NONE };
}

/// What fog does to one pixel: `colour * transmittance + radiance`.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct FogSample {
    /// Light scattered into the ray.
    pub radiance: DVec3,
    /// Share of the object's light that is left.
    pub transmittance: DVec3,
    /// Distance, m, up to which the air counts as before the fog. The mean from which the fog's light comes, less what
    /// lies inside a layer that keeps the light from the air too.
    pub distance: f64,
    /// Of the air's light between the eye and an object, what is left inside a layer that keeps the light from it.
    pub shade: f64,
    /// Light of sun or moon that is scattered once into the ray and no more, over the phase function.
    pub once: DVec3,
}

/// A ray's way through the layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerPath {
    /// Optical depth at 550 nm.
    pub depth: f64,
    /// Where the ray enters the layer and leaves it, m.
    pub first: f64,
    /// See `first`.
    pub last: f64,
    /// Altitude of the ray's end, m.
    pub end_altitude: f64,
    /// Cosine of the ray with the vertical at its end.
    pub end_mu: f64,
}

/// Rise from the start of a ray after `t` metres, m.
pub fn layer_rise(curvature: f64, mu: f64, t: f64) -> f64 {
    let q = t * (2.0 * mu + curvature * t);
    q / (1.0 + (1.0 + curvature * q).max(0.0).sqrt())
}

/// Depth at 550 nm of the layer and of what falls above altitude `h`.
pub fn layer_depth_above(m: &FogModel, h: f64) -> f64 {
    own_depth_above(m, h) + falling_depth_above(m, h)
}

/// Depth at 550 nm of what falls above altitude `h`.
pub fn falling_depth_above(m: &FogModel, h: f64) -> f64 {
    let f = &m.falling;
    let in_top = f.top[1] - h.clamp(f.top[0], f.top[1]);
    f.extinction * (in_top * in_top * 0.5 * f.inverse_flank + f.top[0] - h.min(f.top[0]))
}

/// Depth at 550 nm of the layer alone above altitude `h`.
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

/// Distance after which a ray that rises from its lowest point with cosine `mu` >= 0 is `lift` higher; 0 if that is
/// below.
fn layer_reach(curvature: f64, mu: f64, lift: f64) -> f64 {
    let c = lift.max(0.0) * (2.0 + curvature * lift.max(0.0));
    c / (mu + (mu * mu + curvature * c).sqrt()).max(1e-20)
}

/// Optical depth over extinction of a slab's part that rises from altitude `low` to `high` over `length` metres,
/// meeting the knots after `reach`.
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

/// Heights along a ray from altitude `h0` with cosine `mu`, `t` metres long, over the place where it is lowest.
struct RayCourse {
    /// Altitude of its end, m, and its cosine with the vertical there.
    end_altitude: f64,
    end_mu: f64,
    /// Distance at which it is level, m; whether it is within its length, and whether the ray only falls.
    level: f64,
    passes: bool,
    falls: bool,
    /// Lowest altitude, m, and the cosine with which both parts rise from there.
    low: f64,
    low_mu: f64,
    /// Lengths of the parts on either side of the lowest place, m, and the altitude at which the first begins.
    before: f64,
    after: f64,
    high: f64,
    /// Curvature of altitude along the ray, 1/m.
    bend: f64,
}

fn ray_course(m: &FogModel, h0: f64, mu: f64, t: f64) -> RayCourse {
    let k = m.curvature;
    let end_altitude = h0 + layer_rise(k, mu, t);
    let end_mu = ((mu + k * t) / (1.0 + k * (end_altitude - h0))).clamp(-1.0, 1.0);
    let level = -mu / k.max(1e-30);
    let passes = mu < 0.0 && t > level;
    let falls = mu < 0.0 && !passes;
    let (low, low_mu) = if passes {
        // Where the ray is level: r0 (sqrt(1 - mu^2) - 1).
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

/// Where a ray enters and leaves a slab whose lower and upper end it meets after `reach`, counted from its lowest place.
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

/// The way of a ray from altitude `h0` with cosine `mu` through what falls, `t` metres long.
pub fn falling_path(m: &FogModel, h0: f64, mu: f64, t: f64) -> LayerPath {
    let c = ray_course(m, h0, mu, t);
    let f = &m.falling;
    let reach = f.top.map(|h| layer_reach(m.curvature, c.low_mu, h - c.low));
    // It falls to the ground, wherever that is: the ray never is below it.
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

/// The way of a ray from altitude `h0` with cosine `mu` through the layer, `t` metres long.
pub fn layer_path(m: &FogModel, h0: f64, mu: f64, t: f64) -> LayerPath {
    let c = ray_course(m, h0, mu, t);
    let RayCourse { end_altitude, end_mu, .. } = c;
    if m.kind == FogKind::Exponential {
        let depth = exponential_path(m, h0, mu, t, end_altitude, end_mu);
        // Where the weight lies: beside the denser end.
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

/// e^(z^2) erfc(z) for z >= 0, to 1.2e-7 relative (Chebyshev fit of Press et al., Numerical Recipes, 1992, 6.2).
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

/// Optical depth over (extinction at the start) of an upward exponential path whose altitude grows by `rise`, from a
/// point where the ray has cosine `mu` >= 0: the Chapman integral with a parabolic altitude.
fn exponential_up(k: f64, scale: f64, mu: f64, rise: f64) -> f64 {
    let z = mu / (2.0 * k * scale).sqrt();
    let x = rise / scale;
    (std::f64::consts::FRAC_PI_2 * scale / k).sqrt()
        * (scaled_erfc(z) - (-x).exp() * scaled_erfc((z * z + x).max(0.0).sqrt()))
}

fn exponential_path(m: &FogModel, h0: f64, mu: f64, t: f64, end_altitude: f64, end_mu: f64) -> f64 {
    let k = m.curvature.max(1e-15);
    let scale = m.knots[1];
    let at = |h: f64| m.extinction * ((m.knots[0] - h) / scale).min(60.0).exp();
    let turn = if mu < 0.0 { (-mu / k).min(t) } else { 0.0 };
    let low = h0 + layer_rise(m.curvature, mu, turn);
    if (end_altitude - low).max(h0 - low) < scale {
        // Short in altitude: three Gauss nodes, where the closed form would subtract equal numbers.
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

/// Integral of e^(-rate s) ds over [0, path], times `first`, where `last` = first e^(-rate path): in the form that does
/// not divide by a small rate.
fn attenuated(rate: DVec3, first: DVec3, last: DVec3, path: DVec3) -> DVec3 {
    let one = |rate: f64, first: f64, last: f64, path: f64| {
        let x = rate * path;
        if x.abs() < 0.03 {
            first * path * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0)))
        } else {
            (first - last) / rate
        }
    };
    DVec3::new(
        one(rate.x, first.x, last.x, path.x),
        one(rate.y, first.y, last.y, path.y),
        one(rate.z, first.z, last.z, path.z),
    )
}

/// Mean of x over \[0, 1\] weighted by e^(-r x), within 2 % of 1/r - 1/(e^r - 1).
fn mean_place(r: f64) -> f64 {
    let size = r.abs().min(1e6);
    let p = 1.0 + size * (1.0 / 3.0 + size / 5.7);
    let mean = p / (size * p + 2.0);
    if r < 0.0 { 1.0 - mean } else { mean }
}

fn exp3(v: DVec3) -> DVec3 {
    DVec3::new(v.x.exp(), v.y.exp(), v.z.exp())
}

/// The source of scattered light at scaled depth `a` below the top, looking with cosine `mu`.
fn source_at(m: &FogModel, mu: f64, beam: DVec3, a: DVec3) -> DVec3 {
    let mut j = m.constant.at(mu) + m.slope.at(mu) * a + beam * exp3(-a * m.inverse_mu0);
    if m.absorbing {
        let below = m.scaling * m.depth_total - a;
        j += m.rise.at(mu) * exp3(-m.k * a) + m.fall.at(mu) * exp3(-m.k * below);
    }
    j
}

/// The source of scattered light, integrated over the optical `path` between the scaled depths `a` below the top, of
/// which `through` is left at its end; `slant` is the loss of depth per unit of path.
fn source_along(m: &FogModel, mu: f64, beam: DVec3, a: [DVec3; 2], slant: DVec3, path: DVec3, through: DVec3) -> DVec3 {
    let one = DVec3::ONE;
    let filled = attenuated(one, one, through, path);
    let ramp = a[0] * filled - slant * (filled - path * through);
    let [b0, b1] = a.map(|a| exp3(-a * m.inverse_mu0));
    let mut l = m.constant.at(mu) * filled
        + m.slope.at(mu) * ramp
        + beam * attenuated(one - slant * m.inverse_mu0, b0, b1 * through, path);
    if m.absorbing {
        let below = a.map(|a| m.scaling * m.depth_total - a);
        l += m.rise.at(mu) * attenuated(one - slant * m.k, exp3(-m.k * a[0]), exp3(-m.k * a[1]) * through, path);
        l +=
            m.fall.at(mu) * attenuated(one + slant * m.k, exp3(-m.k * below[0]), exp3(-m.k * below[1]) * through, path);
    }
    l
}

/// Light scattered into a ray through the layer, looking with cosine `mu`, `entry_mu` where it enters; `versine` = 1 -
/// cos of its angle with the sun, `ends` the depths above its ends at 550 nm, `depth` along it.
///
/// Below the ground's level (a hollow of the host's terrain) the field is mirrored: it has fog below it, not the bare
/// ground that is known at the level only. Answers the radiance, and what [`FogSample::once`] is.
fn layer_radiance(m: &FogModel, mu: f64, entry_mu: f64, versine: f64, ends: [f64; 2], depth: f64) -> [DVec3; 2] {
    let mirrored = |a: f64| if a > m.depth_total { (2.0 * m.depth_total - a).max(0.5 * m.depth_total) } else { a };
    let above = ends.map(mirrored);
    let a = above.map(|a| m.scaling * a);
    let total = m.scaling * m.depth_total;
    let path = m.scaling * depth;
    let full = m.ratio * depth;
    let (through, left) = (exp3(-path), exp3(-full));
    // Loss of depth below the top per path, where the light comes from: the mean cosine of a short path, that of the
    // entry for one whose end is not seen.
    let mean = if depth > 1e-12 { ((ends[0] - ends[1]) / depth).clamp(-1.0, 1.0) } else { entry_mu };
    let slant = entry_mu + (mean - entry_mu) * 2.0 / (2.0 + depth);
    let level = DVec3::splat(slant);
    // Optical path of the sunlight by way of the mean place where the ray scatters it: half of what is scattered forward
    // counts as lost. All of it leaves a seam where rays pass from ground to sky; none, too bright an aureole in haze.
    let way = depth * mean_place((1.0 - slant * m.inverse_mu0) * (1.0 - 0.5 * m.forward) * depth);
    let sunlight = ((above[0] - slant * way) * m.inverse_mu0 + way).max(0.0);
    let [even, peak] = fog_phase_after(&m.lobes, m.forward, m.smooth, sunlight, versine);
    let beam = m.beam.at(mu) + m.first * even;
    // The ray's way on, to the ground or out of the top.
    let toward_sky = (slant * 100.0 + 0.5).clamp(0.0, 1.0);
    let rest = (total - a[1]).lerp(a[1], toward_sky) / slant.abs().max(0.005);
    let edge = a[1] - level * rest;
    let clear = exp3(-rest);

    // Sunlight scattered once, about the sun: its peak is as narrow as the scaling takes it to be.
    let rate = DVec3::splat(1.0 - slant * m.inverse_mu0);
    let [b0, b1, b2] = [a[0], a[1], edge].map(|a| exp3(-a * m.inverse_mu0));
    let beyond = attenuated(rate, b1, b2 * clear, rest);
    let met = attenuated(rate, b0, b1 * through, path);
    let aureole = m.first * peak * (met + beyond * (through - left));

    let x = ((slant.abs() / FORWARD_SPREAD - 0.5) / 1.5).clamp(0.0, 1.0);
    let steep = x * x * (3.0 - 2.0 * x);
    let wide = grazing_light(m, mu, beam, a, slant, [full, left]);
    let behind = m.ground_radiance.lerp(m.sky_radiance, toward_sky);
    let end = behind * clear + source_along(m, mu, beam, [a[1], edge], level, rest, clear);
    let narrow = source_along(m, mu, beam, a, level, path, through) + end * (through - left);
    let once = m.first * share_unscattered(m.forward, sunlight) * met;
    [(wide.lerp(narrow, steep) + aureole).max(DVec3::ZERO), once]
}

/// Light in a ray near the level, whose forward lobe reaches up and down: every scattering on the way counts, the
/// forward ones with the mean of what the lobe sees ([`FORWARD_SPREAD`]). `full`: the unscaled path and what it leaves.
fn grazing_light(m: &FogModel, mu: f64, beam: DVec3, a: [DVec3; 2], slant: f64, full: [DVec3; 2]) -> DVec3 {
    let [path, left] = full;
    let one = DVec3::ONE;
    let total = m.scaling * m.depth_total;
    let unforward = m.scaling / m.ratio;
    let s = unforward * slant;
    let spread = (slant * slant + FORWARD_SPREAD * FORWARD_SPREAD).sqrt();
    let up = 0.5 * (1.0 + slant / spread);
    let near = (0.5 * total).min(DVec3::splat(spread));
    let to_sky = (m.sky_radiance - source_at(m, mu, beam, near)) * up;
    let to_ground = (m.ground_radiance - source_at(m, mu, beam, total - near)) * (1.0 - up);
    let [sky0, sky1] = a.map(|a| exp3(-a / spread));
    let [ground0, ground1] = a.map(|a| exp3((a - total) / spread));
    let edges = to_sky * attenuated(one - s / spread, sky0, sky1 * left, path)
        + to_ground * attenuated(one + s / spread, ground0, ground1 * left, path);
    source_along(m, mu, beam, a, s, path, left) + (one - unforward) * edges
}

/// What fog does to the pixel whose ray starts at `origin` (relative to the camera) along `direction`, with an object
/// at `range` metres, or `plane` from the camera's plane; [`RANGE_SKY_M`] for sky.
pub fn fog_along(m: &FogModel, origin: DVec3, direction: DVec3, range: f64, plane: f64) -> FogSample {
    fog_beside_drops(m, origin, direction, range, plane, 0.0)
}

/// As [`fog_along`], where `hidden` of the optical depth of what falls is drawn as drops, flakes and stones: that much of it is
/// left out, and never more than all of it.
pub fn fog_beside_drops(
    m: &FogModel,
    origin: DVec3,
    direction: DVec3,
    range: f64,
    plane: f64,
    hidden: f64,
) -> FogSample {
    match m.kind {
        FogKind::Clear if m.falling.extinction <= 0.0 => {
            FogSample { transmittance: DVec3::ONE, shade: 1.0, ..FogSample::default() }
        }
        FogKind::Clear | FogKind::Slab | FogKind::Exponential => fog_layer(m, origin, direction, range, hidden),
        _ => fog_compatible(m, direction, range, plane),
    }
}

/// A ray's way through two media: the optical depth of both, and between their ends by what each has of it.
fn both_paths(fog: &LayerPath, falling: &LayerPath) -> LayerPath {
    let depth = fog.depth + falling.depth;
    let share = if fog.depth > 0.0 { falling.depth / depth } else { 1.0 };
    let mix = |a: f64, b: f64| a + (b - a) * share;
    LayerPath { depth, first: mix(fog.first, falling.first), last: mix(fog.last, falling.last), ..*falling }
}

/// What the layer and what falls show and let through: each has an optical depth of its own, both share their light.
fn fog_layer(m: &FogModel, origin: DVec3, direction: DVec3, range: f64, hidden: f64) -> FogSample {
    let mu = direction.z.clamp(-1.0, 1.0);
    let lift = origin.z;
    let h0 = m.altitude + lift + 0.5 * m.curvature * (origin.length_squared() - lift * lift);
    let mut t = range;
    if range >= RANGE_SKY_M && mu < 0.0 && h0 > m.ground {
        // A ray without an object ends in the ground, if it meets it.
        let d = h0 - m.ground;
        let c = d * (2.0 - m.curvature * d);
        let disc = mu * mu - m.curvature * c;
        if disc > 0.0 {
            t = c / (disc.sqrt() - mu);
        }
    }
    let mut path = layer_path(m, h0, mu, t);
    if m.patch_amount > 0.0 {
        path.depth *= patch_mean(m, origin, direction, path.first, path.last);
    }
    if m.falling.extinction > 0.0 {
        let mut falling = falling_path(m, h0, mu, t);
        let curtains = &m.falling.curtains;
        if curtains.amount > 0.0 {
            let mean = curtains.mean(origin, direction, falling.first, falling.last);
            falling.depth = curtains.depth(falling.depth, mean);
        }
        falling.depth = (falling.depth - hidden).max(0.0);
        path = both_paths(&path, &falling);
    }
    let depth = path.depth;
    let ends = [h0, path.end_altitude].map(|h| layer_depth_above(m, h));
    let versine = 0.5 * (direction - m.to_sun).length_squared();
    let entry_mu = (mu + m.curvature * path.first).clamp(-1.0, 1.0);
    let [radiance, once] = layer_radiance(m, mu, entry_mu, versine, ends, depth);
    let transmittance = exp3(-m.ratio * depth);
    // Mean distance of the scattered light, as in an even medium between entry and exit. The air is drawn as lit from a
    // free sky: where the layer lets only a share down, only that share of the air inside counts.
    let distance = path.first + (path.last - path.first) * mean_place(depth) * m.lit;
    let inside = if range >= RANGE_SKY_M { 0.0 } else { ((path.last - path.first) / range.max(1e-3)).min(1.0) };
    FogSample { radiance, transmittance, distance, shade: 1.0 - (1.0 - m.lit) * inside, once }
}

fn fog_compatible(m: &FogModel, direction: DVec3, range: f64, plane: f64) -> FogSample {
    let d = if m.distance == DistanceKind::Plane { plane } else { range };
    let mut v = match m.kind {
        FogKind::Linear => ((m.linear[1] - d) / (m.linear[1] - m.linear[0])).clamp(0.0, 1.0),
        FogKind::ExponentialLaw => (-m.extinction * d).exp(),
        _ => (-(m.extinction * d).powi(2)).exp(),
    };
    if range >= RANGE_SKY_M {
        let x = (direction.z.clamp(-1.0, 1.0).asin() / m.sky_band.max(1e-6)).clamp(0.0, 1.0);
        v = if m.sky_band > 0.0 { x * x * (3.0 - 2.0 * x) } else { 1.0 };
        if m.sky_band >= WHOLE_SKY {
            v = 0.0;
        }
    }
    FogSample { radiance: m.first * (1.0 - v), transmittance: DVec3::splat(v), shade: 1.0, ..FogSample::default() }
}
