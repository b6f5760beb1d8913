//! What the wind lifts comes in gusts: how unevenly, by the law of grains that hop along the ground.

use super::{conditions::WindProfile, smoothstep};

/// Wind at 10 m that first moves dry sand or snow, m/s: a friction velocity of 0.25 to 0.3 m/s over smooth ground (Bagnold 1941;
/// for dry snow 7.7 m/s, Li and Pomeroy 1997).
pub const LIFTING_M_S: f64 = 7.0;

/// Absorption of lifted dust goes with (wavelength / 550 nm)^-exponent (Russell et al. 2010). Lifted snow absorbs nothing.
pub(crate) const DUST_ABSORPTION_EXPONENT: f64 = 2.7;

/// What a wind carries of loose grains, up to a factor: u^3 (1 - (ut / u)^2), nothing below the threshold (Owen 1964).
pub fn carried(speed_m_s: f64) -> f64 {
    speed_m_s * (speed_m_s * speed_m_s - LIFTING_M_S * LIFTING_M_S).max(0.0)
}

/// What gusts carry on the mean, m^3/s^3, below which the wind lifts nothing, and from which on its unevenness counts in full: what a
/// calmer wind still carries was lifted before and has mixed.
const CALM: [f64; 2] = [1e-3, 0.3];

/// Standard deviation of what gusts carry over its mean, held to \[0, 1\]: 0 where no gust lifts anything, 1 where only gusts do.
/// Gusts are normal about the mean wind.
pub fn unevenness(wind: &WindProfile) -> f64 {
    const STEPS: i32 = 60;
    let (mean, deviation) = (wind.speed_m_s(), wind.speed_m_s() * wind.turbulence_intensity);
    let (mut weight, mut first, mut second) = (0.0, 0.0, 0.0);
    for i in -STEPS..=STEPS {
        let z = 3.5 * f64::from(i) / f64::from(STEPS);
        let (w, q) = (libm::exp(-0.5 * z * z), carried((mean + z * deviation).max(0.0)));
        (weight, first, second) = (weight + w, first + w * q, second + w * q * q);
    }
    let (first, second) = (first / weight, second / weight);
    if first <= CALM[0] {
        return 0.0;
    }
    ((second - first * first).max(0.0).sqrt() / first).min(1.0) * smoothstep(CALM[0], CALM[1], first)
}

#[cfg(test)]
mod tests {
    use super::super::{Weather, Wind, derive};
    use super::*;

    fn of(speed_m_s: f64, turbulence: f64) -> f64 {
        let wind = Wind { turbulence_intensity: Some(turbulence), ..Wind::of(speed_m_s, 200.0) };
        unevenness(&derive(&Weather { wind, ..Weather::default() }).unwrap().wind)
    }

    #[test]
    fn unevenness_comes_up_without_a_jump() {
        let mut last = of(3.5, 0.18);
        assert_eq!(last, 0.0);
        for i in 1..=1500 {
            let now = of(3.5 + 0.002 * f64::from(i), 0.18);
            assert!((now - last).abs() < 0.02, "{}: {last} to {now}", 3.5 + 0.002 * f64::from(i));
            last = now;
        }
        assert!(last > 0.9, "{last}");
    }

    #[test]
    fn a_wind_above_the_threshold_carries_by_owens_law_and_gusts_carry_unevenly() {
        assert_eq!((carried(3.0), carried(7.0)), (0.0, 0.0));
        assert!((carried(14.0) / carried(28.0) - (1.0 - 0.25) / 8.0 / (1.0 - 1.0 / 16.0)).abs() < 1e-12);
        assert_eq!((of(0.0, 0.2), of(3.0, 0.2)), (0.0, 0.0));
        assert!(of(20.0, 0.0) < 1e-6, "an even wind");
        assert_eq!(of(6.0, 0.2), 1.0, "gusts alone lift");
        // Far above the threshold the cube triples what the wind varies by.
        let strong = of(40.0, 0.1);
        assert!((strong / 0.3 - 1.0).abs() < 0.08, "{strong}");
        assert!(of(12.0, 0.15) > of(20.0, 0.15) && of(20.0, 0.25) > of(20.0, 0.15));
    }
}
