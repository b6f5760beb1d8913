//! The pattern of curtains in rain: steep waves that fall as the drops do, so that a ray's mean over them is a closed
//! form and nothing flickers far away. Columns of rain areas have one each ([`crate::rain`]), the weather's own rain
//! another ([`crate::fog::patterns`]).

use std::f64::consts::TAU;

use super::random3;
use crate::{numerics::smoothstep, weather::Falling};

/// Waves of the pattern of columns.
pub(crate) const WAVES: usize = 12;
/// Height after which the pattern repeats, m.
pub(crate) const PERIOD_M: f64 = 4096.0;
/// Amplitude of each wave of columns.
pub(crate) const AMOUNT: f64 = 0.2;
/// Distances between which the pattern of columns comes up, m: drops round the camera know nothing of it.
pub(crate) const PATTERN_M: [f64; 2] = [30.0, 300.0];
/// Lengths of the waves of columns, m.
pub(crate) const COLUMN_LENGTHS_M: [f64; 2] = [130.0, 900.0];
/// Lengths of the waves of the weather's own rain, m, which is seen from nearer.
pub(crate) const OWN_LENGTHS_M: [f64; 2] = [50.0, 600.0];
/// Fall speed of the curtains of the weather's own rain, m/s, whatever its rate: with a speed that follows it the
/// pattern would be thrown about, late in a run, when the weather changes. Half of the water of 3 mm/h falls faster.
const FALL_M_S: f64 = 6.0;
/// Standard deviation of the rain over its mean at scales of 100 m to 1 km. Clustering in space rules convective rain
/// and hardly shows in stratiform rain (Jameson, Larsen and Kostinski 2015, a network of 21 disdrometers); the values
/// are chosen for each to look like itself.
const VARIATION: [f64; 3] = [0.08, 0.16, 0.49];
/// Rates between which steady rain is taken for convective, mm/h: half-way lie 40 dBZ, 11.5 mm/h by Marshall and
/// Palmer's relation, from which on Steiner, Houze and Yuter (1995) count all rain as convective.
const CONVECTIVE_MM_H: [f64; 2] = [4.0, 19.0];

/// Waves of a seed: lengths between the two in all directions, many times as high as wide; wave numbers to the right or
/// east, ahead or north, and up, 1/m, and phases, rad.
pub(crate) fn waves<const N: usize>(seed: u32, [least, most]: [f64; 2]) -> [[f64; 4]; N] {
    std::array::from_fn(|i| {
        let random = random3([seed, i as u32, 0x7261_696e]).map(|v| f64::from(v) / 4_294_967_296.0);
        let angle = 0.5 * TAU * (i as f64 + random[0]) / N as f64;
        // Neighbouring directions get lengths far apart.
        let place = ((i * 5) % N) as f64 / (N - 1) as f64;
        let k = TAU / (least * libm::pow(most / least, place));
        // Whole waves a period, about a sixth as many up as aside: curtains are steep.
        let rise =
            (k * PERIOD_M / TAU * (0.08 + 0.17 * random[1])).round().max(1.0) * if i % 2 == 0 { 1.0 } else { -1.0 };
        [k * libm::cos(angle), k * libm::sin(angle), TAU * rise / PERIOD_M, TAU * random[2]]
    })
}

/// How far the curtains of the weather's own rain have fallen, m, in the period after which they repeat.
pub(crate) fn fallen_m(time_s: f64) -> f64 {
    (FALL_M_S * time_s).rem_euclid(PERIOD_M)
}

/// Standard deviation of rain and drizzle over their mean from place to place; 0 where none falls.
pub(crate) fn variation(falling: &Falling) -> f64 {
    let liquid = falling.rain_mm_h + falling.drizzle_mm_h;
    if liquid <= 0.0 {
        return 0.0;
    }
    let [drizzle, steady, convective] = VARIATION;
    let heavy = smoothstep(CONVECTIVE_MM_H[0], CONVECTIVE_MM_H[1], falling.rain_mm_h);
    let share = heavy.max(falling.showers.clamp(0.0, 1.0));
    (falling.rain_mm_h * (steady + (convective - steady) * share) + falling.drizzle_mm_h * drizzle) / liquid
}
