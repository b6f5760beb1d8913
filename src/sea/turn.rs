//! Sine and cosine of angles in turns: fast, and with the same bits on every machine.

use glam::Vec4;

/// Returns `x` minus the nearest whole number, within \[-0.5, 0.5\]. `x` must be within 2^51.
#[inline(always)]
pub(super) fn fraction(x: f64) -> f64 {
    // Adding and taking away 1.5 * 2^52 rounds to the nearest whole number.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    x - ((x + ROUNDER) - ROUNDER)
}

/// Returns the sine of 2 pi `quarter`, for `quarter` within \[-0.25, 0.25\]: Taylor's series to the power 15, with an
/// error of at most 7e-12.
#[inline(always)]
fn sine(quarter: f64) -> f64 {
    let x = std::f64::consts::TAU * quarter;
    let z = x * x;
    x * (1.0
        + z * (-1.0 / 6.0
            + z * (1.0 / 120.0
                + z * (-1.0 / 5040.0
                    + z * (1.0 / 362_880.0
                        + z * (-1.0 / 39_916_800.0 + z * (1.0 / 6_227_020_800.0 - z / 1_307_674_368_000.0)))))))
}

/// Returns the sine and cosine of `turns` turns, within 7e-12. It has only sums and products, so that every machine
/// gives the same bits, and no branch, so that the compiler works on several waves at a time.
#[inline(always)]
pub(super) fn sin_cos(turns: f64) -> (f64, f64) {
    let u = fraction(turns);
    let size = u.abs();
    let rest = 0.5 - size;
    // The sine is symmetric about a quarter turn. The cosine of an angle is the sine of a quarter turn less the angle.
    let folded = if size < rest { size } else { rest };
    (sine(folded.copysign(u)), sine(0.25 - size))
}

/// Returns the sine of 2 pi `quarter`, for `quarter` within \[-0.25, 0.25\]: the polynomial of power 9 with the least
/// error, 4e-9 before rounding.
#[inline(always)]
fn sine_four(quarter: Vec4) -> Vec4 {
    let z = quarter * quarter;
    let [a, b, c, d, e] = SINE_FOUR.map(Vec4::splat);
    quarter * (a + z * (b + z * (c + z * (d + z * e))))
}

/// Coefficients of [`sine_four`].
#[expect(clippy::approx_constant, reason = "the first coefficient of the fit is near 2 pi, and not 2 pi")]
const SINE_FOUR: [f32; 5] = [6.283_185, -41.341_656, 81.601_006, -76.549_78, 39.536_72];

/// Returns the sines and cosines of four angles within \[-0.5, 0.5\] turns, within 3e-7. As [`sin_cos`], it gives the
/// same bits on every machine.
#[inline(always)]
pub(super) fn sin_cos_four(turns: Vec4) -> (Vec4, Vec4) {
    let size = turns.abs();
    let folded = size.min(Vec4::splat(0.5) - size);
    (sine_four(folded.copysign(turns)), sine_four(Vec4::splat(0.25) - size))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_of_four_turns_are_those_of_libm() {
        for i in -25_000..25_000 {
            let turns = Vec4::new(0.0, 1.0, 2.0, 3.0) * 5e-6 + Vec4::splat(2e-5 * i as f32);
            let turns = turns.clamp(Vec4::splat(-0.5), Vec4::splat(0.5));
            let (sin, cos) = sin_cos_four(turns);
            for l in 0..4 {
                let (s, c) = libm::sincos(std::f64::consts::TAU * f64::from(turns[l]));
                let off = (f64::from(sin[l]) - s).abs().max((f64::from(cos[l]) - c).abs());
                assert!(off < 3e-7, "{}: {off}", turns[l]);
            }
        }
    }

    #[test]
    fn sine_and_cosine_of_any_turn_are_those_of_libm() {
        for i in -100_000..100_000 {
            let turns = f64::from(i) * 1.234_567e-4;
            let (sin, cos) = sin_cos(turns);
            let (s, c) = libm::sincos(std::f64::consts::TAU * (turns - turns.floor()));
            assert!((sin - s).abs() < 7e-12 && (cos - c).abs() < 7e-12, "{turns}: {sin} {s} {cos} {c}");
        }
        assert_eq!(sin_cos(0.25), sin_cos(1e9 + 0.25));
        assert_eq!(fraction(1e8 + 0.125), 0.125);
    }
}
