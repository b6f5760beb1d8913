//! Matter that the wind lifts: how unevenly gusts distribute it, by the law of saltating grains; and the layer of blown
//! snow.

use super::conditions::{Conditions, GroundLayer, WindProfile};

use crate::numerics::smoothstep;

/// Wind speed at 10 m above which dry sand or snow begins to move, m/s: a friction velocity of 0.25 to 0.3 m/s over
/// smooth ground (Bagnold 1941; for dry snow 7.7 m/s, Li and Pomeroy 1997).
pub const LIFTING_M_S: f64 = 7.0;

/// Exponent of the power law of lifted dust's absorption, (wavelength / 550 nm)^-exponent (Russell et al. 2010). Lifted
/// snow absorbs nothing.
pub(crate) const DUST_ABSORPTION_EXPONENT: f64 = 2.7;

/// Returns the amount of loose grains that a wind carries, up to a constant factor: u^3 (1 - (ut / u)^2), and 0 below
/// the threshold (Owen 1964). u is the speed at 10 m, and ut = [`LIFTING_M_S`].
pub fn carried(speed_m_s: f64) -> f64 {
    speed_m_s * (speed_m_s * speed_m_s - LIFTING_M_S * LIFTING_M_S).max(0.0)
}

/// Mean amounts carried by gusts ([`carried`]), m^3/s^3, between which the unevenness sets in. Up to the first amount
/// the wind lifts nothing. Matter in the air was then lifted earlier and is evenly mixed. From the second amount on,
/// the matter is as uneven as the gusts.
const CALM: [f64; 2] = [1e-3, 0.3];

/// Returns the ratio of the standard deviation of the amount that gusts carry to its mean, limited to \[0, 1\], and
/// multiplied by a ramp over the mean amounts of `CALM`: 0 where no gust lifts anything. The ratio reaches its limit
/// where gusts lift matter but the mean wind does not. Gusts have a normal distribution around the mean wind.
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

/// Radius of blown snow particles, m: 60 to 100 um (Pomeroy and Male 1992).
const BLOWN_RADIUS_M: f64 = 7e-5;
/// Depths of low drifting snow and of high blowing snow, m.
const BLOWN_TOP_M: [f64; 2] = [1.5, 50.0];
/// Difference, m/s, between the wind speed at which the layer reaches the second depth of [`BLOWN_TOP_M`] and the
/// threshold of lifting.
const BLOWN_RISE_M_S: f64 = 5.0;

/// Returns the friction velocity over drifting snow, m/s, for a wind at 10 m (Pomeroy and Gray 1990).
pub fn drift_friction_velocity_m_s(wind_m_s: f64) -> f64 {
    0.02264 * libm::pow(wind_m_s, 1.295)
}

/// Returns the density of snow in the air at a height above loose snow, kg/m^3: 0.8 exp(-1.55 (4.784 u*^-0.544 -
/// z^-0.544)) (Pomeroy and Male 1992), with the friction velocity u*, m/s, and the height z, m.
pub fn blown_kg_m3(wind_m_s: f64, height_m: f64) -> f64 {
    let u = drift_friction_velocity_m_s(wind_m_s);
    0.8 * libm::exp(-1.55 * (4.784 * libm::pow(u, -0.544) - libm::pow(height_m, -0.544)))
}

/// Adds the layer of snow that the wind lifts, unless the weather already has a layer at the ground. Loose snow covers
/// the share `covered` of the ground and moves in wind above `threshold_m_s`. The extinction is that of spheres with an
/// efficiency of 2: 3 eta / (2 rho r), with the density eta of the snow in the air at half the layer's depth (at most
/// 2 m), the density rho of ice and the radius r. The extinction is multiplied by `covered`, and by
/// 1 - (threshold / wind)^2, so that it begins at 0 at the threshold.
pub(crate) fn lift_snow(c: &mut Conditions, threshold_m_s: f64, covered: f64) {
    let wind = c.wind.speed_m_s();
    if c.fog.extinction_per_m > 0.0 || wind <= threshold_m_s || covered <= 0.0 {
        return;
    }
    let high = smoothstep(0.0, BLOWN_RISE_M_S, wind - threshold_m_s);
    let top_m = BLOWN_TOP_M[0] + (BLOWN_TOP_M[1] - BLOWN_TOP_M[0]) * high;
    let begun = 1.0 - (threshold_m_s / wind) * (threshold_m_s / wind);
    let mass = blown_kg_m3(wind, (0.5 * top_m).min(2.0));
    let extinction_per_m = 1.5 * mass / (917.0 * BLOWN_RADIUS_M) * begun * covered;
    c.fog = GroundLayer {
        extinction_per_m,
        angstrom_exponent: 0.0,
        single_scattering_albedo: 1.0,
        asymmetry: 0.89,
        base_m: 0.0,
        top_m,
        softness_m: top_m,
        coverage: 1.0,
        patch_size_m: 12.0 + 108.0 * high,
        lifted: unevenness(&c.wind),
    };
    // Drifting snow stays below the observer's eye, so it does not count in the reported visibility.
    c.extinction_per_m += extinction_per_m * high;
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
        // Far above the threshold the cube triples the relative variation of the wind.
        let strong = of(40.0, 0.1);
        assert!((strong / 0.3 - 1.0).abs() < 0.08, "{strong}");
        assert!(of(12.0, 0.15) > of(20.0, 0.15) && of(20.0, 0.25) > of(20.0, 0.15));
    }

    #[test]
    fn loose_snow_drifts_low_and_blows_high_with_the_wind() {
        let blown = |wind: f64| {
            let mut c = derive(&Weather { wind: Wind::of(wind, 200.0), ..Weather::default() }).unwrap();
            lift_snow(&mut c, 7.7, 1.0);
            c
        };
        assert_eq!(blown(7.6).fog, derive(&Weather::default()).unwrap().fog);
        let (low, high, storm) = (blown(8.5), blown(15.0), blown(22.0));
        assert!((1.5..8.0).contains(&low.fog.top_m) && low.visibility_m() > 5000.0, "{:?}", low.fog);
        println!(
            "visibility in blowing snow: {:.0} m at 15 m/s, {:.0} m at 22 m/s",
            high.visibility_m(),
            storm.visibility_m()
        );
        // Below 1 km it is a blizzard; in a storm the visibility is some tens of metres.
        assert!((150.0..1000.0).contains(&high.visibility_m()), "{}", high.visibility_m());
        assert!((5.0..150.0).contains(&storm.visibility_m()) && storm.fog.top_m == 50.0, "{}", storm.visibility_m());
        let mut last = 0.0;
        for i in 0..400 {
            let now = blown(7.0 + 0.02 * f64::from(i)).fog.extinction_per_m;
            assert!(now >= last && now - last < 0.004, "{now} after {last}");
            last = now;
        }
    }
}
