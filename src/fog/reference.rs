//! Fog along one ray in f64, for tests and queries. This file is the reference of `shaders/fog/lookup.wgsl`, with the
//! same names and the same order of parameters. `path.rs` has the ray's path through the layer.
//!
//! # Light along the ray
//! The source J of scattered light (see [`super::light`]) depends only on the optical depth below the layer's top.
//! Along the ray this depth is taken as linear in optical path, which is exact for flat layers. Each exponential of the
//! depth then integrates to an exponential.
//!
//! The share f of the scattering goes forward, into a lobe. This scattering adds to the ray the mean radiance K over
//! the lobe about the ray. With the full (unscaled) optical depth t, the transfer equation is dI/dt = I - (1 - f) J - f
//! K. The light of a host's object is attenuated by the full depth. The object hides the share e^-t of the light from
//! behind it, so the contrast of a black target is e^-t.
//!
//! * **Steep rays**: the lobe is narrow compared with the ray's angle to the horizon, so K is the radiance in the ray's
//!   own direction. The solution is the delta-scaled one, L = integral of J e^(-t') dt' + I_behind (e^(-t') - e^-t),
//!   with the scaled depth t' and the radiance I_behind that arrives from behind the object.
//! * **Rays near the level**: the lobe sees the bright fog above and the dark ground below. Let s be the ray's cosine
//!   with the vertical, w the lobe's spread and r = sqrt(s^2 + w^2). The share (1 + s/r)/2 of the lobe looks up, with
//!   the mean cosine r, because a distribution of cosines x about s with this spread has E max(x, 0) = (s + r)/2. Each
//!   part of the lobe sees J and, behind it, the sky or the ground through the transmittance e^(-depth/r). Without
//!   this, dark ground would show through fog of any depth toward the horizon.

use glam::DVec3;

use super::laws::DistanceKind;
pub use super::model::{FallingModel, FogKind, FogModel, Term};
use super::path::both_paths;
pub use super::path::{LayerPath, falling_depth_above, falling_path, layer_depth_above, layer_path, layer_rise};
use super::patterns::patch_mean;
use super::phase::{fog_phase_after, share_unscattered};
use crate::{numerics::smooth, scene::depth::RANGE_SKY_M};

/// Smallest height of the compatibility laws' sky band, rad, with which the band covers the whole sky: pi less a margin
/// for f32 rounding.
const WHOLE_SKY: f64 = 0.999 * std::f64::consts::PI;

/// Spread of the forward lobe in elevation, rad. The lobe of a ray much farther than this from the level sees only sky
/// or only ground. Fitted to adding and doubling (`tests/fog/light.rs`); values from 0.1 to 0.2 suit both droplets and
/// haze.
pub(super) const FORWARD_SPREAD: f64 = 0.12;

/// Effect of fog on one pixel: `colour * transmittance + radiance`.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct FogSample {
    /// Light scattered into the ray.
    pub radiance: DVec3,
    /// Share of the light from behind the fog that is left, per channel.
    pub transmittance: DVec3,
    /// Distance, m, up to which the air is drawn in front of the fog. It is the mean distance from which the fog's
    /// light comes, shortened inside the layer, where less light reaches the air ([`FogModel::lit`]).
    pub distance: f64,
    /// Share that is left of the air's light between the eye and an object: the layer shades the air inside it.
    pub shade: f64,
    /// Light of sun or moon that is scattered exactly once, into the ray, divided by the phase function.
    pub once: DVec3,
}

/// Integral of first e^(-rate s) ds over [0, path], where `last` = first e^(-rate path). A series replaces the division
/// by a small rate.
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

/// Mean of x over \[0, 1\] with the weight e^(-r x), which is 1/r - 1/(e^r - 1). The approximation is within 2 %.
fn mean_place(r: f64) -> f64 {
    let size = r.abs().min(1e6);
    let p = 1.0 + size * (1.0 / 3.0 + size / 5.7);
    let mean = p / (size * p + 2.0);
    if r < 0.0 { 1.0 - mean } else { mean }
}

/// Returns the exponential of each component.
fn exp3(v: DVec3) -> DVec3 {
    DVec3::new(v.x.exp(), v.y.exp(), v.z.exp())
}

/// Source of scattered light at the scaled depth `a` below the top, for a ray whose cosine with the vertical is `mu`.
fn source_at(m: &FogModel, mu: f64, beam: DVec3, a: DVec3) -> DVec3 {
    let mut j = m.constant.at(mu) + m.slope.at(mu) * a + beam * exp3(-a * m.inverse_mu0);
    if m.absorbing {
        let below = m.scaling * m.depth_total - a;
        j += m.rise.at(mu) * exp3(-m.k * a) + m.fall.at(mu) * exp3(-m.k * below);
    }
    j
}

