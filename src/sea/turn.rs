//! Sine and cosine of angles in turns: fast, and with the same bits on every machine.

/// Returns `x` minus the nearest whole number, within \[-0.5, 0.5\]. `x` must be within 2^51.
#[inline(always)]
pub(super) fn fraction(x: f64) -> f64 {
    // Adding and taking away 1.5 * 2^52 rounds to the nearest whole number.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    x - ((x + ROUNDER) - ROUNDER)
}

/// Returns the sine and cosine of `turns` turns, within 1e-13. Plain sums and products, so that every machine gives the
/// same bits; no branch, so that the compiler works on several waves at a time.
#[inline(always)]
pub(super) fn sin_cos(turns: f64) -> (f64, f64) {
    let u = fraction(turns);
    // Quarter turns: 4u = q + r with |r| <= 1/2.
    let r = fraction(4.0 * u);
    let q = 4.0 * u - r;
    let x = std::f64::consts::FRAC_PI_2 * r;
    let z = x * x;
    let sin = x
        * (1.0
            + z * (-1.0 / 6.0
                + z * (1.0 / 120.0
                    + z * (-1.0 / 5040.0
                        + z * (1.0 / 362_880.0 + z * (-1.0 / 39_916_800.0 + z * (1.0 / 6_227_020_800.0)))))));
    let cos = 1.0
        + z * (-0.5
            + z * (1.0 / 24.0
                + z * (-1.0 / 720.0
                    + z * (1.0 / 40_320.0
                        + z * (-1.0 / 3_628_800.0 + z * (1.0 / 479_001_600.0 - z / 87_178_291_200.0))))));
    // q is -2, -1, 0, 1 or 2.
    let is_odd = q * q == 1.0;
    let (s, c) = if is_odd { (cos, sin) } else { (sin, cos) };
    let sin_sign = if q < -0.5 || q > 1.5 { -1.0 } else { 1.0 };
    let cos_sign = if q > 0.5 || q < -1.5 { -1.0 } else { 1.0 };
    (sin_sign * s, cos_sign * c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_turns_are_those_of_the_library() {
        for i in -100_000..100_000 {
            let turns = f64::from(i) * 1.234_567e-4;
            let (sin, cos) = sin_cos(turns);
            let (s, c) = libm::sincos(std::f64::consts::TAU * (turns - turns.floor()));
            assert!((sin - s).abs() < 1e-13 && (cos - c).abs() < 1e-13, "{turns}: {sin} {s} {cos} {c}");
        }
        assert_eq!(sin_cos(0.25), (1.0, sin_cos(1e9 + 0.25).1));
        assert_eq!(fraction(1e8 + 0.125), 0.125);
    }
}
