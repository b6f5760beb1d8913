//! Physics of snow on glass: how much of it lands and stays, and how it melts.

use std::f64::consts::PI;

use super::laws::{GRAVITY, WATER};
use crate::{falling::flakes::aggregate_speed_m_s, weather::Falling};

/// Latent heat of melting ice, J/kg.
const MELTING_J_KG: f64 = 3.34e5;
/// Diameter of the flake whose fall speed is taken for all flakes, mm.
const TYPICAL_MM: f64 = 4.0;
/// Width of the body that the air flows around, glass and cab, m.
const BLUFF_M: f64 = 1.0;
/// Largest amount of snow that stays on glass, m of water. Any more slides off as a sheet.
const MOST_M: f64 = 5e-3;

/// Snowfall at the glass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Snowing {
    /// Rate of melted water on level ground, m/s.
    pub water_m_s: f64,
    /// Fall speed of the flakes, m/s.
    pub fall_m_s: f64,
    /// Volume of water in a flake, m^3.
    pub flake_m3: f64,
}

impl Snowing {
    /// Creates the snowfall of `falling` at a temperature. `factor` is the ratio of fall speeds to those at sea level.
    /// The median melted diameter by volume is 1.4 mm R^0.45 at R mm/h (Sekhon & Srivastava 1970, eq. 8).
    pub fn new(falling: &Falling, temperature_c: f64, factor: f64) -> Self {
        let rate = falling.snow_mm_h;
        if rate <= 0.0 {
            return Self::default();
        }
        let melted_m = 1.4e-3 * libm::pow(rate.max(0.01), 0.45);
        Self {
            water_m_s: rate / 3.6e6,
            fall_m_s: factor * aggregate_speed_m_s(TYPICAL_MM, temperature_c),
            flake_m3: PI / 6.0 * melted_m * melted_m * melted_m,
        }
    }

    /// Returns the rate at which snow stays on a surface, as water, m/s. `normal_up` is the upward component of the
    /// surface's outward normal, and `approach_m_s` its speed outwards against the air. The air that flows around the
    /// glass takes light flakes with it. Of the flakes blown towards the glass the share S^3 / (S^3 + 0.77 S^2 + 0.22)
    /// arrives (Landahl & Herrmann 1949), where S is their Stokes number, (fall speed / g) x approach / 1 m. Of flakes
    /// that arrive at a speed v above 1 m/s, the share (1 m/s) / v stays (ISO 12494:2001, wet snow).
    pub fn stays_m_s(&self, normal_up: f64, approach_m_s: f64) -> f64 {
        if self.water_m_s <= 0.0 {
            return 0.0;
        }
        let blown = approach_m_s.max(0.0);
        let s = self.fall_m_s / GRAVITY * blown / BLUFF_M;
        let arrives = s * s * s / (s * s * s + 0.77 * s * s + 0.22);
        let speed = self.fall_m_s * normal_up + approach_m_s.min(0.0) + blown * arrives;
        if speed <= 0.0 { 0.0 } else { self.water_m_s / self.fall_m_s * speed / speed.max(1.0) }
    }
}

/// Returns the heat transfer from glass to air, W/(m^2 K), by the law of a plate in wind: 5.7 + 3.8 v below 5 m/s, and
/// 6.47 v^0.78 above (McAdams 1954, *Heat Transmission*, 3rd edition, eq. 9-42).
fn exchange_w_m2_k(wind_m_s: f64) -> f64 {
    let v = wind_m_s.abs();
    if v < 5.0 { 5.7 + 3.8 * v } else { 6.47 * libm::pow(v, 0.78) }
}

/// Returns the rate at which snow melts on heated glass, m/s of water: (H + h T) / (L rho), at least 0. H is the
/// heating, W/m^2; h the heat transfer, W/(m^2 K), from glass at 0 C to air of the temperature T, C; L the latent heat
/// of melting, J/kg; rho the density of water, kg/m^3.
pub fn melts_m_s(heat_w_m2: f64, temperature_c: f64, wind_m_s: f64) -> f64 {
    (heat_w_m2 + exchange_w_m2_k(wind_m_s) * temperature_c).max(0.0) / (MELTING_J_KG * WATER)
}

/// Returns the largest volume of water that one flake brings to a cell, m^3. It is 0.1 mm of water over the cell. A
/// large flake covers several cells: a flake of 5 mm and 2 mg is also 0.1 mm of water deep over its disc.
pub fn of_a_flake_m3(cell_m: f64) -> f64 {
    1e-4 * cell_m * cell_m
}

/// Returns the largest volume of water in the snow of a cell, m^3.
pub fn most_m3(cell_m: f64) -> f64 {
    MOST_M * cell_m * cell_m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn level_glass_gathers_all_falling_snow_and_fast_glass_a_part_of_what_hits_it() {
        let snow = Snowing { water_m_s: 1.0 / 3.6e6, fall_m_s: 1.0, flake_m3: 1e-9 };
        let mm_h = |up, approach| snow.stays_m_s(up, approach) * 3.6e6;
        // In calm air level glass gathers as much as level ground does, and upright glass nothing.
        assert!((mm_h(1.0, 0.0) - 1.0).abs() < 1e-12);
        assert_eq!([mm_h(0.0, 0.0), mm_h(0.0, -8.0), mm_h(-0.5, 0.0)], [0.0; 3]);
        // A leaning windscreen at 14 m/s meets eight times the falling snow, most of which blows away.
        let driven = mm_h(0.5, 14.0);
        assert!((0.5..1.5).contains(&driven), "{driven}");
        assert_eq!(Snowing::default().stays_m_s(1.0, 20.0), 0.0);
    }

    #[test]
    fn heat_and_warm_air_melt_and_cold_wind_does_not() {
        let mm_h = |heat, t, v| melts_m_s(heat, t, v) * 3.6e6;
        assert_eq!(mm_h(0.0, -5.0, 0.0), 0.0);
        assert_eq!(mm_h(300.0, -10.0, 20.0), 0.0, "the wind takes more");
        // 600 W/m^2 at -5 C in calm air: 571 W/m^2 melt 6.2 kg/(m^2 h).
        let melted = mm_h(600.0, -5.0, 0.0);
        assert!((melted - 571.5 * 3600.0 / 3.34e5 / 0.998).abs() < 0.01, "{melted}");
        assert!(mm_h(0.0, 3.0, 0.0) > 0.1);
    }
}
