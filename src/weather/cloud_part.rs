//! Parts of a cloud layer above or below a place, and how they transmit and reflect light.
//!
//! # Model
//! The shape of a layer determines which share of the layer's cover and which share of its optical depth lie above a
//! height. The laws are fitted to means over the drawn clouds (`clouds::field`), for all kinds between sheets, cells,
//! cumulus, towers and fibres. A slant beam meets more of broken clouds than a vertical one, because it also meets
//! their sides ([`SlabPart::meet`]). Some of the cloud that a slant beam meets is thin.
//!
//! # Error
//! `cargo test --lib clouds::light::mean_light -- --nocapture` prints the error against the drawn clouds, for each
//! kind.

use super::conditions::CloudSlab;
use super::mix::mix;

use crate::numerics::smoothstep;

/// Sine of the lowest elevation of the sun at which its beam is traced through clouds. The light of a lower sun is
/// treated as coming from this elevation.
pub(super) const LOWEST: f64 = 0.03;
/// Upper limit of the spread of optical depths in broken clouds. The spread is 1 / nu, where nu is the shape parameter
/// of their gamma distribution. The limit is the spread of the deepest clouds to which the law of `SlabPart::through`
/// was fitted.
const MOST_SPREAD: f64 = 2.6;
/// Covers between which clouds change from broken to closed (`CLOSES` of `clouds::field`).
const CLOSES: [f64; 2] = [0.99, 1.0];

/// Part of a layer that lies on one side of a height.
pub(super) struct SlabPart<'a> {
    pub slab: &'a CloudSlab,
    /// Share of the sky that the part's clouds cover, 0 to 1.
    pub cover: f64,
    /// Vertical optical depth of the part's clouds, averaged over the covered area.
    pub depth: f64,
    /// Share of the layer's thickness that the part spans.
    share: f64,
}

fn mix2(a: [f64; 2], b: [f64; 2], t: f64) -> [f64; 2] {
    [mix(a[0], b[0], t), mix(a[1], b[1], t)]
}

impl CloudSlab {
    /// Returns the degree to which the layer is cumulus, 0 to 1, as opposed to the cells of stratocumulus.
    fn heaps(&self) -> f64 {
        (2.0 * self.convection).min(1.0) * (1.0 - self.cellular)
    }

    /// Returns the degree to which the layer is closed, 0 to 1. A layer with an infinite `scale_m`, such as that of
    /// the clouds over rain areas, is closed at any cover.
    fn closed(&self) -> f64 {
        if self.scale_m.is_finite() { smoothstep(CLOSES[0], CLOSES[1], self.cover) } else { 1.0 }
    }

    /// Returns the shares of the layer's cover and of its optical depth above a height. The height is 0 at the base and
    /// 1 at the top.
    ///
    /// The laws are fitted to means over the drawn clouds (`clouds::field`). The higher above the base, the fewer
    /// broken clouds reach there. A cumulonimbus has its anvil on top. The cloud of a closed layer ends below the
    /// layer's top, and its upper surface is more uneven in sheets than in cumulus.
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

    /// Returns the shares of [`Self::shares_above`] for broken clouds. The dome of a cloud rises with the amount by
    /// which the drawn clouds' field (`clouds::field`) exceeds its threshold. The field has a normal distribution.
    fn broken_above(&self, height: f64, heaped: f64) -> [f64; 2] {
        let tall = (2.0 * self.convection - 1.0).max(0.0);
        let left = (1.0 - height / (1.0 - 0.15 * heaped * (1.0 - tall))).max(0.0);
        // A logistic distribution with the factor 1.7 approximates the normal one (Johnson and Kotz 1970).
        let cover = self.cover.clamp(1e-6, 1.0 - 1e-6);
        let odds = libm::log(cover / (1.0 - cover));
        let rises = (1.3 * (1.7 * (2.2 - tall) + odds)).max(1.0);
        let reach = 1.0 / (1.0 + libm::exp(rises * height * height - odds)) / cover;
        [reach * smoothstep(0.0, 0.15, left), left * left]
    }

    /// Converts a height above the station to a relative height: 0 at the base, 1 at the top.
    fn height(&self, height_m: f64) -> f64 {
        ((height_m - self.base_m) / self.thickness_m.max(1e-3)).clamp(0.0, 1.0)
    }

