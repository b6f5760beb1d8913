//! Change of a planet's air from one weather to another, taken as a straight way through the numbers that describe the
//! air: how far apart two airs are, and where on the way between them a third one lies.

use crate::planet::{FIELDS, Planet};

/// Change of the optical depth, as a share of the depth, above which two planets are far apart: its far change. A draft
/// for one of them (small tables that are quickly built) then shows it with a smaller error than the whole tables of
/// the other. The far change of the haze's asymmetry is this number itself, and that of a scale height is twice this
/// share of the height.
const FAR: f64 = 0.03;
/// Far change (see [`FAR`]) of the ground's albedo.
const FAR_ALBEDO: f64 = 0.1;
/// Count of the numbers that the air's light depends on.
const NUMBERS: usize = 15;
/// Largest distance of a planet from the way between two others, as a share of the way's length, at which a mix of
/// their tables may still be used for it. A distance of a single far change is allowed however short the way is. A
/// distance or length is the square root of the sum, over all [`numbers`], of (change / far change)^2.
const BESIDE: f64 = 0.5;

/// Length of light's slanted path through the air, as a multiple of the vertical path, for which a mix of two tables is
/// right. The tests in `src/tests/changing_air.rs` print the errors of the mix.
const SLANT: f64 = 2.0;

/// Place of a planet's air on the way between two others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlaceOnWay {
    /// Share of the way, 0 at its start and 1 at its end.
    pub share: f64,
    /// Whether a mix of the tables at both ends may be used for the planet.
    pub is_near: bool,
}

/// Returns the place of the air of `now` on the way between the airs of `start` and `end`: the nearest point of the
/// way. The three planets are one body under three weathers.
pub(super) fn place_on_way(start: &Planet, end: &Planet, now: &Planet) -> PlaceOnWay {
    if now == end {
        return PlaceOnWay { share: 1.0, is_near: true };
    }
    let (way, gone) = (differences(start, end), differences(start, now));
    // Both changes are measured in the units of the whole way, which depend on its ends.
    let units = units(start, end);
    let sum =
        |a: &[f64; NUMBERS], b: &[f64; NUMBERS]| (0..NUMBERS).map(|i| a[i] * b[i] * units[i].powi(2)).sum::<f64>();
    let length_squared = sum(&way, &way);
    if length_squared == 0.0 {
        return PlaceOnWay { share: 1.0, is_near: sum(&gone, &gone) <= 1.0 };
    }
    let share = (sum(&gone, &way) / length_squared).clamp(0.0, 1.0);
    let beside = std::array::from_fn(|i| gone[i] - share * way[i]);
    let allowed = (BESIDE * BESIDE * length_squared).max(1.0);
    PlaceOnWay { share, is_near: sum(&beside, &beside) <= allowed }
}

/// Weights of the tables at the two ends of a way from one air to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightWay {
    /// Change of the vertical optical depth at the middle wavelength over the way, times [`SLANT`], clamped to ±40. A
    /// larger change would alter only the weights near the clearer end.
    depth: f64,
}

impl LightWay {
    /// Creates the way between two planets.
    pub fn new(start: &Planet, end: &Planet) -> Self {
        let depth = |p: &Planet| [1, 4, 7].map(|i| numbers(p)[i]).iter().sum::<f64>();
        Self { depth: (SLANT * (depth(end) - depth(start))).clamp(-40.0, 40.0) }
    }

    /// Returns the weight of the tables at the end, for air at a share of the way. Scattered light follows the
    /// transmittance, so it is not linear in optical depth.
    pub fn weight(&self, share: f64) -> f64 {
        if self.depth.abs() < 1e-6 { share } else { (-self.depth * share).exp_m1() / (-self.depth).exp_m1() }
    }

    /// Returns the share of the way at which the tables at the end have the weight `weight`: the inverse of
    /// [`LightWay::weight`].
    pub fn share(&self, weight: f64) -> f64 {
        if self.depth.abs() < 1e-6 {
            return weight;
        }
        (-(weight * (-self.depth).exp_m1()).ln_1p() / self.depth).clamp(0.0, 1.0)
    }
}

/// Returns the planet at a share of the way from `start` to `end`.
pub(super) fn between(start: &Planet, end: &Planet, share: f64) -> Planet {
    let mut planet = *start;
    for field in &FIELDS {
        for (value, last) in (field.set)(&mut planet).iter_mut().zip((field.get)(end)) {
            *value += share * (last - *value);
        }
    }
    planet
}

/// Whether two planets differ so much that a draft (see [`FAR`]) for one has a smaller error than the whole tables of
/// the other. True if they are different bodies, or if a number changes by more than a far change. The changes of the
/// depths of gas, haze and ozone at a wavelength are added.
pub(super) fn is_far(a: &Planet, b: &Planet) -> bool {
    let body = |p: &Planet| (p.bottom_radius_m, p.top_radius_m, p.wavelengths_nm);
    let (difference, unit) = (differences(a, b), units(a, b));
    let apart = |i: usize| difference[i].abs() * unit[i];
    let depths = |wavelength: usize| (0..3).map(|medium| apart(3 * medium + wavelength)).sum::<f64>();
    body(a) != body(b) || (0..3).any(|i| depths(i) > 1.0) || (9..NUMBERS).any(|i| apart(i) > 1.0)
}

