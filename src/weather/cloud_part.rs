//! Parts of a layer of cloud above or below a place, and what they do with light.
//!
//! # Model
//! How much of its cover and of its optical depth a layer has above a height follows from how it is shaped: laws fitted
//! to means over the clouds that are drawn (`clouds::field`), for all kinds between sheets, cells, heaps, towers and
//! fibres. A beam that comes slantwise meets more of broken clouds than one that comes straight down, since it meets
//! their sides too ([`SlabPart::meet`]); some of what it meets is thin.
//!
//! # Error
//! `cargo test --lib clouds::light::mean_light -- --nocapture` prints it, kind by kind, against the clouds that are
//! drawn.

use super::conditions::CloudSlab;
use super::mix::mix;

use crate::numerics::smoothstep;

/// Sine of the lowest sun whose beam is followed through clouds: light that comes lower goes as light from there.
pub(super) const LOWEST: f64 = 0.03;
/// Most that depths of broken clouds are spread: that of the deepest that the law was fitted to.
const MOST_SPREAD: f64 = 2.6;
/// Covers between which clouds go over from broken to closed (`CLOSES` of `clouds::field`).
const CLOSES: [f64; 2] = [0.99, 1.0];

/// Part of a layer that lies on one side of a height.
pub(super) struct SlabPart<'a> {
    pub slab: &'a CloudSlab,
    /// Part of the sky that its clouds cover, 0 to 1.
    pub cover: f64,
    /// Their optical depth straight up, averaged over what they cover.
    pub depth: f64,
    /// Share of the layer's thickness that they reach through.
    share: f64,
}

fn mix2(a: [f64; 2], b: [f64; 2], t: f64) -> [f64; 2] {
    [mix(a[0], b[0], t), mix(a[1], b[1], t)]
}

impl CloudSlab {
    /// How far it is heaps, 0 to 1: those of cumulus, not the cells of stratocumulus.
    fn heaps(&self) -> f64 {
        (2.0 * self.convection).min(1.0) * (1.0 - self.cellular)
    }

    /// How far it is closed, 0 to 1: a whole wherever it is, too, which has no next cloud.
    fn closed(&self) -> f64 {
        if self.scale_m.is_finite() { smoothstep(CLOSES[0], CLOSES[1], self.cover) } else { 1.0 }
    }

    /// Share of its cover and of its optical depth above a height, of 1 from base to top.
    ///
    /// Laws fitted to means over the clouds that are drawn (`clouds::field`). Of broken clouds ever fewer reach ever
    /// higher; a cumulonimbus has its anvil over it; a closed layer ends below its top, sheets more unevenly than what
    /// is heaped.
    fn shares_above(&self, height: f64) -> [f64; 2] {
        if height <= 0.0 || height >= 1.0 {
            return [1.0 - height; 2];
        }
        let heaped = self.heaps().max(self.cellular);
        let anvil = ((self.convection - 0.9) / 0.1).clamp(0.0, 1.0);
        let broken = mix2(self.broken_above(height, heaped), [smoothstep(1.0, 0.95, height), 1.0 - height], anvil);
        let tower = ((self.convection - 0.6) / 0.15).clamp(0.0, 1.0);
        let top = mix(0.86 - 0.125 * heaped, 0.999, tower);
        let uneven = mix(0.12, 0.05, heaped).min(1.0 - top);
        let under = ((top - height + uneven) / (2.0 * uneven)).max(0.0);
        let even = if under < 1.0 { [under, uneven * under * under / top] } else { [1.0, (top - height) / top] };
        mix2(broken, even, self.closed())
    }

