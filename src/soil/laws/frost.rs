//! Frost in the ground: how deep cold weather freezes it.

/// Thermal conductivity of frozen loam, W/(m K).
const CONDUCTIVITY_W_M_K: f64 = 2.0;
/// Heat that freezing takes from a cubic metre of moist ground, J/m^3: 250 kg of water at 334 kJ/kg.
const LATENT_J_M3: f64 = 250.0 * 334e3;

/// Returns the depth to which ground is frozen, m, by the freezing index I: the sum of the degrees below 0 over time, K
/// s. The depth is sqrt(2 k I / L), with the conductivity k of the frozen ground and the latent heat L of its water
/// (Stefan 1891). Snow on the ground is left out.
pub fn frost_depth_m(freezing_k_s: f64) -> f64 {
    (2.0 * CONDUCTIVITY_W_M_K * freezing_k_s.max(0.0) / LATENT_J_M3).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frost_goes_deeper_with_the_root_of_its_index() {
        // A day at -10 degrees, and a hundred degree days, which freeze moist ground by about 0.6 m.
        assert!((frost_depth_m(10.0 * 86_400.0) - 0.2034).abs() < 1e-3);
        assert!((frost_depth_m(100.0 * 86_400.0) - 0.6433).abs() < 1e-3);
        assert_eq!(frost_depth_m(-5.0), 0.0);
    }
}
