//! Limits of illuminance below which stars are not drawn, because no eye could see them against the sky, or because
//! they are too faint for a step of the display.

use std::f64::consts::PI;

use super::{light::MAGNITUDE_0_LUX, reference::PEAK_WEIGHT};

/// One foot-candle in lux.
const LUX_PER_FOOT_CANDLE: f64 = 10.763_91;
/// One nanolambert in cd/m^2.
const CD_M2_PER_NANOLAMBERT: f64 = 1e-5 / PI;

/// Smallest illuminance at the eye, lux, of a star that can be seen against a background of `background_cd_m2`. Hecht's
/// law in the form of Schaefer (1990, PASP 102, 212, after Knoll, Tousey and Hulburt 1946):
///
/// `I = C (1 + (K B)^(1/2))^2`, with log C = -9.80 and log K = -1.90 for rods, -8.35 and -5.90 for cones,
///
/// with I in foot-candles and B in nanolamberts. The lower of the two thresholds applies. Backgrounds below 0 are
/// taken as 0. A good observer sees stars half a magnitude fainter.
pub fn threshold_lux(background_cd_m2: f64) -> f64 {
    let b = background_cd_m2.max(0.0) / CD_M2_PER_NANOLAMBERT;
    let eye = |log_c: f64, log_k: f64| 10f64.powf(log_c) * (1.0 + (10f64.powf(log_k) * b).sqrt()).powi(2);
    eye(-9.80, -1.90).min(eye(-8.35, -5.90)) * LUX_PER_FOOT_CANDLE
}

/// Magnitude, at the eye, of the faintest star that can be seen against a background; it corresponds to
/// [`threshold_lux`].
pub fn limiting_magnitude(background_cd_m2: f64) -> f64 {
    -2.5 * (threshold_lux(background_cd_m2) / MAGNITUDE_0_LUX).log10()
}

/// Smallest illuminance, lux, of a star whose brightest pixel is at least `share` of a display step. `step` is the
/// smallest difference that the display shows in the dark, as a share of white (1/255/12.92 for 8 bits with the sRGB
/// curve). `exposure` is in display units per cd/m^2, and `pixel_sr` is the solid angle of a pixel. If any of the four
/// is not positive, the result is 0, which drops no star.
pub fn display_threshold_lux(share: f64, step: f64, exposure: f64, pixel_sr: f64) -> f64 {
    if !(share > 0.0 && step > 0.0 && exposure > 0.0 && pixel_sr > 0.0) {
        return 0.0;
    }
    share * step / exposure * pixel_sr / PEAK_WEIGHT
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Luminance of a surface brightness, cd/m^2.
    fn of_magnitude(per_square_arc_second: f64) -> f64 {
        super::super::glow::S10_CD_M2 * 10f64.powf(-0.4 * (per_square_arc_second - 27.782))
    }

    #[test]
    fn limiting_magnitudes_are_those_observed_by_eye() {
        // Dark site, 21.6 to 22 mag/arcsec^2: 6 to 7. Suburb, 18: 4 to 5. City centre, 16: below 4.5 (Bortle 2001).
        for (sky, low, high) in [(22.0, 6.3, 7.0), (21.6, 6.2, 6.8), (18.0, 4.0, 5.2), (16.0, 3.0, 4.5)] {
            let m = limiting_magnitude(of_magnitude(sky));
            assert!((low..high).contains(&m), "{sky}: {m}");
        }
        // By day Venus at -4.4 is just visible, and Sirius is not.
        let day = limiting_magnitude(4000.0);
        assert!((-4.4..-2.5).contains(&day), "{day}");
    }

    #[test]
    fn brighter_skies_hide_more_without_a_leap() {
        let at = |i: i32| limiting_magnitude(1e-7 * 1.05f64.powi(i));
        for i in 0..500 {
            assert!(at(i + 1) <= at(i) && at(i) - at(i + 1) < 0.06, "{i}");
        }
        assert_eq!(limiting_magnitude(-1.0), limiting_magnitude(0.0));
        assert!((limiting_magnitude(0.0) - 7.93).abs() < 0.02, "{}", limiting_magnitude(0.0));
    }

    #[test]
    fn the_threshold_of_a_display_is_the_stated_share_of_its_step() {
        let sr = 7e-7;
        let lux = display_threshold_lux(0.1, 1.0 / 255.0 / 12.92, 50.0, sr);
        // The brightest pixel of a centred star has a tenth of a step.
        let peak = lux * PEAK_WEIGHT / sr * 50.0;
        assert!((peak * 255.0 * 12.92 - 0.1).abs() < 1e-9);
        for none in [(0.0, 1e-3, 1.0, sr), (0.1, 1e-3, 0.0, sr), (0.1, 1e-3, f64::NAN, sr), (0.1, 1e-3, 1.0, 0.0)] {
            assert_eq!(display_threshold_lux(none.0, none.1, none.2, none.3), 0.0);
        }
    }
}