    /// Returns these shares for broken clouds: how far their excess over the field's threshold, spread normally, lifts
    /// their domes.
    fn broken_above(&self, height: f64, heaped: f64) -> [f64; 2] {
        let tall = (2.0 * self.convection - 1.0).max(0.0);
        let left = (1.0 - height / (1.0 - 0.15 * heaped * (1.0 - tall))).max(0.0);
        // A normal distribution as a logistic one (1.7: Johnson and Kotz 1970).
        let cover = self.cover.clamp(1e-6, 1.0 - 1e-6);
        let odds = libm::log(cover / (1.0 - cover));
        let rises = (1.3 * (1.7 * (2.2 - tall) + odds)).max(1.0);
        let reach = 1.0 / (1.0 + libm::exp(rises * height * height - odds)) / cover;
        [reach * smoothstep(0.0, 0.15, left), left * left]
    }

    /// A height over the station of 1 from its base to its top.
    fn height(&self, height_m: f64) -> f64 {
        ((height_m - self.base_m) / self.thickness_m.max(1e-3)).clamp(0.0, 1.0)
    }

    /// Share of its cover and of its optical depth above a height over the station.
    pub(super) fn shares_above_m(&self, height_m: f64) -> [f64; 2] {
        self.shares_above(self.height(height_m))
    }

    /// Returns the part of the layer above a height over the station.
    pub(super) fn above(&self, height_m: f64) -> SlabPart<'_> {
        let [cover, depth] = self.shares_above_m(height_m);
        let depth = if cover > 0.0 { self.optical_depth * (depth / cover) } else { 0.0 };
        SlabPart { slab: self, cover: self.cover * cover, depth, share: 1.0 - self.height(height_m) }
    }

    /// Returns the part of the layer below a height over the station.
    pub(super) fn below(&self, height_m: f64) -> SlabPart<'_> {
        let [_, above] = self.shares_above_m(height_m);
        SlabPart {
            slab: self,
            cover: self.cover,
            depth: self.optical_depth * (1.0 - above),
            share: self.height(height_m),
        }
    }
}

impl SlabPart<'_> {
    /// Share of a beam from a sine of elevation that meets its clouds.
    ///
    /// Of gaps between clouds that lie at random, (1 - cover) is raised to a power that grows with the tangent of the
    /// zenith angle by the height of clouds over their distances (Kauth and Penquite 1967). Straight up less is covered
    /// than the sky is seen to be, of which sides are a part.
    fn hit(&self, mu: f64) -> f64 {
        let s = self.slab;
        if self.cover >= 1.0 {
            return 1.0;
        }
        let (heaps, cells, fibre) = (s.heaps(), s.cellular, s.fibre);
        let tall = (2.0 * s.convection - 1.0).max(0.0);
        let upright = 0.85 - 0.4 * cells * cells - 0.15 * heaps - 0.13 * tall + 0.5 * fibre * fibre;
        let slant = (0.55 - 0.1 * heaps + 1.5 * cells * (1.0 - cells)) * (1.0 - fibre);
        let tangent = (1.0 - mu * mu).max(0.0).sqrt() / mu;
        let over_spacing = self.share * s.thickness_m / s.scale_m.max(1e-3);
        let more = slant * over_spacing * tangent - (1.0 - upright) * (1.0 - self.cover * self.cover);
        let power = (1.0 + (1.0 - s.closed()) * more).max(0.05);
        -libm::expm1(power * libm::log1p(-self.cover))
    }

    /// Share of a beam that goes through the clouds that it meets unscattered.
    ///
    /// Depths of broken clouds are spread by a gamma distribution (Barker 1996).
    fn through(&self, hit: f64, mu: f64) -> f64 {
        let depth = self.depth_met(hit) / mu;
        // What a low beam meets beside what lies straight above is edges.
        let edges = (hit - self.cover).max(0.0);
        let spread =
            (1.0 - self.slab.closed()) * ((0.4 * libm::log1p(self.slab.optical_depth)).min(MOST_SPREAD) + edges);
        let x = spread * depth;
        libm::exp(if x > 1e-9 { -depth * (libm::log1p(x) / x) } else { -depth })
    }

    /// Optical depth of what a beam meets of which so much meets cloud: all that is there, spread over that.
    fn depth_met(&self, hit: f64) -> f64 {
        if hit > 0.0 { self.depth * (self.cover / hit) } else { 0.0 }
    }

    /// Returns what the part does with a beam from a sine of elevation.
    pub(super) fn meet(&self, mu: f64) -> Met {
        let g = self.slab.asymmetry;
        let hit = self.hit(mu);
        Met {
            hit,
            through: hit * self.through(hit, mu),
            beam_through: hit * libm::exp(-(1.0 - g * g) * self.depth_met(hit) / mu),
            back: hit * slab_reflectance(self.depth_met(hit), g, mu),
        }
    }

    /// Share of light from all sides that it sends back.
    pub(super) fn back(&self) -> f64 {
        self.cover * slab_diffuse_reflectance(self.depth, self.slab.asymmetry)
    }
}

