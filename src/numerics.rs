//! Numerical rules that several rooms use: Gauss-Legendre nodes and the smooth step.

/// Nodes and weights of the Gauss-Legendre rule of 4 points on \[-1, 1\] (Abramowitz and Stegun 1964, table 25.4).
pub(crate) const GAUSS_4: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// Positive nodes and weights of the Gauss-Legendre rule of 8 points on \[-1, 1\] (Abramowitz and Stegun 1964, table
/// 25.4). The negative nodes have the same weights.
pub(crate) const GAUSS_8_HALF: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

/// Returns the cubic that rises from 0 at `t` = 0 to 1 at `t` = 1 with slope 0 at both ends, for `t` within \[0, 1\].
pub(crate) fn smooth(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

/// Returns the smooth step from 0 at `a` to 1 at `b`, constant outside.
pub(crate) fn smoothstep(a: f64, b: f64, x: f64) -> f64 {
    smooth(((x - a) / (b - a)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_for_their_degree() {
        let exact = |power: i32| if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
        for power in 0..8 {
            let sum: f64 = GAUSS_4.iter().map(|(x, w)| w * x.powi(power)).sum();
            assert!((sum - exact(power)).abs() < 1e-15, "4 points, degree {power}: {sum}");
        }
        for power in 0..16 {
            let sum: f64 = GAUSS_8_HALF.iter().map(|(x, w)| w * (x.powi(power) + (-x).powi(power))).sum();
            assert!((sum - exact(power)).abs() < 1e-15, "8 points, degree {power}: {sum}");
        }
        let beyond: f64 = GAUSS_4.iter().map(|(x, w)| w * x.powi(8)).sum();
        assert!((beyond - exact(8)).abs() > 1e-3);
    }
}