/// Numbers that the air's light depends on: vertical optical depths of gas, haze and ozone at each wavelength, the
/// ground's albedo at each, the haze's asymmetry, and the scale heights of gas and haze.
fn numbers(p: &Planet) -> [f64; NUMBERS] {
    let mut all = [0.0; NUMBERS];
    for i in 0..3 {
        all[i] = p.rayleigh.scattering_per_m[i] * p.rayleigh.scale_height_m;
        all[3 + i] = p.mie.extinction_per_m[i] * p.mie.scale_height_m;
        all[6 + i] = p.absorption.extinction_per_m[i] * p.absorption.half_width_m;
        all[9 + i] = p.ground_albedo[i];
    }
    [all[12], all[13], all[14]] = [p.mie.asymmetry_g, p.rayleigh.scale_height_m, p.mie.scale_height_m];
    all
}

/// Returns the changes of the numbers from `a` to `b`.
fn differences(a: &Planet, b: &Planet) -> [f64; NUMBERS] {
    let (a, b) = (numbers(a), numbers(b));
    std::array::from_fn(|i| b[i] - a[i])
}

/// Returns the factors that turn changes of the numbers into multiples of far changes ([`FAR`]). Relative changes are
/// relative to the larger of the values of `a` and `b`. For a depth of gas, haze or ozone this value is the depth of
/// all three at the wavelength.
fn units(a: &Planet, b: &Planet) -> [f64; NUMBERS] {
    let (a, b) = (numbers(a), numbers(b));
    let whole = |n: &[f64; NUMBERS], i: usize| n[i] + n[3 + i] + n[6 + i];
    let one_over = |v: f64| if v > 0.0 { 1.0 / v } else { 0.0 };
    std::array::from_fn(|i| match i {
        0..9 => one_over(FAR * whole(&a, i % 3).max(whole(&b, i % 3))),
        9..12 => 1.0 / FAR_ALBEDO,
        12 => 1.0 / FAR,
        _ => one_over(2.0 * FAR * a[i].max(b[i])),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hazy(extinction_per_m: f64) -> Planet {
        let mut planet = Planet::earth();
        planet.mie.extinction_per_m = [extinction_per_m; 3];
        planet.mie.scattering_per_m = [0.9 * extinction_per_m; 3];
        planet
    }

    #[test]
    fn the_place_of_a_planet_on_the_way_follows_from_its_depth() {
        let (clear, haze) = (hazy(2e-5), hazy(6e-4));
        for share in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let place = place_on_way(&clear, &haze, &hazy(2e-5 + share * 5.8e-4));
            assert!(place.is_near && (place.share - share).abs() < 1e-9, "{share}: {place:?}");
        }
        assert_eq!(place_on_way(&clear, &haze, &haze).share, 1.0, "the end to the bit");
        let beyond = place_on_way(&clear, &haze, &hazy(2e-3));
        assert_eq!(beyond, PlaceOnWay { share: 1.0, is_near: false });
        let mut aside = hazy(3e-4);
        aside.ground_albedo = [0.9; 3];
        assert!(place_on_way(&clear, &haze, &aside).is_near, "far less than half of a long way");
        let short = hazy(2.2e-5);
        assert!(!place_on_way(&clear, &short, &aside).is_near);
        assert_eq!(place_on_way(&clear, &clear, &clear), PlaceOnWay { share: 1.0, is_near: true });
    }

    #[test]
    fn weights_and_shares_invert_each_other_and_both_directions_agree() {
        for end in [2.1e-5, 6e-4, 5e-2] {
            let [up, down] = [(2e-5, end), (end, 2e-5)].map(|(a, b)| LightWay::new(&hazy(a), &hazy(b)));
            assert_eq!((up.weight(0.0), up.weight(1.0), down.weight(1.0)), (0.0, 1.0, 1.0));
            for share in [0.001, 0.1, 0.5, 0.8] {
                let weight = up.weight(share);
                assert!(weight >= share && (weight + down.weight(1.0 - share) - 1.0).abs() < 1e-9);
                assert!(weight > 0.999 || (up.share(weight) - share).abs() < 1e-6, "{end}: {share}");
            }
        }
    }

    #[test]
    fn planets_are_far_apart_from_three_per_cent_of_depth_or_a_tenth_of_albedo_on() {
        let earth = Planet::earth();
        let lit = |albedo: f64| Planet { ground_albedo: [albedo; 3], ..earth };
        assert!(!is_far(&lit(0.1), &lit(0.19)) && is_far(&lit(0.1), &lit(0.21)));
        assert!(!is_far(&earth, &earth.with_air_scaled(1.02)) && is_far(&earth, &earth.with_air_scaled(1.04)));
        assert!(is_far(&earth, &Planet { bottom_radius_m: 6.0e6, ..earth }));
    }
}
