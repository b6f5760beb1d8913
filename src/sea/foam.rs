//! Whitecaps: their area by wind, their decay, and where on the drawn surface they stand.

use std::f64::consts::PI;

use crate::numerics::smoothstep;

/// Time in which foam of breaking waves fades to 1/e in salt water, s (Monahan et al. 1986, second hand).
pub const SALT_DECAY_S: f64 = 3.85;
/// Time in which foam of breaking waves fades to 1/e in fresh water, s (Monahan et al. 1986, second hand).
pub const FRESH_DECAY_S: f64 = 2.54;
/// Mean reflectance of foam of all ages (Koepke 1984).
pub const MEAN_REFLECTANCE: f64 = 0.22;

/// Share of the area under foam that belongs to waves that break now. Crests break for about a second, and the foam
/// that they leave fades within some four seconds.
pub(super) const BREAKING_SHARE: f64 = 0.25;
/// Number of ages at which foam that earlier waves have left is computed, and the step between these ages, s.
pub(super) const AGES: usize = 4;
pub(super) const AGE_STEP_S: f64 = 0.9;
/// Salinity of the sea for which [`SALT_DECAY_S`] holds, g/kg.
const SALT_G_KG: f64 = 35.0;
/// Half-width of the range of compressions about the threshold over which foam begins: a share of the threshold, and a
/// compression that is added.
const EDGE: f64 = 0.05;
const LEAST_EDGE: f64 = 1e-3;
/// Standard deviations beyond which a normal distribution is taken as 0.
const FARTHEST_TAIL: f64 = 6.0;
/// Least standard deviation of the compression that is known by its variance alone.
const LEAST_DEVIATION: f64 = 0.02;

/// Returns the share of the sea under whitecaps for a wind, m/s, at 10 m: 3.84e-6 U^3.41 (Monahan and O'Muircheartaigh
/// 1980), at most 1. Published laws differ by a factor of 2.
pub fn whitecap_share(wind_m_s: f64) -> f64 {
    (3.84e-6 * libm::pow(wind_m_s.max(0.0), 3.41)).min(1.0)
}

/// Returns the share of the sea under whitecaps for a wind U, m/s, at 10 m (Callaghan et al. 2008): 0 up to 3.7 m/s,
/// then 3.18e-5 (U - 3.7)^3, and from 10.2 m/s on 4.82e-6 (U + 1.98)^3, at most 1.
pub fn callaghan_share(wind_m_s: f64) -> f64 {
    let cube = |v: f64| v * v * v;
    if wind_m_s < 10.2 { 3.18e-5 * cube((wind_m_s - 3.7).max(0.0)) } else { (4.82e-6 * cube(wind_m_s + 1.98)).min(1.0) }
}

/// Returns the compression c such that the surface is compressed by more than c on `share` of its area, for a sum of
/// waves whose compression has the variance `variance`. If the waves' horizontal motion is that of Gerstner's waves,
/// this variance is the mean square slope of the drawn waves. A compressed place covers 1 - c of its area at rest.
/// Therefore the share is Q(c / s) - s q(c / s) with the root s of the variance, and the tail Q and the density q of
/// the normal distribution. Returns infinity if `share` or `variance` is 0 or less.
pub fn fold_threshold(share: f64, variance: f64) -> f64 {
    let s = variance.max(0.0).sqrt();
    if s <= 0.0 || share <= 0.0 {
        return f64::INFINITY;
    }
    let area = |x: f64| compressed_area(s * x, 0.0, s);
    // The area falls with x up to x = 1/s, at which c is 1. The search covers all c from -1 to 1.
    let (mut low, mut high) = (-1.0 / s, 1.0 / s);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if area(middle) > share { low = middle } else { high = middle }
    }
    s * 0.5 * (low + high)
}

/// Returns the area of the water that is compressed by more than a threshold, over the area of all the water at rest.
/// The compression is a known one plus one that has a normal distribution with the standard deviation `s`.
fn compressed_area(threshold: f64, known: f64, s: f64) -> f64 {
    let x = (threshold - known) / s;
    // The tail beyond is a billionth. It is left out so that calm water has no foam at all.
    if x > FARTHEST_TAIL {
        return 0.0;
    }
    let density = libm::exp(-0.5 * x * x) / (2.0 * PI).sqrt();
    (1.0 - known) * 0.5 * libm::erfc(x / std::f64::consts::SQRT_2) - s * density
}

