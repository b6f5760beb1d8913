//! The pattern of curtains in columns of rain: steep waves that fall as the drops do, so that a ray's mean over them is a closed
//! form and nothing flickers far away.

use std::f64::consts::TAU;

use super::lattice::random3;

/// Waves of the pattern.
pub(crate) const WAVES: usize = 12;
/// Height after which the pattern repeats, m.
pub(super) const PERIOD_M: f64 = 4096.0;
/// Amplitude of each wave.
pub(crate) const AMOUNT: f64 = 0.2;
/// Distances between which the pattern comes up, m: drops round the camera know nothing of it.
pub(crate) const PATTERN_M: [f64; 2] = [30.0, 300.0];

/// The pattern of a seed: wave lengths from 130 to 900 m in all directions, many times as high as wide.
pub(crate) fn pattern(seed: u32) -> [[f64; 4]; WAVES] {
    std::array::from_fn(|i| {
        let random = random3([seed, i as u32, 0x7261_696e]).map(|v| f64::from(v) / 4_294_967_296.0);
        let angle = 0.5 * TAU * (i as f64 + random[0]) / WAVES as f64;
        // Neighbouring directions get lengths far apart.
        let place = ((i * 5) % WAVES) as f64 / (WAVES - 1) as f64;
        let k = TAU / (130.0 * libm::pow(900.0 / 130.0, place));
        // Whole waves a period, about a sixth as many up as aside: curtains are steep.
        let rise =
            (k * PERIOD_M / TAU * (0.08 + 0.17 * random[1])).round().max(1.0) * if i % 2 == 0 { 1.0 } else { -1.0 };
        [k * libm::cos(angle), k * libm::sin(angle), TAU * rise / PERIOD_M, TAU * random[2]]
    })
}