/// Integral of the source of scattered light over the optical path `path`, whose ends lie at the scaled depths `a`
/// below the top. `transmitted` is the transmittance of the path; `slant` is the decrease of the depth per unit of
/// path.
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

/// Returns the light that is scattered into a ray, and [`FogSample::once`]. `mu` is the ray's cosine with the vertical
/// at its start, `entry_mu` the cosine where it enters the layer; `versine` is 1 - cos of its angle with the sun.
/// `ends` are the optical depths above the two ends of the ray, `depth` is the optical depth along it, both at 550 nm.
///
/// An end of the ray may lie below the ground's level, in a hollow of the host's terrain. Fog, not ground, lies below
/// that level there, but the solution ends at the level. The light below the level is therefore taken as the mirror
/// image of the light above it.
fn layer_radiance(m: &FogModel, mu: f64, entry_mu: f64, versine: f64, ends: [f64; 2], depth: f64) -> [DVec3; 2] {
    let mirrored = |a: f64| if a > m.depth_total { (2.0 * m.depth_total - a).max(0.5 * m.depth_total) } else { a };
    let above = ends.map(mirrored);
    let a = above.map(|a| m.scaling * a);
    let total = m.scaling * m.depth_total;
    let path = m.scaling * depth;
    let full = m.ratio * depth;
    let (through, left) = (exp3(-path), exp3(-full));
    // Decrease of the depth below the top per unit of path, in the part of the path from which the light comes. It is
    // the mean over an optically thin path. If the path is so thick that its end is not seen, it is the value at the
    // entry.
    let mean = if depth > 1e-12 { ((ends[0] - ends[1]) / depth).clamp(-1.0, 1.0) } else { entry_mu };
    let slant = entry_mu + (mean - entry_mu) * 2.0 / (2.0 + depth);
    let level = DVec3::splat(slant);
    // Optical path of sunlight from the top to the mean place where it is scattered, and on to the eye. Half of the
    // forward scattering counts as extinction for this mean. With all of it, a seam would show between rays that end at
    // the ground and rays to the sky. With none of it, the aureole in haze would be too bright.
    let way = depth * mean_place((1.0 - slant * m.inverse_mu0) * (1.0 - 0.5 * m.forward) * depth);
    let sunlight = ((above[0] - slant * way) * m.inverse_mu0 + way).max(0.0);
    let [even, peak] = fog_phase_after(&m.lobes, m.forward, m.smooth, sunlight, versine);
    let beam = m.beam.at(mu) + m.first * even;
    // Continuation of the ray beyond its end, to the ground or out of the top.
    let toward_sky = (slant * 100.0 + 0.5).clamp(0.0, 1.0);
    let rest = (total - a[1]).lerp(a[1], toward_sky) / slant.abs().max(0.005);
    let edge = a[1] - level * rest;
    let clear = exp3(-rest);

    // Aureole: the peak of sunlight scattered once. It is narrow enough for the delta-scaled solution at any elevation.
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

/// Light in a ray near the level, whose forward lobe reaches above and below the horizon. Extinction is unscaled, and
/// forward scattering adds the mean radiance over the lobe ([`FORWARD_SPREAD`]). `full` is the unscaled optical path
/// and its transmittance.
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

/// Returns the effect of fog on the pixel whose ray starts at `origin`, relative to the camera, along `direction`. The
/// object that the pixel shows lies at the distance `range`, m, along the ray and `plane`, m, from the camera's plane.
/// Both are [`RANGE_SKY_M`] for sky.
pub fn fog_along(m: &FogModel, origin: DVec3, direction: DVec3, range: f64, plane: f64) -> FogSample {
    fog_beside_drops(m, origin, direction, range, plane, 0.0)
}

/// Returns the effect of fog as [`fog_along`] does, where drops, flakes and stones are drawn one by one. `hidden` is
/// their optical depth, which is subtracted from that of the precipitation, down to 0.
pub fn fog_beside_drops(
    m: &FogModel,
    origin: DVec3,
    direction: DVec3,
    range: f64,
    plane: f64,
    hidden: f64,
) -> FogSample {
    fog_beside(m, origin, direction, [range, plane], [hidden, 0.0])
}

/// Returns the effect of fog along a ray to an object. The object's distance is `range`, m, along the ray and `plane`,
/// m, from the camera's plane. `less` has two optical depths: that of single drops, which is subtracted from the
/// precipitation, and that which fog banks replace, which is subtracted from the layer.
fn fog_beside(m: &FogModel, origin: DVec3, direction: DVec3, [range, plane]: [f64; 2], less: [f64; 2]) -> FogSample {
    match m.kind {
        FogKind::Clear if m.falling.extinction <= 0.0 => {
            FogSample { transmittance: DVec3::ONE, shade: 1.0, ..FogSample::default() }
        }
        FogKind::Clear | FogKind::Slab | FogKind::Exponential => fog_layer(m, origin, direction, range, less),
        _ => fog_compatible(m, direction, range, plane),
    }
}

/// Returns the effect of a layer from the camera as [`fog_along`] does, where fog banks replace the optical depth
/// `replaced` of the layer.
pub(super) fn fog_beside_banks(m: &FogModel, direction: DVec3, range: f64, replaced: f64) -> FogSample {
    fog_beside(m, DVec3::ZERO, direction, [range, range], [0.0, replaced])
}

/// Returns the effect of a fog bank along a ray from the camera that meets it between the distances `ends`, m, with the
/// optical depth `depth`.
pub(super) fn bank_light(m: &FogModel, direction: DVec3, range: f64, ends: [f64; 2], depth: f64) -> FogSample {
    let mu = direction.z.clamp(-1.0, 1.0);
    let [h0, _] = fog_reach(m, DVec3::ZERO, direction, range);
    let [first, last] = ends;
    let cosine = |s: f64| (mu + m.curvature * s).clamp(-1.0, 1.0);
    let above = layer_depth_above(m, h0 + layer_rise(m.curvature, mu, first));
    let below = (above - cosine(0.5 * (first + last)) * depth).max(0.0);
    let versine = 0.5 * (direction - m.to_sun).length_squared();
    let [radiance, once] = layer_radiance(m, mu, cosine(first), versine, [above, below], depth);
    let inside = if range >= RANGE_SKY_M { 0.0 } else { ((last - first) / range.max(1e-3)).min(1.0) };
    FogSample {
        radiance,
        transmittance: exp3(-m.ratio * depth),
        distance: first + (last - first) * mean_place(depth) * m.lit,
        shade: 1.0 - (1.0 - m.lit) * inside,
        once,
    }
}

/// Returns the altitude at which a ray starts, m, and its length in fog, m. A ray without an object ends at the ground
/// if it meets the ground.
pub(super) fn fog_reach(m: &FogModel, origin: DVec3, direction: DVec3, range: f64) -> [f64; 2] {
    let mu = direction.z.clamp(-1.0, 1.0);
    let lift = origin.z;
    let h0 = m.altitude + lift + 0.5 * m.curvature * (origin.length_squared() - lift * lift);
    if range >= RANGE_SKY_M && mu < 0.0 && h0 > m.ground {
        let d = h0 - m.ground;
        let c = d * (2.0 - m.curvature * d);
        let disc = mu * mu - m.curvature * c;
        if disc > 0.0 {
            return [h0, c / (disc.sqrt() - mu)];
        }
    }
    [h0, range]
}

/// Returns the effect of the layer and the precipitation. Each has its own optical depth; both are lit as one medium.
/// Single drops have the optical depth `hidden` of the precipitation, and fog banks replace the optical depth
/// `replaced` of the layer: both are subtracted.
fn fog_layer(m: &FogModel, origin: DVec3, direction: DVec3, range: f64, [hidden, replaced]: [f64; 2]) -> FogSample {
    let mu = direction.z.clamp(-1.0, 1.0);
    let [h0, t] = fog_reach(m, origin, direction, range);
    let mut path = layer_path(m, h0, mu, t);
    path.depth = (path.depth - replaced).max(0.0);
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
    // Mean distance from which scattered light comes, as in an even medium between entry and exit. The air in front of
    // this distance is drawn as if lit by an open sky. Inside the layer only the share `lit` of that light arrives, so
    // the distance inside the layer is multiplied by `lit`.
    let distance = path.first + (path.last - path.first) * mean_place(depth) * m.lit;
    let inside = if range >= RANGE_SKY_M { 0.0 } else { ((path.last - path.first) / range.max(1e-3)).min(1.0) };
    FogSample { radiance, transmittance, distance, shade: 1.0 - (1.0 - m.lit) * inside, once }
}

/// Returns the effect of a fog law of older simulators.
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