/// Foam on a surface by its compression, now and some seconds ago: foam stays with the water that was compressed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FoamLaw {
    /// Compression at which waves break; infinite where none do.
    pub from: f64,
    /// Variance of the compression by all waves.
    pub variance: f64,
    /// Standard deviation of the compression by short waves, whose past is known by their variance alone.
    pub short_deviation: f64,
    /// Weight of foam at each age: the share of the foam's first area that is left, times one factor for all ages. With
    /// this factor, foam of all ages covers the area under whitecaps that breaking waves do not cover.
    pub kept: [f64; AGES],
}

impl FoamLaw {
    /// No foam.
    pub const NONE: Self = Self { from: f64::INFINITY, variance: 0.0, short_deviation: 0.0, kept: [0.0; AGES] };

    /// Returns the law by which foam covers `share` of a sea, for variances of the compression by all waves and by the
    /// short ones, in water of a salinity, g/kg.
    pub fn new(share: f64, [all, short]: [f64; 2], salinity_g_kg: f64) -> Self {
        let salt = (salinity_g_kg / SALT_G_KG).clamp(0.0, 1.0);
        let decay_s = FRESH_DECAY_S + (SALT_DECAY_S - FRESH_DECAY_S) * salt;
        let left: [f64; AGES] = std::array::from_fn(|i| libm::exp(-AGE_STEP_S * (i + 1) as f64 / decay_s));
        // The foam that is left at all ages covers the rest of the share.
        let factor = (1.0 / BREAKING_SHARE - 1.0) / left.iter().sum::<f64>();
        Self {
            from: fold_threshold(BREAKING_SHARE * share, all),
            variance: all,
            short_deviation: short.max(0.0).sqrt(),
            kept: left.map(|left| factor * left),
        }
    }

    /// Returns the share of a place under foam, from its compression now and that by long waves at each age.
    /// `height_share` is the ratio of the height of the waves to that on the open sea.
    pub fn share(&self, now: f64, past: [f64; AGES], height_share: f64) -> f64 {
        let edge = EDGE * self.from.abs() + LEAST_EDGE;
        let breaking = smoothstep(self.from - edge, self.from + edge, now);
        let s = (height_share * self.short_deviation).max(LEAST_DEVIATION);
        let area = |compression: f64| compressed_area(self.from, compression, s).max(0.0);
        let left: f64 = past.iter().zip(self.kept).map(|(compression, kept)| kept * area(*compression)).sum();
        (breaking + left).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_are_those_published() {
        for (wind, first, second) in
            [(6.0, 0.0017, 0.0004), (10.0, 0.0099, 0.0080), (15.0, 0.039, 0.024), (20.0, 0.105, 0.051)]
        {
            assert!((whitecap_share(wind) / first - 1.0).abs() < 0.03, "{wind}: {}", whitecap_share(wind));
            assert!((callaghan_share(wind) / second - 1.0).abs() < 0.1, "{wind}: {}", callaghan_share(wind));
        }
        assert_eq!((whitecap_share(-1.0), whitecap_share(100.0)), (0.0, 1.0));
    }

    #[test]
    fn thresholds_cover_the_area_that_was_asked() {
        let mut chance = crate::chance::RandomStream::new(7, 1);
        for (share, variance) in [(0.0017, 0.02), (0.0099, 0.03), (0.105, 0.06)] {
            let c = fold_threshold(share, variance);
            let (n, mut area) = (400_000, 0.0);
            for _ in 0..n {
                let squeezed = variance.sqrt() * chance.normal();
                area += if squeezed > c { 1.0 - squeezed } else { 0.0 };
            }
            let found = area / f64::from(n);
            assert!((found / share - 1.0).abs() < 0.1, "{share} {variance}: {found}");
        }
        assert_eq!(fold_threshold(0.01, 0.0), f64::INFINITY);
    }
}
