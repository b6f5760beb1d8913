//! Sine and cosine of angles in turns: fast, and with the same bits on every machine.

/// Returns `x` minus the nearest whole number, within \[-0.5, 0.5\]. `x` must be within 2^51.
#[inline(always)]
pub(super) fn fraction(x: f64) -> f64 {
    // Adding and taking away 1.5 * 2^52 rounds to the nearest whole number.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    x - ((x + ROUNDER) - ROUNDER)
}

/// Returns the sine of 2 pi `quarter`, within \[-0.25, 0.25\]: Taylor's series to the power 15, within 7e-12.
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

/// Returns the sine and cosine of `turns` turns, within 7e-12. Plain sums and products, so that every machine gives the
/// same bits; no branch, so that the compiler works on several waves at a time.
#[inline(always)]
pub(super) fn sin_cos(turns: f64) -> (f64, f64) {
    let u = fraction(turns);
    let size = u.abs();
    let rest = 0.5 - size;
    // The sine is symmetric about a quarter turn; the cosine is the sine of what is missing to one.
    let folded = if size < rest { size } else { rest };
    (sine(folded.copysign(u)), sine(0.25 - size))
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
            assert!((sin - s).abs() < 7e-12 && (cos - c).abs() < 7e-12, "{turns}: {sin} {s} {cos} {c}");
        }
        assert_eq!(sin_cos(0.25), sin_cos(1e9 + 0.25));
        assert_eq!(fraction(1e8 + 0.125), 0.125);
    }
}
