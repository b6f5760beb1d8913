//! Pattern of curtains in rain: steep waves that fall with the drops. The mean over a ray has a closed form, so nothing
//! flickers far away. Each rain area's column has a pattern ([`crate::rain`]), and so does the weather's own rain
//! ([`crate::fog::patterns`]).

use std::f64::consts::TAU;

use super::random3;
use crate::{numerics::smoothstep, weather::Falling};

/// Number of waves in the pattern of columns.
pub(crate) const WAVES: usize = 12;
/// Height after which the pattern repeats, m.
pub(crate) const PERIOD_M: f64 = 4096.0;
/// Amplitude of each wave of columns, as a share of the column's mean rain.
pub(crate) const AMOUNT: f64 = 0.2;
/// Distances from the eye between which the pattern of columns fades in, m. Single drops around the camera do not have
/// it.
pub(crate) const PATTERN_M: [f64; 2] = [30.0, 300.0];
/// Shortest and longest wave of columns, m.
pub(crate) const COLUMN_LENGTHS_M: [f64; 2] = [130.0, 900.0];
/// Shortest and longest wave of the weather's own rain, m. This rain is seen from nearer than columns.
pub(crate) const OWN_LENGTHS_M: [f64; 2] = [50.0, 600.0];
/// Fall speed of the curtains of the weather's own rain, m/s, the same for all rain rates. If it followed the rate, a
/// change of weather late in a run would shift the pattern abruptly. At 3 mm/h half of the water falls faster.
const FALL_M_S: f64 = 6.0;
/// Ratio of the standard deviation of the rain rate to its mean, at scales of 100 m to 1 km, for drizzle, steady rain
/// and convective rain. Clustering in space dominates convective rain and is weak in stratiform rain (Jameson, Larsen
/// and Kostinski 2015, a network of 21 disdrometers). The values are chosen so that each kind looks right.
const VARIATION: [f64; 3] = [0.08, 0.16, 0.49];
/// Range of rates over which steady rain turns convective, mm/h. Its middle is 40 dBZ, 11.5 mm/h by Marshall and
/// Palmer's relation, above which Steiner, Houze and Yuter (1995) count all rain as convective.
const CONVECTIVE_MM_H: [f64; 2] = [4.0, 19.0];

/// Returns the waves for a seed, in all directions, with horizontal lengths between `least` and `most`, m. Each wave is
/// some six times as high as it is long. Each wave has its wave numbers to the right (or east), ahead (or north) and
/// up, 1/m, and its phase, rad.
pub(crate) fn waves<const N: usize>(seed: u32, [least, most]: [f64; 2]) -> [[f64; 4]; N] {
    std::array::from_fn(|i| {
        let random = random3([seed, i as u32, 0x7261_696e]).map(|v| f64::from(v) / 4_294_967_296.0);
        let angle = 0.5 * TAU * (i as f64 + random[0]) / N as f64;
        // Gives waves of neighbouring directions very different lengths.
        let place = ((i * 5) % N) as f64 / (N - 1) as f64;
        let k = TAU / (least * libm::pow(most / least, place));
        // Fits a whole number of waves into the vertical period. The vertical wave number is about a sixth of the
        // horizontal one: curtains are steep.
        let rise =
            (k * PERIOD_M / TAU * (0.08 + 0.17 * random[1])).round().max(1.0) * if i % 2 == 0 { 1.0 } else { -1.0 };
        [k * libm::cos(angle), k * libm::sin(angle), TAU * rise / PERIOD_M, TAU * random[2]]
    })
}

/// Returns the distance that the curtains of the weather's own rain have fallen, m, modulo [`PERIOD_M`].
pub(crate) fn fallen_m(time_s: f64) -> f64 {
    (FALL_M_S * time_s).rem_euclid(PERIOD_M)
}

/// Returns the ratio of the standard deviation of the rate of rain and drizzle in space to its mean; 0 if none falls.
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
