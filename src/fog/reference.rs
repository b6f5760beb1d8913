//! The fog along one ray in f64: the truth that tests and queries call, and the twin of `shaders/fog/lookup.wgsl`
//! (same names, same order of parameters). A ray's way through the layer is in `path.rs`.
//!
//! # Light along the ray
//! The source J of scattered light (see [`super::light`]) depends on the depth below the layer's top only. Along the
//! ray that depth is taken as linear in optical path (exact for flat layers), so each exponential of it integrates to
//! an exponential. Of all scattering the share f is forward, about the ray, and leaves what arrives there; the transfer
//! equation, whose extinction is the full one, becomes dI/dt = I - (1 - f) J - f K, with K the mean of the radiance
//! over the forward lobe. A host's object is attenuated by the full depth, and what it hides is its share of the same
//! field: a black target's contrast is e^-t.
//!
//! * **Steep rays**: the lobe is narrow beside the angle to the horizon, K is the field in the ray's own direction, and
//!   the solution is the scaled one, L = integral of J e^(-t') dt' + I_behind (e^(-t') - e^-t), with scaled depth t'.
//! * **Rays near the level**: the lobe sees the light of the fog above and the dark of the ground below. With s the
//!   ray's cosine, w the lobe's spread and r = sqrt(s^2 + w^2), the share (1 + s/r)/2 of it looks up with the mean
//!   cosine r (from E max(x, 0) = (s + r)/2 of a spread distribution), and each half is J, seen through to its edge
//!   (sky or ground) by e^(-depth/r). Without this, dark ground shone through fog of any depth toward the horizon.

use glam::DVec3;

use super::laws::DistanceKind;
pub use super::model::{FallingModel, FogKind, FogModel, Term};
use super::path::both_paths;
pub use super::path::{LayerPath, falling_depth_above, falling_path, layer_depth_above, layer_path, layer_rise};
use super::patterns::patch_mean;
use super::phase::{fog_phase_after, share_unscattered};
use crate::{numerics::smooth, scene::depth::RANGE_SKY_M};

/// A band of this height, rad, or more covers all of the sky: pi, less what f32 rounds away.
const WHOLE_SKY: f64 = 0.999 * std::f64::consts::PI;

/// Spread of the forward lobe in elevation, rad: how far from the level a ray must be to see only ground or only sky
/// through it. Fitted to adding and doubling (`tests/fog/light.rs`): .1 to .2 serve droplets and haze alike.
pub(super) const FORWARD_SPREAD: f64 = 0.12;

/// Effect of fog on one pixel: `colour * transmittance + radiance`.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct FogSample {
    /// Light scattered into the ray.
    pub radiance: DVec3,
    /// Share of the object's light that is left.
    pub transmittance: DVec3,
    /// Distance, m, up to which the air counts as before the fog. The mean from which the fog's light comes, less what
    /// lies inside a layer that keeps the light from the air too.
    pub distance: f64,
    /// Share of the air's light between the eye and an object that is left inside a layer that keeps the light from it.
    pub shade: f64,
    /// Light of sun or moon that is scattered once into the ray and no more, over the phase function.
    pub once: DVec3,
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
/// which `transmitted` is left at its end; `slant` is the loss of depth per unit of path.
fn source_along(
    m: &FogModel,
    mu: f64,
    beam: DVec3,
    a: [DVec3; 2],
    slant: DVec3,
    path: DVec3,
    transmitted: DVec3,
) -> DVec3 {
    let one = DVec3::ONE;
    let filled = attenuated(one, one, transmitted, path);
    let ramp = a[0] * filled - slant * (filled - path * transmitted);
    let [b0, b1] = a.map(|a| exp3(-a * m.inverse_mu0));
    let mut l = m.constant.at(mu) * filled
        + m.slope.at(mu) * ramp
        + beam * attenuated(one - slant * m.inverse_mu0, b0, b1 * transmitted, path);
    if m.absorbing {
        let below = a.map(|a| m.scaling * m.depth_total - a);
        l += m.rise.at(mu) * attenuated(one - slant * m.k, exp3(-m.k * a[0]), exp3(-m.k * a[1]) * transmitted, path);
        l += m.fall.at(mu)
            * attenuated(one + slant * m.k, exp3(-m.k * below[0]), exp3(-m.k * below[1]) * transmitted, path);
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
    // Optical path of the sunlight by way of the mean place where the ray scatters it: half of what is scattered
    // forward counts as lost. All of it leaves a seam where rays pass from ground to sky; none, too bright an aureole
    // in haze.
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
    let steep = smooth(x);
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

/// Returns the effect of fog on the pixel whose ray starts at `origin` (relative to the camera) along `direction`, with
/// an object at `range` metres, or `plane` from the camera's plane; [`RANGE_SKY_M`] for sky.
pub fn fog_along(m: &FogModel, origin: DVec3, direction: DVec3, range: f64, plane: f64) -> FogSample {
    fog_beside_drops(m, origin, direction, range, plane, 0.0)
}

/// As [`fog_along`], where `hidden` of the optical depth of what falls is drawn as drops, flakes and stones: that much
/// of it is left out, and never more than all of it.
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

/// Returns what the layer and what falls show and let through: each has an optical depth of its own, both share their
/// light.
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
        v = if m.sky_band > 0.0 { smooth(x) } else { 1.0 };
        if m.sky_band >= WHOLE_SKY {
            v = 0.0;
        }
    }
    FogSample { radiance: m.first * (1.0 - v), transmittance: DVec3::splat(v), shade: 1.0, ..FogSample::default() }
}
