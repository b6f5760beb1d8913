//! The wind above the surface layer.
//!
//! # Model
//! * Up to 100 m: the logarithmic law ([`WindProfile::speed_at_height_m_s`]).
//! * High above the ground: the geostrophic wind. The geostrophic drag law (Rossby and Montgomery 1935) gives its
//!   component along the wind at the ground, `(u* / k) (ln(u* / (f z0)) - A)`, and the one across it, `(u* / k) B`, to
//!   the right on the northern hemisphere. u* is the friction velocity and z0 the roughness length; k = 0.4, A = 1.8
//!   and B = 4.5 (Troen and Petersen 1989, European Wind Atlas, section 8.1).
//! * In between: the difference to the geostrophic wind turns and decays with the height z as in Ekman's (1905) spiral
//!   for a constant eddy viscosity K: by `exp(-(1 + i) (z - 100 m) sqrt(f / (2 K)))`. K = k u* 100 m is the eddy
//!   viscosity at the top of the surface layer.
//!
//! f is the Coriolis parameter at 43 degrees north, because conditions have no place. Above the friction layer the wind
//! is the same at all heights.

use super::conditions::WindProfile;

/// Top of the surface layer, m.
const SURFACE_LAYER_M: f64 = 100.0;
/// Coriolis parameter, 1/s.
const CORIOLIS_PER_S: f64 = 1e-4;
/// Von Karman's constant.
const KARMAN: f64 = 0.4;
/// Constants A and B of the geostrophic drag law.
const DRAG: [f64; 2] = [1.8, 4.5];
/// Lower limit of ln(u* / (f z0)) - A: the law does not hold for very weak wind over very rough land.
const LEAST_ALONG: f64 = 1.0;

impl WindProfile {
    /// Returns the geostrophic wind along the wind at the ground and to the left of it, m/s.
    fn geostrophic_m_s(&self) -> [f64; 2] {
        let friction = self.friction_velocity_m_s();
        let along = libm::log(friction / (CORIOLIS_PER_S * self.roughness_length_m)) - DRAG[0];
        [friction / KARMAN * along.max(LEAST_ALONG), -friction / KARMAN * DRAG[1]]
    }

    /// Returns the mean wind at a height above ground, relative to the speed at 10 m: along the wind at 10 m and to the
    /// left of it; 0 in a calm.
    pub(crate) fn relative_at_height(&self, height_m: f64) -> [f64; 2] {
        let speed = self.speed_m_s();
        if speed <= 0.0 {
            return [0.0; 2];
        }
        let lower = self.speed_at_height_m_s(height_m);
        if height_m <= SURFACE_LAYER_M {
            return [lower / speed, 0.0];
        }
        let [along, left] = self.geostrophic_m_s();
        let viscosity_m2_s = KARMAN * self.friction_velocity_m_s() * SURFACE_LAYER_M;
        let turn = (height_m - SURFACE_LAYER_M) * libm::sqrt(CORIOLIS_PER_S / (2.0 * viscosity_m2_s));
        let (sine, cosine) = libm::sincos(turn);
        let (x, y, left_over) = (lower - along, -left, libm::exp(-turn));
        [(along + left_over * (x * cosine + y * sine)) / speed, (left + left_over * (y * cosine - x * sine)) / speed]
    }

    /// Returns the mean wind at a height above ground, m/s towards east and north.
    pub fn mean_at_height_m_s(&self, height_m: f64) -> [f64; 2] {
        let [along, left] = self.relative_at_height(height_m);
        [self.east_m_s * along - self.north_m_s * left, self.north_m_s * along + self.east_m_s * left]
    }
}

#[cfg(test)]
mod tests {
    use crate::weather::{Surface, Weather, Wind, WindProfile, derive};

    fn profile(speed_m_s: f64, roughness_m: f64) -> WindProfile {
        let surface = Surface { roughness_length_m: Some(roughness_m), ..Surface::default() };
        derive(&Weather { wind: Wind::of(speed_m_s, 270.0), surface, ..Weather::default() }).unwrap().wind
    }

    #[test]
    fn the_wind_aloft_is_the_geostrophic_one_of_another_law() {
        for (speed, roughness) in [(3.0, 0.03), (8.0, 0.03), (8.0, 0.5), (20.0, 0.001)] {
            let p = profile(speed, roughness);
            let [east, north] = p.mean_at_height_m_s(12_000.0);
            let aloft = east.hypot(north);
            // Lettau 1959: u*/G = 0.16 / (log10(G / (f z0)) - 1.8).
            let lettau = 0.16 / ((aloft / (1e-4 * roughness)).log10() - 1.8);
            let ratio = p.friction_velocity_m_s() / aloft / lettau;
            let veered = (-north).atan2(east).to_degrees();
            println!(
                "{speed} m/s over {roughness} m: {aloft:.1} m/s aloft, veered by {veered:.0} degrees, {ratio:.2} of Lettau's drag"
            );
            assert!((ratio - 1.0).abs() < 0.15, "{ratio}");
            assert!((15.0..35.0).contains(&veered), "{veered}");
        }
    }

    #[test]
    fn the_profile_has_no_step_and_veers_all_the_way_up() {
        let p = profile(8.0, 0.03);
        let at = |h: f64| p.mean_at_height_m_s(h);
        let mut last = at(10.0);
        assert!((last[0] - 8.0).abs() < 1e-12 && last[1].abs() < 1e-12);
        for i in 11..3000 {
            let now = at(f64::from(i));
            assert!((now[0] - last[0]).hypot(now[1] - last[1]) < 0.15, "{i} m: {last:?} {now:?}");
            last = now;
        }
        let speeds = [50.0, 100.0, 300.0, 600.0, 1000.0].map(|h| at(h)[0].hypot(at(h)[1]));
        assert!(speeds.windows(2).all(|s| s[1] > s[0]), "{speeds:?}");
        assert!(at(150.0)[1] < 0.0 && at(600.0)[1] < at(150.0)[1], "to the right, as the northern hemisphere turns it");
        assert_eq!(profile(0.0, 0.03).mean_at_height_m_s(900.0), [0.0; 2]);
    }
}
