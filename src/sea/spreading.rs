//! Spreading of waves over directions: densities per radian whose integral over the full circle is 1.

use std::f64::consts::PI;

use crate::numerics::GAUSS_8_HALF;

/// Returns cos^2s(theta / 2) times 2^(2s-1) Gamma(s+1)^2 / (pi Gamma(2s+1)), which normalises it over the full circle
/// (Longuet-Higgins, Cartwright and Smith 1963). The logarithm of the gamma function keeps large `s` finite.
pub fn cosine_power(theta: f64, s: f64) -> f64 {
    let ln_norm = (2.0 * s - 1.0) * std::f64::consts::LN_2 + 2.0 * libm::lgamma(s + 1.0)
        - libm::log(PI)
        - libm::lgamma(2.0 * s + 1.0);
    let cos = libm::cos(0.5 * theta).abs();
    libm::exp(ln_norm + 2.0 * s * libm::log(cos.max(1e-300)))
}

/// Returns the directional width, rad, of [`cosine_power`]: sqrt(2 / (s + 1)) (Kuik, van Vledder and Holthuijsen 1988).
pub fn cosine_power_width(s: f64) -> f64 {
    libm::sqrt(2.0 / (s + 1.0))
}

/// Returns the exponent `s` of Mitsuyasu et al. (1975) at `r` = w / wp. `wind_over_speed` is U / cp, the ratio of the
/// wind to the phase speed of waves at the peak. The exponent is 11.5 (U / cp)^-2.5 at the peak, times r^5 below it and
/// r^-2.5 above.
pub fn mitsuyasu_exponent(r: f64, wind_over_speed: f64) -> f64 {
    let peak = 11.5 * libm::pow(wind_over_speed, -2.5);
    peak * libm::pow(r, if r < 1.0 { 5.0 } else { -2.5 })
}

/// Returns the exponent `s` of Hasselmann, Dunckel and Ewing (1980) at `r` = w / wp. `wind_over_speed` is that of
/// [`mitsuyasu_exponent`]. The exponent jumps at the peak, as published.
pub fn hasselmann_exponent(r: f64, wind_over_speed: f64) -> f64 {
    if r < 1.0 { 6.97 * libm::pow(r, 4.06) } else { 9.77 * libm::pow(r, -2.33 - 1.45 * (wind_over_speed - 1.17)) }
}

/// Returns the parameter beta of Donelan, Hamilton and Hui (1985) at `r` = w / wp, with Banner's (1990) continuation
/// above 1.6.
pub fn donelan_banner_beta(r: f64) -> f64 {
    if r < 0.95 {
        2.61 * libm::pow(r, 1.3)
    } else if r < 1.6 {
        2.28 * libm::pow(r, -1.3)
    } else {
        let ln = libm::log(r * r);
        libm::exp(std::f64::consts::LN_10 * (-0.4 + 0.8393 * libm::exp(-0.567 * ln)))
    }
}

/// Returns the density of a spreading beta sech^2(beta theta) / (2 tanh(beta pi)), `theta` in \[-pi, pi\] (Donelan,
/// Hamilton and Hui 1985, normalised over the circle).
pub fn sech_squared(theta: f64, beta: f64) -> f64 {
    let sech = 1.0 / libm::cosh(beta * theta);
    beta * sech * sech / (2.0 * libm::tanh(beta * PI))
}

/// Returns the share of [`sech_squared`] from -pi to `theta` in \[-pi, pi\]: its integral in closed form.
pub fn sech_squared_share(theta: f64, beta: f64) -> f64 {
    0.5 * (1.0 + libm::tanh(beta * theta) / libm::tanh(beta * PI))
}

/// Returns the exponent by which Horvath (2015, equation 45) narrows a swell at w / wp = `r`: 16 tanh(1 / r) xi^2, with
/// xi from 0 (wind sea) to 1. The spreading is multiplied by |cos(theta / 2)|^(2 s) and normalised again.
pub fn swell_exponent(r: f64, xi: f64) -> f64 {
    16.0 * libm::tanh(1.0 / r) * xi * xi
}

/// Returns the directional width, rad, sqrt(2 (1 - m)) with m the mean cosine (Kuik, van Vledder and Holthuijsen 1988),
/// of a density over \[-pi, pi\] that is symmetric and need not be normalised.
pub fn width_of(density: impl Fn(f64) -> f64) -> f64 {
    let (panels, mut whole, mut cosine) = (64u32, 0.0, 0.0);
    let half = 0.5 * PI / f64::from(panels);
    for i in 0..panels {
        let middle = (2.0 * f64::from(i) + 1.0) * half;
        for (node, weight) in GAUSS_8_HALF {
            for theta in [middle - half * node, middle + half * node] {
                let d = weight * density(theta);
                whole += d;
                cosine += d * libm::cos(theta);
            }
        }
    }
    libm::sqrt(2.0 * (1.0 - cosine / whole).max(0.0))
}