/// Shares into which a part of a layer splits a beam.
pub(super) struct Met {
    /// Share that meets its clouds.
    pub hit: f64,
    /// Share that meets them and comes through unscattered; and with what is scattered nearly straight on.
    pub through: f64,
    pub beam_through: f64,
    /// Share that goes back up.
    pub back: f64,
}

impl Met {
    /// Share that comes through scattered.
    pub(super) fn scattered(&self) -> f64 {
        (self.hit - self.beam_through - self.back).max(0.0)
    }
}

/// Reflectance of a slab without absorption under a parallel beam: the two-stream solution of Meador and Weaver
/// (1980, eq. 24) with Eddington's coefficients after the delta scaling of Joseph, Wiscombe and Weinman (1976).
/// Transmittance, direct and diffuse together, is 1 minus this. Against discrete ordinates (Henyey-Greenstein, g =
/// 0.85, depths 1 to 64) it errs by at most 0.0044 with the sun overhead and 0.029 at 60 degrees (tested); of five
/// two-stream closures tried it is the nearest.
pub fn slab_reflectance(optical_depth: f64, asymmetry: f64, cos_zenith: f64) -> f64 {
    let mu = cos_zenith.clamp(0.01, 1.0);
    let tau = optical_depth * (1.0 - asymmetry * asymmetry);
    let g = asymmetry / (1.0 + asymmetry);
    let gamma1 = 0.75 * (1.0 - g);
    let gamma3 = 0.25 * (2.0 - 3.0 * g * mu);
    let beam = -libm::expm1(-tau / mu);
    ((gamma1 * tau + (gamma3 - gamma1 * mu) * beam) / (1.0 + gamma1 * tau)).clamp(0.0, 1.0)
}

/// Reflectance of the same slab for light from all sides: gamma1 tau / (1 + gamma1 tau) (Meador and Weaver 1980).
pub fn slab_diffuse_reflectance(optical_depth: f64, asymmetry: f64) -> f64 {
    let tau = optical_depth * (1.0 - asymmetry * asymmetry);
    let x = 0.75 * (1.0 - asymmetry / (1.0 + asymmetry)) * tau;
    x / (1.0 + x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_stream_holds_to_discrete_ordinates() {
        // Reflectance of a conservative Henyey-Greenstein slab, g = 0.85, by PythonicDISORT.
        let table =
            [(1.0, 0.04232, 0.16488), (4.0, 0.19092, 0.41602), (16.0, 0.55721, 0.69740), (64.0, 0.84628, 0.89497)];
        for (tau, high, low) in table {
            let (a, b) = (slab_reflectance(tau, 0.85, 1.0), slab_reflectance(tau, 0.85, 0.5));
            assert!((a - high).abs() < 0.0045, "tau {tau}, mu 1: {a} against {high}");
            assert!((b - low).abs() < 0.03, "tau {tau}, mu .5: {b} against {low}");
        }
        assert_eq!(slab_reflectance(0.0, 0.85, 1.0), 0.0);
        assert!(slab_reflectance(1e9, 0.85, 0.5) <= 1.0);
    }
}