    /// Returns the shares of the layer's cover and of its optical depth above a height over the station, m.
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
    /// Returns the share of a beam that meets the part's clouds; `mu` is the sine of the beam's elevation.
    ///
    /// For gaps between randomly placed clouds, (1 - cover) is raised to a power that grows with the tangent of the
    /// zenith angle times the ratio of the clouds' height to their spacing (Kauth and Penquite 1967). The vertically
    /// covered share is less than the cover that an observer sees, because the observer also sees the sides of clouds.
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

    /// Returns the unscattered share of the light that meets the part's clouds. `hit` is the share of the whole beam
    /// that meets these clouds.
    ///
    /// The optical depths of broken clouds have a gamma distribution (Barker 1996).
    fn through(&self, hit: f64, mu: f64) -> f64 {
        let depth = self.depth_met(hit) / mu;
        // A low beam meets the same clouds as a vertical one, and edges in addition.
        let edges = (hit - self.cover).max(0.0);
        let spread =
            (1.0 - self.slab.closed()) * ((0.4 * libm::log1p(self.slab.optical_depth)).min(MOST_SPREAD) + edges);
        let x = spread * depth;
        libm::exp(if x > 1e-9 { -depth * (libm::log1p(x) / x) } else { -depth })
    }

    /// Returns the vertical optical depth of the clouds that a beam meets: all of the part's cloud, spread over the
    /// share `hit`.
    fn depth_met(&self, hit: f64) -> f64 {
        if hit > 0.0 { self.depth * (self.cover / hit) } else { 0.0 }
    }

    /// Returns the shares into which the part splits a beam; `mu` is the sine of the beam's elevation.
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

    /// Returns the share of diffuse light that the part reflects.
    pub(super) fn back(&self) -> f64 {
        self.cover * slab_diffuse_reflectance(self.depth, self.slab.asymmetry)
    }
}

/// Shares into which a part of a layer splits a beam.
pub(super) struct Met {
    /// Share that meets the part's clouds.
    pub hit: f64,
    /// Share that meets the part's clouds and passes unscattered. The optical depths of broken clouds have a gamma
    /// distribution.
    pub through: f64,
    /// Share that meets the part's clouds and stays in the beam for the two-stream fluxes, in which light scattered
    /// nearly straight on counts as unscattered (delta scaling). All these clouds are taken to have the mean optical
    /// depth, so this share may be above or below `through`.
    pub beam_through: f64,
    /// Share that is reflected up.
    pub back: f64,
}

impl Met {
    /// Returns the share that is transmitted by scattering.
    pub(super) fn scattered(&self) -> f64 {
        (self.hit - self.beam_through - self.back).max(0.0)
    }
}

/// Returns the reflectance of a slab without absorption under a parallel beam: the two-stream solution of Meador and
/// Weaver (1980, eq. 24) with Eddington's coefficients after the delta scaling of Joseph, Wiscombe and Weinman (1976).
/// Transmittance, direct and diffuse together, is 1 minus the reflectance. The error of the reflectance against
/// discrete ordinates (Henyey-Greenstein, g = 0.85, optical depths 1 to 64) is at most 0.0044 with the sun overhead
/// and 0.029 with the sun 60 degrees from the zenith (tested). The solution was the best of five two-stream closures
/// tried.
pub fn slab_reflectance(optical_depth: f64, asymmetry: f64, cos_zenith: f64) -> f64 {
    let mu = cos_zenith.clamp(0.01, 1.0);
    let tau = optical_depth * (1.0 - asymmetry * asymmetry);
    let g = asymmetry / (1.0 + asymmetry);
    let gamma1 = 0.75 * (1.0 - g);
    let gamma3 = 0.25 * (2.0 - 3.0 * g * mu);
    let beam = -libm::expm1(-tau / mu);
    ((gamma1 * tau + (gamma3 - gamma1 * mu) * beam) / (1.0 + gamma1 * tau)).clamp(0.0, 1.0)
}

/// Returns the reflectance of a slab without absorption for diffuse light: gamma1 tau / (1 + gamma1 tau) (Meador and
/// Weaver 1980), with gamma1 and tau as in [`slab_reflectance`].
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