/// Returns the parameter beta of [`sech_squared`] with a directional width, rad, by bisection.
pub fn beta_of_width(width: f64) -> f64 {
    let (mut low, mut high) = (0.0f64, 400.0f64);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if width_of(|theta| sech_squared(theta, middle)) > width { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Returns the width, rad, of a swell at its peak: Donelan and Banner's spreading, narrowed by Horvath's `xi`.
pub fn swell_width(xi: f64) -> f64 {
    let (beta, s) = (donelan_banner_beta(1.0), swell_exponent(1.0, xi));
    width_of(|theta| sech_squared(theta, beta) * libm::pow(libm::cos(0.5 * theta).abs(), 2.0 * s))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(density: impl Fn(f64) -> f64) -> f64 {
        let n = 20_000;
        let step = 2.0 * PI / f64::from(n);
        (0..n).map(|i| density(-PI + (f64::from(i) + 0.5) * step)).sum::<f64>() * step
    }

    #[test]
    fn every_law_integrates_to_one_over_the_circle() {
        for s in [0.5, 2.0, 10.0, 25.0, 75.0, 400.0] {
            assert!((circle(|t| cosine_power(t, s)) - 1.0).abs() < 1e-7, "{s}");
        }
        for beta in [0.05, 0.4, 1.0, 2.28, 12.0] {
            assert!((circle(|t| sech_squared(t, beta)) - 1.0).abs() < 1e-6, "{beta}");
            let inside = circle(|t| if t < 0.7 { sech_squared(t, beta) } else { 0.0 });
            assert!((inside - sech_squared_share(0.7, beta)).abs() < 1e-3, "{beta}: {inside}");
        }
    }

    #[test]
    fn heights_and_widths_are_those_published() {
        for (s, at_0, deg) in
            [(2.0, 0.42441, 46.78), (10.0, 0.90328, 24.43), (25.0, 1.41754, 15.89), (75.0, 2.44709, 9.29)]
        {
            assert!((cosine_power(0.0, s) - at_0).abs() < 6e-6, "{s}");
            assert!((cosine_power_width(s).to_degrees() - deg).abs() < 6e-3, "{s}");
            assert!((width_of(|t| cosine_power(t, s)).to_degrees() - deg).abs() < 6e-3, "{s}");
        }
        for (r, at_0, deg) in [(0.8, 0.97641, 25.65), (1.0, 1.14, 22.18), (2.0, 0.48248, 46.59), (5.0, 0.29028, 63.78)]
        {
            let beta = donelan_banner_beta(r);
            assert!((sech_squared(0.0, beta) - at_0).abs() < 1e-5, "{r}: {}", sech_squared(0.0, beta));
            assert!((width_of(|t| sech_squared(t, beta)).to_degrees() - deg).abs() < 6e-3, "{r}");
        }
    }

    #[test]
    fn exponents_are_those_published() {
        // 10 m/s over 100 km: the peak of JONSWAP's own law runs at g / wp.
        let peak = 22.0 * (9.81f64 * 9.81 / 1e6).cbrt();
        let age = 10.0 * peak / 9.81;
        assert!((mitsuyasu_exponent(1.0, age) - 10.74).abs() < 1e-2, "{}", mitsuyasu_exponent(1.0, age));
        assert!((hasselmann_exponent(0.8, age) - 2.817).abs() < 1e-3);
        let above = hasselmann_exponent(2.0, age);
        assert!((above - 2.242).abs() < 2e-3, "{above}");
    }

    #[test]
    fn swells_narrow_by_horvath_s_parameter() {
        for (xi, deg) in [(0.0, 22.18), (0.5, 19.21), (1.0, 15.07)] {
            assert!((swell_width(xi).to_degrees() - deg).abs() < 6e-3, "{xi}: {}", swell_width(xi).to_degrees());
        }
        for deg in [3.0f64, 15.07, 40.0] {
            let beta = beta_of_width(deg.to_radians());
            assert!((width_of(|t| sech_squared(t, beta)).to_degrees() - deg).abs() < 1e-6, "{deg}");
        }
    }
}
